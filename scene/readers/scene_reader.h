/* scene_reader.h: what a reader of scene files is, and which formats have one: a file and a row of SCENE_READER_LIST
 * each. Flow: scene_file finds a file's reader -> [here] -> scene. Threads: one per scene. */
#ifndef AFTERGLOW_SCENE_READER_H
#define AFTERGLOW_SCENE_READER_H

#include "scene.h"

/* Fills an empty, uncommitted scene from a file. Every error is told to the run's log, with its location in the file;
 * what is not supported is named in a warning, once. Models without camera or light get those of import_defaults.h.
 * Errors: AG_ERROR_INPUT (a file cannot be read), AG_ERROR_SCENE, AG_ERROR_MEMORY, AG_ERROR_SYSTEM, AG_ERROR_COLOR,
 * AG_CANCELLED. */
typedef ag_status scene_reader(run_context *run, const char *path, scene *out_scene);

/* Every ending of file names, in any case, and its reader, which stands in a file of its own and says there what it
 * makes of the format. The first row that fits is taken. assimp, which reads some of these too, comes after them. */
#define SCENE_READER_LIST(X)                                                                                           \
    X(".pbrt", pbrt_parse_file)                                                                                        \
    X(".pbrt.gz", pbrt_parse_file)                                                                                     \
    X(".obj", obj_load_file)                                                                                           \
    X(".obj.gz", obj_load_file)                                                                                        \
    X(".ply", ply_load_file)                                                                                           \
    X(".ply.gz", ply_load_file)                                                                                        \
    X(".gltf", gltf_load_file)                                                                                         \
    X(".glb", gltf_load_file)

#define SCENE_READER_DECLARATION(ending, reader) scene_reader reader;
SCENE_READER_LIST(SCENE_READER_DECLARATION)
#undef SCENE_READER_DECLARATION

#endif
