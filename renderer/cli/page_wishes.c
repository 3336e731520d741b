/* page_wishes.c: see page_wishes.h. */
#define _POSIX_C_SOURCE 200809L
#include "page_wishes.h"

#include "passes.h"

#include <math.h>
#include <time.h>

bool page_wishes_init(page_wishes *w)
{
    pthread_condattr_t attributes;
    *w = (page_wishes){.heard_seconds = -1.0};
    if (pthread_condattr_init(&attributes) != 0)
        return false;
    const bool is_made = pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC) == 0 &&
                         pthread_cond_init(&w->changed, &attributes) == 0;
    pthread_condattr_destroy(&attributes);
    if (is_made && pthread_mutex_init(&w->lock, NULL) == 0)
        return true;
    if (is_made)
        pthread_cond_destroy(&w->changed);
    return false;
}

void page_wishes_reset(page_wishes *w)
{
    pthread_cond_destroy(&w->changed);
    pthread_mutex_destroy(&w->lock);
}

/* --- requests --- */

/* Notes a wish, and pauses the rendering so that main looks at it. */
static void wish(page_wishes *w, bool *which)
{
    *which = true;
    if (w->context)
        ag_context_pause(w->context);
    pthread_cond_broadcast(&w->changed);
}

void page_wishes_end(page_wishes *w)
{
    pthread_mutex_lock(&w->lock);
    w->has_ended = true;
    wish(w, &w->wants_end);
    pthread_mutex_unlock(&w->lock);
}

void page_wishes_return(page_wishes *w)
{
    pthread_mutex_lock(&w->lock);
    w->wants_move = false;
    wish(w, &w->wants_return);
    pthread_mutex_unlock(&w->lock);
}

void page_wishes_move(page_wishes *w, const page_place *place)
{
    pthread_mutex_lock(&w->lock);
    w->place = *place;
    w->wants_return = false;
    wish(w, &w->wants_move);
    pthread_mutex_unlock(&w->lock);
}

void page_wishes_layers(page_wishes *w)
{
    pthread_mutex_lock(&w->lock);
    if (!w->wants_layers)
        wish(w, &w->wants_layers);
    pthread_mutex_unlock(&w->lock);
}

void page_wishes_hear(page_wishes *w)
{
    pthread_mutex_lock(&w->lock);
    w->heard_seconds = passes_seconds();
    pthread_mutex_unlock(&w->lock);
}

/* --- main --- */

void page_wishes_attend(page_wishes *w, ag_context *context)
{
    pthread_mutex_lock(&w->lock);
    w->context = context;
    if (!context)
        w->wants_end = w->wants_return = w->wants_move = w->wants_layers = false;
    pthread_mutex_unlock(&w->lock);
}

static bool look(page_wishes *w, bool *which, bool is_taken)
{
    pthread_mutex_lock(&w->lock);
    const bool wanted = *which;
    if (is_taken)
        *which = false;
    pthread_mutex_unlock(&w->lock);
    return wanted;
}

bool page_wishes_has_end(page_wishes *w) { return look(w, &w->wants_end, false); }

bool page_wishes_has_ended(page_wishes *w) { return look(w, &w->has_ended, false); }

bool page_wishes_has_move(page_wishes *w) { return look(w, &w->wants_move, false); }

bool page_wishes_take_return(page_wishes *w) { return look(w, &w->wants_return, true); }

bool page_wishes_take_layers(page_wishes *w) { return look(w, &w->wants_layers, true); }

bool page_wishes_take_move(page_wishes *w, page_place *out_place)
{
    pthread_mutex_lock(&w->lock);
    const bool wanted = w->wants_move;
    w->wants_move = false;
    if (wanted)
        *out_place = w->place;
    pthread_mutex_unlock(&w->lock);
    return wanted;
}

void page_wishes_wait(page_wishes *w, double seconds)
{
    const double end = passes_seconds() + seconds;
    const struct timespec until = {.tv_sec = (time_t)end, .tv_nsec = (long)((end - floor(end)) * 1e9)};
    pthread_mutex_lock(&w->lock);
    while (!(w->wants_end || w->wants_return || w->wants_move || w->wants_layers) && passes_seconds() < end)
        if (pthread_cond_timedwait(&w->changed, &w->lock, &until) != 0)
            break;
    pthread_mutex_unlock(&w->lock);
}

bool page_wishes_is_watched(page_wishes *w, double seconds)
{
    pthread_mutex_lock(&w->lock);
    const bool is_watched = w->heard_seconds >= 0.0 && passes_seconds() - w->heard_seconds < seconds;
    pthread_mutex_unlock(&w->lock);
    return is_watched;
}
