/* disc_kernels_avx2.c: eight at a time; see disc_kernels.h. No fused multiplications: their rounding is another.
 * Threads: see disc_kernels.h. */
#include "disc_kernels.h"

#if defined(__x86_64__)

#include <immintrin.h>

#define AVX2 __attribute__((target("avx2,popcnt")))

enum { WIDTH = 8 };

/* Three columns of eight. */
typedef struct vec3_8 {
    __m256 x, y, z;
} vec3_8;

AVX2 static inline vec3_8 fill(vec3 v)
{
    return (vec3_8){_mm256_set1_ps(v.x), _mm256_set1_ps(v.y), _mm256_set1_ps(v.z)};
}
AVX2 static inline vec3_8 sub(vec3_8 a, vec3_8 b)
{
    return (vec3_8){_mm256_sub_ps(a.x, b.x), _mm256_sub_ps(a.y, b.y), _mm256_sub_ps(a.z, b.z)};
}
AVX2 static inline __m256 dot(vec3_8 a, vec3_8 b)
{
    return _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(a.x, b.x), _mm256_mul_ps(a.y, b.y)), _mm256_mul_ps(a.z, b.z));
}
AVX2 static inline __m256 sign_bit(void) { return _mm256_set1_ps(-0.0f); }
AVX2 static inline __m256 negate(__m256 a) { return _mm256_xor_ps(a, sign_bit()); }
AVX2 static inline __m256 absolute(__m256 a) { return _mm256_andnot_ps(sign_bit(), a); }
AVX2 static inline __m256 with_sign_of(__m256 a, __m256 sign)
{
    return _mm256_or_ps(absolute(a), _mm256_and_ps(sign_bit(), sign));
}
AVX2 static inline __m256i load(const void *eight) { return _mm256_loadu_si256((const __m256i *)eight); }

/* direction_decode_unnormalized. */
AVX2 static inline vec3_8 decode(__m256i code)
{
    __m256 middle = _mm256_set1_ps(127.0f), step = _mm256_set1_ps(1.0f / 127.0f), zero = _mm256_setzero_ps();
    __m256i low = _mm256_set1_epi32(255);
    __m256 x = _mm256_mul_ps(_mm256_sub_ps(_mm256_cvtepi32_ps(_mm256_srli_epi32(code, 8)), middle), step);
    __m256 y = _mm256_mul_ps(_mm256_sub_ps(_mm256_cvtepi32_ps(_mm256_and_si256(code, low)), middle), step);
    __m256 z = _mm256_sub_ps(_mm256_sub_ps(_mm256_set1_ps(1.0f), absolute(x)), absolute(y));
    __m256 fold = _mm256_and_ps(negate(z), _mm256_cmp_ps(z, zero, _CMP_LT_OQ));
    return (vec3_8){_mm256_sub_ps(x, with_sign_of(fold, x)), _mm256_sub_ps(y, with_sign_of(fold, y)), z};
}

/* Goes down one level of a subtree: in each lane the plane beside one of its eight leaves, and whether that leaf is on
 * its right. Where that is not the query's side, the leaf is at least as far along the axis as the plane. */
AVX2 static inline void go_down(vec3_8 at, __m256 split, __m256i axis, __m256i is_right, vec3_8 *in_out_offset)
{
    /* axes 1 and 2 by their bits, as the sign */
    __m256 is_y = _mm256_castsi256_ps(_mm256_slli_epi32(axis, 31)),
           is_z = _mm256_castsi256_ps(_mm256_slli_epi32(axis, 30));
    __m256 off = _mm256_blendv_ps(_mm256_blendv_ps(at.x, at.y, is_y), at.z, is_z);
    __m256 query_is_right = _mm256_cmp_ps(off, split, _CMP_GE_OQ);
    __m256 is_other = _mm256_xor_ps(query_is_right, _mm256_castsi256_ps(is_right));
    off = _mm256_sub_ps(off, split);
    in_out_offset->x =
        _mm256_blendv_ps(in_out_offset->x, off, _mm256_andnot_ps(is_y, _mm256_andnot_ps(is_z, is_other)));
    in_out_offset->y = _mm256_blendv_ps(in_out_offset->y, off, _mm256_and_ps(is_y, is_other));
    in_out_offset->z = _mm256_blendv_ps(in_out_offset->z, off, _mm256_and_ps(is_z, is_other));
}

AVX2 static uint32_t find_leaves(const photon_query *q, photon_subtree subtree, float most, uint32_t *out_leaves)
{
    const photon_tree_node *nodes = q->tree->nodes;
    const __m256i lanes = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
    uint32_t first = subtree.node, second = 2 * first + 1, third = 2 * second + 1, leaf = 2 * third + 1;
    vec3_8 at = {_mm256_set1_ps(q->position[0]), _mm256_set1_ps(q->position[1]), _mm256_set1_ps(q->position[2])};
    vec3_8 offset = {_mm256_set1_ps(subtree.offset[0]), _mm256_set1_ps(subtree.offset[1]),
                     _mm256_set1_ps(subtree.offset[2])};

    __m256i is_right = _mm256_srai_epi32(_mm256_slli_epi32(lanes, 29), 31); /* by bit 2 */
    go_down(at, _mm256_set1_ps(nodes[first].split), _mm256_set1_epi32((int)nodes[first].axis), is_right, &offset);

    /* pairs of split and axis, each for as many lanes as lie below */
    __m256i planes = _mm256_castsi128_si256(_mm_loadu_si128((const __m128i *)(const void *)&nodes[second]));
    __m256i half = _mm256_srli_epi32(_mm256_and_si256(lanes, _mm256_set1_epi32(4)), 1); /* 0 or 2 */
    is_right = _mm256_srai_epi32(_mm256_slli_epi32(lanes, 30), 31);
    go_down(at, _mm256_castsi256_ps(_mm256_permutevar8x32_epi32(planes, half)),
            _mm256_permutevar8x32_epi32(planes, _mm256_or_si256(half, _mm256_set1_epi32(1))), is_right, &offset);

    planes = load(&nodes[third]);
    __m256i quarter = _mm256_and_si256(lanes, _mm256_set1_epi32(6)); /* 0, 2, 4 or 6 */
    is_right = _mm256_srai_epi32(_mm256_slli_epi32(lanes, 31), 31);
    go_down(at, _mm256_castsi256_ps(_mm256_permutevar8x32_epi32(planes, quarter)),
            _mm256_permutevar8x32_epi32(planes, _mm256_or_si256(quarter, _mm256_set1_epi32(1))), is_right, &offset);

    __m256 beyond = dot(offset, offset);
    uint32_t met =
        (uint32_t)_mm256_movemask_ps(_mm256_and_ps(_mm256_cmp_ps(beyond, _mm256_set1_ps(most), _CMP_LE_OQ),
                                                   _mm256_cmp_ps(beyond, _mm256_set1_ps(INFINITY), _CMP_LT_OQ)));
    uint32_t count = 0, base = leaf - ((1u << q->tree->depth) - 1);
    for (; met; met &= met - 1)
        out_leaves[count++] = base + (uint32_t)__builtin_ctz(met);
    return count;
}

/* The neighbours of four that have their bits set, in front of `out`, which has room for four; returns how many. */
AVX2 static inline uint32_t store_some(photon_neighbor *out, __m256i four, uint32_t bits)
{
#define LANE(i) 2 * (i), 2 * (i) + 1
    static const uint8_t IN_FRONT[16][8] = {{0},
                                            {LANE(0)},
                                            {LANE(1)},
                                            {LANE(0), LANE(1)},
                                            {LANE(2)},
                                            {LANE(0), LANE(2)},
                                            {LANE(1), LANE(2)},
                                            {LANE(0), LANE(1), LANE(2)},
                                            {LANE(3)},
                                            {LANE(0), LANE(3)},
                                            {LANE(1), LANE(3)},
                                            {LANE(0), LANE(1), LANE(3)},
                                            {LANE(2), LANE(3)},
                                            {LANE(0), LANE(2), LANE(3)},
                                            {LANE(1), LANE(2), LANE(3)},
                                            {LANE(0), LANE(1), LANE(2), LANE(3)}};
#undef LANE
    __m256i lanes = _mm256_cvtepu8_epi32(_mm_loadl_epi64((const __m128i *)(const void *)IN_FRONT[bits]));
    _mm256_storeu_si256((__m256i *)(void *)out, _mm256_permutevar8x32_epi32(four, lanes));
    return (uint32_t)__builtin_popcount(bits);
}

/* Returns, as bits, photon_query_has_similar_normal of a block's photons, and writes the least distance of the other
 * photons that are within the limit and do not face away. */
AVX2 static inline uint32_t find_similar(const photon_query *q, const photon_block *b, const __m256 d[2], __m256 limit,
                                         float *in_out_other)
{
    vec3_8 wanted = fill(q->normal);
    __m256 zero = _mm256_setzero_ps(), min_squared = _mm256_set1_ps(q->min_cos * q->min_cos),
           quarter = _mm256_set1_ps(0.25f), others = _mm256_set1_ps(*in_out_other);
    uint32_t similar = 0;
    for (uint32_t i = 0; i < 2; i++) {
        __m128i codes = _mm_load_si128((const __m128i *)(const void *)&b->normal[WIDTH * i]);
        vec3_8 n = decode(_mm256_cvtepu16_epi32(codes));
        __m256 cosine = dot(n, wanted), square = dot(n, n), cosine_squared = _mm256_mul_ps(cosine, cosine);
        __m256 is_similar =
            _mm256_and_ps(_mm256_cmp_ps(cosine, zero, _CMP_GT_OQ),
                          _mm256_cmp_ps(cosine_squared, _mm256_mul_ps(min_squared, square), _CMP_GT_OQ));
        __m256 is_behind = _mm256_and_ps(_mm256_cmp_ps(cosine, zero, _CMP_LT_OQ),
                                         _mm256_cmp_ps(cosine_squared, _mm256_mul_ps(quarter, square), _CMP_GT_OQ));
        __m256 is_other = _mm256_andnot_ps(_mm256_or_ps(is_similar, is_behind), _mm256_cmp_ps(d[i], limit, _CMP_LE_OQ));
        others = _mm256_min_ps(_mm256_blendv_ps(others, d[i], is_other), others);
        similar |= (uint32_t)_mm256_movemask_ps(is_similar) << WIDTH * i;
    }
    __m128 least = _mm_min_ps(_mm256_castps256_ps128(others), _mm256_extractf128_ps(others, 1));
    least = _mm_min_ps(least, _mm_movehl_ps(least, least));
    least = _mm_min_ss(least, _mm_movehdup_ps(least));
    *in_out_other = _mm_cvtss_f32(least);
    return similar;
}

AVX2 static uint32_t collect(photon_query *q, const uint32_t *leaves, uint32_t leaf_count, photon_collection *c)
{
    const __m256i lanes = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
    vec3_8 at = {_mm256_set1_ps(q->position[0]), _mm256_set1_ps(q->position[1]), _mm256_set1_ps(q->position[2])};
    __m256 limit = _mm256_set1_ps(c->limit);
    photon_neighbor *end = c->neighbors + c->count, *last = c->neighbors + c->capacity - PHOTON_BLOCK_LANES;
    uint32_t i = 0;
    for (; i < leaf_count && end <= last; i++) {
        const photon_block *b = &q->tree->blocks[leaves[i]];
        __m256 d[2];
        uint32_t within = 0;
        for (uint32_t k = 0; k < 2; k++) {
            vec3_8 p = {_mm256_load_ps(&b->position[0][WIDTH * k]), _mm256_load_ps(&b->position[1][WIDTH * k]),
                        _mm256_load_ps(&b->position[2][WIDTH * k])};
            vec3_8 off = sub(p, at);
            d[k] = dot(off, off);
            within |= (uint32_t)_mm256_movemask_ps(_mm256_cmp_ps(d[k], limit, _CMP_LE_OQ)) << WIDTH * k;
        }
        if (!within)
            continue;
        uint32_t similar = q->similar_code == PHOTON_QUERY_NO_CODE
                               ? 0
                               : within & photon_block_with_normal(b, (uint16_t)q->similar_code);
        if (within & ~similar) {
            similar = within & find_similar(q, b, d, limit, &c->other);
            if (similar)
                q->similar_code = b->normal[__builtin_ctz(similar)];
        }
        __m256i index = _mm256_add_epi32(_mm256_set1_epi32((int)(leaves[i] * PHOTON_BLOCK_LANES)), lanes);
        for (uint32_t k = 0; k < 2; k++) {
            /* pairs of index and distance: lanes 0 1 4 5, and 2 3 6 7 */
            __m256i bits = _mm256_castps_si256(d[k]);
            __m256i a = _mm256_unpacklo_epi32(index, bits), e = _mm256_unpackhi_epi32(index, bits);
            end += store_some(end, _mm256_permute2x128_si256(a, e, 0x20), similar >> WIDTH * k & 15);
            end += store_some(end, _mm256_permute2x128_si256(a, e, 0x31), similar >> (WIDTH * k + 4) & 15);
            index = _mm256_add_epi32(index, _mm256_set1_epi32(WIDTH));
        }
    }
    c->count = (uint32_t)(end - c->neighbors);
    return i;
}

/* The squared distances of eight neighbours, but in the order 0 1 4 5 2 3 6 7 of theirs. */
AVX2 static inline __m256 distances(__m256i low, __m256i high)
{
    return _mm256_shuffle_ps(_mm256_castsi256_ps(low), _mm256_castsi256_ps(high), _MM_SHUFFLE(3, 1, 3, 1));
}

AVX2 static void select_nearest(photon_neighbor *n, uint32_t count, uint32_t wanted, float limit)
{
    photon_selection s;
    photon_selection_begin(&s, limit);
    __m256 scale = _mm256_set1_ps(s.scale);
    uint32_t whole = count & ~(uint32_t)(WIDTH - 1);
    for (uint32_t i = 0; i < whole; i += WIDTH) {
        _Alignas(32) uint32_t bin[WIDTH];
        __m256 d = distances(load(&n[i]), load(&n[i + 4]));
        _mm256_store_si256((__m256i *)(void *)bin, _mm256_cvttps_epi32(_mm256_mul_ps(d, scale)));
        for (uint32_t k = 0; k < WIDTH; k++)
            s.histogram[bin[k]]++;
    }
    photon_selection_count(&s, n, whole, count);
    if (!photon_selection_find_bin(&s, n, count, wanted))
        return;
    __m256i chosen = _mm256_set1_epi32((int)s.bin);
    for (uint32_t i = 0; i < whole; i += WIDTH) {
        /* both are read before either is written over */
        __m256i low = load(&n[i]), high = load(&n[i + 4]);
        __m256i its_bin = _mm256_cvttps_epi32(_mm256_mul_ps(distances(low, high), scale));
        its_bin = _mm256_permute4x64_epi64(its_bin, _MM_SHUFFLE(3, 1, 2, 0));
        uint32_t nearer = (uint32_t)_mm256_movemask_ps(_mm256_castsi256_ps(_mm256_cmpgt_epi32(chosen, its_bin)));
        uint32_t in = (uint32_t)_mm256_movemask_ps(_mm256_castsi256_ps(_mm256_cmpeq_epi32(chosen, its_bin)));
        for (; in; in &= in - 1)
            s.in_bin[s.in_bin_count++] = n[i + (uint32_t)__builtin_ctz(in)];
        s.kept += store_some(n + s.kept, low, nearer & 15);
        s.kept += store_some(n + s.kept, high, nearer >> 4);
    }
    photon_selection_part(&s, n, whole, count);
    photon_selection_end(&s, n, wanted);
}

AVX2 static inline int64_t sum_of(__m256i v)
{
    __m128i two = _mm_add_epi64(_mm256_castsi256_si128(v), _mm256_extracti128_si256(v, 1));
    return _mm_cvtsi128_si64(_mm_add_epi64(two, _mm_unpackhi_epi64(two, two)));
}

AVX2 static inline int32_t sum_of_32(__m256i v)
{
    __m128i four = _mm_add_epi32(_mm256_castsi256_si128(v), _mm256_extracti128_si256(v, 1));
    __m128i two = _mm_add_epi32(four, _mm_unpackhi_epi64(four, four));
    return _mm_cvtsi128_si32(_mm_add_epi32(two, _mm_shuffle_epi32(two, 1)));
}

/* Mantissas, in the lowest bytes, times 2^32 and shifted down; of those 64 octaves below nothing is left. */
AVX2 static inline __m256i add_shifted(__m256i sum, __m256i mantissas, __m256i below)
{
    __m256i low = _mm256_set1_epi64x(UINT32_MAX);
    __m256i even = _mm256_srlv_epi64(_mm256_slli_epi64(mantissas, 32), _mm256_and_si256(below, low));
    __m256i odd = _mm256_srlv_epi64(_mm256_andnot_si256(low, mantissas), _mm256_srli_epi64(below, 32));
    return _mm256_add_epi64(_mm256_add_epi64(sum, even), odd);
}

/* Where the photons of four neighbours lie: their blocks in bytes from the first one, which may be more than 32 bits
 * can tell, and their lanes. */
typedef struct lanes_4 {
    __m256i block, lane;
} lanes_4;

AVX2 static inline lanes_4 find_lanes(__m256i four)
{
    __m256i index = _mm256_and_si256(four, _mm256_set1_epi64x(UINT32_MAX));
    __m256i block = _mm256_srli_epi64(index, 4); /* 16 lanes */
    return (lanes_4){_mm256_mul_epu32(block, _mm256_set1_epi64x(sizeof(photon_block))),
                     _mm256_and_si256(index, _mm256_set1_epi64x(PHOTON_BLOCK_LANES - 1))};
}

/* Gathers words of a column by offsets in bytes from the first block. */
AVX2 static inline __m256i gather_words(const void *column, __m256i low, __m256i high)
{
    return _mm256_set_m128i(_mm256_i64gather_epi32((const int *)column, high, 1),
                            _mm256_i64gather_epi32((const int *)column, low, 1));
}

AVX2 static inline __m256i word_of_lane(lanes_4 p) { return _mm256_add_epi64(p.block, _mm256_slli_epi64(p.lane, 2)); }

/* Gives the 32-bit word that holds a lane's half-word and its neighbour. */
AVX2 static inline __m256i pair_of_lane(lanes_4 p)
{
    __m256i pair = _mm256_srli_epi64(p.lane, 1);
    return _mm256_add_epi64(p.block, _mm256_slli_epi64(pair, 2));
}

AVX2 static inline __m256i gather_normals(const photon_block *blocks, lanes_4 low, lanes_4 high)
{
    __m256i pairs = gather_words(blocks->normal, pair_of_lane(low), pair_of_lane(high));
    /* lanes are few: the low words of all, side by side */
    __m256i lanes = _mm256_castps_si256(
        _mm256_shuffle_ps(_mm256_castsi256_ps(low.lane), _mm256_castsi256_ps(high.lane), _MM_SHUFFLE(2, 0, 2, 0)));
    lanes = _mm256_permute4x64_epi64(lanes, _MM_SHUFFLE(3, 1, 2, 0));
    __m256i is_odd = _mm256_and_si256(lanes, _mm256_set1_epi32(1));
    __m256i code = _mm256_srlv_epi32(pairs, _mm256_slli_epi32(is_odd, 4));
    return _mm256_and_si256(code, _mm256_set1_epi32(UINT16_MAX));
}

/* photon_disc_is_on_level, as bits. */
AVX2 static inline uint32_t find_on_level(const photon_disc *disc, vec3_8 offset, lanes_4 low, lanes_4 high)
{
    vec3_8 normal = fill(disc->normal);
    __m256 level = _mm256_set1_ps(disc->level), zero = _mm256_setzero_ps(), height = dot(offset, normal);
    uint32_t flat = (uint32_t)_mm256_movemask_ps(_mm256_cmp_ps(absolute(height), level, _CMP_LE_OQ));
    if (flat == 255)
        return flat;
    vec3_8 n = decode(gather_normals(disc->blocks, low, high));
    __m256 below = _mm256_sub_ps(negate(height), level), d = dot(n, normal), square = _mm256_mul_ps(d, d);
    __m256 lateral_squared = _mm256_sub_ps(dot(offset, offset), _mm256_mul_ps(height, height));
    __m256 least = _mm256_mul_ps(_mm256_mul_ps(below, below), square);
    __m256 most = _mm256_mul_ps(lateral_squared, _mm256_sub_ps(dot(n, n), square));
    __m256 is_convex = _mm256_and_ps(_mm256_cmp_ps(below, zero, _CMP_GT_OQ), _mm256_cmp_ps(least, most, _CMP_LE_OQ));
    return flat | (uint32_t)_mm256_movemask_ps(is_convex);
}

AVX2 static uint32_t sum_on_level(const photon_disc *disc, photon_neighbor *n, uint32_t count,
                                  photon_disc_sums *out_sums, photon_neighbor *out_doubtful)
{
    const photon_block *blocks = disc->blocks;
    vec3_8 position = fill(disc->position);
    __m256 scale = _mm256_set1_ps(PHOTON_DISC_OFFSET_UNIT / disc->radius);
    __m256i byte = _mm256_set1_epi32(255), most = _mm256_set1_epi32(disc->flux_exponent_max + 128),
            none = _mm256_setzero_si256(), flux[3] = {none, none, none}, offsets[3] = {none, none, none},
            bits = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    uint32_t kept = 0, doubtful = 0, i = 0;
    for (; i + WIDTH <= count; i += WIDTH) {
        /* both fours are read before either is written over */
        __m256i first = load(&n[i]), second = load(&n[i + 4]);
        lanes_4 low = find_lanes(first), high = find_lanes(second);
        __m256i low_word = word_of_lane(low), high_word = word_of_lane(high);
        vec3_8 at = {_mm256_castsi256_ps(gather_words(blocks->position[0], low_word, high_word)),
                     _mm256_castsi256_ps(gather_words(blocks->position[1], low_word, high_word)),
                     _mm256_castsi256_ps(gather_words(blocks->position[2], low_word, high_word))};
        vec3_8 offset = sub(at, position);
        uint32_t on_level = find_on_level(disc, offset, low, high);
        __m256i keeps = _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32((int)on_level), bits), bits);

        __m256i code = gather_words(blocks->flux, low_word, high_word);
        __m256i below = _mm256_sub_epi32(most, _mm256_srli_epi32(code, 24));
        code = _mm256_and_si256(code, keeps);
        for (int c = 0; c < 3; c++)
            flux[c] = add_shifted(flux[c], _mm256_and_si256(_mm256_srli_epi32(code, 16 - 8 * c), byte), below);
        const __m256 column[3] = {offset.x, offset.y, offset.z};
        for (int a = 0; a < 3; a++)
            offsets[a] = _mm256_add_epi32(
                offsets[a], _mm256_and_si256(_mm256_cvttps_epi32(_mm256_mul_ps(column[a], scale)), keeps));

        if (on_level == 255) {
            _mm256_storeu_si256((__m256i *)(void *)(n + kept), first);
            _mm256_storeu_si256((__m256i *)(void *)(n + kept + 4), second);
            kept += WIDTH;
            continue;
        }
        kept += store_some(n + kept, first, on_level & 15);
        kept += store_some(n + kept, second, on_level >> 4);
        doubtful += store_some(out_doubtful + doubtful, first, ~on_level & 15);
        doubtful += store_some(out_doubtful + doubtful, second, ~on_level >> 4 & 15);
    }
    for (int c = 0; c < 3; c++) {
        out_sums->flux[c] = sum_of(flux[c]);
        out_sums->offset[c] = sum_of_32(offsets[c]);
    }
    photon_disc_part(disc, n, i, count, &kept, out_sums, out_doubtful);
    return kept;
}

const disc_kernels *disc_kernels_avx2(void)
{
    static const disc_kernels KERNELS = {find_leaves, collect, select_nearest, sum_on_level};
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("popcnt") ? &KERNELS : NULL;
}

#else

const disc_kernels *disc_kernels_avx2(void) { return NULL; }

#endif
