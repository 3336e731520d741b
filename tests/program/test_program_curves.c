/* test_program_curves.c: light on curves: a furnace in which they cannot be seen, a tube as bright as a cylinder, and a
 * tuft of hair on a floor that both integrators show alike, all light and indirect light alone; and so what ribbons of
 * hair send to a floor. Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_agreement.h"

static const char *const INTEGRATORS[] = {"--integrator=photonmap", "--integrator=path"};
enum { INTEGRATOR_COUNT = 2 };
/* For scenes that nearly all photons leave at once: without it many more are traced, and in vain. What else changes
 * with it is as by default. */
#define FEW_PATHS "--photon-paths=1e5", "--caustic-photons=0", "--photon-aim=0.8", "--gather-guiding=0.5"
static const agreement_bounds BOUNDS = {AGREEMENT_BLUR, 0.007, 0.05}, UNBIASED = {0.0, 0.003, 0.02};

static void test_curves_in_a_furnace(void **state)
{
    (void)state;
    agreement_means exact = agreement_uniform(1.5, 1.5, 1.5);
    for (int k = 0; k < INTEGRATOR_COUNT; k++) {
        agreement_means means = agreement_render(PROGRAM_SCENES "curves_in_furnace.pbrt",
                                                 ARGUMENTS(INTEGRATORS[k], "--spp=64", "--max-depth=64", FEW_PATHS));
        expect_agreement(INTEGRATORS[k], &means, &exact, k == 0 ? BOUNDS : UNBIASED);
    }
}

/* Hair without colour, which keeps all light, cannot be seen in a furnace either. */
static void test_white_hair_in_a_furnace(void **state)
{
    (void)state;
    static const char TEXT[] = "LookAt 0 -5 1  0 0 1  0 0 1\nCamera \"perspective\" \"float fov\" 20\nPixelFilter "
                               "\"box\"\nWorldBegin\nLightSource \"infinite\" \"rgb L\" [1.5 1.5 1.5]\nMaterial "
                               "\"hair\" \"float eumelanin\" 0 \"float beta_m\" .4\n"
                               "Shape \"curve\" \"float width\" .4 \"point3 P\" [-.5 0 0 0 0 .5 0 0 1.5 .5 0 2]\n"
                               "Shape \"curve\" \"string type\" \"cylinder\" \"float width\" .5 \"point3 P\" "
                               "[-2 .5 .5 -1 .5 1.5 1 .5 .5 2 .5 1.5]\n";
    const char *scene = write_text("white.pbrt", TEXT);
    agreement_means exact = agreement_uniform(1.5, 1.5, 1.5);
    for (int k = 0; k < INTEGRATOR_COUNT; k++) {
        agreement_means means = agreement_render(scene, ARGUMENTS(INTEGRATORS[k], "--spp=64", FEW_PATHS));
        expect_agreement(INTEGRATORS[k], &means, &exact, k == 0 ? BOUNDS : UNBIASED);
    }
}

#define UNDER_A_LAMP                                                                                                   \
    "LookAt 0 -5 1  0 0 1  0 0 1\nCamera \"perspective\" \"float fov\" 20\nPixelFilter \"box\"\nWorldBegin\n"          \
    "LightSource \"distant\" \"point3 from\" [1 -1 1] \"point3 to\" [0 0 0]\nLightSource \"infinite\" \"rgb L\" "      \
    "[.1 .1 .1]\nMaterial \"diffuse\" \"rgb reflectance\" [.5 .5 .5]\n"

static void test_a_tube_is_as_bright_as_a_cylinder(void **state)
{
    (void)state;
    static const char *const SHAPES[] = {
        UNDER_A_LAMP "Shape \"cylinder\" \"float radius\" .5 \"float zmin\" 0 \"float zmax\" 2\n",
        UNDER_A_LAMP "Shape \"curve\" \"string type\" \"cylinder\" \"point3 P\" [0 0 0 0 0 .5 0 0 1.5 0 0 2]\n"};
    agreement_means cylinder =
        agreement_render(write_text("cylinder.pbrt", SHAPES[0]), ARGUMENTS("--integrator=path", "--spp=32"));
    const char *tube = write_text("tube.pbrt", SHAPES[1]);
    for (int k = 0; k < INTEGRATOR_COUNT; k++) {
        agreement_means means = agreement_render(tube, ARGUMENTS(INTEGRATORS[k], "--spp=32", FEW_PATHS));
        expect_agreement(INTEGRATORS[k], &means, &cylinder, UNBIASED);
    }
}

static double hash(unsigned n)
{
    n = (n ^ 61u ^ (n >> 16)) * 9u;
    n = (n ^ (n >> 4)) * 0x27d4eb2du;
    return (n ^ (n >> 15)) * 0x1p-32;
}

/* materials: of the tubes, the flat ones and the ribbons. */
static const char *write_tuft(const char *const materials[3])
{
    static char text[400000];
    static const char *const TYPES[] = {"cylinder", "flat", "ribbon"};
    size_t n = (size_t)snprintf(text, sizeof text, "Include \"" PROGRAM_SCENES "tuft.pbrt\"\n");
    for (unsigned i = 0; i < 900; i++) {
        double r = 0.7 * sqrt(hash(7 * i)), a = 6.283185307 * hash(7 * i + 1), x = r * cos(a), y = r * sin(a);
        double lean = 0.5 + 0.5 * hash(7 * i + 2), h = 0.6 + 0.5 * hash(7 * i + 3);
        if (i % 300 == 0)
            n += (size_t)snprintf(text + n, sizeof text - n, "Material %s\n", materials[i / 300]);
        n += (size_t)snprintf(text + n, sizeof text - n,
                              "Shape \"curve\" \"string type\" \"%s\" \"float width0\" .03 \"float width1\" .01 "
                              "\"point3 P\" [%g %g -.01 %g %g %g %g %g %g %g %g %g]%s\n",
                              TYPES[i / 300], x, y, x, y, h / 2, x * (1 + lean / 2), y * (1 + lean / 2), h,
                              x * (1 + lean), y * (1 + lean), h * .9, i < 600 ? "" : " \"normal N\" [1 0 0 0 1 0]");
        assert_true(n < sizeof text - 1000);
    }
    return write_text("tuft.pbrt", text);
}

/* Most of the time goes into photons, and of ninety caustic paths one stores a photon: so few are asked for, and there
 * are more samples. */
#define HAIR_MAP "--photons=1e5", "--gather-samples=4"

static void test_a_tuft_of_hair(void **state)
{
    (void)state;
    static const char *const MATTE[3] = {"\"diffuse\" \"rgb reflectance\" [.8 .5 .3]",
                                         "\"diffuse\" \"rgb reflectance\" [.4 .7 .4]",
                                         "\"diffuse\" \"rgb reflectance\" [.7 .7 .8]"};
    const char *scene = write_tuft(MATTE);
    compare_integrators_by("hair", scene, ARGUMENTS(HAIR_MAP, "--caustic-photons=2e3", "--nearest=16", "--spp=16"),
                           ARGUMENTS("--integrator=path", "--spp=64"), BOUNDS);
    compare_integrators_by("hair, indirect", scene,
                           ARGUMENTS(HAIR_MAP, "--caustic-photons=1e4", "--nearest=16", "--spp=24", "--only=indirect"),
                           ARGUMENTS("--integrator=path", "--spp=128", "--only=indirect"), BOUNDS);
}

/* Hair as it scatters: photons that go on from hair to the floor are those of the eye's ways back. It sends the light
 * of lamps on to the floor and other hair. */
static void test_a_tuft_of_fibres(void **state)
{
    (void)state;
    static const char *const HAIR[3] = {"\"hair\" \"float eumelanin\" .3",
                                        "\"hair\" \"rgb color\" [.5 .5 .5] \"float beta_m\" .5 \"float beta_n\" .5",
                                        "\"hair\" \"rgb sigma_a\" [.1 .2 .4] \"float alpha\" 3"};
    compare_integrators_by("fibres", write_tuft(HAIR),
                           ARGUMENTS(HAIR_MAP, "--caustic-photons=1e4", "--nearest=8", "--spp=10"),
                           ARGUMENTS("--integrator=path", "--spp=64"), BOUNDS);
}

/* A lamp, a ribbon of hair and the floor beside it, which shows nothing but what the ribbon sends there. */
static const char *write_ribbon(const char *normals, double width)
{
    static char text[1024];
    snprintf(text, sizeof text,
             "LookAt 1.5 0 5  1.5 0 0  0 1 0\n"
             "Camera \"orthographic\" \"float screenwindow\" [-.5 .5 -.5 .5]\n"
             "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\nWorldBegin\n"
             "LightSource \"distant\" \"point3 from\" [.2 0 1] \"point3 to\" [0 0 0] \"rgb L\" [3 3 3]\n"
             "Material \"hair\" \"float eumelanin\" 0 \"float beta_m\" .8 \"float beta_n\" .9\n"
             "Shape \"curve\" \"string type\" \"ribbon\" \"normal N\" [%s] \"float width\" %g "
             "\"point3 P\" [0 -2 1 0 -.7 1 0 .7 1 0 2 1]\nMaterial \"diffuse\"\n"
             "Shape \"bilinearmesh\" \"point3 P\" [-4 -4 0 4 -4 0 -4 4 0 4 4 0]\n",
             normals, width);
    return write_text("ribbon.pbrt", text);
}

/* caustic_photons: as many as make the noise two hundredths of a block. */
static void compare_ribbon(const char *what, const char *scene, const char *caustic_photons)
{
    static const agreement_bounds RIBBON = {AGREEMENT_BLUR, 0.006, 0.035};
    compare_integrators_by(
        what, scene,
        ARGUMENTS("--max-depth=2", "--only=indirect", "--photons=2e4", caustic_photons, "--nearest=32", "--spp=16"),
        ARGUMENTS("--max-depth=2", "--only=indirect", "--integrator=path", "--spp=1024"), RIBBON);
}

/* A ribbon of hair that the lamp meets at a slant: as much flux goes on as its own normal lets arrive. */
static void test_a_slanting_ribbon_of_fibres(void **state)
{
    (void)state;
    compare_ribbon("ribbon", write_ribbon("1 0 0 1 0 0", 0.6), "--caustic-photons=2e5");
}

/* One that twists while its normals lean along it: as wide and turned as they say, for photons as for the eye. */
static void test_a_twisting_ribbon_of_fibres(void **state)
{
    (void)state;
    compare_ribbon("twisting ribbon", write_ribbon("1 3 0 0 -3 1", 1.2), "--caustic-photons=1e5");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_curves_in_a_furnace),
        TEST_IN_FOLDER(test_white_hair_in_a_furnace),
        TEST_IN_FOLDER(test_a_tube_is_as_bright_as_a_cylinder),
        TEST_IN_FOLDER(test_a_tuft_of_hair),
        TEST_IN_FOLDER(test_a_tuft_of_fibres),
        TEST_IN_FOLDER(test_a_slanting_ribbon_of_fibres),
        TEST_IN_FOLDER(test_a_twisting_ribbon_of_fibres),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
