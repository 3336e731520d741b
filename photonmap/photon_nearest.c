/* photon_nearest.c: the nearest photon; see photon_tree.h.
 * From the query's leaf upwards: mostly its cell holds all that may be nearer than what the leaf has. The way down to a
 * leaf, with the cells along it, is kept from one query to the next.
 * Threads: read only, but for the caller's walk. */
#include "photon_query.h"

#include <string.h>

void photon_walk_init(photon_walk *walk, const photon_tree *tree)
{
    walk->tree = tree;
    walk->way = 0;
    walk->normal = (vec3){0.0f, 0.0f, 0.0f};
    walk->min_cos = 0.0f;
    walk->similar_code = walk->other_code = PHOTON_QUERY_NO_CODE;
    for (int a = 0; a < PHOTON_WALK_AXES; a++) {
        walk->low[0][a] = -INFINITY;
        walk->high[0][a] = INFINITY;
    }
}

static inline photon_lanes load_lanes(const float *four)
{
    photon_lanes lanes;
    memcpy(&lanes, four, sizeof lanes);
    return lanes;
}

/* Works out the cells on the way to the leaf, from where it parts from the last one's. A node's number plus one, in
 * binary, is 1 and the turns on the way to it. */
static void walk_to(photon_walk *walk, uint32_t leaf)
{
    const photon_tree *tree = walk->tree;
    uint32_t depth = tree->depth, way = (1u << depth) + leaf, parted = walk->way ^ way;
    if (parted == 0)
        return;
    uint32_t highest = 31 - (uint32_t)__builtin_clz(parted), level = highest >= depth ? 0 : depth - 1 - highest;
    walk->way = way;
    photon_lanes low = load_lanes(walk->low[level]), high = load_lanes(walk->high[level]);
    for (; level < depth; level++) {
        photon_tree_node n = tree->nodes[(way >> (depth - level)) - 1];
        photon_lanes split = photon_lanes_fill(n.split);
        if (way >> (depth - 1 - level) & 1)
            low = photon_lanes_replace(low, split, n.axis);
        else if (n.split < INFINITY) /* else there is nothing beyond */
            high = photon_lanes_replace(high, split, n.axis);
        memcpy(walk->low[level + 1], &low, sizeof low);
        memcpy(walk->high[level + 1], &high, sizeof high);
    }
}

/* Whether all that is outside the cell of that level is farther away than the limit. The place is in the cell. */
static inline bool cell_holds(const photon_walk *walk, uint32_t level, photon_lanes at, float limit)
{
    float most = photon_query_hair_beyond(limit);
#if defined(__SSE2__)
    __m128 here = (__m128)at, low = _mm_load_ps(walk->low[level]), high = _mm_load_ps(walk->high[level]);
    __m128 to_face = _mm_min_ps(_mm_sub_ps(here, low), _mm_sub_ps(high, here));
    return _mm_movemask_ps(_mm_cmpgt_ps(_mm_mul_ps(to_face, to_face), _mm_set1_ps(most))) == 15;
#else
    for (int a = 0; a < 3; a++) {
        float below = at[a] - walk->low[level][a], above = walk->high[level][a] - at[a];
        if (!(below * below > most && above * above > most))
            return false;
    }
    return true;
#endif
}

/* The nearest so far. */
typedef struct nearest {
    float distance_squared;
    uint32_t index;
} nearest;

static inline void scan_for_nearest(photon_query *q, uint32_t block, nearest *best)
{
    const photon_block *b = &q->tree->blocks[block];
    _Alignas(16) float d[PHOTON_BLOCK_LANES];
    uint32_t lane;
    if (!photon_block_nearest(b, q->position, best->distance_squared, d, &lane))
        return;
    uint16_t code = b->normal[lane];
    if (!photon_query_has_similar_normal(q, code)) {
        /* the nearest of the rest, normal by normal */
        uint32_t within = photon_block_within(b, q->position, best->distance_squared, d);
        for (;;) {
            within &= ~photon_block_with_normal(b, code);
            if (!within)
                return;
            lane = photon_block_nearest_lane(d, within);
            code = b->normal[lane];
            if (photon_query_has_similar_normal(q, code))
                break;
        }
    }
    uint32_t index = block * PHOTON_BLOCK_LANES + lane;
    if (d[lane] < best->distance_squared || index < best->index)
        *best = (nearest){d[lane], index};
}

uint32_t photon_walk_nearest(photon_walk *walk, uint32_t leaf, vec3 position, vec3 normal, float min_cos, float radius,
                             float *out_distance_squared)
{
    photon_query q;
    const photon_tree *tree = walk->tree;
    nearest best = {radius * radius, PHOTON_NONE};
    *out_distance_squared = best.distance_squared;
    if (tree->count == 0)
        return PHOTON_NONE;
    walk_to(walk, leaf);
    photon_query_init(&q, tree, position, normal, min_cos);
    if (normal.x == walk->normal.x && normal.y == walk->normal.y && normal.z == walk->normal.z &&
        min_cos == walk->min_cos) {
        q.similar_code = walk->similar_code;
        q.other_code = walk->other_code;
    }
    scan_for_nearest(&q, leaf, &best);
    for (uint32_t level = tree->depth; level > 0 && !cell_holds(walk, level, q.at, best.distance_squared); level--) {
        uint32_t child = walk->way >> (tree->depth - level), block;
        photon_tree_node n = tree->nodes[(child >> 1) - 1];
        q.visits = 0;
        photon_query_push(&q, photon_lanes_fill(0.0f), q.at - photon_lanes_fill(n.split), n.axis, (child ^ 1) - 1,
                          photon_query_hair_beyond(best.distance_squared));
        while (photon_query_next_leaf(&q, best.distance_squared, &block))
            scan_for_nearest(&q, block, &best);
    }
    walk->normal = normal;
    walk->min_cos = min_cos;
    walk->similar_code = q.similar_code;
    walk->other_code = q.other_code;
    *out_distance_squared = best.distance_squared;
    return best.index;
}

uint32_t photon_tree_nearest(const photon_tree *tree, vec3 position, vec3 normal, float min_cos, float radius,
                             float *out_distance_squared)
{
    photon_walk walk;
    photon_walk_init(&walk, tree);
    uint32_t leaf = tree->count > 0 ? photon_tree_leaf(tree, position) : 0;
    return photon_walk_nearest(&walk, leaf, position, normal, min_cos, radius, out_distance_squared);
}
