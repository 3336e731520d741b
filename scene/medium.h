/* medium.h: homogeneous media that absorb light.
 * Rests on: Beer's law, as in Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, 11.2; scattering
 * within a medium is not simulated.
 * Flow: the scene file makes media; shapes, lamps and the camera refer to them; transmittance.h takes light through
 * them.
 * Threads: pure functions; media are read-only once the scene is committed. */
#ifndef AFTERGLOW_MEDIUM_H
#define AFTERGLOW_MEDIUM_H

#include "math/vec3.h"

#include <stdbool.h>

typedef struct medium {
    rgb sigma_a; /* share of the light that is absorbed per unit of the way, 1 / scene unit, >= 0 and finite */
} medium;

/* Returns the transmittance of a distance in scene units; INFINITY is fine. */
rgb medium_transmittance(const medium *m, float distance);

/* Finds by pbrt-v4's name what a measured liquid or solid absorbs and scatters, 1/mm; the latter is reduced, as if it
 * scattered alike in all directions. Returns false for an unknown name. */
bool medium_find_preset(const char *name, rgb *out_sigma_a, rgb *out_reduced_sigma_s);

#endif
