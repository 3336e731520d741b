/* disc_kernels.c: for any processor, and which ones to take; see disc_kernels.h.
 * Threads: see disc_kernels.h. */
#include "disc_kernels.h"

static uint32_t find_leaves(const photon_query *q, photon_subtree subtree, float most, uint32_t *out_leaves)
{
    uint32_t count = 0, base = (1u << q->tree->depth) - 1;
    const uint32_t levels = q->tree->depth - (31 - (uint32_t)__builtin_clz(subtree.node + 1));
    for (uint32_t leaf = 0; leaf < 1u << levels; leaf++) { /* its bits, from the highest on, are the turns to it */
        photon_lanes offset = subtree.offset;
        uint32_t node = subtree.node;
        bool is_there = true; /* beyond a plane at infinity there is nothing */
        for (uint32_t level = levels; level-- > 0;) {
            photon_tree_node n = photon_tree_node_at(q->tree, node);
            uint32_t goes_right = leaf >> level & 1;
            if (goes_right != (q->position[n.axis] >= n.split)) {
                offset = photon_lanes_replace(offset, q->at - photon_lanes_fill(n.split), n.axis);
                is_there = is_there && n.split < INFINITY;
            }
            node = 2 * node + 1 + goes_right;
        }
        photon_lanes square = offset * offset;
        float beyond = square[0] + square[1] + square[2];
        if (is_there && beyond <= most && beyond < INFINITY)
            out_leaves[count++] = node - base;
    }
    return count;
}

static void collect_leaf(photon_query *q, uint32_t leaf, photon_found *f)
{
    const photon_block *b = &q->tree->blocks[leaf];
    _Alignas(16) float d[PHOTON_BLOCK_LANES];
    uint32_t within = photon_block_within(b, q->position, f->limit, d);
    uint32_t similar =
        q->similar_code == PHOTON_QUERY_NO_CODE ? 0 : within & photon_block_with_normal(b, (uint16_t)q->similar_code);
    for (uint32_t rest = within & ~similar; rest; rest &= rest - 1) {
        uint32_t lane = (uint32_t)__builtin_ctz(rest);
        if (photon_query_has_similar_normal(q, b->normal[lane]))
            similar |= 1u << lane;
        else if (!q->other_is_behind)
            f->other_squared = d[lane] < f->other_squared ? d[lane] : f->other_squared;
    }
    if (!similar)
        return;
    float *to = f->distances_squared + (size_t)f->leaf_count * PHOTON_BLOCK_LANES;
    for (uint32_t lane = 0; lane < PHOTON_BLOCK_LANES; lane++)
        to[lane] = similar >> lane & 1 ? d[lane] : NAN;
    f->leaves[f->leaf_count++] = leaf;
    f->count += (uint32_t)__builtin_popcount(similar);
}

static uint32_t collect(photon_query *q, const uint32_t *leaves, uint32_t leaf_count, photon_found *f)
{
    uint32_t i = 0;
    while (i < leaf_count && f->leaf_count < f->leaf_capacity && f->count + PHOTON_BLOCK_LANES <= f->capacity)
        collect_leaf(q, leaves[i++], f);
    return i;
}

static void count_within(const photon_found *f, const float most[DISC_COUNTS], uint32_t out_counts[DISC_COUNTS])
{
    for (int k = 0; k < DISC_COUNTS; k++) {
        out_counts[k] = 0;
        for (uint32_t i = 0; i < f->leaf_count * PHOTON_BLOCK_LANES; i++)
            out_counts[k] += f->distances_squared[i] <= most[k];
    }
}

static uint32_t list_between(const photon_found *f, float low, float high, photon_neighbor *out_neighbors)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < f->leaf_count * PHOTON_BLOCK_LANES; i++) {
        float d = f->distances_squared[i];
        if (d > low && d <= high)
            out_neighbors[count++] = photon_neighbor_make(d, photon_found_index(f, i));
    }
    return count;
}

static uint32_t sum_on_surface(const photon_disc *disc, const photon_found *f, photon_disc_sums *out_sums,
                               photon_neighbor *out_doubtful)
{
    uint32_t kept = 0, doubtful = 0;
    *out_sums = (photon_disc_sums){{0}, {0}};
    for (uint32_t i = 0; i < f->leaf_count * PHOTON_BLOCK_LANES; i++) {
        if (!(f->distances_squared[i] <= f->limit))
            continue;
        uint32_t index = photon_found_index(f, i);
        vec3 offset = vec3_sub(photon_block_position(disc->blocks, index), disc->position);
        if (photon_disc_is_on_surface(disc, offset, photon_block_normal(disc->blocks, index))) {
            photon_disc_add(disc, index, out_sums);
            kept++;
        } else {
            out_doubtful[doubtful++] = i;
        }
    }
    return kept;
}

static uint32_t sum_in_region(const photon_disc *disc, const surface_region *region, const photon_found *f,
                              photon_disc_sums *out_sums)
{
    uint32_t inside = 0;
    *out_sums = (photon_disc_sums){{0}, {0}};
    for (uint32_t i = 0; i < f->leaf_count * PHOTON_BLOCK_LANES; i++) {
        if (!(f->distances_squared[i] <= f->limit))
            continue;
        uint32_t index = photon_found_index(f, i);
        if (surface_region_contains(region, photon_block_position(disc->blocks, index))) {
            photon_disc_add(disc, index, out_sums);
            inside++;
        }
    }
    return inside;
}

const disc_kernels disc_kernels_plain = {PHOTON_SUBTREE_LEVELS, find_leaves,    collect,      count_within,
                                         list_between,          sum_on_surface, sum_in_region};

const disc_kernels *disc_kernels_best(void)
{
    const disc_kernels *widest = disc_kernels_avx512(), *wide = disc_kernels_avx2();
    return widest ? widest : wide ? wide : &disc_kernels_plain;
}
