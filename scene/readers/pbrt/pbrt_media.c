/* pbrt_media.c: MakeNamedMedium and MediumInterface of a pbrt-v4 scene.
 * Rests on the format's description, pbrt.org/fileformat-v4, "Participating media"; defaults as in pbrt-v4's media.cpp.
 * Media that vary from point to point get a stand-in that absorbs alike everywhere; those that scatter too, one that
 * does nothing.
 * Flow: pbrt_parser -> [here] -> scene.media; shapes, lights and the camera use them. Threads: one per scene. */
#define _POSIX_C_SOURCE 200809L
#include "pbrt/pbrt_private.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static ag_status tell_emission(pbrt_parser *parser, parameter_list *list)
{
    rgb emitted = rgb_gray(0.0f);
    float scale = 1.0f;
    AG_TRY(parameter_get_rgb(list, parser->log, "Le", &emitted));
    AG_TRY(parameter_get_float(list, parser->log, "Lescale", &scale));
    if (!rgb_is_black(emitted))
        log_at_once(parser->log, AG_LOG_WARNING, list->where, "medium Le",
                    "media that emit light are not supported: \"Le\" of \"%s\" is ignored, as are any others",
                    list->name);
    return AG_OK;
}

static ag_status read_scale(pbrt_parser *parser, parameter_list *list, float *out_scale)
{
    *out_scale = 1.0f;
    AG_TRY(parameter_get_float(list, parser->log, "scale", out_scale));
    return *out_scale >= 0.0f ? AG_OK : pbrt_refuse(parser, list, "scale", "\"scale\" should not be negative");
}

/* Scales a coefficient; scale is a product with a mean, which may overflow. */
static rgb scaled(rgb sigma, double scale)
{
    return rgb_make((float)(sigma.r * scale), (float)(sigma.g * scale), (float)(sigma.b * scale));
}

static ag_status set_absorption(pbrt_parser *parser, const parameter_list *list, rgb sigma_a, double scale, medium *m)
{
    m->as.homogeneous.sigma_a = scaled(sigma_a, scale);
    return rgb_is_finite(m->as.homogeneous.sigma_a)
               ? AG_OK
               : pbrt_refuse(parser, list, "scale", "it absorbs more than a float holds");
}

static ag_status set_scattering(pbrt_parser *parser, const parameter_list *list, rgb sigma_s, double scale, medium *m)
{
    homogeneous_parameters *p = &m->as.homogeneous;
    p->sigma_s = scaled(sigma_s, scale);
    return rgb_is_finite(rgb_add(p->sigma_a, p->sigma_s))
               ? AG_OK
               : pbrt_refuse(parser, list, "scale", "it scatters more than a float holds");
}

/* As pbrt: "sigma_a" and "sigma_s", 1 per unit by default, count where no preset is given that is known; neither is
 * scaled by the current transform. */
static ag_status read_homogeneous(pbrt_parser *parser, parameter_list *list, medium *m)
{
    const char *preset = "";
    rgb sigma_a = rgb_gray(1.0f), sigma_s = rgb_gray(1.0f);
    float scale;
    AG_TRY(parameter_get_string(list, parser->log, "preset", &preset));
    if (!preset[0] || !medium_find_preset(preset, &sigma_a, &sigma_s)) {
        if (preset[0])
            log_at(parser->log, AG_LOG_WARNING, parameter_list_find(list, "preset")->where,
                   "no medium has the preset \"%s\": \"sigma_a\" counts", preset);
        AG_TRY(parameter_get_rgb(list, parser->log, "sigma_a", &sigma_a));
        AG_TRY(parameter_get_rgb(list, parser->log, "sigma_s", &sigma_s));
    } else {
        sigma_a = working_space_light(&parser->scene->space, sigma_a);
        sigma_s = working_space_light(&parser->scene->space, sigma_s);
    }
    AG_TRY(read_scale(parser, list, &scale));
    AG_TRY(parameter_get_float(list, parser->log, "g", &m->phase.g));
    if (!(fabsf(m->phase.g) < 1.0f))
        return pbrt_refuse(parser, list, "g", "\"g\" should be more than -1 and less than 1");
    AG_TRY(tell_emission(parser, list));
    parameter_list_warn_unused(list, parser->log);
    AG_TRY(set_absorption(parser, list, sigma_a, (double)scale, m));
    return set_scattering(parser, list, sigma_s, (double)scale, m);
}

/* Returns the mean of one of `components` components. */
static double mean_of(const double *values, size_t count, size_t components, size_t component)
{
    double sum = 0.0;
    for (size_t i = component; i < count; i += components)
        sum += values[i];
    return sum / (double)(count / components);
}

static void tell_stand_in(pbrt_parser *parser, const parameter_list *list, const char *type, const char *stand_in)
{
    char key[64];
    snprintf(key, sizeof key, "medium:%s:%c", type, stand_in[0]); /* one key for each stand-in */
    log_at_once(parser->log, AG_LOG_WARNING, list->where, key,
                "media of type \"%s\" are not supported: \"%s\" %s, as do any others", type, list->name, stand_in);
}

/* A medium that scatters and varies is mostly a cloud in a container that it does not fill: absorbing everywhere in it
 * would hide all behind. */
static void tell_grid(pbrt_parser *parser, const parameter_list *list, const char *type, bool scatters, medium *m)
{
    if (scatters)
        m->as.homogeneous.sigma_a = rgb_gray(0.0f);
    tell_stand_in(parser, list, type,
                  scatters ? "neither absorbs nor scatters" : "absorbs alike everywhere, by its mean \"sigma_a\"");
}

/* Reads a density for each cell of a box, times sigma_a. */
static ag_status read_uniform_grid(pbrt_parser *parser, parameter_list *list, medium *m)
{
    const double *density;
    size_t count;
    rgb sigma_a = rgb_gray(1.0f), sigma_s = rgb_gray(1.0f);
    float scale;
    AG_TRY(parameter_get_numbers(list, parser->log, "density", PARAMETER_FLOAT, &density, &count));
    if (count == 0)
        return pbrt_refuse(parser, list, "density", "a medium of type \"uniformgrid\" needs \"float density\"");
    for (size_t i = 0; i < count; i++)
        if (density[i] < 0.0)
            return pbrt_refuse(parser, list, "density", "\"density\" has a negative value, %g", density[i]);
    AG_TRY(parameter_get_rgb(list, parser->log, "sigma_a", &sigma_a));
    AG_TRY(parameter_get_rgb(list, parser->log, "sigma_s", &sigma_s));
    AG_TRY(read_scale(parser, list, &scale));
    AG_TRY(set_absorption(parser, list, sigma_a, (double)scale * mean_of(density, count, 1, 0), m));
    tell_grid(parser, list, "uniformgrid", !rgb_is_black(sigma_s), m);
    return AG_OK;
}

/* Reads sigma_a for each cell; without it, as in pbrt, it is 1 everywhere. */
static ag_status read_rgb_grid(pbrt_parser *parser, parameter_list *list, medium *m)
{
    const double *values, *scattering;
    size_t count, scattering_count;
    float scale;
    rgb mean = rgb_gray(1.0f);
    AG_TRY(parameter_get_numbers(list, parser->log, "sigma_a", PARAMETER_RGB, &values, &count));
    if (count == 0 && !parameter_list_find(list, "sigma_s"))
        return pbrt_refuse(parser, list, "sigma_a", "a medium of type \"rgbgrid\" needs \"sigma_a\" or \"sigma_s\"");
    for (size_t i = 0; i < count; i++)
        if (values[i] < 0.0)
            return pbrt_refuse(parser, list, "sigma_a", "\"sigma_a\" has a negative component, %g", values[i]);
    if (count % 3 != 0)
        return pbrt_refuse(parser, list, "sigma_a", "\"sigma_a\" should have 3 values for each cell");
    if (count > 0)
        mean = rgb_make((float)mean_of(values, count, 3, 0), (float)mean_of(values, count, 3, 1),
                        (float)mean_of(values, count, 3, 2));
    AG_TRY(parameter_get_numbers(list, parser->log, "sigma_s", PARAMETER_RGB, &scattering, &scattering_count));
    bool scatters = scattering_count == 0; /* without it it is 1 */
    for (size_t i = 0; i < scattering_count; i++)
        scatters = scatters || scattering[i] != 0.0;
    AG_TRY(read_scale(parser, list, &scale));
    AG_TRY(set_absorption(parser, list, mean, (double)scale, m));
    tell_grid(parser, list, "rgbgrid", scatters, m);
    return AG_OK;
}

/* Reads a medium whose density is in a file, or in pbrt's own noise. */
static ag_status read_unknown_density(pbrt_parser *parser, parameter_list *list, medium *m)
{
    const char *type = parameter_list_find(list, "type")->strings[0];
    tell_stand_in(parser, list, type, "neither absorbs nor scatters");
    m->as.homogeneous.sigma_a = rgb_gray(0.0f);
    return AG_OK;
}

static ag_status read_medium(pbrt_parser *parser, parameter_list *list, medium *out_medium)
{
    static const struct {
        const char *type;
        ag_status (*read)(pbrt_parser *parser, parameter_list *list, medium *m);
    } READERS[] = {{"homogeneous", read_homogeneous},
                   {"uniformgrid", read_uniform_grid},
                   {"rgbgrid", read_rgb_grid},
                   {"cloud", read_unknown_density},
                   {"nanovdb", read_unknown_density}};
    const char *type = NULL;
    AG_TRY(parameter_get_string(list, parser->log, "type", &type));
    if (!type)
        return pbrt_error(parser, list->where, strlen("MakeNamedMedium"),
                          "MakeNamedMedium \"%s\" has no \"string type\"", list->name);
    for (size_t i = 0; i < sizeof READERS / sizeof *READERS; i++)
        if (strcmp(type, READERS[i].type) == 0)
            return READERS[i].read(parser, list, out_medium);
    return pbrt_refuse(parser, list, "type", "unknown medium \"%s\"", type);
}

/* The index of a name among the named media, new where it is not there yet. */
static ag_status find_or_reserve(pbrt_parser *parser, const char *name, file_location where, size_t *out_named)
{
    uint32_t found;
    if (name_table_find(&parser->medium_names, name, &found)) {
        *out_named = found;
        return AG_OK;
    }
    size_t count = parser->named_medium_count;
    if ((count & (count - 1)) == 0) { /* room has doubled at every power of two */
        size_t capacity = count ? 2 * count : 4;
        pbrt_named_medium *larger =
            count < UINT32_MAX / 2 ? realloc(parser->named_media, capacity * sizeof *larger) : NULL;
        if (!larger)
            return AG_ERROR_MEMORY;
        parser->named_media = larger;
    }
    pbrt_named_medium added = {.where = where};
    const medium nothing = medium_make(MEDIUM_HOMOGENEOUS);
    AG_TRY(scene_add_medium(parser->scene, &nothing, &added.index));
    added.name = strdup(name);
    if (!added.name || name_table_set(&parser->medium_names, name, (uint32_t)count)) {
        free(added.name);
        return AG_ERROR_MEMORY;
    }
    parser->named_media[count] = added;
    parser->named_medium_count++;
    *out_named = count;
    return AG_OK;
}

static ag_status make_named(pbrt_parser *parser, parameter_list *list)
{
    size_t index;
    AG_TRY(find_or_reserve(parser, list->name, list->where, &index));
    pbrt_named_medium *named = &parser->named_media[index];
    if (named->is_defined)
        return pbrt_error(parser, list->where, strlen("MakeNamedMedium"),
                          "medium \"%s\" is made twice, first at %s:%d:%d", list->name, named->where.file,
                          named->where.line, named->where.column);
    medium made = medium_make(MEDIUM_HOMOGENEOUS);
    ag_status status = read_medium(parser, list, &made);
    if (status != AG_OK) {
        medium_reset(&made);
        return status;
    }
    parser->scene->media[named->index] = made;
    named->is_defined = true;
    named->where = list->where;
    return AG_OK;
}

ag_status pbrt_make_named_medium(pbrt_parser *parser, file_location where)
{
    parameter_list list;
    AG_TRY(pbrt_read_named_parameters(parser, "MakeNamedMedium", "a quoted name", where, &list));
    ag_status status = make_named(parser, &list);
    parameter_list_reset(&list);
    return status;
}

/* Reads the name of the medium on one side; the empty name is that of no medium. */
static ag_status read_side(pbrt_parser *parser, const char *name, file_location where, size_t *out_named)
{
    *out_named = PBRT_NO_MEDIUM;
    return name[0] ? find_or_reserve(parser, name, where, out_named) : AG_OK;
}

ag_status pbrt_medium_interface(pbrt_parser *parser, file_location where)
{
    char *inside, *outside = NULL;
    pbrt_token second;
    AG_TRY(pbrt_read_string(parser, "MediumInterface", "a quoted name", &inside, NULL));
    ag_status status = pbrt_peek(parser, &second);
    if (status == AG_OK && second.kind == PBRT_TOKEN_STRING)
        status = pbrt_read_string(parser, "MediumInterface", "a quoted name", &outside, NULL);
    if (status == AG_OK)
        status = read_side(parser, inside, where, &parser->state.medium_inside);
    if (status == AG_OK) /* as pbrt: one name is that of both sides */
        status = read_side(parser, outside ? outside : inside, where, &parser->state.medium_outside);
    free(inside);
    free(outside);
    return status;
}

uint32_t pbrt_medium_index(const pbrt_parser *parser, size_t named)
{
    return named == PBRT_NO_MEDIUM ? SCENE_NO_MEDIUM : parser->named_media[named].index;
}

uint32_t pbrt_use_medium(pbrt_parser *parser, size_t named)
{
    if (named != PBRT_NO_MEDIUM)
        parser->named_media[named].is_used = true;
    return pbrt_medium_index(parser, named);
}

ag_status pbrt_check_named_media(pbrt_parser *parser)
{
    for (size_t i = 0; i < parser->named_medium_count; i++) {
        const pbrt_named_medium *named = &parser->named_media[i];
        const bool is_used = named->is_used || named->index == parser->scene->camera_medium;
        if (is_used && !named->is_defined)
            return pbrt_error(parser, named->where, strlen("MediumInterface"), "no medium is named \"%s\"",
                              named->name);
    }
    return AG_OK;
}
