/* bvh.h: the tree that rays go through; only bvh_embree.c knows how it is built. rays.h casts rays.
 * Flow: scene_commit builds it. Threads: built by the run's workers; then read-only. */
#ifndef AFTERGLOW_BVH_H
#define AFTERGLOW_BVH_H

#include "scene.h"

typedef struct bvh bvh;

/* See scene_commit for isa and errors. The scene's shapes must stay where they are while the bvh lives: meshes are
 * shared with Embree, not copied. */
ag_status bvh_create(const scene *s, run_context *run, const char *isa, bvh **out_bvh);
void bvh_destroy(bvh *b); /* NULL is fine */

/* Bytes that Embree holds for it, buffers of ours that it shares not counted. */
uint64_t bvh_memory_bytes(const bvh *b);

/* "avx2", ...: what the kernels were limited to. */
const char *bvh_isa(const bvh *b);

#endif
