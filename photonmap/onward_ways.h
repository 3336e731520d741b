/* onward_ways.h: directions in which light goes on from diffuse surfaces to where it is requested, learned from
 * importons that came from there.
 * Rests on: Peter, Pietrek, "Importance Driven Construction of Photon Maps", 1998 (photons scattered towards where
 * importons came from); Veach, Guibas, "Optimally Combining Sampling Techniques", 1995 (the mixture's density).
 * Flow: the pilot's importons -> [here] -> photon_path. Threads: built by one caller on the run's workers; then
 * read-only.
 *
 * The directions of a cell's importons form a histogram (incident_light). Far from a window they are too alike for its
 * bins, but the importons' lines all pass the window. The point nearest to these lines, and their distances from it,
 * give a ball; paths are sent into cones around the ball. */
#ifndef AFTERGLOW_ONWARD_WAYS_H
#define AFTERGLOW_ONWARD_WAYS_H

#include "incident_light.h"

/* A ball that most lines of a cell pass. radius 0: there is none. */
typedef struct ways_opening {
    vec3 center;
    float radius;
} ways_opening;

typedef struct onward_ways {
    photon_tree importons;     /* owned, with its blocks */
    incident_light histograms; /* borrows the tree */
    ways_opening *openings;    /* owned, one for each histogram */
} onward_ways;

/* Takes over the importons, also on failure. They come from photon_records_create and have the position, the normal (on
 * the side of the surface that they reached) and the direction of photons. Without importons no path is guided. Errors:
 * AG_ERROR_MEMORY, AG_CANCELLED. */
ag_status onward_ways_create(run_context *run, photon *importons, uint32_t count, onward_ways *out_ways);
void onward_ways_reset(onward_ways *ways);

enum { ONWARD_CONES_MAX = 12 };

/* The density of directions in which light goes on from a point. */
typedef struct onward_guide {
    incident_guide by_histogram; /* of the point's cell; counts where there are no cones */
    /* Nested cones around towards.z, each with its share of the directions. */
    uint32_t cone_count;
    frame towards;
    float one_minus_cos[ONWARD_CONES_MAX], sine_squared[ONWARD_CONES_MAX], share[ONWARD_CONES_MAX];
} onward_guide;

/* Finds the density at a point; returns false where nothing is known there. normal: unit, on the side of the incident
 * light. */
bool onward_ways_find(const onward_ways *ways, vec3 position, vec3 normal, onward_guide *out_guide);

/* Samples a direction by that density, unit; it may lie below the surface. u: uniform numbers of [0, 1)^2. */
vec3 onward_guide_sample(const onward_guide *guide, vec2 u);

/* Returns that density, per solid angle. direction: unit. */
float onward_guide_density(const onward_guide *guide, vec3 direction);

/* Returns the ratio of the density to the cosine's in the direction of most importons; 1 for a histogram. */
float onward_guide_gain(const onward_guide *guide);

#endif
