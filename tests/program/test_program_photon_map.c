/* test_program_photon_map.c: --photon-map: what one picture computed serves the next, with the same bits as a fresh
 * run; programs at once share the work; whichever of them is killed, and whenever, the others end, with the same bits.
 *
 * Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_picture.h"

#define ROOM "glass_and_metal.pbrt"
#define QUICK                                                                                                          \
    "--photons=4000", "--caustic-photons=500", "--spp=2", "--gather-samples=4", "--size=24x24", "--nthreads=2",        \
        "--progress=none", "--type=float", "--reproducible", "--photon-aim=0"

static void expect_end(program_run run, int code, const char *said)
{
    expect_exit(&run, code);
    if (said)
        expect_said(&run, said);
    program_run_reset(&run);
}

static void expect_map(const json_t *stats, const char *state)
{
    assert_string_equal(json_string_value(stats_find(stats, "photons.map_file")), state);
    assert_int_equal(stats_integer(stats, "irradiance.duplicated"), 0);
}

#define MAP      "--photon-map=a.map"
#define FRACTION "--irradiance-fraction=0.125"

/* --- alone --- */

static void test_camera_move(void **state)
{
    (void)state;
    const char *scene = PROGRAM_SCENES ROOM;
    expect_end(RUN(QUICK, "-o", "fresh1.exr", scene), 0, NULL);
    expect_end(RUN(QUICK, MAP, "--stats=1.json", "-o", "kept1.exr", scene), 0, NULL);
    expect_same_files("fresh1.exr", "kept1.exr");
    json_t *first = stats_read(in_folder("1.json"));
    expect_map(first, "traced");
    assert_int_equal(stats_integer(first, "irradiance.ready"), 0);

    char moved[160]; /* what in_folder gives does not last */
    snprintf(moved, sizeof moved, "%s",
             SCENE_WITH(ROOM, "LookAt 0 1.1 3.4", "LookAt 0.2 1.2 3.2", "\"float fov\" 45", "\"float fov\" 50"));
    expect_end(RUN(QUICK, "--stats=fresh.json", "-o", "fresh2.exr", moved), 0, NULL);
    expect_end(RUN(QUICK, MAP, "--stats=2.json", "-o", "kept2.exr", moved), 0, NULL);
    expect_same_files("fresh2.exr", "kept2.exr");
    json_t *second = stats_read(in_folder("2.json")), *fresh = stats_read(in_folder("fresh.json"));
    expect_map(second, "opened");
    expect_map(fresh, "none");
    assert_int_equal(stats_integer(second, "irradiance.ready"), stats_integer(first, "irradiance.computed"));
    assert_int_equal(stats_integer(second, "irradiance.computed"), stats_integer(second, "irradiance.distinct"));
    assert_true(stats_integer(second, "irradiance.computed") < stats_integer(fresh, "irradiance.computed") / 2);
    assert_int_equal(stats_integer(second, "irradiance.reclaimed"), 0);
    assert_int_equal(stats_integer(second, "rays.photon"), 0);
    assert_int_equal(stats_integer(second, "photons.stored_global"), 4000);
    json_decref(first);
    json_decref(second);
    json_decref(fresh);

    /* once more it computes nothing; other samples, another size and precomputing may use it too */
    expect_end(RUN(QUICK, MAP, "--stats=3.json", "-o", "kept3.exr", moved), 0, NULL);
    expect_same_files("kept2.exr", "kept3.exr");
    json_t *third = stats_read(in_folder("3.json"));
    assert_int_equal(stats_integer(third, "irradiance.computed"), 0);
    json_decref(third);
    expect_end(RUN(QUICK, MAP, "--cache=precompute", "--spp=1", "--size=10x10", "--stats=4.json", "-o", "4.exr", scene),
               0, NULL);
    json_t *fourth = stats_read(in_folder("4.json"));
    assert_int_equal(stats_integer(fourth, "irradiance.computed") + stats_integer(fourth, "irradiance.ready"), 4000);
    json_decref(fourth);
    expect_listing(
        "1.json 2.json 3.json 4.exr 4.json a.map fresh.json fresh1.exr fresh2.exr glass_and_metal.pbrt kept1.exr "
        "kept2.exr kept3.exr");
}

/* A dump tells the photons of a map from a file. */
static void test_dump(void **state)
{
    (void)state;
    const char *scene = PROGRAM_SCENES ROOM;
    expect_end(RUN(QUICK, "--dump-photons=fresh.ply", "-o", "fresh.exr", scene), 0, NULL);
    for (int i = 0; i < 2; i++) {
        expect_end(RUN(QUICK, MAP, "--dump-photons=kept.ply", "-o", "kept.exr", scene), 0, NULL);
        expect_same_files("fresh.exr", "kept.exr");
        expect_same_files("fresh.ply", "kept.ply");
    }
    expect_end(RUN(QUICK, FRACTION, "--dump-photons=fresh.ply", "-o", "fresh.exr", scene), 0, NULL);
    for (int i = 0; i < 2; i++) {
        expect_end(RUN(QUICK, FRACTION, "--photon-map=b.map", "--dump-photons=kept.ply", "--stats=b.json", "-o",
                       "kept.exr", scene),
                   0, NULL);
        expect_same_files("fresh.exr", "kept.exr");
        expect_same_files("fresh.ply", "kept.ply");
        json_t *stats = stats_read(in_folder("b.json"));
        expect_map(stats, i == 0 ? "traced" : "opened");
        json_decref(stats);
    }
}

static void test_refusal(void **state)
{
    (void)state;
    const char *scene = PROGRAM_SCENES ROOM;
    expect_end(RUN(QUICK, MAP, "-o", "a.exr", scene), 0, NULL);
    expect_end(RUN(QUICK, MAP, "--seed=3", "-o", "a.exr", scene), 1, "another seed of photons: 0, not 3");
    expect_end(RUN(QUICK, MAP, "--photons=4001", "-o", "a.exr", scene), 1, "another number of photons: 4000, not 4001");
    expect_end(RUN(QUICK, MAP, "--irradiance-fraction=0.5", "-o", "a.exr", scene), 1,
               "another fraction of irradiance photons: 1, not 0.5");
    expect_end(RUN(QUICK, MAP, "--isa=sse2", "-o", "a.exr", scene), 1, "another machine");
    const char *paler = SCENE_WITH(ROOM, "[0.6 0.6 0.5]", "[0.6 0.6 0.51]");
    expect_end(RUN(QUICK, MAP, "-o", "a.exr", paler), 1, "another scene");
    const char *brighter = SCENE_WITH(ROOM, "\"rgb L\" [4 4 4]", "\"rgb L\" [4 4 4.5]");
    expect_end(RUN(QUICK, MAP, "-o", "a.exr", brighter), 1, "--photon-map-refresh");
    expect_end(RUN(QUICK, MAP, "--photon-map-refresh", "--stats=a.json", "-o", "b.exr", brighter), 0, NULL);
    json_t *stats = stats_read(in_folder("a.json"));
    expect_map(stats, "traced");
    json_decref(stats);
    expect_end(RUN(QUICK, MAP, "--photon-map-refresh", "--stats=a.json", "-o", "b.exr", brighter), 0, NULL);
    stats = stats_read(in_folder("a.json"));
    expect_map(stats, "opened"); /* it fits: nothing to refresh */
    json_decref(stats);
    assert_int_equal(truncate(in_folder("a.map"), 10000), 0);
    expect_end(RUN(QUICK, MAP, "-o", "b.exr", brighter), 1, "cut short");
    expect_end(RUN(QUICK, MAP, "--photon-map-refresh", "-o", "b.exr", brighter), 0, NULL);
    expect_end(RUN(QUICK, MAP, "-o", "b.exr", brighter), 0, NULL);

    expect_end(RUN(QUICK, MAP, "--integrator=path", "-o", "c.exr", scene), 2, "path tracing has no photons");
    expect_end(RUN(QUICK, "--photon-map=c.exr", "-o", "c.exr", scene), 2, "written twice");
    expect_end(RUN(QUICK, "--photon-map=none/a.map", "-o", "c.exr", scene), 3, "none/a.map");
    expect_end(RUN(QUICK, "--photon-map=.", "-o", "c.exr", scene), 3, "regular file");
    expect_end(RUN(QUICK, "--photon-map=a.exr", "-o", "c.exr", scene), 1, "no photon map");
    expect_listing("a.exr a.json a.map b.exr glass_and_metal.pbrt");
}

static void test_full_disk(void **state)
{
    (void)state;
    const program_setting setting = {.file_size_limit = 50000};
    expect_end(program_execute(&setting, ARGUMENTS(QUICK, MAP, "-o", "a.exr", PROGRAM_SCENES ROOM)), 3,
               "cannot write 'a.map'");
    expect_listing("");
}

/* The first job of a farm: all that the pictures share, and no picture. */
static void test_photons_only(void **state)
{
    (void)state;
    const char *scene = PROGRAM_SCENES ROOM;
    expect_end(RUN(QUICK, MAP, "--photons-only", "--cache=precompute", scene), 0, NULL);
    expect_listing("a.map");
    expect_end(RUN(QUICK, MAP, "--stats=a.json", "-o", "kept.exr", scene), 0, NULL);
    expect_end(RUN(QUICK, "-o", "fresh.exr", scene), 0, NULL);
    expect_same_files("fresh.exr", "kept.exr");
    json_t *stats = stats_read(in_folder("a.json"));
    expect_map(stats, "opened");
    assert_int_equal(stats_integer(stats, "irradiance.computed"), 0);
    assert_int_equal(stats_integer(stats, "irradiance.ready"), 4000);
    json_decref(stats);
    expect_end(RUN(QUICK, "--photons-only", "--dump-photons=a.ply", scene), 0, NULL);
    expect_listing("a.json a.map a.ply fresh.exr kept.exr");
    expect_end(RUN(QUICK, "--photons-only", scene), 2, "give --photon-map or --dump-photons");
    expect_end(RUN(QUICK, MAP, "--photons-only", "-o", "a.exr", scene), 2, "--outfile");
    expect_end(RUN(QUICK, MAP, "--photons-only", "--resume", scene), 2, "--resume");
    expect_end(RUN(QUICK, MAP, "--photons-only", "--integrator=path", scene), 2, "path tracing has no photons");
}

/* A map that may not be written is used, and left as it is. */
static void test_read_only(void **state)
{
    (void)state;
    const char *scene = PROGRAM_SCENES ROOM;
    const program_setting nobody = {.is_nobody = true};
    expect_end(RUN(QUICK, MAP, "-o", "a.exr", scene), 0, NULL);
    assert_int_equal(chmod(in_folder("a.map"), 0444), 0);
    assert_int_equal(chmod(folder, 0777), 0);
    expect_end(
        program_execute(&nobody, ARGUMENTS(QUICK, MAP, "--cache=precompute", "--stats=a.json", "-o", "b.exr", scene)),
        0, "may not be written");
    expect_same_files("a.exr", "b.exr");
    json_t *stats = stats_read(in_folder("a.json"));
    expect_map(stats, "private");
    json_decref(stats);
}

/* --- several at once --- */

enum { CROWD = 3 };

static void test_crowd(void **state)
{
    (void)state;
    const char *scene = PROGRAM_SCENES ROOM;
    const program_setting usual = {0};
    const char *const pictures[CROWD] = {"1.exr", "2.exr", "3.exr"}, *const stats[CROWD] = {"1.json", "2.json",
                                                                                            "3.json"};
    expect_end(RUN(QUICK, "-o", "fresh.exr", scene), 0, NULL);
    program_process crowd[CROWD];
    for (int i = 0; i < CROWD; i++)
        crowd[i] = program_start(
            &usual, ARGUMENTS(QUICK, MAP, "--cache=precompute", "--stats", stats[i], "-o", pictures[i], scene));
    long long computed = 0;
    int traced = 0;
    for (int i = 0; i < CROWD; i++) {
        expect_end(program_finish(&crowd[i]), 0, NULL);
        expect_same_files("fresh.exr", pictures[i]);
        json_t *s = stats_read(in_folder(stats[i]));
        assert_int_equal(stats_integer(s, "irradiance.duplicated"), 0);
        assert_int_equal(stats_integer(s, "irradiance.reclaimed"), 0);
        computed += stats_integer(s, "irradiance.computed");
        traced += strcmp(json_string_value(stats_find(s, "photons.map_file")), "traced") == 0;
        json_decref(s);
    }
    assert_int_equal(computed, 4000); /* none twice, none forgotten */
    assert_int_equal(traced, 1);
}

/* Two of three are killed at random moments: while one traces, while they wait for it, while they render. */
static void test_kills(void **state)
{
    (void)state;
    enum { ROUNDS = 12 };
    const char *scene = PROGRAM_SCENES ROOM;
    const program_setting usual = {0};
    const char *const pictures[CROWD] = {"1.exr", "2.exr", "3.exr"};
    expect_end(RUN(QUICK, "-o", "fresh.exr", scene), 0, NULL);
    unsigned random = 12345;
    for (int round = 0; round < ROUNDS; round++) {
        program_process crowd[CROWD];
        if (round % 2 == 0)
            unlink(in_folder("a.map"));
        for (int i = 0; i < CROWD; i++)
            crowd[i] = program_start(&usual, ARGUMENTS(QUICK, MAP, "-o", pictures[i], scene));
        for (int i = 0; i < CROWD - 1; i++) {
            random = random * 1664525u + 1013904223u;
            const struct timespec nap = {0, (long)(random >> 8) % 80000000};
            nanosleep(&nap, NULL);
            kill(crowd[i].id, SIGKILL);
        }
        for (int i = 0; i < CROWD; i++) {
            program_run run = program_finish(&crowd[i]);
            assert_true(run.signal == SIGKILL || run.exit_code == 0);
            if (i == CROWD - 1)
                expect_exit(&run, 0);
            program_run_reset(&run);
        }
        expect_same_files("fresh.exr", pictures[CROWD - 1]);
    }
}

/* --- damage --- */

/* Random bits flipped anywhere in the file: the right picture, or a refusal. */
static void test_flipped_bits(void **state)
{
    (void)state;
    enum { FLIPS = 200 };
    const char *scene = PROGRAM_SCENES ROOM;
    expect_end(RUN(QUICK, MAP, "--cache=precompute", "-o", "fresh.exr", scene), 0, NULL);
    size_t size;
    unsigned char *whole = read_bytes(in_folder("a.map"), &size);
    unsigned random = 99;
    int refused = 0;
    for (int k = 0; k < FLIPS; k++) {
        random = random * 1664525u + 1013904223u;
        size_t at = (size_t)((double)random / 4294967296.0 * (double)size);
        random = random * 1664525u + 1013904223u;
        int file = open(in_folder("a.map"), O_RDWR | O_CREAT | O_TRUNC, 0666);
        assert_true(file >= 0);
        unsigned char before = whole[at];
        whole[at] ^= (unsigned char)(1u << (random >> 29));
        assert_int_equal(write(file, whole, size), size);
        assert_int_equal(close(file), 0);
        whole[at] = before;
        program_run run = RUN(QUICK, MAP, "-q", "-o", "flipped.exr", scene);
        if (run.exit_code == 1)
            refused++;
        else {
            expect_exit(&run, 0);
            expect_same_files("fresh.exr", "flipped.exr");
        }
        program_run_reset(&run);
    }
    free(whole);
    assert_in_range(refused, FLIPS / 2, FLIPS - 10);
}

enum { CUT, OVERWRITTEN, CHANGES };

/* A map is cut short, or overwritten, while it is in use: nobody is ended by a signal, and no picture shows what is not
 * there. Photons are so many that their tree lacks nearly half of its leaves, to which nodes of zeros lead. */
static void test_map_lost_while_rendering(void **state)
{
    (void)state;
    const char *scene = PROGRAM_SCENES ROOM;
    const program_setting usual = {0};
    char path[160], other[160];
    snprintf(path, sizeof path, "%s", in_folder("a.map"));
    snprintf(other, sizeof other, "%s", in_folder("b.map"));
    expect_end(RUN(QUICK, "--photon-map=b.map", "--seed=5", "-o", "b.exr", scene), 0, NULL);
    expect_end(RUN(QUICK, "--spp=1", "-o", "one.exr", scene), 0, NULL);
    for (int change = 0; change < CHANGES; change++) {
        unlink(path);
        unlink(in_folder("lost.exr"));
        program_process process = program_start(
            &usual, ARGUMENTS("--photons=17000", "--caustic-photons=500", "--gather-samples=4", "--size=24x24",
                              "--nthreads=2", "--type=float", "--reproducible", "--progress=json", "--spp=20000",
                              "--photon-map=a.map", "-o", "lost.exr", scene));
        program_wait_for(&process, "\"phase\": \"render\", \"fraction\": 0.01");
        char command[512];
        if (change == CUT) {
            assert_int_equal(truncate(path, 0), 0);
        } else {
            snprintf(command, sizeof command, "cat '%s' >'%s'", other, path);
            assert_int_equal(system(command), 0);
        }
        program_run run = program_finish(&process);
        expect_exit(&run, 3);
        expect_said(&run, "'a.map': the photon map was cut short or overwritten");
        expect_said(&run, "of 20000 samples per pixel");
        program_run_reset(&run);
        assert_int_equal(access(in_folder("lost.exr.afterglow-unfinished"), F_OK), 0);
        picture p = picture_read(in_folder("lost.exr")), fresh = picture_read(in_folder("one.exr"));
        double lost = picture_mean(&p, 0), all = picture_mean(&fresh, 0);
        if (!(lost > 0.8 * all && lost < 1.25 * all)) /* it is the room, of a pass that saw the map */
            fail_msg("%g instead of %g", lost, all);
        picture_reset(&p);
        picture_reset(&fresh);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_camera_move),
        TEST_IN_FOLDER(test_dump),
        TEST_IN_FOLDER(test_refusal),
        TEST_IN_FOLDER(test_photons_only),
        TEST_IN_FOLDER(test_full_disk),
        TEST_IN_FOLDER(test_read_only),
        TEST_IN_FOLDER(test_crowd),
        TEST_IN_FOLDER(test_kills),
        TEST_IN_FOLDER(test_map_lost_while_rendering),
        TEST_IN_FOLDER(test_flipped_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
