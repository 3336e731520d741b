/* gather_path.h: the way of a gather ray from what it meets first to where its light is asked for.
 * Rests on: Jensen 2001, ch. 8; Christensen 1999; Neilson, Yang, TR 04-21, 2004.
 * Flow: final_gather -> [here] -> gather_batch. Threads: pure but for the worker's counters. */
#ifndef AFTERGLOW_GATHER_PATH_H
#define AFTERGLOW_GATHER_PATH_H

#include "integrator/transport.h"

/* Follows a gather ray that has met *v: through traced lobes, and by a bounce more where it is still too near for the
 * cache. scatterings_left: how many there may be between the ray's start and the lamp; >= 1. throughput: what the light
 * behind the ray is multiplied by; share_seen: how much of that again reaches the eye. Adds to *in_out_known what
 * direct light and caustics on the way bring. Returns true where there is more light: the irradiance at each of
 * *out_ends times its weight. Lamps and environments that the ray meets add nothing: their light is direct light where
 * it comes straight, and in the caustic map where it comes by way of traced lobes. But where the
 * ray has bounced on a diffuse surface, what it meets straight from there adds to *in_out_known, weighted against the
 * shadow rays of that bounce; and behind a point where a medium has scattered the ray it is followed as a path tracer's
 * up to the next diffuse surface: shadow rays, and lamps that it meets, add to *in_out_known. */
bool gather_path_follow(const transport *t, eye_worker *worker, vertex *v, rng random, int scatterings_left,
                        rgb throughput, float share_seen, rgb *in_out_known, gather_ends *out_ends);

/* Replaces the irradiance at an end where no estimate holds by that of one more bounce. Adds to *in_out_known what
 * direct light and caustics bring at the end and on the way, lamps and skies that the bounce meets straight among them,
 * times *in_out_weight. Returns true where there is more
 * light: the irradiance at the new end times the new weight. The weight decides the probability of roulette. */
bool gather_path_bounce(const transport *t, eye_worker *worker, rng random, float share_seen, gather_end *in_out_end,
                        rgb *in_out_weight, rgb *in_out_known);

/* Makes a white Lambertian surface at an end: the radiance that leaves it is the irradiance over pi. */
void gather_end_make_white(const gather_end *end, vertex *out_vertex);

#endif
