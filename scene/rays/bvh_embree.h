/* bvh_embree.h: the inside of a bvh, which bvh_embree.c builds and into which rays_embree.c casts rays. Private to the
 * two. Threads: read-only once it is built. */
#ifndef AFTERGLOW_BVH_EMBREE_H
#define AFTERGLOW_BVH_EMBREE_H

#include "rays/bvh.h"
#include "rays/embree_api.h"

struct bvh_tree;
struct bvh_device;

enum { BVH_SPHERES_MAX = 64 };

struct bvh {
    RTCScene scene; /* the world's */
    struct bvh_tree *world;
    struct bvh_tree **objects; /* [object_count], NULL where none is to be seen */
    uint32_t object_count;
    struct bvh_device *device;
    bool tells_what_is_near;                         /* Embree's point queries find all surfaces but these spheres */
    uint32_t sphere_count, spheres[BVH_SPHERES_MAX]; /* shapes */
};

#endif
