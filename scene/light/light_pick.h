/* light_pick.h: prepares the data by which scene.h picks lights.
 * Flow: scene_commit -> [here] -> light_tree. Threads: one commits; then any number pick. */
#ifndef AFTERGLOW_LIGHT_PICK_H
#define AFTERGLOW_LIGHT_PICK_H

#include "scene.h"

/* Sets the lights' powers and the data by which they are picked. Shapes are committed and bounds are set before.
 * Errors: AG_ERROR_MEMORY, AG_ERROR_SCENE. */
ag_status light_pick_commit(scene *s, log_sink *log);
void light_pick_reset(scene *s);

#endif
