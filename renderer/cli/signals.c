/* signals.c: see signals.h. */
#define _GNU_SOURCE
#include "signals.h"

#include "passes.h"
#include "terminal_query.h"

#include <errno.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdatomic.h>
#include <stddef.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

static ag_context *signalled_context;
static volatile sig_atomic_t stop_signal, wants_snapshot, is_rendering;

/* There is one timer, for what comes first. Its handler may run on any thread, at any time later: what it finds is told
 * by the clock alone. */
static _Atomic(double) deadline = INFINITY; /* in seconds of passes_seconds() */
static atomic_bool is_time_up;

static volatile sig_atomic_t resets_terminal, ends_sixels;
/* Shared by the thread that draws and the handler of SIGTSTP, which may run on any thread. */
static atomic_int drawing_state;
static atomic_bool was_stopped;
enum {
    DRAWING_NOTHING,
    DRAWING,
    DRAWING_BEFORE_STOP,
    DRAWING_IN_STOP,   /* the second SIGTSTP did not wait */
    DRAWING_FORBIDDEN, /* from before the terminal is reset until the process goes on: nobody draws */
    DRAWING_STATES
};
static const int STATE_BY_SIGNAL[DRAWING_STATES] = {[DRAWING_NOTHING] = DRAWING_FORBIDDEN,
                                                    [DRAWING] = DRAWING_BEFORE_STOP,
                                                    [DRAWING_BEFORE_STOP] = DRAWING_IN_STOP,
                                                    [DRAWING_IN_STOP] = DRAWING_IN_STOP,
                                                    [DRAWING_FORBIDDEN] = DRAWING_FORBIDDEN};
static const int STATE_BY_END[DRAWING_STATES] = {[DRAWING_NOTHING] = DRAWING_NOTHING,
                                                 [DRAWING] = DRAWING_NOTHING,
                                                 [DRAWING_BEFORE_STOP] = DRAWING_FORBIDDEN,
                                                 [DRAWING_IN_STOP] = DRAWING_FORBIDDEN,
                                                 [DRAWING_FORBIDDEN] = DRAWING_FORBIDDEN};
static const int STATE_BY_GOING_ON[DRAWING_STATES] = {[DRAWING_NOTHING] = DRAWING_NOTHING,
                                                      [DRAWING] = DRAWING,
                                                      [DRAWING_BEFORE_STOP] = DRAWING_BEFORE_STOP,
                                                      [DRAWING_IN_STOP] = DRAWING,
                                                      [DRAWING_FORBIDDEN] = DRAWING_NOTHING};

static bool is_released; /* signals are blocked, by us */

static const int STOPPING[] = {SIGINT, SIGTERM, SIGHUP, SIGXCPU};

/* A terminal that is held (Ctrl-S) takes nothing, and would hold the process with it. */
static void write_to_terminal(const char *text, size_t length)
{
    enum { PATIENCE_MS = 1000 };
    struct pollfd asked = {.fd = STDERR_FILENO, .events = POLLOUT};
    const ssize_t ignored =
        poll(&asked, 1, PATIENCE_MS) == 1 && (asked.revents & POLLOUT) ? write(STDERR_FILENO, text, length) : 0;
    (void)ignored;
}

static void reset_terminal(void)
{
    static const char TEXT[] = "\033\\\033[0m\r\n"; /* the first two end a picture of sixels */
    const size_t skipped = ends_sixels ? 0 : 2;
    write_to_terminal(TEXT + skipped, sizeof TEXT - 1 - skipped);
}

static void leave_terminal(void)
{
    if (!resets_terminal)
        return;
    reset_terminal();
    terminal_query_forget();
}

/* Changes the state, and returns the one before. */
static int change_drawing_state(const int next[DRAWING_STATES])
{
    int state = atomic_load(&drawing_state);
    while (!atomic_compare_exchange_weak(&drawing_state, &state, next[state])) {
    }
    return state;
}

/* The process stops here, as it would without the handler, and goes on here. The state, DRAWING_FORBIDDEN or
 * DRAWING_IN_STOP, keeps others from being here too; the signal may be one that this thread blocks. */
static void stop_process(int number)
{
    struct sigaction by_default = {.sa_handler = SIG_DFL}, before;
    sigset_t own, mask;
    reset_terminal();
    sigemptyset(&own);
    sigaddset(&own, number);
    pthread_sigmask(SIG_BLOCK, &own, &mask);
    sigaction(number, &by_default, &before);
    raise(number);
    pthread_sigmask(SIG_UNBLOCK, &own, NULL);
    pthread_sigmask(SIG_BLOCK, &own, NULL);
    sigaction(number, &before, NULL);
    atomic_store(&was_stopped, true);
    change_drawing_state(STATE_BY_GOING_ON);
    pthread_sigmask(SIG_SETMASK, &mask, NULL);
}

static void on_terminal_stop(int number)
{
    const int error = errno;
    const int state = change_drawing_state(STATE_BY_SIGNAL);
    if (state == DRAWING_NOTHING || state == DRAWING_BEFORE_STOP) /* in a stop, that stop is this one */
        stop_process(number);
    errno = error;
}

void signals_reset_terminal(bool has_sixels)
{
    struct sigaction before, action = {.sa_handler = on_terminal_stop, .sa_flags = SA_RESTART};
    ends_sixels = has_sixels;
    resets_terminal = 1;
    /* where a shell without job control has set the signal to be ignored, it stays so */
    if (sigaction(SIGTSTP, NULL, &before) == 0 && before.sa_handler != SIG_IGN)
        sigaction(SIGTSTP, &action, NULL);
}

void signals_begin_drawing(void)
{
    const struct timespec a_while = {.tv_nsec = 1000000};
    for (int nothing = DRAWING_NOTHING; !atomic_compare_exchange_strong(&drawing_state, &nothing, DRAWING);
         nothing = DRAWING_NOTHING)
        nanosleep(&a_while, NULL);
}

void signals_end_drawing(void)
{
    /* the stop is here and not in another thread's handler, before which this thread might write more */
    if (change_drawing_state(STATE_BY_END) == DRAWING_BEFORE_STOP)
        stop_process(SIGTSTP);
}

bool signals_take_stopped(void) { return atomic_exchange(&was_stopped, false); }

static void on_stop(int number)
{
    if (stop_signal && number == SIGXCPU)
        return; /* it comes every second beyond the limit */
    if (stop_signal) {
        leave_terminal();
        ag_abandon_files();
        _exit(128 + number);
    }
    stop_signal = number;
    ag_end_waits();
    if (is_rendering)
        ag_context_pause(signalled_context);
    else
        ag_context_cancel(signalled_context);
}

static void on_snapshot(int number)
{
    (void)number;
    wants_snapshot = 1;
    ag_context_pause(signalled_context);
}

static void on_timer(int number)
{
    const int error = errno;
    const bool is_late = passes_seconds() >= atomic_load(&deadline);
    (void)number;
    if (is_late)
        atomic_store(&is_time_up, true);
    if (is_late && !is_rendering)
        ag_context_cancel(signalled_context);
    else
        ag_context_pause(signalled_context);
    errno = error;
}

static void block(int how)
{
    sigset_t caught;
    sigemptyset(&caught);
    for (size_t i = 0; i < sizeof STOPPING / sizeof *STOPPING; i++)
        sigaddset(&caught, STOPPING[i]);
    sigaddset(&caught, SIGUSR1);
    sigaddset(&caught, SIGALRM);
    sigprocmask(how, &caught, NULL);
}

/* The text is written at once, since a signal handler may not print. */
static void on_abort(int number)
{
    static const char TEXT[] =
        "afterglow: error: a library has given up, for the reason above if there is one; most often threads or memory are "
        "limited: try -t with fewer threads, or higher limits (ulimit -u, ulimit -v)\n";
    (void)number;
    leave_terminal();
    write_to_terminal(TEXT, sizeof TEXT - 1);
    ag_abandon_files();
    _exit(3);
}

void signals_catch_abort(void)
{
    struct sigaction action = {.sa_handler = on_abort, .sa_flags = (int)SA_RESETHAND};
    sigaction(SIGABRT, &action, NULL);
}

void signals_catch(ag_context *context)
{
    atomic_store(&is_time_up, false); /* it was set for the picture before */
    signalled_context = context;
    for (size_t i = 0; i < sizeof STOPPING / sizeof *STOPPING; i++) {
        struct sigaction before, action = {.sa_handler = on_stop, .sa_flags = SA_RESTART};
        /* signals that nohup or a shell's & have set to be ignored stay so */
        if (sigaction(STOPPING[i], NULL, &before) == 0 && before.sa_handler != SIG_IGN)
            sigaction(STOPPING[i], &action, NULL);
    }
    struct sigaction snapshot = {.sa_handler = on_snapshot, .sa_flags = SA_RESTART};
    struct sigaction timer = {.sa_handler = on_timer, .sa_flags = SA_RESTART};
    sigaction(SIGUSR1, &snapshot, NULL);
    sigaction(SIGALRM, &timer, NULL);
    /* a limit on file size is an error of the write, not the end */
    signal(SIGXFSZ, SIG_IGN);
    signal(SIGPIPE, SIG_IGN);
    if (is_released) /* signals that came since the last context are delivered now */
        block(SIG_UNBLOCK);
    is_released = false;
}

void signals_release(void)
{
    signals_set_deadline(INFINITY);
    block(SIG_BLOCK);
    is_released = true;
}

void signals_begin_rendering(void) { is_rendering = 1; }

void signals_end_rendering(void) { is_rendering = 0; }

int signals_stop(void) { return stop_signal; }

bool signals_take_snapshot(void)
{
    bool wanted = wants_snapshot;
    wants_snapshot = 0;
    return wanted;
}

void signals_set_timer(double seconds)
{
    struct itimerval timer = {0};
    if (!atomic_load(&is_time_up))
        seconds = fmin(seconds, atomic_load(&deadline) - passes_seconds());
    if (isfinite(seconds) && seconds < 1e9) {
        double at_least = fmax(seconds + 2e-6, 1e-3); /* rounded down, it would end before the deadline */
        timer.it_value.tv_sec = (time_t)at_least;
        timer.it_value.tv_usec = (suseconds_t)((at_least - floor(at_least)) * 1e6);
    }
    setitimer(ITIMER_REAL, &timer, NULL);
}

void signals_set_deadline(double at)
{
    atomic_store(&deadline, at);
    signals_set_timer(INFINITY);
}

bool signals_is_time_up(void) { return atomic_load(&is_time_up); }
