/* frame_rays.c: the program afterglow-frame-rays: what Embree alone needs for a whole picture's gather rays: as many,
 * from the middle of each pixel, by the cosine. A picture sends half of its own where photons came from, and
 * starts them beside the middle (gather_rays.c replays the very same ones, of five tiles).
 * A tile's rays at a time are made, untimed, and then traced, timed; one line of CSV: how many, microseconds of CPU
 * each. Use: afterglow-frame-rays SCENE.pbrt [SIZE] [GATHER_RAYS]. Flow: frame.sh -> [here]. Threads: one. */
#define _GNU_SOURCE
#include "bench/room_bench.h"
#include "clock.h"
#include "floating_point.h"
#include "integrator/final_gather.h"

#include <stdio.h>
#include <stdlib.h>

enum { TILE = 32, RAYS_MOST = 4096 };

typedef struct replay {
    scene *s;
    transport t;
    eye_worker worker;
    int size, gather_rays;
    scene_ray *rays; /* of a tile */
    size_t ray_count;
    double seconds, sink;
    uint64_t rays_in_all;
} replay;

static void add_pixel(replay *r, int x, int y)
{
    sampler where = sampler_make(0, x, y, 0, 0);
    float size = (float)r->size;
    vertex v;
    scene_ray ray = camera_generate_ray(&r->s->camera, ((float)x + 0.5f) / size, ((float)y + 0.5f) / size, 1.0f,
                                        (vec2){0.5f, 0.5f}, 0.0f);
    if (!transport_trace(&r->t, &r->worker, ray, &v) || !bsdf_is_plain(&v.scattering))
        return;
    sampler_sequence sequence = sampler_sequence_make(&where, SAMPLE_GATHER, 0, (uint32_t)r->gather_rays);
    for (int k = 0; k < r->gather_rays; k++) {
        bsdf_sample first;
        if (!bsdf_sample_direction(&v.scattering, BSDF_GATHERED, BSDF_RADIANCE, 0.0f,
                                   sampler_sequence_at(&sequence, (uint32_t)k), &first))
            continue;
        ray = surface_ray(&v.hit, v.arrived, first.direction);
        ray.skips_uv = true;
        r->rays[r->ray_count++] = ray;
    }
}

static void replay_tile(replay *r, int x0, int y0)
{
    r->ray_count = 0;
    for (int y = y0; y < y0 + TILE && y < r->size; y++)
        for (int x = x0; x < x0 + TILE && x < r->size; x++)
            add_pixel(r, x, y);
    double begin = clock_thread_cpu_seconds();
    for (size_t i = 0; i < r->ray_count; i++)
        r->sink += (double)scene_first_distance(r->s, r->rays[i]);
    r->seconds += clock_thread_cpu_seconds() - begin;
    r->rays_in_all += r->ray_count;
}

static ag_status replay_run(replay *r, run_context *run)
{
    static const ag_render_settings settings = {0};
    r->t = (transport){.s = r->s, .run = run, .settings = &settings, .has_lights = true};
    r->worker.scratch = arena_create(1 << 16);
    r->rays = malloc((size_t)TILE * TILE * (size_t)r->gather_rays * sizeof *r->rays);
    if (!r->rays || !r->worker.scratch)
        return AG_ERROR_MEMORY;
    for (int y = 0; y < r->size; y += TILE)
        for (int x = 0; x < r->size; x += TILE)
            replay_tile(r, x, y);
    return r->rays_in_all > 0 ? AG_OK : AG_ERROR_SCENE;
}

int main(int argc, char **argv)
{
    static replay r;
    thread_pool *pool = NULL;
    run_context run;
    r.size = argc > 2 ? atoi(argv[2]) : 400;
    r.gather_rays = argc > 3 ? atoi(argv[3]) : ROOM_BENCH_GATHER_RAYS;
    if (argc < 2 || argc > 4 || r.size < 1 || r.gather_rays < 1 || r.gather_rays > RAYS_MOST) {
        fprintf(stderr, "usage: afterglow-frame-rays SCENE.pbrt [SIZE] [GATHER_RAYS]\n");
        return 2;
    }
    log_sink *log = log_create(room_bench_say, NULL);
    ag_status status = log ? thread_pool_create(1, &pool) : AG_ERROR_MEMORY;
    unsigned arithmetic = floating_point_enter();
    if (status == AG_OK) {
        run_context_init(&run, pool, log, NULL, NULL);
        status = room_bench_load(&run, argv[1], &r.s);
        if (status == AG_OK)
            status = replay_run(&r, &run);
    }
    floating_point_leave(arithmetic);
    if (status != AG_OK) {
        fprintf(stderr, "afterglow-frame-rays: %s: %s\n", argv[1], ag_status_text(status));
        return 1;
    }
    fprintf(stderr, "checksum %g\n", r.sink);
    printf("%llu,%.6f\n", (unsigned long long)r.rays_in_all, 1e6 * r.seconds / (double)r.rays_in_all);
    scene_destroy(r.s);
    free(r.rays);
    arena_destroy(r.worker.scratch);
    run_context_reset(&run);
    thread_pool_destroy(pool);
    log_destroy(log);
    return 0;
}
