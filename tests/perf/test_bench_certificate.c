/* test_bench_certificate.c: the certificate of afterglow-bench on made-up records: right work is certified, and each
 * fault that is planted is found and named. Flow: tests of perf/bench/bench_certificate.c. Threads: one. */
#define _GNU_SOURCE
#include "bench/bench_certificate.h"
#include "fixtures/temporary_folder.h"

enum { ENTRIES = 6 };

/* Two phases of one scene on 1, 2 and 4 threads. */
static void make_right_work(certificate_entry entries[ENTRIES])
{
    const unsigned threads[] = {1, 2, 4};
    for (int i = 0; i < ENTRIES; i++) {
        int phase = i / 3;
        entries[i] = (certificate_entry){.scene = "room",
                                         .phase = phase == 0 ? "photons" : "frame",
                                         .threads = threads[i % 3],
                                         .hash = {{11 + (uint64_t)phase, 12}},
                                         .count = 100,
                                         .expected = 100,
                                         .is_steady = true,
                                         .is_sound = true};
    }
}

static void expect_refusal(const certificate_entry entries[ENTRIES], const char *text)
{
    certificate c;
    certificate_judge(entries, ENTRIES, NULL, &c);
    assert_false(c.is_valid);
    assert_true(c.reason_count > 0);
    bool is_named = false;
    for (unsigned i = 0; i < c.reason_count; i++)
        is_named = is_named || strstr(c.reasons[i], text);
    if (!is_named)
        fail_msg("'%s' is not in: %s", text, c.reasons[0]);
}

static void test_right_work(void **state)
{
    (void)state;
    certificate_entry entries[ENTRIES];
    certificate c, again;
    make_right_work(entries);
    certificate_judge(entries, ENTRIES, NULL, &c);
    assert_true(c.is_valid);
    assert_int_equal(c.reason_count, 0);
    assert_int_equal(c.duplicated, 0);
    assert_int_equal(c.known, BENCH_BUILD_UNKNOWN);

    /* fewer numbers of threads: the same certificate */
    certificate_entry fewer[] = {entries[0], entries[3]};
    certificate_judge(fewer, 2, NULL, &again);
    assert_true(hash128_is_equal(c.hash, again.hash));

    certificate_judge(entries, 0, NULL, &c);
    assert_false(c.is_valid);
}

static void test_wrong_picture(void **state)
{
    (void)state;
    certificate_entry entries[ENTRIES];
    make_right_work(entries);
    entries[4].hash.bits[1] ^= 1; /* one bit, on two threads */
    expect_refusal(entries, "room, frame: bits on 2 threads are not those on 1");
}

static void test_counts(void **state)
{
    (void)state;
    certificate_entry entries[ENTRIES];
    make_right_work(entries);
    entries[2].count = entries[2].expected = 101;
    expect_refusal(entries, "counted 101 on 4 threads and 100 on 1");
    make_right_work(entries);
    entries[0].count = 99;
    expect_refusal(entries, "counted 99 instead of 100 on 1 threads");
    make_right_work(entries);
    entries[5].duplicated = 3;
    expect_refusal(entries, "3 irradiances were computed twice on 4 threads");
}

static void test_soundness(void **state)
{
    (void)state;
    certificate_entry entries[ENTRIES];
    make_right_work(entries);
    entries[1].is_steady = false;
    expect_refusal(entries, "bits differ from one time to the next on 2 threads");
    make_right_work(entries);
    for (int i = 3; i < ENTRIES; i++) /* all agree, and all are black */
        entries[i].is_sound = false;
    expect_refusal(entries, "nothing but 0");
}

/* The hash of a known build: all numbers of threads may agree and yet be wrong. */
static void test_known_build(void **state)
{
    (void)state;
    certificate_entry entries[ENTRIES];
    certificate c;
    make_right_work(entries);
    certificate_judge(entries, ENTRIES, NULL, &c);
    hash128 right = c.hash;
    certificate_judge(entries, ENTRIES, &right, &c);
    assert_int_equal(c.known, BENCH_BUILD_MATCHES);
    assert_true(c.is_valid);
    for (int i = 0; i < 3; i++)
        entries[i].hash.bits[0]++;
    certificate_judge(entries, ENTRIES, &right, &c);
    assert_int_equal(c.known, BENCH_BUILD_DIFFERS);
    assert_false(c.is_valid);
    assert_string_equal(c.reasons[0], "this build is known to make other bits");

    hash128 none;
    bench_build build = bench_build_describe("avx2", "NobodysMaker");
    assert_false(bench_known_hash(&build, "small", &none));
    assert_int_equal(strlen(build.sources), 32);
}

/* Where there are more faults than there is room for, the first ones are kept. */
static void test_many_faults(void **state)
{
    (void)state;
    certificate_entry entries[40];
    certificate c;
    for (int i = 0; i < 40; i++)
        entries[i] =
            (certificate_entry){.scene = "room", .phase = "tree", .threads = (unsigned)i + 1, .is_steady = true};
    certificate_judge(entries, 40, NULL, &c);
    assert_int_equal(c.reason_count, CERTIFICATE_REASONS_MAX);
    assert_non_null(strstr(c.reasons[0], "on 1 threads"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_right_work), cmocka_unit_test(test_wrong_picture), cmocka_unit_test(test_counts),
        cmocka_unit_test(test_soundness),  cmocka_unit_test(test_known_build),   cmocka_unit_test(test_many_faults),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
