/* run_context.h: what every phase needs of its surroundings: threads, log, progress, and whether to stop.
 * Threads: run_cancel may be called from any thread and from a signal handler; the others from any thread. */
#ifndef AFTERGLOW_RUN_CONTEXT_H
#define AFTERGLOW_RUN_CONTEXT_H

#include "afterglow/base.h"
#include "atomics.h"
#include "log.h"
#include "thread_pool.h"

#include <pthread.h>

typedef struct run_context {
    thread_pool *pool;        /* borrowed */
    log_sink *log;            /* borrowed, may be NULL */
    ag_progress_fn *progress; /* may be NULL */
    void *progress_user;
    pthread_mutex_t progress_mutex; /* protects the three below and serialises the callback */
    double progress_fraction;       /* the last fraction told */
    double progress_time;           /* when, in clock_seconds */
    ag_phase progress_phase;
    atomic_u32 cancelled; /* set once, read often; orders nothing else, so relaxed */
} run_context;

/* Borrows pool and log. */
void run_context_init(run_context *run, thread_pool *pool, log_sink *log, ag_progress_fn *progress,
                      void *progress_user);
void run_context_reset(run_context *run); /* releases what init took; pool and log stay the caller's */

static inline void run_cancel(run_context *run) { store_relaxed_u32(&run->cancelled, 1); }
static inline bool run_is_cancelled(const run_context *run) { return load_relaxed_u32(&run->cancelled) != 0; }

/* Tells the callback at most some 20 times a second, and always at the beginning (0) and the end (1) of a phase.
 * Cheap when there is nothing to tell. */
void run_progress(run_context *run, ag_phase phase, double fraction);

#endif
