/* pbrt_principled.c: Material "principled" of a pbrt-v4 scene: no word of pbrt's, but glTF 2.0's metallic-roughness
 * with transmission, ior, specular and clearcoat, by glTF's names and defaults. Flow: pbrt_materials -> [here] ->
 * material. Threads: one per scene. */
#include "pbrt/pbrt_private.h"

/* A number, or a texture instead of it, which multiplies what then is 1. */
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
                  {"clearcoat_roughness", &m->clearcoat_roughness, &m->clearcoat_roughness_texture}};
    for (size_t i = 0; i < sizeof FLOATS / sizeof *FLOATS; i++)
        AG_TRY(read_number(parser, list, FLOATS[i].name, FLOATS[i].value, FLOATS[i].texture_index));
    AG_TRY(parameter_get_bool(list, parser->log, "is_thin", &m->is_thin));
    AG_TRY(parameter_get_float(list, parser->log, "ior", &m->ior));
    if (!(m->ior == 0.0f || m->ior >= 1.0f))
        return pbrt_refuse(parser, list, "ior", "\"ior\" should be at least 1, or 0 for an infinite one");
    return AG_OK;
}
