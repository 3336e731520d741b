/* bvh.h: the tree that rays go through; only bvh_embree.c knows how it is built. rays.h casts rays.
 * Flow: scene_commit builds it. Threads: built by the run's workers; then read-only. */
#ifndef AFTERGLOW_BVH_H
#define AFTERGLOW_BVH_H

#include "scene.h"

typedef struct bvh bvh;

/* Builds the trees of a scene. isa and errors: see scene_commit. The scene's shapes must not move while the bvh lives:
 * meshes are shared with Embree, not copied. Trees of s->before with the same surfaces are shared by both scenes, and
 * refer to s from now on, also after a failure. Adds to *reuse. */
ag_status bvh_create(const scene *s, run_context *run, const char *isa, scene_reuse *reuse, bvh **out_bvh);
/* Makes the trees refer to the scene that owns them again. NULL is fine. */
void bvh_point_at(const bvh *b, const scene *s);
void bvh_destroy(bvh *b); /* NULL is fine */

/* Returns the bytes that Embree holds for the tree, and for others that share it, without this library's buffers. */
uint64_t bvh_memory_bytes(const bvh *b);

/* Returns the instruction set that the kernels were limited to: "avx2", ... */
const char *bvh_isa(const bvh *b);

#endif
