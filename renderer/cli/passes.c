/* passes.c: see passes.h. */
#define _POSIX_C_SOURCE 200809L
#include "passes.h"

#include "display_server.h"
#include "memory_limit.h"
#include "picture_files.h"
#include "picture_mark.h"
#include "progress.h"
#include "signals.h"
#include "status.h"
#include "walk.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

typedef struct passes {
    ag_context *context;
    const options *o;
    ag_rendering *rendering;
    ag_rendering *kept;         /* the view from elsewhere that is written instead; NULL: none */
    char *checkpoint;           /* its file; NULL: none is asked for */
    double checkpoint_interval; /* seconds; INFINITY: at signals alone */
    double next_checkpoint;     /* when, in seconds of passes_seconds() */
    double mean_at_checkpoint;  /* samples per pixel there were at the last one */
    double begun;               /* when rendering began, in seconds of passes_seconds() */
    int final;                  /* samples per pixel in the end */
    bool is_view;               /* what is written is another view of a picture that was complete before */
    bool *is_written;           /* of each outfile, as by picture_files_write; owned */
    ag_status unwritten;        /* AG_OK, or AG_ERROR_OUTPUT: a file is missing in the end, which has been told */
    ag_end cut;                 /* AG_END_TIME_LIMIT, AG_END_KEPT: it ends with fewer; else AG_END_NONE */
} passes;

double passes_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* --- pictures --- */

static ag_status write_pictures(const passes *p, const ag_film *film, bool is_last)
{
    return picture_files_write(p->context, p->o, film, is_last, p->is_view, p->is_written);
}

/* Notes, for the end of the run, that a file could not be written; the other files are written all the same. */
static ag_status note_unwritten(passes *p, ag_status status)
{
    if (status != AG_ERROR_OUTPUT)
        return status;
    p->unwritten = status;
    return AG_OK;
}

static ag_status write_snapshot(passes *p)
{
    ag_sample_counts samples = ag_rendering_sample_counts(p->rendering);
    if (samples.most == 0)
        return AG_OK; /* nothing to show yet */
    AG_TRY(write_pictures(p, ag_rendering_film(p->rendering), false));
    if (p->o->verbosity >= 0)
        fprintf(stderr, "afterglow: snapshot: %.4g of %d samples per pixel\n", samples.mean, p->final);
    return AG_OK;
}

/* --- checkpoints --- */

static ag_status write_checkpoint(passes *p)
{
    /* a pause loses the samples under way, so with an interval too short for a sample the run would never end */
    double mean = ag_rendering_sample_counts(p->rendering).mean;
    if (mean <= p->mean_at_checkpoint)
        p->checkpoint_interval *= 2.0;
    p->mean_at_checkpoint = mean;
    ag_status status = ag_rendering_write_checkpoint(p->rendering, p->checkpoint);
    p->next_checkpoint = passes_seconds() + p->checkpoint_interval;
    return status;
}

static ag_status resume(passes *p)
{
    if (access(p->checkpoint, F_OK) != 0 && errno == ENOENT) {
        if (p->o->verbosity >= 0)
            fprintf(stderr, "afterglow: no checkpoint '%s': beginning anew\n", p->checkpoint);
        return AG_OK;
    }
    AG_TRY(ag_rendering_read_checkpoint(p->rendering, p->checkpoint));
    if (p->o->verbosity >= 0)
        fprintf(stderr, "afterglow: resumed from '%s': %.4g of %d samples per pixel are there\n", p->checkpoint,
                ag_rendering_sample_counts(p->rendering).mean, p->final);
    return AG_OK;
}

/* --- the passes --- */

/* The whole picture is brought to 1 sample, then to 4, to 16, ...: what there is when a render ends early is a picture
 * of one quality. Previews take smaller steps. */
enum { PASS_GROWTH = 4, PREVIEW_GROWTH = 2 };
/* A pass is planned to take so much of the time that is left: a machine is not always as fast as before. */
static const double PLANNED_SHARE = 0.9;

/* Who watches by a browser sees layers, counters and noise after each pass, and keeps what whole passes have brought:
 * one takes no longer than this, or than this share of the time that all have taken. */
static const double WATCHED_SECONDS = 1.0, WATCHED_SHARE = 0.1;

/* The samples after which the next pass ends; 0: there is no time for one more. */
static int next_pass(const passes *p, int samples, double seconds_per_sample)
{
    int growth = p->o->preview ? PREVIEW_GROWTH : PASS_GROWTH;
    int next = samples <= p->final / growth ? samples * growth : p->final;
    if (p->o->page && seconds_per_sample > 0.0) {
        const double seconds = fmax(WATCHED_SECONDS, WATCHED_SHARE * (passes_seconds() - p->begun));
        next = (int)fmin(next, samples + fmax(1.0, seconds / seconds_per_sample));
    }
    double affordable = PLANNED_SHARE * (p->o->deadline - passes_seconds()) / fmax(seconds_per_sample, 1e-9);
    if (affordable >= next - samples)
        return next;
    return affordable >= 1.0 ? samples + (int)affordable : 0;
}

/* Shows the picture itself in a browser from now on. Where there is no memory for that, it is rendered all the same. */
static ag_status show_page(const passes *p, page_mode mode)
{
    const options *o = p->o;
    if (!o->page)
        return AG_OK;
    const page_notes notes = walk_notes(p->rendering, mode, p->final);
    const ag_status status = page_server_show(o->page, p->context, p->rendering, &o->output, &notes);
    if (status != AG_ERROR_MEMORY)
        return status;
    progress_log(o->told, AG_LOG_WARNING, "--serve: there is no memory to show the picture");
    page_wishes_attend(page_server_wishes(o->page), p->context);
    return AG_OK;
}

/* Goes for a walk where that is wished for; back from it the picture is shown again, or p->kept is there. */
static ag_status walk_about(passes *p, page_mode mode)
{
    const walk w = {p->context, p->o, p->rendering, p->final};
    if (!p->o->page || !page_wishes_has_move(page_server_wishes(p->o->page)))
        return AG_OK;
    AG_TRY(walk_run(&w, &p->kept));
    if (!p->kept && show_page(p, mode) != AG_OK)
        progress_log(p->o->told, AG_LOG_WARNING, "--serve: the picture is rendered, and can be shown no more");
    return AG_OK;
}

/* Returns whether those who watch want the end, and there is something to keep: a view from elsewhere, or a picture of
 * whole passes, which the film then is. */
static bool is_kept(const passes *p, ag_status status)
{
    if (!p->o->page || !page_wishes_has_end(page_server_wishes(p->o->page)))
        return false;
    return p->kept || status == AG_OK || ag_rendering_go_back(p->rendering) == AG_OK;
}

/* Tells those who watch how far the picture is. */
static void note_page(const passes *p)
{
    if (!p->o->page || p->kept)
        return;
    const page_notes notes = walk_notes(p->rendering, PAGE_RENDERING, p->final);
    page_server_note(p->o->page, &notes);
}

/* Writes what is due in a pause or after a pass: a snapshot or preview, and a checkpoint; tells who watches. What
 * cannot be written on the way does not end the render: the disk may have room again when the picture is complete. */
static ag_status serve(passes *p, bool is_after_pass)
{
    ag_status shown = AG_OK, saved = AG_OK;
    note_page(p);
    if (signals_take_snapshot())
        shown = write_snapshot(p);
    else if (is_after_pass && p->o->preview)
        shown = write_pictures(p, ag_rendering_film(p->rendering), false);
    if (passes_seconds() >= p->next_checkpoint)
        saved = write_checkpoint(p);
    if (shown == AG_ERROR_OUTPUT || saved == AG_ERROR_OUTPUT)
        progress_log(p->o->told, AG_LOG_WARNING, "rendering goes on without this file");
    if (shown != AG_OK && shown != AG_ERROR_OUTPUT)
        return shown;
    return saved == AG_ERROR_OUTPUT ? AG_OK : saved;
}

/* The time is up within a pass, or between two. AG_PAUSED: there are pixels without a sample, so it is no picture. */
static ag_status end_in_time(passes *p, ag_status status)
{
    p->cut = AG_END_TIME_LIMIT;
    if (status == AG_OK ||
        ag_rendering_go_back(p->rendering) == AG_OK) /* whole passes are better, where they are kept */
        return AG_OK;
    return ag_rendering_sample_counts(p->rendering).least > 0 ? AG_OK : AG_PAUSED;
}

/* AG_PAUSED: a signal wants the end, or the time is up and there is no whole picture yet. */
static ag_status run_passes(passes *p)
{
    int samples = 1;
    double rendered = 0.0; /* seconds of this pass, and samples per pixel that they brought */
    double before = ag_rendering_sample_counts(p->rendering).mean;
    for (;;) {
        double begun = passes_seconds();
        signals_set_timer(p->next_checkpoint - begun);
        ag_status status = ag_rendering_continue(p->rendering, samples);
        rendered += passes_seconds() - begun;
        if (status != AG_OK && status != AG_PAUSED)
            return status;
        if (status == AG_OK && samples == p->final)
            return AG_OK;
        AG_TRY(walk_about(p, PAGE_RENDERING));
        if (signals_stop())
            return AG_PAUSED;
        if (is_kept(p, status)) {
            p->cut = AG_END_KEPT;
            return AG_OK;
        }
        if (signals_is_time_up())
            return end_in_time(p, status);
        AG_TRY(serve(p, status == AG_OK));
        if (status != AG_OK)
            continue;
        ag_sample_counts counts = ag_rendering_sample_counts(p->rendering);
        double mean = counts.mean;
        if (counts.most < samples) { /* no pixel needs more */
            samples = p->final;
            continue;
        }
        samples = next_pass(p, samples, mean > before ? rendered / (mean - before) : 0.0);
        if (samples == 0) {
            p->cut = AG_END_TIME_LIMIT;
            return AG_OK;
        }
        rendered = 0.0;
        before = mean;
    }
}

static ag_status begin(passes *p, const ag_scene *scene, const ag_render_settings *settings)
{
    const options *o = p->o;
    p->is_written = calloc((size_t)o->outfile_count + 1, sizeof *p->is_written);
    if (!p->is_written)
        return AG_ERROR_MEMORY;
    if (o->checkpoint_seconds > 0.0 || o->resume) {
        p->checkpoint = picture_mark_checkpoint(o->outfiles[0]);
        if (!p->checkpoint)
            return AG_ERROR_MEMORY;
        AG_TRY(ag_statistics_check(p->context, p->checkpoint)); /* as for any file */
    }
    if (!o->photons_only)
        AG_TRY(progress_prepare_film(o->told, p->context, &o->output));
    AG_TRY(ag_rendering_create(p->context, scene, settings, &p->rendering));
    if (o->page)
        AG_TRY(ag_rendering_keep_passes(p->rendering));
    if (o->resume)
        AG_TRY(resume(p));
    p->begun = passes_seconds();
    p->checkpoint_interval = o->checkpoint_seconds > 0.0 ? o->checkpoint_seconds : INFINITY;
    p->next_checkpoint = passes_seconds() + p->checkpoint_interval;
    p->mean_at_checkpoint = ag_rendering_sample_counts(p->rendering).mean;
    return AG_OK;
}

/* Tells the noise that is left beside what was asked for, and what would help most. */
static void tell_noise(const ag_noise *noise, const ag_sample_counts *samples, const ag_render_settings *settings)
{
    if (noise->level < 0.0)
        return;
    fprintf(stderr, "afterglow: noise: %.2g, where white is 1; %.4g samples per pixel", noise->level, samples->mean);
    if (settings->noise_level > 0.0f)
        fprintf(stderr, ", from %d to %d, for --noise %g", samples->least, samples->most,
                (double)settings->noise_level);
    if (noise->hint[0])
        fprintf(stderr, "\nafterglow: noise: %s", noise->hint);
    fputc('\n', stderr);
}

static ag_end find_end(const passes *p, const passes_result *result)
{
    if (p->cut != AG_END_NONE)
        return p->cut;
    if (result->is_partial)
        return AG_END_SIGNAL;
    if (p->o->photons_only)
        return AG_END_PHOTONS;
    return result->samples.most < p->final ? AG_END_NOISE : AG_END_SAMPLES;
}

/* Runs the passes. *out_failed: AG_OK, or why the picture shown is not complete. */
static ag_status render(passes *p, passes_result *out_result, ag_noise *out_noise, ag_status *out_failed)
{
    ag_status status = p->o->photons_only ? AG_OK : run_passes(p);
    out_result->is_partial = status == AG_PAUSED;
    signals_set_deadline(INFINITY); /* the picture is written, however long that takes */
    if (status == AG_PAUSED)
        status = AG_OK;
    if (status == AG_ERROR_SYSTEM && ag_rendering_sample_counts(p->rendering).most > 0) {
        *out_failed = status; /* the photon map was lost: what the passes before have rendered is shown */
        status = AG_OK;
    }
    if (status == AG_OK && p->checkpoint && (out_result->is_partial || p->cut != AG_END_NONE))
        status = note_unwritten(p, write_checkpoint(p));
    out_result->samples = ag_rendering_sample_counts(p->rendering);
    *out_noise = ag_rendering_noise(p->rendering);
    ag_context_note_end(p->context, find_end(p, out_result));
    note_page(p);
    return status;
}

/* Denoises and writes the pictures of a finished rendering, and tells of them. */
static ag_status show(passes *p, ag_film *film, const ag_render_settings *settings, const passes_result *result,
                      const ag_noise *noise, ag_status failed)
{
    const options *o = p->o;
    const bool has_picture = !o->photons_only && (!result->is_partial || result->samples.most > 0);
    ag_status written = AG_OK;
    if (settings->denoise && has_picture) {
        memory_limit_lift(); /* the prediction does not cover the denoiser's memory */
        AG_TRY(ag_film_denoise(p->context, film));
    }
    if (has_picture) {
        written = write_pictures(p, film, !result->is_partial && failed == AG_OK);
        AG_TRY(note_unwritten(p, written));
        progress_leave_film(o->told, true); /* messages from here on stand below the picture */
    }
    if (failed != AG_OK) {
        fprintf(stderr, "afterglow: error: the picture is not complete: it has %.4g of %d samples per pixel\n",
                result->samples.mean, p->final);
        return failed;
    }
    if (p->checkpoint && !result->is_partial && p->cut == AG_END_NONE && written == AG_OK)
        unlink(p->checkpoint); /* it has served */
    if (p->cut != AG_END_NONE && !result->is_partial && o->verbosity >= 0)
        fprintf(stderr, "afterglow: %s: the picture has %.4g of %d samples per pixel\n",
                p->cut == AG_END_KEPT ? "stopped by who watched it" : "time limit", result->samples.mean, p->final);
    if (has_picture && o->verbosity >= (settings->noise_level > 0.0f ? 0 : 1))
        tell_noise(noise, &result->samples, settings);
    return AG_OK;
}

static bool is_last_frame(const options *o)
{
    return o->frames.count == 0 || o->frame == o->frames.numbers[o->frames.count - 1];
}

/* Whether somebody looks at the finished picture in a browser: he is not interrupted, as long as he does; but the next
 * picture does not wait, nor does the time limit. */
static bool is_looked_at(const passes *p)
{
    const options *o = p->o;
    if (!o->page || !is_last_frame(o) || p->kept || signals_stop() || passes_seconds() >= o->deadline)
        return false;
    page_wishes *wishes = page_server_wishes(o->page);
    return page_wishes_is_watched(wishes, PAGE_PATIENCE_SECONDS) && !page_wishes_has_end(wishes);
}

static ag_status await_page(passes *p)
{
    page_server_set_mode(p->o->page, PAGE_FINISHED);
    while (is_looked_at(p)) {
        page_wishes *wishes = page_server_wishes(p->o->page);
        page_wishes_wait(wishes, PAGE_LOOK_SECONDS);
        AG_TRY(walk_about(p, PAGE_FINISHED));
        (void)page_wishes_take_return(wishes);
        if (!p->kept && page_wishes_take_layers(wishes))
            page_server_copy_layers(p->o->page);
    }
    return AG_OK;
}

/* Lets go of the film. The viewer is waited for within the time limit. */
static void leave_watchers(const passes *p)
{
    page_server_leave(p->o->page, is_last_frame(p->o) ? PAGE_FINISHED : PAGE_WAITING);
    display_server_leave(p->o->display, fmax(p->o->deadline - passes_seconds(), 0.0));
}

/* Shows the film from now on wherever it is wanted. */
static ag_status show_to_watchers(const passes *p)
{
    const ag_film *film = ag_rendering_film(p->rendering);
    AG_TRY(progress_show_film(p->o->told, film));
    AG_TRY(show_page(p, PAGE_RENDERING));
    display_server_show(p->o->display, film, p->o->outfiles[0]);
    return AG_OK;
}

static void end_rendering(passes *p, ag_film **out_film)
{
    page_server_end_rendering(p->o->page);
    ag_rendering_finish(p->rendering, out_film);
    p->rendering = NULL;
}

/* Writes the picture once more, with the memory that was kept for who watches. */
static ag_status write_unwatched(passes *p, const ag_render_settings *settings, const passes_result *result,
                                 const ag_noise *noise, ag_film *out_films[2])
{
    progress_log(p->o->told, AG_LOG_WARNING,
                 "--serve: there is no memory to write the picture while it is watched: it is shown no more");
    page_server_empty_film(p->o->page);
    if (p->rendering)
        end_rendering(p, &out_films[0]);
    return show(p, out_films[0], settings, result, noise, AG_OK);
}

/* Writes the picture, and if it is wished for the view that somebody has walked to. Its rendering ends before the files
 * are written, which takes memory, unless somebody looks on and there is memory enough. *out_films: to be destroyed
 * when nobody watches. */
static ag_status write_and_wait(passes *p, const ag_render_settings *settings, passes_result *result, ag_noise *noise,
                                ag_status failed, ag_film *out_films[2])
{
    bool stays = is_looked_at(p) && !p->o->photons_only && !result->is_partial && failed == AG_OK;
    ag_status status = AG_OK;
    if (!stays)
        end_rendering(p, &out_films[0]);
    /* the film of a rendering that has ended, or that is continued no more */
    ag_film *film = stays ? (ag_film *)(uintptr_t)ag_rendering_film(p->rendering) : out_films[0];
    if (!p->kept) {
        status = show(p, film, settings, result, noise, failed);
        if (status == AG_ERROR_MEMORY && p->o->page && !p->o->photons_only && failed == AG_OK) {
            stays = false;
            status = write_unwatched(p, settings, result, noise, out_films);
        }
        progress_leave_film(p->o->told, false);
        p->is_view = true; /* what may be written from here on */
    }
    if (status == AG_OK && stays)
        status = await_page(p);
    if (stays)
        end_rendering(p, &out_films[0]);
    if (status != AG_OK || !p->kept)
        return status;
    p->cut = AG_END_KEPT;
    result->samples = ag_rendering_sample_counts(p->kept);
    *noise = ag_rendering_noise(p->kept);
    ag_context_note_end(p->context, AG_END_KEPT);
    ag_rendering_finish(p->kept, &out_films[1]);
    p->kept = NULL;
    return show(p, out_films[1], settings, result, noise, failed);
}

ag_status passes_render(ag_context *context, const options *o, const ag_scene *scene,
                        const ag_render_settings *settings, passes_result *out_result)
{
    passes p = {.context = context, .o = o, .final = settings->samples_per_pixel};
    ag_film *films[2] = {NULL, NULL};
    ag_noise noise = {.level = -1.0};
    ag_status failed = AG_OK;
    *out_result = (passes_result){0};
    ag_status status = begin(&p, scene, settings);
    if (status == AG_OK && !o->photons_only)
        status = show_to_watchers(&p);
    if (status == AG_OK) {
        signals_begin_rendering(); /* until all is written, so that no signal loses what was rendered */
        status = render(&p, out_result, &noise, &failed);
    }
    if (status == AG_OK && o->photons_file && !out_result->is_partial && failed == AG_OK)
        status = note_unwritten(&p, ag_rendering_write_photons(p.rendering, o->photons_file));
    if (status == AG_OK)
        status = write_and_wait(&p, settings, out_result, &noise, failed, films);
    progress_leave_film(o->told, false);
    leave_watchers(&p); /* only once the files are written, which do not wait for a viewer */
    ag_rendering_finish(p.rendering, NULL);
    ag_rendering_finish(p.kept, NULL);
    signals_end_rendering();
    ag_film_destroy(films[0]);
    ag_film_destroy(films[1]);
    free(p.checkpoint);
    if (p.is_written)
        progress_tell_written(o->told, o->outfiles, p.is_written, o->outfile_count);
    free(p.is_written);
    out_result->is_complete = status == AG_OK && !out_result->is_partial;
    if (status == AG_OK)
        status = p.unwritten;
    return status == AG_OK && out_result->is_partial ? AG_CANCELLED : status;
}
