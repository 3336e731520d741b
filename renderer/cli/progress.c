/* progress.c: see progress.h. */
#define _POSIX_C_SOURCE 200809L
#include "progress.h"

#include "passes.h"

#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static pthread_mutex_t terminal = PTHREAD_MUTEX_INITIALIZER; /* one line at a time, from the log or from here */

void progress_init(progress *p, const options *o)
{
    *p = (progress){.style = o->progress, .verbosity = o->verbosity, .told_percent = -1, .phase = AG_PHASE_COUNT};
    if (p->style == PROGRESS_AUTO)
        p->style = o->verbosity < 0 ? PROGRESS_NONE : isatty(STDERR_FILENO) ? PROGRESS_BAR : PROGRESS_PLAIN;
    p->has_precompute = o->render.cache == AG_CACHE_PRECOMPUTE;
    p->is_path = o->render.integrator == AG_INTEGRATOR_PATH;
}

/* The whole work in percent: each phase has a share of it that is usual. */
static int overall_percent(const progress *p, ag_phase phase, double fraction)
{
    double shares[AG_PHASE_COUNT] = {
        [AG_PHASE_LOAD] = 2, [AG_PHASE_BVH] = 2, [AG_PHASE_RENDER] = 94, [AG_PHASE_WRITE] = 2};
    if (!p->is_path) {
        shares[AG_PHASE_PHOTONS] = 10;
        shares[AG_PHASE_MAP] = 3;
        shares[AG_PHASE_PRECOMPUTE] = p->has_precompute ? 25 : 0;
        shares[AG_PHASE_RENDER] = 81 - shares[AG_PHASE_PRECOMPUTE];
    }
    double done = shares[phase] * fraction;
    for (int i = 0; i < (int)phase; i++)
        done += shares[i];
    return (int)done;
}

void progress_begin_frame(progress *p, int frame, int frame_count)
{
    p->frame = frame;
    p->frame_count = frame_count;
    p->phase = AG_PHASE_COUNT;
}

/* Seconds until the phase is over, as it went so far; -1: not known yet. */
static double seconds_left(progress *p, ag_phase phase, double fraction)
{
    double now = passes_seconds();
    if (p->phase != phase) {
        p->phase = phase;
        p->phase_begun = now;
        p->phase_begun_at = fraction;
    }
    double done = fraction - p->phase_begun_at, took = now - p->phase_begun;
    return done >= 0.02 && took >= 0.5 ? took * (1.0 - fraction) / done : -1.0;
}

/* ", 1:23 left", or nothing. */
static const char *left_text(double seconds, char *out, size_t size)
{
    long whole = (long)(seconds + 0.5);
    if (seconds < 0.0)
        out[0] = '\0';
    else if (whole >= 3600)
        snprintf(out, size, ", %ld:%02ld:%02ld left", whole / 3600, whole / 60 % 60, whole % 60);
    else
        snprintf(out, size, ", %ld:%02ld left", whole / 60, whole % 60);
    return out;
}

static void clear_bar(progress *p)
{
    if (p->bar_is_shown)
        fputs("\r\033[K", stderr);
    p->bar_is_shown = false;
}

void progress_tell(void *user, ag_phase phase, double fraction)
{
    progress *p = user;
    pthread_mutex_lock(&terminal);
    int percent = (100 * p->frame + overall_percent(p, phase, fraction)) / (p->frame_count > 0 ? p->frame_count : 1);
    double left = seconds_left(p, phase, fraction);
    char left_for[48];
    bool is_new = percent > p->told_percent;
    if (is_new)
        p->told_percent = percent;
    switch (p->style) {
    case PROGRESS_BAR: {
        enum { WIDTH = 40 };
        char bar[WIDTH + 1];
        int filled = p->told_percent * WIDTH / 100;
        memset(bar, '.', WIDTH);
        memset(bar, '#', (size_t)(filled < WIDTH ? filled : WIDTH));
        bar[WIDTH] = '\0';
        fprintf(stderr, "\r\033[K%-10s [%s] %3d%%%s", ag_phase_name(phase), bar, p->told_percent,
                left_text(left, left_for, sizeof left_for));
        fflush(stderr);
        p->bar_is_shown = true;
        break;
    }
    case PROGRESS_PLAIN:
        if (is_new)
            fprintf(stderr, "Progress: %d%% (%s%s)\n", percent, ag_phase_name(phase),
                    left_text(left, left_for, sizeof left_for));
        break;
    case PROGRESS_ALF: /* as render queues read it, from standard output */
        if (is_new) {
            printf("ALF_PROGRESS %d%%\n", percent);
            fflush(stdout);
        }
        break;
    case PROGRESS_JSON:
        fprintf(stderr, "{\"phase\": \"%s\", \"fraction\": %.4f, \"percent\": %d", ag_phase_name(phase), fraction,
                p->told_percent);
        if (left >= 0.0)
            fprintf(stderr, ", \"seconds_left\": %.1f", left);
        fprintf(stderr, "}\n");
        break;
    case PROGRESS_AUTO:
    case PROGRESS_NONE: break;
    }
    pthread_mutex_unlock(&terminal);
}

void progress_log(void *user, ag_log_level level, const char *message)
{
    progress *p = user;
    if (level > AG_LOG_ERROR && (int)level > p->verbosity + 1)
        return;
    static const char *const prefixes[] = {"error: ", "warning: ", "", ""};
    static const char *const placed[] = {": error: ", ": warning: "};
    /* messages about a place in a file say themselves what they are */
    bool has_place = level <= AG_LOG_WARNING && strstr(message, placed[level]) != NULL;
    pthread_mutex_lock(&terminal);
    clear_bar(p);
    fprintf(stderr, "%s%s%s\n", has_place ? "" : "afterglow: ", has_place ? "" : prefixes[level], message);
    pthread_mutex_unlock(&terminal);
}

void progress_finish(progress *p)
{
    pthread_mutex_lock(&terminal);
    clear_bar(p);
    pthread_mutex_unlock(&terminal);
}
