/* test_program_passes.c: renders that end by a limit of time or of noise, and those that show what they have on the
 * way.
 *
 * Flow: tests of the whole program. Threads: the program's. */
/* ctest: sanitize */
#define _GNU_SOURCE
#include "fixtures/program_picture.h"

#define BOX   PROGRAM_SCENES "box_with_blocks.pbrt"
#define SMALL "--integrator=path", "--size=24x24", "--type=float"

/* A run that ends by its limit, with samples: limits grow until one leaves time for them. */
static program_run run_within_limit(const char *other)
{
    program_run run = {.exit_code = 3};
    for (double limit = 0.25; run.exit_code == 3 && limit < 300.0; limit *= 2.0) {
        char option[64];
        snprintf(option, sizeof option, "--time-limit=%g", limit);
        program_run_reset(&run);
        run = RUN(SMALL, "--spp=65536", "--max-depth=2", option, other, "-o", "a.exr", BOX);
    }
    return run;
}

/* All pixels have the same number of samples: they are the picture of so many. */
static void test_time_limit(void **state)
{
    (void)state;
    program_run run = run_within_limit("--checkpoint=1000");
    expect_exit(&run, 0);
    int samples = 0;
    const char *said = strstr(run.err, "time limit: the picture has ");
    if (!said || sscanf(said, "time limit: the picture has %d of 65536 samples", &samples) != 1)
        fail_msg("%s", run.err);
    program_run_reset(&run);
    assert_true(samples >= 1);
    expect_listing("a.exr a.exr.afterglow-checkpoint");
    run = run_within_limit("--resume");
    expect_exit(&run, 0);
    expect_said(&run, "resumed from");
    program_run_reset(&run);
    run = RUN(SMALL, "--spp=2", "--time-limit=100:00:00", "-o", "b.exr", BOX); /* time enough */
    expect_exit(&run, 0);
    assert_null(strstr(run.err, "time limit"));
    program_run_reset(&run);
    static const char *const wrong[] = {"--time-limit=0",        "--time-limit=1:2", "--time-limit=0:60:00",
                                        "--time-limit=00:00:00", "--noise=-1",       "--min-spp=1"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        run = RUN(wrong[i], "-o", "a.exr", BOX);
        expect_exit(&run, 2);
        program_run_reset(&run);
    }
}

static void expect_reason(const char *name, const char *reason)
{
    json_t *stats = stats_read(in_folder(name));
    assert_string_equal(json_string_value(stats_find(stats, "end.reason")), reason);
    json_decref(stats);
    unlink(in_folder(name));
}

/* The limit may be reached while the scene is read, or its photons are traced: nothing is there to be written. */
static void test_limit_before_the_picture(void **state)
{
    (void)state;
    program_run run = RUN(SMALL, "--spp=1", "--time-limit=0.001", "--stats=a.json", "-o", "a.exr", BOX);
    expect_exit(&run, 3);
    expect_said(&run, "error: time limit: it was reached before there was anything to write");
    program_run_reset(&run);
    expect_reason("a.json", "time-limit");
    run = RUN("--photons=20000000", "--photons-only", "--photon-map=a.map", "--time-limit=0.2", "--stats=a.json", BOX);
    expect_exit(&run, 3);
    program_run_reset(&run);
    expect_reason("a.json", "time-limit");
    run = RUN(SMALL, "--spp=1", "--frames=1-2", "--time-limit=0.001", "-o", "a.%d.exr", BOX);
    expect_exit(&run, 3);
    program_run_reset(&run);
    expect_listing("");
    run = RUN(SMALL, "--spp=2", "--time-limit=0.001", "--dry-run", BOX); /* which tells how long a picture would take */
    expect_exit(&run, 0);
    program_run_reset(&run);
}

/* Within the first sample it leaves what there is, marked as a signal's. The time that reading takes is not known:
 * limits grow until one is reached within the sample, which takes longer. */
static void test_limit_within_the_first_sample(void **state)
{
    (void)state;
    program_run run = {0};
    bool is_partial = false;
    for (double limit = 0.03; !is_partial && limit < 100.0; limit *= 1.5) {
        char option[64];
        snprintf(option, sizeof option, "--time-limit=%g", limit);
        run = RUN("--integrator=path", "--size=1600x1600", "--max-depth=64", "--spp=65536", "--noise=0", "--type=float",
                  option, "--stats=a.json", "-o", "a.exr", BOX);
        is_partial = strstr(run.err, "samples per pixel, from 0 to 1") != NULL;
        expect_exit(&run, 3);
        if (is_partial)
            expect_said(&run, "error: time limit: the picture is not complete");
        program_run_reset(&run);
        expect_reason("a.json", "time-limit");
    }
    assert_true(is_partial);
    expect_listing("a.exr a.exr.afterglow-unfinished");
}

/* A scene that does not come: standard input is waited for until the limit. */
static void test_limit_while_waiting(void **state)
{
    (void)state;
    assert_int_equal(mkfifo(in_folder("pipe"), 0600), 0);
    const int writer = open(in_folder("pipe"), O_RDWR);
    assert_true(writer >= 0);
    const program_setting piped = {.input = in_folder("pipe")};
    program_process process =
        program_start(&piped, ARGUMENTS(SMALL, "--time-limit=0.01", "--stats=a.json", "-o", "a.exr", "-"));
    program_run run = program_finish(&process);
    expect_exit(&run, 3);
    expect_said(&run, "error: time limit: it was reached before there was anything to write");
    program_run_reset(&run);
    close(writer);
    expect_reason("a.json", "time-limit");
    expect_listing("pipe");
}

static void test_preview(void **state)
{
    (void)state;
    const program_setting usual = {0};
    program_process process = program_start(&usual, ARGUMENTS(SMALL, "--spp=1048576", "--preview", "-o", "a.exr", BOX));
    while (access(in_folder("a.exr"), F_OK) != 0) {
        assert_int_equal(kill(process.id, 0), 0);
        program_pause();
    }
    picture p = picture_read(in_folder("a.exr"));
    assert_int_equal(p.width, 24);
    picture_reset(&p);
    assert_int_equal(kill(process.id, SIGINT), 0);
    program_run run = program_finish(&process);
    expect_exit(&run, 128 + SIGINT);
    program_run_reset(&run);

    run = RUN(SMALL, "--spp=8", "--reproducible", "--preview", "-o", "a.exr", BOX);
    expect_exit(&run, 0);
    program_run_reset(&run);
    run = RUN(SMALL, "--spp=8", "--reproducible", "-o", "b.exr", BOX);
    expect_exit(&run, 0);
    program_run_reset(&run);
    expect_listing("a.exr b.exr");
    size_t size, other_size;
    unsigned char *bytes = read_bytes(in_folder("a.exr"), &size), *other = read_bytes(in_folder("b.exr"), &other_size);
    assert_int_equal(size, other_size);
    assert_memory_equal(bytes, other, size);
    free(bytes);
    free(other);
}

static void test_noise(void **state)
{
    (void)state;
    program_run run = RUN(SMALL, "--spp=64", "--noise=0.05", "--min-spp=4", "-o", "a.exr", BOX);
    expect_exit(&run, 0);
    double level = 0.0, mean = 0.0;
    int least = 0, most = 0;
    const char *said = strstr(run.err, "noise: ");
    if (!said || sscanf(said, "noise: %lf, where white is 1; %lf samples per pixel, from %d to %d, for --noise 0.05",
                        &level, &mean, &least, &most) != 4)
        fail_msg("%s", run.err);
    assert_true(level > 0.01 && level < 0.06);
    program_run_reset(&run);
    assert_true(least >= 4 && most <= 64 && mean >= least && mean <= most && least < most);
}

/* How many samples a pixel has in the mean, exactly. */
static double samples_by(const char *scene, const char *const *options, bool expects_level)
{
    const char *all[PROGRAM_ARGUMENTS_MAX] = {
        "--integrator=path", "--size=8x8", "--stats=a.json", "-o", "a.exr", scene};
    int count = 6;
    while (*options)
        all[count++] = *options++;
    program_run run = program_execute(NULL, all);
    expect_exit(&run, 0);
    if ((strstr(run.err, ", for --noise ") != NULL) != expects_level)
        fail_msg("%s", run.err);
    program_run_reset(&run);
    json_t *stats = stats_read(in_folder("a.json"));
    double samples = (double)stats_integer(stats, "rays.camera") / (8.0 * 8.0);
    json_decref(stats);
    return samples;
}

#define SAMPLES_BY(expects_level, ...) samples_by("box_with_blocks.pbrt", ARGUMENTS(__VA_ARGS__), expects_level)

/* A level of noise and most samples; just as many where it is said so, or the scene is written for this program. */
static void test_default_samples(void **state)
{
    (void)state;
    static const char sampler[] = "Sampler \"independent\" \"integer pixelsamples\" 2";
    (void)SCENE_WITH("block.pbrt", "", ""); /* which the box includes */
    (void)SCENE_WITH("box_with_blocks.pbrt", sampler,
                     "Sampler \"zsobol\" \"integer pixelsamples\" 3 Integrator \"volpath\"");
    double free_choice = SAMPLES_BY(true, "--seed=0"), same = SAMPLES_BY(true, "--noise=0.02", "--spp=1024"),
           coarse = SAMPLES_BY(true, "--noise=0.1"), few = SAMPLES_BY(true, "--noise=1e-5", "--spp=20");
    assert_true(free_choice > 20.0 && free_choice < 1024.0);
    assert_float_equal(same, free_choice, 0.0);
    assert_true(coarse >= 16.0 && coarse < free_choice);
    assert_float_equal(few, 20.0, 0.0);
    assert_float_equal(SAMPLES_BY(false, "--spp=5"), 5.0, 0.0);
    assert_float_equal(SAMPLES_BY(false, "--spp=5", "--noise=0"), 5.0, 0.0);
    assert_float_equal(SAMPLES_BY(false, "--noise=0"), 3.0, 0.0);
    (void)SCENE_WITH("box_with_blocks.pbrt", sampler,
                     "Sampler \"zsobol\" \"integer pixelsamples\" 3 Integrator \"photonmap\"");
    assert_float_equal(SAMPLES_BY(false, "--seed=1"), 3.0, 0.0);
    assert_true(SAMPLES_BY(true, "--noise=0.1") >= 16.0);
    (void)SCENE_WITH("box_with_blocks.pbrt", sampler, "Integrator \"photonmap\"");
    assert_true(SAMPLES_BY(true, "--seed=1") > 20.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_time_limit),
        TEST_IN_FOLDER(test_limit_before_the_picture),
        TEST_IN_FOLDER(test_limit_within_the_first_sample),
        TEST_IN_FOLDER(test_limit_while_waiting),
        TEST_IN_FOLDER(test_preview),
        TEST_IN_FOLDER(test_noise),
        TEST_IN_FOLDER(test_default_samples),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
