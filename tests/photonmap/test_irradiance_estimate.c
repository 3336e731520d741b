/* test_irradiance_estimate.c: density estimates in fields of photons whose irradiance is known. At points drawn apart
 * from the photons, k over the area out to the (k+1)-th is right on average: for uniform points the expectation of
 * k / A is their density. Threads: one. */
#include "fixtures/photon_field.h"

#include "irradiance_estimate.h"

enum { PHOTONS = 50000 / FEWER, POINTS = 1500 };

/* The mean over the surface. Photons are as many as they are, so that the mean hardly varies: what does is k at each of
 * the points, by 1 / sqrt(k), over as many as are apart: PHOTONS / k at most. */
static double mean_of(field_kind kind, uint32_t nearest, float max_radius)
{
    test_run r;
    test_run_init(&r, 1);
    photon_set set = field_photons(kind, PHOTONS, 11);
    photon_map map = field_map(&r, &set, nearest, max_radius);
    photon_neighbor *scratch = malloc(photon_map_scratch_count(&map) * sizeof *scratch);
    assert_non_null(scratch);
    rng random = test_random(12);
    double sum = 0.0;
    for (int i = 0; i < POINTS; i++) {
        field_point at = field_point_at(kind, rng_vec2(&random));
        rgb e = irradiance_estimate(&map, at.position, at.normal, scratch);
        sum += (double)e.r;
        if (i < 10)
            assert_true(rgb_is_black(irradiance_estimate(&map, at.position, vec3_negate(at.normal), scratch)));
    }
    free(scratch);
    photon_map_reset(&map);
    test_run_reset(&r);
    return sum / POINTS;
}

static void even_fields(void **state)
{
    (void)state;
    static const uint32_t NEAREST[] = {5, 50, 300};
    for (int kind = FIELD_SPHERE; kind <= FIELD_PLANE; kind++)
        for (size_t i = 0; i < sizeof NEAREST / sizeof *NEAREST; i++) {
            double expected = (double)FIELD_FLUX.r * field_irradiance((field_kind)kind), k = NEAREST[i];
            double apart = fmin(POINTS, PHOTONS / k), sigma = 1.0 / sqrt(k * apart);
            assert_relative(mean_of((field_kind)kind, NEAREST[i], FIELD_SPHERE_RADIUS), expected, 4.0 * sigma + 0.002);
        }
}

/* Fewer than k within the largest radius: their flux over the disc's area, as right on average. About 50 of 300. */
static void bounded_radius(void **state)
{
    (void)state;
    double radius = sqrt(50.0 / (PI * PHOTONS));
    double sigma = 1.0 / sqrt(50.0 * fmin(POINTS, PHOTONS / 50.0));
    assert_relative(mean_of(FIELD_PLANE, 300, (float)radius), (double)FIELD_FLUX.r, 4.0 * sigma + 0.002);
}

/* Two walls back to back, a thousandth apart: each has its own light, nothing of the other's. */
static void thin_wall(void **state)
{
    (void)state;
    enum { EACH = 20000 / FEWER };
    test_run r;
    test_run_init(&r, 1);
    photon_set set = {.emitted_paths = EACH, .photons = photon_records_create(2 * EACH)};
    assert_non_null(set.photons);
    rng random = test_random(13);
    for (uint32_t i = 0; i < EACH; i++) {
        vec2 above = rng_vec2(&random), below = rng_vec2(&random);
        field_add(&set, (vec3){above.x, above.y, 0.001f}, (vec3){0.0f, 0.0f, 1.0f},
                  flux_encode((rgb){1.0f, 0.0f, 0.0f}, 2 * i));
        field_add(&set, (vec3){below.x, below.y, 0.0f}, (vec3){0.0f, 0.0f, -1.0f},
                  flux_encode((rgb){0.0f, 1.0f, 0.0f}, 2 * i + 1));
    }
    photon_map map = field_map(&r, &set, 50, 1.0f);
    photon_neighbor *scratch = malloc(photon_map_scratch_count(&map) * sizeof *scratch);
    assert_non_null(scratch);
    for (int i = 0; i < POINTS; i++) {
        vec2 u = rng_vec2(&random);
        vec3 at = {0.2f + 0.6f * u.x, 0.2f + 0.6f * u.y, 0.0f};
        rgb below = irradiance_estimate(&map, at, (vec3){0.0f, 0.0f, -1.0f}, scratch);
        at.z = 0.001f;
        rgb above = irradiance_estimate(&map, at, (vec3){0.0f, 0.0f, 1.0f}, scratch);
        assert_true(above.r > 0.0f && above.g == 0.0f && below.g > 0.0f && below.r == 0.0f);
    }
    free(scratch);
    photon_map_reset(&map);
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(even_fields), cmocka_unit_test(bounded_radius),
                                       cmocka_unit_test(thin_wall)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
