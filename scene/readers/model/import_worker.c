/* import_worker.c: see import_worker.h. */
#define _POSIX_C_SOURCE 200809L
#include "model/import_worker.h"

#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

/* On top of what is mapped already, which a sanitizer's shadow is part of; and no more than the machine has. */
static void limit_memory(uint64_t memory_bytes)
{
    unsigned long pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    bool is_read = file && fscanf(file, "%lu", &pages) == 1;
    if (file)
        fclose(file);
    long page_bytes = sysconf(_SC_PAGESIZE), all_pages = sysconf(_SC_PHYS_PAGES);
    struct rlimit limit;
    if (!is_read || page_bytes <= 0 || all_pages <= 0 || getrlimit(RLIMIT_AS, &limit) != 0)
        return;
    rlim_t of_machine = (rlim_t)all_pages * (rlim_t)page_bytes;
    rlim_t most = (rlim_t)pages * (rlim_t)page_bytes + (memory_bytes < of_machine ? memory_bytes : of_machine);
    if (limit.rlim_cur == RLIM_INFINITY || limit.rlim_cur > most) {
        limit.rlim_cur = most;
        setrlimit(RLIMIT_AS, &limit);
    }
}

/* The caller alone has the other end of the pipe. Its number would say less: it may be of another namespace. */
static bool caller_is_gone(void)
{
    struct pollfd pipe_end = {.fd = IMPORT_END_DESCRIPTOR};
    return poll(&pipe_end, 1, 0) > 0 && (pipe_end.revents & POLLERR) != 0;
}

FILE *import_worker_begin(uint64_t memory_bytes)
{
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (caller_is_gone()) /* before that */
        return NULL;
    setrlimit(RLIMIT_CORE, &(struct rlimit){0, 0});
    limit_memory(memory_bytes);
    return fdopen(IMPORT_ANSWER_DESCRIPTOR, "wb");
}

void import_worker_end(FILE *answer, bool is_sound) { _exit(is_sound && fflush(answer) == 0 ? 0 : 1); }
