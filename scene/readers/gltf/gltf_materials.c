/* gltf_materials.c: metallic-roughness materials, alpha and emission, each loaded when it is first used.
 * Rests on: Khronos, "glTF 2.0 Specification", 2021, 3.9 (materials). Emission is in the unit of radiance as it is, as
 * Blender has it, whose emission of strength 1 the exporter writes as 1.
 * Flow: gltf_meshes -> [here] -> gltf_textures, gltf_material_extensions -> scene.materials. Threads: one per scene. */
#include "gltf/gltf_private.h"

#include <float.h>
#include <string.h>

static const gltf_texture_use COLOR = {.is_color = true, .is_srgb = true, .scale = 1.0f};
static const gltf_texture_use NORMAL = {.is_color = true, .scale = 1.0f};
static const gltf_texture_use METALLIC = {.channel = TEXTURE_CHANNEL_B, .scale = 1.0f};
static const gltf_texture_use ROUGHNESS = {.channel = TEXTURE_CHANNEL_G, .scale = 1.0f};

/* Reads how much of a surface is there: the alpha of its base colour, by alphaMode. base: pbrMetallicRoughness, or the
 * extension that replaces it. */
ag_status gltf_read_alpha(gltf_reader *r, const gltf_value *at, const gltf_value *base, const char *texture_key,
                          float factor, gltf_material *out)
{
    const char *mode = "OPAQUE";
    double cutoff = 0.5;
    gltf_value v = gltf_member(at, "alphaMode");
    /* the encoding is the colour's, so that both share one picture; alpha is never encoded */
    gltf_texture_use use = {.is_srgb = true, .channel = TEXTURE_CHANNEL_A, .scale = factor};
    out->alpha = 1.0f;
    out->alpha_texture = SCENE_NO_TEXTURE;
    out->alpha_cutoff = 0.0f;
    AG_TRY(gltf_get_text(r, at, "alphaMode", &mode));
    AG_TRY(gltf_get_double(r, at, "alphaCutoff", &cutoff));
    bool is_mask = strcmp(mode, "MASK") == 0;
    if (!is_mask && strcmp(mode, "BLEND") != 0)
        return strcmp(mode, "OPAQUE") == 0 ? AG_OK : gltf_error(r, &v, "there is no alpha mode \"%s\"", mode);
    if (is_mask && cutoff <= 0.0)
        return AG_OK; /* all of it passes */
    out->alpha = factor;
    out->alpha_cutoff = is_mask ? (float)double_clamp(cutoff, (double)FLT_MIN, (double)FLT_MAX) : 0.0f;
    return gltf_get_texture(r, base, texture_key, use, &out->uv_set, &out->alpha_texture);
}

static ag_status read_metallic_roughness(gltf_reader *r, const gltf_value *at, material *m, gltf_material *out)
{
    float base[4] = {1.0f, 1.0f, 1.0f, 1.0f};
    gltf_value pbr;
    AG_TRY(gltf_get_object(r, at, "pbrMetallicRoughness", &pbr));
    AG_TRY(gltf_get_factors(r, &pbr, "baseColorFactor", 0.0, 1.0, 4, base));
    m->reflectance = working_space_reflectance(&r->scene->space, rgb_make(base[0], base[1], base[2]));
    AG_TRY(gltf_get_clamped(r, &pbr, "metallicFactor", 0.0, 1.0, &m->metallic));
    AG_TRY(gltf_get_clamped(r, &pbr, "roughnessFactor", 0.0, 1.0, &m->roughness));
    AG_TRY(gltf_get_texture(r, &pbr, "baseColorTexture", COLOR, &out->uv_set, &m->reflectance_texture));
    AG_TRY(gltf_read_alpha(r, at, &pbr, "baseColorTexture", base[3], out));
    if (m->metallic > 0.0f)
        AG_TRY(gltf_get_texture(r, &pbr, "metallicRoughnessTexture", METALLIC, &out->uv_set, &m->metallic_texture));
    if (m->roughness > 0.0f)
        AG_TRY(gltf_get_texture(r, &pbr, "metallicRoughnessTexture", ROUGHNESS, &out->uv_set, &m->roughness_texture));
    return AG_OK;
}

static ag_status read_normal_map(gltf_reader *r, const gltf_value *at, material *m, gltf_material *out)
{
    double scale = 1.0;
    gltf_value map;
    AG_TRY(gltf_get_object(r, at, "normalTexture", &map));
    AG_TRY(gltf_get_double(r, &map, "scale", &scale));
    m->normal_scale = (float)double_clamp(scale, -1e6, 1e6);
    return gltf_get_texture(r, at, "normalTexture", NORMAL, &out->uv_set, &m->normal_map_texture);
}

static ag_status read_emission(gltf_reader *r, const gltf_value *at, gltf_material *out)
{
    float strength = 1.0f;
    gltf_value extensions, extension;
    AG_TRY(gltf_get_color(r, at, "emissiveFactor", 0.0, 1e30, &out->radiance));
    AG_TRY(gltf_get_extension(r, at, "KHR_materials_emissive_strength", &extensions, &extension));
    AG_TRY(gltf_get_clamped(r, &extension, "emissiveStrength", 0.0, 1e30, &strength));
    out->radiance = rgb_scale(working_space_light(&r->scene->space, out->radiance), strength);
    if (!rgb_is_finite(out->radiance))
        return gltf_error(r, at, "it shines brighter than a float can say");
    if (rgb_is_black(out->radiance))
        return AG_OK;
    AG_TRY(gltf_get_bool(r, at, "doubleSided", &out->is_two_sided));
    AG_TRY(gltf_get_texture(r, at, "emissiveTexture", COLOR, &out->uv_set, &out->radiance_texture));
    out->only_glows = out->radiance_texture != SCENE_NO_TEXTURE && rgb_max(out->radiance) <= 1.0f;
    return AG_OK;
}

/* at.json NULL: the default material. */
static ag_status load(gltf_reader *r, const gltf_value *at, gltf_material *out)
{
    material m = material_make(MATERIAL_PRINCIPLED);
    out->uv_set = GLTF_NONE;
    out->medium_inside = SCENE_NO_MEDIUM;
    out->radiance = rgb_gray(0.0f);
    out->radiance_texture = SCENE_NO_TEXTURE;
    AG_TRY(read_metallic_roughness(r, at, &m, out));
    AG_TRY(read_normal_map(r, at, &m, out));
    AG_TRY(read_emission(r, at, out));
    AG_TRY(gltf_read_material_extensions(r, at, &m, out));
    AG_TRY(scene_add_material(r->scene, &m, &out->material_index));
    const gltf_value name = gltf_member(at, "name");
    return scene_set_name(r->scene, NAMED_MATERIAL, out->material_index, json_string_value(name.json));
}

ag_status gltf_material_find(gltf_reader *r, uint32_t index, const gltf_material **out_material)
{
    gltf_material *found = &r->materials[index == GLTF_NONE ? r->list_counts[GLTF_MATERIALS] : index];
    gltf_value at = {NULL, &r->document, "materials", 0};
    *out_material = found;
    if (found->is_loaded)
        return AG_OK;
    if (index != GLTF_NONE)
        AG_TRY(gltf_get_item(r, GLTF_MATERIALS, index, &at));
    found->is_loaded = true;
    return load(r, &at, found);
}
