/* disc_kernels_avx512.c: a leaf's sixteen photons at a time; see disc_kernels.h. No fused multiplications: their
 * rounding is another. Lists are compressed in a register and then stored, since some processors compress into memory
 * slowly. Threads: see disc_kernels.h. */
#include "disc_kernels.h"

#if defined(__x86_64__)

#include "avx512.h"

enum { WIDTH = PHOTON_BLOCK_LANES };
_Static_assert((int)WIDTH == 16, "a vector is a leaf");

/* Three columns of sixteen. */
typedef struct vec3_16 {
    __m512 x, y, z;
} vec3_16;

AVX512 static inline vec3_16 fill(vec3 v)
{
    return (vec3_16){_mm512_set1_ps(v.x), _mm512_set1_ps(v.y), _mm512_set1_ps(v.z)};
}
AVX512 static inline vec3_16 sub(vec3_16 a, vec3_16 b)
{
    return (vec3_16){_mm512_sub_ps(a.x, b.x), _mm512_sub_ps(a.y, b.y), _mm512_sub_ps(a.z, b.z)};
}
AVX512 static inline __m512 dot(vec3_16 a, vec3_16 b)
{
    return _mm512_add_ps(_mm512_add_ps(_mm512_mul_ps(a.x, b.x), _mm512_mul_ps(a.y, b.y)), _mm512_mul_ps(a.z, b.z));
}
AVX512 static inline __m512 negate(__m512 a) { return _mm512_xor_ps(a, _mm512_set1_ps(-0.0f)); }

/* direction_decode_unnormalized of a leaf's photons. */
AVX512 static inline vec3_16 decode(const uint16_t codes[PHOTON_BLOCK_LANES])
{
    const __m512 middle = _mm512_set1_ps(127.0f), step = _mm512_set1_ps(1.0f / 127.0f), zero = _mm512_setzero_ps();
    __m512i code = _mm512_cvtepu16_epi32(_mm256_load_si256((const __m256i *)(const void *)codes));
    __m512 x = _mm512_mul_ps(_mm512_sub_ps(_mm512_cvtepi32_ps(_mm512_srli_epi32(code, 8)), middle), step);
    __m512 y =
        _mm512_mul_ps(_mm512_sub_ps(_mm512_cvtepi32_ps(_mm512_and_si512(code, _mm512_set1_epi32(255))), middle), step);
    __m512 z = _mm512_sub_ps(_mm512_sub_ps(_mm512_set1_ps(1.0f), _mm512_abs_ps(x)), _mm512_abs_ps(y));
    __mmask16 is_folded = _mm512_cmp_ps_mask(z, zero, _CMP_LT_OQ);
    /* fold with the sign of x or of y, from which it is subtracted; where nothing is folded, that zero */
    const __m512i sign = _mm512_set1_epi32(INT32_MIN);
    __m512i fold = _mm512_maskz_mov_epi32(is_folded, _mm512_castps_si512(negate(z)));
    __m512i fold_x = _mm512_or_si512(fold, _mm512_and_si512(_mm512_castps_si512(x), sign));
    __m512i fold_y = _mm512_or_si512(fold, _mm512_and_si512(_mm512_castps_si512(y), sign));
    return (vec3_16){_mm512_sub_ps(x, _mm512_castsi512_ps(fold_x)), _mm512_sub_ps(y, _mm512_castsi512_ps(fold_y)), z};
}

/* Stores the lanes whose bits are set, in their order. out: room for these alone. Returns their number. */
AVX512 static inline uint32_t store_some(uint32_t *out, __m512i lanes, __mmask16 which)
{
    uint32_t count = (uint32_t)__builtin_popcount(which);
    _mm512_mask_storeu_epi32(out, (__mmask16)((1u << count) - 1), _mm512_maskz_compress_epi32(which, lanes));
    return count;
}

/* Returns the bits of 2^level nodes, each as often as leaves lie below it in a subtree of sixteen. */
AVX512 static inline uint32_t to_leaves(uint32_t bits, uint32_t level)
{
    static const uint32_t FIRST[4] = {0x0001, 0x0101, 0x1111, 0x5555};
    return (uint32_t)_pdep_u32(bits >> (1u << level), FIRST[level]) * ((1u << (16u >> level)) - 1);
}

AVX512 static uint32_t find_leaves(const photon_query *q, photon_subtree subtree, float most, uint32_t *out_leaves)
{
    static const uint32_t RIGHT[4] = {0xff00, 0xf0f0, 0xcccc, 0xaaaa};
    const photon_tree_node *nodes = q->tree->nodes;
    const uint32_t first = subtree.node, second = 2 * first + 1, third = 2 * second + 1, fourth = 2 * third + 1;

    /* The fifteen planes in a heap's order: the first in lane 1. */
    __m128i one = _mm_loadl_epi64((const __m128i *)(const void *)&nodes[first]);
    __m256i three = _mm256_inserti128_si256(_mm256_castsi128_si256(_mm_unpacklo_epi64(one, one)),
                                            _mm_loadu_si128((const __m128i *)(const void *)&nodes[second]), 1);
    __m512i seven = _mm512_inserti64x4(_mm512_castsi256_si512(three),
                                       _mm256_loadu_si256((const __m256i *)(const void *)&nodes[third]), 1);
    __m512i eight = _mm512_loadu_si512(&nodes[fourth]);
    const __m512i even = _mm512_slli_epi32(avx512_lanes(), 1);
    __m512 split = _mm512_castsi512_ps(_mm512_permutex2var_epi32(seven, even, eight));
    __m512i axis = _mm512_permutex2var_epi32(seven, _mm512_or_si512(even, _mm512_set1_epi32(1)), eight);

    /* Where a leaf is not on the query's side of a plane, it is at least as far along the axis as the plane. */
    __m512 off = _mm512_permutexvar_ps(axis, _mm512_castps128_ps512((__m128)q->at));
    const uint32_t is_right = _mm512_cmp_ps_mask(off, split, _CMP_GE_OQ);
    const uint32_t is_y = _mm512_test_epi32_mask(axis, _mm512_set1_epi32(1)),
                   is_z = _mm512_test_epi32_mask(axis, _mm512_set1_epi32(2));
    off = _mm512_sub_ps(off, split);
    vec3_16 offset = {_mm512_set1_ps(subtree.offset[0]), _mm512_set1_ps(subtree.offset[1]),
                      _mm512_set1_ps(subtree.offset[2])};
    for (uint32_t level = 0; level < 4; level++) {
        __m512i node = _mm512_srli_epi32(_mm512_or_si512(avx512_lanes(), _mm512_set1_epi32(16)), 4 - level);
        __m512 there = _mm512_permutexvar_ps(node, off);
        uint32_t is_other = to_leaves(is_right, level) ^ RIGHT[level];
        uint32_t along_y = to_leaves(is_y, level), along_z = to_leaves(is_z, level);
        offset.x = _mm512_mask_mov_ps(offset.x, (__mmask16)(is_other & ~(along_y | along_z)), there);
        offset.y = _mm512_mask_mov_ps(offset.y, (__mmask16)(is_other & along_y), there);
        offset.z = _mm512_mask_mov_ps(offset.z, (__mmask16)(is_other & along_z), there);
    }
    __m512 beyond = dot(offset, offset);
    uint32_t is_met = _mm512_mask_cmp_ps_mask(_mm512_cmp_ps_mask(beyond, _mm512_set1_ps(most), _CMP_LE_OQ), beyond,
                                              _mm512_set1_ps(INFINITY), _CMP_LT_OQ);
    if (!(nodes[first].split < INFINITY))
        is_met &= 0x00ff; /* Nothing is right of a plane at infinity. Planes there may be finite: the tree promises
                             three levels, not four. */
    uint32_t base = 2 * fourth + 1 - ((1u << q->tree->depth) - 1);
    return store_some(out_leaves, _mm512_add_epi32(_mm512_set1_epi32((int)base), avx512_lanes()), (__mmask16)is_met);
}

/* Returns, as bits, photon_query_has_similar_normal of a block's photons, and writes the least distance of the other
 * photons that are within the limit and do not face away. */
AVX512 static inline uint32_t find_similar(const photon_query *q, const photon_block *b, __m512 d, __mmask16 within,
                                           float *in_out_other)
{
    const __m512 zero = _mm512_setzero_ps(), min_squared = _mm512_set1_ps(q->min_cos * q->min_cos);
    vec3_16 n = decode(b->normal);
    __m512 cosine = dot(n, fill(q->normal)), square = dot(n, n), cosine_squared = _mm512_mul_ps(cosine, cosine);
    __mmask16 is_similar = _mm512_mask_cmp_ps_mask(_mm512_mask_cmp_ps_mask(within, cosine, zero, _CMP_GT_OQ),
                                                   cosine_squared, _mm512_mul_ps(min_squared, square), _CMP_GT_OQ);
    __mmask16 is_behind = _mm512_mask_cmp_ps_mask(_mm512_cmp_ps_mask(cosine, zero, _CMP_LT_OQ), cosine_squared,
                                                  _mm512_mul_ps(_mm512_set1_ps(0.25f), square), _CMP_GT_OQ);
    uint32_t is_other = within & ~((uint32_t)is_similar | is_behind);
    if (is_other) {
        float least = _mm512_mask_reduce_min_ps((__mmask16)is_other, d);
        *in_out_other = least < *in_out_other ? least : *in_out_other;
    }
    return is_similar;
}

/* Codes of normals that are similar to a query's for sure. */
typedef struct near_codes {
    __m256i middle, most_apart; /* bytes: the halves of the query's own code, and how far from it they may be */
    uint32_t lanes;             /* 0: none is near enough */
} near_codes;

AVX512 static inline near_codes near_codes_of(const photon_query *q)
{
    const near_code_bound bound = near_code_bound_of(q);
    return (near_codes){_mm256_set1_epi16(bound.middle), _mm256_set1_epi8(bound.most_apart),
                        bound.is_any ? UINT32_MAX : 0};
}

/* Returns, as bits, those of a block's photons whose normals have such codes. */
AVX512 static inline uint32_t find_near_codes(const photon_block *b, const near_codes *near)
{
    __m256i codes = _mm256_load_si256((const __m256i *)(const void *)b->normal);
    __m256i apart = _mm256_or_si256(_mm256_subs_epu8(codes, near->middle), _mm256_subs_epu8(near->middle, codes));
    __m256i too_far = _mm256_subs_epu8(apart, near->most_apart);
    return _mm256_testn_epi16_mask(too_far, too_far) & near->lanes;
}

AVX512 static inline vec3_16 positions_of(const photon_block *b)
{
    return (vec3_16){_mm512_load_ps(b->position[0]), _mm512_load_ps(b->position[1]), _mm512_load_ps(b->position[2])};
}

/* Writes every leaf, and goes on to the next place only behind one in which photons were found, by arithmetic: a branch
 * on that would be predicted badly. */
AVX512 static uint32_t collect(photon_query *q, const uint32_t *leaves, uint32_t leaf_count, photon_found *f)
{
    const __m512 none = _mm512_set1_ps(NAN), limit = _mm512_set1_ps(f->limit);
    const near_codes near = near_codes_of(q);
    const vec3_16 at = {_mm512_set1_ps(q->position[0]), _mm512_set1_ps(q->position[1]), _mm512_set1_ps(q->position[2])};
    const photon_block *blocks = q->tree->blocks;
    const uint32_t leaf_capacity = f->leaf_capacity, most = f->capacity - PHOTON_BLOCK_LANES;
    uint32_t i = 0, found = f->leaf_count, count = f->count, *to_leaves = f->leaves;
    float *to = f->distances_squared, other = f->other_squared;
    for (; i < leaf_count && found < leaf_capacity && count <= most; i++) {
        const photon_block *b = &blocks[leaves[i]];
        vec3_16 off = sub(positions_of(b), at);
        __m512 d = dot(off, off);
        uint32_t within = _mm512_cmp_ps_mask(d, limit, _CMP_LE_OQ), similar = within & find_near_codes(b, &near);
        if (similar != within)
            similar = find_similar(q, b, d, (__mmask16)within, &other);
        _mm512_store_ps(to + (size_t)found * PHOTON_BLOCK_LANES, _mm512_mask_mov_ps(none, (__mmask16)similar, d));
        to_leaves[found] = leaves[i];
        found += similar != 0;
        count += (uint32_t)__builtin_popcount(similar);
    }
    f->other_squared = other;
    f->leaf_count = found;
    f->count = count;
    return i;
}

AVX512 static void count_within(const photon_found *f, const float most[DISC_COUNTS], uint32_t out_counts[DISC_COUNTS])
{
    _Static_assert(DISC_COUNTS == 3, "what stays in registers");
    const __m512 a = _mm512_set1_ps(most[0]), b = _mm512_set1_ps(most[1]), c = _mm512_set1_ps(most[2]);
    uint32_t in_a = 0, in_b = 0, in_c = 0;
    const float *d = f->distances_squared, *end = d + (size_t)f->leaf_count * PHOTON_BLOCK_LANES;
    for (; d < end; d += PHOTON_BLOCK_LANES) {
        __m512 leaf = _mm512_load_ps(d);
        in_a += (uint32_t)__builtin_popcount(_mm512_cmp_ps_mask(leaf, a, _CMP_LE_OQ));
        in_b += (uint32_t)__builtin_popcount(_mm512_cmp_ps_mask(leaf, b, _CMP_LE_OQ));
        in_c += (uint32_t)__builtin_popcount(_mm512_cmp_ps_mask(leaf, c, _CMP_LE_OQ));
    }
    out_counts[0] = in_a;
    out_counts[1] = in_b;
    out_counts[2] = in_c;
}

/* Most leaves have few photons between or none, as good as random: there is no branch but for more than eight. */
AVX512 static uint32_t list_between(const photon_found *f, float low, float high, photon_neighbor *out_neighbors)
{
    const __m512 least = _mm512_set1_ps(low), most = _mm512_set1_ps(high);
    const __m512i lanes = avx512_lanes();
    const __m512i first = _mm512_setr_epi32(0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23);
    const __m512i second = _mm512_add_epi32(first, _mm512_set1_epi32(8));
    const uint32_t leaves = f->leaf_count;
    uint32_t count = 0;
    for (uint32_t i = 0; i < leaves; i++) {
        __m512 d = _mm512_load_ps(f->distances_squared + (size_t)i * PHOTON_BLOCK_LANES);
        __mmask16 between = _mm512_mask_cmp_ps_mask(_mm512_cmp_ps_mask(d, least, _CMP_GT_OQ), d, most, _CMP_LE_OQ);
        __m512i index = _mm512_add_epi32(_mm512_set1_epi32((int)(f->leaves[i] * PHOTON_BLOCK_LANES)), lanes);
        __m512i distances = _mm512_maskz_compress_epi32(between, _mm512_castps_si512(d)),
                indices = _mm512_maskz_compress_epi32(between, index);
        uint32_t here = (uint32_t)__builtin_popcount(between), bits = (1u << here) - 1;
        _mm512_mask_storeu_epi64(out_neighbors + count, (__mmask8)bits,
                                 _mm512_permutex2var_epi32(indices, first, distances));
        if (here > 8)
            _mm512_mask_storeu_epi64(out_neighbors + count + 8, (__mmask8)(bits >> 8),
                                     _mm512_permutex2var_epi32(indices, second, distances));
        count += here;
    }
    return count;
}

/* The sums of sixteen lanes. Fluxes few octaves below the strongest are summed in 32 bits, for as many photons as do
 * not overflow; nothing of them is lost. */
enum { NEAR_OCTAVES = 16, FLUSH_EVERY = 128 /* leaves: times 255 << NEAR_OCTAVES is less than 2^32 */ };

typedef struct near_sums {
    __m512i red, green, blue, x, y, z;
} near_sums;

AVX512 static inline near_sums near_sums_none(void)
{
    const __m512i none = _mm512_setzero_si512();
    return (near_sums){none, none, none, none, none, none};
}

AVX512 static inline int64_t sum_of_near(__m512i v)
{
    __m512i low = _mm512_and_si512(v, _mm512_set1_epi64(UINT32_MAX)), high = _mm512_srli_epi64(v, 32);
    return _mm512_reduce_add_epi64(_mm512_add_epi64(low, high)) << (32 - NEAR_OCTAVES);
}

/* Sums in 64 bits, since _mm512_reduce_add_epi32 adds signed numbers, which must not overflow. */
AVX512 static inline int32_t sum_of_offsets(__m512i v)
{
    __m512i low = _mm512_cvtepi32_epi64(_mm512_castsi512_si256(v)),
            high = _mm512_cvtepi32_epi64(_mm512_extracti64x4_epi64(v, 1));
    return (int32_t)_mm512_reduce_add_epi64(_mm512_add_epi64(low, high));
}

/* Adds the sums to all, and begins anew. */
AVX512 static inline void near_sums_flush(near_sums *s, bool has_offsets, photon_disc_sums *sums)
{
    sums->flux[0] += sum_of_near(s->red);
    sums->flux[1] += sum_of_near(s->green);
    sums->flux[2] += sum_of_near(s->blue);
    if (has_offsets) {
        photon_disc_add_offset(sums, 0, sum_of_offsets(s->x));
        photon_disc_add_offset(sums, 1, sum_of_offsets(s->y));
        photon_disc_add_offset(sums, 2, sum_of_offsets(s->z));
    }
    *s = near_sums_none();
}

/* The flux of photons of which some are too faint for near_sums; 0 is a photon that does not count. */
AVX512 __attribute__((noinline)) static void add_far(__m512i codes, int exponent_max, photon_disc_sums *sums)
{
    _Alignas(64) uint32_t code[WIDTH];
    _mm512_store_si512(code, codes);
    for (uint32_t i = 0; i < WIDTH; i++) {
        uint32_t below = (uint32_t)(exponent_max - flux_exponent(code[i]));
        for (int c = 0; c < 3 && below < 64; c++)
            sums->flux[c] += (int64_t)((uint64_t)(code[i] >> (16 - 8 * c) & 255) << 32 >> below);
    }
}

/* photon_disc_add of those of a leaf's photons that count. */
AVX512 static inline void sums_add(near_sums *s, const photon_disc *disc, bool has_offsets, __m512 scale,
                                   const photon_block *b, vec3_16 offset, __mmask16 counts, photon_disc_sums *sums)
{
    const __m512i byte = _mm512_set1_epi32(255);
    __m512i code = _mm512_maskz_load_epi32(counts, b->flux);
    /* by how many octaves a flux is stronger than the faintest of the near ones; of those that do not count so far
     * below them that nothing is left */
    __m512i shift =
        _mm512_sub_epi32(_mm512_srli_epi32(code, 24), _mm512_set1_epi32(disc->flux_exponent_max + 128 - NEAR_OCTAVES));
    if (__builtin_expect(!(_mm512_movepi32_mask(shift) & counts), 1)) {
        __m512i red = _mm512_and_si512(_mm512_srli_epi32(code, 16), byte),
                green = _mm512_and_si512(_mm512_srli_epi32(code, 8), byte), blue = _mm512_and_si512(code, byte);
        s->red = _mm512_add_epi32(s->red, _mm512_sllv_epi32(red, shift));
        s->green = _mm512_add_epi32(s->green, _mm512_sllv_epi32(green, shift));
        s->blue = _mm512_add_epi32(s->blue, _mm512_sllv_epi32(blue, shift));
    } else {
        add_far(code, disc->flux_exponent_max, sums);
    }
    if (has_offsets) {
        s->x = _mm512_mask_add_epi32(s->x, counts, s->x, _mm512_cvttps_epi32(_mm512_mul_ps(offset.x, scale)));
        s->y = _mm512_mask_add_epi32(s->y, counts, s->y, _mm512_cvttps_epi32(_mm512_mul_ps(offset.y, scale)));
        s->z = _mm512_mask_add_epi32(s->z, counts, s->z, _mm512_cvttps_epi32(_mm512_mul_ps(offset.z, scale)));
    }
}

AVX512 static inline __m512 offset_scale(const photon_disc *disc)
{
    return _mm512_set1_ps(PHOTON_DISC_OFFSET_UNIT / disc->radius);
}

/* Returns, as bits, photon_disc_is_on_surface of those found. */
AVX512 static inline __mmask16 find_on_surface(const photon_disc *disc, const photon_block *b, vec3_16 offset,
                                               __mmask16 found)
{
    vec3_16 normal = fill(disc->normal);
    __m512 flat = _mm512_set1_ps(disc->flat_height), height = dot(offset, normal);
    uint32_t is_flat = _mm512_mask_cmp_ps_mask(found, _mm512_abs_ps(height), flat, _CMP_LE_OQ);
    if (is_flat == found)
        return found;
    vec3_16 n = decode(b->normal);
    __m512 below = _mm512_sub_ps(negate(height), flat), d = dot(n, normal), square = _mm512_mul_ps(d, d);
    __m512 lateral_squared = _mm512_sub_ps(dot(offset, offset), _mm512_mul_ps(height, height));
    __m512 least = _mm512_mul_ps(_mm512_mul_ps(below, below), square);
    __m512 most = _mm512_mul_ps(lateral_squared, _mm512_sub_ps(dot(n, n), square));
    uint32_t is_convex = _mm512_mask_cmp_ps_mask(_mm512_mask_cmp_ps_mask(found, below, _mm512_setzero_ps(), _CMP_GT_OQ),
                                                 least, most, _CMP_LE_OQ);
    return (__mmask16)(is_flat | is_convex);
}

AVX512 __attribute__((always_inline)) static inline uint32_t sum_on_surface_as(const photon_disc *disc,
                                                                               bool has_offsets, const photon_found *f,
                                                                               photon_disc_sums *out_sums,
                                                                               photon_neighbor *out_doubtful)
{
    const __m512 scale = offset_scale(disc), limit = _mm512_set1_ps(f->limit);
    const vec3_16 at = fill(disc->position);
    const uint32_t leaves = f->leaf_count;
    near_sums sums = near_sums_none();
    uint32_t kept = 0, doubtful = 0;
    *out_sums = (photon_disc_sums){{0}, {0}};
    for (uint32_t i = 0; i < leaves; near_sums_flush(&sums, has_offsets, out_sums)) {
        const uint32_t end = leaves - i < FLUSH_EVERY ? leaves : i + FLUSH_EVERY;
        for (; i < end; i++) {
            const uint32_t entry = i * PHOTON_BLOCK_LANES;
            __mmask16 found = _mm512_cmp_ps_mask(_mm512_load_ps(f->distances_squared + entry), limit, _CMP_LE_OQ);
            if (!found)
                continue;
            const photon_block *b = &disc->blocks[f->leaves[i]];
            vec3_16 offset = sub(positions_of(b), at);
            uint32_t on_surface = find_on_surface(disc, b, offset, found);
            sums_add(&sums, disc, has_offsets, scale, b, offset, (__mmask16)on_surface, out_sums);
            kept += (uint32_t)__builtin_popcount(on_surface);
            for (uint32_t rest = found & ~on_surface; rest; rest &= rest - 1)
                out_doubtful[doubtful++] = entry + (uint32_t)__builtin_ctz(rest);
        }
    }
    return kept;
}

AVX512 static uint32_t sum_on_surface(const photon_disc *disc, const photon_found *f, photon_disc_sums *out_sums,
                                      photon_neighbor *out_doubtful)
{
    return disc->has_offsets ? sum_on_surface_as(disc, true, f, out_sums, out_doubtful)
                             : sum_on_surface_as(disc, false, f, out_sums, out_doubtful);
}

/* Returns, as bits, surface_region_contains of points by their offset from the centre. */
AVX512 static inline __mmask16 find_inside(const surface_region *region, const __m512 line[2], vec3_16 offset)
{
    const __m512 zero = _mm512_setzero_ps();
    __m512 x = dot(offset, fill(region->x)), y = dot(offset, fill(region->y));
    __mmask16 is_steep = _mm512_cmp_ps_mask(_mm512_abs_ps(y), _mm512_abs_ps(x), _CMP_GT_OQ),
              is_left = _mm512_cmp_ps_mask(x, zero, _CMP_LT_OQ), is_low = _mm512_cmp_ps_mask(y, zero, _CMP_LT_OQ);
    __m512i part = _mm512_maskz_set1_epi32(is_steep, 1);
    part = _mm512_mask_or_epi32(part, is_left, part, _mm512_set1_epi32(2));
    part = _mm512_mask_or_epi32(part, is_low, part, _mm512_set1_epi32(4));
    __m512 a = _mm512_permutexvar_ps(part, line[0]), b = _mm512_permutexvar_ps(part, line[1]);
    __m512 along = _mm512_add_ps(_mm512_mul_ps(a, x), _mm512_mul_ps(b, y));
    return _mm512_cmp_ps_mask(along, _mm512_set1_ps(1.0f), _CMP_LE_OQ);
}

AVX512 static uint32_t sum_in_region(const photon_disc *disc, const surface_region *region, const photon_found *f,
                                     photon_disc_sums *out_sums)
{
    _Alignas(64) float lines[2][WIDTH] = {{0.0f}};
    for (int a = 0; a < 2; a++)
        for (int i = 0; i < 8; i++)
            lines[a][i] = region->line[SURFACE_REGION_OCTANT_BY_SIGNS[i]][a];
    const __m512 line[2] = {_mm512_load_ps(lines[0]), _mm512_load_ps(lines[1])};
    const __m512 scale = offset_scale(disc), limit = _mm512_set1_ps(f->limit);
    const vec3_16 at = fill(disc->position);
    const uint32_t leaves = f->leaf_count;
    near_sums sums = near_sums_none();
    uint32_t inside = 0;
    *out_sums = (photon_disc_sums){{0}, {0}};
    for (uint32_t i = 0; i < leaves; near_sums_flush(&sums, true, out_sums)) {
        const uint32_t end = leaves - i < FLUSH_EVERY ? leaves : i + FLUSH_EVERY;
        for (; i < end; i++) {
            uint32_t found =
                _mm512_cmp_ps_mask(_mm512_load_ps(f->distances_squared + (size_t)i * WIDTH), limit, _CMP_LE_OQ);
            if (!found)
                continue;
            const photon_block *b = &disc->blocks[f->leaves[i]];
            vec3_16 offset = sub(positions_of(b), at);
            uint32_t is_inside = found & find_inside(region, line, offset);
            sums_add(&sums, disc, true, scale, b, offset, (__mmask16)is_inside, out_sums);
            inside += (uint32_t)__builtin_popcount(is_inside);
        }
    }
    return inside;
}

const disc_kernels *disc_kernels_avx512(void)
{
    static const disc_kernels KERNELS = {DISC_SUBTREE_LEVELS_MAX, find_leaves,  collect, count_within, list_between,
                                         sum_on_surface,          sum_in_region};
    return avx512_is_there() ? &KERNELS : NULL;
}

#else

const disc_kernels *disc_kernels_avx512(void) { return NULL; }

#endif
