/* material_point.h: a material at one point of a surface: mixes picked, textures looked up. A material_point
 * (material_kinds.h) holds only the values from which lobes are evaluated, since each bsdf has one.
 * Flow: material + surface hit -> [here] -> bsdf, which makes lobes of it. Threads: pure functions. */
#ifndef AFTERGLOW_MATERIAL_POINT_H
#define AFTERGLOW_MATERIAL_POINT_H

#include "material/material.h"

struct scene;
struct surface_hit;

/* Writes the point of a prepared material without textures, or before they are evaluated. */
void material_point_of(const material *m, material_point *out_point);

/* Returns the material at a hit, with mixes picked, and its values there. */
const material *material_at(const struct scene *s, const struct surface_hit *hit, material_point *out_point);

/* Finds, for a surface that gathers light anywhere (bsdf.h), the material by which it does, at a point where another
 * one may have been picked or the texture is black. Returns false where no point of the surface gathers. */
bool material_gathering_at(const struct scene *s, const struct surface_hit *hit, material_point *out_point);

/* Returns whether scattering depends on the surface's grain or on a fibre's axis. */
bool material_point_has_grain(const material_point *p);

#endif
