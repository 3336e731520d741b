/* photon_tree.h: a kd-tree over photons, in place: the records are put in order and become blocks.
 * Rests on: Bentley, "Multidimensional Binary Search Trees Used for Associative Searching", 1975; Arya, Mount,
 * "Algorithms for Fast Vector Quantization", 1993 (distances kept up to date on the way down). A leaf is a block of
 * sixteen photons, and leaf i of the perfect tree is block i: a node holds no more than its plane. Flow: photon_tracing
 * -> [here] -> photon_map. Threads: built by the run's workers; then read-only.
 *
 * Only photons whose normal is similar count, and that is tested inside the search: a test afterwards would let photons
 * on the other side of a thin wall use up the search. Ties go by (distance squared, index), so a result does not depend
 * on the way it was found. */
#ifndef AFTERGLOW_PHOTON_TREE_H
#define AFTERGLOW_PHOTON_TREE_H

#include "photon_block.h"
#include "run_context.h"

typedef struct photon_tree_node {
    float split;
    uint32_t axis;
} photon_tree_node;

/* The number of the lowest levels that may be looked at as a whole; what is empty there lies beyond infinite planes. */
enum { PHOTON_SUBTREE_LEVELS = 3, PHOTON_SUBTREE_LEAVES = 1 << PHOTON_SUBTREE_LEVELS };

typedef struct photon_tree {
    photon_block *blocks;    /* borrowed */
    uint32_t count;          /* of photons, below PHOTON_NONE */
    uint32_t depth;          /* all leaves are at this depth; 2^depth - 1 nodes, some with nothing on their right */
    photon_tree_node *nodes; /* children of i at 2 i + 1 and 2 i + 2 */
} photon_tree;

/* Puts the records, from photon_records_create, in order, so their indices change, and turns them into the tree's
 * blocks where they lie; on failure they are lost. Deterministic: equal input gives equal order for any number of
 * threads. Errors: AG_ERROR_MEMORY, AG_CANCELLED. phase and progress as in parallel_for. */
ag_status photon_tree_build(run_context *run, photon *photons, uint32_t count, double progress_begin,
                            double progress_end, photon_tree *out_tree);
void photon_tree_reset(photon_tree *tree);
uint64_t photon_tree_bytes(const photon_tree *tree); /* of the nodes */

/* A photon found: its squared distance as the high half, its index as the low half. Distances are not negative, so
 * their bits order as integers do: comparing two neighbours compares (distance squared, index). */
typedef uint64_t photon_neighbor;

static inline photon_neighbor photon_neighbor_make(float distance_squared, uint32_t index)
{
    uint32_t bits;
    __builtin_memcpy(&bits, &distance_squared, sizeof bits);
    return (uint64_t)bits << 32 | index;
}
static inline uint32_t photon_neighbor_index(photon_neighbor n) { return (uint32_t)n; }
static inline float photon_neighbor_distance_squared(photon_neighbor n)
{
    uint32_t bits = (uint32_t)(n >> 32);
    float distance_squared;
    __builtin_memcpy(&distance_squared, &bits, sizeof bits);
    return distance_squared;
}

/* The nearest photon within radius (inclusive) whose normal has a dot product above min_cos (>= 0) with `normal`;
 * PHOTON_NONE where there is none. */
uint32_t photon_tree_nearest(const photon_tree *tree, vec3 position, vec3 normal, float min_cos, float radius,
                             float *out_distance_squared);

/* The block of the leaf that a point falls into; of a tree that is not empty. */
uint32_t photon_tree_leaf(const photon_tree *tree, vec3 position);

enum { PHOTON_TREE_DEPTH_MAX = 32, PHOTON_WALK_AXES = 4 };

/* The way to a leaf, with the cells of the nodes along it: kept for the next lookup, which is cheap where its leaf is
 * not far. The fourth axis has no bounds. */
typedef struct photon_walk {
    const photon_tree *tree;
    const struct photon_kernels *kernels; /* for many at once: photon_kernels.h; they make no difference but in time */
    uint32_t way;                         /* to the leaf of the last lookup; 0: there was none */
    vec3 normal;                          /* of that lookup */
    float min_cos;                        /* likewise */
    uint32_t similar_code, other_code;    /* normals that were last found similar to it, and not */
    _Alignas(16) float low[PHOTON_TREE_DEPTH_MAX][PHOTON_WALK_AXES], high[PHOTON_TREE_DEPTH_MAX][PHOTON_WALK_AXES];
} photon_walk;

void photon_walk_init(photon_walk *walk, const photon_tree *tree); /* borrows the tree */

/* photon_tree_nearest at a point of the leaf that photon_tree_leaf tells: the same photon, whatever was looked up
 * before. */
uint32_t photon_walk_nearest(photon_walk *walk, uint32_t leaf, vec3 position, vec3 normal, float min_cos, float radius,
                             float *out_distance_squared);

/* A point to find the nearest photon of: position, unit normal, and the leaf that photon_tree_leaf tells. */
enum { PHOTON_LOOKUPS_MAX = 64 };
typedef struct photon_lookup {
    vec3 position, normal;
    uint32_t leaf;
} photon_lookup;

/* Finds the nearest photons of `count` points, from 1 to PHOTON_LOOKUPS_MAX, in the order of their leaves: much
 * cheaper. Where there is none, the index is PHOTON_NONE. */
void photon_walk_nearest_many(photon_walk *walk, const photon_lookup *lookups, uint32_t count, float min_cos,
                              float radius, photon_neighbor *out_nearest);

/* The `wanted` nearest photons within radius, in no order, but with the farthest of them last when all were found.
 * neighbors: room for photon_neighbors_capacity(wanted). *out_other_squared: how far, squared, the nearest
 * photon is that has another normal, yet no opposite one (beyond 120 degrees), if that is no farther than the photons
 * found or the radius; else more than that. Returns how many were found. */
uint32_t photon_tree_k_nearest(const photon_tree *tree, vec3 position, vec3 normal, float min_cos, float radius,
                               uint32_t wanted, photon_neighbor *neighbors, float *out_other_squared);

static inline uint32_t photon_neighbors_capacity(uint32_t wanted) { return 2 * wanted + 64; }

#endif
