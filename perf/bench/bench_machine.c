/* bench_machine.c: see bench_machine.h. */
#define _GNU_SOURCE
#include "bench/bench_machine.h"

#include "cpu_count.h"

#include <hwloc.h>
#include <pthread.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/utsname.h>
#include <unistd.h>
#if defined(__x86_64__) || defined(__i386__)
#include <cpuid.h>
#endif

/* --- what the system tells --- */

/* The first line of a small file, without its end; false where there is none. */
static bool read_line(const char *path, char *out, size_t size)
{
    FILE *file = fopen(path, "r");
    out[0] = '\0';
    if (!file)
        return false;
    bool is_read = fgets(out, (int)size, file) != NULL;
    fclose(file);
    out[strcspn(out, "\n")] = '\0';
    return is_read;
}

/* A field "NAME : VALUE" of /proc/cpuinfo, of the first processor that has it. */
static bool read_cpuinfo(const char *name, char *out, size_t size)
{
    char line[512];
    bool is_found = false;
    FILE *file = fopen("/proc/cpuinfo", "r");
    while (file && !is_found && fgets(line, sizeof line, file)) {
        const char *colon = strchr(line, ':');
        size_t length = strlen(name);
        if (strncmp(line, name, length) == 0 && (line[length] == '\t' || line[length] == ' ') && colon) {
            colon += 1 + strspn(colon + 1, " ");
            snprintf(out, size, "%.*s", (int)strcspn(colon, "\n"), colon);
            is_found = true;
        }
    }
    if (file)
        fclose(file);
    return is_found;
}

static bool read_clock(const bench_machine *m, const char *what, char *out, size_t size)
{
    char path[128];
    snprintf(path, sizeof path, "/sys/devices/system/cpu/cpu%u/cpufreq/%s", m->cpus[0].os_index, what);
    return read_line(path, out, size);
}

double bench_machine_clock_mhz(const bench_machine *machine)
{
    char text[64];
    if (read_clock(machine, "scaling_cur_freq", text, sizeof text))
        return atof(text) / 1000.0;
    return read_cpuinfo("cpu MHz", text, sizeof text) ? atof(text) : 0.0;
}

static void describe_clock(bench_machine *m)
{
    char least[64], most[64], boost[64] = "0", no_turbo[64] = "1";
    m->clock_mhz = bench_machine_clock_mhz(m);
    read_clock(m, "scaling_governor", m->governor, sizeof m->governor);
    m->clock_is_fixed = -1;
    if (!read_clock(m, "scaling_min_freq", least, sizeof least) ||
        !read_clock(m, "scaling_max_freq", most, sizeof most))
        return;
    read_line("/sys/devices/system/cpu/cpufreq/boost", boost, sizeof boost);
    read_line("/sys/devices/system/cpu/intel_pstate/no_turbo", no_turbo, sizeof no_turbo);
    m->clock_is_fixed = strcmp(least, most) == 0 && atoi(boost) == 0 && atoi(no_turbo) == 1;
}

static void describe(bench_machine *m)
{
    struct utsname system;
#if defined(__x86_64__) || defined(__i386__)
    unsigned level, words[3];
    if (__get_cpuid(0, &level, &words[0], &words[2], &words[1])) /* EBX, EDX, ECX spell the name */
        memcpy(m->maker, words, sizeof words);
#endif
    if (uname(&system) == 0)
        snprintf(m->kernel, sizeof m->kernel, "%.24s %.40s %.24s", system.sysname, system.release, system.machine);
    if (!read_cpuinfo("model name", m->cpu_name, sizeof m->cpu_name))
        snprintf(m->cpu_name, sizeof m->cpu_name, "unknown");
    long pages = sysconf(_SC_PHYS_PAGES), page_bytes = sysconf(_SC_PAGESIZE);
    m->memory_bytes = pages > 0 && page_bytes > 0 ? (uint64_t)pages * (uint64_t)page_bytes : 0;
    describe_clock(m);
}

/* --- topology --- */

static int by_sibling_and_core(const void *a, const void *b)
{
    const bench_cpu *x = a, *y = b;
    if (x->sibling != y->sibling)
        return x->sibling < y->sibling ? -1 : 1;
    return x->core < y->core ? -1 : x->core > y->core;
}

static unsigned numa_node_of(hwloc_topology_t topology, hwloc_obj_t cpu)
{
    int count = hwloc_get_nbobjs_by_type(topology, HWLOC_OBJ_NUMANODE);
    for (int i = 0; i < count; i++) {
        hwloc_obj_t node = hwloc_get_obj_by_type(topology, HWLOC_OBJ_NUMANODE, (unsigned)i);
        if (hwloc_bitmap_isset(node->cpuset, cpu->os_index))
            return node->os_index;
    }
    return 0;
}

/* A system that tells of no cores has one for each processor. */
static void describe_cpu(hwloc_topology_t topology, unsigned index, bench_cpu *out)
{
    hwloc_obj_t cpu = hwloc_get_obj_by_type(topology, HWLOC_OBJ_PU, index);
    hwloc_obj_t core = hwloc_get_ancestor_obj_by_type(topology, HWLOC_OBJ_CORE, cpu);
    *out = (bench_cpu){.os_index = cpu->os_index,
                       .core = core ? core->logical_index : index,
                       .numa_node = numa_node_of(topology, cpu)};
    for (unsigned i = 0; core && i < index; i++)
        if (hwloc_get_ancestor_obj_by_type(topology, HWLOC_OBJ_CORE,
                                           hwloc_get_obj_by_type(topology, HWLOC_OBJ_PU, i)) == core)
            out->sibling++;
}

static ag_status list_cpus(hwloc_topology_t topology, bench_machine *m)
{
    int count = hwloc_get_nbobjs_by_type(topology, HWLOC_OBJ_PU);
    int packages = hwloc_get_nbobjs_by_type(topology, HWLOC_OBJ_PACKAGE);
    int nodes = hwloc_get_nbobjs_by_type(topology, HWLOC_OBJ_NUMANODE);
    if (count < 1)
        return AG_ERROR_SYSTEM;
    m->cpus = calloc((size_t)count, sizeof *m->cpus);
    if (!m->cpus)
        return AG_ERROR_MEMORY;
    m->cpu_count = (unsigned)count;
    for (unsigned i = 0; i < m->cpu_count; i++) {
        describe_cpu(topology, i, &m->cpus[i]);
        m->core_count += m->cpus[i].sibling == 0;
    }
    qsort(m->cpus, m->cpu_count, sizeof *m->cpus, by_sibling_and_core);
    m->package_count = packages > 0 ? (unsigned)packages : 1;
    m->numa_count = nodes > 0 ? (unsigned)nodes : 1;
    unsigned entitled = cpu_count_available();
    m->entitled = entitled < m->cpu_count ? entitled : m->cpu_count;
    return AG_OK;
}

ag_status bench_machine_create(bench_machine *out_machine)
{
    *out_machine = (bench_machine){0};
    hwloc_topology_t topology;
    if (hwloc_topology_init(&topology) != 0)
        return AG_ERROR_MEMORY;
    ag_status status = hwloc_topology_load(topology) == 0 ? AG_OK : AG_ERROR_SYSTEM;
    hwloc_bitmap_t allowed = hwloc_bitmap_alloc();
    if (status == AG_OK && !allowed)
        status = AG_ERROR_MEMORY;
    /* what the affinity mask leaves out is not ours */
    if (status == AG_OK && (hwloc_get_cpubind(topology, allowed, HWLOC_CPUBIND_PROCESS) != 0 ||
                            hwloc_topology_restrict(topology, allowed, HWLOC_RESTRICT_FLAG_REMOVE_CPULESS) != 0))
        status = AG_ERROR_SYSTEM;
    if (status == AG_OK)
        status = list_cpus(topology, out_machine);
    if (status == AG_OK)
        describe(out_machine);
    hwloc_bitmap_free(allowed);
    hwloc_topology_destroy(topology);
    return status;
}

void bench_machine_reset(bench_machine *machine)
{
    free(machine->cpus);
    *machine = (bench_machine){0};
}

unsigned bench_levels_of(unsigned cores, unsigned threads, unsigned out_levels[BENCH_LEVELS_MAX])
{
    unsigned count = 0;
    for (unsigned n = 1; n < cores && count < BENCH_LEVELS_MAX - 2; n *= 2)
        out_levels[count++] = n;
    out_levels[count++] = cores;
    if (threads > cores)
        out_levels[count++] = threads;
    return count;
}

/* --- pinning --- */

typedef struct pinning {
    const bench_machine *machine;
    unsigned worker_count;
    unsigned refused[BENCH_THREADS_MAX]; /* by worker */
} pinning;

static void pin_worker(void *user, unsigned worker)
{
    pinning *p = user;
    const bench_machine *m = p->machine;
    unsigned most = m->cpus[0].os_index;
    for (unsigned i = 1; i < m->cpu_count; i++)
        most = m->cpus[i].os_index > most ? m->cpus[i].os_index : most;
    cpu_set_t *set = CPU_ALLOC(most + 1);
    size_t size_bytes = CPU_ALLOC_SIZE(most + 1);
    p->refused[worker] = 1;
    if (!set)
        return;
    CPU_ZERO_S(size_bytes, set);
    for (unsigned i = 0; i < m->cpu_count; i++)
        if (p->worker_count > m->cpu_count || i == worker)
            CPU_SET_S(m->cpus[i].os_index, size_bytes, set);
    p->refused[worker] = pthread_setaffinity_np(pthread_self(), size_bytes, set) != 0;
    CPU_FREE(set);
}

bool bench_machine_pin(const bench_machine *machine, thread_pool *pool)
{
    pinning *p = calloc(1, sizeof *p);
    if (!p)
        return false;
    p->machine = machine;
    p->worker_count = thread_pool_worker_count(pool);
    thread_pool_run(pool, pin_worker, p);
    bool is_pinned = true;
    for (unsigned i = 0; i < p->worker_count; i++)
        is_pinned = is_pinned && !p->refused[i];
    free(p);
    return is_pinned;
}

void bench_machine_span(const bench_machine *machine, unsigned threads, unsigned *out_cores, unsigned *out_numa_nodes)
{
    unsigned count = threads < machine->cpu_count ? threads : machine->cpu_count;
    *out_cores = *out_numa_nodes = 0;
    for (unsigned i = 0; i < count; i++) {
        bool is_new_node = true;
        *out_cores += machine->cpus[i].sibling == 0;
        for (unsigned k = 0; k < i; k++)
            is_new_node = is_new_node && machine->cpus[k].numa_node != machine->cpus[i].numa_node;
        *out_numa_nodes += is_new_node;
    }
}
