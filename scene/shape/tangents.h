/* tangents.h: how a surface runs along its u and v, and how its normal turns on the way.
 * Rests on: Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, ch. 6 (the parametrisations), 3.9.
 * Flow: surface hit -> [here] -> shading_frame, and whoever asks bvh.h for surface_tangents. Threads: pure functions.
 */
#ifndef AFTERGLOW_TANGENTS_H
#define AFTERGLOW_TANGENTS_H

#include "rays/bvh.h"

/* World space. Where uvs say nothing (a seam, a pole, one uv for a whole triangle) dpdu and dpdv are unit and any. */
typedef struct surface_differentials {
    vec3 dpdu, dpdv;
    vec3 dndu, dndv; /* of the unit shading normal, across it */
} surface_differentials;

surface_differentials surface_differentials_at(const scene *s, const surface_hit *hit);

#endif
