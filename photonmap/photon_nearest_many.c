/* photon_nearest_many.c: the nearest photons of many points at once; see photon_tree.h.
 * First each lookup's own leaf, which says how far to look; then all lookups go down the tree together, level by level.
 * What one lookup alone does, going where its last step has led, is a chain of branches that no processor foresees;
 * here they are counts that go up by one or not, and what is to be read next is known well before.
 * Threads: read only,
 * but for the caller's walk. */
#include "photon_kernels.h"
#include "photon_query.h"

#include <float.h>

/* Of each photon found whether its normal counts; else another of its leaf. */
static void take(photon_query *q, const photon_lookup *lookups, const photon_visits *found, const float *distances,
                 photon_neighbor *nearest)
{
    for (uint32_t i = 0; i < found->count; i++) {
        uint32_t lookup = found->lookup[i], photon_index = found->node[i];
        const photon_lookup *l = &lookups[lookup];
        if (l->normal.x != q->normal.x || l->normal.y != q->normal.y || l->normal.z != q->normal.z)
            q->similar_code = q->other_code = PHOTON_QUERY_NO_CODE;
        q->normal = l->normal;
        q->position[0] = l->position.x, q->position[1] = l->position.y, q->position[2] = l->position.z;
        if (distances[i] <= photon_neighbor_distance_squared(nearest[lookup]))
            photon_query_offer(q, photon_index / PHOTON_BLOCK_LANES, photon_index % PHOTON_BLOCK_LANES, distances[i],
                               &nearest[lookup]);
    }
}

/* Puts on `leaves` which other leaves than their own the points must look at. Down to the node that has all their
 * leaves below it the way is the same for all, and only who sees the other side is asked. Returns false where there are
 * too many. */
static bool find_other_leaves(const photon_walk *walk, const photon_lookup *lookups, uint32_t count,
                              const photon_reach *reach, photon_visits *spare, photon_visits *leaves)
{
    const photon_tree *tree = walk->tree;
    const float *most = reach->column[PHOTON_REACH_SQUARED];
    uint32_t depth = tree->depth, way = (1u << depth) + lookups[0].leaf;
    uint32_t parted = lookups[0].leaf ^ lookups[count - 1].leaf;
    uint32_t top = depth - (parted ? 32 - (uint32_t)__builtin_clz(parted) : 0);
    photon_visits *from = spare, *to = leaves;
    from->count = 0;
    for (uint32_t level = 0;; level++) {
        for (uint32_t i = 0; level == top && i < count; i++) {
            from->lookup[from->count] = i;
            from->node[from->count] = (way >> (depth - top)) - 1;
            from->count += most[i] >= 0.0f;
        }
        if (level == depth)
            break;
        if (from->count > PHOTON_VISITS_MAX)
            return false;
        to->count = 0;
        if (from->count > 0)
            walk->kernels->descend(tree, reach, from, to);
        if (level < top) {
            uint32_t sibling = (way >> (depth - 1 - level) ^ 1) - 1;
            uint64_t met = walk->kernels->meet_plane(reach, tree->nodes[(way >> (depth - level)) - 1]);
            for (; met; met &= met - 1) {
                to->lookup[to->count] = (uint32_t)__builtin_ctzll(met);
                to->node[to->count++] = sibling;
            }
        }
        photon_visits *hold = from;
        from = to;
        to = hold;
    }
    uint32_t kept = 0;
    for (uint32_t i = 0; i < from->count; i++) {
        uint32_t lookup = from->lookup[i], leaf = from->node[i] - ((1u << depth) - 1);
        leaves->lookup[kept] = lookup;
        leaves->node[kept] = leaf;
        kept += leaf != lookups[lookup].leaf;
    }
    leaves->count = kept;
    return true;
}

void photon_walk_nearest_many(photon_walk *walk, const photon_lookup *lookups, uint32_t count, float min_cos,
                              float radius, photon_neighbor *out_nearest)
{
    const photon_tree *tree = walk->tree;
    const photon_kernels *kernels = walk->kernels;
    photon_visits leaves, found;
    photon_reach reach;
    photon_query q;
    float distances[sizeof found.node / sizeof *found.node];
    float *most = reach.column[PHOTON_REACH_SQUARED];
    for (uint32_t i = 0; i < PHOTON_LOOKUPS_MAX; i++) {
        vec3 at = i < count ? lookups[i].position : (vec3){0.0f, 0.0f, 0.0f};
        reach.column[0][i] = at.x, reach.column[1][i] = at.y, reach.column[2][i] = at.z;
        most[i] = i < count ? radius * radius : -1.0f;
    }
    for (uint32_t i = 0; i < count; i++) {
        leaves.lookup[i] = i;
        leaves.node[i] = lookups[i].leaf;
        out_nearest[i] = photon_neighbor_make(radius * radius, PHOTON_NONE);
    }
    leaves.count = tree->count > 0 ? count : 0;
    if (leaves.count == 0)
        return;
    photon_query_init(&q, tree, lookups[0].position, lookups[0].normal, min_cos);
    kernels->scan(tree->blocks, &reach, &leaves, &found, distances);
    take(&q, lookups, &found, distances, out_nearest);

    /* lookups that found nothing in their own leaf have no radius, and search alone */
    uint32_t alone[PHOTON_LOOKUPS_MAX], alone_count = 0;
    for (uint32_t i = 0; i < count; i++) {
        bool has_none = photon_neighbor_index(out_nearest[i]) == PHOTON_NONE;
        alone[alone_count] = i;
        alone_count += has_none;
        /* beyond a plane at infinity there is nothing */
        most[i] = has_none ? -1.0f
                           : fminf(photon_query_hair_beyond(photon_neighbor_distance_squared(out_nearest[i])), FLT_MAX);
    }
    if (find_other_leaves(walk, lookups, count, &reach, &found, &leaves)) {
        kernels->scan(tree->blocks, &reach, &leaves, &found, distances);
        take(&q, lookups, &found, distances, out_nearest);
    } else {
        for (alone_count = 0; alone_count < count; alone_count++)
            alone[alone_count] = alone_count;
    }
    for (uint32_t i = 0; i < alone_count; i++) {
        const photon_lookup *l = &lookups[alone[i]];
        float d;
        uint32_t index = photon_walk_nearest(walk, l->leaf, l->position, l->normal, min_cos, radius, &d);
        out_nearest[alone[i]] = photon_neighbor_make(d, index);
    }
}
