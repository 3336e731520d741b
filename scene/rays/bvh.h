/* bvh.h: the tree that rays go through; only bvh_embree.c knows how it is built. rays.h casts rays.
 * Flow: scene_commit builds it. Threads: built by the run's workers; then read-only. */
#ifndef AFTERGLOW_BVH_H
#define AFTERGLOW_BVH_H

#include "scene.h"

typedef struct bvh bvh;

/* See scene_commit for isa and errors. The scene's shapes must stay where they are while the bvh lives: meshes are
 * shared with Embree, not copied. Trees of s->before whose surfaces are the same are held by both; they ask s from now
 * on, also after a failure. Adds to *reuse. */
ag_status bvh_create(const scene *s, run_context *run, const char *isa, scene_reuse *reuse, bvh **out_bvh);
/* Makes the trees ask a scene again whose they are. NULL is fine. */
void bvh_point_at(const bvh *b, const scene *s);
void bvh_destroy(bvh *b); /* NULL is fine */

/* Bytes that Embree holds for it, and for others that share trees with it; buffers of ours not counted. */
uint64_t bvh_memory_bytes(const bvh *b);

/* "avx2", ...: what the kernels were limited to. */
const char *bvh_isa(const bvh *b);

#endif
