/* test_bench_result.c: what afterglow-bench makes of figures, on made-up ones: a busy machine is known and gets no
 * score, spread turns a score into an interval, numbers of threads follow the machine, options are read.
 * Flow: tests of perf/bench/bench_load.c, bench_machine.c, bench_score.c, bench_json.c, bench_options.c. Threads:
 * one. */
#define _GNU_SOURCE
#include "bench/bench_json.h"
#include "bench/bench_options.h"
#include "bench/bench_page.h"
#include "bench/bench_score.h"
#include "fixtures/temporary_folder.h"

static bench_run made_up;

/* --- load --- */

static const char PROC_STAT[] = "cpu  900 0 0 0 0 0 0 0 0 0\n"
                                "cpu0 100 10 20 500 40 5 5 10 0 0\n"
                                "cpu1 200 0 0 700 0 0 0 0 7 0\n"
                                "cpu10 50 0 0 0 0 0 0 50 0 0\n"
                                "intr 1\n";

static void test_proc_stat(void **state)
{
    (void)state;
    const bench_cpu cpus[] = {{.os_index = 0}, {.os_index = 10}}, absent[] = {{.os_index = 2}};
    double busy, stolen;
    assert_true(bench_load_parse(PROC_STAT, cpus, 2, 100.0, &busy, &stolen));
    assert_true(busy == 2.5 && stolen == 0.6); /* 150 + 100 ticks; idle and waiting are not busy */
    assert_false(bench_load_parse(PROC_STAT, absent, 1, 100.0, &busy, &stolen));
    assert_false(bench_load_parse("", cpus, 1, 100.0, &busy, &stolen));
    assert_false(bench_load_parse(PROC_STAT, cpus, 0, 100.0, &busy, &stolen));
}

/* 100 s on 4 processors, of which we had 200 s. */
static bench_load load_of(double others_s, double stolen_s, uint64_t involuntary)
{
    const bench_load_reading begin = {.at_s = 1.0, .busy_s = 7.0, .stolen_s = 2.0, .own_s = 3.0, .is_known = true};
    bench_load_reading end = begin;
    end.at_s += 100.0;
    end.own_s += 200.0;
    end.busy_s += 200.0 + others_s + stolen_s;
    end.stolen_s += stolen_s;
    end.involuntary += involuntary;
    return bench_load_between(&begin, &end, 4);
}

static void test_busy(void **state)
{
    (void)state;
    char reasons[BENCH_LOAD_REASONS_MAX][BENCH_LOAD_REASON_SIZE];
    bench_load idle = load_of(1.0, 0.5, 400), others = load_of(40.0, 0.0, 0), stolen = load_of(0.0, 20.0, 0),
               interrupted = load_of(0.0, 0.0, 200 * 100);
    assert_int_equal(bench_load_judge(&idle, 0.99, reasons), 0);
    assert_int_equal(bench_load_judge(&others, 0.99, reasons), 1);
    assert_string_equal(reasons[0], "other processes took 10.0 % of the processors' time (3 % at most)");
    assert_int_equal(bench_load_judge(&stolen, 0.99, reasons), 1);
    assert_non_null(strstr(reasons[0], "the hypervisor took 5.0 %"));
    assert_int_equal(bench_load_judge(&interrupted, 0.99, reasons), 1);
    assert_non_null(strstr(reasons[0], "interrupted 100 times"));
    /* a quota that is less than the threads want: what they had of their processors tells */
    assert_int_equal(bench_load_judge(&idle, 0.5, reasons), 1);
    assert_non_null(strstr(reasons[0], "had 50 % of their processors"));
    /* ticks are coarse: ours may be more than all that was counted */
    assert_true(load_of(-0.5, 0.0, 0).others_share == 0.0);
}

/* --- the machine --- */

static void expect_levels(unsigned cores, unsigned threads, const char *expected)
{
    unsigned levels[BENCH_LEVELS_MAX], count = bench_levels_of(cores, threads, levels);
    char text[256] = "";
    for (unsigned i = 0; i < count; i++)
        snprintf(text + strlen(text), sizeof text - strlen(text), "%s%u", i ? " " : "", levels[i]);
    assert_string_equal(text, expected);
}

static void test_levels(void **state)
{
    (void)state;
    expect_levels(1, 1, "1");
    expect_levels(2, 2, "1 2");
    expect_levels(6, 12, "1 2 4 6 12");
    expect_levels(8, 8, "1 2 4 8");
    expect_levels(512, 1024, "1 2 4 8 16 32 64 128 256 512 1024");

    /* two cores of two threads each; a quota leaves three threads */
    bench_cpu cpus[] = {{.core = 0}, {.core = 1, .numa_node = 1}, {.core = 0, .sibling = 1}, {.core = 1, .sibling = 1}};
    const bench_machine machine = {.cpus = cpus, .cpu_count = 4, .core_count = 2, .entitled = 3};
    bench_level l = bench_level_describe(&machine, 2);
    assert_true(l.cores == 2 && l.numa_nodes == 2 && l.has_all_phases && !l.is_oversubscribed);
    l = bench_level_describe(&machine, 3);
    assert_true(l.cores == 2 && !l.is_oversubscribed);
    l = bench_level_describe(&machine, 4);
    assert_true(l.is_oversubscribed);
    l = bench_level_describe(&machine, 64);
    assert_true(l.cores == 2 && l.is_oversubscribed);
}

/* --- scores --- */

/* Makes a run of one and two threads on an idle machine; the second turn of each phase is faster by `spread`. */
static void make_run(double spread)
{
    static bench_cpu cpus[2];
    made_up = (bench_run){.size = BENCH_SMALL, .turns = 3, .level_count = 2, .isa = "avx2", .seconds = 200.0};
    made_up.machine = (bench_machine){.cpus = cpus,
                                      .cpu_count = 2,
                                      .core_count = 2,
                                      .numa_count = 1,
                                      .package_count = 1,
                                      .entitled = 2,
                                      .clock_is_fixed = -1};
    strcpy(made_up.machine.cpu_name, "Example <1> & Co");
    made_up.load = load_of(0.0, 0.0, 0);
    for (unsigned level = 0; level < 2; level++) {
        made_up.levels[level] = bench_level_describe(&made_up.machine, level + 1);
        made_up.levels[level].arithmetic_share = 0.99;
        for (unsigned turn = 0; turn < 3; turn++) {
            made_up.levels[level].arithmetic[turn] = 1e9 * (level + 1);
            made_up.levels[level].memory[turn] = 1e10 * (1.0 + 0.5 * level);
        }
        for (int i = 0; i < BENCH_SCENE_COUNT; i++)
            for (int phase = 0; phase < BENCH_PHASE_COUNT; phase++) {
                bench_part *p = &made_up.parts[i][phase][level];
                *p = (bench_part){.is_measured = true,
                                  .is_steady = true,
                                  .is_sound = true,
                                  .units = 9,
                                  .items = 90,
                                  .seconds = 3.0,
                                  .cpu_s = 3.0,
                                  .requests = 100,
                                  .computed = 40};
                for (unsigned turn = 0; turn < 3; turn++)
                    p->rate[turn] = 100.0 * (1.0 + 0.8 * level) * (turn == 1 ? 1.0 + spread : 1.0);
            }
    }
}

static json_t *result_of(void)
{
    static certificate c;
    bench_build build = bench_build_describe(made_up.isa, "NobodysMaker");
    bench_certify(&made_up, &build, &c);
    json_t *result = bench_json(&made_up, &build, &c);
    assert_non_null(result);
    return result;
}

static void test_interval(void **state)
{
    (void)state;
    const double odd[] = {3.0, 1.0, 2.0}, even[] = {4.0, 1.0, 2.0, 3.0};
    bench_interval i = bench_interval_of(odd, 3);
    assert_true(i.median == 2.0 && i.least == 1.0 && i.most == 3.0 && bench_spread(i) == 1.0);
    assert_true(bench_interval_of(even, 4).median == 2.5);
}

static void test_scores(void **state)
{
    (void)state;
    char line[512];
    make_run(0.01);
    bench_scaling s = bench_scaling_of(&made_up, BENCH_SCENE_GLASS, BENCH_PHASE_RAYS, 1);
    assert_true(s.speedup > 1.7999 && s.speedup < 1.8001 && s.efficiency > 0.8999 && s.efficiency < 0.9001);
    assert_true(s.of_arithmetic > 0.8999 && s.of_arithmetic < 0.9001);
    assert_true(s.of_memory > 1.1999 && s.of_memory < 1.2001);
    assert_int_equal(bench_best_level(&made_up), 1);
    json_t *result = result_of();
    assert_true(json_is_object(json_object_get(result, "score_one")));
    assert_int_equal(json_integer_value(json_object_get(json_object_get(result, "score_best"), "threads")), 2);
    assert_true(json_is_true(json_object_get(json_object_get(result, "score_one"), "steady")));
    bench_line(result, line, sizeof line);
    assert_non_null(strstr(line, "| Example <1> & Co | 2 cores, 2 threads | small |"));
    assert_null(strstr(line, " to "));
    json_decref(result);

    make_run(0.05); /* too much for a single number */
    result = result_of();
    assert_true(json_is_false(json_object_get(json_object_get(result, "score_one"), "steady")));
    bench_line(result, line, sizeof line);
    assert_non_null(strstr(line, " to "));
    json_decref(result);
}

static void expect_no_score(const char *reason)
{
    size_t i;
    json_t *value, *result = result_of();
    bool is_named = false;
    assert_true(json_is_null(json_object_get(result, "score_one")));
    assert_true(json_is_null(json_object_get(result, "score_best")));
    json_array_foreach(json_object_get(result, "refused"), i, value) is_named =
        is_named || strstr(json_string_value(value), reason);
    assert_true(is_named);
    json_decref(result);
}

static void test_refused(void **state)
{
    (void)state;
    make_run(0.0);
    made_up.load = load_of(100.0, 0.0, 0);
    expect_no_score("other processes took 25.0 %");
    make_run(0.0);
    made_up.levels[1].arithmetic_share = 0.5;
    expect_no_score("had 50 %");
    make_run(0.0);
    made_up.levels[1].arithmetic_share = 0.5; /* more threads than processors share them: that alone is no fault */
    made_up.levels[1].is_oversubscribed = true;
    json_t *result = result_of();
    assert_int_equal(json_array_size(json_object_get(result, "refused")), 0);
    assert_int_equal(json_integer_value(json_object_get(json_object_get(result, "score_best"), "threads")), 1);
    json_decref(result);
    make_run(0.0);
    made_up.parts[1][BENCH_PHASE_FRAME][1].hash.bits[0] ^= 4; /* a wrong picture */
    expect_no_score("the certificate is not valid");
    make_run(0.0);
    made_up.size = BENCH_QUICK;
    expect_no_score("the quick size");
}

static void test_page(void **state)
{
    (void)state;
    make_run(0.01);
    json_t *result = result_of();
    char *page = bench_page(result);
    assert_non_null(page);
    assert_non_null(strstr(page, "Example &lt;1&gt; &amp; Co"));
    assert_non_null(strstr(page, "<svg "));
    assert_non_null(strstr(page, "</html>"));
    assert_null(strstr(page, "<script"));
    assert_null(strstr(page, "http"));
    assert_null(strstr(page, "nan"));
    free(page);
    json_decref(result);
}

/* --- options --- */

static bool parse(const char *arguments, bench_options *out)
{
    static char words[256];
    char *argv[16] = {0};
    int argc = 0;
    snprintf(words, sizeof words, "afterglow-bench %s", arguments);
    for (char *word = strtok(words, " "); word; word = strtok(NULL, " "))
        argv[argc++] = word;
    return bench_options_parse(argc, argv, out, message, sizeof message);
}

static void test_options(void **state)
{
    (void)state;
    bench_options o;
    assert_true(parse("", &o) && o.level_count == 0 && !o.has_size && o.action == BENCH_MEASURE);
    assert_true(parse("--threads 8,2,2 --size large --allow-busy -o a.json -o b.html", &o));
    assert_true(o.level_count == 3 && o.levels[0] == 1 && o.levels[1] == 2 && o.levels[2] == 8);
    assert_true(o.size == BENCH_LARGE && o.allows_busy);
    assert_string_equal(o.json_path, "a.json");
    assert_string_equal(o.page_path, "b.html");
    assert_true(parse("compare a.json b.json", &o) && o.action == BENCH_COMPARE);
    static const char *const wrong[] = {"compare a.json", "--size",          "--size huge",  "--threads 0",
                                        "--threads 1,,2", "--threads 99999", "--threads x",  "--threads -1",
                                        "-o a.txt",       "--fast",          "--threads 2,", "scene.pbrt"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        if (parse(wrong[i], &o))
            fail_msg("'%s' was taken", wrong[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_proc_stat), cmocka_unit_test(test_busy),    cmocka_unit_test(test_levels),
        cmocka_unit_test(test_interval),  cmocka_unit_test(test_scores),  cmocka_unit_test(test_refused),
        cmocka_unit_test(test_page),      cmocka_unit_test(test_options),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
