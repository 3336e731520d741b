/* clear_spaces.c: see clear_spaces.h.
 * Threads: see clear_spaces.h. */
#include "clear_spaces.h"

#include <stdlib.h>

enum { EMPTY, BUSY, READY };

clear_spaces *clear_spaces_create(const scene *s, const photon_block *blocks, uint64_t block_count, float radius)
{
    clear_spaces *c = calloc(1, (size_t)clear_spaces_bytes(block_count));
    if (c)
        c->s = s, c->blocks = blocks, c->radius = radius, c->count = (uint32_t)block_count;
    return c;
}

const clear_space *clear_spaces_get(clear_spaces *spaces, uint32_t block, clear_space *spare)
{
    clear_spaces_entry *e = block < spaces->count ? &spaces->entries[block] : NULL;
    uint32_t first = block * PHOTON_BLOCK_LANES, expected = EMPTY;
    if (e && load_acquire_u32(&e->state) == READY) /* pairs with the release below */
        return &e->space;
    vec3 normal = direction_decode(photon_block_normal(spaces->blocks, first));
    clear_space_find(spaces->s, photon_block_position(spaces->blocks, first), normal, spaces->radius, spare);
    if (e && cas_acquire_u32(&e->state, &expected, BUSY)) {
        e->space = *spare;
        store_release_u32(&e->state, READY); /* pairs with the acquire above */
    }
    return spare;
}
