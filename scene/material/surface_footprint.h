/* surface_footprint.h: the ellipse that a ray's cone cuts out of a surface, in space and in the surface's u and v.
 * Rests on: Akenine-Moller et al., "Improved Shader and Texture Level of Detail Using Ray Cones", JCGT 10(1), 2021.
 * Flow: surface hit -> [here] -> material, texture. Threads: pure functions. */
#ifndef AFTERGLOW_SURFACE_FOOTPRINT_H
#define AFTERGLOW_SURFACE_FOOTPRINT_H

#include "surface.h"
#include "texture/texture.h"

/* false: nothing is to be filtered there. That is so on shapes which are there in part (alpha.h), too: what lies beside
 * the point may be a part that is not there, and of any colour. */
bool surface_footprint_at(const scene *s, const surface_hit *hit, surface_footprint *out);

#endif
