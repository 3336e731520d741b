/* loop_subdivision.h: triangle meshes made smooth by Loop subdivision, pushed to the limit surface.
 * Rests on: Loop, "Smooth Subdivision Surfaces Based on Triangles", 1987; Hoppe et al., "Piecewise Smooth Surface
 * Reconstruction", 1994 (limit positions and tangents); Pharr, Jakob, Humphreys, "Physically Based Rendering", 3rd ed.,
 * 2016, ch. 3.8 (the weights: Warren's).
 * Flow: pbrt_subdivision -> [here]. Threads: any. */
#ifndef AFTERGLOW_LOOP_SUBDIVISION_H
#define AFTERGLOW_LOOP_SUBDIVISION_H

#include "afterglow/base.h"

#include <stddef.h>
#include <stdint.h>

/* The finest mesh that is made: with its BVH it takes some 8 GB, 124 bytes a triangle. */
#define LOOP_MAX_TRIANGLES ((size_t)1 << 26)

typedef struct loop_mesh {
    size_t vertex_count, triangle_count;
    double *positions; /* 3 per vertex, on the limit surface */
    double *normals;   /* 3 per vertex, of any length, on the side where triangles go counterclockwise */
    uint32_t *indices; /* 3 per triangle, each < vertex_count */
} loop_mesh;

/* Subdivides `levels` times (0 is fine). positions: 3 per vertex; indices: 3 per triangle, each < vertex_count.
 * The vertices that triangles use keep their order and come first; the others are left out. A boundary is a smooth
 * curve, at its corners too. Where the mesh is not manifold, or its triangles are not turned alike, error (of
 * error_size bytes) says where: AG_ERROR_SCENE. Other errors: AG_ERROR_MEMORY, AG_ERROR_ARGUMENT where the result would
 * be too fine. *out_mesh is to be reset; on failure it is zeroed. */
ag_status loop_subdivide(const double *positions, size_t vertex_count, const uint32_t *indices, size_t triangle_count,
                         int levels, char *error, size_t error_size, loop_mesh *out_mesh);
void loop_mesh_reset(loop_mesh *m); /* frees the arrays; leaves it zeroed */

#endif
