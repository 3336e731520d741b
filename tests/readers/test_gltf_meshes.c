/* test_gltf_meshes.c: accessors of every kind, modes and indices: values as they come out in the scene, and every
 * error by its message. Threads: one. */
#define _POSIX_C_SOURCE 200809L
#include "fixtures/gltf_fixture.h"

#define SCENE_OF(primitive) "'meshes': [{'primitives': [" primitive "]}], 'nodes': [{'mesh': 0}]}"

static const mesh *only_mesh(const reading *r)
{
    assert_int_equal(r->scene->shape_count, 1);
    return &r->scene->shapes[0].as.mesh;
}

/* --- accessors --- */

/* The positions 0 0 0, 1 0 0, 0 1 0 in every type of component, normalised where it is an integer. */
static void component_types(void **state)
{
    (void)state;
    static const struct {
        int type;
        size_t size;
        bool is_normalized;
        int64_t one;
    } TYPES[] = {
        {5120, 1, true, 127},        {5121, 1, true, 255},         {5122, 2, true, 32767}, {5123, 2, true, 65535},
        {5125, 4, true, 4294967295}, {5126, 4, false, 0x3f800000}, {5120, 1, false, 1},    {5121, 1, false, 1},
        {5122, 2, false, 1},         {5123, 2, false, 1},          {5125, 4, false, 1},
    };
    for (size_t i = 0; i < sizeof TYPES / sizeof *TYPES; i++) {
        blob b = {.size = 0};
        char text[1024];
        for (int value = 0; value < 9; value++) {
            uint32_t bits = value == 3 || value == 7 ? (uint32_t)TYPES[i].one : 0;
            for (size_t k = 0; k < TYPES[i].size; k++)
                blob_put(&b, &(unsigned char){(unsigned char)(bits >> 8 * k)}, 1);
        }
        write_blob("b.bin", &b);
        snprintf(text, sizeof text,
                 "{" GLTF_ASSET "'buffers': [{'uri': 'b.bin', 'byteLength': %zu}],"
                 "'bufferViews': [{'buffer': 0, 'byteLength': %zu}], 'accessors': [{'bufferView': 0, 'type': 'VEC3',"
                 "'componentType': %d, 'normalized': %s, 'count': 3}]," SCENE_OF("{'attributes': {'POSITION': 0}}"),
                 b.size, b.size, TYPES[i].type, TYPES[i].is_normalized ? "true" : "false");
        reading r = gltf_of(text);
        const mesh *m = only_mesh(&r);
        assert_vec3(m->positions[0], 0, 0, 0, 0);
        assert_vec3(m->positions[1], 1, 0, 0, 0);
        assert_vec3(m->positions[2], 0, 1, 0, 0);
        reading_destroy(&r);
    }
}

/* -1 is what the lowest number of each signed type is, too: they have one more below zero. */
static void signed_integers(void **state)
{
    (void)state;
    blob b = {.size = 0};
    BLOB_PUT(&b, (float[]){0, 0, 0, 1, 0, 0, 0, 1, 0});
    BLOB_PUT(&b, (int8_t[]){-128, 127, 0, 99, -127, -127, 0, 99, 0, -64, 0, 99});
    write_blob("b.bin", &b);
    reading r =
        gltf_of("{" GLTF_ASSET "'buffers': [{'uri': 'b.bin', 'byteLength': 48}],"
                "'bufferViews': [{'buffer': 0, 'byteLength': 36},"
                "  {'buffer': 0, 'byteOffset': 36, 'byteLength': 12, 'byteStride': 4}],"
                "'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 3, 'type': 'VEC3'},"
                "  {'bufferView': 1, 'componentType': 5120, 'normalized': true, 'count': 3, 'type': 'VEC3'}]," SCENE_OF(
                    "{'attributes': {'POSITION': 0, 'NORMAL': 1}}"));
    const mesh *m = only_mesh(&r);
    assert_vec3(m->normals[0], -sqrt(0.5), sqrt(0.5), 0, 1e-7);
    assert_vec3(m->normals[1], -sqrt(0.5), -sqrt(0.5), 0, 1e-7);
    assert_vec3(m->normals[2], 0, -1, 0, 0);
    reading_destroy(&r);
}

/* Interleaved vertices: positions, normals and uvs at offsets of one view with a stride. */
static void strides_and_offsets(void **state)
{
    (void)state;
    blob b = {.size = 0};
    BLOB_PUT(&b, (float[]){99});
    BLOB_PUT(&b, (float[]){0, 0, 5, 0, 0, 2, 0.25f, 1});
    BLOB_PUT(&b, (float[]){1, 0, 5, 0, 3, 4, 0.5f, 0.75f});
    BLOB_PUT(&b, (float[]){0, 1, 5, 0, 0, 0, 0.75f, 0});
    write_blob("b.bin", &b);
    reading r =
        gltf_of("{" GLTF_ASSET "'buffers': [{'uri': 'b.bin', 'byteLength': 100}],"
                "'bufferViews': [{'buffer': 0, 'byteOffset': 4, 'byteLength': 96, 'byteStride': 32}],"
                "'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 3, 'type': 'VEC3'},"
                "  {'bufferView': 0, 'byteOffset': 12, 'componentType': 5126, 'count': 3, 'type': 'VEC3'},"
                "  {'bufferView': 0, 'byteOffset': 24, 'componentType': 5126, 'count': 3, 'type': 'VEC2'}]," SCENE_OF(
                    "{'attributes': {'POSITION': 0, 'NORMAL': 1, 'TEXCOORD_0': 2}}"));
    const mesh *m = only_mesh(&r);
    assert_vec3(m->positions[1], 1, 0, 5, 0);
    assert_vec3(m->normals[0], 0, 0, 1, 1e-7);
    assert_vec3(m->normals[1], 0, 0.6, 0.8, 1e-7);
    assert_vec3(m->normals[2], 0, 0, 0, 0);
    assert_near(m->uvs[0].x, 0.25, 0);
    assert_near(m->uvs[0].y, 0, 0); /* up the picture */
    assert_near(m->uvs[1].y, 0.25, 0);
    assert_near(m->uvs[2].y, 1, 0);
    reading_destroy(&r);
}

static void sparse_values(void **state)
{
    (void)state;
    blob b = {.size = 0};
    BLOB_PUT(&b, (float[]){0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
    BLOB_PUT(&b, (uint16_t[]){1, 3});
    BLOB_PUT(&b, (float[]){2, 0, 0, 0, 0, 2});
    BLOB_PUT(&b, (unsigned char[]){0, 1, 2, 0, 3, 1});
    write_blob("b.bin", &b);
    static const char TEXT[] =
        "{" GLTF_ASSET "'buffers': [{'uri': 'b.bin', 'byteLength': 82}],"
        "'bufferViews': [{'buffer': 0, 'byteLength': 48}, {'buffer': 0, 'byteOffset': 48, 'byteLength': 4},"
        "  {'buffer': 0, 'byteOffset': 52, 'byteLength': 24}, {'buffer': 0, 'byteOffset': 76, 'byteLength': 6}],"
        "'accessors': [{%s 'componentType': 5126, 'count': 4, 'type': 'VEC3', 'sparse': {'count': 2,"
        "    'indices': {'bufferView': 1, 'componentType': 5123}, 'values': {'bufferView': 2}}},"
        "  {'bufferView': 3, 'componentType': 5121, 'count': 6, 'type': 'SCALAR'}]," SCENE_OF(
            "{'attributes': {'POSITION': "
            "0}, 'indices': 1}");
    char text[2048];
    snprintf(text, sizeof text, TEXT, "'bufferView': 0,");
    reading r = gltf_of(text);
    const mesh *m = only_mesh(&r);
    assert_int_equal(m->vertex_count, 4);
    assert_int_equal(m->triangle_count, 2);
    assert_vec3(m->positions[0], 0, 0, 0, 0);
    assert_vec3(m->positions[1], 2, 0, 0, 0);
    assert_vec3(m->positions[2], 0, 1, 0, 0);
    assert_vec3(m->positions[3], 0, 0, 2, 0);
    reading_destroy(&r);
    snprintf(text, sizeof text, TEXT, ""); /* over zeros */
    r = gltf_of(text);
    m = only_mesh(&r);
    assert_int_equal(m->triangle_count, 1); /* 0 1 2 has no area */
    assert_vec3(m->positions[1], 2, 0, 0, 0);
    assert_vec3(m->positions[2], 0, 0, 0, 0);
    assert_vec3(m->positions[3], 0, 0, 2, 0);
    expect_said(&r, AG_LOG_INFO, "1 of 2 triangles have no area and are left out");
    reading_destroy(&r);
}

/* --- triangles --- */

/* Six vertices of a plane, z = 0: a strip up, all triangles of which face +z. */
static void put_strip(blob *b)
{
    BLOB_PUT(b, (float[]){0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0, 1, 2, 0});
    BLOB_PUT(b, (unsigned char[]){0, 1, 2, 2, 1, 3, 5, 4, 3, 2, 1, 0});
    BLOB_PUT(b, (uint16_t[]){0, 1, 3, 5, 4, 2});
    BLOB_PUT(b, (uint32_t[]){2, 3, 4, 0, 0, 0});
    write_blob("b.bin", b);
}

static const char *strip_text(const char *primitive)
{
    static char text[2048];
    snprintf(text, sizeof text,
             "{" GLTF_ASSET "'buffers': [{'uri': 'b.bin', 'byteLength': 120}],"
             "'bufferViews': [{'buffer': 0, 'byteLength': 72}, {'buffer': 0, 'byteOffset': 72, 'byteLength': 48}],"
             "'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 6, 'type': 'VEC3'},"
             "  {'bufferView': 1, 'componentType': 5121, 'count': 6, 'type': 'SCALAR'},"
             "  {'bufferView': 1, 'byteOffset': 6, 'componentType': 5121, 'count': 6, 'type': 'SCALAR'},"
             "  {'bufferView': 1, 'byteOffset': 12, 'componentType': 5123, 'count': 6, 'type': 'SCALAR'},"
             "  {'bufferView': 1, 'byteOffset': 24, 'componentType': 5125, 'count': 3, 'type': 'SCALAR'},"
             "  {'bufferView': 0, 'componentType': 5126, 'count': 6, 'type': 'SCALAR'},"
             "  {'bufferView': 0, 'componentType': 5120, 'count': 6, 'type': 'SCALAR'},"
             "  {'bufferView': 0, 'componentType': 5126, 'count': 5, 'type': 'VEC3'},"
             "  {'bufferView': 0, 'componentType': 5126, 'count': 6, 'type': 'MAT2'}]," SCENE_OF("%s"),
             primitive);
    return text;
}

static float facing_area(const mesh *m)
{
    float twice = 0.0f;
    for (uint32_t i = 0; i < m->triangle_count; i++) {
        vec3 p[3];
        for (int c = 0; c < 3; c++)
            p[c] = m->positions[m->indices[3 * i + (uint32_t)c]];
        twice += vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0])).z;
    }
    return 0.5f * twice;
}

static void modes_and_indices(void **state)
{
    (void)state;
    static const struct {
        const char *primitive;
        uint32_t triangles, vertices;
        double area; /* towards +z */
    } RIGHT[] = {
        {"{'attributes': {'POSITION': 0}}", 2, 6, 0.0}, /* 0 1 2, and 3 4 5 the other way round */
        {"{'attributes': {'POSITION': 0}, 'mode': 5}", 4, 6, 2.0},
        {"{'attributes': {'POSITION': 0}, 'indices': 1}", 2, 4, 1.0},
        {"{'attributes': {'POSITION': 0}, 'indices': 2, 'mode': 5}", 4, 6, 2.0},
        {"{'attributes': {'POSITION': 0}, 'indices': 3, 'mode': 6}", 3, 6, 2.0}, /* 4 2 0 has no area */
        {"{'attributes': {'POSITION': 0}, 'indices': 4}", 1, 3, 0.5}, /* of the vertices those in use are kept */
    };
    blob b = {.size = 0};
    put_strip(&b);
    for (size_t i = 0; i < sizeof RIGHT / sizeof *RIGHT; i++) {
        reading r = gltf_of(strip_text(RIGHT[i].primitive));
        const mesh *m = only_mesh(&r);
        assert_int_equal(m->triangle_count, RIGHT[i].triangles);
        assert_int_equal(m->vertex_count, RIGHT[i].vertices);
        assert_near(facing_area(m), RIGHT[i].area, 1e-6);
        assert_null(m->normals);
        assert_false(r.scene->shapes[0].flip_normal);
        reading_destroy(&r);
    }
    reading r = gltf_of(strip_text("{'attributes': {'POSITION': 0}, 'indices': 4}"));
    assert_vec3(only_mesh(&r)->positions[0], 0, 1, 0, 0);
    assert_vec3(only_mesh(&r)->positions[2], 0, 2, 0, 0);
    reading_destroy(&r);
}

static void what_is_no_surface(void **state)
{
    (void)state;
    static const char *const OTHERS[] = {"points", "lines", "line loops", "line strips"};
    blob b = {.size = 0};
    put_strip(&b);
    for (int mode = 0; mode < 4; mode++) {
        char primitive[256], warning[128];
        snprintf(primitive, sizeof primitive,
                 "{'attributes': {'POSITION': 0}, 'mode': %d}, {'attributes': {'POSITION': 0}, 'mode': %d}", mode,
                 mode);
        snprintf(warning, sizeof warning, "meshes[0].primitives[0].mode: %s have no surface, and are left out",
                 OTHERS[mode]);
        gltf_expect_warning(strip_text(primitive), warning);
    }
    gltf_expect_warning(strip_text("{'attributes': {}}"), "primitives[0].attributes: there is no POSITION");
    gltf_expect_warning(strip_text("{'attributes': {'POSITION': 7}}"), "5 vertices do not make whole triangles");
    gltf_expect_warning(strip_text("{'attributes': {'POSITION': 0, 'COLOR_0': 0}}"),
                        "COLOR_0: colours of vertices are not supported, and ignored");
}

static void mesh_errors(void **state)
{
    (void)state;
    static const struct {
        const char *primitive, *error;
    } WRONG[] = {
        {"3", "meshes[0].primitives[0]: should be an object, not an integer"},
        {"{}", "meshes[0].primitives[0].attributes: is missing"},
        {"{'attributes': {'POSITION': 17}}", "attributes.POSITION: 17 is out of range: there are 9 accessors"},
        {"{'attributes': {'POSITION': 1}}", "attributes.POSITION: accessors[1] is of type SCALAR, which does not fit"},
        {"{'attributes': {'POSITION': 8}}", "attributes.POSITION: accessors[8] is of type MAT2, which does not fit"},
        {"{'attributes': {'POSITION': 0, 'NORMAL': 7}}", "attributes.NORMAL: it has 5 elements, but POSITION has 6"},
        {"{'attributes': {'POSITION': 0}, 'mode': 7}", "primitives[0].mode: there is no mode 7"},
        {"{'attributes': {'POSITION': 0}, 'indices': 0}", "indices: accessors[0] is of type VEC3, which does not fit"},
        {"{'attributes': {'POSITION': 0}, 'indices': 5}", "primitives[0].indices: should be unsigned integers"},
        {"{'attributes': {'POSITION': 0}, 'indices': 6}", "primitives[0].indices: should be unsigned integers"},
        {"{'attributes': {'POSITION': 7}, 'indices': 2}",
         "indices: index 5 (element 0) is out of range: there are 5 vertices"},
        {"{'attributes': {'POSITION': 0}, 'material': 0}", "material: 0 is out of range: there are 0 materials"},
    };
    blob b = {.size = 0};
    put_strip(&b);
    for (size_t i = 0; i < sizeof WRONG / sizeof *WRONG; i++)
        gltf_expect_error(strip_text(WRONG[i].primitive), AG_ERROR_SCENE, WRONG[i].error);
    gltf_expect_error("{" GLTF_ASSET "'meshes': [{}], 'nodes': [{'mesh': 0}]}", AG_ERROR_SCENE,
                      "meshes[0].primitives: is missing");
}

static void accessor_errors(void **state)
{
    (void)state;
    static const struct {
        const char *view, *accessor, *error;
    } WRONG[] = {
        {"'byteLength': 36", "'componentType': 5126, 'type': 'VEC3'", "accessors[0].count: is missing"},
        {"'byteLength': 36", "'count': 3, 'type': 'VEC3'", "accessors[0].componentType: is missing"},
        {"'byteLength': 36", "'componentType': 5126, 'count': 3", "accessors[0].type: is missing"},
        {"'byteLength': 36", "'componentType': 5124, 'count': 3, 'type': 'VEC3'", "there is no component type 5124"},
        {"'byteLength': 36", "'componentType': 5126, 'count': 3, 'type': 'VEC5'", "there is no type \"VEC5\""},
        {"'byteLength': 36", "'componentType': 5126, 'count': 0, 'type': 'VEC3'",
         "its count is 0, which should be from 1"},
        {"'byteLength': 36", "'componentType': 5126, 'count': 4, 'type': 'VEC3'",
         "accessors[0]: its 4 elements take bytes 0 to 48 of the view, which has 36"},
        {"'byteLength': 36", "'componentType': 5126, 'count': 1000000000, 'type': 'VEC3'", "elements take bytes 0 to"},
        {"'byteLength': 36", "'componentType': 5126, 'count': 3, 'type': 'VEC3', 'byteOffset': 9007199254740992",
         "its 3 elements take bytes 9007199254740992 to"},
        {"'byteLength': 36, 'byteStride': 8", "'componentType': 5126, 'count': 3, 'type': 'VEC3'",
         "an element has 12 bytes, but the view's byteStride is 8"},
        {"'byteLength': 36, 'byteStride': 256", "'componentType': 5126, 'count': 3, 'type': 'VEC3'",
         "bufferViews[0]: its byteStride is 256; up to 252 are allowed"},
        {"'byteLength': 36, 'byteOffset': 1", "'componentType': 5126, 'count': 3, 'type': 'VEC3'",
         "bufferViews[0]: bytes 1 to 37 reach beyond the buffer, which has 36"},
        {"'byteLength': 9007199254740992, 'byteOffset': 9007199254740992",
         "'componentType': 5126, 'count': 3, 'type': 'VEC3'", "reach beyond the buffer, which has 36"},
        {"'byteLength': 36",
         "'componentType': 5126, 'count': 3, 'type': 'VEC3', 'sparse': {'count': 4, 'indices':"
         "{'bufferView': 0, 'componentType': 5121}, 'values': {'bufferView': 0}}",
         "accessors[0].sparse: its count is 4, but the accessor has 3 elements"},
        {"'byteLength': 36",
         "'componentType': 5126, 'count': 3, 'type': 'VEC3', 'sparse': {'count': 2, 'indices':"
         "{'bufferView': 0, 'componentType': 5121}, 'values': {'bufferView': 0}}",
         "sparse.indices: index 0 (element 1) is out of range, or does not rise"},
        {"'byteLength': 36",
         "'componentType': 5126, 'count': 3, 'type': 'VEC3', 'sparse': {'count': 2, 'indices':"
         "{'bufferView': 0, 'componentType': 5126}, 'values': {'bufferView': 0}}",
         "sparse.indices: should be unsigned integers"},
        {"'byteLength': 36", "'componentType': 5126, 'count': 3, 'type': 'VEC3', 'sparse': {'count': 2}",
         "accessors[0].sparse.indices: is missing"},
    };
    write_triangle();
    for (size_t i = 0; i < sizeof WRONG / sizeof *WRONG; i++) {
        char text[1024];
        snprintf(text, sizeof text,
                 "{" GLTF_ASSET
                 "'buffers': [{'uri': 'triangle.bin', 'byteLength': 36}], 'bufferViews': [{'buffer': 0, %s}],"
                 "'accessors': [{'bufferView': 0, %s}]," SCENE_OF("{'attributes': {'POSITION': 0}}"),
                 WRONG[i].view, WRONG[i].accessor);
        gltf_expect_error(text, AG_ERROR_SCENE, WRONG[i].error);
    }
    gltf_expect_error("{" GLTF_ASSET
                      "'accessors': [{'componentType': 5126, 'count': 1000000000, 'type': 'VEC3'}]," SCENE_OF(
                          "{'attributes': {'POSITION': 0}}"),
                      AG_ERROR_SCENE, "it has no bufferView, and 1000000000 elements are too many for that");
}

static void numbers_that_are_none(void **state)
{
    (void)state;
    blob b = {.size = 0};
    BLOB_PUT(&b, (float[]){0, 0, 0, 1, 0, NAN, 0, 1, 0});
    write_blob("triangle.bin", &b);
    gltf_expect_error("{" GLTF_ASSET GLTF_TRIANGLE SCENE_OF("{'attributes': {'POSITION': 0}}"), AG_ERROR_SCENE,
                      "POSITION: vertex 1 is not finite, or beyond 1e18 units in world space");
    write_triangle();
    gltf_expect_error("{" GLTF_ASSET GLTF_TRIANGLE "'meshes': [{'primitives': [{'attributes': {'POSITION': 0}}]}],"
                      "'nodes': [{'mesh': 0, 'scale': [1e19, 1, 1]}]}",
                      AG_ERROR_SCENE, "POSITION: vertex 1 is not finite, or beyond 1e18 units in world space");
    reading r = gltf_of("{" GLTF_ASSET GLTF_TRIANGLE "'meshes': [{'primitives': [{'attributes': {'POSITION': 0}}]}],"
                        "'nodes': [{'mesh': 0, 'scale': [0, 0, 0]}]}");
    assert_int_equal(r.scene->shape_count, 0); /* nodes are often hidden so */
    reading_destroy(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(component_types), TEST_IN_FOLDER(signed_integers),   TEST_IN_FOLDER(strides_and_offsets),
        TEST_IN_FOLDER(sparse_values),   TEST_IN_FOLDER(modes_and_indices), TEST_IN_FOLDER(what_is_no_surface),
        TEST_IN_FOLDER(mesh_errors),     TEST_IN_FOLDER(accessor_errors),   TEST_IN_FOLDER(numbers_that_are_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
