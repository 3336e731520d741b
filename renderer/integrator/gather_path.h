/* gather_path.h: the way of a gather ray from what it meets first to where its light is asked for.
 * Rests on: Jensen 2001, ch. 8; Christensen 1999; Neilson, Yang, TR 04-21, 2004.
 * Flow: final_gather -> [here] -> gather_batch. Threads: pure but for the worker's counters. */
#ifndef AFTERGLOW_GATHER_PATH_H
#define AFTERGLOW_GATHER_PATH_H

#include "integrator/transport.h"

/* Follows a gather ray that has met *v: through traced lobes, and by a bounce more where it is still too near for the
 * cache. scatterings_left: how many there may be between the ray's start and the lamp; >= 1. throughput: what the light
 * behind the ray is multiplied by; share_seen: how much of that again reaches the eye. Adds to *in_out_known what
 * direct light and caustics on the way bring; true: the rest is the irradiance at out_end->point times *out_weight
 * (1/sr). Lamps and environments that the ray meets add nothing: light straight from them is direct light, light from
 * them by way of traced lobes is in the caustic map. */
bool gather_path_follow(const transport *t, eye_worker *worker, vertex *v, rng random, int scatterings_left,
                        rgb throughput, float share_seen, rgb *in_out_known, gather_end *out_end, rgb *out_weight);

/* Replaces the irradiance at an end where no estimate holds by what one bounce more brings: *in_out_known grows by what
 * direct light and caustics bring there and on the way, times `weight`; true: the rest is the irradiance at another end
 * times *in_out_weight. Roulette goes by how much that weight is. */
bool gather_path_bounce(const transport *t, eye_worker *worker, rng random, float share_seen, gather_end *in_out_end,
                        rgb *in_out_weight, rgb *in_out_known);

/* A white Lambertian surface at an end: the radiance that leaves it is the irradiance over pi. */
void gather_end_make_white(const gather_end *end, vertex *out_vertex);

#endif
