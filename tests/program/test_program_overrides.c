/* test_program_overrides.c: camera, sun and sky of the command line's through the whole program, for every format: as
 * bright as they say, from where they say, instead of what the file has.
 *
 * Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/environment_picture.h"
#include "fixtures/gltf_file.h"
#include "fixtures/program_picture.h"

static const double PI_D = 3.14159265358979323846;

#define PATH "--integrator=path", "--size=8x8", "--spp=4"
#define MAP                                                                                                            \
    "--photons=2000", "--caustic-photons=0", "--gather-samples=4", "--photon-aim=0", "--size=8x8", "--spp=4",          \
        "--noise=0"

/* A floor of grey 1/2 in each format. y is up. */
#define FLOOR_PBRT                                                                                                     \
    "Material \"diffuse\" \"rgb reflectance\" [.5 .5 .5] Shape \"bilinearmesh\" \"point3 P\" [-9 0 -9 9 0 -9 -9 0 9 "  \
    "9 0 9]\n"
static void write_floors(void)
{
    write_text("floor.pbrt", "LookAt 0 5 0 0 0 0 0 0 1 Camera \"perspective\" WorldBegin\n" FLOOR_PBRT);
    write_text("floor.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                            "property float z\nelement face 1\nproperty list uchar int vertex_index\n"
                            "end_header\n-9 0 9\n9 0 9\n9 0 -9\n-9 0 -9\n4 0 1 2 3\n");
    write_text("floor.mtl", "newmtl grey\nKd .5 .5 .5\n");
    write_text("floor.obj", "mtllib floor.mtl\nusemtl grey\nv -9 0 9\nv 9 0 9\nv 9 0 -9\nv -9 0 -9\nf 1 2 3 4\n");
    write_text("floor.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex -9 -9 0\nvertex 9 -9 0\nvertex 0 9 0\n"
                            "endloop\nendfacet\nendsolid a\n");
    blob b = {.size = 0};
    BLOB_PUT(&b, (float[]){-9, 0, 9, 9, 0, 9, 0, 0, -9});
    write_blob("floor.bin", &b);
    char *json = json_text(
        "{" GLTF_ASSET "'buffers': [{'uri': 'floor.bin', 'byteLength': 36}],"
        "'bufferViews': [{'buffer': 0, 'byteLength': 36}],"
        "'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 3, 'type': 'VEC3'}],"
        "'materials': [{'pbrMetallicRoughness': {'baseColorFactor': [0.5, 0.5, 0.5, 1], 'metallicFactor': 0},"
        "  'extensions': {'KHR_materials_ior': {'ior': 1}}}],"
        "'meshes': [{'primitives': [{'attributes': {'POSITION': 0}, 'material': 0}]}], 'nodes': [{'mesh': 0}]}");
    write_text("floor.gltf", json);
    free(json);
}

/* A sun of irradiance E at an elevation e shows a floor of reflectance 1/2 as E sin e / (2 pi), by both integrators,
 * whatever the format; nothing else lights it. */
static void a_sun_is_as_bright_as_it_says(void **state)
{
    (void)state;
    static const char *const FILES[] = {"floor.pbrt", "floor.ply", "floor.obj", "floor.gltf", "floor.stl"};
    const double reflectances[] = {0.5, 0.5, 0.5, 0.5, 1.0};    /* the last has no material */
    const double tolerances[] = {1e-5, 1e-5, 1e-5, 3e-3, 1e-5}; /* glTF's has a little of a highlight */
    write_floors();
    for (size_t k = 0; k < sizeof FILES / sizeof *FILES; k++) {
        const double expected = reflectances[k] * 5.0 * sin(25.0 * PI_D / 180.0) / PI_D;
        const bool is_pbrt = k == 0;
        picture p = RENDER(FILES[k], PATH, "--sun=77,25,5", "--camera-from=0,5,0", "--camera-to=0,0,0",
                           "--camera-up=0,0,1", is_pbrt ? "--up=y" : "--fov=10", "--fov=10");
        expect_uniform(FILES[k], &p, expected, tolerances[k], 8, tolerances[k]);
        picture_reset(&p);
        p = RENDER(FILES[k], MAP, "--sun=-283,25,5", "--camera-from=0,5,0", "--camera-to=0,0,0", "--camera-up=0,0,1",
                   "--up=y", "--fov=10");
        expect_uniform(FILES[k], &p, expected, tolerances[k], 8, tolerances[k]);
        picture_reset(&p);
    }
}

/* A sky of radiance L shows it as L / 2. */
static void a_sky_is_as_bright_as_it_says(void **state)
{
    (void)state;
    static const char *const FILES[] = {"floor.pbrt", "floor.ply", "floor.gltf"};
    write_floors();
    for (size_t k = 0; k < sizeof FILES / sizeof *FILES; k++) {
        picture p =
            RENDER(FILES[k], "--integrator=path", "--size=16x16", "--spp=64", "--sky=1,2,.5", "--sky-strength=1.5",
                   "--camera-from=0,5,0", "--camera-to=0,0,0", "--camera-up=0,0,1", "--fov=10");
        for (int c = 0; c < 3; c++) /* 16,384 samples of a variance below the square: sigma is below 0.8 % */
            expect_near(FILES[k], picture_mean(&p, c), 0.5 * 1.5 * (c == 0 ? 1.0 : c == 1 ? 2.0 : 0.5), 0.03);
        picture_reset(&p);
    }
}

/* The file's own light: lamp, point and sky, all of it far brighter than the sun that is asked for. */
static void what_the_file_has_is_dropped(void **state)
{
    (void)state;
    static const char WORLD[] = "LookAt 0 5 0 0 0 0 0 0 1 Camera \"perspective\" \"float fov\" 10 WorldBegin\n"
                                "LightSource \"infinite\" \"rgb L\" [7 7 7] LightSource \"point\" \"rgb I\" [99 9 9] "
                                "\"point3 from\" [0 3 0]\n"
                                "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [9 9 9] Translate 0 9 0\n"
                                "Shape \"sphere\" AttributeEnd\n" FLOOR_PBRT;
    write_text("lit.pbrt", WORLD);
    picture p = RENDER("lit.pbrt", PATH, "--no-lights", "--sun=0,90,2", "--up=y", "--sky=0");
    expect_near("the sun alone", picture_mean(&p, 0), 0.0, 1e-6); /* the lamp is in its way, as a dark ball */
    picture_reset(&p);
    p = RENDER("lit.pbrt", PATH, "--no-lights", "--sun=0,30,2", "--up=y");
    expect_uniform("the sun alone", &p, 0.5 * 2.0 * 0.5 / PI_D, 1e-5, 8, 1e-5);
    picture_reset(&p);
    /* the sky alone is replaced: the rest is as in a file without it */
    char without[sizeof WORLD];
    memcpy(without, WORLD, sizeof WORLD);
    char *sky = strstr(without, "LightSource \"infinite\"");
    memset(sky, ' ', strlen("LightSource \"infinite\" \"rgb L\" [7 7 7]"));
    write_text("no_sky.pbrt", without);
    p = RENDER("lit.pbrt", PATH, "--sky=0");
    picture q = RENDER("no_sky.pbrt", PATH);
    expect_near("a black sky instead of it", picture_mean(&p, 0), picture_mean(&q, 0), 0.1);
    assert_true(picture_mean(&p, 0) > 0.3);
    picture_reset(&p);
    picture_reset(&q);
    program_run run = RUN(PATH, "--no-lights", "-o", "x.exr", "lit.pbrt");
    expect_exit(&run, 0);
    expect_said(&run, "no light that emits");
    program_run_reset(&run);
}

/* A picture of the sky: a quarter of it around each point of the compass, with 1, 2, 3 and 4 from north over east; and
 * above the horizon 10 more. */
static const char *write_sky(void)
{
    float pixels[4][8][3];
    static const float QUARTERS[8] = {4, 1, 1, 2, 2, 3, 3, 4}; /* the left edge is the west, the middle the east */
    for (int y = 0; y < 4; y++)
        for (int x = 0; x < 8; x++)
            for (int c = 0; c < 3; c++)
                pixels[y][x][c] = QUARTERS[x] + (y < 2 ? 10.0f : 0.0f);
    return write_environment("sky.exr", 8, 4, IMAGE_FLOAT, &pixels[0][0][0]);
}

/* The part of the sky is seen that lies just above the horizon, or just below. */
static void a_sky_stands_where_it_should(void **state)
{
    (void)state;
    static const struct {
        const char *scene, *up, *north, *east, *below;
    } WAYS[] = {
        {"floor.ply", "--up=y", "--camera-to=100,20.1,-1", "--camera-to=101,20.1,0", "--camera-to=100,19.9,1"},
        {"floor.gltf", "--up=y", "--camera-to=100,20.1,-1", "--camera-to=101,20.1,0", "--camera-to=100,19.9,1"},
        {"floor.ply", "--up=z", "--camera-to=100,21,0.1", "--camera-to=101,20,.1", "--camera-to=100,19,-.1"},
        {"floor.pbrt", "--up=y", "--camera-to=100,20.1,1", "--camera-to=101,20.1,0", "--camera-to=100,19.9,-1"},
        {"mirrored.pbrt", "--up=z", "--camera-to=100,21,0.1", "--camera-to=101,20,.1", "--camera-to=100,19,-.1"},
        {"floor.pbrt", "--up=z", "--camera-to=100,21,0.1", "--camera-to=99,20,.1", "--camera-to=100,19,-.1"},
        {"floor.ply", "--up=-y", "--camera-to=100,19.9,-1", "--camera-to=99,19.9,0", "--camera-to=100,20.1,1"},
    };
    write_floors();
    write_text("mirrored.pbrt",
               "Scale -1 1 1 LookAt 0 -5 0 0 0 0 0 0 1 Camera \"perspective\" WorldBegin\n" FLOOR_PBRT);
    write_sky();
    for (size_t k = 0; k < sizeof WAYS / sizeof *WAYS; k++) {
#define LOOK(where, ...)                                                                                               \
    RENDER(WAYS[k].scene, PATH, "--sky=sky.exr", "--fov=1", "--camera-from=100,20,0", WAYS[k].up, where, __VA_ARGS__)
        picture p = LOOK(WAYS[k].north, "--sky-rotation=0");
        expect_uniform("north", &p, 11.0, 1e-5, 8, 1e-5);
        picture_reset(&p);
        p = LOOK(WAYS[k].east, "--sky-rotation=0");
        expect_uniform("east", &p, 12.0, 1e-5, 8, 1e-5);
        picture_reset(&p);
        p = LOOK(WAYS[k].below, "--sky-rotation=0");
        expect_uniform("south, below the horizon", &p, 3.0, 1e-5, 8, 1e-5);
        picture_reset(&p);
        p = LOOK(WAYS[k].east, "--sky-rotation=90");
        expect_uniform("east, turned", &p, 11.0, 1e-5, 8, 1e-5);
        picture_reset(&p);
        p = LOOK(WAYS[k].north, "--sky-strength=.5");
        expect_uniform("half as strong", &p, 5.5, 1e-5, 8, 1e-5);
        picture_reset(&p);
    }
}

/* Walls that face the points of the compass: the sun's azimuth lights the one, and not those across or away. */
static void a_sun_stands_where_it_should(void **state)
{
    (void)state;
    static const char *const AZIMUTHS[] = {"--sun=0,0,2", "--sun=90,0,2", "--sun=180,0,2", "--sun=270,0,2"};
    static const char *const FROM[] = {"--camera-from=0,0,-9", "--camera-from=9,0,0", "--camera-from=0,0,9",
                                       "--camera-from=-9,0,0"};
    write_text("cube.mtl", "newmtl grey\nKd .5 .5 .5\n");
    write_text("cube.obj", "mtllib cube.mtl\nusemtl grey\n"
                           "v -1 -1 -1\nv 1 -1 -1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 1\nv 1 -1 1\nv -1 1 1\nv 1 1 1\n"
                           "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n");
    for (int sun = 0; sun < 4; sun++)
        for (int eye = 0; eye < 4; eye++) {
            picture p = RENDER("cube.obj", PATH, AZIMUTHS[sun], FROM[eye], "--camera-to=0,0,0", "--fov=5");
            expect_near("wall", picture_mean(&p, 1) + 1.0, 1.0 + (sun == eye ? 0.5 * 2.0 / PI_D : 0.0), 1e-5);
            picture_reset(&p);
        }
}

/* Under the edge of a roof half of a sun at the zenith is seen; farther out all of it, farther in nothing. */
static void a_sun_of_an_extent_has_penumbras(void **state)
{
    (void)state;
    static const struct {
        const char *to;
        double share;
    } CASES[] = {{"--camera-to=0.5,0,0", 1.0}, {"--camera-to=0,0,0", 0.5}, {"--camera-to=-0.5,0,0", 0.0}};
    write_text("roof.pbrt", "LookAt 0 5 0 0 0 0 0 0 1 Camera \"perspective\" WorldBegin\n" FLOOR_PBRT
                            "Material \"diffuse\" \"rgb reflectance\" [0 0 0] Shape \"bilinearmesh\" \"point3 P\" "
                            "[-9 1 -9 0 1 -9 -9 1 9 0 1 9]\n");
    for (size_t k = 0; k < 3; k++)
        for (int maps = 0; maps < 2; maps++) { /* the standard error is 0.6 % */
            picture p = RENDER("roof.pbrt", maps ? "--photons=1000" : "--integrator=path", "--size=8x8", "--spp=128",
                               "--noise=0", "--sun=0,90,3,40", "--up=y", "--camera-from=5,5,0", CASES[k].to,
                               "--camera-up=0,0,1", "--fov=1");
            expect_near(CASES[k].to, picture_mean(&p, 1) + 0.1, 0.1 + CASES[k].share * 0.5 * 3.0 / PI_D, 0.03);
            picture_reset(&p);
        }
}

static void expect_same(const char *scene, const char *const *some, const char *const *others)
{
    picture p = render(scene, some), q = render(scene, others);
    assert_int_equal(p.width, q.width);
    assert_memory_equal(p.pixels, q.pixels, 3 * (size_t)p.width * (size_t)p.height * sizeof *p.pixels);
    assert_true(picture_mean(&p, 1) > 0.0);
    picture_reset(&p);
    picture_reset(&q);
}

/* In a pbrt file its own camera says what is up, whatever camera replaces it. */
static void up_is_that_of_the_file(void **state)
{
    (void)state;
    write_floors();
    write_sky();
    expect_same(
        "floor.pbrt", ARGUMENTS(PATH, "--sky=sky.exr", "--camera-from=3,5,1", "--camera-to=0,0,0"),
        ARGUMENTS(PATH, "--sky=sky.exr", "--camera-from=3,5,1", "--camera-to=0,0,0", "--up=z", "--camera-up=0,0,1"));
    expect_same(
        "floor.pbrt", ARGUMENTS(PATH, "--sun=30,40", "--camera-from=3,5,1", "--camera-to=0,0,0", "--camera-up=0,1,1"),
        ARGUMENTS(PATH, "--sun=30,40", "--camera-from=3,5,1", "--camera-to=0,0,0", "--up=z", "--camera-up=0,1,1"));
    program_run run = RUN(PATH, "--up=y", "-ox.exr", "floor.pbrt");
    expect_said(&run, "which axis points up is asked for, but no sun or sky is, and the file has its own camera");
    program_run_reset(&run);
}

/* A closed room with a red floor and a blue ceiling; z_up: z is y, and y is -z. */
static void write_room(const char *name, bool z_up)
{
    static const int CORNERS[6][4] = {{1, 5, 6, 2}, {3, 4, 8, 7}, {1, 2, 4, 3},
                                      {5, 7, 8, 6}, {1, 3, 7, 5}, {2, 6, 8, 4}};
    FILE *file = fopen(in_folder(name), "w");
    assert_non_null(file);
    fprintf(file, "mtllib room.mtl\n");
    for (int k = 0; k < 8; k++) {
        const int x = k & 1 ? 6 : 0, y = k & 2 ? 3 : 0, z = k & 4 ? 4 : 0;
        fprintf(file, "v %d %d %d\n", x, z_up ? -z : y, z_up ? y : z);
    }
    for (int k = 0; k < 6; k++) /* faces look inwards */
        fprintf(file, "usemtl %s\nf %d %d %d %d\n",
                k == 0   ? "red"
                : k == 1 ? "blue"
                         : "grey",
                CORNERS[k][0], CORNERS[k][1], CORNERS[k][2], CORNERS[k][3]);
    assert_int_equal(fclose(file), 0);
}

/* The camera that is made up in a closed room stands upright by --up: both rooms look alike. */
static void a_camera_in_a_room_stands_upright(void **state)
{
    (void)state;
    write_text("room.mtl", "newmtl red\nKd .8 .1 .1\nnewmtl blue\nKd .1 .1 .8\nnewmtl grey\nKd .5 .5 .5\n");
    write_room("y.obj", false);
    write_room("z.obj", true);
    picture y = RENDER("y.obj", "--integrator=path", "--max-depth=1", "--size=32x18", "--spp=16"),
            z = RENDER("z.obj", "--integrator=path", "--max-depth=1", "--size=32x18", "--spp=16", "--up=z");
    double off = 0.0, below = 0.0;
    for (int k = 0; k < 3 * 32 * 18; k++)
        off += fabs((double)y.pixels[k] - (double)z.pixels[k]) / (3 * 32 * 18);
    for (int x = 0; x < 32; x++)
        below += (double)z.pixels[3 * (32 * 17 + x)] - (double)z.pixels[3 * (32 * 17 + x) + 2];
    expect_near("both rooms", 1.0 + off, 1.0, 0.01 * picture_mean(&y, 1));
    assert_true(below > 0.0); /* the floor is red */
    picture_reset(&y);
    picture_reset(&z);
}

/* Two cameras: one sees a wall of 1, the other one of 2. */
static void a_camera_is_picked_by_its_name(void **state)
{
    (void)state;
    blob b = {.size = 0};
    BLOB_PUT(&b, (float[]){-9, -9, -1, 9, -9, -1, 0, 9, -1});
    write_blob("wall.bin", &b);
    char *json =
        json_text("{" GLTF_ASSET "'buffers': [{'uri': 'wall.bin', 'byteLength': 36}],"
                  "'bufferViews': [{'buffer': 0, 'byteLength': 36}],"
                  "'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 3, 'type': 'VEC3'}],"
                  "'materials': [{'emissiveFactor': [1, 1, 1]}, {'emissiveFactor': [0.5, 0.5, 0.5]}],"
                  "'meshes': [{'primitives': [{'attributes': {'POSITION': 0}, 'material': 0}]},"
                  "  {'primitives': [{'attributes': {'POSITION': 0}, 'material': 1}]}],"
                  "'cameras': [{'name': 'wide', 'type': 'perspective', 'perspective': {'yfov': 0.1, 'aspectRatio': 1}},"
                  "  {'type': 'perspective', 'perspective': {'yfov': 0.1, 'aspectRatio': 1}}],"
                  "'nodes': [{'mesh': 0}, {'mesh': 1, 'translation': [50, 0, 0]}, {'camera': 0, 'name': 'first'},"
                  "  {'camera': 0, 'name': 'second', 'translation': [50, 0, 0]}, {'camera': 1}]}");
    write_text("two.gltf", json);
    free(json);
    static const struct {
        const char *name;
        double expected;
    } NAMES[] = {
        {"--camera=first", 1.0}, {"--camera=second", 0.5}, {"--camera=wide", 1.0}, {"--camera=cameras[1]", 1.0}};
    for (size_t k = 0; k < sizeof NAMES / sizeof *NAMES; k++) {
        picture p = RENDER("two.gltf", PATH, NAMES[k].name);
        expect_uniform(NAMES[k].name, &p, NAMES[k].expected, 1e-6, 8, 1e-6);
        picture_reset(&p);
    }
    program_run run = RUN("--camera=third", "-o", "x.exr", "two.gltf");
    expect_exit(&run, 2);
    expect_said(&run, "two.gltf: error: it has no camera \"third\", but \"first\" (\"wide\"), \"second\" (\"wide\"), "
                      "\"cameras[1]\"");
    program_run_reset(&run);
    write_floors();
    static const char *const OTHERS[][2] = {{"floor.ply", "it has no camera \"a\", but none at all"},
                                            {"floor.pbrt", "it has no camera \"a\", but one at most, without a name"}};
    for (int k = 0; k < 2; k++) {
        run = RUN("--camera=a", "-o", "x.exr", OTHERS[k][0]);
        expect_exit(&run, 2);
        expect_said(&run, OTHERS[k][1]);
        program_run_reset(&run);
        assert_int_not_equal(access(in_folder("x.exr"), F_OK), 0);
    }
}

/* Said before anything is rendered. */
static void mistakes_are_told(void **state)
{
    (void)state;
    static const struct {
        const char *arguments[3], *said;
        int exit_code;
    } MISTAKES[] = {
        {{"--sun=1"}, "--sun: '1' is not valid", 2},
        {{"--sun=1,91"}, "--sun: '1,91' is not valid", 2},
        {{"--sun=1,2,-3"}, "--sun: '1,2,-3' is not valid", 2},
        {{"--sun=1,2,3,181"}, "--sun: '1,2,3,181' is not valid", 2},
        {{"--sun=1,2,3,4,5"}, "is not valid", 2},
        {{"--sky=2e38"}, "the sky that is asked for: the light is too bright for a float", 2},
        {{"--camera-up=0,0,0", "--camera-from=1,2,3", "--camera-to=0,0,0"}, "is not valid", 2},
        {{"--sun=1,nan"}, "is not valid", 2},
        {{"--sky=1,2"}, "--sky: '1,2' is not valid", 2},
        {{"--sky=-1"}, "is not valid", 2},
        {{"--sky="}, "is not valid", 2},
        {{"--sky=none.exr"}, "the sky that is asked for, \"none.exr\": No such file", 1},
        {{"--sky=odd.exr"}, "\"odd.exr\" is 2 x 3: the picture of such a light is square", 1},
        {{"--sky-strength=2"}, "are for --sky, which is not given", 2},
        {{"--up=w", "--sky=1"}, "--up: 'w' is not valid", 2},
        {{"--camera=a", "--camera-from=1,2,3", "--camera-to=0,0,0"}, "are two cameras: give one", 2},
        {{"--sky=o.exr", "-oo.exr"}, "cannot be written as well", 2},
    };
    write_floors();
    static const float pixels[18] = {0};
    write_environment("odd.exr", 2, 3, IMAGE_FLOAT, pixels);
    write_environment("o.exr", 2, 1, IMAGE_FLOAT, pixels);
    for (size_t k = 0; k < sizeof MISTAKES / sizeof *MISTAKES; k++) {
        const char *const *a = MISTAKES[k].arguments;
        const char *all[8] = {"-ox.exr", "floor.ply"};
        for (int i = 0; i < 3 && a[i]; i++)
            all[2 + i] = a[i];
        program_run run = program_execute(NULL, all);
        expect_exit(&run, MISTAKES[k].exit_code);
        expect_said(&run, MISTAKES[k].said);
        program_run_reset(&run);
        assert_int_not_equal(access(in_folder("x.exr"), F_OK), 0);
    }
}

/* A picture that the command line names may lie outside of where a confined scene may read. */
static void a_sky_is_read_where_the_user_says(void **state)
{
    (void)state;
    write_floors();
    write_sky();
    assert_int_equal(mkdir(in_folder("below"), 0700), 0);
    assert_int_equal(rename(in_folder("floor.ply"), in_folder("below/floor.ply")), 0);
    picture p = RENDER("below/floor.ply", PATH, "--confine", "--sky=sky.exr", "--camera-from=0,5,0",
                       "--camera-to=0,5.1,-1", "--fov=1");
    expect_uniform("sky", &p, 11.0, 1e-5, 8, 1e-5);
    picture_reset(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(a_sun_is_as_bright_as_it_says),
        TEST_IN_FOLDER(a_sky_is_as_bright_as_it_says),
        TEST_IN_FOLDER(what_the_file_has_is_dropped),
        TEST_IN_FOLDER(a_sky_stands_where_it_should),
        TEST_IN_FOLDER(a_sun_stands_where_it_should),
        TEST_IN_FOLDER(a_sun_of_an_extent_has_penumbras),
        TEST_IN_FOLDER(up_is_that_of_the_file),
        TEST_IN_FOLDER(a_camera_in_a_room_stands_upright),
        TEST_IN_FOLDER(a_camera_is_picked_by_its_name),
        TEST_IN_FOLDER(mistakes_are_told),
        TEST_IN_FOLDER(a_sky_is_read_where_the_user_says),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
