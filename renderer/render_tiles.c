/* render_tiles.c: see render_tiles.h. */
#include "render_tiles.h"

#include "clock.h"
#include "film/film_tiles.h"
#include "integrator/first_hit.h"
#include "integrator/integrator.h"
#include "integrator/sample_queue.h"
#include "status.h"
#include "tile_scheduler.h"

#include <stdlib.h>

enum { TILE_SIZE = 32 };

/* Tells the sequences of further camera rays from those of samples. */
static const uint32_t FURTHER_KEY = 0x66757274u;

/* --- workers --- */

void eye_workers_destroy(eye_worker *workers, unsigned count)
{
    for (unsigned i = 0; workers && i < count; i++) {
        arena_destroy(workers[i].scratch);
        gather_batch_destroy(workers[i].batch);
        sample_queue_destroy(workers[i].queue);
    }
    free(workers);
}

static bool eye_worker_reserve(eye_worker *worker, const transport *t)
{
    const integrator *kind = integrator_of(t->settings->integrator);
    worker->queue = sample_queue_create();
    return worker->queue && (!kind->reserve || kind->reserve(t, worker));
}

eye_worker *eye_workers_create(const transport *t, unsigned count)
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

/* --- tiles --- */

/* Tiles that a worker is through with, whose last samples may still be under way. Beyond these many tiles are shown at
 * the end of the pass. */
enum { TILES_TO_SHOW = 16 };
typedef struct tiles_to_show {
    film_area areas[TILES_TO_SHOW];
    int count;
} tiles_to_show;

typedef struct tile_job {
    ag_context *context;
    const transport *t;
    const integrator *kind;
    tile_scheduler *tiles;
    eye_worker *workers;
    tiles_to_show *to_show; /* [worker_count] */
    ag_film *film;
    float aspect;             /* of the frame */
    uint32_t wanted;          /* samples of each pixel */
    double sample_count;      /* all that are still to be taken */
    double samples_per_pixel; /* of those, in the mean */
    unsigned worker_count;
    atomic_u64 samples_done;             /* for the progress alone: relaxed */
    double progress_begin, progress_end; /* of the phase, before and after this pass */
} tile_job;

/* Returns the camera sample that these random numbers choose in a pixel, without its split and number. */
static camera_sample make_camera_sample(const tile_job *job, const sampler *where, int x, int y, int *out_sign,
                                        film_point *out_on_film)
{
    const transport *t = job->t;
    const ag_render_settings *settings = t->settings;
    vec2 offset = pixel_filter_sample(&job->film->filter, sampler_2d(where, SAMPLE_PIXEL, 0), out_sign);
    vec2 lens = t->s->hints.disable_pixel_jitter ? (vec2){0.5f, 0.5f} : sampler_2d(where, SAMPLE_LENS, 0);
    float time = !t->s->has_motion                  ? 0.0f
                 : t->s->hints.disable_pixel_jitter ? 0.5f
                                                    : sampler_2d(where, SAMPLE_TIME, 0).x;
    float width = (float)settings->width, height = (float)settings->height;
    film_point p = {((float)x + 0.5f + offset.x) / width, ((float)y + 0.5f + offset.y) / height, job->aspect, lens,
                    time};
    camera_sample from = {.ray = camera_generate_ray(&t->s->camera, p.film_x, p.film_y, p.aspect, lens, time),
                          .where = *where};
    if (t->pixel_share > 0.0f)
        from.ray.cone = camera_ray_cone(&t->s->camera, &from.ray, p.film_x, p.film_y, t->pixel_share / width,
                                        t->pixel_share / height, p.aspect, lens);
    *out_on_film = p;
    return from;
}

/* Adds the further camera rays of a sample, which run through sequences of their own. */
static void add_further(const tile_job *job, eye_worker *worker, int x, int y, const camera_sample *own,
                        eye_sample *out)
{
    const uint32_t light_cost = out->light_cost, bits = sampler_bits(own->split.further);
    const sampler apart = sampler_apart(&own->where, FURTHER_KEY + bits);
    uint64_t cost_before = eye_worker_cost(worker);
    for (uint32_t i = 0; i < own->split.further; i++) {
        int sign; /* always 1: filters with negative lobes have no further camera rays */
        film_point on_film;
        const sampler where = sampler_branch(&apart, bits, i);
        camera_sample from = make_camera_sample(job, &where, x, y, &sign, &on_film);
        from.split = own->split;
        from.number = own->number;
        from.is_further = true;
        job->kind->sample(job->t, worker, &from, out);
    }
    out->further_cost = (uint32_t)(eye_worker_cost(worker) - cost_before) - (out->light_cost - light_cost);
}

/* The sample of that index of a pixel, of that number in the worker's queue: all but the gathered light, which the
 * worker's batch brings later. */
static void render_sample(const tile_job *job, eye_worker *worker, int x, int y, uint32_t index, uint32_t number,
                          split_counts split, eye_sample *out)
{
    const transport *t = job->t;
    const ag_render_settings *settings = t->settings;
    const sampler where =
        sampler_make(settings->seed, x, y, index, sampler_bits((uint32_t)settings->samples_per_pixel));
    film_point on_film;
    camera_sample from = make_camera_sample(job, &where, x, y, &out->sign, &on_film);
    from.split = split;
    from.number = number;
    out->most_direct = settings->clamp_direct > 0.0f ? settings->clamp_direct : INFINITY;
    out->most_indirect = settings->clamp_indirect > 0.0f ? settings->clamp_indirect : INFINITY;
    uint64_t cost_before = eye_worker_cost(worker);
    job->kind->sample(t, worker, &from, out);
    out->rest_cost =
        (uint32_t)(eye_worker_cost(worker) - cost_before) - out->gather_cost - out->light_cost - out->caustic_cost;
    if (split.further > 0)
        add_further(job, worker, x, y, &from, out);
    if (out->layers && t->layout->needs_first_hit)
        first_hit_project(t, &on_film, &out->layers->first);
}

/* Shows the tiles that the worker has finished, while none of its samples is under way. */
static void show_tiles(const tile_job *job, const eye_worker *worker)
{
    tiles_to_show *done = &job->to_show[worker->index];
    for (int i = 0; i < done->count; i++)
        film_show(job->film, done->areas[i]);
    done->count = 0;
}

/* The worker is through with the tile. */
static void leave_tile(const tile_job *job, const eye_worker *worker, const tile *area)
{
    tiles_to_show *done = &job->to_show[worker->index];
    if (done->count < TILES_TO_SHOW)
        done->areas[done->count++] = (film_area){area->x0, area->y0, area->x1 - area->x0, area->y1 - area->y0};
    if (worker->queue->count == 0)
        show_tiles(job, worker);
}

/* Completes the samples under way. When the work is cancelled they do not count. */
static void finish_samples(tile_job *job, eye_worker *worker)
{
    const transport *t = job->t;
    gather_batch *batch = worker->batch;
    if (job->kind->complete && !run_is_cancelled(t->run))
        job->kind->complete(t, worker);
    uint32_t count = worker->queue->count;
    run_look(&job->context->run);
    if (count == 0 || run_is_cancelled(t->run))
        return;
    worker->samples_not_finite += sample_queue_deliver(worker->queue, batch ? batch->gathered : NULL,
                                                       (uint32_t)t->layout->group_count, job->film);
    uint64_t done = fetch_add_relaxed_u64(&job->samples_done, count) + count;
    show_tiles(job, worker);
    double share = (double)done / job->sample_count;
    run_progress(&job->context->run, AG_PHASE_RENDER,
                 job->progress_begin + share * (job->progress_end - job->progress_begin));
}

/* Whether the next sample is better begun when those under way are complete. */
static bool should_finish(const transport *t, const eye_worker *worker)
{
    const gather_batch *batch = worker->batch;
    return sample_queue_is_full(worker->queue) ||
           (batch && batch->query_count > 0 && batch->query_count + t->split.rays > IRRADIANCE_BATCH_MAX);
}

/* The samples that the pixel has not had yet, in their order, by the one thread that has its tile. */
static void render_pixel(tile_job *job, eye_worker *worker, int x, int y)
{
    ag_film *film = job->film;
    size_t pixel = film_pixel_at(film, x, y);
    uint32_t goal = film_goal(film, pixel, job->wanted);
    split_counts split = film->splits ? film->splits[pixel].counts : job->t->split;
    bool with_layers = job->t->wants_layers || noise_lattice_holds(&film->noise, pixel);
    for (uint32_t i = film->counts[pixel]; i < goal; i++) {
        if (run_is_cancelled(&job->context->run))
            return;
        uint32_t number = worker->queue->count;
        render_sample(job, worker, x, y, i, number, split, sample_queue_begin(worker->queue, pixel, with_layers));
        if (should_finish(job->t, worker))
            finish_samples(job, worker);
    }
}

/* Whether a worker that is through with the tile completes its samples, although there is room for more: when it has
 * so many under way that the others, done with all that is left, might wait for it. The share gets smaller with what is
 * left, down to a smallest tile's. A worker alone keeps nobody waiting. */
static bool should_share_out(const tile_job *job, const eye_worker *worker, uint64_t pixels_left)
{
    double left = (double)pixels_left * job->samples_per_pixel;
    return job->worker_count > 1 && worker->queue->count > left / (2.0 * job->worker_count);
}

static void add_tile_time(ag_film *film, tile area, float seconds)
{
    for (int y = area.y0; y < area.y1; y++)
        for (int x = area.x0; x < area.x1; x++)
            film->views[VIEW_TILE_TIME][film_pixel_at(film, x, y)] += seconds;
}

/* Samples under way may be of several tiles, unless each tile's time is asked for. */
static void work_on_tiles(void *user, unsigned worker_index)
{
    tile_job *job = user;
    eye_worker *worker = &job->workers[worker_index];
    float *times = job->film->views[VIEW_TILE_TIME];
    tile area;
    worker->queue->count = worker->queue->layers_count = 0;
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
        if (times || should_share_out(job, worker, area.left))
            finish_samples(job, worker);
        if (times)
            add_tile_time(job->film, area, (float)(clock_seconds() - begin));
        if (!run_is_cancelled(&job->context->run))
            leave_tile(job, worker, &area);
    }
    finish_samples(job, worker);
}

ag_status render_tiles(ag_rendering *r, uint32_t wanted)
{
    ag_context *context = r->context;
    ag_film *film = r->film;
    double most = (double)r->settings.samples_per_pixel;
    tile_job job = {.context = context,
                    .t = &r->t,
                    .kind = integrator_of(r->settings.integrator),
                    .film = film,
                    .aspect = r->aspect,
                    .workers = r->workers,
                    .wanted = wanted,
                    .worker_count = context->statistics.threads,
                    .progress_begin = r->is_pilot ? 0.0 : film_count_samples(film).mean / most,
                    .progress_end = r->is_pilot ? 0.0 : (double)wanted / most};
    const film_area *area = &film->area;
    AG_TRY(tile_scheduler_create(area->x0, area->y0, area->x0 + area->width, area->y0 + area->height, TILE_SIZE,
                                 context->statistics.threads, &job.tiles));
    for (size_t i = 0; i < film_area_count(film); i++) {
        uint32_t goal = film_goal(film, i, wanted);
        job.sample_count += film->counts[i] < goal ? (double)(goal - film->counts[i]) : 0.0;
    }
    job.samples_per_pixel = job.sample_count / (double)film_area_count(film);
    run_progress(&context->run, AG_PHASE_RENDER, job.progress_begin); /* the first pixels may take long */
    run_allow_pause(&context->run);
    job.to_show = calloc(job.worker_count, sizeof *job.to_show);
    if (!job.to_show) {
        tile_scheduler_destroy(job.tiles);
        return AG_ERROR_MEMORY;
    }
    thread_pool_run(context->pool, work_on_tiles, &job);
    bool is_paused = run_end_pause(&context->run);
    tile_scheduler_destroy(job.tiles);
    free(job.to_show);
    AG_TRY(context_check_textures(context, r->s));
    return run_is_cancelled(&context->run) ? AG_CANCELLED : is_paused ? AG_PAUSED : AG_OK;
}
