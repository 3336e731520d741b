/* test_onward_ways.c: from importons that passed a window, its place and width; densities that are those of the
 * directions drawn by them. Threads: those of the trees. */
#include "onward_ways.h"

#include "fixtures/test_scene.h"

/* A round window in the plane x = 0, and a floor in front of it. */
static const vec3 WINDOW = {0.0f, 2.0f, 0.0f}, UP = {0.0f, 1.0f, 0.0f};
static const float WINDOW_RADIUS = 1.0f;
enum { IMPORTONS = 4000, DIRECTIONS = 200000 };

static float between(rng *random, float low, float high) { return low + (high - low) * rng_float(random); }

/* Importons on the floor, at x in [low, high], that passed the window; a share of them came from anywhere instead. */
static void make_ways(test_run *r, float low, float high, float astray, onward_ways *out_ways)
{
    photon *importons = photon_records_create(IMPORTONS);
    rng random = test_random(3);
    assert_non_null(importons);
    for (int i = 0; i < IMPORTONS; i++) {
        vec3 at = {between(&random, low, high), 0.0f, between(&random, -0.5f * high, 0.5f * high)};
        vec2 d = sample_disk_concentric(rng_vec2(&random));
        vec3 from = {WINDOW.x, WINDOW.y + WINDOW_RADIUS * d.y, WINDOW.z + WINDOW_RADIUS * d.x};
        vec3 direction = vec3_normalize(vec3_sub(at, from)), any = sample_cosine_hemisphere(rng_vec2(&random));
        if (rng_float(&random) < astray)
            direction = (vec3){any.x, -any.z, any.y};
        importons[i] = (photon){.position = {at.x, at.y, at.z},
                                .flux = flux_encode(rgb_gray(1.0f), 0),
                                .direction = arrival_encode(direction, true),
                                .normal = direction_encode(UP)};
    }
    assert_int_equal(onward_ways_create(&r->run, importons, IMPORTONS, out_ways), AG_OK);
    assert_true(out_ways->histograms.histogram_count > 0);
}

static void windows_are_found(void **state)
{
    (void)state;
    static const float ASTRAY[] = {0.0f, 0.25f};
    test_run r;
    rng random = test_random(7);
    test_run_init(&r, 2);
    for (int i = 0; i < 2; i++) {
        onward_ways ways;
        make_ways(&r, 10.0f, 40.0f, ASTRAY[i], &ways);
        for (uint32_t k = 0; k < ways.histograms.histogram_count; k++)
            assert_true(ways.openings[k].radius > WINDOW_RADIUS && ways.openings[k].radius < 2.0f * WINDOW_RADIUS);
        for (int k = 0; k < 100; k++) {
            vec3 at = {between(&random, 10.0f, 40.0f), 0.0f, between(&random, -20.0f, 20.0f)};
            onward_guide guide;
            assert_true(onward_ways_find(&ways, at, UP, &guide));
            assert_true(guide.cone_count > 0);
            float off = vec3_length(vec3_cross(vec3_sub(WINDOW, at), guide.towards.z));
            assert_true(off < 0.7f * WINDOW_RADIUS);
        }
        onward_ways_reset(&ways);
    }
    test_run_reset(&r);
}

/* Light from everywhere passes no window. */
static void no_window_is_found_where_there_is_none(void **state)
{
    (void)state;
    test_run r;
    onward_ways ways;
    onward_guide guide;
    rng random = test_random(4);
    test_run_init(&r, 2);
    make_ways(&r, 10.0f, 40.0f, 1.0f, &ways);
    for (int i = 0; i < 100; i++) {
        vec3 at = {between(&random, 10.0f, 40.0f), 0.0f, between(&random, -5.0f, 5.0f)};
        assert_true(onward_ways_find(&ways, at, UP, &guide));
        assert_int_equal(guide.cone_count, 0);
        assert_true(onward_guide_gain(&guide) == 1.0f);
    }
    assert_false(onward_ways_find(&ways, (vec3){20.0f, 0.0f, 0.0f}, vec3_negate(UP), &guide));
    onward_ways_reset(&ways);
    test_run_reset(&r);
}

/* The mean over drawn directions of another density over this one is what of the other lies where this one draws: here
 * of the even density over the half sphere about the window, in bands around its direction. */
static void expect_density(const onward_guide *guide, vec3 axis)
{
    enum { BANDS = 12 };
    double sums[BANDS] = {0.0}, squares[BANDS] = {0.0};
    const double widest = guide->cone_count > 0 ? (double)guide->one_minus_cos[guide->cone_count - 1] : 1.0;
    rng random = test_random(5);
    for (int i = 0; i < DIRECTIONS; i++) {
        vec3 d = onward_guide_sample(guide, rng_vec2(&random));
        double density = (double)onward_guide_density(guide, d), off = 1.0 - (double)vec3_dot(d, axis);
        assert_true(density > 0.0);
        assert_close(vec3_length(d), 1.0, 1e-6);
        int band = (int)floor(log2(fmax(off, 1e-9) / widest)) + BANDS;
        band = band < 0 ? 0 : band;
        if (band < BANDS) {
            double part = 1.0 / (2.0 * 3.14159265358979 * density);
            sums[band] += part;
            squares[band] += part * part;
        }
    }
    for (int band = BANDS - 6; band < BANDS; band++) {
        double high = ldexp(widest, band + 1 - BANDS), expected = 0.5 * high;
        double mean = sums[band] / DIRECTIONS;
        double error = sqrt((squares[band] / DIRECTIONS - mean * mean) / DIRECTIONS);
        assert_true(error < 0.02 * expected);
        assert_close(mean, expected, 4.0 * error + 1e-4 * expected);
    }
}

static void densities_are_those_of_what_is_drawn(void **state)
{
    (void)state;
    test_run r;
    onward_ways ways;
    onward_guide guide;
    test_run_init(&r, 2);
    make_ways(&r, 10.0f, 40.0f, 0.0f, &ways);
    assert_true(onward_ways_find(&ways, (vec3){30.0f, 0.0f, 2.0f}, UP, &guide));
    assert_true(guide.cone_count >= 3);
    assert_true(onward_guide_gain(&guide) > 1000.0f);
    expect_density(&guide, guide.towards.z);
    onward_ways_reset(&ways);
    make_ways(&r, 0.5f, 2.0f, 0.0f, &ways);
    assert_true(onward_ways_find(&ways, (vec3){1.0f, 0.0f, 0.1f}, UP, &guide));
    assert_int_equal(guide.cone_count, 0);
    expect_density(&guide, UP);
    onward_ways_reset(&ways);
    test_run_reset(&r);
}

/* Parallel lines meet nowhere, and lines that are all in one point leave no width. */
static void odd_importons_do_no_harm(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    for (int is_one_point = 0; is_one_point < 2; is_one_point++) {
        photon *importons = photon_records_create(IMPORTONS);
        rng random = test_random(6);
        onward_ways ways;
        onward_guide guide;
        assert_non_null(importons);
        for (int i = 0; i < IMPORTONS; i++) {
            float x = is_one_point ? 0.0f : between(&random, -1.0f, 1.0f);
            importons[i] = (photon){.position = {x, 0.0f, 0.5f * x},
                                    .flux = flux_encode(rgb_gray(1.0f), 0),
                                    .direction = arrival_encode((vec3){0.6f, -0.8f, 0.0f}, true),
                                    .normal = direction_encode(UP)};
        }
        assert_int_equal(onward_ways_create(&r.run, importons, IMPORTONS, &ways), AG_OK);
        if (onward_ways_find(&ways, (vec3){0.1f, 0.0f, 0.05f}, UP, &guide)) {
            vec3 d = onward_guide_sample(&guide, (vec2){0.3f, 0.7f});
            assert_close(vec3_length(d), 1.0, 1e-6);
            assert_true(onward_guide_density(&guide, d) > 0.0f);
        }
        onward_ways_reset(&ways);
    }
    onward_ways none;
    onward_guide guide;
    assert_int_equal(onward_ways_create(&r.run, photon_records_create(0), 0, &none), AG_OK);
    assert_false(onward_ways_find(&none, UP, UP, &guide));
    onward_ways_reset(&none);
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(windows_are_found),
        cmocka_unit_test(no_window_is_found_where_there_is_none),
        cmocka_unit_test(densities_are_those_of_what_is_drawn),
        cmocka_unit_test(odd_importons_do_no_harm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
