/* test_program_glossy.c: rough metal and glass show the same light as in the path tracer, and with more gather rays a
 * sample less noise, for they go to many reflected or refracted hits and not all to one.
 * Rests on: Arvo, Kirk, "Particle Transport and Image Synthesis", 1990 (splitting).
 * Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_agreement.h"

static const agreement_bounds BOUNDS = {AGREEMENT_BLUR, 0.01, 0.06};

static void test_agreement(void **state)
{
    (void)state;
    compare_integrators("metal_plate", "--spp=128", NULL, BOUNDS);
    compare_integrators("metal_plate", "--spp=128", "--only=indirect", BOUNDS);
    compare_integrators("glass_ball_room", "--spp=512", "--only=indirect", BOUNDS);
}

/* How far two pictures are apart, in the mean over all pixels, over their mean. */
static double difference_of(const char *scene, const char *spp, const char *option)
{
    picture a = RENDER(scene, "--size=24x24", "--photons=1e5", spp, "--seed=1", option),
            b = RENDER(scene, "--size=24x24", "--photons=1e5", spp, "--seed=2", option);
    double sum = 0.0, mean = 0.0;
    int count = 3 * a.width * a.height;
    for (int k = 0; k < count; k++) {
        double x = (double)a.pixels[k], y = (double)b.pixels[k];
        sum += fabs(x - y);
        mean += (x + y) / 2.0;
    }
    picture_reset(&a);
    picture_reset(&b);
    return sum / mean;
}

/* with_one: as many directions, few of which have a gather ray. */
static void expect_less_noise(const char *scene, const char *many, double times, double most_with_one)
{
    double with_one = difference_of(scene, "--spp=4", "--gather-samples=1"),
           with_many = difference_of(scene, "--spp=4", many);
    print_message("%s: difference %.4f with one gather ray, %.4f with %s\n", scene, with_one, with_many, many);
    assert_true(with_many < with_one / times && with_one < most_with_one);
}

static void test_noise(void **state)
{
    (void)state;
    /* of one direction alone: 1.1 and 0.48; 1.2 */
    expect_less_noise(PROGRAM_SCENES "metal_plate.pbrt", "--gather-samples=8", 1.4, 0.4);
    expect_less_noise(PROGRAM_SCENES "glass_ball_room.pbrt", "--gather-samples=4", 1.4, 1.0);
}

/* A coat reflects a lamp behind glass. Guided or not it is as bright, and guided its rays leave less noise. */
static void test_glints(void **state)
{
    (void)state;
    static const char *const guiding[] = {"--gather-guiding=0.5", "--gather-guiding=0"};
    double mean[2], difference[2];
    for (int i = 0; i < 2; i++) {
        difference[i] = difference_of(PROGRAM_SCENES "glints.pbrt", "--spp=16", guiding[i]);
        picture p = RENDER(PROGRAM_SCENES "glints.pbrt", "--photons=1e5", "--spp=512", guiding[i]);
        mean[i] = picture_mean(&p, 1);
        picture_reset(&p);
    }
    print_message("guided: mean %.5f, difference %.4f; not: %.5f, %.4f\n", mean[0], difference[0], mean[1],
                  difference[1]);
    assert_true(fabs(mean[0] / mean[1] - 1.0) < 0.01);
    assert_true(difference[0] < 0.7 * difference[1]);
}

/* A path that is split brings no more than one that is not: a shadow ray, reflected lamps, and from the diffuse hits
 * that are reflected direct light, caustics and gathered light, each at most the bound. */
static void test_bounds(void **state)
{
    (void)state;
    picture p = RENDER(PROGRAM_SCENES "metal_plate.pbrt", "--photons=1e5", "--spp=1", "--gather-samples=8",
                       "--clamp-direct=0.01", "--clamp-indirect=0.01");
    float most = 0.0f;
    for (int k = 0; k < 3 * p.width * p.height; k++)
        most = fmaxf(most, p.pixels[k]);
    print_message("at most %g\n", (double)most);
    assert_true(most > 0.01f && most < 5.0f * 0.01f * 1.001f);
    picture_reset(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_agreement),
        TEST_IN_FOLDER(test_noise),
        TEST_IN_FOLDER(test_glints),
        TEST_IN_FOLDER(test_bounds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
