/* render_settings.c: the renderer's settings: our defaults (settings_rows.c), and what the scene's file says of its
 * picture instead of some.
 * Flow: scene -> [here] -> render. Threads: as in afterglow.h. */
#include "context.h"
#include "public_structs.h"
#include "settings_table.h"
#include "status.h"

#include <stdio.h>
#include <string.h>

static void take_int(integer_hint hint, int *in_out_value)
{
    if (hint.is_given)
        *in_out_value = (int)hint.value;
}

static void take_count(integer_hint hint, uint64_t *in_out_value)
{
    if (hint.is_given)
        *in_out_value = (uint64_t)hint.value;
}

static void take_float(float_hint hint, float *in_out_value)
{
    if (hint.is_given)
        *in_out_value = hint.value;
}

bool ag_scene_has_own_samples(const ag_scene *loaded)
{
    return loaded && loaded->s && loaded->s->hints.has_sampler && loaded->s->hints.is_for_photon_map;
}

ag_status ag_render_settings_fill(ag_context *context, const ag_scene *loaded, void *out_settings, size_t struct_size)
{
    if (!context || !loaded || !out_settings)
        return AG_ERROR_ARGUMENT;
    AG_TRY(scene_check_complete(context, loaded));
    const scene_hints *hints = &loaded->s->hints;
    ag_render_settings settings = settings_table_defaults();
    take_int(hints->width, &settings.width);
    take_int(hints->height, &settings.height);
    if (hints->has_crop_window)
        memcpy(settings.crop_window, hints->crop_window, sizeof settings.crop_window);
    settings.float_samples = settings.float_samples || hints->has_float_samples;
    if (hints->surface_layers != SURFACE_LAYERS_NONE) {
        settings.layers |= AG_LAYER_GBUFFER;
        settings.layers_in_camera_space = hints->surface_layers == SURFACE_LAYERS_CAMERA;
    }
    if (loaded->s->camera.exposure > 0.0f)
        settings.exposure = loaded->s->camera.exposure;
    settings.exposure *= hints->iso / 100.0f;
    take_float(hints->white_balance, &settings.white_balance);
    settings.max_component = hints->max_component;
    take_int(hints->samples_per_pixel, &settings.samples_per_pixel);
    take_count(hints->seed, &settings.seed);
    take_count(hints->photon_count, &settings.photon_count);
    take_count(hints->caustic_photon_count, &settings.caustic_photon_count);
    take_int(hints->nearest, &settings.nearest);
    take_float(hints->radius, &settings.radius);
    take_int(hints->gather_samples, &settings.gather_samples);
    take_int(hints->max_depth, &settings.max_depth);
    public_struct_write(&settings, sizeof settings, out_settings, struct_size);
    return AG_OK;
}

ag_status render_settings_check(ag_context *context, const ag_render_settings *s)
{
    char wrong[256] = "";
    bool is_valid = true;
    for (size_t i = 0; is_valid && setting_at(i); i++)
        is_valid = setting_check(setting_at(i), s, wrong, sizeof wrong);
    /* what no row can say alone */
    if (is_valid && (int64_t)s->samples_per_pixel * s->gather_samples > UINT32_MAX) {
        snprintf(wrong, sizeof wrong, "samples per pixel times gather rays must stay below 2^32");
        is_valid = false;
    }
    if (is_valid)
        return AG_OK;
    log_message(context->log, AG_LOG_ERROR, "%s", wrong);
    return AG_ERROR_ARGUMENT;
}
