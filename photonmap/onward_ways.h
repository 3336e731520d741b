/* onward_ways.h: by which ways light goes on from diffuse surfaces to where it is asked for, as importons tell that
 * came from there. Rests on: Peter, Pietrek, "Importance Driven Construction of Photon Maps", 1998 (photons scattered
 * towards where importons came from); Veach, Guibas, "Optimally Combining Sampling Techniques", 1995 (the mixture's
 * density). Flow: the eye's importons -> [here] -> photon_path. Threads: built by one caller on the run's workers; then
 * read-only.
 *
 * Near by, the ways of a cell of importons are a histogram (incident_light). Far from a window they are a bundle too
 * thin for its bins, but straight lines that all pass the window: the point that is nearest to these lines, and how far
 * off they pass it, make a ball, and cones around it are where paths are sent. */
#ifndef AFTERGLOW_ONWARD_WAYS_H
#define AFTERGLOW_ONWARD_WAYS_H

#include "incident_light.h"

/* A ball that most ways of a cell pass. radius 0: there is none. */
typedef struct ways_opening {
    vec3 center;
    float radius;
} ways_opening;

typedef struct onward_ways {
    photon_tree importons;     /* owned, with its blocks */
    incident_light histograms; /* borrows the tree */
    ways_opening *openings;    /* owned; one for each histogram */
} onward_ways;

/* Takes over the importons, from photon_records_create, on failure too: where they are, the side that they came to, and
 * the direction that they came by, as photons'. Without any, no path is led. Errors: AG_ERROR_MEMORY, AG_CANCELLED. */
ag_status onward_ways_create(run_context *run, photon *importons, uint32_t count, onward_ways *out_ways);
void onward_ways_reset(onward_ways *ways);

enum { ONWARD_CONES_MAX = 12 };

/* What is known of the ways on from a point, as a density of directions. */
typedef struct onward_lead {
    incident_guide guide;
    /* Cones within each other, around towards.z, that have these shares; 0 of them: the guide tells alone. */
    uint32_t cone_count;
    frame towards;
    float one_minus_cos[ONWARD_CONES_MAX], sine_squared[ONWARD_CONES_MAX], share[ONWARD_CONES_MAX];
} onward_lead;

/* normal: unit, on the side that light arrives at. false: nothing is known there. */
bool onward_ways_find(const onward_ways *ways, vec3 position, vec3 normal, onward_lead *out_lead);

/* A direction by that density, unit; it may lie below the surface. u: uniform numbers of [0, 1)^2. */
vec3 onward_lead_sample(const onward_lead *lead, vec2 u);

/* That density, per solid angle. direction: unit. */
float onward_lead_density(const onward_lead *lead, vec3 direction);

/* How many times denser than by the cosine it is where most importons came from; 1 where a histogram tells. */
float onward_lead_gain(const onward_lead *lead);

#endif
