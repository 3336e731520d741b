/* light_pick.h: scene.c's side of picking lights; the questions themselves are in scene.h.
 * Flow: scene_commit -> [here] -> light_tree. Threads: one commits; then any number ask. */
#ifndef AFTERGLOW_LIGHT_PICK_H
#define AFTERGLOW_LIGHT_PICK_H

#include "scene.h"

/* Powers, and all by which lights are picked. Shapes are committed, bounds are set.
 * Errors: AG_ERROR_MEMORY, AG_ERROR_SCENE. */
ag_status light_pick_commit(scene *s, log_sink *log);
void light_pick_reset(scene *s);

#endif
