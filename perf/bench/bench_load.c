/* bench_load.c: see bench_load.h. */
#define _GNU_SOURCE
#include "bench/bench_load.h"

#include "clock.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

/* The line of one processor: "cpuN user nice system idle iowait irq softirq steal guest guest_nice". User time holds
 * that of guests already. */
static bool parse_cpu(const char *proc_stat, unsigned index, double *in_out_busy, double *in_out_stolen)
{
    char name[24];
    double user, nice, system, idle, waiting, irq, softirq, stolen;
    int length = snprintf(name, sizeof name, "cpu%u ", index);
    const char *line = proc_stat;
    while (line && strncmp(line, name, (size_t)length) != 0) {
        line = strchr(line, '\n');
        line = line ? line + 1 : NULL;
    }
    if (!line || sscanf(line + length, "%lf %lf %lf %lf %lf %lf %lf %lf", &user, &nice, &system, &idle, &waiting, &irq,
                        &softirq, &stolen) != 8)
        return false;
    *in_out_busy += user + nice + system + irq + softirq + stolen;
    *in_out_stolen += stolen;
    return true;
}

bool bench_load_parse(const char *proc_stat, const bench_cpu *cpus, unsigned cpu_count, double ticks_per_second,
                      double *out_busy_s, double *out_stolen_s)
{
    double busy = 0.0, stolen = 0.0;
    bool is_whole = cpu_count > 0;
    for (unsigned i = 0; i < cpu_count && is_whole; i++)
        is_whole = parse_cpu(proc_stat, cpus[i].os_index, &busy, &stolen);
    *out_busy_s = busy / ticks_per_second;
    *out_stolen_s = stolen / ticks_per_second;
    return is_whole;
}

/* A file of the kernel's, whose size is not told. For free(); NULL where it cannot be read. */
static char *read_text(const char *path)
{
    size_t size = 0, capacity = 1 << 16;
    char *text = malloc(capacity);
    FILE *file = fopen(path, "r");
    while (file && text) {
        size += fread(text + size, 1, capacity - size - 1, file);
        if (size + 1 < capacity)
            break;
        char *larger = realloc(text, capacity *= 2);
        if (!larger)
            free(text);
        text = larger;
    }
    if (text)
        text[size] = '\0';
    if (file)
        fclose(file);
    else
        free(text);
    return file ? text : NULL;
}

bench_load_reading bench_load_read(const bench_machine *machine)
{
    bench_load_reading r = {.at_s = clock_seconds(), .own_s = clock_process_cpu_seconds()};
    struct rusage usage;
    if (getrusage(RUSAGE_SELF, &usage) == 0)
        r.involuntary = (uint64_t)usage.ru_nivcsw;
    char *text = read_text("/proc/stat");
    r.is_known = text && bench_load_parse(text, machine->cpus, machine->cpu_count, (double)sysconf(_SC_CLK_TCK),
                                          &r.busy_s, &r.stolen_s);
    free(text);
    return r;
}

bench_load bench_load_between(const bench_load_reading *begin, const bench_load_reading *end, unsigned cpu_count)
{
    bench_load load = {.elapsed_s = end->at_s - begin->at_s,
                       .own_s = end->own_s - begin->own_s,
                       .is_known = begin->is_known && end->is_known};
    double capacity = load.elapsed_s * (double)cpu_count;
    if (load.own_s > 0.0)
        load.involuntary_rate = (double)(end->involuntary - begin->involuntary) / load.own_s;
    if (!load.is_known || !(capacity > 0.0))
        return load;
    load.stolen_share = (end->stolen_s - begin->stolen_s) / capacity;
    double others = (end->busy_s - begin->busy_s) / capacity - load.stolen_share - load.own_s / capacity;
    load.others_share = others > 0.0 ? others : 0.0; /* the kernel counts in ticks, and ours to the nanosecond */
    return load;
}

unsigned bench_load_judge(const bench_load *load, double own_share,
                          char out_reasons[BENCH_LOAD_REASONS_MAX][BENCH_LOAD_REASON_SIZE])
{
    unsigned count = 0;
    if (load->others_share > BENCH_LOAD_OTHERS_MOST)
        snprintf(out_reasons[count++], BENCH_LOAD_REASON_SIZE,
                 "other processes took %.1f %% of the processors' time (%.0f %% at most)", 100.0 * load->others_share,
                 100.0 * BENCH_LOAD_OTHERS_MOST);
    if (load->stolen_share > BENCH_LOAD_STOLEN_MOST)
        snprintf(out_reasons[count++], BENCH_LOAD_REASON_SIZE,
                 "the hypervisor took %.1f %% of the processors' time (%.0f %% at most)", 100.0 * load->stolen_share,
                 100.0 * BENCH_LOAD_STOLEN_MOST);
    if (load->involuntary_rate > BENCH_LOAD_INVOLUNTARY_MOST)
        snprintf(out_reasons[count++], BENCH_LOAD_REASON_SIZE,
                 "threads were interrupted %.0f times in each second of CPU time (%.0f at most)",
                 load->involuntary_rate, BENCH_LOAD_INVOLUNTARY_MOST);
    if (own_share < BENCH_LOAD_OWN_LEAST)
        snprintf(out_reasons[count++], BENCH_LOAD_REASON_SIZE,
                 "threads of pure arithmetic had %.0f %% of their processors (%.0f %% at least)", 100.0 * own_share,
                 100.0 * BENCH_LOAD_OWN_LEAST);
    return count;
}
