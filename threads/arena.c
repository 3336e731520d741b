/* arena.c: see arena.h.
 * Flow: one per worker; a tile or a photon block allocates, and gives everything back at its end.
 * Threads: an arena belongs to one thread at a time. */
#include "arena.h"

#include <assert.h>
#include <stdalign.h>
#include <stdint.h>
#include <stdlib.h>

#define ARENA_ALIGNMENT ((size_t)64) /* a cache line, and the widest SIMD register */

/* The blocks form a chain. Those up to `current` are in use, those behind it are spare. */
typedef struct arena_block {
    alignas(64) struct arena_block *next;
    size_t size_bytes;   /* room behind this header */
    size_t before_bytes; /* in use in the blocks before this one; valid while this one is in use */
} arena_block;

static_assert(sizeof(arena_block) == 64, "what follows the header must be aligned too");

struct arena {
    arena_block *first, *current; /* current NULL: nothing is in use */
    size_t used_bytes;            /* in current */
    size_t block_bytes, peak_bytes;
};

arena *arena_create(size_t block_bytes)
{
    arena *a = calloc(1, sizeof *a);
    if (a)
        a->block_bytes = block_bytes;
    return a;
}

void arena_destroy(arena *a)
{
    if (!a)
        return;
    for (arena_block *block = a->first, *next; block; block = next) {
        next = block->next;
        free(block);
    }
    free(a);
}

/* Returns the first spare block with room for size_bytes (a multiple of the alignment), which it takes out of the
 * chain, or makes one. */
static arena_block *take_block(arena *a, size_t size_bytes)
{
    arena_block **link = a->current ? &a->current->next : &a->first;
    for (; *link; link = &(*link)->next)
        if ((*link)->size_bytes >= size_bytes) {
            arena_block *found = *link;
            *link = found->next;
            return found;
        }
    /* The block's size is a power of two, so that ever larger requests leave behind at most as much as the largest of
     * them took. */
    size_t capacity = ARENA_ALIGNMENT;
    while (capacity < size_bytes || capacity < a->block_bytes) {
        if (capacity > SIZE_MAX / 4)
            return NULL;
        capacity *= 2;
    }
    arena_block *block = aligned_alloc(ARENA_ALIGNMENT, sizeof *block + capacity);
    if (block)
        block->size_bytes = capacity;
    return block;
}

void *arena_alloc(arena *a, size_t size_bytes)
{
    if (size_bytes > SIZE_MAX / 4)
        return NULL;
    size_t rounded = size_bytes == 0 ? ARENA_ALIGNMENT : (size_bytes + ARENA_ALIGNMENT - 1) & ~(ARENA_ALIGNMENT - 1);
    if (!a->current || a->current->size_bytes - a->used_bytes < rounded) {
        arena_block *block = take_block(a, rounded);
        if (!block)
            return NULL;
        arena_block **link = a->current ? &a->current->next : &a->first;
        block->before_bytes = a->current ? a->current->before_bytes + a->used_bytes : 0;
        block->next = *link;
        *link = block;
        a->current = block;
        a->used_bytes = 0;
    }
    unsigned char *result = (unsigned char *)(a->current + 1) + a->used_bytes;
    a->used_bytes += rounded;
    if (a->current->before_bytes + a->used_bytes > a->peak_bytes)
        a->peak_bytes = a->current->before_bytes + a->used_bytes;
    return result;
}

arena_mark arena_save(const arena *a) { return (arena_mark){.block = a->current, .used_bytes = a->used_bytes}; }

void arena_restore(arena *a, arena_mark mark)
{
    assert(mark.block != a->current || mark.used_bytes <= a->used_bytes);
    a->current = mark.block;
    a->used_bytes = mark.used_bytes;
}

size_t arena_peak_bytes(const arena *a) { return a->peak_bytes; }
