/* signals.c: see signals.h. */
#define _GNU_SOURCE
#include "signals.h"

#include "terminal_query.h"

#include <math.h>
#include <signal.h>
#include <stddef.h>
#include <sys/time.h>
#include <unistd.h>

static ag_context *signalled_context;
static volatile sig_atomic_t stop_signal, wants_snapshot, is_rendering;

static volatile sig_atomic_t resets_terminal, ends_sixels;

static bool is_released; /* signals are blocked, by us */

static const int STOPPING[] = {SIGINT, SIGTERM, SIGHUP, SIGXCPU};

static void reset_terminal(void)
{
    static const char END_SIXELS[] = "\033\\", RESET[] = "\033[0m\r\n";
    if (!resets_terminal)
        return;
    ssize_t ignored = ends_sixels ? write(STDERR_FILENO, END_SIXELS, sizeof END_SIXELS - 1) : 0;
    ignored = write(STDERR_FILENO, RESET, sizeof RESET - 1);
    (void)ignored;
    terminal_query_forget();
}

void signals_reset_terminal(bool has_sixels)
{
    ends_sixels = has_sixels;
    resets_terminal = 1;
}

static void on_stop(int number)
{
    if (stop_signal && number == SIGXCPU)
        return; /* it comes every second beyond the limit */
    if (stop_signal) {
        reset_terminal();
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
    (void)number;
    ag_context_pause(signalled_context);
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
    reset_terminal();
    ssize_t ignored = write(STDERR_FILENO, TEXT, sizeof TEXT - 1);
    (void)ignored;
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
    signalled_context = context;
    for (size_t i = 0; i < sizeof STOPPING / sizeof *STOPPING; i++) {
        struct sigaction before, action = {.sa_handler = on_stop, .sa_flags = SA_RESTART};
        /* what nohup or a shell's & have set to be ignored stays so */
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
    signals_set_timer(INFINITY);
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
    if (isfinite(seconds) && seconds < 1e9) {
        double at_least = fmax(seconds, 1e-3);
        timer.it_value.tv_sec = (time_t)at_least;
        timer.it_value.tv_usec = (suseconds_t)((at_least - floor(at_least)) * 1e6);
    }
    setitimer(ITIMER_REAL, &timer, NULL);
}
