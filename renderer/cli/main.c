/* main.c: the program: scene -> picture -> files.
 * Threads: main alone. */
#define _POSIX_C_SOURCE 200809L
#include "file_conflicts.h"
#include "large_stack.h"
#include "memory_limit.h"
#include "options.h"
#include "passes.h"
#include "progress.h"
#include "signals.h"
#include "standard_files.h"
#include "summary.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
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
static void name_default_output(const options *o, const ag_scene *scene, int frame, char *out_name, size_t size)
{
    /* where a stranger's scene is written, the stranger does not say */
    const char *own = o->context.is_confined ? NULL : ag_scene_film_file_name(scene);
    if (own && frame < 0) {
        snprintf(out_name, size, "%s", own);
        return;
    }
    if (own) {
        const char *dot = strrchr(own, '.');
        char *named = frames_name(own, frame);
        if (named && frames_has_placeholder(own))
            snprintf(out_name, size, "%s", named);
        else /* the frames may have one name */
            snprintf(out_name, size, "%.*s.%04d%s", (int)(dot ? dot - own : (long)strlen(own)), own, frame,
                     dot ? dot : "");
        free(named);
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

/* Whether all that is to be written is there, and complete; says so. */
static bool is_there(const options *o)
{
    for (int i = 0; i < o->outfile_count; i++)
        if (!passes_is_complete(o->outfiles[i]))
            return false;
    if (o->outfile_count > 0 && o->verbosity >= 0)
        fprintf(stderr, "afterglow: skipped: '%s' is there\n", o->outfiles[0]);
    return o->outfile_count > 0;
}

/* What a picture will take, before it is begun: whether that is allowed, and where it is all that is asked for, what.
 * Errors: AG_ERROR_SYSTEM (more memory than --memory allows, which sets *out_lacks_memory; it has been said), those of
 * the prediction. */
static ag_status predict(ag_context *context, const options *o, const ag_scene *scene,
                         const ag_render_settings *settings, bool *out_lacks_memory)
{
    ag_prediction prediction;
    if (o->memory_limit == 0 && !o->dry_run)
        return AG_OK;
    ag_status status = ag_predict_memory(context, scene, settings, &prediction);
    if (status == AG_OK && o->memory_limit > 0 && !memory_limit_holds(o->memory_limit, &prediction)) {
        ag_context_note_end(context, AG_END_MEMORY);
        *out_lacks_memory = true;
        return AG_ERROR_SYSTEM;
    }
    if (status == AG_OK && o->memory_limit > 0)
        memory_limit_set(o->memory_limit, true);
    if (status != AG_OK || !o->dry_run)
        return status;
    status = ag_predict(context, scene, settings, &prediction);
    if (status != AG_OK)
        return status;
    summary_print_prediction(stdout, &prediction);
    ag_context_note_end(context, AG_END_DRY_RUN);
    return fflush(stdout) == 0 ? AG_OK : AG_ERROR_OUTPUT;
}

/* One picture; frame: -1 where there is none. */
static ag_status run(ag_context *context, options *o, int frame, progress *told, passes_result *out_result)
{
    ag_status status = AG_OK;
    o->begun = passes_seconds();
    if (o->no_clobber && is_there(o))
        return AG_OK;
    /* what was asked for is checked before the work */
    if (file_conflicts_of_options(o))
        return AG_ERROR_ARGUMENT;
    for (int i = 0; i < o->outfile_count && status == AG_OK; i++) {
        const ag_output_settings output = options_output(o, i);
        status = ag_output_check(context, &output, o->outfiles[i]);
    }
    if (status == AG_OK && o->stats)
        status = ag_statistics_check(context, o->stats);
    if (status == AG_OK && o->photons_file)
        status = ag_statistics_check(context, o->photons_file); /* as for any file */
    if (status == AG_OK && o->render.photon_map_file)
        status = ag_photon_map_check(context, o->render.photon_map_file);
    if (status == AG_OK && (o->photons_file || o->render.photon_map_file) &&
        o->render.integrator == AG_INTEGRATOR_PATH) {
        fprintf(stderr, "afterglow: --%s: path tracing has no photons\n",
                o->photons_file ? "dump-photons" : "photon-map");
        status = AG_ERROR_ARGUMENT;
    }
    if (status == AG_OK && o->render.denoise)
        status = ag_denoise_check(context);
    if (status != AG_OK)
        return status;

    ag_scene *scene = NULL;
    ag_render_settings settings;
    char default_name[4096];
    bool is_skipped = false;
    ag_scene_settings asked = o->asked;
    asked.definitions = o->definitions;
    asked.definition_count = o->definition_count;
    status = ag_scene_load_as(context, o->scene, &asked, &scene);
    if (status == AG_OK && o->outfile_count == 0 && !o->photons_only) {
        name_default_output(o, scene, frame, default_name, sizeof default_name);
        o->outfiles[o->outfile_count++] = default_name;
        status = ag_output_check(context, &o->output, default_name);
        if (status == AG_ERROR_ARGUMENT)
            status = AG_ERROR_SCENE; /* the name is the scene's, not the command line's */
        is_skipped = status == AG_OK && o->no_clobber && is_there(o);
        if (status == AG_OK && !is_skipped && file_conflicts_of_options(o))
            status = AG_ERROR_ARGUMENT;
    }
    if (status == AG_OK && !is_skipped && file_conflicts_with_scene(o, scene))
        status = AG_ERROR_ARGUMENT;
    if (status == AG_OK && !is_skipped)
        status = ag_render_settings_from_scene(context, scene, &settings);
    if (status == AG_OK && !is_skipped && !options_override(o, scene, &settings)) {
        fprintf(stderr, "afterglow: --tile: there are more tiles than rows\n");
        status = AG_ERROR_ARGUMENT;
    }
    bool lacks_memory = false;
    if (status == AG_OK && !is_skipped)
        status = predict(context, o, scene, &settings, &lacks_memory);
    if (status == AG_OK && !is_skipped && !o->dry_run) {
        status = passes_render(context, o, scene, &settings, out_result);
        if (status == AG_OK && !o->photons_only)
            progress_tell_written(told, o->outfiles, o->outfile_count);
    }
    if (status == AG_ERROR_MEMORY) {
        ag_context_note_end(context, AG_END_MEMORY);
        lacks_memory = true;
    }
    if ((status == AG_OK || out_result->is_partial) && !is_skipped && !o->dry_run && o->verbosity >= 1) {
        ag_statistics statistics = ag_context_statistics(context);
        summary_print(stderr, &statistics);
    }
    if ((status == AG_OK || out_result->is_partial || lacks_memory) && !is_skipped && o->stats) {
        ag_status written = ag_statistics_write(context, o->stats);
        status = status == AG_OK ? written : status;
    }
    ag_scene_destroy(scene);
    return status;
}

static void tell_end(const options *o, ag_status status, const passes_result *result)
{
    if (status == AG_CANCELLED && o->verbosity >= 0) {
        if (result->is_partial && result->samples.most > 0)
            fprintf(stderr, "afterglow: interrupted: the picture has %.4g samples per pixel, from %d to %d\n",
                    result->samples.mean, result->samples.least, result->samples.most);
        else
            fprintf(stderr, "afterglow: interrupted: no picture was written\n");
    }
    if (status == AG_ERROR_MEMORY) /* the log says what else there is to say */
        fprintf(stderr, "afterglow: error: %s%s\n", ag_status_text(status),
                o->memory_limit > 0 ? ": --memory allows no more" : "");
}

/* Each picture has a context of its own, so that statistics are its own. */
static ag_status run_in_context(options *o, int frame, progress *told)
{
    ag_context *context;
    ag_status status = ag_context_create(&o->context, &context);
    if (status != AG_OK) {
        fprintf(stderr, "afterglow: error: %s\n", ag_status_text(status));
        return status;
    }
    signals_catch(context);
    if (o->memory_limit > 0)
        memory_limit_set(o->memory_limit, false);
    passes_result result = {0};
    status = o->lists_displays ? list_displays(context) : run(context, o, frame, told, &result);
    progress_finish(told);
    tell_end(o, status, &result);
    signals_release();
    ag_context_destroy(context);
    memory_limit_lift();
    return status;
}

/* The definitions of one frame: its number in their values, and as "frame" where that is not defined. */
static bool define_frame(const options *o, int frame, options *one)
{
    char number[16];
    snprintf(number, sizeof number, "%d", frame);
    one->definition_count = 0;
    one->definitions = calloc(o->definition_count + 1, sizeof *one->definitions);
    bool is_whole = one->definitions != NULL, is_named = false;
    for (size_t i = 0; is_whole && i < o->definition_count; i++) {
        const ag_definition *from = &o->definitions[i];
        ag_definition *to = &one->definitions[one->definition_count++];
        is_named = is_named || strcmp(from->name, "frame") == 0;
        *to = (ag_definition){.name = strdup(from->name), .value = frames_name(from->value, frame)};
        is_whole = to->name && to->value;
    }
    if (is_whole && !is_named) {
        ag_definition *to = &one->definitions[one->definition_count++];
        *to = (ag_definition){.name = strdup("frame"), .value = strdup(number), .is_optional = true};
        is_whole = to->name && to->value;
    }
    return is_whole;
}

/* The options of one frame: its number in all names. The strings are to be freed. */
static bool name_frame(const options *o, int frame, options *out_one)
{
    options one = *o;
    bool is_whole = define_frame(o, frame, &one);
    one.outfiles = calloc((size_t)o->outfile_count + 1, sizeof *one.outfiles);
    for (int i = 0; one.outfiles && i < o->outfile_count; i++)
        is_whole = (one.outfiles[i] = frames_name(o->outfiles[i], frame)) && is_whole;
    one.scene = frames_name(o->scene, frame);
    one.seed_pattern = o->seed_pattern ? frames_name(o->seed_pattern, frame) : NULL;
    one.frame = frame;
    one.stats = o->stats ? frames_name(o->stats, frame) : NULL;
    one.photons_file = o->photons_file ? frames_name(o->photons_file, frame) : NULL;
    *out_one = one;
    return is_whole && one.outfiles && one.scene && (one.stats || !o->stats) &&
           (one.photons_file || !o->photons_file) && (one.seed_pattern || !o->seed_pattern);
}

static void free_frame(options *one, int outfile_count)
{
    for (int i = 0; one->outfiles && i < outfile_count; i++)
        free((void *)(uintptr_t)one->outfiles[i]);
    free((void *)one->outfiles);
    free((void *)(uintptr_t)one->scene);
    free((void *)(uintptr_t)one->stats);
    free((void *)(uintptr_t)one->photons_file);
    free((void *)(uintptr_t)one->seed_pattern);
    for (size_t i = 0; i < one->definition_count; i++)
        options_free_definition(&one->definitions[i]);
    free(one->definitions);
}

/* One after the other; the first that fails ends it. */
static ag_status run_frames(options *o, progress *told)
{
    ag_status status = AG_OK;
    for (int i = 0; i < o->frames.count && status == AG_OK; i++) {
        options one;
        status = name_frame(o, o->frames.numbers[i], &one) ? AG_OK : AG_ERROR_MEMORY;
        progress_begin_frame(told, i, o->frames.count, o->frames.numbers[i]);
        if (status == AG_OK && o->verbosity >= 1)
            fprintf(stderr, "afterglow: frame %d: %s\n", o->frames.numbers[i], one.scene);
        if (status == AG_OK)
            status = run_in_context(&one, o->frames.numbers[i], told);
        free_frame(&one, o->outfile_count);
        if (status == AG_OK && signals_stop() && i + 1 < o->frames.count)
            status = AG_CANCELLED; /* it came when this one was complete */
    }
    return status;
}

static int run_program(int argc, char **argv)
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
    ag_status status = o.frames.count > 0 ? run_frames(&o, &told) : run_in_context(&o, -1, &told);
    options_reset(&o);
    return exit_code(status);
}

int main(int argc, char **argv)
{
    if (!standard_files_fill())
        return 3; /* there is nobody to tell */
    signals_catch_abort();
    return large_stack_call(run_program, argc, argv);
}
