/* test_program_media.c: pictures through media that absorb, whose answer is known: tests/scenes/absorbing_*.pbrt derive
 * it in their heads. Both integrators must give it, whatever bounds the media: an interface, a dielectric that bends
 * nothing, triangles, a surface turned inside out.
 * Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_picture.h"

static const double PI = 3.14159265358979323846;
static const char *const INTEGRATORS[] = {"photonmap", "path"};
enum { INTEGRATOR_COUNT = 2, BLOCK = 8 };

static const char *spp_of(int integrator) { return integrator == 0 ? "2" : "128"; }

/* ---- spheres ---- */

static const double TEA[3] = {0.1, 0.3, 0.9}, WINE[3] = {0.1, 0.4, 0.25}, WALL = 2.0, BALL = 1.2, RHO = 0.5;

static double left_to_the_wall(int c) { return exp(-TEA[c] * BALL - WINE[c] * (WALL - BALL)); }

/* T of absorbing_spheres.pbrt, by midpoints. */
static double mean_left_between_walls(int c)
{
    enum { STEPS = 200000 };
    double sum = 0.0;
    for (int i = 0; i < STEPS; i++) {
        double d = 2.0 * WALL * (i + 0.5) / STEPS;
        double in_ball = 2.0 * sqrt(fmax(0.0, BALL * BALL - WALL * WALL + d * d / 4.0));
        sum += d / (2.0 * WALL * WALL) * exp(-TEA[c] * in_ball - WINE[c] * (d - in_ball));
    }
    return sum * 2.0 * WALL / STEPS;
}

static void expect_color(const char *what, const picture *p, const double expected[3], double of_mean, double of_block)
{
    for (int c = 0; c < 3; c++) {
        expect_near(what, picture_mean(p, c), expected[c], of_mean);
        for (int y = 0; y < p->height; y += BLOCK)
            for (int x = 0; x < p->width; x += BLOCK)
                expect_near(what, picture_block(p, x, y, BLOCK, c), expected[c], of_block);
    }
}

static void expect_spheres(const char *scene, int integrator)
{
    double expected[3];
    for (int c = 0; c < 3; c++) {
        double t = left_to_the_wall(c);
        expected[c] = RHO / PI * 10.0 * t / (WALL * WALL * (1.0 - RHO * mean_left_between_walls(c))) * t;
    }
    picture p = RENDER(scene, "--integrator", INTEGRATORS[integrator], "--photons=300000", "--caustic-photons=300000",
                       "--spp", spp_of(integrator));
    expect_color(INTEGRATORS[integrator], &p, expected, 0.01, 0.04);
    picture_reset(&p);
}

static void test_light_and_eye_in_a_ball(void **state)
{
    (void)state;
    for (int k = 0; k < INTEGRATOR_COUNT; k++)
        expect_spheres(PROGRAM_SCENES "absorbing_spheres.pbrt", k);
}

/* ReverseOrientation turns over what is inside. */
static void test_ball_turned_inside_out(void **state)
{
    (void)state;
    for (int k = 0; k < INTEGRATOR_COUNT; k++)
        expect_spheres(SCENE_WITH("absorbing_spheres.pbrt", "MediumInterface \"tea\" \"wine\"",
                                  "ReverseOrientation MediumInterface \"wine\" \"tea\""),
                       k);
}

/* The interface is made after its use, and one of the media too. */
static void test_things_made_after_their_use(void **state)
{
    (void)state;
    expect_spheres(
        SCENE_WITH("absorbing_spheres.pbrt", "Material \"interface\"", "NamedMaterial \"nothing\"",
                   "MediumInterface \"wine\" \"\"",
                   "MediumInterface \"wine\" \"\" MakeNamedMaterial \"nothing\" \"string type\" \"interface\""),
        0);
}

/* A dielectric of index 1: all light passes it, but as a scattered ray: photons are caustic ones, shadow rays end
 * there. The path tracer cannot find a point light behind it. */
static void test_ball_of_index_one(void **state)
{
    (void)state;
    expect_spheres(
        SCENE_WITH("absorbing_spheres.pbrt", "Material \"interface\"", "Material \"dielectric\" \"float eta\" 1"), 0);
}

/* The wall shines: lamps whose light starts in a medium, met by scattered rays. */
static void test_shining_wall(void **state)
{
    (void)state;
    double expected[3];
    for (int c = 0; c < 3; c++)
        expected[c] = left_to_the_wall(c) / (1.0 - RHO * mean_left_between_walls(c));
    for (int k = 0; k < INTEGRATOR_COUNT; k++) {
        const char *scene = SCENE_WITH("absorbing_spheres.pbrt", "LightSource \"point\" \"rgb I\" [10 10 10]", "",
                                       "MediumInterface \"wine\" \"\"",
                                       "MediumInterface \"\" \"wine\" ReverseOrientation AreaLightSource \"diffuse\"");
        picture p = RENDER(scene, "--integrator", INTEGRATORS[k], "--photons=300000", "--spp", spp_of(k));
        expect_color(INTEGRATORS[k], &p, expected, 0.01, 0.03);
        picture_reset(&p);
    }
}

/* ---- a slab over a floor ---- */

/* The mean over a pixel, from 4 x 4 points; x runs to the left. */
static double slab_pixel(const picture *p, int i, int j, double sigma)
{
    enum { POINTS = 4 };
    double sum = 0.0;
    for (int k = 0; k < POINTS * POINTS; k++) {
        double x = 1.0 - 2.0 * (i + (k % POINTS + 0.5) / POINTS) / p->width;
        double y = 1.0 - 2.0 * (j + (k / POINTS + 0.5) / POINTS) / p->height;
        double d = sqrt((x - 0.3) * (x - 0.3) + (y - 0.2) * (y - 0.2) + 2.25), v = sqrt(x * x + y * y + 1.0);
        sum += 0.6 / PI * 10.0 * 1.5 / (d * d * d) * exp(-sigma * (d / 3.0 + v / 2.0));
    }
    return sum / (POINTS * POINTS);
}

static void expect_slab(const char *what, const char *scene, int integrator, const double sigma[3])
{
    picture p = RENDER(scene, "--integrator", INTEGRATORS[integrator], "--spp", "16", "--photons", "10000",
                       "--gather-samples", "16");
    for (int c = 0; c < 3; c++) {
        double sum = 0.0;
        for (int y = 0; y < p.height; y++)
            for (int x = 0; x < p.width; x++) {
                double expected = slab_pixel(&p, x, y, sigma[c]);
                sum += expected;
                expect_near(what, picture_block(&p, x, y, 1, c), expected, 0.03);
            }
        expect_near(what, picture_mean(&p, c), sum / (p.width * p.height), 0.001);
    }
    picture_reset(&p);
}

static void test_slab_over_a_floor(void **state)
{
    (void)state;
    static const double AMBER[3] = {0.5, 1.0, 3.0}, NOTHING[3] = {0.0, 0.0, 0.0};
    for (int k = 0; k < INTEGRATOR_COUNT; k++) {
        expect_slab(INTEGRATORS[k], PROGRAM_SCENES "absorbing_slab.pbrt", k, AMBER);
        /* interfaces with the same on both sides are not there */
        expect_slab("nothing", SCENE_WITH("absorbing_slab.pbrt", "MediumInterface \"amber\" \"\"", ""), k, NOTHING);
        expect_slab("amber everywhere, but for the slab's surfaces",
                    SCENE_WITH("absorbing_slab.pbrt", "MediumInterface \"amber\" \"\"",
                               "MediumInterface \"amber\" \"amber\"", "[0.5 1 3]", "[0 0 0]"),
                    k, NOTHING);
    }
}

/* Nothing is left of light that comes from infinitely far through a medium without bound; by photons neither. */
static void test_sun_in_a_boundless_medium(void **state)
{
    (void)state;
    for (int k = 0; k < INTEGRATOR_COUNT; k++) {
        const char *scene =
            SCENE_WITH("absorbing_slab.pbrt", "LookAt", "MediumInterface \"\" \"amber\" LookAt", "[0.5 1 3]",
                       "[0.5 1 0]", "LightSource \"point\" \"rgb I\" [10 10 10] \"point3 from\" [0.3 0.2 1.5]",
                       "LightSource \"infinite\" LightSource \"distant\" \"point3 from\" [0 0 1] \"point3 to\" [0 0 0]",
                       "MediumInterface \"amber\" \"\"", "MediumInterface \"amber\" \"amber\"");
        picture p = RENDER(scene, "--integrator", INTEGRATORS[k], "--spp", "16", "--photons", "20000");
        for (int c = 0; c < 2; c++)
            assert_true(picture_mean(&p, c) == 0.0);
        /* the sun's irradiance is 1, the sky's pi */
        expect_near("the channel that is not absorbed", picture_mean(&p, 2), 0.6 / PI * (1.0 + PI), 0.01);
        picture_reset(&p);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_light_and_eye_in_a_ball),
        TEST_IN_FOLDER(test_ball_turned_inside_out),
        TEST_IN_FOLDER(test_things_made_after_their_use),
        TEST_IN_FOLDER(test_ball_of_index_one),
        TEST_IN_FOLDER(test_shining_wall),
        TEST_IN_FOLDER(test_slab_over_a_floor),
        TEST_IN_FOLDER(test_sun_in_a_boundless_medium),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
