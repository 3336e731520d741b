/* test_scene_names.c: what pbrt, glTF, OBJ and PLY files call materials, shapes and objects reaches the scene.
 * Threads: one. */
#define _GNU_SOURCE
#include "fixtures/gltf_fixture.h"
#include "fixtures/model_fixture.h"

static void expect_name(const scene *s, scene_named kind, uint32_t index, const char *expected)
{
    const char *name = scene_name(s, kind, index);
    if (!name || !expected ? name != expected : strcmp(name, expected) != 0)
        fail_msg("name %u of kind %d is %s, not %s", index, (int)kind, name ? name : "none",
                 expected ? expected : "none");
}

static void test_by_hand(void **state)
{
    (void)state;
    scene *s = scene_create();
    assert_non_null(s);
    expect_name(s, NAMED_SHAPE, 0, NULL);
    assert_int_equal(scene_set_name(s, NAMED_SHAPE, 40, "far"), AG_OK);
    assert_int_equal(scene_set_name(s, NAMED_SHAPE, 2, "first"), AG_OK);
    assert_int_equal(scene_set_name(s, NAMED_SHAPE, 2, "second"), AG_OK);
    assert_int_equal(scene_set_name(s, NAMED_SHAPE, 2, ""), AG_OK);
    assert_int_equal(scene_set_name(s, NAMED_SHAPE, 3, NULL), AG_OK);
    expect_name(s, NAMED_SHAPE, 2, "second");
    expect_name(s, NAMED_SHAPE, 3, NULL);
    expect_name(s, NAMED_SHAPE, 40, "far");
    expect_name(s, NAMED_SHAPE, UINT32_MAX, NULL);
    expect_name(s, NAMED_OBJECT, 2, NULL);
    scene_destroy(s);
}

static void test_pbrt(void **state)
{
    (void)state;
    model_write_text("t.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                              "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                              "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    char text[1024];
    snprintf(
        text, sizeof text,
        "WorldBegin MakeNamedMaterial \"clay\" \"string type\" \"diffuse\" NamedMaterial \"clay\" Shape \"sphere\" "
        "ObjectBegin \"tree\" Shape \"disk\" ObjectEnd Shape \"plymesh\" \"string filename\" \"%s\"",
        in_folder("t.ply"));
    reading r = reading_of(text);
    const scene *s = r.scene;
    expect_name(s, NAMED_MATERIAL, s->shapes[0].material_index, "clay");
    expect_name(s, NAMED_SHAPE, 0, NULL);
    expect_name(s, NAMED_OBJECT, 0, "tree");
    expect_name(s, NAMED_SHAPE, 2, in_folder("t.ply"));
    reading_destroy(&r);
}

static void test_gltf(void **state)
{
    (void)state;
    write_triangle();
    reading r = gltf_of("{" GLTF_ASSET GLTF_TRIANGLE "'materials': [{'name': 'brass'}],"
                        "'meshes': [{'name': 'bell', 'primitives': [{'attributes': {'POSITION': 0}, 'material': 0}]}],"
                        "'nodes': [{'mesh': 0, 'name': 'church'}, {'mesh': 0}]}");
    const scene *s = r.scene;
    assert_int_equal(s->shape_count, 2);
    expect_name(s, NAMED_SHAPE, 0, "church");
    expect_name(s, NAMED_SHAPE, 1, "bell"); /* of a node without a name: its mesh's */
    expect_name(s, NAMED_MATERIAL, s->shapes[0].material_index, "brass");
    reading_destroy(&r);
}

static void test_obj(void **state)
{
    (void)state;
    model_write_text("m.mtl", "newmtl red\nKd 1 0 0\n");
    reading r = model_quietly("m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n");
    expect_name(r.scene, NAMED_MATERIAL, r.scene->shapes[0].material_index, "red");
    reading_destroy(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_by_hand),
        TEST_IN_FOLDER(test_pbrt),
        TEST_IN_FOLDER(test_gltf),
        TEST_IN_FOLDER(test_obj),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
