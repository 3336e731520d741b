/* medium.h: what lies between surfaces. A medium absorbs light on its way, and scatters it; whether it does so alike
 * all over is for its kind to know. Rests on: Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed.,
 * 2023, 11.1 to 11.4. Flow: the scene file makes media; rays/transmittance asks them about stretches of rays, as slabs
 * of glass and lamps far away do; medium_flight samples where they scatter. Threads: read-only once the scene is
 * committed. */
#ifndef AFTERGLOW_MEDIUM_H
#define AFTERGLOW_MEDIUM_H

#include "afterglow/base.h"
#include "medium/phase_function.h"

#include <stdbool.h>

/* All kinds, each with its medium_type (medium_type.h). */
#define MEDIUM_KIND_LIST(X) X(MEDIUM_HOMOGENEOUS, homogeneous_medium)

typedef enum medium_kind {
#define MEDIUM_KIND_ENUM(kind, type) kind,
    MEDIUM_KIND_LIST(MEDIUM_KIND_ENUM)
#undef MEDIUM_KIND_ENUM
        MEDIUM_KIND_COUNT
} medium_kind;

/* --- the kinds --- */

/* The parameters of a medium that is the same all over. */
typedef struct homogeneous_parameters {
    rgb sigma_a; /* share of the light that is absorbed per unit of the way, 1 / scene unit, >= 0 and finite */
    rgb sigma_s; /* share of the light that is scattered, likewise */
} homogeneous_parameters;

typedef struct medium {
    medium_kind kind;
    phase_function phase; /* into which directions it scatters, the same all over */
    union {
        homogeneous_parameters homogeneous;
    } as;
} medium;

/* A straight stretch of a ray's way, all of it in one medium. */
typedef struct medium_stretch {
    vec3 origin, direction; /* world; the direction is unit */
    float length;           /* scene units, >= 0; INFINITY is fine */
} medium_stretch;

/* Returns a medium of a kind that neither absorbs nor scatters. */
medium medium_make(medium_kind kind);
/* Frees what the medium owns. */
void medium_reset(medium *m);

/* Returns whether it scatters any light anywhere. */
bool medium_scatters(const medium *m);

/* Returns the share of light, [0, 1], that is neither absorbed nor scattered over a stretch, or an estimate of it whose
 * mean that is. A stretch always has the same. */
rgb medium_transmittance(const medium *m, const medium_stretch *way);

/* Adds all that light notices of the medium, as scene_hash_of_light asks. */
void medium_add_hash(const medium *m, hash128 *h);

/* Finds by pbrt-v4's name what a measured liquid or solid absorbs and scatters, 1/mm; the latter is reduced, as if it
 * scattered alike in all directions. Returns false for an unknown name. */
bool medium_find_preset(const char *name, rgb *out_sigma_a, rgb *out_reduced_sigma_s);

#endif
