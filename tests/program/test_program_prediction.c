/* test_program_prediction.c: what the program says beforehand that a picture will take, against what it took, and the
 * limit of memory.
 * Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_picture.h"

#define BOX   PROGRAM_SCENES "box_with_blocks.pbrt"
#define GLASS PROGRAM_SCENES "glass_and_metal.pbrt"

static double number_of(const json_t *stats, const char *keys)
{
    const json_t *value = stats_find(stats, keys);
    assert_true(json_is_number(value));
    return json_number_value(value);
}

static void expect_reason(const json_t *stats, const char *reason)
{
    assert_string_equal(json_string_value(stats_find(stats, "end.reason")), reason);
}

/* Nothing is written but what is asked for; the numbers are there. How long it takes is not tested. */
static void test_dry_run(void **state)
{
    (void)state;
    static const char *const CACHES[] = {"--cache=on-demand", "--cache=precompute", "--cache=off", "--integrator=path"};
    for (int i = 0; i < 4; i++) {
        program_run run = RUN("--dry-run", "--photons=3000", "--size=40x30", "--spp=20", "--noise=0", CACHES[i],
                              "--stats=a.json", "-o", "a.exr", GLASS);
        expect_exit(&run, 0);
        expect_listing("a.json");
        assert_non_null(strstr(run.out, "samples per pixel"));
        assert_non_null(strstr(run.out, "peak"));
        json_t *stats = stats_read(in_folder("a.json"));
        expect_reason(stats, "dry-run");
        assert_true(number_of(stats, "prediction.time_s.render") > 0.0);
        assert_true(number_of(stats, "prediction.time_s.total") > number_of(stats, "prediction.time_s.render"));
        assert_true((number_of(stats, "prediction.time_s.precompute") > 0.0) == (i == 1));
        assert_true(number_of(stats, "prediction.cpu_s") > 0.0);
        assert_true(number_of(stats, "prediction.memory.optional_bytes") <=
                    number_of(stats, "prediction.memory.needed_bytes"));
        assert_true(number_of(stats, "prediction.memory.needed_bytes") <=
                    number_of(stats, "prediction.memory.peak_bytes"));
        assert_true(number_of(stats, "prediction.samples_per_pixel") == 20.0);
        assert_int_equal(stats_integer(stats, "rays.camera"), 0); /* of the picture */
        json_decref(stats);
        assert_int_equal(unlink(in_folder("a.json")), 0);
        program_run_reset(&run);
    }
}

/* A picture whose blocks differ in their samples: the trial's mean is the picture's, as blocks render alike in both.
 * Half of its blocks are tried; between them the numbers of samples differ by less than their mean. */
static void test_samples(void **state)
{
    (void)state;
#define ADAPTIVE "--photons=3000", "--size=160x120", "--noise=0.006", "--spp=256", "--stats=a.json", "-o", "a.exr", BOX
    program_run run = RUN("--dry-run", ADAPTIVE);
    expect_exit(&run, 0);
    program_run_reset(&run);
    json_t *stats = stats_read(in_folder("a.json"));
    const double predicted = number_of(stats, "prediction.samples_per_pixel");
    json_decref(stats);
    run = RUN(ADAPTIVE);
    expect_exit(&run, 0);
    program_run_reset(&run);
    stats = stats_read(in_folder("a.json"));
    const double mean = number_of(stats, "end.samples.mean");
    assert_true(stats_integer(stats, "end.samples.most") > stats_integer(stats, "end.samples.least"));
    if (fabs(predicted - mean) > 0.2 * mean)
        fail_msg("predicted %.2f samples a pixel, but it took %.2f", predicted, mean);
    json_decref(stats);
}

/* Fails unless the prediction is within a fifth of the peak memory that the kernel tells of the real run. */
static void expect_peak(const char *const *dry, const char *const *real)
{
    program_run run = program_execute(NULL, dry);
    expect_exit(&run, 0);
    program_run_reset(&run);
    run = program_execute(NULL, real);
    expect_exit(&run, 0);
    program_run_reset(&run);
    json_t *predicted = stats_read(in_folder("dry.json")), *stats = stats_read(in_folder("real.json"));
    const double expected = number_of(predicted, "prediction.memory.peak_bytes");
    const double peak = number_of(stats, "memory.peak_bytes");
    if (fabs(expected - peak) > 0.2 * peak)
        fail_msg("predicted %.1f MB, but it took %.1f", expected / 1e6, peak / 1e6);
    json_decref(predicted);
    json_decref(stats);
}

#define EXPECT_PEAK(...)                                                                                               \
    expect_peak(ARGUMENTS("--dry-run", "--stats=dry.json", __VA_ARGS__), ARGUMENTS("--stats=real.json", __VA_ARGS__))

static void test_memory(void **state)
{
    (void)state;
    /* photons; pixels; layers; threads */
    EXPECT_PEAK("--photons=2000000", "--spp=1", "--size=16x16", "-o", "a.exr", BOX);
    EXPECT_PEAK("--integrator=path", "--max-depth=1", "--spp=1", "--size=900x900", "-o", "a.exr", BOX);
    EXPECT_PEAK("--integrator=path", "--max-depth=1", "--spp=1", "--size=300x300", "--aov=all", "-o", "a.exr", BOX);
    EXPECT_PEAK("--photons=3000", "--spp=8", "--noise=0", "--size=64x64", "--nthreads=8", "-o", "a.exr", GLASS);
}

/* Returns by how much memory's peak is higher with one option than with another, measured or predicted. */
static double peak_more(bool is_dry, const char *photons, const char *option, const char *other)
{
    double peaks[2];
    for (int i = 0; i < 2; i++) {
        program_run run = RUN(is_dry ? "--dry-run" : "-q", photons, "--size=32x32", "--spp=1", "--noise=0",
                              i == 0 ? option : other, "--stats=a.json", "-o", "a.exr", BOX);
        expect_exit(&run, 0);
        program_run_reset(&run);
        json_t *stats = stats_read(in_folder("a.json"));
        peaks[i] = number_of(stats, is_dry ? "prediction.memory.peak_bytes" : "memory.peak_bytes");
        json_decref(stats);
    }
    return peaks[0] - peaks[1];
}

/* Aiming leaves free memory between the blocks that are kept, and in small scenes that counts. */
static void test_memory_of_aiming(void **state)
{
    (void)state;
    const double predicted = peak_more(true, "--photons=600000", "--photon-aim=0.8", "--photon-aim=0"),
                 real = peak_more(false, "--photons=600000", "--photon-aim=0.8", "--photon-aim=0");
    if (predicted < 0.4 * real || predicted > real + 4e6)
        fail_msg("predicted %.1f MB more, but it took %.1f more", predicted / 1e6, real / 1e6);
}

/* A photon takes as much memory as is predicted: for itself, in the tree, and for the space around it. */
static void test_memory_of_photons(void **state)
{
    (void)state;
    const double predicted = peak_more(true, "--photon-aim=0", "--photons=2000000", "--photons=1000000"),
                 real = peak_more(false, "--photon-aim=0", "--photons=2000000", "--photons=1000000");
    if (fabs(predicted - real) > 0.1 * real)
        fail_msg("predicted %.1f bytes a photon, but it took %.1f", predicted / 1e6, real / 1e6);
}

/* What there is only where its memory can be had is left out where --memory allows no more than the rest. */
static void test_limit_without_spaces(void **state)
{
    (void)state;
#define MANY                                                                                                           \
    "--photons=7000000", "--photon-aim=0", "--caustic-photons=0", "--size=16x16", "--spp=1", "--noise=0",              \
        "--nthreads=1", "-o", "a.exr", BOX
    static const char NEEDS[] = "the picture needs about ";
    program_run run = RUN("--memory=1M", MANY);
    expect_exit(&run, 3);
    const char *needs = strstr(run.err, NEEDS);
    assert_non_null(needs);
    const double needed = 1e6 * strtod(needs + strlen(NEEDS), NULL);
    program_run_reset(&run);
    char limit[64];
    snprintf(limit, sizeof limit, "--memory=%.0f", needed + 1e6);
    run = RUN(limit, "--stats=a.json", MANY);
    expect_exit(&run, 0);
    program_run_reset(&run);
    json_t *stats = stats_read(in_folder("a.json"));
    assert_true(number_of(stats, "photons.bytes") < 26.0 * 7e6);
    json_decref(stats);
}

/* A scene of many parts is given up as soon as they take more, and not when all of them are there. */
static void test_limit_while_reading(void **state)
{
    (void)state;
    enum { SPHERES = 250000 };
    FILE *file = fopen(in_folder("many.pbrt"), "w");
    assert_non_null(file);
    fputs("Camera \"perspective\" WorldBegin\n", file);
    for (int i = 0; i < SPHERES; i++)
        fputs("Translate 0.01 0 0 Shape \"sphere\"\n", file);
    assert_int_equal(fclose(file), 0);
    program_run run = RUN("--memory=80M", "--integrator=path", "--spp=1", "--size=8x8", "--stats=a.json", "-o", "a.exr",
                          in_folder("many.pbrt"));
    expect_exit(&run, 3);
    expect_said(&run, "--memory allows no more");
    program_run_reset(&run);
    expect_listing("a.json many.pbrt");
    json_t *stats = stats_read(in_folder("a.json"));
    expect_reason(stats, "memory");
#if !IS_SANITIZED /* whose own memory counts, too */
    assert_true(number_of(stats, "memory.peak_bytes") < 120.0 * 1024.0 * 1024.0);
#endif
    json_decref(stats);
}

static void test_limit(void **state)
{
    (void)state;
    /* more than that is needed: said before anything is rendered */
    program_run run =
        RUN("--memory=32M", "--integrator=path", "--spp=1", "--size=1000x1000", "--stats=a.json", "-o", "a.exr", BOX);
    expect_exit(&run, 3);
    expect_said(&run, "--memory allows 33.6 MB");
    expect_listing("a.json");
    json_t *stats = stats_read(in_folder("a.json"));
    expect_reason(stats, "memory");
    assert_int_equal(stats_integer(stats, "rays.camera"), 0);
    json_decref(stats);
    program_run_reset(&run);

    run = RUN("--memory=1G", "--photons=3000", "--spp=1", "--size=40x30", "-o", "a.exr", BOX);
    expect_exit(&run, 0);
    expect_listing("a.exr a.json");
    program_run_reset(&run);

    static const char *const NONE[] = {"--memory=0", "--memory=-1G", "--memory=5Q", "--memory=", "--memory=G"};
    for (size_t i = 0; i < sizeof NONE / sizeof *NONE; i++) {
        run = RUN(NONE[i], "-o", "b.exr", BOX);
        expect_exit(&run, 2);
        program_run_reset(&run);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_dry_run),
        TEST_IN_FOLDER(test_samples),
        TEST_IN_FOLDER(test_memory),
        TEST_IN_FOLDER(test_limit_while_reading),
        TEST_IN_FOLDER(test_memory_of_aiming),
        TEST_IN_FOLDER(test_memory_of_photons),
        TEST_IN_FOLDER(test_limit_without_spaces),
        TEST_IN_FOLDER(test_limit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
