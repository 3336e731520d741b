/* test_program_plains.c: small things on a ground of kilometres under the sky: a house with a window, a glass ball.
 * Most photons would lie far away, and discs be as large as houses; the photon map must be as right as the path tracer
 * all the same. Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_agreement.h"

#define GRAY          "Material \"diffuse\" \"rgb reflectance\" [.5 .5 .5]\n"
#define WALLS         "Material \"diffuse\" \"rgb reflectance\" [.7 .68 .6]\n"
#define QUAD(corners) "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [" corners "]\n"

/* A room of 4 x 3 x 5 with a window in its left wall; the ground is half a unit below its floor. */
#define HOUSE                                                                                                          \
    QUAD("0 0 0 4 0 0 4 0 5 0 0 5")                                                                                    \
    QUAD("0 3 0 0 3 5 4 3 5 4 3 0")                                                                                    \
    QUAD("4 0 0 4 3 0 4 3 5 4 0 5")                                                                                    \
    QUAD("0 0 0 0 3 0 4 3 0 4 0 0")                                                                                    \
    QUAD("0 0 5 4 0 5 4 3 5 0 3 5")                                                                                    \
    QUAD("0 0 0 0 0 5 0 .8 5 0 .8 0")                                                                                  \
    QUAD("0 2.2 0 0 2.2 5 0 3 5 0 3 0") QUAD("0 .8 0 0 .8 1 0 2.2 1 0 2.2 0") QUAD("0 .8 3.5 0 .8 5 0 2.2 5 0 2.2 3.5")

/* The house on a ground, which is of the first material, its walls of the second. */
static void expect_house_alike(const char *what, const char *size, const char *ground, const char *walls)
{
    char text[4096];
    snprintf(text, sizeof text,
             "LookAt 2.5 1.5 4.5  1 1.2 0  0 1 0\nCamera \"perspective\" \"float fov\" 60\nWorldBegin\n"
             "LightSource \"infinite\" \"rgb L\" [.6 .8 1]\n%s"
             "AttributeBegin Translate 0 -.5 0 Rotate -90 1 0 0 Shape \"disk\" \"float radius\" %s "
             "AttributeEnd\n%s" HOUSE GRAY QUAD("1.2 1 .8 2 1 .8 2 1 1.6 1.2 1 1.6"),
             ground, size, walls);
    compare_integrators_by(what, write_text("scene.pbrt", text),
                           ARGUMENTS(AGREEMENT_MAP, "--photons=3e5", "--nearest=10", "--spp=24"),
                           ARGUMENTS("--integrator=path", "--spp=128"),
                           (agreement_bounds){2.0 * AGREEMENT_BLUR, 0.004, 0.03}); /* few photons are in the house */
}

/* The smaller ground was three times too bright before discs kept to the floor they lie on. */
static void test_a_house_with_a_window(void **state)
{
    (void)state;
    expect_house_alike("a ground of 300", "300", GRAY, WALLS);
    expect_house_alike("a ground of 10000", "10000", GRAY, WALLS);
}

/* By a coat the ground far away sends single caustics through the window, of which one was brighter than all others. */
static void test_a_house_on_glossy_ground(void **state)
{
    (void)state;
    expect_house_alike("a glossy ground", "300",
                       "Material \"coateddiffuse\" \"rgb reflectance\" [.5 .5 .5] \"float roughness\" .2\n",
                       "Material \"coateddiffuse\" \"rgb reflectance\" [.7 .68 .6] \"float roughness\" .1\n");
}

/* The light that the glass gathers was missing once. */
static void test_a_glass_ball(void **state)
{
    (void)state;
    const char *scene =
        write_text("scene.pbrt", "LookAt 0 2 5  0 .7 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\nWorldBegin\n"
                                 "LightSource \"infinite\" \"rgb L\" [.6 .8 1]\n" GRAY
                                 "AttributeBegin Rotate -90 1 0 0 Shape \"disk\" \"float radius\" 10000 AttributeEnd\n"
                                 "Material \"dielectric\" Translate 0 1.01 0 Shape \"sphere\"\n");
    compare_integrators_by("a glass ball", scene, ARGUMENTS(AGREEMENT_MAP, "--photons=1e5", "--nearest=8", "--spp=12"),
                           ARGUMENTS("--integrator=path", "--spp=64"), (agreement_bounds){AGREEMENT_BLUR, 0.004, 0.03});
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_a_house_with_a_window),
        TEST_IN_FOLDER(test_a_house_on_glossy_ground),
        TEST_IN_FOLDER(test_a_glass_ball),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
