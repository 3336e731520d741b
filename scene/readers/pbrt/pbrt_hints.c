/* pbrt_hints.c: what a pbrt-v4 scene says of its picture: Integrator and Sampler; Film and PixelFilter are in
 * pbrt_film. The last directive of each counts, and WorldBegin ends them all.
 * Rests on: pbrt-v2's "photonmap" integrator (its parameter names); the pbrt-v4 file format ("Samplers").
 * Flow: pbrt_parser -> [here] -> scene.hints. Threads: one per scene. */
#include "pbrt/pbrt_private.h"

#include <stdio.h>
#include <string.h>

static ag_status keep_parameters(pbrt_parser *parser, file_location where, const char *directive, parameter_list *kept)
{
    parameter_list list;
    AG_TRY(pbrt_read_named_parameters(parser, directive, "a quoted type", where, &list));
    parameter_list_reset(kept);
    *kept = list;
    return AG_OK;
}

ag_status pbrt_integrator(pbrt_parser *parser, file_location where)
{
    return keep_parameters(parser, where, "Integrator", &parser->integrator);
}

ag_status pbrt_sampler(pbrt_parser *parser, file_location where)
{
    return keep_parameters(parser, where, "Sampler", &parser->sampler);
}

ag_status pbrt_film(pbrt_parser *parser, file_location where)
{
    if (parser->state.rgb_space != COLOR_SPACE_SRGB) /* pbrt writes the picture in it */
        log_at_once(parser->log, AG_LOG_WARNING, where, "film colours",
                    "the ColorSpace is not that of the picture: it is written in %s",
                    parser->scene->space.is_rec709 ? "linear Rec. 709" : "the working space");
    return keep_parameters(parser, where, "Film", &parser->film);
}

ag_status pbrt_pixel_filter(pbrt_parser *parser, file_location where)
{
    return keep_parameters(parser, where, "PixelFilter", &parser->pixel_filter);
}

ag_status pbrt_get_integer_hint(pbrt_parser *parser, parameter_list *list, const char *name, int64_t least,
                                int64_t most, integer_hint *in_out_hint)
{
    int64_t value = 0;
    if (!parameter_list_find(list, name))
        return AG_OK;
    AG_TRY(parameter_get_int(list, parser->log, name, &value));
    if (value < least || value > most)
        return pbrt_refuse(parser, list, name, "%s: \"%s\" is %lld, it must be from %lld to %lld", list->directive,
                           name, (long long)value, (long long)least, (long long)most);
    *in_out_hint = (integer_hint){true, value};
    return AG_OK;
}

/* Our own sampler stands in for all of pbrt's, whatever way they are randomised: it is not seen but in the noise. */
static ag_status settle_sampler(pbrt_parser *parser)
{
    static const char *const NAMES[] = {"halton",  "sobol",       "paddedsobol", "zsobol",
                                        "pmj02bn", "independent", "stratified"};
    parameter_list *list = &parser->sampler;
    scene_hints *hints = &parser->scene->hints;
    const char *randomization;
    bool jitter, is_known = false;
    if (!list->name)
        return AG_OK;
    hints->has_sampler = true;
    for (size_t i = 0; i < sizeof NAMES / sizeof *NAMES; i++)
        is_known = is_known || strcmp(list->name, NAMES[i]) == 0;
    if (!is_known)
        log_at_once(parser->log, AG_LOG_WARNING, list->where, "sampler",
                    "Sampler \"%s\" is not known; our own stands in", list->name);
    AG_TRY(pbrt_get_integer_hint(parser, list, "seed", INT64_MIN, INT64_MAX, &hints->seed));
    AG_TRY(parameter_get_string(list, parser->log, "randomization", &randomization));
    if (strcmp(list->name, "stratified") == 0) {
        integer_hint x = {true, 4}, y = {true, 4};
        AG_TRY(pbrt_get_integer_hint(parser, list, "xsamples", 1, 1 << 10, &x));
        AG_TRY(pbrt_get_integer_hint(parser, list, "ysamples", 1, 1 << 10, &y));
        AG_TRY(parameter_get_bool(list, parser->log, "jitter", &jitter));
        hints->samples_per_pixel = (integer_hint){true, x.value * y.value};
    } else {
        if (strcmp(list->name, "independent") == 0)
            hints->samples_per_pixel = (integer_hint){true, 4}; /* pbrt's default for it alone */
        AG_TRY(pbrt_get_integer_hint(parser, list, "pixelsamples", 1, 1 << 20, &hints->samples_per_pixel));
    }
    parameter_list_warn_unused(list, parser->log);
    return AG_OK;
}

/* Warns of an integrator of another renderer, and names its parameters. */
static void name_ignored(const parameter_list *list, log_sink *log)
{
    char names[256] = "";
    for (size_t i = 0; i < list->count; i++) {
        size_t used = strlen(names);
        const char *gap = i == 0 ? "" : i + 1 == list->count ? " and " : ", ";
        snprintf(names + used, sizeof names - used, "%s\"%.40s\"", gap, list->items[i].name);
    }
    log_at_once(log, AG_LOG_WARNING, list->where, "integrator",
                "Integrator \"%s\" is another renderer's: rendering with our own defaults%s%s%s%s", list->name,
                names[0] ? "; its " : "", names, names[0] ? list->count > 1 ? " are ignored" : " is ignored" : "",
                parameter_list_find(list, "maxdepth") ? ", paths end by roulette" : "");
}

static ag_status settle_integrator(pbrt_parser *parser)
{
    parameter_list *list = &parser->integrator;
    scene_hints *hints = &parser->scene->hints;
    bool final_gather = true;
    if (!list->name)
        return AG_OK;
    if (strcmp(list->name, "photonmap") != 0) {
        name_ignored(list, parser->log);
        return AG_OK;
    }
    hints->is_for_photon_map = true;
    AG_TRY(pbrt_get_integer_hint(parser, list, "indirectphotons", 1, UINT32_MAX - 1, &hints->photon_count));
    AG_TRY(pbrt_get_integer_hint(parser, list, "causticphotons", 0, UINT32_MAX - 1, &hints->caustic_photon_count));
    AG_TRY(pbrt_get_integer_hint(parser, list, "nused", 1, 65536, &hints->nearest));
    hints->radius.is_given = parameter_list_find(list, "maxdist") != NULL;
    AG_TRY(parameter_get_float(list, parser->log, "maxdist", &hints->radius.value));
    AG_TRY(pbrt_get_integer_hint(parser, list, "finalgathersamples", 1, 65536, &hints->gather_samples));
    AG_TRY(pbrt_get_integer_hint(parser, list, "maxdepth", 0, 100, &hints->max_depth));
    AG_TRY(parameter_get_bool(list, parser->log, "finalgather", &final_gather));
    if (!(hints->radius.value >= 0.0f) || isinf(hints->radius.value))
        return pbrt_refuse(parser, list, "maxdist", "Integrator: \"maxdist\" must be finite and not negative");
    if (!final_gather)
        log_at_once(parser->log, AG_LOG_WARNING, list->where, "finalgather",
                    "Integrator \"photonmap\": \"finalgather\" false is not supported; indirect light is gathered");
    parameter_list_warn_unused(list, parser->log);
    return AG_OK;
}

ag_status pbrt_settle_hints(pbrt_parser *parser)
{
    AG_TRY(pbrt_settle_film(parser));
    AG_TRY(settle_sampler(parser));
    AG_TRY(settle_integrator(parser));
    return pbrt_settle_pixel_filter(parser);
}

void pbrt_reset_hints(pbrt_parser *parser)
{
    parameter_list_reset(&parser->integrator);
    parameter_list_reset(&parser->sampler);
    parameter_list_reset(&parser->film);
    parameter_list_reset(&parser->pixel_filter);
}
