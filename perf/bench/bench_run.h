/* bench_run.h: all that afterglow-bench measures in one run, and the measuring: turn by turn, so that what disturbs the
 * machine for a while meets all numbers of threads and all phases alike.
 * Flow: bench_machine, bench_stage, bench_phases -> [here] -> bench_score, bench_certificate, bench_json.
 * Threads: one; each level has workers of its own, which sleep while others work. */
#ifndef AFTERGLOW_BENCH_RUN_H
#define AFTERGLOW_BENCH_RUN_H

#include "bench/bench_counters.h"
#include "bench/bench_load.h"
#include "bench/bench_phases.h"
#include "bench/bench_streams.h"

enum { BENCH_TURNS_MAX = 8 };

/* A number of threads. */
typedef struct bench_level {
    unsigned threads, cores, numa_nodes; /* processors in the order of bench_machine */
    bool is_oversubscribed;              /* more threads than processors, or than we are entitled to */
    bool is_pinned;
    bool has_all_phases;                /* else whole frames alone */
    double arithmetic[BENCH_TURNS_MAX]; /* operations a second, by turn */
    double arithmetic_share;            /* of their processors' time that its threads had: CPU time over elapsed */
    double memory[BENCH_TURNS_MAX];     /* bytes a second, by turn */
} bench_level;

/* A phase of a scene on a number of threads. */
typedef struct bench_part {
    bool is_measured;
    double rate[BENCH_TURNS_MAX]; /* items a second, by turn */
    double seconds, cpu_s;        /* of all turns */
    uint64_t units, items;        /* done in all turns */
    hash128 hash;                 /* of the first unit */
    bool is_steady;               /* all units have that hash and the same counts */
    bool is_sound;                /* all units were */
    uint64_t count, expected;     /* of the first unit; a unit that counts otherwise than expected stays here */
    uint64_t duplicated;          /* of all units; so are all below */
    uint64_t requests, computed, deferred, waited;
    double waited_s;
    bench_counts counts;
} bench_part;

typedef struct bench_run {
    bench_machine machine;
    bench_size size;
    unsigned turns;
    bench_level levels[BENCH_LEVELS_MAX];
    unsigned level_count;
    bench_part parts[BENCH_SCENE_COUNT][BENCH_PHASE_COUNT][BENCH_LEVELS_MAX];
    bench_load load;                        /* while it measured */
    double clock_least_mhz, clock_most_mhz; /* seen between turns; 0: not told */
    double seconds;                         /* in all */
    char isa[16];                           /* of ray traversal */
} bench_run;

/* A level before anything is measured on it. */
bench_level bench_level_describe(const bench_machine *machine, unsigned threads);

/* Takes the machine. levels: numbers of threads, ascending, the first one 1. progress, which may be NULL, is told what
 * is being done. Errors: those of the work; AG_ERROR_SYSTEM (threads cannot be started). */
ag_status bench_run_measure(bench_machine *machine, bench_size size, const unsigned *levels, unsigned level_count,
                            ag_log_fn *log, void (*progress)(const char *what), bench_run *out_run);
void bench_run_reset(bench_run *run);

#endif
