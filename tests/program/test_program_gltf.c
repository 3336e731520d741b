/* test_program_gltf.c: glTF files through the whole program: a room whose radiance is known, and one without closed
 * form that photon map and path tracer show alike; the picture's size; what the program says of files that are wrong.
 * Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/gltf_file.h"
#include "fixtures/program_picture.h"

enum { BLOCK = 8 };

/* A cube from -1 to 1 in all axes without normals, its triangles facing outwards or inwards: 6 times 6 indices in the
 * order -x +x -y +y -z +z, the outward ones first. */
static void write_cube(void)
{
    blob b = {.size = 0};
    for (int i = 0; i < 8; i++)
        BLOB_PUT(&b, (float[]){i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f, i & 4 ? 1.0f : -1.0f});
    for (int inwards = 0; inwards < 2; inwards++)
        for (int axis = 0; axis < 3; axis++)
            for (int side = 0; side < 2; side++) {
                const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3, base = side << axis;
                const bool turn = (side == 0) != (inwards == 1);
                const int quad[4] = {base, base | (turn ? v : u), base | u | v, base | (turn ? u : v)};
                const int corners[6] = {0, 1, 2, 0, 2, 3};
                for (int c = 0; c < 6; c++)
                    BLOB_PUT(&b, (uint16_t[]){(uint16_t)quad[corners[c]]});
            }
    write_blob("cube.bin", &b);
}

/* accessors: 0 positions, 1 all outwards, 2 all inwards, 3 to 8 each inward side. */
#define CUBE                                                                                                           \
    "'buffers': [{'uri': 'cube.bin', 'byteLength': 240}], 'bufferViews': [{'buffer': 0, 'byteLength': 96},"            \
    "{'buffer': 0, 'byteOffset': 96, 'byteLength': 144}], 'accessors': ["                                              \
    "{'bufferView': 0, 'componentType': 5126, 'count': 8, 'type': 'VEC3'},"                                            \
    "{'bufferView': 1, 'componentType': 5123, 'count': 36, 'type': 'SCALAR'},"                                         \
    "{'bufferView': 1, 'byteOffset': 72, 'componentType': 5123, 'count': 36, 'type': 'SCALAR'},"                       \
    "{'bufferView': 1, 'byteOffset': 72, 'componentType': 5123, 'count': 6, 'type': 'SCALAR'},"                        \
    "{'bufferView': 1, 'byteOffset': 84, 'componentType': 5123, 'count': 6, 'type': 'SCALAR'},"                        \
    "{'bufferView': 1, 'byteOffset': 96, 'componentType': 5123, 'count': 6, 'type': 'SCALAR'},"                        \
    "{'bufferView': 1, 'byteOffset': 108, 'componentType': 5123, 'count': 6, 'type': 'SCALAR'},"                       \
    "{'bufferView': 1, 'byteOffset': 120, 'componentType': 5123, 'count': 6, 'type': 'SCALAR'},"                       \
    "{'bufferView': 1, 'byteOffset': 132, 'componentType': 5123, 'count': 6, 'type': 'SCALAR'}],"

static const char *write_scene(const char *text)
{
    char *json = json_text(text);
    write_cube();
    write_file("t.gltf", json, strlen(json));
    free(json);
    return in_folder("t.gltf");
}

/* All walls emit 0.5 from their inner side alone and reflect half of what comes, diffusely: radiance is 0.5 / (1 - 0.5)
 * everywhere. The node mirrors, which keeps the inner side the inner one. */
static void furnace(void **state)
{
    (void)state;
    const char *scene = write_scene(
        "{" GLTF_ASSET CUBE "'materials': [{'emissiveFactor': [0.25, 0.25, 0.25], 'pbrMetallicRoughness': {"
        "'baseColorFactor': [0.5, 0.5, 0.5, 1], 'metallicFactor': 0}, 'extensions': {'KHR_materials_specular':"
        "{'specularFactor': 0}, 'KHR_materials_emissive_strength': {'emissiveStrength': 2}}}],"
        "'meshes': [{'primitives': [{'attributes': {'POSITION': 0}, 'indices': 2, 'material': 0}]}],"
        "'cameras': [{'type': 'perspective', 'perspective': {'yfov': 1.2, 'aspectRatio': 1}}],"
        "'nodes': [{'mesh': 0, 'scale': [-2, 1, 1.5]}, {'camera': 0, 'rotation': [0, 1, 0, 1]}]}");
    picture p = RENDER(scene, "--integrator=path", "--size=16x16", "--spp=64");
    expect_uniform("path", &p, 1.0, 0.01, 8, 0.03);
    picture_reset(&p);
    p = RENDER(scene, "--size=16x16", "--spp=16", "--photons=200000");
    expect_uniform("photon map", &p, 1.0, 0.02, 8, 0.05);
    picture_reset(&p);
}

/* A lamp of 2 W/sr two metres off lights a black-walled room's white far wall, seen straight on: 0.5 / pi in its
 * middle. */
static void point_lamp(void **state)
{
    (void)state;
    const char *scene = write_scene(
        "{" GLTF_ASSET CUBE "'extensions': {'KHR_lights_punctual': {'lights': [{'type': 'point', 'intensity': 2}]}},"
        "'materials': [{'pbrMetallicRoughness': {'metallicFactor': 0}, 'extensions': {'KHR_materials_specular':"
        "{'specularFactor': 0}}}],"
        "'meshes': [{'primitives': [{'attributes': {'POSITION': 0}, 'indices': 7, 'material': 0}]}],"
        "'cameras': [{'type': 'orthographic', 'orthographic': {'xmag': 0.02, 'ymag': 0.02, 'zfar': 9, 'znear': 0}}],"
        "'nodes': [{'mesh': 0}, {'camera': 0, 'translation': [0, 0, 1], 'extensions': {'KHR_lights_punctual':"
        "{'light': 0}}}]}");
    picture p = RENDER(scene, "--integrator=path", "--size=8x8", "--spp=16");
    expect_uniform("lamp", &p, 2.0 / 4.0 / 3.14159265358979323846, 1e-3, 8, 1e-3);
    picture_reset(&p);
}

/* A lamp of Blender's, 10 W or 10 W/m^2, in front of a white wall two metres off, in all ways that its exporters write
 * it: the wall's radiance is 10 / (4 pi) / 2^2 / pi, of a sun 10 / pi. Exporters of others mean what they write. */
static void lamp_units(void **state)
{
    (void)state;
    static const double PI_ = 3.14159265358979323846;
    static const struct {
        const char *generator, *option;
        double candela, lux; /* what a file by it has for 1 W and 1 W/m^2 */
    } WAYS[] = {
        {"Khronos glTF Blender I/O v3.4.50", "", 683 / (4 * 3.14159265358979323846), 683},
        {"Khronos glTF Blender I/O v3.6.27", "", 683 / (4 * 3.14159265358979323846), 683},
        {"Khronos glTF Blender I/O v4.2.57", "", 683 / (4 * 3.14159265358979323846), 683},
        {"Khronos glTF Blender I/O v3.3.36", "", 1, 1},
        {"Khronos glTF Blender I/O v1.8.19", "", 1, 1},
        {"THREE.GLTFExporter r160", "", 1 / (4 * 3.14159265358979323846), 1},
        {"Khronos glTF Blender I/O v3.4.50", "--gltf-light-units=unitless", 1 / (4 * 3.14159265358979323846), 1},
        {"Khronos glTF Blender I/O v3.4.50", "--gltf-light-units=raw", 1, 1},
        {"Khronos glTF Blender I/O v3.3.36", "--gltf-light-units=standard", 683 / (4 * 3.14159265358979323846), 683},
        {"Khronos glTF Blender I/O v4.2.57", "--gltf-light-units=auto", 683 / (4 * 3.14159265358979323846), 683},
    };
    static const char *const LAMPS[] = {"point", "spot", "directional"};
    for (size_t i = 0; i < sizeof WAYS / sizeof *WAYS; i++)
        for (int lamp = 0; lamp < 3; lamp++) {
            char text[2048];
            const bool is_sun = lamp == 2;
            snprintf(text, sizeof text,
                     "{'asset': {'version': '2.0', 'generator': '%s'}, " CUBE
                     "'extensions': {'KHR_lights_punctual': {'lights': [{'type': '%s', 'intensity': %.9g}]}},"
                     "'materials': [{'pbrMetallicRoughness': {'metallicFactor': 0}, 'extensions': {"
                     "'KHR_materials_specular': {'specularFactor': 0}}}],"
                     "'meshes': [{'primitives': [{'attributes': {'POSITION': 0}, 'indices': 7, 'material': 0}]}],"
                     "'cameras': [{'type': 'orthographic', 'orthographic': {'xmag': 0.02, 'ymag': 0.02, 'zfar': 9,"
                     "'znear': 0}}], 'nodes': [{'mesh': 0}, {'camera': 0, 'translation': [0, 0, 1],"
                     "'extensions': {'KHR_lights_punctual': {'light': 0}}}]}",
                     WAYS[i].generator, LAMPS[lamp], 10 * (is_sun ? WAYS[i].lux : WAYS[i].candela));
            const double expected = is_sun ? 10 / PI_ : 10 / (4 * PI_) / 4 / PI_;
            const char *scene = write_scene(text);
            picture p = WAYS[i].option[0] ? RENDER(scene, "--integrator=path", "--size=8x8", "--spp=16", WAYS[i].option)
                                          : RENDER(scene, "--integrator=path", "--size=8x8", "--spp=16");
            expect_uniform(WAYS[i].generator, &p, expected, 1e-3, 8, 1e-3);
            picture_reset(&p);
        }
}

/* A camera of the command line's instead of the file's, which looks away: the wall at its left alone shines. */
static void camera_of_the_command_line(void **state)
{
    (void)state;
    const char *scene = write_scene(
        "{" GLTF_ASSET CUBE "'materials': [{'emissiveFactor': [1, 1, 1]}],"
        "'meshes': [{'primitives': [{'attributes': {'POSITION': 0}, 'indices': 3, 'material': 0}]}],"
        "'cameras': [{'type': 'orthographic', 'orthographic': {'xmag': 0.02, 'ymag': 0.02, 'zfar': 9, 'znear': 0}}],"
        "'nodes': [{'mesh': 0}, {'camera': 0}]}");
    picture p = RENDER(scene, "--integrator=path", "--size=8x8", "--spp=16");
    expect_near("away", picture_mean(&p, 0) + 1.0, 1.0, 1e-6);
    picture_reset(&p);
    p = RENDER(scene, "--integrator=path", "--size=8x8", "--spp=16", "--camera-from=0.5,0,0", "--camera-to=-1,0,0",
               "--fov=30");
    expect_uniform("towards", &p, 1.0, 1e-6, 8, 1e-6);
    picture_reset(&p);
    /* along -z with the wall on the left: the left half of a view of 90 degrees from the wall's far end */
    p = RENDER(scene, "--integrator=path", "--size=8x8", "--spp=16", "--camera-from=0,0,1", "--camera-to=0,0,0",
               "--fov=89");
    assert_true(picture_block(&p, 0, 0, 4, 0) + picture_block(&p, 0, 4, 4, 0) > 0.5);
    assert_true(picture_block(&p, 4, 0, 4, 0) + picture_block(&p, 4, 4, 4, 0) < 1e-6);
    picture_reset(&p);
}

/* A wall that shines with 1, seen through a block that does not refract, two metres thick where half of the red and a
 * quarter of the green are left. */
static void volume(void **state)
{
    (void)state;
    const char *scene = write_scene(
        "{" GLTF_ASSET CUBE
        "'materials': [{'emissiveFactor': [1, 1, 1]}, {'pbrMetallicRoughness': {'metallicFactor': 0,"
        "'roughnessFactor': 0}, 'extensions': {'KHR_materials_transmission': {'transmissionFactor': 1},"
        "'KHR_materials_ior': {'ior': 1}, 'KHR_materials_volume': {'thicknessFactor': 1, 'attenuationDistance': 2,"
        "'attenuationColor': [0.5, 0.25, 1]}}}],"
        "'meshes': [{'primitives': [{'attributes': {'POSITION': 0}, 'indices': 7, 'material': 0}]},"
        "  {'primitives': [{'attributes': {'POSITION': 0}, 'indices': 1, 'material': 1}]}],"
        "'cameras': [{'type': 'orthographic', 'orthographic': {'xmag': 0.5, 'ymag': 0.5, 'zfar': 9, 'znear': 0}}],"
        "'nodes': [{'mesh': 0, 'translation': [0, 0, -4]}, {'mesh': 1, 'scale': [-1, 1, 1]},"
        "  {'camera': 0, 'translation': [0, 0, 5]}]}");
    picture p = RENDER(scene, "--integrator=path", "--size=8x8", "--spp=16");
    expect_near("red", picture_mean(&p, 0), 0.5, 1e-3);
    expect_near("green", picture_mean(&p, 1), 0.25, 1e-3);
    expect_near("blue", picture_mean(&p, 2), 1.0, 1e-3);
    picture_reset(&p);
}

/* Plastic walls in three colours, a lamp under the ceiling that shines down alone, a small one beside it, and two
 * turned boxes of rough metal, the second a mirror image. */
static const char ROOM[] =
    "{" GLTF_ASSET CUBE
    "'extensions': {'KHR_lights_punctual': {'lights': [{'type': 'point', 'intensity': 0.3, 'color': [1, 0.6, 0.3]}]}},"
    "'materials': ["
    "{'pbrMetallicRoughness': {'baseColorFactor': [0.6, 0.6, 0.55, 1], 'metallicFactor': 0, 'roughnessFactor': 0.8}},"
    "{'pbrMetallicRoughness': {'baseColorFactor': [0.6, 0.2, 0.15, 1], 'metallicFactor': 0, 'roughnessFactor': 0.6}},"
    "{'pbrMetallicRoughness': {'baseColorFactor': [0.15, 0.3, 0.6, 1], 'metallicFactor': 0, 'roughnessFactor': 0.6}},"
    "{'emissiveFactor': [1, 0.95, 0.8], 'extensions': {'KHR_materials_emissive_strength': {'emissiveStrength': 5}},"
    "  'pbrMetallicRoughness': {'baseColorFactor': [0, 0, 0, 1], 'metallicFactor': 0}},"
    "{'pbrMetallicRoughness': {'baseColorFactor': [0.8, 0.6, 0.4, 1], 'metallicFactor': 1, 'roughnessFactor': 0.5}}],"
    "'meshes': [{'primitives': [{'attributes': {'POSITION': 0}, 'indices': 3, 'material': 1},"
    "  {'attributes': {'POSITION': 0}, 'indices': 4, 'material': 2}, {'attributes': {'POSITION': 0}, 'indices': 5, "
    "'material': 0},"
    "  {'attributes': {'POSITION': 0}, 'indices': 6, 'material': 0}, {'attributes': {'POSITION': 0}, 'indices': 7, "
    "'material': 0},"
    "  {'attributes': {'POSITION': 0}, 'indices': 8, 'material': 0}]},"
    "  {'primitives': [{'attributes': {'POSITION': 0}, 'indices': 6, 'material': 3}]},"
    "  {'primitives': [{'attributes': {'POSITION': 0}, 'indices': 1, 'material': 4}]}],"
    "'cameras': [{'type': 'perspective', 'perspective': {'yfov': 0.9, 'aspectRatio': 1}}],"
    "'nodes': [{'children': [1, 2, 3, 4, 5], 'translation': [0, 1, 0]}, {'mesh': 0, 'scale': [1.3, 1, 2.5]},"
    "  {'mesh': 1, 'scale': [0.7, 1, 0.7], 'translation': [0, -0.05, 0]},"
    "  {'camera': 0, 'translation': [0, 0, 2.4]},"
    "  {'mesh': 2, 'scale': [0.3, 0.5, 0.3], 'translation': [-0.5, -0.5, -0.4], 'rotation': [0, 0.2, 0, 0.98]},"
    "  {'mesh': 2, 'scale': [-0.3, 0.25, 0.3], 'translation': [0.5, -0.75, 0.1], 'rotation': [0, -0.3, 0, 0.95],"
    "    'children': [6]},"
    "  {'translation': [0, 3, 0], 'extensions': {'KHR_lights_punctual': {'light': 0}}}]}";

static double block_luminance(const picture *p, int x, int y)
{
    return 0.2126 * picture_block(p, x, y, BLOCK, 0) + 0.7152 * picture_block(p, x, y, BLOCK, 1) +
           0.0722 * picture_block(p, x, y, BLOCK, 2);
}

static void room_by_both_integrators(void **state)
{
    (void)state;
    const char *scene = write_scene(ROOM);
    picture map = RENDER(scene, "--size=48x48", "--photons=1e6", "--nearest=30", "--spp=16", "--gather-samples=16");
    picture path = RENDER(scene, "--size=48x48", "--integrator=path", "--spp=256");
    double sum[2] = {0.0, 0.0}, error = 0.0;
    int count = 0, odd = 0;
    for (int y = 0; y < 48; y += BLOCK)
        for (int x = 0; x < 48; x += BLOCK, count++) {
            double a = block_luminance(&map, x, y), b = block_luminance(&path, x, y);
            sum[0] += a;
            sum[1] += b;
            error += fabs(a - b) / b;
            odd += fabs(a - b) > 0.05 * b;
        }
    print_message("mean %+.2f %%, blocks %.2f %% apart, %d of %d by more than 5 %%\n", 100.0 * (sum[0] / sum[1] - 1.0),
                  100.0 * error / count, odd, count);
    expect_near("mean", sum[0], sum[1], 0.01);
    assert_true(error / count < 0.02);
    assert_true(odd <= 2);
    picture_reset(&map);
    picture_reset(&path);
}

/* Where the arguments give no size, the picture's follows from the camera's proportions. */
static void picture_size(void **state)
{
    (void)state;
    const char *scene =
        write_scene("{" GLTF_ASSET CUBE "'meshes': [{'primitives': [{'attributes': {'POSITION': 0}, 'indices': 1}]}],"
                    "'cameras': [{'type': 'perspective', 'perspective': {'yfov': 1, 'aspectRatio': 4}}],"
                    "'nodes': [{'mesh': 0}, {'camera': 0, 'translation': [0, 0, 5]}]}");
    picture p = RENDER(scene, "--integrator=path", "--spp=1");
    assert_int_equal(p.width, 1280);
    assert_int_equal(p.height, 320);
    assert_true(picture_block(&p, 636, 156, 8, 0) > 0.0); /* by the light that is made where there is none */
    picture_reset(&p);
}

static void errors_end_the_program(void **state)
{
    (void)state;
    write_scene("{" GLTF_ASSET "'nodes': [{'mesh': 3}]}");
    program_run run = program_execute(NULL, ARGUMENTS("--progress=none", "-o", "x.exr", "t.gltf"));
    expect_exit(&run, 1);
    assert_string_equal(run.err, "t.gltf:1:50: error: nodes[0].mesh: 3 is out of range: there are 0 meshes\n");
    program_run_reset(&run);
    write_file("t.glb", "glTF\2\0\0\0\377\0\0\0", 12);
    run = program_execute(NULL, ARGUMENTS("-o", "x.exr", "t.glb"));
    expect_exit(&run, 1);
    assert_non_null(strstr(run.err, "t.glb: error: the binary file is cut short"));
    program_run_reset(&run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(furnace),      TEST_IN_FOLDER(point_lamp),
        TEST_IN_FOLDER(lamp_units),   TEST_IN_FOLDER(camera_of_the_command_line),
        TEST_IN_FOLDER(volume),       TEST_IN_FOLDER(room_by_both_integrators),
        TEST_IN_FOLDER(picture_size), TEST_IN_FOLDER(errors_end_the_program),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
