/* direct_lighting.h: light that comes straight from the lamps, by shadow rays and by scattering, weighted against
 * each other.
 * Rests on: Veach, Guibas, "Optimally Combining Sampling Techniques for Monte Carlo Rendering", 1995.
 * Threads: pure but for the worker's counters. */
#ifndef AFTERGLOW_DIRECT_LIGHTING_H
#define AFTERGLOW_DIRECT_LIGHTING_H

#include "integrator/transport.h"

/* Returns the share, [0, 1], of a sample's light that reaches the origin of `shadow`, a ray in its direction. */
rgb direct_light_transmittance(const transport *t, eye_worker *worker, scene_ray shadow, const light_sample *sample);

/* One sample towards a lamp, or towards a light that reaches everywhere. */
typedef struct lamp_light {
    rgb radiance;   /* that the vertex reflects, weighted against samples by scattering, over the sample's density */
    uint32_t lamp;  /* the light's index; lamp and direction are valid where radiance is not black */
    vec3 direction; /* towards it, unit */
} lamp_light;

/* Samples a lamp that is picked for the vertex. lamp_count and scatter_count: how many samples the caller takes of
 * either technique, on average; the caller divides the sum of its samples by lamp_count. scatter_count 0: this
 * technique alone. */
lamp_light direct_light_sample_lamp(const transport *t, eye_worker *worker, const vertex *v, bsdf_lobes lobes,
                                    float u_pick, vec2 u, int lamp_count, float scatter_count);

/* Samples all lights: each that reaches everywhere once, and one lamp of the others. So a place that a sun lights takes
 * no more than its light, however seldom the direct guide would have picked it there. Where more than eight lights
 * reach everywhere (portals do), it is one sample of a light that is picked. Returns the radiance that the vertex
 * reflects, weighted against scatter_count samples by scattering. */
rgb direct_light_sample_each(const transport *t, eye_worker *worker, const vertex *v, bsdf_lobes lobes, rng *random,
                             float scatter_count);

/* Samples by scattering, and the samples towards lamps that they are weighted against. */
typedef struct light_counts {
    int lamp;         /* samples of direct_light_sample_lamp; LIGHT_COUNT_EACH: one direct_light_sample_each */
    float scattering; /* on average */
} light_counts;
#define LIGHT_COUNT_EACH (-1)

/* Returns the weight of the radiance that a ray meets on a lamp. The ray was scattered with that density at `from`,
 * where vertex_light_normal is `normal`. */
float direct_light_scatter_weight(const transport *t, vec3 from, vec3 normal, const vertex *on_lamp,
                                  float pdf_solid_angle, light_counts counts);

/* Returns the radiance of infinite lights along a ray that meets nothing, weighted as by direct_light_scatter_weight.
 * pdf_solid_angle: the density by which the ray was scattered, or 0 where no sample towards a lamp could stand for it
 * (the eye, smooth lobes), which makes the weight 1. by_group, here and below: the light is added there too, by groups
 * of lamps; or NULL. */
rgb direct_light_escaped(const transport *t, vec3 from, vec3 normal, vec3 direction, float pdf_solid_angle,
                         light_counts counts, rgb *by_group);

/* The direct light at a diffuse vertex, estimated by samples towards lamps and by scattering. */
typedef struct direct_light {
    rgb radiance;
    rgb from_sky;   /* the part of it that comes from infinite lights */
    float variance; /* of the mean of the three colours, estimated */
} direct_light;
direct_light direct_light_gathered(const transport *t, eye_worker *worker, const vertex *v, const sampler *where,
                                   int path_vertex, sample_counts counts, rgb *by_group);

#endif
