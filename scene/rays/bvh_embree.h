/* bvh_embree.h: what bvh_embree.c, which builds it, and rays_embree.c, which casts rays at it, know of a bvh. Private
 * to them. Threads: read-only once it is built. */
#ifndef AFTERGLOW_BVH_EMBREE_H
#define AFTERGLOW_BVH_EMBREE_H

#include "rays/bvh.h"
#include "rays/embree_api.h"

struct attached;

struct bvh {
    struct attached *attached; /* [shape_count]: what Embree gives back to the build's functions */
    RTCDevice device;
    RTCScene scene;
    RTCScene *objects; /* [object_count], NULL where none is to be seen */
    uint32_t object_count;
    char isa[16];
    _Atomic int64_t memory_bytes; /* moved by Embree's memory monitor, from several threads; a plain count */
};

#endif
