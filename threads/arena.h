/* arena.h: scratch memory for one worker: a stack of allocations, given back all at once.
 * Threads: an arena belongs to one thread at a time. */
#ifndef AFTERGLOW_ARENA_H
#define AFTERGLOW_ARENA_H

#include <stddef.h>

typedef struct arena arena;
typedef struct arena_mark {
    void *block;
    size_t used_bytes;
} arena_mark;

/* Returns NULL when out of memory. It grows by blocks of at least block_bytes and keeps them until it is destroyed. */
arena *arena_create(size_t block_bytes);
void arena_destroy(arena *a); /* NULL is fine */

/* Allocates memory aligned to 64 bytes, its contents undefined. Returns NULL when out of memory. size 0 gives a valid
 * pointer. */
void *arena_alloc(arena *a, size_t size_bytes);

arena_mark arena_save(const arena *a);
void arena_restore(arena *a, arena_mark mark); /* gives back what was allocated since */

/* Returns the most bytes that were in use at once, each allocation rounded up to 64. */
size_t arena_peak_bytes(const arena *a);

#endif
