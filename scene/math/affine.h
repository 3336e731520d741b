/* affine.h: affine maps as the 3x4 matrices of floats that instances are kept in; applied in double precision.
 * Threads: pure functions. */
#ifndef AFTERGLOW_AFFINE_H
#define AFTERGLOW_AFFINE_H

#include "math/transform.h"

typedef struct affine {
    float m[3][4]; /* row, column */
} affine;

/* False where t is no affine map, or one that floats cannot hold and undo; *out_affine is then left alone. */
bool affine_from_transform(const transform *t, affine *out_affine);
/* Whether the map can be undone in single precision: its determinant is neither 0 nor out of range. */
bool affine_can_be_undone(const affine *a);

/* Entry by entry: a at 0, b at 1. */
affine affine_lerp(const affine *a, const affine *b, float t);

double affine_determinant(const affine *a);
/* The cofactors of the linear part: determinant times inverse transpose. It maps area vectors as the map does areas,
 * but for a mirror's sign. */
void affine_cofactors(const affine *a, double out_cofactors[3][3]);

vec3 affine_point(const affine *a, vec3 p);
vec3 affine_vector(const affine *a, vec3 v);

#endif
