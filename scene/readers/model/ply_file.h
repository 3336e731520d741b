/* ply_file.h: a triangle mesh from a PLY file: ascii or binary, plain or gzip.
 * Rests on: Turk, "The PLY Polygon File Format", 1994. What is not named below is passed over.
 * Flow: ply_stream, ply_header -> [here] -> pbrt_ply. Threads: any, each with its own file. */
#ifndef AFTERGLOW_PLY_FILE_H
#define AFTERGLOW_PLY_FILE_H

#include "run_context.h"
#include "shape/shape.h"

typedef struct ply_mesh {
    mesh mesh; /* as the file has it; normals of any length, NULL where not all of nx, ny, nz are there, uvs likewise;
                  arrays from malloc, positions with room for one more */
    size_t lines;       /* faces with fewer than three corners, left out */
    size_t odd_vectors; /* normals and uvs that were not finite, and are 0 */
} ply_mesh;

/* Vertices' x, y, z; nx, ny, nz; u, v, also called s, t, texture_u, texture_v, texture_s, texture_t; and faces'
 * vertex_indices or vertex_index. Polygons are cut into the fan around their first corner.
 * Errors: AG_ERROR_INPUT, and error (of error_size bytes) says what and where, see ply_fail; AG_ERROR_MEMORY,
 * AG_CANCELLED when run (may be NULL) is. *out_mesh is to be reset; on failure it is zeroed. */
ag_status ply_file_read(const char *path, const run_context *run, char *error, size_t error_size, ply_mesh *out_mesh);
void ply_mesh_reset(ply_mesh *m); /* frees the arrays; leaves it zeroed */

#endif
