/* pbrt_meshes.h: what the readers of meshes share: arrays as a file has them, and how they become a mesh of the scene.
 * Flow: pbrt_meshes.c, pbrt_patches.c, pbrt_ply.c, pbrt_subdivision.c -> [here] -> pbrt_add_shape. Threads: one per
 * scene. */
#ifndef AFTERGLOW_PBRT_MESHES_H
#define AFTERGLOW_PBRT_MESHES_H

#include "pbrt/pbrt_private.h"

/* A mesh in object space as the file has it. */
typedef struct pbrt_mesh {
    const double *positions; /* 3 per vertex, of each of the sets */
    const double *normals;   /* as positions, or NULL */
    const double *uvs;       /* 2 per vertex, or NULL */
    const double *tangents;  /* as positions, or NULL */
    size_t vertex_count;
    uint32_t motion_segments; /* sets of positions, normals and tangents beside the first, as a mesh has them */
    uint32_t *indices;        /* 3 per triangle, each < vertex_count; from malloc */
    size_t triangle_count;
    bool expects_degenerate; /* triangles without area are no fault of the file's */
} pbrt_mesh;

/* Adds it to the scene in world space, less the triangles without area. Takes source->indices, also on failure. */
ag_status pbrt_add_mesh(pbrt_parser *parser, const parameter_list *list, const pbrt_mesh *source);
/* Works as pbrt_add_mesh, for a mesh whose arrays, in object space, are the scene's own already: they are transformed
 * in place and taken, also on failure. dropped: triangles that were left out before, for the warning. */
ag_status pbrt_add_object_mesh(pbrt_parser *parser, const parameter_list *list, mesh *object_mesh, size_t dropped,
                               bool expects_degenerate);
/* Adds parser->made_mesh, whose arrays the scene then shares, or, of a lamp that would lose triangles because it stands
 * still, holds its own copies of. */
ag_status pbrt_add_made_mesh(pbrt_parser *parser, const parameter_list *list);
/* Returns whether shapes of that type may have "motionsteps". */
bool pbrt_has_motion_steps(const char *type);
/* "motionsteps", which pbrt does not have: of how many sets P consists, for evenly spaced times of the shutter. Makes
 * *in_out_vertex_count, of all of them, that of one. Errors: AG_ERROR_SCENE. */
ag_status pbrt_read_motion_steps(pbrt_parser *parser, parameter_list *list, size_t *in_out_vertex_count,
                                 uint32_t *out_segments);
/* Reads the arrays that meshes have in common, all but triangle_count. There are *out_index_count indices, a multiple
 * of corners, from malloc: those of the file, or 0, 1, 2, ... where it has none and the vertices are a single face. */
ag_status pbrt_read_mesh_arrays(pbrt_parser *parser, parameter_list *list, size_t corners, pbrt_mesh *out_mesh,
                                size_t *out_index_count);

#endif
