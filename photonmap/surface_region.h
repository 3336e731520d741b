/* surface_region.h: the part of an estimate's disc that is surface, which ends at a wall, at the edge of a table or at
 * a thin partition. A disc that reaches past an edge loses light (about 0.21 of its radius along the edge); one that
 * reaches through a wall finds the next room's. A few short rays along the surface, and down onto it, tell how far it
 * goes each way; photons and area are then counted inside that region alone, so the estimate is right wherever the
 * region is whole surface. Rests on: Jensen 2001, 7.2 (boundary bias); the rays are an alternative to his convex hull,
 * which takes shadows for edges. Flow: irradiance_estimate, where the photons found hint at an edge -> [here] ->
 * rays/clear_space, rays/transmittance. Threads: pure functions of the scene and the point. */
#ifndef AFTERGLOW_SURFACE_REGION_H
#define AFTERGLOW_SURFACE_REGION_H

#include "rays/clear_space.h"

enum { SURFACE_REGION_OCTANTS = 8 };

/* A region of the tangent plane around its centre: in each octant of the frame x, y it is the near side of a chord,
 * line[0] x + line[1] y <= 1; a line of zeros bounds nothing. */
typedef struct surface_region {
    vec3 center, x, y;
    float line[SURFACE_REGION_OCTANTS][2];
    float bend[SURFACE_REGION_OCTANTS][2]; /* along each octant's first bound, and in the frame x, y: by how much the
                                              normal's part in the plane grows over a scene unit; 0 where flat */
    bool has_steps; /* other surfaces lie below, as a wall behind a board: a region is wanted even where there is no
                       end; set by who looks for it */
    float share;    /* share of the area within those bounds that is surface: below 1 where alpha cuts holes (alpha.h),
                       and where surface_region_leave_steps has found other surfaces */
    float nearest_end; /* distance from the centre to the nearest end of the surface, along the octants' bounds, scene
                          units */
} surface_region;

/* The bounds of the octants in the frame x, y, counter-clockwise; each octant's first bound has its index. */
static const float SURFACE_REGION_BOUND[SURFACE_REGION_OCTANTS][2] = {
    {1.0f, 0.0f},  {0.70710678f, 0.70710678f},   {0.0f, 1.0f},  {-0.70710678f, 0.70710678f},
    {-1.0f, 0.0f}, {-0.70710678f, -0.70710678f}, {0.0f, -1.0f}, {0.70710678f, -0.70710678f}};

/* The octant of a point of the plane, by the bits |y| > |x|, x < 0, y < 0, from the lowest. */
static const uint32_t SURFACE_REGION_OCTANT_BY_SIGNS[SURFACE_REGION_OCTANTS] = {0, 1, 3, 2, 7, 6, 4, 5};

/* Returns whether what lies so far below the plane of a point, at a lateral distance, is another surface: it faces the
 * way that the point's own does too nearly to have bent down to there. A step of less than a thirty-second of the
 * radius is none. cosine: > 0, between the two normals. All lengths in scene units. */
bool surface_region_is_below_step(float radius, float lateral_squared, float drop, float cosine);

/* Finds the surface at a point itself, from above: at first from a thirty-second of the radius above it; a narrow
 * corner may have room for an eighth, or a sixty-fourth, of that alone. normal: unit, accurate to a degree. *out_lift:
 * from how far above it was found, scene units. The rays cast are added to *in_out_rays. Returns false where the first
 * surface below is not that of the point, or where a ray cannot start so close to it. */
bool surface_region_find_foot(const scene *s, vec3 position, vec3 normal, float radius, uint64_t *in_out_rays,
                              surface_hit *out_foot, float *out_lift);

/* Finds the region around a point; its has_steps is set beforehand. min_cos: normals with a greater cosine belong to
 * the surface, as for photons. The rays cast are added to *in_out_rays, here and below. space: a clear space nearby, or
 * NULL; rays whose answer it tells are not cast. Returns false where the surface has neither an end nor a hole nor a
 * step within radius, and where there is no surface at the point. */
bool surface_region_find(const scene *s, const clear_space *space, vec3 position, vec3 normal, float min_cos,
                         float radius, uint64_t *in_out_rays, surface_region *in_out_region);

/* Finds the share of a region above surfaces that lie below a step. normal, min_cos, radius: as for
 * surface_region_find, which has found it. Costs some 100 rays. */
void surface_region_leave_steps(const scene *s, const clear_space *space, vec3 normal, float min_cos, float radius,
                                uint64_t *in_out_rays, surface_region *in_out_region);

/* Finds a larger part of what a region is of, where that is a strip, as a rod, a bar or a cord: the region's eight
 * directions miss the strip's, so that little of its length is within. Changes the region only if its area grows.
 * normal, min_cos, radius: as for surface_region_find, which has found it. Costs some 100 rays. */
void surface_region_follow_strip(const scene *s, const clear_space *space, vec3 normal, float min_cos, float radius,
                                 uint64_t *in_out_rays, surface_region *in_out_region);

/* Returns whether surface lies below four points near the rim of the disc, a quarter turn apart: a test for edges at a
 * quarter of the search's cost, for discs in which nothing else indicates one. An edge nearer than 0.64 of the radius
 * is always found. */
bool surface_region_reaches_rim(const scene *s, const clear_space *space, vec3 position, vec3 normal, float min_cos,
                                float radius, uint64_t *in_out_rays);

/* Returns whether the space alone tells that surface_region_find would return false: the cheapest of the three. */
bool surface_region_is_whole(const scene *s, const clear_space *space, vec3 position, vec3 normal, float min_cos,
                             float radius);

/* Returns whether the position's projection on the tangent plane lies in the region; its distance from the centre does
 * not count. */
bool surface_region_contains(const surface_region *region, vec3 position);

/* Returns the area of the surface within radius of the centre, m^2. Where it ends because it bends away, that is more
 * than the region has in the plane: of a ball, the cap whose rim is 37 degrees off has 10 / 9 of it. */
double surface_region_area(const surface_region *region, float radius);

#endif
