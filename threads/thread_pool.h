/* thread_pool.h: pthreads with stable worker indices that run one job at a time together.
 * Flow: every phase's parallel work goes through thread_pool_run.
 * Threads: one caller at a time per pool; idle workers sleep on a condition variable. */
#ifndef AFTERGLOW_THREAD_POOL_H
#define AFTERGLOW_THREAD_POOL_H

#include "afterglow/base.h"

typedef struct thread_pool thread_pool;

/* Called once on each worker, worker_index in [0, worker count); the caller of thread_pool_run is worker 0. */
typedef void thread_pool_fn(void *user, unsigned worker_index);

/* worker_count 0: cpu_count_available(). Creates worker_count - 1 threads. Errors: AG_ERROR_MEMORY, AG_ERROR_SYSTEM. */
ag_status thread_pool_create(unsigned worker_count, thread_pool **out_pool);
void thread_pool_destroy(thread_pool *pool); /* NULL is fine */

unsigned thread_pool_worker_count(const thread_pool *pool);

/* Runs fn on every worker and returns when all have returned. Not to be nested. While fn runs, the MXCSR of every
 * thread, the caller's too, flushes denormals (FTZ and DAZ, as Embree's manual asks); the caller's is put back
 * afterwards. */
void thread_pool_run(thread_pool *pool, thread_pool_fn *fn, void *user);

#endif
