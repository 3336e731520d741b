/* clear_spaces.h: the clear space (rays/clear_space.h) around the first photon of each leaf of a map's tree, found at
 * its first use. Most rays of estimates and lookups stay within such a space, so they need not be cast. Flow:
 * photon_map, irradiance_estimate -> [here] -> rays/clear_space. Threads: any number at once; a space is a function of
 * the map and its scene, so that it does not matter who finds it. */
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
    float radius;               /* largest radius of a space, scene units */
    uint32_t count;             /* of the map's blocks */
    clear_spaces_entry entries[];
} clear_spaces;

/* Returns the bytes of the spaces of a map with that many blocks. */
static inline uint64_t clear_spaces_bytes(uint64_t block_count)
{
    return sizeof(clear_spaces) + block_count * sizeof(clear_spaces_entry);
}

/* Allocates empty spaces, whose pages the system provides at their first use. Returns NULL when out of memory; free()
 * releases them. */
clear_spaces *clear_spaces_create(const scene *s, const photon_block *blocks, uint64_t block_count, float radius);

/* Returns the space around a block's first photon: the stored one, or *spare, into which this call has written it. The
 * block may be one that is not there, as a tree whose file was overwritten may have it. */
const clear_space *clear_spaces_get(clear_spaces *spaces, uint32_t block, clear_space *spare);

#endif
