/* adaptive.h: which pixels have had enough samples, by the noise that is left in their block.
 * Rests on: noise.h, where the noise is told. Flow: film -> [here] -> the next pass. Threads: when no tile is rendered.
 *
 * A block decides as one: a bright sample that a pixel has not met may be met next door, and pixels that stop because
 * they have met none would darken the picture. Blocks lie alike in crops and in the full picture. It is decided at
 * fixed numbers of samples alone, when every pixel has had what it is to have: so neither threads nor the moment of a
 * pause reach the picture. */
#ifndef AFTERGLOW_ADAPTIVE_H
#define AFTERGLOW_ADAPTIVE_H

#include "film/film.h"
#include "run_context.h"

/* Returns how many samples each pixel has, at least. */
int adaptive_least_samples(const ag_render_settings *settings);

/* Returns the number of samples up to which pixels are brought now: the next one at which it is decided. */
uint32_t adaptive_barrier(const struct ag_film *film);

/* Decides anew how many samples each pixel is to have. Called when all pixels have had the samples of the last
 * decision, and the barrier is below `most`. *out_is_done: no pixel needs more. Errors: AG_CANCELLED. */
ag_status adaptive_decide(struct ag_film *film, run_context *run, const ag_render_settings *settings,
                          bool *out_is_done);

#endif
