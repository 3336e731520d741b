/* import_file.h: models in the formats that assimp reads, by way of the program afterglow-import.
 * Flow: file -> import_process -> records (import_model.h) -> import_scene -> scene. Threads: one per scene. */
#ifndef AFTERGLOW_IMPORT_FILE_H
#define AFTERGLOW_IMPORT_FILE_H

#include "scene.h"

/* Returns whether the import program is installed; where it is not, logs at a level the paths that were tried. */
bool import_finds_program(const run_context *run, ag_log_level level);

/* Finds whether assimp reads files whose names end so: extension with its dot, in any case. False where the program is
 * not there. Errors: AG_ERROR_SYSTEM, AG_ERROR_INPUT (also told to the log), AG_ERROR_MEMORY, AG_CANCELLED. */
ag_status import_reads_extension(const run_context *run, const char *extension, bool *out_reads);

/* Fills an empty, uncommitted scene: meshes in world space (right-handed, y up) with materials (import_material.c), the
 * file's first camera, its lights; or a default camera and light. Polygons are cut into triangles; where the file has
 * no normals, surfaces are flat. Animations are not played. Whatever is in the file, and whatever assimp makes of it,
 * is at worst an error. Errors: AG_ERROR_INPUT (also told to the log, in assimp's words), AG_ERROR_MEMORY,
 * AG_ERROR_SYSTEM, AG_CANCELLED. */
ag_status import_file_load(run_context *run, const char *path, scene *out_scene);

#endif
