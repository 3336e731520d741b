/* render_settings.c: the renderer's settings, from the scene's Integrator, Sampler and Film; our defaults are in
 * settings_rows.c.
 * Rests on: pbrt-v2's "photonmap" integrator (its parameter names); the pbrt-v4 file format (Film, Sampler).
 * Flow: scene -> [here] -> render. Threads: as in afterglow.h. */
#include "context.h"
#include "settings_table.h"

#include <stdio.h>
#include <string.h>

/* An integer parameter within a range. */
static ag_status get_count(parameter_list *list, log_sink *log, const char *name, int64_t least, int64_t most,
                           int64_t *in_out_value)
{
    int64_t value = *in_out_value;
    const parameter *p = parameter_list_find(list, name);
    ag_status status = parameter_get_int(list, log, name, &value);
    if (status != AG_OK || !p)
        return status; /* where it is absent the default stays, which may be outside the range: "automatic" */
    if (value < least || value > most) {
        log_at(log, AG_LOG_ERROR, p->where, "%s: \"%s\" is %lld, it must be from %lld to %lld", list->directive, name,
               (long long)value, (long long)least, (long long)most);
        return AG_ERROR_SCENE;
    }
    *in_out_value = value;
    return AG_OK;
}

static ag_status get_int(parameter_list *list, log_sink *log, const char *name, int least, int most, int *in_out_value)
{
    int64_t value = *in_out_value;
    ag_status status = get_count(list, log, name, least, most, &value);
    *in_out_value = (int)value;
    return status;
}

static bool is_crop_window(const double window[4])
{
    return window[0] >= 0.0 && window[0] < window[1] && window[1] <= 1.0 && window[2] >= 0.0 && window[2] < window[3] &&
           window[3] <= 1.0;
}

/* The film's kind, and the parameters of kinds that are not written. */
static ag_status read_film_kind(parameter_list *film, log_sink *log, ag_render_settings *out)
{
    float wavelength;
    int64_t count;
    ag_status status = AG_OK;
    if (strcmp(film->name, "rgb") == 0)
        return AG_OK;
    if (strcmp(film->name, "gbuffer") == 0) {
        const char *space = "camera";
        status = parameter_get_string(film, log, "coordinatesystem", &space);
        if (status != AG_OK)
            return status;
        out->layers |= AG_LAYER_GBUFFER;
        out->layers_in_camera_space = strcmp(space, "camera") == 0;
        if (out->layers_in_camera_space || strcmp(space, "world") == 0)
            return AG_OK;
        const parameter *wrong = parameter_list_find(film, "coordinatesystem");
        log_at(log, AG_LOG_ERROR, wrong->where,
               "Film: \"coordinatesystem\" is \"%s\", it must be \"camera\" or \"world\"", space);
        return AG_ERROR_SCENE;
    }
    log_at_once(log, AG_LOG_WARNING, film->where, "film", "Film \"%s\" is not supported; \"rgb\" stands in",
                film->name);
    if (strcmp(film->name, "spectral") == 0) {
        status = parameter_get_float(film, log, "lambdamin", &wavelength);
        if (status == AG_OK)
            status = parameter_get_float(film, log, "lambdamax", &wavelength);
        if (status == AG_OK)
            status = parameter_get_int(film, log, "nbuckets", &count);
    }
    return status;
}

/* pbrt-v4's PixelSensor. Only cie1931 is there, which sees as our RGB does. */
static ag_status read_sensor(parameter_list *film, log_sink *log, ag_render_settings *out)
{
    const char *sensor = "cie1931";
    float iso = 100.0f;
    out->max_component = INFINITY;
    ag_status status = parameter_get_float(film, log, "iso", &iso);
    if (status == AG_OK)
        status = parameter_get_float(film, log, "whitebalance", &out->white_balance);
    if (status == AG_OK)
        status = parameter_get_float(film, log, "maxcomponentvalue", &out->max_component);
    if (status == AG_OK)
        status = parameter_get_string(film, log, "sensor", &sensor);
    if (status != AG_OK)
        return status;
    const parameter *wrong = NULL;
    if (!(iso > 0.0f))
        wrong = parameter_list_find(film, "iso");
    else if (!(out->max_component > 0.0f))
        wrong = parameter_list_find(film, "maxcomponentvalue");
    else if (out->white_balance != 0.0f && !(out->white_balance >= 1000.0f && out->white_balance <= 25000.0f))
        wrong = parameter_list_find(film, "whitebalance");
    if (wrong) {
        log_at(log, AG_LOG_ERROR, wrong->where, "Film: \"%s\" is %g, it must be %s", wrong->name, wrong->numbers[0],
               strcmp(wrong->name, "whitebalance") == 0 ? "from 1000 to 25000 kelvin, or 0" : "above 0");
        return AG_ERROR_SCENE;
    }
    if (isinf(out->max_component))
        out->max_component = 0.0f;
    if (strcmp(sensor, "cie1931") != 0) /* pbrt balances the others to 6500 K, which is our white */
        log_at_once(log, AG_LOG_WARNING, film->where, "sensor", "Film: the sensor \"%s\" is %s; \"cie1931\" stands in",
                    sensor, spectra_is_sensor(sensor, strlen(sensor)) ? "not supported" : "not known");
    out->exposure *= iso / 100.0f;
    return AG_OK;
}

static ag_status read_film(parameter_list *film, log_sink *log, ag_render_settings *out)
{
    if (!film->name)
        return AG_OK;
    const char *file_name = NULL;
    const double *crop = NULL, *bounds = NULL;
    size_t crop_count = 0, bounds_count = 0;
    float diagonal;
    bool is_half = true;
    ag_status status = read_film_kind(film, log, out);
    if (status == AG_OK)
        status = read_sensor(film, log, out);
    if (status == AG_OK)
        status = get_int(film, log, "xresolution", 1, 65536, &out->width);
    if (status == AG_OK)
        status = get_int(film, log, "yresolution", 1, 65536, &out->height);
    if (status == AG_OK)
        status = parameter_get_string(film, log, "filename", &file_name);
    if (status == AG_OK)
        status = parameter_get_bool(film, log, "savefp16", &is_half);
    if (status == AG_OK)
        status =
            parameter_get_float(film, log, "diagonal", &diagonal); /* of the sensor: a realistic camera's concern */
    if (status == AG_OK)
        status = parameter_get_numbers(film, log, "cropwindow", PARAMETER_FLOAT, &crop, &crop_count);
    if (status == AG_OK)
        status = parameter_get_numbers(film, log, "pixelbounds", PARAMETER_INTEGER, &bounds, &bounds_count);
    if (status != AG_OK)
        return status;
    if ((crop && crop_count != 4) || (bounds && bounds_count != 4)) {
        log_at(log, AG_LOG_ERROR, film->where, "Film: \"%s\" takes four numbers",
               crop && crop_count != 4 ? "cropwindow" : "pixelbounds");
        return AG_ERROR_SCENE;
    }
    if (crop && bounds)
        log_at_once(log, AG_LOG_WARNING, film->where, "cropwindow",
                    "Film: \"pixelbounds\" is ignored, as there is a \"cropwindow\"");
    for (int i = 0; i < 4; i++) {
        if (crop) /* in any order, and clipped, as in pbrt */
            out->crop_window[i] = fmin(fmax(i % 2 ? fmax(crop[i - 1], crop[i]) : fmin(crop[i], crop[i + 1]), 0.0), 1.0);
        else if (bounds) /* beyond the picture is nothing, as in pbrt */
            out->crop_window[i] = fmin(fmax(bounds[i] / (i < 2 ? out->width : out->height), 0.0), 1.0);
    }
    if (!is_crop_window(out->crop_window)) {
        log_at(log, AG_LOG_ERROR, film->where, "Film: \"%s\" leaves no part of the picture",
               crop ? "cropwindow" : "pixelbounds");
        return AG_ERROR_SCENE;
    }
    out->float_samples = !is_half;
    parameter_list_warn_unused(film, log);
    return AG_OK;
}

/* All of pbrt's samplers have ours standing in for them, whatever way they are randomised: it is not seen but in the
 * noise. */
static ag_status read_sampler(parameter_list *sampler, log_sink *log, ag_render_settings *out)
{
    static const char *const NAMES[] = {"halton",  "sobol",       "paddedsobol", "zsobol",
                                        "pmj02bn", "independent", "stratified"};
    const char *randomization;
    bool jitter, is_known = false;
    int64_t seed = 0;
    if (!sampler->name)
        return AG_OK;
    for (size_t i = 0; i < sizeof NAMES / sizeof *NAMES; i++)
        is_known = is_known || strcmp(sampler->name, NAMES[i]) == 0;
    if (!is_known)
        log_at_once(log, AG_LOG_WARNING, sampler->where, "sampler", "Sampler \"%s\" is not known; our own stands in",
                    sampler->name);
    ag_status status = parameter_get_int(sampler, log, "seed", &seed);
    if (status == AG_OK)
        status = parameter_get_string(sampler, log, "randomization", &randomization);
    if (status != AG_OK)
        return status;
    if (parameter_list_find(sampler, "seed"))
        out->seed = (uint64_t)seed;
    if (strcmp(sampler->name, "stratified") == 0) {
        int x = 4, y = 4;
        status = get_int(sampler, log, "xsamples", 1, 1 << 10, &x);
        if (status == AG_OK)
            status = get_int(sampler, log, "ysamples", 1, 1 << 10, &y);
        if (status == AG_OK)
            status = parameter_get_bool(sampler, log, "jitter", &jitter);
        out->samples_per_pixel = x * y;
    } else {
        if (strcmp(sampler->name, "independent") == 0)
            out->samples_per_pixel = 4; /* pbrt's default for it alone */
        status = get_int(sampler, log, "pixelsamples", 1, 1 << 20, &out->samples_per_pixel);
    }
    if (status == AG_OK)
        parameter_list_warn_unused(sampler, log);
    return status;
}

static ag_status read_photonmap(parameter_list *list, log_sink *log, ag_render_settings *out)
{
    int64_t photons = (int64_t)out->photon_count, caustics = (int64_t)out->caustic_photon_count;
    bool final_gather = true;
    ag_status status = get_count(list, log, "indirectphotons", 1, UINT32_MAX - 1, &photons);
    if (status == AG_OK)
        status = get_count(list, log, "causticphotons", 0, UINT32_MAX - 1, &caustics);
    if (status == AG_OK)
        status = get_int(list, log, "nused", 1, 65536, &out->nearest);
    if (status == AG_OK)
        status = parameter_get_float(list, log, "maxdist", &out->radius);
    if (status == AG_OK)
        status = get_int(list, log, "finalgathersamples", 1, 65536, &out->gather_samples);
    if (status == AG_OK)
        status = get_int(list, log, "maxdepth", 0, 100, &out->max_depth);
    if (status == AG_OK)
        status = parameter_get_bool(list, log, "finalgather", &final_gather);
    if (status != AG_OK)
        return status;
    if (!(out->radius >= 0.0f) || isinf(out->radius)) {
        log_at(log, AG_LOG_ERROR, list->where, "Integrator: \"maxdist\" must be finite and not negative");
        return AG_ERROR_SCENE;
    }
    if (!final_gather)
        log_at_once(log, AG_LOG_WARNING, list->where, "finalgather",
                    "Integrator \"photonmap\": \"finalgather\" false is not supported; indirect light is gathered");
    out->photon_count = (uint64_t)photons;
    out->caustic_photon_count = (uint64_t)caustics;
    parameter_list_warn_unused(list, log);
    return AG_OK;
}

/* Another renderer's integrator, with all that it says. */
static void name_ignored(const parameter_list *integrator, log_sink *log)
{
    char names[256] = "";
    for (size_t i = 0; i < integrator->count; i++) {
        size_t used = strlen(names);
        const char *gap = i == 0 ? "" : i + 1 == integrator->count ? " and " : ", ";
        snprintf(names + used, sizeof names - used, "%s\"%.40s\"", gap, integrator->items[i].name);
    }
    log_at_once(log, AG_LOG_WARNING, integrator->where, "integrator",
                "Integrator \"%s\" is another renderer's: rendering with our own defaults%s%s%s%s", integrator->name,
                names[0] ? "; its " : "", names, names[0] ? integrator->count > 1 ? " are ignored" : " is ignored" : "",
                parameter_list_find(integrator, "maxdepth") ? ", paths end by roulette" : "");
}

bool ag_scene_has_own_samples(const ag_scene *loaded)
{
    const scene *s = loaded->s;
    return s->sampler.name && s->integrator.name && strcmp(s->integrator.name, "photonmap") == 0;
}

ag_status ag_render_settings_from_scene(ag_context *context, const ag_scene *loaded, ag_render_settings *out_settings)
{
    if (!context || !loaded || !out_settings)
        return AG_ERROR_ARGUMENT;
    scene *s = loaded->s; /* parameters are marked as looked up; nothing else changes */
    ag_render_settings settings = ag_default_render_settings();
    if (s->options.has_seed)
        settings.seed = (uint64_t)s->options.seed;
    if (s->camera.exposure > 0.0f)
        settings.exposure = s->camera.exposure;
    ag_status status = read_film(&s->film, context->log, &settings);
    if (status == AG_OK)
        status = read_sampler(&s->sampler, context->log, &settings);
    if (status != AG_OK)
        return status;
    if (s->integrator.name && strcmp(s->integrator.name, "photonmap") == 0) {
        status = read_photonmap(&s->integrator, context->log, &settings);
        if (status != AG_OK)
            return status;
    } else if (s->integrator.name) {
        name_ignored(&s->integrator, context->log);
    }
    *out_settings = settings;
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
