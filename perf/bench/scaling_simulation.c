/* scaling_simulation.c: see scaling_simulation.h. */
#include "bench/scaling_simulation.h"

#include "math/rng.h"
#include "tile_scheduler.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The renderer's own numbers: render_tiles.c, irradiance_cache.h. */
enum { TILE_SIZE = 32, BATCH_REQUESTS = 1 << 16 };
/* The lookup's share of a request's own time (perf/costs.md, "Where the time goes": 20 of 72). A batch has all its
 * lookups first, then computes what nobody has claimed, then reads what others have computed. */
static const double LOOKUP_SHARE = 0.28;
/* Looking at a slot that needs no work. */
static const double LOOK_S = 5e-9;
/* Slots that a worker looks at together, unless one is to be computed: what others do meanwhile is seen later by no
 * more than that takes. */
enum { LOOKS_PER_STEP = 16 };

typedef struct worker {
    double now_s;
    uint32_t *batch; /* photons, in the map's order once it is full */
    uint32_t count, capacity, at;
    uint32_t pixels; /* of the samples under way */
    uint32_t *met;   /* photons that others were computing */
    uint32_t met_count;
    bool is_looking, is_last;
} worker;

typedef struct simulation {
    const simulated_frame *frame;
    simulated_run *run;
    unsigned worker_count;
    worker *workers;
    double *ready_s; /* of each photon, when its slot is ready; INFINITY: it is empty */
    uint32_t *heap;  /* workers at work, the earliest first */
    unsigned heap_count;
    tile_scheduler *tiles;
    double tiles_free_s; /* when the next tile can be claimed */
} simulation;

uint32_t simulation_photons(uint64_t requests, uint64_t computed)
{
    double wanted = (double)computed, all = (double)requests, low = wanted, high = wanted * 1e6 + 1.0;
    for (int i = 0; i < 200; i++) {
        double middle = 0.5 * (low + high);
        if (middle * -expm1(-all / middle) < wanted)
            low = middle;
        else
            high = middle;
    }
    double rounded = low + 0.5;
    return rounded < 4e9 ? (uint32_t)rounded : 4000000000u;
}

/* --- the order of events --- */

static void sift_down(simulation *s, unsigned at)
{
    for (;;) {
        unsigned child = 2 * at + 1;
        if (child + 1 < s->heap_count && s->workers[s->heap[child + 1]].now_s < s->workers[s->heap[child]].now_s)
            child++;
        if (child >= s->heap_count || s->workers[s->heap[at]].now_s <= s->workers[s->heap[child]].now_s)
            return;
        uint32_t other = s->heap[child];
        s->heap[child] = s->heap[at];
        s->heap[at] = other;
        at = child;
    }
}

/* --- what a worker does --- */

static int by_photon(const void *a, const void *b)
{
    uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return x < y ? -1 : x > y;
}

static bool reserve(worker *w, uint32_t more)
{
    if (w->count + more <= w->capacity)
        return true;
    uint32_t capacity = 2 * (w->count + more);
    uint32_t *batch = realloc(w->batch, capacity * sizeof *batch);
    w->batch = batch ? batch : w->batch;
    uint32_t *met = realloc(w->met, capacity * sizeof *met);
    w->met = met ? met : w->met;
    w->capacity = batch && met ? capacity : w->capacity;
    return batch && met;
}

static void begin_looking(const simulation *s, worker *w)
{
    w->now_s += w->count * s->frame->own_s * LOOKUP_SHARE;
    if (w->count > 0)
        qsort(w->batch, w->count, sizeof *w->batch, by_photon);
    w->is_looking = true;
    w->at = w->met_count = 0;
}

/* A tile's rays, and its requests into the batch. */
static ag_status take_tile(simulation *s, worker *w)
{
    const simulated_frame *f = s->frame;
    tile t;
    if (w->now_s < s->tiles_free_s)
        w->now_s = s->tiles_free_s;
    w->now_s += f->tile_claim_s;
    s->tiles_free_s = w->now_s;
    if (!tile_scheduler_next(s->tiles, &t)) {
        w->is_last = true;
        begin_looking(s, w);
        return AG_OK;
    }
    uint32_t pixels = (uint32_t)((t.x1 - t.x0) * (t.y1 - t.y0));
    /* by its position: the same requests for any number of workers, and so for any tiles */
    for (int y = t.y0; y < t.y1; y++)
        for (int x = t.x0; x < t.x1; x++) {
            uint64_t pixel = (uint64_t)y * (uint64_t)f->width + (uint64_t)x;
            rng random = rng_make(0, 1, pixel), cost = rng_make(0, 2, (uint64_t)(y / 32) << 32 | (uint64_t)(x / 32));
            /* whole requests, as many on average */
            uint32_t count = (uint32_t)(f->requests_per_pixel * (double)(pixel + 1)) -
                             (uint32_t)(f->requests_per_pixel * (double)pixel);
            if (!reserve(w, count))
                return AG_ERROR_MEMORY;
            for (uint32_t i = 0; i < count; i++)
                w->batch[w->count++] = (uint32_t)((rng_next(&random) >> 32) * f->photons >> 32);
            /* uniform, of mean 1 and that deviation */
            double factor = 1.0 + f->tile_spread * sqrt(12.0) * ((double)rng_float(&cost) - 0.5);
            w->now_s += count * f->own_s * (1.0 - LOOKUP_SHARE) * (factor > 0.0 ? factor : 0.0);
        }
    w->pixels += pixels;
    bool is_full = w->count + (uint32_t)(f->requests_per_pixel * TILE_SIZE * TILE_SIZE) > BATCH_REQUESTS;
    bool others_might_wait = s->worker_count > 1 && w->pixels > (double)t.left / (2.0 * s->worker_count);
    if (is_full || others_might_wait)
        begin_looking(s, w);
    return AG_OK;
}

/* Irradiances that are still being computed when the batch is read are set aside, and waited for where that does not
 * suffice. */
static void end_batch(simulation *s, worker *w)
{
    double read_s = w->now_s;
    for (uint32_t i = 0; i < w->met_count; i++) {
        double ready_s = s->ready_s[w->met[i]];
        s->run->deferred += ready_s > read_s;
        if (ready_s > w->now_s) {
            s->run->waited++;
            s->run->waiting_s += ready_s - w->now_s;
            w->now_s = ready_s;
        }
    }
    w->count = w->pixels = 0;
    w->is_looking = false;
}

static void look_up(simulation *s, worker *w)
{
    const simulated_frame *f = s->frame;
    bool has_computed = false;
    for (int i = 0; i < LOOKS_PER_STEP && w->at < w->count && !has_computed; i++) {
        uint32_t photon = w->batch[w->at++];
        s->run->requests++;
        w->now_s += LOOK_S;
        if (isinf(s->ready_s[photon])) {
            w->now_s += f->claim_s + f->estimate_s;
            s->ready_s[photon] = w->now_s;
            s->run->computed++;
            has_computed = true;
        } else if (s->ready_s[photon] > w->now_s) {
            w->met[w->met_count++] = photon;
        }
    }
    if (w->at == w->count)
        end_batch(s, w);
}

static ag_status simulate(simulation *s)
{
    ag_status status = AG_OK;
    double idle_s = 0.0;
    while (s->heap_count > 0 && status == AG_OK) {
        worker *w = &s->workers[s->heap[0]];
        if (w->is_looking)
            look_up(s, w);
        else if (!w->is_last)
            status = take_tile(s, w);
        if (w->is_last && !w->is_looking) {
            if (w->now_s > s->run->seconds)
                s->run->seconds = w->now_s;
            idle_s -= w->now_s;
            s->heap[0] = s->heap[--s->heap_count];
        }
        sift_down(s, 0);
    }
    s->run->idle_s = idle_s + s->run->seconds * s->worker_count;
    return status;
}

ag_status simulation_run(const simulated_frame *of, unsigned workers, simulated_run *out_run)
{
    if (workers < 1 || workers > SIMULATION_WORKERS_MAX || of->photons < 1 || !(of->requests_per_pixel > 0.0) ||
        !(of->tile_spread >= 0.0 && of->tile_spread <= 1.0))
        return AG_ERROR_ARGUMENT;
    *out_run = (simulated_run){0};
    simulation s = {.frame = of, .run = out_run, .worker_count = workers, .heap_count = workers};
    s.workers = calloc(workers, sizeof *s.workers);
    s.heap = malloc(workers * sizeof *s.heap);
    s.ready_s = malloc(of->photons * sizeof *s.ready_s);
    ag_status status = s.workers && s.heap && s.ready_s ? AG_OK : AG_ERROR_MEMORY;
    if (status == AG_OK)
        status = tile_scheduler_create(0, 0, of->width, of->height, TILE_SIZE, workers, &s.tiles);
    if (status == AG_OK) {
        for (uint32_t i = 0; i < of->photons; i++)
            s.ready_s[i] = INFINITY;
        for (unsigned i = 0; i < workers; i++)
            s.heap[i] = i;
        status = simulate(&s);
    }
    for (unsigned i = 0; s.workers && i < workers; i++) {
        free(s.workers[i].batch);
        free(s.workers[i].met);
    }
    tile_scheduler_destroy(s.tiles);
    free(s.workers);
    free(s.heap);
    free(s.ready_s);
    return status;
}
