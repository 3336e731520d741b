/* glint_guide.h: the directions from which the caustic map's photons come to a point, as a density that rays of rough
 * lobes follow. Light that a lamp sends through glass, or by metal, is met by such a ray by chance alone, seldom, and
 * then shines as a speck; photons have found the way.
 * Rests on: Hey, Purgathofer, "Importance Sampling with Hemispherical Particle Footprints", 2002 (a cone around the
 * direction of each photon); Jensen, "Importance Driven Path Tracing using the Photon Map", 1995.
 * Flow: the caustic map's tree -> [here] -> eye_path. Threads: pure functions. */
#ifndef AFTERGLOW_GLINT_GUIDE_H
#define AFTERGLOW_GLINT_GUIDE_H

#include "photon_tree.h"

enum { GLINT_BLOCKS = 2, GLINT_PHOTONS = GLINT_BLOCKS * PHOTON_BLOCK_LANES };

/* The photons of a guide. A direction is drawn around one of them, picked by its flux, in one of three cones. */
typedef struct glint_guide {
    uint32_t count;
    float end[GLINT_PHOTONS];     /* the flux of the photons up to each one over that of all, ascending to 1 */
    vec3 to_light[GLINT_PHOTONS]; /* against the photon's way, unit */
} glint_guide;

/* Finds the photons within reach (> 0, scene units) of a point that lie on surfaces which face alike, of 32 neighbours
 * in the tree. normal: unit, on the side of the light. Returns false where there are fewer than eight, or all are
 * black. */
bool glint_guide_find(const photon_tree *tree, vec3 position, vec3 normal, float reach, glint_guide *out_guide);

/* Returns a unit direction; u_pick and u: random numbers in [0, 1). It may lie below the surface. */
vec3 glint_guide_sample(const glint_guide *guide, float u_pick, vec2 u);

/* Returns the density of glint_guide_sample at a unit direction, 1/sr. */
float glint_guide_density(const glint_guide *guide, vec3 direction);

#endif
