/* flat_patches.h: the flat parts of a mesh: triangles of one plane that are connected by their edges.
 * Flow: a mesh -> [here] -> rays/slab_faces.c, which looks for the faces of panes. Threads: pure functions. */
#ifndef AFTERGLOW_FLAT_PATCHES_H
#define AFTERGLOW_FLAT_PATCHES_H

#include "shape/shape.h"

#define FLAT_NO_PATCH UINT32_MAX

/* Normals of one plane differ by no more than this, radians. */
#define FLAT_ANGLE_MAX 1e-3f

typedef struct flat_patch {
    vec3 normal;               /* unit, of either side */
    vec3 extent;               /* of a box around it, along the axes, in units of the mesh's space */
    float area;                /* in squares of these units */
    uint32_t largest_triangle; /* of its own */
} flat_patch;

/* Finds the patch of each triangle of a mesh; FLAT_NO_PATCH where the mesh's own normals make a triangle look curved,
 * where it has no area, and where the patch has less than share_min of the mesh's area. The caller frees both arrays.
 * Errors: AG_ERROR_MEMORY. */
ag_status flat_patches_find(const mesh *m, double share_min, uint32_t **out_patch_of_triangle, flat_patch **out_patches,
                            uint32_t *out_count);

#endif
