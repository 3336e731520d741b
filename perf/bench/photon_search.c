/* photon_search.c: the program afterglow-photon-search: what the photon map's two searches cost, against nanoflann's
 * kd-tree and against Embree's rays, on the photons of one of the forty rooms. All take turns in one process on one
 * thread; medians; ratios are what counts.
 * estimate: irradiance from the 300 nearest of 500,000 photons within 3.0, at photon positions: in random order, and in
 * the order in which the map keeps them (neighbours one after the other).
 * nearest: the nearest photon with a similar normal, at what gather rays hit: ray after ray as they come, and sorted.
 * ray: the gather rays themselves, by Embree alone.
 * The rival finds neighbours by distance alone, without normals or a radius: less work than ours.
 * Use: afterglow-photon-search [SCENE.pbrt]. Flow: room_bench -> [here]. Threads: one. */
#define _GNU_SOURCE
#include "bench/nanoflann_rival.h"
#include "bench/room_bench.h"
#include "clock.h"
#include "floating_point.h"
#include "math/sampling.h"
#include "rays/rays.h"
#include "scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { QUERIES = 20000, RAYS = 200000, NEAREST = ROOM_BENCH_NEAREST };

typedef struct ray_hit {
    scene_ray ray;
    vec3 position, normal;
    uint64_t order;
} ray_hit;

typedef struct bench {
    scene *s;
    photon_map map;
    nanoflann_tree *rival;
    float *points;                      /* [3 count], in the map's order */
    uint32_t *random_order, *map_order; /* [QUERIES], photons */
    ray_hit *hits, *sorted_hits;        /* [hit_count] */
    uint32_t hit_count;
    photon_neighbor *scratch;
    double sink; /* keeps the work from being optimised away */
} bench;

/* --- what is measured: each gives the number of operations --- */

static uint32_t estimates(bench *b, const uint32_t *order)
{
    for (uint32_t i = 0; i < QUERIES; i++) {
        vec3 at = photon_block_position(b->map.blocks, order[i]);
        vec3 normal = direction_decode(photon_block_normal(b->map.blocks, order[i]));
        b->sink += (double)irradiance_estimate(&b->map, at, normal, b->scratch).g;
    }
    return QUERIES;
}

static uint32_t rival_estimates(bench *b, const uint32_t *order)
{
    uint32_t indices[NEAREST + 1];
    float distances[NEAREST + 1];
    for (uint32_t i = 0; i < QUERIES; i++) {
        size_t found =
            nanoflann_tree_nearest(b->rival, b->points + 3 * (size_t)order[i], NEAREST + 1, indices, distances);
        rgb sum = rgb_gray(0.0f);
        for (size_t k = 0; k < found; k++)
            sum = rgb_add(sum, flux_decode(photon_block_flux(b->map.blocks, indices[k])));
        b->sink += (double)sum.g;
    }
    return QUERIES;
}

static uint32_t estimate_random(bench *b) { return estimates(b, b->random_order); }
static uint32_t estimate_ordered(bench *b) { return estimates(b, b->map_order); }
static uint32_t rival_estimate_random(bench *b) { return rival_estimates(b, b->random_order); }
static uint32_t rival_estimate_ordered(bench *b) { return rival_estimates(b, b->map_order); }

static uint32_t nearest_as_they_come(bench *b)
{
    uint64_t rays = 0;
    for (uint32_t i = 0; i < b->hit_count; i++)
        b->sink += (double)photon_map_nearest(&b->map, b->hits[i].position, b->hits[i].normal, &rays);
    return b->hit_count;
}

/* Searches as irradiance_cache_get_many does once the queries are in order. */
static uint32_t nearest_sorted(bench *b)
{
    photon_walk walk;
    photon_walk_init(&walk, &b->map.irradiance_photons);
    uint32_t end;
    uint64_t rays = 0;
    for (uint32_t begin = 0; begin < b->hit_count; begin = end) {
        /* rays of one tile are in order */
        photon_lookup lookups[PHOTON_LOOKUPS_MAX];
        uint32_t photons[PHOTON_LOOKUPS_MAX], count = 0;
        float distances_squared[PHOTON_LOOKUPS_MAX];
        uint64_t tile = b->sorted_hits[begin].order >> 32;
        for (end = begin; end < b->hit_count && count < PHOTON_LOOKUPS_MAX && b->sorted_hits[end].order >> 32 == tile;
             end++) {
            const ray_hit *h = &b->sorted_hits[end];
            lookups[count++] = (photon_lookup){h->position, h->normal, (uint32_t)h->order};
        }
        photon_map_nearest_many(&b->map, &walk, lookups, count, &rays, photons, distances_squared);
        for (uint32_t i = 0; i < count; i++)
            b->sink += (double)photons[i];
    }
    return b->hit_count;
}

static uint32_t rival_nearests(bench *b, const ray_hit *hits)
{
    for (uint32_t i = 0; i < b->hit_count; i++) {
        uint32_t index;
        float distance, at[3] = {hits[i].position.x, hits[i].position.y, hits[i].position.z};
        nanoflann_tree_nearest(b->rival, at, 1, &index, &distance);
        b->sink += (double)index;
    }
    return b->hit_count;
}

static uint32_t rival_nearest_as_they_come(bench *b) { return rival_nearests(b, b->hits); }
static uint32_t rival_nearest_sorted(bench *b) { return rival_nearests(b, b->sorted_hits); }

static uint32_t rays(bench *b)
{
    for (uint32_t i = 0; i < b->hit_count; i++)
        b->sink += (double)scene_first_distance(b->s, b->hits[i].ray);
    return b->hit_count;
}

/* Each after what it is held against. As they come, gather rays are not looked up: no bound. */
enum {
    RIVAL_RANDOM,
    RANDOM,
    RIVAL_ORDERED,
    ORDERED,
    RAY,
    RIVAL_LOOSE,
    LOOSE,
    RIVAL_SORTED,
    SORTED,
    SORTED_TO_RAY,
    ROWS
};
static room_bench_row rows[ROWS] = {
    [RIVAL_RANDOM] = {.name = "nanoflann: estimate in random order", .rival = RIVAL_RANDOM},
    [RANDOM] = {.name = "estimate in random order", .rival = RIVAL_RANDOM, .most_ratio = 1.0 / 5},
    [RIVAL_ORDERED] = {.name = "nanoflann: estimate in the map's order", .rival = RIVAL_ORDERED},
    [ORDERED] = {.name = "estimate in the map's order", .rival = RIVAL_ORDERED, .most_ratio = 1.0 / 3},
    [RAY] = {.name = "Embree: gather ray", .rival = RAY},
    [RIVAL_LOOSE] = {.name = "nanoflann: nearest as they come", .rival = RIVAL_LOOSE},
    [LOOSE] = {.name = "nearest as they come", .rival = RIVAL_LOOSE},
    [RIVAL_SORTED] = {.name = "nanoflann: nearest sorted", .rival = RIVAL_SORTED},
    [SORTED] = {.name = "nearest sorted", .rival = RIVAL_SORTED, .most_ratio = 1.0 / 3},
    [SORTED_TO_RAY] = {.name = "nearest sorted (against the ray)", .rival = RAY, .most_ratio = 1.0},
};
static uint32_t (*const measured[ROWS])(bench *b) = {
    [RIVAL_RANDOM] = rival_estimate_random,
    [RANDOM] = estimate_random,
    [RIVAL_ORDERED] = rival_estimate_ordered,
    [ORDERED] = estimate_ordered,
    [RAY] = rays,
    [RIVAL_LOOSE] = rival_nearest_as_they_come,
    [LOOSE] = nearest_as_they_come,
    [RIVAL_SORTED] = rival_nearest_sorted,
    [SORTED] = nearest_sorted,
    [SORTED_TO_RAY] = nearest_sorted,
};

/* --- what they work on --- */

static int by_order(const void *a, const void *b)
{
    uint64_t x = ((const ray_hit *)a)->order, y = ((const ray_hit *)b)->order;
    return x < y ? -1 : x > y;
}

/* Gather rays from photon positions, as a picture's are: 64 from each hit; a tile is 1,024 hits' worth. */
static void make_rays(bench *b, rng *random)
{
    enum { FROM_EACH = 64, TILE = 65536 };
    uint32_t start = 0;
    for (uint32_t i = 0; i < RAYS; i++) {
        if (i % FROM_EACH == 0)
            start = (uint32_t)(rng_next(random) % b->map.set.count);
        vec3 normal = direction_decode(photon_block_normal(b->map.blocks, start));
        frame f = frame_from_z(normal);
        ray_hit h;
        vec3 from = vec3_add_scaled(photon_block_position(b->map.blocks, start), normal, 1e-3f);
        h.ray = scene_ray_make(from, frame_to_world(&f, sample_cosine_hemisphere(rng_vec2(random))));
        surface_hit hit;
        if (!scene_intersect(b->s, h.ray, INFINITY, &hit))
            continue;
        h.position = hit.position;
        h.normal = vec3_face_forward(hit.geometric_normal, vec3_negate(h.ray.direction));
        h.order = (uint64_t)(i / TILE) << 32 | photon_map_leaf(&b->map, h.position);
        b->hits[b->hit_count++] = h;
    }
    memcpy(b->sorted_hits, b->hits, b->hit_count * sizeof *b->hits);
    qsort(b->sorted_hits, b->hit_count, sizeof *b->hits, by_order);
}

static bool make_orders(bench *b)
{
    uint32_t count = b->map.set.count;
    b->points = malloc(3 * (size_t)count * sizeof *b->points);
    b->random_order = malloc(QUERIES * sizeof *b->random_order);
    b->map_order = malloc(QUERIES * sizeof *b->map_order);
    b->hits = malloc(RAYS * sizeof *b->hits);
    b->sorted_hits = malloc(RAYS * sizeof *b->sorted_hits);
    b->scratch = malloc(photon_map_scratch_count(&b->map) * sizeof *b->scratch);
    if (!b->points || !b->random_order || !b->map_order || !b->hits || !b->sorted_hits || !b->scratch)
        return false;
    rng random = rng_make(1, 2, 3);
    for (uint32_t i = 0; i < count; i++) {
        vec3 p = photon_block_position(b->map.blocks, i);
        memcpy(b->points + 3 * (size_t)i, &p, sizeof p);
    }
    for (uint32_t i = 0; i < QUERIES; i++) {
        b->random_order[i] = (uint32_t)(rng_next(&random) % count);
        b->map_order[i] = count / 3 + i;
    }
    make_rays(b, &random);
    b->rival = nanoflann_tree_create(b->points, count);
    return b->rival != NULL;
}

int main(int argc, char **argv)
{
    bench b = {0};
    thread_pool *pool = NULL;
    run_context run;
    log_sink *log = log_create(room_bench_say, NULL);
    ag_status status = log ? thread_pool_create(1, &pool) : AG_ERROR_MEMORY;
    if (status == AG_OK) {
        run_context_init(&run, pool, log, NULL, NULL);
        status = room_bench_load(&run, argc > 1 ? argv[1] : NULL, &b.s);
        if (status == AG_OK)
            status = room_bench_map(&run, b.s, &b.map);
        if (status == AG_OK && !make_orders(&b))
            status = AG_ERROR_MEMORY;
    }
    if (status != AG_OK) {
        fprintf(stderr, "afterglow-photon-search: %s\n", ag_status_text(status));
        return 1;
    }
    unsigned arithmetic = floating_point_enter();
    for (int round = 0; round < ROOM_BENCH_ROUNDS; round++)
        for (int i = 0; i < ROWS; i++) {
            double begin = clock_thread_cpu_seconds();
            uint32_t count = measured[i](&b);
            rows[i].us[round] = (clock_thread_cpu_seconds() - begin) * 1e6 / count;
        }
    floating_point_leave(arithmetic);
    fprintf(stderr, "%u photons, %u estimates, %u rays, %d rounds (checksum %g)\n", b.map.set.count, (unsigned)QUERIES,
            b.hit_count, ROOM_BENCH_ROUNDS, b.sink);
    room_bench_report(rows, ROWS);
    nanoflann_tree_destroy(b.rival);
    photon_map_reset(&b.map);
    scene_destroy(b.s);
    free(b.points);
    free(b.random_order);
    free(b.map_order);
    free(b.hits);
    free(b.sorted_hits);
    free(b.scratch);
    run_context_reset(&run);
    thread_pool_destroy(pool);
    log_destroy(log);
    return 0;
}
