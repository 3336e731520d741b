/* disc_kernels_avx2.c: eight at a time; see disc_kernels.h. No fused multiplications: their rounding is another.
 * Threads: see disc_kernels.h. */
#include "disc_kernels.h"

#if defined(__x86_64__)

#include "avx2.h"

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

/* Codes of normals that are similar to a query's for sure. */
typedef struct near_codes {
    __m256i middle, most_apart; /* bytes: the halves of the query's own code, and how far from it they may be */
    uint32_t lanes;             /* 0: none is near enough */
} near_codes;

AVX2 static inline near_codes near_codes_of(const photon_query *q)
{
    const near_code_bound bound = near_code_bound_of(q);
    return (near_codes){_mm256_set1_epi16(bound.middle), _mm256_set1_epi8(bound.most_apart),
                        bound.is_any ? UINT32_MAX : 0};
}

/* Returns, as bits, those of a block's photons whose normals have such codes. */
AVX2 static inline uint32_t find_near_codes(const photon_block *b, const near_codes *near)
{
    __m256i codes = _mm256_load_si256((const __m256i *)(const void *)b->normal);
    __m256i apart = _mm256_or_si256(_mm256_subs_epu8(codes, near->middle), _mm256_subs_epu8(near->middle, codes));
    __m256i is_near = _mm256_cmpeq_epi16(_mm256_subs_epu8(apart, near->most_apart), _mm256_setzero_si256());
    __m128i lanes = _mm_packs_epi16(_mm256_castsi256_si128(is_near), _mm256_extracti128_si256(is_near, 1));
    return (uint32_t)_mm_movemask_epi8(lanes) & near->lanes;
}

/* Squared distances of eight of a block's photons. */
AVX2 static inline __m256 find_distances(const photon_block *b, uint32_t lane, vec3_8 at)
{
    vec3_8 p = {_mm256_load_ps(&b->position[0][lane]), _mm256_load_ps(&b->position[1][lane]),
                _mm256_load_ps(&b->position[2][lane])};
    vec3_8 off = sub(p, at);
    return dot(off, off);
}

/* Returns a mask of eight lanes: those whose bits are set, from the lowest on. */
AVX2 static inline __m256 lanes_of(uint32_t bits)
{
    const __m256i each = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    __m256i its_bit = _mm256_and_si256(_mm256_set1_epi32((int)bits), each);
    return _mm256_castsi256_ps(_mm256_cmpeq_epi32(its_bit, each));
}

AVX2 static uint32_t collect(photon_query *q, const uint32_t *leaves, uint32_t leaf_count, photon_found *f)
{
    const __m256 none = _mm256_set1_ps(NAN), limit = _mm256_set1_ps(f->limit);
    const near_codes near = near_codes_of(q);
    const vec3_8 at = {_mm256_set1_ps(q->position[0]), _mm256_set1_ps(q->position[1]), _mm256_set1_ps(q->position[2])};
    const photon_block *blocks = q->tree->blocks;
    const uint32_t leaf_capacity = f->leaf_capacity, most = f->capacity - PHOTON_BLOCK_LANES;
    uint32_t i = 0, found = f->leaf_count, count = f->count, *to_leaves = f->leaves;
    float *to = f->distances_squared + (size_t)found * PHOTON_BLOCK_LANES;
    for (; i < leaf_count && found < leaf_capacity && count <= most; i++) {
        const photon_block *b = &blocks[leaves[i]];
        __m256 first = find_distances(b, 0, at), second = find_distances(b, WIDTH, at);
        __m256 in_first = _mm256_cmp_ps(first, limit, _CMP_LE_OQ), in_second = _mm256_cmp_ps(second, limit, _CMP_LE_OQ);
        uint32_t within = (uint32_t)_mm256_movemask_ps(in_first) | (uint32_t)_mm256_movemask_ps(in_second) << WIDTH;
        if (!within)
            continue;
        uint32_t similar = within & find_near_codes(b, &near);
        if (similar != within) {
            const __m256 d[2] = {first, second};
            similar = within & find_similar(q, b, d, limit, &f->other_squared);
            if (!similar)
                continue;
            in_first = lanes_of(similar);
            in_second = lanes_of(similar >> WIDTH);
        }
        _mm256_store_ps(to, _mm256_blendv_ps(none, first, in_first));
        _mm256_store_ps(to + WIDTH, _mm256_blendv_ps(none, second, in_second));
        to += PHOTON_BLOCK_LANES;
        to_leaves[found++] = leaves[i];
        count += (uint32_t)__builtin_popcount(similar);
    }
    f->leaf_count = found;
    f->count = count;
    return i;
}

AVX2 static inline uint32_t sum_of_32(__m256i v)
{
    __m128i four = _mm_add_epi32(_mm256_castsi256_si128(v), _mm256_extracti128_si256(v, 1));
    __m128i two = _mm_add_epi32(four, _mm_unpackhi_epi64(four, four));
    return (uint32_t)_mm_cvtsi128_si32(_mm_add_epi32(two, _mm_shuffle_epi32(two, 1)));
}

AVX2 static void count_within(const photon_found *f, const float most[DISC_COUNTS], uint32_t out_counts[DISC_COUNTS])
{
    _Static_assert(DISC_COUNTS == 3 && PHOTON_BLOCK_LANES == 2 * WIDTH, "what stays in registers");
    const __m256 a = _mm256_set1_ps(most[0]), b = _mm256_set1_ps(most[1]), c = _mm256_set1_ps(most[2]);
    __m256i in_a = _mm256_setzero_si256(), in_b = in_a, in_c = in_a; /* less so many */
    const float *d = f->distances_squared, *end = d + (size_t)f->leaf_count * PHOTON_BLOCK_LANES;
    for (; d < end; d += PHOTON_BLOCK_LANES) {
        __m256 first = _mm256_load_ps(d), second = _mm256_load_ps(d + WIDTH);
        in_a = _mm256_add_epi32(in_a, _mm256_castps_si256(_mm256_cmp_ps(first, a, _CMP_LE_OQ)));
        in_b = _mm256_add_epi32(in_b, _mm256_castps_si256(_mm256_cmp_ps(first, b, _CMP_LE_OQ)));
        in_c = _mm256_add_epi32(in_c, _mm256_castps_si256(_mm256_cmp_ps(first, c, _CMP_LE_OQ)));
        in_a = _mm256_add_epi32(in_a, _mm256_castps_si256(_mm256_cmp_ps(second, a, _CMP_LE_OQ)));
        in_b = _mm256_add_epi32(in_b, _mm256_castps_si256(_mm256_cmp_ps(second, b, _CMP_LE_OQ)));
        in_c = _mm256_add_epi32(in_c, _mm256_castps_si256(_mm256_cmp_ps(second, c, _CMP_LE_OQ)));
    }
    out_counts[0] = 0 - sum_of_32(in_a);
    out_counts[1] = 0 - sum_of_32(in_b);
    out_counts[2] = 0 - sum_of_32(in_c);
}

/* Returns, as bits, which of eight squared distances are between two others. */
AVX2 static inline uint32_t find_between(const float *d, __m256 least, __m256 most)
{
    __m256 eight = _mm256_load_ps(d);
    return (uint32_t)_mm256_movemask_ps(
        _mm256_and_ps(_mm256_cmp_ps(eight, least, _CMP_GT_OQ), _mm256_cmp_ps(eight, most, _CMP_LE_OQ)));
}

AVX2 static uint32_t list_between(const photon_found *f, float low, float high, photon_neighbor *out_neighbors)
{
    const __m256 least = _mm256_set1_ps(low), most = _mm256_set1_ps(high);
    const uint32_t leaves = f->leaf_count;
    uint32_t count = 0;
    for (uint32_t leaf = 0; leaf < leaves; leaf++) {
        const float *d = f->distances_squared + (size_t)leaf * PHOTON_BLOCK_LANES;
        uint32_t between = find_between(d, least, most) | find_between(d + WIDTH, least, most) << WIDTH;
        for (; between; between &= between - 1) {
            uint32_t lane = (uint32_t)__builtin_ctz(between);
            out_neighbors[count++] = photon_neighbor_make(d[lane], f->leaves[leaf] * PHOTON_BLOCK_LANES + lane);
        }
    }
    return count;
}

AVX2 static inline int64_t sum_of(__m256i v)
{
    __m128i two = _mm_add_epi64(_mm256_castsi256_si128(v), _mm256_extracti128_si256(v, 1));
    return _mm_cvtsi128_si64(_mm_add_epi64(two, _mm_unpackhi_epi64(two, two)));
}

/* Mantissas, in the lowest bytes, times 2^32 and shifted down; of those 64 octaves below nothing is left. */
AVX2 static inline __m256i add_shifted(__m256i sum, __m256i mantissas, __m256i below)
{
    __m256i low = _mm256_set1_epi64x(UINT32_MAX);
    __m256i even = _mm256_srlv_epi64(_mm256_slli_epi64(mantissas, 32), _mm256_and_si256(below, low));
    __m256i odd = _mm256_srlv_epi64(_mm256_andnot_si256(low, mantissas), _mm256_srli_epi64(below, 32));
    return _mm256_add_epi64(_mm256_add_epi64(sum, even), odd);
}

/* The sums of eight lanes. Fluxes few octaves below the strongest are summed in 32 bits, for as many photons as do not
 * overflow; nothing of them is lost. */
enum { NEAR_OCTAVES = 16, FLUSH_EVERY = 128 /* vectors: times 255 << NEAR_OCTAVES is less than 2^32 */ };

typedef struct near_sums {
    __m256i red, green, blue, x, y, z;
} near_sums;

AVX2 static inline near_sums near_sums_none(void)
{
    const __m256i none = _mm256_setzero_si256();
    return (near_sums){none, none, none, none, none, none};
}

AVX2 static inline int64_t sum_of_near(__m256i v)
{
    const __m256i low = _mm256_set1_epi64x(UINT32_MAX);
    __m256i both = _mm256_add_epi64(_mm256_and_si256(v, low), _mm256_srli_epi64(v, 32));
    return sum_of(both) << (32 - NEAR_OCTAVES);
}

/* Adds the sums to all, and begins anew. */
AVX2 static inline void near_sums_flush(near_sums *s, bool has_offsets, photon_disc_sums *sums)
{
    sums->flux[0] += sum_of_near(s->red);
    sums->flux[1] += sum_of_near(s->green);
    sums->flux[2] += sum_of_near(s->blue);
    if (has_offsets) {
        photon_disc_add_offset(sums, 0, (int32_t)sum_of_32(s->x));
        photon_disc_add_offset(sums, 1, (int32_t)sum_of_32(s->y));
        photon_disc_add_offset(sums, 2, (int32_t)sum_of_32(s->z));
    }
    *s = near_sums_none();
}

/* The flux of eight photons of which some are too faint for near_sums; 0 is a photon that does not count. */
AVX2 __attribute__((noinline)) static void add_far(__m256i code, __m256i below, photon_disc_sums *sums)
{
    const __m256i byte = _mm256_set1_epi32(255), none = _mm256_setzero_si256();
    for (int c = 0; c < 3; c++) {
        __m256i channel = _mm256_and_si256(_mm256_srlv_epi32(code, _mm256_set1_epi32(16 - 8 * c)), byte);
        sums->flux[c] += sum_of(add_shifted(none, channel, below));
    }
}

/* Returns one byte of each of eight words, 0 the lowest. */
AVX2 static inline __m256i byte_of(__m256i words, int byte)
{
    const __m256i first = _mm256_set1_epi32((int)0x80808000), word = _mm256_setr_epi32(0, 4, 8, 12, 0, 4, 8, 12);
    return _mm256_shuffle_epi8(words, _mm256_add_epi32(_mm256_add_epi32(first, word), _mm256_set1_epi32(byte)));
}

/* photon_disc_add of those of eight photons that count. */
AVX2 static inline void sums_add(near_sums *s, const photon_disc *disc, bool has_offsets, __m256 scale,
                                 const uint32_t *flux, vec3_8 offset, __m256i counts, photon_disc_sums *sums)
{
    const __m256i byte = _mm256_set1_epi32(255);
    __m256i code = _mm256_and_si256(_mm256_load_si256((const __m256i *)(const void *)flux), counts);
    /* by how many octaves a flux is stronger than the faintest of the near ones; of those that do not count so far
     * below them that nothing is left */
    __m256i shift =
        _mm256_sub_epi32(_mm256_srli_epi32(code, 24), _mm256_set1_epi32(disc->flux_exponent_max + 128 - NEAR_OCTAVES));
    if (__builtin_expect(_mm256_testz_ps(_mm256_castsi256_ps(shift), _mm256_castsi256_ps(counts)), 1)) {
        __m256i red = byte_of(code, 2), green = byte_of(code, 1), blue = _mm256_and_si256(code, byte);
        s->red = _mm256_add_epi32(s->red, _mm256_sllv_epi32(red, shift));
        s->green = _mm256_add_epi32(s->green, _mm256_sllv_epi32(green, shift));
        s->blue = _mm256_add_epi32(s->blue, _mm256_sllv_epi32(blue, shift));
    } else {
        add_far(code, _mm256_sub_epi32(_mm256_set1_epi32(NEAR_OCTAVES), shift), sums);
    }
    if (has_offsets) {
        s->x = _mm256_add_epi32(s->x, _mm256_and_si256(_mm256_cvttps_epi32(_mm256_mul_ps(offset.x, scale)), counts));
        s->y = _mm256_add_epi32(s->y, _mm256_and_si256(_mm256_cvttps_epi32(_mm256_mul_ps(offset.y, scale)), counts));
        s->z = _mm256_add_epi32(s->z, _mm256_and_si256(_mm256_cvttps_epi32(_mm256_mul_ps(offset.z, scale)), counts));
    }
}

AVX2 static inline __m256 offset_scale(const photon_disc *disc)
{
    return _mm256_set1_ps(PHOTON_DISC_OFFSET_UNIT / disc->radius);
}

/* Eight photons of those found, as vectors; false where none of them is. */
typedef struct photons_8 {
    const photon_block *block;
    uint32_t lane, found; /* the first one; as bits */
    __m256i is_found;
    vec3_8 offset; /* from the disc's centre */
} photons_8;

AVX2 static inline bool find_photons(const photon_disc *disc, const photon_found *f, uint32_t entry, photons_8 *out)
{
    __m256 is_found = _mm256_cmp_ps(_mm256_load_ps(f->distances_squared + entry), _mm256_set1_ps(f->limit), _CMP_LE_OQ);
    out->found = (uint32_t)_mm256_movemask_ps(is_found);
    if (!out->found)
        return false;
    const photon_block *b = &disc->blocks[f->leaves[entry / PHOTON_BLOCK_LANES]];
    uint32_t lane = entry % PHOTON_BLOCK_LANES;
    vec3_8 at = {_mm256_load_ps(&b->position[0][lane]), _mm256_load_ps(&b->position[1][lane]),
                 _mm256_load_ps(&b->position[2][lane])};
    out->block = b;
    out->lane = lane;
    out->is_found = _mm256_castps_si256(is_found);
    out->offset = sub(at, fill(disc->position));
    return true;
}

/* photon_disc_is_on_surface. */
AVX2 static inline __m256i find_on_surface(const photon_disc *disc, const photons_8 *p)
{
    vec3_8 normal = fill(disc->normal);
    __m256 flat = _mm256_set1_ps(disc->flat_height), height = dot(p->offset, normal);
    __m256 is_flat = _mm256_cmp_ps(absolute(height), flat, _CMP_LE_OQ);
    if (_mm256_testc_ps(is_flat, _mm256_castsi256_ps(p->is_found)))
        return _mm256_castps_si256(is_flat);
    __m128i codes = _mm_load_si128((const __m128i *)(const void *)&p->block->normal[p->lane]);
    vec3_8 n = decode(_mm256_cvtepu16_epi32(codes));
    __m256 below = _mm256_sub_ps(negate(height), flat), d = dot(n, normal), square = _mm256_mul_ps(d, d);
    __m256 lateral_squared = _mm256_sub_ps(dot(p->offset, p->offset), _mm256_mul_ps(height, height));
    __m256 least = _mm256_mul_ps(_mm256_mul_ps(below, below), square);
    __m256 most = _mm256_mul_ps(lateral_squared, _mm256_sub_ps(dot(n, n), square));
    __m256 is_convex =
        _mm256_and_ps(_mm256_cmp_ps(below, _mm256_setzero_ps(), _CMP_GT_OQ), _mm256_cmp_ps(least, most, _CMP_LE_OQ));
    return _mm256_castps_si256(_mm256_or_ps(is_flat, is_convex));
}

AVX2 __attribute__((always_inline)) static inline uint32_t sum_on_surface_as(const photon_disc *disc, bool has_offsets,
                                                                             const photon_found *f,
                                                                             photon_disc_sums *out_sums,
                                                                             photon_neighbor *out_doubtful)
{
    const __m256 scale = offset_scale(disc);
    const uint32_t entries = f->leaf_count * PHOTON_BLOCK_LANES;
    near_sums sums = near_sums_none();
    uint32_t kept = 0, doubtful = 0;
    *out_sums = (photon_disc_sums){{0}, {0}};
    for (uint32_t i = 0; i < entries; near_sums_flush(&sums, has_offsets, out_sums)) {
        const uint32_t end = entries - i < FLUSH_EVERY * WIDTH ? entries : i + FLUSH_EVERY * WIDTH;
        for (; i < end; i += WIDTH) {
            photons_8 p;
            if (!find_photons(disc, f, i, &p))
                continue;
            __m256i keeps = _mm256_and_si256(find_on_surface(disc, &p), p.is_found);
            sums_add(&sums, disc, has_offsets, scale, &p.block->flux[p.lane], p.offset, keeps, out_sums);
            uint32_t on_surface = (uint32_t)_mm256_movemask_ps(_mm256_castsi256_ps(keeps));
            kept += (uint32_t)__builtin_popcount(on_surface);
            for (uint32_t rest = p.found & ~on_surface; rest; rest &= rest - 1)
                out_doubtful[doubtful++] = i + (uint32_t)__builtin_ctz(rest);
        }
    }
    return kept;
}

AVX2 static uint32_t sum_on_surface(const photon_disc *disc, const photon_found *f, photon_disc_sums *out_sums,
                                    photon_neighbor *out_doubtful)
{
    return disc->has_offsets ? sum_on_surface_as(disc, true, f, out_sums, out_doubtful)
                             : sum_on_surface_as(disc, false, f, out_sums, out_doubtful);
}

/* surface_region_contains of points by their offset from the centre. */
AVX2 static inline __m256i find_inside(const surface_region *region, const __m256 line[2], vec3_8 offset)
{
    __m256 zero = _mm256_setzero_ps(), x = dot(offset, fill(region->x)), y = dot(offset, fill(region->y));
    __m256 is_steep = _mm256_cmp_ps(absolute(y), absolute(x), _CMP_GT_OQ), is_left = _mm256_cmp_ps(x, zero, _CMP_LT_OQ),
           is_low = _mm256_cmp_ps(y, zero, _CMP_LT_OQ);
    __m256i part =
        _mm256_or_si256(_mm256_or_si256(_mm256_and_si256(_mm256_castps_si256(is_steep), _mm256_set1_epi32(1)),
                                        _mm256_and_si256(_mm256_castps_si256(is_left), _mm256_set1_epi32(2))),
                        _mm256_and_si256(_mm256_castps_si256(is_low), _mm256_set1_epi32(4)));
    __m256 a = _mm256_permutevar8x32_ps(line[0], part), b = _mm256_permutevar8x32_ps(line[1], part);
    __m256 along = _mm256_add_ps(_mm256_mul_ps(a, x), _mm256_mul_ps(b, y));
    return _mm256_castps_si256(_mm256_cmp_ps(along, _mm256_set1_ps(1.0f), _CMP_LE_OQ));
}

AVX2 static uint32_t sum_in_region(const photon_disc *disc, const surface_region *region, const photon_found *f,
                                   photon_disc_sums *out_sums)
{
    const float *lines = region->line[0];
    const __m256i octants = _mm256_slli_epi32(load(SURFACE_REGION_OCTANT_BY_SIGNS), 1);
    const __m256 line[2] = {_mm256_i32gather_ps(lines, octants, 4), _mm256_i32gather_ps(lines + 1, octants, 4)};
    const __m256 scale = offset_scale(disc);
    const uint32_t entries = f->leaf_count * PHOTON_BLOCK_LANES;
    near_sums sums = near_sums_none();
    uint32_t inside = 0;
    *out_sums = (photon_disc_sums){{0}, {0}};
    for (uint32_t i = 0; i < entries; near_sums_flush(&sums, true, out_sums)) {
        const uint32_t end = entries - i < FLUSH_EVERY * WIDTH ? entries : i + FLUSH_EVERY * WIDTH;
        for (; i < end; i += WIDTH) {
            photons_8 p;
            if (!find_photons(disc, f, i, &p))
                continue;
            __m256i is_inside = _mm256_and_si256(find_inside(region, line, p.offset), p.is_found);
            sums_add(&sums, disc, true, scale, &p.block->flux[p.lane], p.offset, is_inside, out_sums);
            inside += (uint32_t)__builtin_popcount((uint32_t)_mm256_movemask_ps(_mm256_castsi256_ps(is_inside)));
        }
    }
    return inside;
}

const disc_kernels *disc_kernels_avx2(void)
{
    static const disc_kernels KERNELS = {PHOTON_SUBTREE_LEVELS, find_leaves,    collect,      count_within,
                                         list_between,          sum_on_surface, sum_in_region};
    return avx2_is_there() ? &KERNELS : NULL;
}

#else

const disc_kernels *disc_kernels_avx2(void) { return NULL; }

#endif
