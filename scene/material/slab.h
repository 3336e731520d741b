/* slab.h: what a plate of smooth glass with two parallel faces reflects and lets through, in all: light leaves it as it
 * came, or as a mirror sends it, but for a shift sideways of about a third of the plate's thickness.
 * Rests on: Born, Wolf, "Principles of Optics", 1.6 (the series of reflections between two faces, without
 * interference); Beer's law for what is between them.
 * Flow: material -> [here] -> bsdf, at hits that rays/slab_faces.h has found to be such plates.
 * Threads: pure functions. */
#ifndef AFTERGLOW_SLAB_H
#define AFTERGLOW_SLAB_H

#include "material/material_point.h"

struct medium;

/* Whether plates of the material are known in closed form: smooth glass and nothing else, the same all over. */
bool slab_may_be_of(const struct scene *s, uint32_t material_index);

/* Of light that meets a plate of such a material at a cosine (>= 0) from outside, all that it reflects and all that it
 * lets through; together at most 1. Where each face reflects R and a is left of light on its way between them,
 * T = (1 - R)^2 a / (1 - R^2 a^2). thickness: scene units; between: what fills the plate, NULL: nothing absorbs. */
slab_point slab_point_at(const material_point *face, float cosine, float thickness, const struct medium *between);

#endif
