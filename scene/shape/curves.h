/* curves.h: hair, grass and thread: cubic Bezier curves with a width; what shape.c asks of them.
 * Rests on: Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, 6.7 (types, parametrisation); for
 * round ones Reshetov, Luebke, "Phantom Ray-Hair Intersector", 2018. Round curves are tubes here; in pbrt they are flat
 * and face the ray. Flow: shape.c -> [here]. Embree casts the rays, points are recomputed here. Threads: read-only once
 * committed. */
#ifndef AFTERGLOW_CURVES_H
#define AFTERGLOW_CURVES_H

#include "shape/shape.h"
#include "shape/tangents.h"

/* Returns how many points a segment has in all its sets. */
static inline size_t curves_points_of_each(const curves *c) { return 4 * ((size_t)c->motion_segments + 1); }
/* Returns whether the shape is one of curves whose points move. */
static inline bool shape_is_moving_curves(const shape *s)
{
    return s->kind == SHAPE_CURVES && s->as.curves.motion_segments > 0;
}

/* Reserves room for segment_count segments in all; motion_segments stays as it is from then on. Errors:
 * AG_ERROR_MEMORY. */
ag_status curves_reserve(curves *c, uint32_t segment_count);
void curves_reset(curves *c);
/* Returns whether two shapes of curves differ in nothing but their segments, and can be joined. */
bool curves_can_be_joined(const shape *s, const shape *with);
/* Adds the segments of `from`. Errors: AG_ERROR_MEMORY. */
ag_status curves_join(curves *c, const curves *from);

float curves_area(const shape *s); /* at the opening; of flat curves the one side that is seen; needs no commit */
void curves_find_bounds(const shape *s, vec3 *out_min, vec3 *out_max);

/* Fits a ribbon's segment, whose normals may lean and be of any length, to Embree, which evaluates them at its ends and
 * leaves out the turning of the curve itself. Returns the largest distance of its edges from where the normals put
 * them, as a share of half the width. */
double curves_fit_ribbon(curves *c, uint32_t segment);

/* shape_surface_at for curves. u: Embree's. direction: of the ray, which flat curves turn to face. time: of the
 * shutter. */
void curves_surface_at(const shape *s, uint32_t primitive_index, float u, vec3 position, vec3 direction, float time,
                       surface_hit *out_hit);
/* Returns the differentials in the shape's own space. */
surface_differentials curves_differentials(const shape *s, const surface_hit *hit);

#endif
