/* thread_pool.c: see thread_pool.h. One mutex and two condition variables; a job is a new generation number.
 * Rests on: Embree's manual, "Performance Recommendations" (FTZ and DAZ in every thread).
 * Flow: below parallel_for and the tile loop.
 * Threads: what the caller wrote before a job is seen by fn, and what fn wrote is seen after it, by the mutex. */
#define _GNU_SOURCE
#include "thread_pool.h"

#include "cpu_count.h"
#include "floating_point.h"

#include <assert.h>
#include <pthread.h>
#include <signal.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct worker {
    thread_pool *pool;
    unsigned index;
    pthread_t thread;
} worker;

struct thread_pool {
    unsigned worker_count;
    worker *workers;       /* entry 0, the caller's, has no thread */
    pthread_mutex_t mutex; /* protects all below */
    pthread_cond_t job_given, job_done;
    uint64_t generation; /* the number of jobs given so far */
    thread_pool_fn *fn;
    void *user;
    unsigned running_count; /* threads that have not finished the current job; the caller is not counted */
    bool busy, stopping;
};

static void call_in_our_arithmetic(thread_pool_fn *fn, void *user, unsigned worker_index)
{
    unsigned callers = floating_point_enter();
    fn(user, worker_index);
    floating_point_leave(callers);
}

static void *worker_main(void *argument)
{
    const worker *self = argument;
    thread_pool *pool = self->pool;
    char name[16]; /* the kernel's limit */
    snprintf(name, sizeof name, "afterglow-%u", self->index % 100000u);
    pthread_setname_np(pthread_self(), name);

    uint64_t seen_generation = 0;
    pthread_mutex_lock(&pool->mutex);
    for (;;) {
        while (pool->generation == seen_generation && !pool->stopping)
            pthread_cond_wait(&pool->job_given, &pool->mutex);
        if (pool->stopping)
            break;
        seen_generation = pool->generation;
        thread_pool_fn *fn = pool->fn;
        void *user = pool->user;
        pthread_mutex_unlock(&pool->mutex);
        call_in_our_arithmetic(fn, user, self->index);
        pthread_mutex_lock(&pool->mutex);
        if (--pool->running_count == 0)
            pthread_cond_signal(&pool->job_done);
    }
    pthread_mutex_unlock(&pool->mutex);
    return NULL;
}

/* Stops and joins the threads of workers 1 .. started_count, and frees the pool. */
static void stop_and_free(thread_pool *pool, unsigned started_count)
{
    pthread_mutex_lock(&pool->mutex);
    assert(!pool->busy);
    pool->stopping = true;
    pthread_cond_broadcast(&pool->job_given);
    pthread_mutex_unlock(&pool->mutex);
    for (unsigned i = 1; i <= started_count; i++)
        pthread_join(pool->workers[i].thread, NULL);
    pthread_cond_destroy(&pool->job_done);
    pthread_cond_destroy(&pool->job_given);
    pthread_mutex_destroy(&pool->mutex);
    free(pool->workers);
    free(pool);
}

static const size_t STACK_BYTES = (size_t)8 << 20;

/* Starts the threads with their signals blocked, so that the program's handlers run on its own threads. Faults stay
 * open: they belong to the thread that caused them. Returns how many threads stand. */
static unsigned start_threads(thread_pool *pool)
{
    static const int faults[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGTRAP, SIGSYS, SIGABRT};
    sigset_t blocked, callers;
    sigfillset(&blocked);
    for (size_t i = 0; i < sizeof faults / sizeof faults[0]; i++)
        sigdelset(&blocked, faults[i]);
    pthread_sigmask(SIG_SETMASK, &blocked, &callers);
    unsigned started_count = 0;
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes,
                              STACK_BYTES); /* the limit of `ulimit -s`, which is the default, may be small */
    for (unsigned i = 1; i < pool->worker_count; i++) {
        pool->workers[i].pool = pool;
        pool->workers[i].index = i;
        if (pthread_create(&pool->workers[i].thread, &attributes, worker_main, &pool->workers[i]) != 0)
            break;
        started_count++;
    }
    pthread_attr_destroy(&attributes);
    pthread_sigmask(SIG_SETMASK, &callers, NULL);
    return started_count;
}

ag_status thread_pool_create(unsigned worker_count, thread_pool **out_pool)
{
    *out_pool = NULL;
    thread_pool *pool = calloc(1, sizeof *pool);
    if (!pool)
        return AG_ERROR_MEMORY;
    pool->worker_count = worker_count > 0 ? worker_count : cpu_count_available();
    pool->workers = calloc(pool->worker_count, sizeof *pool->workers);
    if (!pool->workers) {
        free(pool);
        return AG_ERROR_MEMORY;
    }
    pthread_mutex_init(&pool->mutex, NULL);
    pthread_cond_init(&pool->job_given, NULL);
    pthread_cond_init(&pool->job_done, NULL);
    unsigned started_count = start_threads(pool);
    if (started_count != pool->worker_count - 1) {
        stop_and_free(pool, started_count);
        return AG_ERROR_SYSTEM;
    }
    *out_pool = pool;
    return AG_OK;
}

void thread_pool_destroy(thread_pool *pool)
{
    if (pool)
        stop_and_free(pool, pool->worker_count - 1);
}

unsigned thread_pool_worker_count(const thread_pool *pool) { return pool->worker_count; }

void thread_pool_run(thread_pool *pool, thread_pool_fn *fn, void *user)
{
    pthread_mutex_lock(&pool->mutex);
    assert(!pool->busy); /* nested, or two callers at once */
    pool->busy = true;
    pool->fn = fn;
    pool->user = user;
    pool->running_count = pool->worker_count - 1;
    pool->generation++;
    if (pool->running_count > 0)
        pthread_cond_broadcast(&pool->job_given);
    pthread_mutex_unlock(&pool->mutex);

    call_in_our_arithmetic(fn, user, 0);

    pthread_mutex_lock(&pool->mutex);
    while (pool->running_count > 0)
        pthread_cond_wait(&pool->job_done, &pool->mutex);
    pool->busy = false;
    pthread_mutex_unlock(&pool->mutex);
}
