/* geometry_embree.h: shapes as Embree's geometries: meshes, curves, whole spheres, and user geometries for all others.
 * Private to bvh_embree.c. Threads: one attaches; Embree's call the functions. */
#ifndef AFTERGLOW_GEOMETRY_EMBREE_H
#define AFTERGLOW_GEOMETRY_EMBREE_H

#include "rays/embree_api.h"
#include "scene.h"

/* The user data of a geometry, which Embree passes to the callbacks. */
typedef struct embree_user {
    const scene *s;
    const shape *shape;
} embree_user;

/* The address by which TSan is told that callbacks on Embree's threads run after what was written before the build, and
 * before what is read after it. */
extern char embree_threads;

/* Attaches the user data's shape as a geometry of that number, unless no ray can meet it. The user data must not move
 * while the geometry lives. Returns false when out of memory. */
bool embree_attach_shape(RTCDevice device, RTCScene into, embree_user *user, uint32_t index);

/* A ray's id is its ray_alpha_rule and, this many bits up, the roles of the shapes that it looks for; 0: all. */
enum { EMBREE_ROLES_SHIFT = 2 };

/* Embree's filter for rays that look for shapes of some roles. */
void embree_filter_by_role(const struct RTCFilterFunctionNArguments *arguments);

/* Returns whether Embree knows the shape as a sphere of its own. */
bool embree_has_as_sphere(const shape *s);

/* Returns the shape's number of primitives. */
uint64_t embree_item_count(const shape *s);

#endif
