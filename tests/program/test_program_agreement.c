/* test_program_agreement.c: photon map and path tracer show the same light in rooms without a closed form: diffuse
 * blocks; a room lit through an opening; media in glass and behind interfaces. All light, indirect light alone, and
 * direct light alone, which neither blurs.
 * Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_agreement.h"

static const agreement_bounds BOUNDS = {AGREEMENT_BLUR, 0.005, 0.03};
static const agreement_bounds UNBIASED = {0.0, 0.006, 0.04};

static void test_box_with_blocks(void **state)
{
    (void)state;
    compare_parts("box_with_blocks", "--spp=64", BOUNDS);
}

/* With one scattering no photons take part, and both integrators sample lamps without bias, so no blur is allowed. */
static void test_direct_light(void **state)
{
    (void)state;
    compare_integrators("box_with_blocks", "--spp=64", "--max-depth=1", UNBIASED);
    compare_integrators("tea_in_glass", "--spp=64", "--max-depth=1", UNBIASED);
}

static void test_few_irradiance_photons(void **state)
{
    (void)state;
    compare_integrators_with("box_with_blocks", "--spp=64", "--only=indirect", "--irradiance-fraction=0.25", BOUNDS);
}

/* Nearly all of its light is indirect: once is enough. Few photons find the way in. */
static void test_next_room(void **state)
{
    (void)state;
    compare_integrators("next_room", "--spp=128", NULL, BOUNDS);
}

static void test_tea_in_glass(void **state)
{
    (void)state;
    compare_integrators("tea_in_glass", "--spp=64", NULL, BOUNDS);
    compare_integrators("tea_in_glass", "--spp=128", "--only=indirect", BOUNDS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_box_with_blocks),        TEST_IN_FOLDER(test_direct_light),
        TEST_IN_FOLDER(test_few_irradiance_photons), TEST_IN_FOLDER(test_next_room),
        TEST_IN_FOLDER(test_tea_in_glass),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
