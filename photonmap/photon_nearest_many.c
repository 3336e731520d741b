/* photon_nearest_many.c: the nearest photons of many points at once; see photon_tree.h.
 * First each lookup's own leaf, which says how far to look; then all lookups go down the tree together, level by level.
 * What one lookup alone does, going where its last step has led, is a chain of branches that no processor foresees;
 * here they are counts that go up by one or not, and what is to be read next is known well before.
 * Threads: read only, but for the caller's walk. */
#include "lookup_kernels.h"
#include "photon_query.h"

#include <float.h>

/* Offers each photon found to its lookup: the photon, or where its normal does not count another one of its leaf. */
static void offer_found(photon_query *q, const photon_lookup *lookups, const lookup_visits *found,
                        const float *distances, photon_neighbor *nearest)
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

/* Appends a visit of the node by each lookup that has a reach. */
static void add_lookups(const lookup_columns *points, uint32_t count, uint32_t node, lookup_visits *visits)
{
    for (uint32_t i = 0; i < count; i++) {
        visits->lookup[visits->count] = i;
        visits->node[visits->count] = node;
        visits->count += points->column[LOOKUP_REACH_SQUARED][i] >= 0.0f;
    }
}

/* Appends a visit of the node by each lookup whose bit is set. */
static void add_some_lookups(uint64_t lookups, uint32_t node, lookup_visits *visits)
{
    for (; lookups; lookups &= lookups - 1) {
        visits->lookup[visits->count] = (uint32_t)__builtin_ctzll(lookups);
        visits->node[visits->count++] = node;
    }
}

/* Turns visits of nodes at the tree's depth into visits of leaves, without those of the lookups' own leaves. */
static void keep_other_leaves(const lookup_visits *visits, const photon_lookup *lookups, uint32_t leaf_base,
                              lookup_visits *out_leaves)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < visits->count; i++) {
        uint32_t lookup = visits->lookup[i], leaf = visits->node[i] - leaf_base;
        out_leaves->lookup[kept] = lookup;
        out_leaves->node[kept] = leaf;
        kept += leaf != lookups[lookup].leaf;
    }
    out_leaves->count = kept;
}

/* Lists the leaves other than its own that each point has to look at. Down to the node that has all their own leaves
 * below it, all points are on the same side of each plane, and only those that reach past it visit its other side.
 * spare: scratch memory. Returns false where there are too many visits. */
static bool find_other_leaves(const photon_walk *walk, const photon_lookup *lookups, uint32_t count,
                              const lookup_columns *points, lookup_visits *spare, lookup_visits *out_leaves)
{
    const photon_tree *tree = walk->tree;
    const uint32_t depth = tree->depth, first_leaf = (1u << depth) + lookups[0].leaf; /* a heap index */
    const uint32_t parted = lookups[0].leaf ^ lookups[count - 1].leaf;
    const uint32_t top = depth - (parted ? 32 - (uint32_t)__builtin_clz(parted) : 0); /* level of that node */
    lookup_visits *from = spare, *to = out_leaves;
    from->count = 0;
    for (uint32_t level = 0;; level++) {
        if (level == top)
            add_lookups(points, count, (first_leaf >> (depth - top)) - 1, from);
        if (level == depth)
            break;
        if (from->count > LOOKUP_VISITS_MAX)
            return false;
        to->count = 0;
        if (from->count > 0)
            walk->kernels->descend(tree, points, from, to);
        if (level < top) {
            uint32_t node = (first_leaf >> (depth - level)) - 1,
                     other_child = (first_leaf >> (depth - 1 - level) ^ 1) - 1;
            add_some_lookups(walk->kernels->meet_plane(points, photon_tree_node_at(tree, node)), other_child, to);
        }
        lookup_visits *hold = from;
        from = to;
        to = hold;
    }
    keep_other_leaves(from, lookups, (1u << depth) - 1, out_leaves);
    return true;
}

void photon_walk_nearest_many(photon_walk *walk, const photon_lookup *lookups, uint32_t count, float min_cos,
                              float radius, photon_neighbor *out_nearest)
{
    const photon_tree *tree = walk->tree;
    const lookup_kernels *kernels = walk->kernels;
    lookup_visits leaves, found;
    lookup_columns points;
    photon_query q;
    float distances[sizeof found.node / sizeof *found.node];
    float *most = points.column[LOOKUP_REACH_SQUARED];
    for (uint32_t i = 0; i < PHOTON_LOOKUPS_MAX; i++) {
        vec3 at = i < count ? lookups[i].position : (vec3){0.0f, 0.0f, 0.0f};
        points.column[0][i] = at.x, points.column[1][i] = at.y, points.column[2][i] = at.z;
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
    kernels->scan(tree->blocks, &points, &leaves, &found, distances);
    offer_found(&q, lookups, &found, distances, out_nearest);

    /* lookups that found nothing in their own leaf have no radius, and search alone */
    uint32_t alone[PHOTON_LOOKUPS_MAX], alone_count = 0;
    for (uint32_t i = 0; i < count; i++) {
        bool has_none = photon_neighbor_index(out_nearest[i]) == PHOTON_NONE;
        alone[alone_count] = i;
        alone_count += has_none;
        /* beyond a plane at infinity there is nothing */
        most[i] = has_none
                      ? -1.0f
                      : float_min(photon_query_hair_beyond(photon_neighbor_distance_squared(out_nearest[i])), FLT_MAX);
    }
    if (find_other_leaves(walk, lookups, count, &points, &found, &leaves)) {
        kernels->scan(tree->blocks, &points, &leaves, &found, distances);
        offer_found(&q, lookups, &found, distances, out_nearest);
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
