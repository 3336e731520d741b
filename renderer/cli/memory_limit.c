/* memory_limit.c: see memory_limit.h. */
#define _POSIX_C_SOURCE 200809L
#include "memory_limit.h"

#include <stdio.h>
#include <string.h>
#include <sys/resource.h>

/* A line "NAME: N kB" of /proc/self/status, in bytes; 0 where there is none. */
static uint64_t status_bytes(const char *name)
{
    char line[256];
    unsigned long long kilobytes = 0;
    FILE *file = fopen("/proc/self/status", "r");
    while (file && fgets(line, sizeof line, file))
        if (strncmp(line, name, strlen(name)) == 0 && sscanf(line + strlen(name), ": %llu", &kilobytes) == 1)
            break;
    if (file)
        fclose(file);
    return (uint64_t)kilobytes << 10;
}

static const uint64_t RESERVED_BYTES = (uint64_t)24 << 20, RESERVED_IN_LOADING = (uint64_t)256 << 20;

static struct {
    struct rlimit found; /* before --memory */
    bool is_set;
} own;

/* The kernel counts what is reserved, too; so the limit is set above what there is. */
void memory_limit_set(uint64_t bytes, bool is_loaded)
{
    struct rlimit limit;
    const uint64_t data = status_bytes("VmData"), resident = status_bytes("VmRSS");
    const uint64_t more =
        (bytes > resident ? bytes - resident : 0) + (is_loaded ? RESERVED_BYTES : RESERVED_IN_LOADING);
    if (data == 0 || getrlimit(RLIMIT_DATA, &limit) != 0 || (uint64_t)limit.rlim_cur <= data + more)
        return;
    if (!own.is_set)
        own.found = limit;
    own.is_set = true;
    limit.rlim_cur = (rlim_t)(data + more);
    setrlimit(RLIMIT_DATA, &limit);
}

void memory_limit_lift(void)
{
    if (own.is_set)
        setrlimit(RLIMIT_DATA, &own.found);
    own.is_set = false;
}

bool memory_limit_holds(uint64_t bytes, const ag_prediction *p)
{
    const uint64_t optional = p->memory_optional_bytes, least = p->memory_needed_bytes - optional;
    if (least <= bytes) /* the peak may be another picture's */
        return true;
    fprintf(
        stderr,
        "afterglow: error: the picture needs about %.1f MB of memory, and --memory allows %.1f MB: the program and "
        "the scene %.1f MB, photon maps %.1f, threads %.1f, film %.1f, showing it meanwhile %.1f, a file on its way %.1f\n",
        (double)least / 1e6, (double)bytes / 1e6, (double)p->memory_scene_bytes / 1e6,
        (double)(p->memory_photon_bytes - optional) / 1e6, (double)p->memory_thread_bytes / 1e6,
        (double)p->memory_film_bytes / 1e6, (double)p->memory_host_bytes / 1e6, (double)p->memory_file_bytes / 1e6);
    return false;
}
