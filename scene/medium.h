/* medium.h: what fills space and absorbs light on its way, the same everywhere in it.
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

/* The share of light that is left after a way of that length in scene units; INFINITY is fine. */
rgb medium_transmittance(const medium *m, float distance);

/* The absorption of a measured liquid or solid by pbrt-v4's name, 1/mm. All of them scatter too. False: not known. */
bool medium_find_preset(const char *name, rgb *out_sigma_a);

#endif
