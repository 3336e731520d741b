/* bench_load.h: what others took of the processors while afterglow-bench measured, and whether a score can stand beside
 * that. Rests on: proc(5) on /proc/stat, getrusage(2). Flow: bench_machine -> [here] -> bench_result.
 * Threads: one. */
#ifndef AFTERGLOW_BENCH_LOAD_H
#define AFTERGLOW_BENCH_LOAD_H

#include "bench/bench_machine.h"

/* A busy machine, by any of these. */
#define BENCH_LOAD_OTHERS_MOST      0.03 /* share of the processors' time that other processes had */
#define BENCH_LOAD_STOLEN_MOST      0.01 /* share that the hypervisor gave to others */
#define BENCH_LOAD_INVOLUNTARY_MOST 40.0 /* involuntary switches a second of our own CPU time */
#define BENCH_LOAD_OWN_LEAST        0.95 /* share of their processors that threads of pure arithmetic had */

enum { BENCH_LOAD_REASONS_MAX = 4, BENCH_LOAD_REASON_SIZE = 160 };

/* Sums since the machine or the process was started. */
typedef struct bench_load_reading {
    double at_s;          /* clock_seconds */
    double busy_s;        /* of the machine's processors, our own share too, and all that was stolen */
    double stolen_s;      /* processor time that the hypervisor gave to others */
    double own_s;         /* CPU time of this process */
    uint64_t involuntary; /* switches of this process */
    bool is_known;        /* whether the system tells busy_s and stolen_s */
} bench_load_reading;

typedef struct bench_load {
    double elapsed_s, own_s;
    bool is_known;
    double others_share, stolen_share; /* of elapsed time times processors; 0 where the system does not tell */
    double involuntary_rate;           /* 1/s of own CPU time */
} bench_load;

/* The sums over those processors in a text of /proc/stat, in seconds. False: not all of them are in it. */
bool bench_load_parse(const char *proc_stat, const bench_cpu *cpus, unsigned cpu_count, double ticks_per_second,
                      double *out_busy_s, double *out_stolen_s);

bench_load_reading bench_load_read(const bench_machine *machine);
bench_load bench_load_between(const bench_load_reading *begin, const bench_load_reading *end, unsigned cpu_count);

/* Whether the machine was idle but for us. own_share: the least share that threads of arithmetic had of their
 * processors. Returns how many reasons there are against it, a sentence each. */
unsigned bench_load_judge(const bench_load *load, double own_share,
                          char out_reasons[BENCH_LOAD_REASONS_MAX][BENCH_LOAD_REASON_SIZE]);

#endif
