/* geometry_embree.h: shapes as Embree's geometries: meshes, curves, whole spheres, and our own functions for the rest.
 * Private to bvh_embree.c. Threads: one attaches; Embree's call the functions. */
#ifndef AFTERGLOW_GEOMETRY_EMBREE_H
#define AFTERGLOW_GEOMETRY_EMBREE_H

#include "rays/embree_api.h"
#include "scene.h"

/* Our user data, which Embree gives back to our functions. */
typedef struct embree_user {
    const scene *s;
    const shape *shape;
} embree_user;

/* Calls to us from Embree's threads read what was written before the build, and what they write is read after it. */
extern char embree_threads;

/* The user data's shape as a geometry of that number, unless no ray meets it. The user data stays where it is as long
 * as the geometry lives. False when out of memory. */
bool embree_attach_shape(RTCDevice device, RTCScene into, embree_user *user, uint32_t index);

/* How many primitives it brings. */
uint64_t embree_item_count(const shape *s);

#endif
