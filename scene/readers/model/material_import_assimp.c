/* material_import_assimp.c: materials as assimp reads them, as records: see import_assimp.h. Threads: one. */
#include "model/import_assimp.h"

#include <assimp/ObjMaterial.h>
#include <assimp/material.h>

#include <math.h>
#include <string.h>

static float get_float(const struct aiMaterial *m, const char *key, unsigned type, unsigned index, float fallback)
{
    ai_real value;
    unsigned count = 1;
    return aiGetMaterialFloatArray(m, key, type, index, &value, &count) == aiReturn_SUCCESS && count == 1 ? (float)value
                                                                                                          : fallback;
}

static rgb get_color(const struct aiMaterial *m, const char *key, unsigned type, unsigned index, rgb fallback)
{
    struct aiColor4D c;
    return aiGetMaterialColor(m, key, type, index, &c) == aiReturn_SUCCESS
               ? rgb_make((float)c.r, (float)c.g, (float)c.b)
               : fallback;
}

static uint32_t wrap_of(enum aiTextureMapMode mode)
{
    return mode == aiTextureMapMode_Clamp    ? IMPORT_IS_CLAMPED
           : mode == aiTextureMapMode_Mirror ? IMPORT_IS_MIRRORED
           : mode == aiTextureMapMode_Decal  ? IMPORT_IS_BLACK
                                             : IMPORT_REPEATS;
}

/* Finds the first of up to three kinds of which the material has a picture. */
static void get_picture(const assimp_writer *w, const struct aiMaterial *m, const enum aiTextureType types[3],
                        import_picture *out)
{
    *out = (import_picture){.scale = {1.0f, 1.0f}, .strength = 1.0f};
    for (int k = 0; k < 3 && types[k] != aiTextureType_NONE; k++) {
        struct aiString path;
        enum aiTextureMapMode modes[3] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
        struct aiUVTransform t;
        if (aiGetMaterialTexture(m, types[k], 0, &path, NULL, NULL, NULL, NULL, modes, NULL) != aiReturn_SUCCESS)
            continue;
        assimp_copy_text(out->path, sizeof out->path, &path);
        for (unsigned n = 0; n < w->scene->mNumTextures && path.data[0] != '*'; n++)
            if (strcmp(w->scene->mTextures[n]->mFilename.data, path.data) == 0) {
                snprintf(out->path, sizeof out->path, "*%u", n);
                break;
            }
        out->wrap_s = wrap_of(modes[0]);
        out->wrap_t = wrap_of(modes[1]);
        if (aiGetMaterialUVTransform(m, AI_MATKEY_UVTRANSFORM(types[k], 0), &t) == aiReturn_SUCCESS) {
            out->scale[0] = (float)t.mScaling.x;
            out->scale[1] = (float)t.mScaling.y;
            out->offset[0] = (float)t.mTranslation.x;
            out->offset[1] = (float)t.mTranslation.y;
        }
        out->strength = get_float(m, AI_MATKEY_OBJ_BUMPMULT(types[k], 0), 1.0f);
        return;
    }
}

/* assimp's readers fill in specular colours where the file has none. */
static bool has_highlights(const struct aiMaterial *m)
{
    int mode = 0;
    unsigned count = 1;
    if (aiGetMaterialIntegerArray(m, AI_MATKEY_SHADING_MODEL, &mode, &count) == aiReturn_SUCCESS && count == 1)
        return mode == aiShadingMode_Phong || mode == aiShadingMode_Blinn || mode == aiShadingMode_CookTorrance;
    return get_float(m, AI_MATKEY_SHININESS, 0.0f) > 0.0f;
}

/* Blender's FBX exporter squeezes its principled material into Phong's words: specular is twice SpecularFactor and 0.08
 * of it is reflected at normal incidence, roughness is 1 - sqrt(Shininess) / 10, metallic ReflectionFactor. */
static void restore_surface_of_fbx(const struct aiMaterial *m, import_material *out)
{
    const double specular = 2.0 * (double)get_float(m, AI_MATKEY_SHININESS_STRENGTH, 0.25f);
    const double normal = sqrt(double_clamp(0.08 * specular, 1e-6, 0.9));
    out->metallic = float_clamp(get_float(m, AI_MATKEY_REFLECTIVITY, 0.0f), 0.0f, 1.0f);
    out->roughness = (float)double_max(1.0 - sqrt(double_max((double)out->exponent, 0.0)) / 10.0, 0.0);
    out->ior = (float)((1.0 + normal) / (1.0 - normal));
}

/* Blender's Collada exporter writes an index of refraction for principled materials alone, whose metallic it calls
 * reflectivity; it leaves out specular and roughness, which have Blender's defaults here, 0.5 both: 0.04 is reflected
 * at normal incidence. Returns whether this is such a one. */
static bool restore_surface_of_collada(const struct aiMaterial *m, import_material *out)
{
    if (out->ior <= 0.0f || out->ior == 1.0f) /* the value of assimp where the file has none */
        return false;
    out->metallic = float_clamp(get_float(m, AI_MATKEY_REFLECTIVITY, 0.0f), 0.0f, 1.0f);
    out->roughness = 0.5f;
    out->ior = 1.5f;
    return true;
}

void assimp_write_material(assimp_writer *w, const struct aiMaterial *m)
{
    static const enum aiTextureType TYPES[IMPORT_SLOT_COUNT][3] = {
        [IMPORT_COLOR] = {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE, aiTextureType_NONE},
        [IMPORT_EMISSION] = {aiTextureType_EMISSION_COLOR, aiTextureType_EMISSIVE, aiTextureType_NONE},
        [IMPORT_OPACITY] = {aiTextureType_OPACITY, aiTextureType_NONE, aiTextureType_NONE},
        [IMPORT_ROUGHNESS] = {aiTextureType_DIFFUSE_ROUGHNESS, aiTextureType_NONE, aiTextureType_NONE},
        [IMPORT_METALLIC] = {aiTextureType_METALNESS, aiTextureType_NONE, aiTextureType_NONE},
        [IMPORT_NORMAL] = {aiTextureType_NORMALS, aiTextureType_NORMAL_CAMERA, aiTextureType_NONE},
        [IMPORT_BUMP] = {aiTextureType_HEIGHT, aiTextureType_DISPLACEMENT, aiTextureType_NONE},
    };
    const rgb black = rgb_gray(0.0f);
    import_material out;
    memset(&out, 0, sizeof out);
    struct aiString name;
    if (aiGetMaterialString(m, AI_MATKEY_NAME, &name) == aiReturn_SUCCESS)
        assimp_copy_text(out.name, sizeof out.name, &name);
    int illumination = -1;
    unsigned count = 1;
    aiGetMaterialIntegerArray(m, AI_MATKEY_OBJ_ILLUM, &illumination, &count);
    out.illumination = illumination;
    out.diffuse = get_color(m, AI_MATKEY_COLOR_DIFFUSE, rgb_gray(0.6f));
    out.diffuse = get_color(m, AI_MATKEY_BASE_COLOR, out.diffuse);
    if (has_highlights(m))
        out.specular =
            rgb_scale(get_color(m, AI_MATKEY_COLOR_SPECULAR, black), get_float(m, AI_MATKEY_SHININESS_STRENGTH, 1.0f));
    out.emission =
        rgb_scale(get_color(m, AI_MATKEY_COLOR_EMISSIVE, black), get_float(m, AI_MATKEY_EMISSIVE_INTENSITY, 1.0f));
    w->has_plain_shining |= out.emission.r > 0.0f || out.emission.g > 0.0f || out.emission.b > 0.0f;
    out.filter = illumination >= 0 ? get_color(m, AI_MATKEY_COLOR_TRANSPARENT, rgb_gray(1.0f)) : rgb_gray(1.0f);
    out.exponent = get_float(m, AI_MATKEY_SHININESS, -1.0f);
    out.opacity = get_float(m, AI_MATKEY_OPACITY, 1.0f);
    out.ior = get_float(m, AI_MATKEY_REFRACTI, -1.0f);
    out.metallic = get_float(m, AI_MATKEY_METALLIC_FACTOR, -1.0f);
    /* some readers derive a roughness from Phong's exponent: that one counts by itself */
    out.roughness = illumination >= 0 || out.metallic >= 0.0f ? get_float(m, AI_MATKEY_ROUGHNESS_FACTOR, -1.0f) : -1.0f;
    out.clearcoat = get_float(m, AI_MATKEY_CLEARCOAT_FACTOR, 0.0f);
    out.clearcoat_roughness = get_float(m, AI_MATKEY_CLEARCOAT_ROUGHNESS_FACTOR, 0.0f);
    out.transmission = get_float(m, AI_MATKEY_TRANSMISSION_FACTOR, 0.0f);
    const bool is_restored = w->is_blenders && !w->is_fbx && restore_surface_of_collada(m, &out);
    w->has_default_surface |= is_restored;
    if (w->is_blenders && w->is_fbx)
        restore_surface_of_fbx(m, &out);
    for (int slot = 0; slot < IMPORT_SLOT_COUNT; slot++)
        get_picture(w, m, TYPES[slot], &out.pictures[slot]);
    if (w->is_blenders && (w->is_fbx || is_restored) && out.pictures[IMPORT_COLOR].path[0] != '\0')
        out.diffuse = rgb_gray(1.0f); /* a socket's value, which the picture replaces */
    assimp_write_record(w, IMPORT_RECORD_MATERIAL, &out, sizeof out);
}
