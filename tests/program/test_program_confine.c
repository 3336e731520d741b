/* test_program_confine.c: a scene that is not trusted tries to reach files outside of its folder, in twenty ways: by
 * every directive that names a file, in three formats, by paths, links and encodings. Nothing of them is read, shown or
 * told, and nothing is written there.
 *
 * Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_picture.h"

#include <limits.h>

#define QUICK   "--photons=300", "--spp=1", "--gather-samples=2", "--size=8x6", "--progress=none"
#define BEGIN   "Camera \"perspective\"\nWorldBegin\nLightSource \"point\"\nShape \"sphere\"\n"
#define SECRET  "Verschwiegenheit"
#define REFUSED "a confined scene may not read it"

/* folder/secret.* are not to be reached from folder/scene/. */
static void write_files(void)
{
    static const char *const NAMES[] = {"secret.pbrt", "secret.ply", "secret.png", "secret.spd",
                                        "secret.bin",  "secret.mtl", "secret.gltf"};
    for (int i = 0; i < 7; i++)
        write_text(NAMES[i], SECRET " 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18\n");
    assert_int_equal(mkdir(in_folder("scene"), 0755), 0);
    assert_int_equal(mkdir(in_folder("scene/sub"), 0755), 0);
    assert_int_equal(symlink("../secret.pbrt", in_folder("scene/link.pbrt")), 0);
    assert_int_equal(symlink("..", in_folder("scene/up")), 0);
}

/* Fails where the program has told anything of the files, or written anything but the picture. */
static void expect_nothing_told(const program_run *run)
{
    if (strstr(run->err, SECRET) || strstr(run->out, SECRET))
        fail_msg("it tells: %s%s", run->out, run->err);
}

static void expect_refused(const char *name, const char *text)
{
    char path[64];
    snprintf(path, sizeof path, "scene/%s", name);
    write_text(path, text);
    program_run run = RUN(QUICK, "--confine", "-o", "a.exr", path);
    expect_exit(&run, 1);
    expect_said(&run, REFUSED);
    expect_nothing_told(&run);
    program_run_reset(&run);
    assert_int_not_equal(access(in_folder("a.exr"), F_OK), 0);
}

/* A triangle in a buffer, with or without a picture on it. */
#define GLTF(buffers, more, material)                                                                                  \
    "{\"asset\": {\"version\": \"2.0\"}, \"buffers\": [" buffers "], " more                                            \
    "\"bufferViews\": [{\"buffer\": 0, \"byteLength\": 36}],"                                                          \
    "\"accessors\": [{\"bufferView\": 0, \"componentType\": 5126, \"count\": 3, \"type\": \"VEC3\"}],"                 \
    "\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0}" material "}]}],"                               \
    "\"nodes\": [{\"mesh\": 0}], \"scenes\": [{\"nodes\": [0]}]}"
#define BARE(buffers) GLTF(buffers, "", "")
#define WITH_PICTURE(image)                                                                                            \
    GLTF(INSIDE,                                                                                                       \
         "\"images\": [" image "], \"textures\": [{\"source\": 0}], "                                                  \
         "\"materials\": [{\"pbrMetallicRoughness\": {\"baseColorTexture\": {\"index\": 0}}}],",                       \
         ", \"material\": 0")
#define BUFFER(uri) "{\"byteLength\": 36, \"uri\": \"" uri "\"}"
#define IMAGE(uri)  "{\"uri\": \"" uri "\"}"
#define INSIDE      BUFFER("data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA")

static void test_pbrt(void **state)
{
    (void)state;
    char text[1024];
    write_files();
    expect_refused("1.pbrt", BEGIN "Include \"../secret.pbrt\"\n");
    snprintf(text, sizeof text, BEGIN "Include \"%s/secret.pbrt\"\n", folder);
    expect_refused("2.pbrt", text);
    expect_refused("3.pbrt", BEGIN "Include \"link.pbrt\"\n");
    expect_refused("4.pbrt", BEGIN "Include \"up/secret.pbrt\"\n");
    expect_refused("5.pbrt", BEGIN "Import \"sub/../../secret.pbrt\"\n");
    snprintf(text, sizeof text, BEGIN "Include \"/proc/self/root%s/secret.pbrt\"\n", folder);
    expect_refused("6.pbrt", text);
    expect_refused("7.pbrt", BEGIN "Include \"/etc/passwd\"\n");
    expect_refused("8.pbrt", BEGIN "Shape \"plymesh\" \"string filename\" \"../secret.ply\"\n");
    expect_refused("9.pbrt", BEGIN "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"../secret.png\"\n");
    expect_refused("10.pbrt", BEGIN "LightSource \"infinite\" \"string filename\" \"../secret.png\"\n");
    expect_refused("11.pbrt", BEGIN "LightSource \"point\" \"spectrum I\" \"../secret.spd\"\n");
    expect_refused("12.pbrt", BEGIN "LightSource \"projection\" \"string filename\" \"../secret.png\"\n");
    /* what is not there is refused in the same words, so that nobody can find out */
    expect_refused("13.pbrt", BEGIN "Include \"../nothing.pbrt\"\n");
    expect_refused("14.pbrt", BEGIN "Include \"../nowhere/nothing.pbrt\"\n");
    /* within the folder all can be read */
    write_text("scene/part.pbrt", "Shape \"sphere\"\n");
    write_text("scene/good.pbrt", BEGIN "Include \"part.pbrt\"\nInclude \"sub/../part.pbrt\"\n");
    program_run run = RUN(QUICK, "--confine", "-o", "good.exr", "scene/good.pbrt");
    expect_exit(&run, 0);
    program_run_reset(&run);
    write_text("scene/missing.pbrt", BEGIN "Include \"missing/part.pbrt\"\nInclude \"none.pbrt\"\n");
    run = RUN(QUICK, "--confine", "-o", "a.exr", "scene/missing.pbrt");
    expect_exit(&run, 1);
    program_run_reset(&run);
}

static void test_gltf(void **state)
{
    (void)state;
    char text[2048];
    write_files();
    expect_refused("1.gltf", BARE(BUFFER("../secret.bin")));
    expect_refused("2.gltf", BARE(BUFFER("%2e%2e/secret.bin")));
    expect_refused("3.gltf", BARE(BUFFER("%2E%2E%2Fsecret.bin")));
    snprintf(text, sizeof text, BARE("{\"byteLength\": 36, \"uri\": \"%s/secret.bin\"}"), folder);
    expect_refused("4.gltf", text);
    expect_refused("5.gltf", WITH_PICTURE(IMAGE("../secret.png")));
    expect_refused("6.gltf", WITH_PICTURE(IMAGE("up/secret.png")));
}

/* A material or picture that cannot be read is a warning there: the picture is made without it. */
static void test_models(void **state)
{
    (void)state;
    write_files();
    write_text("scene/a.obj", "mtllib ../secret.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    program_run run = RUN(QUICK, "--confine", "-o", "a.exr", "scene/a.obj");
    expect_exit(&run, 0);
    expect_said(&run, REFUSED);
    expect_nothing_told(&run);
    program_run_reset(&run);
    write_text("scene/b.obj", "mtllib b.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
    write_text("scene/b.mtl", "newmtl m\nKd 1 1 1\nmap_Kd ../secret.png\n");
    run = RUN(QUICK, "--confine", "-o", "b.exr", "scene/b.obj");
    expect_exit(&run, 0);
    expect_said(&run, REFUSED);
    expect_nothing_told(&run);
    program_run_reset(&run);
    /* assimp's process is held in the folder by the kernel, or the file is refused */
    write_text("scene/c.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
                              "endloop\nendfacet\nendsolid a\n");
    run = RUN(QUICK, "--confine", "-o", "c.exr", "scene/c.stl");
    if (run.exit_code != 0) {
        expect_exit(&run, 1);
        expect_said(&run, "Landlock");
    }
    program_run_reset(&run);
}

/* Nothing tells whether tiles of a picture lie outside, and messages name the pattern, not a tile. */
static void test_tiles(void **state)
{
    (void)state;
    static const char *const NAMES[2] = {"scene/a.pbrt", "scene/a.obj"};
    char *said[2] = {NULL, NULL};
    write_files();
    write_text("scene/a.pbrt",
               BEGIN "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"../z<UDIM>.png\"\n");
    write_text("scene/a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
    write_text("scene/a.mtl", "newmtl m\nKd 1 1 1\nmap_Kd ../z<UDIM>.png\n");
    for (int k = 0; k < 4; k++) {
        if (k == 2)
            write_text("z1001.png", SECRET "\n");
        program_run run = RUN(QUICK, "--confine", "-o", "a.exr", NAMES[k % 2]);
        expect_exit(&run, k % 2 ? 0 : 1);
        expect_said(&run, REFUSED);
        expect_said(&run, "../z<UDIM>.png");
        assert_null(strstr(run.err, "1001"));
        if (k < 2)
            said[k] = strdup(run.err);
        else
            assert_string_equal(run.err, said[k % 2]);
        program_run_reset(&run);
    }
    free(said[0]);
    free(said[1]);
}

/* The stranger's name for the picture is not used; further folders may be named. */
static void test_outputs_and_folders(void **state)
{
    (void)state;
    write_files();
    write_text("scene/a.pbrt", "Film \"rgb\" \"string filename\" \"../stolen.exr\"\n" BEGIN);
    program_run run = RUN(QUICK, "--confine", "scene/a.pbrt");
    expect_exit(&run, 0);
    program_run_reset(&run);
    expect_listing("a.exr scene secret.bin secret.gltf secret.mtl secret.pbrt secret.ply secret.png secret.spd");
    assert_int_equal(mkdir(in_folder("shared"), 0755), 0);
    write_text("shared/part.pbrt", "Shape \"sphere\"\n");
    write_text("scene/b.pbrt", BEGIN "Include \"../shared/part.pbrt\"\n");
    run = RUN(QUICK, "--confine-to=shared", "-o", "b.exr", "scene/b.pbrt");
    expect_exit(&run, 0);
    program_run_reset(&run);
    run = RUN(QUICK, "--confine", "-o", "c.exr", "scene/b.pbrt");
    expect_exit(&run, 1);
    expect_said(&run, REFUSED);
    program_run_reset(&run);
    run = RUN(QUICK, "--confine-to=none", "-o", "c.exr", "scene/b.pbrt");
    expect_exit(&run, 2);
    expect_said(&run, "'none': scenes cannot be confined to it");
    program_run_reset(&run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_pbrt),
        TEST_IN_FOLDER(test_gltf),
        TEST_IN_FOLDER(test_models),
        TEST_IN_FOLDER(test_tiles),
        TEST_IN_FOLDER(test_outputs_and_folders),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
