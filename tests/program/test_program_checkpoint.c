/* test_program_checkpoint.c: a render that is killed again and again, at any moment, and resumed each time, writes the
 * very file of one that was let alone.
 *
 * Flow: tests of the whole program. Threads: the program's. */
/* ctest: sanitize */
#define _GNU_SOURCE
#include "fixtures/program_run.h"
#include "fixtures/sanitizer.h"

#define BOX PROGRAM_SCENES "box_with_blocks.pbrt"

enum { KILLS = IS_SANITIZED ? 6 : 12 };
/* A render that goes on for long enough to be ended half-way. */
#define LASTING (IS_SANITIZED ? "--spp=512" : "--spp=4096"), "--size=64x64"

#define SETTINGS                                                                                                       \
    "--reproducible", "--size=40x40", "--spp=64", "--photons=3000", "--caustic-photons=1000", "--gather-samples=2",    \
        "--aov=all"

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Where it is killed depends on the machine; that the file is the same does not. */
static void test_killed(void **state)
{
    (void)state;
    double begin = seconds();
    program_run whole = RUN("-q", SETTINGS, "-o", "whole.exr", BOX);
    double duration = seconds() - begin;
    expect_exit(&whole, 0);
    program_run_reset(&whole);
    const char *const arguments[] = {
        SETTINGS, "-t3", "--progress=json", "--checkpoint=0.05", "--resume", "-o", "cut.exr", BOX, NULL};
    const program_setting usual = {0};
    srand(5);
    int kills = 0, resumed = 0;
    bool has_ended = false;
    for (int i = 0; i < KILLS && !has_ended; i++) {
        program_process process = program_start(&usual, arguments);
        if (i % 2 == 0 && kills < KILLS / 2) /* some while they render, which is where checkpoints come from */
            program_wait_for(&process, "\"phase\": \"render\"");
        double until = seconds() + duration * (double)(rand() % 1000) / (i % 2 == 0 ? 4000.0 : 1000.0);
        while (seconds() < until)
            program_pause();
        assert_int_equal(kill(process.id, SIGKILL), 0);
        program_run run = program_finish(&process);
        if (strstr(run.err, "cannot resume"))
            fail_msg("%s", run.err);
        resumed += strstr(run.err, "resumed from") != NULL;
        kills += run.signal == SIGKILL;
        has_ended = run.exit_code == 0;
        program_run_reset(&run);
    }
    assert_true(kills >= 1); /* how many depends on the machine */
    assert_true(resumed >= 1);
    program_run last = program_execute(NULL, arguments);
    expect_exit(&last, 0);
    program_run_reset(&last);
    expect_same_files("whole.exr", "cut.exr");
    assert_int_not_equal(access(in_folder("cut.exr.afterglow-checkpoint"), F_OK), 0); /* it has served */
}

/* Ended by a signal, it leaves a picture and a checkpoint; the end of it is the same file again. */
static void test_ended_and_resumed(void **state)
{
    (void)state;
    const program_setting usual = {0};
    program_process process = program_start(&usual, ARGUMENTS("--integrator=path", LASTING, "--progress=json",
                                                              "--checkpoint=1000", "-o", "a.exr", "-o", "a.png", BOX));
    program_wait_for(&process, "\"phase\": \"render\"");
    assert_int_equal(kill(process.id, SIGTERM), 0);
    program_run run = program_finish(&process);
    expect_exit(&run, 128 + SIGTERM);
    expect_said(&run, "interrupted");
    program_run_reset(&run);
    assert_int_equal(access(in_folder("a.exr.afterglow-checkpoint"), F_OK), 0);

    run = RUN("--integrator=path", LASTING, "--resume", "--seed=3", "-o", "a.exr", BOX);
    expect_exit(&run, 1);
    expect_said(&run, "cannot resume from 'a.exr.afterglow-checkpoint': it is of a render with another seed");
    program_run_reset(&run);
}

/* Waits until a render with --progress=json has told that each pixel has samples, of some thousands. */
static void wait_for_samples(const program_process *process)
{
    static const char TOLD[] = "\"phase\": \"render\", \"fraction\": ";
    bool has_samples = false;
    for (long i = 0; i < PROGRAM_PATIENCE_SECONDS * 1000L && !has_samples; i++) {
        char *said = program_said(process->err);
        for (const char *at = strstr(said, TOLD); at; at = strstr(at + 1, TOLD))
            has_samples = has_samples || strtod(at + strlen(TOLD), NULL) >= 0.004;
        free(said);
        program_pause();
    }
    assert_true(has_samples);
}

/* A checkpoint is larger than a small picture in integers. Where there is no room for it the render goes on, and a
 * signal leaves the picture all the same. */
static void test_no_room(void **state)
{
    (void)state;
    const program_setting limited = {.file_size_limit = 8192};
    program_run run =
        program_execute(&limited, ARGUMENTS("--integrator=path", "--spp=2048", "--size=16x16", "--checkpoint=0.01",
                                            "--preview", "--aov=all", "-o", "huge.exr:float", "-o", "a.png", BOX));
    expect_exit(&run, 3); /* for the picture with layers alone */
    expect_said(&run, "cannot write 'huge.exr.afterglow-checkpoint': File too large");
    expect_said(&run, "rendering goes on without this file");
    expect_said(&run, "cannot write 'huge.exr': File too large");
    program_run_reset(&run);
    expect_listing("a.png huge.exr.afterglow-unfinished");
    assert_int_equal(unlink(in_folder("huge.exr.afterglow-unfinished")), 0);

    program_process process = program_start(&limited, ARGUMENTS("--integrator=path", LASTING, "--progress=json",
                                                                "--checkpoint=1000", "--size=32x32", "-ob.png", BOX));
    wait_for_samples(&process);
    assert_int_equal(kill(process.id, SIGTERM), 0);
    run = program_finish(&process);
    expect_exit(&run, 3);
    expect_said(&run, "cannot write 'b.png.afterglow-checkpoint': File too large");
    expect_said(&run, "interrupted: the picture has ");
    program_run_reset(&run);
    expect_listing("a.png b.png b.png.afterglow-unfinished");
}

/* The checkpoint of a complete picture goes, whichever other file could not be written; without the picture it
 * stays. */
static void test_one_file_fails(void **state)
{
    (void)state;
    static const char *const FILES[][2] = {{"-ofull.png", "-oa.exr"}, {"-oa.exr", "--dump-photons=full.png"}};
    assert_int_equal(symlink("/dev/full", in_folder("full.png")), 0);
    for (int i = 0; i < 2; i++) {
        program_run run = RUN("--photons=3000", "--spp=256", "--size=32x32", "--gather-samples=2", "--checkpoint=0.01",
                              FILES[i][0], FILES[i][1], BOX);
        expect_exit(&run, 3);
        expect_said(&run, "'full.png': No space left on device");
        program_run_reset(&run);
        expect_listing(i == 0 ? "a.exr full.png full.png.afterglow-checkpoint" : "a.exr full.png");
        if (i == 0)
            assert_int_equal(unlink(in_folder("full.png.afterglow-checkpoint")), 0);
    }
}

/* Without a checkpoint there is nothing to go on from, and that is fine; what cannot be written is told beforehand. */
static void test_usage(void **state)
{
    (void)state;
    program_run run = RUN("--integrator=path", "--spp=1", "--size=8x8", "--resume", "-o", "a.exr", BOX);
    expect_exit(&run, 0);
    expect_said(&run, "beginning anew");
    program_run_reset(&run);
    expect_listing("a.exr");
    static const char *const wrong[] = {"--checkpoint=0", "--checkpoint=-1", "--checkpoint=x", "--checkpoint=inf"};
    for (int i = 0; i < 4; i++) {
        run = RUN(wrong[i], "-o", "a.exr", BOX);
        expect_exit(&run, 2);
        program_run_reset(&run);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_killed),  TEST_IN_FOLDER(test_ended_and_resumed),
        TEST_IN_FOLDER(test_no_room), TEST_IN_FOLDER(test_one_file_fails),
        TEST_IN_FOLDER(test_usage),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
