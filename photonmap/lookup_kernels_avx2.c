/* lookup_kernels_avx2.c: eight at a time; see lookup_kernels.h. No fused multiplications: their rounding is another.
 * Threads: see lookup_kernels.h. */
#include "lookup_kernels.h"

#if defined(__x86_64__)

#include "avx2.h"

enum { WIDTH = 8 };

AVX2 static inline __m256i load(const uint32_t *eight)
{
    return _mm256_loadu_si256((const __m256i *)(const void *)eight);
}
AVX2 static inline void store(uint32_t *eight, __m256i v) { _mm256_storeu_si256((__m256i *)(void *)eight, v); }

typedef struct nodes_8 {
    __m256 split;
    __m256i axis;
} nodes_8;

/* photon_tree_node_at of eight; node by node, not word by word: half as many loads. */
AVX2 static inline nodes_8 gather_nodes(const photon_tree *tree, __m256i node)
{
    enum { IN_ORDER = _MM_SHUFFLE(3, 1, 2, 0) };
    const long long *n = (const long long *)(const void *)tree->nodes;
    __m256 low = _mm256_castsi256_ps(_mm256_i32gather_epi64(n, _mm256_castsi256_si128(node), 8));
    __m256 high = _mm256_castsi256_ps(_mm256_i32gather_epi64(n, _mm256_extracti128_si256(node, 1), 8));
    __m256 splits = _mm256_shuffle_ps(low, high, _MM_SHUFFLE(2, 0, 2, 0));
    __m256 axes = _mm256_shuffle_ps(low, high, _MM_SHUFFLE(3, 1, 3, 1));
    return (nodes_8){
        _mm256_castpd_ps(_mm256_permute4x64_pd(_mm256_castps_pd(splits), IN_ORDER)),
        _mm256_and_si256(_mm256_permute4x64_epi64(_mm256_castps_si256(axes), IN_ORDER),
                         _mm256_set1_epi32(PHOTON_TREE_AXES - 1)),
    };
}

/* Some vectors at once, for each waits for its own way down. */
AVX2 static void find_leaves(const photon_tree *tree, const float *positions, uint32_t stride, uint32_t count,
                             uint32_t *out_leaves)
{
    enum { VECTORS = 4, AT_ONCE = VECTORS * WIDTH };
    __m256i one = _mm256_set1_epi32(1), base = _mm256_set1_epi32((int)(1u << tree->depth) - 1);
    __m256i offset = _mm256_mullo_epi32(_mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7), _mm256_set1_epi32((int)stride));
    uint32_t i = 0;
    for (; i + AT_ONCE <= count; i += AT_ONCE) {
        __m256 x[VECTORS], y[VECTORS], z[VECTORS];
        __m256i node[VECTORS];
        for (uint32_t v = 0; v < VECTORS; v++, positions += (size_t)WIDTH * stride) {
            x[v] = _mm256_i32gather_ps(positions, offset, 4);
            y[v] = _mm256_i32gather_ps(positions + 1, offset, 4);
            z[v] = _mm256_i32gather_ps(positions + 2, offset, 4);
            node[v] = _mm256_setzero_si256();
        }
        for (uint32_t level = 0; level < tree->depth; level++)
            for (uint32_t v = 0; v < VECTORS; v++) {
                nodes_8 n = gather_nodes(tree, node[v]);
                /* axes 1 and 2 by their bits, as the sign */
                __m256 at = _mm256_blendv_ps(x[v], y[v], _mm256_castsi256_ps(_mm256_slli_epi32(n.axis, 31)));
                at = _mm256_blendv_ps(at, z[v], _mm256_castsi256_ps(_mm256_slli_epi32(n.axis, 30)));
                __m256i is_right = _mm256_castps_si256(_mm256_cmp_ps(at, n.split, _CMP_GE_OQ)); /* -1 */
                node[v] = _mm256_sub_epi32(_mm256_add_epi32(_mm256_add_epi32(node[v], node[v]), one), is_right);
            }
        for (uint32_t v = 0; v < VECTORS; v++)
            store(out_leaves + i + v * WIDTH, _mm256_sub_epi32(node[v], base));
    }
    for (; i < count; i++, positions += stride)
        out_leaves[i] = photon_tree_leaf(tree, (vec3){positions[0], positions[1], positions[2]});
}

AVX2 static uint64_t meet_plane(const lookup_columns *points, photon_tree_node plane)
{
    const float *at = points->column[plane.axis], *most = points->column[LOOKUP_REACH_SQUARED];
    __m256 split = _mm256_set1_ps(plane.split);
    uint64_t met = 0;
    for (uint32_t i = 0; i < PHOTON_LOOKUPS_MAX; i += WIDTH) {
        __m256 off = _mm256_sub_ps(_mm256_load_ps(at + i), split);
        __m256 is_met = _mm256_cmp_ps(_mm256_mul_ps(off, off), _mm256_load_ps(most + i), _CMP_LE_OQ);
        met |= (uint64_t)(uint32_t)_mm256_movemask_ps(is_met) << i;
    }
    return met;
}

/* The lanes of four that have their bits set, in front; returns how many. */
AVX2 static inline uint32_t store_some(uint32_t *out, __m128i four, uint32_t bits)
{
    static const uint8_t IN_FRONT[16][4] = {{0}, {0},    {1},    {0, 1},    {2},    {0, 2},    {1, 2},    {0, 1, 2},
                                            {3}, {0, 3}, {1, 3}, {0, 1, 3}, {2, 3}, {0, 2, 3}, {1, 2, 3}, {0, 1, 2, 3}};
    int lanes;
    __builtin_memcpy(&lanes, IN_FRONT[bits], sizeof lanes);
    __m128 moved = _mm_permutevar_ps(_mm_castsi128_ps(four), _mm_cvtepu8_epi32(_mm_cvtsi32_si128(lanes)));
    _mm_storeu_ps((float *)(void *)out, moved);
    return (uint32_t)__builtin_popcount(bits);
}

AVX2 static inline uint32_t store_some_of_8(uint32_t *out, __m256i eight, uint32_t bits)
{
    uint32_t low = store_some(out, _mm256_castsi256_si128(eight), bits & 15);
    return low + store_some(out + low, _mm256_extracti128_si256(eight, 1), bits >> 4);
}

AVX2 static void descend(const photon_tree *tree, const lookup_columns *points, const lookup_visits *nodes,
                         lookup_visits *out_children)
{
    const float *coordinates = points->column[0];
    __m256i one = _mm256_set1_epi32(1), height = _mm256_set1_epi32(PHOTON_LOOKUPS_MAX),
            lanes = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
    uint32_t count = 0;
    for (uint32_t i = 0; i < nodes->count; i += WIDTH) {
        /* beyond the last there is rubbish: lookup 0 at the root instead */
        uint32_t left = nodes->count - i;
        __m256i is_there = _mm256_cmpgt_epi32(_mm256_set1_epi32((int)left), lanes);
        __m256i lookup = _mm256_and_si256(load(&nodes->lookup[i]), is_there);
        __m256i node = _mm256_and_si256(load(&nodes->node[i]), is_there);
        nodes_8 n = gather_nodes(tree, node);
        __m256 at = _mm256_i32gather_ps(coordinates, _mm256_add_epi32(_mm256_mullo_epi32(n.axis, height), lookup), 4);
        __m256 most = _mm256_i32gather_ps(points->column[LOOKUP_REACH_SQUARED], lookup, 4);
        __m256 off = _mm256_sub_ps(at, n.split);
        __m256i is_right = _mm256_castps_si256(_mm256_cmp_ps(at, n.split, _CMP_GE_OQ)); /* -1 */
        __m256i first_child = _mm256_add_epi32(_mm256_add_epi32(node, node), one);
        store(&out_children->lookup[count], lookup);
        store(&out_children->node[count], _mm256_sub_epi32(first_child, is_right));
        count += left < WIDTH ? left : WIDTH;
        __m256 is_met =
            _mm256_and_ps(_mm256_cmp_ps(_mm256_mul_ps(off, off), most, _CMP_LE_OQ), _mm256_castsi256_ps(is_there));
        uint32_t met = (uint32_t)_mm256_movemask_ps(is_met);
        store_some_of_8(&out_children->lookup[count], lookup, met);
        __m256i other = _mm256_add_epi32(_mm256_add_epi32(first_child, one), is_right);
        count += store_some_of_8(&out_children->node[count], other, met);
    }
    out_children->count = count;
}

/* photon_block_nearest. */
AVX2 static inline float block_nearest(const photon_block *b, __m256 px, __m256 py, __m256 pz, uint32_t *out_lane)
{
    __m256 d[2];
    for (uint32_t i = 0; i < 2; i++) {
        __m256 x = _mm256_sub_ps(_mm256_load_ps(&b->position[0][WIDTH * i]), px);
        __m256 y = _mm256_sub_ps(_mm256_load_ps(&b->position[1][WIDTH * i]), py);
        __m256 z = _mm256_sub_ps(_mm256_load_ps(&b->position[2][WIDTH * i]), pz);
        d[i] = _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(x, x), _mm256_mul_ps(y, y)), _mm256_mul_ps(z, z));
    }
    /* of what is no number, the second */
    __m256 least = _mm256_min_ps(d[1], _mm256_min_ps(d[0], _mm256_set1_ps(INFINITY)));
    least = _mm256_min_ps(least, _mm256_permute2f128_ps(least, least, 1));
    least = _mm256_min_ps(least, _mm256_permute_ps(least, _MM_SHUFFLE(1, 0, 3, 2)));
    least = _mm256_min_ps(least, _mm256_permute_ps(least, _MM_SHUFFLE(2, 3, 0, 1)));
    uint32_t lanes = (uint32_t)_mm256_movemask_ps(_mm256_cmp_ps(d[0], least, _CMP_EQ_OQ)) |
                     (uint32_t)_mm256_movemask_ps(_mm256_cmp_ps(d[1], least, _CMP_EQ_OQ)) << WIDTH;
    *out_lane = (uint32_t)__builtin_ctz(lanes | 1u << (PHOTON_BLOCK_LANES - 1));
    return _mm256_cvtss_f32(least);
}

AVX2 static void scan(const photon_block *blocks, const lookup_columns *points, const lookup_visits *leaves,
                      lookup_visits *out_photons, float *out_distances_squared)
{
    enum { AHEAD = 6 };
    uint32_t count = 0;
    for (uint32_t i = 0; i < leaves->count; i++) {
        uint32_t lane, lookup = leaves->lookup[i], leaf = leaves->node[i];
        if (i + AHEAD < leaves->count)
            photon_block_prefetch(&blocks[leaves->node[i + AHEAD]]);
        float d = block_nearest(&blocks[leaf], _mm256_broadcast_ss(&points->column[0][lookup]),
                                _mm256_broadcast_ss(&points->column[1][lookup]),
                                _mm256_broadcast_ss(&points->column[2][lookup]), &lane);
        out_photons->lookup[count] = lookup;
        out_photons->node[count] = leaf * PHOTON_BLOCK_LANES + lane;
        out_distances_squared[count] = d;
        count += d <= points->column[LOOKUP_REACH_SQUARED][lookup];
    }
    out_photons->count = count;
}

const lookup_kernels *lookup_kernels_avx2(void)
{
    static const lookup_kernels KERNELS = {find_leaves, meet_plane, descend, scan};
    return avx2_is_there() ? &KERNELS : NULL;
}

#else

const lookup_kernels *lookup_kernels_avx2(void) { return NULL; }

#endif
