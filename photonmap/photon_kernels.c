/* photon_kernels.c: for any processor, and which ones to take; see photon_kernels.h.
 * Threads: see photon_kernels.h. */
#include "photon_kernels.h"

static void find_leaves(const photon_tree *tree, const float *positions, uint32_t stride, uint32_t count,
                        uint32_t *out_leaves)
{
    for (uint32_t i = 0; i < count; i++, positions += stride)
        out_leaves[i] = photon_tree_leaf(tree, (vec3){positions[0], positions[1], positions[2]});
}

static uint64_t meet_plane(const photon_reach *reach, photon_tree_node plane)
{
    const float *at = reach->column[plane.axis], *most = reach->column[PHOTON_REACH_SQUARED];
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
static void descend(const photon_tree *tree, const photon_reach *reach, const photon_visits *nodes,
                    photon_visits *out_children)
{
    photon_visits *out = out_children;
    uint32_t count = 0;
    for (uint32_t i = 0; i < nodes->count; i++) {
        uint32_t lookup = nodes->lookup[i], first_child = 2 * nodes->node[i] + 1;
        photon_tree_node n = tree->nodes[nodes->node[i]];
        float at = reach->column[n.axis][lookup], off = at - n.split;
        uint32_t is_right = at >= n.split;
        out->lookup[count] = lookup;
        out->node[count++] = first_child + is_right;
        out->lookup[count] = lookup;
        out->node[count] = first_child + 1 - is_right;
        count += off * off <= reach->column[PHOTON_REACH_SQUARED][lookup];
    }
    out->count = count;
}

static void scan(const photon_block *blocks, const photon_reach *reach, const photon_visits *leaves,
                 photon_visits *out_photons, float *out_distances_squared)
{
    enum { AHEAD = 6 };
    uint32_t count = 0;
    for (uint32_t i = 0; i < leaves->count; i++) {
        uint32_t lane, lookup = leaves->lookup[i], leaf = leaves->node[i];
        if (i + AHEAD < leaves->count)
            photon_block_prefetch(&blocks[leaves->node[i + AHEAD]]);
        const float at[3] = {reach->column[0][lookup], reach->column[1][lookup], reach->column[2][lookup]};
        float d = photon_block_nearest(&blocks[leaf], at, &lane);
        out_photons->lookup[count] = lookup;
        out_photons->node[count] = leaf * PHOTON_BLOCK_LANES + lane;
        out_distances_squared[count] = d;
        count += d <= reach->column[PHOTON_REACH_SQUARED][lookup];
    }
    out_photons->count = count;
}

const photon_kernels photon_kernels_plain = {find_leaves, meet_plane, descend, scan};

const photon_kernels *photon_kernels_best(void)
{
    const photon_kernels *widest = photon_kernels_avx512(), *wide = photon_kernels_avx2();
    return widest ? widest : wide ? wide : &photon_kernels_plain;
}
