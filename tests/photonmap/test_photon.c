/* test_photon.c: the photon's 24 bytes: flux and directions survive their packing, flux without bias.
 * Threads: one. */
#include "photon.h"

#include "fixtures/test_scene.h"

#include <float.h>

static void a_photon_is_24_bytes(void **state)
{
    (void)state;
    assert_int_equal(sizeof(photon), 24);
    assert_int_equal(offsetof(photon, slot), 20);
    assert_int_equal(_Alignof(photon), 4);
}

static void flux_survives_within_a_step(void **state)
{
    (void)state;
    rng random = test_random(1);
    for (int i = 0; i < 200000 / FEWER; i++) {
        float scale = ldexpf(0.5f + 0.5f * rng_float(&random), (int)(rng_next(&random) % 200) - 100);
        rgb flux = {rng_float(&random) * scale, rng_float(&random) * scale, rng_float(&random) * scale};
        float largest = rgb_max(flux);
        if (largest < 0x1p-105f)
            continue;
        rgb back = flux_decode(flux_encode(flux, (uint64_t)i));
        /* the step is 1/127.5 of the largest channel at most, and rounding goes to one of the two neighbours */
        double step = (double)largest / 127.5 * 1.000001;
        assert_close(back.r, flux.r, step);
        assert_close(back.g, flux.g, step);
        assert_close(back.b, flux.b, step);
        assert_true(back.r >= 0.0f && back.g >= 0.0f && back.b >= 0.0f);
    }
}

static void flux_at_the_ends_of_its_range(void **state)
{
    (void)state;
    assert_int_equal(flux_encode(rgb_gray(0.0f), 7), 0);
    assert_true(rgb_is_black(flux_decode(0)));
    assert_int_equal(flux_encode(rgb_gray(FLT_MIN), 7), 0);
    assert_relative(flux_decode(flux_encode(rgb_gray(0x1p-109f), 7)).g, 0x1p-109, 1 / 127.0);
    rgb huge = flux_decode(flux_encode(rgb_gray(0.5f * FLT_MAX), 7));
    assert_true(isfinite(huge.r));
    assert_relative(huge.r, 0.5 * (double)FLT_MAX, 1 / 127.0);
    /* a single channel, at powers of two and just below them */
    for (int e = -100; e < 120; e++)
        for (int below = 0; below < 2; below++) {
            float v = below ? nextafterf(ldexpf(1.0f, e), 0.0f) : ldexpf(1.0f, e);
            rgb back = flux_decode(flux_encode((rgb){0.0f, v, 0.0f}, (uint64_t)e));
            assert_relative(back.g, v, 1 / 127.0);
            assert_true(back.r == 0.0f && back.b == 0.0f);
        }
}

/* Exponents read from the bits, without libm, are those that libm gives. */
static void exponents_are_read_from_the_bits(void **state)
{
    (void)state;
    for (int e = -126; e <= 127; e++)
        assert_true(power_of_two(e) == ldexpf(1.0f, e));
    assert_true(power_of_two(-127) == 0.0f && isinf(power_of_two(128)));
    for (uint32_t bits = 0x00800000; bits < 0x7f800000; bits += 2048 - 1) {
        float v;
        memcpy(&v, &bits, sizeof v);
        int exponent;
        float fraction = frexpf(v, &exponent);
        assert_int_equal(shared_exponent_of(v), exponent - 8 + (fraction * 256.0f > 255.0f));
    }
}

static void expect_unbiased(rgb flux, bool keys_are_hashes, uint64_t count)
{
    double sum[3] = {0.0, 0.0, 0.0};
    for (uint64_t i = 0; i < count; i++) {
        rgb v = flux_decode(flux_encode(flux, keys_are_hashes ? hash_combine(99, i) : i));
        sum[0] += v.r, sum[1] += v.g, sum[2] += v.b;
    }
    assert_relative(sum[0] / (double)count, flux.r, 1e-3);
    assert_relative(sum[1] / (double)count, flux.g, 1e-3);
    assert_relative(sum[2] / (double)count, flux.b, 1e-3);
}

/* Photons of equal power would share one rounding error, if it did not depend on the photon. */
static void the_mean_flux_of_equal_photons_is_right(void **state)
{
    (void)state;
    expect_unbiased((rgb){1.0f, 0.01f, 0.001f}, false, 1 << 24);
    expect_unbiased((rgb){1.0f, 0.01f, 0.001f}, true, 1 << 24);
    expect_unbiased((rgb){0.003f, 0.9f, 0.0101f}, false, 1 << 22);
    expect_unbiased((rgb){1.0f, 1.0f, 1.0f}, false, 1 << 18);
    expect_unbiased((rgb){254.7f, 255.0f, 127.6f}, false, 1 << 18);
    expect_unbiased((rgb){3.1e-7f, 2.2e-8f, 7.7e-9f}, true, 1 << 20);
}

static void directions_survive_within_a_degree(void **state)
{
    (void)state;
    rng random = test_random(2);
    double worst = 0.0;
    for (int i = 0; i < 1000000 / FEWER; i++) {
        vec3 d = random_direction(&random), back = direction_decode(direction_encode(d));
        assert_close(vec3_length(back), 1.0, 1e-6);
        double chord = vec3_length(vec3_sub(d, back));
        worst = fmax(worst, 2.0 * asin(0.5 * chord) * 180.0 / PI);
    }
    assert_true(worst < 1.0);
}

static void axes_survive_exactly(void **state)
{
    (void)state;
    for (int axis = 0; axis < 3; axis++)
        for (int sign = -1; sign <= 1; sign += 2) {
            float d[3] = {0.0f, 0.0f, 0.0f};
            d[axis] = (float)sign;
            vec3 back = direction_decode(direction_encode((vec3){d[0], d[1], d[2]}));
            assert_true(back.x == d[0] && back.y == d[1] && back.z == d[2]);
        }
    /* every code decodes to a unit direction that gives the same one again */
    for (uint32_t code = 0; code < 0x10000; code++) {
        if ((code >> 8) == 255 || (code & 255) == 255)
            continue; /* never made */
        vec3 d = direction_decode((uint16_t)code), again = direction_decode(direction_encode(d));
        assert_close(vec3_length(d), 1.0, 1e-6);
        assert_true(vec3_distance_squared(d, again) < 1e-10f);
    }
}

/* Directions of arrival are kept as one of 181 x 181 steps, beside a mark. */
static void arrivals_survive_within_two_degrees(void **state)
{
    (void)state;
    rng random = test_random(3);
    double worst = 0.0;
    for (int i = 0; i < 1000000 / FEWER; i++) {
        vec3 d = random_direction(&random);
        uint16_t code = arrival_encode(d, i & 1);
        vec3 back = arrival_direction(code);
        assert_int_equal(arrival_is_diffuse(code), i & 1);
        assert_close(vec3_length(back), 1.0, 1e-6);
        worst = fmax(worst, 2.0 * asin(0.5 * vec3_length(vec3_sub(d, back))) * 180.0 / PI);
    }
    assert_true(worst < 1.5);
    for (int axis = 0; axis < 3; axis++)
        for (int sign = -1; sign <= 1; sign += 2) {
            float d[3] = {0.0f, 0.0f, 0.0f};
            d[axis] = (float)sign;
            vec3 back = arrival_direction(arrival_encode((vec3){d[0], d[1], d[2]}, sign > 0));
            assert_true(back.x == d[0] && back.y == d[1] && back.z == d[2]);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_photon_is_24_bytes),
        cmocka_unit_test(flux_survives_within_a_step),
        cmocka_unit_test(flux_at_the_ends_of_its_range),
        cmocka_unit_test(exponents_are_read_from_the_bits),
        cmocka_unit_test(the_mean_flux_of_equal_photons_is_right),
        cmocka_unit_test(directions_survive_within_a_degree),
        cmocka_unit_test(axes_survive_exactly),
        cmocka_unit_test(arrivals_survive_within_two_degrees),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
