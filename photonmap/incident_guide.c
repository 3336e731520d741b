/* incident_guide.c: see incident_guide.h. */
#include "incident_guide.h"

#include "math/sampling.h"

#if defined(__x86_64__)
#include "avx2.h"
#endif

/* The one of consecutive intervals [low, high) that a number falls in. */
typedef struct interval {
    uint32_t number; /* of the interval, from 0 on */
    float low, high;
} interval;

/* Finds the interval of x among those that begin at `begins`, the last of which ends at `end`. */
static interval find_interval(const float begins[INCIDENT_SIDE], float end, float x)
{
    interval s = {0, begins[0], end};
    for (uint32_t i = 1; i < INCIDENT_SIDE; i++) {
        s.number += begins[i] <= x;
        s.low = begins[i] <= x ? begins[i] : s.low;
    }
    s.high = s.number + 1 < INCIDENT_SIDE ? begins[s.number + 1] : end;
    return s;
}

static const float BIN_WIDTH = 1.0f / INCIDENT_SIDE, BELOW_ONE = 0x1.fffffep-1f;

float incident_guide_warp_one(const incident_guide *guide, vec2 *in_out_u)
{
    const incident_histogram *h = guide->histogram;
    float rows[INCIDENT_SIDE], bins[INCIDENT_SIDE], x = in_out_u->x * INCIDENT_ONE;
    for (int i = 0; i < INCIDENT_SIDE; i++)
        rows[i] = h->begins[0][i];
    interval row = find_interval(rows, INCIDENT_ONE, x);
    for (int i = 0; i < INCIDENT_SIDE; i++)
        bins[i] = h->begins[i][row.number];
    float y = row.low + in_out_u->y * (row.high - row.low);
    interval bin = find_interval(bins, row.high, y);
    in_out_u->x = float_min(((float)row.number + (x - row.low) / (row.high - row.low)) * BIN_WIDTH, BELOW_ONE);
    in_out_u->y = float_min(((float)bin.number + (y - bin.low) / (bin.high - bin.low)) * BIN_WIDTH, BELOW_ONE);
    return (float)(INCIDENT_ONE / INCIDENT_BINS) / (bin.high - bin.low);
}

float incident_guide_density(const incident_guide *guide, vec3 direction)
{
    const uint16_t(*begins)[INCIDENT_SIDE] = guide->histogram->begins;
    float cosine = vec3_dot(direction, guide->around.z);
    if (!(cosine > 0.0f))
        return 0.0f;
    vec2 u = sample_disk_concentric_inverse(
        (vec2){vec3_dot(direction, guide->around.x), vec3_dot(direction, guide->around.y)});
    uint32_t row = incident_guide_bin(u.x), column = incident_guide_bin(u.y), next = row * INCIDENT_SIDE + column + 1;
    uint32_t end = next < INCIDENT_BINS ? begins[next % INCIDENT_SIDE][next / INCIDENT_SIDE] : INCIDENT_ONE;
    return (float)(end - begins[column][row]) * (INCIDENT_BINS / (float)INCIDENT_ONE) * cosine * AG_INV_PI;
}

static void warp_plain(const incident_guide *guide, uint32_t count, float u[2][INCIDENT_WARPS_MAX],
                       float weights[INCIDENT_WARPS_MAX])
{
    for (uint32_t i = 0; i < count; i++) {
        vec2 u_of_ray = {u[0][i], u[1][i]};
        weights[i] = incident_guide_warp_one(guide, &u_of_ray);
        u[0][i] = u_of_ray.x;
        u[1][i] = u_of_ray.y;
    }
}

#if defined(__x86_64__)
/* Eight intervals. */
typedef struct interval_8 {
    __m256 number, low, high;
} interval_8;

/* Takes the interval that begins at `begin` for those numbers that are in it or beyond: find_interval, step by step. */
AVX2 static inline void try_begin(interval_8 *s, __m256 begin, __m256 x)
{
    __m256 is_passed = _mm256_cmp_ps(begin, x, _CMP_LE_OQ);
    s->number = _mm256_add_ps(s->number, _mm256_and_ps(is_passed, _mm256_set1_ps(1.0f)));
    s->low = _mm256_blendv_ps(s->low, begin, is_passed);
    /* of those that are not passed the first, which is the least */
    s->high = _mm256_min_ps(s->high, _mm256_blendv_ps(begin, s->high, is_passed));
}

/* The coordinate along the unit square's side, from a bin's number and the position in it. */
AVX2 static inline __m256 coordinate_in(interval_8 s, __m256 x)
{
    __m256 share = _mm256_div_ps(_mm256_sub_ps(x, s.low), _mm256_sub_ps(s.high, s.low));
    __m256 u = _mm256_mul_ps(_mm256_add_ps(s.number, share), _mm256_set1_ps(BIN_WIDTH));
    return _mm256_min_ps(u, _mm256_set1_ps(BELOW_ONE));
}

AVX2 static void warp_avx2(const incident_guide *guide, uint32_t count, float u[2][INCIDENT_WARPS_MAX],
                           float weights[INCIDENT_WARPS_MAX])
{
    __m256 columns[INCIDENT_SIDE], one = _mm256_set1_ps(INCIDENT_ONE);
    for (int i = 0; i < INCIDENT_SIDE; i++) {
        __m128i begins = _mm_loadu_si128((const __m128i *)(const void *)guide->histogram->begins[i]);
        columns[i] = _mm256_cvtepi32_ps(_mm256_cvtepu16_epi32(begins));
    }
    for (uint32_t i = 0; i < count; i += 8) {
        __m256 x = _mm256_mul_ps(_mm256_loadu_ps(&u[0][i]), one);
        interval_8 row = {_mm256_setzero_ps(), _mm256_setzero_ps(), one};
        for (int k = 1; k < INCIDENT_SIDE; k++)
            try_begin(&row, _mm256_permutevar8x32_ps(columns[0], _mm256_set1_epi32(k)), x);
        __m256i number = _mm256_cvttps_epi32(row.number);
        __m256 y = _mm256_add_ps(row.low, _mm256_mul_ps(_mm256_loadu_ps(&u[1][i]), _mm256_sub_ps(row.high, row.low)));
        interval_8 bin = {_mm256_setzero_ps(), row.low, row.high};
        for (int k = 1; k < INCIDENT_SIDE; k++)
            try_begin(&bin, _mm256_permutevar8x32_ps(columns[k], number), y);
        _mm256_storeu_ps(&u[0][i], coordinate_in(row, x));
        _mm256_storeu_ps(&u[1][i], coordinate_in(bin, y));
        _mm256_storeu_ps(&weights[i], _mm256_div_ps(_mm256_set1_ps((float)(INCIDENT_ONE / INCIDENT_BINS)),
                                                    _mm256_sub_ps(bin.high, bin.low)));
    }
}

void incident_guide_warp(const incident_guide *guide, uint32_t count, float in_out_u[2][INCIDENT_WARPS_MAX],
                         float out_weights[INCIDENT_WARPS_MAX])
{
    if (avx2_is_there())
        warp_avx2(guide, count, in_out_u, out_weights);
    else
        warp_plain(guide, count, in_out_u, out_weights);
}
#else
void incident_guide_warp(const incident_guide *guide, uint32_t count, float in_out_u[2][INCIDENT_WARPS_MAX],
                         float out_weights[INCIDENT_WARPS_MAX])
{
    warp_plain(guide, count, in_out_u, out_weights);
}
#endif
