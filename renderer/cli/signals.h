/* signals.h: what the system tells the program while it works: stop, show the picture so far; and that time is up.
 * Flow: handlers -> [here] -> main, passes, progress. Threads: main's alone, but for the functions about drawing, which
 * progress calls from any thread. Handlers set flags and pause or cancel the context; those that end the process or
 * stop it reset the terminal before, and those that end it at once write why and remove unfinished files. */
#ifndef AFTERGLOW_SIGNALS_H
#define AFTERGLOW_SIGNALS_H

#include "afterglow/afterglow.h"

#include <stdbool.h>

/* From now on a library that aborts because it gets no threads or memory ends the program with exit code 3 and a
 * message. */
void signals_catch_abort(void);

/* From now on a signal that ends the process at once, or stops it (SIGTSTP, as Ctrl-Z sends it), ends what is drawn by
 * sixels, where has_sixels, resets the terminal's attributes and begins a line, if the terminal takes that within a
 * second; one that ends it takes a late answer of the terminal's away too. */
void signals_reset_terminal(bool has_sixels);
/* Between these two calls the first SIGTSTP waits for the second call, which then stops the process before it returns,
 * so that what is drawn is whole and nothing follows it; the next SIGTSTP stops the process at once. The first call
 * waits while the process is being stopped. To be called by one thread at a time. */
void signals_begin_drawing(void);
void signals_end_drawing(void);
/* Returns whether the process was stopped by SIGTSTP since the last call, so that others may have written to the
 * terminal. To be called while drawing, when only a second SIGTSTP can stop the process between the answer and what is
 * drawn. */
bool signals_take_stopped(void);

/* The first SIGINT, SIGTERM, SIGHUP or SIGXCPU (a soft limit of CPU time) lets the work end in order: rendering pauses,
 * all else is cancelled. The second ends the process at once, but for SIGXCPU, which the system repeats. */
void signals_catch(ag_context *context);
/* Forgets the context, which is about to be destroyed: signals wait from here on. */
void signals_release(void);

/* Between these two calls a signal to stop pauses the rendering. */
void signals_begin_rendering(void);
void signals_end_rendering(void);

/* Returns the number of the signal to stop, 0: none so far. */
int signals_stop(void);
/* Returns whether SIGUSR1 asked for a snapshot since the last call. */
bool signals_take_snapshot(void);

/* Pauses the rendering after so many seconds (at least a millisecond); INFINITY: never. */
void signals_set_timer(double seconds);

/* Sets when the time is up, in seconds of passes_seconds(): rendering pauses then, all else is cancelled, as by a
 * signal to stop. INFINITY: never. signals_catch forgets that it was up. */
void signals_set_deadline(double at);
bool signals_is_time_up(void);

#endif
