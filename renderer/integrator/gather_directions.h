/* gather_directions.h: the directions of a gather's rays, many at once: the numbers of a sampler's sequence, warped to
 * a cosine distribution. Rests on: what sampler.h and math/sampling.h rest on; the results have the bits of theirs, one
 * by one. Flow: sampler -> [here] -> final_gather. Threads: pure functions. */
#ifndef AFTERGLOW_GATHER_DIRECTIONS_H
#define AFTERGLOW_GATHER_DIRECTIONS_H

#include "integrator/sampler.h"
#include "rays/rays.h"

/* Writes the sequence's numbers from `first` on, up to RAY_FAN_MAX, as columns. Columns are overwritten up to a
 * multiple of eight, here and below. */
void gather_numbers(sampler_sequence *sequence, uint32_t first, uint32_t count, float out_u[2][RAY_FAN_MAX]);

/* Writes the directions that sample_cosine_hemisphere makes of such numbers: unit, around the frame's z, or around its
 * opposite where is_below. Columns: x, y, z. */
void gather_directions(float u[2][RAY_FAN_MAX], uint32_t count, const frame *around, bool is_below,
                       float out_directions[3][RAY_FAN_MAX]);

/* gather_numbers and gather_directions in plain C: for processors without AVX2, and for tests of the others' bits. */
void gather_numbers_plain(sampler_sequence *sequence, uint32_t first, uint32_t count, float out_u[2][RAY_FAN_MAX]);
void gather_directions_plain(float u[2][RAY_FAN_MAX], uint32_t count, const frame *around, bool is_below,
                             float out_directions[3][RAY_FAN_MAX]);

#endif
