/* test_program_edges.c: where surfaces end: a thin table leg on a floor, a corner of 10 degrees, a wall without
 * thickness between a lit room and a dark one, a step of 1 mm. Estimates there must neither lose light past the edge
 * nor find the next room's. Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_agreement.h"

/* The photon map against the path tracer. So small a picture has 130,000 photons by default, whose discs of 50
 * blur the shade below the table: that picture lacks 0.54 % of its light, and 0.05 % with 3,000,000. */
static void compare(const char *name, agreement_bounds bounds)
{
    char scene[512];
    snprintf(scene, sizeof scene, PROGRAM_SCENES "%s.pbrt", name);
    compare_integrators_by(name, scene, ARGUMENTS("--noise=0", "--photons=1e6"),
                           ARGUMENTS("--integrator=path", "--spp=128"), bounds);
}

static void test_table_leg(void **state)
{
    (void)state;
    compare("table", (agreement_bounds){AGREEMENT_BLUR, 0.003, 0.02});
}

static void test_narrow_corner(void **state)
{
    (void)state;
    compare("narrow_corner", (agreement_bounds){AGREEMENT_BLUR, 0.003, 0.02});
}

static void test_thin_wall(void **state)
{
    (void)state;
    picture lit = RENDER(PROGRAM_SCENES "thin_wall_lit.pbrt", "--spp=4");
    picture dark = RENDER(PROGRAM_SCENES "thin_wall_dark.pbrt", "--spp=4");
    double leak = picture_mean(&dark, 1) / picture_mean(&lit, 1);
    print_message("of the lit room's light %.4f %% is seen in the dark one\n", 100.0 * leak);
    assert_true(leak < 0.0006);
    picture_reset(&lit);
    picture_reset(&dark);
}

/* No pixel of the indirect light is much brighter than path tracing has it anywhere. Before photons on the riser were
 * kept from serving the wall the largest was three times as bright. */
static void test_step(void **state)
{
    (void)state;
    picture map = RENDER(PROGRAM_SCENES "step.pbrt", "--only=indirect", "--spp=8");
    picture path = RENDER(PROGRAM_SCENES "step.pbrt", "--only=indirect", "--integrator=path", "--spp=512");
    compare_integrators_by("a step of 1 mm", PROGRAM_SCENES "step.pbrt", ARGUMENTS("--only=indirect", "--spp=8"),
                           ARGUMENTS("--only=indirect", "--integrator=path", "--spp=256"),
                           (agreement_bounds){AGREEMENT_BLUR, 0.005, 0.03});
    float of_map = 0.0f, of_path = 0.0f;
    for (int i = 0; i < map.width * map.height; i++) {
        of_map = fmaxf(of_map, map.pixels[3 * i + 1]);
        of_path = fmaxf(of_path, path.pixels[3 * i + 1]);
    }
    print_message("the largest: %.3f, path traced %.3f\n", (double)of_map, (double)of_path);
    assert_true(of_map < 1.25f * of_path);
    picture_reset(&map);
    picture_reset(&path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_table_leg),
        TEST_IN_FOLDER(test_narrow_corner),
        TEST_IN_FOLDER(test_thin_wall),
        TEST_IN_FOLDER(test_step),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
