/* scene_file.h: a scene from a file of any format that is read, by the end of the file's name.
 * Flow: path -> [here] -> scene_reader, import_file -> scene. Threads: one per scene. */
#ifndef AFTERGLOW_SCENE_FILE_H
#define AFTERGLOW_SCENE_FILE_H

#include "scene.h"

/* path: NAME.ply and .ply.gz, .gltf and .glb, what assimp reads (.obj, .stl, .dae, .fbx, ...), and all else as pbrt-v4
 * text (plain or gzip; "-" is standard input). Fills an empty, uncommitted scene. Models without camera or light get
 * those of import_defaults.h. Every error is told to the run's log. Errors: AG_ERROR_INPUT, AG_ERROR_SCENE,
 * AG_ERROR_MEMORY, AG_ERROR_SYSTEM, AG_CANCELLED, AG_ERROR_ARGUMENT (one of the scene's definitions is used
 * nowhere; formats other than pbrt's text use none). */
ag_status scene_file_load(run_context *run, const char *path, scene *out_scene);

/* scene_file_load of pbrt-v4 text in memory, as if it had been read from a file of that name. */
ag_status scene_file_load_text(run_context *run, const char *name, const char *text, size_t size, scene *out_scene);

#endif
