/* bench_counters.h: cycles and instructions of the process and of all threads that it starts from then on, where the
 * kernel lets them be counted. Rests on: perf_event_open(2). Flow: [here] -> bench_phases. Threads: one. */
#ifndef AFTERGLOW_BENCH_COUNTERS_H
#define AFTERGLOW_BENCH_COUNTERS_H

#include <stdbool.h>
#include <stdint.h>

typedef struct bench_counters {
    int cycles, instructions; /* descriptors; -1 where they may not be counted */
} bench_counters;

typedef struct bench_counts {
    bool is_known; /* else both are 0 */
    uint64_t cycles, instructions;
} bench_counts;

/* Counts in user space alone. To be called before threads are started. */
bench_counters bench_counters_open(void);
void bench_counters_close(bench_counters *counters);
/* Since they were opened. Where more is counted than the processor has registers for, and each only at times, nothing
 * is known. */
bench_counts bench_counters_read(const bench_counters *counters);

#endif
