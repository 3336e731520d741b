/* photon_found.h: the photons that a search has found, leaf by leaf. The squared distances of a leaf's sixteen photons
 * lie side by side, as the photons' columns do in their block, so selecting the nearest and summing a disc read whole
 * vectors of consecutive memory, and move no data. Flow: photon_k_nearest -> [here] -> disc_kernels,
 * irradiance_estimate. Threads: each belongs to one. */
#ifndef AFTERGLOW_PHOTON_FOUND_H
#define AFTERGLOW_PHOTON_FOUND_H

#include "photon_tree.h"

struct disc_kernels;

typedef struct photon_found {
    const photon_block *blocks;
    uint32_t *leaves;         /* [leaf_count] */
    float *distances_squared; /* [leaf_count][PHOTON_BLOCK_LANES]; of photons that do not count: not a number */
    uint32_t leaf_count, leaf_capacity;
    float limit;              /* squared distance: the photons found are those no farther */
    uint32_t count, capacity; /* of them; capacity - count >= PHOTON_BLOCK_LANES */
    float other_squared; /* squared distance of the nearest photon whose normal differs but is not about opposite */
    photon_neighbor farthest; /* the last of those wanted, where all were found */
    photon_neighbor *scratch; /* [capacity] */
} photon_found;

/* A worker's search leaves this for the worker's next search, which begins there. The hint changes how long a search
 * takes, and never what it finds. */
typedef struct photon_search_hint {
    vec3 position;        /* of the last search */
    float radius_squared; /* of the disc that it found; 0: there was none */
    uint32_t leaf;        /* in or beside which the next point lies; PHOTON_NONE: not known */
} photon_search_hint;

/* Borrows scratch memory for photon_neighbors_capacity(wanted) neighbours. */
void photon_found_init(photon_found *found, const photon_tree *tree, uint32_t wanted, photon_neighbor *scratch);

/* Finds the `wanted` nearest photons within radius, whose number becomes found->count; `found` is from
 * photon_found_init for as many. Where all were found, found->farthest is one of them, and found->limit its distance.
 * found->other_squared is photon_tree_k_nearest's *out_other_squared. in_out_hint may be NULL. */
void photon_found_search(photon_found *found, const photon_tree *tree, vec3 position, vec3 normal, float min_cos,
                         float radius, uint32_t wanted, photon_search_hint *in_out_hint);

/* photon_found_search and photon_tree_k_nearest by given kernels (disc_kernels.h), for tests that compare them. */
void photon_found_search_by(const struct disc_kernels *kernels, photon_found *found, const photon_tree *tree,
                            vec3 position, vec3 normal, float min_cos, float radius, uint32_t wanted,
                            photon_search_hint *in_out_hint);
uint32_t photon_tree_k_nearest_by(const struct disc_kernels *kernels, const photon_tree *tree, vec3 position,
                                  vec3 normal, float min_cos, float radius, uint32_t wanted, photon_neighbor *neighbors,
                                  float *out_other_squared);

/* Removes all but the `wanted` nearest photons, 1 to found->count; sets found->farthest and found->limit by them. */
void photon_found_keep_nearest(const struct disc_kernels *kernels, photon_found *found, uint32_t wanted);

/* Removes the leaves that contain no photon found. */
void photon_found_drop_empty_leaves(photon_found *found);

/* Returns the photon at an entry of distances_squared. */
static inline uint32_t photon_found_index(const photon_found *found, uint32_t entry)
{
    return found->leaves[entry / PHOTON_BLOCK_LANES] * PHOTON_BLOCK_LANES + entry % PHOTON_BLOCK_LANES;
}

/* Removes the photon at an entry of distances_squared. */
static inline void photon_found_forget_entry(photon_found *found, uint32_t entry)
{
    found->distances_squared[entry] = NAN;
    found->count--;
}

/* Removes a photon that is among those found. */
static inline void photon_found_forget(photon_found *found, photon_neighbor n)
{
    uint32_t index = photon_neighbor_index(n), i = 0;
    while (found->leaves[i] != index / PHOTON_BLOCK_LANES)
        i++;
    photon_found_forget_entry(found, i * PHOTON_BLOCK_LANES + index % PHOTON_BLOCK_LANES);
}

#endif
