/* import_process.c: see import_process.h. The answer is written to memory that both processes see as a file.
 * Rests on: posix_spawn(3): a fork of a process with threads may do next to nothing before it becomes another program.
 * Threads: any. */
#define _GNU_SOURCE /* memfd_create, pipe2, posix_spawn_file_actions_addclosefrom_np */
#include "model/import_process.h"

#include "model/import_worker.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { LOOK_UP_EVERY_MS = 50 }; /* for cancellation */

/* Waits until the process has closed its end of the pipe, as it does when it ends. */
static bool wait_for_end(const run_context *run, pid_t process, int pipe_end)
{
    struct pollfd at = {.fd = pipe_end, .events = POLLIN};
    for (;;) {
        if (run && run_is_cancelled(run)) {
            kill(-process, SIGKILL); /* the whole group, which start made */
            return false;
        }
        int ready = poll(&at, 1, LOOK_UP_EVERY_MS);
        if (ready > 0 || (ready < 0 && errno != EINTR))
            return true;
    }
}

/* Returns AG_OK where the process ended as it should. A host that ignores SIGCHLD gets no exit codes: whether the
 * answer is whole then decides. */
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

/* 0, or the reason as an errno. The new process gets the default actions of all signals, a group of its own, for the
 * terminal's signals are the caller's, who ends this process then, and no descriptor but those of import_worker.h. */
static int start(const char *program, const char *const *arguments, int answer, int pipe_end, pid_t *out_process)
{
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    sigset_t all, none;
    sigfillset(&all);
    sigemptyset(&none);
    int error = posix_spawn_file_actions_init(&actions);
    if (error != 0)
        return error;
    error = posix_spawnattr_init(&attributes);
    if (error != 0) {
        posix_spawn_file_actions_destroy(&actions);
        return error;
    }
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setsigmask(&attributes, &none);
    for (int descriptor = 0; descriptor < 3 && error == 0; descriptor++)
        error = posix_spawn_file_actions_addopen(&actions, descriptor, "/dev/null", O_RDWR, 0);
    if (error == 0)
        error = posix_spawn_file_actions_adddup2(&actions, answer, IMPORT_ANSWER_DESCRIPTOR);
    if (error == 0)
        error = posix_spawn_file_actions_adddup2(&actions, pipe_end, IMPORT_END_DESCRIPTOR);
    if (error == 0)
        error = posix_spawn_file_actions_addclosefrom_np(&actions, IMPORT_DESCRIPTORS_END);
    if (error == 0) /* it promises not to change the strings; its type is older than const */
        error = posix_spawn(out_process, program, &actions, &attributes, (char *const *)(uintptr_t)arguments, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    return error;
}

static ag_status run_process(const run_context *run, const char *program, const char *const *arguments, int answer,
                             int pipe_ends[2], import_answer *out_answer, char *message, size_t message_size)
{
    pid_t process;
    int error = start(program, arguments, answer, pipe_ends[1], &process);
    if (error != 0) {
        snprintf(message, message_size, "the program '%s' cannot be started: %s", program, strerror(error));
        return AG_ERROR_SYSTEM;
    }
    close(pipe_ends[1]);
    pipe_ends[1] = -1;
    bool has_ended = wait_for_end(run, process, pipe_ends[0]);
    ag_status status = judge_end(process, message, message_size);
    if (!has_ended || (run && run_is_cancelled(run)))
        return AG_CANCELLED;
    return status != AG_OK ? status : take_answer(answer, out_answer, message, message_size);
}

/* Returns another descriptor of an open file, which the new process does not use otherwise. -1 stays -1. */
static int beyond_the_workers(int descriptor)
{
    if (descriptor < 0 || descriptor >= IMPORT_DESCRIPTORS_END)
        return descriptor;
    int moved = fcntl(descriptor, F_DUPFD_CLOEXEC, IMPORT_DESCRIPTORS_END);
    int error = errno;
    close(descriptor);
    errno = error;
    return moved;
}

ag_status import_process_run(const run_context *run, const char *program, const char *const *arguments,
                             import_answer *out_answer, char *message, size_t message_size)
{
    *out_answer = (import_answer){NULL, 0};
    snprintf(message, message_size, "%s", "");
    int pipe_ends[2] = {-1, -1};
    int answer = beyond_the_workers(memfd_create("afterglow import", MFD_CLOEXEC));
    bool has_pipe = answer >= 0 && pipe2(pipe_ends, O_CLOEXEC) == 0;
    for (int i = 0; i < 2; i++) {
        pipe_ends[i] = beyond_the_workers(pipe_ends[i]);
        has_pipe = has_pipe && pipe_ends[i] >= 0;
    }
    ag_status status = AG_ERROR_SYSTEM;
    if (!has_pipe)
        snprintf(message, message_size, "no process can be prepared: %s", strerror(errno));
    else
        status = run_process(run, program, arguments, answer, pipe_ends, out_answer, message, message_size);
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
