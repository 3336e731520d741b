/* transform.h: affine and projective maps of space as 4x4 matrices with their inverses, in double precision.
 * Names read "to_from_from": world_from_camera maps camera space to world space.
 * Conventions are pbrt's: column vectors, left-handed camera space looking along +z.
 * Threads: pure functions. */
#ifndef AFTERGLOW_TRANSFORM_H
#define AFTERGLOW_TRANSFORM_H

#include "math/vec3.h"

typedef struct transform {
    double m[4][4];       /* row, column */
    double inverse[4][4]; /* of m */
} transform;

transform transform_identity(void);
/* false when m is singular (or not finite); *out_transform is then left alone */
bool transform_from_matrix(const double m[4][4], transform *out_transform);
transform transform_multiply(const transform *a, const transform *b); /* apply b first */
transform transform_invert(const transform *a);
transform transform_translate(double x, double y, double z);
/* false when a factor is 0 */
bool transform_scale(double x, double y, double z, transform *out_transform);
/* false when the axis is 0 */
bool transform_rotate(double degrees, double x, double y, double z, transform *out_transform);
/* camera_from_world; false when eye and look coincide or up is parallel to the view */
bool transform_look_at(const double eye[3], const double look[3], const double up[3], transform *out_transform);

vec3 transform_point(const transform *t, vec3 p);
vec3 transform_vector(const transform *t, vec3 v);
/* by the inverse transpose; not normalised */
vec3 transform_normal(const transform *t, vec3 n);
/* the linear part turns right-handed frames into left-handed ones */
bool transform_swaps_handedness(const transform *t);
/* the linear part is a rotation (or reflection) times one scale; returns that scale, 0 when it is not */
double transform_uniform_scale(const transform *t);

#endif
