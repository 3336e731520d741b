/* test_light_pick.c: which light is sampled: probabilities are those said and sum to 1, lights that shine at a point
 * are never left out, and many lamps' light is found with little noise. Threads: one. */
/* ctest: serial */
#include "fixtures/test_scene.h"

#include "light/light_tree.h"

static const vec3 ALL_SIDES = {0.0f, 0.0f, 0.0f};

/* --- for photons --- */

/* Three quarters by power, one quarter for all alike; no lamp without power is picked. */
static void photons_go_by_power_and_none_is_forgotten(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    scene *s =
        test_scene_create(&r, "LightSource \"point\" \"rgb I\" [1 0 0]\nLightSource \"point\" \"rgb I\" [0 0 0]\n"
                              "LightSource \"point\" \"rgb I\" [0 0 3]\nLightSource \"point\" \"rgb I\" [0 0 0]");
    uint32_t counts[4] = {0};
    for (int i = 0; i < 10000; i++) {
        float probability;
        uint32_t index = scene_pick_light_by_power(s, ((float)i + 0.5f) / 10000.0f, &probability);
        assert_true(index < 4);
        assert_relative(probability, index == 0 ? 0.3125 : 0.6875, 1e-6);
        counts[index]++;
    }
    assert_int_equal(counts[1] + counts[3], 0);
    assert_close(counts[0], 3125, 1);
    float probability;
    assert_int_equal(scene_pick_light_by_power(s, 0x1.fffffep-1f, &probability), 2);
    assert_int_equal(scene_pick_light_by_power(s, 0.0f, &probability), 0);
    scene_destroy(s);
    test_run_reset(&r);
}

static void photons_multiplies_a_share(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, "LightSource \"point\" \"float photons\" 3\nLightSource \"point\"\n"
                                     "AttributeBegin AreaLightSource \"diffuse\" \"float photons\" 0 Shape \"sphere\" "
                                     "AttributeEnd");
    assert_true(scene_sends_photons(s));
    assert_relative(s->photon_probability[0], 0.75, 1e-6);
    assert_relative(s->photon_probability[1], 0.25, 1e-6);
    assert_true(s->photon_probability[2] == 0.0f);
    float probability; /* it shines as ever */
    vec3 near_sphere = {0.0f, 0.0f, 1.1f};
    assert_true(scene_light_probability(s, 2, near_sphere, ALL_SIDES) > 0.1f);
    for (int i = 0; i < 1000; i++) {
        uint32_t index = scene_pick_light_by_power(s, (float)i / 1000.0f, &probability);
        assert_true(index < 2 && probability == s->photon_probability[index]);
    }
    scene_destroy(s);
    s = test_scene_create(&r, "LightSource \"point\" \"float photons\" 0");
    assert_false(scene_sends_photons(s));
    scene_destroy(s);
    test_run_reset(&r);
}

/* --- for a point --- */

enum { TEXT_SIZE = 1 << 18 };

/* All kinds of lamps, here and there, many of them where count is large. */
static void write_lamps(char *text, int count, uint64_t seed)
{
    rng random = test_random(seed);
    size_t at = 0;
    for (int i = 0; i < count; i++) {
        vec3 p = random_in_box(&random, (vec3){-10.0f, -10.0f, -3.0f}, (vec3){10.0f, 10.0f, 3.0f});
        vec3 d = random_direction(&random);
        double power = 0.1 + 5.0 * pow((double)rng_float(&random), 4.0);
        at += (size_t)snprintf(text + at, TEXT_SIZE - at, "AttributeBegin Translate %g %g %g Rotate %g %g %g %g\n",
                               (double)p.x, (double)p.y, (double)p.z, 360.0 * (double)rng_float(&random), (double)d.x,
                               (double)d.y, (double)d.z);
        static const char *const KINDS[] = {
            "LightSource \"point\" \"float scale\" %g",
            "LightSource \"spot\" \"float coneangle\" 40 \"float scale\" %g",
            "AreaLightSource \"diffuse\" \"float scale\" %g Shape \"sphere\" \"float radius\" 0.4",
            "AreaLightSource \"diffuse\" \"float scale\" %g Shape \"disk\" \"float radius\" 0.7",
            ("AreaLightSource \"diffuse\" \"bool twosided\" true \"float scale\" %g Shape \"bilinearmesh\" \"point3 "
             "P\" "
             "[-1 -1 0 1 -1 0 -1 1 0 1 1 0.2]"),
            "LightSource \"spot\" \"float coneangle\" 5 \"float scale\" %g",
        };
        at += (size_t)snprintf(text + at, TEXT_SIZE - at, KINDS[i % 6], power);
        at += (size_t)snprintf(text + at, TEXT_SIZE - at, "\nAttributeEnd\n");
        assert_true(at < TEXT_SIZE);
    }
}

static char text[TEXT_SIZE];

static const char *const SKY =
    "LightSource \"distant\" \"point3 from\" [0 0 1] \"point3 to\" [0 0 0] \"float scale\" 50\n"
    "LightSource \"infinite\" \"rgb L\" [0.1 0.2 0.4]\n"
    "LightSource \"distant\" \"rgb L\" [0 0 0]\n";

/* Irradiance that a light may bring to a point facing along normal (from all sides: to its whole surface), unshadowed,
 * by one sample of it. */
static double brought(const scene *s, uint32_t index, vec3 point, vec3 normal, vec2 u)
{
    light_sample at;
    if (!light_sample_from_point(s, &s->lights[index], point, u, &at))
        return 0.0;
    bool has_normal = vec3_length_squared(normal) > 0.0f;
    return (has_normal ? fmax(0.0, (double)vec3_dot(normal, at.direction)) : 1.0) * (double)at.radiance.g /
           (double)at.pdf_solid_angle;
}

static void check_probabilities(const char *world, int point_count)
{
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, world);
    rng random = test_random(11);
    double *shares = malloc(s->light_count * sizeof *shares);
    uint32_t *counts = malloc(s->light_count * sizeof *counts);
    assert_non_null(shares);
    assert_non_null(counts);
    for (int k = 0; k < point_count; k++) {
        vec3 point = random_in_box(&random, (vec3){-12.0f, -12.0f, -4.0f}, (vec3){12.0f, 12.0f, 4.0f});
        vec3 normal = k % 3 == 0 ? ALL_SIDES : random_direction(&random);
        double sum = 0.0;
        for (uint32_t i = 0; i < s->light_count; i++) {
            shares[i] = scene_light_probability(s, i, point, normal);
            assert_true(shares[i] >= 0.0);
            sum += shares[i];
            counts[i] = 0;
            if (shares[i] > 0.0)
                continue;
            for (int n = 0; n < 4; n++) /* what is never picked brings nothing */
                assert_true(brought(s, i, point, normal, rng_vec2(&random)) == 0.0);
        }
        /* less only by what is lost where bounds are too wide */
        assert_true(sum <= 1.0 + 1e-5);
        enum { PICKS = 4096 };
        uint32_t lost = 0;
        for (int i = 0; i < PICKS; i++) {
            float probability;
            uint32_t index = scene_pick_light(s, point, normal, ((float)i + 0.5f) / PICKS, &probability);
            if (!(probability > 0.0f)) {
                lost++;
                continue;
            }
            assert_relative(probability, shares[index], 1e-5);
            counts[index]++;
        }
        assert_close((double)lost / PICKS, 1.0 - sum, 0.01);
        for (uint32_t i = 0; i < s->light_count; i++) /* even steps of u: each share is a few stretches of it */
            assert_close((double)counts[i] / PICKS, shares[i], 4.0 / PICKS);
    }
    free(shares);
    free(counts);
    scene_destroy(s);
    test_run_reset(&r);
}

static void probabilities_are_those_said(void **state)
{
    (void)state;
    static const int COUNTS[] = {1, 2, 5, 8, 9, 30, 400};
    for (size_t i = 0; i < sizeof COUNTS / sizeof *COUNTS; i++) {
        write_lamps(text, COUNTS[i], 20 + i);
        check_probabilities(text, 60 / (COUNTS[i] > 100 ? FEWER : 1));
        strcat(text, SKY);
        check_probabilities(text, 30 / (COUNTS[i] > 100 ? FEWER : 1));
    }
    check_probabilities(SKY, 50);
}

/* The sum over all lamps is what one picked lamp brings, on average; and it varies far less than by power. */
static void many_lamps_are_found(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    write_lamps(text, 300, 3);
    scene *s = test_scene_create(&r, text);
    rng random = test_random(12);
    double log_ratio = 0.0, *brings = malloc(s->light_count * sizeof *brings);
    assert_non_null(brings);
    enum { POINTS = 40, SAMPLES = 64, PICKS = 40000 / FEWER };
    for (int k = 0; k < POINTS; k++) {
        vec3 point = random_in_box(&random, (vec3){-10.0f, -10.0f, -3.0f}, (vec3){10.0f, 10.0f, 3.0f});
        vec3 normal = k % 2 ? random_direction(&random) : ALL_SIDES;
        double all = 0.0, squares[2] = {0.0, 0.0};
        for (uint32_t i = 0; i < s->light_count; i++) {
            double share = scene_light_probability(s, i, point, normal);
            brings[i] = 0.0;
            for (int n = 0; n < SAMPLES; n++)
                brings[i] += brought(s, i, point, normal, rng_vec2(&random)) / SAMPLES;
            all += brings[i];
            squares[0] += share > 0.0 ? brings[i] * brings[i] / share : 0.0;
            squares[1] += brings[i] * brings[i] / (double)s->photon_probability[i];
        }
        assert_true(all > 0.0);
        double mean = 0.0, variance = squares[0] - all * all;
        for (int i = 0; i < PICKS; i++) {
            float probability;
            uint32_t index = scene_pick_light(s, point, normal, rng_float(&random), &probability);
            mean += probability > 0.0f ? brings[index] / (double)probability / PICKS : 0.0;
        }
        assert_close(mean, all, 5.0 * sqrt(variance / PICKS));
        log_ratio += 0.5 * log((squares[1] - all * all) / variance) / POINTS;
    }
    free(brings);
    print_message("300 lamps: %.1f times less noise of the pick than by power\n", exp(log_ratio));
    assert_true(exp(log_ratio) > 2.0);
    scene_destroy(s);
    test_run_reset(&r);
}

/* A lamp beside a point, one far off, a sun: the sun has its share, the near lamp nearly all of the rest. */
static void the_near_lamp_and_the_sun(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, "LightSource \"point\" \"point3 from\" [0 0 1]\n"
                                     "LightSource \"point\" \"point3 from\" [100 0 1] \"float scale\" 10\n"
                                     "LightSource \"distant\" \"point3 from\" [0 0 1] \"point3 to\" [0 0 0]\n"
                                     "Shape \"disk\" \"float radius\" 200");
    vec3 point = {0.0f, 0.0f, 0.0f}, up = {0.0f, 0.0f, 1.0f}, down = {0.0f, 0.0f, -1.0f};
    assert_relative(scene_light_probability(s, 2, point, up), 0.5, 1e-6);
    assert_close(scene_light_probability(s, 0, point, up), 0.5, 0.001);
    assert_true(scene_light_probability(s, 1, point, up) > 0.0f);
    for (uint32_t i = 0; i < 3; i++)
        assert_true(scene_light_probability(s, i, point, down) == 0.0f);
    float probability;
    scene_pick_light(s, point, down, 0.3f, &probability);
    assert_true(probability == 0.0f);
    scene_destroy(s);
    test_run_reset(&r);
}

/* A light that is alone is always picked, wherever it shines. */
static void one_light_is_certain(void **state)
{
    (void)state;
    static const char *const WORLDS[] = {"LightSource \"point\" LightSource \"point\" \"rgb I\" [0 0 0]",
                                         "LightSource \"distant\"", "LightSource \"infinite\"",
                                         "AreaLightSource \"diffuse\" Shape \"disk\""};
    for (size_t i = 0; i < sizeof WORLDS / sizeof *WORLDS; i++) {
        test_run r;
        test_run_init(&r, 1);
        scene *s = test_scene_create(&r, WORLDS[i]);
        float probability;
        vec3 point = {0.0f, 0.0f, -5.0f}, away = {0.0f, 0.0f, -1.0f};
        assert_int_equal(scene_pick_light(s, point, away, 0.7f, &probability), 0);
        assert_true(probability == 1.0f);
        assert_true(scene_light_probability(s, 0, point, away) == 1.0f);
        scene_destroy(s);
        test_run_reset(&r);
    }
}

/* Points where bounds are at their worst: in lamps, on them, beside their planes, at the point of a spot, far away. */
static void odd_points(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    write_lamps(text, 12, 5);
    scene *s = test_scene_create(&r, text);
    rng random = test_random(13);
    for (uint32_t i = 0; i < s->light_count; i++)
        for (int k = 0; k < 200; k++) {
            const light *l = &s->lights[i];
            light_bounds b;
            assert_true(light_find_bounds(s, l, &b));
            float reach = k % 4 == 0 ? 1e-6f : k % 4 == 1 ? 0.3f : k % 4 == 2 ? 3.0f : 1e6f;
            vec3 point = k % 20 == 0 ? b.center : vec3_add_scaled(b.center, random_direction(&random), reach);
            vec3 normal = k % 2 ? random_direction(&random) : ALL_SIDES;
            double sum = 0.0;
            for (uint32_t n = 0; n < s->light_count; n++) {
                double share = scene_light_probability(s, n, point, normal);
                assert_true(share >= 0.0 && share <= 1.0);
                assert_true(share > 0.0 || brought(s, n, point, normal, rng_vec2(&random)) == 0.0);
                sum += share;
            }
            assert_true(sum <= 1.0 + 1e-5);
        }
    scene_destroy(s);
    test_run_reset(&r);
}

/* Lamps are picked alike in a scene a million units off, and in one of a billionth of the size. */
static void scales_do_not_matter(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    static const double SCALES[] = {1e-12, 1.0, 1e12};
    double expected = 0.0;
    for (int k = 0; k < 3; k++) {
        snprintf(text, TEXT_SIZE,
                 "Scale %g %g %g LightSource \"point\" LightSource \"point\" \"point3 from\" [3 0 0]\n"
                 "AreaLightSource \"diffuse\" \"float power\" 5 Shape \"sphere\" \"float radius\" 0.3",
                 SCALES[k], SCALES[k], SCALES[k]);
        scene *s = test_scene_create(&r, text);
        vec3 point = {(float)SCALES[k], (float)SCALES[k] * 0.2f, 0.0f};
        double share = scene_light_probability(s, 1, point, ALL_SIDES);
        if (k == 0)
            expected = share;
        assert_true(share > 0.01 && share < 0.99);
        assert_relative(share, expected, 1e-3);
        scene_destroy(s);
    }
    test_run_reset(&r);
}

/* The message tells which light it is, in the order of the file. */
static void too_much_power_is_refused(void **state)
{
    (void)state;
    static const char *const CASES[] = {"LightSource \"point\" LightSource \"point\" \"rgb I\" [1e38 1e38 1e38] "
                                        "LightSource \"point\"",
                                        "LightSource \"distant\" LightSource \"distant\" \"float scale\" 1e38 "
                                        "LightSource \"point\" Shape \"sphere\" \"float radius\" 1e9"};
    for (int i = 0; i < 2; i++) {
        test_run r;
        test_run_init(&r, 1);
        scene *s = scene_create();
        snprintf(text, TEXT_SIZE, "WorldBegin %s", CASES[i]);
        assert_int_equal(pbrt_parse_text(&r.run, "t", text, strlen(text), s), AG_OK);
        assert_int_equal(scene_commit(s, &r.run, NULL), AG_ERROR_SCENE);
        assert_non_null(strstr(r.said,
                               "the lights' power together is beyond what a float holds; the brightest is number 2 "
                               "of 3"));
        scene_destroy(s);
        test_run_reset(&r);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(photons_go_by_power_and_none_is_forgotten),
        cmocka_unit_test(photons_multiplies_a_share),
        cmocka_unit_test(probabilities_are_those_said),
        cmocka_unit_test(many_lamps_are_found),
        cmocka_unit_test(the_near_lamp_and_the_sun),
        cmocka_unit_test(one_light_is_certain),
        cmocka_unit_test(odd_points),
        cmocka_unit_test(scales_do_not_matter),
        cmocka_unit_test(too_much_power_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
