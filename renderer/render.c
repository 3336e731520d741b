/* render.c: the whole flow on one page: photons, maps, cache, tiles, film.
 * Rests on: Jensen 1996; Christensen 1999; Neilson, Yang, TR 04-21, 2004.
 * Threads: one phase after the other, each on all of the context's workers; what a phase made is const in the next. */
#include "context.h"

#include "clock.h"
#include "film_response.h"
#include "floating_point.h"
#include "passage.h"
#include "path_tracing.h"
#include "pixel_filter.h"
#include "shading.h"
#include "tile_scheduler.h"

#include <stdlib.h>

enum { TILE_SIZE = 32, ARENA_BLOCK_BYTES = 1 << 16 };
/* Direct light takes one sample for so many gather rays, so that neither is much noisier than the other. */
enum { GATHER_RAYS_PER_LIGHT_SAMPLE = 8, LIGHT_SAMPLES_PER_SCATTER_SAMPLE = 4 };
/* A gather ray shorter than this many mean radii of an estimate does not use the cache. */
static const float GATHER_MIN_DISTANCE_RADII = 1.0f;

/* --- photons and maps --- */

typedef struct maps {
    photon_map global, caustic;
    irradiance_cache cache;
} maps;

static void maps_reset(maps *m)
{
    irradiance_cache_reset(&m->cache);
    photon_map_reset(&m->global);
    photon_map_reset(&m->caustic);
}

/* A caustic needs something to be focused by. */
static bool has_traced_matter(const scene *s)
{
    for (uint32_t i = 0; i < s->shape_count; i++)
        if (material_is_traced(s, s->shapes[i].material_index))
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

static ag_status build_maps(ag_context *context, const scene *s, const ag_render_settings *settings, maps *out_maps)
{
    ag_statistics *statistics = &context->statistics;
    photon_set global = {0}, caustic = {0};
    double begin = clock_seconds();
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
        begin = clock_seconds();
        photon_map_settings map_settings = {.nearest = (uint32_t)settings->nearest,
                                            .max_radius = settings->radius,
                                            .surface_area = s->surface_area,
                                            .surfaces = s};
        status = photon_map_create(&context->run, &global, &map_settings, 0.0, 0.7, &out_maps->global);
        /* caustics gather in places: how many of their photons there are does not tell how far apart they lie */
        map_settings.radius_bound = out_maps->global.max_radius;
        if (status == AG_OK)
            status = photon_map_create(&context->run, &caustic, &map_settings, 0.7, 1.0, &out_maps->caustic);
    }
    photon_set_reset(&global); /* empty, where the maps have taken them over */
    photon_set_reset(&caustic);
    if (status != AG_OK)
        return status;
    run_progress(&context->run, AG_PHASE_MAP, 1.0);
    context_end_phase(context, AG_PHASE_MAP, begin);
    statistics->photon_bytes += photon_map_bytes(&out_maps->global) + photon_map_bytes(&out_maps->caustic);
    log_message(context->log, AG_LOG_INFO, "estimates: %u nearest, %.4g at most, %.4g where light is spread evenly",
                out_maps->global.nearest, (double)out_maps->global.max_radius, (double)out_maps->global.mean_radius);

    static const irradiance_cache_mode modes[] = {[AG_CACHE_ON_DEMAND] = IRRADIANCE_ON_DEMAND,
                                                  [AG_CACHE_PRECOMPUTE] = IRRADIANCE_PRECOMPUTE,
                                                  [AG_CACHE_OFF] = IRRADIANCE_UNCACHED};
    status = irradiance_cache_create(&out_maps->global, modes[settings->cache], statistics->threads, &out_maps->cache);
    if (status == AG_OK && settings->cache == AG_CACHE_PRECOMPUTE) {
        begin = clock_seconds();
        status = irradiance_cache_precompute(&out_maps->cache, &context->run);
        context_end_phase(context, AG_PHASE_PRECOMPUTE, begin);
    }
    return status;
}

/* --- tiles --- */

typedef struct tile_job {
    ag_context *context;
    const transport *t;
    const pixel_filter *filter;
    film_response response;
    tile_scheduler *tiles;
    eye_worker *workers;
    ag_film *film;
    atomic_u64 pixels_done; /* for the progress alone: relaxed */
} tile_job;

static rgb render_sample(const tile_job *job, eye_worker *worker, int x, int y, uint32_t index, int *out_sign)
{
    const transport *t = job->t;
    const ag_render_settings *settings = t->settings;
    sampler where = sampler_make(settings->seed, x, y, index, sampler_bits((uint32_t)settings->samples_per_pixel));
    vec2 offset = pixel_filter_sample(job->filter, sampler_2d(&where, SAMPLE_PIXEL, 0), out_sign);
    vec2 lens = t->s->options.disable_pixel_jitter ? (vec2){0.5f, 0.5f} : sampler_2d(&where, SAMPLE_LENS, 0);
    float time = !t->s->has_motion                    ? 0.0f
                 : t->s->options.disable_pixel_jitter ? 0.5f
                                                      : sampler_2d(&where, SAMPLE_TIME, 0).x;
    float width = (float)settings->width, height = (float)settings->height;
    scene_ray ray = camera_generate_ray(&t->s->camera, ((float)x + 0.5f + offset.x) / width,
                                        ((float)y + 0.5f + offset.y) / height, width / height, lens, time);
    rgb radiance = settings->integrator == AG_INTEGRATOR_PATH ? path_tracing_radiance(t, worker, ray, &where)
                                                              : shading_radiance(t, worker, ray, &where);
    if (rgb_is_finite(radiance))
        return job->response.is_bounded ? film_response_bound(&job->response, radiance) : radiance;
    worker->samples_not_finite++;
    return rgb_gray(0.0f);
}

/* A pixel is the mean of its samples (of filters with negative lobes: their mean with signs), summed in their order by
 * the one thread that has its tile. */
static void render_pixel(const tile_job *job, eye_worker *worker, int x, int y)
{
    uint32_t count = (uint32_t)job->t->settings->samples_per_pixel;
    pixel_sum sum = {0};
    for (uint32_t i = 0; i < count; i++) {
        if (run_is_cancelled(&job->context->run))
            return;
        int sign;
        rgb sample = render_sample(job, worker, x, y, i, &sign);
        double *signed_sum = sign > 0 ? sum.positive : sum.negative;
        signed_sum[0] += (double)sample.r;
        signed_sum[1] += (double)sample.g;
        signed_sum[2] += (double)sample.b;
        if (sign > 0)
            sum.positive_count++;
        else
            sum.negative_count++;
    }
    double mean[3] = {sum.positive[0] / count, sum.positive[1] / count, sum.positive[2] / count};
    if (job->filter->has_signs)
        pixel_filter_resolve(job->filter, &sum, mean);
    if (!job->response.is_plain)
        film_response_develop(&job->response, mean);
    float *pixel =
        job->film->pixels + 3 * ((size_t)(y - job->film->y0) * (size_t)job->film->width + (size_t)(x - job->film->x0));
    for (int c = 0; c < 3; c++)
        pixel[c] = (float)mean[c];
}

static void render_tiles(void *user, unsigned worker_index)
{
    tile_job *job = user;
    eye_worker *worker = &job->workers[worker_index];
    double pixel_count = (double)job->film->width * (double)job->film->height;
    tile area;
    while (!run_is_cancelled(&job->context->run) && tile_scheduler_next(job->tiles, &area)) {
        for (int y = area.y0; y < area.y1; y++) {
            for (int x = area.x0; x < area.x1; x++)
                render_pixel(job, worker, x, y);
            uint64_t row = (uint64_t)(area.x1 - area.x0);
            uint64_t done = fetch_add_relaxed_u64(&job->pixels_done, row) + row;
            run_progress(&job->context->run, AG_PHASE_RENDER, (double)done / pixel_count);
        }
    }
}

static void eye_workers_destroy(eye_worker *workers, unsigned count)
{
    for (unsigned i = 0; workers && i < count; i++)
        arena_destroy(workers[i].scratch);
    free(workers);
}

/* The most that a worker has in use at once: a gather's rays, and an estimate's neighbours within it. Tried out here,
 * so that nothing can fail while tiles run. */
static bool eye_worker_reserve(eye_worker *worker, const transport *t)
{
    worker->scratch = arena_create(ARENA_BLOCK_BYTES);
    if (!worker->scratch)
        return false;
    arena_mark mark = arena_save(worker->scratch);
    bool fits = arena_alloc(worker->scratch, (size_t)t->settings->gather_samples * sizeof(gather_ray)) &&
                arena_alloc(worker->scratch, photon_map_scratch_count(t->caustic) * sizeof(photon_neighbor));
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
    for (unsigned i = 0; t->cache && i < count; i++)
        if (!eye_worker_reserve(&workers[i], t)) {
            eye_workers_destroy(workers, count);
            return NULL;
        }
    return workers;
}

static ag_status render_film(ag_context *context, const transport *t, const pixel_filter *filter, ag_film *film)
{
    ag_statistics *statistics = &context->statistics;
    tile_job job = {.context = context, .t = t, .filter = filter, .film = film};
    job.response = film_response_make(t->settings);
    job.workers = eye_workers_create(t, statistics->threads);
    if (!job.workers)
        return AG_ERROR_MEMORY;
    ag_status status = tile_scheduler_create(film->x0, film->y0, film->x0 + film->width, film->y0 + film->height,
                                             TILE_SIZE, statistics->threads, &job.tiles);
    if (status == AG_OK) {
        double begin = clock_seconds();
        run_progress(&context->run, AG_PHASE_RENDER, 0.0); /* the first pixels may take long */
        thread_pool_run(context->pool, render_tiles, &job);
        status = run_is_cancelled(&context->run) ? AG_CANCELLED : AG_OK;
        context_end_phase(context, AG_PHASE_RENDER, begin);
    }
    uint64_t cut = 0;
    for (unsigned i = 0; i < statistics->threads; i++) {
        statistics->rays_camera += job.workers[i].rays_camera;
        statistics->rays_shadow += job.workers[i].rays_shadow;
        statistics->rays_gather += job.workers[i].rays_gather;
        statistics->rays_path += job.workers[i].rays_path;
        statistics->samples_not_finite += job.workers[i].samples_not_finite;
        cut += job.workers[i].passages_cut;
    }
    warn_of_cut_passages(context, cut);
    tile_scheduler_destroy(job.tiles);
    eye_workers_destroy(job.workers, statistics->threads);
    return status;
}

/* --- the flow --- */

static ag_film *film_create(const ag_render_settings *settings)
{
    ag_film *film = calloc(1, sizeof *film);
    if (!film)
        return NULL;
    /* as pbrt: pixels from ceil(x0 width) on; a hair less, so that pixel / width times width is that pixel */
    const double *crop = settings->crop_window;
    int edges[4];
    for (int i = 0; i < 4; i++)
        edges[i] = (int)ceil(crop[i] * (i < 2 ? settings->width : settings->height) - 1e-6);
    film->x0 = edges[0];
    film->y0 = edges[2];
    film->width = edges[1] - edges[0];
    film->height = edges[3] - edges[2];
    film->full_width = settings->width;
    film->full_height = settings->height;
    film->float_samples = settings->float_samples;
    if (film->width < 1 || film->height < 1)
        film->width = film->height = 0;
    film->pixels = calloc((size_t)film->width * (size_t)film->height + 1, 3 * sizeof *film->pixels);
    if (!film->pixels) {
        free(film);
        return NULL;
    }
    return film;
}

static transport make_transport(const ag_context *context, const scene *s, const ag_render_settings *settings, maps *m)
{
    transport t = {.s = s, .run = &context->run, .settings = settings, .has_lights = rgb_max(s->light_power) > 0.0f};
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
    statistics->irradiance_uncached += c.uncached;
    statistics->irradiance_estimate_s += irradiance_counters_estimate_seconds(&c);
}

/* Settings with nothing left open. */
static ag_status settle_settings(ag_context *context, const ag_scene *loaded, const ag_render_settings *wanted)
{
    ag_render_settings *settings = &context->rendered;
    *settings = *wanted;
    if (settings->gather_samples == 0 && settings->samples_per_pixel > 0) {
        int rays = AG_DEFAULT_GATHER_RAYS_PER_PIXEL / settings->samples_per_pixel;
        settings->gather_samples = rays > 0 ? rays : 1;
    }
    if (loaded->s->has_camera)
        return render_settings_check(context, settings);
    log_message(context->log, AG_LOG_ERROR, "the scene has no Camera");
    return AG_ERROR_SCENE;
}

static ag_status render_into(ag_context *context, const scene *s, const pixel_filter *filter, ag_film *film)
{
    const ag_render_settings *settings = &context->rendered;
    ag_status status = AG_OK;
    if (!(rgb_max(s->light_power) > 0.0f))
        log_once(context->log, AG_LOG_WARNING, "no light", "the scene has no light that emits: the picture is black");

    /* light's side: lamps -> photons -> maps -> cache */
    maps m = {0};
    if (settings->integrator == AG_INTEGRATOR_PHOTONMAP)
        status = build_maps(context, s, settings, &m);

    /* the eye's side: tiles -> film */
    if (status == AG_OK) {
        transport t = make_transport(context, s, settings, &m);
        status = render_film(context, &t, filter, film);
        if (t.cache && status == AG_OK)
            count_irradiance(&context->statistics, t.cache);
    }
    maps_reset(&m);
    return status;
}

ag_status ag_render(ag_context *context, const ag_scene *loaded, const ag_render_settings *settings, ag_film **out_film)
{
    if (!context || !loaded || !settings || !out_film)
        return AG_ERROR_ARGUMENT;
    unsigned callers_arithmetic = floating_point_enter();
    uint64_t not_finite_before = context->statistics.samples_not_finite;
    ag_film *film = NULL;
    pixel_filter filter;
    ag_status status = settle_settings(context, loaded, settings);
    if (status == AG_OK)
        status = pixel_filter_create(&loaded->s->pixel_filter, loaded->s->options.disable_pixel_jitter, context->log,
                                     &filter);
    if (status == AG_OK) {
        film = film_create(&context->rendered);
        status = film ? AG_OK : AG_ERROR_MEMORY;
    }
    if (status == AG_OK && film->width == 0) {
        log_message(context->log, AG_LOG_ERROR, "the crop window holds no pixel");
        status = AG_ERROR_ARGUMENT;
    }
    if (status == AG_OK)
        status = render_into(context, loaded->s, &filter, film);
    floating_point_leave(callers_arithmetic);
    if (status != AG_OK) {
        ag_film_destroy(film);
        return status;
    }
    uint64_t not_finite = context->statistics.samples_not_finite - not_finite_before;
    if (not_finite > 0)
        log_message(context->log, AG_LOG_WARNING, "%llu camera samples were not finite and count as black",
                    (unsigned long long)not_finite);
    *out_film = film;
    return AG_OK;
}
