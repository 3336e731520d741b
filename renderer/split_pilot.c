/* split_pilot.c: see split_pilot.h. */
#include "split_pilot.h"

#include "film/splitting.h"
#include "render_tiles.h"
#include "status.h"

/* Of the small picture: pixels of its longer side, samples of each pixel, and how each is split. */
enum { SIDE = 64, SAMPLES = 4, RAYS = 8 };
static const split_counts SPLIT = {.rays = RAYS, .lights = 8};
/* The sampler's key is apart from the picture's own. */
static const uint64_t PILOT_SEED = 0x73706c6974u;

static ag_render_settings pilot_settings(const ag_render_settings *settings, float *out_scale)
{
    ag_render_settings small = *settings;
    int longer = settings->width > settings->height ? settings->width : settings->height;
    *out_scale = longer > SIDE ? (float)SIDE / (float)longer : 1.0f;
    small.width = (int)fmaxf(roundf(*out_scale * (float)settings->width), 1.0f);
    small.height = (int)fmaxf(roundf(*out_scale * (float)settings->height), 1.0f);
    small.crop_window[0] = small.crop_window[2] = 0.0;
    small.crop_window[1] = small.crop_window[3] = 1.0;
    small.samples_per_pixel = SAMPLES;
    small.noise_level = 0.0f;
    small.layers = 0;
    small.denoise = false;
    small.seed ^= PILOT_SEED;
    return small;
}

/* scale: the width of the large picture's pixels, in those of the small one. Errors: those of rendering_create_film,
 * with a film or without. */
static ag_status create_film(ag_rendering *pilot, float scale)
{
    AG_TRY(rendering_create_film(pilot));
    ag_film *film = pilot->film;
    for (int axis = 0; axis < 2; axis++)
        film->filter.radius[axis] *= scale;
    for (size_t i = 0; i < film_area_count(film); i++)
        film->splits[i].counts = SPLIT;
    return AG_OK;
}

/* Camera rays and faulty samples in the statistics are the picture's. */
static void count_camera_rays_apart(eye_worker *workers, unsigned count)
{
    for (unsigned i = 0; i < count; i++) {
        workers[i].rays_path += workers[i].rays_camera + workers[i].rays_further;
        workers[i].rays_camera = workers[i].rays_further = workers[i].camera_rays_met = workers[i].samples_not_finite =
            0;
    }
}

/* As eye_worker_cost counts: photons' paths, and an estimate for each irradiance photon. */
static double cost_of_maps(const maps *m)
{
    double rays = (double)m->global.set.rays + (double)m->caustic.set.rays;
    return (double)EYE_COST_OF_PATH_RAY * rays +
           (double)EYE_COST_OF_CAUSTIC * (double)m->global.irradiance_photons.count;
}

ag_status split_pilot_run(ag_rendering *r)
{
    ag_film *film = r->film;
    if (!film->splits || film->prior.first || film_count_samples(film).most > 0)
        return AG_OK;
    float scale;
    ag_rendering pilot = {.context = r->context,
                          .s = r->s,
                          .settings = pilot_settings(&r->settings, &scale),
                          .t = r->t,
                          .workers = r->workers,
                          .aspect = r->aspect,
                          .film = r->pilot,
                          .is_pilot = true};
    if (!r->pilot) {
        ag_status made = create_film(&pilot, scale);
        r->pilot = pilot.film; /* owned by the rendering, which frees it */
        AG_TRY(made);
    }
    pilot.t.settings = &pilot.settings;
    pilot.t.layout = &pilot.film->layout;
    pilot.t.wants_layers = pilot.t.wants_groups = false;
    pilot.t.split = SPLIT;
    pilot.t.ray_bits = sampler_bits(RAYS);
    pilot.t.pixel_share *= scale;
    ag_status status = render_tiles(&pilot, SAMPLES);
    count_camera_rays_apart(r->workers, r->context->statistics.threads);
    if (status == AG_OK)
        status = splitting_begin(film, pilot.film, cost_of_maps(r->maps), &r->settings);
    if (status == AG_PAUSED)
        return status;
    ag_film_destroy(r->pilot);
    r->pilot = NULL;
    return status;
}
