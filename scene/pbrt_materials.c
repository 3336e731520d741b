/* pbrt_materials.c: Material, MakeNamedMaterial and NamedMaterial of a pbrt-v4 scene.
 * Rests on the format's description, pbrt.org/fileformat-v4, "Materials".
 * Flow: pbrt_parser -> [here] -> scene.materials. Threads: one per scene. */
#define _POSIX_C_SOURCE 200809L
#include "pbrt_private.h"
#include "spectra.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static ag_status read_reflectance(pbrt_parser *parser, parameter_list *list, material *m)
{
    rgb *r = &m->reflectance;
    PBRT_TRY(pbrt_get_rgb_texture(parser, list, "reflectance", r, &m->reflectance_texture));
    if (rgb_max(*r) > 1.0f) {
        const parameter *p = parameter_list_find(list, "reflectance");
        log_at(parser->log, AG_LOG_WARNING, p->where, "\"reflectance\" is above 1: 1 is used");
        *r = rgb_make(fminf(r->r, 1.0f), fminf(r->g, 1.0f), fminf(r->b, 1.0f));
    }
    return AG_OK;
}

/* "roughness" and its two axes, of the outer interface; prefix: of the parts of a coated conductor. */
static ag_status read_roughness(pbrt_parser *parser, parameter_list *list, const char *prefix, material *m)
{
    float *const out_alpha[2] = {&m->alpha_u, &m->alpha_v};
    uint32_t *const out_texture[2] = {&m->alpha_u_texture, &m->alpha_v_texture};
    static const char *const AXES[2] = {"uroughness", "vroughness"};
    char name[48];
    float roughness = 0.0f;
    uint32_t texture_index = SCENE_NO_TEXTURE;
    bool remap = true;
    snprintf(name, sizeof name, "%sroughness", prefix);
    PBRT_TRY(pbrt_get_float_texture(parser, list, name, &roughness, &texture_index));
    PBRT_TRY(parameter_get_bool(list, parser->log, "remaproughness", &remap));
    if (roughness < 0.0f)
        return pbrt_refuse(parser, list, name, "\"%s\" should not be negative", name);
    for (int i = 0; i < 2; i++) {
        float value = roughness;
        snprintf(name, sizeof name, "%s%s", prefix, AXES[i]);
        *out_texture[i] = parameter_list_find(list, name) ? SCENE_NO_TEXTURE : texture_index;
        PBRT_TRY(pbrt_get_float_texture(parser, list, name, &value, out_texture[i]));
        if (value < 0.0f)
            return pbrt_refuse(parser, list, name, "\"%s\" should not be negative", name);
        *out_alpha[i] = remap ? sqrtf(value) : value;
    }
    m->remaps_roughness = remap;
    return AG_OK;
}

/* eta and k of a conductor, or those that give its reflectance; prefix as for read_roughness. */
static ag_status read_metal(pbrt_parser *parser, parameter_list *list, const char *prefix, material *m)
{
    char eta[32], k[32];
    snprintf(eta, sizeof eta, "%seta", prefix);
    snprintf(k, sizeof k, "%sk", prefix);
    spectra_find_named("metal-Cu-eta", &m->eta);
    spectra_find_named("metal-Cu-k", &m->k);
    if (!parameter_list_find(list, "reflectance")) {
        PBRT_TRY(parameter_get_rgb(list, parser->log, eta, &m->eta));
        PBRT_TRY(parameter_get_rgb(list, parser->log, k, &m->k));
        if (!(m->eta.r > 0.0f && m->eta.g > 0.0f && m->eta.b > 0.0f))
            return pbrt_refuse(parser, list, eta, "\"%s\" should be above 0", eta);
        return AG_OK;
    }
    if (parameter_list_find(list, eta) || parameter_list_find(list, k))
        return pbrt_refuse(parser, list, "reflectance",
                           "\"reflectance\" and \"%s\" or \"%s\" cannot both be given to a conductor", eta, k);
    PBRT_TRY(read_reflectance(parser, list, m));
    rgb r = m->reflectance;
    m->eta = rgb_gray(1.0f);
    m->k = rgb_make(material_k_from_reflectance(r.r), material_k_from_reflectance(r.g), material_k_from_reflectance(r.b));
    return AG_OK;
}

/* One index for all light: dispersion is not simulated. */
static ag_status read_index(pbrt_parser *parser, parameter_list *list, const char *name, float *ior)
{
    const parameter *eta = parameter_list_find(list, name);
    if (eta && eta->type == PARAMETER_SPECTRUM) {
        rgb value = rgb_gray(*ior);
        PBRT_TRY(parameter_get_rgb(list, parser->log, name, &value));
        *ior = value.g;
    } else {
        PBRT_TRY(parameter_get_float(list, parser->log, name, ior));
    }
    if (!(*ior > 0.0f))
        return pbrt_refuse(parser, list, name, "\"%s\" should be above 0", name);
    return AG_OK;
}

static ag_status read_conductor(pbrt_parser *parser, parameter_list *list, material *m)
{
    PBRT_TRY(read_metal(parser, list, "", m));
    return read_roughness(parser, list, "", m);
}

static ag_status read_dielectric(pbrt_parser *parser, parameter_list *list, material *m)
{
    PBRT_TRY(read_index(parser, list, "eta", &m->ior));
    return read_roughness(parser, list, "", m);
}

static ag_status read_thin_dielectric(pbrt_parser *parser, parameter_list *list, material *m)
{
    return read_index(parser, list, "eta", &m->ior);
}

/* pbrt's random walk in a coat: ours is a closed form of it. Its stuff absorbs even where its albedo is 0, and the walk ends
 * after "maxdepth" steps: both darken, so both are kept. */
static ag_status read_coat_walk(pbrt_parser *parser, parameter_list *list, material *m)
{
    float g = 0.0f;
    m->coat_thickness = 0.01f;
    int64_t depth = 10, samples = 1;
    rgb albedo = rgb_gray(0.0f);
    PBRT_TRY(parameter_get_float(list, parser->log, "thickness", &m->coat_thickness));
    PBRT_TRY(parameter_get_float(list, parser->log, "g", &g));
    PBRT_TRY(parameter_get_int(list, parser->log, "maxdepth", &depth));
    PBRT_TRY(parameter_get_int(list, parser->log, "nsamples", &samples));
    PBRT_TRY(parameter_get_rgb(list, parser->log, "albedo", &albedo));
    if (m->coat_thickness < 0.0f)
        return pbrt_refuse(parser, list, "thickness", "\"thickness\" should not be negative");
    if (depth < 1 || depth > 1000)
        return pbrt_refuse(parser, list, "maxdepth", "\"maxdepth\" should be from 1 to 1000");
    m->coat_bounces = (int)(depth + 1) / 2; /* every other step of the walk meets the base */
    if (!rgb_is_black(albedo))
        log_at_once(parser->log, AG_LOG_WARNING, list->where, "coat albedo",
                    "a coat with scattering inside (\"albedo\") is not supported: one that only absorbs stands in");
    return AG_OK;
}

static ag_status read_coated_diffuse(pbrt_parser *parser, parameter_list *list, material *m)
{
    PBRT_TRY(read_reflectance(parser, list, m));
    PBRT_TRY(read_index(parser, list, "eta", &m->ior));
    PBRT_TRY(read_coat_walk(parser, list, m));
    return read_roughness(parser, list, "", m);
}

static ag_status read_coated_conductor(pbrt_parser *parser, parameter_list *list, material *m)
{
    PBRT_TRY(read_metal(parser, list, "conductor.", m));
    PBRT_TRY(read_index(parser, list, "interface.eta", &m->ior));
    PBRT_TRY(read_coat_walk(parser, list, m));
    PBRT_TRY(read_roughness(parser, list, "conductor.", m));
    if (m->alpha_u_texture != SCENE_NO_TEXTURE || m->alpha_v_texture != SCENE_NO_TEXTURE)
        log_at_once(parser->log, AG_LOG_WARNING, list->where, "base roughness",
                    "a texture for \"conductor.roughness\" is not supported: a smooth conductor stands in");
    m->base_alpha_u = m->alpha_u;
    m->base_alpha_v = m->alpha_v;
    PBRT_TRY(read_roughness(parser, list, "interface.", m));
    /* the conductor's index is relative to air; under the coat it is relative to the coat */
    m->eta = rgb_scale(m->eta, 1.0f / m->ior);
    m->k = rgb_scale(m->k, 1.0f / m->ior);
    return AG_OK;
}

/* It has no parameters. */
static ag_status read_interface(pbrt_parser *parser, parameter_list *list, material *m)
{
    (void)parser, (void)list, (void)m;
    return AG_OK;
}

static ag_status read_diffuse(pbrt_parser *parser, parameter_list *list, material *m)
{
    return read_reflectance(parser, list, m);
}

static ag_status read_diffuse_transmission(pbrt_parser *parser, parameter_list *list, material *m)
{
    float scale = 1.0f;
    PBRT_TRY(pbrt_get_rgb_texture(parser, list, "reflectance", &m->reflectance, &m->reflectance_texture));
    PBRT_TRY(pbrt_get_rgb_texture(parser, list, "transmittance", &m->transmittance, &m->transmittance_texture));
    PBRT_TRY(parameter_get_float(list, parser->log, "scale", &scale));
    if (scale < 0.0f)
        return pbrt_refuse(parser, list, "scale", "\"scale\" should not be negative");
    m->reflectance = rgb_scale(m->reflectance, scale);
    m->transmittance = rgb_scale(m->transmittance, scale);
    if (scale != 1.0f &&
        (m->reflectance_texture != SCENE_NO_TEXTURE || m->transmittance_texture != SCENE_NO_TEXTURE))
        log_at_once(parser->log, AG_LOG_WARNING, list->where, "transmission scale",
                    "\"scale\" is not applied to textures of \"diffusetransmission\"");
    rgb sum = rgb_add(m->reflectance, m->transmittance);
    if (rgb_max(sum) > 1.0f) {
        log_at(parser->log, AG_LOG_WARNING, list->where,
               "\"reflectance\" and \"transmittance\" are above 1 together: both are scaled down");
        m->reflectance = rgb_scale(m->reflectance, 1.0f / rgb_max(sum));
        m->transmittance = rgb_scale(m->transmittance, 1.0f / rgb_max(sum));
    }
    return AG_OK;
}

static ag_status find_or_keep_place(pbrt_parser *parser, const char *name, file_location where, uint32_t *out_index);

static ag_status read_mix(pbrt_parser *parser, parameter_list *list, material *m)
{
    const parameter *names = parameter_list_find(list, "materials");
    const char *ignored;
    PBRT_TRY(pbrt_get_float_texture(parser, list, "amount", &m->mix_amount, &m->mix_amount_texture));
    if (!names || names->type != PARAMETER_STRING || names->count != 2)
        return pbrt_refuse(parser, list, "materials", "\"mix\" needs \"string materials\" with two names");
    (void)parameter_get_string(list, NULL, "materials", &ignored); /* marks it as known */
    for (int i = 0; i < 2; i++)
        PBRT_TRY(find_or_keep_place(parser, names->strings[i], names->where, &m->mixed[i]));
    return AG_OK;
}

typedef struct material_reader {
    const char *name;
    material_kind kind;
    ag_status (*read)(pbrt_parser *parser, parameter_list *list, material *m);
} material_reader;

static const material_reader READERS[] = {
    {"diffuse", MATERIAL_DIFFUSE, read_diffuse},
    {"diffusetransmission", MATERIAL_DIFFUSE_TRANSMISSION, read_diffuse_transmission},
    {"conductor", MATERIAL_CONDUCTOR, read_conductor},
    {"dielectric", MATERIAL_DIELECTRIC, read_dielectric},
    {"thindielectric", MATERIAL_THIN_DIELECTRIC, read_thin_dielectric},
    {"coateddiffuse", MATERIAL_COATED_DIFFUSE, read_coated_diffuse},
    {"coatedconductor", MATERIAL_COATED_CONDUCTOR, read_coated_conductor},
    {"mix", MATERIAL_MIX, read_mix},
    {"interface", MATERIAL_INTERFACE, read_interface},
    {"none", MATERIAL_INTERFACE, read_interface},
    {"", MATERIAL_INTERFACE, read_interface},
};

/* What is not supported yet gets the nearest plain thing. Its parameters go unread with it. */
static void name_stand_in(pbrt_parser *parser, const parameter_list *list, const char *type)
{
    char key[96];
    snprintf(key, sizeof key, "material:%s", type);
    log_at_once(parser->log, AG_LOG_WARNING, list->where, key,
                "material \"%s\" is not known, or not supported yet: \"diffuse\" with a reflectance of 0.5 stands in",
                type);
}

static ag_status read_material(pbrt_parser *parser, parameter_list *list, const char *type, material *out_material)
{
    *out_material = material_make(MATERIAL_DIFFUSE);
    for (size_t i = 0; i < sizeof READERS / sizeof *READERS; i++)
        if (strcmp(type, READERS[i].name) == 0) {
            *out_material = material_make(READERS[i].kind);
            PBRT_TRY(READERS[i].read(parser, list, out_material));
            parameter_list_warn_unused(list, parser->log);
            return AG_OK;
        }
    name_stand_in(parser, list, type);
    return AG_OK;
}

ag_status pbrt_add_default_material(pbrt_parser *parser)
{
    material m = material_make(MATERIAL_DIFFUSE);
    return scene_add_material(parser->scene, &m, &parser->state.material_index);
}

ag_status pbrt_material(pbrt_parser *parser, file_location where)
{
    parameter_list list;
    material m;
    PBRT_TRY(pbrt_read_named_parameters(parser, "Material", "a quoted type", where, &list));
    ag_status status = read_material(parser, &list, list.name, &m);
    parameter_list_reset(&list);
    if (!status)
        status = scene_add_material(parser->scene, &m, &parser->state.material_index);
    parser->state.has_no_surface = m.kind == MATERIAL_INTERFACE;
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
    PBRT_TRY(read_material(parser, list, type, &m));
    PBRT_TRY(scene_add_material(parser->scene, &m, &made.index));
    named = find_named_material(parser, list->name); /* anew: a mix may have kept places for others, or for itself */
    if (!named)
        return add_named_material(parser, list->name, made);
    /* it has been used before: fill the place that was made for it then */
    parser->scene->materials[named->index] = parser->scene->materials[made.index];
    named->is_defined = true;
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

/* A named material, or where it is not made yet, as pbrt allows, a place for it. */
static ag_status find_or_keep_place(pbrt_parser *parser, const char *name, file_location where, uint32_t *out_index)
{
    const pbrt_named_material *named = find_named_material(parser, name);
    if (!named) {
        pbrt_named_material used = {.where = where};
        material place = material_make(MATERIAL_DIFFUSE);
        PBRT_TRY(scene_add_material(parser->scene, &place, &used.index));
        PBRT_TRY(add_named_material(parser, name, used));
        named = find_named_material(parser, name);
    }
    *out_index = named->index;
    return AG_OK;
}

static ag_status use_named(pbrt_parser *parser, const char *name, file_location where)
{
    PBRT_TRY(find_or_keep_place(parser, name, where, &parser->state.material_index));
    parser->state.has_no_surface = parser->scene->materials[parser->state.material_index].kind == MATERIAL_INTERFACE;
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

/* Mixes of mixes end: none is more than so many deep, which also says that there is no cycle. */
static ag_status check_mixes(pbrt_parser *parser)
{
    enum { DEPTH_MAX = 16 };
    const scene *s = parser->scene;
    unsigned char *depth = calloc((size_t)s->material_count + 1, 1);
    bool has_changed = true, is_too_deep = false;
    if (!depth)
        return AG_ERROR_MEMORY;
    while (has_changed && !is_too_deep) {
        has_changed = false;
        for (uint32_t i = 0; i < s->material_count; i++) {
            const material *m = &s->materials[i];
            for (int k = 0; k < 2 && m->kind == MATERIAL_MIX; k++)
                if (depth[i] <= depth[m->mixed[k]]) {
                    depth[i] = (unsigned char)(depth[m->mixed[k]] + 1);
                    has_changed = true;
                    is_too_deep = is_too_deep || depth[i] > DEPTH_MAX;
                }
        }
    }
    free(depth);
    if (!is_too_deep)
        return AG_OK;
    log_message(parser->log, AG_LOG_ERROR, "%s: error: materials of type \"mix\" mix one another in a circle, or more than %d deep",
                parser->scene->file_names[0], DEPTH_MAX);
    return AG_ERROR_SCENE;
}

/* Interfaces do not shine: lamps of a material that turned out to be one, after they were made, go dark. */
static void put_out_interfaces(pbrt_parser *parser)
{
    scene *s = parser->scene;
    for (uint32_t i = 0; i < s->shape_count; i++) {
        shape *lamp = &s->shapes[i];
        if (lamp->light_index == SHAPE_NO_LIGHT || s->materials[lamp->material_index].kind != MATERIAL_INTERFACE)
            continue;
        s->lights[lamp->light_index].radiance = rgb_gray(0.0f);
        lamp->light_index = SHAPE_NO_LIGHT;
        log_once(parser->log, AG_LOG_WARNING, "interface made late",
                 "%s: warning: shapes with the material \"interface\" cannot shine: their area lights are left out",
                 s->file_names[0]);
    }
}

ag_status pbrt_check_named_materials(pbrt_parser *parser)
{
    for (size_t i = 0; i < parser->named_material_count; i++) {
        const pbrt_named_material *named = &parser->named_materials[i];
        if (!named->is_defined)
            return pbrt_error(parser, named->where, strlen("NamedMaterial"), "no material is named \"%s\"",
                              named->name);
    }
    put_out_interfaces(parser);
    return check_mixes(parser);
}
