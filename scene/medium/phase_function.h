/* phase_function.h: the directions into which a medium scatters light.
 * Rests on: Henyey, Greenstein, "Diffuse Radiation in the Galaxy", 1941; Pharr, Jakob, Humphreys, "Physically Based
 * Rendering", 4th ed., 2023, 11.3.1.
 * Flow: medium -> [here] -> photon tracing; the lobe of bsdf.h by which integrators see a medium. Threads: pure
 * functions. */
#ifndef AFTERGLOW_PHASE_FUNCTION_H
#define AFTERGLOW_PHASE_FUNCTION_H

#include "math/hash128.h"
#include "math/vec3.h"

typedef struct phase_function {
    float g; /* mean cosine of the angle by which scattering turns light, in (-1, 1) */
} phase_function;

/* Returns the density, 1/sr, of light that is turned by an angle of that cosine; its integral over all directions is
 * 1. */
float phase_function_density(const phase_function *phase, float cosine);

/* Samples by exactly that density a direction for light that came along another; both unit. u: in [0, 1). */
vec3 phase_function_sample(const phase_function *phase, vec3 along, vec2 u);

/* Adds all that decides where light is scattered. */
void phase_function_add_hash(const phase_function *phase, hash128 *h);

#endif
