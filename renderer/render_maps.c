/* render_maps.c: see render_maps.h. */
#include "render_maps.h"

#include "caustic_radius.h"
#include "integrator/eye_pilot.h"
#include "last_frame.h"
#include "map_file.h"
#include "photon_aim.h"
#include "rays/transmittance.h"
#include "settings_table.h"
#include "status.h"
#include "strong_photons.h"

#include <stdlib.h>

maps *maps_hold(maps *m)
{
    m->holders++;
    return m;
}

void maps_release(maps *m)
{
    if (!m || --m->holders > 0)
        return;
    irradiance_cache_reset(&m->cache);
    incident_light_reset(&m->incident);
    last_frame_leave(m->context, &m->global, &m->forms);
    scene_forms_reset(&m->forms);
    photon_map_reset(&m->global);
    photon_map_reset(&m->caustic);
    photon_file_close(&m->file);
    free(m);
}

/* A caustic needs something to be focused by. */
static bool has_traced_lobes(const scene *s)
{
    for (uint32_t i = 0; i < s->shape_count; i++)
        if (scene_shape_is_traced(s, &s->shapes[i]))
            return true;
    return false;
}

bool maps_have_caustics(const scene *s, const ag_render_settings *settings)
{
    return settings->caustic_photon_count > 0 && settings->max_depth >= 2 && has_traced_lobes(s);
}

/* Traces one map's photons, after trials that tell which of them are of use; starts: see photon_aim.h. */
static ag_status trace_aimed(ag_context *context, const scene *s, float share, photon_tracing_settings tracing,
                             const emission_starts *starts, photon_set *out_set)
{
    photon_aim aim;
    ag_status status = photon_aim_learn(s, &context->run, &tracing, starts, share, &aim);
    const emission_guide *guide = &aim.guide;
    context->statistics.rays_photon += aim.tried.rays;
    if (guide->nodes)
        log_message(context->log, AG_LOG_INFO,
                    "photons are aimed: %u cells, %.3g times less variance expected, after %llu trials",
                    (guide->node_count + 1) / 2, (double)guide->gain, (unsigned long long)aim.tried.paths);
    if (aim.focus)
        log_message(context->log, AG_LOG_INFO, "light from afar is densest within %.3g of where it is asked for",
                    (double)aim.focus->radius);
    photon_aim_apply(&aim, &tracing);
    if (status == AG_OK)
        status = photon_tracing_run(s, &context->run, &tracing, out_set);
    if (status == AG_OK && out_set->parts > 0)
        log_message(context->log, AG_LOG_INFO, "photon paths were split into %llu parts more",
                    (unsigned long long)out_set->parts);
    photon_aim_reset(&aim);
    return status;
}

/* pilot: may be empty. */
static ag_status trace_after(ag_context *context, const scene *s, const ag_render_settings *settings,
                             const eye_pilot *pilot, photon_set *out_global, photon_set *out_caustic)
{
    bool wants_caustics = maps_have_caustics(s, settings);
    float share = settings->photon_aim;
    /* an arrival after n scatterings reaches the eye after n + 2 (gathered), or n + 1 (a caustic seen) */
    photon_tracing_settings tracing = {.kind = PHOTON_GLOBAL,
                                       .wanted = (uint32_t)settings->photon_count,
                                       .paths = settings->photon_paths,
                                       .max_scatterings = settings->max_depth - 2,
                                       .media_are_bounded = settings_bound_media(settings),
                                       .panes_are_direct = settings_panes_are_direct(settings),
                                       .filters_textures =
                                           settings->texture_filter == AG_TEXTURE_FILTER_ON && s->filters_textures,
                                       .seed = settings->photon_seed,
                                       .asked = &pilot->gathered,
                                       .onward = &pilot->onward,
                                       .ways = &pilot->ways,
                                       .progress_begin = 0.0,
                                       .progress_end = wants_caustics ? 0.7 : 1.0};
    if (settings->max_depth >= 2) {
        AG_TRY(trace_aimed(context, s, share, tracing, &pilot->starts, out_global));
    }
    if (wants_caustics) {
        tracing.kind = PHOTON_CAUSTIC;
        tracing.asked = &pilot->seen;
        tracing.onward = NULL;
        tracing.ways = &pilot->seen_ways;
        tracing.wanted = (uint32_t)settings->caustic_photon_count;
        tracing.paths = 0;
        tracing.max_scatterings = settings->max_depth - 1;
        tracing.progress_begin = 0.7;
        tracing.progress_end = 1.0;
        AG_TRY(trace_aimed(context, s, share, tracing, &(emission_starts){0}, out_caustic));
    }
    return AG_OK;
}

static ag_status trace_photons(ag_context *context, const scene *s, const ag_render_settings *settings,
                               photon_set *out_global, photon_set *out_caustic)
{
    eye_pilot pilot = {0};
    if (settings->photon_aim > 0.0f && settings->max_depth >= 2) {
        AG_TRY(eye_pilot_look(s, &context->run, settings, &pilot));
    }
    ag_status status = trace_after(context, s, settings, &pilot, out_global, out_caustic);
    eye_pilot_reset(&pilot);
    AG_TRY(status);
    AG_TRY(context_check_textures(context, s));
    run_progress(&context->run, AG_PHASE_PHOTONS, 1.0);
    return AG_OK;
}

/* The maps take over what the sets hold. */
static ag_status build_maps(ag_context *context, const scene *s, const ag_render_settings *settings, photon_set *global,
                            photon_set *caustic, photon_map *out_global, photon_map *out_caustic)
{
    const bool is_steady = settings->photon_paths > 0 && global->emitted_paths == settings->photon_paths;
    photon_map_settings map_settings = {.nearest = (uint32_t)settings->nearest,
                                        .max_radius = settings->radius,
                                        .surface_area = s->surface_area,
                                        .irradiance_fraction = settings->irradiance_fraction,
                                        .is_steady = is_steady,
                                        .surfaces = s};
    AG_TRY(photon_map_create(&context->run, global, &map_settings, 0.0, 0.7, out_global));
    /* caustics gather in spots: how many of their photons there are does not tell how far apart they lie */
    AG_TRY(caustic_radius_find(out_global, caustic, &map_settings.radius_bound));
    map_settings.irradiance_fraction = 1.0f;
    map_settings.is_steady = false;
    AG_TRY(strong_photons_divide(s, &context->run, photon_map_largest_radius(&map_settings, caustic->count), caustic));
    return photon_map_create(&context->run, caustic, &map_settings, 0.7, 1.0, out_caustic);
}

static void count_photons(ag_context *context, const photon_set *global, const photon_set *caustic)
{
    ag_statistics *statistics = &context->statistics;
    statistics->photons_emitted += global->emitted_paths + caustic->emitted_paths;
    statistics->photons_stored_global += global->count;
    statistics->photons_stored_caustic += caustic->count;
    statistics->rays_photon += global->rays + caustic->rays;
    transmittance_warn_of_cut(context->log, global->rays_cut + caustic->rays_cut);
    log_message(context->log, AG_LOG_INFO, "photons: %u in the global map, %u in the caustic map, %llu paths",
                global->count, caustic->count, (unsigned long long)(global->emitted_paths + caustic->emitted_paths));
}

static ag_status trace_maps(ag_context *context, const scene *s, const ag_render_settings *settings,
                            photon_map *out_global, photon_map *out_caustic)
{
    *out_global = *out_caustic = (photon_map){0};
    photon_set global = {0}, caustic = {0};
    phase_begin begin = context_begin_phase();
    ag_status status = trace_photons(context, s, settings, &global, &caustic);
    if (status == AG_OK) {
        context_end_phase(context, AG_PHASE_PHOTONS, begin);
        begin = context_begin_phase();
        status = build_maps(context, s, settings, &global, &caustic, out_global, out_caustic);
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
    count_photons(context, &out_global->set, &out_caustic->set);
    return AG_OK;
}

/* Takes from the last frame what is the same in this one. */
static ag_status follow_last_frame(maps *m, const scene *s)
{
    if (!m->global.reaches_squared)
        return AG_OK;
    phase_begin begin = context_begin_phase();
    ag_status status = scene_forms_create(s, &m->forms);
    if (status == AG_OK)
        status = last_frame_use(m->context, &m->forms, &m->global);
    context_add_to_phase(m->context, AG_PHASE_MAP, begin);
    return status;
}

static bool is_whole(const void *watched, bool thoroughly)
{
    const photon_file *file = watched;
    return thoroughly ? photon_file_is_intact(file) : photon_file_has_memory(file);
}

void maps_watch(const maps *m)
{
    if (m->file.is_shared)
        run_begin_watch(&m->context->run, is_whole, &m->file);
}

hash128 maps_photons_hash(maps *m)
{
    if (!m->has_photons_hash) {
        m->photons = hash128_begin();
        photon_map_add_hash(&m->global, &m->photons);
        photon_map_add_hash(&m->caustic, &m->photons);
        m->has_photons_hash = true;
    }
    return m->photons;
}

ag_status maps_create(ag_context *context, const scene *s, const ag_render_settings *settings, maps **out_maps)
{
    maps *m = *out_maps = calloc(1, sizeof *m);
    if (!m)
        return AG_ERROR_MEMORY;
    m->holders = 1;
    m->context = context;
    ag_statistics *statistics = &context->statistics;
    ag_status status;
    if (settings->photon_map_file)
        status = map_file_obtain(context, s, settings, trace_maps, &m->file, &m->global, &m->caustic);
    else
        status = trace_maps(context, s, settings, &m->global, &m->caustic);
    AG_TRY(status);
    maps_watch(m);
    AG_TRY(follow_last_frame(m, s));
    phase_begin guiding = context_begin_phase();
    AG_TRY(incident_light_create(&context->run, &m->global.tree, settings->gather_guiding, &m->incident));
    context_add_to_phase(context, AG_PHASE_MAP, guiding);
    log_message(context->log, AG_LOG_INFO, "estimates: %u nearest, %.4g at most, %.4g where light is spread evenly",
                m->global.nearest, (double)m->global.max_radius, (double)m->global.mean_radius);

    static const irradiance_cache_mode modes[] = {[AG_CACHE_ON_DEMAND] = IRRADIANCE_ON_DEMAND,
                                                  [AG_CACHE_PRECOMPUTE] = IRRADIANCE_PRECOMPUTE,
                                                  [AG_CACHE_OFF] = IRRADIANCE_UNCACHED};
    phase_begin caching = context_begin_phase();
    status = irradiance_cache_create(&m->global, modes[settings->cache], statistics->threads, &m->cache);
    if (status == AG_OK && m->file.is_shared)
        irradiance_cache_share(&m->cache, &m->file.owners);
    statistics->photon_bytes +=
        photon_map_bytes(&m->global) + photon_map_bytes(&m->caustic) + incident_light_bytes(&m->incident);
    statistics->irradiance_ready += m->cache.ready_before;
    context_add_to_phase(context, AG_PHASE_MAP, caching);
    if (status == AG_OK && settings->cache == AG_CACHE_PRECOMPUTE) {
        phase_begin begin = context_begin_phase();
        status = irradiance_cache_precompute(&m->cache, &context->run);
        context_end_phase(context, AG_PHASE_PRECOMPUTE, begin);
    }
    return status;
}
