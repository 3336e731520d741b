/* splitting.h: into how many gather rays, light samples and camera rays a camera sample is split, and how many of them
 * ask for caustics, where no option says it: in each block of pixels so many that the rays which the block costs bring
 * the least noise.
 * Rests on: Arvo, Kirk, "Particle Transport and Image Synthesis", 1990 (splitting); Neyman, "On the Two Different
 * Aspects of the Representative Method", 1934 (samples by variance and cost). With the variances V between camera
 * samples, G by one gather ray, L by one light sample, and what each of them costs, v, g, l, N camera samples of n rays
 * and m light samples have the variance (V + G / n + L / m) / N for the cost N (v + n g + m l); their product is least
 * at n = sqrt(G / V * v / g), m = sqrt(L / V * v / l). Where caustics of the mean square C, which cost c, are asked for
 * by chance, with the probability p (roulette), V - C + C / p and v + p c stand for V and v, and the best probability
 * is p = sqrt(C / (V - C) * v / c).
 *
 * Gathered light and caustics cost most, while edges, highlights and lamps in mirrors want many camera rays. So a
 * sample may have k of these (eye_sample.h), which all bring the light of other kinds. Where a single one costs s, and
 * the variance of that light is S, S / k and k s are among V and v, and of what is left of these without them the best
 * number is k = sqrt(S / V * v / s).
 *
 * These numbers are best for a block that goes on until it is quiet enough; there n, m and p are those for one camera
 * ray, and k the number for which the product is least then. Where N is fixed, it is the same for all blocks, and what
 * counts is the product of the whole frame's variance E and cost F. This cost includes what the photon maps cost,
 * shared out among the camera samples. The product is least where F / E stands for v / V above, and for v / (V - C): at
 * n = sqrt(G / g * F / E), m = sqrt(L / l * F / E), k = sqrt(S / s * F / E), p = sqrt(C / c * F / E). A small picture
 * of the whole frame tells F / E. Its samples are spread over as much as a pixel of the large picture, in the middle of
 * each of its own. In the large picture, what differs across a pixel is spread evenly among its N samples: the variance
 * that an edge leaves in their mean is as N^-1.5 (Mitchell, "Consequences of Stratified Sampling in Graphics", 1996).
 * So of S, and of the V that goes into E, the share 1 / sqrt(N) counts.
 *
 * With a level of noise, a block has the least number of samples that there is, or r times as many, as it needs. Most
 * blocks of a room need no more, and for these N is fixed. So E is the sum of V / r, and F that of r v, and a block
 * takes the numbers by F / E or those that are best for itself, whichever leaves less of V / r + r v E / F.
 *
 * The numbers are chosen for blocks, as in adaptive.h. The small picture chooses those of the first samples; later ones
 * are chosen by the block's own samples. Costs are numbers of rays, never times. How a
 * sample is split depends on earlier samples alone, and all samples weigh alike: the picture's expectation stays.
 * Flow: film, which sums what sample_split.h says -> [here] -> the next pass. Threads: a pixel belongs to one worker at
 * a time; decisions are made while no tile is rendered. */
#ifndef AFTERGLOW_SPLITTING_H
#define AFTERGLOW_SPLITTING_H

#include "film/sample_split.h"

struct ag_film;

/* Sets the film's prior and the counts of its blocks' first samples, by a small picture of the whole frame, each of
 * whose pixels has had two samples or more. fixed_cost: of all that does not depend on the number of samples, as
 * eye_worker_cost counts. Errors: AG_ERROR_MEMORY. */
ag_status splitting_begin(struct ag_film *film, const struct ag_film *pilot, double fixed_cost,
                          const ag_render_settings *settings);

/* Decides the blocks' counts where that is due, and returns the number of samples to stop at next. Called while no tile
 * is rendered, before pixels are brought to `wanted` samples; calling it again changes nothing. */
uint32_t splitting_decide(struct ag_film *film, const ag_render_settings *settings, uint32_t wanted);

#endif
