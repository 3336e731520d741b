/* bench_score.h: what a run is worth: rates against a reference machine's, with their spread over the turns, and how
 * well phases scale. Flow: bench_run -> [here] -> bench_json. Threads: one. */
#ifndef AFTERGLOW_BENCH_SCORE_H
#define AFTERGLOW_BENCH_SCORE_H

#include "bench/bench_run.h"

/* The interval that the turns of a phase give. */
typedef struct bench_interval {
    double median, least, most;
} bench_interval;

/* The interval of so many values, 1 to BENCH_TURNS_MAX. */
bench_interval bench_interval_of(const double *values, unsigned count);
/* (most - least) / median; 0 where the median is 0. */
double bench_spread(bench_interval interval);

/* Scores whose spread is above this are told as an interval. */
#define BENCH_SPREAD_MOST 0.02

/* The geometric mean over the scenes of a phase's rate, where one thread of the reference machine is 100, by turn. */
bench_interval bench_score(const bench_run *run, bench_phase phase, unsigned level);

/* A part's rate against that of one thread, by turn; and that against what the streams get there, by turn. */
typedef struct bench_scaling {
    double speedup;       /* of one thread's rate */
    double efficiency;    /* that over the number of threads */
    double of_arithmetic; /* that over the speed-up of pure arithmetic */
    double of_memory;     /* that over the speed-up of streams through memory */
} bench_scaling;
bench_scaling bench_scaling_of(const bench_run *run, bench_scene where, bench_phase phase, unsigned level);

/* The level with the best score for whole frames, of those with all phases and without more threads than processors. */
unsigned bench_best_level(const bench_run *run);

/* The least share of their processors that the threads of arithmetic had, of all levels that fit the machine. */
double bench_arithmetic_share(const bench_run *run);

#endif
