/* eye_sample.h: what one camera sample brings home: its radiance, and where layers are asked for, the parts of light
 * that make it up and what its ray met first.
 * Rests on: Jensen 2001, ch. 8 (emitted + direct + caustics + specular + indirect); Heckbert 1990 (path notation).
 * Flow: shading, path_tracing -> [here] -> film. Threads: a sample belongs to one worker.
 *
 * The parts, of the light that reaches the eye: EMISSION by no surface (LE); DIRECT by the first surface's gathered
 * lobes, straight from a lamp (LDE); CAUSTIC by the same, from a lamp by way of traced lobes alone (LS+DE); INDIRECT by
 * the same, from elsewhere; SPECULAR by the first surface's traced lobes, whatever came before. Both integrators split
 * alike. Where panes are direct (bsdf.h), one that is passed straight is no surface here. */
#ifndef AFTERGLOW_EYE_SAMPLE_H
#define AFTERGLOW_EYE_SAMPLE_H

#include "math/vec3.h"

#include <stddef.h>
#include <stdint.h>

typedef enum light_part { PART_EMISSION, PART_DIRECT, PART_INDIRECT, PART_CAUSTIC, PART_SPECULAR } light_part;
enum { LIGHT_PART_COUNT = PART_SPECULAR + 1 };

/* Groups of lights by their names; behind them what comes through the photon map, of which no lamp is known. */
enum { LIGHT_GROUPS_MAX = 32 };

/* The values of a camera sample that are summed over a pixel, beside its light: of each its sum (aov.h), type and
 * member, and whether the sum alone needs what the ray meets first. Types consist of floats, all of which are summed. A
 * value that is 0 where nothing sets it needs no more than its row here, and where it is set. */
#define SAMPLE_VALUE_LIST(X)                                                                                           \
    X(SUM_ALPHA, float, alpha, false) /* share of the background that is hidden, [0, 1]; in media on average */

/* The values of a camera ray's first hit, which are summed where there is one; columns as in SAMPLE_VALUE_LIST. */
#define FIRST_HIT_LIST(X)                                                                                              \
    X(SUM_ALBEDO, rgb, albedo, true)                                                                                   \
    X(SUM_NORMAL, vec3, normal, true)                      /* of shading, on the eye's side */                         \
    X(SUM_GEOMETRIC_NORMAL, vec3, geometric_normal, false) /* on the eye's side */                                     \
    X(SUM_POSITION, vec3, position, false)                                                                             \
    X(SUM_UV, vec2, uv, false)                                                                                         \
    X(SUM_SLOPE, vec2, slope, false)         /* dz/dx, dz/dy of the surface's plane, from pixel to pixel */            \
    X(SUM_IRRADIANCE, rgb, irradiance, true) /* W/m^2, of the photon map's estimate there */

/* The camera ray's first hit; all zero where there is none. Space is the film's: see aov.h. */
typedef struct first_hit {
    bool is_hit;
    float depth; /* along the camera's axis; of spherical cameras the distance */
#define FIRST_HIT_MEMBER(sum, type, member, needs_first_hit) type member;
    FIRST_HIT_LIST(FIRST_HIT_MEMBER)
#undef FIRST_HIT_MEMBER
    uint32_t object_id, material_id; /* from 1 on; 0: nothing */
} first_hit;

typedef struct sample_layers {
    rgb parts[LIGHT_PART_COUNT];
    rgb sky; /* of the part DIRECT, from infinite lights */
    rgb groups[LIGHT_GROUPS_MAX + 1];
#define SAMPLE_VALUE_MEMBER(sum, type, member, needs_first_hit) type member;
    SAMPLE_VALUE_LIST(SAMPLE_VALUE_MEMBER)
#undef SAMPLE_VALUE_MEMBER
    first_hit first;
} sample_layers;

/* The numbers that a camera sample is split into. */
typedef struct split_counts {
    uint32_t rays;         /* gather rays, >= 1 */
    uint32_t further;      /* camera rays beside the sample's own, 0 or a power of two. Gathered light and caustics,
                              which cost most, come by the own one alone, as does what it meets first (first_hit); of
                              all other light each brings an equal share */
    uint32_t lights;       /* samples towards lamps, >= 1, where a camera ray meets a diffuse surface first */
    uint32_t caustic_bits; /* of 2^caustic_bits camera samples one asks the caustic map, by chance */
    uint32_t ray_shift; /* added, modulo 2^32, to the sample's number where its gather rays are numbered, so that those
                           of a pixel follow each other whatever the numbers were before; see sampler_shifted */
} split_counts;

static inline uint32_t split_camera_rays(split_counts counts) { return 1 + counts.further; }

typedef struct eye_sample {
    rgb radiance;
    float most_direct, most_indirect; /* of a component of one contribution, INFINITY: unbounded */
    int sign;                         /* of the pixel filter there */
    float gather_variance;            /* of the mean of the three colours, by the choice of gather rays: an estimate */
    float light_variance; /* of that mean by the choice of light samples, where camera rays met a surface first */
    float caustic_square; /* of the same mean of the caustics that were asked for, times the chance of asking by
                             caustic_bits: the sum of the squares */
    float own;            /* that mean of gathered light and caustics, which the sample's own camera ray alone brings */
    uint32_t gather_cost, light_cost, caustic_cost; /* of those: see eye_worker_cost */
    uint32_t further_cost;                          /* of the further camera rays, but for their light samples */
    uint32_t rest_cost;                             /* of all else */
    sample_layers *layers;                          /* NULL: radiance alone is asked for */
} eye_sample;

/* Returns the factor that bounds light to a largest component. */
static inline float eye_bound(float most, rgb brought)
{
    float largest = rgb_max(brought);
    return largest > most ? most / largest : 1.0f;
}

/* Returns the factor, mostly 1, that bounds light scattered so many times between lamp and eye (--clamp-direct,
 * --clamp-indirect). share: the path's share of the sample, where a path was split; all of them together bring no more
 * than one would. */
static inline float eye_sample_bound(const eye_sample *s, float share, int scatterings, rgb brought)
{
    return eye_bound(share * (scatterings > 1 ? s->most_indirect : s->most_direct), brought);
}

/* Adds light that is in the radiance to its part, where layers are asked for. */
static inline void eye_sample_add_part(eye_sample *s, light_part part, rgb brought)
{
    if (s->layers)
        s->layers->parts[part] = rgb_add(s->layers->parts[part], brought);
}

/* Light by the groups of its lamps, while an estimate goes on. */
typedef struct light_group_sums {
    rgb of_group[LIGHT_GROUPS_MAX + 1];
} light_group_sums;

/* Sets the sums to 0; NULL where no groups are asked for, and then nothing is touched. */
static inline rgb *light_group_sums_begin(light_group_sums *sums, bool is_wanted)
{
    if (!is_wanted)
        return NULL;
    *sums = (light_group_sums){0};
    return sums->of_group;
}

/* Adds light of a group's lamps to a sample that has layers. */
static inline void eye_sample_add_group(eye_sample *s, uint32_t group, rgb brought)
{
    s->layers->groups[group] = rgb_add(s->layers->groups[group], brought);
}

/* Adds light by groups, times the throughput. by_group: of light_group_sums_begin; NULL: nothing is done. */
static inline void eye_sample_add_groups(eye_sample *s, const rgb *by_group, rgb throughput)
{
    for (uint32_t i = 0; by_group && i <= LIGHT_GROUPS_MAX; i++)
        eye_sample_add_group(s, i, rgb_mul(throughput, by_group[i]));
}

#endif
