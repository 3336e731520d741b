/* test_program_agreement_surfaces.c: photon map and path tracer show the same light on surfaces that are not diffuse:
 * glass, rough metal and a mirror; rough coats; glTF's material in many ways; cloth; alpha, bump maps and brushed
 * metal. All light, and indirect light alone. Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_agreement.h"

static const agreement_bounds BOUNDS = {AGREEMENT_BLUR, 0.007, 0.04};

static void test_glass_and_metal(void **state)
{
    (void)state;
    compare_integrators("glass_and_metal", "--spp=64", NULL, BOUNDS);
    compare_integrators("glass_and_metal", "--spp=128", "--only=indirect", BOUNDS);
}

static void test_rough_coats(void **state)
{
    (void)state;
    compare_integrators("rough_coats", "--spp=64", NULL, BOUNDS);
    compare_integrators("rough_coats", "--spp=64", "--only=indirect", BOUNDS);
}

static void test_principled(void **state)
{
    (void)state;
    compare_integrators("principled", "--spp=64", NULL, BOUNDS);
    compare_integrators("principled", "--spp=64", "--only=indirect", BOUNDS);
}

static void test_cloth(void **state)
{
    (void)state;
    compare_integrators("cloth", "--spp=64", NULL, BOUNDS);
    compare_integrators("cloth", "--spp=64", "--only=indirect", BOUNDS);
}

/* Alpha and relief show in all light; indirect light alone tells no more. */
static void test_alpha_and_relief(void **state)
{
    (void)state;
    compare_integrators("alpha_and_relief", "--spp=64", NULL, BOUNDS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_glass_and_metal), TEST_IN_FOLDER(test_rough_coats),      TEST_IN_FOLDER(test_principled),
        TEST_IN_FOLDER(test_cloth),           TEST_IN_FOLDER(test_alpha_and_relief),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
