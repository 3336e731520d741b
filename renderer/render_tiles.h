/* render_tiles.h: the eye's side of a rendering: a pass over the tiles of the picture, by all workers.
 * Flow: render.c -> [here] -> shading, path_tracing -> sample_queue -> film. Threads: a tile belongs to one worker;
 * samples wait in its queue until their gather rays are looked up, and come to the film in their order. */
#ifndef AFTERGLOW_RENDER_TILES_H
#define AFTERGLOW_RENDER_TILES_H

#include "rendering.h"

/* Creates each thread's own state, with all the memory that it will use: nothing can fail while tiles run. NULL when
 * out of memory. */
eye_worker *eye_workers_create(const transport *t, unsigned count);
void eye_workers_destroy(eye_worker *workers, unsigned count); /* NULL is fine */

/* A pass: brings pixels to so many samples, or to their goals where the film has some. Errors: AG_PAUSED (not all of
 * them, but whole samples), AG_CANCELLED, AG_ERROR_MEMORY. */
ag_status render_tiles(ag_rendering *r, uint32_t wanted);

#endif
