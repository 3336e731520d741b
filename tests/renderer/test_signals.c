/* test_signals.c: SIGTSTP beside what is drawn in a terminal: the process stops between drawings and writes nothing
 * else before, and what a shell has written meanwhile stays; terminals that are held hold no process that ends.
 * Flow: tests of renderer/cli/signals.c and progress.c. Threads: each child's own; it leads a process group of this
 * session, since those of no shell are not stopped. */
#define _GNU_SOURCE
#include "passes.h"
#include "progress.h"
#include "signals.h"

#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

enum { TEXT_MOST = 4096, PATIENCE_MS = 60000 };

/* A pseudo-terminal that is standard error of a child, and a pipe from it that nothing holds. */
typedef struct desk {
    int terminal, own;
    int told[2];
    pid_t child;
} desk;

static desk d;

/* Of the program's passes, which are not here. */
double passes_seconds(void) { return 0.0; }

static void begin(void (*fn)(void), bool is_held)
{
    struct termios modes;
    d.terminal = posix_openpt(O_RDWR | O_NOCTTY);
    assert_true(d.terminal >= 0 && grantpt(d.terminal) == 0 && unlockpt(d.terminal) == 0);
    d.own = open(ptsname(d.terminal), O_RDWR | O_NOCTTY);
    assert_true(d.own >= 0);
    assert_int_equal(tcgetattr(d.own, &modes), 0);
    cfmakeraw(&modes);
    assert_int_equal(tcsetattr(d.own, TCSANOW, &modes), 0);
    if (is_held)
        assert_int_equal(tcflow(d.own, TCOOFF), 0);
    assert_int_equal(pipe2(d.told, O_NONBLOCK | O_CLOEXEC), 0);
    d.child = fork();
    assert_true(d.child >= 0);
    if (d.child == 0) {
        setpgid(0, 0);
        dup2(d.own, STDERR_FILENO);
        signal(SIGTSTP, SIG_DFL);
        signals_reset_terminal(false);
        fn();
        _exit(0);
    }
}

static void end(void)
{
    close(d.terminal);
    close(d.own);
    close(d.told[0]);
    close(d.told[1]);
}

/* Reads what the terminal has been sent up to here. The system brings it in its own time, but in its order. */
static const char *sent(void)
{
    static const char MARK[] = "<end>";
    static char text[TEXT_MOST];
    size_t length = 0;
    char *at = NULL;
    assert_int_equal(write(d.own, MARK, strlen(MARK)), strlen(MARK));
    while (!at) {
        struct pollfd asked = {.fd = d.terminal, .events = POLLIN};
        assert_int_equal(poll(&asked, 1, PATIENCE_MS), 1);
        const ssize_t more = read(d.terminal, text + length, sizeof text - 1 - length);
        assert_true(more > 0);
        length += (size_t)more;
        text[length] = '\0';
        at = strstr(text, MARK);
    }
    *at = '\0';
    return text;
}

static const char *told(void)
{
    static char text[TEXT_MOST];
    const ssize_t length = read(d.told[0], text, sizeof text - 1);
    text[length > 0 ? length : 0] = '\0';
    return text;
}

/* Waits until the child has stopped or ended, as it should, or kills it. */
static int wait_for_child(void)
{
    const struct timespec a_while = {.tv_nsec = 1000000};
    int status;
    for (int waited_ms = 0; waitpid(d.child, &status, WUNTRACED | WNOHANG) == 0; waited_ms++) {
        if (waited_ms == PATIENCE_MS)
            kill(d.child, SIGKILL);
        nanosleep(&a_while, NULL);
    }
    return status;
}

static void expect_stop(void)
{
    const int status = wait_for_child();
    assert_true(WIFSTOPPED(status));
    assert_int_equal(WSTOPSIG(status), SIGTSTP);
}

static void go_on(void) { assert_int_equal(kill(d.child, SIGCONT), 0); }

static void expect_exit(int expected)
{
    const int status = wait_for_child();
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), expected);
}

/* --- children's --- */

static void draw(const char *text)
{
    if (write(STDERR_FILENO, text, strlen(text)) != (ssize_t)strlen(text))
        _exit(10);
}

static void tell(const char *text)
{
    if (write(d.told[1], text, strlen(text)) != (ssize_t)strlen(text))
        _exit(11);
}

/* As the library's threads are, which take no signals. */
static void run_beside(void *(*fn)(void *))
{
    pthread_t thread;
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    if (pthread_create(&thread, NULL, fn, NULL) != 0)
        _exit(12);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    pthread_join(thread, NULL);
}

static void *draw_with_a_stop(void *unused)
{
    sigset_t stop;
    sigemptyset(&stop);
    sigaddset(&stop, SIGTSTP);
    signals_begin_drawing();
    draw("picture");
    /* the handler has run when raise returns */
    pthread_sigmask(SIG_UNBLOCK, &stop, NULL);
    raise(SIGTSTP);
    pthread_sigmask(SIG_BLOCK, &stop, NULL);
    draw(" and bar");
    signals_end_drawing();
    signals_begin_drawing();
    if (!signals_take_stopped() || signals_take_stopped())
        _exit(1);
    draw("next");
    signals_end_drawing();
    return unused;
}

static void draw_beside(void) { run_beside(draw_with_a_stop); }

static bool is_in_handler(void)
{
    char name[64], line[256];
    unsigned long long blocked = 0;
    snprintf(name, sizeof name, "/proc/self/task/%d/status", (int)getpid());
    FILE *file = fopen(name, "r");
    if (!file)
        _exit(13);
    while (fgets(line, sizeof line, file))
        if (strncmp(line, "SigBlk:", 7) == 0)
            blocked = strtoull(line + 7, NULL, 16);
    fclose(file);
    return blocked >> (SIGTSTP - 1) & 1;
}

static pthread_t children_main;

static void *draw_in_the_handlers_time(void *unused)
{
    const struct timespec longer_than_it_waits = {.tv_sec = 1, .tv_nsec = 500000000};
    pthread_kill(children_main, SIGTSTP);
    while (!is_in_handler()) {
    }
    signals_begin_drawing();
    tell("<");
    nanosleep(&longer_than_it_waits, NULL);
    tell(">");
    signals_end_drawing();
    return unused;
}

static void stop_while_held(void)
{
    children_main = pthread_self();
    run_beside(draw_in_the_handlers_time);
}

static void draw_with_three_signals(void)
{
    signals_begin_drawing();
    draw("a");
    raise(SIGTSTP);
    draw("b");
    raise(SIGTSTP); /* it does not wait */
    draw("c");
    raise(SIGTSTP); /* the first one since */
    draw("d");
    signals_end_drawing();
    draw("e");
}

static progress a_drawn_one(void)
{
    return (progress){.style = PROGRESS_PICTURE, .bar_is_shown = true, .watch = {.drawn_rows = 5, .version = 1}};
}

static void tell_messages(void)
{
    progress p = a_drawn_one();
    progress_log(&p, AG_LOG_ERROR, "before");
    p = a_drawn_one();
    raise(SIGTSTP);
    progress_log(&p, AG_LOG_ERROR, "after");
}

static void tell_files(void)
{
    static const char *const FILES[] = {"a.exr"};
    static const bool IS_WRITTEN[] = {true};
    progress p = a_drawn_one();
    raise(SIGTSTP);
    progress_tell_written(&p, FILES, IS_WRITTEN, 1);
}

static void give_up(void)
{
    signals_catch_abort();
    abort();
}

/* --- */

static void test_nothing_before_the_stop(void **state)
{
    (void)state;
    begin(draw_beside, false);
    expect_stop();
    assert_string_equal(sent(), "picture and bar\033[0m\r\n");
    go_on();
    expect_exit(0);
    assert_string_equal(sent(), "next");
    end();
}

static void test_no_drawing_begins_in_a_stop(void **state)
{
    (void)state;
    begin(stop_while_held, true);
    expect_stop();
    char all[TEXT_MOST];
    snprintf(all, sizeof all, "%s", told());
    assert_true(strcmp(all, "") == 0 || strcmp(all, "<>") == 0);
    go_on();
    expect_exit(0);
    assert_int_equal(strlen(all) + strlen(told()), 2);
    end();
}

static void test_second_signal(void **state)
{
    (void)state;
    begin(draw_with_three_signals, false);
    expect_stop();
    assert_string_equal(sent(), "ab\033[0m\r\n");
    go_on();
    expect_stop();
    assert_string_equal(sent(), "cd\033[0m\r\n");
    go_on();
    expect_exit(0);
    assert_string_equal(sent(), "e");
    end();
}

static void test_messages_below_the_shells(void **state)
{
    (void)state;
    begin(tell_messages, false);
    expect_stop();
    assert_string_equal(sent(), "\r\033[5A\033[Jafterglow: error: before\n\033[0m\r\n");
    go_on();
    expect_exit(0);
    assert_string_equal(sent(), "afterglow: error: after\n");
    end();
    begin(tell_files, false);
    expect_stop();
    assert_string_equal(sent(), "\033[0m\r\n");
    go_on();
    expect_exit(0);
    assert_string_equal(sent(), "afterglow: wrote a.exr in 0:00\n");
    end();
}

static void test_abort_while_held(void **state)
{
    (void)state;
    begin(give_up, true);
    expect_exit(3);
    end();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_nothing_before_the_stop), cmocka_unit_test(test_no_drawing_begins_in_a_stop),
        cmocka_unit_test(test_second_signal),           cmocka_unit_test(test_messages_below_the_shells),
        cmocka_unit_test(test_abort_while_held),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
