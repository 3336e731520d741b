/* surface_region.h: which part of an estimate's disc is surface: a wall, the edge of a table or a thin partition ends
 * it. A disc that reaches past an edge loses light (about 0.21 of its radius along the edge); one that reaches through
 * a wall finds the next room's. A few short rays along the surface, and down onto it, tell how far it goes each way;
 * photons and area are then counted inside that region alone, so the estimate is right wherever the region is whole
 * surface. Rests on: Jensen 2001, 7.2 (boundary bias); the rays are an alternative to his convex hull, which takes
 * shadows for edges. Flow: photon_map asks, where the photons found hint at an edge. Threads: pure functions of the
 * scene and the point. */
#ifndef AFTERGLOW_SURFACE_REGION_H
#define AFTERGLOW_SURFACE_REGION_H

#include "scene.h"

enum { SURFACE_REGION_SECTORS = 8 };

/* A region of the tangent plane around its centre: in each octant of the frame x, y it is the near side of a chord,
 * line[0] x + line[1] y <= 1; a line of zeros bounds nothing. */
typedef struct surface_region {
    vec3 center, x, y;
    float line[SURFACE_REGION_SECTORS][2];
    float share;       /* of the area within those bounds that is there: below 1 where a picture cuts holes (alpha.h) */
    float nearest_end; /* from the centre to where the surface ends first, among the sectors' bounds; scene units */
} surface_region;

/* min_cos: normals more alike than this belong to the surface, as for photons. The rays that are cast are added to
 * *in_out_rays, here and below. Returns false where nothing ends it
 * within radius of the point and it has no holes, and where there is no surface at the point. */
bool surface_region_find(const scene *s, vec3 position, vec3 normal, float min_cos, float radius, uint64_t *in_out_rays,
                         surface_region *out_region);

/* Whether surface lies below four points near the rim of the disc, a quarter turn apart: a test for edges at a quarter
 * of the search's cost, for discs in which nothing else hints at one. An edge nearer than 0.64 of the radius is
 * always found. */
bool surface_region_reaches_rim(const scene *s, vec3 position, vec3 normal, float min_cos, float radius,
                                uint64_t *in_out_rays);

bool surface_region_contains(const surface_region *region, vec3 position);

/* m^2, of what is there within radius of the centre. */
double surface_region_area(const surface_region *region, float radius);

#endif
