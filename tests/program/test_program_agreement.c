/* test_program_agreement.c: photon map and path tracer show the same light in rooms without a closed form: diffuse
 * blocks; a room lit through an opening; media in glass and behind interfaces. All light, and indirect light alone.
 * Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#define AGREEMENT_BLOCK_SIGMA_MOST 0.03
#include "fixtures/program_agreement.h"

/* Standard error of the whole picture. */
static const double SIGMA_MOST = 0.005;

static void test_box_with_blocks(void **state)
{
    (void)state;
    compare_integrators("box_with_blocks", "--spp=64", NULL, SIGMA_MOST);
    compare_integrators("box_with_blocks", "--spp=64", "--only=indirect", SIGMA_MOST);
}

static void test_few_irradiance_photons(void **state)
{
    (void)state;
    compare_integrators_with("box_with_blocks", "--spp=64", "--only=indirect", "--irradiance-fraction=0.25",
                             SIGMA_MOST);
}

/* Nearly all of its light is indirect: once is enough. Few photons find the way in. */
static void test_next_room(void **state)
{
    (void)state;
    compare_integrators("next_room", "--spp=128", NULL, SIGMA_MOST);
}

static void test_tea_in_glass(void **state)
{
    (void)state;
    compare_integrators("tea_in_glass", "--spp=64", NULL, SIGMA_MOST);
    compare_integrators("tea_in_glass", "--spp=128", "--only=indirect", SIGMA_MOST);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_box_with_blocks),
        TEST_IN_FOLDER(test_few_irradiance_photons),
        TEST_IN_FOLDER(test_next_room),
        TEST_IN_FOLDER(test_tea_in_glass),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
