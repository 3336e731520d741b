/* prediction.c: what a picture will take: memory from the sizes of what is held at its peak, time from a trial.
 * Rests on: the trial renders a lattice of the film's blocks just as the picture would, so all that is paid by the
 * sample grows with the number of pixels. Irradiance is computed at a photon once: how many photons more requests reach
 * follows from requests that are spread over the photons by a negative binomial distribution (Greenwood, Yule, "An
 * Inquiry into the Nature of Frequency Distributions", 1920), whose shape the trial tells. Flow: scene, settings ->
 * [here] -> program. Threads: as in afterglow.h. */
#include "integrator/gather_batch.h"
#include "integrator/integrator.h"
#include "integrator/sample_queue.h"
#include "photon_aim.h"
#include "public_structs.h"
#include "render_maps.h"
#include "split_pilot.h"
#include "status.h"

#include <malloc.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum {
    TRIAL_PHOTONS = 1000000, /* of each map, at most */
    TRIAL_BLOCKS = 256,      /* of a picture, in each of two trials, if that is a quarter of it or less */
    SMALL_SIDE = 64          /* of a film that tells what a pixel takes */
};

/* Measured: blocks, tree, and what there is meanwhile on the way to them. */
static const double BYTES_PER_PHOTON = 26.0;
/* Measured: stacks, arenas and what libraries hold for each thread. */
static const double BYTES_PER_THREAD = 1.5e6;
/* Measured: what aiming leaves behind of each trial of a round (photon_aim.c), by the global map and by the caustic
 * map: memory that is free again, between what is kept. Where loading has left such memory, that is used first. */
static const double AIM_BYTES_PER_TRIAL = 140.0, CAUSTIC_AIM_BYTES_PER_TRIAL = 50.0;
/* Measured: of path tracing, which keeps no samples back. */
static const double PATH_BYTES_PER_THREAD = 3e5;
/* A zipped value of a picture, over its size; it differs much, and counts little. */
static const double ZIPPED_SHARE = 0.5;
/* Measured: a value of an EXR file, most of it in zlib. */
static const double WRITE_SECONDS_PER_VALUE = 6e-8;

/* --- memory --- */

/* 0 where the system does not tell. */
static uint64_t resident_bytes(void)
{
    unsigned long long size = 0, resident = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (file && fscanf(file, "%llu %llu", &size, &resident) != 2)
        resident = 0;
    if (file)
        fclose(file);
    return resident * (uint64_t)sysconf(_SC_PAGESIZE);
}

static double pixels_of(const ag_render_settings *settings)
{
    const double *crop = settings->crop_window;
    return (crop[1] - crop[0]) * settings->width * (crop[3] - crop[2]) * settings->height;
}

/* The bytes of a pixel in the film, and on its way to a file, by a small film of these settings. */
static ag_status measure_pixel(ag_context *context, const scene *s, const ag_render_settings *settings,
                               double *out_film_bytes, double *out_file_bytes, int *out_channel_count)
{
    ag_rendering small = {.context = context, .s = s, .settings = *settings};
    film_plane planes[FILM_PLANES_MAX];
    small.settings.width = small.settings.height = SMALL_SIDE;
    small.settings.crop_window[0] = small.settings.crop_window[2] = 0.0;
    small.settings.crop_window[1] = small.settings.crop_window[3] = 1.0;
    ag_status status = rendering_create_film(&small);
    if (status == AG_OK) {
        double bytes = -(double)noise_lattice_bytes(&small.film->noise), pixel_count = SMALL_SIDE * SMALL_SIDE;
        const aov_layout *layout = &small.film->layout;
        for (int i = film_planes(small.film, planes) - 1; i >= 0; i--)
            bytes += (double)planes[i].size;
        *out_film_bytes = bytes / pixel_count + 3.0 * sizeof(float); /* 3 floats: the finished picture */
        *out_file_bytes = 0.0;
        for (int c = 0; c < layout->channel_count; c++)
            *out_file_bytes += sizeof(float) + ZIPPED_SHARE * (layout->channels[c].is_exact ? 4.0 : 2.0);
        *out_channel_count = layout->channel_count;
    }
    ag_film_destroy(small.film);
    return status;
}

void ag_context_expect_host_memory(ag_context *context, uint64_t bytes)
{
    if (context)
        context->host_bytes = bytes;
}

static double aim_bytes_of(const scene *s, const ag_render_settings *settings)
{
    if (!(settings->photon_aim > 0.0f) || settings->max_depth < 2)
        return 0.0;
    double bytes = AIM_BYTES_PER_TRIAL * (double)photon_aim_round_trials(settings->photon_count);
    if (maps_have_caustics(s, settings))
        bytes += CAUSTIC_AIM_BYTES_PER_TRIAL * (double)photon_aim_round_trials(settings->caustic_photon_count);
    return fmax(bytes - (double)mallinfo2().fordblks, 0.0);
}

static ag_status predict_memory(ag_context *context, const scene *s, const ag_render_settings *settings,
                                ag_prediction *out, int *out_channel_count)
{
    const bool has_map = integrator_of(settings->integrator)->has_photon_map;
    const double threads = context->statistics.threads, pixels = pixels_of(settings);
    double film, file;
    ag_status status = measure_pixel(context, s, settings, &film, &file, out_channel_count);
    if (status != AG_OK)
        return status;
    double photons = 0.0, thread = PATH_BYTES_PER_THREAD;
    uint64_t spaces = 0;
    if (has_map) {
        const double fraction = (double)settings->irradiance_fraction;
        photons = (double)settings->photon_count * (fraction < 1.0 ? 1.0 + fraction : 1.0);
        photons += maps_have_caustics(s, settings) ? (double)settings->caustic_photon_count : 0.0;
        spaces = photon_map_spaces_bytes(s, settings->photon_count);
        thread = BYTES_PER_THREAD + sizeof(sample_queue) + sizeof(gather_batch);
    }
    out->memory_scene_bytes = resident_bytes();
    out->memory_photon_bytes =
        (uint64_t)(BYTES_PER_PHOTON * photons + (has_map ? aim_bytes_of(s, settings) : 0.0)) + spaces;
    out->memory_thread_bytes = (uint64_t)(thread * threads);
    /* with a kept map, the film of a finished pass is copied */
    out->memory_film_bytes = (uint64_t)(film * pixels * (settings->photon_map_file ? 2.0 : 1.0));
    out->memory_host_bytes = context->host_bytes;
    out->memory_file_bytes = (uint64_t)(file * pixels);
    const uint64_t rendering = out->memory_photon_bytes + out->memory_thread_bytes;
    const uint64_t most = rendering > out->memory_file_bytes ? rendering : out->memory_file_bytes;
    out->memory_needed_bytes = out->memory_scene_bytes + out->memory_film_bytes + out->memory_host_bytes + most;
    out->memory_optional_bytes = most - out->memory_file_bytes < spaces ? most - out->memory_file_bytes : spaces;
    const uint64_t before = peak_memory_bytes();
    out->memory_peak_bytes = out->memory_needed_bytes > before ? out->memory_needed_bytes : before;
    return AG_OK;
}

/* --- time --- */

/* The part of the photons that is reached at least once by `mean` requests each on average, where these are spread by a
 * negative binomial distribution of this evenness (its shape): small where a few photons get most of them. */
static double share_reached(double mean, double evenness) { return 1.0 - exp(-evenness * log1p(mean / evenness)); }

/* How many of count photons `requests` reach, when those of the trial reached `reached`. */
static double predict_reached(double count, double reached, double trial_requests, double requests)
{
    const double share = reached / count, trial_mean = trial_requests / count;
    double low = 1e-6, high = 1e6;
    if (!(reached > 0.0) || !(count > 0.0))
        return 0.0;
    for (int i = 0; i < 100; i++) { /* the more evenly they are spread, the more are reached */
        const double middle = sqrt(low * high);
        *(share_reached(trial_mean, middle) < share ? &low : &high) = middle;
    }
    return count * share_reached(requests / count, low);
}

/* The time that the blocks of a trial have taken. */
typedef struct trial {
    double cpu_s, pixels, samples;
    double computed, requests; /* of irradiance at photons */
} trial;

/* Of two trials one after the other. The second finds most of the irradiance there: what it takes less tells what
 * computing it takes. timed_s: the same by a clock, which is read too seldom and takes time itself. */
static double seconds_of_estimate(const trial *first, const trial *second, double timed_s)
{
    const double fewer = first->computed * second->samples - second->computed * first->samples;
    const double less_s = first->cpu_s * second->samples - second->cpu_s * first->samples;
    const double estimate_s = fewer > 0.0 ? less_s / fewer : timed_s;
    return fmin(fmax(estimate_s, 0.5 * timed_s), timed_s);
}

/* CPU seconds of the whole picture's samples, with the pilot's, and of the irradiance that is computed before. */
static double predict_samples(const ag_rendering *r, const ag_render_settings *settings, const trial *pilot,
                              const trial trials[2], double photons_grown, double *out_precompute_s)
{
    const double grown = (double)film_area_count(r->film) / (trials[0].pixels + trials[1].pixels);
    const double cpu_s = trials[0].cpu_s + trials[1].cpu_s;
    *out_precompute_s = 0.0;
    if (!r->t.cache)
        return pilot->cpu_s + cpu_s * grown;
    const irradiance_counters c = irradiance_cache_counters(r->t.cache);
    const double computed = trials[0].computed + trials[1].computed, made = (double)c.computed + (double)c.uncached;
    const double timed_s = made > 0.0 ? irradiance_counters_estimate_seconds(&c) / made : 0.0;
    const double each_s = seconds_of_estimate(&trials[0], &trials[1], timed_s);
    const double count = (double)r->maps->global.irradiance_photons.count,
                 rest_s =
                     fmax(pilot->cpu_s - each_s * pilot->computed, 0.0) + fmax(cpu_s - each_s * computed, 0.0) * grown;
    if (settings->cache == AG_CACHE_PRECOMPUTE) {
        *out_precompute_s = each_s * count * photons_grown;
        return rest_s;
    }
    const double tried = trials[0].requests + trials[1].requests, requests = pilot->requests + tried * grown;
    const double reached =
        predict_reached(count, pilot->computed + computed, pilot->requests + tried, requests / photons_grown);
    return rest_s + each_s * photons_grown * reached;
}

/* The picture's pilot (split_pilot.h), or the blocks of one trial. */
static ag_status render_trial(ag_rendering *r, bool is_pilot, trial *out)
{
    ag_film *film = r->film;
    const double cpu_before = clock_process_cpu_seconds();
    irradiance_counters before = {0}, after = {0};
    if (r->t.cache)
        before = irradiance_cache_counters(r->t.cache);
    ag_status status;
    do /* a pause is for snapshots, and there is none of a trial */
        status = is_pilot ? split_pilot_run(r) : ag_rendering_continue(r, r->settings.samples_per_pixel);
    while (status == AG_PAUSED);
    if (r->t.cache)
        after = irradiance_cache_counters(r->t.cache);
    *out = (trial){.cpu_s = clock_process_cpu_seconds() - cpu_before,
                   .computed = (double)(after.computed - before.computed),
                   .requests = (double)(after.requests - before.requests)};
    for (size_t i = 0; i < film_area_count(film); i++) {
        out->pixels += !film_is_left_out(film, i);
        out->samples += film->counts[i];
    }
    return status;
}

static unsigned greatest_common_divisor(unsigned a, unsigned b)
{
    return b == 0 ? a : greatest_common_divisor(b, a % b);
}

/* A lattice is even where a row is turned against the next by about the golden ratio of the step. */
static unsigned even_turn(unsigned step)
{
    unsigned turn = (unsigned)(0.6180339887 * step);
    while (greatest_common_divisor(step, turn) != 1)
        turn++;
    return turn;
}

/* Two trials, of blocks that lie between each other's. */
static ag_status render_trials(ag_rendering *r, trial out_trials[2])
{
    ag_film *film = r->film;
    const double blocks = (double)film_area_count(film) / (FILM_BLOCK * FILM_BLOCK);
    film->trial_step = blocks < 4.0 * TRIAL_BLOCKS ? 4 : (unsigned)(blocks / TRIAL_BLOCKS);
    film->trial_turn = even_turn(film->trial_step);
    ag_status status = render_trial(r, false, &out_trials[0]);
    film_clear(film, &r->settings);
    film->trial_first = film->trial_step / 2;
    return status == AG_OK ? render_trial(r, false, &out_trials[1]) : status;
}

/* CPU seconds of the phases that make the maps. */
typedef struct map_cost {
    double cpu_s[AG_PHASE_COUNT];
} map_cost;

static map_cost cost_since(const ag_statistics *now, const ag_statistics *before)
{
    map_cost cost = {{0}};
    for (int i = AG_PHASE_PHOTONS; i <= AG_PHASE_MAP; i++)
        cost.cpu_s[i] = now->phase_cpu_s[i] - before->phase_cpu_s[i];
    return cost;
}

/* The cost of maps of fewer photons than those tried. The difference tells what each photon costs; the rest is paid
 * once, as for finding out where photons go. */
typedef struct fewer_photons {
    map_cost maps;
    double cpu_s; /* of measuring that */
    double step;  /* of the way from the tried counts to the wanted ones, back; HUGE_VAL: nothing was measured */
} fewer_photons;

/* Measures it in silence, since the trial that follows says the same. */
static fewer_photons measure_fewer(ag_context *context, const ag_scene *loaded, const uint64_t wanted[2],
                                   const ag_render_settings *tried)
{
    static const double PART = 0.45; /* fewer than those tried: a round of trials (photon_aim.h) has as many then */
    const uint64_t counts[2] = {tried->photon_count, tried->caustic_photon_count};
    fewer_photons out = {.step = HUGE_VAL};
    for (int i = 0; i < 2; i++)
        if (wanted[i] > counts[i])
            out.step = fmin(out.step, PART * (double)counts[i] / (double)(wanted[i] - counts[i]));
    if (out.step == HUGE_VAL)
        return out;
    ag_render_settings fewer = *tried;
    fewer.photon_count -= (uint64_t)(out.step * (double)(wanted[0] - counts[0]));
    fewer.caustic_photon_count -= (uint64_t)(out.step * (double)(wanted[1] - counts[1]));
    const ag_statistics before = context->statistics;
    const double cpu_before = clock_process_cpu_seconds();
    ag_log_fn *const told = log_silence(context->log);
    ag_rendering *r;
    if (ag_rendering_create(context, loaded, &fewer, &r) == AG_OK) {
        out.maps = cost_since(&context->statistics, &before);
        ag_rendering_finish(r, NULL);
    } else {
        out.step = HUGE_VAL; /* the trial that follows says why */
    }
    log_speak(context->log, told);
    out.cpu_s = clock_process_cpu_seconds() - cpu_before;
    return out;
}

/* Returns what the wanted photons cost. tried_s: the tried ones; fewer_s: fewer, by step; photons_grown: the wanted
 * ones over the tried ones. At most, all is paid by the photon; and at least a part, since on a busy machine the
 * difference of two times tells little. */
static double cost_of_wanted(double tried_s, double fewer_s, double step, double photons_grown)
{
    static const double PART_LEAST = 0.4;
    const double more = tried_s * (photons_grown - 1.0);
    return tried_s + fmin(fmax(fmax(tried_s - fewer_s, 0.0) / step, PART_LEAST * more), more);
}

static double at_most(uint64_t count, uint64_t most) { return count > most ? (double)count / (double)most : 1.0; }

/* A prediction renders a trial instead of the picture: with its settings, but at most TRIAL_PHOTONS in each map. */
typedef struct trial_plan {
    ag_render_settings tried;
    uint64_t wanted[2];                 /* photons of the picture's global and caustic map */
    double global_grown, photons_grown; /* wanted photons over tried ones: of the global map, and of both together */
} trial_plan;

static trial_plan plan_trial(const scene *s, const ag_render_settings *settings)
{
    trial_plan plan = {
        .tried = *settings,
        .wanted = {settings->photon_count, maps_have_caustics(s, settings) ? settings->caustic_photon_count : 0},
        .global_grown = at_most(settings->photon_count, TRIAL_PHOTONS)};
    ag_render_settings *tried = &plan.tried;
    tried->photon_count = (uint64_t)((double)plan.wanted[0] / plan.global_grown);
    tried->caustic_photon_count = (uint64_t)((double)plan.wanted[1] / at_most(plan.wanted[1], TRIAL_PHOTONS));
    tried->photon_map_file = NULL;
    tried->photon_paths = 0; /* what the last frame left is for the picture itself */
    tried->cache = settings->cache == AG_CACHE_PRECOMPUTE ? AG_CACHE_ON_DEMAND : settings->cache;
    const double tried_photons = (double)(tried->photon_count + tried->caustic_photon_count);
    plan.photons_grown = (double)(plan.wanted[0] + plan.wanted[1]) / fmax(tried_photons, 1.0);
    return plan;
}

/* Predicts the time of the phases that make the maps, which the trial made between two statistics. Returns how many CPU
 * seconds the wanted maps take more than the tried ones. */
static double predict_maps(const ag_statistics *before, const ag_statistics *after, const fewer_photons *fewer,
                           double photons_grown, ag_prediction *out)
{
    const map_cost tried = cost_since(after, before);
    double more_cpu_s = 0.0;
    for (int i = AG_PHASE_PHOTONS; i <= AG_PHASE_MAP; i++) {
        const double tried_s = tried.cpu_s[i];
        const double wanted_s = cost_of_wanted(tried_s, fewer->maps.cpu_s[i], fewer->step, photons_grown);
        /* some of it is one thread's; what takes longer than that has waited for a processor */
        out->time_s[i] = fmin(after->time_s[i] - before->time_s[i], tried_s);
        out->time_s[i] *= tried_s > 0.0 ? wanted_s / tried_s : 1.0;
        more_cpu_s += wanted_s - tried_s;
    }
    return more_cpu_s;
}

static ag_status predict_time(ag_context *context, const ag_scene *loaded, const ag_render_settings *settings,
                              int channel_count, ag_prediction *out)
{
    const trial_plan plan = plan_trial(loaded->s, settings);
    fewer_photons fewer = {.step = HUGE_VAL};
    if (integrator_of(settings->integrator)->has_photon_map)
        fewer = measure_fewer(context, loaded, plan.wanted, &plan.tried);

    const ag_statistics before = context->statistics, *after = &context->statistics;
    ag_rendering *r;
    trial pilot = {0}, trials[2] = {0};
    AG_TRY(ag_rendering_create(context, loaded, &plan.tried, &r));
    const double preparing_s = after->phase_cpu_s[AG_PHASE_RENDER] - before.phase_cpu_s[AG_PHASE_RENDER];
    ag_status status = render_trial(r, true, &pilot);
    if (status == AG_OK)
        status = render_trials(r, trials);
    if (status == AG_OK) {
        double precompute_s;
        const double render_s =
            preparing_s + predict_samples(r, settings, &pilot, trials, plan.global_grown, &precompute_s);
        const double write_s = WRITE_SECONDS_PER_VALUE * channel_count * pixels_of(settings);
        const double measuring_s = fewer.cpu_s + pilot.cpu_s + trials[0].cpu_s + trials[1].cpu_s + preparing_s;
        out->samples_per_pixel = (trials[0].samples + trials[1].samples) / (trials[0].pixels + trials[1].pixels);
        out->cpu_s = clock_process_cpu_seconds() - measuring_s + precompute_s + render_s + write_s;
        for (int i = 0; i < AG_PHASE_COUNT; i++) /* of the scene: they are over */
            out->time_s[i] = before.time_s[i];
        out->cpu_s += predict_maps(&before, after, &fewer, plan.photons_grown, out);
        out->time_s[AG_PHASE_PRECOMPUTE] = precompute_s / after->threads;
        out->time_s[AG_PHASE_RENDER] = render_s / after->threads;
        out->time_s[AG_PHASE_WRITE] = before.time_s[AG_PHASE_WRITE] + write_s;
        for (int i = 0; i < AG_PHASE_COUNT; i++)
            out->time_total_s += out->time_s[i];
    }
    ag_rendering_finish(r, NULL);
    return status;
}

static ag_status predict(ag_context *context, const ag_scene *loaded, const ag_render_settings *wanted, bool with_time,
                         void *out_prediction, size_t struct_size)
{
    if (!context || !loaded || !wanted || !out_prediction)
        return AG_ERROR_ARGUMENT;
    AG_TRY(scene_check_complete(context, loaded));
    ag_render_settings settings;
    ag_prediction made = {0};
    int channel_count = 0;
    const ag_statistics statistics = context->statistics;
    const ag_render_settings rendered = context->rendered;
    ag_status status = rendering_settle(context, loaded->s, wanted, &settings);
    if (status == AG_OK)
        status = predict_memory(context, loaded->s, &settings, &made, &channel_count);
    if (status == AG_OK && with_time)
        status = predict_time(context, loaded, &settings, channel_count, &made);
    context->statistics = statistics; /* trials are nothing of a picture */
    context->rendered = rendered;
    if (status != AG_OK)
        return status;
    context->rendered = settings;
    context->rendered.photon_map_file = NULL; /* the caller's */
    context->prediction = made;
    public_struct_write_part(&made, sizeof made, out_prediction, struct_size);
    return AG_OK;
}

ag_status ag_predict_memory_fill(ag_context *context, const ag_scene *loaded, const ag_render_settings *settings,
                                 void *out_prediction, size_t struct_size)
{
    return predict(context, loaded, settings, false, out_prediction, struct_size);
}

ag_status ag_predict_fill(ag_context *context, const ag_scene *loaded, const ag_render_settings *settings,
                          void *out_prediction, size_t struct_size)
{
    return predict(context, loaded, settings, true, out_prediction, struct_size);
}
