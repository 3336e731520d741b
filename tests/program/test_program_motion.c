/* test_program_motion.c: what moves while the shutter is open: the part of the time that a point is covered, in closed
 * form; a camera that moves and a world that moves the other way; photon map and path tracer where what moves reflects.
 * Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_agreement.h"

static const agreement_bounds UNBIASED = {0.0, 0.005, 0.02};

/* The plane z = 0 from -1 to 1 fills the picture; a sky of radiance 1 behind what is black. The camera's left-handed
 * space has x to the right. */
#define SKY_AND_BLACK                                                                                                  \
    "LookAt 0 0 -1 0 0 0 0 1 0 Camera \"perspective\" \"float fov\" 90 %s\n"                                           \
    "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 32 PixelFilter \"box\" WorldBegin\n"              \
    "LightSource \"infinite\" \"rgb L\" [1 1 1] Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n"

static double clamp(double x, double low, double high) { return x < low ? low : x > high ? high : x; }

/* How much of the time a point is not covered, of x to the right and y up from -1 to 1. */
typedef double uncovered_fn(double x, double y);

static void radiance_of_sky(const void *uncovered, double x, double y, double out_rgb[3])
{
    out_rgb[0] = out_rgb[1] = out_rgb[2] = (*(uncovered_fn *const *)uncovered)(2.0 * x - 1.0, 1.0 - 2.0 * y);
}

static void expect_uncovered(const char *what, const char *camera, const char *world, uncovered_fn *uncovered)
{
    char text[2048];
    static const char *const INTEGRATORS[] = {"--integrator=path", "--integrator=photonmap"};
    int length = snprintf(text, sizeof text, SKY_AND_BLACK "%s\n", camera, world);
    assert_true(length > 0 && (size_t)length < sizeof text);
    const char *scene = write_text("cover.pbrt", text);
    agreement_means exact = agreement_exact(radiance_of_sky, &uncovered);
    for (int i = 0; i < 2; i++) {
        agreement_means means =
            agreement_render(scene, ARGUMENTS(INTEGRATORS[i], "--spp=128", "--photons=1000", "--gather-samples=1"));
        expect_agreement(what, &means, &exact, UNBIASED);
    }
}

/* A band of width 0.8 whose left edge goes from -1 to 0.2. */
static double uncovered_by_band(double x, double y)
{
    (void)y;
    double first = clamp((x - 0.8 + 1.0) / 1.2, 0.0, 1.0), last = clamp((x + 1.0) / 1.2, 0.0, 1.0);
    return 1.0 - (last - first);
}

#define BAND                                                                                                           \
    "ActiveTransform EndTime Translate 1.2 0 0 ActiveTransform All "                                                   \
    "Shape \"bilinearmesh\" \"point3 P\" [-1 -2 0 -.2 -2 0 -1 2 0 -.2 2 0]"

static void test_sliding_band(void **state)
{
    (void)state;
    expect_uncovered("band", "", BAND, uncovered_by_band);
    expect_uncovered(
        "band as instance", "",
        "ObjectBegin \"b\" Shape \"bilinearmesh\" \"point3 P\" [-1 -2 0 -.2 -2 0 -1 2 0 -.2 2 0] ObjectEnd "
        "ActiveTransform EndTime Translate 1.2 0 0 ObjectInstance \"b\"",
        uncovered_by_band);
}

/* The share of the time that a point is uncovered where the motion takes half of the time that the shutter is open, and
 * the plate waits as long before it as after it. */
static double uncovered_with_waits(double x, double y)
{
    double waits = (x > -1.0 && x < -0.2 ? 0.25 : 0.0) + (x > 0.2 && x < 1.0 ? 0.25 : 0.0);
    return 0.5 - waits + 0.5 * uncovered_by_band(x, y);
}

static void test_shutter(void **state)
{
    (void)state;
    expect_uncovered("middle third", "\"float shutteropen\" 1 \"float shutterclose\" 2 TransformTimes 0 3",
                     "ActiveTransform StartTime Translate -1.2 0 0 ActiveTransform EndTime Translate 1.2 0 0 "
                     "ActiveTransform All " BAND,
                     uncovered_by_band);
    expect_uncovered("waits", "\"float shutteropen\" 1 \"float shutterclose\" 2 TransformTimes 1.25 1.75", BAND,
                     uncovered_with_waits);
}

/* Half a disk turns by a quarter turn about its middle, from the upper half plane to the left one (x is to the right, y
 * up, and the turn is from x to y). */
static double uncovered_by_half_disk(double x, double y)
{
    double turns = atan2(y, x) / (2.0 * 3.14159265358979323846), quarters = 4.0 * (turns < 0.0 ? turns + 1.0 : turns);
    if (quarters < 1.0)
        return 1.0 - quarters; /* left at that part of the time */
    return quarters < 2.0 ? 0.0 : quarters < 3.0 ? quarters - 2.0 : 1.0;
}

static void test_turning_disk(void **state)
{
    (void)state;
    expect_uncovered("half a disk", "",
                     "ActiveTransform EndTime Rotate 90 0 0 1 ActiveTransform All "
                     "Shape \"disk\" \"float radius\" 9 \"float phimax\" 180",
                     uncovered_by_half_disk);
}

/* --- a camera that moves, a world that moves the other way --- */

#define BODIES                                                                                                         \
    "AttributeBegin Translate .5 .2 3 Shape \"sphere\" \"float radius\" .8 AttributeEnd\n"                             \
    "AttributeBegin Translate -.9 -.4 4 Rotate 30 1 1 0 Shape \"cylinder\" AttributeEnd\n"                             \
    "AttributeBegin Translate 0 -1 3 Rotate 50 1 0 0 Shape \"disk\" AttributeEnd\n"

/* One object moves, so that all turns about one point as the camera does; what moves by itself turns about its own.
 * Black before an even sky: each sample sees the one or the other, the same in both but for an edge now and then. */
static void test_moving_camera(void **state)
{
    (void)state;
    static const char *const MOVES[] = {"Translate .4 .1 -.6", "Rotate 20 1 2 3"};
    static const char BEFORE[] = "%s Camera \"perspective\" \"float fov\" 60 Film \"rgb\" \"integer xresolution\" 32\n"
                                 "\"integer yresolution\" 32 PixelFilter \"box\" WorldBegin LightSource \"infinite\"\n"
                                 "\"rgb L\" [1 1 1] Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n"
                                 "ObjectBegin \"all\"\n" BODIES "ObjectEnd %s ObjectInstance \"all\"\n";
    for (int k = 0; k < 2; k++) {
        /* the camera's transform is that of the world into its space */
        char text[2048], move[128];
        snprintf(move, sizeof move, "ActiveTransform EndTime %s ActiveTransform All", MOVES[k]);
        snprintf(text, sizeof text, BEFORE, move, "");
        picture camera = RENDER(write_text("camera.pbrt", text), "--integrator=path", "--spp=64");
        snprintf(text, sizeof text, BEFORE, "", move);
        picture world = RENDER(write_text("world.pbrt", text), "--integrator=path", "--spp=64");
        snprintf(text, sizeof text, BEFORE, "", "");
        picture still = RENDER(write_text("still.pbrt", text), "--integrator=path", "--spp=64");
        double difference = 0.0, blur = 0.0;
        for (int i = 0; i < 32 * 32; i++) {
            difference += fabs((double)camera.pixels[3 * i] - (double)world.pixels[3 * i]);
            blur += fabs((double)camera.pixels[3 * i] - (double)still.pixels[3 * i]);
        }
        assert_true(blur > 20.0);
        if (!(difference < 0.25))
            fail_msg("%s: %g pixels differ", MOVES[k], difference);
        picture_reset(&camera);
        picture_reset(&world);
        picture_reset(&still);
    }
}

/* --- what moves reflects --- */

/* A map knows the mean of the light on a point, not which light came when: where light and what hides it go together,
 * some of the indirect light is lost. */
static void test_moving_blocks(void **state)
{
    (void)state;
    static const agreement_bounds BOUNDS = {AGREEMENT_BLUR, 0.007, 0.03};
    compare_parts("moving_blocks", "--spp=64", BOUNDS);
}

/* Light counted for the wrong time would be six times off; light that is 8 % off makes this fail. */
static void test_moving_plate(void **state)
{
    (void)state;
    static const agreement_bounds BOUNDS = {AGREEMENT_BLUR, 0.02, 0.1};
    compare_integrators_by(
        "moving plate", PROGRAM_SCENES "moving_plate.pbrt",
        ARGUMENTS("--photons=1e6", "--nearest=30", "--gather-samples=16", "--spp=64", "--only=indirect"),
        ARGUMENTS("--integrator=path", "--spp=1024", "--only=indirect"), BOUNDS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_sliding_band),  TEST_IN_FOLDER(test_shutter),       TEST_IN_FOLDER(test_turning_disk),
        TEST_IN_FOLDER(test_moving_camera), TEST_IN_FOLDER(test_moving_blocks), TEST_IN_FOLDER(test_moving_plate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
