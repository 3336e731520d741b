/* bench_machine.h: what afterglow-bench runs on: which processors it may use, in the order in which threads take them,
 * and what the system tells of them. Rests on: hwloc (Broquedis et al., "hwloc: a Generic Framework for Managing
 * Hardware Affinities in HPC Applications", 2010); proc(5); Linux Documentation/admin-guide/pm/cpufreq.rst.
 * Flow: [here] -> bench_phases (pinning), bench_load, bench_result. Threads: read-only once made. */
#ifndef AFTERGLOW_BENCH_MACHINE_H
#define AFTERGLOW_BENCH_MACHINE_H

#include "afterglow/base.h"
#include "thread_pool.h"

#include <stdbool.h>
#include <stdint.h>

enum { BENCH_LEVELS_MAX = 24, BENCH_THREADS_MAX = 4096 };

typedef struct bench_cpu {
    unsigned os_index;  /* the kernel's number */
    unsigned core;      /* hwloc's logical number */
    unsigned sibling;   /* 0: the core's first thread, 1: its second, ... */
    unsigned numa_node; /* the kernel's number */
} bench_cpu;

typedef struct bench_machine {
    bench_cpu *cpus; /* owned: those of the affinity mask; cores' first threads first, one NUMA node after the other */
    unsigned cpu_count, core_count, numa_count, package_count;
    unsigned entitled;     /* threads that affinity mask and cgroup quota allow; <= cpu_count */
    char cpu_name[96];     /* as the kernel has it */
    char maker[16];        /* "AuthenticAMD" */
    char kernel[96];       /* system, release, architecture */
    char governor[32];     /* of the clock; "" where it is not told */
    double clock_mhz;      /* of the first processor, now; 0: not told */
    int clock_is_fixed;    /* 1: least and greatest clock are the same, and nothing boosts; 0; -1: not told */
    uint64_t memory_bytes; /* of the machine; 0: not told */
} bench_machine;

/* Describes this machine; the caller resets it, on failure too. Errors: AG_ERROR_MEMORY, AG_ERROR_SYSTEM (hwloc finds
 * no processor). */
ag_status bench_machine_create(bench_machine *out_machine);
void bench_machine_reset(bench_machine *machine);

/* The clock of the first processor in MHz, now; 0: not told. */
double bench_machine_clock_mhz(const bench_machine *machine);

/* Numbers of threads worth a measurement: 1, 2, 4, ... below cores, cores, threads. cores <= threads, both >= 1.
 * Returns how many. */
unsigned bench_levels_of(unsigned cores, unsigned threads, unsigned out_levels[BENCH_LEVELS_MAX]);

/* Puts each worker of the pool on a processor of its own, worker 0, the caller, among them; where there are more
 * workers than processors, they may go anywhere on these. False: the kernel refuses. */
bool bench_machine_pin(const bench_machine *machine, thread_pool *pool);

/* The cores and NUMA nodes that the first so many processors are on. */
void bench_machine_span(const bench_machine *machine, unsigned threads, unsigned *out_cores, unsigned *out_numa_nodes);

#endif
