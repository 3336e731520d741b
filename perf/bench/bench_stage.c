/* bench_stage.c: see bench_stage.h. */
#include "bench/bench_stage.h"

#include "math/sampling.h"
#include "rays/rays.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MAX_SCATTERINGS = 98, STREAM_RAYS = 77 };

photon_tracing_settings bench_stage_tracing(const bench_stage *stage, photon_kind kind)
{
    return (photon_tracing_settings){
        .kind = kind, .wanted = stage->work->photons, .max_scatterings = MAX_SCATTERINGS, .panes_are_direct = true};
}

static ag_status load(bench_stage *stage, ag_context *context)
{
    char path[64];
    int descriptor;
    const bench_work *work = stage->work;
    ag_status status = bench_scene_open(stage->which, &descriptor);
    if (status != AG_OK)
        return status;
    snprintf(path, sizeof path, "/proc/self/fd/%d", descriptor);
    status = ag_scene_load(context, path, &stage->scene);
    close(descriptor);
    if (status == AG_OK)
        status = ag_render_settings_from_scene(context, stage->scene, &stage->frame);
    if (status != AG_OK)
        return status;
    ag_render_settings *settings = &stage->frame;
    settings->width = settings->height = work->frame_side;
    settings->samples_per_pixel = 1;
    settings->gather_samples = work->gather_rays;
    settings->photon_count = work->photons;
    settings->caustic_photon_count = stage->which == BENCH_SCENE_GLASS ? work->photons : 0;
    stage->shading = *settings;
    stage->shading.integrator = AG_INTEGRATOR_PATH;
    stage->shading.width = stage->shading.height = work->shading_side;
    stage->shading.samples_per_pixel = work->shading_samples;
    stage->shading.max_depth = 1;
    return AG_OK;
}

static ag_status make_map(bench_stage *stage, ag_context *context)
{
    const photon_tracing_settings tracing = bench_stage_tracing(stage, PHOTON_GLOBAL);
    const scene *s = stage->scene->s;
    photon_set copy = {0};
    ag_status status = photon_tracing_run(s, &context->run, &tracing, &stage->photons);
    if (status != AG_OK)
        return status;
    copy = stage->photons;
    copy.photons = photon_records_create(copy.count);
    if (!copy.photons)
        return AG_ERROR_MEMORY;
    memcpy(copy.photons, stage->photons.photons, copy.count * sizeof *copy.photons);
    stage->map_settings = (photon_map_settings){.nearest = (uint32_t)stage->frame.nearest,
                                                .max_radius = stage->frame.radius,
                                                .surface_area = s->surface_area,
                                                .surfaces = s};
    status = photon_map_create(&context->run, &copy, &stage->map_settings, 0.0, 1.0, &stage->map);
    irradiance_cache cache;
    if (status == AG_OK)
        status = irradiance_cache_create(&stage->map, IRRADIANCE_PRECOMPUTE, ag_context_thread_count(context), &cache);
    if (status != AG_OK)
        return status;
    status = irradiance_cache_precompute(&cache, &context->run);
    irradiance_cache_reset(&cache);
    return status;
}

/* A ray goes where light comes from on its way to a photon's position. Most photons of an interior lie on the outside
 * of its walls, from where rays go nowhere: another photon is drawn then, up to so many times. */
static bool draw_ray(const bench_stage *stage, uint32_t index, scene_ray *out_ray, surface_hit *out_hit)
{
    enum { TRIES = 32 };
    const photon_set *set = &stage->photons;
    rng random = rng_make(0, STREAM_RAYS, index);
    bool is_met = false;
    for (int i = 0; i < TRIES && !is_met; i++) {
        const photon *p = &set->photons[rng_next(&random) % set->count];
        vec3 normal = direction_decode(p->normal), position = vec3_make(p->position[0], p->position[1], p->position[2]);
        frame around = frame_from_z(normal);
        vec3 direction = frame_to_world(&around, sample_cosine_hemisphere(rng_vec2(&random)));
        *out_ray = scene_ray_make(vec3_add_scaled(position, normal, 1e-3f), vec3_normalize(direction));
        out_ray->skips_uv = true;
        is_met = scene_intersect(stage->scene->s, *out_ray, INFINITY, out_hit);
    }
    return is_met;
}

/* Irradiance is asked for where rays end, as a final gather does; not on glass and metal, where photons are far. */
static void make_rays(bench_stage *stage)
{
    for (uint32_t i = 0; i < stage->work->rays; i++) {
        surface_hit hit;
        uint64_t rays = 0;
        if (!draw_ray(stage, i, &stage->rays[i], &hit))
            continue;
        stage->met_count++;
        vec3 normal = vec3_face_forward(hit.geometric_normal, vec3_negate(stage->rays[i].direction));
        if (photon_map_nearest(&stage->map, hit.position, normal, &rays) < PHOTON_HIDDEN)
            stage->queries[stage->query_count++] = (irradiance_query){hit.position, normal};
    }
}

static ag_status make_colors(bench_stage *stage, ag_context *context)
{
    ag_film *film;
    int width, height;
    ag_status status = ag_render(context, stage->scene, &stage->shading, &film);
    if (status != AG_OK)
        return status;
    const float *pixels = ag_film_pixels(film, &width, &height);
    size_t count = 3 * (size_t)width * (size_t)height, all = 3 * (size_t)stage->work->color_pixels;
    for (size_t at = 0; at < all; at += count)
        memcpy(stage->colors + at, pixels, (at + count <= all ? count : all - at) * sizeof *pixels);
    ag_film_destroy(film);
    return AG_OK;
}

static bool reserve(bench_stage *stage)
{
    const bench_work *work = stage->work;
    stage->word_count = work->photons;
    stage->rays = malloc(work->rays * sizeof *stage->rays);
    stage->distances = malloc(work->rays * sizeof *stage->distances);
    stage->queries = malloc(work->rays * sizeof *stage->queries);
    stage->irradiance = malloc(work->rays * sizeof *stage->irradiance);
    stage->holds = malloc(work->rays * sizeof *stage->holds);
    stage->colors = malloc(3 * (size_t)work->color_pixels * sizeof *stage->colors);
    stage->shown = malloc(3 * (size_t)work->color_pixels * sizeof *stage->shown);
    stage->words = malloc(stage->word_count * sizeof *stage->words);
    return stage->rays && stage->distances && stage->queries && stage->irradiance && stage->holds && stage->colors &&
           stage->shown && stage->words;
}

ag_status bench_stage_create(bench_scene which, const bench_work *work, ag_context *context, bench_stage *out_stage)
{
    *out_stage = (bench_stage){.which = which, .work = work};
    if (!reserve(out_stage))
        return AG_ERROR_MEMORY;
    ag_status status = load(out_stage, context);
    if (status == AG_OK)
        status = make_map(out_stage, context);
    if (status == AG_OK && out_stage->photons.count == 0)
        status = AG_ERROR_SCENE;
    if (status != AG_OK)
        return status;
    make_rays(out_stage);
    return make_colors(out_stage, context);
}

void bench_stage_reset(bench_stage *stage)
{
    photon_map_reset(&stage->map);
    photon_set_reset(&stage->photons);
    ag_scene_destroy(stage->scene);
    free(stage->rays);
    free(stage->distances);
    free(stage->queries);
    free(stage->irradiance);
    free(stage->holds);
    free(stage->colors);
    free(stage->shown);
    free(stage->words);
    *stage = (bench_stage){0};
}
