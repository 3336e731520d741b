/* lookup_kernels_avx512.c: sixteen at a time; see lookup_kernels.h. No fused multiplications: their rounding is
 * another. Threads: see lookup_kernels.h. */
#include "lookup_kernels.h"

#if defined(__x86_64__)

#include "avx512.h"

enum { WIDTH = 16 };

typedef struct nodes_16 {
    __m512 split;
    __m512i axis;
} nodes_16;

/* Pairs of a split and an axis, in two vectors, as columns. */
AVX512 static inline nodes_16 to_columns(__m512i low, __m512i high)
{
    const __m512i even = _mm512_slli_epi32(avx512_lanes(), 1), odd = _mm512_or_si512(even, _mm512_set1_epi32(1));
    return (nodes_16){_mm512_castsi512_ps(_mm512_permutex2var_epi32(low, even, high)),
                      _mm512_permutex2var_epi32(low, odd, high)};
}

/* Node by node, not word by word: half as many loads. */
AVX512 static inline nodes_16 gather_nodes(const photon_tree *tree, __m512i node)
{
    __m512i low = _mm512_i32gather_epi64(_mm512_castsi512_si256(node), tree->nodes, 8);
    __m512i high = _mm512_i32gather_epi64(_mm512_extracti64x4_epi64(node, 1), tree->nodes, 8);
    return to_columns(low, high);
}

/* Returns each lane's component along its axis. */
AVX512 static inline __m512 along(const __m512 at[3], __m512i axis)
{
    __mmask16 is_y = _mm512_test_epi32_mask(axis, _mm512_set1_epi32(1)),
              is_z = _mm512_test_epi32_mask(axis, _mm512_set1_epi32(2));
    return _mm512_mask_mov_ps(_mm512_mask_mov_ps(at[0], is_y, at[1]), is_z, at[2]);
}

/* Goes down one level. */
AVX512 static inline __m512i child_of(__m512i node, const __m512 at[3], nodes_16 n)
{
    const __m512i one = _mm512_set1_epi32(1);
    __m512i left = _mm512_add_epi32(_mm512_add_epi32(node, node), one);
    return _mm512_mask_add_epi32(left, _mm512_cmp_ps_mask(along(at, n.axis), n.split, _CMP_GE_OQ), left, one);
}

/* Some vectors at once, for each waits for its own way down. The nodes of the highest levels stay in registers. */
AVX512 static void find_leaves(const photon_tree *tree, const float *positions, uint32_t stride, uint32_t count,
                               uint32_t *out_leaves)
{
    enum { VECTORS = 4, AT_ONCE = VECTORS * WIDTH, HIGHEST = 5 /* levels, of 2^HIGHEST - 1 nodes */ };
    const __m512i base = _mm512_set1_epi32((int)(1u << tree->depth) - 1);
    const __m512i offset = _mm512_mullo_epi32(avx512_lanes(), _mm512_set1_epi32((int)stride));
    const uint32_t highest = tree->depth < HIGHEST ? 0 : HIGHEST;
    uint32_t i = 0;
    nodes_16 high[2] = {{_mm512_setzero_ps(), _mm512_setzero_si512()}, {_mm512_setzero_ps(), _mm512_setzero_si512()}};
    if (highest > 0) { /* the last of the 32 lanes is not used */
        high[0] = to_columns(_mm512_loadu_si512(tree->nodes), _mm512_loadu_si512(tree->nodes + 8));
        high[1] = to_columns(_mm512_loadu_si512(tree->nodes + 16), _mm512_maskz_loadu_epi64(0x7f, tree->nodes + 24));
    }
    for (; i + AT_ONCE <= count; i += AT_ONCE) {
        __m512 at[VECTORS][3];
        __m512i node[VECTORS];
        for (uint32_t v = 0; v < VECTORS; v++, positions += (size_t)WIDTH * stride) {
            for (int a = 0; a < 3; a++)
                at[v][a] = _mm512_i32gather_ps(offset, positions + a, 4);
            node[v] = _mm512_setzero_si512();
        }
        for (uint32_t level = 0; level < highest; level++)
            for (uint32_t v = 0; v < VECTORS; v++) {
                nodes_16 n = {_mm512_permutex2var_ps(high[0].split, node[v], high[1].split),
                              _mm512_permutex2var_epi32(high[0].axis, node[v], high[1].axis)};
                node[v] = child_of(node[v], at[v], n);
            }
        for (uint32_t level = highest; level < tree->depth; level++)
            for (uint32_t v = 0; v < VECTORS; v++)
                node[v] = child_of(node[v], at[v], gather_nodes(tree, node[v]));
        for (uint32_t v = 0; v < VECTORS; v++)
            _mm512_storeu_si512(out_leaves + i + v * WIDTH, _mm512_sub_epi32(node[v], base));
    }
    for (; i < count; i++, positions += stride)
        out_leaves[i] = photon_tree_leaf(tree, (vec3){positions[0], positions[1], positions[2]});
}

AVX512 static uint64_t meet_plane(const lookup_columns *points, photon_tree_node plane)
{
    const float *at = points->column[plane.axis], *most = points->column[LOOKUP_REACH_SQUARED];
    const __m512 split = _mm512_set1_ps(plane.split);
    uint64_t met = 0;
    for (uint32_t i = 0; i < PHOTON_LOOKUPS_MAX; i += WIDTH) {
        __m512 off = _mm512_sub_ps(_mm512_loadu_ps(at + i), split);
        met |= (uint64_t)_mm512_cmp_ps_mask(_mm512_mul_ps(off, off), _mm512_loadu_ps(most + i), _CMP_LE_OQ) << i;
    }
    return met;
}

/* A number for each of the lookups, in registers: a permutation takes less time than a gather. */
typedef struct column_64 {
    __m512 quarter[4];
} column_64;

AVX512 static inline column_64 load_column(const float column[PHOTON_LOOKUPS_MAX])
{
    _Static_assert((int)PHOTON_LOOKUPS_MAX == 4 * WIDTH, "four vectors");
    return (column_64){{_mm512_loadu_ps(column), _mm512_loadu_ps(column + WIDTH), _mm512_loadu_ps(column + 2 * WIDTH),
                        _mm512_loadu_ps(column + 3 * WIDTH)}};
}

AVX512 static inline __m512 look_up(const column_64 *c, __m512i lookup, __mmask16 is_high)
{
    return _mm512_mask_mov_ps(_mm512_permutex2var_ps(c->quarter[0], lookup, c->quarter[1]), is_high,
                              _mm512_permutex2var_ps(c->quarter[2], lookup, c->quarter[3]));
}

AVX512 static void descend(const photon_tree *tree, const lookup_columns *points, const lookup_visits *nodes,
                           lookup_visits *out_children)
{
    const column_64 x = load_column(points->column[0]), y = load_column(points->column[1]),
                    z = load_column(points->column[2]), reaches = load_column(points->column[LOOKUP_REACH_SQUARED]);
    const __m512i one = _mm512_set1_epi32(1), half = _mm512_set1_epi32(PHOTON_LOOKUPS_MAX / 2);
    uint32_t count = 0;
    for (uint32_t i = 0; i < nodes->count; i += WIDTH) {
        /* beyond the last there is rubbish: lookup 0 at the root instead */
        uint32_t left = nodes->count - i, here = left < WIDTH ? left : WIDTH;
        __mmask16 is_there = (__mmask16)((1u << here) - 1);
        __m512i lookup = _mm512_maskz_loadu_epi32(is_there, &nodes->lookup[i]);
        __m512i node = _mm512_maskz_loadu_epi32(is_there, &nodes->node[i]);
        nodes_16 n = gather_nodes(tree, node);
        __mmask16 is_high = _mm512_test_epi32_mask(lookup, half);
        const __m512 at[3] = {look_up(&x, lookup, is_high), look_up(&y, lookup, is_high), look_up(&z, lookup, is_high)};
        __m512 here_at = along(at, n.axis), off = _mm512_sub_ps(here_at, n.split);
        __mmask16 is_right = _mm512_cmp_ps_mask(here_at, n.split, _CMP_GE_OQ);
        __m512i left_child = _mm512_add_epi32(_mm512_add_epi32(node, node), one),
                right_child = _mm512_add_epi32(left_child, one);
        _mm512_storeu_si512(&out_children->lookup[count], lookup);
        _mm512_storeu_si512(&out_children->node[count], _mm512_mask_mov_epi32(left_child, is_right, right_child));
        count += here;
        __mmask16 is_met =
            _mm512_mask_cmp_ps_mask(is_there, _mm512_mul_ps(off, off), look_up(&reaches, lookup, is_high), _CMP_LE_OQ);
        __m512i other = _mm512_mask_mov_epi32(right_child, is_right, left_child);
        _mm512_storeu_si512(&out_children->lookup[count], _mm512_maskz_compress_epi32(is_met, lookup));
        _mm512_storeu_si512(&out_children->node[count], _mm512_maskz_compress_epi32(is_met, other));
        count += (uint32_t)__builtin_popcount(is_met);
    }
    out_children->count = count;
}

/* photon_block_nearest. */
AVX512 static inline float block_nearest(const photon_block *b, const lookup_columns *points, uint32_t lookup,
                                         uint32_t *out_lane)
{
    __m512 x = _mm512_sub_ps(_mm512_load_ps(b->position[0]), _mm512_set1_ps(points->column[0][lookup]));
    __m512 y = _mm512_sub_ps(_mm512_load_ps(b->position[1]), _mm512_set1_ps(points->column[1][lookup]));
    __m512 z = _mm512_sub_ps(_mm512_load_ps(b->position[2]), _mm512_set1_ps(points->column[2][lookup]));
    __m512 d = _mm512_add_ps(_mm512_add_ps(_mm512_mul_ps(x, x), _mm512_mul_ps(y, y)), _mm512_mul_ps(z, z));
    /* of what is no number, the second */
    __m256 eight =
        _mm256_min_ps(_mm512_extractf32x8_ps(d, 1), _mm256_min_ps(_mm512_castps512_ps256(d), _mm256_set1_ps(INFINITY)));
    __m128 least = _mm_min_ps(_mm256_castps256_ps128(eight), _mm256_extractf128_ps(eight, 1));
    least = _mm_min_ps(least, _mm_permute_ps(least, _MM_SHUFFLE(1, 0, 3, 2)));
    least = _mm_min_ps(least, _mm_permute_ps(least, _MM_SHUFFLE(2, 3, 0, 1)));
    uint32_t lanes = _mm512_cmp_ps_mask(d, _mm512_broadcastss_ps(least), _CMP_EQ_OQ);
    *out_lane = (uint32_t)__builtin_ctz(lanes | 1u << (PHOTON_BLOCK_LANES - 1));
    return _mm_cvtss_f32(least);
}

AVX512 static void scan(const photon_block *blocks, const lookup_columns *points, const lookup_visits *leaves,
                        lookup_visits *out_photons, float *out_distances_squared)
{
    enum { AHEAD = 6 };
    uint32_t count = 0;
    for (uint32_t i = 0; i < leaves->count; i++) {
        uint32_t lane, lookup = leaves->lookup[i], leaf = leaves->node[i];
        if (i + AHEAD < leaves->count)
            photon_block_prefetch(&blocks[leaves->node[i + AHEAD]]);
        float d = block_nearest(&blocks[leaf], points, lookup, &lane);
        out_photons->lookup[count] = lookup;
        out_photons->node[count] = leaf * PHOTON_BLOCK_LANES + lane;
        out_distances_squared[count] = d;
        count += d <= points->column[LOOKUP_REACH_SQUARED][lookup];
    }
    out_photons->count = count;
}

const lookup_kernels *lookup_kernels_avx512(void)
{
    static const lookup_kernels KERNELS = {find_leaves, meet_plane, descend, scan};
    return avx512_is_there() ? &KERNELS : NULL;
}

#else

const lookup_kernels *lookup_kernels_avx512(void) { return NULL; }

#endif
