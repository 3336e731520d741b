/* sample_split.h: how samples are split at first and at most, and what each pixel learns from its samples for the next
 * ones. splitting.h, which decides by that, has the theory.
 * Flow: settings, eye_sample -> [here] -> film, splitting. Threads: a pixel belongs to one worker at a time. */
#ifndef AFTERGLOW_SAMPLE_SPLIT_H
#define AFTERGLOW_SAMPLE_SPLIT_H

#include "afterglow/afterglow.h"
#include "film/eye_sample.h"

#include <stdbool.h>

/* The split is decided for the first time at so many samples of a pixel. */
enum { SPLIT_FIRST_BARRIER = 4 };
/* Gather rays of the first camera samples, at least: from one the variance cannot be told. */
enum { SPLIT_FIRST_RAYS_MIN = 4 };

/* A pixel's sums over its samples, and how the next ones are split. Variances are of the mean of the three colours. */
typedef struct split_sums {
    float value, square;             /* the mean of the three colours, and its square */
    float own, own_square;           /* value and square of what the samples' own camera rays alone bring */
    float by_parts;                  /* of own, the variance by the choice of gather rays, and by roulette */
    float by_ray, by_light;          /* the variance if there were one of them */
    float caustic;                   /* the square of caustics: the variance by asking for them half as often */
    float per_light, per_camera_ray; /* 1 / their number */
    float cost_of_ray, cost_of_light, cost_of_caustic, cost_of_further, cost_of_rest;
    uint32_t lights_known; /* samples that by_light sums over: those with two light samples or more by a camera ray */
    split_counts counts;
} split_sums;

/* The numbers that a small picture of the whole frame tells before the first sample. Samples have no part in it, so a
 * film that is emptied keeps it. */
typedef struct split_prior {
    double cost_per_variance; /* of the frame's camera samples; 0: each block chooses for itself */
    split_counts *first;      /* of the first samples, by film_block_number; owned; NULL: film_first_split of all */
} split_prior;

/* Frees what it owns, and empties it: before the first sample, or at the end of the film. */
void split_prior_reset(split_prior *prior);

/* Returns whether blocks choose: where the integrator's samples can be split (splits_samples) and no number of gather
 * rays is set. */
bool sample_split_is_open(const ag_render_settings *settings, bool splits_samples);
/* Returns whether blocks choose again by their own samples: then a film holds all pixels of its blocks. */
bool sample_split_goes_on(const ag_render_settings *settings, bool splits_samples);
/* Returns the counts of every sample where blocks do not choose, and of the first samples where they do. */
split_counts sample_split_first(const ag_render_settings *settings, bool splits_samples);

/* Returns the largest of each count that a sample may have. */
split_counts sample_split_most(const ag_render_settings *settings, bool splits_samples);

/* Adds a sample that was split by the sums' counts. */
void split_sums_add(split_sums *sums, const eye_sample *sample);

#endif
