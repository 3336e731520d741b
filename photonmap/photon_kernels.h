/* photon_kernels.h: the inner loops of searches for many points at once, once for any processor and once for AVX2. Both
 * do the same operations on the same numbers, so what they find is the same, to the bit.
 * Rests on: Intel, "64 and IA-32 Architectures Optimization Reference Manual", ch. on AVX2 (gathers, compaction by
 * permutation). Flow: photon_nearest_many, irradiance_cache -> [here]. Threads: pure but for what the caller owns. */
#ifndef AFTERGLOW_PHOTON_KERNELS_H
#define AFTERGLOW_PHOTON_KERNELS_H

#include "photon_tree.h"

/* Points by their numbers as columns: x, y, z, and the squared distance within which photons still matter to each;
 * negative: none does. */
typedef struct photon_reach {
    _Alignas(32) float column[4][PHOTON_LOOKUPS_MAX];
} photon_reach;

enum { PHOTON_REACH_SQUARED = 3 };

/* Pairs of a lookup and a node, or a leaf, that it has to visit. */
enum { PHOTON_VISITS_MAX = 16 * PHOTON_LOOKUPS_MAX };
typedef struct photon_visits {
    uint32_t count;
    /* room for two children each, for all points on top, and for a vector that sticks out */
    uint32_t lookup[2 * PHOTON_VISITS_MAX + 2 * PHOTON_LOOKUPS_MAX + 16],
        node[2 * PHOTON_VISITS_MAX + 2 * PHOTON_LOOKUPS_MAX + 16];
} photon_visits;

typedef struct photon_kernels {
    /* The leaves that points fall into: photon_tree_leaf of each. x, y, z stand side by side, and `stride` floats on
     * those of the next lookup. */
    void (*find_leaves)(const photon_tree *tree, const float *positions, uint32_t stride, uint32_t count,
                        uint32_t *out_leaves);

    /* Finds the points, of PHOTON_LOOKUPS_MAX, that have the plane within their reach; as bits. */
    uint64_t (*meet_plane)(const photon_reach *reach, photon_tree_node plane);

    /* Goes from nodes, at most PHOTON_VISITS_MAX, to their children: the one on the lookup's side, and the other where
     * its plane is within reach. */
    void (*descend)(const photon_tree *tree, const photon_reach *reach, const photon_visits *nodes,
                    photon_visits *out_children);

    /* The nearest photon of each leaf visited, of equally near ones the first, where it is within reach; out_photons
     * has them as nodes. */
    void (*scan)(const photon_block *blocks, const photon_reach *reach, const photon_visits *leaves,
                 photon_visits *out_photons, float *out_distances_squared);
} photon_kernels;

extern const photon_kernels photon_kernels_plain;

/* NULL where neither the compiler nor the processor knows AVX2. */
const photon_kernels *photon_kernels_avx2(void);

/* The fastest that this processor has. */
const photon_kernels *photon_kernels_best(void);

#endif
