/* import_process.c: see import_process.h. The answer is written to memory that both processes see as a file.
 * Threads: any; the new process has only the one that called. */
#define _GNU_SOURCE /* memfd_create, pipe2 */
#include "model/import_process.h"

#include "descriptor.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { LOOK_UP_EVERY_MS = 50 }; /* for cancellation */

/* So much on top of what is mapped already, which a sanitizer's shadow is part of; and no more than the machine has. */
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

static void keep_to_itself(uint64_t memory_bytes)
{
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    setpgid(0, 0); /* the terminal's signals are for the caller, who ends this process then */
    for (int number = 1; number < NSIG; number++)
        signal(number, SIG_DFL);
    sigset_t none;
    sigemptyset(&none);
    pthread_sigmask(SIG_SETMASK, &none, NULL);
    int nowhere = open("/dev/null", O_RDWR);
    for (int descriptor = 0; descriptor < 3 && nowhere >= 0; descriptor++)
        dup2(nowhere, descriptor);
    setrlimit(RLIMIT_CORE, &(struct rlimit){0, 0});
    limit_memory(memory_bytes);
}

static void work_and_exit(import_task *task, void *user, uint64_t memory_bytes, int answer_descriptor)
{
    keep_to_itself(memory_bytes);
    FILE *answer = fdopen(answer_descriptor, "wb");
    bool is_done = answer && task(user, answer) && fflush(answer) == 0;
    _exit(is_done ? 0 : 1);
}

/* Waits until the process has closed its end of the pipe, which its end does. */
static bool wait_for_end(const run_context *run, pid_t process, int pipe_end)
{
    struct pollfd at = {.fd = pipe_end, .events = POLLIN};
    for (;;) {
        if (run && run_is_cancelled(run)) {
            kill(process, SIGKILL);
            return false;
        }
        int ready = poll(&at, 1, LOOK_UP_EVERY_MS);
        if (ready > 0 || (ready < 0 && errno != EINTR))
            return true;
    }
}

/* AG_OK where it ended as it should. A host that ignores SIGCHLD has no exit codes: what was written then counts. */
static ag_status judge_end(pid_t process, char *message, size_t message_size)
{
    int how = 0;
    pid_t ended;
    while ((ended = waitpid(process, &how, 0)) < 0 && errno == EINTR)
        continue;
    if (ended < 0 || (WIFEXITED(how) && WEXITSTATUS(how) == 0))
        return AG_OK;
    if (WIFSIGNALED(how))
        snprintf(message, message_size, "the importing process was ended by signal %d (%s)", WTERMSIG(how),
                 strsignal(WTERMSIG(how)));
    else
        snprintf(message, message_size, "the importing process failed");
    return AG_ERROR_INPUT;
}

static ag_status take_answer(int descriptor, import_answer *out_answer, char *message, size_t message_size)
{
    struct stat info;
    if (fstat(descriptor, &info) != 0 || info.st_size <= 0) {
        snprintf(message, message_size, "the importing process has answered nothing");
        return AG_ERROR_INPUT;
    }
    void *bytes = mmap(NULL, (size_t)info.st_size, PROT_READ, MAP_PRIVATE, descriptor, 0);
    if (bytes == MAP_FAILED)
        return AG_ERROR_MEMORY;
    *out_answer = (import_answer){bytes, (size_t)info.st_size};
    return AG_OK;
}

static ag_status run_process(const run_context *run, import_task *task, void *user, uint64_t memory_bytes,
                             int answer_descriptor, int pipe_ends[2], import_answer *out_answer, char *message,
                             size_t message_size)
{
    /* No signal of the caller's may meet its handlers in the new process. */
    sigset_t all, saved;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &saved);
    pid_t process = fork();
    if (process == 0) {
        close(pipe_ends[0]);
        work_and_exit(task, user, memory_bytes, answer_descriptor);
    }
    int error = errno;
    pthread_sigmask(SIG_SETMASK, &saved, NULL);
    close(pipe_ends[1]);
    pipe_ends[1] = -1;
    if (process < 0) {
        snprintf(message, message_size, "no process can be started: %s", strerror(error));
        return AG_ERROR_SYSTEM;
    }
    bool has_ended = wait_for_end(run, process, pipe_ends[0]);
    ag_status status = judge_end(process, message, message_size);
    if (!has_ended || (run && run_is_cancelled(run)))
        return AG_CANCELLED;
    return status != AG_OK ? status : take_answer(answer_descriptor, out_answer, message, message_size);
}

ag_status import_process_run(const run_context *run, import_task *task, void *user, uint64_t memory_bytes,
                             import_answer *out_answer, char *message, size_t message_size)
{
    *out_answer = (import_answer){NULL, 0};
    snprintf(message, message_size, "%s", "");
    /* none of them may be one of the standard three, which go nowhere in the new process */
    int pipe_ends[2] = {-1, -1};
    int answer = descriptor_beyond_standard(memfd_create("afterglow import", MFD_CLOEXEC));
    bool has_pipe = answer >= 0 && pipe2(pipe_ends, O_CLOEXEC) == 0;
    for (int i = 0; i < 2; i++) {
        pipe_ends[i] = descriptor_beyond_standard(pipe_ends[i]);
        has_pipe = has_pipe && pipe_ends[i] >= 0;
    }
    ag_status status = AG_ERROR_SYSTEM;
    if (!has_pipe)
        snprintf(message, message_size, "no process can be prepared: %s", strerror(errno));
    else
        status = run_process(run, task, user, memory_bytes, answer, pipe_ends, out_answer, message, message_size);
    for (int i = 0; i < 2; i++)
        if (pipe_ends[i] >= 0)
            close(pipe_ends[i]);
    if (answer >= 0)
        close(answer);
    return status;
}

void import_answer_reset(import_answer *answer)
{
    if (answer->bytes)
        munmap((void *)(uintptr_t)answer->bytes, answer->size);
    *answer = (import_answer){NULL, 0};
}
