/* test_sampling.c: warps of the unit square have the densities that they name; random numbers are what they should be.
 * Threads: one. */
#include "math/sampling.h"

#include "fixtures/test_scene.h"

static void sine_and_cosine_are_right_to_float_precision(void **state)
{
    (void)state;
    for (int i = -20000; i <= 20000; i++) {
        float u = (float)i / 20000.0f, s, c;
        sincos_turns(u, &s, &c);
        assert_close(s, sin(2.0 * PI * (double)u), 1.2e-7);
        assert_close(c, cos(2.0 * PI * (double)u), 1.2e-7);
    }
    float s, c;
    sincos_turns(0.25f, &s, &c);
    assert_true(s == 1.0f && c == 0.0f);
}

enum { COUNT = 400000 / FEWER };

/* Mean of x, y, z and of their squares over many samples, against what they should be. */
static void expect_moments(vec3 (*warp)(vec2), const double mean[3], const double square[3])
{
    rng random = test_random(5);
    double sum[3] = {0}, sum2[3] = {0};
    for (int i = 0; i < COUNT; i++) {
        vec3 v = warp(rng_vec2(&random));
        double a[3] = {v.x, v.y, v.z};
        for (int k = 0; k < 3; k++) {
            sum[k] += a[k] / COUNT;
            sum2[k] += a[k] * a[k] / COUNT;
        }
    }
    for (int k = 0; k < 3; k++) {
        assert_close(sum[k], mean[k], 4.0 / sqrt(COUNT));
        assert_close(sum2[k], square[k], 4.0 / sqrt(COUNT));
    }
}

static vec3 disk(vec2 u)
{
    vec2 d = sample_disk_concentric(u);
    assert_true(d.x * d.x + d.y * d.y <= 1.000001f);
    return (vec3){d.x, d.y, d.x * d.x + d.y * d.y}; /* the third is uniform */
}

static vec3 triangle(vec2 u)
{
    vec2 b = sample_triangle(u);
    assert_true(b.x >= 0.0f && b.y >= 0.0f && b.x + b.y <= 1.000001f);
    return (vec3){b.x, b.y, 1.0f - b.x - b.y};
}

static void disks_and_triangles_are_filled_evenly(void **state)
{
    (void)state;
    expect_moments(disk, (const double[3]){0, 0, 0.5}, (const double[3]){0.25, 0.25, 1 / 3.0});
    expect_moments(triangle, (const double[3]){1 / 3.0, 1 / 3.0, 1 / 3.0},
                   (const double[3]){1 / 6.0, 1 / 6.0, 1 / 6.0});
    vec2 middle = sample_disk_concentric((vec2){0.5f, 0.5f});
    assert_true(middle.x == 0.0f && middle.y == 0.0f);
}

static double cosine_density(void *user, vec3 d) { return (void)user, d.z > 0.0f ? (double)d.z / PI : 0.0; }
static double sphere_density(void *user, vec3 d) { return (void)user, (void)d, 1.0 / (4.0 * PI); }
static double cone_density(void *user, vec3 d)
{
    double h = *(double *)user;
    return 1.0 - (double)d.z < h ? 1.0 / (2.0 * PI * h) : 0.0;
}

static void directions_have_their_densities(void **state)
{
    (void)state;
    /* a cone that ends on the edge of bins, so that midpoints integrate it well */
    double h = 10 * 2.0 / BINS_Z;
    static uint32_t counts[3][BIN_COUNT];
    static double bins[BIN_COUNT];
    memset(counts, 0, sizeof counts);
    rng random = test_random(6);
    for (int i = 0; i < COUNT; i++) {
        vec3 d[3] = {sample_cosine_hemisphere(rng_vec2(&random)), sample_uniform_sphere(rng_vec2(&random)),
                     sample_uniform_cone(rng_vec2(&random), (float)h)};
        for (int k = 0; k < 3; k++) {
            assert_close(vec3_length(d[k]), 1.0, 1e-5);
            counts[k][direction_bin(d[k])]++;
        }
        assert_true(d[0].z > 0.0f);
    }
    assert_close(integrate_bins(cosine_density, NULL, 4, bins), 1.0, 1e-3);
    assert_chi_square(counts[0], bins, COUNT, 1e-3);
    assert_close(integrate_bins(sphere_density, NULL, 1, bins), 1.0, 1e-9);
    assert_chi_square(counts[1], bins, COUNT, 0.0);
    assert_close(integrate_bins(cone_density, &h, 2, bins), 1.0, 1e-6);
    assert_chi_square(counts[2], bins, COUNT, 1e-3);
}

static void a_thin_cone_keeps_its_precision(void **state)
{
    (void)state;
    rng random = test_random(7);
    double mean = 0.0;
    for (int i = 0; i < 10000; i++) {
        vec3 d = sample_uniform_cone(rng_vec2(&random), 1e-10f);
        mean += ((double)d.x * (double)d.x + (double)d.y * (double)d.y) / 10000.0; /* 2 h u, on average h */
    }
    assert_relative(mean, 1e-10, 0.03);
}

static void mis_weights_share(void **state)
{
    (void)state;
    rng random = test_random(8);
    for (int i = 0; i < 1000; i++) {
        float a = rng_float(&random) * 9.0f, b = rng_float(&random) + 0.01f;
        assert_close(mis_power(2.0f, a, 3.0f, b) + mis_power(3.0f, b, 2.0f, a), 1.0, 1e-6);
    }
    assert_close(mis_power(1.0f, 1.0f, 1.0f, 3.0f), 0.1, 1e-6);
    assert_close(mis_power(3.0f, 1.0f, 1.0f, 1.0f), 0.9, 1e-6);
    assert_true(mis_power(1.0f, 0.0f, 1.0f, 0.0f) == 0.0f);
    assert_true(mis_power(1.0f, 2.0f, 1.0f, 0.0f) == 1.0f);
    assert_true(mis_power(1.0f, INFINITY, 1.0f, 1.0f) == 1.0f);
}

static void random_numbers_are_uniform_and_their_own(void **state)
{
    (void)state;
    /* neighbouring streams and successive numbers know nothing of each other */
    double sum[4] = {0}, streams = 0.0, successive = 0.0, pair = 0.0;
    const int count = 200000;
    for (int i = 0; i < count; i++) {
        rng a = rng_make(1, 2, (uint64_t)i), b = rng_make(1, 2, (uint64_t)i + 1);
        float u = rng_float(&a), v = rng_float(&a), w = rng_float(&b);
        vec2 p = rng_vec2(&a);
        assert_true(u >= 0.0f && u < 1.0f && p.x >= 0.0f && p.x < 1.0f && p.y >= 0.0f && p.y < 1.0f);
        float x[4] = {u, v, p.x, p.y};
        for (int k = 0; k < 4; k++)
            sum[k] += x[k] / (double)count;
        streams += 12.0 * (u - 0.5) * (w - 0.5) / count;
        successive += 12.0 * (u - 0.5) * (v - 0.5) / count;
        pair += 12.0 * (p.x - 0.5) * (p.y - 0.5) / count;
    }
    for (int k = 0; k < 4; k++)
        assert_close(sum[k], 0.5, 4.0 * sqrt(1 / 12.0 / count));
    assert_close(streams, 0.0, 4.0 / sqrt(count));
    assert_close(successive, 0.0, 4.0 / sqrt(count));
    assert_close(pair, 0.0, 4.0 / sqrt(count));
    /* a pure function of its keys, each of which matters */
    rng a = rng_make(1, 2, 3), same = rng_make(1, 2, 3), b = rng_make(2, 2, 3), c = rng_make(1, 3, 3),
        d = rng_make(1, 2, 4);
    uint64_t first = rng_next(&a);
    assert_true(first == rng_next(&same));
    assert_true(first != rng_next(&b) && first != rng_next(&c) && first != rng_next(&d));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sine_and_cosine_are_right_to_float_precision),
        cmocka_unit_test(disks_and_triangles_are_filled_evenly),
        cmocka_unit_test(directions_have_their_densities),
        cmocka_unit_test(a_thin_cone_keeps_its_precision),
        cmocka_unit_test(mis_weights_share),
        cmocka_unit_test(random_numbers_are_uniform_and_their_own),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
