/* test_gltf_textures.c: textures and emission as they come out in the scene; samplers and transforms; pictures from
 * files, data URIs and buffers. Threads: one. */
#define _POSIX_C_SOURCE 200809L
#include "fixtures/gltf_material.h"
#include "rays/rays.h"

/* The value that a texture of the scene has at uv. */
static rgb value_at(const reading *r, uint32_t texture_index, float u, float v)
{
    surface_hit hit;
    memset(&hit, 0, sizeof hit);
    hit.uv = (vec2){u, v};
    assert_true(texture_index < r->scene->textures.count);
    return texture_evaluate_rgb(&r->scene->textures, texture_index, &hit);
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
    assert_rgb(value_at(&r, r.scene->lights[0].as.area.radiance_texture, u, v), red, green, blue, close);
    assert_rgb(value_at(&r, m->normal_map_texture, u, v), 0.2, 0.4, 0.6, close);
    assert_near(m->normal_scale, 0.5, 0);
    assert_near(value_at(&r, m->metallic_texture, u, v).r, 0.6, close);
    assert_near(value_at(&r, m->roughness_texture, u, v).r, 0.4, close);
    assert_near(value_at(&r, m->transmission_texture, u, v).r, 0.2, close);
    assert_near(value_at(&r, m->specular_texture, u, v).r, 0.8, close);
    assert_near(value_at(&r, m->clearcoat_texture, u, v).r, 0.2, close);
    assert_near(value_at(&r, m->clearcoat_roughness_texture, u, v).r, 0.4, close);
    assert_near(value_at(&r, r.scene->shapes[0].alpha_texture, u, v).r, 0.4, close); /* times the factor's */
    assert_int_equal(r.scene->textures.image_count, 2);                              /* once for each encoding */
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
    if (image_file_write(NULL, in_folder("q.png"), &description, pixels, message, sizeof message) != AG_OK)
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(what_only_glows_does_not_replace_the_sky),
        TEST_IN_FOLDER(material_textures),
        TEST_IN_FOLDER(samplers_and_transforms),
        TEST_IN_FOLDER(uv_sets),
        TEST_IN_FOLDER(pictures_in_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
