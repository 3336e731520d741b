/* gltf_material_extensions.c: the material extensions of Khronos: transmission, volume, ior, specular, clearcoat,
 * sheen, anisotropy, unlit, specular-glossiness. Rests on: Khronos, KHR_materials_… of glTF 2.0; KHR_materials_ior says
 * how specular-glossiness is written with an index of 0. Flow: gltf_materials -> [here] -> gltf_textures. Threads: one
 * per scene. */
#include "gltf/gltf_private.h"

#include <stdio.h>

static const gltf_texture_use COLOR = {.is_color = true, .is_srgb = true, .scale = 1.0f};
static const gltf_texture_use RED = {.channel = TEXTURE_CHANNEL_R, .scale = 1.0f};
static const gltf_texture_use GREEN = {.channel = TEXTURE_CHANNEL_G, .scale = 1.0f};
static const gltf_texture_use BLUE = {.channel = TEXTURE_CHANNEL_B, .scale = 1.0f};
static const gltf_texture_use DIRECTION = {.is_color = true, .scale = 1.0f};
static const gltf_texture_use ALPHA = {.channel = TEXTURE_CHANNEL_A, .scale = 1.0f};

typedef ag_status reader(gltf_reader *r, const gltf_value *at, const gltf_value *extension, material *m,
                         gltf_material *out);

static ag_status read_ior(gltf_reader *r, const gltf_value *at, const gltf_value *extension, material *m,
                          gltf_material *out)
{
    double ior = 1.5;
    gltf_value v = gltf_member(extension, "ior");
    (void)at, (void)out;
    AG_TRY(gltf_get_double(r, extension, "ior", &ior));
    if (!(ior == 0.0 || (ior >= 1.0 && ior <= 1e6)))
        return gltf_error(r, &v, "%g should be 0 or from 1", ior);
    m->ior = (float)ior;
    return AG_OK;
}

static ag_status read_specular(gltf_reader *r, const gltf_value *at, const gltf_value *extension, material *m,
                               gltf_material *out)
{
    (void)at;
    AG_TRY(gltf_get_clamped(r, extension, "specularFactor", 0.0, 1.0, &m->specular));
    AG_TRY(gltf_get_color(r, extension, "specularColorFactor", 0.0, 1e6, &m->specular_color));
    m->specular_color = working_space_light(&r->scene->space, m->specular_color);
    AG_TRY(gltf_get_texture(r, extension, "specularTexture", ALPHA, &out->uv_set, &m->specular_texture));
    return gltf_get_texture(r, extension, "specularColorTexture", COLOR, &out->uv_set, &m->specular_color_texture);
}

static ag_status read_transmission(gltf_reader *r, const gltf_value *at, const gltf_value *extension, material *m,
                                   gltf_material *out)
{
    (void)at;
    AG_TRY(gltf_get_clamped(r, extension, "transmissionFactor", 0.0, 1.0, &m->transmission));
    if (m->transmission == 0.0f)
        return AG_OK;
    return gltf_get_texture(r, extension, "transmissionTexture", RED, &out->uv_set, &m->transmission_texture);
}

/* Computes an absorption by which that share of light is left after that distance in the world, as the format has it.
 * Blender's exporter writes the colour and 1 / density of a Volume Absorption as they stand, and Cycles absorbs (1 -
 * colour) density. */
static float absorption(const gltf_reader *r, float share, double distance)
{
    double depth = r->is_blenders ? double_max(1.0 - (double)share, 0.0) : -log(double_max((double)share, 1e-6));
    return (float)(depth / distance);
}

static void tell_absorption(const gltf_reader *r)
{
    if (r->is_blenders)
        log_at_once(r->run->log, AG_LOG_INFO, r->where, "gltf:absorption",
                    "glass absorbs as Blender's Volume Absorption does, (1 - colour) / distance, whose colour its "
                    "exporter writes as it stands; the format itself means -ln(colour) / distance");
}

/* Reads from the thickness only whether there is a volume: how thick it is, the mesh tells better than the factor. */
static ag_status read_volume(gltf_reader *r, const gltf_value *at, const gltf_value *extension, material *m,
                             gltf_material *out)
{
    float thickness = 0.0f;
    double distance = 0.0;
    rgb color = rgb_gray(1.0f);
    gltf_value v = gltf_member(extension, "attenuationDistance");
    (void)at;
    AG_TRY(gltf_get_clamped(r, extension, "thicknessFactor", 0.0, 1e30, &thickness));
    AG_TRY(gltf_get_double(r, extension, "attenuationDistance", &distance));
    AG_TRY(gltf_get_color(r, extension, "attenuationColor", 0.0, 1.0, &color));
    color = working_space_reflectance(&r->scene->space, color);
    if (v.json && !(distance > 1e-18))
        return gltf_error(r, &v, "%g should be above 0", distance);
    if (thickness == 0.0f || m->transmission == 0.0f)
        return AG_OK;
    m->is_thin = false;
    bool absorbs = v.json && (color.r < 1.0f || color.g < 1.0f || color.b < 1.0f);
    medium filling = medium_make(MEDIUM_HOMOGENEOUS);
    filling.as.homogeneous.sigma_a =
        (rgb){absorption(r, color.r, distance), absorption(r, color.g, distance), absorption(r, color.b, distance)};
    if (!absorbs)
        return AG_OK;
    tell_absorption(r);
    return scene_add_medium(r->scene, &filling, &out->medium_inside);
}

static ag_status read_clearcoat(gltf_reader *r, const gltf_value *at, const gltf_value *extension, material *m,
                                gltf_material *out)
{
    gltf_value map = gltf_member(extension, "clearcoatNormalTexture");
    (void)at;
    AG_TRY(gltf_get_clamped(r, extension, "clearcoatFactor", 0.0, 1.0, &m->clearcoat));
    AG_TRY(gltf_get_clamped(r, extension, "clearcoatRoughnessFactor", 0.0, 1.0, &m->clearcoat_roughness));
    if (m->clearcoat == 0.0f)
        return AG_OK;
    if (map.json)
        gltf_warn_once(r, &map, map.key, "normal maps of clearcoats are not supported: they are as smooth as the mesh");
    AG_TRY(gltf_get_texture(r, extension, "clearcoatTexture", RED, &out->uv_set, &m->clearcoat_texture));
    return gltf_get_texture(r, extension, "clearcoatRoughnessTexture", GREEN, &out->uv_set,
                            &m->clearcoat_roughness_texture);
}

static ag_status read_sheen(gltf_reader *r, const gltf_value *at, const gltf_value *extension, material *m,
                            gltf_material *out)
{
    (void)at;
    AG_TRY(gltf_get_color(r, extension, "sheenColorFactor", 0.0, 1.0, &m->sheen));
    AG_TRY(gltf_get_clamped(r, extension, "sheenRoughnessFactor", 0.0, 1.0, &m->sheen_roughness));
    m->sheen = working_space_reflectance(&r->scene->space, m->sheen);
    if (rgb_is_black(m->sheen))
        return AG_OK;
    AG_TRY(gltf_get_texture(r, extension, "sheenColorTexture", COLOR, &out->uv_set, &m->sheen_texture));
    return gltf_get_texture(r, extension, "sheenRoughnessTexture", ALPHA, &out->uv_set, &m->sheen_roughness_texture);
}

/* Red and green of the texture are the direction before the rotation, blue is a factor of the strength. */
static ag_status read_anisotropy(gltf_reader *r, const gltf_value *at, const gltf_value *extension, material *m,
                                 gltf_material *out)
{
    double rotation = 0.0;
    (void)at;
    AG_TRY(gltf_get_clamped(r, extension, "anisotropyStrength", 0.0, 1.0, &m->anisotropy));
    AG_TRY(gltf_get_double(r, extension, "anisotropyRotation", &rotation));
    if (m->anisotropy == 0.0f)
        return AG_OK;
    m->grain_turn = (float)remainder(rotation / 6.283185307179586477, 1.0);
    AG_TRY(gltf_get_texture(r, extension, "anisotropyTexture", DIRECTION, &out->uv_set, &m->grain_texture));
    return gltf_get_texture(r, extension, "anisotropyTexture", BLUE, &out->uv_set, &m->anisotropy_texture);
}

/* A dielectric of infinite index reflects what its specular colour says, from all sides; what is left is diffuse. */
static ag_status read_specular_glossiness(gltf_reader *r, const gltf_value *at, const gltf_value *extension,
                                          material *m, gltf_material *out)
{
    float diffuse[4] = {1.0f, 1.0f, 1.0f, 1.0f}, glossiness = 1.0f;
    AG_TRY(gltf_get_factors(r, extension, "diffuseFactor", 0.0, 1.0, 4, diffuse));
    AG_TRY(gltf_get_color(r, extension, "specularFactor", 0.0, 1.0, &m->specular_color));
    AG_TRY(gltf_get_clamped(r, extension, "glossinessFactor", 0.0, 1.0, &glossiness));
    m->reflectance = working_space_reflectance(&r->scene->space, rgb_make(diffuse[0], diffuse[1], diffuse[2]));
    m->specular_color = working_space_reflectance(&r->scene->space, m->specular_color);
    m->reflectance_texture = m->metallic_texture = m->roughness_texture = SCENE_NO_TEXTURE;
    m->metallic = 0.0f;
    m->ior = 0.0f;
    m->roughness = 1.0f - glossiness;
    out->uv_set = GLTF_NONE;
    AG_TRY(gltf_get_texture(r, extension, "diffuseTexture", COLOR, &out->uv_set, &m->reflectance_texture));
    AG_TRY(gltf_read_alpha(r, at, extension, "diffuseTexture", diffuse[3], out));
    AG_TRY(
        gltf_get_texture(r, extension, "specularGlossinessTexture", COLOR, &out->uv_set, &m->specular_color_texture));
    if (m->specular_color_texture == SCENE_NO_TEXTURE || glossiness == 0.0f)
        return AG_OK;
    /* the texture's alpha is the glossiness: roughness is 1 - factor alpha; alpha is never encoded */
    gltf_texture_use roughness = {.is_srgb = true, .channel = TEXTURE_CHANNEL_A, .scale = glossiness, .invert = true};
    m->roughness = 1.0f;
    return gltf_get_texture(r, extension, "specularGlossinessTexture", roughness, &out->uv_set, &m->roughness_texture);
}

/* An unlit material looks alike whatever light falls on it: it shines with its colour and reflects nothing. */
static ag_status read_unlit(gltf_reader *r, const gltf_value *at, const gltf_value *extension, material *m,
                            gltf_material *out)
{
    rgb color = m->reflectance;
    uint32_t color_texture = m->reflectance_texture;
    gltf_warn_once(r, extension, "unlit", "unlit materials shine with their colour, and so light what is around them");
    (void)at;
    *m = material_make(MATERIAL_DIFFUSE);
    m->reflectance = rgb_gray(0.0f);
    out->radiance = color;
    out->radiance_texture = color_texture;
    out->only_glows = false;
    out->is_two_sided = true;
    return AG_OK;
}

/* Warns of extensions that are not supported, and without which the picture can be made. */
static void warn_others(const gltf_reader *r, const gltf_value *extensions, const char *name)
{
    static const char *const OTHERS[] = {"KHR_materials_diffuse_transmission", "KHR_materials_dispersion",
                                         "KHR_materials_iridescence"};
    for (size_t i = 0; i < sizeof OTHERS / sizeof *OTHERS; i++) {
        gltf_value v = gltf_member(extensions, OTHERS[i]);
        if (v.json)
            gltf_warn_once(r, &v, OTHERS[i],
                           "the extension %s is not supported, and ignored, in material \"%s\" and "
                           "whichever else has it",
                           OTHERS[i], name);
    }
}

/* Glass without a volume is a sheet to the format, whatever its mesh looks like. Blender has no such sheets. */
static void tell_thin_glass(const gltf_reader *r, const gltf_value *at, const material *m, const char *name)
{
    char key[96];
    if (!(m->transmission > 0.0f && m->is_thin))
        return;
    snprintf(key, sizeof key, "gltf:thin:%p", (const void *)at->json); /* once for each material */
    log_at_once(r->run->log, r->is_blenders ? AG_LOG_WARNING : AG_LOG_INFO, r->where, key,
                "the glass of material \"%s\" is a thin shell, which bends no light: the file gives it no thickness "
                "(KHR_materials_volume)%s",
                name,
                r->is_blenders ? "; Blender writes one where the material has a node group \"glTF Material "
                                 "Output\" (before 3.4 \"glTF Settings\") with a Thickness"
                               : "");
}

/* To glTF facets of a dielectric reflect all at grazing angles, however little its specular colour is. Blender's
 * exporter writes a black one for Principled surfaces whose "Specular" is 0, which but for glass have no interface at
 * all in its Cycles: read as they stand, a room of these under a point lamp is 2.5 % brighter than with Lambert's
 * surfaces there, and without interface 0.1 %. */
static void drop_missing_interface(const gltf_reader *r, material *m)
{
    const bool is_glossiness = m->ior == 0.0f;
    if (r->is_blenders && rgb_is_black(m->specular_color) && m->transmission == 0.0f && !is_glossiness)
        m->specular = 0.0f;
}

ag_status gltf_read_material_extensions(gltf_reader *r, const gltf_value *at, material *m, gltf_material *out)
{
    static const struct {
        const char *name;
        reader *read;
    } EXTENSIONS[] = {
        {"KHR_materials_pbrSpecularGlossiness", read_specular_glossiness}, /* replaces what was read before */
        {"KHR_materials_ior", read_ior},
        {"KHR_materials_specular", read_specular},
        {"KHR_materials_transmission", read_transmission},
        {"KHR_materials_volume", read_volume},
        {"KHR_materials_clearcoat", read_clearcoat},
        {"KHR_materials_sheen", read_sheen},
        {"KHR_materials_anisotropy", read_anisotropy},
        {"KHR_materials_unlit", read_unlit}, /* the last: replaces all */
    };
    gltf_value extensions, extension;
    for (size_t i = 0; i < sizeof EXTENSIONS / sizeof *EXTENSIONS; i++) {
        AG_TRY(gltf_get_extension(r, at, EXTENSIONS[i].name, &extensions, &extension));
        if (extension.json)
            AG_TRY(EXTENSIONS[i].read(r, at, &extension, m, out));
    }
    const char *name = "";
    AG_TRY(gltf_get_text(r, at, "name", &name));
    drop_missing_interface(r, m);
    warn_others(r, &extensions, name);
    tell_thin_glass(r, at, m, name);
    return AG_OK;
}
