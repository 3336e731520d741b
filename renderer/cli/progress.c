/* progress.c: see progress.h. */
#define _POSIX_C_SOURCE 200809L
#include "progress.h"

#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static pthread_mutex_t terminal = PTHREAD_MUTEX_INITIALIZER; /* one line at a time, from the log or from here */

void progress_init(progress *p, const options *o)
{
    *p = (progress){.style = o->progress, .verbosity = o->verbosity, .told_percent = -1};
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
    int percent = overall_percent(p, phase, fraction);
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
        fprintf(stderr, "\r\033[K%-10s [%s] %3d%%", ag_phase_name(phase), bar, p->told_percent);
        fflush(stderr);
        p->bar_is_shown = true;
        break;
    }
    case PROGRESS_PLAIN:
        if (is_new)
            fprintf(stderr, "Progress: %d%% (%s)\n", percent, ag_phase_name(phase));
        break;
    case PROGRESS_JSON:
        fprintf(stderr, "{\"phase\": \"%s\", \"fraction\": %.4f, \"percent\": %d}\n", ag_phase_name(phase), fraction,
                p->told_percent);
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
