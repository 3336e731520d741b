/* test_program_define.c: -D NAME=VALUE: the picture is that of the scene with the value in it; what is missing or idle
 * is an error; frames, metadata, and files that hold for one scene alone.
 * Flow: tests of the whole program. Threads: the program's. */
/* ctest: sanitize */
#define _GNU_SOURCE
#include "fixtures/program_picture.h"

#define BOX  PROGRAM_SCENES "box_with_blocks.pbrt"
#define TINY "--integrator=path", "--size=8x8", "--spp=1", "--type=float", "--reproducible"

static void expect_end(const char *const *arguments, int code, const char *said)
{
    program_run run = program_execute(NULL, arguments);
    expect_exit(&run, code);
    expect_said(&run, said);
    program_run_reset(&run);
}

static void expect_same_picture(const char *name, const char *other, bool is_same)
{
    picture a = picture_read(in_folder(name)), b = picture_read(in_folder(other));
    assert_int_equal(a.width * a.height, b.width * b.height);
    assert_int_equal(memcmp(a.pixels, b.pixels, (size_t)(3 * a.width * a.height) * sizeof *a.pixels) == 0, is_same);
    picture_reset(&a);
    picture_reset(&b);
}

/* A floor with its reflectance and name of the included scene left open. */
static void write_open_scene(const char *path_of_included)
{
    char text[2048];
    snprintf(text, sizeof text,
             "LookAt 0 0 1  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" ${fov:-90}\n"
             "Film \"rgb\" \"string filename\" \"film_$rho.exr\"\n"
             "WorldBegin Include \"%s\"\n"
             "Material \"diffuse\" \"rgb reflectance\" [ $rho $rho $rho ]\n"
             "Shape \"disk\" \"float radius\" 3\n",
             path_of_included);
    write_text("open.pbrt", text);
    write_text("lamp.1.pbrt", "LightSource \"point\" \"point3 from\" [0 0 $height]\n");
    write_text("lamp.2.pbrt", "LightSource \"point\" \"point3 from\" [1 0 $height]\n");
}

static void test_values(void **state)
{
    (void)state;
    write_open_scene("lamp.$which.pbrt");
    write_text("closed.pbrt", "LookAt 0 0 1  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 60\n"
                              "WorldBegin LightSource \"point\" \"point3 from\" [1 0 0.75]\n"
                              "Material \"diffuse\" \"rgb reflectance\" [ 0.4 0.4 0.4 ]\n"
                              "Shape \"disk\" \"float radius\" 3\n");
    expect_end(ARGUMENTS(TINY, "-o", "closed.exr", "closed.pbrt"), 0, "");
    expect_end(ARGUMENTS(TINY, "-D", "rho=0.4", "-Dwhich=1", "--define", "height=.75", "-D", "which=2", "-Dfov=60",
                         "-o", "open.exr", "open.pbrt"),
               0, "");
    expect_same_picture("open.exr", "closed.exr", true);
    expect_end(ARGUMENTS(TINY, "-Drho=0.5", "-Dwhich=2", "-Dheight=.75", "open.pbrt"), 0, "");
    expect_same_picture("film_0.5.exr", "closed.exr", false);
    unsigned char *value = attribute_of("open.exr", "afterglow/define", "string");
    assert_non_null(value);
    assert_string_equal((const char *)value, "rho=0.4, which=2, height=.75, fov=60");
    free(value);
    assert_null(attribute_of("closed.exr", "afterglow/define", "string"));
}

static void test_mistakes(void **state)
{
    (void)state;
    write_open_scene("lamp.1.pbrt");
    expect_end(ARGUMENTS(TINY, "-o", "a.exr", "-Dheight=1", "open.pbrt"), 1,
               "open.pbrt:2:30: error: $rho has no value");
    expect_end(ARGUMENTS(TINY, "-o", "a.exr", "-Drho=1", "open.pbrt"), 1, "lamp.1.pbrt:1:40: error: $height has no");
    expect_end(ARGUMENTS(TINY, "-o", "a.exr", "open.pbrt"), 1, "lamp.1.pbrt:1:40: error: $height has no");
    expect_end(ARGUMENTS(TINY, "-o", "a.exr", "-Drho=1", "-Dheight=1", "-Dbad=1", "open.pbrt"), 2,
               "the scene has no $bad");
    expect_end(ARGUMENTS(TINY, "-o", "a.exr", "-Drho=1", BOX), 2, "the scene has no $rho");
    expect_end(ARGUMENTS(TINY, "-o", "a.exr", "-Drho=", "-Dheight=1", "open.pbrt"), 1,
               "should have 3 values, but has 0");
    static const char *const wrong[] = {"-Drho", "-D1=2", "-D=2", "-Da-b=2", "-D"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        expect_end(ARGUMENTS(TINY, wrong[i], "-o", "a.exr", "open.pbrt"), 2, "define");
    write_text("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    expect_end(ARGUMENTS(TINY, "-o", "a.exr", "-Drho=1", "a.obj"), 2, "the scene has no $rho");
}

static void test_dollars_without_definitions(void **state)
{
    (void)state;
    write_text("d.pbrt", "Camera \"perspective\" WorldBegin\n"
                         "Include \"$frame${a}$1.pbrt\" Shape \"sphere\" LightSource \"point\"\n");
    write_text("$frame${a}$1.pbrt", "Scale 2 2 2\n");
    expect_end(ARGUMENTS(TINY, "-o", "a.exr", "d.pbrt"), 0, "");
    expect_end(ARGUMENTS(TINY, "-o", "a.exr", "-Da=b", "d.pbrt"), 1, "d.pbrt:2:9: error: $frame has no value");
}

static void test_frames(void **state)
{
    (void)state;
    write_open_scene("lamp.$frame.pbrt");
    expect_end(ARGUMENTS(TINY, "-Drho=0.4", "-Dheight=0.7", "-Dfov=%02d", "--frames=1-2", "-o", "f.#.exr", "open.pbrt"),
               0, "");
    expect_end(ARGUMENTS(TINY, "-Drho=0.4", "-Dheight=0.7", "-Dfov=02", "-Dframe=2", "-o", "one.exr", "open.pbrt"), 0,
               "");
    expect_same_picture("f.1.exr", "one.exr", false);
    expect_same_picture("f.2.exr", "one.exr", true);
    /* a frame's number that is not used is no mistake */
    expect_end(ARGUMENTS(TINY, "--frames=1", "-o", "g.#.exr", BOX), 0, "");
}

/* Files that hold for one scene know that another value makes another. */
static void test_other_scene(void **state)
{
    (void)state;
#define SMALL "--size=8x8", "--spp=2", "--photons=500", "--gather-samples=4", "--photon-map=m.map"
    write_open_scene("lamp.1.pbrt");
    expect_end(ARGUMENTS(SMALL, "-Drho=0.4", "-Dheight=0.7", "-o", "a.exr", "open.pbrt"), 0, "");
    expect_end(ARGUMENTS(SMALL, "-Drho=0.40", "-Dheight=7e-1", "-Dfov=50", "-o", "b.exr", "open.pbrt"), 0, "");
    expect_end(ARGUMENTS(SMALL, "-Drho=0.5", "-Dheight=0.7", "-o", "b.exr", "open.pbrt"), 1, "m.map");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_values), TEST_IN_FOLDER(test_mistakes),    TEST_IN_FOLDER(test_dollars_without_definitions),
        TEST_IN_FOLDER(test_frames), TEST_IN_FOLDER(test_other_scene),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
