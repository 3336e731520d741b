/* photon_block.h: how a finished map keeps its photons: sixteen records of 24 bytes as columns, 384 bytes, so that a
 * search tests a block's positions and normals four or eight at a time and touches nothing else. Photon i of the map is
 * lane i % 16 of block i / 16; the last block's unused lanes have NaN positions, which fail every comparison. Flow:
 * photon_tracing fills records; photon_tree_build turns them into blocks where they lie. Threads: all but the slots is
 * read-only once the map stands. */
#ifndef AFTERGLOW_PHOTON_BLOCK_H
#define AFTERGLOW_PHOTON_BLOCK_H

#include "large_alloc.h"
#include "photon.h"

#include <stdlib.h>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

enum { PHOTON_BLOCK_LANES = 16 };

typedef struct photon_block {
    _Alignas(64) float position[3][PHOTON_BLOCK_LANES];
    uint32_t flux[PHOTON_BLOCK_LANES];
    uint16_t direction[PHOTON_BLOCK_LANES], normal[PHOTON_BLOCK_LANES];
    irradiance_slot slot[PHOTON_BLOCK_LANES];
} photon_block;

_Static_assert(sizeof(photon_block) == PHOTON_BLOCK_LANES * sizeof(photon), "a block is no larger than its records");

static inline uint64_t photon_block_count(uint64_t photon_count)
{
    return (photon_count + PHOTON_BLOCK_LANES - 1) / PHOTON_BLOCK_LANES;
}

/* Allocates room for photon_count records, and for the blocks that they become; to be freed by free(). NULL when out of
 * memory. */
static inline photon *photon_records_create(uint32_t photon_count)
{
    uint64_t blocks = photon_block_count(photon_count);
    return large_alloc((size_t)(blocks ? blocks : 1) * sizeof(photon_block));
}

static inline irradiance_slot *photon_block_slot(photon_block *blocks, uint32_t index)
{
    return &blocks[index / PHOTON_BLOCK_LANES].slot[index % PHOTON_BLOCK_LANES];
}

static inline vec3 photon_block_position(const photon_block *blocks, uint32_t index)
{
    const photon_block *b = &blocks[index / PHOTON_BLOCK_LANES];
    uint32_t lane = index % PHOTON_BLOCK_LANES;
    return (vec3){b->position[0][lane], b->position[1][lane], b->position[2][lane]};
}

static inline uint16_t photon_block_normal(const photon_block *blocks, uint32_t index)
{
    return blocks[index / PHOTON_BLOCK_LANES].normal[index % PHOTON_BLOCK_LANES];
}

static inline uint32_t photon_block_flux(const photon_block *blocks, uint32_t index)
{
    return blocks[index / PHOTON_BLOCK_LANES].flux[index % PHOTON_BLOCK_LANES];
}

/* Returns a hash of the photon's position, which does not depend on the photon's place in the map. */
static inline uint64_t photon_block_position_key(const photon_block *blocks, uint32_t index)
{
    vec3 at = photon_block_position(blocks, index);
    uint32_t bits[3];
    memcpy(bits, &at, sizeof bits);
    return hash_combine(hash_combine(bits[0], bits[1]), bits[2]);
}

/* Writes the squared distances of all lanes; returns, as bits, the lanes no farther than the limit. */
static inline uint32_t photon_block_within(const photon_block *b, const float position[3], float limit,
                                           float out_distance_squared[PHOTON_BLOCK_LANES])
{
    uint32_t within = 0;
#if defined(__SSE2__)
    __m128 px = _mm_set1_ps(position[0]), py = _mm_set1_ps(position[1]), pz = _mm_set1_ps(position[2]);
    __m128 most = _mm_set1_ps(limit);
    for (uint32_t i = 0; i < PHOTON_BLOCK_LANES; i += 4) {
        __m128 x = _mm_sub_ps(_mm_load_ps(&b->position[0][i]), px);
        __m128 y = _mm_sub_ps(_mm_load_ps(&b->position[1][i]), py);
        __m128 z = _mm_sub_ps(_mm_load_ps(&b->position[2][i]), pz);
        __m128 d = _mm_add_ps(_mm_add_ps(_mm_mul_ps(x, x), _mm_mul_ps(y, y)), _mm_mul_ps(z, z));
        _mm_store_ps(&out_distance_squared[i], d);
        within |= (uint32_t)_mm_movemask_ps(_mm_cmple_ps(d, most)) << i;
    }
#else
    for (uint32_t i = 0; i < PHOTON_BLOCK_LANES; i++) {
        float x = b->position[0][i] - position[0], y = b->position[1][i] - position[1],
              z = b->position[2][i] - position[2];
        out_distance_squared[i] = x * x + y * y + z * z;
        within |= (uint32_t)(out_distance_squared[i] <= limit) << i;
    }
#endif
    return within;
}

/* Returns the nearest of the lanes in the mask, which is not 0; the first of equally near ones. */
static inline uint32_t photon_block_nearest_lane(const float distance_squared[PHOTON_BLOCK_LANES], uint32_t mask)
{
    uint32_t best = (uint32_t)__builtin_ctz(mask);
    for (mask &= mask - 1; mask; mask &= mask - 1) {
        uint32_t lane = (uint32_t)__builtin_ctz(mask);
        best = distance_squared[lane] < distance_squared[best] ? lane : best;
    }
    return best;
}

/* Returns the squared distance of the nearest lane; the first of equally near ones. */
static inline float photon_block_nearest(const photon_block *b, const float position[3], uint32_t *out_lane)
{
#if defined(__SSE2__)
    enum { VECTORS = PHOTON_BLOCK_LANES / 4 };
    __m128 px = _mm_set1_ps(position[0]), py = _mm_set1_ps(position[1]), pz = _mm_set1_ps(position[2]);
    __m128 d[VECTORS], least = _mm_set1_ps(INFINITY);
    for (uint32_t i = 0; i < VECTORS; i++) {
        __m128 x = _mm_sub_ps(_mm_load_ps(&b->position[0][4 * i]), px);
        __m128 y = _mm_sub_ps(_mm_load_ps(&b->position[1][4 * i]), py);
        __m128 z = _mm_sub_ps(_mm_load_ps(&b->position[2][4 * i]), pz);
        d[i] = _mm_add_ps(_mm_add_ps(_mm_mul_ps(x, x), _mm_mul_ps(y, y)), _mm_mul_ps(z, z));
        least = _mm_min_ps(d[i], least); /* min gives the second operand where the first is NaN */
    }
    least = _mm_min_ps(least, _mm_shuffle_ps(least, least, _MM_SHUFFLE(1, 0, 3, 2)));
    least = _mm_min_ps(least, _mm_shuffle_ps(least, least, _MM_SHUFFLE(2, 3, 0, 1)));
    uint32_t lanes = 0;
    for (uint32_t i = 0; i < VECTORS; i++)
        lanes |= (uint32_t)_mm_movemask_ps(_mm_cmpeq_ps(d[i], least)) << 4 * i;
    *out_lane = (uint32_t)__builtin_ctz(lanes | 1u << (PHOTON_BLOCK_LANES - 1));
    return _mm_cvtss_f32(least);
#else
    float least = INFINITY;
    *out_lane = PHOTON_BLOCK_LANES - 1;
    for (uint32_t i = 0; i < PHOTON_BLOCK_LANES; i++) {
        float x = b->position[0][i] - position[0], y = b->position[1][i] - position[1],
              z = b->position[2][i] - position[2], d = x * x + y * y + z * z;
        *out_lane = d < least ? i : *out_lane;
        least = d < least ? d : least;
    }
    return least;
#endif
}

/* Prefetches the positions and normals of a block. */
static inline void photon_block_prefetch(const photon_block *b)
{
    for (int a = 0; a < 3; a++)
        __builtin_prefetch(b->position[a]);
    __builtin_prefetch(b->normal);
}

/* Returns, as bits, the lanes with exactly that normal. */
static inline uint32_t photon_block_with_normal(const photon_block *b, uint16_t normal)
{
#if defined(__SSE2__)
    __m128i wanted = _mm_set1_epi16((short)normal);
    __m128i low = _mm_cmpeq_epi16(_mm_load_si128((const __m128i *)(const void *)&b->normal[0]), wanted);
    __m128i high = _mm_cmpeq_epi16(_mm_load_si128((const __m128i *)(const void *)&b->normal[8]), wanted);
    return (uint32_t)_mm_movemask_epi8(_mm_packs_epi16(low, high));
#else
    uint32_t alike = 0;
    for (uint32_t i = 0; i < PHOTON_BLOCK_LANES; i++)
        alike |= (uint32_t)(b->normal[i] == normal) << i;
    return alike;
#endif
}

/* Turns the records of a block, at most sixteen, into columns where they lie. */
void photon_block_from_records(photon_block *block, uint32_t count);

#endif
