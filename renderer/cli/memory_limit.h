/* memory_limit.h: the memory that --memory allows the process.
 * Rests on: getrlimit(2), RLIMIT_DATA; proc_pid_status(5). Flow: options -> main -> [here]. Threads: main's. */
#ifndef AFTERGLOW_MEMORY_LIMIT_H
#define AFTERGLOW_MEMORY_LIMIT_H

#include "afterglow/afterglow.h"

#include <stdbool.h>

/* Makes allocations fail that would bring the process beyond this many resident bytes, if it touched all that it
 * allocates. Since libraries and heaps reserve what they never touch, 24 MB more are allowed; before the scene is there
 * (is_loaded), and with it what ray tracing reserves, 256 MB. */
void memory_limit_set(uint64_t bytes, bool is_loaded);

/* Takes the limit away: for what the prediction does not know, and for the next picture's scene. */
void memory_limit_lift(void);

/* Whether what is predicted keeps within the limit; says on standard error what does not. */
bool memory_limit_holds(uint64_t bytes, const ag_prediction *prediction);

#endif
