/* closed_room.h: places the camera and light of a model that is a closed room, and brings none itself, inside of it.
 *
 * A position is in a room where rays in nearly all directions end at surfaces, thin glass not counted, and these are
 * walls that face it, or lie on the scene's bounds with something else between: a closed solid, whose faces all turn
 * away from its inside, is therefore none. The decision depends on the scene alone.
 * Flow: scene_commit, once rays can be cast -> [here] -> camera and lights, before these are committed. */
#ifndef AFTERGLOW_CLOSED_ROOM_H
#define AFTERGLOW_CLOSED_ROOM_H

#include "scene.h"

/* Moves camera and light into a room, if there is one; does nothing where the file has both. scene.world_from_upright
 * is the upright direction. Logs at info level. Errors: AG_ERROR_MEMORY, AG_CANCELLED. */
ag_status closed_room_furnish(scene *s, const run_context *run);

#endif
