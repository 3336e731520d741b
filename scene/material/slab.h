/* slab.h: reflectance and transmittance of a plate of smooth glass with two parallel faces, as a whole: light leaves
 * it in its own direction or the mirror direction, but for a lateral shift of about a third of the plate's
 * thickness.
 * Rests on: Born, Wolf, "Principles of Optics", 1.6 (the series of reflections between two faces, without
 * interference); Beer's law for what is between them.
 * Flow: material -> [here] -> bsdf, at hits that rays/slab_faces.h has found to be such plates.
 * Threads: pure functions. */
#ifndef AFTERGLOW_SLAB_H
#define AFTERGLOW_SLAB_H

#include "material/material_point.h"

struct medium;
struct surface_hit;

/* Returns whether plates of the material have a closed form: smooth glass and nothing else, uniform. */
bool slab_may_be_of(const struct scene *s, uint32_t material_index);

/* Returns reflectance and transmittance of a plate of such a material, together at most 1, for light that comes from
 * outside at a cosine (>= 0). Where each face reflects R, and a is the transmittance between the faces,
 * T = (1 - R)^2 a / (1 - R^2 a^2). hit: on the face that light enters by, with the way through the plate. between: the
 * medium within the plate, or NULL. */
slab_point slab_point_at(const material_point *face, float cosine, const struct surface_hit *hit,
                         const struct medium *between);

#endif
