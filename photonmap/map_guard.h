/* map_guard.h: memory mapped from a file that somebody may cut short: touching what is gone would end the process by
 * SIGBUS. Guarded memory reads as zeros then, and it is known that it does.
 * Rests on: mmap(2), sigaction(2). Flow: photon_file. Threads: any. */
#ifndef AFTERGLOW_MAP_GUARD_H
#define AFTERGLOW_MAP_GUARD_H

#include <stdbool.h>
#include <stddef.h>

/* Guards a mapping; gives its number, or -1 where too many are guarded. The first one catches SIGBUS; faults elsewhere
 * go to who had it before. */
int map_guard_add(void *memory, size_t size_bytes);
/* Called before the memory is unmapped. -1 is fine. */
void map_guard_remove(int guard);
/* Whether a part of the memory was found gone; all of it has been zeros since. */
bool map_guard_is_lost(int guard);

#endif
