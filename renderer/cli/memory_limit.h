/* memory_limit.h: the memory that --memory allows the process.
 * Rests on: getrlimit(2), RLIMIT_DATA; proc_pid_status(5). Flow: options -> main -> [here]. Threads: main's, and one of
 * its own that watches while the scene is read. */
#ifndef AFTERGLOW_MEMORY_LIMIT_H
#define AFTERGLOW_MEMORY_LIMIT_H

#include "afterglow/afterglow.h"

#include <stdbool.h>

/* Makes allocations fail that would bring the process beyond so many resident bytes, if it touched all that it
 * allocates. Libraries and heaps reserve what they never touch, so 24 MB more are allowed; before the scene is there
 * (is_loaded false) 256 MB more, with what ray tracing reserves. */
void memory_limit_set(uint64_t bytes, bool is_loaded);

/* Begins to watch the process, while the scene is read: a thread looks every 2 ms how many resident bytes it has, and
 * cancels the context once there are more than `bytes`, and 24 MB more than when the watch began, so that a small
 * scene's needs can be told. Where no thread can be had, memory_limit_set alone bounds the reading. The context is to
 * outlive memory_limit_end_watch. */
void memory_limit_watch(uint64_t bytes, ag_context *context);
/* Ends the watch of memory_limit_watch. Returns whether it has cancelled the context. */
bool memory_limit_end_watch(void);

/* Takes the limit away, for work that the prediction does not cover, and for reading the next picture's scene. */
void memory_limit_lift(void);

/* Returns whether what is predicted keeps within the limit; says on standard error what does not. */
bool memory_limit_holds(uint64_t bytes, const ag_prediction *prediction);

#endif
