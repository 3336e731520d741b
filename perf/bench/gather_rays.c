/* gather_rays.c: the program afterglow-gather-rays: what a final gather's ray costs in all and by part, against what
 * Embree alone needs for the very same rays. Room 20 of the forty, or another scene; all take turns in one process on
 * one thread; medians of the rounds' ratios, as CSV.
 * The rays are those of some tiles of a picture of 400 x 400, 64 from each hit, guided as the renderer guides them;
 * all irradiance is there already. Embree casts them one by one (rtcIntersect1), and the renderer's ray_fan 64
 * together: sorted, then in packets. Where a scene has media, or normals that turn within a triangle, the renderer
 * leaves out some of these rays. Use: afterglow-gather-rays [SCENE.pbrt]. Flow: [here]. Threads: one. */
#define _GNU_SOURCE
#include "bench/room_bench.h"
#include "clock.h"
#include "floating_point.h"
#include "integrator/final_gather.h"
#include "integrator/gather_directions.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { PICTURE = 400, TILE = 32, TILES = 5, GATHER_RAYS = ROOM_BENCH_GATHER_RAYS, ESTIMATES = 20000 };
_Static_assert((int)GATHER_RAYS <= (int)RAY_FAN_MAX, "a hit's rays are one fan");
enum { HITS_MAX = TILES * TILE * TILE, RAYS_MAX = HITS_MAX * GATHER_RAYS };

typedef struct bench_hit {
    vertex v;
    sampler where;
    ray_fan fan; /* its rays */
} bench_hit;

typedef struct bench {
    scene *s;
    photon_map map, no_caustics;
    irradiance_cache cache;
    incident_light incident;
    ag_render_settings settings;
    transport t;
    eye_worker worker;
    bench_hit *hits; /* [hit_count] */
    scene_ray *rays;
    irradiance_query *queries; /* where the rays end */
    rgb *irradiance;
    bool *holds;
    uint32_t hit_count, ray_count, query_count;
    double sink; /* keeps the work from being optimised away */
} bench;

/* --- what is measured: each gives the number of operations --- */

static double embree(bench *b)
{
    for (uint32_t i = 0; i < b->ray_count; i++)
        b->sink += (double)scene_first_distance(b->s, b->rays[i]);
    return b->ray_count;
}

static double embree_together(bench *b)
{
    for (uint32_t i = 0; i < b->hit_count; i++) {
        scene_intersect_fan(b->s, &b->hits[i].fan);
        b->sink += (double)b->hits[i].fan.met[0].distance;
    }
    return b->ray_count;
}

static double whole(bench *b)
{
    uint64_t before = b->worker.rays_gather;
    for (uint32_t i = 0; i < b->hit_count; i++) {
        gather_request request = {.from = &b->hits[i].v,
                                  .where = &b->hits[i].where,
                                  .is_first = true,
                                  .scatterings_left = 98,
                                  .count = (uint32_t)b->t.settings->gather_samples,
                                  .throughput = rgb_gray(1.0f),
                                  .share = 1.0f};
        final_gather(&b->t, &b->worker, &request);
    }
    final_gather_resolve(&b->t, &b->worker);
    b->sink += (double)b->worker.batch->gathered[0].first.g;
    return (double)(b->worker.rays_gather - before);
}

static double lookups(bench *b)
{
    for (uint32_t i = 0; i < b->query_count; i += IRRADIANCE_BATCH_MAX) {
        uint32_t left = b->query_count - i, count = left < IRRADIANCE_BATCH_MAX ? left : IRRADIANCE_BATCH_MAX;
        irradiance_cache_get_many(&b->cache, b->t.run, b->queries + i, count, 0, b->irradiance, b->holds);
        b->sink += (double)b->irradiance[0].g;
    }
    return b->query_count;
}

/* Makes the rays as final_gather does. */
static void make_fan(const bench *b, const bench_hit *p, ray_fan *out_fan)
{
    const bsdf *scattering = &p->v.scattering;
    bool is_below = bsdf_is_below(scattering);
    vec3 side = is_below ? vec3_negate(scattering->shading.z) : scattering->shading.z;
    sampler_sequence sequence = sampler_sequence_make(&p->where, SAMPLE_GATHER, 0, GATHER_RAYS);
    incident_guide guide;
    bool is_guided = incident_light_find(&b->incident, vertex_map_point(b->t.s, &p->v).position, side, &guide);
    out_fan->common = vertex_ray(&p->v, vertex_facing_normal(&p->v));
    out_fan->common.skips_uv = true;
    out_fan->count = GATHER_RAYS;
    float u[2][RAY_FAN_MAX], weights[RAY_FAN_MAX];
    gather_numbers(&sequence, 0, GATHER_RAYS, u);
    if (is_guided)
        incident_guide_warp(&guide, GATHER_RAYS, u, weights);
    gather_directions(u, GATHER_RAYS, is_guided ? &guide.around : &scattering->shading, !is_guided && is_below,
                      out_fan->direction);
}

static double directions(bench *b)
{
    ray_fan fan;
    for (uint32_t i = 0; i < b->hit_count; i++) {
        make_fan(b, &b->hits[i], &fan);
        b->sink += (double)fan.direction[0][i % GATHER_RAYS];
    }
    return (double)b->hit_count * GATHER_RAYS;
}

static double fans(bench *b)
{
    ray_fan fan;
    for (uint32_t i = 0; i < b->hit_count; i++) {
        make_fan(b, &b->hits[i], &fan);
        scene_intersect_fan(b->s, &fan);
        for (uint32_t k = 0; k < GATHER_RAYS; k++) {
            surface_point at;
            if (fan.met[k].distance < INFINITY && ray_fan_plain_point(b->s, &fan, k, &at))
                b->sink += (double)at.position.x;
        }
    }
    return (double)b->hit_count * GATHER_RAYS;
}

static double hits(bench *b)
{
    for (uint32_t i = 0; i < b->ray_count; i++) {
        surface_hit hit;
        if (scene_intersect(b->s, b->rays[i], INFINITY, &hit))
            b->sink += (double)hit.position.x;
    }
    return b->ray_count;
}

static double estimates(bench *b)
{
    uint32_t step = b->map.set.count / ESTIMATES + 1, count = 0;
    for (uint32_t i = 0; i < b->map.set.count; i += step, count++)
        b->sink += (double)irradiance_estimate(&b->map, photon_block_position(b->map.blocks, i),
                                               direction_decode(photon_block_normal(b->map.blocks, i)),
                                               b->cache.scratch[0].neighbors)
                       .g;
    return count;
}

enum { EMBREE, EMBREE_TOGETHER, WHOLE, WHOLE_TO_TOGETHER, DIRECTIONS, FANS, HITS, LOOKUPS, ESTIMATE, ROWS };
static room_bench_row rows[ROWS] = {
    [EMBREE] = {.name = "Embree alone"},
    [EMBREE_TOGETHER] = {.name = "rays alone (64 together)"},
    [WHOLE] = {.name = "whole gather ray", .most_ratio = 2.4},
    [WHOLE_TO_TOGETHER] = {.name = "whole gather ray (against rays 64 together)", .rival = EMBREE_TOGETHER},
    [DIRECTIONS] = {.name = "direction"},
    [FANS] = {.name = "direction with ray and end (64 together)"},
    [HITS] = {.name = "ray and hit (alone)"},
    [LOOKUPS] = {.name = "lookup (warm cache)", .most_ratio = 1.0},
    [ESTIMATE] = {.name = "estimate (scattered)"},
};
static double (*const measured[ROWS])(bench *b) = {
    [EMBREE] = embree,
    [EMBREE_TOGETHER] = embree_together,
    [WHOLE] = whole,
    [WHOLE_TO_TOGETHER] = whole,
    [DIRECTIONS] = directions,
    [FANS] = fans,
    [HITS] = hits,
    [LOOKUPS] = lookups,
    [ESTIMATE] = estimates,
};

/* --- what they work on --- */

static void add_hit(bench *b, int x, int y)
{
    bench_hit *p = &b->hits[b->hit_count];
    p->where = sampler_make(0, x, y, 0, 0);
    scene_ray ray = camera_generate_ray(&b->s->camera, ((float)x + 0.5f) / PICTURE, ((float)y + 0.5f) / PICTURE, 1.0f,
                                        (vec2){0.5f, 0.5f}, 0.0f);
    if (!transport_trace(&b->t, &b->worker, ray, &p->v) || !bsdf_is_plain(&p->v.scattering))
        return;
    b->hit_count++;
    make_fan(b, p, &p->fan);
    for (uint32_t k = 0; k < GATHER_RAYS; k++) {
        ray = vertex_ray(&p->v, ray_fan_direction(&p->fan, k));
        ray.skips_uv = true;
        b->rays[b->ray_count++] = ray;
        vertex end;
        if (transport_trace(&b->t, &b->worker, ray, &end)) {
            map_point at = vertex_map_point(b->t.s, &end);
            b->queries[b->query_count++] = (irradiance_query){at.position, at.facing_normal};
        }
    }
}

static ag_status make_work(bench *b)
{
    b->hits = malloc(HITS_MAX * sizeof *b->hits);
    b->rays = malloc(RAYS_MAX * sizeof *b->rays);
    b->queries = malloc(RAYS_MAX * sizeof *b->queries);
    b->irradiance = malloc(IRRADIANCE_BATCH_MAX * sizeof *b->irradiance);
    b->holds = malloc(IRRADIANCE_BATCH_MAX * sizeof *b->holds);
    b->worker.batch = gather_batch_create(INFINITY);
    b->worker.scratch = arena_create(1 << 16);
    if (!b->hits || !b->rays || !b->queries || !b->irradiance || !b->holds || !b->worker.batch || !b->worker.scratch)
        return AG_ERROR_MEMORY;
    for (int tile = 0; tile < TILES; tile++) { /* across the picture, from corner to corner */
        int corner = tile * (PICTURE - TILE) / (TILES - 1);
        for (int y = corner; y < corner + TILE; y++)
            for (int x = corner; x < corner + TILE; x++)
                add_hit(b, x, y);
    }
    return AG_OK;
}

static ag_status make_cache(bench *b, run_context *run)
{
    ag_status status = room_bench_map(run, b->s, &b->map);
    if (status == AG_OK)
        status = irradiance_cache_create(&b->map, IRRADIANCE_PRECOMPUTE, 1, &b->cache);
    if (status == AG_OK)
        status = irradiance_cache_precompute(&b->cache, run);
    b->settings.gather_samples = GATHER_RAYS;
    if (status == AG_OK)
        status = incident_light_create(run, &b->map.tree, AG_DEFAULT_GATHER_GUIDING, &b->incident);
    b->t = (transport){.s = b->s,
                       .run = run,
                       .caustic = &b->no_caustics,
                       .cache = &b->cache,
                       .incident = &b->incident,
                       .settings = &b->settings,
                       .has_lights = true,
                       .gather_min_distance = b->map.mean_radius};
    return status;
}

static void bench_reset(bench *b)
{
    irradiance_cache_reset(&b->cache);
    incident_light_reset(&b->incident);
    photon_map_reset(&b->map);
    scene_destroy(b->s);
    free(b->hits);
    free(b->rays);
    free(b->queries);
    free(b->irradiance);
    free(b->holds);
    gather_batch_destroy(b->worker.batch);
    arena_destroy(b->worker.scratch);
}

int main(int argc, char **argv)
{
    static bench b;
    thread_pool *pool = NULL;
    run_context run;
    log_sink *log = log_create(room_bench_say, NULL);
    ag_status status = log ? thread_pool_create(1, &pool) : AG_ERROR_MEMORY;
    unsigned arithmetic = floating_point_enter();
    if (status == AG_OK) {
        run_context_init(&run, pool, log, NULL, NULL);
        status = room_bench_load(&run, argc > 1 ? argv[1] : NULL, &b.s);
        if (status == AG_OK)
            status = make_cache(&b, &run);
        if (status == AG_OK)
            status = make_work(&b);
    }
    if (status != AG_OK) {
        fprintf(stderr, "afterglow-gather-rays: %s\n", ag_status_text(status));
        return 1;
    }
    for (int round = 0; round < ROOM_BENCH_ROUNDS; round++)
        for (int i = 0; i < ROWS; i++) {
            double begin = clock_thread_cpu_seconds(), count = measured[i](&b);
            rows[i].us[round] = (clock_thread_cpu_seconds() - begin) * 1e6 / count;
        }
    floating_point_leave(arithmetic);
    fprintf(stderr, "%u photons, %u hits, %u rays, %d rounds (checksum %g)\n", b.map.set.count, b.hit_count,
            b.ray_count, ROOM_BENCH_ROUNDS, b.sink);
    room_bench_report(rows, ROWS);
    bench_reset(&b);
    run_context_reset(&run);
    thread_pool_destroy(pool);
    log_destroy(log);
    return 0;
}
