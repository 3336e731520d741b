/* sampler.h: well-spread sample positions as a pure function of pixel, dimension and index.
 * Rests on: Owen, "Randomly Permuted (t,m,s)-Nets", 1995; Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4),
 * 2020; Vegdahl, "Building a Better LK Hash", 2021 (the constants). The first two dimensions of Sobol's sequence,
 * scrambled and shuffled anew for each dimension asked for: any 2^n consecutive aligned samples are stratified in every
 * pair. Keyed by absolute pixel: crops see the same samples. Threads: pure functions. */
#ifndef AFTERGLOW_SAMPLER_H
#define AFTERGLOW_SAMPLER_H

#include "math/rng.h"

/* What a pair of random numbers decides. One camera path uses each at each of its vertices. */
typedef enum sample_use {
    SAMPLE_PIXEL,
    SAMPLE_LENS,
    SAMPLE_LOBE,
    SAMPLE_SCATTER,
    SAMPLE_LIGHT_PICK,
    SAMPLE_LIGHT,
    SAMPLE_SCATTER_TO_LIGHT,
    SAMPLE_GATHER,
    SAMPLE_ROULETTE,
    SAMPLE_USE_COUNT,
    /* The time of the path, which its first vertex alone asks for: there this is a number that the second vertex leaves
     * free, for what that would mean is a place on the film. So pictures of scenes without motion keep their bits. */
    SAMPLE_TIME = SAMPLE_USE_COUNT + SAMPLE_PIXEL
} sample_use;

typedef struct sampler {
    uint64_t key;    /* of seed and pixel */
    uint32_t sample; /* of the pixel */
} sampler;

static inline sampler sampler_make(uint64_t seed, int x, int y, uint32_t sample)
{
    uint64_t pixel = (uint64_t)(uint32_t)y << 32 | (uint32_t)x;
    return (sampler){hash_combine(hash_mix64(seed + 0x73616d706c6572u), pixel), sample};
}

static inline uint32_t sampler_reverse_bits(uint32_t x)
{
    x = __builtin_bswap32(x);
    x = (x & 0x0f0f0f0fu) << 4 | (x >> 4 & 0x0f0f0f0fu);
    x = (x & 0x33333333u) << 2 | (x >> 2 & 0x33333333u);
    return (x & 0x55555555u) << 1 | (x >> 1 & 0x55555555u);
}

/* A nested uniform scramble of bits taken from the lowest up. */
static inline uint32_t sampler_scramble_reversed(uint32_t x, uint32_t seed)
{
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

static inline uint32_t sampler_scramble(uint32_t x, uint32_t seed)
{
    return sampler_reverse_bits(sampler_scramble_reversed(sampler_reverse_bits(x), seed));
}

/* The second Sobol dimension, of an index with its bits reversed as well as not: column j of its matrix is row j of
 * Pascal's triangle modulo 2. */
static inline uint32_t sampler_sobol_1(uint32_t index)
{
    uint32_t result = 0;
    for (uint32_t column = 0x80000000u; index; index >>= 1, column ^= column >> 1)
        if (index & 1)
            result ^= column;
    return result;
}

/* Sample `index` of the sequence for a use at a vertex of the path, in [0,1)^2. */
static inline vec2 sampler_2d_at(const sampler *s, sample_use use, int vertex, uint32_t index)
{
    uint64_t hash = hash_combine(s->key, (uint64_t)vertex * SAMPLE_USE_COUNT + (uint64_t)use);
    uint64_t more = hash_mix64(hash + 0x9e3779b97f4a7c15u);
    uint32_t shuffled = sampler_scramble(index, (uint32_t)hash);
    uint32_t x = sampler_reverse_bits(sampler_scramble_reversed(shuffled, (uint32_t)(hash >> 32)));
    uint32_t y = sampler_scramble(sampler_sobol_1(shuffled), (uint32_t)more);
    return (vec2){(float)(x >> 8) * 0x1p-24f, (float)(y >> 8) * 0x1p-24f};
}

static inline vec2 sampler_2d(const sampler *s, sample_use use, int vertex)
{
    return sampler_2d_at(s, use, vertex, s->sample);
}

#endif
