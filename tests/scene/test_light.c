/* test_light.c: lights that are points, with pictures and without, and the sun: closed forms of what arrives where, and
 * what leaves. See test_light_table.c too. Threads: one. */
#include "fixtures/light_fixture.h"

enum { SAMPLES = 60000 / FEWER };

static const char *const SPOT =
    "LightSource \"spot\" \"rgb I\" [3 2 1] \"point3 from\" [1 2 3] \"point3 to\" [1 2 13]\n"
    "\"float coneangle\" [50] \"float conedeltaangle\" [20]\nShape \"sphere\" \"float radius\" [9]";

static void lamps_without_extent(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    light_sample at;
    scene *s = test_scene_create(&r, "LightSource \"point\" \"rgb I\" [8 4 2] \"point3 from\" [0 0 2]");
    assert_true(light_sample_from_point(s, &s->lights[0], (vec3){0.0f, 0.0f, 0.0f}, (vec2){0.5f, 0.5f}, &at));
    assert_true(at.is_delta && at.pdf_solid_angle == 1.0f && at.distance == 2.0f);
    assert_relative(at.radiance.r, 2.0, 1e-6);
    surface_hit hit = {.position = {0.0f, 0.0f, 2.0f}, .geometric_normal = {0.0f, 0.0f, 1.0f}};
    assert_true(light_pdf_from_point(s, &s->lights[0], (vec3){0, 0, 0}, &hit) == 0.0f);
    assert_false(light_sample_from_point(s, &s->lights[0], (vec3){0.0f, 0.0f, 2.0f}, (vec2){0.5f, 0.5f}, &at));
    scene_destroy(s);

    s = test_scene_create(&r,
                          "LightSource \"distant\" \"rgb L\" [8 4 2] \"point3 from\" [0 0 0] \"point3 to\" [0 3 0]");
    assert_true(light_sample_from_point(s, &s->lights[0], (vec3){5.0f, 6.0f, 7.0f}, (vec2){0.5f, 0.5f}, &at));
    assert_true(at.is_delta && isinf(at.distance) && at.direction.y == -1.0f);
    assert_true(at.radiance.r == 8.0f);
    scene_destroy(s);

    /* along the axis, half-way down the ramp of the cosine, outside */
    s = test_scene_create(&r, SPOT);
    double inner = cos(30.0 * PI / 180.0), outer = cos(50.0 * PI / 180.0);
    for (double c = 0.5; c <= 1.0; c += 0.01) {
        vec3 point = {1.0f + 2.0f * (float)sqrt(1.0 - c * c), 2.0f, 3.0f + 2.0f * (float)c};
        bool is_lit = light_sample_from_point(s, &s->lights[0], point, (vec2){0.5f, 0.5f}, &at);
        double x = fmin(fmax((c - outer) / (inner - outer), 0.0), 1.0);
        assert_true(is_lit == (x > 0.0));
        if (is_lit)
            assert_close(at.radiance.g, 2.0 / 4.0 * x * x * (3.0 - 2.0 * x), 1e-4);
        light dimming = s->lights[0];
        dimming.as.spot.dims_by_cosine = true;
        if (light_sample_from_point(s, &dimming, point, (vec2){0.5f, 0.5f}, &at))
            assert_close(at.radiance.g, 2.0 / 4.0 * c * x * x * (3.0 - 2.0 * x), 1e-4);
    }
    scene_destroy(s);
    test_run_reset(&r);
}

/* Cones whose cosines single precision rounds to 1. The ramp from the axis to the edge: of light that leaves,
 * (1 - cos) has the mean 3/10 of the cone's, by the integral of h s(1 - h) over that of s. */
static void narrow_spots_keep_their_power(void **state)
{
    (void)state;
    static const double ANGLES[] = {20.0, 1.0, 0.1, 0.02, 0.01, 0.001};
    test_run r;
    test_run_init(&r, 1);
    for (size_t k = 0; k < sizeof ANGLES / sizeof *ANGLES; k++)
        for (int has_ramp = 0; has_ramp < 2; has_ramp++) {
            char text[512];
            snprintf(text, sizeof text,
                     "LightSource \"spot\" \"float coneangle\" %g \"float conedeltaangle\" %g \"float power\" 7",
                     ANGLES[k], has_ramp ? ANGLES[k] : 0.0);
            scene *s = test_scene_create(&r, text);
            const light *l = &s->lights[0];
            double sine = sin(ANGLES[k] * PI / 360.0), height = 2.0 * sine * sine;
            assert_relative(l->power.g, 7.0, 1e-5);
            assert_relative(l->as.spot.intensity.g, 7.0 / (2.0 * PI * height * (has_ramp ? 0.5 : 1.0)), 1e-5);
            rng random = test_random(3);
            double mean_height = 0.0;
            for (int i = 0; i < SAMPLES; i++) {
                light_emission e;
                assert_true(light_sample_emission(s, l, NULL, &random, &e));
                assert_true(e.flux.g == l->power.g);
                double x = e.direction.x, y = e.direction.y, sine2 = x * x + y * y;
                mean_height += sine2 / (1.0 + sqrt(1.0 - sine2)) / SAMPLES;
            }
            assert_relative(mean_height, height * (has_ramp ? 0.3 : 0.5), 5.0 * 0.8 / sqrt(SAMPLES) + 1e-3);
            /* half-way out on the ramp of the cosine it is half as bright */
            for (int i = 0; i < 4; i++) {
                static const double WHERE[] = {0.0, 0.499, 0.9, 1.1};
                double h = WHERE[i] * height, across = sqrt(h * (2.0 - h)), x = 1.0 - WHERE[i];
                vec3 point = {(float)(3.0 * across), 0.0f, (float)(3.0 * (1.0 - h))};
                light_sample at;
                bool is_lit = light_sample_from_point(s, l, point, (vec2){0.5f, 0.5f}, &at);
                assert_int_equal(is_lit, WHERE[i] < 1.0);
                if (is_lit)
                    assert_relative(at.radiance.g,
                                    (double)l->as.spot.intensity.g / 9.0 * (has_ramp ? x * x * (3.0 - 2.0 * x) : 1.0),
                                    2e-2);
            }
            scene_destroy(s);
        }
    test_run_reset(&r);
}

/* --- with pictures --- */

static rgb *constant_pixels(uint32_t count)
{
    rgb *pixels = malloc(count * sizeof *pixels);
    assert_non_null(pixels);
    for (uint32_t i = 0; i < count; i++)
        pixels[i] = rgb_gray(1.0f);
    return pixels;
}

/* A goniometric light whose picture is constant shines as a point light does. */
static void a_constant_goniometric_light_is_a_point(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    light l = goniometric(ENVIRONMENT_OCTAHEDRAL, 3, 3, constant_pixels(9));
    scene *s = scene_with_light(&r, "", &l);
    assert_int_equal(scene_commit(s, &r.run, NULL), AG_OK);
    assert_relative(s->lights[0].power.r, 3.0 * 4.0 * PI, 1e-5);
    rng random = test_random(5);
    for (int i = 0; i < 1000; i++) {
        light_sample at;
        vec3 point = vec3_add_scaled(l.as.point.position, random_direction(&random), 2.0f);
        assert_true(light_sample_from_point(s, &s->lights[0], point, (vec2){0.5f, 0.5f}, &at));
        assert_relative(at.radiance.g, 2.0 / 4.0, 1e-5);
    }
    scene_destroy(s);
    test_run_reset(&r);
}

/* A constant picture: the solid angle of a rectangle is 4 asin(a b / sqrt((1 + a^2)(1 + b^2))); on a screen that faces
 * it irradiance is I cos^3 / distance^2. */
static void a_constant_projection(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    light l = projector(4, 2, constant_pixels(8), 90.0f);
    l.as.projection.world_from_light = frame_identity();
    scene *s = scene_with_light(&r, "", &l);
    assert_int_equal(scene_commit(s, &r.run, NULL), AG_OK);
    double a = 2.0, b = 1.0;
    assert_relative(s->lights[0].power.r, 3.0 * 4.0 * asin(a * b / sqrt((1 + a * a) * (1 + b * b))), 1e-4);
    for (int i = 0; i < 200; i++) {
        double x = -3.0 + 0.03 * i, y = 0.7;
        vec3 point = vec3_add(l.as.point.position, vec3_make((float)(2.0 * x), (float)(2.0 * y), 2.0f));
        light_sample at;
        bool is_lit = light_sample_from_point(s, &s->lights[0], point, (vec2){0.5f, 0.5f}, &at);
        if (fabs(fabs(x) - a) < 1e-3)
            continue;
        assert_int_equal(is_lit, fabs(x) < a);
        double square = 1.0 + x * x + y * y;
        if (is_lit)
            assert_relative(-(double)at.radiance.r * (double)at.direction.z, 3.0 / (4.0 * square * sqrt(square)), 1e-5);
    }
    scene_destroy(s);
    test_run_reset(&r);
}

/* The top row of the picture goes up, its left column left, as seen along the light's way with x to the right. */
static void a_projection_is_upright(void **state)
{
    (void)state;
    rgb *pixels = noise_pixels(2, 2, 1);
    for (int i = 0; i < 4; i++)
        pixels[i] = rgb_gray((float)(i + 1));
    projection *p;
    assert_int_equal(projection_create(2, 2, pixels, 90.0f, &p), AG_OK);
    assert_true(projection_value(p, vec3_normalize(vec3_make(-0.5f, 0.5f, 1.0f))).r == 1.0f);
    assert_true(projection_value(p, vec3_normalize(vec3_make(0.5f, 0.5f, 1.0f))).r == 2.0f);
    assert_true(projection_value(p, vec3_normalize(vec3_make(-0.5f, -0.5f, 1.0f))).r == 3.0f);
    assert_true(projection_value(p, vec3_normalize(vec3_make(0.5f, -0.5f, 1.0f))).r == 4.0f);
    assert_true(projection_value(p, vec3_normalize(vec3_make(1.1f, 0.5f, 1.0f))).r == 0.0f);
    assert_true(projection_value(p, vec3_make(0.0f, 0.0f, -1.0f)).r == 0.0f);
    assert_relative(projection_corner_cosine(p), 1.0 / sqrt(3.0), 1e-6);
    projection_destroy(p);
}

/* The numbers of a direction give that direction again, but where the picture is black, or ends. */
static void numbers_of_a_projection_are_known(void **state)
{
    (void)state;
    rgb *pixels = noise_pixels(5, 3, 1);
    pixels[7] = rgb_gray(0.0f);
    projection *p;
    assert_int_equal(projection_create(5, 3, pixels, 70.0f, &p), AG_OK);
    rng random = test_random(21);
    uint32_t known = 0;
    for (int i = 0; i < 1000; i++) {
        vec3 direction = sample_uniform_cone(rng_vec2(&random), 0.6f), again;
        vec2 u;
        rgb value;
        float pdf;
        const bool is_lit = !rgb_is_black(projection_value(p, direction));
        assert_int_equal(projection_sample_numbers(p, direction, &u), is_lit);
        if (!is_lit)
            continue;
        assert_true(projection_sample(p, u, &again, &value, &pdf));
        assert_true(vec3_distance_squared(direction, again) < 1e-10f);
        known++;
    }
    assert_in_range(known, 200, 900);
    vec2 u;
    assert_false(projection_sample_numbers(p, vec3_make(0.0f, 0.0f, -1.0f), &u));
    projection_destroy(p);
}

static void black_pictures_send_nothing(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    for (int k = 0; k < 2; k++) {
        rgb *pixels = calloc(4, sizeof *pixels);
        light l = k ? projector(2, 2, pixels, 50.0f) : goniometric(ENVIRONMENT_OCTAHEDRAL, 2, 2, pixels);
        scene *s = scene_with_light(&r, "", &l);
        assert_int_equal(scene_commit(s, &r.run, NULL), AG_OK);
        rng random = test_random(8);
        light_sample at;
        light_emission e;
        assert_false(light_sample_from_point(s, &s->lights[0], vec3_make(0.0f, 0.0f, 9.0f), (vec2){0.5f, 0.5f}, &at));
        assert_false(light_sample_emission(s, &s->lights[0], NULL, &random, &e));
        assert_true(rgb_is_black(s->light_power));
        scene_destroy(s);
    }
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lamps_without_extent),
        cmocka_unit_test(narrow_spots_keep_their_power),
        cmocka_unit_test(a_constant_goniometric_light_is_a_point),
        cmocka_unit_test(a_constant_projection),
        cmocka_unit_test(a_projection_is_upright),
        cmocka_unit_test(numbers_of_a_projection_are_known),
        cmocka_unit_test(black_pictures_send_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
