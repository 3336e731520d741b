/* gltf_textures.c: a material's reference to a texture becomes a texture of the scene: picture, sampler, transform.
 * Rests on: Khronos, "glTF 2.0 Specification", 2021, 3.8 (textures); KHR_texture_transform.
 * Flow: gltf_materials -> [here] -> gltf_images. Threads: one per scene. */
#include "gltf/gltf_private.h"

#include <string.h>

static const uint64_t MAX_UV_SETS = 1000000; /* the number becomes part of a name */

static ag_status read_wrap(const gltf_reader *r, const gltf_value *sampler, const char *key, texture_wrap *wrap)
{
    uint64_t number = 10497;
    gltf_value v = gltf_member(sampler, key);
    AG_TRY(gltf_get_uint(r, sampler, key, &number));
    if (number != 10497 && number != 33071 && number != 33648)
        return gltf_error(r, &v, "there is no wrap %llu", (unsigned long long)number);
    *wrap = number == 10497 ? TEXTURE_WRAP_REPEAT : number == 33071 ? TEXTURE_WRAP_CLAMP : TEXTURE_WRAP_MIRROR;
    return AG_OK;
}

static ag_status read_sampler(const gltf_reader *r, const gltf_value *texture_value, texture *t)
{
    uint32_t index = GLTF_NONE;
    uint64_t filter = 9729;
    gltf_value sampler;
    AG_TRY(gltf_get_index(r, texture_value, "sampler", GLTF_SAMPLERS, &index));
    if (index == GLTF_NONE)
        return AG_OK;
    AG_TRY(gltf_get_item(r, GLTF_SAMPLERS, index, &sampler));
    AG_TRY(gltf_get_uint(r, &sampler, "magFilter", &filter));
    t->filter = filter == 9728 ? TEXTURE_FILTER_POINT : TEXTURE_FILTER_BILINEAR;
    AG_TRY(read_wrap(r, &sampler, "wrapS", &t->wraps.s));
    return read_wrap(r, &sampler, "wrapT", &t->wraps.t);
}

/* glTF's v runs down the picture, where its rotation and scale apply; our v runs up. */
static void map_uv(const double offset[2], double rotation, const double scale[2], texture_mapping *m)
{
    double c = cos(rotation), s = sin(rotation);
    m->kind = TEXTURE_MAPPING_UV_AFFINE;
    m->axes[0] = vec3_make((float)(c * scale[0]), (float)(-s * scale[1]), 0.0f);
    m->axes[1] = vec3_make((float)(s * scale[0]), (float)(c * scale[1]), 0.0f);
    m->delta = (vec2){(float)(s * scale[1] + offset[0]), (float)(1.0 - c * scale[1] - offset[1])};
}

static ag_status read_transform(const gltf_reader *r, const gltf_value *info, texture_mapping *m, uint64_t *uv_set)
{
    double offset[2] = {0.0, 0.0}, scale[2] = {1.0, 1.0}, rotation = 0.0;
    gltf_value extensions, extension;
    m->kind = TEXTURE_MAPPING_UV;
    m->scale = (vec2){1.0f, 1.0f};
    AG_TRY(gltf_get_extension(r, info, "KHR_texture_transform", &extensions, &extension));
    if (!extension.json)
        return AG_OK;
    AG_TRY(gltf_get_doubles(r, &extension, "offset", 2, offset));
    AG_TRY(gltf_get_doubles(r, &extension, "scale", 2, scale));
    AG_TRY(gltf_get_double(r, &extension, "rotation", &rotation));
    AG_TRY(gltf_get_uint(r, &extension, "texCoord", uv_set));
    map_uv(offset, rotation, scale, m);
    vec3 largest = vec3_make(vec3_max_abs(m->axes[0]), vec3_max_abs(m->axes[1]), fabsf(m->delta.x) + fabsf(m->delta.y));
    return vec3_max_abs(largest) <= 1e18f && vec3_is_finite(largest)
               ? AG_OK
               : gltf_error(r, &extension, "its numbers are too large");
}

static ag_status choose_uv_set(const gltf_reader *r, const gltf_value *info, uint64_t wanted, uint32_t *uv_set)
{
    if (wanted >= MAX_UV_SETS)
        return gltf_error(r, info, "there is no TEXCOORD_%llu", (unsigned long long)wanted);
    if (*uv_set == GLTF_NONE)
        *uv_set = (uint32_t)wanted;
    if (*uv_set != wanted)
        gltf_warn_once(r, info, "texCoord",
                       "textures of one material by several sets of uvs are not supported: TEXCOORD_%u is used, not %u",
                       *uv_set, (unsigned)wanted);
    return AG_OK;
}

ag_status gltf_get_texture(gltf_reader *r, const gltf_value *parent, const char *key, gltf_texture_use use,
                           uint32_t *uv_set, uint32_t *out_texture)
{
    uint32_t index = GLTF_NONE, source = GLTF_NONE;
    uint64_t wanted_set = 0;
    gltf_value info, texture_value;
    texture t = texture_make(TEXTURE_IMAGE);
    t.is_spectrum = use.is_color;
    t.is_data = use.is_color && !use.is_srgb;
    t.channel = use.channel;
    t.scale = use.scale;
    t.invert = use.invert;
    AG_TRY(gltf_get_object(r, parent, key, &info));
    if (!info.json)
        return AG_OK;
    AG_TRY(gltf_require(r, &info, "index"));
    AG_TRY(gltf_get_index(r, &info, "index", GLTF_TEXTURES, &index));
    AG_TRY(gltf_get_uint(r, &info, "texCoord", &wanted_set));
    AG_TRY(read_transform(r, &info, &t.mapping, &wanted_set));
    AG_TRY(gltf_get_item(r, GLTF_TEXTURES, index, &texture_value));
    AG_TRY(gltf_get_index(r, &texture_value, "source", GLTF_IMAGES, &source));
    if (source == GLTF_NONE) {
        gltf_warn_once(r, &texture_value, "source", "there is no picture in a known format: the texture is left out");
        return AG_OK;
    }
    AG_TRY(read_sampler(r, &texture_value, &t));
    AG_TRY(choose_uv_set(r, &info, wanted_set, uv_set));
    image_encoding encoding = {.curve = use.is_srgb ? IMAGE_CURVE_SRGB : IMAGE_CURVE_LINEAR};
    AG_TRY(gltf_load_image(r, source, encoding, &t.image_index));
    return texture_set_add(&r->scene->textures, &t, out_texture);
}
