/* test_program_surface.c: pictures of surfaces that are not wholly there, whose answer is known: white alpha surfaces
 * in a furnace, a lamp through a black one, lamps that are invisible or there in part. Flow: tests of the whole
 * program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_picture.h"

static const double PI = 3.14159265358979323846;
static const char *const INTEGRATORS[] = {"photonmap", "path"};
enum { INTEGRATOR_COUNT = 2, BLOCK = 8 };

static void test_alpha_in_a_furnace(void **state)
{
    (void)state;
    for (int k = 0; k < INTEGRATOR_COUNT; k++) {
        picture p = RENDER(PROGRAM_SCENES "alpha_in_furnace.pbrt", "--integrator", INTEGRATORS[k], "--photons=400000",
                           "--spp", k == 0 ? "4" : "128");
        expect_uniform(INTEGRATORS[k], &p, 2.0, 0.01, BLOCK, 0.03);
        picture_reset(&p);
    }
}

/* Holes smaller than an estimate's disc: what is there is lit as if the whole were. */
static void test_fine_nets_in_a_furnace(void **state)
{
    (void)state;
    static const char SPHERE[] = "Shape \"sphere\" \"float radius\" 2";
    static const char NETS[] =
        "Shape \"sphere\" \"float radius\" 2\nReverseOrientation\n"
        "Texture \"holes\" \"float\" \"checkerboard\" \"float uscale\" 60 \"float vscale\" 60 \"float tex1\" 1 "
        "\"float tex2\" 0\nAttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [0 0 0]\n"
        "Material \"diffuse\" \"rgb reflectance\" [1 1 1]\n"
        "Shape \"bilinearmesh\" \"point3 P\" [-0.8 -0.6 0.3  0.7 -0.7 0.4  -0.8 0.7 0.2  0.6 0.7 0.5] "
        "\"point2 uv\" [0 0 1 0 0 1 1 1] \"texture alpha\" \"holes\"\n"
        "Translate 0.2 0 0.9\nShape \"sphere\" \"float radius\" 0.4 \"texture alpha\" \"holes\"\nAttributeEnd\n";
    const char *scene = SCENE_WITH("furnace.pbrt", SPHERE, NETS);
    for (int k = 0; k < INTEGRATOR_COUNT; k++) {
        picture p = RENDER(scene, "--integrator", INTEGRATORS[k], "--photons=400000", "--spp", k == 0 ? "4" : "128");
        expect_uniform(INTEGRATORS[k], &p, 2.0, 0.01, BLOCK, 0.04);
        picture_reset(&p);
    }
}

/* The floor of tests/scenes/floor.pbrt, under a point lamp with these shapes between. */
static picture floor_under(const char *between, const char *integrator)
{
    char text[1024];
    snprintf(text, sizeof text,
             "Include \"" PROGRAM_SCENES "lamp_point.pbrt\"\nMaterial \"diffuse\" \"rgb reflectance\" [0 0 0]\n%s\n",
             between);
    return RENDER(write_text("scene.pbrt", text), "--integrator", integrator, "--spp=512", "--photons=10000",
                  "--gather-samples=4");
}

static void test_lamp_through_alpha_surfaces(void **state)
{
    (void)state;
    static const struct {
        const char *between;
        double share;
    } CASES[] = {
        {"Shape \"bilinearmesh\" \"point3 P\" [-4 -4 1.2  4 -4 1.2  -4 4 1.2  4 4 1.2] \"float alpha\" 0.3", 0.7},
        {"Translate 0.3 0.2 1.5 Shape \"sphere\" \"float radius\" 0.3 \"float alpha\" 0.4", 0.6},
        {"Translate 0.3 0.2 1.3 Shape \"disk\" \"float radius\" 3 \"float alpha\" 0.5 Translate 0 0 -0.1 Shape "
         "\"disk\" "
         "\"float radius\" 4 \"float alpha\" 0.2",
         0.4},
    };
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < INTEGRATOR_COUNT; k++) {
            picture p = floor_under(CASES[i].between, INTEGRATORS[k]);
            double sum = 0.0;
            for (int y = 0; y < p.height; y++)
                for (int x = 0; x < p.width; x++) {
                    double dx = 2.0 * (x + 0.5) / p.width - 1.0 - 0.3, dy = 1.0 - 2.0 * (y + 0.5) / p.height - 0.2;
                    sum += 0.6 / PI * 10.0 * 1.5 / pow(dx * dx + dy * dy + 1.5 * 1.5, 1.5);
                }
            expect_near(CASES[i].between, picture_mean(&p, 1), CASES[i].share * sum / (p.width * p.height), 0.01);
            picture_reset(&p);
        }
}

/* The floor under a rectangular lamp is as bright when the lamp is invisible, and dimmed by its share when it is there
 * in part. */
static void test_lamps_that_are_alpha_surfaces(void **state)
{
    (void)state;
    static const struct {
        const char *alpha;
        double share;
    } CASES[] = {{"\"float alpha\" 0", 1.0}, {"\"float alpha\" 0.4", 0.4}, {"\"texture alpha\" \"mask\"", 0.5}};
    picture whole = RENDER(PROGRAM_SCENES "lamp_rectangle.pbrt", "--spp=64", "--photons=10000", "--gather-samples=4",
                           "--integrator=path");
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < INTEGRATOR_COUNT; k++) {
            char with_alpha[256];
            snprintf(with_alpha, sizeof with_alpha, "0.8 0.3 1.5] %s", CASES[i].alpha);
            const char *scene =
                SCENE_WITH("lamp_rectangle.pbrt", "Include \"floor.pbrt\"", "Include \"" PROGRAM_SCENES "floor.pbrt\"",
                           "0.8 0.3 1.5]", with_alpha, "AreaLightSource",
                           "Texture \"mask\" \"float\" \"checkerboard\" \"float uscale\" 16 \"float vscale\" 16 "
                           "\"float tex1\" 1 \"float tex2\" 0\nAreaLightSource");
            picture p =
                RENDER(scene, "--integrator", INTEGRATORS[k], "--spp=128", "--photons=10000", "--gather-samples=4");
            expect_near(CASES[i].alpha, picture_mean(&p, 1), CASES[i].share * picture_mean(&whole, 1), 0.01);
            for (int y = 0; y < p.height; y += BLOCK)
                for (int x = 0; x < p.width; x += BLOCK)
                    expect_near(CASES[i].alpha, picture_block(&p, x, y, BLOCK, 1),
                                CASES[i].share * picture_block(&whole, x, y, BLOCK, 1), 0.04);
            picture_reset(&p);
        }
    picture_reset(&whole);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_alpha_in_a_furnace),
        TEST_IN_FOLDER(test_fine_nets_in_a_furnace),
        TEST_IN_FOLDER(test_lamp_through_alpha_surfaces),
        TEST_IN_FOLDER(test_lamps_that_are_alpha_surfaces),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
