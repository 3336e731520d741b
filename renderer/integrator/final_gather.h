/* final_gather.h: indirect light at a diffuse vertex, by rays over its hemisphere that read the irradiance cache where
 * they end.
 * Rests on: Jensen 1996, 2001 ch. 8; Christensen 1999; Neilson, Yang, TR 04-21, 2004.
 * Threads: any number gather at once, each into its worker's batch. */
#ifndef AFTERGLOW_FINAL_GATHER_H
#define AFTERGLOW_FINAL_GATHER_H

#include "integrator/transport.h"

/* A hit that gathers, and how. */
typedef struct gather_request {
    const vertex *from;   /* the diffuse hit that gathers */
    const sampler *where; /* keys the random numbers, with path_vertex */
    int path_vertex;      /* the number of the hit in its path */
    uint32_t sample;      /* the number of the camera sample, see camera_sample.h */
    bool is_first;        /* the eye sees the hit, but for panes, directly */
    int scatterings_left; /* the most between the hit and the lamp, the hit's own included; >= 2. Photons' own
                             scatterings are bounded in their tracing */
    uint32_t count;       /* of rays */
    rgb throughput;       /* from the hit to the eye */
    float share; /* of the camera sample, (0, 1], which the throughput contains: the gathered light is bounded by this
                    share of a sample's bound */
} gather_request;

/* Sends the rays. final_gather_resolve adds what they find to the sample: throughput times the radiance, from the hit,
 * of light that met at least two surfaces before the eye, the last but one of them diffuse. Returns the cost of the
 * rays, as eye_worker_cost counts it. */
uint32_t final_gather(const transport *t, eye_worker *worker, const gather_request *request);

/* Gets all irradiance that the worker's gather rays ask for, follows the light of those that get none, and adds the
 * gathers that are over to their samples. Once the run is cancelled the samples are not to be used. */
void final_gather_resolve(const transport *t, eye_worker *worker);

#endif
