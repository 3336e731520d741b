/* import_scene.h: the records of import_model.h made into a scene.
 * Flow: import_file -> [here] -> importer -> scene. Threads: one per scene. */
#ifndef AFTERGLOW_IMPORT_SCENE_H
#define AFTERGLOW_IMPORT_SCENE_H

#include "scene.h"

#include <stddef.h>

/* Fills an empty, uncommitted scene from the records; path is the file's, for messages and pictures. The bytes may be
 * anything: what does not hold together is an error. Meshes are copied to each node that holds them.
 * Errors: AG_ERROR_INPUT (also told to the log), AG_ERROR_MEMORY, AG_CANCELLED. */
ag_status import_scene_fill(run_context *run, const char *path, const unsigned char *bytes, size_t size,
                            scene *out_scene);

#endif
