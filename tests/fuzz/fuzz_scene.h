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

#endif
