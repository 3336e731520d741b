/* main.c: the program: scene -> picture -> files.
 * Threads: main alone. */
#define _POSIX_C_SOURCE 200809L
#include "display_server.h"
#include "file_conflicts.h"
#include "frame_options.h"
#include "large_stack.h"
#include "memory_limit.h"
#include "options.h"
#include "page_server.h"
#include "passes.h"
#include "picture_files.h"
#include "progress.h"
#include "signals.h"
#include "standard_files.h"
#include "status.h"
#include "summary.h"

#include <math.h>
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

/* The output where none is asked for: the scene's own file name, else the scene file's with .exr, in the working
 * directory. */
static void name_default_output(const options *o, const ag_scene *scene, int frame, char *out_name, size_t size)
{
    /* a confined scene does not say where it is written */
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
    if (strcmp(base, "-") == 0 || stem == 0) {
        base = "afterglow";
        stem = (int)strlen(base);
    }
    if (frame < 0)
        snprintf(out_name, size, "%.*s.exr", stem, base);
    else
        snprintf(out_name, size, "%.*s.%04d.exr", stem, base, frame);
}

static ag_status list_displays(ag_context *context)
{
    const char *text;
    AG_TRY(ag_color_summary(context, &text));
    return fputs(text, stdout) < 0 || fflush(stdout) != 0 ? AG_ERROR_OUTPUT : AG_OK;
}

/* Returns whether the picture is left out, since all its files are there; says so. */
static bool is_there(const options *o)
{
    const bool is_skipped = picture_files_are_there(o);
    if (is_skipped && o->verbosity >= 0)
        fprintf(stderr, "afterglow: skipped: '%s' is there\n", o->outfiles[0]);
    return is_skipped;
}

/* Returns the bytes that it takes to show the picture in a browser, which needs the film once more, or in the terminal.
 * p: the prediction without them. */
static uint64_t shown_bytes(const options *o, const ag_render_settings *settings, const ag_prediction *p)
{
    const double *crop = settings->crop_window;
    const double pixels = (crop[1] - crop[0]) * settings->width * (crop[3] - crop[2]) * settings->height;
    const int each =
        (o->page ? PAGE_BYTES_PER_PIXEL : 0) + (o->progress == PROGRESS_PICTURE ? FILM_WATCH_BYTES_PER_PIXEL : 0);
    const uint64_t film_bytes =
        p->memory_film_bytes / (settings->photon_map_file ? 2 : 1); /* with a kept map the film has a copy */
    return (uint64_t)(each * pixels) + (o->page ? film_bytes : 0);
}

/* Predicts the picture's memory before it is begun, and refuses it where --memory does not allow so much; prints the
 * whole prediction for --dry-run. Errors: AG_ERROR_SYSTEM (more memory than allowed, which sets *out_lacks_memory and
 * has been logged), those of the prediction. */
static ag_status predict(ag_context *context, const options *o, const ag_scene *scene,
                         const ag_render_settings *settings, bool *out_lacks_memory)
{
    ag_prediction prediction;
    if (o->memory_limit == 0 && !o->dry_run)
        return AG_OK;
    AG_TRY(ag_predict_memory(context, scene, settings, &prediction));
    ag_context_expect_host_memory(context, shown_bytes(o, settings, &prediction));
    AG_TRY(ag_predict_memory(context, scene, settings, &prediction));
    if (o->memory_limit > 0 && !memory_limit_holds(o->memory_limit, &prediction)) {
        ag_context_note_end(context, AG_END_MEMORY);
        *out_lacks_memory = true;
        return AG_ERROR_SYSTEM;
    }
    if (o->memory_limit > 0)
        memory_limit_set(o->memory_limit, true);
    if (!o->dry_run)
        return AG_OK;
    AG_TRY(ag_predict(context, scene, settings, &prediction));
    summary_print_prediction(stdout, &prediction, ag_context_statistics(context).texture_file_bytes);
    ag_context_note_end(context, AG_END_DRY_RUN);
    return fflush(stdout) == 0 ? AG_OK : AG_ERROR_OUTPUT;
}

/* Checks what was asked for, as far as that is possible without the scene, before any work. */
static ag_status check_options(ag_context *context, const options *o)
{
    if (file_conflicts_of_options(o))
        return AG_ERROR_ARGUMENT;
    for (int i = 0; i < o->outfile_count; i++) {
        const ag_output_settings output = options_output(o, i);
        AG_TRY(ag_output_check(context, &output, o->outfiles[i]));
    }
    if (o->stats)
        AG_TRY(ag_statistics_check(context, o->stats));
    if (o->photons_file)
        AG_TRY(ag_statistics_check(context, o->photons_file)); /* as for any file */
    if (o->render.photon_map_file)
        AG_TRY(ag_photon_map_check(context, o->render.photon_map_file));
    if ((o->photons_file || o->render.photon_map_file) && !ag_integrator_has_photons(o->render.integrator)) {
        fprintf(stderr, "afterglow: --%s: path tracing has no photons\n",
                o->photons_file ? "dump-photons" : "photon-map");
        return AG_ERROR_ARGUMENT;
    }
    return o->render.denoise ? ag_denoise_check(context) : AG_OK;
}

enum { NAME_SIZE = 4096 };

/* The state of a picture that is rendered. */
typedef struct picture_run {
    ag_context *context;
    options *o;
    int frame; /* -1: there are no frames */
    char default_name[NAME_SIZE];
    bool is_skipped;   /* for --no-clobber */
    bool lacks_memory; /* it needs more memory than there is, or than --memory allows */
} picture_run;

/* Gives a picture without an output file the name that belongs to its scene. */
static ag_status choose_output(picture_run *r, const ag_scene *scene)
{
    options *o = r->o;
    name_default_output(o, scene, r->frame, r->default_name, sizeof r->default_name);
    o->outfiles[o->outfile_count++] = r->default_name;
    const ag_status status = ag_output_check(r->context, &o->output, r->default_name);
    if (status != AG_OK) /* then the name is from the scene, not from the command line */
        return status == AG_ERROR_ARGUMENT ? AG_ERROR_SCENE : status;
    r->is_skipped = is_there(o);
    return !r->is_skipped && file_conflicts_of_options(o) ? AG_ERROR_ARGUMENT : AG_OK;
}

static ag_status render_scene(picture_run *r, const ag_scene *scene, passes_result *out_result)
{
    options *o = r->o;
    ag_render_settings settings;
    if (o->outfile_count == 0 && !o->photons_only)
        AG_TRY(choose_output(r, scene));
    if (r->is_skipped)
        return AG_OK;
    if (file_conflicts_with_scene(o, scene))
        return AG_ERROR_ARGUMENT;
    AG_TRY(ag_render_settings_from_scene(r->context, scene, &settings));
    if (!options_override(o, scene, &settings)) {
        fprintf(stderr, "afterglow: --tile: there are more tiles than rows\n");
        return AG_ERROR_ARGUMENT;
    }
    AG_TRY(predict(r->context, o, scene, &settings, &r->lacks_memory));
    if (o->dry_run)
        return AG_OK;
    return passes_render(r->context, o, scene, &settings, out_result);
}

/* Writes the statistics of a picture that was made, if only in part, or that lacked memory. */
static ag_status tell_statistics(picture_run *r, ag_status status, const passes_result *result)
{
    const options *o = r->o;
    const bool is_made = status == AG_OK || result->is_partial || result->is_complete;
    if (r->is_skipped)
        return status;
    if (is_made && !o->dry_run && o->verbosity >= 1) {
        ag_statistics statistics = ag_context_statistics(r->context);
        summary_print(stderr, &statistics);
    }
    /* whether the run was ended before there was any picture */
    const bool is_stopped = status == AG_CANCELLED && (signals_stop() || signals_is_time_up()) && !is_made;
    if (!o->stats || !(is_made || r->lacks_memory || is_stopped))
        return status;
    if (is_stopped) {
        ag_context_note_end(r->context, signals_stop() ? AG_END_SIGNAL : AG_END_TIME_LIMIT);
        ag_context_clear_cancel(r->context); /* for this file */
    }
    const ag_status written = ag_statistics_write(r->context, o->stats);
    return status == AG_OK ? written : status;
}

/* Errors: AG_ERROR_MEMORY where reading took more than --memory allows; those of ag_scene_load_as. */
static ag_status load_scene(ag_context *context, const options *o, const ag_scene_settings *asked, ag_scene **out_scene)
{
    if (o->memory_limit > 0)
        memory_limit_watch(o->memory_limit, context);
    const ag_status status = ag_scene_load_as(context, o->scene, asked, out_scene);
    if (!memory_limit_end_watch() || signals_stop() || signals_is_time_up())
        return status;
    ag_context_clear_cancel(context);
    if (status == AG_OK || status == AG_CANCELLED) { /* a signal may have come once the scene was read */
        ag_scene_destroy(*out_scene);
        *out_scene = NULL;
        return AG_ERROR_MEMORY;
    }
    return status;
}

/* Renders a picture; frame: -1 where there are no frames. */
static ag_status run(ag_context *context, options *o, int frame, passes_result *out_result)
{
    if (is_there(o))
        return AG_OK;
    AG_TRY(check_options(context, o));
    o->deadline = o->time_limit > 0.0 && !o->dry_run ? passes_seconds() + o->time_limit : INFINITY;
    signals_set_deadline(o->deadline);
    picture_run r = {.context = context, .o = o, .frame = frame};
    ag_scene *scene = NULL;
    ag_scene_settings asked = o->asked;
    asked.definitions = o->definitions;
    asked.definition_count = o->definition_count;
    ag_status status = load_scene(context, o, &asked, &scene);
    if (status == AG_OK)
        status = render_scene(&r, scene, out_result);
    if (status == AG_ERROR_MEMORY) {
        ag_context_note_end(context, AG_END_MEMORY);
        r.lacks_memory = true;
    }
    status = tell_statistics(&r, status, out_result);
    ag_scene_destroy(scene);
    return status;
}

static void tell_end(const options *o, ag_status status, const passes_result *result)
{
    const bool is_late = signals_is_time_up() && !signals_stop();
    if (status == AG_CANCELLED && is_late && result->samples.most > 0)
        fprintf(
            stderr,
            "afterglow: error: time limit: the picture is not complete: it has %.4g samples per pixel, from %d to %d\n",
            result->samples.mean, result->samples.least, result->samples.most);
    else if (status == AG_CANCELLED && is_late)
        fprintf(stderr, "afterglow: error: time limit: it was reached before there was anything to write\n");
    else if ((status == AG_CANCELLED || result->is_partial) && o->verbosity >= 0) {
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

/* Each picture has a context of its own, so that statistics are its own. in_out_last: NULL, or the context of the frame
 * before, or NULL there; it becomes this one's, to be destroyed. */
static ag_status run_in_context(options *o, int frame, progress *told, ag_context **in_out_last)
{
    ag_context *context;
    ag_status status = ag_context_create(&o->context, &context);
    if (status != AG_OK) {
        if (status != AG_ERROR_SYSTEM) /* the log has told those */
            fprintf(stderr, "afterglow: error: %s\n", ag_status_text(status));
        return status;
    }
    if (in_out_last) {
        ag_context_take_frame(context, *in_out_last);
        ag_context_destroy(*in_out_last);
        *in_out_last = NULL;
    }
    signals_catch(context);
    if (o->memory_limit > 0)
        memory_limit_set(o->memory_limit, false);
    passes_result result = {0};
    status = o->lists_displays ? list_displays(context) : run(context, o, frame, &result);
    progress_finish(told);
    tell_end(o, status, &result);
    signals_release();
    if (in_out_last)
        *in_out_last = context;
    else
        ag_context_destroy(context);
    memory_limit_lift();
    return status;
}

static ag_status run_frame(options *o, int index, progress *told, ag_context **in_out_last)
{
    const int frame = o->frames.numbers[index];
    options one;
    ag_status status = AG_ERROR_MEMORY;
    const bool is_named = frame_options_make(o, frame, &one);
    progress_begin_frame(told, index, o->frames.count, frame);
    if (is_named) {
        if (o->verbosity >= 1)
            fprintf(stderr, "afterglow: frame %d: %s\n", frame, one.scene);
        status = run_in_context(&one, frame, told, in_out_last);
    }
    frame_options_reset(&one, o->outfile_count);
    return status;
}

/* Renders one frame after the other; the first that fails, or that who watches stops, ends the run. */
static ag_status run_frames(options *o, progress *told, ag_context **in_out_last)
{
    AG_TRY(file_conflicts_of_frames(o));
    for (int i = 0; i < o->frames.count; i++) {
        AG_TRY(run_frame(o, i, told, in_out_last));
        if (signals_stop() && i + 1 < o->frames.count)
            return AG_CANCELLED; /* the signal came after this frame was complete */
        if (o->page && page_wishes_has_ended(page_server_wishes(o->page)) && i + 1 < o->frames.count) {
            if (o->verbosity >= 0)
                fprintf(stderr, "afterglow: stopped by who watched it: %d of %d frames\n", i + 1, o->frames.count);
            return AG_OK;
        }
    }
    return AG_OK;
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
    o.told = &told;
    o.context.log = progress_log;
    o.context.progress = progress_tell;
    o.context.user = &told;
    if (o.display_server && !(o.display = display_server_start(o.display_server, progress_log, &told)))
        progress_log(&told, AG_LOG_WARNING,
                     "--display-server: no thread can be had for it: no viewer is shown the picture");
    ag_status status = AG_OK;
    ag_context *last = NULL;
    if (o.serves)
        status = page_server_start(o.serve_address ? o.serve_address : "127.0.0.1", o.serve_port, &told, &o.page);
    if (status == AG_OK)
        status = o.frames.count > 0 ? run_frames(&o, &told, &last) : run_in_context(&o, -1, &told, NULL);
    progress_finish(&told); /* also where no context was made */
    ag_context_destroy(last);
    page_server_stop(o.page);
    display_server_stop(o.display);
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
