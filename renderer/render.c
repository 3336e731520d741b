/* render.c: the whole flow on one page: photons, maps, cache, tiles, film.
 * Rests on: Jensen 1996; Christensen 1999; Neilson, Yang, TR 04-21, 2004.
 * Threads: one phase after the other, each on all of the context's workers; what a phase made is const in the next. */
#define _POSIX_C_SOURCE 200809L
#include "rendering.h"

#include "adaptive.h"
#include "clock.h"
#include "debug_views.h"
#include "first_hit.h"
#include "floating_point.h"
#include "map_file.h"
#include "passage.h"
#include "path_tracing.h"
#include "photon_dump.h"
#include "sample_queue.h"
#include "shading.h"
#include "tile_scheduler.h"

#include <stdlib.h>
#include <string.h>

enum { TILE_SIZE = 32, ARENA_BLOCK_BYTES = 1 << 16 };
/* Direct light takes one sample for so many gather rays, so that neither is much noisier than the other. */
enum { GATHER_RAYS_PER_LIGHT_SAMPLE = 8, LIGHT_SAMPLES_PER_SCATTER_SAMPLE = 4 };
/* A gather ray shorter than this many mean radii of an estimate does not use the cache. */
static const float GATHER_MIN_DISTANCE_RADII = 1.0f;

/* --- photons and maps --- */

static void maps_reset(maps *m)
{
    irradiance_cache_reset(&m->cache);
    photon_map_reset(&m->global);
    photon_map_reset(&m->caustic);
    photon_file_close(&m->file);
}

/* A caustic needs something to be focused by. */
static bool has_traced_matter(const scene *s)
{
    for (uint32_t i = 0; i < s->shape_count; i++)
        if (scene_shape_is_traced(s, &s->shapes[i]))
            return true;
    return false;
}

static ag_status trace_photons(ag_context *context, const scene *s, const ag_render_settings *settings,
                               photon_set *out_global, photon_set *out_caustic)
{
    bool wants_caustics = settings->caustic_photon_count > 0 && settings->max_depth >= 2 && has_traced_matter(s);
    /* an arrival after n scatterings reaches the eye after n + 2 (gathered), or n + 1 (a caustic seen) */
    photon_tracing_settings tracing = {.kind = PHOTON_GLOBAL,
                                       .wanted = (uint32_t)settings->photon_count,
                                       .max_scatterings = settings->max_depth - 2,
                                       .seed = settings->seed,
                                       .progress_begin = 0.0,
                                       .progress_end = wants_caustics ? 0.7 : 1.0};
    ag_status status = AG_OK;
    if (settings->max_depth >= 2)
        status = photon_tracing_run(s, &context->run, &tracing, out_global);
    if (status == AG_OK && wants_caustics) {
        tracing.kind = PHOTON_CAUSTIC;
        tracing.wanted = (uint32_t)settings->caustic_photon_count;
        tracing.max_scatterings = settings->max_depth - 1;
        tracing.progress_begin = 0.7;
        tracing.progress_end = 1.0;
        status = photon_tracing_run(s, &context->run, &tracing, out_caustic);
    }
    if (status == AG_OK)
        run_progress(&context->run, AG_PHASE_PHOTONS, 1.0);
    return status;
}

static void warn_of_cut_passages(const ag_context *context, uint64_t count)
{
    if (count > 0)
        log_message(context->log, AG_LOG_WARNING, "%llu rays would cross more than %d interfaces: they end there, dark",
                    (unsigned long long)count, PASSAGE_CROSSINGS_MAX);
}

static ag_status trace_maps(ag_context *context, const scene *s, const ag_render_settings *settings,
                            photon_map *out_global, photon_map *out_caustic)
{
    ag_statistics *statistics = &context->statistics;
    *out_global = *out_caustic = (photon_map){0};
    photon_set global = {0}, caustic = {0};
    phase_begin begin = context_begin_phase();
    ag_status status = trace_photons(context, s, settings, &global, &caustic);
    if (status == AG_OK) {
        context_end_phase(context, AG_PHASE_PHOTONS, begin);
        statistics->photons_emitted += global.emitted_paths + caustic.emitted_paths;
        statistics->photons_stored_global += global.count;
        statistics->photons_stored_caustic += caustic.count;
        statistics->rays_photon += global.rays + caustic.rays;
        warn_of_cut_passages(context, global.passages_cut + caustic.passages_cut);
        log_message(context->log, AG_LOG_INFO, "photons: %u in the global map, %u in the caustic map, %llu paths",
                    global.count, caustic.count, (unsigned long long)(global.emitted_paths + caustic.emitted_paths));
        begin = context_begin_phase();
        photon_map_settings map_settings = {.nearest = (uint32_t)settings->nearest,
                                            .max_radius = settings->radius,
                                            .surface_area = s->surface_area,
                                            .bearing = settings->irradiance_fraction,
                                            .surfaces = s};
        status = photon_map_create(&context->run, &global, &map_settings, 0.0, 0.7, out_global);
        /* caustics gather in places: how many of their photons there are does not tell how far apart they lie */
        map_settings.radius_bound = out_global->max_radius;
        map_settings.bearing = 1.0f;
        if (status == AG_OK)
            status = photon_map_create(&context->run, &caustic, &map_settings, 0.7, 1.0, out_caustic);
    }
    photon_set_reset(&global); /* empty, where the maps have taken them over */
    photon_set_reset(&caustic);
    if (status != AG_OK) {
        photon_map_reset(out_global);
        photon_map_reset(out_caustic);
        return status;
    }
    run_progress(&context->run, AG_PHASE_MAP, 1.0);
    context_end_phase(context, AG_PHASE_MAP, begin);
    return AG_OK;
}

static ag_status build_maps(ag_context *context, const scene *s, const ag_render_settings *settings, maps *out_maps)
{
    ag_statistics *statistics = &context->statistics;
    ag_status status;
    if (settings->photon_map_file)
        status =
            map_file_obtain(context, s, settings, trace_maps, &out_maps->file, &out_maps->global, &out_maps->caustic);
    else
        status = trace_maps(context, s, settings, &out_maps->global, &out_maps->caustic);
    if (status != AG_OK)
        return status;
    statistics->photon_bytes += photon_map_bytes(&out_maps->global) + photon_map_bytes(&out_maps->caustic);
    log_message(context->log, AG_LOG_INFO, "estimates: %u nearest, %.4g at most, %.4g where light is spread evenly",
                out_maps->global.nearest, (double)out_maps->global.max_radius, (double)out_maps->global.mean_radius);

    static const irradiance_cache_mode modes[] = {[AG_CACHE_ON_DEMAND] = IRRADIANCE_ON_DEMAND,
                                                  [AG_CACHE_PRECOMPUTE] = IRRADIANCE_PRECOMPUTE,
                                                  [AG_CACHE_OFF] = IRRADIANCE_UNCACHED};
    status = irradiance_cache_create(&out_maps->global, modes[settings->cache], statistics->threads, &out_maps->cache);
    if (status == AG_OK && out_maps->file.is_shared)
        irradiance_cache_share(&out_maps->cache, &out_maps->file.owners);
    statistics->irradiance_ready += out_maps->cache.ready_before;
    if (status == AG_OK && settings->cache == AG_CACHE_PRECOMPUTE) {
        phase_begin begin = context_begin_phase();
        status = irradiance_cache_precompute(&out_maps->cache, &context->run);
        context_end_phase(context, AG_PHASE_PRECOMPUTE, begin);
    }
    return status;
}

/* --- tiles --- */

typedef struct tile_job {
    ag_context *context;
    const transport *t;
    tile_scheduler *tiles;
    eye_worker *workers;
    ag_film *film;
    uint32_t wanted;                     /* samples of each pixel */
    double sample_count;                 /* all that are still to be taken */
    atomic_u64 samples_done;             /* for the progress alone: relaxed */
    double progress_begin, progress_end; /* of the phase, before and after this pass */
} tile_job;

/* All but the gathered light, which the worker's batch brings later. */
static void render_sample(const tile_job *job, eye_worker *worker, int x, int y, uint32_t index, eye_sample *out)
{
    const transport *t = job->t;
    const ag_render_settings *settings = t->settings;
    sampler where = sampler_make(settings->seed, x, y, index, sampler_bits((uint32_t)settings->samples_per_pixel));
    vec2 offset = pixel_filter_sample(&job->film->filter, sampler_2d(&where, SAMPLE_PIXEL, 0), &out->sign);
    vec2 lens = t->s->options.disable_pixel_jitter ? (vec2){0.5f, 0.5f} : sampler_2d(&where, SAMPLE_LENS, 0);
    float time = !t->s->has_motion                    ? 0.0f
                 : t->s->options.disable_pixel_jitter ? 0.5f
                                                      : sampler_2d(&where, SAMPLE_TIME, 0).x;
    float width = (float)settings->width, height = (float)settings->height;
    camera_place place = {((float)x + 0.5f + offset.x) / width, ((float)y + 0.5f + offset.y) / height, width / height,
                          lens, time};
    scene_ray ray = camera_generate_ray(&t->s->camera, place.film_x, place.film_y, place.aspect, lens, time);
    out->most_direct = settings->clamp_direct > 0.0f ? settings->clamp_direct : INFINITY;
    out->most_indirect = settings->clamp_indirect > 0.0f ? settings->clamp_indirect : INFINITY;
    if (settings->integrator == AG_INTEGRATOR_PATH)
        path_tracing_radiance(t, worker, ray, &where, out);
    else
        shading_radiance(t, worker, ray, &where, out);
    if (out->layers && t->layout->needs_first_hit)
        first_hit_project(t, &place, &out->layers->first);
}

/* Completes the samples under way. When the work is cancelled they do not count. */
static void finish_samples(tile_job *job, eye_worker *worker)
{
    const transport *t = job->t;
    gather_batch *batch = worker->batch;
    if (batch && !run_is_cancelled(t->run))
        gather_batch_resolve(batch, t->cache, t->run, worker->index);
    uint32_t count = worker->queue->count;
    if (count == 0 || run_is_cancelled(t->run))
        return;
    worker->samples_not_finite += sample_queue_deliver(worker->queue, batch ? batch->gathered : NULL,
                                                       (uint32_t)t->layout->group_count, job->film);
    uint64_t done = fetch_add_relaxed_u64(&job->samples_done, count) + count;
    double share = (double)done / job->sample_count;
    run_progress(&job->context->run, AG_PHASE_RENDER,
                 job->progress_begin + share * (job->progress_end - job->progress_begin));
}

/* Whether the next sample is better begun when those under way are complete. */
static bool should_finish(const transport *t, const eye_worker *worker)
{
    const gather_batch *batch = worker->batch;
    return sample_queue_is_full(worker->queue) ||
           (batch && batch->query_count > 0 &&
            batch->query_count + (uint32_t)t->settings->gather_samples > IRRADIANCE_BATCH_MAX);
}

/* The samples that the pixel has not had yet, in their order, by the one thread that has its tile. */
static void render_pixel(tile_job *job, eye_worker *worker, int x, int y)
{
    ag_film *film = job->film;
    size_t pixel = (size_t)(y - film->y0) * (size_t)film->width + (size_t)(x - film->x0);
    uint32_t goal = film_goal(film, pixel, job->wanted);
    for (uint32_t i = film->counts[pixel]; i < goal; i++) {
        if (run_is_cancelled(&job->context->run))
            return;
        worker->sample = worker->queue->count;
        render_sample(job, worker, x, y, i, sample_queue_begin(worker->queue, pixel));
        if (should_finish(job->t, worker))
            finish_samples(job, worker);
    }
}

static void add_tile_time(ag_film *film, tile area, float seconds)
{
    for (int y = area.y0; y < area.y1; y++)
        for (int x = area.x0; x < area.x1; x++)
            film->views[VIEW_TILE_TIME][(size_t)(y - film->y0) * (size_t)film->width + (size_t)(x - film->x0)] +=
                seconds;
}

/* Samples under way may be of several tiles, unless each tile's time is asked for. */
static void render_tiles(void *user, unsigned worker_index)
{
    tile_job *job = user;
    eye_worker *worker = &job->workers[worker_index];
    float *times = job->film->views[VIEW_TILE_TIME];
    tile area;
    worker->queue->count = 0;
    if (worker->batch)
        gather_batch_reset(worker->batch);
    while (!run_is_cancelled(&job->context->run) && tile_scheduler_next(job->tiles, &area)) {
        double begin = times ? clock_seconds() : 0.0;
        for (int y = area.y0; y < area.y1; y++) {
            for (int x = area.x0; x < area.x1; x++)
                render_pixel(job, worker, x, y);
            if (!worker->batch) /* nothing is waited for */
                finish_samples(job, worker);
        }
        if (times) {
            finish_samples(job, worker);
            add_tile_time(job->film, area, (float)(clock_seconds() - begin));
        }
    }
    finish_samples(job, worker);
}

static void eye_workers_destroy(eye_worker *workers, unsigned count)
{
    for (unsigned i = 0; workers && i < count; i++) {
        arena_destroy(workers[i].scratch);
        gather_batch_destroy(workers[i].batch);
        sample_queue_destroy(workers[i].queue);
    }
    free(workers);
}

/* What a worker has in use, tried out here, so that nothing can fail while tiles run. */
static bool eye_worker_reserve(eye_worker *worker, const transport *t)
{
    float most_indirect = t->settings->clamp_indirect > 0.0f ? t->settings->clamp_indirect : INFINITY;
    worker->queue = sample_queue_create(t->wants_layers);
    if (!worker->queue || !t->cache)
        return worker->queue != NULL;
    worker->batch = gather_batch_create(most_indirect);
    worker->scratch = arena_create(ARENA_BLOCK_BYTES);
    if (!worker->batch || !worker->scratch)
        return false;
    arena_mark mark = arena_save(worker->scratch);
    bool fits = arena_alloc(worker->scratch, photon_map_scratch_count(t->caustic) * sizeof(photon_neighbor)) != NULL;
    if (fits && (aov_has(t->layout, SUM_IRRADIANCE) || t->layout->has_view[VIEW_PHOTON_DENSITY])) /* alone */
        fits = arena_alloc(worker->scratch, photon_map_scratch_count(t->cache->map) * sizeof(photon_neighbor));
    arena_restore(worker->scratch, mark);
    return fits;
}

static eye_worker *eye_workers_create(const transport *t, unsigned count)
{
    eye_worker *workers = aligned_alloc(_Alignof(eye_worker), count * sizeof *workers);
    if (!workers)
        return NULL;
    for (unsigned i = 0; i < count; i++)
        workers[i] = (eye_worker){.index = i};
    for (unsigned i = 0; i < count; i++)
        if (!eye_worker_reserve(&workers[i], t)) {
            eye_workers_destroy(workers, count);
            return NULL;
        }
    return workers;
}

/* --- a rendering --- */

/* A pass: brings pixels to so many samples. AG_PAUSED: not all of them. */
static ag_status render_tiles_of(ag_rendering *r, uint32_t wanted)
{
    ag_context *context = r->context;
    ag_film *film = r->film;
    double most = (double)r->settings.samples_per_pixel;
    tile_job job = {.context = context,
                    .t = &r->t,
                    .film = film,
                    .workers = r->workers,
                    .wanted = wanted,
                    .progress_begin = film_count_samples(film).mean / most,
                    .progress_end = (double)wanted / most};
    ag_status status = tile_scheduler_create(film->x0, film->y0, film->x0 + film->width, film->y0 + film->height,
                                             TILE_SIZE, context->statistics.threads, &job.tiles);
    if (status != AG_OK)
        return status;
    for (size_t i = 0; i < (size_t)film->width * (size_t)film->height; i++) {
        uint32_t goal = film_goal(film, i, wanted);
        job.sample_count += film->counts[i] < goal ? (double)(goal - film->counts[i]) : 0.0;
    }
    run_progress(&context->run, AG_PHASE_RENDER, job.progress_begin); /* the first pixels may take long */
    run_allow_pause(&context->run);
    thread_pool_run(context->pool, render_tiles, &job);
    bool is_paused = run_end_pause(&context->run);
    tile_scheduler_destroy(job.tiles);
    return run_is_cancelled(&context->run) ? AG_CANCELLED : is_paused ? AG_PAUSED : AG_OK;
}

/* The passes between the places where it is decided which pixels need more. */
static ag_status render_adaptively(ag_rendering *r, uint32_t wanted)
{
    ag_film *film = r->film;
    bool is_done = false;
    ag_status status = AG_OK;
    uint32_t barrier = adaptive_barrier(film);
    while (status == AG_OK && !is_done) {
        if (barrier > 0)
            status = render_tiles_of(r, barrier < wanted ? barrier : wanted);
        if (barrier >= wanted || status != AG_OK)
            break;
        status = adaptive_decide(film, &r->context->run, &r->settings, &is_done);
        barrier = adaptive_barrier(film);
    }
    return status;
}

/* What the workers counted since they were asked last. */
static void collect_counts(ag_rendering *r)
{
    ag_statistics *statistics = &r->context->statistics;
    uint64_t cut = 0;
    for (unsigned i = 0; i < statistics->threads; i++) {
        eye_worker *w = &r->workers[i];
        statistics->rays_camera += w->rays_camera;
        statistics->rays_shadow += w->rays_shadow;
        statistics->rays_gather += w->rays_gather;
        statistics->rays_path += w->rays_path;
        statistics->samples_not_finite += w->samples_not_finite;
        cut += w->passages_cut;
        w->rays_camera = w->rays_shadow = w->rays_gather = w->rays_path = 0;
        w->samples_not_finite = w->passages_cut = 0;
    }
    warn_of_cut_passages(r->context, cut);
}

static transport make_transport(const ag_context *context, const scene *s, const ag_render_settings *settings,
                                const aov_layout *layout, maps *m)
{
    transport t = {.s = s,
                   .run = &context->run,
                   .settings = settings,
                   .layout = layout,
                   .wants_layers = layout->sum_count > 3 || layout->needs_first_hit,
                   .wants_groups = aov_has(layout, SUM_GROUPS),
                   .has_lights = rgb_max(s->light_power) > 0.0f};
    for (uint32_t i = 0; i < s->light_count; i++)
        t.can_meet_lights = t.can_meet_lights || s->lights[i].kind == LIGHT_AREA || s->lights[i].kind == LIGHT_INFINITE;
    t.light_samples = (settings->gather_samples + GATHER_RAYS_PER_LIGHT_SAMPLE - 1) / GATHER_RAYS_PER_LIGHT_SAMPLE;
    if (t.can_meet_lights)
        t.scatter_samples = (t.light_samples + LIGHT_SAMPLES_PER_SCATTER_SAMPLE - 1) / LIGHT_SAMPLES_PER_SCATTER_SAMPLE;
    if (settings->integrator == AG_INTEGRATOR_PHOTONMAP) {
        t.caustic = &m->caustic;
        t.cache = &m->cache;
        t.gather_min_distance = GATHER_MIN_DISTANCE_RADII * m->global.mean_radius;
    }
    return t;
}

static void count_irradiance(ag_statistics *statistics, const irradiance_cache *cache)
{
    irradiance_counters c = irradiance_cache_counters(cache);
    statistics->irradiance_requests += c.requests;
    statistics->irradiance_computed += c.computed;
    statistics->irradiance_distinct += irradiance_cache_distinct(cache);
    statistics->irradiance_deferred += c.deferred;
    statistics->irradiance_waited += c.waited;
    statistics->irradiance_duplicated += c.duplicated;
    statistics->irradiance_reclaimed += c.reclaimed;
    statistics->irradiance_uncached += c.uncached;
    statistics->irradiance_estimate_s += irradiance_counters_estimate_seconds(&c);
    statistics->irradiance_wait_s += c.waited_seconds;
}

/* Settings with nothing left open. */
static ag_status settle_settings(ag_context *context, const scene *s, const ag_render_settings *wanted,
                                 ag_render_settings *out_settings)
{
    *out_settings = *wanted;
    if (out_settings->gather_samples == 0 && out_settings->samples_per_pixel > 0) {
        int rays = AG_DEFAULT_GATHER_RAYS_PER_PIXEL / out_settings->samples_per_pixel;
        out_settings->gather_samples = rays > 0 ? rays : 1;
    }
    if (s->has_camera)
        return render_settings_check(context, out_settings);
    log_message(context->log, AG_LOG_ERROR, "the scene has no Camera");
    return AG_ERROR_SCENE;
}

/* As OpenEXR's standard attributes describe them. Errors: AG_ERROR_MEMORY. */
static ag_status note_origin(const ag_rendering *r, film_origin *out)
{
    const camera *c = &r->s->camera;
    const ag_render_settings *settings = &r->settings;
    double film_from_camera[4][4];
    transform world_from_camera = c->world_from_camera;
    if (c->is_moving)
        world_from_camera = camera_transform_at(c, 0.0f);
    out->settings = *settings;
    out->settings.photon_map_file = NULL; /* the caller's */
    out->has_ndc =
        camera_film_from_camera(c, (float)settings->width / (float)settings->height, 1e-2, 1e3, film_from_camera);
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 4; k++) {
            double ndc = 0.0;
            for (int j = 0; out->has_ndc && j < 4; j++)
                ndc += film_from_camera[i][j] * world_from_camera.inverse[j][k];
            out->world_to_camera[4 * k + i] = (float)world_from_camera.inverse[i][k];
            out->world_to_ndc[4 * k + i] = (float)ndc;
        }
    out->defined = r->s->defined ? strdup(r->s->defined) : NULL;
    return out->defined || !r->s->defined ? AG_OK : AG_ERROR_MEMORY;
}

static ag_status create_film(ag_rendering *r)
{
    pixel_filter filter;
    aov_layout layout;
    const ag_render_settings *settings = &r->settings;
    const aov_needs also = {.albedo_and_normal = settings->denoise, .variance = settings->noise_level > 0.0f};
    static const char *const no_groups[] = {"default"};
    const char *const *group_names = no_groups;
    int group_count = 1;
    if (r->s->light_group_count > 0) {
        group_names = (const char *const *)(void *)r->s->light_group_names;
        group_count = (int)r->s->light_group_count;
    }
    ag_status status =
        pixel_filter_create(&r->s->pixel_filter, r->s->options.disable_pixel_jitter, r->context->log, &filter);
    if (status == AG_OK)
        status = aov_layout_create(settings->layers, also, settings->integrator == AG_INTEGRATOR_PATH, group_names,
                                   group_count, &layout);
    if (status != AG_OK)
        return status;
    r->film = film_create(settings, &r->s->space, &filter, &layout);
    if (!r->film)
        return AG_ERROR_MEMORY;
    status = note_origin(r, &r->film->origin);
    for (int i = 0; i < CRYPTOMATTE_KIND_COUNT && status == AG_OK; i++)
        if (r->film->layout.has_matte[i])
            status = cryptomatte_create(r->s, (cryptomatte_kind)i, &r->film->mattes[i]);
    if (status != AG_OK)
        return status;
    if (r->film->width > 0)
        return AG_OK;
    log_message(r->context->log, AG_LOG_ERROR, "the crop window holds no pixel");
    return AG_ERROR_ARGUMENT;
}

static ag_status prepare(ag_rendering *r)
{
    ag_context *context = r->context;
    ag_status status = create_film(r);
    if (status != AG_OK)
        return status;
    if (!(rgb_max(r->s->light_power) > 0.0f))
        log_once(context->log, AG_LOG_WARNING, "no light", "the scene has no light that emits: the picture is black");
    if (r->settings.integrator == AG_INTEGRATOR_PHOTONMAP)
        status = build_maps(context, r->s, &r->settings, &r->maps);
    if (status != AG_OK)
        return status;
    r->t = make_transport(context, r->s, &r->settings, &r->film->layout, &r->maps);
    r->workers = eye_workers_create(&r->t, context->statistics.threads);
    return r->workers ? AG_OK : AG_ERROR_MEMORY;
}

/* light's side: lamps -> photons -> maps -> cache */
ag_status ag_rendering_create(ag_context *context, const ag_scene *loaded, const ag_render_settings *settings,
                              ag_rendering **out_rendering)
{
    if (!context || !loaded || !settings || !out_rendering)
        return AG_ERROR_ARGUMENT;
    ag_rendering *r = calloc(1, sizeof *r);
    if (!r)
        return AG_ERROR_MEMORY;
    unsigned callers_arithmetic = floating_point_enter();
    r->context = context;
    r->s = loaded->s;
    r->not_finite_before = context->statistics.samples_not_finite;
    ag_status status = settle_settings(context, loaded->s, settings, &r->settings);
    context->rendered = r->settings;
    context->rendered.photon_map_file = NULL; /* the caller's */
    if (status == AG_OK)
        status = prepare(r);
    r->settings.photon_map_file = NULL; /* the caller's, and done with */
    floating_point_leave(callers_arithmetic);
    if (status == AG_OK)
        *out_rendering = r;
    else
        ag_rendering_finish(r, NULL);
    return status;
}

/* the eye's side: tiles -> film */
ag_status ag_rendering_continue(ag_rendering *r, int samples_per_pixel)
{
    if (!r || samples_per_pixel < 1 || samples_per_pixel > r->settings.samples_per_pixel)
        return AG_ERROR_ARGUMENT;
    unsigned callers_arithmetic = floating_point_enter();
    ag_context *context = r->context;
    uint32_t wanted = (uint32_t)samples_per_pixel;
    phase_begin begin = context_begin_phase();
    ag_status status = r->film->wanted ? render_adaptively(r, wanted) : render_tiles_of(r, wanted);
    film_resolve(r->film);
    if (status == AG_OK)
        status = debug_views_render(&r->t, &context->run, r->workers, r->film);
    if (status == AG_OK)
        run_progress(&context->run, AG_PHASE_RENDER, (double)wanted / (double)r->settings.samples_per_pixel);
    r->seconds += context_add_to_phase(context, AG_PHASE_RENDER, begin);
    if (status == AG_OK && samples_per_pixel == r->settings.samples_per_pixel)
        log_message(context->log, AG_LOG_INFO, "%-10s %9.3f s", ag_phase_name(AG_PHASE_RENDER), r->seconds);
    collect_counts(r);
    floating_point_leave(callers_arithmetic);
    return status;
}

ag_status ag_rendering_write_photons(const ag_rendering *r, const char *path)
{
    if (!r || !path || r->settings.integrator != AG_INTEGRATOR_PHOTONMAP)
        return AG_ERROR_ARGUMENT;
    char message[1024] = "";
    ag_status status = photon_dump_write(&r->maps.global, &r->maps.caustic, path, message, sizeof message);
    if (message[0])
        log_message(r->context->log, AG_LOG_ERROR, "%s", message);
    return status;
}

const ag_film *ag_rendering_film(const ag_rendering *r) { return r->film; }

void ag_rendering_finish(ag_rendering *r, ag_film **out_film)
{
    if (!r)
        return;
    if (r->t.cache)
        count_irradiance(&r->context->statistics, r->t.cache);
    uint64_t not_finite = r->context->statistics.samples_not_finite - r->not_finite_before;
    if (not_finite > 0)
        log_message(r->context->log, AG_LOG_WARNING, "%llu camera samples were not finite and count as black",
                    (unsigned long long)not_finite);
    if (out_film)
        *out_film = r->film;
    else
        ag_film_destroy(r->film);
    eye_workers_destroy(r->workers, r->context->statistics.threads);
    maps_reset(&r->maps);
    free(r);
}

ag_status ag_render(ag_context *context, const ag_scene *loaded, const ag_render_settings *settings, ag_film **out_film)
{
    if (!out_film)
        return AG_ERROR_ARGUMENT;
    ag_rendering *rendering;
    ag_status status = ag_rendering_create(context, loaded, settings, &rendering);
    if (status != AG_OK)
        return status;
    status = ag_rendering_continue(rendering, rendering->settings.samples_per_pixel);
    ag_rendering_finish(rendering, status == AG_OK ? out_film : NULL);
    return status;
}
