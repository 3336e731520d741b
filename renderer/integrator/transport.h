/* transport.h: what the eye's side reads while tiles are rendered, and what each worker has of its own.
 * Flow: render.c fills it; shading, final gather, direct lighting and path tracing read it.
 * Threads: a transport is read-only while tiles run, but for the slots behind the irradiance cache; an eye_worker
 * belongs to one worker. */
#ifndef AFTERGLOW_TRANSPORT_H
#define AFTERGLOW_TRANSPORT_H

#include "afterglow/afterglow.h"
#include "arena.h"
#include "film/aov.h"
#include "incident_light.h"
#include "integrator/direct_guide.h"
#include "integrator/gather_batch.h"
#include "integrator/path_settings.h"
#include "integrator/sampler.h"
#include "integrator/vertex.h"
#include "medium/medium_roulette.h"

typedef struct transport {
    const scene *s;
    run_context *run;                 /* whether to stop */
    const photon_map *caustic;        /* may be empty */
    irradiance_cache *cache;          /* over the global map; NULL for path tracing */
    const incident_light *incident;   /* over the global map: guides gathers; NULL: nothing guides */
    const direct_guide *direct_guide; /* guides shadow rays; NULL: nothing does */
    const ag_render_settings *settings;
    split_counts split;        /* of all samples; where blocks choose, of the first */
    uint32_t ray_bits;         /* no sample has more than 2^this gather rays */
    const aov_layout *layout;  /* what the film wants beside radiance */
    bool wants_layers;         /* of each sample: more than its radiance */
    bool wants_groups;         /* light by the groups of its lamps */
    bool has_lights;           /* there are lights with power */
    bool can_meet_lights;      /* there are area or infinite lights, which scattered rays find */
    bool media_are_bounded;    /* max_depth bounds scatterings by media too (settings_bound_media) */
    bool panes_are_direct;     /* there are panes, and light straight through them is direct light (bsdf.h) */
    float pixel_share;         /* the share of a pixel that textures are filtered over for a sample; 0: they are not */
    float gather_min_distance; /* a gather ray that hits nearer than this does not use the cache, scene units */
} transport;

/* Returns whether emission and direct light are asked for too, not indirect light alone. */
static inline bool transport_wants_all_light(const transport *t) { return t->settings->only == AG_ONLY_ALL; }

typedef struct eye_worker {
    _Alignas(64) unsigned index;        /* the worker's */
    uint64_t rays_camera, rays_further; /* samples' own camera rays, and further ones */
    uint64_t rays_shadow, rays_gather, rays_path;
    uint64_t rays_estimate;                /* of photon estimates and lookups at the point itself */
    uint64_t estimates_caustic;            /* estimates of the caustic map's light */
    uint64_t camera_rays_met;              /* those that met a surface or were scattered in a medium */
    uint64_t samples_not_finite, rays_cut; /* cut by TRANSMITTANCE_CROSSINGS_MAX */
    arena *scratch;                        /* for neighbours; what render.c has tried out beforehand always fits */
    gather_batch *batch;                   /* of the samples under way; NULL for path tracing */
    struct sample_queue *queue;            /* those samples */
    uint64_t uncharged_cost;               /* of what is not charged to a sample: detours of gather rays, and layers */
} eye_worker;

/* Returns room for the photons of an estimate of the map, which arena_restore gives back. */
static inline photon_neighbor *eye_worker_neighbors(eye_worker *worker, const photon_map *map)
{
    return arena_alloc(worker->scratch, photon_map_scratch_count(map) * sizeof(photon_neighbor));
}

/* The cost of a worker's rays so far in quarters of a gather ray's time, as measured in five rooms. Detours are left
 * out: they do not belong to the sample under way. A camera ray's cost includes the sample's whole way into the film, a
 * path ray's the shading of the vertex that it meets. */
enum {
    EYE_COST_OF_RAY = 4,
    EYE_COST_OF_CAMERA_RAY = 24,
    EYE_COST_OF_FURTHER_RAY = 8,
    EYE_COST_OF_PATH_RAY = 8,
    EYE_COST_OF_CAUSTIC = 32
};
static inline uint64_t eye_worker_cost(const eye_worker *w)
{
    return EYE_COST_OF_CAMERA_RAY * w->rays_camera + EYE_COST_OF_FURTHER_RAY * w->rays_further +
           EYE_COST_OF_PATH_RAY * w->rays_path + EYE_COST_OF_RAY * (w->rays_shadow + w->rays_gather) +
           w->rays_estimate + EYE_COST_OF_CAUSTIC * w->estimates_caustic - w->uncharged_cost;
}

/* The numbers of samples that direct light takes at a diffuse vertex. */
typedef struct sample_counts {
    int light;                 /* towards lamps */
    int scatter;               /* by scattering, 0 where that cannot meet a lamp */
    float scatter_probability; /* a single sample by scattering is taken with this probability; else 1 */
} sample_counts;
/* Returns one sample by scattering for every four towards lamps. For fewer of these, one is taken at a path's first
 * surface (is_first), and one by chance behind it, where a sample costs as much and brings less. */
sample_counts transport_sample_counts(const transport *t, uint32_t lights, bool is_first);

/* Follows a ray of unit direction to the first surface that scatters. */
bool transport_trace(const transport *t, eye_worker *worker, scene_ray ray, vertex *out_vertex);

/* Follows a ray of a path of light as transport_trace does, but where a medium on the way scatters light the vertex may
 * be a point in it: see transmittance_travel. carried, u: decide that; they count in scenes alone that have such media
 * (has_scattering_media). Returns whether there is a vertex. */
bool transport_travel(const transport *t, eye_worker *worker, scene_ray ray, rgb carried, vec2 u, vertex *out_vertex);

/* transport_travel in two steps, as transport_meet and transport_complete are those of transport_trace. It draws from
 * the random numbers in scenes alone that have media which scatter. */
bool transport_travel_to(const transport *t, eye_worker *worker, scene_ray ray, rgb carried, rng *random,
                         vertex *out_vertex);

/* transport_trace in two steps, for callers that may not need the second: transport_meet finds the hit, and
 * transport_complete how the vertex scatters and whether it shines. */
bool transport_meet(const transport *t, eye_worker *worker, scene_ray ray, vertex *out_vertex);
void transport_complete(const transport *t, vertex *in_out_vertex);

/* Follows a ray as transport_trace does, and straight through panes where they are direct. out_vertex->transmittance
 * includes the panes; hit.distance is the last stretch's. Returns false also where no light is left. */
bool transport_trace_through_panes(const transport *t, eye_worker *worker, scene_ray ray, vertex *out_vertex);

/* Returns whether a sample of the vertex counts as no scattering where it is_straight. */
static inline bool transport_is_open_pane(const transport *t, const vertex *v)
{
    return t->panes_are_direct && v->scattering.is_pane;
}

/* Returns the ray that leaves a vertex by scattering. From the first lobe on that is not smooth, rays pass slabs
 * straight (slab_faces.h), as shadow rays and photons do; what the eye sees directly, or in mirrors, is refracted. */
static inline scene_ray transport_scattered_ray(const transport *t, const vertex *v, vec3 direction, bool is_delta)
{
    scene_ray ray = vertex_ray(v, direction);
    ray.slabs_are_panes = ray.slabs_are_panes || (t->panes_are_direct && !is_delta);
    return ray;
}

/* Returns the cone over which textures are filtered along the ray of a sample of the vertex. */
ray_cone transport_scattered_cone(const transport *t, const vertex *v, const bsdf_sample *next);

/* Returns the cone of gather rays, for which no sample of the vertex tells a density. */
static inline ray_cone transport_gather_cone(const vertex *v)
{
    const ray_cone *c = &v->arrived.cone;
    return ray_cone_is_wide(c) ? (ray_cone){fabsf(c->width), RAY_CONE_DIFFUSE_SPREAD, true} : *c;
}

/* Roulette: returns whether a path with this throughput goes on, as all do that have this level at least; fainter ones
 * that survive have it then. level: > 0. u: a random number in [0, 1). */
static inline bool transport_survives(rgb *in_out_throughput, float level, float u)
{
    float survival = float_min(rgb_max(*in_out_throughput) / level, 1.0f);
    if (u >= survival)
        return false;
    *in_out_throughput = rgb_scale(*in_out_throughput, 1.0f / survival);
    return true;
}

/* Returns the caustic map's light at a diffuse vertex: reflected radiance. */
rgb transport_caustics(const transport *t, eye_worker *worker, const vertex *v);

/* Returns the probability with which the map is to be asked for caustics of which this share, [0, 1], is seen. */
float transport_caustic_probability(const transport *t, float share_seen);

/* Returns an estimate of transport_caustics, right on average, that asks the map with this probability. u: a random
 * number in [0, 1). */
rgb transport_some_caustics(const transport *t, eye_worker *worker, const vertex *v, float probability, float u);

#endif
