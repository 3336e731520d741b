/* parallel_for.c: see parallel_for.h.
 * Flow: between the pool and every phase that goes over photons, tree nodes or rows.
 * Threads: the workers share two counters; the results they write are handed over by the pool's own mutex. */
#include "parallel_for.h"

#include <assert.h>

typedef struct loop {
    run_context *run;
    uint64_t count, block_size, block_count;
    parallel_for_fn *fn;
    void *user;
    ag_phase phase;
    double progress_begin, progress_end;
    /* Both counters only count, and order nothing else, so relaxed: what fn reads and writes is ordered by
     * thread_pool_run. */
    atomic_u64 next_block; /* pairs with itself: each worker's addition claims a different block */
    atomic_u64 done_count; /* pairs with itself for progress, and is read for good after all have returned */
} loop;

static void report(const loop *l, uint64_t done_count)
{
    if (l->progress_end <= l->progress_begin)
        return;
    double share = l->block_count > 0 ? (double)done_count / (double)l->block_count : 1.0;
    double fraction = l->progress_begin + share * (l->progress_end - l->progress_begin); /* b + (1 - b) rounds to 1 */
    run_progress(l->run, l->phase, fraction);
}

static void work(void *user, unsigned worker_index)
{
    loop *l = user;
    while (!run_is_cancelled(l->run)) {
        uint64_t block = fetch_add_relaxed_u64(&l->next_block, 1);
        if (block >= l->block_count)
            return;
        uint64_t begin = block * l->block_size;
        uint64_t rest = l->count - begin;
        uint64_t end = begin + (rest < l->block_size ? rest : l->block_size);
        l->fn(l->user, begin, end, block, worker_index);
        run_look(l->run);
        report(l, fetch_add_relaxed_u64(&l->done_count, 1) + 1);
    }
}

ag_status parallel_for(run_context *run, uint64_t count, uint64_t block_size, parallel_for_fn *fn, void *user,
                       ag_phase phase, double progress_begin, double progress_end)
{
    assert(block_size >= 1);
    loop l = {.run = run,
              .count = count,
              .block_size = block_size,
              .block_count = count / block_size + (count % block_size != 0),
              .fn = fn,
              .user = user,
              .phase = phase,
              .progress_begin = progress_begin,
              .progress_end = progress_end};
    report(&l, 0);
    if (l.block_count > 0)
        thread_pool_run(run->pool, work, &l);
    return load_relaxed_u64(&l.done_count) == l.block_count ? AG_OK : AG_CANCELLED;
}
