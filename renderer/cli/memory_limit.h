/* memory_limit.h: the memory that --memory allows the process.
 * Rests on: getrlimit(2), RLIMIT_DATA; proc_pid_status(5). Flow: options -> main -> [here]. Threads: main's, and one of
 * its own that watches while the scene is read. */
#ifndef AFTERGLOW_MEMORY_LIMIT_H
#define AFTERGLOW_MEMORY_LIMIT_H

#include "afterglow/afterglow.h"

#include <stdbool.h>

/* Makes allocations fail that would bring the process beyond this many resident bytes, if it touched all that it
 * allocates. Since libraries and heaps reserve what they never touch, 24 MB more are allowed; before the scene is there
 * (is_loaded), and with it what ray tracing reserves, 256 MB. */
void memory_limit_set(uint64_t bytes, bool is_loaded);

/* While the scene is read: cancels the context once the process has more resident bytes than this, at which it looks
 * every 2 ms; 24 MB more than there are now are
 * always allowed, for a small scene's needs to be told. Without a thread to do so, the limit that is set is the only
 * one. The context is to outlive memory_limit_end_watch. */
void memory_limit_watch(uint64_t bytes, ag_context *context);
/* Ends that. Returns whether there were more. */
bool memory_limit_end_watch(void);

/* Takes the limit away: for what the prediction does not know, and for the next picture's scene. */
void memory_limit_lift(void);

/* Whether what is predicted keeps within the limit; says on standard error what does not. */
bool memory_limit_holds(uint64_t bytes, const ag_prediction *prediction);

#endif
