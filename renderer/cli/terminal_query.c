/* terminal_query.c: see terminal_query.h. */
#define _DEFAULT_SOURCE
#include "terminal_query.h"

#include "passes.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <unistd.h>

enum { ANSWER_MOST = 512, NUMBERS_MOST = 32, SIXELS = 4, REGISTERS = 1, CELL_SIZE = 6, USUAL_COLORS = 256 };
static const double PATIENCE_SECONDS = 1.0;

static const char ASK_KIND[] = "\033[c";
/* How many colours, how large a character is; a terminal answers in turn, and does not answer what it does not know, so
 * that the last question is one that it knows. */
static const char ASK_DETAIL[] = "\033[?1;1;0S\033[16t\033[c";

static volatile sig_atomic_t owed_terminal = -1; /* a terminal that is open and has not answered yet; -1: none */

/* A control sequence of an answer: "ESC [ ? 1 ; 2 c" has the mark '?', the numbers 1 and 2, and the end 'c'. */
typedef struct sequence {
    char mark, end;
    int numbers[NUMBERS_MOST];
    int count;
} sequence;

/* Finds the first whole sequence. Returns what stands behind it; NULL: there is none. */
static const char *next_sequence(const char *at, const char *end, sequence *out)
{
    for (; (at = memchr(at, '\033', (size_t)(end - at))); at++) {
        const char *c = at + 1;
        if (c == end || *c != '[')
            continue;
        *out = (sequence){0};
        if (++c < end && *c >= '<' && *c <= '?')
            out->mark = *c++;
        for (int number = 0; c < end; c++) {
            const bool is_digit = *c >= '0' && *c <= '9';
            if (is_digit) {
                number = number < 1000000 ? 10 * number + (*c - '0') : number;
                continue;
            }
            if (out->count < NUMBERS_MOST)
                out->numbers[out->count++] = number;
            number = 0;
            if (*c == ';')
                continue;
            out->end = *c;
            if (*c >= '@' && *c <= '~')
                return c + 1;
            break;
        }
    }
    return NULL;
}

static void learn(const sequence *s, terminal_abilities *out)
{
    if (s->mark == '?' && s->end == 'c') {
        for (int i = 1; i < s->count; i++) /* the first one is the terminal's class */
            out->has_sixels = out->has_sixels || s->numbers[i] == SIXELS;
    } else if (s->mark == '?' && s->end == 'S') {
        if (s->count == 3 && s->numbers[0] == REGISTERS && s->numbers[1] == 0 && s->numbers[2] >= TERMINAL_LEAST_COLORS)
            out->color_count = s->numbers[2] < TERMINAL_MOST_COLORS ? s->numbers[2] : TERMINAL_MOST_COLORS;
    } else if (s->end == 't' && s->count == 3 && s->numbers[0] == CELL_SIZE) {
        out->cell_height = s->numbers[1];
        out->cell_width = s->numbers[2];
    }
}

/* Waits for POLLIN or POLLOUT. Returns false where it has not come in that time, or never will. */
static bool is_ready(int terminal, short event, double until)
{
    struct pollfd asked = {.fd = terminal, .events = event};
    const double left = until - passes_seconds();
    return poll(&asked, 1, left > 0.0 ? (int)(left * 1e3) + 1 : 0) == 1 && (asked.revents & event);
}

/* Writes a text to the terminal. Returns false where the terminal did not take all of it. */
static bool write_all(int terminal, const char *text, double until)
{
    size_t left = strlen(text);
    while (left > 0) {
        if (!is_ready(terminal, POLLOUT, until))
            return false;
        const ssize_t written = write(terminal, text, left);
        if (written < 0 && ((errno != EINTR && errno != EAGAIN) || passes_seconds() > until))
            return false;
        text += written > 0 ? written : 0;
        left -= written > 0 ? (size_t)written : 0;
    }
    return true;
}

/* Asks, and reads the answers until the terminal has told its kind. Returns false where it has not. */
static bool ask(int terminal, const char *question, double until, terminal_abilities *out)
{
    char got[ANSWER_MOST];
    size_t length = 0;
    if (!write_all(terminal, question, until))
        return false;
    while (length < sizeof got && is_ready(terminal, POLLIN, until)) {
        const ssize_t more = read(terminal, got + length, sizeof got - length);
        if (more <= 0)
            return false;
        length += (size_t)more;
        sequence s;
        for (const char *at = got; (at = next_sequence(at, got + length, &s));)
            if (s.mark == '?' && s.end == 'c') {
                for (at = got; (at = next_sequence(at, got + length, &s));)
                    learn(&s, out);
                return true;
            }
    }
    return false;
}

/* Sets the terminal to give each byte as it comes, and to show none of them. */
static bool ask_all(int terminal, terminal_abilities *out)
{
    const double until = passes_seconds() + PATIENCE_SECONDS;
    if (is_ready(terminal, POLLIN, 0.0))
        return false;
    bool is_whole = ask(terminal, ASK_KIND, until, out);
    if (is_whole && out->has_sixels)
        is_whole = ask(terminal, ASK_DETAIL, until, out);
    if (!is_whole)
        owed_terminal = terminal;
    return is_whole;
}

bool terminal_query(int descriptor, terminal_abilities *out)
{
    *out = (terminal_abilities){.color_count = USUAL_COLORS};
    struct termios before, during;
    sigset_t all, signals_before;
    /* a session has one controlling terminal; opened anew, since O_NONBLOCK holds for all who share what was opened */
    const int terminal =
        tcgetsid(descriptor) == getsid(0) ? open("/dev/tty", O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK) : -1;
    if (terminal < 0)
        return false;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all,
                    &signals_before); /* a process that ended now would leave a terminal without echo */
    bool is_told = false;
    if (tcgetpgrp(terminal) == getpgrp() && tcgetattr(terminal, &before) == 0) {
        during = before;
        during.c_lflag &= ~(tcflag_t)(ICANON | ECHO | ECHONL);
        during.c_cc[VMIN] = during.c_cc[VTIME] = 0;
        if (tcsetattr(terminal, TCSANOW, &during) == 0) {
            is_told = ask_all(terminal, out);
            tcsetattr(terminal, TCSANOW, &before);
        }
    }
    pthread_sigmask(SIG_SETMASK, &signals_before, NULL);
    if (owed_terminal != terminal)
        close(terminal);
    return is_told;
}

void terminal_query_forget(void)
{
    const int terminal = (int)owed_terminal;
    /* in the background SIGTTOU would stop the process, and what is typed is another's */
    if (terminal >= 0 && tcgetpgrp(terminal) == getpgrp())
        tcflush(terminal, TCIFLUSH);
}
