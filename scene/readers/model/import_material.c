/* import_material.c: materials of foreign formats, in the words of MTL (Wavefront's "MTL material format", 1995, with
 * the PBR extension of Clara.io), as ours.
 *
 *   MTL                             here
 *   illum 4, 6, 7, 9                glass: dielectric of index Ni (1.5 where it says nothing above 1), smooth or of
 *                                   roughness Pr; tinted where Tf is no white
 *   illum 3, 5, 8                   mirror: Ks at normal incidence over diffuse Kd; metal Ks where Kd is black
 *   Pr or Pm                        principled: base Kd, metallic Pm, roughness Pr (0.5), clearcoat Pc, Pcr
 *   else with Ks                    principled: base Kd, reflection of 0.08 Ks at normal incidence, as Blender has it
 *   else                            diffuse Kd
 *   Ns                              GGX alpha sqrt(2 / (Ns + 2)) (Walter et al. 2007); 1000 and above is smooth
 *   d, Tr, map_d                    opacity: the surface is there for that share of the rays; glass ignores it
 *   Ke, map_Ke                      a lamp of that radiance, on both sides
 *   map_Kd, map_Pr, map_Pm          multiply Kd, Pr, Pm; a factor that is black or 0 (not given for Pr, Pm) counts as 1
 *   norm, map_Bump                  normal map; bump map, whose white is bump_unit times -bm high
 *
 * Pictures are sRGB where they are colours, else linear. Threads: one per scene. */
#define _POSIX_C_SOURCE 200809L
#include "model/importer.h"

#include "status.h"
#include "text/input_file.h"
#include "texture/texture_image_load.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Pictures */

/* Checks whether the scene may read the file. message is left as it is where it may. */
static bool is_there(const importer *i, const char *path, char *message, size_t message_size)
{
    return input_file_may_ask(i->run, path, message, message_size) && texture_image_is_there(i->run, path);
}

/* The path with slashes as they are here, below the folder of the model, or where the file says, or with the folders
 * that were there when it was made left out. Gives whether there is a file; if not, message says why. */
static bool find_picture(const importer *i, const char *name, char *out_path, size_t size, char *message,
                         size_t message_size)
{
    char plain[IMPORT_PATH_SIZE];
    snprintf(plain, sizeof plain, "%s", name);
    for (char *c = plain; *c; c++)
        if (*c == '\\')
            *c = '/';
    const char *slash = strrchr(i->where.file, '/'), *base = strrchr(plain, '/');
    snprintf(message, message_size, "there is no such file");
    int folder = slash ? (int)(slash - i->where.file) + 1 : 0;
    if (plain[0] == '/') {
        snprintf(out_path, size, "%s", plain);
        if (is_there(i, out_path, message, message_size))
            return true;
    }
    snprintf(out_path, size, "%.*s%s", folder, i->where.file, plain);
    if (is_there(i, out_path, message, message_size))
        return true;
    snprintf(out_path, size, "%.*s%s", folder, i->where.file, base ? base + 1 : plain);
    return is_there(i, out_path, message, message_size);
}

static void warn_picture(importer *i, const import_picture *p, const char *reason)
{
    char key[IMPORT_PATH_SIZE + 16];
    snprintf(key, sizeof key, "picture:%s", p->path);
    log_at_once(i->log, AG_LOG_WARNING, i->where, key, "the picture \"%s\" is not used: %s", p->path, reason);
}

/* Reads a picture from a file, or one within the model's file. */
static ag_status load_picture(importer *i, const import_picture *p, image_encoding encoding, uint32_t *out_image_index,
                              char *message, size_t message_size)
{
    char path[2 * IMPORT_PATH_SIZE + 4096];
    if (p->path[0] == '*') {
        char *end;
        unsigned long number = strtoul(p->path + 1, &end, 10);
        if (end == p->path + 1 || *end || number >= i->embedded_count || i->embedded[number].size == 0) {
            snprintf(message, message_size, "there is no such picture within the file");
            return AG_ERROR_INPUT;
        }
        return texture_image_load_memory(i->run, &i->scene->textures, p->path, i->embedded[number].bytes,
                                         i->embedded[number].size, encoding, out_image_index, message, message_size);
    }
    if (!find_picture(i, p->path, path, sizeof path, message, message_size))
        return AG_ERROR_INPUT;
    if (encoding.curve == IMAGE_CURVE_DEFAULT) /* a colour's */
        encoding = image_colors_rule(&i->scene->textures.colors, path);
    return texture_image_load(i->run, &i->scene->textures, path, encoding, out_image_index, message, message_size);
}

static texture_wrap wrap_of(uint32_t wrap)
{
    return wrap == IMPORT_IS_CLAMPED    ? TEXTURE_WRAP_CLAMP
           : wrap == IMPORT_IS_MIRRORED ? TEXTURE_WRAP_MIRROR
           : wrap == IMPORT_IS_BLACK    ? TEXTURE_WRAP_BLACK
                                        : TEXTURE_WRAP_REPEAT;
}

/* The channels to read of a picture. */
typedef enum picture_use {
    PICTURE_COLOR,
    PICTURE_DIRECTION, /* three numbers, as they are */
    PICTURE_NUMBER,    /* one, as it is */
    PICTURE_OPACITY    /* its alpha where it has that, else as above */
} picture_use;

/* Returns the material's texture, multiplied by scale; SCENE_NO_TEXTURE where there is none that can be read. */
static ag_status add_picture(importer *i, const import_picture *p, picture_use use, float scale, uint32_t *out_texture)
{
    char message[1024] = "";
    *out_texture = SCENE_NO_TEXTURE;
    if (p->path[0] == '\0')
        return AG_OK;
    texture t = texture_make(TEXTURE_IMAGE);
    t.is_spectrum = use == PICTURE_COLOR || use == PICTURE_DIRECTION;
    t.mapping.scale = (vec2){p->scale[0], p->scale[1]};
    t.mapping.delta = (vec2){p->offset[0], p->offset[1]};
    t.wraps = (texture_wraps){wrap_of(p->wrap_s), wrap_of(p->wrap_t)};
    t.scale = scale;
    t.is_data = use == PICTURE_DIRECTION;
    const bool is_color = use == PICTURE_COLOR;
    image_encoding encoding = {.curve = is_color ? IMAGE_CURVE_DEFAULT : IMAGE_CURVE_LINEAR};
    ag_status status = load_picture(i, p, encoding, &t.image_index, message, sizeof message);
    if (status == AG_ERROR_SYSTEM) /* no room for the picture, or no library that reads it */
        log_message(i->log, AG_LOG_ERROR, "%s", message);
    if (status == AG_ERROR_MEMORY || status == AG_ERROR_SYSTEM || status == AG_CANCELLED)
        return status;
    if (status != AG_OK) {
        warn_picture(i, p, message);
        return AG_OK;
    }
    const texture_image *read = i->scene->textures.images[t.image_index];
    const bool has_alpha = texture_image_has_alpha(read);
    t.channel = use == PICTURE_OPACITY && has_alpha ? TEXTURE_CHANNEL_A : TEXTURE_CHANNEL_MEAN;
    return texture_set_add(&i->scene->textures, &t, out_texture);
}

/* Materials */

static float clamp01(float x) { return float_clamp(x, 0.0f, 1.0f); } /* 0 for NaN */

/* Converts a share of light to the working space. */
static rgb share_of(const importer *i, rgb c)
{
    return working_space_reflectance(&i->scene->space, rgb_clamp(c, 0.0f, 1.0f));
}

static bool is_given(float x) { return x >= 0.0f && isfinite(x); }

static float exponent_roughness(float exponent, float fallback)
{
    if (!is_given(exponent) || exponent == 0.0f)
        return fallback;
    return exponent >= 1000.0f ? 0.0f : sqrtf(sqrtf(2.0f / (exponent + 2.0f)));
}

static void set_roughness(material *m, float roughness)
{
    m->roughness = clamp01(roughness);
    m->alpha_u = m->alpha_v = m->roughness * m->roughness;
}

static material make_principled(rgb base, float roughness)
{
    material m = material_make(MATERIAL_PRINCIPLED);
    m.reflectance = base;
    m.metallic = 0.0f;
    m.is_thin = false;
    set_roughness(&m, roughness);
    return m;
}

static material make_glass(const importer *i, const import_material *source)
{
    rgb filter = share_of(i, source->filter);
    float roughness = is_given(source->roughness) ? clamp01(source->roughness) : 0.0f;
    bool is_clear = rgb_is_black(filter) || (filter.r == 1.0f && filter.g == 1.0f && filter.b == 1.0f);
    material m = is_clear ? material_make(MATERIAL_DIELECTRIC) : make_principled(filter, roughness);
    m.transmission = 1.0f;
    m.ior = source->ior > 1.0f && isfinite(source->ior) ? source->ior : 1.5f;
    if (is_clear)
        m.alpha_u = m.alpha_v = roughness * roughness;
    return m;
}

static material make_mirror(const import_material *source, rgb diffuse, rgb specular)
{
    float roughness =
        is_given(source->roughness) ? clamp01(source->roughness) : exponent_roughness(source->exponent, 0.0f);
    material m = make_principled(diffuse, roughness);
    if (rgb_is_black(diffuse)) {
        m.reflectance = specular;
        m.metallic = 1.0f;
        return m;
    }
    /* the index that reflects as much as the strongest channel, and a colour for the others */
    float strongest = float_min(rgb_max(specular), 0.98f), root = sqrtf(strongest);
    m.ior = (1.0f + root) / (1.0f - root);
    m.specular_color = rgb_scale(specular, 1.0f / rgb_max(specular));
    return m;
}

/* Without its pictures. */
static material make_material(const importer *i, const import_material *source)
{
    rgb diffuse = share_of(i, source->diffuse), specular = share_of(i, source->specular);
    const bool is_principled = is_given(source->roughness) || is_given(source->metallic) || source->clearcoat > 0.0f ||
                               source->transmission > 0.0f || source->pictures[IMPORT_ROUGHNESS].path[0] ||
                               source->pictures[IMPORT_METALLIC].path[0];
    switch (source->illumination) {
    case 4:
    case 6:
    case 7:
    case 9: return make_glass(i, source);
    case 3:
    case 5:
    case 8:
        if (!is_given(source->metallic) && !rgb_is_black(specular))
            return make_mirror(source, diffuse, specular);
        break;
    default: break;
    }
    if (is_principled) {
        material m = make_principled(diffuse, is_given(source->roughness)                  ? source->roughness
                                              : source->pictures[IMPORT_ROUGHNESS].path[0] ? 1.0f
                                                                                           : 0.5f);
        m.metallic = is_given(source->metallic)                  ? clamp01(source->metallic)
                     : source->pictures[IMPORT_METALLIC].path[0] ? 1.0f
                                                                 : 0.0f;
        m.transmission = clamp01(source->transmission);
        m.ior = source->ior > 1.0f && isfinite(source->ior) ? source->ior : 1.5f;
        m.clearcoat = clamp01(source->clearcoat);
        m.clearcoat_roughness = clamp01(source->clearcoat_roughness);
        return m;
    }
    if (!rgb_is_black(specular)) {
        material m = make_principled(diffuse, exponent_roughness(source->exponent, 0.5f));
        m.specular_color = rgb_scale(specular, 2.0f); /* of 0.04 */
        return m;
    }
    material m = material_make(MATERIAL_DIFFUSE);
    m.reflectance = diffuse;
    return m;
}

static bool is_glass(const material *m) { return m->kind == MATERIAL_DIELECTRIC || m->transmission == 1.0f; }

/* A picture multiplies a principled material's colour, but stands in for a diffuse one's. */
static ag_status add_color(importer *i, const import_material *source, material *m)
{
    const import_picture *p = &source->pictures[IMPORT_COLOR];
    if (p->path[0] == '\0' || is_glass(m))
        return AG_OK;
    rgb factor = rgb_is_black(m->reflectance) ? rgb_gray(1.0f) : m->reflectance;
    const bool is_gray = factor.r == factor.g && factor.g == factor.b;
    uint32_t picture;
    AG_TRY(add_picture(i, p, PICTURE_COLOR, m->kind == MATERIAL_DIFFUSE && is_gray ? factor.r : 1.0f, &picture));
    if (picture == SCENE_NO_TEXTURE)
        return AG_OK;
    if (m->kind == MATERIAL_DIFFUSE && !is_gray) {
        *m = make_principled(factor, 1.0f);
        m->specular = 0.0f;
    }
    m->reflectance = factor;
    m->reflectance_texture = picture;
    return AG_OK;
}

static ag_status add_relief(importer *i, const import_material *source, material *m)
{
    const import_picture *normal = &source->pictures[IMPORT_NORMAL], *bump = &source->pictures[IMPORT_BUMP];
    AG_TRY(add_picture(i, normal, PICTURE_DIRECTION, 1.0f, &m->normal_map_texture));
    if (isfinite(normal->strength))
        m->normal_scale = normal->strength;
    float height = bump->strength * i->bump_unit;
    if (m->normal_map_texture != SCENE_NO_TEXTURE || !isfinite(height))
        return AG_OK;
    return add_picture(i, bump, PICTURE_NUMBER, height, &m->displacement_texture);
}

static ag_status add_opacity(importer *i, const import_material *source, const material *m, import_surface *out)
{
    if (is_glass(m))
        return AG_OK;
    out->alpha = is_given(source->opacity) ? clamp01(source->opacity) : 1.0f;
    if (out->alpha == 0.0f)
        log_at(i->log, AG_LOG_WARNING, i->where, "material \"%s\" has the opacity 0: what is made of it is not seen",
               source->name);
    return add_picture(i, &source->pictures[IMPORT_OPACITY], PICTURE_OPACITY, out->alpha, &out->alpha_texture);
}

static ag_status add_emission(importer *i, const import_material *source, import_surface *out)
{
    rgb e = source->emission;
    const import_picture *p = &source->pictures[IMPORT_EMISSION];
    if (!rgb_is_finite(e) || e.r < 0.0f || e.g < 0.0f || e.b < 0.0f)
        e = rgb_gray(0.0f);
    e = working_space_light(&i->scene->space, e);
    AG_TRY(add_picture(i, p, PICTURE_COLOR, 1.0f, &out->radiance_texture));
    out->radiance = out->radiance_texture != SCENE_NO_TEXTURE && rgb_is_black(e) ? rgb_gray(1.0f) : e;
    return AG_OK;
}

ag_status importer_add_material(importer *i, const import_material *source, import_surface *out_surface)
{
    import_surface surface = {.alpha = 1.0f, .alpha_texture = SCENE_NO_TEXTURE, .radiance_texture = SCENE_NO_TEXTURE};
    material m = make_material(i, source);
    AG_TRY(add_color(i, source, &m));
    if (m.kind == MATERIAL_PRINCIPLED && !is_glass(&m)) {
        AG_TRY(add_picture(i, &source->pictures[IMPORT_ROUGHNESS], PICTURE_NUMBER, 1.0f, &m.roughness_texture));
        AG_TRY(add_picture(i, &source->pictures[IMPORT_METALLIC], PICTURE_NUMBER, 1.0f, &m.metallic_texture));
    }
    AG_TRY(add_relief(i, source, &m));
    AG_TRY(add_opacity(i, source, &m, &surface));
    AG_TRY(add_emission(i, source, &surface));
    AG_TRY(scene_add_material(i->scene, &m, &surface.material_index));
    AG_TRY(scene_set_name(i->scene, NAMED_MATERIAL, surface.material_index, source->name));
    *out_surface = surface;
    return AG_OK;
}
