/* test_program_statistics.c: what the program tells of its work: statistics as JSON, progress in every style, silence.
 *
 * Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_picture.h"

#define BOX   PROGRAM_SCENES "box_with_blocks.pbrt"
#define GLASS PROGRAM_SCENES "glass_and_metal.pbrt"
#define QUICK "--photons=3000", "--caustic-photons=500", "--spp=2", "--gather-samples=4", "--size=20x10"

static double stats_number(const json_t *stats, const char *keys)
{
    const json_t *value = stats_find(stats, keys);
    assert_true(json_is_number(value));
    return json_number_value(value);
}

/* ---- statistics ---- */

static void expect_keys(const json_t *stats)
{
    static const char *const INTEGERS[] = {"threads",
                                           "seed",
                                           "image.width",
                                           "image.height",
                                           "image.samples_per_pixel",
                                           "photons.emitted",
                                           "photons.stored_global",
                                           "photons.stored_caustic",
                                           "photons.bytes",
                                           "irradiance.requests",
                                           "irradiance.computed",
                                           "irradiance.distinct",
                                           "irradiance.deferred",
                                           "irradiance.waited",
                                           "irradiance.duplicated",
                                           "rays.camera",
                                           "rays.shadow",
                                           "rays.gather",
                                           "rays.photon",
                                           "memory.peak_bytes"};
    static const char *const SECONDS[] = {"time_s.load",      "time_s.bvh",         "time_s.photons",
                                          "time_s.map",       "time_s.precompute",  "time_s.render",
                                          "time_s.write",     "time_s.total",       "cpu_s",
                                          "phase_cpu_s.load", "phase_cpu_s.render", "irradiance.wait_s"};
    for (size_t i = 0; i < sizeof INTEGERS / sizeof *INTEGERS; i++)
        assert_true(stats_integer(stats, INTEGERS[i]) >= 0);
    for (size_t i = 0; i < sizeof SECONDS / sizeof *SECONDS; i++)
        assert_true(stats_number(stats, SECONDS[i]) >= 0.0);
}

static json_t *stats_of(const char *scene, const char *const *arguments)
{
    picture p = render(scene, arguments);
    picture_reset(&p);
    json_t *stats = stats_read(in_folder("a.json"));
    expect_keys(stats);
    return stats;
}

static void test_photon_map(void **state)
{
    (void)state;
    static const char *const CACHES[] = {"on-demand", "precompute", "off"};
    for (int i = 0; i < 3; i++) {
        json_t *stats =
            stats_of(GLASS, ARGUMENTS(QUICK, "--nthreads=3", "--seed=77", "--cache", CACHES[i], "--stats=a.json"));
        assert_int_equal(stats_integer(stats, "threads"), 3);
        assert_int_equal(stats_integer(stats, "seed"), 77);
        assert_string_equal(json_string_value(stats_find(stats, "integrator")), "photonmap");
        assert_string_equal(json_string_value(stats_find(stats, "cache")), CACHES[i]);
        assert_int_equal(stats_integer(stats, "image.width"), 20);
        assert_int_equal(stats_integer(stats, "image.height"), 10);
        assert_int_equal(stats_integer(stats, "image.samples_per_pixel"), 2);
        assert_int_equal(stats_integer(stats, "photons.stored_global"), 3000);
        assert_int_equal(stats_integer(stats, "photons.stored_caustic"), 500);
        long long bytes = stats_integer(stats, "photons.bytes");
        assert_true(bytes >= 24 * 3500 && bytes <= 34 * 3500);
        assert_true(stats_integer(stats, "photons.emitted") > 0);
        assert_true(stats_integer(stats, "rays.photon") >= stats_integer(stats, "photons.emitted"));
        assert_int_equal(stats_integer(stats, "rays.camera"), 20 * 10 * 2);
        assert_true(stats_integer(stats, "rays.gather") > 0);
        assert_true(stats_integer(stats, "rays.shadow") > 0);
        /* each estimate looks where surfaces end, by four rays or more unless the first says so */
        assert_true(stats_integer(stats, "rays.estimate") >=
                    stats_integer(stats, "irradiance.computed") + stats_integer(stats, "irradiance.uncached"));
        assert_true(stats_integer(stats, "rays.estimate") > 0);
        assert_true(stats_integer(stats, "memory.peak_bytes") > bytes);
        long long computed = stats_integer(stats, "irradiance.computed");
        assert_int_equal(computed, stats_integer(stats, "irradiance.distinct"));
        assert_int_equal(stats_integer(stats, "irradiance.duplicated"), 0);
        assert_true(stats_integer(stats, "irradiance.requests") > 0);
        if (i == 0)
            assert_true(computed > 0 && computed <= 3000 && computed <= stats_integer(stats, "irradiance.requests"));
        else
            assert_int_equal(computed, i == 1 ? 3000 : 0);
        assert_true((stats_number(stats, "time_s.precompute") > 0.0) == (i == 1));
        json_decref(stats);
    }
}

static void test_path_tracer(void **state)
{
    (void)state;
    json_t *stats = stats_of(BOX, ARGUMENTS(QUICK, "--integrator=path", "--stats=a.json"));
    assert_string_equal(json_string_value(stats_find(stats, "integrator")), "path");
    static const char *const NONE[] = {"photons.emitted", "photons.stored_global", "photons.stored_caustic",
                                       "photons.bytes",   "irradiance.requests",   "irradiance.computed",
                                       "rays.gather",     "rays.photon",           "rays.estimate"};
    for (size_t i = 0; i < sizeof NONE / sizeof *NONE; i++)
        assert_int_equal(stats_integer(stats, NONE[i]), 0);
    assert_int_equal(stats_integer(stats, "rays.camera"), 20 * 10 * 2);
    json_decref(stats);
}

static void expect_end(const char *const *arguments, const char *reason, int least, int most)
{
    json_t *stats = stats_of(BOX, arguments);
    assert_string_equal(json_string_value(stats_find(stats, "end.reason")), reason);
    assert_int_equal(stats_integer(stats, "end.samples.least"), least);
    assert_int_equal(stats_integer(stats, "end.samples.most"), most);
    const double mean = stats_number(stats, "end.samples.mean");
    assert_true(mean >= least && mean <= most);
    assert_true(stats_number(stats, "end.noise") >= 0.0);
    json_decref(stats);
}

/* A farm asks why a picture ended, and how good it is. */
static void test_end(void **state)
{
    (void)state;
    expect_end(ARGUMENTS(QUICK, "--stats=a.json"), "samples", 2, 2);
    /* a level that no picture of 16 samples misses, and one that none reaches */
    expect_end(ARGUMENTS(QUICK, "--spp=64", "--noise=0.99", "--stats=a.json"), "noise", 16, 16);
    expect_end(ARGUMENTS(QUICK, "--spp=16", "--noise=1e-6", "--min-spp=2", "--stats=a.json"), "samples", 16, 16);
    /* too short for all passes: limits grow until one leaves time for the first */
    program_run run = {.exit_code = 3};
    for (double limit = 0.25; run.exit_code == 3 && limit < 300.0; limit *= 2.0) {
        char option[64];
        snprintf(option, sizeof option, "--time-limit=%g", limit);
        program_run_reset(&run);
        run = RUN("--photons=3000", "--size=16x16", "--spp=1000000", "--noise=0", "--gather-samples=64", option,
                  "--stats=a.json", "-o", "a.exr", BOX);
    }
    expect_exit(&run, 0);
    program_run_reset(&run);
    json_t *stats = stats_read(in_folder("a.json"));
    expect_keys(stats);
    assert_string_equal(json_string_value(stats_find(stats, "end.reason")), "time-limit");
    assert_true(stats_number(stats, "end.samples.mean") >= 1.0 && stats_number(stats, "end.samples.mean") < 1e6);
    json_decref(stats);

    run = RUN(QUICK, "--photons-only", "--photon-map=a.map", "--stats=b.json", BOX);
    expect_exit(&run, 0);
    stats = stats_read(in_folder("b.json"));
    assert_string_equal(json_string_value(stats_find(stats, "end.reason")), "photons");
    assert_true(json_is_null(stats_find(stats, "end.noise")));
    json_decref(stats);
    program_run_reset(&run);
}

/* Phases follow each other: together they last no longer than the whole. */
static void test_times(void **state)
{
    (void)state;
    json_t *stats = stats_of(BOX, ARGUMENTS(QUICK, "--cache=precompute", "--stats=a.json"));
    double sum = 0.0;
    const char *phase;
    const json_t *seconds;
    json_object_foreach((json_t *)(uintptr_t)stats_find(stats, "time_s"), phase,
                        seconds) if (strcmp(phase, "total") != 0) sum += json_number_value(seconds);
    assert_true(sum > 0.0);
    assert_true(sum <= stats_number(stats, "time_s.total"));
    assert_true(stats_number(stats, "cpu_s") > 0.0);
    double cpu_sum = 0.0;
    json_object_foreach((json_t *)(uintptr_t)stats_find(stats, "phase_cpu_s"), phase, seconds) cpu_sum +=
        json_number_value(seconds);
    assert_true(cpu_sum > 0.0);
    assert_true(cpu_sum <= stats_number(stats, "cpu_s"));
    json_decref(stats);
}

/* Where more photons are asked for than light can bring, a message says so, and statistics count those there are. */
static void test_photons_that_cannot_be_had(void **state)
{
    (void)state;
    const char *scene = write_text("scene.pbrt", "Camera \"perspective\"\nWorldBegin\n"
                                                 "LightSource \"point\" \"point3 from\" [0 0 -1000]\n"
                                                 "Translate 0 0 3\nShape \"sphere\"\n");
    program_run run = RUN(QUICK, "--progress=none", "--stats=a.json", "-o", "a.exr", scene);
    expect_exit(&run, 0);
    expect_said(&run, "of 3000 photons");
    program_run_reset(&run);
    json_t *stats = stats_read(in_folder("a.json"));
    assert_true(stats_integer(stats, "photons.stored_global") < 3000);
    /* a last block that is not full, and a node for each */
    assert_true(stats_integer(stats, "photons.bytes") <= 34 * stats_integer(stats, "photons.stored_global") + 1024);
    json_decref(stats);
}

/* ---- progress ---- */

static const char *next_line(const char *text, char *line, size_t size)
{
    const char *end = strchr(text, '\n');
    assert_non_null(end); /* whole lines alone */
    assert_true((size_t)(end - text) < size);
    snprintf(line, size, "%.*s", (int)(end - text), text);
    return end + 1;
}

static void expect_plain(const char *said)
{
    int last = -1, lines = 0;
    char line[256];
    for (const char *at = said; *at;) {
        at = next_line(at, line, sizeof line);
        int percent, used = 0;
        assert_true(++lines <= 22); /* a log is not flooded */
        if (!*at) {                 /* the last line says what was written, and how long it took */
            assert_int_equal(strncmp(line, "afterglow: wrote a.exr", 22), 0);
            assert_non_null(strstr(line, " in 0:"));
            break;
        }
        assert_int_equal(sscanf(line, "Progress: %d%%%n", &percent, &used), 1);
        assert_true(used > 0);
        assert_true(percent > last && percent <= 100);
        last = percent;
    }
    assert_int_equal(last, 100);
}

static void test_plain(void **state)
{
    (void)state;
    static const char *const INTEGRATORS[] = {"--integrator=photonmap", "--integrator=path"};
    for (int k = 0; k < 2; k++) {
        program_run run = RUN(QUICK, "--progress=plain", INTEGRATORS[k], "-o", "a.exr", "-o", "b.png", BOX);
        expect_exit(&run, 0);
        expect_plain(run.err);
        assert_string_equal(run.out, "");
        program_run_reset(&run);
    }
    /* where standard error is no terminal, that is what `auto` means */
    program_run run = RUN(QUICK, "-o", "a.exr", BOX);
    expect_exit(&run, 0);
    expect_plain(run.err);
    program_run_reset(&run);
}

/* Each phase from 0 to 1, in their order. */
static void test_json(void **state)
{
    (void)state;
    program_run run = RUN(QUICK, "--progress=json", "--cache=precompute", "-o", "a.exr", BOX);
    expect_exit(&run, 0);
    char line[256];
    int phase = -1, last_percent = 0;
    double last_fraction = 1.0;
    for (const char *at = run.err; *at;) {
        at = next_line(at, line, sizeof line);
        json_t *told = json_loads(line, 0, NULL);
        assert_non_null(told);
        assert_true(stats_number(told, "seconds") >= 0.0);
        if (!*at) {
            assert_string_equal(json_string_value(json_array_get(json_object_get(told, "written"), 0)), "a.exr");
            assert_true(stats_number(told, "picture_seconds") > 0.0);
            json_decref(told);
            break;
        }
        const char *name = json_string_value(stats_find(told, "phase"));
        double fraction = stats_number(told, "fraction"), percent = stats_number(told, "percent");
        if (phase < 0 || strcmp(name, ag_phase_name((ag_phase)phase)) != 0) {
            assert_true(last_fraction == 1.0);
            assert_true(++phase < AG_PHASE_COUNT);
            assert_string_equal(name, ag_phase_name((ag_phase)phase));
            assert_true(fraction == 0.0);
        } else {
            assert_true(fraction > last_fraction && fraction <= 1.0);
        }
        assert_true((int)percent >= last_percent && percent <= 100.0);
        last_fraction = fraction;
        last_percent = (int)percent;
        json_decref(told);
    }
    assert_int_equal(phase, AG_PHASE_WRITE);
    assert_int_equal(last_percent, 100);
    assert_true(last_fraction == 1.0);
    program_run_reset(&run);
}

static void test_bar(void **state)
{
    (void)state;
    program_run run = RUN(QUICK, "--progress=bar", "-o", "a.exr", BOX);
    expect_exit(&run, 0);
    expect_said(&run, "100%");
    assert_non_null(strstr(run.err, "afterglow: wrote a.exr in 0:"));
    assert_ptr_equal(strchr(run.err, '\n'), run.err + strlen(run.err) - 1); /* the bar is one line that goes */
    program_run_reset(&run);
}

static void test_silence(void **state)
{
    (void)state;
    static const char *const QUIET[] = {"--progress=none", "-q", "--quiet"};
    for (int i = 0; i < 3; i++) {
        program_run run = RUN(QUICK, QUIET[i], "-o", "a.exr", BOX);
        expect_exit(&run, 0);
        assert_string_equal(run.err, "");
        assert_string_equal(run.out, "");
        program_run_reset(&run);
    }
    /* -q takes warnings away, not errors */
    const char *scene =
        write_text("scene.pbrt", "Integrator \"bdpt\"\nCamera \"perspective\"\nWorldBegin\nShape \"sphere\"\n");
    program_run run = RUN(QUICK, "-q", "-o", "a.exr", scene);
    expect_exit(&run, 0);
    assert_string_equal(run.err, "");
    program_run_reset(&run);
}

static void test_verbose(void **state)
{
    (void)state;
    program_run run = RUN(QUICK, "-v", "--progress=none", "-o", "a.exr", BOX);
    expect_exit(&run, 0);
    expect_said(&run, "3000 in the global map");
    assert_string_equal(run.out, "");
    program_run_reset(&run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_photon_map),
        TEST_IN_FOLDER(test_path_tracer),
        TEST_IN_FOLDER(test_end),
        TEST_IN_FOLDER(test_times),
        TEST_IN_FOLDER(test_photons_that_cannot_be_had),
        TEST_IN_FOLDER(test_plain),
        TEST_IN_FOLDER(test_json),
        TEST_IN_FOLDER(test_bar),
        TEST_IN_FOLDER(test_silence),
        TEST_IN_FOLDER(test_verbose),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
