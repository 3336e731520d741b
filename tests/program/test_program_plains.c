/* test_program_plains.c: small things on a ground of kilometres under the sky: a house with a window, a glass ball.
 * Most photons would lie far away, and discs be as large as houses; the photon map must be as right as the path tracer
 * all the same. Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_agreement.h"

#define GRAY          "Material \"diffuse\" \"rgb reflectance\" [.5 .5 .5]\n"
#define QUAD(corners) "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [" corners "]\n"

/* A room of 4 x 3 x 5 with a window in its left wall; the ground is half a unit below its floor. */
#define HOUSE                                                                                                          \
    "Material \"diffuse\" \"rgb reflectance\" [.7 .68 .6]\n" QUAD("0 0 0 4 0 0 4 0 5 0 0 5")                           \
        QUAD("0 3 0 0 3 5 4 3 5 4 3 0") QUAD("4 0 0 4 3 0 4 3 5 4 0 5") QUAD("0 0 0 0 3 0 4 3 0 4 0 0")                \
            QUAD("0 0 5 4 0 5 4 3 5 0 3 5") QUAD("0 0 0 0 0 5 0 .8 5 0 .8 0") QUAD("0 2.2 0 0 2.2 5 0 3 5 0 3 0")      \
                QUAD("0 .8 0 0 .8 1 0 2.2 1 0 2.2 0") QUAD("0 .8 3.5 0 .8 5 0 2.2 5 0 2.2 3.5")

static void expect_both_alike(const char *what, const char *text, const char *const *path_arguments,
                              agreement_bounds bounds)
{
    compare_integrators_by(what, write_text("scene.pbrt", text), ARGUMENTS(AGREEMENT_MAP, "--spp=12"), path_arguments,
                           bounds);
}

/* The smaller ground was three times too bright before discs kept to the floor they lie on. */
static void test_a_house_with_a_window(void **state)
{
    (void)state;
    static const char *const SIZES[] = {"300", "10000"};
    char text[4096], name[64];
    for (int i = 0; i < 2; i++) {
        snprintf(text, sizeof text,
                 "LookAt 2.5 1.5 4.5  1 1.2 0  0 1 0\nCamera \"perspective\" \"float fov\" 60\nWorldBegin\n"
                 "LightSource \"infinite\" \"rgb L\" [.6 .8 1]\n" GRAY
                 "AttributeBegin Translate 0 -.5 0 Rotate -90 1 0 0 Shape \"disk\" \"float radius\" %s "
                 "AttributeEnd\n" HOUSE GRAY QUAD("1.2 1 .8 2 1 .8 2 1 1.6 1.2 1 1.6"),
                 SIZES[i]);
        snprintf(name, sizeof name, "a ground of %s", SIZES[i]);
        expect_both_alike(name, text, ARGUMENTS("--integrator=path", "--spp=128"),
                          (agreement_bounds){2.0 * AGREEMENT_BLUR, 0.004, 0.03}); /* few photons are in the house */
    }
}

/* The light that the glass gathers was missing once. */
static void test_a_glass_ball(void **state)
{
    (void)state;
    expect_both_alike("a glass ball",
                      "LookAt 0 2 5  0 .7 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\nWorldBegin\n"
                      "LightSource \"infinite\" \"rgb L\" [.6 .8 1]\n" GRAY
                      "AttributeBegin Rotate -90 1 0 0 Shape \"disk\" \"float radius\" 10000 AttributeEnd\n"
                      "Material \"dielectric\" Translate 0 1.01 0 Shape \"sphere\"\n",
                      ARGUMENTS("--integrator=path", "--spp=64"), (agreement_bounds){AGREEMENT_BLUR, 0.004, 0.03});
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_a_house_with_a_window),
        TEST_IN_FOLDER(test_a_glass_ball),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
