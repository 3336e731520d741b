/* test_program_reference.c: a public scene, the Cornell box of Bitterli's collection, against the reference picture
 * that comes with it, by the comparison that stands beside it. Skipped where the scenes are not beside the repository.
 * Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_run.h"

#define SHARED    AG_SOURCE_DIR "/../shared/scenes/"
#define SCENE     SHARED "cornell-box/scene.pbrt"
#define REFERENCE SHARED "cornell-box/reference.exr"
#define COMPARE   SHARED "compare.py"

/* mean: ratio of the mean luminances. median: over blocks, relative; noise: the reference's own part of it. */
static void compare_with_reference(double *out_mean, double *out_median, double *out_noise)
{
    char command[1024], line[256] = "";
    snprintf(command, sizeof command, "python3 '" COMPARE "' '%s' '" REFERENCE "'", in_folder("picture.exr"));
    FILE *answer = popen(command, "r");
    assert_non_null(answer);
    char *got = fgets(line, sizeof line, answer);
    assert_int_equal(pclose(answer), 0);
    assert_non_null(got);
    print_message("%s", line);
    assert_int_equal(sscanf(line, "mean %lf median %lf p90 %*f colour %*f noise %lf", out_mean, out_median, out_noise),
                     3);
}

static void expect_reference(const char *const *arguments)
{
    program_run run = program_execute(NULL, arguments);
    expect_exit(&run, 0);
    program_run_reset(&run);
    double mean, median, noise;
    compare_with_reference(&mean, &median, &noise);
    assert_true(mean > 0.99 && mean < 1.01);
    assert_true(median <= 0.02 + noise);
}

static void test_photon_map(void **state)
{
    (void)state;
    expect_reference(ARGUMENTS("--spp=16", "-q", "-o", "picture.exr", SCENE));
}

static void test_path_tracer(void **state)
{
    (void)state;
    expect_reference(ARGUMENTS("--integrator=path", "--spp=64", "-q", "-o", "picture.exr", SCENE));
}

static bool is_skipped(void)
{
    static const char *const FILES[] = {SCENE, REFERENCE, COMPARE};
    for (size_t i = 0; i < sizeof FILES / sizeof *FILES; i++)
        if (access(FILES[i], R_OK) != 0) {
            printf("SKIPPED: %s is not there\n", FILES[i]);
            return true;
        }
    static const char *const TOOLS[][2] = {{"python3", "python3 --version >/dev/null 2>&1"},
                                           {"oiiotool", "oiiotool --version >/dev/null 2>&1"}};
    for (int i = 0; i < 2; i++)
        if (system(TOOLS[i][1]) != 0) {
            printf("SKIPPED: there is no %s\n", TOOLS[i][0]);
            return true;
        }
    return false;
}

int main(void)
{
    if (is_skipped())
        return 77;
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_photon_map),
        TEST_IN_FOLDER(test_path_tracer),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
