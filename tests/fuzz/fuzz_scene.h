/* fuzz_scene.h: what holds of every scene that a reader accepts, and that it can be committed and looked at.
 * Flow: a target -> [here] -> scene, bvh. Threads: one. */
#ifndef AFTERGLOW_FUZZ_SCENE_H
#define AFTERGLOW_FUZZ_SCENE_H

#include "fuzz.h"
#include "scene.h"

/* Goes into the folder, and has files in it that scenes may name: a.pbrt, a.ply, a.pfm, a.spd, a.dat. */
void fuzz_enter_folder_with_files(void);

/* Checks indices and values, commits, and casts some rays. run has no threads but gets one. */
void fuzz_look_at_scene(scene *s, fuzz_run *run);

/* Reads a file into an empty scene by a format's reader, and looks at what that accepts. */
typedef ag_status fuzz_reader(run_context *run, const char *path, scene *s);
void fuzz_read_scene(fuzz_reader *read, const char *path);

#endif
