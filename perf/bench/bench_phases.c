/* bench_phases.c: see bench_phases.h. */
#include "bench/bench_phases.h"

#include "output/output_color.h"
#include "parallel_for.h"
#include "rays/rays.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { RAY_BLOCK = 2048, QUERY_BLOCK = 8192 };

static const struct {
    const char *name, *item;
} phases[BENCH_PHASE_COUNT] = {
    [BENCH_PHASE_PHOTONS] = {"photons", "photon"},
    [BENCH_PHASE_TREE] = {"tree", "photon"},
    [BENCH_PHASE_ESTIMATES] = {"estimates", "estimate"},
    [BENCH_PHASE_LOOKUPS] = {"lookups", "lookup"},
    [BENCH_PHASE_RAYS] = {"rays", "ray"},
    [BENCH_PHASE_SHADING] = {"shading", "sample"},
    [BENCH_PHASE_COLOR] = {"color", "pixel"},
    [BENCH_PHASE_FRAME] = {"frame", "frame"},
};

const char *bench_phase_name(bench_phase phase) { return phases[phase].name; }
const char *bench_phase_item(bench_phase phase) { return phases[phase].item; }

/* --- time and soundness --- */

static void begin_work(bench_outcome *o)
{
    *o = (bench_outcome){.seconds = -clock_seconds(), .cpu_s = -clock_process_cpu_seconds()};
}

static void end_work(bench_outcome *o)
{
    o->seconds += clock_seconds();
    o->cpu_s += clock_process_cpu_seconds();
    o->hash = hash128_begin();
}

static void add_numbers(bench_outcome *o, const float *values, size_t count)
{
    bool is_finite = true, is_black = true;
    for (size_t i = 0; i < count; i++) {
        is_finite = is_finite && isfinite(values[i]);
        is_black = is_black && values[i] == 0.0f;
    }
    o->is_sound = is_finite && !is_black;
    hash128_add(&o->hash, values, count * sizeof *values);
}

static void add_film(bench_outcome *o, const ag_film *film)
{
    int width, height;
    const float *pixels = ag_film_pixels(film, &width, &height);
    add_numbers(o, pixels, 3 * (size_t)width * (size_t)height);
}

/* --- the phases --- */

static ag_status trace(bench_stage *stage, ag_context *context, bench_outcome *out)
{
    bool has_caustics = stage->frame.caustic_photon_count > 0;
    photon_set sets[2] = {{0}, {0}};
    ag_status status = AG_OK;
    begin_work(out);
    for (int kind = 0; kind < 1 + has_caustics && status == AG_OK; kind++) {
        photon_tracing_settings tracing = bench_stage_tracing(stage, kind == 0 ? PHOTON_GLOBAL : PHOTON_CAUSTIC);
        status = photon_tracing_run(stage->scene->s, &context->run, &tracing, &sets[kind]);
    }
    end_work(out);
    for (int kind = 0; kind < 2; kind++) {
        hash128_add(&out->hash, sets[kind].photons, sets[kind].count * sizeof(photon));
        out->amount += sets[kind].count;
        photon_set_reset(&sets[kind]);
    }
    out->count = out->amount;
    out->expected = (uint64_t)stage->work->photons * (has_caustics ? 2 : 1);
    out->is_sound = out->count > 0;
    return status;
}

static ag_status build_tree(bench_stage *stage, ag_context *context, bench_outcome *out)
{
    photon_set copy = stage->photons;
    photon_map map;
    copy.photons = photon_records_create(copy.count);
    if (!copy.photons)
        return AG_ERROR_MEMORY;
    memcpy(copy.photons, stage->photons.photons, copy.count * sizeof *copy.photons);
    begin_work(out);
    ag_status status = photon_map_create(&context->run, &copy, &stage->map_settings, 0.0, 1.0, &map);
    end_work(out);
    if (status != AG_OK)
        return status;
    hash128_add(&out->hash, map.blocks, photon_block_count(map.set.count) * sizeof *map.blocks);
    out->amount = out->count = out->expected = map.set.count;
    out->is_sound = true;
    photon_map_reset(&map);
    return AG_OK;
}

static void add_slots(bench_stage *stage, const irradiance_cache *cache, bench_outcome *out)
{
    irradiance_cache_save(cache, stage->words);
    hash128_add(&out->hash, stage->words, cache->map->irradiance_photons.count * sizeof *stage->words);
}

static ag_status estimate_all(bench_stage *stage, ag_context *context, bench_outcome *out)
{
    irradiance_cache cache;
    ag_status status =
        irradiance_cache_create(&stage->map, IRRADIANCE_PRECOMPUTE, ag_context_thread_count(context), &cache);
    if (status != AG_OK)
        return status;
    for (uint32_t i = 0; i < stage->map.irradiance_photons.count; i++)
        store_relaxed_u32(photon_map_slot(&stage->map, i), 0);
    begin_work(out);
    status = irradiance_cache_precompute(&cache, &context->run);
    end_work(out);
    add_slots(stage, &cache, out);
    irradiance_counters c = irradiance_cache_counters(&cache);
    out->amount = out->count = c.computed;
    out->expected = stage->map.irradiance_photons.count;
    out->duplicated = c.duplicated;
    out->is_sound = true;
    irradiance_cache_reset(&cache);
    return status;
}

typedef struct lookup_job {
    bench_stage *stage;
    irradiance_cache *cache;
    run_context *run;
} lookup_job;

static void look_up(void *user, uint64_t begin, uint64_t end, uint64_t block, unsigned worker)
{
    (void)block;
    const lookup_job *job = user;
    bench_stage *stage = job->stage;
    irradiance_cache_get_many(job->cache, job->run, stage->queries + begin, (uint32_t)(end - begin), worker,
                              stage->irradiance + begin, stage->holds + begin);
}

static ag_status look_up_all(bench_stage *stage, ag_context *context, bench_outcome *out)
{
    irradiance_cache cache;
    ag_status status =
        irradiance_cache_create(&stage->map, IRRADIANCE_ON_DEMAND, ag_context_thread_count(context), &cache);
    if (status != AG_OK)
        return status;
    lookup_job job = {stage, &cache, &context->run};
    begin_work(out);
    status = parallel_for(&context->run, stage->query_count, QUERY_BLOCK, look_up, &job, AG_PHASE_RENDER, 0.0, 0.0);
    end_work(out);
    add_numbers(out, &stage->irradiance[0].r, 3 * (size_t)stage->query_count);
    hash128_add(&out->hash, stage->holds, stage->query_count * sizeof *stage->holds);
    irradiance_counters c = irradiance_cache_counters(&cache);
    out->amount = out->expected = stage->query_count;
    out->count = c.requests;
    out->duplicated = c.duplicated;
    irradiance_cache_reset(&cache);
    return status;
}

static void cast(void *user, uint64_t begin, uint64_t end, uint64_t block, unsigned worker)
{
    (void)block;
    (void)worker;
    bench_stage *stage = user;
    for (uint64_t i = begin; i < end; i++)
        stage->distances[i] = scene_first_distance(stage->scene->s, stage->rays[i]);
}

static ag_status cast_all(bench_stage *stage, ag_context *context, bench_outcome *out)
{
    uint32_t met = 0;
    begin_work(out);
    ag_status status =
        parallel_for(&context->run, stage->work->rays, RAY_BLOCK, cast, stage, AG_PHASE_RENDER, 0.0, 0.0);
    end_work(out);
    for (uint32_t i = 0; i < stage->work->rays; i++)
        met += isfinite(stage->distances[i]) ? 1 : 0;
    hash128_add(&out->hash, stage->distances, stage->work->rays * sizeof *stage->distances);
    out->amount = stage->work->rays;
    out->count = met;
    out->expected = stage->met_count;
    out->is_sound = met > 0;
    return status;
}

static ag_status shade(bench_stage *stage, ag_context *context, bench_outcome *out)
{
    ag_film *film;
    const ag_statistics *now = &context->statistics;
    uint64_t rays = now->rays_camera, not_finite = now->samples_not_finite;
    begin_work(out);
    ag_status status = ag_render(context, stage->scene, &stage->shading, &film);
    end_work(out);
    if (status != AG_OK)
        return status;
    add_film(out, film);
    ag_film_destroy(film);
    uint64_t side = (uint64_t)stage->work->shading_side;
    out->amount = out->expected = side * side * (uint64_t)stage->work->shading_samples;
    out->count = now->rays_camera - rays;
    out->is_sound = out->is_sound && now->samples_not_finite == not_finite;
    return AG_OK;
}

static ag_status color(bench_stage *stage, ag_context *context, bench_outcome *out)
{
    uint64_t count = stage->work->color_pixels;
    const ag_output_settings settings = ag_default_output_settings();
    ag_status status =
        output_color_check(context, &settings, false); /* the config is read when it is first asked for */
    memcpy(stage->shown, stage->colors, 3 * (size_t)count * sizeof *stage->shown);
    begin_work(out);
    if (status == AG_OK)
        status = output_color_apply(context, &settings, false, stage->shown, count);
    end_work(out);
    add_numbers(out, stage->shown, 3 * (size_t)count);
    out->amount = out->count = out->expected = count;
    return status;
}

static ag_status render_frame(bench_stage *stage, ag_context *context, bench_outcome *out)
{
    const ag_statistics before = context->statistics, *now = &context->statistics;
    ag_rendering *rendering = NULL;
    begin_work(out);
    ag_status status = ag_rendering_create(context, stage->scene, &stage->frame, &rendering);
    if (status == AG_OK)
        status = ag_rendering_continue(rendering, 1);
    end_work(out);
    if (status == AG_OK) {
        add_film(out, ag_rendering_film(rendering));
        add_slots(stage, &rendering->maps->cache, out);
    }
    ag_rendering_finish(rendering, NULL);
    out->amount = 1;
    out->requests = now->irradiance_requests - before.irradiance_requests;
    out->computed = now->irradiance_computed - before.irradiance_computed;
    out->deferred = now->irradiance_deferred - before.irradiance_deferred;
    out->waited = now->irradiance_waited - before.irradiance_waited;
    out->waited_s = now->irradiance_wait_s - before.irradiance_wait_s;
    out->duplicated = now->irradiance_duplicated - before.irradiance_duplicated;
    out->count = out->computed;
    out->expected = now->irradiance_distinct - before.irradiance_distinct;
    out->is_sound = out->is_sound && now->samples_not_finite == before.samples_not_finite;
    return status;
}

ag_status bench_phase_run(bench_stage *stage, ag_context *context, bench_phase phase, bench_outcome *out_outcome)
{
    static ag_status (*const run[BENCH_PHASE_COUNT])(bench_stage *, ag_context *, bench_outcome *) = {
        [BENCH_PHASE_PHOTONS] = trace,       [BENCH_PHASE_TREE] = build_tree,    [BENCH_PHASE_ESTIMATES] = estimate_all,
        [BENCH_PHASE_LOOKUPS] = look_up_all, [BENCH_PHASE_RAYS] = cast_all,      [BENCH_PHASE_SHADING] = shade,
        [BENCH_PHASE_COLOR] = color,         [BENCH_PHASE_FRAME] = render_frame,
    };
    return run[phase](stage, context, out_outcome);
}
