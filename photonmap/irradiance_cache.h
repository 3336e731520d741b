/* irradiance_cache.h: the irradiance at a point, from the nearest irradiance photon, computed at most once.
 * Rests on: Neilson, Yang, TR 04-21, 2004 (on demand); Christensen 1999 (precomputed, and the nearest-photon lookup).
 * Flow: final gathering asks; the photon map's estimates answer. Threads: any number ask at once.
 *
 * A value is a pure function of the finished map and the irradiance photon's index, and all threads use what the slot's
 * bits decode to: so neither the mode nor who computed it, nor when, can reach the picture. */
#ifndef AFTERGLOW_IRRADIANCE_CACHE_H
#define AFTERGLOW_IRRADIANCE_CACHE_H

#include "claim_owners.h"
#include "irradiance_estimate.h"

/* Points that can be asked for at once. */
enum { IRRADIANCE_BATCH_MAX = 1 << 16 };

typedef enum irradiance_cache_mode {
    IRRADIANCE_ON_DEMAND,  /* the first to ask computes */
    IRRADIANCE_PRECOMPUTE, /* all are computed beforehand */
    IRRADIANCE_UNCACHED    /* an estimate at every point asked for: another estimator, without the mosaic */
} irradiance_cache_mode;

/* The counters of one worker, summed when all is done. They are padded apart, since they change all the time. */
typedef struct irradiance_counters {
    _Alignas(64) uint64_t requests; /* points asked for */
    uint64_t computed;              /* estimates at photons, published */
    uint64_t deferred;              /* requests that met a claim of another thread and were set aside */
    uint64_t waited;                /* of those, the ones that had to wait in the end */
    uint64_t duplicated;            /* estimates whose claim another process had taken over meanwhile: 0, unless this
                                       process stood still for seconds */
    uint64_t reclaimed;             /* claims taken over from processes that died or stood still */
    uint64_t uncached;              /* estimates at the point itself */
    uint64_t refused;               /* requests for points where no estimate holds */
    uint64_t rays;                  /* cast by estimates and lookups, to find where surfaces end and what is in sight */
    uint64_t timed;                 /* estimates whose time was taken */
    double timed_seconds;           /* CPU time of those */
    double waited_seconds;          /* CPU time of waiting */
} irradiance_counters;

/* The scratch memory of one worker: an estimate's neighbours, and the leaves of a batch's queries and the order by
 * them. */
typedef struct irradiance_scratch {
    photon_neighbor *neighbors;
    uint32_t *leaves;   /* [IRRADIANCE_BATCH_MAX] */
    uint64_t *order[2]; /* the same, from one to the other while it is sorted */
} irradiance_scratch;

/* Of one worker's counters those that anybody may read while it works; relaxed, since they order nothing else. */
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
    claim_owners *owners;          /* borrowed; of a map that other processes fill too, else NULL */
    uint64_t ready_before;         /* photons that were ready when the cache was created */
} irradiance_cache;

/* Borrows the map. Errors: AG_ERROR_MEMORY. */
ag_status irradiance_cache_create(photon_map *map, irradiance_cache_mode mode, unsigned worker_count,
                                  irradiance_cache *out_cache);
/* Tells, before the first request, that other processes fill the map too. Borrows. */
void irradiance_cache_share(irradiance_cache *cache, claim_owners *owners);
void irradiance_cache_reset(irradiance_cache *cache);

/* Computes what is not ready yet, at every irradiance photon. Errors: AG_CANCELLED. */
ag_status irradiance_cache_precompute(irradiance_cache *cache, run_context *run);

/* Saves the slots that are ready, a word for each irradiance photon, 0 where nothing is; and puts them back into a
 * cache over the same map, where they count as ready before. Not while anybody asks. */
void irradiance_cache_save(const irradiance_cache *cache, uint32_t *out_words);
void irradiance_cache_restore(irradiance_cache *cache, const uint32_t *words);

/* A point, and the side of the unit normal. */
typedef struct irradiance_query {
    vec3 position, normal;
} irradiance_query;

typedef struct irradiance_request {
    irradiance_query query;
    uint32_t irradiance_photon; /* PHOTON_NONE: the request has been answered */
    bool holds;     /* whether there is an irradiance: where none is, the caller has to follow the light itself */
    rgb irradiance; /* W/m^2; 0 where none holds */
} irradiance_request;

/* Asks for the irradiance at a point, on the side of the unit normal. Either it is answered (request->irradiance_photon
 * is PHOTON_NONE), or another thread is computing it: then it is to be asked for again with irradiance_cache_retry,
 * after the caller's other work. Where that photon's irradiance does not reach (photon_map_reaches), an estimate at the
 * point answers. Where no estimate holds (irradiance_estimate.h) at the photon that stands for the
 * point, or the point does not see that photon and would have to, the answer is that there is none. */
void irradiance_cache_get(irradiance_cache *cache, vec3 position, vec3 normal, unsigned worker_index,
                          irradiance_request *out_request);

/* Comes back to a request that was set aside; waits for the claimer where it still computes. Afterwards it is
 * answered, unless the run (which may be NULL) is cancelled meanwhile: then no irradiance holds. The claimer holds its
 * claim only while computing, and takes no other meanwhile; a dead one's is taken over: so this ends. */
void irradiance_cache_retry(irradiance_cache *cache, const run_context *run, irradiance_request *request,
                            unsigned worker_index);

/* Asks for the irradiance at up to IRRADIANCE_BATCH_MAX points at once, in the map's order: what is looked up and
 * computed one after the other lies near each other. Those that another thread is computing are set aside, and come
 * last. Afterwards all are answered, unless the run is cancelled meanwhile: then some are not. out_irradiance and
 * out_holds: [count], as in irradiance_request. */
void irradiance_cache_get_many(irradiance_cache *cache, const run_context *run, const irradiance_query *queries,
                               uint32_t count, unsigned worker_index, rgb *out_irradiance, bool *out_holds);

/* An estimate at the point itself, not kept; the value alone, also where it does not hold. */
rgb irradiance_cache_estimate(irradiance_cache *cache, vec3 position, vec3 normal, unsigned worker_index);

/* The counters of all workers. */
irradiance_counters irradiance_cache_counters(const irradiance_cache *cache);

/* How many irradiances have been asked for, in whole batches, and computed at photons, so far: any thread may ask at
 * any time. */
void irradiance_cache_look(const irradiance_cache *cache, uint64_t *out_requests, uint64_t *out_computed);

/* CPU seconds spent in all estimates, from those whose time was taken. */
double irradiance_counters_estimate_seconds(const irradiance_counters *counters);

/* Irradiance photons whose slots are ready now, less those that were so at creation: counted by looking at them. Of a
 * shared map, those too that other processes have made ready meanwhile. */
uint64_t irradiance_cache_distinct(const irradiance_cache *cache);

#endif
