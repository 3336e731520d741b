/* map_guard.h: guards memory that is mapped from a file against truncation of the file, which would end the process by
 * SIGBUS at the next access. Guarded memory then reads as zeros, and the loss can be queried.
 * Rests on: mmap(2), sigaction(2). Flow: photon_file. Threads: any. */
#ifndef AFTERGLOW_MAP_GUARD_H
#define AFTERGLOW_MAP_GUARD_H

#include <stdbool.h>
#include <stddef.h>

/* Guards a mapping; returns the guard's number, or -1 where 64 mappings are guarded already. Installs a SIGBUS handler
 * where it is not there, which passes faults elsewhere on to the one before. */
int map_guard_add(void *memory, size_t size_bytes);
/* Ends the guard; to be called before the memory is unmapped. -1 is fine. */
void map_guard_remove(int guard);
/* Returns whether a part of the memory was lost; all of it reads as zeros since then. */
bool map_guard_is_lost(int guard);

#endif
