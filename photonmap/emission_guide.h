/* emission_guide.h: which random numbers of a photon path's beginning bring light to where it is asked for.
 * Rests on: Hachisuka, Jensen, "Robust Adaptive Photon Tracing using Photon Path Visibility", 2011 (paths as points of
 * the space of their random numbers); Lepage, "A New Algorithm for Adaptive Multidimensional Integration", 1978
 * (density by the root of the mean square); Suykens, Willems 2000 (bounded weights).
 * Flow: photon_aim's trials -> [here] -> photon_tracing. Threads: one builds; then read-only.
 *
 * A binary tree halves the cube of those numbers, one of them at a time, where the trials say that halves differ. A
 * path that is guided begins in a leaf, picked by its mass; a share of the paths begins anywhere. The density of both
 * together weighs every path, so that the light is right on average whatever the tree says. */
#ifndef AFTERGLOW_EMISSION_GUIDE_H
#define AFTERGLOW_EMISSION_GUIDE_H

#include "light/light.h"
#include "math/rng.h"

/* Light, direction (2), point (2), part. */
enum { EMISSION_DIMENSIONS = 6 };

/* A path's beginning; each number in [0, 1). */
typedef struct emission_start {
    float u[EMISSION_DIMENSIONS];
} emission_start;

/* A path that was tried, and what came of it. */
typedef struct emission_trial {
    emission_start start;
    float value;   /* >= 0: what it brought to where light is asked for */
    float density; /* with which it was begun, 1 where all are alike */
} emission_trial;

typedef struct emission_guide_node emission_guide_node;

typedef struct emission_guide {
    emission_guide_node *nodes; /* owned, the root first; NULL: all starts are alike */
    uint32_t node_count;
    float share; /* of the paths, that follow the tree, or it and the other one: [0, 1) */
    float gain;  /* variance by power alone over variance by the guide, as the trials let expect; >= 0 */
    const struct emission_guide *other; /* whose tree half of the guided paths follow; the caller's, or NULL */
} emission_guide;

/* Reorders the trials. Where none has brought anything, all starts are alike. other: as above; it has a tree, and none
 * beside it. Errors: AG_ERROR_MEMORY. */
ag_status emission_guide_create(emission_trial *trials, uint32_t count, float share, const emission_guide *other,
                                emission_guide *out_guide);
void emission_guide_reset(emission_guide *guide);

/* A start, and its density, which is at least 1 - share. */
emission_start emission_guide_sample(const emission_guide *guide, rng *random, float *out_density);
float emission_guide_density(const emission_guide *guide, const emission_start *start);

/* The numbers as drawn without a guide, and what light_emit wants of them. */
emission_start emission_start_draw(rng *random);
emission_numbers emission_start_numbers(const emission_start *start);
/* The start of those numbers, from the lamp that u_light picks. */
emission_start emission_start_of(float u_light, const emission_numbers *numbers);

#endif
