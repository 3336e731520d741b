/* test_program_direct_guiding.c: direct light guided by what a pilot has seen: the irradiance below a window in a roof
 * is that of its form factor, with a fraction of the noise; and parts of a picture have the bits of the whole.
 * Flow: tests of the whole program. Threads: the program's. */
/* ctest: sanitize */
#define _GNU_SOURCE
#include "fixtures/program_agreement.h"
#include "fixtures/sanitizer.h"

#define GUIDED   "--direct-guiding=0.8"
#define UNGUIDED "--direct-guiding=0"
#define ROOF     PROGRAM_SCENES "roof_window.pbrt"
#define DIRECT   "--max-depth=1"
#define SUN_AND_SKY                                                                                                    \
    "LightSource \"infinite\" \"rgb L\" [0.3 0.4 0.6] LightSource \"distant\" \"rgb L\" [6 5 4] \"point3 from\" [3 "   \
    "-1 3] \"point3 to\" [0 0 0]"

/* Radiance of the floor below the window: four quarters of a parallel rectangle, seen from under their corner. */
static double radiance_below_window(void)
{
    double x = 0.25 / 3.0, root = sqrt(1.0 + x * x), factor = 4.0 / M_PI * (x / root) * atan(x / root);
    return 0.5 * factor; /* E = pi L factor */
}

/* Mean of the green channel, and its standard error by how pixels differ: they are independent enough, and alike. */
typedef struct mean_and_error {
    double mean, error, variance;
} mean_and_error;

static mean_and_error measure(const picture *p)
{
    int count = p->width * p->height;
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < count; i++) {
        double value = (double)p->pixels[3 * i + 1];
        sum += value;
        squares += value * value;
    }
    double mean = sum / count, variance = (squares / count - mean * mean) * count / (count - 1);
    return (mean_and_error){mean, sqrt(variance / count), variance};
}

static void expect_form_factor(const char *what, mean_and_error m)
{
    double expected = radiance_below_window();
    print_message("%s: %.6f, standard error %.6f, variance of a pixel %.3g; expected %.6f\n", what, m.mean, m.error,
                  m.variance, expected);
    assert_true(m.error < 0.05 * expected);
    assert_true(fabs(m.mean - expected) < 3.0 * m.error + 1e-3 * expected);
}

/* All three ways have one shadow ray and one scattered ray a sample. */
static void test_form_factor_and_noise(void **state)
{
    (void)state;
    if (IS_SANITIZED)
        skip(); /* statistics of what other tests run here */
    picture plain = RENDER(ROOF, "--integrator=path", DIRECT, UNGUIDED, "--spp=256");
    picture guided = RENDER(ROOF, "--integrator=path", DIRECT, GUIDED, "--spp=64");
    picture map = RENDER(ROOF, DIRECT, GUIDED, "--spp=64", "--gather-samples=8");
    mean_and_error a = measure(&plain), b = measure(&guided), c = measure(&map);
    expect_form_factor("unguided", a);
    expect_form_factor("guided", b);
    expect_form_factor("photon map, guided", c);
    assert_true(4.0 * a.variance > 4.0 * b.variance); /* of a fourth as many samples: it was 5.8 times less */
    picture_reset(&plain);
    picture_reset(&guided);
    picture_reset(&map);
}

/* A sun that is not seen from there, and a lamp that is; the light adds up as it does unguided. */
static void test_shares_of_lights(void **state)
{
    (void)state;
    if (IS_SANITIZED)
        skip(); /* statistics of what other tests run here */
    char scene[160];
    snprintf(
        scene, sizeof scene, "%s",
        SCENE_WITH("roof_window.pbrt", "# EVEN_SKY",
                   "\nLightSource \"distant\" \"rgb L\" [20 20 20] \"point3 from\" [3 1 0] \"point3 to\" [0 0 0]\n"
                   "LightSource \"distant\" \"rgb L\" [0.02 0.02 0.02] \"point3 from\" [0 1 0] \"point3 to\" [0 0 0]\n",
                   "# THE_LAMPS", "LightSource \"point\" \"rgb I\" [0.01 0.01 0.01] \"point3 from\" [1 1 0]"));
    picture plain = RENDER(scene, "--integrator=path", DIRECT, UNGUIDED, "--spp=1024");
    picture guided = RENDER(scene, "--integrator=path", DIRECT, GUIDED, "--spp=64");
    mean_and_error a = measure(&plain), b = measure(&guided);
    double expected = radiance_below_window() + 0.5 / M_PI * (0.02 + 0.01 / (2.0 * sqrt(2.0)));
    print_message("unguided %.6f (error %.6f), guided %.6f (error %.6f), expected %.6f\n", a.mean, a.error, b.mean,
                  b.error, expected);
    assert_true(fabs(a.mean - expected) < 3.0 * a.error + 1e-3 * expected);
    assert_true(fabs(b.mean - expected) < 3.0 * b.error + 1e-3 * expected);
    picture_reset(&plain);
    picture_reset(&guided);
}

static const char *room(void)
{
    return SCENE_WITH("window_room.pbrt", "THE_LIGHTS", SUN_AND_SKY, "block.pbrt", PROGRAM_SCENES "block.pbrt");
}

/* Whatever the part and the threads; and what is off by default for the path tracer is on for the photon map. */
static void test_parts_have_the_bits_of_the_whole(void **state)
{
    (void)state;
    static const char *const INTEGRATORS[] = {"--integrator=path", "--integrator=photonmap"};
    char scene[160];
    snprintf(scene, sizeof scene, "%s", room());
    for (int i = 0; i < 2; i++) {
#define OF_ROOM "--photons=20000", "--spp=2", "--gather-samples=4", "--size=24x24", INTEGRATORS[i]
        picture whole = RENDER(scene, OF_ROOM, GUIDED, "--nthreads=1");
        picture part = RENDER(scene, OF_ROOM, GUIDED, "--nthreads=3", "--cropwindow=0.25,0.75,0.5,1");
        picture tile = RENDER(scene, OF_ROOM, GUIDED, "--nthreads=2", "--tile=2/2");
        picture plain = RENDER(scene, OF_ROOM, UNGUIDED);
        picture usual = RENDER(scene, OF_ROOM);
        size_t bytes = 24 * 24 * 3 * sizeof(float);
        assert_int_equal(part.width * part.height, 12 * 12);
        for (int y = 0; y < 12; y++)
            assert_memory_equal(&part.pixels[3 * 12 * y], &whole.pixels[3 * (24 * (y + 12) + 6)],
                                12 * 3 * sizeof(float));
        assert_memory_equal(tile.pixels, &whole.pixels[3 * 24 * 12], bytes / 2);
        assert_memory_equal(usual.pixels, i == 0 ? plain.pixels : whole.pixels, bytes);
        assert_true(memcmp(plain.pixels, whole.pixels, bytes) != 0);
        picture_reset(&whole);
        picture_reset(&part);
        picture_reset(&tile);
        picture_reset(&plain);
        picture_reset(&usual);
    }
}

static void test_agreement(void **state)
{
    (void)state;
    if (IS_SANITIZED)
        skip(); /* statistics of what other tests run here */
    char scene[160];
    snprintf(scene, sizeof scene, "%s", room());
    const agreement_means path = agreement_render(scene, ARGUMENTS("--integrator=path", "--spp=256", UNGUIDED));
    const agreement_means guided = agreement_render(scene, ARGUMENTS("--integrator=path", "--spp=256", GUIDED));
    const agreement_means map = agreement_render(scene, ARGUMENTS(AGREEMENT_MAP, "--spp=16", GUIDED));
    expect_agreement("guided paths", &guided, &path, (agreement_bounds){0.0, 0.005, 0.03});
    expect_agreement("photons", &map, &path, (agreement_bounds){AGREEMENT_BLUR, 0.005, 0.03});
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_form_factor_and_noise),
        TEST_IN_FOLDER(test_shares_of_lights),
        TEST_IN_FOLDER(test_parts_have_the_bits_of_the_whole),
        TEST_IN_FOLDER(test_agreement),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
