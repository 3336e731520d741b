/* test_program_guiding.c: gathers guided by photons show the same light as others and as the path tracer: in a sphere
 * of known radiance, in a room, and in a dark hall lit by one bright tile, where they are several times less noisy.
 * Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_agreement.h"

static const agreement_bounds BOUNDS = {AGREEMENT_BLUR, 0.005, 0.03};
/* Few paths find the tile: the path tracer's noise is 11 % of a block. */
static const agreement_bounds BOUNDS_OF_HALL = {AGREEMENT_BLUR, 0.02, 0.15};

#define NEVER   "--gather-guiding=0"
#define HALF    "--gather-guiding=0.5"
#define ALWAYS  "--gather-guiding=1"
#define HALL    PROGRAM_SCENES "dim_hall.pbrt"
#define OF_HALL "--size=24x24", "--only=indirect", "--photons=2e5", "--nearest=30"

static const char *const GUIDINGS[] = {NEVER, HALF, ALWAYS};

/* Indirect radiance 0.193256, everywhere: tests/scenes/sphere_spot.pbrt. */
static void test_sphere(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        picture p = RENDER(PROGRAM_SCENES "sphere_spot.pbrt", "--size=16x16", "--photons=1e6", "--nearest=100",
                           "--only=indirect", "--spp=16", "--gather-samples=16", GUIDINGS[i]);
        expect_uniform(GUIDINGS[i], &p, 0.193256, 0.004, 4, 0.02);
        picture_reset(&p);
    }
}

static void test_agreement(void **state)
{
    (void)state;
    compare_integrators_with("box_with_blocks", "--spp=64", "--only=indirect", NEVER, BOUNDS);
    compare_integrators_with("box_with_blocks", "--spp=64", "--only=indirect", ALWAYS, BOUNDS);
    compare_integrators_with("dim_hall", "--spp=256", "--only=indirect", ALWAYS, BOUNDS_OF_HALL);
}

/* Mean square of how far pixels are off, relative, from those of a long rendering by the same photons. */
static double noise_of(const char *guiding, const picture *truth)
{
    picture p = RENDER(HALL, OF_HALL, "--spp=4", "--gather-samples=4", guiding);
    double sum = 0.0;
    int count = 3 * p.width * p.height;
    for (int k = 0; k < count; k++) {
        assert_true(truth->pixels[k] > 0.0f);
        double off = (double)p.pixels[k] / (double)truth->pixels[k] - 1.0;
        sum += off * off / count;
    }
    picture_reset(&p);
    return sum;
}

static void test_noise(void **state)
{
    (void)state;
    picture truth = RENDER(HALL, OF_HALL, "--spp=64", "--gather-samples=32", HALF);
    double never = noise_of(NEVER, &truth), half = noise_of(HALF, &truth), always = noise_of(ALWAYS, &truth);
    picture_reset(&truth);
    print_message("relative variance: unguided %.4f, by half %.4f, guided %.4f\n", never, half, always);
    assert_true(half < never / 4.0); /* it was a ninth, and a fourteenth */
    assert_true(always < never / 6.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_sphere),
        TEST_IN_FOLDER(test_agreement),
        TEST_IN_FOLDER(test_noise),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
