/* gather_batch.h: a worker's gather rays that have ended and wait for the irradiance at their ends. A batch holds many
 * rays, so that irradiances are looked up, and computed where they are missing, in the photon map's order instead of
 * the rays'.
 * Rests on: Neilson, Yang, TR 04-21, 2004; sorted requests, as in Pharr et al., "Rendering Complex Scenes with
 * Memory-Coherent Ray Tracing", 1997.
 * Flow: final_gather adds rays; sample_queue takes each sample's light when it is complete. Threads: a batch belongs to
 * one worker.
 *
 * The moment at which a batch is resolved depends on the worker's other work, and must not change the picture. Each
 * gather therefore has two sums of its own, each in ray order: of the light that the rays brought themselves, and of
 * the light read from the cache. The two are added once, and a sample's gathers are added in their order. */
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
    int scatterings_left; /* the most between the lamp and the ray's last start; >= 1 */
} gather_end;

/* Where the light of a gather ray is asked for: on the side of a surface that the ray has met, and on the far side of
 * one that light comes through. */
enum { GATHER_ENDS_MAX = 2 };
typedef struct gather_ends {
    int count;
    gather_end end[GATHER_ENDS_MAX];
    rgb weight[GATHER_ENDS_MAX]; /* of the irradiance there, 1/sr */
} gather_ends;

/* Keeps one of two ends, by chance, in proportion to their weights. u: [0, 1). */
void gather_ends_pick(gather_ends *in_out_ends, float u);

/* All rays from one diffuse vertex of a camera path. */
typedef struct gather {
    rgb throughput;  /* from the vertex to the eye, over the number of rays */
    rgb known, read; /* radiance, W/m^2/sr: that rays brought themselves, and that was read from the cache */
    float most;      /* bound on a component of what the gather brings the eye; INFINITY: none */
    float known_squares, read_squares; /* sums of the squares of what single rays brought (gather_query_rest.known): of
                                          rays without a query, and of the others; two sums for the reason above */
    uint32_t ray_count;                /* those that brought nothing included */
    uint32_t sample;                   /* the number of its sample, see camera_sample.h */
    uint32_t query_end;                /* the end of its queries, which begin at the last gather's end */
    bool is_first;                     /* the vertex is what the eye sees */
    uint64_t key;                      /* of the random numbers of its rays' detours */
} gather;

/* The rest of a query: of its end, and the number of its ray in the gather. */
typedef struct gather_query_rest {
    float epsilon;
    uint32_t medium, number;
    int scatterings_left;
    float known;        /* mean of the three colours of what the ray brought itself */
    bool is_second_end; /* of the ray of the query before */
} gather_query_rest;

/* The way, by further bounces, to the light of a query without an answer. */
typedef struct gather_detour {
    uint32_t query, number;
    uint64_t key;
    gather_end end;
    rgb weight;       /* of the irradiance at the end, 1/sr */
    float share_seen; /* the share of the gather's radiance that reaches the eye */
} gather_detour;

/* The light that a sample's gather rays have found. */
typedef struct gathered_light {
    rgb first, behind; /* radiance at the eye: of the first surface itself, and by way of its traced lobes */
    float variance;    /* of the mean of the three colours of both, estimated from ray to ray */
} gathered_light;

typedef struct gather_batch {
    uint32_t query_count, gather_count;
    bool is_open;        /* the last gather still sends rays */
    float most_indirect; /* bound on a component of what a sample's gathers bring the eye; INFINITY: none */
    irradiance_query queries[IRRADIANCE_BATCH_MAX];
    rgb weights[IRRADIANCE_BATCH_MAX];    /* of the irradiance, 1/sr */
    rgb irradiance[IRRADIANCE_BATCH_MAX]; /* W/m^2 */
    bool holds[IRRADIANCE_BATCH_MAX];     /* whether there is one */
    gather_query_rest rests[IRRADIANCE_BATCH_MAX];
    gather_detour detours[GATHER_BATCH_DETOURS]; /* under way, and their queries: */
    irradiance_query detour_queries[GATHER_BATCH_DETOURS];
    rgb detour_irradiance[GATHER_BATCH_DETOURS];
    bool detour_holds[GATHER_BATCH_DETOURS];
    gather gathers[GATHER_BATCH_GATHERS];
    gathered_light gathered[GATHER_BATCH_SAMPLES]; /* of the samples under way, by gathers that have ended */
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

/* Begin a gather of that many rays in a batch that has room, and end it. known: the sum of what its rays brought
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
        (gather_query_rest){end->point.epsilon, end->medium, number, end->scatterings_left, known, false};
    b->weights[b->query_count++] = weight;
}

/* Asks for the irradiance at all ends of a ray, one at least, in a batch that has room for them. known, as above,
 * counts with the first. */
static inline void gather_batch_ask_all(gather_batch *b, const gather_ends *ends, uint32_t number, float known)
{
    for (int i = 0; i < ends->count; i++) {
        gather_batch_ask(b, &ends->end[i], number, ends->weight[i], i == 0 ? known : 0.0f);
        b->rests[b->query_count - 1].is_second_end = i > 0;
    }
}

/* Notes a ray of the open gather that asks for nothing. */
static inline void gather_batch_note(gather_batch *b, float known)
{
    b->gathers[b->gather_count - 1].known_squares += known * known;
}

/* Makes detours for up to GATHER_BATCH_DETOURS queries without an answer, from query *in_out_query on, and sets that to
 * the query to continue with. The queries get weight 1 and irradiance 0, to which detours add. Returns the number of
 * detours; 0 when no query is left. */
uint32_t gather_batch_make_detours(gather_batch *b, uint32_t *in_out_query);

/* Adds the gathers that have ended to their samples, once all queries are answered. An open gather stays. */
void gather_batch_sum(gather_batch *b);

#endif
