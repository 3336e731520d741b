/* test_caustic_radius.c: how far caustic estimates reach, in an even field of light whose irradiance is known: the
 * radius of the disc on which k caustic photons are as bright as a part of it; and the flux of a spot of light, which
 * no estimate beside it adds to. Threads: one. */
#include "caustic_radius.h"
#include "fixtures/photon_field.h"

#include "irradiance_estimate.h"

enum { PHOTONS = 20000 / FEWER, NEAREST = 50, SPOT = 300, SPOT_POINTS = 60000 };
static const float SPOT_ANGLE = 0.05f, AROUND = 0.6f;

/* A spot of SPOT photons around the pole of the unit sphere, each of so many W, and each second one of `ratio` times
 * that. */
static photon_set uneven_spot_photons(float power_each, float ratio)
{
    photon_set set = {.emitted_paths = SPOT};
    set.photons = photon_records_create(SPOT);
    assert_non_null(set.photons);
    rng random = test_random(31);
    for (int i = 0; i < SPOT; i++) {
        float u = rng_float(&random), v = rng_float(&random), z = 1.0f - u * (1.0f - cosf(SPOT_ANGLE));
        float r = sqrtf(1.0f - z * z), around = 2.0f * AG_PI * v;
        vec3 p = {r * cosf(around), r * sinf(around), z};
        field_add(&set, p, vec3_negate(p),
                  flux_encode(rgb_gray((i % 2 ? ratio : 1.0f) * power_each * (float)SPOT), 32));
    }
    return set;
}

static photon_set spot_photons(float power_each) { return uneven_spot_photons(power_each, 1.0f); }

typedef struct radius_case {
    test_run run;
    photon_map global;
} radius_case;

static void begin(radius_case *c, uint32_t photons)
{
    test_run_init(&c->run, 1);
    photon_set set = field_photons(FIELD_SPHERE, photons, 33);
    c->global = field_map(&c->run, &set, NEAREST, 0.0f);
}

static void end(radius_case *c)
{
    photon_map_reset(&c->global);
    test_run_reset(&c->run);
}

static float radius_of_uneven(const radius_case *c, float power_each, float ratio)
{
    photon_set set = uneven_spot_photons(power_each, ratio);
    float radius = -1.0f;
    assert_int_equal(caustic_radius_find(&c->global, &set, &radius), AG_OK);
    photon_set_reset(&set);
    return radius;
}

static float radius_of(const radius_case *c, float power_each) { return radius_of_uneven(c, power_each, 1.0f); }

/* pi R^2 E / 2 = k photons, of the mean power of a watt's photons. The dim parts of an even field are those that chance
 * makes so: one in twenty estimates of 50 photons is below 0.77 of the mean. */
static void radius_by_power(void **state)
{
    (void)state;
    radius_case c;
    begin(&c, PHOTONS);
    double irradiance = 10.0 / (4.0 * PI), power = 1e-6, even = sqrt(2.0 * NEAREST * power / (PI * irradiance));
    double radius = (double)radius_of(&c, (float)power);
    print_message("radius %g, %g by the mean\n", radius, even);
    assert_true(radius > even && radius < even * 1.25);
    assert_float_equal(radius_of(&c, 4.0f * (float)power), (float)(2.0 * radius), (float)(0.01 * radius));
    /* of each watt a quarter comes by photons of that power, three quarters by those of three times as much */
    assert_float_equal(radius_of_uneven(&c, (float)power, 3.0f), (float)(sqrt(2.5) * radius), (float)(0.01 * radius));
    assert_true(radius_of(&c, 1e3f) == c.global.max_radius);
    end(&c);
}

static void no_photons(void **state)
{
    (void)state;
    radius_case c;
    begin(&c, PHOTONS);
    float radius = -1.0f;
    photon_set none = {.emitted_paths = 1};
    assert_int_equal(caustic_radius_find(&c.global, &none, &radius), AG_OK);
    assert_true(radius == c.global.max_radius);
    end(&c);
    begin(&c, 0);
    assert_true(radius_of(&c, 1e-6f) == 0.0f);
    end(&c);
}

/* The irradiance over all the points around a spot is its power: out to the global map's radius, estimates in the dark
 * around it add half as much again. */
static void a_spot_keeps_its_power(void **state)
{
    (void)state;
    radius_case c;
    begin(&c, PHOTONS);
    const float power_each = 1e-6f;
    photon_map_settings settings = {
        .nearest = NEAREST, .surface_area = 4.0f * AG_PI, .radius_bound = radius_of(&c, power_each)};
    photon_set set = spot_photons(power_each);
    photon_map caustic;
    assert_int_equal(photon_map_create(&c.run.run, &set, &settings, 0.0, 1.0, &caustic), AG_OK);
    photon_neighbor *scratch = malloc(photon_map_scratch_count(&caustic) * sizeof *scratch);
    assert_non_null(scratch);
    rng random = test_random(34);
    double sum = 0.0, squares = 0.0, area = 2.0 * PI * (1.0 - (double)cosf(AROUND));
    for (int i = 0; i < SPOT_POINTS; i++) {
        float z = 1.0f - rng_float(&random) * (1.0f - cosf(AROUND)), r = sqrtf(1.0f - z * z);
        float around = 2.0f * AG_PI * rng_float(&random);
        vec3 p = {r * cosf(around), r * sinf(around), z};
        double power = (double)irradiance_estimate(&caustic, p, vec3_negate(p), scratch).r * area;
        sum += power;
        squares += power * power;
    }
    double mean = sum / SPOT_POINTS, sigma = sqrt((squares / SPOT_POINTS - mean * mean) / SPOT_POINTS);
    double share = mean / (SPOT * (double)power_each), error = sigma / (SPOT * (double)power_each);
    print_message("radius %g: %.3f +- %.3f of the power\n", (double)caustic.max_radius, share, error);
    assert_true(fabs(share - 1.0) < 0.05 + 3.0 * error);
    assert_true(error < 0.1);
    free(scratch);
    photon_map_reset(&caustic);
    end(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(radius_by_power),
        cmocka_unit_test(no_photons),
        cmocka_unit_test(a_spot_keeps_its_power),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
