/* rng.h: random numbers as a pure function of (seed, stream, index, dimension).
 * Rests on: Steele, Lea, Flood, "Fast Splittable Pseudorandom Number Generators", 2014 (SplitMix64 and its finaliser).
 * A stream belongs to one photon path or one pixel sample, never to a thread or tile: so the order of work cannot
 * reach the picture. Threads: a stream belongs to one thread. */
#ifndef AFTERGLOW_RNG_H
#define AFTERGLOW_RNG_H

#include "math/vec3.h"

#include <stdint.h>
#include <string.h>

typedef struct rng {
    uint64_t state;
} rng;

/* A bijection of 64 bits in which every input bit reaches every output bit. */
static inline uint64_t hash_mix64(uint64_t z)
{
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

static inline uint64_t hash_combine(uint64_t a, uint64_t b) { return hash_mix64(a * 0x9e3779b97f4a7c15u + b); }

/* Returns a number that depends on all bits of a ray and of the key, for what a ray meets by chance: it then always
 * meets the same. */
static inline uint64_t hash_of_ray(uint64_t key, vec3 origin, vec3 direction)
{
    const float values[6] = {origin.x, origin.y, origin.z, direction.x, direction.y, direction.z};
    uint32_t bits[6];
    memcpy(bits, values, sizeof bits);
    for (int i = 0; i < 6; i += 2)
        key = hash_combine(key, ((uint64_t)bits[i] << 32) | bits[i + 1]);
    return key;
}

/* stream: one of a few purposes; index: the path or pixel sample. */
static inline rng rng_make(uint64_t seed, uint64_t stream, uint64_t index)
{
    return (rng){hash_combine(hash_combine(hash_mix64(seed + 0x632be59bd9b4e019u), stream), index)};
}

static inline uint64_t rng_next(rng *random)
{
    random->state += 0x9e3779b97f4a7c15u;
    return hash_mix64(random->state);
}

/* Uniform in [0, 1), on a grid of 2^-24. */
static inline float rng_float(rng *random) { return (float)(rng_next(random) >> 40) * 0x1p-24f; }

static inline vec2 rng_vec2(rng *random)
{
    uint64_t bits = rng_next(random);
    return (vec2){(float)(bits >> 40) * 0x1p-24f, (float)((uint32_t)bits >> 8) * 0x1p-24f};
}

#endif
