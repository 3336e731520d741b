/* pbrt_film.c: Film and PixelFilter of a pbrt-v4 scene.
 * Rests on the format's description, pbrt.org/fileformat-v4, "Film" and "Filters". Names and defaults are pbrt-v4's.
 * Flow: pbrt_hints -> [here] -> scene.hints. Threads: one per scene. */
#define _POSIX_C_SOURCE 200809L
#include "pbrt/pbrt_private.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

static bool is_crop_window(const double window[4])
{
    return window[0] >= 0.0 && window[0] < window[1] && window[1] <= 1.0 && window[2] >= 0.0 && window[2] < window[3] &&
           window[3] <= 1.0;
}

/* Reads the film's kind, and the parameters of kinds that are not written. */
static ag_status read_kind(pbrt_parser *parser, parameter_list *film, scene_hints *hints)
{
    float wavelength;
    int64_t count;
    if (strcmp(film->name, "rgb") == 0)
        return AG_OK;
    if (strcmp(film->name, "gbuffer") == 0) {
        const char *space = "camera";
        AG_TRY(parameter_get_string(film, parser->log, "coordinatesystem", &space));
        bool is_camera = strcmp(space, "camera") == 0;
        if (!is_camera && strcmp(space, "world") != 0)
            return pbrt_refuse(parser, film, "coordinatesystem",
                               "Film: \"coordinatesystem\" is \"%s\", it must be \"camera\" or \"world\"", space);
        hints->surface_layers = is_camera ? SURFACE_LAYERS_CAMERA : SURFACE_LAYERS_WORLD;
        return AG_OK;
    }
    log_at_once(parser->log, AG_LOG_WARNING, film->where, "film", "Film \"%s\" is not supported; \"rgb\" stands in",
                film->name);
    if (strcmp(film->name, "spectral") == 0) {
        AG_TRY(parameter_get_float(film, parser->log, "lambdamin", &wavelength));
        AG_TRY(parameter_get_float(film, parser->log, "lambdamax", &wavelength));
        AG_TRY(parameter_get_int(film, parser->log, "nbuckets", &count));
    }
    return AG_OK;
}

/* Reads pbrt-v4's PixelSensor. Only cie1931 is supported, which sees as our RGB does. */
static ag_status read_sensor(pbrt_parser *parser, parameter_list *film, scene_hints *hints)
{
    const char *sensor = "cie1931";
    float balance = 0.0f, most = INFINITY;
    AG_TRY(parameter_get_float(film, parser->log, "iso", &hints->iso));
    AG_TRY(parameter_get_float(film, parser->log, "whitebalance", &balance));
    AG_TRY(parameter_get_float(film, parser->log, "maxcomponentvalue", &most));
    AG_TRY(parameter_get_string(film, parser->log, "sensor", &sensor));
    if (!(hints->iso > 0.0f))
        return pbrt_refuse(parser, film, "iso", "Film: \"iso\" is %g, it must be above 0", (double)hints->iso);
    if (!(most > 0.0f))
        return pbrt_refuse(parser, film, "maxcomponentvalue", "Film: \"maxcomponentvalue\" is %g, it must be above 0",
                           (double)most);
    if (balance != 0.0f && !(balance >= 1000.0f && balance <= 25000.0f))
        return pbrt_refuse(parser, film, "whitebalance",
                           "Film: \"whitebalance\" is %g, it must be from 1000 to 25000 kelvin, or 0", (double)balance);
    hints->white_balance = (float_hint){parameter_list_find(film, "whitebalance") != NULL, balance};
    hints->max_component = isinf(most) ? 0.0f : most;
    if (strcmp(sensor, "cie1931") != 0) /* pbrt balances the others to 6500 K, which is our white */
        log_at_once(parser->log, AG_LOG_WARNING, film->where, "sensor",
                    "Film: the sensor \"%s\" is %s; \"cie1931\" stands in", sensor,
                    spectra_is_sensor(sensor, strlen(sensor)) ? "not supported" : "not known");
    return AG_OK;
}

static ag_status read_window(pbrt_parser *parser, parameter_list *film, scene_hints *hints)
{
    static const int64_t SIZE[2] = {1280, 720}; /* pixels, where the film names none */
    const double *crop = NULL, *bounds = NULL;
    size_t crop_count = 0, bounds_count = 0;
    AG_TRY(parameter_get_numbers(film, parser->log, "cropwindow", PARAMETER_FLOAT, &crop, &crop_count));
    AG_TRY(parameter_get_numbers(film, parser->log, "pixelbounds", PARAMETER_INTEGER, &bounds, &bounds_count));
    if ((crop && crop_count != 4) || (bounds && bounds_count != 4)) {
        const char *wrong = crop && crop_count != 4 ? "cropwindow" : "pixelbounds";
        return pbrt_refuse(parser, film, wrong, "Film: \"%s\" takes four numbers", wrong);
    }
    if (crop && bounds)
        log_at_once(parser->log, AG_LOG_WARNING, film->where, "cropwindow",
                    "Film: \"pixelbounds\" is ignored, as there is a \"cropwindow\"");
    if (!crop && !bounds)
        return AG_OK;
    int64_t width = hints->width.is_given ? hints->width.value : SIZE[0],
            height = hints->height.is_given ? hints->height.value : SIZE[1];
    for (int i = 0; i < 4; i++) {
        if (crop) /* in any order, and clipped, as in pbrt */
            hints->crop_window[i] =
                double_clamp(i % 2 ? double_max(crop[i - 1], crop[i]) : double_min(crop[i], crop[i + 1]), 0.0, 1.0);
        else /* beyond the picture is nothing, as in pbrt */
            hints->crop_window[i] = double_clamp(bounds[i] / (double)(i < 2 ? width : height), 0.0, 1.0);
    }
    hints->has_crop_window = true;
    const char *asked = crop ? "cropwindow" : "pixelbounds";
    return is_crop_window(hints->crop_window)
               ? AG_OK
               : pbrt_refuse(parser, film, asked, "Film: \"%s\" leaves no part of the picture", asked);
}

ag_status pbrt_settle_film(pbrt_parser *parser)
{
    parameter_list *film = &parser->film;
    scene_hints *hints = &parser->scene->hints;
    const char *file_name = NULL;
    float diagonal;
    bool is_half = true;
    if (!film->name)
        return AG_OK;
    AG_TRY(read_kind(parser, film, hints));
    AG_TRY(read_sensor(parser, film, hints));
    AG_TRY(pbrt_get_integer_hint(parser, film, "xresolution", 1, 65536, &hints->width));
    AG_TRY(pbrt_get_integer_hint(parser, film, "yresolution", 1, 65536, &hints->height));
    AG_TRY(parameter_get_string(film, parser->log, "filename", &file_name));
    AG_TRY(parameter_get_bool(film, parser->log, "savefp16", &is_half));
    AG_TRY(parameter_get_float(film, parser->log, "diagonal", &diagonal)); /* only realistic cameras need it */
    AG_TRY(read_window(parser, film, hints));
    hints->has_float_samples = !is_half;
    hints->file_name = file_name ? strdup(file_name) : NULL;
    if (file_name && !hints->file_name)
        return AG_ERROR_MEMORY;
    parameter_list_warn_unused(film, parser->log);
    return AG_OK;
}

/* The numbers of a kind of filter, and the kinds by name. */
static ag_status read_filter(pbrt_parser *parser, parameter_list *list, filter_hint *filter)
{
    static const struct {
        filter_kind kind;
        const char *name;
        size_t offset;
    } OWN[] = {
        {FILTER_GAUSSIAN, "sigma", offsetof(filter_hint, sigma)},
        {FILTER_MITCHELL, "B", offsetof(filter_hint, b)},
        {FILTER_MITCHELL, "C", offsetof(filter_hint, c)},
        {FILTER_SINC, "tau", offsetof(filter_hint, tau)},
    };
    AG_TRY(parameter_get_float(list, parser->log, "xradius", &filter->radius[0]));
    AG_TRY(parameter_get_float(list, parser->log, "yradius", &filter->radius[1]));
    for (size_t i = 0; i < sizeof OWN / sizeof *OWN; i++)
        if (OWN[i].kind == filter->kind)
            AG_TRY(parameter_get_float(list, parser->log, OWN[i].name, (float *)((char *)filter + OWN[i].offset)));
    if (!(filter->radius[0] > 0.0f && filter->radius[0] <= 64.0f && filter->radius[1] > 0.0f &&
          filter->radius[1] <= 64.0f && filter->sigma > 0.0f && filter->tau > 0.0f))
        return pbrt_error(parser, list->where, strlen(list->directive),
                          "PixelFilter: radii must be in (0, 64], sigma and tau above 0");
    parameter_list_warn_unused(list, parser->log);
    return AG_OK;
}

ag_status pbrt_settle_pixel_filter(pbrt_parser *parser)
{
    static const struct {
        const char *name;
        filter_kind kind;
        float radius; /* default */
    } FILTERS[] = {{"gaussian", FILTER_GAUSSIAN, 1.5f},
                   {"box", FILTER_BOX, 0.5f},
                   {"triangle", FILTER_TRIANGLE, 2.0f},
                   {"mitchell", FILTER_MITCHELL, 2.0f},
                   {"sinc", FILTER_SINC, 4.0f}};
    parameter_list *list = &parser->pixel_filter;
    filter_hint *filter = &parser->scene->hints.filter;
    if (!list->name)
        return AG_OK;
    filter->where = list->where;
    for (size_t i = 0; i < sizeof FILTERS / sizeof *FILTERS; i++)
        if (strcmp(list->name, FILTERS[i].name) == 0) {
            filter->kind = FILTERS[i].kind;
            filter->radius[0] = filter->radius[1] = FILTERS[i].radius;
            return read_filter(parser, list, filter);
        }
    log_at_once(parser->log, AG_LOG_WARNING, list->where, "pixel filter",
                "PixelFilter \"%s\" is not known; pbrt's default, \"gaussian\", stands in", list->name);
    return AG_OK;
}
