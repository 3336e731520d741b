/* test_gltf_materials.c: materials, textures and emission as they come out in the scene; pictures from files, data URIs
 * and buffers; every error by its message. Threads: one. */
#define _POSIX_C_SOURCE 200809L
#include "fixtures/gltf_fixture.h"
#include "output/image_file.h"
#include "rays/rays.h"
#include "scene.h"

/* A document with one triangle of materials[0]; others are its members besides. */
static const char *material_text(const char *material_json, const char *others)
{
    static char text[8192];
    int length =
        snprintf(text, sizeof text,
                 "{" GLTF_ASSET GLTF_TRIANGLE "%s 'materials': [%s], 'meshes': [{'primitives': [{'material': 0,"
                 "'attributes': {'POSITION': 0}}]}], 'nodes': [{'mesh': 0}]}",
                 others, material_json);
    assert_true(length < (int)sizeof text);
    return text;
}

static const material *only_material(const reading *r)
{
    assert_int_equal(r->scene->shape_count, 1);
    return &r->scene->materials[r->scene->shapes[0].material_index];
}

static void defaults(void **state)
{
    (void)state;
    write_triangle();
    static const char *const TEXTS[] = {"{}", "{'pbrMetallicRoughness': {}}"};
    for (size_t i = 0; i < 2; i++) {
        reading r = gltf_of(material_text(TEXTS[i], ""));
        const material *m = only_material(&r);
        assert_int_equal(m->kind, MATERIAL_PRINCIPLED);
        assert_rgb(m->reflectance, 1, 1, 1, 0);
        assert_near(m->metallic, 1, 0);
        assert_near(m->roughness, 1, 0);
        assert_near(m->ior, 1.5, 0);
        assert_near(m->transmission, 0, 0);
        assert_true(m->reflectance_texture == SCENE_NO_TEXTURE && m->normal_map_texture == SCENE_NO_TEXTURE);
        assert_near(r.scene->shapes[0].alpha, 1, 0);
        assert_true(r.scene->shapes[0].alpha_texture == SCENE_NO_TEXTURE);
        assert_true(r.scene->shapes[0].light_index == SHAPE_NO_LIGHT);
        reading_destroy(&r);
    }
}

/* The text, as Blender's exporter would have signed it. */
static const char *by_blender(const char *text)
{
    static const char UNSIGNED[] = "'version': '2.0'",
                      SIGNED[] = "'version': '2.0', 'generator': 'Khronos glTF Blender I/O v3.4.50'";
    static char out[8192];
    const char *version = strstr(text, UNSIGNED);
    assert_non_null(version);
    snprintf(out, sizeof out, "%.*s%s%s", (int)(version - text), text, SIGNED, version + sizeof UNSIGNED - 1);
    return out;
}

static void factors(void **state)
{
    (void)state;
    write_triangle();
    reading r = gltf_of(
        material_text("{'pbrMetallicRoughness': {'baseColorFactor': [0.1, 0.2, 0.3, 0.4], 'metallicFactor': 0.5, "
                      "'roughnessFactor': 0.6},"
                      "'extensions': {'KHR_materials_ior': {'ior': 1.3},"
                      "'KHR_materials_specular': {'specularFactor': 0.7, 'specularColorFactor': [0.5, 1, 2]},"
                      "'KHR_materials_transmission': {'transmissionFactor': 0.8},"
                      "'KHR_materials_clearcoat': {'clearcoatFactor': 0.25, 'clearcoatRoughnessFactor': 0.125}}}",
                      ""));
    const material *m = only_material(&r);
    assert_rgb(m->reflectance, 0.1, 0.2, 0.3, 1e-7);
    assert_near(m->metallic, 0.5, 0);
    assert_near(m->roughness, 0.6, 1e-7);
    assert_near(m->ior, 1.3, 1e-6);
    assert_near(m->specular, 0.7, 1e-7);
    assert_rgb(m->specular_color, 0.5, 1, 2, 0);
    assert_near(m->transmission, 0.8, 1e-7);
    assert_near(m->clearcoat, 0.25, 0);
    assert_near(m->clearcoat_roughness, 0.125, 0);
    assert_true(m->is_thin);
    assert_near(r.scene->shapes[0].alpha, 1, 0); /* opaque, whatever the factor's alpha */
    reading_destroy(&r);
    r = gltf_of(material_text("{'extensions': {'KHR_materials_transmission': {'transmissionFactor': 1},"
                              "'KHR_materials_volume': {'thicknessFactor': 0.1}}}",
                              ""));
    assert_false(only_material(&r)->is_thin);
    assert_false(r.scene->shapes[0].has_medium_interface);
    reading_destroy(&r);
    /* after 2 units half of the red and all of the green is left, and of the blue as little as one can say */
    static const char ABSORBING[] = "{'extensions': {'KHR_materials_transmission': {'transmissionFactor': 1},"
                                    "'KHR_materials_volume': {'thicknessFactor': 0.1, 'attenuationDistance': 2,"
                                    "'attenuationColor': [0.5, 1, 0]}}}";
    r = gltf_of(material_text(ABSORBING, ""));
    assert_false(only_material(&r)->is_thin);
    assert_true(r.scene->shapes[0].has_medium_interface);
    assert_true(r.scene->shapes[0].medium_outside == SCENE_NO_MEDIUM);
    assert_int_equal(r.scene->shapes[0].medium_inside, 0);
    assert_int_equal(r.scene->medium_count, 1);
    assert_rgb(r.scene->media[0].sigma_a, 0.5 * log(2), 0, 0.5 * log(1e6), 1e-5);
    reading_destroy(&r);
    /* Blender's Volume Absorption of that colour and of density 1/2 */
    r = gltf_read(by_blender(material_text(ABSORBING, "")));
    assert_int_equal(r.status, AG_OK);
    assert_rgb(r.scene->media[0].sigma_a, 0.25, 0, 0.5, 1e-6);
    expect_said(&r, AG_LOG_INFO, "glass absorbs as Blender's Volume Absorption does");
    reading_destroy(&r);
    static const char *const THIN[] = {
        "{'extensions': {'KHR_materials_transmission': {'transmissionFactor': 1}, 'KHR_materials_volume': {"
        "'attenuationDistance': 2, 'attenuationColor': [0.5, 1, 0]}}}",
        "{'extensions': {'KHR_materials_volume': {'thicknessFactor': 1, 'attenuationDistance': 2,"
        "'attenuationColor': [0.5, 1, 0]}}}"};
    for (int i = 0; i < 2; i++) {
        r = gltf_of(material_text(THIN[i], ""));
        assert_int_equal(r.scene->medium_count, 0);
        assert_false(r.scene->shapes[0].has_medium_interface);
        reading_destroy(&r);
    }
}

static void alpha_modes(void **state)
{
    (void)state;
    static const struct {
        const char *json;
        double alpha, cutoff;
    } MODES[] = {
        {"{'alphaMode': 'OPAQUE', 'pbrMetallicRoughness': {'baseColorFactor': [1, 1, 1, 0.25]}}", 1, 0},
        {"{'alphaMode': 'BLEND', 'pbrMetallicRoughness': {'baseColorFactor': [1, 1, 1, 0.25]}}", 0.25, 0},
        {"{'alphaMode': 'MASK', 'pbrMetallicRoughness': {'baseColorFactor': [1, 1, 1, 0.25]}}", 0.25, 0.5},
        {"{'alphaMode': 'MASK', 'alphaCutoff': 0.75, 'pbrMetallicRoughness': {}}", 1, 0.75},
        {"{'alphaMode': 'MASK', 'alphaCutoff': 0, 'pbrMetallicRoughness': {'baseColorFactor': [1, 1, 1, 0.25]}}", 1, 0},
    };
    write_triangle();
    for (size_t i = 0; i < sizeof MODES / sizeof *MODES; i++) {
        reading r = gltf_of(material_text(MODES[i].json, ""));
        assert_near(r.scene->shapes[0].alpha, MODES[i].alpha, 0);
        assert_near(r.scene->shapes[0].alpha_cutoff, MODES[i].cutoff, 0);
        reading_destroy(&r);
    }
}

static void emission(void **state)
{
    (void)state;
    write_triangle();
    reading r = gltf_of(material_text("{'emissiveFactor': [1, 0.5, 0], 'doubleSided': true,"
                                      "'extensions': {'KHR_materials_emissive_strength': {'emissiveStrength': 8}}}",
                                      ""));
    assert_int_equal(r.scene->light_count, 1);
    const light *l = &r.scene->lights[0];
    assert_int_equal(l->kind, LIGHT_AREA);
    assert_rgb(l->radiance, 8, 4, 0, 0);
    assert_true(l->two_sided);
    assert_int_equal(r.scene->shapes[0].light_index, 0);
    reading_destroy(&r);
    r = gltf_of(material_text("{'emissiveFactor': [1, 1, 1]}", ""));
    assert_false(r.scene->lights[0].two_sided);
    reading_destroy(&r);

    gltf_expect_warning(material_text("{'extensions': {'KHR_materials_unlit': {}},"
                                      "'pbrMetallicRoughness': {'baseColorFactor': [0.5, 0.25, 1, 1]}}",
                                      ""),
                        "materials[0].extensions.KHR_materials_unlit: unlit materials shine with their colour");
    r = gltf_read(material_text("{'extensions': {'KHR_materials_unlit': {}},"
                                "'pbrMetallicRoughness': {'baseColorFactor': [0.5, 0.25, 1, 1]}}",
                                ""));
    assert_rgb(r.scene->lights[0].radiance, 0.5, 0.25, 1, 0);
    assert_true(r.scene->lights[0].two_sided);
    assert_int_equal(only_material(&r)->kind, MATERIAL_DIFFUSE);
    assert_rgb(only_material(&r)->reflectance, 0, 0, 0, 0);
    reading_destroy(&r);
}

static void specular_glossiness(void **state)
{
    (void)state;
    write_triangle();
    reading r =
        gltf_of(material_text("{'extensions': {'KHR_materials_pbrSpecularGlossiness': {'diffuseFactor':"
                              "[0.1, 0.2, 0.3, 0.4], 'specularFactor': [0.5, 0.6, 0.7], 'glossinessFactor': 0.75}},"
                              "'alphaMode': 'BLEND', 'pbrMetallicRoughness': {'metallicFactor': 1}}",
                              ""));
    const material *m = only_material(&r);
    assert_rgb(m->reflectance, 0.1, 0.2, 0.3, 1e-7);
    assert_rgb(m->specular_color, 0.5, 0.6, 0.7, 1e-7);
    assert_near(m->roughness, 0.25, 0);
    assert_near(m->metallic, 0, 0);
    assert_near(m->ior, 0, 0);
    assert_near(r.scene->shapes[0].alpha, 0.4, 1e-7);
    reading_destroy(&r);
}

/* --- textures --- */

/* A PNG file of two pixels: red 0.2 green 0.4 blue 0.6 alpha 0.8, and black of alpha 0. */
static const unsigned char PICTURE[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00, 0x00,
    0x00, 0x02, 0x00, 0x00, 0x00, 0x01, 0x08, 0x06, 0x00, 0x00, 0x00, 0xf4, 0x22, 0x7f, 0x8a, 0x00, 0x00, 0x00,
    0x0f, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x30, 0x4e, 0x9b, 0x79, 0x86, 0x01, 0x08, 0x00, 0x0b, 0xfd,
    0x01, 0xff, 0xff, 0x1e, 0x69, 0x07, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

/* Those, or in a JPEG file much the same without alpha. */
static void write_picture(const char *name)
{
    static const char *const CHANNELS[] = {"R", "G", "B"};
    const float pixels[] = {0.2f, 0.4f, 0.6f, 0, 0, 0};
    const image_description description = {.width = 2,
                                           .height = 1,
                                           .full_width = 2,
                                           .full_height = 1,
                                           .channel_count = 3,
                                           .channel_names = CHANNELS,
                                           .type = IMAGE_UINT8};
    if (strstr(name, ".png"))
        write_file(name, PICTURE, sizeof PICTURE);
    else if (image_file_write(in_folder(name), &description, pixels, message, sizeof message) != AG_OK)
        fail_msg("%s", message);
}

#define ONE_TEXTURE "'textures': [{'source': 0, 'sampler': 0}], 'samplers': [{}], 'images': [{'uri': 'p.png'}],"

/* The value that a texture of the scene has at uv. */
static rgb value_at(const reading *r, uint32_t texture_index, float u, float v)
{
    surface_hit hit;
    memset(&hit, 0, sizeof hit);
    hit.uv = (vec2){u, v};
    assert_true(texture_index < r->scene->texture_count);
    return texture_evaluate_rgb(r->scene, texture_index, &hit);
}

/* Linear from sRGB. */
static double decoded(double v) { return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4); }

/* Small lamps painted on a device are no light to see it by. */
static void what_only_glows_does_not_replace_the_sky(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        uint32_t light_count;
    } CASES[] = {
        {"{'emissiveTexture': {'index': 0}, 'emissiveFactor': [1, 1, 1]}", 3},
        {"{'emissiveFactor': [1, 1, 1]}", 1},
        {"{'emissiveTexture': {'index': 0}, 'emissiveFactor': [1, 1, 1],"
         "'extensions': {'KHR_materials_emissive_strength': {'emissiveStrength': 5}}}",
         1},
        {"{'emissiveTexture': {'index': 0}, 'emissiveFactor': [1, 1, 1],"
         "'pbrMetallicRoughness': {'baseColorTexture': {'index': 0}}, 'extensions': {'KHR_materials_unlit': {}}}",
         1},
    };
    write_triangle();
    write_picture("p.png");
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        reading r = gltf_read(material_text(CASES[i].text, ONE_TEXTURE));
        assert_int_equal(r.status, AG_OK);
        assert_int_equal(r.scene->light_count, CASES[i].light_count);
        reading_destroy(&r);
    }
}

static void material_textures(void **state)
{
    (void)state;
    write_triangle();
    write_picture("p.png");
    reading r = gltf_read(material_text(
        "{'alphaMode': 'MASK', 'pbrMetallicRoughness': {'baseColorTexture': {'index': 0},"
        "'metallicRoughnessTexture': {'index': 0}, 'baseColorFactor': [1, 1, 1, 0.5]},"
        "'normalTexture': {'index': 0, 'scale': 0.5}, 'emissiveTexture': {'index': 0}, 'emissiveFactor': [1, 1, 1],"
        "'occlusionTexture': {'index': 0},"
        "'extensions': {'KHR_materials_transmission': {'transmissionFactor': 1, 'transmissionTexture': {'index': 0}},"
        "'KHR_materials_specular': {'specularTexture': {'index': 0}, 'specularColorTexture': {'index': 0}},"
        "'KHR_materials_clearcoat': {'clearcoatFactor': 1, 'clearcoatTexture': {'index': 0},"
        "'clearcoatRoughnessTexture': {'index': 0}}}}",
        ONE_TEXTURE));
    assert_int_equal(r.status, AG_OK);
    expect_said(&r, AG_LOG_WARNING, "attributes: the material's textures need TEXCOORD_0, which is missing");
    assert_int_equal(r.count[AG_LOG_WARNING], 1);
    const material *m = only_material(&r);
    const float u = 0.25f, v = 0.5f; /* the middle of the first pixel */
    const double red = decoded(0.2), green = decoded(0.4), blue = decoded(0.6), close = 1e-6;
    assert_rgb(value_at(&r, m->reflectance_texture, u, v), red, green, blue, close);
    assert_rgb(value_at(&r, m->specular_color_texture, u, v), red, green, blue, close);
    assert_rgb(value_at(&r, r.scene->lights[0].radiance_texture, u, v), red, green, blue, close);
    assert_rgb(value_at(&r, m->normal_map_texture, u, v), 0.2, 0.4, 0.6, close);
    assert_near(m->normal_scale, 0.5, 0);
    assert_near(value_at(&r, m->metallic_texture, u, v).r, 0.6, close);
    assert_near(value_at(&r, m->roughness_texture, u, v).r, 0.4, close);
    assert_near(value_at(&r, m->transmission_texture, u, v).r, 0.2, close);
    assert_near(value_at(&r, m->specular_texture, u, v).r, 0.8, close);
    assert_near(value_at(&r, m->clearcoat_texture, u, v).r, 0.2, close);
    assert_near(value_at(&r, m->clearcoat_roughness_texture, u, v).r, 0.4, close);
    assert_near(value_at(&r, r.scene->shapes[0].alpha_texture, u, v).r, 0.4, close); /* times the factor's */
    assert_int_equal(r.scene->texture_image_count, 2);                               /* once for each encoding */
    reading_destroy(&r);

    r = gltf_read(material_text("{'extensions': {'KHR_materials_pbrSpecularGlossiness': {'glossinessFactor': 0.5,"
                                "'diffuseTexture': {'index': 0}, 'specularGlossinessTexture': {'index': 0}}}}",
                                ONE_TEXTURE));
    assert_int_equal(r.status, AG_OK);
    m = only_material(&r);
    assert_rgb(value_at(&r, m->reflectance_texture, u, v), red, green, blue, close);
    assert_rgb(value_at(&r, m->specular_color_texture, u, v), red, green, blue, close);
    assert_near(m->roughness, 1, 0);
    assert_near(value_at(&r, m->roughness_texture, u, v).r, 1.0 - 0.5 * 0.8, close);
    reading_destroy(&r);
}

/* A picture of 2 by 2 pixels, whose red tells them apart: 0.2 0.4 above 0.6 0.8. */
static void samplers_and_transforms(void **state)
{
    (void)state;
    static const char *const CHANNELS[] = {"R", "G", "B"};
    const float pixels[] = {0.2f, 0, 0, 0.4f, 0, 0, 0.6f, 0, 0, 0.8f, 0, 0};
    const image_description description = {.width = 2,
                                           .height = 2,
                                           .full_width = 2,
                                           .full_height = 2,
                                           .channel_count = 3,
                                           .channel_names = CHANNELS,
                                           .type = IMAGE_UINT8};
    /* uv are glTF's, v down */
    static const struct {
        const char *sampler, *transform;
        float u, v;
        double value;
    } LOOKUPS[] = {
        {"", "", 0.25f, 0.25f, 0.2},
        {"", "", 0.75f, 0.25f, 0.4},
        {"", "", 0.25f, 0.75f, 0.6},
        {"", "", 0.5f, 0.25f, 0.3},
        {"'magFilter': 9728", "", 0.45f, 0.45f, 0.2},
        {"'magFilter': 9729", "", 0.5f, 0.25f, 0.3},
        {"", "", 1.25f, 0.25f, 0.2},
        {"'wrapS': 10497", "", 0.0f, 0.25f, 0.3},
        {"'wrapS': 33071", "", 1.25f, 0.25f, 0.4},
        {"'wrapS': 33071", "", 0.75f, 1.25f, 0.4}, /* t still repeats */
        {"'wrapT': 33071", "", 0.75f, 1.25f, 0.8},
        {"'wrapT': 33071", "", 1.25f, 1.25f, 0.6},
        {"'wrapS': 33648", "", 1.25f, 0.25f, 0.4},
        {"'wrapS': 33648", "", 1.75f, 0.25f, 0.2},
        {"'wrapS': 33648", "", 2.25f, 0.25f, 0.2},
        {"'wrapS': 33648", "", -0.25f, 0.25f, 0.2},
        {"'wrapS': 33648", "", 1.0f, 0.25f, 0.4}, /* the edge's own pixel on both sides */
        {"'wrapS': 33648", "", 2.0f, 0.25f, 0.2},
        {"", "'offset': [0.5, 0]", 0.25f, 0.25f, 0.4},
        {"", "'offset': [0, 0.5]", 0.25f, 0.25f, 0.6},
        {"", "'scale': [3, 1]", 0.25f, 0.25f, 0.4},
        {"", "'offset': [0, 1], 'scale': [1, -1]", 0.25f, 0.25f, 0.6},
        /* the specification's example: of the lower left quadrant (here a pixel), turned clockwise by 90 degrees */
        {"", "'offset': [0, 1], 'rotation': 1.57079632679, 'scale': [0.5, 0.5]", 0.5f, 0.5f, 0.6},
        {"'wrapS': 33071, 'wrapT': 33071", "'offset': [0, 1], 'rotation': 1.57079632679", 0.25f, 0.25f, 0.6},
        {"'wrapS': 33071, 'wrapT': 33071", "'offset': [0, 1], 'rotation': 1.57079632679", 0.75f, 0.25f, 0.2},
        {"'wrapS': 33071, 'wrapT': 33071", "'offset': [0, 1], 'rotation': 1.57079632679", 0.25f, 0.75f, 0.8},
    };
    write_triangle();
    if (image_file_write(in_folder("q.png"), &description, pixels, message, sizeof message) != AG_OK)
        fail_msg("%s", message);
    for (size_t i = 0; i < sizeof LOOKUPS / sizeof *LOOKUPS; i++) {
        char others[512], info[512];
        snprintf(others, sizeof others,
                 "'textures': [{'source': 0, 'sampler': 0}], 'samplers': [{%s}], 'images': [{'uri': 'q.png'}],",
                 LOOKUPS[i].sampler);
        snprintf(info, sizeof info, "{'normalTexture': {'index': 0, 'extensions': {'KHR_texture_transform': {%s}}}}",
                 LOOKUPS[i].transform);
        reading r = gltf_read(material_text(info, others));
        assert_int_equal(r.status, AG_OK);
        rgb value = value_at(&r, only_material(&r)->normal_map_texture, LOOKUPS[i].u, 1.0f - LOOKUPS[i].v);
        if (!(fabs((double)value.r - LOOKUPS[i].value) < 1e-5))
            fail_msg("lookup %zu: %g is not %g", i, (double)value.r, LOOKUPS[i].value);
        reading_destroy(&r);
    }
}

static void uv_sets(void **state)
{
    (void)state;
    blob b = {.size = 0};
    BLOB_PUT(&b, (float[]){0, 0, 0, 1, 0, 0, 0, 1, 0});
    BLOB_PUT(&b, (float[]){0.5f, 1, 0.5f, 1, 0.5f, 1});
    BLOB_PUT(&b, (float[]){0.25f, 1, 0.25f, 1, 0.25f, NAN});
    write_blob("b.bin", &b);
    write_picture("p.png");
    static const char TEXT[] =
        "{" GLTF_ASSET
        "'buffers': [{'uri': 'b.bin', 'byteLength': 84}], 'bufferViews': [{'buffer': 0, 'byteLength': 84}],"
        "'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 3, 'type': 'VEC3'},"
        "  {'bufferView': 0, 'byteOffset': 36, 'componentType': 5126, 'count': 3, 'type': 'VEC2'},"
        "  {'bufferView': 0, 'byteOffset': 60, 'componentType': 5126, 'count': 3, 'type': 'VEC2'}]," ONE_TEXTURE
        "'materials': [{%s}], 'meshes': [{'primitives': [{'material': 0,"
        "  'attributes': {'POSITION': 0, 'TEXCOORD_0': 1, 'TEXCOORD_1': 2}}]}], 'nodes': [{'mesh': 0}]}";
    static const struct {
        const char *info;
        double u;
    } SETS[] = {
        {"", 0.5},
        {"'normalTexture': {'index': 0}", 0.5},
        {"'normalTexture': {'index': 0, 'texCoord': 1}", 0.25},
        {"'normalTexture': {'index': 0, 'texCoord': 0, 'extensions': {'KHR_texture_transform': {'texCoord': 1}}}",
         0.25},
        {"'normalTexture': {'index': 0}, 'occlusionTexture': {'index': 0, 'texCoord': 1}", 0.5},
    };
    for (size_t i = 0; i < sizeof SETS / sizeof *SETS; i++) {
        char text[2048];
        snprintf(text, sizeof text, TEXT, SETS[i].info);
        reading r = gltf_of(text);
        const mesh *m = &r.scene->shapes[0].as.mesh;
        assert_near(m->uvs[0].x, SETS[i].u, 0);
        assert_near(m->uvs[2].x, SETS[i].u == 0.25 ? 0 : 0.5, 0); /* what is not finite is 0 */
        reading_destroy(&r);
    }
    char text[2048];
    snprintf(
        text, sizeof text, TEXT,
        "'pbrMetallicRoughness': {'baseColorTexture': {'index': 0}}, 'normalTexture': {'index': 0, 'texCoord': 1}");
    gltf_expect_warning(text, "materials[0].normalTexture: textures of one material by several sets of uvs are not "
                              "supported: TEXCOORD_0 is used, not 1");
}

/* Pictures in a buffer and in a data URI, PNG and JPEG, look as those in files do. */
static void pictures_in_memory(void **state)
{
    (void)state;
    static const char *const NAMES[] = {"p.png", "p.jpg"};
    for (int i = 0; i < 2; i++) {
        char others[256];
        size_t size;
        write_triangle();
        write_picture(NAMES[i]);
        unsigned char *bytes = read_bytes(in_folder(NAMES[i]), &size);
        snprintf(others, sizeof others, "'textures': [{'source': 0}], 'images': [{'uri': '%s'}],", NAMES[i]);
        reading r = gltf_read(material_text("{'normalTexture': {'index': 0}}", others));
        assert_int_equal(r.status, AG_OK);
        rgb expected = value_at(&r, only_material(&r)->normal_map_texture, 0.25f, 0.5f);
        reading_destroy(&r);

        char *text =
            json_text("{" GLTF_ASSET "'buffers': [{'uri': 'triangle.bin', 'byteLength': 36}, {'uri': 'all.bin',"
                      "'byteLength': 0000000}], 'bufferViews': [{'buffer': 0, 'byteLength': 36},"
                      "{'buffer': 1, 'byteLength': 0000000}]," GLTF_TRIANGLE_ACCESSOR
                      "'textures': [{'source': 0}], 'images': [{'bufferView': 1, 'mimeType': 'image/png'}],"
                      "'materials': [{'normalTexture': {'index': 0}}],"
                      "'meshes': [{'primitives': [{'material': 0, 'attributes': {'POSITION': 0}}]}],"
                      "'nodes': [{'mesh': 0}]}");
        for (char *zeros = strstr(text, "0000000"); zeros; zeros = strstr(text, "0000000")) {
            char number[8];
            snprintf(number, sizeof number, "%7zu", size);
            memcpy(zeros, number, 7);
        }
        write_file("all.bin", bytes, size);
        r = gltf_read(text);
        assert_int_equal(r.status, AG_OK);
        rgb value = value_at(&r, only_material(&r)->normal_map_texture, 0.25f, 0.5f);
        assert_rgb(value, expected.r, expected.g, expected.b, 0);
        reading_destroy(&r);

        /* cut short, or damaged in the middle, it is an error or another picture, but no crash */
        for (size_t end = 0; end < size; end += 1 + size / 97) {
            write_file("all.bin", bytes, size);
            FILE *file = fopen(in_folder("all.bin"), "r+b");
            assert_non_null(file);
            assert_int_equal(fseek(file, (long)end, SEEK_SET), 0);
            for (size_t k = end; k < size; k++)
                fputc(0, file);
            fclose(file);
            r = gltf_read(text);
            assert_int_equal(r.count[AG_LOG_ERROR], r.status == AG_OK ? 0 : 1);
            reading_destroy(&r);
        }
        free(text);
        free(bytes);
    }
    reading r = gltf_read(material_text("{'normalTexture': {'index': 0}}",
                                        "'textures': [{'source': 0}], 'images': [{'uri': "
                                        "'data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6"
                                        "fptVAAAACklEQVR4nGP4DwABAQEAsTj2FAAAAABJRU5ErkJggg=='}],"));
    assert_int_equal(r.status, AG_OK);
    assert_rgb(value_at(&r, only_material(&r)->normal_map_texture, 0.25f, 0.5f), 1, 1, 1, 0);
    reading_destroy(&r);
}

static void warnings(void **state)
{
    (void)state;
    write_triangle();
    write_picture("p.png");
    gltf_expect_warning(
        material_text("{'extensions': {'KHR_materials_sheen': {}}}", ""),
        "materials[0].extensions.KHR_materials_sheen: the extension KHR_materials_sheen is not supported");
    gltf_expect_warning(material_text("{'pbrMetallicRoughness': {'metallicFactor': 1.5}}", ""),
                        "materials[0].pbrMetallicRoughness.metallicFactor: 1.5 is beyond [0, 1], and brought there");
    gltf_expect_warning(material_text("{'normalTexture': {'index': 0}}", "'textures': [{}],"),
                        "textures[0]: there is no picture in a known format: the texture is left out");
    gltf_expect_warning(material_text("{'extensions': {'KHR_materials_clearcoat': {'clearcoatFactor': 1,"
                                      "'clearcoatNormalTexture': {'index': 0}}}}",
                                      ONE_TEXTURE),
                        "clearcoatNormalTexture: normal maps of clearcoats are not supported");
}

static void material_errors(void **state)
{
    (void)state;
    static const struct {
        const char *material_json, *others, *error;
        ag_status status;
    } WRONG[] = {
        {"3", "", "materials[0]: should be an object, not an integer", AG_ERROR_SCENE},
        {"{'alphaMode': 'ODD'}", "", "materials[0].alphaMode: there is no alpha mode \"ODD\"", AG_ERROR_SCENE},
        {"{'pbrMetallicRoughness': {'baseColorFactor': [1, 1, 1]}}", "",
         "pbrMetallicRoughness.baseColorFactor: should have 4 numbers, but has 3", AG_ERROR_SCENE},
        {"{'doubleSided': 1, 'emissiveFactor': [1, 1, 1]}", "", "doubleSided: should be true or false, not an integer",
         AG_ERROR_SCENE},
        {"{'extensions': {'KHR_materials_ior': {'ior': 0.5}}}", "", "KHR_materials_ior.ior: 0.5 should be 0 or from 1",
         AG_ERROR_SCENE},
        {"{'extensions': {'KHR_materials_volume': {'attenuationDistance': 0}}}", "",
         "KHR_materials_volume.attenuationDistance: 0 should be above 0", AG_ERROR_SCENE},
        {"{'extensions': {'KHR_materials_ior': 2}}", "", "KHR_materials_ior: should be an object, not an integer",
         AG_ERROR_SCENE},
        {"{'emissiveFactor': [1e30, 0, 0], 'extensions': {'KHR_materials_emissive_strength': {'emissiveStrength': "
         "1e30}}}",
         "", "materials[0]: it shines brighter than a float can say", AG_ERROR_SCENE},
        {"{'normalTexture': {}}", "", "materials[0].normalTexture.index: is missing", AG_ERROR_SCENE},
        {"{'normalTexture': {'index': 0}}", "", "normalTexture.index: 0 is out of range: there are 0 textures",
         AG_ERROR_SCENE},
        {"{'normalTexture': {'index': 0}}", "'textures': [{'source': 0}],",
         "textures[0].source: 0 is out of range: there are 0 images", AG_ERROR_SCENE},
        {"{'normalTexture': {'index': 0, 'texCoord': 1e9}}", ONE_TEXTURE, "there is no TEXCOORD_1000000000",
         AG_ERROR_SCENE},
        {"{'normalTexture': {'index': 0, 'extensions': {'KHR_texture_transform': {'scale': [1e40, 1]}}}}", ONE_TEXTURE,
         "KHR_texture_transform: its numbers are too large", AG_ERROR_SCENE},
        {"{'normalTexture': {'index': 0}}", "'textures': [{'source': 0}], 'images': [{}],",
         "images[0]: has neither a uri nor a bufferView", AG_ERROR_SCENE},
        {"{'normalTexture': {'index': 0}}", "'textures': [{'source': 0}], 'images': [{'uri': 'none.png'}],",
         "images[0].uri: cannot read '", AG_ERROR_INPUT},
        {"{'normalTexture': {'index': 0}}", "'textures': [{'source': 0}], 'images': [{'bufferView': 1}],",
         "images[0].bufferView: 1 is out of range: there are 1 bufferViews", AG_ERROR_SCENE},
        {"{'normalTexture': {'index': 0}}", "'textures': [{'source': 0}], 'images': [{'bufferView': 0}],",
         "#images[0]': it is neither a PNG nor a JPEG picture", AG_ERROR_INPUT},
        {"{'normalTexture': {'index': 0}}", "'textures': [{'source': 0}], 'images': [{'uri': 'data:;base64,?'}],",
         "images[0].uri: the data URI holds what is not base64", AG_ERROR_SCENE},
        {"{'normalTexture': {'index': 0}}",
         "'samplers': [{'wrapS': 1}], 'textures': [{'source': 0, 'sampler': 0}],"
         "'images': [{'uri': 'p.png'}],",
         "samplers[0].wrapS: there is no wrap 1", AG_ERROR_SCENE},
    };
    write_triangle();
    write_picture("p.png");
    for (size_t i = 0; i < sizeof WRONG / sizeof *WRONG; i++)
        gltf_expect_error(material_text(WRONG[i].material_json, WRONG[i].others), WRONG[i].status, WRONG[i].error);
}

/* Glass without a volume is told of by name; in Blender's files, where it was solid, by a warning. */
static void thin_glass_is_told(void **state)
{
    (void)state;
    write_triangle();
    static const char GLASS[] = "{'name': 'Pane', 'extensions': {'KHR_materials_transmission': {'transmissionFactor': "
                                "1}%s}}",
                      SAID[] = "the glass of material \"Pane\" is a thin shell, which bends no light";
    char text[512];
    snprintf(text, sizeof text, GLASS, "");
    reading r = gltf_of(material_text(text, ""));
    expect_said(&r, AG_LOG_INFO, SAID);
    reading_destroy(&r);
    r = gltf_read(by_blender(material_text(text, "")));
    assert_int_equal(r.status, AG_OK);
    expect_said(&r, AG_LOG_WARNING, SAID);
    reading_destroy(&r);
    snprintf(text, sizeof text, GLASS, ", 'KHR_materials_volume': {'thicknessFactor': 1}");
    r = gltf_of(material_text(text, ""));
    assert_null(r.said[AG_LOG_INFO] ? strstr(r.said[AG_LOG_INFO], SAID) : NULL);
    reading_destroy(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(defaults),
        TEST_IN_FOLDER(factors),
        TEST_IN_FOLDER(alpha_modes),
        TEST_IN_FOLDER(emission),
        TEST_IN_FOLDER(specular_glossiness),
        TEST_IN_FOLDER(what_only_glows_does_not_replace_the_sky),
        TEST_IN_FOLDER(material_textures),
        TEST_IN_FOLDER(samplers_and_transforms),
        TEST_IN_FOLDER(uv_sets),
        TEST_IN_FOLDER(pictures_in_memory),
        TEST_IN_FOLDER(warnings),
        TEST_IN_FOLDER(thin_glass_is_told),
        TEST_IN_FOLDER(material_errors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
