/* gather_batch.h: a worker's gather rays that have ended and wait for the irradiance there: many, so that what they ask
 * for can be looked up, and where it is not there yet computed, in the photon map's order instead of the rays'.
 * Rests on: Neilson, Yang, TR 04-21, 2004; sorting what rays ask for, as Pharr et al., "Rendering Complex Scenes with
 * Memory-Coherent Ray Tracing", 1997. Flow: final_gather adds; sample_queue takes each sample's light when all is
 * there. Threads: a batch belongs to one worker.
 *
 * When a batch is resolved depends on what else the worker has done, and must not reach the picture: each gather has
 * two sums of its own, each in ray order; they are added once, and gathers to their sample in their order. */
#ifndef AFTERGLOW_GATHER_BATCH_H
#define AFTERGLOW_GATHER_BATCH_H

#include "integrator/eye_sample.h"
#include "irradiance_cache.h"

enum { GATHER_BATCH_GATHERS = 1 << 14, GATHER_BATCH_SAMPLES = 1 << 14 };

/* All rays from one diffuse place of a camera path. */
typedef struct gather {
    rgb throughput;     /* from the place to the eye, over the number of rays */
    rgb known, read;    /* radiance, W/m^2/sr: brought by short rays' own bounces, and what was read from the cache */
    uint32_t sample;    /* of those under way */
    uint32_t query_end; /* its queries go up to here, from where the last gather's end */
    bool is_first;      /* the place is what the eye sees */
} gather;

/* What a sample has gathered. */
typedef struct gathered_light {
    rgb first, behind; /* radiance at the eye: where its ray met a surface first, and by way of traced lobes there */
} gathered_light;

typedef struct gather_batch {
    uint32_t query_count, gather_count;
    bool is_open;        /* the last gather still sends rays */
    float most_indirect; /* of a component of what a gather brings the eye; INFINITY: no bound */
    irradiance_query queries[IRRADIANCE_BATCH_MAX];
    rgb weights[IRRADIANCE_BATCH_MAX];    /* of the irradiance, 1/sr */
    rgb irradiance[IRRADIANCE_BATCH_MAX]; /* W/m^2 */
    gather gathers[GATHER_BATCH_GATHERS];
    gathered_light gathered[GATHER_BATCH_SAMPLES]; /* by samples under way, in gathers that are over */
} gather_batch;

/* Empty; NULL when out of memory. */
gather_batch *gather_batch_create(float most_indirect);
void gather_batch_reset(gather_batch *b);   /* empty again, whatever it was left with */
void gather_batch_destroy(gather_batch *b); /* NULL is fine */

/* Whether there is room for one more gather, and so many queries. */
static inline bool gather_batch_has_room(const gather_batch *b, uint32_t query_count)
{
    return b->query_count + query_count <= IRRADIANCE_BATCH_MAX && b->gather_count < GATHER_BATCH_GATHERS;
}

/* Begins a gather, in a batch that has room, and ends it: known is the sum of what its rays brought themselves. */
void gather_batch_begin(gather_batch *b, uint32_t sample, bool is_first, rgb throughput);
void gather_batch_end(gather_batch *b, rgb known);

/* Asks for the irradiance at a place, for the open gather, in a batch that has room. */
static inline void gather_batch_ask(gather_batch *b, vec3 position, vec3 normal, rgb weight)
{
    b->queries[b->query_count] = (irradiance_query){position, normal};
    b->weights[b->query_count++] = weight;
}

/* Gets all irradiance that was asked for, and adds the gathers that are over to their samples; an open one
 * stays, alone. Nothing is right any more once the run is cancelled. */
void gather_batch_resolve(gather_batch *b, irradiance_cache *cache, const run_context *run, unsigned worker_index);

#endif
