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

/* The number of the lowest levels that searches may treat as a whole; their empty parts lie beyond infinite planes. */
enum { PHOTON_SUBTREE_LEVELS = 3 };

/* Coordinates that a node's axis picks from stand in arrays of so many; the last is for axes that are none, as in a
 * file that was overwritten. */
enum { PHOTON_TREE_AXES = 4 };

typedef struct photon_tree {
    photon_block *blocks; /* borrowed */
    uint32_t count;       /* of photons, below PHOTON_NONE */
    uint32_t depth;       /* all leaves are at this depth; 2^depth - 1 nodes, some with nothing on their right */
    /* Children of i at 2 i + 1 and 2 i + 2. i + 1 is the node's heap index: without its last bits it is that of an
     * ancestor, as many levels above; with the last bit flipped, that of the other child of the same parent. */
    photon_tree_node *nodes;
} photon_tree;

/* Builds a tree from records of photon_records_create. The records are reordered, so that their indices change, and
 * become the tree's blocks in place; on failure they are lost, but not freed. Deterministic: equal input gives equal
 * order for any number of threads. progress: of AG_PHASE_MAP, as in parallel_for. Errors: AG_ERROR_MEMORY,
 * AG_CANCELLED. */
ag_status photon_tree_build(run_context *run, photon *photons, uint32_t count, double progress_begin,
                            double progress_end, photon_tree *out_tree);
void photon_tree_reset(photon_tree *tree);
uint64_t photon_tree_bytes(const photon_tree *tree); /* Returns the bytes of the nodes. */

/* Returns a node, whose axis is below PHOTON_TREE_AXES even where the file that the tree is in was overwritten. */
static inline photon_tree_node photon_tree_node_at(const photon_tree *tree, uint32_t node)
{
    photon_tree_node n = tree->nodes[node];
    n.axis &= PHOTON_TREE_AXES - 1;
    return n;
}

/* A photon found: its squared distance as the high half, its index as the low half. Distances are not negative, so that
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

/* Returns the nearest photon within radius (inclusive) whose normal has a dot product above min_cos (>= 0) with
 * `normal`; PHOTON_NONE where there is none. */
uint32_t photon_tree_nearest(const photon_tree *tree, vec3 position, vec3 normal, float min_cos, float radius,
                             float *out_distance_squared);

/* Returns the leaf that contains a point, by the number of its block. The tree must not be empty. */
uint32_t photon_tree_leaf(const photon_tree *tree, vec3 position);

enum { PHOTON_TREE_DEPTH_MAX = 32 };

/* The leaf of the last lookup, and the cells of the nodes above it by their levels: the next lookup is cheap where its
 * leaf is near. The fourth axis has no bounds. */
typedef struct photon_walk {
    const photon_tree *tree;
    const struct lookup_kernels *kernels; /* for many lookups at once (lookup_kernels.h); they change the time alone */
    uint32_t leaf_heap_index;             /* 0: there was no lookup yet */
    vec3 normal;                          /* of that lookup */
    float min_cos;                        /* of that lookup */
    uint32_t similar_code, other_code;    /* normals that were last found similar to it, and not */
    _Alignas(16) float low[PHOTON_TREE_DEPTH_MAX][PHOTON_TREE_AXES], high[PHOTON_TREE_DEPTH_MAX][PHOTON_TREE_AXES];
} photon_walk;

void photon_walk_init(photon_walk *walk, const photon_tree *tree); /* borrows the tree */

/* photon_tree_nearest at a point in the leaf of photon_tree_leaf; the result does not depend on earlier lookups. */
uint32_t photon_walk_nearest(photon_walk *walk, uint32_t leaf, vec3 position, vec3 normal, float min_cos, float radius,
                             float *out_distance_squared);

/* Most lookups at once. */
enum { PHOTON_LOOKUPS_MAX = 64 };

/* A point of a lookup: position, unit normal, and its photon_tree_leaf. */
typedef struct photon_lookup {
    vec3 position, normal;
    uint32_t leaf;
} photon_lookup;

/* Finds the nearest photons of `count` points, 1 to PHOTON_LOOKUPS_MAX, in the order of their leaves, which is much
 * cheaper. The index is PHOTON_NONE where there is none. */
void photon_walk_nearest_many(photon_walk *walk, const photon_lookup *lookups, uint32_t count, float min_cos,
                              float radius, photon_neighbor *out_nearest);

/* Finds the `wanted` nearest photons within radius, unordered, except that the farthest of them is last when all were
 * found (photon_found.h is the faster form). neighbors: room for photon_neighbors_capacity(wanted). *out_other_squared:
 * squared distance of the nearest photon whose normal differs but is not opposite (beyond 120 degrees), if it is no
 * farther than the photons found or the radius; else a greater number. Returns the number found. */
uint32_t photon_tree_k_nearest(const photon_tree *tree, vec3 position, vec3 normal, float min_cos, float radius,
                               uint32_t wanted, photon_neighbor *neighbors, float *out_other_squared);

/* Returns the number of neighbours that a search for so many takes as scratch memory. */
uint32_t photon_neighbors_capacity(uint32_t wanted);

#endif
