/* photon_making.c: the program afterglow-photon-making: what making a photon map costs: tracing its photons, against
 * what Embree alone needs for the very same rays, on one thread; and putting them in order, on one thread and on all.
 * Room 20 of the forty, or another scene; all take turns in one process; medians of the rounds' ratios, as CSV. The
 * rays are heard on their way to Embree: the linker puts __wrap_scene_intersect before scene_intersect. Use:
 * afterglow-photon-making [SCENE.pbrt]. Flow: [here]. Threads: one, but for the tree. */
#include "bench/room_bench.h"
#include "clock.h"
#include "floating_point.h"
#include "rays/rays.h"
#include "scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct bench {
    scene *s;
    run_context one, all; /* threads */
    photon_set set;       /* as traced */
    scene_ray *rays;
    size_t ray_count, ray_capacity;
    double sink; /* keeps the work from being optimised away */
} bench;

static bench *listener; /* NULL: nobody records */

bool __real_scene_intersect(const scene *s, scene_ray ray, float max_distance, surface_hit *out_hit);
bool __wrap_scene_intersect(const scene *s, scene_ray ray, float max_distance, surface_hit *out_hit);

bool __wrap_scene_intersect(const scene *s, scene_ray ray, float max_distance, surface_hit *out_hit)
{
    bench *b = listener;
    if (b && b->ray_count == b->ray_capacity) {
        size_t capacity = b->ray_capacity ? 2 * b->ray_capacity : 1 << 20;
        scene_ray *larger = realloc(b->rays, capacity * sizeof *larger);
        if (!larger) {
            fputs("afterglow-photon-making: error: out of memory\n", stderr);
            exit(1);
        }
        b->rays = larger;
        b->ray_capacity = capacity;
    }
    if (b)
        b->rays[b->ray_count++] = ray;
    return __real_scene_intersect(s, ray, max_distance, out_hit);
}

/* --- what is measured: microseconds each --- */

static double embree(bench *b)
{
    double begin = clock_thread_cpu_seconds();
    for (size_t i = 0; i < b->ray_count; i++)
        b->sink += (double)scene_first_distance(b->s, b->rays[i]);
    return (clock_thread_cpu_seconds() - begin) * 1e6 / (double)b->ray_count;
}

/* Measured by the process, since the one worker is a thread of its own. */
static double tracing(bench *b)
{
    photon_set set;
    double begin = clock_process_cpu_seconds();
    if (room_bench_trace(&b->one, b->s, &set) != AG_OK)
        return NAN;
    double used = clock_process_cpu_seconds() - begin;
    photon_set_reset(&set);
    return used * 1e6 / (double)b->ray_count;
}

static double tree(bench *b, run_context *run, double (*clock)(void))
{
    photon *photons = photon_records_create(b->set.count);
    if (!photons)
        return NAN;
    memcpy(photons, b->set.photons, b->set.count * sizeof *photons);
    photon_tree made;
    double begin = clock();
    ag_status status = photon_tree_build(run, photons, b->set.count, 0.0, 1.0, &made);
    double used = clock() - begin;
    if (status == AG_OK)
        photon_tree_reset(&made);
    free(photons);
    return status == AG_OK ? used * 1e6 / b->set.count : NAN;
}

static double tree_on_one(bench *b) { return tree(b, &b->one, clock_process_cpu_seconds); }
/* Elapsed: what counts is when all threads are done. */
static double tree_on_all(bench *b) { return tree(b, &b->all, clock_seconds); }

static room_bench_row rows[] = {
    {.name = "Embree alone (a ray)"},
    {.name = "photon tracing (a ray)", .most_ratio = 2.0},
    {.name = "tree on one thread (a photon)"},
    {.name = "tree on all threads (a photon)", .most_us = 0.2}, /* 0.1 s for 500,000, on two */
};
enum { ROWS = sizeof rows / sizeof *rows };
static double (*const measured[ROWS])(bench *b) = {embree, tracing, tree_on_one, tree_on_all};

int main(int argc, char **argv)
{
    static bench b;
    thread_pool *one = NULL, *all = NULL;
    log_sink *log = log_create(room_bench_say, NULL);
    ag_status status = log ? thread_pool_create(1, &one) : AG_ERROR_MEMORY;
    if (status == AG_OK)
        status = thread_pool_create(0, &all);
    unsigned arithmetic = floating_point_enter();
    if (status == AG_OK) {
        run_context_init(&b.one, one, log, NULL, NULL);
        run_context_init(&b.all, all, log, NULL, NULL);
        status = room_bench_load(&b.all, argc > 1 ? argv[1] : NULL, &b.s);
        if (status == AG_OK) {
            listener = &b;
            status = room_bench_trace(&b.one, b.s, &b.set);
            listener = NULL;
        }
    }
    if (status != AG_OK || b.set.count == 0) {
        fprintf(stderr, "afterglow-photon-making: error: %s\n",
                status != AG_OK ? ag_status_text(status) : "no photons");
        return 1;
    }
    for (int round = 0; round < ROOM_BENCH_ROUNDS; round++)
        for (int i = 0; i < ROWS; i++)
            rows[i].us[round] = measured[i](&b);
    floating_point_leave(arithmetic);
    fprintf(stderr, "%u photons, %zu rays, %d rounds, %u threads (checksum %g)\n", b.set.count, b.ray_count,
            ROOM_BENCH_ROUNDS, thread_pool_worker_count(all), b.sink);
    room_bench_report(rows, ROWS);
    photon_set_reset(&b.set);
    scene_destroy(b.s);
    free(b.rays);
    run_context_reset(&b.one);
    run_context_reset(&b.all);
    thread_pool_destroy(one);
    thread_pool_destroy(all);
    log_destroy(log);
    return 0;
}
