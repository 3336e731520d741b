/* bench_counters.c: see bench_counters.h. */
#define _GNU_SOURCE
#include "bench/bench_counters.h"

#include <linux/perf_event.h>
#include <string.h>
#include <sys/syscall.h>
#include <unistd.h>

static int open_one(uint64_t what)
{
    struct perf_event_attr wanted;
    memset(&wanted, 0, sizeof wanted);
    wanted.type = PERF_TYPE_HARDWARE;
    wanted.size = sizeof wanted;
    wanted.config = what;
    wanted.inherit = 1;
    wanted.exclude_kernel = 1;
    wanted.exclude_hv = 1;
    wanted.read_format = PERF_FORMAT_TOTAL_TIME_ENABLED | PERF_FORMAT_TOTAL_TIME_RUNNING;
    return (int)syscall(SYS_perf_event_open, &wanted, 0, -1, -1, PERF_FLAG_FD_CLOEXEC);
}

bench_counters bench_counters_open(void)
{
    return (bench_counters){open_one(PERF_COUNT_HW_CPU_CYCLES), open_one(PERF_COUNT_HW_INSTRUCTIONS)};
}

void bench_counters_close(bench_counters *counters)
{
    if (counters->cycles >= 0)
        close(counters->cycles);
    if (counters->instructions >= 0)
        close(counters->instructions);
    *counters = (bench_counters){-1, -1};
}

static bool read_one(int descriptor, uint64_t *out_value)
{
    uint64_t value_enabled_running[3];
    if (descriptor < 0 ||
        read(descriptor, value_enabled_running, sizeof value_enabled_running) != (ssize_t)sizeof value_enabled_running)
        return false;
    *out_value = value_enabled_running[0];
    return value_enabled_running[1] == value_enabled_running[2];
}

bench_counts bench_counters_read(const bench_counters *counters)
{
    bench_counts c = {0};
    c.is_known = read_one(counters->cycles, &c.cycles) && read_one(counters->instructions, &c.instructions);
    return c.is_known ? c : (bench_counts){0};
}
