/* photon_query.h: a way through the photon tree: the query, what is still to visit, and which normals count. For
 * searches of photons alone. Rests on: Arya, Mount, "Algorithms for Fast Vector Quantization", 1993.
 * Depth first, near side first; a stack entry carries its box's offset from the query along each axis.
 * Threads: a query belongs to one. */
#ifndef AFTERGLOW_PHOTON_QUERY_H
#define AFTERGLOW_PHOTON_QUERY_H

#include "photon_tree.h"

/* x, y, z and an unused lane. It stays in registers: to store one lane and then load all four would stall the
 * processor. */
typedef float photon_lanes __attribute__((vector_size(16)));
typedef int32_t photon_lane_bits __attribute__((vector_size(16)));

static inline photon_lanes photon_lanes_fill(float value) { return (photon_lanes){value, value, value, value}; }

/* Returns a with its component along the axis replaced by b's. */
static inline photon_lanes photon_lanes_replace(photon_lanes a, photon_lanes b, uint32_t axis)
{
    static const photon_lane_bits ALONG[PHOTON_TREE_AXES] = {{-1, 0, 0, 0}, {0, -1, 0, 0}, {0, 0, -1, 0}, {0, 0, 0, 0}};
    return (photon_lanes)(((photon_lane_bits)a & ~ALONG[axis]) | ((photon_lane_bits)b & ALONG[axis]));
}

/* A part of the tree still to visit: how far the query is outside its box, along each axis and in all. */
typedef struct photon_visit {
    photon_lanes offset;
    float distance_squared;
    uint32_t node;
} photon_visit;

typedef struct photon_query {
    photon_lanes at;                  /* the point, in lanes */
    float position[PHOTON_TREE_AXES]; /* its coordinates one by one */
    const photon_tree *tree;
    vec3 normal;
    float min_cos;
    uint32_t similar_code, other_code; /* normals, as photons have them, that were last found similar and not */
    bool other_is_behind;              /* that other one is turned by more than 120 degrees */
    uint32_t visits;                   /* on the stack */
    photon_visit stack[PHOTON_TREE_DEPTH_MAX + 1]; /* one more, which is written and does not count */
} photon_query;

#define PHOTON_QUERY_NO_CODE UINT32_MAX

/* Rounding may make a box seem farther than its photons, so boxes a hair beyond the limit are visited, too. */
static inline float photon_query_hair_beyond(float limit) { return limit * 1.00001f; }

/* Pushes the other side of a node's plane, as seen from the box of the visit, where it is no farther than `most`: the
 * limit and a hair. */
static inline void photon_query_push(photon_query *q, photon_lanes offset, photon_lanes from_plane, uint32_t axis,
                                     uint32_t node, float most)
{
    photon_lanes far = photon_lanes_replace(offset, from_plane, axis), square = far * far;
    float beyond = square[0] + square[1] + square[2];
    /* whether it is within is as good as random: it is always written, but mostly overwritten */
    q->stack[q->visits] = (photon_visit){far, beyond, node};
    q->visits += (uint32_t)(beyond <= most) & (uint32_t)(beyond < INFINITY); /* beyond such a plane there is nothing */
}

/* A part of the tree, and the query's offset from its box. */
typedef struct photon_subtree {
    photon_lanes offset;
    uint32_t node;
} photon_subtree;

/* Goes down, on the query's side of each plane, to the node `height` levels above the leaves, and pushes the other
 * sides that are within the limit. */
static inline photon_subtree photon_query_descend(photon_query *q, photon_lanes offset, uint32_t node, uint32_t height,
                                                  float limit)
{
    uint32_t base = (1u << (q->tree->depth - height)) - 1;
    float most = photon_query_hair_beyond(limit);
    while (node < base) {
        photon_tree_node n = photon_tree_node_at(q->tree, node);
        photon_lanes from_plane = q->at - photon_lanes_fill(n.split);
        uint32_t is_right = q->position[n.axis] >= n.split;
        photon_query_push(q, offset, from_plane, n.axis, 2 * node + 2 - is_right, most);
        node = 2 * node + 1 + is_right;
    }
    return (photon_subtree){offset, node};
}

/* Takes the next visit from the stack and goes down from it by photon_query_descend; false when nothing within the
 * limit is left. */
static inline bool photon_query_next(photon_query *q, float limit, uint32_t height, photon_subtree *out_subtree)
{
    float most = photon_query_hair_beyond(limit);
    while (q->visits > 0) {
        const photon_visit *v = &q->stack[--q->visits];
        if (v->distance_squared > most)
            continue;
        *out_subtree = photon_query_descend(q, v->offset, v->node, height, limit);
        return true;
    }
    return false;
}

/* Goes on to the next leaf within the limit, and writes its block. Returns false where there is none. */
static inline bool photon_query_next_leaf(photon_query *q, float limit, uint32_t *out_block)
{
    photon_subtree leaf;
    bool is_found = photon_query_next(q, limit, 0, &leaf);
    *out_block = is_found ? leaf.node - ((1u << q->tree->depth) - 1) : 0;
    return is_found;
}

/* Returns whether a normal is similar to the query's. Neighbours mostly share one, so the last answers are kept. */
static inline bool photon_query_has_similar_normal(photon_query *q, uint16_t code)
{
    if (code == q->similar_code)
        return true;
    if (code == q->other_code)
        return false;
    /* the cosine against min_cos >= 0, without a square root */
    vec3 n = direction_decode_unnormalized(code);
    float d = vec3_dot(n, q->normal), square = vec3_length_squared(n);
    if (d > 0.0f && d * d > q->min_cos * q->min_cos * square) {
        q->similar_code = code;
        return true;
    }
    q->other_code = code;
    q->other_is_behind = d < 0.0f && d * d > 0.25f * square;
    return false;
}

/* Offers a block whose nearest photon is `lane`, no farther than *nearest. *nearest becomes this photon or, where its
 * normal is not similar, the nearest one of the block with a similar normal, unless that is farther. */
static inline void photon_query_offer(photon_query *q, uint32_t block, uint32_t lane, float distance_squared,
                                      photon_neighbor *nearest)
{
    const photon_block *b = &q->tree->blocks[block];
    uint16_t code = b->normal[lane];
    if (!photon_query_has_similar_normal(q, code)) {
        /* the nearest of the rest, normal by normal */
        _Alignas(16) float d[PHOTON_BLOCK_LANES];
        uint32_t within = photon_block_within(b, q->position, photon_neighbor_distance_squared(*nearest), d);
        do {
            within &= ~photon_block_with_normal(b, code);
            if (!within)
                return;
            lane = photon_block_nearest_lane(d, within);
            code = b->normal[lane];
        } while (!photon_query_has_similar_normal(q, code));
        distance_squared = d[lane];
    }
    photon_neighbor found = photon_neighbor_make(distance_squared, block * PHOTON_BLOCK_LANES + lane);
    *nearest = found < *nearest ? found : *nearest;
}

static inline void photon_query_init(photon_query *q, const photon_tree *tree, vec3 position, vec3 normal,
                                     float min_cos)
{
    q->tree = tree;
    q->at = (photon_lanes){position.x, position.y, position.z, 0.0f};
    q->position[0] = position.x, q->position[1] = position.y, q->position[2] = position.z, q->position[3] = 0.0f;
    q->normal = normal;
    q->min_cos = min_cos;
    q->similar_code = q->other_code = PHOTON_QUERY_NO_CODE;
    q->other_is_behind = false;
}

#endif
