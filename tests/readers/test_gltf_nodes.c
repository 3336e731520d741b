/* test_gltf_nodes.c: how nodes place meshes: transforms, instances, morph targets, skins; errors by their words, trees
 * of any depth. Threads: one. */
#define _POSIX_C_SOURCE 200809L
#include "fixtures/gltf_fixture.h"

static const mesh *only_mesh(const reading *r)
{
    assert_int_equal(r->scene->shape_count, 1);
    return &r->scene->shapes[0].as.mesh;
}

static reading placed(const char *nodes)
{
    char text[2048];
    snprintf(text, sizeof text,
             "{" GLTF_ASSET
             "'buffers': [{'uri': 'b.bin', 'byteLength': 72}], 'bufferViews': [{'buffer': 0, 'byteLength': 72}],"
             "'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 3, 'type': 'VEC3'},"
             "  {'bufferView': 0, 'byteOffset': 36, 'componentType': 5126, 'count': 3, 'type': 'VEC3'}],"
             "'meshes': [{'primitives': [{'attributes': {'POSITION': 0, 'NORMAL': 1}}]}], %s}",
             nodes);
    return gltf_read(text);
}

static void transforms(void **state)
{
    (void)state;
    static const struct {
        const char *nodes;
        double p1[3], p2[3], n[3]; /* of 1 0 0 and 0 1 0, and the normal 0 0 1 */
        bool flips;
    } RIGHT[] = {
        {"'nodes': [{'mesh': 0}]", {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, false},
        {"'nodes': [{'mesh': 0, 'translation': [1, 2, 3]}]", {2, 2, 3}, {1, 3, 3}, {0, 0, 1}, false},
        {"'nodes': [{'mesh': 0, 'scale': [2, 3, -4]}]", {2, 0, 0}, {0, 3, 0}, {0, 0, -1}, true},
        {"'nodes': [{'mesh': 0, 'scale': [-1, 1, 1]}]", {-1, 0, 0}, {0, 1, 0}, {0, 0, 1}, true},
        {"'nodes': [{'mesh': 0, 'scale': [1, 1, 0]}]", {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, false},
        /* a quarter turn about x, then what is above it */
        {"'nodes': [{'mesh': 0, 'rotation': [0.70710678, 0, 0, 0.70710678]}]", {1, 0, 0}, {0, 0, 1}, {0, -1, 0}, false},
        {"'nodes': [{'mesh': 0, 'rotation': [2, 0, 0, 2]}]", {1, 0, 0}, {0, 0, 1}, {0, -1, 0}, false},
        {"'nodes': [{'mesh': 0, 'translation': [0, 0, 7], 'rotation': [0, 0, 1, 1], 'scale': [2, 1, 1]}]",
         {0, 2, 7},
         {-1, 0, 7},
         {0, 0, 1},
         false},
        {"'nodes': [{'children': [1], 'scale': [2, 2, 2]}, {'mesh': 0, 'translation': [1, 0, 0]}]",
         {4, 0, 0},
         {2, 2, 0},
         {0, 0, 1},
         false},
        {"'nodes': [{'mesh': 0, 'matrix': [0, 1, 0, 0,  0, 0, 1, 0,  1, 0, 0, 0,  5, 6, 7, 1]}]",
         {5, 7, 7},
         {5, 6, 8},
         {1, 0, 0},
         false},
        {"'nodes': [{'mesh': 0, 'matrix': [1, 0, 0, 0,  0, 1, 0, 0,  1, 0, 1, 0,  0, 0, 0, 1]}]",
         {1, 0, 0},
         {0, 1, 0},
         {0, 0, 1},
         false},
        {"'scene': 1, 'scenes': [{'nodes': [0]}, {'nodes': [1]}],"
         "'nodes': [{'mesh': 0}, {'mesh': 0, 'translation': [0, 0, 1]}]",
         {1, 0, 1},
         {0, 1, 1},
         {0, 0, 1},
         false},
    };
    blob b = {.size = 0};
    BLOB_PUT(&b, (float[]){0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 1});
    write_blob("b.bin", &b);
    for (size_t i = 0; i < sizeof RIGHT / sizeof *RIGHT; i++) {
        reading r = placed(RIGHT[i].nodes);
        assert_int_equal(r.status, AG_OK);
        const mesh *m = only_mesh(&r);
        assert_vec3(m->positions[1], RIGHT[i].p1[0], RIGHT[i].p1[1], RIGHT[i].p1[2], 1e-6);
        assert_vec3(m->positions[2], RIGHT[i].p2[0], RIGHT[i].p2[1], RIGHT[i].p2[2], 1e-6);
        assert_vec3(m->normals[0], RIGHT[i].n[0], RIGHT[i].n[1], RIGHT[i].n[2], 1e-6);
        assert_true(r.scene->shapes[0].flip_normal == RIGHT[i].flips);
        reading_destroy(&r);
    }
    reading r = placed("'nodes': [{'mesh': 0}, {'mesh': 0, 'translation': [0, 0, 1]}]");
    assert_int_equal(r.scene->shape_count, 2);
    reading_destroy(&r);
}

/* A mesh of 30000 triangles, of which one shines, used three times: an object and three instances of what is dark, and
 * copies of what shines. Used twice, or with a weight of its own, it is copied. */
static void instances(void **state)
{
    (void)state;
    enum { TRIANGLES = 30000 };
    write_triangle();
    unsigned char *indices = malloc(3 * TRIANGLES);
    assert_non_null(indices);
    for (int i = 0; i < 3 * TRIANGLES; i++)
        indices[i] = (unsigned char)(i % 3);
    write_file("indices.bin", indices, 3 * TRIANGLES);
    free(indices);
    static const char TEXT[] =
        "{" GLTF_ASSET
        "'buffers': [{'uri': 'triangle.bin', 'byteLength': 36}, {'uri': 'indices.bin', 'byteLength': 90000}],"
        "'bufferViews': [{'buffer': 0, 'byteLength': 36}, {'buffer': 1, 'byteLength': 90000}],"
        "'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 3, 'type': 'VEC3'},"
        "  {'bufferView': 1, 'componentType': 5121, 'count': 90000, 'type': 'SCALAR'}],"
        "'materials': [{}, {'emissiveFactor': [1, 1, 1]}], 'meshes': [{'primitives': ["
        "  {'attributes': {'POSITION': 0}, 'indices': 1, 'material': 0}, {'attributes': {'POSITION': 0}, 'material': "
        "1}]}],"
        "'nodes': [{'mesh': 0}, {'mesh': 0, 'translation': [0, 0, 1]}, {%s 'scale': [-2, 1, 1], 'translation': [5, 0, "
        "0]}]}";
    char text[2048];
    snprintf(text, sizeof text, TEXT, "'mesh': 0,");
    reading r = gltf_of(text);
    const scene *s = r.scene;
    assert_int_equal(s->object_count, 1);
    assert_int_equal(s->instance_count, 3);
    assert_int_equal(s->shape_count, 4);
    assert_int_equal(s->light_count, 3);
    for (uint32_t i = 0; i < 4; i++)
        assert_int_equal(s->shapes[i].object_index, s->shapes[i].as.mesh.triangle_count > 1 ? 0 : SCENE_NO_OBJECT);
    affine last = instance_at(s, 2, 0.0f);
    assert_vec3(affine_point(&last, vec3_make(1, 0, 0)), 3, 0, 0, 0);
    assert_vec3(s->shapes[s->lights[2].as.area.shape_index].as.mesh.positions[1], 3, 0, 0, 0);
    assert_true(s->shapes[s->lights[2].as.area.shape_index].flip_normal);
    reading_destroy(&r);
    static const char *const COPIED[] = {"", "'mesh': 0, 'weights': [1],"};
    for (int i = 0; i < 2; i++) {
        snprintf(text, sizeof text, TEXT, COPIED[i]);
        r = gltf_of(text);
        assert_int_equal(r.scene->instance_count, 0);
        assert_int_equal(r.scene->shape_count, 4 + 2 * i);
        reading_destroy(&r);
    }
    snprintf(text, sizeof text, TEXT, "'mesh': 0, 'matrix': [0,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],"); /* not by scale */
    r = gltf_of(text); /* flat: no instance can be, and there is nothing to see */
    assert_int_equal(r.scene->instance_count, 2);
    reading_destroy(&r);
}

/* Two morph targets, of which the node's or else the mesh's weights say how much is added. */
static void morph_targets(void **state)
{
    (void)state;
    blob b = {.size = 0};
    BLOB_PUT(&b, (float[]){0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 1});
    BLOB_PUT(&b, (float[]){0, 0, 2, 0, 0, 2, 0, 0, 4, 4, 0, 0, 8, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0});
    write_blob("b.bin", &b);
    static const char TEXT[] =
        "{" GLTF_ASSET
        "'buffers': [{'uri': 'b.bin', 'byteLength': 180}], 'bufferViews': [{'buffer': 0, 'byteLength': 180}],"
        "'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 3, 'type': 'VEC3'},"
        "  {'bufferView': 0, 'byteOffset': 36, 'componentType': 5126, 'count': 3, 'type': 'VEC3'},"
        "  {'bufferView': 0, 'byteOffset': 72, 'componentType': 5126, 'count': 3, 'type': 'VEC3'},"
        "  {'bufferView': 0, 'byteOffset': 108, 'componentType': 5126, 'count': 3, 'type': 'VEC3'},"
        "  {'bufferView': 0, 'byteOffset': 144, 'componentType': 5126, 'count': 3, 'type': 'VEC3'},"
        "  {'bufferView': 0, 'componentType': 5126, 'count': 2, 'type': 'VEC3'}],"
        "'meshes': [{%s 'primitives': [{'attributes': {'POSITION': 0, 'NORMAL': 1},"
        "  'targets': [{'POSITION': %s}, {'POSITION': 3, 'NORMAL': 4}]}]}], 'nodes': [{'mesh': 0 %s}]}";
    static const struct {
        const char *mesh_weights, *node_weights;
        double first, second;
    } WEIGHTS[] = {
        {"", "", 0, 0},
        {"'weights': [0.5, 0],", "", 0.5, 0},
        {"'weights': [0.5, 0.25],", "", 0.5, 0.25},
        {"'weights': [0.5, 0.25],", ", 'weights': [0, 1]", 0, 1},
        {"", ", 'weights': [1]", 1, 0},
    };
    char text[2048];
    for (size_t i = 0; i < sizeof WEIGHTS / sizeof *WEIGHTS; i++) {
        const double f = WEIGHTS[i].first, s = WEIGHTS[i].second;
        snprintf(text, sizeof text, TEXT, WEIGHTS[i].mesh_weights, "2", WEIGHTS[i].node_weights);
        reading r = gltf_of(text);
        const mesh *m = only_mesh(&r);
        assert_vec3(m->positions[0], 4 * s, 0, 2 * f, 1e-6);
        assert_vec3(m->positions[1], 1 + 8 * s, 0, 2 * f, 1e-6);
        assert_vec3(m->positions[2], 0, 1, 4 * f, 1e-6);
        assert_vec3(m->normals[0], s / sqrt(s * s + 1), 0, 1 / sqrt(s * s + 1), 1e-6);
        assert_vec3(m->normals[2], 0, 0, 1, 1e-6);
        reading_destroy(&r);
    }
    snprintf(text, sizeof text, TEXT, "'weights': ['x'],", "2", "");
    gltf_expect_error(text, AG_ERROR_SCENE, "meshes[0].weights[0]: should be a number");
    snprintf(text, sizeof text, TEXT, "'weights': [1],", "5", "");
    gltf_expect_error(text, AG_ERROR_SCENE, "primitives[0].targets[0].POSITION: it has 2 elements, but POSITION has 3");
}

/* Three vertices: of one joint, of the other, and half and half of both, in weights that do not add up to 1. The joints
 * alone say where the mesh is; the node that has it does not. */
static void skins(void **state)
{
    (void)state;
    blob b = {.size = 0};
    BLOB_PUT(&b, (float[]){0, 0, 0, 1, 0, 0, 0, 1, 0});
    BLOB_PUT(&b, (float[]){1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1}); /* inverse bind: back by 1 */
    BLOB_PUT(&b, (float[]){1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    BLOB_PUT(&b, (float[]){1, 0, 0, 0, 0, 1, 0, 0, 2, 2, 0, 0});
    BLOB_PUT(&b, (unsigned char[]){0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 9, 9});
    write_blob("b.bin", &b);
    static const char TEXT[] =
        "{" GLTF_ASSET
        "'buffers': [{'uri': 'b.bin', 'byteLength': 224}], 'bufferViews': [{'buffer': 0, 'byteLength': 224}],"
        "'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 3, 'type': 'VEC3'},"
        "  {'bufferView': 0, 'byteOffset': 36, 'componentType': 5126, 'count': %d, 'type': 'MAT4'},"
        "  {'bufferView': 0, 'byteOffset': 164, 'componentType': 5126, 'count': 3, 'type': 'VEC4'},"
        "  {'bufferView': 0, 'byteOffset': 212, 'componentType': 5121, 'count': 3, 'type': 'VEC4'}],"
        "'meshes': [{'primitives': [{'attributes': {'POSITION': 0, 'JOINTS_0': 3, 'WEIGHTS_0': 2}}]}],"
        "'skins': [{'joints': [%s] %s}], 'nodes': [{'mesh': 0, 'skin': 0, 'translation': [9, 9, 9]}, {'children': [2],"
        "  'translation': [1, 0, 5]}, {'scale': [3, 3, 3]}]}";
    char text[2048];
    snprintf(text, sizeof text, TEXT, 2, "1, 2", ", 'inverseBindMatrices': 1");
    reading r = gltf_of(text);
    const mesh *m = only_mesh(&r);
    assert_vec3(m->positions[0], 0, 0, 5, 1e-6);   /* 0 - 1 + 1 */
    assert_vec3(m->positions[1], 4, 0, 5, 1e-6);   /* 3 times 1, + 1 */
    assert_vec3(m->positions[2], 0.5, 2, 5, 1e-6); /* between 0 1 5 and 1 3 5 */
    reading_destroy(&r);
    snprintf(text, sizeof text, TEXT, 2, "1, 2", "");
    r = gltf_of(text);
    assert_vec3(only_mesh(&r)->positions[0], 1, 0, 5, 1e-6);
    reading_destroy(&r);
    snprintf(text, sizeof text, TEXT, 2, "1", "");
    gltf_expect_error(text, AG_ERROR_SCENE, "attributes: JOINTS_0: vertex 1 has joint 1, but the skin has 1");
    snprintf(text, sizeof text, TEXT, 1, "1, 2", ", 'inverseBindMatrices': 1");
    gltf_expect_error(text, AG_ERROR_SCENE, "skins[0].inverseBindMatrices: it has 1 elements, but there are 2 joints");
    snprintf(text, sizeof text, TEXT, 2, "1, 7", "");
    gltf_expect_error(text, AG_ERROR_SCENE, "skins[0].joints[1]: 7 is out of range: there are 3 nodes");
    snprintf(text, sizeof text, TEXT, 2, "", "");
    gltf_expect_error(text, AG_ERROR_SCENE, "skins[0].joints: there are 0, which should be from 1 to 65535");
}

static void node_errors(void **state)
{
    (void)state;
    static const struct {
        const char *nodes, *error;
    } WRONG[] = {
        {"'nodes': [{'mesh': 1}]", "nodes[0].mesh: 1 is out of range: there are 1 meshes"},
        {"'nodes': [{'children': [1]}]", "nodes[0].children[0]: 1 is out of range: there are 1 nodes"},
        {"'nodes': [{'children': [0]}]", "nodes[0]: it is among its own children, or theirs"},
        {"'nodes': [{'children': [1]}, {'children': [2]}, {'children': [1]}]",
         "nodes[2].children[0]: nodes[1] is a child of nodes[0] already"},
        {"'nodes': [{}, {'children': [2]}, {'children': [1]}]", "nodes[1]: it is among its own children, or theirs"},
        {"'nodes': [{'children': [2]}, {'children': [2]}, {}]",
         "nodes[1].children[0]: nodes[2] is a child of nodes[0] already"},
        {"'scenes': [{'nodes': [1]}], 'nodes': [{'children': [1]}, {}]",
         "scenes[0].nodes[0]: nodes[1] is no root: it is a child of nodes[0]"},
        {"'scenes': [{'nodes': [0, 0]}], 'nodes': [{}]", "scenes[0].nodes[0]: nodes[0] is named twice"},
        {"'scene': 1, 'scenes': [{}]", "scene: 1 is out of range: there are 1 scenes"},
        {"'nodes': [{'matrix': [1, 0, 0]}]", "nodes[0].matrix: should have 16 numbers, but has 3"},
        {"'nodes': [{'matrix': [1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,'1']}]",
         "nodes[0].matrix[15]: should be a number, not a string"},
        {"'nodes': [{'matrix': [1,0,0,1,0,1,0,0,0,0,1,0,0,0,0,1]}]", "nodes[0].matrix: its last row should be 0 0 0 1"},
        {"'nodes': [{'rotation': [0, 0, 0, 0]}]",
         "nodes[0].rotation: is no rotation: the quaternion's length is not 1"},
        {"'nodes': [{'scale': 2}]", "nodes[0].scale: should be an array, not an integer"},
        {"'nodes': [{'camera': 0}]", "nodes[0].camera: 0 is out of range: there are 0 cameras"},
        {"'nodes': [{'extensions': {'KHR_lights_punctual': {'light': 0}}}]",
         "nodes[0].extensions.KHR_lights_punctual.light: 0 is out of range: there are 0 lights"},
        {"'nodes': [7]", "nodes[0]: should be an object, not an integer"},
    };
    for (size_t i = 0; i < sizeof WRONG / sizeof *WRONG; i++) {
        reading r = placed(WRONG[i].nodes);
        expect_said(&r, AG_LOG_ERROR, WRONG[i].error);
        assert_int_equal(r.status, AG_ERROR_SCENE);
        reading_destroy(&r);
    }
}

/* A deep tree of nodes is read without recursion, in time proportional to its size. */
static void deep_tree(void **state)
{
    (void)state;
    enum { DEPTH = 30000 };
    char *text = malloc(DEPTH * 48 + 1024), *end = text;
    assert_non_null(text);
    end += sprintf(end, "{" GLTF_ASSET "'nodes': [");
    for (int i = 0; i < DEPTH; i++)
        end += sprintf(end, "{'children':[%d],'translation':[0,0,1]},", i + 1);
    sprintf(end, "{'camera': 0}], 'cameras': [{'type': 'perspective', 'perspective': {'yfov': 1}}]}");
    reading r = gltf_of(text);
    assert_near(r.scene->camera.world_from_camera.m[2][3], DEPTH, 0);
    reading_destroy(&r);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(transforms), TEST_IN_FOLDER(instances),   TEST_IN_FOLDER(morph_targets),
        TEST_IN_FOLDER(skins),      TEST_IN_FOLDER(node_errors), TEST_IN_FOLDER(deep_tree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
