/* mesh_import_assimp.h: models in the formats that assimp reads: OBJ, STL, Collada, FBX, 3DS and some forty others.
 * Flow: file -> assimp, in a process of its own (import_process) -> records (import_model.h) -> import_scene -> scene.
 * Threads: one per scene. */
#ifndef AFTERGLOW_MESH_IMPORT_ASSIMP_H
#define AFTERGLOW_MESH_IMPORT_ASSIMP_H

#include "scene.h"

/* Whether assimp reads files whose names end so: extension with its dot, in any case. */
bool assimp_reads_extension(const char *extension);

/* Fills an empty, uncommitted scene: meshes in world space (right-handed, y up) with materials (import_material.c), the
 * file's first camera, its lights; or a default camera and light. Polygons are cut into triangles; where the file has
 * no normals, surfaces are flat. Animations are not played. Whatever is in the file, and whatever assimp makes of it,
 * is at worst an error. Errors: AG_ERROR_INPUT (also told to the log, in assimp's words), AG_ERROR_MEMORY,
 * AG_ERROR_SYSTEM, AG_CANCELLED. */
ag_status assimp_load_file(run_context *run, const char *path, scene *out_scene);

#endif
