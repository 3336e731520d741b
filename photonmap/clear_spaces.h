/* clear_spaces.h: for each leaf of a map's tree the clear space around its first photon (rays/clear_space.h), found
 * when it is first asked for: most rays that estimates and lookups would cast stay within one, and need not be cast.
 * Flow: photon_map, irradiance_estimate -> [here] -> rays/clear_space. Threads: any number at once; a space is a
 * function of the map and its scene, so that it does not matter who finds it. */
#ifndef AFTERGLOW_CLEAR_SPACES_H
#define AFTERGLOW_CLEAR_SPACES_H

#include "atomics.h"
#include "photon_block.h"
#include "rays/clear_space.h"

/* A leaf's space. state: EMPTY, then BUSY while one thread writes the space, then READY for good. */
typedef struct clear_spaces_entry {
    clear_space space;
    atomic_u32 state;
} clear_spaces_entry;

typedef struct clear_spaces {
    const scene *s;             /* borrowed */
    const photon_block *blocks; /* borrowed, of the map */
    float radius;               /* out to which spaces are looked for, scene units */
    clear_spaces_entry entries[];
} clear_spaces;

/* Returns the bytes of the spaces of a map with so many blocks. */
static inline uint64_t clear_spaces_bytes(uint64_t block_count)
{
    return sizeof(clear_spaces) + block_count * sizeof(clear_spaces_entry);
}

/* Zeroed memory, whose pages are taken when they are first asked for. NULL when out of memory. Freed by free(). */
clear_spaces *clear_spaces_create(const scene *s, const photon_block *blocks, uint64_t block_count, float radius);

/* Returns the space around a block's first photon. spare: room for one that is found just now. */
const clear_space *clear_spaces_get(clear_spaces *spaces, uint32_t block, clear_space *spare);

#endif
