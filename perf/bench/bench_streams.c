/* bench_streams.c: see bench_streams.h. */
#include "bench/bench_streams.h"

#include "clock.h"

#include <stdlib.h>

/* --- arithmetic --- */

/* A block is some hundred microseconds, as a small tile is. */
enum { STEPS_PER_BLOCK = 100000, BLOCKS_PER_UNIT = 64, OPERATIONS_PER_STEP = 4 };

static void multiply(void *user, uint64_t begin, uint64_t end, uint64_t block, unsigned worker)
{
    (void)worker;
    uint64_t *sums = user;
    double x = 1.0 + (double)block * 1e-6, y = 0.5;
    for (uint64_t i = begin; i < end; i++)
        for (int k = 0; k < STEPS_PER_BLOCK; k++) {
            x = x * 0.999999 + 0.25;
            y = y * 0.999998 + x;
        }
    sums[block] = (uint64_t)(x + y); /* once a block: so that the work is not optimised away */
}

ag_status stream_arithmetic(run_context *run, uint64_t units, stream_turn *out_turn)
{
    uint64_t count = units * BLOCKS_PER_UNIT, *sums = calloc(count, sizeof *sums);
    if (!sums)
        return AG_ERROR_MEMORY;
    double begin = clock_seconds(), cpu_begin = clock_process_cpu_seconds();
    ag_status status = parallel_for(run, count, 1, multiply, sums, AG_PHASE_RENDER, 0.0, 0.0);
    *out_turn = (stream_turn){clock_seconds() - begin, clock_process_cpu_seconds() - cpu_begin,
                              (double)count * STEPS_PER_BLOCK * OPERATIONS_PER_STEP};
    free(sums);
    return status;
}

/* --- memory --- */

typedef struct memory_share {
    _Alignas(64) double *values; /* three arrays, one behind the other */
} memory_share;

typedef struct memory_stream {
    memory_share *shares; /* [workers] */
    size_t share_count;   /* numbers in each array of a worker */
    unsigned passes;
} memory_stream;

static void touch(void *user, unsigned worker)
{
    memory_stream *m = user;
    double *values = malloc(3 * m->share_count * sizeof *values);
    for (size_t i = 0; values && i < 3 * m->share_count; i++)
        values[i] = (double)(i & 255);
    m->shares[worker].values = values;
}

static void triad(void *user, unsigned worker)
{
    const memory_stream *m = user;
    double *restrict a = m->shares[worker].values, scale = 0.5;
    const double *restrict b = a + m->share_count, *restrict c = b + m->share_count;
    for (unsigned pass = 0; pass < m->passes; pass++, scale *= 0.99)
        for (size_t i = 0; i < m->share_count; i++)
            a[i] = b[i] + scale * c[i];
}

ag_status stream_memory(run_context *run, uint64_t size_bytes, unsigned passes, stream_turn *out_turn)
{
    unsigned workers = thread_pool_worker_count(run->pool);
    memory_stream m = {.share_count = (size_t)(size_bytes / (3 * sizeof(double) * workers)) + 1, .passes = passes};
    m.shares = aligned_alloc(_Alignof(memory_share), workers * sizeof *m.shares);
    if (!m.shares)
        return AG_ERROR_MEMORY;
    thread_pool_run(run->pool, touch, &m);
    bool is_whole = true;
    for (unsigned i = 0; i < workers; i++)
        is_whole = is_whole && m.shares[i].values;
    if (is_whole) {
        double begin = clock_seconds(), cpu_begin = clock_process_cpu_seconds();
        thread_pool_run(run->pool, triad, &m);
        *out_turn = (stream_turn){clock_seconds() - begin, clock_process_cpu_seconds() - cpu_begin,
                                  (double)m.share_count * workers * passes * 3.0 * sizeof(double)};
    }
    for (unsigned i = 0; i < workers; i++)
        free(m.shares[i].values);
    free(m.shares);
    return is_whole ? AG_OK : AG_ERROR_MEMORY;
}
