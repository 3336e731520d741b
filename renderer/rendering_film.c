/* rendering_film.c: makes the film of a rendering: its filter, its layers, its mattes, and what files tell of its
 * origin. Flow: render -> [here] -> film. Threads: the one that renders. */
#define _POSIX_C_SOURCE 200809L
#include "film/cryptomatte.h"
#include "integrator/integrator.h"
#include "rendering.h"
#include "status.h"

#include <string.h>

/* Notes camera and settings as OpenEXR's standard attributes describe them. Errors: AG_ERROR_MEMORY. */
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

ag_status rendering_create_film(ag_rendering *r)
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
    AG_TRY(pixel_filter_create(&r->s->hints.filter, r->s->hints.disable_pixel_jitter, r->context->log, &filter));
    AG_TRY(aov_layout_create(settings->layers, also, !integrator_of(settings->integrator)->has_photon_map, group_names,
                             group_count, &layout));
    r->film =
        film_create(settings, &r->s->space, &filter, integrator_of(settings->integrator)->splits_samples, &layout);
    if (!r->film)
        return AG_ERROR_MEMORY;
    AG_TRY(note_origin(r, &r->film->origin));
    for (int i = 0; i < CRYPTOMATTE_KIND_COUNT; i++)
        if (r->film->layout.has_matte[i]) {
            AG_TRY(cryptomatte_create(r->s, (cryptomatte_kind)i, &r->film->mattes[i]));
        }
    if (r->film->width > 0)
        return AG_OK;
    log_message(r->context->log, AG_LOG_ERROR, "the crop window holds no pixel");
    return AG_ERROR_ARGUMENT;
}
