/* test_program_signals.c: a signal ends the program with 128 + its number, in whatever phase it comes. While it renders
 * it leaves what picture there is, whole as a file and marked as unfinished; in other phases it leaves statistics
 * alone, which say how it ended. SIGUSR1 shows the picture so far, and ends nothing.
 *
 * Flow: tests of the whole program. Threads: the program's. */
/* ctest: sanitize */
#define _GNU_SOURCE
#include "fixtures/program_picture.h"

#define BOX PROGRAM_SCENES "box_with_blocks.pbrt"

/* A render that was ended leaves both pictures or none, since there may be no sample yet. */
static void expect_partial_pictures(void)
{
    if (access(in_folder("a.exr"), F_OK) != 0) {
        expect_listing("a.json");
        return;
    }
    expect_listing("a.exr a.exr.afterglow-unfinished a.json a.png a.png.afterglow-unfinished");
    picture p = picture_read(in_folder("a.exr"));
    assert_int_equal(p.width, 48);
    picture_reset(&p);
}

/* Sends the signal as soon as the phase is told of, in a run that would take minutes. */
static void expect_end(const char *phase, int number, const char *const *arguments)
{
    char told[64];
    const program_setting usual = {0};
    program_process process = program_start(&usual, arguments);
    snprintf(told, sizeof told, "\"phase\": \"%s\"", phase);
    program_wait_for(&process, told);
    assert_int_equal(kill(process.id, number), 0);
    program_run run = program_finish(&process);
    expect_exit(&run, 128 + number);
    program_run_reset(&run);
}

#define LONG "--progress=json", "-o", "a.exr", "-o", "a.png", "--stats=a.json"

static void test_every_signal(void **state)
{
    (void)state;
    static const int NUMBERS[] = {SIGINT, SIGTERM, SIGHUP, SIGXCPU};
    for (int i = 0; i < 4; i++)
        expect_end("render", NUMBERS[i], ARGUMENTS(LONG, "--integrator=path", "--spp=100000", "--size=48x48", BOX));
    json_t *stats = stats_read(in_folder("a.json"));
    assert_string_equal(json_string_value(stats_find(stats, "end.reason")), "signal");
    json_decref(stats);
    expect_partial_pictures();
}

/* The system repeats its signal every second beyond the soft limit. */
static void test_repeated_cpu_limit(void **state)
{
    (void)state;
    const program_setting usual = {0};
    program_process process =
        program_start(&usual, ARGUMENTS("--integrator=path", "--spp=100000", "--size=48x48", LONG, BOX));
    program_wait_for(&process, "\"phase\": \"render\"");
    for (int i = 0; i < 20; i++)
        assert_int_equal(kill(process.id, SIGXCPU), 0);
    program_run run = program_finish(&process);
    expect_exit(&run, 128 + SIGXCPU);
    program_run_reset(&run);
    expect_partial_pictures();
}

/* Statistics alone, which a farm can tell a signal by. */
static void expect_reason_alone(void)
{
    expect_listing("a.json");
    json_t *stats = stats_read(in_folder("a.json"));
    assert_string_equal(json_string_value(stats_find(stats, "end.reason")), "signal");
    json_decref(stats);
    assert_int_equal(unlink(in_folder("a.json")), 0);
}

static void test_every_phase(void **state)
{
    (void)state;
    expect_end("photons", SIGINT, ARGUMENTS(LONG, "--photons=2e7", "--spp=100000", BOX));
    expect_reason_alone();
    expect_end("map", SIGINT, ARGUMENTS(LONG, "--photons=1e6", "--spp=100000", BOX));
    expect_reason_alone();
    expect_end("precompute", SIGINT, ARGUMENTS(LONG, "--photons=1e6", "--nearest=3000", "--cache=precompute", BOX));
    expect_reason_alone();
    /* seconds of rays within one sample */
    expect_end("render", SIGTERM,
               ARGUMENTS(LONG, "--photons=1e6", "--nearest=3000", "--gather-samples=50000", "--size=48x48", BOX));
    expect_partial_pictures();
}

static bool has_said(const program_process *process, const char *text)
{
    char *said = program_said(process->err);
    bool is_there = strstr(said, text) != NULL;
    free(said);
    return is_there;
}

/* Asked again until there is a sample to show. */
static void test_snapshot(void **state)
{
    (void)state;
    const program_setting usual = {0};
    program_process process = program_start(&usual, ARGUMENTS("--progress=json", "--integrator=path", "--spp=100000",
                                                              "--size=48x48", "--reproducible", "-o", "a.exr", BOX));
    program_wait_for(&process, "\"phase\": \"render\"");
    while (!has_said(&process, "snapshot: ")) {
        assert_int_equal(kill(process.id, SIGUSR1), 0);
        program_pause();
        assert_int_equal(kill(process.id, 0), 0);
    }
    picture p = picture_read(in_folder("a.exr"));
    double sum = picture_block(&p, 0, 0, 48, 0);
    assert_true(sum > 0.0);
    picture_reset(&p);
    assert_int_equal(access(in_folder("a.exr.afterglow-unfinished"), F_OK), 0);
    assert_int_equal(kill(process.id, SIGTERM), 0);
    program_run run = program_finish(&process);
    expect_exit(&run, 128 + SIGTERM);
    expect_said(&run, "samples per pixel, from");
    program_run_reset(&run);

    /* the end of a render takes the mark away */
    run = RUN("-q", "--integrator=path", "--spp=1", "--size=48x48", "-o", "a.exr", BOX);
    expect_exit(&run, 0);
    program_run_reset(&run);
    expect_listing("a.exr");
}

/* A mesh that takes a while to read and to sort. */
static void test_loading(void **state)
{
    (void)state;
    enum { SIDE = 400 };
    const char *path = write_text(
        "mesh.pbrt",
        "Camera \"perspective\"\nWorldBegin\nLightSource \"point\"\nShape \"trianglemesh\" \"point3 P\" [\n");
    FILE *file = fopen(path, "a");
    assert_non_null(file);
    for (int i = 0; i < SIDE * SIDE; i++)
        fprintf(file, "%d %d %d\n", i % SIDE, i / SIDE, i % 7);
    fprintf(file, "] \"integer indices\" [\n");
    for (int i = 0; i + SIDE + 1 < SIDE * SIDE; i++)
        fprintf(file, "%d %d %d\n", i, i + 1, i + SIDE);
    fprintf(file, "]\n");
    assert_int_equal(fclose(file), 0);
    expect_end("load", SIGINT, ARGUMENTS(LONG, "--spp=100000", path));
    expect_end("bvh", SIGTERM, ARGUMENTS(LONG, "--spp=100000", path));
    expect_listing("a.json mesh.pbrt");
}

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* A hundred thousand triangles in one place, each of which each ray meets: whether the model is a room is found out by
 * tens of thousands of rays, which take most of a minute. */
static void test_looking_for_a_room(void **state)
{
    (void)state;
    const char *path = write_text("heap.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf");
    FILE *file = fopen(path, "a");
    assert_non_null(file);
    for (int i = 0; i < 300000; i++)
        fprintf(file, " %d", i % 3 + 1);
    assert_int_equal(fclose(file), 0);
    const double begun = seconds();
    expect_end("bvh", SIGTERM, ARGUMENTS(LONG, "--spp=100000", path));
    assert_true(seconds() - begun < 20.0);
    expect_listing("a.json heap.obj");
}

/* While files are written the program may as well end in order: then all of them are there. */
static void test_writing(void **state)
{
    (void)state;
    const program_setting usual = {0};
    program_process process =
        program_start(&usual, ARGUMENTS("--progress=json", "-o", "a.png", "-o", "b.png", "--integrator=path",
                                        "--max-depth=0", "--spp=1", "--size=1200x1200", BOX));
    program_wait_for(&process, "\"phase\": \"write\"");
    assert_int_equal(kill(process.id, SIGTERM), 0);
    program_run run = program_finish(&process);
    if (run.exit_code == 0)
        expect_listing("a.png b.png");
    else {
        expect_exit(&run, 128 + SIGTERM);
        /* the first may be complete, none is in part */
        expect_listing(access(in_folder("a.png"), F_OK) == 0 ? "a.png" : "");
    }
    program_run_reset(&run);
}

/* A second signal ends it at once; here it waits for a scene that does not come. */
static void test_second_signal(void **state)
{
    (void)state;
    assert_int_equal(mkfifo(in_folder("pipe"), 0600), 0);
    int writer = open(in_folder("pipe"), O_RDWR);
    assert_true(writer >= 0);
    const program_setting piped = {.input = in_folder("pipe")};
    program_process process = program_start(&piped, ARGUMENTS(LONG, "-"));
    while (!program_catches(process.id, SIGINT) || !program_catches(process.id, SIGTERM))
        program_pause();
    assert_int_equal(kill(process.id, SIGINT), 0);
    program_pause();
    assert_int_equal(kill(process.id, SIGTERM), 0);
    program_run run = program_finish(&process);
    if (run.exit_code != 128 + SIGINT)
        expect_exit(&run, 128 + SIGTERM);
    program_run_reset(&run);
    close(writer);
    expect_listing("pipe");
}

/* A signal that nohup has set to be ignored stays so. */
static void test_ignored_signal(void **state)
{
    (void)state;
    assert_int_equal(setenv("AFTERGLOW_SCENE", PROGRAM_SCENES "sphere.pbrt", 1), 0);
    char command[1024];
    snprintf(
        command, sizeof command,
        "cd '%s' && trap '' HUP && '%s' -q --photons=200000 --size=64x64 -o a.exr \"$AFTERGLOW_SCENE\" & child=$!; "
        "sleep 0.2; kill -HUP $child; wait $child",
        folder, program_path());
    assert_int_equal(system(command), 0);
    expect_listing("a.exr");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_every_signal),
        TEST_IN_FOLDER(test_every_phase),
        TEST_IN_FOLDER(test_loading),
        TEST_IN_FOLDER(test_looking_for_a_room),
        TEST_IN_FOLDER(test_snapshot),
        TEST_IN_FOLDER(test_writing),
        TEST_IN_FOLDER(test_second_signal),
        TEST_IN_FOLDER(test_ignored_signal),
        TEST_IN_FOLDER(test_repeated_cpu_limit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
