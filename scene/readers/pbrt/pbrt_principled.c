/* pbrt_principled.c: Material "principled" of a pbrt-v4 scene: no word of pbrt's, but glTF 2.0's metallic-roughness
 * with transmission, ior, specular, clearcoat, sheen and anisotropy, by glTF's names and defaults. Flow: pbrt_materials
 * -> [here] -> material. Threads: one per scene. */
#include "pbrt/pbrt_private.h"

#include <string.h>

/* Reads a number, or a texture in its place; the number, which the texture multiplies, then is 1. */
static ag_status read_number(pbrt_parser *parser, parameter_list *list, const char *name, float *value,
                             uint32_t *texture_index)
{
    AG_TRY(pbrt_get_float_texture(parser, list, name, value, texture_index));
    if (*texture_index != SCENE_NO_TEXTURE)
        *value = 1.0f;
    if (*value < 0.0f || *value > 1.0f)
        return pbrt_refuse(parser, list, name, "\"%s\" should be from 0 to 1", name);
    return AG_OK;
}

static ag_status read_color(pbrt_parser *parser, parameter_list *list, const char *name, rgb *value,
                            uint32_t *texture_index)
{
    AG_TRY(pbrt_get_rgb_texture(parser, list, name, value, texture_index));
    if (*texture_index != SCENE_NO_TEXTURE)
        *value = rgb_gray(1.0f);
    return AG_OK;
}

/* Returns the largest component of a colour as the file has it, since it may be larger in another colour space. */
static float most_of(const parameter_list *list, const char *name, rgb value)
{
    const parameter *p = parameter_list_find(list, name);
    return p && p->most_in_file > 0.0 ? (float)p->most_in_file : rgb_max(value);
}

static ag_status read_sheen(pbrt_parser *parser, parameter_list *list, material *m)
{
    static const struct {
        const char *name;
        sheen_model model;
    } MODELS[] = {{"charlie", SHEEN_CHARLIE}, {"schlick", SHEEN_SCHLICK}, {"velvet", SHEEN_VELVET}};
    const char *model = "charlie";
    AG_TRY(read_color(parser, list, "sheen", &m->sheen, &m->sheen_texture));
    AG_TRY(parameter_get_string(list, parser->log, "sheen_model", &model));
    size_t k = 0;
    while (k < sizeof MODELS / sizeof *MODELS && strcmp(model, MODELS[k].name) != 0)
        k++;
    if (k == sizeof MODELS / sizeof *MODELS)
        return pbrt_refuse(parser, list, "sheen_model",
                           "\"sheen_model\" should be \"charlie\", \"schlick\" or \"velvet\", not \"%s\"", model);
    m->sheen_model = MODELS[k].model;
    const float most = sheen_factor_max(m->sheen_model);
    const float least = float_min(m->sheen.r, float_min(m->sheen.g, m->sheen.b));
    if (!(least >= 0.0f && most_of(list, "sheen", m->sheen) <= most))
        return pbrt_refuse(parser, list, "sheen", "\"sheen\" of this model should be from 0 to %.4g", (double)most);
    return AG_OK;
}

/* Reads the roughness of one axis, which then has no texture but its own. */
static ag_status read_axis(pbrt_parser *parser, parameter_list *list, const char *name, float *value,
                           uint32_t *texture_index)
{
    *texture_index = SCENE_NO_TEXTURE;
    return read_number(parser, list, name, value, texture_index);
}

/* "uroughness" and "vroughness" replace "roughness" along each axis. */
static ag_status read_axes(pbrt_parser *parser, parameter_list *list, material *m)
{
    if (parameter_list_find(list, "vroughness")) {
        m->roughness_v = m->roughness;
        AG_TRY(read_axis(parser, list, "vroughness", &m->roughness_v, &m->roughness_v_texture));
    }
    if (!parameter_list_find(list, "uroughness"))
        return AG_OK;
    if (m->roughness_v < 0.0f) {
        m->roughness_v = m->roughness;
        m->roughness_v_texture = m->roughness_texture;
    }
    return read_axis(parser, list, "uroughness", &m->roughness, &m->roughness_texture);
}

ag_status pbrt_read_principled(pbrt_parser *parser, parameter_list *list, material *m)
{
    AG_TRY(read_color(parser, list, "reflectance", &m->reflectance, &m->reflectance_texture));
    if (rgb_max(m->reflectance) > 1.0f)
        return pbrt_refuse(parser, list, "reflectance", "\"reflectance\" should be from 0 to 1");
    AG_TRY(read_color(parser, list, "specular_color", &m->specular_color, &m->specular_color_texture));
    const struct {
        const char *name;
        float *value;
        uint32_t *texture_index;
    } FLOATS[] = {{"metallic", &m->metallic, &m->metallic_texture},
                  {"roughness", &m->roughness, &m->roughness_texture},
                  {"transmission", &m->transmission, &m->transmission_texture},
                  {"specular", &m->specular, &m->specular_texture},
                  {"clearcoat", &m->clearcoat, &m->clearcoat_texture},
                  {"clearcoat_roughness", &m->clearcoat_roughness, &m->clearcoat_roughness_texture},
                  {"sheen_roughness", &m->sheen_roughness, &m->sheen_roughness_texture},
                  {"anisotropy", &m->anisotropy, &m->anisotropy_texture}};
    for (size_t i = 0; i < sizeof FLOATS / sizeof *FLOATS; i++)
        AG_TRY(read_number(parser, list, FLOATS[i].name, FLOATS[i].value, FLOATS[i].texture_index));
    AG_TRY(read_axes(parser, list, m));
    AG_TRY(read_sheen(parser, list, m));
    AG_TRY(parameter_get_bool(list, parser->log, "is_thin", &m->is_thin));
    AG_TRY(parameter_get_float(list, parser->log, "ior", &m->ior));
    if (!(m->ior == 0.0f || m->ior >= 1.0f))
        return pbrt_refuse(parser, list, "ior", "\"ior\" should be at least 1, or 0 for an infinite one");
    return AG_OK;
}
