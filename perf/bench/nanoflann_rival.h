/* nanoflann_rival.h: nanoflann's kd-tree (Debian's libnanoflann-dev), the rival of photon_search.
 * Threads: built by one; then any number search at once. */
#ifndef AFTERGLOW_NANOFLANN_RIVAL_H
#define AFTERGLOW_NANOFLANN_RIVAL_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct nanoflann_tree nanoflann_tree;

/* points: 3 floats each, borrowed. NULL when out of memory. */
nanoflann_tree *nanoflann_tree_create(const float *points, size_t count);
void nanoflann_tree_destroy(nanoflann_tree *tree);
/* How many there are among the `wanted` nearest, and their indices and squared distances, nearest first. */
size_t nanoflann_tree_nearest(const nanoflann_tree *tree, const float query[3], size_t wanted, uint32_t *out_indices,
                              float *out_distances_squared);

#ifdef __cplusplus
}
#endif
#endif
