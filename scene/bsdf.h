/* bsdf.h: scattering at a surface: evaluating, sampling and its density, lobe by lobe.
 * Rests on: Lambert; Walter et al., "Microfacet Models for Refraction through Rough Surfaces", 2007 (GGX); Heitz,
 * "Sampling the GGX Distribution of Visible Normals", 2018; Pharr, Jakob, Humphreys, 4th ed., 2023, ch. 9.
 * Flow: material + surface hit -> [here] -> photon tracing, shading, path tracing.
 * Threads: pure functions.
 *
 * One predicate splits the lobes, for photons and for the eye alike: GATHERED lobes (Lambertian ones) store photons and
 * look up irradiance; all others, rough or smooth, are TRACED on. The S of the path notation is every traced lobe. */
#ifndef AFTERGLOW_BSDF_H
#define AFTERGLOW_BSDF_H

#include "bvh.h"
#include "material.h"

/* Below this GGX alpha a surface is perfectly smooth (pbrt-v4 draws the same line). */
#define BSDF_SMOOTH_ALPHA 1e-3f

typedef enum bsdf_lobes { BSDF_GATHERED = 1, BSDF_TRACED = 2, BSDF_ALL = 3 } bsdf_lobes;

/* What travels: radiance is scaled by the square of the relative index when it enters another medium, flux is not. */
typedef enum bsdf_transport { BSDF_RADIANCE, BSDF_FLUX } bsdf_transport;

typedef struct bsdf {
    frame shading;         /* z: shading normal, to the outside */
    vec3 geometric_normal; /* to the outside */
    const material *matter;
    bool is_smooth;
} bsdf;

typedef struct bsdf_sample {
    vec3 direction;       /* unit, away from the surface */
    rgb weight;           /* f |cos| / pdf, shading-normal correction of flux included */
    float pdf_solid_angle; /* meaningless where is_delta */
    bool is_delta;
} bsdf_sample;

bsdf bsdf_create(const material *matter, const surface_hit *hit);

bool bsdf_has(const bsdf *b, bsdf_lobes lobes);

/* Whether light can find these lobes by sampling a lamp: they are not all perfectly smooth. */
bool bsdf_is_sampled_from_light(const bsdf *b, bsdf_lobes lobes);

/* Reflectance of the gathered lobes, [0, 1]. */
rgb bsdf_gathered_albedo(const bsdf *b);

/* f |cos(direction, shading normal)| for light from `direction` leaving to `out` (both unit, away from the surface);
 * smooth lobes count as 0. */
rgb bsdf_evaluate(const bsdf *b, bsdf_lobes lobes, bsdf_transport transport, vec3 out, vec3 direction);
float bsdf_pdf(const bsdf *b, bsdf_lobes lobes, vec3 out, vec3 direction);

/* Samples the way on: `out` is where the path came from. false: absorbed. */
bool bsdf_sample_direction(const bsdf *b, bsdf_lobes lobes, bsdf_transport transport, vec3 out, float u_lobe, vec2 u,
                           bsdf_sample *out_sample);

/* Flux arriving from `direction` per flux on the shading surface: |cos to shading normal| / |cos to geometric normal|;
 * stored photons carry it so that irradiance is that of the shading surface (Veach 1997, 5.3). 1 without shading normals. */
float bsdf_arrival_correction(const bsdf *b, vec3 direction);

#endif
