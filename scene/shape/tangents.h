/* tangents.h: how a surface runs along its u and v, and how its normal turns on the way.
 * Rests on: Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, ch. 6 (the parametrisations), 3.9.
 * Flow: surface hit -> [here] -> shading_frame, and whoever asks for surface_tangents. Threads: pure functions. */
#ifndef AFTERGLOW_TANGENTS_H
#define AFTERGLOW_TANGENTS_H

#include "surface.h"

/* World space. Where uvs give no direction (a seam, a pole, one uv for a whole triangle) dpdu and dpdv are any two unit
 * tangents. */
typedef struct surface_differentials {
    vec3 dpdu, dpdv;
    vec3 dndu, dndv; /* of the unit shading normal, across it */
} surface_differentials;

surface_differentials surface_differentials_at(const scene *s, const surface_hit *hit);

/* Writes dpdu and dpdv alone. Returns false where uvs give no direction. */
bool surface_uv_axes(const scene *s, const surface_hit *hit, vec3 *out_dpdu, vec3 *out_dpdv);

/* Returns whether the hit is on a mesh that has been given tangents, beside what its uvs say. */
bool surface_has_own_tangents(const scene *s, const surface_hit *hit);

/* Writes the tangents along which u and v grow at the hit, in world space; of a mesh with tangents of its own, that
 * tangent and the one across it on v's side. Where uvs give no direction, any two tangents. Each call computes them
 * anew. */
void surface_tangents(const scene *s, const surface_hit *hit, vec3 *out_dpdu, vec3 *out_dpdv);

#endif
