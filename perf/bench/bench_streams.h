/* bench_streams.h: what the machine itself gives so many threads: pure arithmetic, which touches no memory, and streams
 * through memory, each thread its own. Rests on: McCalpin, "Memory Bandwidth and Machine Balance in Current High
 * Performance Computers", 1995 (the triad). Flow: [here] -> arithmetic.c, bench_result. Threads: the run's workers. */
#ifndef AFTERGLOW_BENCH_STREAMS_H
#define AFTERGLOW_BENCH_STREAMS_H

#include "parallel_for.h"

/* The cost of one turn. */
typedef struct stream_turn {
    double seconds, cpu_s;
    double amount; /* multiplications and additions, or bytes read and written */
} stream_turn;

/* Does so many units of arithmetic, 64 blocks of some hundred microseconds each, shared out as the renderer shares out
 * its own work. Errors: AG_ERROR_MEMORY, AG_CANCELLED. */
ag_status stream_arithmetic(run_context *run, uint64_t units, stream_turn *out_turn);

/* a[i] = b[i] + s c[i] over arrays that are size_bytes together, a worker's share of them its own and first touched by
 * it; passes times. Errors: AG_ERROR_MEMORY. */
ag_status stream_memory(run_context *run, uint64_t size_bytes, unsigned passes, stream_turn *out_turn);

#endif
