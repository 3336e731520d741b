/* sampler.h: well-spread sample positions as a pure function of pixel, dimension and index.
 * Rests on: Owen, "Randomly Permuted (t,m,s)-Nets", 1995; Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4),
 * 2020; Vegdahl, "Building a Better LK Hash", 2021 (the constants); Ahmed, Wonka, "Screen-space Blue-noise Diffusion of
 * Monte Carlo Sampling Error via Hierarchical Ordering of Pixels", 2020. The first two dimensions of Sobol's sequence,
 * scrambled and shuffled anew for each dimension asked for, run through the pixels in Morton order: any 2^n consecutive
 * aligned samples are stratified in every pair, those of a pixel as well as those of a square of 2^k by 2^k pixels, so
 * that neighbours' errors cancel. Keyed by absolute pixel: crops see the same samples. Threads: pure functions. */
#ifndef AFTERGLOW_SAMPLER_H
#define AFTERGLOW_SAMPLER_H

#include "math/rng.h"

/* The decision that a pair of random numbers makes. A camera path uses each once at each of its vertices. */
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
    /* The time of the path, drawn at its first vertex alone. It takes the numbers of SAMPLE_PIXEL at the second vertex,
     * where no point on the film is drawn, so other draws keep their numbers. */
    SAMPLE_TIME = SAMPLE_USE_COUNT + SAMPLE_PIXEL,
    /* How far a ray goes through media that scatter. It takes the numbers of SAMPLE_LENS at the next vertex, where no
     * point on the lens is drawn. */
    SAMPLE_DISTANCE = SAMPLE_USE_COUNT + SAMPLE_LENS
} sample_use;

/* Added to the number of a vertex for draws that are to be apart from others there. */
enum {
    SAMPLER_KEY_BRANCHES = 1 << 16, /* times the exponent of the number of branches that the path was split into */
    SAMPLER_KEY_ALBEDO = 1 << 20,   /* the albedo of layers */
    SAMPLER_KEY_RAYS = 1 << 24,     /* times the exponent of the number of rays, or of light samples, behind mirrors */
    SAMPLER_KEY_CHANCE = 1 << 30    /* whether there is such a ray or sample at all */
};

typedef struct sampler {
    uint64_t key;         /* of seed and pixel: for numbers that are random alone */
    uint64_t block_key;   /* of seed and block of pixels */
    uint32_t morton;      /* the pixel's index in its block, in Morton order */
    uint32_t sample;      /* of the pixel */
    uint32_t sample_bits; /* the pixel has no more than 2^this samples */
} sampler;

enum { SAMPLER_BLOCK_BITS = 8 }; /* a block: 2^this pixels wide and high */

/* Returns the smallest n with 2^n >= count; count >= 1. */
static inline uint32_t sampler_bits(uint32_t count) { return count > 1 ? 32 - (uint32_t)__builtin_clz(count - 1) : 0; }

/* Returns the low 8 bits of each, interlaced. */
static inline uint32_t sampler_morton(uint32_t x, uint32_t y)
{
    uint32_t both = (x & 0xffu) | (y & 0xffu) << 16;
    both = (both | both << 4) & 0x0f0f0f0fu;
    both = (both | both << 2) & 0x33333333u;
    both = (both | both << 1) & 0x55555555u;
    return (both | both >> 15) & 0xffffu;
}

static inline sampler sampler_make(uint64_t seed, int x, int y, uint32_t sample, uint32_t sample_bits)
{
    uint32_t column = (uint32_t)x, row = (uint32_t)y;
    uint64_t seed_key = hash_mix64(seed + 0x73616d706c6572u), pixel = (uint64_t)row << 32 | column;
    uint64_t block = (uint64_t)(row >> SAMPLER_BLOCK_BITS) << 32 | column >> SAMPLER_BLOCK_BITS;
    return (sampler){hash_combine(seed_key, pixel), hash_combine(seed_key ^ 0x626c6f636bu, block),
                     sampler_morton(column, row), sample, sample_bits};
}

/* Returns the sampler of one of 2^branch_bits branches into which a sample's path is split: together they run through
 * the sequences as that many samples would. Not for a vertex and use that the whole sample draws for. */
static inline sampler sampler_branch(const sampler *whole, uint32_t branch_bits, uint32_t branch)
{
    sampler s = *whole;
    s.sample = (whole->sample << branch_bits) + branch;
    s.sample_bits += branch_bits;
    return s;
}

/* Returns a sampler whose sequences are apart from those of the whole sample, for a part of its path that meets as many
 * vertices as another. number: tells the parts of one whole from each other. */
static inline sampler sampler_apart(const sampler *whole, uint32_t number)
{
    sampler s = *whole;
    s.key = hash_combine(whole->key, 0x6170617274u + number);
    s.block_key = hash_combine(whole->block_key, 0x6170617274u + number);
    return s;
}

/* Returns the sampler of a sample that draws `count` numbers for each use, where its pixel draws up to 2^number_bits in
 * all. shift: to be added to the sample's number, so that its draws follow those of samples with other counts. */
static inline sampler sampler_shifted(const sampler *whole, uint32_t shift, uint32_t number_bits, uint32_t count)
{
    sampler s = *whole;
    s.sample += shift;
    s.sample_bits = number_bits - sampler_bits(count);
    return s;
}

static inline uint32_t sampler_reverse_bits(uint32_t x)
{
    x = x << 16 | x >> 16; /* shifts, since not all compilers vectorise a swap of bytes */
    x = (x & 0x00ff00ffu) << 8 | (x >> 8 & 0x00ff00ffu);
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

/* Returns the second Sobol dimension with its bits reversed. Column j of its matrix is row j of Pascal's triangle
 * modulo 2. By Lucas' theorem entry i of that row is 1 where i has no bit that j has not. Bit i of the result is
 * therefore the sum, modulo 2, of the index's bits j for which j has all bits of i. */
static inline uint32_t sampler_sobol_1_reversed(uint32_t x)
{
    x ^= x >> 1 & 0x55555555u;
    x ^= x >> 2 & 0x33333333u;
    x ^= x >> 4 & 0x0f0f0f0fu;
    x ^= x >> 8 & 0x00ff00ffu;
    x ^= x >> 16 & 0x0000ffffu;
    return x;
}

/* The numbers that a sample draws for a use at a vertex of the path. */
typedef struct sampler_sequence {
    uint64_t first; /* index of the first number; each 2^32 indices have a sequence of their own */
    uint64_t use_key, block_key, high;
    uint32_t shuffle, scramble_x, scramble_y;
} sampler_sequence;

static inline void sampler_sequence_enter(sampler_sequence *s, uint64_t high)
{
    uint64_t hash = hash_combine(s->block_key + high, s->use_key), more = hash_mix64(hash + 0x9e3779b97f4a7c15u);
    s->high = high;
    s->shuffle = (uint32_t)hash;
    s->scramble_x = (uint32_t)(hash >> 32);
    s->scramble_y = (uint32_t)more;
}

static inline sampler_sequence sampler_sequence_make(const sampler *s, sample_use use, int vertex, uint32_t count)
{
    sampler_sequence made;
    made.first = ((uint64_t)s->morton << (s->sample_bits + sampler_bits(count))) + (uint64_t)s->sample * count;
    made.use_key = (uint64_t)vertex * SAMPLE_USE_COUNT + (uint64_t)use;
    made.block_key = s->block_key;
    sampler_sequence_enter(&made, made.first >> 32);
    return made;
}

/* Returns the pair of numbers at an index of the sequence, given the index's low bits. */
static inline vec2 sampler_sequence_of_index(const sampler_sequence *s, uint32_t index)
{
    uint32_t shuffled = sampler_scramble(index, s->shuffle);
    uint32_t x = sampler_reverse_bits(sampler_scramble_reversed(shuffled, s->scramble_x));
    uint32_t y = sampler_reverse_bits(sampler_scramble_reversed(sampler_sobol_1_reversed(shuffled), s->scramble_y));
    return (vec2){(float)(int32_t)(x >> 8) * 0x1p-24f, (float)(int32_t)(y >> 8) * 0x1p-24f};
}

/* Returns number i of the sequence, in [0,1)^2. */
static inline vec2 sampler_sequence_at(sampler_sequence *s, uint32_t i)
{
    uint64_t index = s->first + i;
    if (index >> 32 != s->high)
        sampler_sequence_enter(s, index >> 32);
    return sampler_sequence_of_index(s, (uint32_t)index);
}

/* Returns number i of the `count` that the sample draws for a use at a vertex of the path, in [0,1)^2. */
static inline vec2 sampler_2d_of(const sampler *s, sample_use use, int vertex, uint32_t count, uint32_t i)
{
    sampler_sequence sequence = sampler_sequence_make(s, use, vertex, count);
    return sampler_sequence_at(&sequence, i);
}

static inline vec2 sampler_2d(const sampler *s, sample_use use, int vertex)
{
    return sampler_2d_of(s, use, vertex, 1, 0);
}

#endif
