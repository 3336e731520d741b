/* render.c: the whole flow: ag_rendering_create makes a film, photon maps and guides; ag_rendering_continue brings
 * samples into the film, pass by pass; ag_rendering_finish hands the film over. Rests on: Jensen 1996; Christensen
 * 1999; Neilson, Yang, TR 04-21, 2004. Threads: one phase after the other, each on all of the context's workers; what a
 * phase made is const in the next. */
#define _POSIX_C_SOURCE 200809L
#include "film/adaptive.h"
#include "film/film_copy.h"
#include "film/splitting.h"
#include "floating_point.h"
#include "integrator/debug_views.h"
#include "integrator/direct_pilot.h"
#include "integrator/eye_pilot.h"
#include "integrator/integrator.h"
#include "odd_scene.h"
#include "render_maps.h"
#include "render_tiles.h"
#include "rendering_counts.h"
#include "settings_table.h"
#include "status.h"

#include <stdlib.h>
#include <string.h>

/* Brings all pixels to `wanted` samples, with stops to decide into how many the next samples are split. */
static ag_status render_passes(ag_rendering *r, uint32_t wanted)
{
    ag_film *film = r->film;
    for (;;) {
        uint32_t next = film->splits ? splitting_decide(film, &r->settings, wanted) : wanted;
        ag_status status = render_tiles(r, next);
        if (status != AG_OK || next == wanted)
            return status;
    }
}

/* Brings pixels to `wanted` samples at most, with stops to decide which of them need more. */
static ag_status render_adaptively(ag_rendering *r, uint32_t wanted)
{
    ag_film *film = r->film;
    bool is_done = false;
    ag_status status = AG_OK;
    uint32_t barrier = adaptive_barrier(film);
    while (status == AG_OK && !is_done) {
        if (barrier > 0)
            status = render_passes(r, barrier < wanted ? barrier : wanted);
        if (barrier >= wanted || status != AG_OK)
            break;
        status = adaptive_decide(film, &r->context->run, &r->settings, &is_done);
        barrier = adaptive_barrier(film);
    }
    return status;
}

/* Returns the width that one sample stands for, as a share of a pixel's. The samples share the pixel and, by its
 * filter, some of the pixels around it. It is no less than a quarter, since adaptive samples are fewer than their
 * number in the settings. */
static float pixel_share(const scene *s, const ag_render_settings *settings)
{
    static const float FILTER_WIDTH = 1.5f, SHARE_MIN = 0.25f;
    if (settings->texture_filter != AG_TEXTURE_FILTER_ON || !s->filters_textures)
        return 0.0f;
    return fminf(fmaxf(FILTER_WIDTH / sqrtf((float)settings->samples_per_pixel), SHARE_MIN), 1.0f);
}

static transport make_transport(ag_context *context, const scene *s, const ag_render_settings *settings,
                                const aov_layout *layout)
{
    transport t = {
        .s = s,
        .run = &context->run,
        .settings = settings,
        .split = sample_split_first(settings, integrator_of(settings->integrator)->splits_samples),
        .ray_bits = sampler_bits(sample_split_most(settings, integrator_of(settings->integrator)->splits_samples).rays),
        .layout = layout,
        .wants_layers = layout->needs_layers,
        .wants_groups = aov_has(layout, SUM_GROUPS),
        .pixel_share = pixel_share(s, settings),
        .has_lights = rgb_max(s->light_power) > 0.0f,
        .media_are_bounded = settings_bound_media(settings),
        .panes_are_direct = s->has_panes && settings_panes_are_direct(settings)};
    for (uint32_t i = 0; i < s->light_count; i++)
        t.can_meet_lights = t.can_meet_lights || light_can_be_met(&s->lights[i]);
    return t;
}

/* --- settings that are left open --- */

/* Few samples do not show what many photons are for, and tracing these would be most of the work: in three interiors
 * at a sample or four of 57,600 pixels, error times CPU time is least at one to four photons for each sample. With a
 * level of noise, most pixels of such rooms end at the least number of samples. */
enum { PHOTONS_PER_SAMPLE = 2, PHOTONS_LEAST = 131072 };

/* The map of one picture alone is made for its samples. */
static bool has_map_of_its_own(const ag_render_settings *settings)
{
    return !settings->photon_map_file && settings->photon_paths == 0;
}

/* The least number of camera samples of the whole frame. */
static double sample_count(const ag_render_settings *settings)
{
    return (double)settings->width * (double)settings->height * (double)adaptive_least_samples(settings);
}

static uint64_t automatic_photon_count(const ag_render_settings *settings)
{
    if (!has_map_of_its_own(settings))
        return AG_DEFAULT_PHOTONS_MOST;
    return (uint64_t)fmin(fmax(PHOTONS_PER_SAMPLE * sample_count(settings), PHOTONS_LEAST), AG_DEFAULT_PHOTONS_MOST);
}

/* In the open most gather rays meet nothing, and the map's squared error is less of the picture's by e^2, where e is
 * the share that is enclosed: as many photons less leave it as it is in a room, for which e is four fifths and more. So
 * of n samples an open view has PHOTONS_PER_ROOT sqrt(n) (e / ROOM_LEAST)^2 photons: in small pictures, where photons
 * are most of the time, fewer than a room; in large ones as many, by the root of the samples, since the product of an
 * error of a + b / photons and a time of c samples + d photons is least so. The factor, like the least number, is one
 * with which a few open scenes of 160 x 120 pixels are near their best (perf/pictures.md). */
static const double PHOTONS_PER_ROOT = 1400.0, ROOM_LEAST = 0.8, PHOTONS_IN_THE_OPEN_LEAST = 16384.0;

static ag_status take_fewer_in_the_open(ag_context *context, const scene *s, ag_render_settings *in_out_settings)
{
    double enclosure;
    phase_begin begin = context_begin_phase();
    ag_status status = eye_pilot_find_enclosure(s, &context->run, in_out_settings, &enclosure);
    context_add_to_phase(context, AG_PHASE_PHOTONS, begin);
    if (status != AG_OK || enclosure >= ROOM_LEAST)
        return status;
    const double share = enclosure / ROOM_LEAST;
    const double base = fmax(PHOTONS_PER_ROOT * sqrt(sample_count(in_out_settings)), PHOTONS_LEAST);
    const double count = fmax(base * share * share, PHOTONS_IN_THE_OPEN_LEAST);
    if (count < (double)in_out_settings->photon_count)
        in_out_settings->photon_count = (uint64_t)count;
    return AG_OK;
}

ag_status rendering_settle(ag_context *context, const scene *s, const ag_render_settings *wanted,
                           ag_render_settings *out_settings)
{
    AG_TRY(context_check_struct(context, "ag_render_settings", wanted->struct_size, sizeof *wanted));
    *out_settings = *wanted;
    if (out_settings->photon_seed == AG_PHOTON_SEED_AUTOMATIC)
        out_settings->photon_seed = out_settings->seed;
    if (out_settings->photon_count == AG_PHOTON_COUNT_AUTOMATIC)
        out_settings->photon_count = automatic_photon_count(out_settings);
    if (out_settings->caustic_photon_count == AG_PHOTON_COUNT_AUTOMATIC)
        out_settings->caustic_photon_count = automatic_photon_count(out_settings) / 2;
    if (out_settings->photon_aim == AG_PHOTON_AIM_AUTOMATIC)
        out_settings->photon_aim = has_map_of_its_own(out_settings) ? AG_DEFAULT_PHOTON_AIM : 0.0f;
    if (out_settings->gather_guiding == AG_GATHER_GUIDING_AUTOMATIC)
        out_settings->gather_guiding = out_settings->photon_paths > 0 ? 0.0f : AG_DEFAULT_GATHER_GUIDING;
    const integrator *kind = integrator_of(out_settings->integrator);
    if (kind && out_settings->direct_guiding == AG_DIRECT_GUIDING_AUTOMATIC)
        out_settings->direct_guiding = kind->direct_guiding;
    if (!s->has_camera) {
        log_message(context->log, AG_LOG_ERROR, "the scene has no Camera");
        return AG_ERROR_SCENE;
    }
    AG_TRY(render_settings_check(context, out_settings));
    const bool may_be_open = wanted->photon_count == AG_PHOTON_COUNT_AUTOMATIC && has_map_of_its_own(out_settings) &&
                             kind->has_photon_map && out_settings->max_depth >= 2;
    return may_be_open ? take_fewer_in_the_open(context, s, out_settings) : AG_OK;
}

/* --- a photon map that others can reach --- */

/* Called after a pass, or after what comes before the first, with its status: what was done counts only where the map's
 * file is still whole. Ends the watch over it. */
static ag_status check_map(ag_rendering *r, ag_status status)
{
    run_end_watch(&r->context->run);
    const bool was_broken_off = run_end_break(&r->context->run); /* by a look that may have another answer now */
    if (!r->maps || !r->maps->file.is_shared || (status != AG_OK && status != AG_PAUSED && status != AG_CANCELLED))
        return status;
    if (!was_broken_off && photon_file_is_intact(&r->maps->file)) {
        ag_status kept = film_copy_take(r->film, &r->kept);
        return kept == AG_OK ? status : kept;
    }
    if (r->kept)
        film_copy_restore(r->film, r->kept);
    if (r->film && film_count_samples(r->film).most == 0)
        split_prior_reset(&r->film->prior); /* the pilot has read the map, too */
    log_message(
        r->context->log, AG_LOG_ERROR,
        "'%s': the photon map was cut short or overwritten while it was in use%s: trace the map anew, and leave its "
        "file alone (moving another one to its name is fine)",
        r->map_name ? r->map_name : "", r->kept ? "; what was rendered since the last pass is dropped" : "");
    return AG_ERROR_SYSTEM;
}

/* Learns where shadow rays find light, if the settings want that and the scene leaves a choice. */
static ag_status guide_direct_light(ag_rendering *r)
{
    ag_context *context = r->context;
    phase_begin begin = context_begin_phase();
    uint64_t rays;
    ag_status status = direct_pilot_learn(&r->t, &context->run, &r->direct_guide, &rays);
    if (status != AG_OK || r->direct_guide.cell_count == 0)
        return status;
    r->t.direct_guide = &r->direct_guide;
    context->statistics.rays_shadow += rays;
    r->seconds += context_add_to_phase(context, AG_PHASE_RENDER, begin);
    log_message(context->log, AG_LOG_INFO, "direct light is guided: %u cells, by %llu shadow rays",
                r->direct_guide.cell_count, (unsigned long long)rays);
    return AG_OK;
}

/* Takes over the maps of another rendering, and all that depends on nothing but them. */
static void share_maps(ag_rendering *r, const ag_rendering *with)
{
    r->maps = with->maps ? maps_hold(with->maps) : NULL;
    r->t.caustic = with->t.caustic;
    r->t.cache = with->t.cache;
    r->t.incident = with->t.incident;
    r->t.gather_min_distance = with->t.gather_min_distance;
}

/* Makes film, maps, guides and workers. with: the rendering whose maps it uses, or NULL to make maps of its own. */
static ag_status prepare(ag_rendering *r, const ag_rendering *with)
{
    ag_context *context = r->context;
    phase_begin begin = context_begin_phase();
    ag_status status = rendering_create_film(r);
    r->seconds += context_add_to_phase(context, AG_PHASE_RENDER, begin);
    AG_TRY(status);
    const integrator *kind = integrator_of(r->settings.integrator);
    r->t = make_transport(context, r->s, &r->settings, &r->film->layout);
    if (with)
        share_maps(r, with);
    else if (kind->prepare)
        AG_TRY(kind->prepare(r));
    AG_TRY(guide_direct_light(r));
    begin = context_begin_phase();
    r->workers = eye_workers_create(&r->t, context->statistics.threads);
    r->seconds += context_add_to_phase(context, AG_PHASE_RENDER, begin);
    return r->workers ? AG_OK : AG_ERROR_MEMORY;
}

/* Settles the settings of a rendering that knows its scene, and prepares it. */
static ag_status begin_rendering(ag_rendering *r, const ag_render_settings *settings)
{
    AG_TRY(rendering_settle(r->context, r->s, settings, &r->settings));
    if (settings->photon_count == AG_PHOTON_COUNT_AUTOMATIC && integrator_of(r->settings.integrator)->has_photon_map)
        log_message(r->context->log, AG_LOG_INFO, "photons by default: %llu",
                    (unsigned long long)r->settings.photon_count);
    r->context->rendered = r->settings;
    r->context->rendered.photon_map_file = NULL; /* the caller's */
    r->aspect = (float)r->settings.width / (float)r->settings.height;
    if (r->settings.photon_map_file)
        r->map_name = strdup(r->settings.photon_map_file);
    return check_map(r, prepare(r, NULL));
}

static void borrow(ag_rendering *r, ag_context *context, ag_scene *loaded)
{
    r->context = context;
    r->loaded = loaded;
    r->loaded->rendering_count++;
    r->s = loaded->s;
    r->not_finite_before = context->statistics.samples_not_finite;
}

ag_status ag_rendering_create(ag_context *context, const ag_scene *loaded, const ag_render_settings *settings,
                              ag_rendering **out_rendering)
{
    if (!context || !loaded || !settings || !out_rendering)
        return AG_ERROR_ARGUMENT;
    AG_TRY(scene_check_complete(context, loaded));
    ag_rendering *r = calloc(1, sizeof *r);
    if (!r)
        return AG_ERROR_MEMORY;
    unsigned callers_arithmetic = floating_point_enter();
    borrow(r, context, (ag_scene *)(uintptr_t)loaded); /* for the count alone */
    ag_status status = begin_rendering(r, settings);
    r->settings.photon_map_file = NULL; /* the caller's, and done with */
    floating_point_leave(callers_arithmetic);
    if (status == AG_OK)
        *out_rendering = r;
    else
        ag_rendering_finish(r, NULL);
    return status;
}

/* Gives the rendering a copy of its scene that differs by the camera alone, and borrows all else. Errors:
 * AG_ERROR_ARGUMENT, AG_ERROR_MEMORY. */
static ag_status look_from(ag_rendering *r, const float from[3], const float to[3], const float up[3])
{
    const camera *before = &r->s->camera;
    camera moved = *before;
    const transform stood = before->is_moving ? camera_transform_at(before, 0.0f) : before->world_from_camera;
    moved.is_moving = false;
    if (!camera_look(vec3_make(from[0], from[1], from[2]), vec3_make(to[0], to[1], to[2]),
                     vec3_make(up[0], up[1], up[2]), !transform_swaps_handedness(&stood), &moved.world_from_camera)) {
        log_message(
            r->context->log, AG_LOG_ERROR,
            "a view makes no sense: from and to should differ, and up should not be along the way between them");
        return AG_ERROR_ARGUMENT;
    }
    if (scene_check_camera(r->s, &moved, r->context->log) != AG_OK)
        return AG_ERROR_ARGUMENT;
    r->seen = malloc(sizeof *r->seen);
    if (!r->seen)
        return AG_ERROR_MEMORY;
    *r->seen = *r->s;
    scene_set_camera(r->seen, &moved);
    r->s = r->seen;
    return AG_OK;
}

ag_status ag_rendering_create_view(ag_rendering *beside, const float from[3], const float to[3], const float up[3],
                                   int reduction, ag_rendering **out_rendering)
{
    if (!beside || !from || !to || !up || reduction < 1 || !out_rendering)
        return AG_ERROR_ARGUMENT;
    ag_rendering *r = calloc(1, sizeof *r);
    if (!r)
        return AG_ERROR_MEMORY;
    unsigned callers_arithmetic = floating_point_enter();
    borrow(r, beside->context, beside->loaded);
    ag_progress_fn *told = run_silence(&r->context->run);
    r->is_view = true;
    r->settings = beside->settings;
    r->settings.width = (r->settings.width + reduction - 1) / reduction;
    r->settings.height = (r->settings.height + reduction - 1) / reduction;
    r->aspect = beside->aspect;
    r->map_name = beside->map_name ? strdup(beside->map_name) : NULL;
    ag_status status = look_from(r, from, to, up);
    if (status == AG_OK && beside->maps)
        maps_watch(beside->maps);
    if (status == AG_OK)
        status = check_map(r, prepare(r, beside));
    run_speak(&r->context->run, told);
    floating_point_leave(callers_arithmetic);
    if (status == AG_OK)
        *out_rendering = r;
    else
        ag_rendering_finish(r, NULL);
    return status;
}

static ag_status render_wanted(ag_rendering *r, uint32_t wanted)
{
    const integrator *kind = integrator_of(r->settings.integrator);
    if (kind->begin_pass)
        AG_TRY(kind->begin_pass(r));
    return r->film->wanted ? render_adaptively(r, wanted) : render_passes(r, wanted);
}

/* Renders one pass, up to `wanted` samples a pixel. The film is resolved even where that fails. */
static ag_status render_pass(ag_rendering *r, uint32_t wanted)
{
    ag_status status = render_wanted(r, wanted);
    film_resolve(r->film);
    AG_TRY(status);
    return debug_views_render(&r->t, &r->context->run, r->workers, r->film);
}

ag_status ag_rendering_continue(ag_rendering *r, int samples_per_pixel)
{
    if (!r || samples_per_pixel < 1 || samples_per_pixel > r->settings.samples_per_pixel)
        return AG_ERROR_ARGUMENT;
    unsigned callers_arithmetic = floating_point_enter();
    ag_context *context = r->context;
    uint32_t wanted = (uint32_t)samples_per_pixel;
    phase_begin begin = context_begin_phase();
    ag_progress_fn *told = r->is_view ? run_silence(&context->run) : NULL;
    if (r->maps)
        maps_watch(r->maps);
    ag_status status = check_map(r, render_pass(r, wanted));
    if (status == AG_OK && r->keeps_passes && film_copy_take(r->film, &r->whole) != AG_OK) {
        r->keeps_passes = false;
        log_message(context->log, AG_LOG_WARNING, "there is no memory to put the picture of a pass aside");
    }
    if (status == AG_OK)
        run_progress(&context->run, AG_PHASE_RENDER, (double)wanted / (double)r->settings.samples_per_pixel);
    r->seconds += context_add_to_phase(context, AG_PHASE_RENDER, begin);
    if (status == AG_OK && samples_per_pixel == r->settings.samples_per_pixel)
        log_message(context->log, AG_LOG_INFO, "%-10s %9.3f s", ag_phase_name(AG_PHASE_RENDER), r->seconds);
    if (r->is_view)
        run_speak(&context->run, told);
    rendering_count_rays(r);
    floating_point_leave(callers_arithmetic);
    return status;
}

ag_status ag_rendering_keep_passes(ag_rendering *r)
{
    if (!r)
        return AG_ERROR_ARGUMENT;
    r->keeps_passes = true;
    return AG_OK;
}

ag_status ag_rendering_go_back(ag_rendering *r)
{
    if (!r || !r->whole)
        return AG_ERROR_ARGUMENT;
    film_copy_restore(r->film, r->whole);
    return AG_OK;
}

const ag_film *ag_rendering_film(const ag_rendering *r) { return r ? r->film : NULL; }

void ag_rendering_finish(ag_rendering *r, ag_film **out_film)
{
    if (!r)
        return;
    ag_context *context = r->context;
    if (r->film) { /* it adds its own time to the phase */
        context->statistics.samples = ag_rendering_sample_counts(r);
        context->statistics.noise = ag_rendering_noise(r).level;
    }
    phase_begin begin = context_begin_phase();
    if (r->maps && r->t.cache)
        rendering_count_irradiance(&context->statistics, r->maps, true);
    uint64_t not_finite = r->context->statistics.samples_not_finite - r->not_finite_before;
    if (not_finite > 0)
        log_message(r->context->log, AG_LOG_WARNING, "%llu camera samples were not finite and count as black",
                    (unsigned long long)not_finite);
    if (out_film)
        odd_scene_warn(r);
    if (out_film)
        *out_film = r->film;
    else
        ag_film_destroy(r->film);
    ag_film_destroy(r->pilot);
    eye_workers_destroy(r->workers, r->context->statistics.threads);
    maps_release(r->maps);
    free(r->seen);
    direct_guide_reset(&r->direct_guide);
    free(r->map_name);
    free(r->kept);
    free(r->whole);
    ag_scene *loaded = r->loaded;
    free(r);
    context_add_to_phase(context, AG_PHASE_RENDER, begin);
    if (--loaded->rendering_count == 0 && loaded->is_dropped)
        ag_scene_destroy(loaded); /* destroys the context too, where that was let go before */
}

ag_status ag_render(ag_context *context, const ag_scene *loaded, const ag_render_settings *settings, ag_film **out_film)
{
    if (!out_film)
        return AG_ERROR_ARGUMENT;
    ag_rendering *rendering;
    AG_TRY(ag_rendering_create(context, loaded, settings, &rendering));
    ag_status status = ag_rendering_continue(rendering, rendering->settings.samples_per_pixel);
    ag_rendering_finish(rendering, status == AG_OK ? out_film : NULL);
    return status;
}
