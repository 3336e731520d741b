/* debug_views.c: see debug_views.h. */
#include "integrator/debug_views.h"

#include "parallel_for.h"

enum { GATHER_RAYS = 32 };

typedef struct views_job {
    const transport *t;
    eye_worker *workers;
    ag_film *film;
} views_job;

static void put(const views_job *job, film_view view, size_t pixel, float value)
{
    float *plane = job->film->views[view];
    if (plane)
        plane[pixel] = value;
}

/* Returns the number of photons per area, of those that an estimate would take; the disc is not cut off at edges. */
static float photon_density(const photon_map *map, eye_worker *worker, const map_point *at)
{
    if (map->set.count == 0)
        return 0.0f;
    arena_mark mark = arena_save(worker->scratch);
    photon_neighbor *neighbors = eye_worker_neighbors(worker, map);
    float other_squared, radius_squared = map->max_radius * map->max_radius;
    uint32_t found = photon_tree_k_nearest(&map->tree, at->position, at->facing_normal, PHOTON_ESTIMATE_MIN_COS,
                                           map->max_radius, map->nearest + 1, neighbors, &other_squared);
    if (found == map->nearest + 1) {
        found = map->nearest;
        radius_squared = photon_neighbor_distance_squared(neighbors[found]);
    }
    arena_restore(worker->scratch, mark);
    return (float)found / (AG_PI * float_max(radius_squared, map->min_radius_squared));
}

/* Returns the harmonic mean of how far gather rays go: near points weigh most, as they do for the light. */
static float gather_distance(const transport *t, eye_worker *worker, const vertex *v, const sampler *where)
{
    float sum = 0.0f;
    int count = 0;
    for (uint32_t i = 0; i < GATHER_RAYS; i++) {
        bsdf_sample first;
        vertex met;
        if (!bsdf_sample_direction(&v->scattering, BSDF_GATHERED, BSDF_RADIANCE,
                                   sampler_2d_of(where, SAMPLE_LOBE, 0, GATHER_RAYS, i).x,
                                   sampler_2d_of(where, SAMPLE_GATHER, 0, GATHER_RAYS, i), &first))
            continue;
        count++;
        if (transport_trace(t, worker, transport_scattered_ray(t, v, first.direction, false), &met))
            sum += 1.0f / float_max(met.hit.distance, 1e-20f);
    }
    return sum > 0.0f ? (float)count / sum : 0.0f;
}

static void view_pixel(const views_job *job, eye_worker *worker, size_t pixel, int x, int y)
{
    const transport *t = job->t;
    float width = (float)t->settings->width, height = (float)t->settings->height;
    scene_ray ray = camera_generate_ray(&t->s->camera, ((float)x + 0.5f) / width, ((float)y + 0.5f) / height,
                                        width / height, (vec2){0.5f, 0.5f}, t->s->has_motion ? 0.5f : 0.0f);
    vertex v;
    if (!transport_trace(t, worker, ray, &v) || !bsdf_has(&v.scattering, BSDF_GATHERED))
        return;
    sampler where = sampler_make(t->settings->seed, x, y, 0, 0);
    if (job->film->views[VIEW_GATHER_DISTANCE])
        put(job, VIEW_GATHER_DISTANCE, pixel, gather_distance(t, worker, &v, &where));
    if (!t->cache)
        return;
    const photon_map *map = t->cache->map;
    map_point at = vertex_map_point(t->s, &v);
    if (job->film->views[VIEW_PHOTON_DENSITY])
        put(job, VIEW_PHOTON_DENSITY, pixel, photon_density(map, worker, &at));
    uint32_t nearest = photon_map_nearest(map, at.position, at.facing_normal, &worker->rays_estimate);
    if (nearest >= PHOTON_HIDDEN)
        return;
    uint32_t word = irradiance_slot_read(photon_map_slot(map, nearest));
    put(job, VIEW_CACHE_STATE, pixel, irradiance_word_is_ready(word) ? 2.0f : 1.0f);
    put(job, VIEW_PHOTON_DISTANCE, pixel,
        sqrtf(vec3_distance_squared(at.position, photon_block_position(map->irradiance_photons.blocks, nearest))));
}

static void view_rows(void *user, uint64_t begin, uint64_t end, uint64_t block, unsigned worker_index)
{
    (void)block;
    const views_job *job = user;
    const ag_film *film = job->film;
    for (uint64_t row = begin; row < end; row++)
        for (int x = 0; x < film->width; x++)
            view_pixel(job, &job->workers[worker_index], film_pixel_at(film, film->x0 + x, film->y0 + (int)row),
                       film->x0 + x, film->y0 + (int)row);
}

ag_status debug_views_render(const transport *t, run_context *run, eye_worker *workers, ag_film *film)
{
    views_job job = {t, workers, film};
    bool has_any = false;
    for (int i = 0; i < FILM_VIEW_COUNT; i++)
        has_any = has_any || (film->views[i] && i != VIEW_TILE_TIME);
    return has_any ? parallel_for(run, (uint64_t)film->height, 1, view_rows, &job, AG_PHASE_RENDER, 1.0, 1.0) : AG_OK;
}
