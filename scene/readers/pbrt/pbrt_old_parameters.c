/* pbrt_old_parameters.c: pbrt-v3's names of kinds and parameters, of all directives but materials, as pbrt-v4's own
 * "--upgrade" makes new ones of them.
 * Rests on pbrt-v4's src/pbrt/parser.cpp (which name becomes which); for the luminance of a black body whose greatest
 * value is 1, as pbrt-v3 has it, on its src/core/spectrum.cpp.
 * Flow: pbrt_parameters -> [here]: lists are changed before anybody reads them. Threads: one per scene. */
#define _POSIX_C_SOURCE 200809L
#include "color/spectra.h"
#include "pbrt/pbrt_private.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static parameter *find(parameter_list *list, const char *name) { return (parameter *)parameter_list_find(list, name); }

static ag_status replace_text(char **text, const char *by)
{
    char *copy = strdup(by);
    if (!copy)
        return AG_ERROR_MEMORY;
    free(*text);
    *text = copy;
    return AG_OK;
}

ag_status pbrt_rename_parameter(parameter_list *list, const char *from, const char *to)
{
    parameter *p = find(list, from);
    return p && !find(list, to) ? replace_text(&p->name, to) : AG_OK;
}

/* Adds a parameter without values. */
static ag_status add_parameter(parameter_list *list, const char *name, parameter_type type, parameter **out_parameter)
{
    parameter *larger = realloc(list->items, (list->count + 1) * sizeof *larger);
    if (!larger)
        return AG_ERROR_MEMORY;
    list->items = larger;
    parameter *p = *out_parameter = &larger[list->count];
    memset(p, 0, sizeof *p);
    p->type = type;
    p->where = list->where;
    p->name = strdup(name);
    if (!p->name)
        return AG_ERROR_MEMORY;
    list->count++; /* the list's from here on */
    return AG_OK;
}

ag_status pbrt_add_string(parameter_list *list, const char *name, parameter_type type, const char *value)
{
    parameter *p;
    if (find(list, name))
        return AG_OK;
    AG_TRY(add_parameter(list, name, type, &p));
    p->strings = calloc(1, sizeof *p->strings);
    if (!p->strings)
        return AG_ERROR_MEMORY;
    p->count = 1;
    p->strings[0] = strdup(value);
    return p->strings[0] ? AG_OK : AG_ERROR_MEMORY;
}

static void tell(pbrt_parser *parser, const parameter_list *list, file_location where, const char *old, const char *new)
{
    char key[160];
    snprintf(key, sizeof key, "old:%s:%s", list->directive, old);
    log_at_once(parser->log, AG_LOG_WARNING, where, key,
                "%s: \"%s\" is pbrt-v3's: it is read as \"%s\", as pbrt-v4's \"--upgrade\" does", list->directive, old,
                new);
}

/* Kinds */

static ag_status upgrade_kind(pbrt_parser *parser, parameter_list *list)
{
    static const struct {
        const char *directive, *old, *new;
    } KINDS[] = {
        {"Film", "image", "rgb"},
        {"Sampler", "lowdiscrepancy", "paddedsobol"},
        {"Sampler", "02sequence", "paddedsobol"},
        {"Sampler", "maxmindist", "pmj02bn"},
        {"Sampler", "random", "independent"},
        {"Camera", "environment", "spherical"},
        {"AreaLightSource", "area", "diffuse"},
    };
    for (size_t i = 0; i < sizeof KINDS / sizeof *KINDS; i++)
        if (strcmp(list->directive, KINDS[i].directive) == 0 && strcmp(list->name, KINDS[i].old) == 0) {
            if (strcmp(list->directive, "Camera") == 0)
                AG_TRY(pbrt_add_string(list, "mapping", PARAMETER_STRING, "equirectangular"));
            tell(parser, list, list->where, KINDS[i].old, KINDS[i].new);
            return replace_text(&list->name, KINDS[i].new);
        }
    return AG_OK;
}

/* Names */

/* new: NULL where it made no difference to the picture, which needs no words. */
static ag_status upgrade_names(pbrt_parser *parser, parameter_list *list)
{
    static const struct {
        const char *directive, *old, *new;
    } NAMES[] = {
        {"Film", "maxsampleluminance", "maxcomponentvalue"},
        {"PixelFilter", "xwidth", "xradius"},
        {"PixelFilter", "ywidth", "yradius"},
        {"LightSource", "mapname", "filename"},
        {"LightSource", "samples", NULL},
        {"LightSource", "nsamples", NULL},
        {"AreaLightSource", "samples", NULL},
        {"AreaLightSource", "nsamples", NULL},
        {"Shape", "st", "uv"},
        {"Shape", "nlevels", "levels"},
        {"Shape", "discarddegenerateUVs", NULL},
        {"Shape", "shadowalpha", NULL},
        {"Camera", "simpleweighting", NULL},
    };
    for (size_t i = 0; i < sizeof NAMES / sizeof *NAMES; i++) {
        parameter *p = strcmp(list->directive, NAMES[i].directive) == 0 ? find(list, NAMES[i].old) : NULL;
        if (!p)
            continue;
        if (!NAMES[i].new) {
            p->looked_up = true;
            continue;
        }
        tell(parser, list, p->where, NAMES[i].old, NAMES[i].new);
        AG_TRY(pbrt_rename_parameter(list, NAMES[i].old, NAMES[i].new));
    }
    return AG_OK;
}

/* Values */

static bool is_number(const parameter *p) { return p && p->type == PARAMETER_FLOAT && p->count == 1; }

static ag_status upgrade_film(pbrt_parser *parser, parameter_list *list)
{
    parameter *scale = find(list, "scale");
    if (!is_number(scale) || find(list, "iso"))
        return AG_OK;
    tell(parser, list, scale->where, "scale", "iso");
    scale->numbers[0] *= 100.0;
    return pbrt_rename_parameter(list, "scale", "iso");
}

static ag_status upgrade_filter(pbrt_parser *parser, parameter_list *list)
{
    parameter *alpha = find(list, "alpha");
    if (strcmp(list->name, "gaussian") != 0 || !is_number(alpha) || !(alpha->numbers[0] > 0.0) || find(list, "sigma"))
        return AG_OK;
    tell(parser, list, alpha->where, "alpha", "sigma");
    alpha->numbers[0] = 1.0 / sqrt(2.0 * alpha->numbers[0]);
    return pbrt_rename_parameter(list, "alpha", "sigma");
}

/* Turns "float uv" into "point2 uv": in pbrt-v3 it could hold pairs of plain numbers. */
static ag_status upgrade_shape(pbrt_parser *parser, parameter_list *list)
{
    parameter *uv = find(list, "uv");
    if (!uv || uv->type != PARAMETER_FLOAT || uv->count % 2 != 0)
        return AG_OK;
    tell(parser, list, uv->where, "float uv", "point2 uv");
    uv->type = PARAMETER_POINT2;
    return AG_OK;
}

static bool is_grey(const parameter *p)
{
    return p && p->type == PARAMETER_RGB && p->count == 3 && p->numbers[0] == p->numbers[1] &&
           p->numbers[1] == p->numbers[2];
}

static ag_status multiply_scale(parameter_list *list, double factor)
{
    parameter *scale = find(list, "scale");
    if (!scale) {
        AG_TRY(add_parameter(list, "scale", PARAMETER_FLOAT, &scale));
        scale->numbers = malloc(sizeof *scale->numbers);
        if (!scale->numbers)
            return AG_ERROR_MEMORY;
        scale->count = 1;
        scale->numbers[0] = 1.0;
    }
    if (!is_number(scale)) /* its reader refuses it */
        return AG_OK;
    AG_TRY(parameter_own(scale));
    scale->numbers[0] *= factor;
    return AG_OK;
}

/* A light's "scale" was a colour, and so was what multiplied its picture. */
static ag_status upgrade_light_scale(pbrt_parser *parser, parameter_list *list, const char *color_name)
{
    parameter *scale = find(list, "scale"), *color = find(list, color_name);
    if (!scale || scale->type != PARAMETER_RGB || scale->count != 3)
        return AG_OK;
    tell(parser, list, scale->where, "rgb scale", "float scale");
    if (is_grey(scale)) {
        scale->type = PARAMETER_FLOAT;
        scale->count = 1;
        return AG_OK;
    }
    if (!color) /* it is 1 */
        return pbrt_rename_parameter(list, "scale", color_name);
    if (color->type != PARAMETER_RGB || color->count != 3)
        return pbrt_refuse(parser, list, "scale", "\"rgb scale\" can be read beside \"rgb %s\" alone", color_name);
    AG_TRY(parameter_own(color));
    AG_TRY(parameter_own(scale));
    for (int i = 0; i < 3; i++)
        color->numbers[i] *= scale->numbers[i];
    scale->type = PARAMETER_FLOAT;
    scale->count = 1;
    scale->numbers[0] = 1.0;
    return AG_OK;
}

/* "blackbody L" [ kelvin scale ]: its greatest value was 1; of ours it is the luminance. */
static ag_status upgrade_blackbody(pbrt_parser *parser, parameter_list *list, const char *color_name)
{
    parameter *color = find(list, color_name);
    if (!color || color->type != PARAMETER_BLACKBODY || color->count != 2 ||
        !(color->numbers[0] >= SPECTRA_MIN_KELVIN && color->numbers[0] <= SPECTRA_MAX_KELVIN))
        return AG_OK;
    double factor = color->numbers[1] * spectra_blackbody_luminance(color->numbers[0]);
    log_at_once(parser->log, AG_LOG_WARNING, color->where, "old blackbody",
                "\"blackbody %s\" with a temperature and a scale is pbrt-v3's: it is as bright as there, whose black "
                "bodies have 1 as their greatest value",
                color_name);
    color->count = 1;
    return multiply_scale(list, factor);
}

static ag_status upgrade_light(pbrt_parser *parser, parameter_list *list)
{
    const char *color_name = find(list, "I") ? "I" : "L";
    static const char *const OF_INTENSITY[] = {"point", "spot", "goniometric", "projection"};
    for (size_t i = 0; i < sizeof OF_INTENSITY / sizeof *OF_INTENSITY; i++)
        if (strcmp(list->name, OF_INTENSITY[i]) == 0)
            color_name = "I";
    AG_TRY(upgrade_light_scale(parser, list, color_name));
    return upgrade_blackbody(parser, list, color_name);
}

/* pbrt-v3 multiplies the picture by the colour, which pbrt-v4 has no more where there is a picture. */
static ag_status upgrade_picture(parameter_list *list)
{
    bool is_infinite = strcmp(list->name, "infinite") == 0;
    parameter *color = find(list, is_infinite ? "L" : "I");
    if (!find(list, "mapname") || (!is_infinite && strcmp(list->name, "projection") != 0) || !is_grey(color))
        return AG_OK;
    double factor = color->numbers[0];
    parameter_reset(color);
    *color = list->items[--list->count];
    return multiply_scale(list, factor);
}

static ag_status upgrade_medium(pbrt_parser *parser, parameter_list *list)
{
    parameter *type = find(list, "type");
    if (!type || type->type != PARAMETER_STRING || type->count != 1 || strcmp(type->strings[0], "heterogeneous") != 0)
        return AG_OK;
    tell(parser, list, type->where, "heterogeneous", "uniformgrid");
    AG_TRY(parameter_own(type));
    return replace_text(&type->strings[0], "uniformgrid");
}

ag_status pbrt_upgrade_parameters(pbrt_parser *parser, parameter_list *list)
{
    const char *directive = list->directive;
    if (!list->name)
        return AG_OK;
    if (strcmp(directive, "LightSource") == 0)
        AG_TRY(upgrade_picture(list));
    AG_TRY(upgrade_kind(parser, list));
    if (list->count == 0)
        return AG_OK;
    AG_TRY(upgrade_names(parser, list));
    if (strcmp(directive, "Shape") == 0)
        return upgrade_shape(parser, list);
    if (strcmp(directive, "LightSource") == 0 || strcmp(directive, "AreaLightSource") == 0)
        return upgrade_light(parser, list);
    if (strcmp(directive, "Film") == 0)
        return upgrade_film(parser, list);
    if (strcmp(directive, "PixelFilter") == 0)
        return upgrade_filter(parser, list);
    return strcmp(directive, "MakeNamedMedium") == 0 ? upgrade_medium(parser, list) : AG_OK;
}
