/* splitting.h: into how many gather rays and light samples a camera sample is split, and how many of them ask for
 * caustics, where no option says it: in each block of pixels so many that the rays which the block costs bring the
 * least noise.
 * Rests on: Arvo, Kirk, "Particle Transport and Image Synthesis", 1990 (splitting); Neyman, "On the Two Different
 * Aspects of the Representative Method", 1934 (samples by variance and cost). With the variances V between camera
 * samples, G by one gather ray, L by one light sample, and what each of them costs, v, g, l, N camera samples of n rays
 * and m light samples have the variance (V + G / n + L / m) / N for the cost N (v + n g + m l); their product is least
 * at n = sqrt(G / V * v / g), m = sqrt(L / V * v / l). Where caustics of the mean square C, which cost c, are asked for
 * by chance, with the probability p (roulette), V - C + C / p and v + p c stand for V and v, and the best probability
 * is p = sqrt(C / (V - C) * v / c).
 *
 * These numbers are best for a block that goes on until it is quiet enough. Where N is fixed, it is the same for all
 * blocks, and what counts is the product of the whole frame's variance E and cost F. This cost includes what the photon
 * maps cost, shared out among the camera samples. The product is least where F / E stands for v / V above, and for
 * v / (V - C): at n = sqrt(G / g * F / E), m = sqrt(L / l * F / E), p = sqrt(C / c * F / E). A small picture of the
 * whole frame tells F / E. Each of its samples lies in the middle of its pixel: in the large picture, what differs
 * across a pixel is spread so evenly among its samples that little of it is left in their mean (Mitchell, "Consequences
 * of Stratified Sampling in Graphics", 1996).
 *
 * The numbers are chosen for blocks, as in adaptive.h. With a fixed number of samples, the small picture chooses those
 * of the first ones; later ones are chosen by the block's own samples. Costs are numbers of rays, never times. How a
 * sample is split depends on earlier samples alone, and all samples weigh alike: the picture's expectation stays.
 * Flow: film -> [here] -> the next pass. Threads: a pixel belongs to one worker at a time; decisions are made while no
 * tile is rendered. */
#ifndef AFTERGLOW_SPLITTING_H
#define AFTERGLOW_SPLITTING_H

#include "afterglow/afterglow.h"
#include "film/eye_sample.h"

#include <stdbool.h>

struct ag_film;

/* A pixel's sums over its samples, and how the next ones are split. Variances are of the mean of the three colours. */
typedef struct split_trial {
    float value, square;    /* the mean of the three colours, and its square */
    float by_parts;         /* the variance by the choice of gather rays and light samples, and by roulette */
    float by_ray, by_light; /* what it would be with one of them */
    float caustic;          /* the square of caustics: the variance by asking for them half as often */
    float cost_of_ray, cost_of_light, cost_of_caustic, cost_of_rest;
    uint32_t lights_known; /* samples that by_light sums over: those of two light samples or more */
    split_counts counts;
} split_trial;

/* The numbers that a small picture of the whole frame tells before the first sample. Samples have no part in it, so a
 * film that is emptied keeps it. */
typedef struct split_prior {
    double cost_per_variance; /* of the frame's camera samples; 0: each block chooses for itself */
    split_counts *first;      /* of the first samples, by film_block_number; owned; NULL: splitting_first of all */
} split_prior;

/* Frees what it owns, and empties it: before the first sample, or at the end of the film. */
void split_prior_reset(split_prior *prior);

/* Returns whether blocks choose: where the integrator's samples can be split (splits_samples) and no number of gather
 * rays is set. */
bool splitting_is_open(const ag_render_settings *settings, bool splits_samples);
/* Returns whether blocks choose again by their own samples: then a film holds all pixels of its blocks. */
bool splitting_goes_on(const ag_render_settings *settings, bool splits_samples);
/* The counts of every sample where blocks do not choose, and of the first samples where they do. */
split_counts splitting_first(const ag_render_settings *settings);

/* How many samples a pixel is expected to get, at most: with a level of noise, few get as many as they may. */
int splitting_expected_samples(const ag_render_settings *settings);

/* The most rays of either kind that a sample may have. */
split_counts splitting_most(const ag_render_settings *settings, bool splits_samples);

void split_trial_add(split_trial *trial, const eye_sample *sample);

/* Sets the film's prior and the counts of its blocks' first samples, by a small picture of the whole frame, each of
 * whose pixels has had two samples or more. fixed_cost: of all that does not depend on the number of samples, as
 * eye_worker_cost counts. Errors: AG_ERROR_MEMORY. */
ag_status splitting_begin(struct ag_film *film, const struct ag_film *pilot, double fixed_cost,
                          const ag_render_settings *settings);

/* Sets how the first samples of all pixels are split; does nothing where blocks do not choose. */
void splitting_set_first(struct ag_film *film, const ag_render_settings *settings);

/* Decides the blocks' counts where that is due, and returns the number of samples to stop at next. Called while no tile
 * is rendered, before pixels are brought to `wanted` samples; calling it again changes nothing. */
uint32_t splitting_decide(struct ag_film *film, const ag_render_settings *settings, uint32_t wanted);

#endif
