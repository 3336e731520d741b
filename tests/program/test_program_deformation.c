/* test_program_deformation.c: meshes whose vertices move while the shutter is open: the part of the time that a point
 * is covered, in closed form; the motion of a matrix told by vertices; photon map and path tracer where what bends
 * reflects. Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_agreement.h"

static const agreement_bounds UNBIASED = {0.0, 0.005, 0.02};
static const double TURN = 2.0 * 3.14159265358979323846;
enum { TEXT_SIZE = 1 << 17 };

/* As in test_program_motion.c: the plane z = 0 from -1 to 1 fills the picture, x to the right and y up, the eye at z =
 * -1; a sky of radiance 1 behind what is black. */
static const char SKY_AND_BLACK[] =
    "LookAt 0 0 -1 0 0 0 0 1 0 Camera \"perspective\" \"float fov\" 90\n"
    "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 32 PixelFilter \"box\" WorldBegin\n"
    "LightSource \"infinite\" \"rgb L\" [1 1 1] Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n";

/* A text that grows. */
typedef struct growing {
    char text[TEXT_SIZE];
    size_t length;
} growing;

static growing grown;

static void say(const char *format, ...)
{
    va_list values;
    va_start(values, format);
    const int length = vsnprintf(grown.text + grown.length, sizeof grown.text - grown.length, format, values);
    va_end(values);
    assert_true(length >= 0 && grown.length + (size_t)length < sizeof grown.text);
    grown.length += (size_t)length;
}

static void begin_saying(void)
{
    grown.length = 0;
    say("%s", SKY_AND_BLACK);
}

static double clamp(double x) { return fmin(fmax(x, 0.0), 1.0); }

/* How much of the time a point is not covered, of x to the right and y up from -1 to 1. */
typedef double uncovered_fn(double x, double y);

static void radiance_of_sky(const void *uncovered, double x, double y, double out_rgb[3])
{
    out_rgb[0] = out_rgb[1] = out_rgb[2] = (*(uncovered_fn *const *)uncovered)(2.0 * x - 1.0, 1.0 - 2.0 * y);
}

/* Of the scene that was said. */
static void expect_uncovered(const char *what, uncovered_fn *uncovered)
{
    static const char *const INTEGRATORS[] = {"--integrator=path", "--integrator=photonmap"};
    const char *scene = write_text("cover.pbrt", grown.text);
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
    return 1.0 - (clamp((x + 1.0) / 1.2) - clamp((x - 0.8 + 1.0) / 1.2));
}

#define CORNERS "-1 -2 0 -.2 -2 0 -1 2 0 -.2 2 0 "
#define SQUARE  "\"integer indices\" [0 1 2 2 1 3] "
#define BAND                                                                                                           \
    "Shape \"trianglemesh\" " SQUARE "\"integer motionsteps\" 2 \"point3 P\" [" CORNERS                                \
    "0.2 -2 0 1 -2 0 0.2 2 0 1 2 0] "

static void test_sliding_band(void **state)
{
    (void)state;
    begin_saying();
    say(BAND);
    expect_uncovered("band", uncovered_by_band);
    begin_saying();
    say("ObjectBegin \"b\" " BAND "ObjectEnd ObjectInstance \"b\"");
    expect_uncovered("band of an instance", uncovered_by_band);
    begin_saying(); /* half of the way each */
    say("ActiveTransform EndTime Translate .6 0 0 ActiveTransform All Shape \"trianglemesh\" " SQUARE
        "\"integer motionsteps\" 3 \"point3 P\" [" CORNERS "-.7 -2 0 .1 -2 0 -.7 2 0 .1 2 0 -.4 -2 0 .4 -2 0 -.4 2 0 "
        ".4 2 0]");
    expect_uncovered("band, by both", uncovered_by_band);
}

/* The picture is that of the same way by a matrix, but where a rounding moves an edge over a sample. */
static void test_translation_is_that_of_a_matrix(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        const char *integrator = i == 0 ? "--integrator=path" : "--integrator=photonmap";
        begin_saying();
        say("LightSource \"point\" \"point3 from\" [0 0 -3] Material \"diffuse\" \"rgb reflectance\" [.8 .5 .2] " BAND);
        picture by_vertices = RENDER(write_text("vertices.pbrt", grown.text), integrator, "--spp=16");
        begin_saying();
        say("LightSource \"point\" \"point3 from\" [0 0 -3] Material \"diffuse\" \"rgb reflectance\" [.8 .5 .2] "
            "ActiveTransform EndTime Translate 1.2 0 0 ActiveTransform All "
            "Shape \"trianglemesh\" " SQUARE "\"point3 P\" [" CORNERS "]");
        picture by_matrix = RENDER(write_text("matrix.pbrt", grown.text), integrator, "--spp=16");
        int different = 0;
        for (int k = 0; k < 3 * 32 * 32; k++)
            different += fabsf(by_vertices.pixels[k] - by_matrix.pixels[k]) > 1e-4f * by_matrix.pixels[k];
        print_message("%s: %d of %d values differ\n", integrator, different, 3 * 32 * 32);
        assert_true(different <= 12);
        picture_reset(&by_vertices);
        picture_reset(&by_matrix);
    }
}

/* Curves, flat ones and tubes, deform as they should, also within an object that is moved the other way. */
static void test_translation_of_curves_is_that_of_a_matrix(void **state)
{
    (void)state;
    static const char *const TYPES[] = {"flat", "cylinder"};
#define POINTS "-.6 -2 0 -.7 -.5 .1 -.5 .5 0 -.6 2 0 "
#define CURVE  "Shape \"curve\" \"string type\" \"%s\" \"float width\" .5 "
    for (int i = 0; i < 4; i++) {
        const char *integrator = i % 2 == 0 ? "--integrator=path" : "--integrator=photonmap", *type = TYPES[i / 2];
        begin_saying();
        say("LightSource \"point\" \"point3 from\" [0 0 -3] Material \"diffuse\" \"rgb reflectance\" [.8 .5 .2] " CURVE
            "\"integer motionsteps\" 2 \"point3 P\" [" POINTS ".6 -2 0 .5 -.5 .1 .7 .5 0 .6 2 0]",
            type);
        picture by_points = RENDER(write_text("points.pbrt", grown.text), integrator, "--spp=16");
        begin_saying();
        say("LightSource \"point\" \"point3 from\" [0 0 -3] Material \"diffuse\" \"rgb reflectance\" [.8 .5 .2] "
            "ActiveTransform EndTime Translate 1.2 0 0 ActiveTransform All " CURVE "\"point3 P\" [" POINTS "]",
            type);
        picture by_matrix = RENDER(write_text("matrix.pbrt", grown.text), integrator, "--spp=16");
        int different = 0;
        double all = 0.0;
        for (int k = 0; k < 3 * 32 * 32; k++) {
            different += fabsf(by_points.pixels[k] - by_matrix.pixels[k]) > 1e-3f * by_matrix.pixels[k];
            all += (double)by_points.pixels[k];
        }
        print_message("%s, %s: %d of %d values differ\n", integrator, type, different, 3 * 32 * 32);
        assert_true(different <= 12 && all > 0.0);
        picture_reset(&by_points);
        picture_reset(&by_matrix);
    }
}

/* A disc whose radius goes from 0.25 to 1.25. */
static double uncovered_by_disc(double x, double y) { return clamp(hypot(x, y) - 0.25); }

static void test_growing_disc(void **state)
{
    (void)state;
    enum { CORNERS_OF_DISC = 256 };
    static const double RADII[] = {0.25, 1.25};
    begin_saying();
    say("Shape \"trianglemesh\" \"integer motionsteps\" 2 \"integer indices\" [");
    for (int i = 0; i < CORNERS_OF_DISC; i++)
        say("0 %d %d ", 1 + i, 1 + (i + 1) % CORNERS_OF_DISC);
    say("] \"point3 P\" [");
    for (int k = 0; k < 2; k++) {
        say("0 0 0 ");
        for (int i = 0; i < CORNERS_OF_DISC; i++)
            say("%.9g %.9g 0 ", RADII[k] * cos(TURN * i / CORNERS_OF_DISC), RADII[k] * sin(TURN * i / CORNERS_OF_DISC));
    }
    say("]");
    expect_uncovered("growing disc", uncovered_by_disc);
}

/* Of a square the left half stands, and the right half turns a quarter round the line between them, away from the eye:
 * after an angle a its edge is seen at cos a / (1 + sin a), the tangent of (90 degrees - a) / 2. */
static double uncovered_by_flap(double x, double y)
{
    (void)y;
    return x < 0.0 ? 0.0 : atan(x) / (TURN / 8.0);
}

static void test_turning_half(void **state)
{
    (void)state;
    enum { STEPS = 129 };
    begin_saying();
    say("Shape \"trianglemesh\" \"integer motionsteps\" %d \"integer indices\" [0 1 2 2 1 3 1 4 3 3 4 5] \"point3 P\" [",
        STEPS);
    for (int k = 0; k < STEPS; k++) {
        const double a = TURN / 4.0 * k / (STEPS - 1), x = cos(a), z = sin(a);
        say("-1 -4 0 0 -4 0 -1 4 0 0 4 0 %.9g -4 %.9g %.9g 4 %.9g ", x, z, x, z);
    }
    say("]");
    expect_uncovered("turning half", uncovered_by_flap);
}

/* --- what bends reflects --- */

/* As moving_blocks: some of the indirect light is lost where light and what hides it go together. */
static void test_deforming_blocks(void **state)
{
    (void)state;
    static const agreement_bounds BOUNDS = {AGREEMENT_BLUR, 0.007, 0.03};
    compare_parts("deforming_blocks", "--spp=64", BOUNDS);
}

/* The sun lights a sheet that is stretched to four times its area while the shutter is open, and the sheet lights a
 * dark wall. The sheet's irradiance is the same at all times, so the map must count a photon by the area that its place
 * had when the shutter opened; else it is wrong by up to a factor of four. */
static void test_stretched_sheet(void **state)
{
    (void)state;
    static const char SHEET[] =
        "LookAt 0 3 -6 0 1.5 3 0 1 0 Camera \"perspective\" \"float fov\" 12\n"
        "Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 24 PixelFilter \"box\" WorldBegin\n"
        "LightSource \"distant\" \"rgb L\" [3 3 3] \"point3 from\" [0 1 0] \"point3 to\" [0 0 0]\n"
        "Material \"diffuse\" \"rgb reflectance\" [.9 .9 .9]\n"
        "Shape \"trianglemesh\" \"integer motionsteps\" 2 \"integer indices\" [0 1 2 2 1 3]\n"
        "\"point3 P\" [-1 0 -1 1 0 -1 -1 0 1 1 0 1 -2 0 -2 2 0 -2 -2 0 2 2 0 2]\n"
        "Material \"diffuse\" \"rgb reflectance\" [.05 .05 .05]\n"
        "Shape \"bilinearmesh\" \"point3 P\" [-3 0 3 3 0 3 -3 3 3 3 3 3]\n";
    static const agreement_bounds BOUNDS = {AGREEMENT_BLUR, 0.005, 0.03};
    compare_integrators_by(
        "stretched sheet", write_text("sheet.pbrt", SHEET),
        ARGUMENTS("--photons=2e5", "--nearest=16", "--gather-samples=16", "--spp=64", "--only=indirect"),
        ARGUMENTS("--integrator=path", "--spp=512", "--only=indirect"), BOUNDS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_sliding_band),
        TEST_IN_FOLDER(test_translation_is_that_of_a_matrix),
        TEST_IN_FOLDER(test_translation_of_curves_is_that_of_a_matrix),
        TEST_IN_FOLDER(test_growing_disc),
        TEST_IN_FOLDER(test_turning_half),
        TEST_IN_FOLDER(test_deforming_blocks),
        TEST_IN_FOLDER(test_stretched_sheet),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
