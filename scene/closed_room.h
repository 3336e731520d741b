/* closed_room.h: a model that is a closed room is to be looked at from within, and no sun lights it. Where camera or
 * light were made up for a file that brings none, this sets them inside.
 *
 * A position is in a room where rays in nearly all directions end at surfaces, thin glass not counted, and these are
 * walls that face it, or lie on the bounds of all there is with something else between: so a closed solid, whose faces
 * all turn away from its inside, is none. What is decided depends on the scene alone.
 * Flow: scene_commit, once rays can be cast -> [here] -> camera and lights, before these are committed. Threads:
 * one. */
#ifndef AFTERGLOW_CLOSED_ROOM_H
#define AFTERGLOW_CLOSED_ROOM_H

#include "scene.h"

/* scene.world_from_upright says what is up. Does nothing where neither was made up, or where there is no such room.
 * Said at info level. Errors: AG_ERROR_MEMORY. */
ag_status closed_room_furnish(scene *s, log_sink *log);

#endif
