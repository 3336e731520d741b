/* signals.h: what the system tells the program while it works: stop, show the picture so far, time is up.
 * Flow: handlers -> [here] -> main, passes. Threads: main alone asks; handlers do no more than set flags. */
#ifndef AFTERGLOW_SIGNALS_H
#define AFTERGLOW_SIGNALS_H

#include "afterglow/afterglow.h"

#include <stdbool.h>

/* A library that aborts, since it cannot have threads or memory, ends the program with 3 and a message. */
void signals_catch_abort(void);

/* From now on a signal that ends the process at once ends what is drawn by sixels, where has_sixels, resets the
 * terminal's attributes, begins a line, and takes a late answer of the terminal's away. */
void signals_reset_terminal(bool has_sixels);

/* The first SIGINT, SIGTERM, SIGHUP or SIGXCPU (a soft limit of CPU time) lets the work end in order: rendering pauses,
 * all else is cancelled. The second ends the process at once, but for SIGXCPU, which the system repeats. */
void signals_catch(ag_context *context);
/* Forgets the context, which is about to be destroyed: signals wait from here on. */
void signals_release(void);

/* Between these two calls a signal to stop pauses the rendering. */
void signals_begin_rendering(void);
void signals_end_rendering(void);

/* The number of the signal to stop, 0: none so far. */
int signals_stop(void);
/* Whether SIGUSR1 asked for a snapshot since this was called last. */
bool signals_take_snapshot(void);

/* Pauses the rendering after so many seconds (at least a millisecond); INFINITY: never. */
void signals_set_timer(double seconds);

#endif
