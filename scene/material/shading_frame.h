/* shading_frame.h: the frame of scattering at a surface: along its tangents where its roughness has a grain, tilted by
 * bump and normal maps. Rests on: Blinn, "Simulation of Wrinkled Surfaces", 1978; Pharr, Jakob, Humphreys, "Physically
 * Based Rendering", 4th ed., 2023, 10.5.3 (bump and normal maps). Flow: surface hit, material -> [here] -> bsdf. A
 * function of the point alone, so that photons and eye agree. Threads: pure functions. */
#ifndef AFTERGLOW_SHADING_FRAME_H
#define AFTERGLOW_SHADING_FRAME_H

#include "material/material.h"
#include "scene.h"

/* Returns whether a bump or normal map tilts it. */
bool shading_frame_is_tilted(const material *m);

/* Returns the frame at a hit. m: no mix. z: the shading normal, on the geometric normal's side; x: along dp/du where
 * there is a grain (material_point_has_grain), else any. */
frame shading_frame_at(const scene *s, const surface_hit *hit, const material *m, bool has_grain);

#endif
