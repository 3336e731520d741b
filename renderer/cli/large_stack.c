/* large_stack.c: see large_stack.h.
 * Rests on: getrlimit(2), pthread_setattr_default_np(3). Threads: see large_stack.h. */
#define _GNU_SOURCE
#include "large_stack.h"

#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>

/* Where the limit on the stack is below the first size, the thread is made, with a stack of the second, which is what
 * systems usually have. */
static const size_t ENOUGH_BYTES = (size_t)4 << 20, STACK_BYTES = (size_t)8 << 20;

typedef struct call {
    large_stack_fn *fn;
    int argc, result;
    char **argv;
    sigset_t signals; /* that are blocked there */
} call;

static void *make_call(void *user)
{
    call *c = user;
    pthread_sigmask(SIG_SETMASK, &c->signals, NULL);
    c->result = c->fn(c->argc, c->argv);
    return NULL;
}

int large_stack_call(large_stack_fn *fn, int argc, char **argv)
{
    struct rlimit limit;
    if (getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur >= ENOUGH_BYTES)
        return fn(argc, argv);
    pthread_attr_t attributes;
    pthread_t thread;
    call c = {.fn = fn, .argc = argc, .argv = argv};
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, STACK_BYTES);
    /* signals are for the new thread, which blocks them for a while at times */
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &c.signals);
    int error = pthread_setattr_default_np(&attributes);
    if (error == 0)
        error = pthread_create(&thread, &attributes, make_call, &c);
    pthread_attr_destroy(&attributes);
    if (error != 0) {
        fprintf(
            stderr,
            "afterglow: error: the stack is limited to %llu KiB (ulimit -s), and no thread with a larger one can be "
            "had: %s\n",
            (unsigned long long)limit.rlim_cur >> 10, strerror(error));
        return 3;
    }
    pthread_join(thread, NULL);
    return c.result;
}
