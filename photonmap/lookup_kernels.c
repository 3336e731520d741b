/* lookup_kernels.c: for any processor, and which ones to take; see lookup_kernels.h.
 * Threads: see lookup_kernels.h. */
#include "lookup_kernels.h"

static void find_leaves(const photon_tree *tree, const float *positions, uint32_t stride, uint32_t count,
                        uint32_t *out_leaves)
{
    for (uint32_t i = 0; i < count; i++, positions += stride)
        out_leaves[i] = photon_tree_leaf(tree, (vec3){positions[0], positions[1], positions[2]});
}

static uint64_t meet_plane(const lookup_columns *points, photon_tree_node plane)
{
    const float *at = points->column[plane.axis], *most = points->column[LOOKUP_REACH_SQUARED];
    uint64_t met = 0;
#if defined(__SSE2__)
    __m128 split = _mm_set1_ps(plane.split);
    for (uint32_t i = 0; i < PHOTON_LOOKUPS_MAX; i += 4) {
        __m128 off = _mm_sub_ps(_mm_load_ps(at + i), split);
        met |= (uint64_t)_mm_movemask_ps(_mm_cmple_ps(_mm_mul_ps(off, off), _mm_load_ps(most + i))) << i;
    }
#else
    for (uint32_t i = 0; i < PHOTON_LOOKUPS_MAX; i++) {
        float off = at[i] - plane.split;
        met |= (uint64_t)(off * off <= most[i]) << i;
    }
#endif
    return met;
}

/* Whether a plane is met is as good as random: the other child is always written, but mostly overwritten. */
static void descend(const photon_tree *tree, const lookup_columns *points, const lookup_visits *nodes,
                    lookup_visits *out_children)
{
    lookup_visits *out = out_children;
    uint32_t count = 0;
    for (uint32_t i = 0; i < nodes->count; i++) {
        uint32_t lookup = nodes->lookup[i], first_child = 2 * nodes->node[i] + 1;
        photon_tree_node n = photon_tree_node_at(tree, nodes->node[i]);
        float at = points->column[n.axis][lookup], off = at - n.split;
        uint32_t is_right = at >= n.split;
        out->lookup[count] = lookup;
        out->node[count++] = first_child + is_right;
        out->lookup[count] = lookup;
        out->node[count] = first_child + 1 - is_right;
        count += off * off <= points->column[LOOKUP_REACH_SQUARED][lookup];
    }
    out->count = count;
}

static void scan(const photon_block *blocks, const lookup_columns *points, const lookup_visits *leaves,
                 lookup_visits *out_photons, float *out_distances_squared)
{
    enum { AHEAD = 6 };
    uint32_t count = 0;
    for (uint32_t i = 0; i < leaves->count; i++) {
        uint32_t lane, lookup = leaves->lookup[i], leaf = leaves->node[i];
        if (i + AHEAD < leaves->count)
            photon_block_prefetch(&blocks[leaves->node[i + AHEAD]]);
        const float at[3] = {points->column[0][lookup], points->column[1][lookup], points->column[2][lookup]};
        float d = photon_block_nearest(&blocks[leaf], at, &lane);
        out_photons->lookup[count] = lookup;
        out_photons->node[count] = leaf * PHOTON_BLOCK_LANES + lane;
        out_distances_squared[count] = d;
        count += d <= points->column[LOOKUP_REACH_SQUARED][lookup];
    }
    out_photons->count = count;
}

const lookup_kernels lookup_kernels_plain = {find_leaves, meet_plane, descend, scan};

const lookup_kernels *lookup_kernels_best(void)
{
    const lookup_kernels *widest = lookup_kernels_avx512(), *wide = lookup_kernels_avx2();
    return widest ? widest : wide ? wide : &lookup_kernels_plain;
}
