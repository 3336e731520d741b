/* photon_kernels.h: the inner loops of searches for many points at once, in plain C, for AVX2 and for AVX-512. All
 * versions do the same operations on the same numbers, so that their results have the same bits.
 * Rests on: Intel, "64 and IA-32 Architectures Optimization Reference Manual", ch. on AVX2 (gathers, compaction by
 * permutation). Flow: photon_nearest_many, irradiance_cache -> [here]. Threads: pure but for what the caller owns. */
#ifndef AFTERGLOW_PHOTON_KERNELS_H
#define AFTERGLOW_PHOTON_KERNELS_H

#include "photon_tree.h"

/* Points as columns: x, y, z, and the squared distance within which photons matter to each; negative: none do. */
typedef struct photon_reach {
    _Alignas(64) float column[4][PHOTON_LOOKUPS_MAX];
} photon_reach;

enum { PHOTON_REACH_SQUARED = 3 };

/* Pairs of a lookup and a node or leaf that it has to visit. */
enum { PHOTON_VISITS_MAX = 16 * PHOTON_LOOKUPS_MAX };
typedef struct photon_visits {
    uint32_t count;
    /* room for two children each, for all points besides, and for the rest of a vector */
    uint32_t lookup[2 * PHOTON_VISITS_MAX + 2 * PHOTON_LOOKUPS_MAX + 16],
        node[2 * PHOTON_VISITS_MAX + 2 * PHOTON_LOOKUPS_MAX + 16];
} photon_visits;

typedef struct photon_kernels {
    /* Finds photon_tree_leaf of each point. x, y, z are consecutive; `stride`: floats from one point to the next. */
    void (*find_leaves)(const photon_tree *tree, const float *positions, uint32_t stride, uint32_t count,
                        uint32_t *out_leaves);

    /* Returns, as bits, the points among PHOTON_LOOKUPS_MAX that have the plane within their reach. */
    uint64_t (*meet_plane)(const photon_reach *reach, photon_tree_node plane);

    /* Replaces nodes, at most PHOTON_VISITS_MAX, by their children: the one on the lookup's side, and the other one
     * where its plane is within reach. */
    void (*descend)(const photon_tree *tree, const photon_reach *reach, const photon_visits *nodes,
                    photon_visits *out_children);

    /* Finds the nearest photon within reach of each leaf visited, the first of equally near ones; out_photons stores
     * them in place of nodes. */
    void (*scan)(const photon_block *blocks, const photon_reach *reach, const photon_visits *leaves,
                 photon_visits *out_photons, float *out_distances_squared);
} photon_kernels;

extern const photon_kernels photon_kernels_plain;

/* Return NULL where the compiler or the processor does not support these instructions. */
const photon_kernels *photon_kernels_avx2(void);
const photon_kernels *photon_kernels_avx512(void); /* F, BW, DQ and VL, POPCNT and BMI2 */

/* Returns the fastest kernels that this processor supports. */
const photon_kernels *photon_kernels_best(void);

#endif
