/* run_context.h: what every phase needs of its surroundings: threads, log, progress, and whether to stop.
 * Threads: run_cancel and run_pause may be called from any thread and from a signal handler; the others from any
 * thread. */
#ifndef AFTERGLOW_RUN_CONTEXT_H
#define AFTERGLOW_RUN_CONTEXT_H

#include "afterglow/base.h"
#include "atomics.h"
#include "log.h"
#include "thread_pool.h"

#include <pthread.h>

/* A pause is heeded by the phase that allows it alone, and stays asked for until then. */
typedef enum run_stop { RUN_CANCELLED = 1, RUN_PAUSE_WANTED = 2, RUN_PAUSE_ALLOWED = 4, RUN_IN_VAIN = 8 } run_stop;

/* Returns whether what a phase works on is still what it was. thoroughly: also checks what takes some microseconds to
 * find out. Called by any worker, and thoroughly by one at a time. */
typedef bool run_watch_fn(const void *watched, bool thoroughly);

typedef struct run_context {
    thread_pool *pool;        /* borrowed */
    log_sink *log;            /* borrowed, may be NULL */
    ag_progress_fn *progress; /* may be NULL */
    void *progress_user;
    pthread_mutex_t progress_mutex; /* protects the three below and serialises the callback */
    double progress_fraction;       /* the last fraction told */
    double progress_time;           /* when, in clock_seconds */
    ag_phase progress_phase;
    struct input_files *inputs; /* borrowed, or NULL: what is known of the files of the scene that is read (scene/) */
    run_watch_fn *watch;        /* NULL: nothing is watched */
    const void *watched;        /* for watch; borrowed */
    atomic_u64 next_look;       /* ns of the clock: when to look thoroughly again; orders nothing else, so relaxed */
    atomic_u32 stop;            /* run_stop bits: set seldom, read often; orders nothing else, so relaxed */
} run_context;

/* Borrows pool and log. */
void run_context_init(run_context *run, thread_pool *pool, log_sink *log, ag_progress_fn *progress,
                      void *progress_user);
void run_context_reset(run_context *run); /* releases what init took; pool and log stay the caller's */

static inline void run_cancel(run_context *run) { fetch_or_relaxed_u32(&run->stop, RUN_CANCELLED); }
/* Must not be called while a phase works. */
static inline void run_clear_cancel(run_context *run) { fetch_and_relaxed_u32(&run->stop, ~(uint32_t)RUN_CANCELLED); }
/* Stops a phase, as run_cancel does, that works on what is no longer there. */
static inline void run_break_off(run_context *run) { fetch_or_relaxed_u32(&run->stop, RUN_IN_VAIN); }
/* Ends the state that run_break_off has set. Returns whether the phase was broken off. */
static inline bool run_end_break(run_context *run)
{
    return fetch_and_relaxed_u32(&run->stop, ~(uint32_t)RUN_IN_VAIN) & RUN_IN_VAIN;
}
/* From now on phases are broken off once watch says that what they work on is not what it was. Neither may be called
 * while a phase works; watched is borrowed until the end. */
void run_begin_watch(run_context *run, run_watch_fn *watch, const void *watched);
static inline void run_end_watch(run_context *run) { run->watch = NULL; }
/* Looks at what is watched, thoroughly twice a second. Workers call it between pieces of their work. */
void run_look(run_context *run);
static inline void run_pause(run_context *run) { fetch_or_relaxed_u32(&run->stop, RUN_PAUSE_WANTED); }
/* Allows pauses: from this call on run_is_cancelled is true where a pause is wanted, so that all that stops for good
 * also pauses. */
static inline void run_allow_pause(run_context *run) { fetch_or_relaxed_u32(&run->stop, RUN_PAUSE_ALLOWED); }
/* Forbids pauses again. Returns whether there was one, which is over then. */
static inline bool run_end_pause(run_context *run)
{
    uint32_t now = fetch_and_relaxed_u32(&run->stop, ~(uint32_t)RUN_PAUSE_ALLOWED);
    bool was_paused = now & RUN_PAUSE_ALLOWED && now & RUN_PAUSE_WANTED;
    if (was_paused)
        fetch_and_relaxed_u32(&run->stop, ~(uint32_t)RUN_PAUSE_WANTED);
    return was_paused && !(now & (RUN_CANCELLED | RUN_IN_VAIN));
}
static inline bool run_is_cancelled(const run_context *run)
{
    uint32_t now = load_relaxed_u32(&run->stop);
    /* costs one comparison where no pause is wanted: "allowed" alone stops nothing */
    return (now & ~(uint32_t)RUN_PAUSE_ALLOWED) != 0 && now != RUN_PAUSE_WANTED;
}

/* From now on no progress is told; gives what it was told to, for run_speak. Neither may be called while a phase
 * works. */
static inline ag_progress_fn *run_silence(run_context *run)
{
    ag_progress_fn *told = run->progress;
    run->progress = NULL;
    return told;
}
static inline void run_speak(run_context *run, ag_progress_fn *progress) { run->progress = progress; }

/* Tells the callback at most some 20 times a second, and always at the beginning (0) and the end (1) of a phase.
 * Cheap when there is nothing to tell. */
void run_progress(run_context *run, ag_phase phase, double fraction);

#endif
