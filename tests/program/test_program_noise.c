/* test_program_noise.c: what the program says at the end of the noise that is left: its level, which part of the light
 * brings most of it, and what would help most. A scene for each hint, in which that part is noisy by its making.
 *
 * Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_picture.h"

#define QUICK "-v", "--size=32x32", "--photons=20000", "--caustic-photons=20000", "--type=float"

static const char VIEW[] = "LookAt 0 0 3  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 50\n"
                           "PixelFilter \"box\"\nWorldBegin\n";
static const char PLANE[] = "Shape \"bilinearmesh\" \"point3 P\" [-4 -4 0  4 -4 0  -4 4 0  4 4 0]\n";

/* The words behind "noise: " in the line that has a hint. */
static void expect_hint(const char *scene, const char *const *options, const char *where, const char *help)
{
    const char *all[PROGRAM_ARGUMENTS_MAX] = {QUICK, "-o", "a.exr", scene};
    int count = 8;
    while (*options)
        all[count++] = *options++;
    program_run run = program_execute(NULL, all);
    expect_exit(&run, 0);
    const char *hint = strstr(run.err, " of the noise (");
    if (!hint || !strstr(hint, where) || !strstr(hint, help))
        fail_msg("no hint of '%s' and '%s' in: %s", where, help, run.err);
    program_run_reset(&run);
}

#define EXPECT_HINT(scene, where, help, ...) expect_hint(scene, ARGUMENTS(__VA_ARGS__), where, help)

static const char *scene_of(const char *name, const char *first, const char *second)
{
    char text[4096];
    snprintf(text, sizeof text, "%s%s%s", VIEW, first, second);
    return write_text(name, text);
}

/* A rough metal under small lamps that its lobes find now and then. */
static void test_reflections(void **state)
{
    (void)state;
    const char *scene = scene_of("a.pbrt",
                                 "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [40 40 40]\n"
                                 "Translate 1 1 2 Shape \"sphere\" \"float radius\" 0.2 AttributeEnd\n"
                                 "Material \"conductor\" \"float roughness\" 0.3\n",
                                 PLANE);
    EXPECT_HINT(scene, "in reflections and glass", "more samples (--spp)", "--spp=16", "--gather-samples=2");
    EXPECT_HINT(scene, "in reflections and glass", "more samples (--spp)", "--spp=16", "--integrator=path");
}

/* An even sky: behind a window, behind a window that the file names, and over the open plain. */
static void test_sky(void **state)
{
    (void)state;
    const char *open = "LightSource \"infinite\" \"rgb L\" [1 1 1]";
    const char *scene = SCENE_WITH("window_room.pbrt", "THE_LIGHTS", open, "Include \"block.pbrt\"", "");
    EXPECT_HINT(scene, "which comes in by few windows", "guided shadow rays (--direct-guiding)", "--spp=16",
                "--gather-samples=64", "--direct-guiding=0");
    EXPECT_HINT(scene, "which comes in by few windows", "a \"portal\" of the infinite light", "--spp=16",
                "--gather-samples=64", "--direct-guiding=0.05");
    scene = SCENE_WITH("window_room.pbrt", "THE_LIGHTS",
                       "LightSource \"infinite\" \"rgb L\" [1 1 1]\n"
                       "\"point3 portal\" [1 -0.5 0.6  1 0.5 0.6  1 0.5 1.6  1 -0.5 1.6]",
                       "Include \"block.pbrt\"", "");
    program_run run = RUN(QUICK, "--spp=16", "--gather-samples=64", "-o", "a.exr", scene);
    expect_exit(&run, 0);
    if (strstr(run.err, "\"portal\" of the infinite light"))
        fail_msg("it has a portal already: %s", run.err);
    program_run_reset(&run);
    scene = scene_of("b.pbrt", "LightSource \"infinite\" \"rgb L\" [1 1 1]\nMaterial \"diffuse\"\n", PLANE);
    EXPECT_HINT(scene, "in direct light from the sky:", "more samples (--spp)", "--spp=16");
}

/* A large lamp near a floor that reflects to nowhere else. */
static void test_lamps(void **state)
{
    (void)state;
    EXPECT_HINT(PROGRAM_SCENES "lamp_sphere.pbrt", "in direct light from lamps", "more samples (--spp)", "--spp=2",
                "--gather-samples=1", "--max-depth=1");
}

static void test_indirect(void **state)
{
    (void)state;
    EXPECT_HINT(PROGRAM_SCENES "dim_hall.pbrt", "in indirect light", "(--gather-samples)", "--spp=16",
                "--gather-samples=1");
    EXPECT_HINT(PROGRAM_SCENES "dim_hall.pbrt", "in indirect light", "more samples (--spp)", "--spp=256");
    EXPECT_HINT(PROGRAM_SCENES "dim_hall.pbrt", "in indirect light", "--integrator photonmap", "--spp=64",
                "--integrator=path");
}

/* A glass ball behind the eye, between a lamp and the plane: the photon map shows the grain of few photons, path
 * tracing finds the lamp through the glass by chance alone. */
static void test_caustics(void **state)
{
    (void)state;
    const char *scene = scene_of("a.pbrt",
                                 "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [20 20 20]\n"
                                 "Translate 0 0 6 Shape \"sphere\" \"float radius\" 0.5 AttributeEnd\n"
                                 "AttributeBegin Material \"dielectric\" Translate 0 0 4\n"
                                 "Shape \"sphere\" \"float radius\" 0.9 AttributeEnd\nMaterial \"diffuse\"\n",
                                 PLANE);
    EXPECT_HINT(scene, "in caustics", "(--caustic-photons", "--spp=16", "--nearest=10");
    EXPECT_HINT(scene, "in caustics", "--integrator photonmap", "--spp=64", "--integrator=path");
}

/* The edge of a lamp against the dark. */
static void test_edges(void **state)
{
    (void)state;
    const char *scene = scene_of("a.pbrt", "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] Material \"diffuse\"\n",
                                 "Shape \"disk\" \"float radius\" 0.6\n");
    EXPECT_HINT(scene, "at the edges of lamps and of the sky", "more samples (--spp)", "--spp=16");
}

/* Four times the samples bring half the noise, and a picture without any has no hint. */
static void test_level(void **state)
{
    (void)state;
    double level[2];
    for (int i = 0; i < 2; i++) {
        program_run run = RUN(QUICK, i == 0 ? "--spp=64" : "--spp=256", "--integrator=path", "-o", "a.exr",
                              PROGRAM_SCENES "box_with_blocks.pbrt");
        expect_exit(&run, 0);
        const char *said = strstr(run.err, "noise: ");
        if (!said || sscanf(said, "noise: %lf, where white is 1;", &level[i]) != 1)
            fail_msg("%s", run.err);
        program_run_reset(&run);
    }
    if (!(fabs(level[0] / level[1] - 2.0) < 0.2))
        fail_msg("noise %g by 64 samples, %g by 256", level[0], level[1]);
    const char *even = scene_of("a.pbrt", "LightSource \"infinite\" \"rgb L\" [0.5 0.5 0.5]\n", "");
    program_run run = RUN(QUICK, "--spp=4", "-o", "a.exr", even);
    expect_exit(&run, 0);
    expect_said(&run, "noise: 0, where white is 1; 4 samples per pixel\n");
    assert_null(strstr(run.err, " of the noise ("));
    program_run_reset(&run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_reflections), TEST_IN_FOLDER(test_sky),      TEST_IN_FOLDER(test_lamps),
        TEST_IN_FOLDER(test_indirect),    TEST_IN_FOLDER(test_caustics), TEST_IN_FOLDER(test_edges),
        TEST_IN_FOLDER(test_level),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
