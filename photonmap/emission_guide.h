/* emission_guide.h: guides the emission of photon paths, in the space of the random numbers that begin a path, to where
 * light is requested.
 * Rests on: Hachisuka, Jensen, "Robust Adaptive Photon Tracing using Photon Path Visibility", 2011 (paths as points of
 * the space of their random numbers); Lepage, "A New Algorithm for Adaptive Multidimensional Integration", 1978
 * (density by the root of the mean square); Suykens, Willems 2000 (bounded weights).
 * Flow: photon_aim's trials -> [here] -> photon_tracing. Threads: built by one thread; then read-only.
 *
 * A binary tree bisects the cube of these numbers, one dimension at a time, where trials show that the halves differ. A
 * guided path begins in a leaf that is picked by its mass; the other paths begin uniformly. Each path is weighted by
 * the density of the mixture, so that the light is right on average whatever the tree is. */
#ifndef AFTERGLOW_EMISSION_GUIDE_H
#define AFTERGLOW_EMISSION_GUIDE_H

#include "light/light.h"
#include "math/rng.h"

/* Light, direction (2), point (2), part. */
enum { EMISSION_DIMENSIONS = 6 };

/* The random numbers that begin a path; each in [0, 1). */
typedef struct emission_start {
    float u[EMISSION_DIMENSIONS];
} emission_start;

/* A trial path and its result. */
typedef struct emission_trial {
    emission_start start;
    float value;   /* its contribution where light is requested, >= 0 */
    float density; /* density of its start; 1 for uniform starts */
} emission_trial;

typedef struct emission_guide_node emission_guide_node;

typedef struct emission_guide {
    emission_guide_node *nodes; /* owned, the root first; NULL: starts are uniform */
    uint32_t node_count;
    float share;                        /* share of the paths that follow this tree or the other one, [0, 1) */
    float gain;                         /* expected ratio of the variance by power alone to the guided variance, >= 0 */
    const struct emission_guide *other; /* borrowed: half of the guided paths follow its tree; or NULL */
} emission_guide;

/* Builds a guide from trials, which are reordered. Starts are uniform where no trial has contributed anything. other: a
 * guide with a tree, and without another one; or NULL; borrowed. Errors: AG_ERROR_MEMORY. */
ag_status emission_guide_create(emission_trial *trials, uint32_t count, float share, const emission_guide *other,
                                emission_guide *out_guide);
void emission_guide_reset(emission_guide *guide);

/* Samples a start. out_density: at least 1 - share. */
emission_start emission_guide_sample(const emission_guide *guide, rng *random, float *out_density);
/* Returns the density of a start; 1 where starts are uniform. */
float emission_guide_density(const emission_guide *guide, const emission_start *start);

/* Draws the uniform random numbers of a start. */
emission_start emission_start_draw(rng *random);
/* Returns the numbers of a start in the form that light_emit takes, with that focus, which is borrowed; NULL: none. */
emission_numbers emission_start_numbers(const emission_start *start, const light_target *focus);
/* Returns the start of these numbers, from the lamp that u_light picks. */
emission_start emission_start_of(float u_light, const emission_numbers *numbers);

#endif
