/* obj_file.h: a scene from a Wavefront OBJ file and the MTL files that it names.
 * Rests on: Wavefront, "Object Files", Advanced Visualizer Manual, appendix B1.
 * Flow: text_lines, mtl_file -> [here], polygon -> importer -> scene. Threads: one per scene. */
#ifndef AFTERGLOW_OBJ_FILE_H
#define AFTERGLOW_OBJ_FILE_H

#include "scene.h"

/* path: plain or gzip. Fills an empty, uncommitted scene: one mesh for each material; polygons, concave ones too, are
 * cut into triangles; corners without normals have those of their smoothing group, or none. MTL files and pictures that
 * are not there are warnings. A camera and light are made (import_defaults.h), the latter where nothing shines. Errors:
 * AG_ERROR_INPUT (a file cannot be read), AG_ERROR_SCENE (with the location), AG_ERROR_MEMORY, AG_CANCELLED. */
ag_status obj_load_file(run_context *run, const char *path, scene *out_scene);

#endif
