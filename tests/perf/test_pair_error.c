/* test_pair_error.c: the error of a pair of pictures, by hand and by the variances that they were made with.
 * Flow: tests of perf/bench/pair_error.c. Threads: one. */
#define _GNU_SOURCE
#include "bench/pair_error.h"
#include "fixtures/temporary_folder.h"
#include "math/rng.h"

#include <math.h>

enum { PIXELS = 40000 };

static void expect_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%g instead of %g, by %g at most", value, expected, tolerance);
}

/* Two values of each, by hand: reference 2 and 4, mean 3, so weights are 1 / (4 + 0.09) and 1 / (16 + 0.09). */
static void test_by_hand(void **state)
{
    (void)state;
    const float r1[] = {1, 1, 1, 4, 4, 4}, r2[] = {3, 3, 3, 4, 4, 4};
    const float a[] = {3, 3, 3, 5, 5, 5}, b[] = {5, 5, 5, 7, 7, 7};
    pair_errors e;
    assert_true(pair_errors_of(a, b, r1, r2, 2, 0.0, &e));
    /* (1 + 9) / 2 less the reference's own 4 / 4; (1 + 9) / 2; variances of 4 / 2 */
    double error = (4.0 / 4.09 + 5.0 / 16.09) / 2.0, variance = (2.0 / 4.09 + 2.0 / 16.09) / 2.0;
    expect_near(e.whole.error, error, 1e-12);
    expect_near(e.whole.variance, variance, 1e-12);
    expect_near(e.whole.bias_squared, error - variance, 1e-12);
    expect_near(e.mean_ratio, 5.0 / 3.0, 1e-12);
    expect_near(e.trimmed.error, error, 1e-12);
    /* half of the pixels: the first one's measured 5 / 4.09 is more than the second's 5 / 16.09 */
    assert_true(pair_errors_of(a, b, r1, r2, 2, 0.5, &e));
    expect_near(e.trimmed.error, 5.0 / 16.09, 1e-12);
    expect_near(e.trimmed.variance, 2.0 / 16.09, 1e-12);
    expect_near(e.whole.error, error, 1e-12);
}

static void test_not_finite(void **state)
{
    (void)state;
    const float good[] = {1, 1, 1}, bad[] = {1, NAN, 1}, endless[] = {1, 1, INFINITY}, black[] = {0, 0, 0};
    pair_errors e;
    assert_false(pair_errors_of(bad, good, good, good, 1, 0.0, &e));
    assert_false(pair_errors_of(good, good, good, endless, 1, 0.0, &e));
    assert_false(pair_errors_of(good, good, good, good, 0, 0.0, &e));
    assert_true(pair_errors_of(good, good, black, black, 1, 0.0, &e));
    expect_near(e.whole.error, 0.0, 0.0);
}

/* Uniform noise of mean 0 and that standard deviation. */
static float noise_of(uint64_t key, size_t i, double deviation)
{
    double u = (double)(hash_mix64(key * 0x9e3779b97f4a7c15u + (uint64_t)i) >> 11) * 0x1p-53;
    return (float)(deviation * sqrt(12.0) * (u - 0.5));
}

/* Pictures of known noise and bias against references of known noise: each is found, within four standard errors of
 * 120,000 values; and what a few bright specks add is gone without the worst hundredth. */
static void test_statistics(void **state)
{
    (void)state;
    float *p[4];
    for (int i = 0; i < 4; i++) {
        p[i] = malloc(3 * PIXELS * sizeof *p[i]);
        assert_non_null(p[i]);
    }
    const double reference = 2.0, noise = 0.5, bias = 0.1, reference_noise = 0.4;
    double weight = 1.0 / (1.01 * reference * reference); /* the reference's noise changes it: see below */
    for (size_t i = 0; i < 3 * PIXELS; i++) {
        p[0][i] = (float)(reference + bias) + noise_of(1, i, noise);
        p[1][i] = (float)(reference + bias) + noise_of(2, i, noise);
        p[2][i] = (float)reference + noise_of(3, i, reference_noise);
        p[3][i] = (float)reference + noise_of(4, i, reference_noise);
    }
    pair_errors e;
    assert_true(pair_errors_of(p[0], p[1], p[2], p[3], PIXELS, 0.01, &e));
    /* E[1 / r^2] / (1 / E[r]^2) is 1 + 3 var(r) / r^2, with the variance of the mean of two references; what is
     * measured against r counts where r is small, so the bias is seen with what r's own error shares with the weight:
     * some 5 % */
    double spread = 1.0 + 3.0 * reference_noise * reference_noise / 2.0 / (reference * reference);
    double variance = weight * spread * noise * noise;
    expect_near(e.whole.variance, variance, 0.03 * variance);
    expect_near(e.whole.error - e.whole.variance, e.whole.bias_squared, 1e-12);
    for (size_t i = 0; i < 3 * PIXELS; i++) /* by a reference without noise, to the standard error */
        p[2][i] = p[3][i] = (float)reference;
    assert_true(pair_errors_of(p[0], p[1], p[2], p[3], PIXELS, 0.01, &e));
    variance = weight * noise * noise;
    double sigma = weight * 2.0 * bias * noise / sqrt(2.0 * 3.0 * PIXELS) + variance / sqrt(3.0 * PIXELS);
    expect_near(e.whole.variance, variance, 4.0 * variance / sqrt(3.0 * PIXELS));
    expect_near(e.whole.bias_squared, weight * bias * bias, 4.0 * sigma);
    expect_near(e.mean_ratio, 1.0 + bias / reference, 4.0 * noise / sqrt(6.0 * PIXELS));
    double before = e.trimmed.error;
    for (size_t i = 0; i < PIXELS / 200; i++) /* specks in half a hundredth of the pixels */
        p[0][3 * 200 * i] = 1000.0f;
    assert_true(pair_errors_of(p[0], p[1], p[2], p[3], PIXELS, 0.01, &e));
    assert_true(e.whole.error > 100.0);
    expect_near(e.trimmed.error, before, 0.02 * before);
    for (int i = 0; i < 4; i++)
        free(p[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_by_hand),
        cmocka_unit_test(test_not_finite),
        cmocka_unit_test(test_statistics),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
