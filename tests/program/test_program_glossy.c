/* test_program_glossy.c: a rough metal shows the same light as in the path tracer, and with more gather rays a sample
 * less noise, for they go to many reflected places and not all to one.
 * Rests on: Arvo, Kirk, "Particle Transport and Image Synthesis", 1990 (splitting).
 * Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_agreement.h"

#define PLATE    PROGRAM_SCENES "metal_plate.pbrt"
#define OF_PLATE "--size=24x24", "--photons=1e5", "--spp=4"

static void test_agreement(void **state)
{
    (void)state;
    const agreement_bounds bounds = {0.02, 0.02, 0.04, 0.1};
    compare_integrators("metal_plate", "--spp=512", NULL, bounds);
    compare_integrators("metal_plate", "--spp=512", "--only=indirect", bounds);
}

/* The variance of a pixel with four samples by two seeds, over the square of the mean. */
static double variance_of(const char *rays)
{
    picture a = RENDER(PLATE, OF_PLATE, "--seed=1", rays), b = RENDER(PLATE, OF_PLATE, "--seed=2", rays);
    double sum = 0.0, mean = 0.0;
    int count = 3 * a.width * a.height;
    for (int k = 0; k < count; k++) {
        double x = (double)a.pixels[k], y = (double)b.pixels[k];
        sum += (x - y) * (x - y) / 2.0;
        mean += (x + y) / 2.0;
    }
    picture_reset(&a);
    picture_reset(&b);
    return sum * count / (mean * mean);
}

static void test_noise(void **state)
{
    (void)state;
    double one = variance_of("--gather-samples=1"), eight = variance_of("--gather-samples=8");
    print_message("relative variance: %.4f with one gather ray, %.4f with eight\n", one, eight);
    assert_true(eight < one / 3.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_agreement),
        TEST_IN_FOLDER(test_noise),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
