/* quadric.h: spheres, cylinders and disks, whole or in part: what shape.c asks of them.
 * Rests on: Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, ch. 6.2 to 6.4: what a part is, which
 * way normals point, and how (u, v) runs over it.
 * Flow: shape.c -> [here]. Rays meet them by shape_intersect_quadric. Threads: read-only once committed. */
#ifndef AFTERGLOW_QUADRIC_H
#define AFTERGLOW_QUADRIC_H

#include "shape/shape.h"

/* Each does what the function of shape.h with shape_ in place of quadric_ does. The shape is a quadric. */
void quadric_commit(shape *s);
float quadric_area(const shape *s); /* needs no commit */
void quadric_find_bounds(const shape *s, vec3 *out_min, vec3 *out_max);
surface_sample quadric_sample_area(const shape *s, vec2 u);
float quadric_pdf_area(const shape *s, vec3 geometric_normal);
void quadric_surface_at(const shape *s, vec3 position, bool with_uv, surface_hit *out_hit);
bool quadric_bare_point_at(const shape *s, vec3 position, vec3 *out_position, vec3 *out_geometric_normal);
/* Finds the nearest hit of a committed sphere, cylinder or disk in (t_min, t_max); false where there is none. */
bool shape_intersect_quadric(const shape *s, vec3 origin, vec3 direction, float t_min, float t_max, float *out_t);

#endif
