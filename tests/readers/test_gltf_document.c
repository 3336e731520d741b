/* test_gltf_document.c: the containers, syntax, versions, extensions and data URIs of glTF: what is right reads alike
 * whatever way it is packed, what is wrong is an error that says where; files cut short or damaged at every byte, and
 * documents with odd values in every field, end in a status. Threads: one. */
#define _POSIX_C_SOURCE 200809L
#include "fixtures/gltf_fixture.h"

#include <jansson.h>

static const char MINIMAL[] = "{" GLTF_ASSET GLTF_TRIANGLE
                              "'meshes': [{'primitives': [{'attributes': {'POSITION': 0}}]}], 'nodes': [{'mesh': 0}]}";

static void minimal_document(void **state)
{
    (void)state;
    write_triangle();
    reading r = gltf_of(MINIMAL);
    assert_int_equal(r.scene->shape_count, 1);
    assert_int_equal(r.scene->shapes[0].as.mesh.vertex_count, 3);
    assert_true(r.scene->has_camera);
    assert_int_equal(r.scene->light_count, 2);
    expect_said(&r, AG_LOG_INFO, "the file has no camera");
    expect_said(&r, AG_LOG_INFO, "the file has no light");
    reading_destroy(&r);
    r = gltf_of("\xef\xbb\xbf{'asset': {'version': '2.0'}}");
    assert_int_equal(r.scene->shape_count, 0);
    reading_destroy(&r);
}

static void put_u32(blob *b, uint32_t value)
{
    unsigned char bytes[4] = {(unsigned char)value, (unsigned char)(value >> 8), (unsigned char)(value >> 16),
                              (unsigned char)(value >> 24)};
    blob_put(b, bytes, 4);
}

/* A binary file with the triangle in its BIN chunk; a chunk that nobody knows comes between. */
static blob make_container(const char *text)
{
    blob b = {.size = 0};
    char *json = json_text(text);
    uint32_t json_size = ((uint32_t)strlen(json) + 3) / 4 * 4, offset;
    blob_put(&b, "glTF", 4);
    put_u32(&b, 2);
    put_u32(&b, 12 + 8 + json_size + 8 + 4 + 8 + 36);
    put_u32(&b, json_size);
    blob_put(&b, "JSON", 4);
    offset = (uint32_t)blob_put(&b, json, strlen(json));
    while (b.size < offset + json_size)
        blob_put(&b, " ", 1);
    put_u32(&b, 4);
    blob_put(&b, "ODD ", 4);
    put_u32(&b, 7);
    put_u32(&b, 36);
    blob_put(&b, "BIN", 4);
    BLOB_PUT(&b, (float[]){0, 0, 0, 1, 0, 0, 0, 1, 0});
    free(json);
    return b;
}

#define IN_CHUNK                                                                                                       \
    "'buffers': [{'byteLength': 36}], 'bufferViews': [{'buffer': 0, 'byteLength': 36}], " GLTF_TRIANGLE_ACCESSOR       \
    "'meshes': [{'primitives': [{'attributes': {'POSITION': 0}}]}], 'nodes': [{'mesh': 0}]}"

static void binary_file(void **state)
{
    (void)state;
    blob b = make_container("{" GLTF_ASSET IN_CHUNK);
    write_blob("scene.gltf", &b); /* told by what it is, not by its name */
    reading r = gltf_read_file("scene.gltf");
    assert_int_equal(r.status, AG_OK);
    assert_int_equal(r.scene->shape_count, 1);
    assert_vec3(r.scene->shapes[0].as.mesh.positions[1], 1, 0, 0, 0);
    reading_destroy(&r);

    /* cut short anywhere, it is an error that says so */
    for (size_t size = 4; size < b.size; size++) {
        write_file("t.glb", b.bytes, size);
        r = gltf_read_file("t.glb");
        assert_int_equal(r.status, AG_ERROR_SCENE);
        expect_said(&r, AG_LOG_ERROR, "the binary file is cut short: it has ");
        assert_int_equal(r.count[AG_LOG_ERROR], 1);
        reading_destroy(&r);
    }
}

static void binary_file_errors(void **state)
{
    (void)state;
    static const struct {
        size_t offset;
        unsigned char value;
        const char *error;
    } DAMAGES[] = {
        {4, 1, "the binary file is of version 1; known is 2"},
        {16, 'X', "the first chunk of the binary file is not its JSON"},
        {14, 1, "a chunk of the binary file has "},
        {20, '[', "t.glb:1:"},
    };
    const blob whole = make_container("{" GLTF_ASSET IN_CHUNK);
    for (size_t i = 0; i < sizeof DAMAGES / sizeof *DAMAGES; i++) {
        blob b = whole;
        b.bytes[DAMAGES[i].offset] = DAMAGES[i].value;
        write_blob("t.glb", &b);
        reading r = gltf_read_file("t.glb");
        expect_said(&r, AG_LOG_ERROR, DAMAGES[i].error);
        assert_int_equal(r.status, AG_ERROR_SCENE);
        reading_destroy(&r);
    }
}

/* Every byte turned over: some of it cannot be told from what is right, none of it may crash. */
static void damaged_binary_file(void **state)
{
    (void)state;
    const blob whole = make_container("{" GLTF_ASSET IN_CHUNK);
    for (size_t i = 0; i < whole.size; i++) {
        blob b = whole;
        b.bytes[i] ^= 0xff;
        write_blob("t.glb", &b);
        reading r = gltf_read_file("t.glb");
        assert_int_equal(r.count[AG_LOG_ERROR], r.status == AG_OK ? 0 : 1);
        reading_destroy(&r);
    }
}

static void syntax_errors(void **state)
{
    (void)state;
    reading r = gltf_read("{\n  'asset': {'version': '2.0'},\n  'nodes': [1, 2,, 3]\n}\n");
    assert_int_equal(r.status, AG_ERROR_SCENE);
    expect_said(&r, AG_LOG_ERROR,
                "/t.gltf:3:18: error: unexpected token near ','\n      \"nodes\": [1, 2,, 3]\n"
                "                     ^");
    reading_destroy(&r);
    gltf_expect_error("", AG_ERROR_SCENE, "t.gltf:1:1: error: ");
    gltf_expect_error("{'asset': {'version': '2.0'}", AG_ERROR_SCENE,
                      "t.gltf:1:28: error: '}' expected near end of file");
    gltf_expect_error("{'asset': {'version': '2.0'}} more", AG_ERROR_SCENE, "end of file expected");
    gltf_expect_error("{'a': 1e999}", AG_ERROR_SCENE, "t.gltf:1:11: error: real number overflow");
    gltf_expect_error("[]", AG_ERROR_SCENE, "t.gltf:1:1: error: the document: should be an object");
    r = gltf_read_file("none.gltf");
    assert_int_equal(r.status, AG_ERROR_INPUT);
    expect_said(&r, AG_LOG_ERROR, "none.gltf: error: cannot read the file: No such file or directory");
    reading_destroy(&r);
}

static void versions_and_extensions(void **state)
{
    (void)state;
    gltf_expect_error("{}", AG_ERROR_SCENE, "t.gltf:1:1: error: asset: is missing");
    gltf_expect_error("{'asset': 2}", AG_ERROR_SCENE, "asset: should be an object, not an integer");
    gltf_expect_error("{'asset': {}}", AG_ERROR_SCENE, "asset.version: is missing");
    gltf_expect_error("{'asset': {'version': 2.0}}", AG_ERROR_SCENE, "asset.version: should be a string, not a number");
    gltf_expect_error("{'asset': {'version': '1.0'}}", AG_ERROR_SCENE, "asset: it is glTF 1.0; known is 2.0");
    gltf_expect_error("{'asset': {'version': '2.1', 'minVersion': '2.1'}}", AG_ERROR_SCENE,
                      "asset: it needs glTF 2.1; known is 2.0");
    gltf_expect_error("{" GLTF_ASSET "'extensionsRequired': ['KHR_mesh_quantization', 'KHR_draco_mesh_compression']}",
                      AG_ERROR_SCENE,
                      "extensionsRequired[1]: the file needs the extension KHR_draco_mesh_compression, which is not "
                      "supported");
    gltf_expect_error("{" GLTF_ASSET "'extensionsUsed': [3]}", AG_ERROR_SCENE, "extensionsUsed[0]: should be a string");
    gltf_expect_error("{" GLTF_ASSET "'extensionsUsed': {}}", AG_ERROR_SCENE,
                      "extensionsUsed: should be an array, not an object");
    gltf_expect_warning("{" GLTF_ASSET "'extensionsUsed': ['EXT_odd', 'KHR_texture_transform', 'EXT_odd']}",
                        "extensionsUsed[0]: the extension EXT_odd is not supported, and ignored");
    gltf_expect_warning("{" GLTF_ASSET "'extensionsRequired': ['KHR_materials_dispersion'], "
                        "'extensionsUsed': ['KHR_materials_dispersion']}",
                        "extensionsRequired[0]: the extension KHR_materials_dispersion is not supported, and ignored");
    gltf_expect_error("{" GLTF_ASSET "'nodes': 3}", AG_ERROR_SCENE, "nodes: should be an array, not an integer");
    gltf_expect_warning("{" GLTF_ASSET "'animations': [{}]}", "animations: animations are not supported");
}

/* A document whose only buffer is as given. */
static const char *with_buffer(const char *buffer)
{
    static char text[2048];
    snprintf(text, sizeof text,
             "{" GLTF_ASSET "'buffers': [%s], 'bufferViews': [{'buffer': 0, 'byteLength': 36}], " GLTF_TRIANGLE_ACCESSOR
             "'meshes': [{'primitives': [{'attributes': {'POSITION': 0}}]}], 'nodes': [{'mesh': 0}]}",
             buffer);
    return text;
}

static void uris(void **state)
{
    (void)state;
    static const char *const RIGHT[] = {
        ("{'byteLength': 36, 'uri': "
         "'data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA'}"),
        "{'byteLength': 36, 'uri': 'data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAA=='}",
        "{'byteLength': 36, 'uri': 'a%20triangle%c3%a4.bin'}",
        "{'byteLength': 36, 'uri': 'a triangleä.bin'}",
        "{'byteLength': 36, 'uri': './a%20triangleä.bin'}",
        "{'byteLength': 36, 'uri': '100%.bin'}",
    };
    write_triangle();
    assert_int_equal(rename(in_folder("triangle.bin"), in_folder("a triangleä.bin")), 0);
    write_triangle();
    assert_int_equal(rename(in_folder("triangle.bin"), in_folder("100%.bin")), 0);
    for (size_t i = 0; i < sizeof RIGHT / sizeof *RIGHT; i++) {
        reading r = gltf_of(with_buffer(RIGHT[i]));
        assert_vec3(r.scene->shapes[0].as.mesh.positions[0], 0, 0, 0, 0);
        assert_vec3(r.scene->shapes[0].as.mesh.positions[1], 1, 0, 0, 0);
        assert_vec3(r.scene->shapes[0].as.mesh.positions[2], 0, 1, 0, 0);
        reading_destroy(&r);
    }
    write_triangle();
    static const struct {
        const char *buffer, *error;
        ag_status status;
    } WRONG[] = {
        {"{'byteLength': 36, 'uri': 'none.bin'}", "buffers[0].uri: cannot read '", AG_ERROR_INPUT},
        {"{'byteLength': 36, 'uri': '.'}", "Is a directory", AG_ERROR_INPUT},
        {"{'byteLength': 37, 'uri': 'triangle.bin'}", "triangle.bin' has 36 bytes of the 37 that byteLength says",
         AG_ERROR_SCENE},
        {"{'byteLength': 36, 'uri': ''}", "buffers[0].uri: it is empty", AG_ERROR_SCENE},
        {"{'byteLength': 36, 'uri': 'http://x/y.bin'}", "it has a scheme", AG_ERROR_SCENE},
        {"{'byteLength': 36, 'uri': 'data:text/plain,AAAA'}", "the data URI is not in base64", AG_ERROR_SCENE},
        {"{'byteLength': 36, 'uri': 'data:;base64,AA*A'}", "the data URI holds what is not base64", AG_ERROR_SCENE},
        {"{'byteLength': 36, 'uri': 'data:;base64,AAAA'}", "it has 3 bytes of the 36 that byteLength says",
         AG_ERROR_SCENE},
        {"{'byteLength': 0, 'uri': 'triangle.bin'}", "buffers[0]: its byteLength is 0", AG_ERROR_SCENE},
        {"{'byteLength': -1, 'uri': 'triangle.bin'}", "byteLength: -1 should be an integer from 0 to 2^53",
         AG_ERROR_SCENE},
        {"{'byteLength': 1.5, 'uri': 'triangle.bin'}", "byteLength: 1.5 should be an integer", AG_ERROR_SCENE},
        {"{'byteLength': 35, 'uri': 'triangle.bin'}",
         "bufferViews[0]: bytes 0 to 36 reach beyond the buffer, which has 35", AG_ERROR_SCENE},
        {"{'uri': 'triangle.bin'}", "buffers[0].byteLength: is missing", AG_ERROR_SCENE},
        {"{'byteLength': 36}", "buffers[0]: has no uri, nor the file a BIN chunk", AG_ERROR_SCENE},
        {"{'byteLength': 36, 'uri': 7}", "buffers[0].uri: should be a string, not an integer", AG_ERROR_SCENE},
        {"3", "buffers[0]: should be an object, not an integer", AG_ERROR_SCENE},
    };
    for (size_t i = 0; i < sizeof WRONG / sizeof *WRONG; i++)
        gltf_expect_error(with_buffer(WRONG[i].buffer), WRONG[i].status, WRONG[i].error);
}

/* Errors stand at the line and column of the value, or of what it is missing from. */
static void errors_name_line_and_column(void **state)
{
    (void)state;
    gltf_expect_error("{\n  'asset': {'version': '2.0'},\n  'x': [{'nodes': 1}, \"}\", 1e3, null],\n"
                      "  'nodes': [{}, {\n\t'mesh': 3}]}",
                      AG_ERROR_SCENE, "t.gltf:5:10: error: nodes[1].mesh: 3 is out of range");
    gltf_expect_error(
        "{'asset': {'version': '2.0'},\n 'nodes': [{'name': '\xc3\xa4\\\\', 'rotation': [0, 0, 'x', 1]}]}",
        AG_ERROR_SCENE, "t.gltf:2:47: error: nodes[0].rotation[2]: should be a number");
    gltf_expect_error("{'asset': {'version': '2.0'},\n 'meshes': [ {'primitives': [ {}]}],\n 'nodes': [{'mesh': 0}]}",
                      AG_ERROR_SCENE, "t.gltf:2:31: error: meshes[0].primitives[0].attributes: is missing");
    gltf_expect_error("{'asset': {'version': '1.0'}, 'asset':\n {'version': '3.0'}}", AG_ERROR_SCENE,
                      "t.gltf:2:2: error: asset: it is glTF 3.0");
}

/* A document with most of what is read in it, but for textures: pictures would take most of the time. */
static const char RICH[] =
    "{" GLTF_ASSET "'scene': 0, 'scenes': [{'nodes': [0]}],"
    "'extensionsUsed': ['KHR_texture_transform'],"
    "'extensions': {'KHR_lights_punctual': {'lights': [{'type': 'spot', 'color': [1, 1, 0], 'intensity': 3,"
    "  'spot': {'innerConeAngle': 0.1, 'outerConeAngle': 0.2}}]}},"
    "'nodes': [{'children': [1, 2], 'rotation': [0, 0, 0, 1], 'scale': [1, 2, 1], 'translation': [0, 0, 1]},"
    "  {'mesh': 0, 'skin': 0, 'weights': [1], 'matrix': [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]},"
    "  {'camera': 0, 'extensions': {'KHR_lights_punctual': {'light': 0}}}],"
    "'cameras': [{'type': 'perspective', 'perspective': {'yfov': 0.7, 'aspectRatio': 1.5, 'znear': 0.1}}],"
    "'meshes': [{'weights': [0], 'primitives': [{'mode': 4, 'material': 0, 'indices': 1,"
    "  'attributes': {'POSITION': 0, 'NORMAL': 0, 'TEXCOORD_0': 2, 'JOINTS_0': 3, 'WEIGHTS_0': 4},"
    "  'targets': [{'POSITION': 0}]}]}], 'skins': [{'joints': [1, 2], 'inverseBindMatrices': 5}],"
    "'materials': [{'alphaMode': 'MASK', 'alphaCutoff': 0.4, 'doubleSided': true, 'emissiveFactor': [1, 1, 1],"
    "  'pbrMetallicRoughness': {'baseColorFactor': [1, 1, 1, 1], 'metallicFactor': 0.5, 'roughnessFactor': 0.5},"
    "  'extensions': {'KHR_materials_transmission': {'transmissionFactor': 0.5}, 'KHR_materials_ior': {'ior': 1.4},"
    "    'KHR_materials_volume': {'thicknessFactor': 1, 'attenuationDistance': 1, 'attenuationColor': [1, 0.5, 1]},"
    "    'KHR_materials_specular': {'specularFactor': 0.5, 'specularColorFactor': [1, 1, 1]},"
    "    'KHR_materials_clearcoat': {'clearcoatFactor': 0.5, 'clearcoatRoughnessFactor': 0.5},"
    "    'KHR_materials_emissive_strength': {'emissiveStrength': 2}}}],"
    "'accessors': [{'bufferView': 0, 'byteOffset': 0, 'componentType': 5126, 'normalized': false, 'count': 3,"
    "    'type': 'VEC3', 'sparse': {'count': 1, 'indices': {'bufferView': 1, 'byteOffset': 0, 'componentType': 5121},"
    "    'values': {'bufferView': 0, 'byteOffset': 0}}},"
    "  {'bufferView': 1, 'componentType': 5121, 'count': 3, 'type': 'SCALAR'},"
    "  {'bufferView': 0, 'componentType': 5126, 'count': 3, 'type': 'VEC2'},"
    "  {'componentType': 5121, 'count': 3, 'type': 'VEC4'}, {'componentType': 5126, 'count': 3, 'type': 'VEC4'},"
    "  {'bufferView': 3, 'componentType': 5126, 'count': 2, 'type': 'MAT4'}],"
    "'bufferViews': [{'buffer': 0, 'byteOffset': 0, 'byteLength': 36, 'byteStride': 12},"
    "  {'buffer': 1, 'byteLength': 3}, {'buffer': 0, 'byteLength': 36}, {'buffer': 2, 'byteLength': 128}],"
    "'buffers': [{'uri': 'triangle.bin', 'byteLength': 36}, {'uri': 'data:;base64,AAEC', 'byteLength': 3},"
    "  {'uri': 'matrices.bin', 'byteLength': 128}]}";

static const char TEXTURED[] =
    "{" GLTF_ASSET GLTF_TRIANGLE_BUFFER "'nodes': [{'mesh': 0}],"
    "'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 3, 'type': 'VEC3'},"
    "  {'bufferView': 0, 'componentType': 5126, 'count': 3, 'type': 'VEC2'}],"
    "'meshes': [{'primitives': [{'material': 0, 'attributes': {'POSITION': 0, 'TEXCOORD_0': 1}}]}],"
    "'materials': [{'normalTexture': {'index': 0, 'scale': 0.5, 'texCoord': 0, 'extensions': {'KHR_texture_transform':"
    "  {'offset': [0, 1], 'rotation': 1, 'scale': [2, 2], 'texCoord': 0}}}}],"
    "'textures': [{'source': 0, 'sampler': 0}], 'samplers': [{'magFilter': 9728, 'wrapS': 33071, 'wrapT': 33648}],"
    "'images': [{'uri': 'data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGP4DwABAQEA"
    "sTj2FAAAAABJRU5ErkJggg=='}]}";

typedef struct attempt {
    json_t *root;
    int count, refused;
} attempt;

static void try_document(attempt *a)
{
    char *text = json_dumps(a->root, JSON_COMPACT);
    assert_non_null(text);
    write_file("t.gltf", text, strlen(text));
    reading r = gltf_read_file("t.gltf");
    assert_int_equal(r.count[AG_LOG_ERROR], r.status == AG_OK ? 0 : 1);
    a->count++;
    a->refused += r.status != AG_OK;
    reading_destroy(&r);
    free(text);
}

/* Puts odd values instead of each value below. */
static void vary(attempt *a, json_t *container)
{
    static const char *const ODD[] = {"null", "-1", "4294967295", "1e300", "0.5", "\"odd\"", "[]", "{}", "[[0]]"};
    bool is_array = json_is_array(container);
    size_t index = 0;
    void *member = json_object_iter(container);
    while (is_array ? index < json_array_size(container) : member != NULL) {
        json_t *value = is_array ? json_array_get(container, index) : json_object_iter_value(member);
        json_incref(value);
        for (size_t i = 0; i < sizeof ODD / sizeof *ODD; i++) {
            json_t *odd = json_loads(ODD[i], JSON_DECODE_ANY, NULL);
            assert_non_null(odd);
            assert_int_equal(is_array ? json_array_set_new(container, index, odd)
                                      : json_object_iter_set_new(container, member, odd),
                             0);
            try_document(a);
        }
        assert_int_equal(is_array ? json_array_set_new(container, index, value)
                                  : json_object_iter_set_new(container, member, value),
                         0);
        if (json_is_object(value) || json_is_array(value))
            vary(a, value);
        if (is_array)
            index++;
        else
            member = json_object_iter_next(container, member);
    }
}

/* Reads the document with odd values in each of the members named, or in all. */
static void vary_document(const char *document, const char *const *members, int *out_count)
{
    char *text = json_text(document);
    attempt a = {json_loads(text, 0, NULL), 0, 0};
    assert_non_null(a.root);
    for (; members && *members; members++)
        vary(&a, json_object_get(a.root, *members));
    if (!members)
        vary(&a, a.root);
    assert_true(a.refused > a.count / 2); /* what is ignored, and numbers that will do, are not */
    *out_count = a.count;
    json_decref(a.root);
    free(text);
}

static void odd_values_everywhere(void **state)
{
    (void)state;
    int count;
    blob matrices = {.size = 0};
    for (int i = 0; i < 2; i++)
        BLOB_PUT(&matrices, (float[]){1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    write_blob("matrices.bin", &matrices);
    write_triangle();
    reading r = gltf_of(RICH);
    assert_int_equal(r.scene->shape_count, 1);
    assert_int_equal(r.scene->light_count, 2);
    reading_destroy(&r);
    vary_document(RICH, NULL, &count);
    assert_true(count > 1000);
    static const char *const MEMBERS[] = {"materials", "textures", "samplers", "images", NULL};
    vary_document(TEXTURED, MEMBERS, &count);
    assert_true(count > 100);
}

static void cancelled(void **state)
{
    (void)state;
    write_triangle();
    char *json = json_text(MINIMAL);
    write_file("t.gltf", json, strlen(json));
    free(json);
    run_context run;
    run_context_init(&run, NULL, NULL, NULL, NULL);
    run_cancel(&run);
    scene *s = scene_create();
    assert_int_equal(gltf_load_file(&run, in_folder("t.gltf"), s), AG_CANCELLED);
    scene_destroy(s);
    run_context_reset(&run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(errors_name_line_and_column),
        TEST_IN_FOLDER(minimal_document),
        TEST_IN_FOLDER(binary_file),
        TEST_IN_FOLDER(binary_file_errors),
        TEST_IN_FOLDER(damaged_binary_file),
        TEST_IN_FOLDER(syntax_errors),
        TEST_IN_FOLDER(versions_and_extensions),
        TEST_IN_FOLDER(uris),
        TEST_IN_FOLDER(odd_values_everywhere),
        TEST_IN_FOLDER(cancelled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
