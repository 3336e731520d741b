/* mesh_motion.h: meshes whose vertices move while the shutter is open: sets of positions and normals at evenly spaced
 * times, straight in between, as Embree has them.
 * Rests on: Wald et al., "Embree: A Kernel Framework for Efficient CPU Ray Tracing", 2014 (motion blur).
 * Flow: shape, tangents, instance -> [here]. Threads: pure functions. */
#ifndef AFTERGLOW_MESH_MOTION_H
#define AFTERGLOW_MESH_MOTION_H

#include "shape/shape.h"

/* The most sets of vertices: as many as Embree takes. */
enum { MESH_STEPS_MAX = 129 };

/* Returns how many positions, and normals, a mesh has in all its sets. */
static inline size_t mesh_value_count(const mesh *m) { return m->vertex_count * ((size_t)m->motion_segments + 1); }

/* Returns whether the shape is a mesh whose vertices move. */
static inline bool shape_is_deforming(const shape *s)
{
    return s->kind == SHAPE_MESH && s->as.mesh.motion_segments > 0;
}

/* A value at each corner of a triangle. */
typedef struct corner_values {
    vec3 at[3];
} corner_values;

/* Returns the positions or tangents (`values`, one of the mesh's arrays) of a triangle of a mesh whose vertices move,
 * at a time of the shutter, [0, 1]. */
corner_values mesh_moving_values(const mesh *m, const vec3 *values, uint32_t triangle, float time);
/* Returns the normals of such a triangle's corners: unit, or zero where those of the steps before and after cancel. */
corner_values mesh_moving_normals(const mesh *m, uint32_t triangle, float time);

/* Returns the positions, normals or tangents (`values`) of a triangle of a mesh at rest. */
static inline corner_values mesh_still_values(const mesh *m, const vec3 *values, uint32_t triangle)
{
    const uint32_t *index = m->indices + 3 * (size_t)triangle;
    return (corner_values){{values[index[0]], values[index[1]], values[index[2]]}};
}

/* Returns the positions or tangents (`values`) of a triangle of any mesh, at rest or not, at a time of the shutter. */
static inline corner_values mesh_values_at(const mesh *m, const vec3 *values, uint32_t triangle, float time)
{
    return m->motion_segments > 0 ? mesh_moving_values(m, values, triangle, time)
                                  : mesh_still_values(m, values, triangle);
}
/* Returns the normals of a triangle of any mesh that has normals, at a time of the shutter. */
static inline corner_values mesh_normals_at(const mesh *m, uint32_t triangle, float time)
{
    return m->motion_segments > 0 ? mesh_moving_normals(m, triangle, time) : mesh_still_values(m, m->normals, triangle);
}

/* Returns how a value changes from the first corner to another. */
static inline vec3 triangle_edge(const corner_values *c, int corner) { return vec3_sub(c->at[corner], c->at[0]); }

/* Finds the barycentrics, of the second and the third corner, of a point in a triangle's plane; 0 where the triangle
 * has no area. */
void find_barycentrics(const corner_values *positions, vec3 point, double *out_b1, double *out_b2);

/* Moves a point of a triangle, as it is at a time of the shutter, to where it is at the opening. Computes an area
 * vector there, of either side, which is zero where the triangle has no area at the opening. */
void mesh_move_to_opening(const mesh *m, uint32_t triangle, float time, vec3 *in_out_point, double in_out_area[3]);

/* Returns the largest coordinate, by its size, of the corners before and after that time: their means are rounded by as
 * much. */
float mesh_moving_reach(const mesh *m, uint32_t triangle, float time);

#endif
