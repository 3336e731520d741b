/* split_pilot.h: how the first camera samples of each block are split, told by a small picture beforehand.
 * Rests on: splitting.h. Flow: maps -> [here] -> the film's splitting -> render_tiles.
 * Threads: on the thread that renders, with all of its workers; none is at work before and after.
 *
 * The small picture is of the whole frame, whatever the crop and the tile are, so that they have the bits of the whole.
 * Its samples are of pixels as narrow as the large picture's, where edges and textures bring as little noise, and of
 * random numbers apart from those of the picture, whose expectation stays. */
#ifndef AFTERGLOW_SPLIT_PILOT_H
#define AFTERGLOW_SPLIT_PILOT_H

#include "rendering.h"

/* Sets the film's first counts, where blocks choose and there is no sample yet; the rendering has its maps and workers.
 * Errors: those of render_tiles; after AG_PAUSED the next call goes on. */
ag_status split_pilot_run(ag_rendering *r);

#endif
