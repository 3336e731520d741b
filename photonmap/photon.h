/* photon.h: the photon, 24 bytes, and how its parts are packed.
 * Rests on: Neilson, Yang, "Beyond Faster Photon Map Global Illumination", TR 04-21, 2004 (the 24-byte photon with its
 * irradiance); Jensen, "Realistic Image Synthesis Using Photon Mapping", 2001, ch. 6; Ward, "Real Pixels", 1991 (shared
 * exponents); Meyer et al., "On Floating-Point Normal Vectors", 2010 (octahedral directions).
 * Flow: photon_tracing makes them, the map keeps them. Threads: all but the slot is read-only once the map stands. */
#ifndef AFTERGLOW_PHOTON_H
#define AFTERGLOW_PHOTON_H

#include "irradiance_slot.h"
#include "math/rng.h"
#include "math/vec3.h"

#include <stdint.h>
#include <string.h>

#define PHOTON_NONE UINT32_MAX

typedef struct photon {
    float position[3];    /* world */
    uint32_t flux;        /* W, times the number of paths emitted; shared exponent */
    uint16_t direction;   /* direction of travel, and whether it came by way of a diffuse vertex: arrival_encode */
    uint16_t normal;      /* geometric, on the side it arrived at, octahedral */
    irradiance_slot slot; /* the irradiance here, once it has been requested */
} photon;

_Static_assert(sizeof(photon) == 24, "a photon is 24 bytes, as in the paper");

/* --- shared exponents: value = mantissa 2^exponent, mantissas of 8 bits --- */

/* Returns 2^exponent, made from its bits, since libm's ldexpf is slow; 0 where it would be denormal, infinity where it
 * is too large. */
static inline float power_of_two(int exponent)
{
    int at_least = exponent > -127 ? exponent : -127, within = at_least < 128 ? at_least : 128;
    uint32_t bits = (uint32_t)(within + 127) << 23;
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Picks the exponent so that the largest mantissa is in [127.5, 255]. largest: finite, >= 0. */
static inline int shared_exponent_of(float largest)
{
    uint32_t bits;
    memcpy(&bits, &largest, sizeof bits);
    /* largest = fraction 2^exponent, fraction in [0.5, 1): more than 255/256? */
    int exponent = (int)(bits >> 23) - 126;
    return exponent - 8 + ((bits & 0x7fffff) > 0x7f0000);
}

/* Rounds up with probability equal to the fraction, so that the mean over many photons is right also on the weak
 * channels of a saturated colour; each channel has 21 of the random bits. */
static inline uint32_t shared_mantissas(rgb value, int exponent, uint64_t bits)
{
    float scale = power_of_two(-exponent);
    float u[3] = {(float)(bits & 0x1fffff) * 0x1p-21f, (float)(bits >> 21 & 0x1fffff) * 0x1p-21f,
                  (float)(bits >> 42 & 0x1fffff) * 0x1p-21f};
    uint32_t r = (uint32_t)(value.r * scale + u[0]), g = (uint32_t)(value.g * scale + u[1]),
             b = (uint32_t)(value.b * scale + u[2]);
    return (r > 255 ? 255 : r) << 16 | (g > 255 ? 255 : g) << 8 | (b > 255 ? 255 : b);
}

static inline vec3 photon_position(const photon *p) { return (vec3){p->position[0], p->position[1], p->position[2]}; }

static inline void photon_set_position(photon *p, vec3 position)
{
    p->position[0] = position.x;
    p->position[1] = position.y;
    p->position[2] = position.z;
}

/* --- flux: exponent in the top byte, biased by 128 --- */

#define FLUX_EXPONENT_MIN (-128)

/* Flux is finite and >= 0; key is the photon's own number: it decides the rounding. */
static inline uint32_t flux_encode(rgb flux, uint64_t key)
{
    float largest = rgb_max(flux);
    if (!(largest > 0x1p-110f))
        return 0;
    int exponent = shared_exponent_of(largest);
    return (uint32_t)(exponent + 128) << 24 | shared_mantissas(flux, exponent, hash_mix64(key));
}

static inline int flux_exponent(uint32_t code) { return (int)(code >> 24) - 128; }

static inline rgb flux_decode(uint32_t code)
{
    float scale = power_of_two(flux_exponent(code));
    return (rgb){(float)(code >> 16 & 255) * scale, (float)(code >> 8 & 255) * scale, (float)(code & 255) * scale};
}

/* Returns the largest of the three mantissas. */
static inline uint32_t flux_largest_mantissa(uint32_t code)
{
    uint32_t r = code >> 16 & 255, g = code >> 8 & 255, b = code & 255, of_two = r > g ? r : g;
    return of_two > b ? of_two : b;
}

/* Returns rgb_max(flux_decode(code)). */
static inline float flux_largest(uint32_t code)
{
    return (float)flux_largest_mantissa(code) * power_of_two(flux_exponent(code));
}

/* --- directions: octahedral, 8 + 8 bits; within 1 degree --- */

/* Coordinates are in [-1, 1]. */
static inline vec2 octahedral_encode(vec3 d)
{
    float sum = fabsf(d.x) + fabsf(d.y) + fabsf(d.z), x = d.x / sum, y = d.y / sum;
    /* half of all directions are below, so a branch would be mispredicted */
    float folded_x = (1.0f - fabsf(y)) * copysignf(1.0f, x), folded_y = (1.0f - fabsf(x)) * copysignf(1.0f, y);
    x = float_select(d.z < 0.0f, folded_x, x);
    y = float_select(d.z < 0.0f, folded_y, y);
    return (vec2){x, y};
}

/* The vector of an octahedral code, of any length from 0.57 to 1. */
static inline vec3 octahedral_decode(float x, float y)
{
    float z = 1.0f - fabsf(x) - fabsf(y), fold = z < 0.0f ? -z : 0.0f;
    x -= copysignf(fold, x);
    y -= copysignf(fold, y);
    return (vec3){x, y, z};
}

static inline uint16_t direction_encode(vec3 d)
{
    /* 255 steps from -1 to 1, so that the axes are met exactly */
    vec2 p = octahedral_encode(d);
    uint32_t i = (uint32_t)(p.x * 127.0f + 127.5f), j = (uint32_t)(p.y * 127.0f + 127.5f);
    return (uint16_t)(i << 8 | j);
}

/* The direction, of any length from 0.57 to 1, which is enough to compare angles with. */
static inline vec3 direction_decode_unnormalized(uint16_t code)
{
    return octahedral_decode(((float)(code >> 8) - 127.0f) * (1.0f / 127.0f),
                             ((float)(code & 255) - 127.0f) * (1.0f / 127.0f));
}

static inline vec3 direction_decode(uint16_t code) { return vec3_normalize(direction_decode_unnormalized(code)); }

/* --- how a photon arrived: 1 bit, by way of a diffuse vertex or not; direction, 181 x 181 steps, within 1.5 degrees */

enum { ARRIVAL_IS_DIFFUSE = 0x8000, ARRIVAL_STEPS = 181 };

static inline uint16_t arrival_encode(vec3 d, bool is_diffuse)
{
    const float half = (ARRIVAL_STEPS - 1) / 2; /* a whole number, so that the axes are met exactly */
    vec2 p = octahedral_encode(d);
    uint32_t i = (uint32_t)(p.x * half + half + 0.5f), j = (uint32_t)(p.y * half + half + 0.5f);
    return (uint16_t)((is_diffuse ? ARRIVAL_IS_DIFFUSE : 0) | (i * ARRIVAL_STEPS + j));
}

/* Returns whether a gather ray could have found this light: it has met a diffuse vertex since it left its lamp. */
static inline bool arrival_is_diffuse(uint16_t code) { return code & ARRIVAL_IS_DIFFUSE; }

static inline vec3 arrival_direction(uint16_t code)
{
    const float half = (ARRIVAL_STEPS - 1) / 2, step = 1.0f / half;
    uint32_t cell = code & (ARRIVAL_IS_DIFFUSE - 1u);
    return vec3_normalize(octahedral_decode(((float)(cell / ARRIVAL_STEPS) - half) * step,
                                            ((float)(cell % ARRIVAL_STEPS) - half) * step));
}

#endif
