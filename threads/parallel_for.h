/* parallel_for.h: a range in blocks that the workers claim; results are merged by block, never by worker.
 * Threads: one caller; fn runs on all workers of the pool at once. Not to be nested. */
#ifndef AFTERGLOW_PARALLEL_FOR_H
#define AFTERGLOW_PARALLEL_FOR_H

#include "run_context.h"

/* Does [begin, end), which is block number block_index = begin / block_size. worker_index is stable while fn runs: it
 * may index per-worker scratch memory, but nothing that it selects may reach the result. */
typedef void parallel_for_fn(void *user, uint64_t begin, uint64_t end, uint64_t block_index, unsigned worker_index);

/* Calls fn for every block of [0, count), blocks in ascending order of claiming. block_size >= 1; the blocks do not
 * depend on the number of workers. Stops between blocks when the run is cancelled, or what it watches is lost.
 * phase: whose progress this is, told as (done blocks / blocks) mapped into [progress_begin, progress_end];
 * progress_end <= progress_begin tells nothing.
 * Returns AG_OK, or AG_CANCELLED when some block was not done. */
ag_status parallel_for(run_context *run, uint64_t count, uint64_t block_size, parallel_for_fn *fn, void *user,
                       ag_phase phase, double progress_begin, double progress_end);

#endif
