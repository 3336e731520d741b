/* medium.h: homogeneous media, which absorb light and scatter it.
 * Rests on: Beer's law and the coefficients of Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023,
 * 11.1 and 11.2.
 * Flow: the scene file makes media; shapes, lamps and the camera refer to them; transmittance.h takes light through
 * them, medium_flight.h samples where it is scattered, phase_function.h the direction in which it goes on.
 * Threads: pure functions; media are read-only once the scene is committed. */
#ifndef AFTERGLOW_MEDIUM_H
#define AFTERGLOW_MEDIUM_H

#include "medium/phase_function.h"

#include <stdbool.h>

typedef struct medium {
    rgb sigma_a; /* share of the light that is absorbed per unit of the way, 1 / scene unit, >= 0 and finite */
    rgb sigma_s; /* share of the light that is scattered, likewise */
    phase_function phase;
} medium;

/* Returns whether it scatters any light. */
static inline bool medium_scatters(const medium *m) { return !rgb_is_black(m->sigma_s); }

/* Returns the share of the light that is lost from its way, 1 / scene unit: absorbed or scattered. */
static inline rgb medium_extinction(const medium *m) { return rgb_add(m->sigma_a, m->sigma_s); }

/* Returns the share of light that is neither absorbed nor scattered over a distance in scene units; INFINITY is
 * fine. */
rgb medium_transmittance(const medium *m, float distance);

/* Adds all that light notices of the medium, as scene_hash_of_light asks. */
void medium_add_hash(const medium *m, hash128 *h);

/* Finds by pbrt-v4's name what a measured liquid or solid absorbs and scatters, 1/mm; the latter is reduced, as if it
 * scattered alike in all directions. Returns false for an unknown name. */
bool medium_find_preset(const char *name, rgb *out_sigma_a, rgb *out_reduced_sigma_s);

#endif
