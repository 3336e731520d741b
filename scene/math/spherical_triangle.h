/* spherical_triangle.h: a triangle as it is seen from a point: its solid angle, and points uniform in that.
 * Rests on: Van Oosterom, Strackee, "The Solid Angle of a Plane Triangle", 1983; Arvo, "Stratified Sampling of
 * Spherical Triangles", 1995. Threads: pure functions. */
#ifndef AFTERGLOW_SPHERICAL_TRIANGLE_H
#define AFTERGLOW_SPHERICAL_TRIANGLE_H

#include "math/vec3.h"

typedef struct double3 {
    double x, y, z;
} double3;

/* A triangle whose solid angle is known; corners relative to the point that sees it. */
typedef struct spherical_triangle {
    double3 a, b, c;
    double turns;      /* the solid angle over 2 pi, in [0, 1] */
    bool is_from_back; /* the corners run clockwise as seen from the point, or it is in their plane */
} spherical_triangle;

void spherical_triangle_see(vec3 point, vec3 a, vec3 b, vec3 c, spherical_triangle *out_triangle);

/* Returns the triangle's area, in the corners' units squared. */
double spherical_triangle_area(const spherical_triangle *t);

/* Returns the weights of corners b and c in a point of the triangle, whose direction is uniform in its solid angle.
 * Good to 1e-4 of the triangle's size where turns are from 1e-5 to 0.98. */
vec2 spherical_triangle_sample(const spherical_triangle *t, vec2 u);

#endif
