/* main.c: the program: scene -> picture -> files.
 * Threads: main alone; signals are taken by a handler that does no more than say stop. */
#define _GNU_SOURCE
#include "options.h"
#include "progress.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static ag_context *signalled_context;
static volatile sig_atomic_t caught_signal;

static const int CAUGHT[] = {SIGINT, SIGTERM, SIGHUP};

/* The first signal lets the work end in order, the second ends the process at once. */
static void on_signal(int number)
{
    if (caught_signal) {
        ag_abandon_files();
        _exit(128 + number);
    }
    caught_signal = number;
    ag_context_cancel(signalled_context);
}

static void catch_signals(ag_context *context)
{
    signalled_context = context;
    for (size_t i = 0; i < sizeof CAUGHT / sizeof *CAUGHT; i++) {
        struct sigaction before, action = {.sa_handler = on_signal, .sa_flags = SA_RESTART};
        /* what nohup or a shell's & have set to be ignored stays so */
        if (sigaction(CAUGHT[i], NULL, &before) == 0 && before.sa_handler != SIG_IGN)
            sigaction(CAUGHT[i], &action, NULL);
    }
    /* a limit on file size is an error of the write, not the end */
    signal(SIGXFSZ, SIG_IGN);
    signal(SIGPIPE, SIG_IGN);
}

/* From here on there is no context to cancel. */
static void release_signals(void)
{
    sigset_t caught;
    sigemptyset(&caught);
    for (size_t i = 0; i < sizeof CAUGHT / sizeof *CAUGHT; i++)
        sigaddset(&caught, CAUGHT[i]);
    sigprocmask(SIG_BLOCK, &caught, NULL);
}

static int exit_code(ag_status status)
{
    switch (status) {
    case AG_OK: return 0;
    case AG_ERROR_INPUT:
    case AG_ERROR_SCENE:
    case AG_ERROR_COLOR: return 1;
    case AG_ERROR_ARGUMENT: return 2;
    case AG_CANCELLED: return caught_signal ? 128 + caught_signal : 3;
    case AG_ERROR_MEMORY:
    case AG_ERROR_OUTPUT:
    case AG_ERROR_RAY_TRACING:
    case AG_ERROR_SYSTEM: break;
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

static ag_status render(ag_context *context, const options *o, const ag_scene *scene,
                        const ag_render_settings *settings, ag_film **out_film)
{
    ag_rendering *rendering;
    ag_status status = ag_rendering_create(context, scene, settings, &rendering);
    if (status != AG_OK)
        return status;
    status = ag_rendering_continue(rendering, settings->samples_per_pixel);
    if (status == AG_OK && o->photons_file)
        status = ag_rendering_write_photons(rendering, o->photons_file);
    ag_rendering_finish(rendering, status == AG_OK ? out_film : NULL);
    if (status == AG_OK && settings->denoise)
        status = ag_film_denoise(context, *out_film);
    return status;
}

static ag_status list_displays(ag_context *context)
{
    const char *text;
    ag_status status = ag_color_summary(context, &text);
    if (status == AG_OK && (fputs(text, stdout) < 0 || fflush(stdout) != 0))
        status = AG_ERROR_OUTPUT;
    return status;
}

static ag_status run(ag_context *context, options *o)
{
    ag_status status = AG_OK;
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
    ag_film *film = NULL;
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
        status = render(context, o, scene, &settings, &film);
    }
    for (int i = 0; i < o->outfile_count && status == AG_OK; i++)
        status = ag_film_write(context, film, &o->output, o->outfiles[i]);
    if (status == AG_OK && o->stats)
        status = ag_statistics_write(context, o->stats);
    ag_film_destroy(film);
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
    catch_signals(context);
    status = run(context, &o);
    progress_finish(&told);
    if (status == AG_CANCELLED && o.verbosity >= 0)
        fprintf(stderr, "afterglow: interrupted: no picture was written\n");
    if (status == AG_ERROR_MEMORY || status == AG_ERROR_SYSTEM)
        fprintf(stderr, "afterglow: error: %s\n", ag_status_text(status));
    release_signals();
    ag_context_destroy(context);
    options_reset(&o);
    return exit_code(status);
}
