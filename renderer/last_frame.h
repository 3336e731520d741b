/* last_frame.h: what a context keeps of the last picture's photons, so that the next frame of an animation computes
 * irradiance anew only where something has changed.
 * Flow: render_maps takes from here, and leaves here what it is done with. Threads: as for the context. */
#ifndef AFTERGLOW_LAST_FRAME_H
#define AFTERGLOW_LAST_FRAME_H

#include "context.h"
#include "photon_map.h"
#include "scene_forms.h"

typedef struct last_frame {
    photon_map map;    /* owned, steady; its scene may be gone */
    scene_forms forms; /* owned: of that scene */
} last_frame;

/* Takes over a map and the forms of its scene, in place of what was there, where the map is of use to a next frame. */
void last_frame_leave(ag_context *context, photon_map *map, scene_forms *forms);

/* Makes ready the slots of a new map that the last frame tells, and counts them; the last frame is gone afterwards.
 * Errors: AG_ERROR_MEMORY, AG_CANCELLED. */
ag_status last_frame_use(ag_context *context, const scene_forms *forms, photon_map *map);

void last_frame_destroy(last_frame *left); /* NULL is fine */

#endif
