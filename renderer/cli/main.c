/* main.c: the program: scene -> picture -> files.
 * Threads: main alone. */
#include "options.h"
#include "passes.h"
#include "progress.h"
#include "signals.h"

#include <stdio.h>
#include <string.h>

static int exit_code(ag_status status)
{
    switch (status) {
    case AG_OK: return 0;
    case AG_ERROR_INPUT:
    case AG_ERROR_SCENE:
    case AG_ERROR_COLOR: return 1;
    case AG_ERROR_ARGUMENT: return 2;
    case AG_CANCELLED: return signals_stop() ? 128 + signals_stop() : 3;
    case AG_ERROR_MEMORY:
    case AG_ERROR_OUTPUT:
    case AG_ERROR_RAY_TRACING:
    case AG_ERROR_SYSTEM:
    case AG_PAUSED: break;
    }
    return 3;
}

/* Where nothing is asked for: the scene's own file name, else the scene file's with .exr, in the working directory. */
static void name_default_output(const options *o, const ag_scene *scene, char *out_name, size_t size)
{
    const char *own = ag_scene_film_file_name(scene);
    if (own) {
        snprintf(out_name, size, "%s", own);
        return;
    }
    const char *base = strrchr(o->scene, '/');
    base = base ? base + 1 : o->scene;
    int stem = (int)strcspn(base, ".");
    if (strcmp(base, "-") == 0 || stem == 0)
        snprintf(out_name, size, "afterglow.exr");
    else
        snprintf(out_name, size, "%.*s.exr", stem, base);
}

static ag_status list_displays(ag_context *context)
{
    const char *text;
    ag_status status = ag_color_summary(context, &text);
    if (status == AG_OK && (fputs(text, stdout) < 0 || fflush(stdout) != 0))
        status = AG_ERROR_OUTPUT;
    return status;
}

static ag_status run(ag_context *context, options *o, passes_result *out_result)
{
    ag_status status = AG_OK;
    o->begun = passes_seconds();
    if (o->lists_displays)
        return list_displays(context);
    /* what was asked for is checked before the work */
    for (int i = 0; i < o->outfile_count && status == AG_OK; i++)
        status = ag_output_check(context, &o->output, o->outfiles[i]);
    if (status == AG_OK && o->stats)
        status = ag_statistics_check(context, o->stats);
    if (status == AG_OK && o->photons_file)
        status = ag_statistics_check(context, o->photons_file); /* as for any file */
    if (status == AG_OK && o->photons_file && o->render.integrator == AG_INTEGRATOR_PATH) {
        fprintf(stderr, "afterglow: --dump-photons: path tracing has no photons\n");
        status = AG_ERROR_ARGUMENT;
    }
    if (status == AG_OK && o->render.denoise)
        status = ag_denoise_check(context);
    if (status != AG_OK)
        return status;

    ag_scene *scene = NULL;
    ag_render_settings settings;
    char default_name[4096];
    status = ag_scene_load(context, o->scene, &scene);
    if (status == AG_OK && o->outfile_count == 0) {
        name_default_output(o, scene, default_name, sizeof default_name);
        o->outfiles[o->outfile_count++] = default_name;
        status = ag_output_check(context, &o->output, default_name);
        if (status == AG_ERROR_ARGUMENT)
            status = AG_ERROR_SCENE; /* the name is the scene's, not the command line's */
    }
    if (status == AG_OK)
        status = ag_render_settings_from_scene(context, scene, &settings);
    if (status == AG_OK) {
        options_override(o, &settings);
        status = passes_render(context, o, scene, &settings, out_result);
    }
    if ((status == AG_OK || out_result->is_partial) && o->stats) {
        ag_status written = ag_statistics_write(context, o->stats);
        status = status == AG_OK ? written : status;
    }
    ag_scene_destroy(scene);
    return status;
}

int main(int argc, char **argv)
{
    options o;
    options_result parsed = options_parse(argc, argv, &o);
    if (parsed != OPTIONS_RUN) {
        if (parsed == OPTIONS_EXIT_OK && (fflush(stdout) != 0 || ferror(stdout)))
            return 3;
        return parsed == OPTIONS_EXIT_OK ? 0 : 2;
    }
    progress told;
    progress_init(&told, &o);
    o.context.log = progress_log;
    o.context.progress = progress_tell;
    o.context.user = &told;
    ag_context *context;
    ag_status status = ag_context_create(&o.context, &context);
    if (status != AG_OK) {
        fprintf(stderr, "afterglow: error: %s\n", ag_status_text(status));
        options_reset(&o);
        return exit_code(status);
    }
    signals_catch(context);
    passes_result result = {0};
    status = run(context, &o, &result);
    progress_finish(&told);
    if (status == AG_CANCELLED && o.verbosity >= 0) {
        if (result.is_partial && result.samples.most > 0)
            fprintf(stderr, "afterglow: interrupted: the picture has %.4g samples per pixel, from %d to %d\n",
                    result.samples.mean, result.samples.least, result.samples.most);
        else
            fprintf(stderr, "afterglow: interrupted: no picture was written\n");
    }
    if (status == AG_ERROR_MEMORY || status == AG_ERROR_SYSTEM)
        fprintf(stderr, "afterglow: error: %s\n", ag_status_text(status));
    signals_release();
    ag_context_destroy(context);
    options_reset(&o);
    return exit_code(status);
}
