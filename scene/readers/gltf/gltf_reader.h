/* gltf_reader.h: a scene in the glTF 2.0 format, .gltf or .glb, read into a scene.
 * Rests on: Khronos, "glTF 2.0 Specification", 2021, and the KHR extensions that gltf_document.c lists.
 * Flow: scene file -> [here] -> scene. Threads: one per scene. */
#ifndef AFTERGLOW_GLTF_READER_H
#define AFTERGLOW_GLTF_READER_H

#include "scene.h"

/* path: a JSON or a binary file, told apart by its first bytes, or "-" for standard input. Fills an empty, uncommitted
 * scene with the file's default scene; a camera and light are made where it has none.
 * Every error is told to the run's log: of the JSON's syntax with line and column, else with the path of the value, as
 * "room.gltf: error: accessors[3].bufferView: ...". What is not supported is named in a warning, once. Errors:
 * AG_ERROR_INPUT (a file cannot be read), AG_ERROR_SCENE, AG_ERROR_MEMORY, AG_ERROR_SYSTEM, AG_ERROR_COLOR,
 * AG_CANCELLED.
 *
 * Radiance is what the file's luminance is (1 nit is 1 W/m^2/sr), and lamps are measured alike (1 cd is 1 W/sr, 1 lx is
 * 1 W/m^2); but Blender's exporter multiplies those of lamps alone by 683 lm/W, which is taken back (gltf_lights.c). */
ag_status gltf_load_file(run_context *run, const char *path, scene *out_scene);

#endif
