/* gather_batch.h: a worker's gather rays that have ended and wait for the irradiance there. They are many, so that
 * irradiances are looked up, and computed where they are missing, in the photon map's order instead of the rays'.
 * Rests on: Neilson, Yang, TR 04-21, 2004; sorted requests, as in Pharr et al., "Rendering Complex Scenes with
 * Memory-Coherent Ray Tracing", 1997. Flow: final_gather adds; sample_queue takes each sample's light when all is
 * there. Threads: a batch belongs to one worker.
 *
 * When a batch is resolved depends on what else the worker has done, and must not reach the picture: each gather has
 * sums of its own, one of what rays brought themselves and one of what was read, each in ray order; they are added
 * once, and gathers to their sample in their order. */
#ifndef AFTERGLOW_GATHER_BATCH_H
#define AFTERGLOW_GATHER_BATCH_H

#include "film/eye_sample.h"
#include "irradiance_cache.h"
#include "rays/rays.h"

enum { GATHER_BATCH_GATHERS = 1 << 14, GATHER_BATCH_SAMPLES = 1 << 14, GATHER_BATCH_DETOURS = 1 << 12 };

/* The end of a gather ray: irradiance is asked for there, and where none holds its light is followed on. */
typedef struct gather_end {
    surface_point point;  /* as the photons have it: when the shutter opens */
    uint32_t medium;      /* that the ray arrived in */
    int scatterings_left; /* there may be between the lamp and the ray's last start; >= 1 */
} gather_end;

/* All rays from one diffuse vertex of a camera path. */
typedef struct gather {
    rgb throughput;  /* from the vertex to the eye, over the number of rays */
    rgb known, read; /* radiance, W/m^2/sr: brought by short rays' own bounces, and what was read from the cache */
    float most;      /* of a component of what it brings the eye; INFINITY: no bound */
    float known_squares, read_squares; /* of what single rays brought, see known of gather_query_rest: of those that
                                          asked for nothing, and of the others; apart for the reason above */
    uint32_t ray_count;                /* of those that brought nothing, too */
    uint32_t sample;                   /* the number of its sample, see camera_sample.h */
    uint32_t query_end;                /* its queries go up to here, from where the last gather's end */
    bool is_first;                     /* the vertex is what the eye sees */
    uint64_t key;                      /* of the random numbers of its rays' detours */
} gather;

/* The rest of a query's end, and which of its gather's rays it is of. */
typedef struct gather_query_rest {
    float epsilon;
    uint32_t medium, number;
    int scatterings_left;
    float known; /* mean of the three colours of what the ray brought itself */
} gather_query_rest;

/* The way of light from a query that has no answer: by further bounces. */
typedef struct gather_detour {
    uint32_t query, number;
    uint64_t key;
    gather_end end;
    rgb weight;       /* of the irradiance at the end, 1/sr */
    float share_seen; /* of the gather's radiance, by the eye */
} gather_detour;

/* The light that a sample's gather rays have found. */
typedef struct gathered_light {
    rgb first, behind; /* radiance at the eye: where its ray met a surface first, and by way of traced lobes there */
    float variance;    /* of the mean of the three colours of both, from ray to ray: an estimate */
} gathered_light;

typedef struct gather_batch {
    uint32_t query_count, gather_count;
    bool is_open;        /* the last gather still sends rays */
    float most_indirect; /* of a component of what gathers bring the eye in one sample; INFINITY: no bound */
    irradiance_query queries[IRRADIANCE_BATCH_MAX];
    rgb weights[IRRADIANCE_BATCH_MAX];    /* of the irradiance, 1/sr */
    rgb irradiance[IRRADIANCE_BATCH_MAX]; /* W/m^2 */
    bool holds[IRRADIANCE_BATCH_MAX];     /* whether there is one */
    gather_query_rest rests[IRRADIANCE_BATCH_MAX];
    gather_detour detours[GATHER_BATCH_DETOURS]; /* those under way, and what they ask for: */
    irradiance_query detour_queries[GATHER_BATCH_DETOURS];
    rgb detour_irradiance[GATHER_BATCH_DETOURS];
    bool detour_holds[GATHER_BATCH_DETOURS];
    gather gathers[GATHER_BATCH_GATHERS];
    gathered_light gathered[GATHER_BATCH_SAMPLES]; /* by samples under way, in gathers that are over */
} gather_batch;

/* Returns an empty batch, or NULL when out of memory. */
gather_batch *gather_batch_create(float most_indirect);
void gather_batch_reset(gather_batch *b);   /* empty again, whatever it was left with */
void gather_batch_destroy(gather_batch *b); /* NULL is fine */

/* Returns whether there is room for one more gather, and for so many queries. */
static inline bool gather_batch_has_room(const gather_batch *b, uint32_t query_count)
{
    return b->query_count + query_count <= IRRADIANCE_BATCH_MAX && b->gather_count < GATHER_BATCH_GATHERS;
}

/* Begins a gather of so many rays, in a batch that has room, and ends it: known is the sum of what its rays brought
 * themselves. */
void gather_batch_begin(gather_batch *b, uint32_t sample, bool is_first, rgb throughput, float share,
                        uint32_t ray_count, uint64_t key);
void gather_batch_end(gather_batch *b, rgb known);

/* Asks for the irradiance at an end, for the open gather, in a batch that has room. number: of the ray; known: mean of
 * the three colours of what it brought already. */
static inline void gather_batch_ask(gather_batch *b, const gather_end *end, uint32_t number, rgb weight, float known)
{
    b->queries[b->query_count] = (irradiance_query){end->point.position, end->point.normal};
    b->rests[b->query_count] =
        (gather_query_rest){end->point.epsilon, end->medium, number, end->scatterings_left, known};
    b->weights[b->query_count++] = weight;
}

/* Notes a ray of the open gather that asks for nothing. */
static inline void gather_batch_note(gather_batch *b, float known)
{
    b->gathers[b->gather_count - 1].known_squares += known * known;
}

/* Makes detours of up to GATHER_BATCH_DETOURS queries without an answer, from the query *in_out_query on, which becomes
 * where to go on; their irradiance is 0, to be added to, and of weight 1. Returns how many they are: 0 when no query is
 * left. */
uint32_t gather_batch_make_detours(gather_batch *b, uint32_t *in_out_query);

/* Once all queries are answered: adds the gathers that are over to their samples; an open one stays, alone. */
void gather_batch_sum(gather_batch *b);

#endif
