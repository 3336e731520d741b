/* tangents.h: how a surface runs along its u and v, and how its normal turns on the way.
 * Rests on: Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, ch. 6 (the parametrisations), 3.9.
 * Flow: surface hit -> [here] -> shading_frame, and whoever asks for surface_tangents. Threads: pure functions. */
#ifndef AFTERGLOW_TANGENTS_H
#define AFTERGLOW_TANGENTS_H

#include "surface.h"

/* World space. Where uvs say nothing (a seam, a pole, one uv for a whole triangle) dpdu and dpdv are unit and any. */
typedef struct surface_differentials {
    vec3 dpdu, dpdv;
    vec3 dndu, dndv; /* of the unit shading normal, across it */
} surface_differentials;

surface_differentials surface_differentials_at(const scene *s, const surface_hit *hit);

/* dpdu and dpdv alone. false: uvs say nothing there. */
bool surface_uv_axes(const scene *s, const surface_hit *hit, vec3 *out_dpdu, vec3 *out_dpdv);

/* Along which the surface's u and v grow there, in world space, unless it is a mesh with tangents of its own: those,
 * and across them on v's side. Worked out anew at each call. Where there are none, any that lie in the surface. */
void surface_tangents(const scene *s, const surface_hit *hit, vec3 *out_dpdu, vec3 *out_dpdv);

#endif
