/* bvh_embree.h: what bvh_embree.c, which builds it, and rays_embree.c, which casts rays at it, know of a bvh. Private
 * to them. Threads: read-only once it is built. */
#ifndef AFTERGLOW_BVH_EMBREE_H
#define AFTERGLOW_BVH_EMBREE_H

#include "rays/bvh.h"
#include "rays/embree_api.h"

struct bvh_tree;
struct bvh_device;

struct bvh {
    RTCScene scene; /* the world's */
    struct bvh_tree *world;
    struct bvh_tree **objects; /* [object_count], NULL where none is to be seen */
    uint32_t object_count;
    struct bvh_device *device;
};

#endif
