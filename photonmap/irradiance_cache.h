/* irradiance_cache.h: the irradiance at a point, from the nearest irradiance photon, computed at most once.
 * Rests on: Neilson, Yang, TR 04-21, 2004 (on demand); Christensen 1999 (precomputed, and the nearest-photon lookup).
 * Flow: final gathering requests; the photon map's estimates answer. Threads: any number request at once.
 *
 * A value is a pure function of the finished map and the irradiance photon's index, and all threads use the value that
 * the slot's bits decode to. Neither the mode, nor the thread that computed a value, nor its time can therefore change
 * the picture. */
#ifndef AFTERGLOW_IRRADIANCE_CACHE_H
#define AFTERGLOW_IRRADIANCE_CACHE_H

#include "claim_owners.h"
#include "irradiance_estimate.h"

/* Most points of irradiance_cache_get_many. */
enum { IRRADIANCE_BATCH_MAX = 1 << 16 };

typedef enum irradiance_cache_mode {
    IRRADIANCE_ON_DEMAND,  /* the first request computes */
    IRRADIANCE_PRECOMPUTE, /* all are computed before rendering */
    IRRADIANCE_UNCACHED    /* an estimate at every requested point: another estimator, without the mosaic */
} irradiance_cache_mode;

/* The counters of one worker, summed at the end. Aligned to cache lines, since they change all the time. */
typedef struct irradiance_counters {
    _Alignas(64) uint64_t requests; /* points requested */
    uint64_t computed;              /* estimates at photons, published */
    uint64_t deferred;              /* requests that met a claim of another thread and were set aside */
    uint64_t waited;                /* deferred requests that had to wait in the end */
    uint64_t duplicated;            /* estimates whose claim another process had taken over meanwhile: 0, unless this
                                       process stood still for seconds */
    uint64_t reclaimed;             /* claims taken over from processes that died or stood still */
    uint64_t uncached;              /* estimates at the point itself */
    uint64_t refused;               /* requests for points where no estimate holds */
    uint64_t rays;                  /* cast by estimates and lookups, to find where surfaces end and what is in sight */
    uint64_t timed;                 /* estimates that were timed */
    double timed_seconds;           /* CPU time of these */
    double waited_seconds;          /* CPU time of waiting */
} irradiance_counters;

/* The scratch memory of one worker: for an estimate its neighbours; for a batch the leaves of its queries, their order
 * by these, and what has been found for them. */
typedef struct irradiance_scratch {
    photon_neighbor *neighbors;
    photon_search_hint hint;
    uint32_t *leaves;         /* [IRRADIANCE_BATCH_MAX] */
    uint64_t *order[2];       /* of the queries, sorted from one to the other */
    float *distances_squared; /* from each query, in that order, to the irradiance photon that stands for it */
} irradiance_scratch;

/* The counters of one worker that any thread may read while it works; relaxed, since they order nothing else. */
typedef struct irradiance_shown {
    _Alignas(64) atomic_u64 requests; /* as of the last batch */
    atomic_u64 computed;
} irradiance_shown;

typedef struct irradiance_cache {
    photon_map *map; /* borrowed; only its slots change */
    irradiance_cache_mode mode;
    unsigned worker_count;
    irradiance_counters *counters; /* [worker_count] */
    irradiance_shown *shown;       /* [worker_count] */
    irradiance_scratch *scratch;   /* [worker_count] */
    claim_owners *owners;          /* borrowed; NULL unless other processes fill the map too */
    uint64_t ready_before;         /* photons that were ready when the cache was created */
} irradiance_cache;

/* Borrows the map. Errors: AG_ERROR_MEMORY. */
ag_status irradiance_cache_create(photon_map *map, irradiance_cache_mode mode, unsigned worker_count,
                                  irradiance_cache *out_cache);
/* Declares, before the first request, that other processes fill the map too. Borrows owners. */
void irradiance_cache_share(irradiance_cache *cache, claim_owners *owners);
void irradiance_cache_reset(irradiance_cache *cache);

/* Computes all irradiance photons that are not ready. Errors: AG_CANCELLED. */
ag_status irradiance_cache_precompute(irradiance_cache *cache, run_context *run);

/* Save the slots that are ready, one word for each irradiance photon, 0 for others; and restore them into a cache over
 * the same map, where they count as ready before. Not to be called while requests are under way. */
void irradiance_cache_save(const irradiance_cache *cache, uint32_t *out_words);
void irradiance_cache_restore(irradiance_cache *cache, const uint32_t *words);

/* A point, and the side of the unit normal. */
typedef struct irradiance_query {
    vec3 position, normal;
} irradiance_query;

typedef struct irradiance_request {
    irradiance_query query;
    uint32_t irradiance_photon; /* PHOTON_NONE: the request is answered */
    bool holds;     /* whether there is an irradiance; else the caller follows the light itself by another bounce */
    rgb irradiance; /* W/m^2; 0 where none holds */
} irradiance_request;

/* Requests the irradiance at a point, on the side of the unit normal. On return the request is answered
 * (request->irradiance_photon is PHOTON_NONE); or another thread is computing it, and the caller goes on with other
 * work and calls irradiance_cache_retry later. Where the nearest photon's irradiance does not reach
 * (photon_map_may_hold), an estimate at the point itself answers. There is no irradiance where no estimate holds at
 * that photon (irradiance_estimate.h), or where the point has to see the photon and does not. */
void irradiance_cache_get(irradiance_cache *cache, vec3 position, vec3 normal, unsigned worker_index,
                          irradiance_request *out_request);

/* Answers a request that was set aside; waits for the claimer if it is still computing. If the run (which may be NULL)
 * is cancelled meanwhile, there is no irradiance. It always ends: a claim is held only while computing, a claimer takes
 * no other claim meanwhile, and the claim of a dead one is taken over. */
void irradiance_cache_retry(irradiance_cache *cache, const run_context *run, irradiance_request *request,
                            unsigned worker_index);

/* Requests the irradiance at up to IRRADIANCE_BATCH_MAX points, in the map's order, so that consecutive lookups and
 * estimates lie near each other. Those that another thread is computing are set aside and finished last. Afterwards all
 * are answered, unless the run is cancelled. out_irradiance and out_holds: [count], as in irradiance_request. */
void irradiance_cache_get_many(irradiance_cache *cache, run_context *run, const irradiance_query *queries,
                               uint32_t count, unsigned worker_index, rgb *out_irradiance, bool *out_holds);

/* Returns the sum of all workers' counters. */
irradiance_counters irradiance_cache_counters(const irradiance_cache *cache);

/* Reads the numbers of irradiances requested, in whole batches, and computed at photons, so far. Any thread may call it
 * at any time. */
void irradiance_cache_look(const irradiance_cache *cache, uint64_t *out_requests, uint64_t *out_computed);

/* Returns the CPU seconds of all estimates, extrapolated from those that were timed. */
double irradiance_counters_estimate_seconds(const irradiance_counters *counters);

/* Counts the irradiance photons whose slots are ready now and were not at creation. In a shared map this includes those
 * of other processes. */
uint64_t irradiance_cache_distinct(const irradiance_cache *cache);

#endif
