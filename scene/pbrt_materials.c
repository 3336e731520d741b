/* pbrt_materials.c: Material, MakeNamedMaterial and NamedMaterial of a pbrt-v4 scene.
 * Rests on the format's description, pbrt.org/fileformat-v4, "Materials".
 * Flow: pbrt_parser -> [here] -> scene.materials. Threads: one per scene. */
#define _POSIX_C_SOURCE 200809L
#include "pbrt_private.h"
#include "spectra.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static material default_material(void)
{
    material m;
    memset(&m, 0, sizeof m);
    m.kind = MATERIAL_DIFFUSE;
    m.reflectance = rgb_gray(0.5f);
    m.ior = 1.5f;
    return m;
}

static ag_status read_reflectance(pbrt_parser *parser, parameter_list *list, rgb *reflectance)
{
    PBRT_TRY(parameter_get_rgb(list, parser->log, "reflectance", reflectance));
    if (rgb_max(*reflectance) > 1.0f) {
        const parameter *p = parameter_list_find(list, "reflectance");
        log_at(parser->log, AG_LOG_WARNING, p->where, "\"reflectance\" is above 1: 1 is used");
        *reflectance = rgb_make(fminf(reflectance->r, 1.0f), fminf(reflectance->g, 1.0f), fminf(reflectance->b, 1.0f));
    }
    return AG_OK;
}

static ag_status read_roughness(pbrt_parser *parser, parameter_list *list, material *m)
{
    static const char *const NAMES[2] = {"uroughness", "vroughness"};
    float *const out_alpha[2] = {&m->alpha_u, &m->alpha_v};
    float roughness = 0.0f;
    bool remap = true;
    PBRT_TRY(parameter_get_float(list, parser->log, "roughness", &roughness));
    PBRT_TRY(parameter_get_bool(list, parser->log, "remaproughness", &remap));
    if (roughness < 0.0f)
        return pbrt_refuse(parser, list, "roughness", "\"roughness\" should not be negative");
    for (int i = 0; i < 2; i++) {
        float value = roughness;
        PBRT_TRY(parameter_get_float(list, parser->log, NAMES[i], &value));
        if (value < 0.0f)
            return pbrt_refuse(parser, list, NAMES[i], "\"%s\" should not be negative", NAMES[i]);
        *out_alpha[i] = remap ? sqrtf(value) : value;
    }
    return AG_OK;
}

/* The k that a conductor of index 1 needs to reflect r at normal incidence. */
static float k_from_reflectance(float r)
{
    float clamped = fminf(fmaxf(r, 0.0f), 0.9999f);
    return 2.0f * sqrtf(clamped) / sqrtf(1.0f - clamped);
}

static ag_status read_conductor(pbrt_parser *parser, parameter_list *list, material *m)
{
    m->kind = MATERIAL_CONDUCTOR;
    bool has_reflectance = parameter_list_find(list, "reflectance") != NULL;
    spectra_find_named("metal-Cu-eta", &m->eta);
    spectra_find_named("metal-Cu-k", &m->k);
    if (has_reflectance && (parameter_list_find(list, "eta") || parameter_list_find(list, "k")))
        return pbrt_refuse(parser, list, "reflectance",
                           "\"reflectance\" and \"eta\" or \"k\" cannot both be given to a conductor");
    if (has_reflectance) {
        rgb r = rgb_gray(0.5f);
        PBRT_TRY(read_reflectance(parser, list, &r));
        m->eta = rgb_gray(1.0f);
        m->k = rgb_make(k_from_reflectance(r.r), k_from_reflectance(r.g), k_from_reflectance(r.b));
    } else {
        PBRT_TRY(parameter_get_rgb(list, parser->log, "eta", &m->eta));
        PBRT_TRY(parameter_get_rgb(list, parser->log, "k", &m->k));
        if (!(m->eta.r > 0.0f && m->eta.g > 0.0f && m->eta.b > 0.0f))
            return pbrt_refuse(parser, list, "eta", "\"eta\" should be above 0");
    }
    return read_roughness(parser, list, m);
}

static ag_status read_dielectric(pbrt_parser *parser, parameter_list *list, material *m)
{
    m->kind = MATERIAL_DIELECTRIC;
    const parameter *eta = parameter_list_find(list, "eta");
    if (eta && eta->type == PARAMETER_SPECTRUM) {
        rgb value = rgb_gray(m->ior);
        PBRT_TRY(parameter_get_rgb(list, parser->log, "eta", &value));
        m->ior = value.g; /* one index for all light: dispersion is not simulated */
    } else {
        PBRT_TRY(parameter_get_float(list, parser->log, "eta", &m->ior));
    }
    if (!(m->ior > 0.0f))
        return pbrt_refuse(parser, list, "eta", "\"eta\" should be above 0");
    return read_roughness(parser, list, m);
}

/* What is not supported yet gets the nearest plain thing. Its other parameters go unread with it. */
static ag_status read_stand_in(pbrt_parser *parser, parameter_list *list, const char *type, material *m)
{
    char key[96];
    bool is_coated = strcmp(type, "coateddiffuse") == 0;
    snprintf(key, sizeof key, "material:%s", type);
    log_at_once(
        parser->log, AG_LOG_WARNING, list->where, key,
        is_coated
            ? "material \"%s\" is not supported yet: \"diffuse\" of the same reflectance stands in"
            : "material \"%s\" is not known, or not supported yet: \"diffuse\" with a reflectance of 0.5 stands in",
        type);
    return is_coated ? read_reflectance(parser, list, &m->reflectance) : AG_OK;
}

static ag_status read_material(pbrt_parser *parser, parameter_list *list, const char *type, material *out_material,
                               bool *out_has_no_surface)
{
    material m = default_material();
    bool is_known = true;
    *out_has_no_surface = false;
    if (strcmp(type, "diffuse") == 0) {
        PBRT_TRY(read_reflectance(parser, list, &m.reflectance));
    } else if (strcmp(type, "conductor") == 0) {
        PBRT_TRY(read_conductor(parser, list, &m));
    } else if (strcmp(type, "dielectric") == 0) {
        PBRT_TRY(read_dielectric(parser, list, &m));
    } else if (strcmp(type, "interface") == 0 || strcmp(type, "none") == 0 || type[0] == '\0') {
        *out_has_no_surface = true;
    } else {
        is_known = false;
        PBRT_TRY(read_stand_in(parser, list, type, &m));
    }
    if (is_known)
        parameter_list_warn_unused(list, parser->log);
    *out_material = m;
    return AG_OK;
}

ag_status pbrt_add_default_material(pbrt_parser *parser)
{
    material m = default_material();
    return scene_add_material(parser->scene, &m, &parser->state.material_index);
}

ag_status pbrt_material(pbrt_parser *parser, file_location where)
{
    parameter_list list;
    material m;
    bool has_no_surface;
    PBRT_TRY(pbrt_read_named_parameters(parser, "Material", "a quoted type", where, &list));
    ag_status status = read_material(parser, &list, list.name, &m, &has_no_surface);
    parameter_list_reset(&list);
    if (!status)
        status = scene_add_material(parser->scene, &m, &parser->state.material_index);
    parser->state.has_no_surface = has_no_surface;
    return status;
}

static pbrt_named_material *find_named_material(pbrt_parser *parser, const char *name)
{
    uint32_t found;
    return name_table_find(&parser->material_names, name, &found) ? &parser->named_materials[found] : NULL;
}

/* Adds a name that is not there yet, for the scene's material of that index. */
static ag_status add_named_material(pbrt_parser *parser, const char *name, pbrt_named_material added)
{
    size_t count = parser->named_material_count;
    if ((count & (count - 1)) == 0) { /* room has doubled at every power of two */
        size_t capacity = count ? 2 * count : 16;
        pbrt_named_material *larger =
            count < UINT32_MAX / 2 ? realloc(parser->named_materials, capacity * sizeof *larger) : NULL;
        if (!larger)
            return AG_ERROR_MEMORY;
        parser->named_materials = larger;
    }
    added.name = strdup(name);
    if (!added.name || name_table_set(&parser->material_names, name, (uint32_t)count)) {
        free(added.name);
        return AG_ERROR_MEMORY;
    }
    parser->named_materials[count] = added;
    parser->named_material_count++;
    return AG_OK;
}

static ag_status make_named(pbrt_parser *parser, parameter_list *list)
{
    const char *type = NULL;
    material m;
    pbrt_named_material made = {.is_defined = true, .where = list->where};
    PBRT_TRY(parameter_get_string(list, parser->log, "type", &type));
    if (!type)
        return pbrt_error(parser, list->where, strlen("MakeNamedMaterial"),
                          "MakeNamedMaterial \"%s\" has no \"string type\"", list->name);
    pbrt_named_material *named = find_named_material(parser, list->name);
    if (named && named->is_defined)
        return pbrt_error(parser, list->where, strlen("MakeNamedMaterial"),
                          "material \"%s\" is made twice, first at %s:%d:%d", list->name, named->where.file,
                          named->where.line, named->where.column);
    PBRT_TRY(read_material(parser, list, type, &m, &made.has_no_surface));
    PBRT_TRY(scene_add_material(parser->scene, &m, &made.index));
    if (!named)
        return add_named_material(parser, list->name, made);
    /* it has been used before: fill the place that was made for it then */
    if (made.has_no_surface)
        log_at(parser->log, AG_LOG_WARNING, list->where,
               "material \"%s\" has no surface, but is made after its first use: \"diffuse\" stands in until here",
               list->name);
    parser->scene->materials[named->index] = parser->scene->materials[made.index];
    named->is_defined = true;
    named->has_no_surface = made.has_no_surface;
    named->where = made.where;
    return AG_OK;
}

ag_status pbrt_make_named_material(pbrt_parser *parser, file_location where)
{
    parameter_list list;
    PBRT_TRY(pbrt_read_named_parameters(parser, "MakeNamedMaterial", "a quoted name", where, &list));
    ag_status status = make_named(parser, &list);
    parameter_list_reset(&list);
    return status;
}

static ag_status use_named(pbrt_parser *parser, const char *name, file_location where)
{
    const pbrt_named_material *named = find_named_material(parser, name);
    if (!named) { /* it may still be made, as in pbrt: keep a place for it */
        pbrt_named_material used = {.where = where};
        material place = default_material();
        PBRT_TRY(scene_add_material(parser->scene, &place, &used.index));
        PBRT_TRY(add_named_material(parser, name, used));
        named = find_named_material(parser, name);
    }
    parser->state.material_index = named->index;
    parser->state.has_no_surface = named->has_no_surface;
    return AG_OK;
}

ag_status pbrt_use_named_material(pbrt_parser *parser, file_location where)
{
    char *name;
    PBRT_TRY(pbrt_read_string(parser, "NamedMaterial", "a quoted name", &name, NULL));
    ag_status status = use_named(parser, name, where);
    free(name);
    return status;
}

ag_status pbrt_check_named_materials(pbrt_parser *parser)
{
    for (size_t i = 0; i < parser->named_material_count; i++) {
        const pbrt_named_material *named = &parser->named_materials[i];
        if (!named->is_defined)
            return pbrt_error(parser, named->where, strlen("NamedMaterial"), "no material is named \"%s\"",
                              named->name);
    }
    return AG_OK;
}
