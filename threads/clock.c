/* clock.c: see clock.h.
 * Rests on: clock_gettime(2), proc(5), getrusage(2).
 * Threads: any. */
#define _GNU_SOURCE
#include "clock.h"

#include <stdio.h>
#include <sys/resource.h>
#include <time.h>

static double seconds_of(clockid_t id)
{
    struct timespec t = {0, 0};
    clock_gettime(id, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

double clock_seconds(void) { return seconds_of(CLOCK_MONOTONIC); }
double clock_process_cpu_seconds(void) { return seconds_of(CLOCK_PROCESS_CPUTIME_ID); }
double clock_thread_cpu_seconds(void) { return seconds_of(CLOCK_THREAD_CPUTIME_ID); }

uint64_t peak_memory_bytes(void)
{
    /* VmHWM first: ru_maxrss survives execve, so a small program started by a large one would report the latter's. */
    uint64_t peak_kib = 0;
    FILE *status = fopen("/proc/self/status", "re");
    if (status) {
        char line[256];
        unsigned long kib = 0;
        while (fgets(line, sizeof line, status))
            if (sscanf(line, "VmHWM: %lu kB", &kib) == 1) {
                peak_kib = kib;
                break;
            }
        fclose(status);
    }
    struct rusage usage;
    if (peak_kib == 0 && getrusage(RUSAGE_SELF, &usage) == 0)
        peak_kib = (uint64_t)usage.ru_maxrss;
    return peak_kib * 1024;
}
