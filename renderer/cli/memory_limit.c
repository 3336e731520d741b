/* memory_limit.c: see memory_limit.h. */
#define _POSIX_C_SOURCE 200809L
#include "memory_limit.h"

#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

/* Returns the value of a line "NAME: N kB" of /proc/self/status, in bytes; 0 where there is none. */
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
    pthread_t thread;
    ag_context *context;
    uint64_t bytes;
    bool is_started;
    atomic_bool is_over, has_more; /* is_over tells the thread to end; has_more is read when it has ended */
} watch;

/* Returns the resident bytes of the process; 0: unknown. file: /proc/self/statm. */
static uint64_t resident_bytes(int file)
{
    char text[128];
    unsigned long long pages = 0;
    const ssize_t length = pread(file, text, sizeof text - 1, 0);
    if (length <= 0)
        return 0;
    text[length] = '\0';
    return sscanf(text, "%*u %llu", &pages) == 1 ? pages * (uint64_t)sysconf(_SC_PAGESIZE) : 0;
}

static void *watch_memory(void *unused)
{
    const struct timespec a_while = {.tv_nsec = 2000000};
    const int file = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
    (void)unused;
    while (file >= 0 && !atomic_load(&watch.is_over)) {
        if (resident_bytes(file) > watch.bytes) {
            atomic_store(&watch.has_more, true);
            ag_context_cancel(watch.context);
            break;
        }
        nanosleep(&a_while, NULL);
    }
    if (file >= 0)
        close(file);
    return NULL;
}

void memory_limit_watch(uint64_t bytes, ag_context *context)
{
    enum { STACK_BYTES = 128 << 10 };
    sigset_t all, before;
    pthread_attr_t attributes;
    const uint64_t least = status_bytes("VmRSS") + RESERVED_BYTES;
    watch.context = context;
    watch.bytes = bytes > least ? bytes : least;
    atomic_store(&watch.is_over, false);
    atomic_store(&watch.has_more, false);
    if (pthread_attr_init(&attributes) != 0)
        return;
    sigfillset(&all); /* they are other threads' */
    pthread_sigmask(SIG_SETMASK, &all, &before);
    watch.is_started = pthread_attr_setstacksize(&attributes, STACK_BYTES) == 0 &&
                       pthread_create(&watch.thread, &attributes, watch_memory, NULL) == 0;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    pthread_attr_destroy(&attributes);
}

bool memory_limit_end_watch(void)
{
    if (!watch.is_started)
        return false;
    atomic_store(&watch.is_over, true);
    pthread_join(watch.thread, NULL);
    watch.is_started = false;
    return atomic_load(&watch.has_more);
}

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
    if (least <= bytes) /* the peak may be that of an earlier picture */
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
