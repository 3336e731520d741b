/* surface_footprint.h: the ellipse in which a ray's cone meets a surface, in space and in the surface's u and v.
 * Rests on: Akenine-Moller et al., "Improved Shader and Texture Level of Detail Using Ray Cones", JCGT 10(1), 2021.
 * Flow: surface hit -> [here] -> material, texture. Threads: pure functions. */
#ifndef AFTERGLOW_SURFACE_FOOTPRINT_H
#define AFTERGLOW_SURFACE_FOOTPRINT_H

#include "surface.h"
#include "texture/texture.h"

/* Returns false where textures are not filtered: also on surfaces with alpha (alpha.h), where points nearby may be
 * holes, of any colour. */
bool surface_footprint_at(const scene *s, const surface_hit *hit, surface_footprint *out);

#endif
