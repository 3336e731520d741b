/* test_scaling_simulation.c: the simulated frame accounts for its time: one worker takes the sum of all costs, any
 * number does the same work once, nobody is faster than his share, and one slot that all want is waited for by all but
 * one. Flow: tests of perf/bench/scaling_simulation.c. Threads: one. */
#define _GNU_SOURCE
#include "bench/scaling_simulation.h"
#include "fixtures/temporary_folder.h"

#include <math.h>

static const simulated_frame FRAME = {.width = 200,
                                      .height = 150,
                                      .requests_per_pixel = 16.5,
                                      .photons = 20000,
                                      .own_s = 1e-6,
                                      .estimate_s = 5e-6,
                                      .claim_s = 1e-7,
                                      .tile_claim_s = 1e-7,
                                      .tile_spread = 0.3};

static simulated_run run_on(const simulated_frame *frame, unsigned workers)
{
    simulated_run run;
    assert_int_equal(simulation_run(frame, workers, &run), AG_OK);
    return run;
}

static void expect_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%g instead of %g, by %g at most", value, expected, tolerance);
}

static void test_one_worker(void **state)
{
    (void)state;
    simulated_frame even = FRAME;
    even.tile_spread = even.tile_claim_s = 0.0;
    simulated_run run = run_on(&even, 1);
    assert_int_equal(run.requests, 16.5 * 200 * 150);
    assert_int_equal(run.deferred, 0);
    assert_int_equal(run.waited, 0);
    double expected = (double)run.requests * even.own_s + (double)run.computed * (even.claim_s + even.estimate_s);
    expect_near(run.seconds, expected, 0.01 * expected); /* 1 %: looks at slots */
    assert_true(run.seconds > expected);
    expect_near(run.idle_s, 0.0, 1e-9);
    /* distinct ones of so many drawn: mean by the formula, deviation below the root of the mean */
    double mean = even.photons * -expm1(-(double)run.requests / even.photons);
    expect_near((double)run.computed, mean, 4.0 * sqrt(mean));
    expect_near(simulation_photons(run.requests, run.computed), even.photons, 0.01 * even.photons);
}

static void test_many_workers(void **state)
{
    (void)state;
    simulated_run one = run_on(&FRAME, 1);
    for (unsigned workers = 2; workers <= SIMULATION_WORKERS_MAX; workers *= 4) {
        simulated_run run = run_on(&FRAME, workers);
        assert_int_equal(run.requests, one.requests);
        assert_int_equal(run.computed, one.computed); /* nothing twice */
        assert_true(run.waited <= run.deferred);
        assert_true(run.seconds * workers >= 0.999 * one.seconds);
        /* what all spend is work, waiting and being idle */
        double spent = run.seconds * workers - run.waiting_s - run.idle_s;
        expect_near(spent, one.seconds, 0.01 * one.seconds + workers * 1e-3);
    }
    simulated_run eight = run_on(&FRAME, 8);
    assert_true(one.seconds / eight.seconds > 6.0);
}

/* All threads ask for one photon: one computes its estimate, and the others wait for it. */
static void test_one_slot(void **state)
{
    (void)state;
    simulated_frame f = FRAME;
    f.photons = 1;
    f.estimate_s = 1.0;
    simulated_run run = run_on(&f, 4);
    assert_int_equal(run.computed, 1);
    assert_int_equal(run.waited, 3);
    expect_near(run.waiting_s, 3.0, 0.2);
    assert_true(run.seconds > 1.0 && run.seconds < 1.2);
}

static void test_arguments(void **state)
{
    (void)state;
    simulated_run run;
    simulated_frame bad = FRAME;
    assert_int_equal(simulation_run(&FRAME, 0, &run), AG_ERROR_ARGUMENT);
    assert_int_equal(simulation_run(&FRAME, SIMULATION_WORKERS_MAX + 1, &run), AG_ERROR_ARGUMENT);
    bad.photons = 0;
    assert_int_equal(simulation_run(&bad, 1, &run), AG_ERROR_ARGUMENT);
    bad = FRAME;
    bad.tile_spread = 2.0;
    assert_int_equal(simulation_run(&bad, 1, &run), AG_ERROR_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_one_worker), cmocka_unit_test(test_many_workers),
                                       cmocka_unit_test(test_one_slot), cmocka_unit_test(test_arguments)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
