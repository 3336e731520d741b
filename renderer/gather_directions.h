/* gather_directions.h: the directions of a gather's rays, many at once: spread by the cosine, by the numbers of a
 * sampler's sequence. Rests on: what sampler.h and math/sampling.h rest on; to the bit what they give one by one.
 * Flow: sampler -> [here] -> final_gather. Threads: pure functions. */
#ifndef AFTERGLOW_GATHER_DIRECTIONS_H
#define AFTERGLOW_GATHER_DIRECTIONS_H

#include "bvh.h"
#include "sampler.h"

/* By the numbers from `first` on of the sequence, up to RAY_FAN_MAX of them: unit directions around the frame's z, or
 * where is_below around its opposite. Columns x, y, z; what is behind the last one is overwritten too. */
void gather_directions(sampler_sequence *sequence, uint32_t first, uint32_t count, const frame *around, bool is_below,
                       float out_directions[3][RAY_FAN_MAX]);

/* The same for any processor, which gather_directions is where there is nothing faster. */
void gather_directions_plain(sampler_sequence *sequence, uint32_t first, uint32_t count, const frame *around,
                             bool is_below, float out_directions[3][RAY_FAN_MAX]);

#endif
