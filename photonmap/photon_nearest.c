/* photon_nearest.c: the nearest photon; see photon_tree.h.
 * From the query's leaf upwards: mostly its cell holds all that may be nearer than what the leaf has. The way down to a
 * leaf, with the cells along it, is kept from one query to the next.
 * Threads: read only, but for the caller's walk. */
#include "lookup_kernels.h"
#include "photon_query.h"

#include <string.h>

void photon_walk_init(photon_walk *walk, const photon_tree *tree)
{
    walk->tree = tree;
    walk->kernels = lookup_kernels_best();
    walk->leaf_heap_index = 0;
    walk->normal = (vec3){0.0f, 0.0f, 0.0f};
    walk->min_cos = 0.0f;
    walk->similar_code = walk->other_code = PHOTON_QUERY_NO_CODE;
    for (int a = 0; a < PHOTON_TREE_AXES; a++) {
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

/* Works out the cells of the nodes above the leaf, from where they differ from the last leaf's. */
static void walk_to(photon_walk *walk, uint32_t leaf)
{
    const photon_tree *tree = walk->tree;
    uint32_t depth = tree->depth, heap_index = (1u << depth) + leaf, parted = walk->leaf_heap_index ^ heap_index;
    if (parted == 0)
        return;
    uint32_t highest = 31 - (uint32_t)__builtin_clz(parted), level = highest >= depth ? 0 : depth - 1 - highest;
    walk->leaf_heap_index = heap_index;
    photon_lanes low = load_lanes(walk->low[level]), high = load_lanes(walk->high[level]);
    for (; level < depth; level++) {
        photon_tree_node n = photon_tree_node_at(tree, (heap_index >> (depth - level)) - 1);
        photon_lanes split = photon_lanes_fill(n.split);
        if (heap_index >> (depth - 1 - level) & 1)
            low = photon_lanes_replace(low, split, n.axis);
        else if (n.split < INFINITY) /* else there is nothing beyond */
            high = photon_lanes_replace(high, split, n.axis);
        memcpy(walk->low[level + 1], &low, sizeof low);
        memcpy(walk->high[level + 1], &high, sizeof high);
    }
}

/* Whether all that is outside the cell of that level is farther away than the limit. The point is in the cell. */
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

static inline void scan_for_nearest(photon_query *q, uint32_t block, photon_neighbor *nearest)
{
    uint32_t lane;
    float d = photon_block_nearest(&q->tree->blocks[block], q->position, &lane);
    if (d <= photon_neighbor_distance_squared(*nearest))
        photon_query_offer(q, block, lane, d, nearest);
}

uint32_t photon_walk_nearest(photon_walk *walk, uint32_t leaf, vec3 position, vec3 normal, float min_cos, float radius,
                             float *out_distance_squared)
{
    photon_query q;
    const photon_tree *tree = walk->tree;
    float limit = radius * radius;
    photon_neighbor nearest = photon_neighbor_make(limit, PHOTON_NONE);
    *out_distance_squared = limit;
    if (tree->count == 0)
        return PHOTON_NONE;
    walk_to(walk, leaf);
    photon_query_init(&q, tree, position, normal, min_cos);
    if (normal.x == walk->normal.x && normal.y == walk->normal.y && normal.z == walk->normal.z &&
        min_cos == walk->min_cos) {
        q.similar_code = walk->similar_code;
        q.other_code = walk->other_code;
    }
    scan_for_nearest(&q, leaf, &nearest);
    for (uint32_t level = tree->depth; level > 0; level--) {
        limit = photon_neighbor_distance_squared(nearest);
        if (cell_holds(walk, level, q.at, limit))
            break;
        uint32_t child = walk->leaf_heap_index >> (tree->depth - level), block;
        photon_tree_node n = photon_tree_node_at(tree, (child >> 1) - 1);
        q.visits = 0;
        photon_query_push(&q, photon_lanes_fill(0.0f), q.at - photon_lanes_fill(n.split), n.axis, (child ^ 1) - 1,
                          photon_query_hair_beyond(limit));
        while (photon_query_next_leaf(&q, photon_neighbor_distance_squared(nearest), &block))
            scan_for_nearest(&q, block, &nearest);
    }
    walk->normal = normal;
    walk->min_cos = min_cos;
    walk->similar_code = q.similar_code;
    walk->other_code = q.other_code;
    *out_distance_squared = photon_neighbor_distance_squared(nearest);
    return photon_neighbor_index(nearest);
}

uint32_t photon_tree_nearest(const photon_tree *tree, vec3 position, vec3 normal, float min_cos, float radius,
                             float *out_distance_squared)
{
    photon_walk walk;
    photon_walk_init(&walk, tree);
    uint32_t leaf = tree->count > 0 ? photon_tree_leaf(tree, position) : 0;
    return photon_walk_nearest(&walk, leaf, position, normal, min_cos, radius, out_distance_squared);
}
