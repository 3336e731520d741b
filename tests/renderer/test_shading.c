/* test_shading.c: radiance along single camera rays in closed form: lamps and mirrors, direct light, what settings
 * leave out, and chains that roulette ends. Gathered light: test_final_gather.c. Threads: one. */
#include "fixtures/eye_fixture.h"

#include "integrator/final_gather.h"
#include "integrator/shading.h"

enum { SAMPLES = 20000 / FEWER, NEAREST = 50 };

#define FLOOR               "Material \"diffuse\" \"rgb reflectance\" [0.4 0.4 0.4] Shape \"disk\" \"float radius\" 100 "
#define MIRROR(reflectance) "Material \"conductor\" \"float roughness\" 0 \"rgb reflectance\" [" reflectance "] "

/* The radiance along a ray by one sample, no part of which may wait for the batch. */
static float radiance_along(eye *e, uint32_t i, vec3 from, vec3 direction, float most_direct)
{
    eye_sample s = {.most_direct = most_direct, .most_indirect = INFINITY};
    camera_sample c = {.ray = scene_ray_make(from, vec3_normalize(direction)),
                       .where = sampler_make(i, 3, 4, 0, 0),
                       .split = {.rays = 16, .lights = 1}};
    shading_radiance(&e->t, e->worker, &c, &s);
    assert_int_equal(e->worker->batch->gather_count, 0);
    return s.radiance.r;
}

/* A lamp is seen as bright as it is, and in a mirror by its reflectance; not where indirect light alone is wanted. */
static void lamp_in_a_mirror(void **state)
{
    (void)state;
    eye e;
    eye_init_with_photons(
        &e,
        MIRROR(
            "0.5 0.5 0.5") "Shape \"disk\" \"float radius\" 1 AttributeBegin Translate 0 0 3 "
                           "Material \"diffuse\" \"rgb reflectance\" [0 0 0] AreaLightSource \"diffuse\" \"rgb L\" [6 6 6] Shape \"sphere\" "
                           "AttributeEnd",
        1000, NEAREST);
    e.settings.max_depth = 1;
    vec3 middle = {0.0f, 0.0f, 1.0f}, up = {0.0f, 0.0f, 1.0f}, down = {0.0f, 0.0f, -1.0f};
    assert_relative((double)radiance_along(&e, 0, middle, up, INFINITY), 6.0, 1e-6);
    assert_relative((double)radiance_along(&e, 0, middle, down, INFINITY), 3.0, 1e-5);
    assert_relative((double)radiance_along(&e, 0, middle, down, 2.0f), 2.0, 1e-5);
    e.settings.max_depth = 0;
    assert_relative((double)radiance_along(&e, 0, middle, up, INFINITY), 6.0, 1e-6);
    assert_true(radiance_along(&e, 0, middle, down, INFINITY) == 0.0f);
    e.settings.max_depth = 1;
    e.settings.only = AG_ONLY_INDIRECT;
    assert_true(radiance_along(&e, 0, middle, up, INFINITY) == 0.0f);
    eye_reset(&e);
}

/* Direct light on a floor under a ball of radius r whose middle is h above: E = pi L (r / h)^2. */
static void floor_under_a_ball(void **state)
{
    (void)state;
    eye e;
    eye_init_with_photons(&e,
                          FLOOR "AttributeBegin Translate 0 0 2 AreaLightSource \"diffuse\" \"rgb L\" [10 10 10] "
                                "Shape \"sphere\" AttributeEnd",
                          1000, NEAREST);
    e.settings.max_depth = 1;
    mean_sum all = {0}, bounded = {0};
    vec3 from = {0.0f, 0.0f, 0.5f}, down = {0.0f, 0.0f, -1.0f};
    for (uint32_t i = 0; i < SAMPLES; i++) {
        mean_add(&all, (double)radiance_along(&e, i, from, down, INFINITY));
        mean_add(&bounded, (double)radiance_along(&e, i, from, down, 0.3f));
    }
    assert_mean(&all, 0.4 * 10.0 * 0.25, 1e-4);
    assert_true(bounded.sum <= 0.3 * SAMPLES * (1.0 + 1e-5) && bounded.sum > 0.25 * SAMPLES);
    e.settings.only = AG_ONLY_INDIRECT;
    assert_true(radiance_along(&e, 0, from, down, INFINITY) == 0.0f);
    eye_reset(&e);
}

/* A ray that meets two mirrors ten times before it leaves for the sky: roulette ends most of its paths, and the mean is
 * that of the whole way. */
static void chain_of_mirrors(void **state)
{
    (void)state;
    eye e;
    eye_init_with_photons(
        &e,
        "LightSource \"infinite\" \"rgb L\" [5 5 5] " MIRROR(
            "0.6 0.6 0.6") "AttributeBegin Translate 0 0 0.5 Shape \"disk\" \"float radius\" 0.2 AttributeEnd "
                           "AttributeBegin Translate 0 0 -0.5 Shape \"disk\" \"float radius\" 0.2 AttributeEnd",
        1000, NEAREST);
    mean_sum sum = {0};
    uint32_t ended = 0;
    for (uint32_t i = 0; i < SAMPLES; i++) {
        float radiance = radiance_along(&e, i, (vec3){0.0f, 0.0f, 0.0f}, (vec3){0.02f, 0.0f, 1.0f}, INFINITY);
        mean_add(&sum, (double)radiance);
        ended += radiance == 0.0f;
    }
    assert_true(ended > SAMPLES / 10 && ended < SAMPLES * 19 / 20);
    assert_mean(&sum, 5.0 * pow(0.6, 10.0), 1e-3);
    eye_reset(&e);
}

/* Two lamps that reflect nothing, and glass for what is between. */
#define ABOVE_AND_BELOW                                                                                                \
    MIRROR("0 0 0")                                                                                                    \
    "AttributeBegin Translate 0 0 3 Rotate 180 1 0 0 AreaLightSource \"diffuse\" \"rgb L\" [6 6 6] "                   \
    "Shape \"disk\" \"float radius\" 100 AttributeEnd "                                                                \
    "AttributeBegin Translate 0 0 -3 AreaLightSource \"diffuse\" \"rgb L\" [2 2 2] "                                   \
    "Shape \"disk\" \"float radius\" 100 AttributeEnd Material \"dielectric\" \"float eta\" 1.5 "

/* Returns Fresnel's reflectance of glass of index 1.5 for unpolarised light that arrives at that cosine. */
static double reflectance_of_glass(double cosine)
{
    double inside = sqrt(1.0 - (1.0 - cosine * cosine) / 2.25);
    double parallel = (1.5 * cosine - inside) / (1.5 * cosine + inside),
           perpendicular = (cosine - 1.5 * inside) / (cosine + 1.5 * inside);
    return 0.5 * (parallel * parallel + perpendicular * perpendicular);
}

/* At a smooth surface of glass a path goes both ways, so that each sample has the light of both lamps: what is
 * reflected of the one, and the radiance of the other, which lies in the glass, over the square of the index. */
static void both_ways_of_glass(void **state)
{
    (void)state;
    eye e;
    eye_init_with_photons(&e, ABOVE_AND_BELOW "Shape \"disk\" \"float radius\" 50", 1000, NEAREST);
    vec3 from = {0.0f, 0.0f, 1.0f}, slope = {1.0f, 0.0f, -1.0f};
    double reflected = reflectance_of_glass(sqrt(0.5));
    for (uint32_t i = 0; i < 100; i++)
        assert_relative((double)radiance_along(&e, i, from, slope, INFINITY),
                        reflected * 6.0 + (1.0 - reflected) * 2.0 / 2.25, 1e-4);
    eye_reset(&e);
}

/* A sheet of glass, whose inner reflections form a series: 2 F / (1 + F) is reflected in all. What chance still picks
 * is too faint to take a sample far from that. */
static void both_ways_of_a_sheet(void **state)
{
    (void)state;
    eye e;
    eye_init_with_photons(&e,
                          ABOVE_AND_BELOW "Shape \"disk\" \"float radius\" 50 AttributeBegin Rotate 180 1 0 0 "
                                          "Shape \"disk\" \"float radius\" 50 \"float height\" 0.1 AttributeEnd",
                          1000, NEAREST);
    vec3 from = {0.0f, 0.0f, 1.0f}, slope = {1.0f, 0.0f, -1.0f};
    double once = reflectance_of_glass(sqrt(0.5)), reflected = 2.0 * once / (1.0 + once);
    double expected = reflected * 6.0 + (1.0 - reflected) * 2.0;
    mean_sum sum = {0};
    for (uint32_t i = 0; i < SAMPLES; i++) {
        double radiance = (double)radiance_along(&e, i, from, slope, INFINITY);
        assert_relative(radiance, expected, 0.1);
        mean_add(&sum, radiance);
    }
    assert_mean(&sum, expected, 1e-4);
    eye_reset(&e);
}

/* Sheets of one side alone, each of which light leaves as if it came out of glass: radiance grows at each, which is no
 * reason to split the path ever more. */
static void ways_are_bounded(void **state)
{
    (void)state;
    enum { SHEETS = 20, LEAVES = 8, TRIES = 100 };
    char text[SHEETS * 100 + 400] = ABOVE_AND_BELOW "Rotate 180 1 0 0 ";
    for (int i = 0; i < SHEETS; i++)
        strcat(text, "Translate 0 0 0.01 Shape \"disk\" \"float radius\" 50 ");
    eye e;
    eye_init_with_photons(&e, text, 1000, NEAREST);
    for (uint32_t i = 0; i < TRIES; i++)
        radiance_along(&e, i, (vec3){0.0f, 0.0f, 1.0f}, (vec3){0.0f, 0.0f, -1.0f}, INFINITY);
    assert_true(e.worker->rays_path < (uint64_t)TRIES * LEAVES * (SHEETS + 2));
    eye_reset(&e);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(lamp_in_a_mirror),     cmocka_unit_test(floor_under_a_ball),
                                       cmocka_unit_test(chain_of_mirrors),     cmocka_unit_test(both_ways_of_glass),
                                       cmocka_unit_test(both_ways_of_a_sheet), cmocka_unit_test(ways_are_bounded)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
