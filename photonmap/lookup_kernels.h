/* lookup_kernels.h: the inner loops of searches for many points at once, in plain C, for AVX2 and for AVX-512. All
 * versions do the same operations on the same numbers, so that their results have the same bits.
 * Rests on: Intel, "64 and IA-32 Architectures Optimization Reference Manual", ch. on AVX2 (gathers, compaction by
 * permutation). Flow: photon_nearest_many, irradiance_cache -> [here]. Threads: pure but for what the caller owns. */
#ifndef AFTERGLOW_LOOKUP_KERNELS_H
#define AFTERGLOW_LOOKUP_KERNELS_H

#include "photon_tree.h"

/* The points of lookups as columns: x, y, z, and the squared distance within which photons matter to each; negative:
 * none do. */
typedef struct lookup_columns {
    _Alignas(64) float column[PHOTON_TREE_AXES][PHOTON_LOOKUPS_MAX];
} lookup_columns;

enum { LOOKUP_REACH_SQUARED = 3 };
_Static_assert((int)LOOKUP_REACH_SQUARED < (int)PHOTON_TREE_AXES, "a node's axis picks a column");

/* Pairs of a lookup, by its number, and a node, a leaf or a photon that it comes to. */
enum { LOOKUP_VISITS_MAX = 16 * PHOTON_LOOKUPS_MAX };
typedef struct lookup_visits {
    uint32_t count;
    /* room for two children each, for all points besides, and for the rest of a vector */
    uint32_t lookup[2 * LOOKUP_VISITS_MAX + 2 * PHOTON_LOOKUPS_MAX + 16],
        node[2 * LOOKUP_VISITS_MAX + 2 * PHOTON_LOOKUPS_MAX + 16];
} lookup_visits;

typedef struct lookup_kernels {
    /* Finds photon_tree_leaf of each point. x, y, z are consecutive; `stride`: floats from one point to the next. */
    void (*find_leaves)(const photon_tree *tree, const float *positions, uint32_t stride, uint32_t count,
                        uint32_t *out_leaves);

    /* Returns, as bits, the points among PHOTON_LOOKUPS_MAX that have the plane within their reach. */
    uint64_t (*meet_plane)(const lookup_columns *points, photon_tree_node plane);

    /* Replaces nodes, at most LOOKUP_VISITS_MAX, by their children: the one on the lookup's side, and the other one
     * where its plane is within reach. */
    void (*descend)(const photon_tree *tree, const lookup_columns *points, const lookup_visits *nodes,
                    lookup_visits *out_children);

    /* Finds the nearest photon within reach of each leaf visited, the first of equally near ones; out_photons has
     * their indices as nodes. */
    void (*scan)(const photon_block *blocks, const lookup_columns *points, const lookup_visits *leaves,
                 lookup_visits *out_photons, float *out_distances_squared);
} lookup_kernels;

extern const lookup_kernels lookup_kernels_plain;

/* Return NULL where the compiler or the processor does not support these instructions. */
const lookup_kernels *lookup_kernels_avx2(void);
const lookup_kernels *lookup_kernels_avx512(void); /* F, BW, DQ and VL, POPCNT and BMI2 */

/* Returns the fastest kernels that this processor supports. */
const lookup_kernels *lookup_kernels_best(void);

#endif
