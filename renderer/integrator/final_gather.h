/* final_gather.h: indirect light at a diffuse place, by rays over its hemisphere that read the irradiance cache where
 * they end.
 * Rests on: Jensen 1996, 2001 ch. 8; Christensen 1999; Neilson, Yang, TR 04-21, 2004.
 * Threads: any number gather at once, each into its worker's batch. */
#ifndef AFTERGLOW_FINAL_GATHER_H
#define AFTERGLOW_FINAL_GATHER_H

#include "integrator/transport.h"

/* Sends the rays; what they find is added to the sample under way by final_gather_resolve: throughput times
 * the radiance, from this place, of light that met at least two surfaces before the eye, the last but one of them
 * diffuse. path_vertex: which of its path's, for random numbers; is_first: the eye sees it, but for panes, directly.
 * scatterings_left: how many there may be between here and the lamp, this one included; >= 2. Those of the photons
 * themselves are bounded where they are traced. share: of the camera sample, (0, 1], which the throughput contains;
 * what is brought is bounded by so much of what bounds a sample. */
void final_gather(const transport *t, eye_worker *worker, const vertex *v, const sampler *where, int path_vertex,
                  bool is_first, int scatterings_left, uint32_t count, rgb throughput, float share);

/* Gets all irradiance that the worker's gather rays ask for, follows the light of those that get none, and adds the
 * gathers that are over to their samples. Nothing is right any more once the run is cancelled. */
void final_gather_resolve(const transport *t, eye_worker *worker);

#endif
