/* test_direct_lighting.c: direct light on a floor against closed forms, by either technique and by both weighted.
 * Threads: one. */
#include "fixtures/eye_fixture.h"

#include "integrator/direct_lighting.h"

enum { SAMPLES = 40000 / FEWER };

#define FLOOR "Material \"diffuse\" \"rgb reflectance\" [0.8 0.4 0.2] Shape \"disk\" \"float radius\" 100 "

static const double REFLECTANCE = 0.4; /* of green */

/* Radiance that the floor's middle sends up. */
static mean_sum measure(eye *e, sample_counts counts)
{
    mean_sum sum = {0};
    vertex v = eye_meet(e, (vec3){0.0f, 0.0f, 0.5f}, (vec3){0.0f, 0.0f, -1.0f});
    for (uint32_t i = 0; i < SAMPLES; i++) {
        sampler where = sampler_make(i, 3, 4, 0, 0); /* a seed of its own each: independent */
        mean_add(&sum, (double)direct_light_gathered(&e->t, e->worker, &v, &where, 0, counts, NULL).radiance.g);
    }
    return sum;
}

/* A ball of radius r whose middle is h above: E = pi L (r / h)^2. */
static void ball(void **state)
{
    (void)state;
    static const sample_counts COUNTS[] = {{1, 0, 1}, {1, 1, 1}, {1, 1, 0.25f}, {2, 1, 0.5f}, {4, 1, 1}, {2, 3, 1}};
    eye e;
    eye_init(&e, FLOOR "AttributeBegin Translate 0 0 2 AreaLightSource \"diffuse\" \"rgb L\" [1 10 1]"
                       " Shape \"sphere\" \"float radius\" 1 AttributeEnd");
    for (size_t i = 0; i < sizeof COUNTS / sizeof *COUNTS; i++) {
        mean_sum sum = measure(&e, COUNTS[i]);
        assert_mean(&sum, REFLECTANCE * 10.0 * 0.25, 1e-4);
    }
    assert_true(e.worker->rays_shadow > 0);
    eye_reset(&e);
}

/* The variance that a vertex tells of its light samples is not less than that of its light. It may be ten times as
 * large: a lone sample by scattering stands for its own deviation, and those towards lamps are spread evenly. */
static void variance_is_told(void **state)
{
    (void)state;
    static const sample_counts COUNTS[] = {{2, 1, 0.25f}, {2, 1, 0.5f}, {4, 1, 1}, {4, 3, 1}};
    eye e;
    eye_init(&e, FLOOR "AttributeBegin Translate 0 0 2 AreaLightSource \"diffuse\" \"rgb L\" [1 10 1]"
                       " Shape \"sphere\" \"float radius\" 1.8 AttributeEnd");
    vertex v = eye_meet(&e, (vec3){0.1f, 0.0f, 0.1f}, (vec3){0.0f, 0.0f, -1.0f});
    for (size_t i = 0; i < sizeof COUNTS / sizeof *COUNTS; i++) {
        double sum = 0.0, squares = 0.0, told = 0.0;
        for (uint32_t k = 0; k < SAMPLES; k++) {
            sampler where = sampler_make(k, 3, 4, 0, 0);
            direct_light direct = direct_light_gathered(&e.t, e.worker, &v, &where, 0, COUNTS[i], NULL);
            double value = (double)rgb_mean(direct.radiance);
            sum += value / SAMPLES;
            squares += value * value / SAMPLES;
            told += (double)direct.variance / SAMPLES;
        }
        double times = told / (squares - sum * sum);
        if (times < 1.0 || times > 12.0)
            fail_msg("row %zu tells %g times the variance", i, times);
    }
    eye_reset(&e);
}

/* A sky that is the same all over: E = pi L. All of it is noted as the sky's. */
static void sky(void **state)
{
    (void)state;
    static const sample_counts COUNTS[] = {{1, 0, 1}, {1, 1, 1}, {1, 1, 0.25f}, {4, 1, 1}};
    eye e;
    eye_init(&e, FLOOR "LightSource \"infinite\" \"rgb L\" [1 10 1]");
    for (size_t i = 0; i < sizeof COUNTS / sizeof *COUNTS; i++) {
        mean_sum sum = measure(&e, COUNTS[i]);
        assert_mean(&sum, REFLECTANCE * 10.0, 1e-4);
        vertex v = eye_meet(&e, (vec3){0.0f, 0.0f, 0.5f}, (vec3){0.0f, 0.0f, -1.0f});
        sampler where = sampler_make(1, 3, 4, 0, 0);
        direct_light all = direct_light_gathered(&e.t, e.worker, &v, &where, 0, COUNTS[i], NULL);
        assert_relative((double)all.from_sky.g, (double)all.radiance.g, 1e-5);
    }
    eye_reset(&e);
}

/* A point and a sun above: I / h^2 and E cos, each reflected by rho / pi, without noise but for which is picked. */
static void lights_without_extent(void **state)
{
    (void)state;
    eye e;
    eye_init(&e,
             FLOOR "LightSource \"point\" \"rgb I\" [8 8 8] \"point3 from\" [0 0 2]"
                   " LightSource \"distant\" \"rgb L\" [3 3 3] \"point3 from\" [0 1.7320508 1] \"point3 to\" [0 0 0]");
    mean_sum sum = measure(&e, (sample_counts){1, 0, 1});
    assert_mean(&sum, REFLECTANCE / PI * (8.0 / 4.0 + 3.0 * 0.5), 1e-4);
    eye_reset(&e);
}

/* The lower half of the sky is behind the floor's back: a floor that looks down sees nothing of a lamp above. */
static void nothing_from_behind(void **state)
{
    (void)state;
    eye e;
    eye_init(&e, FLOOR "LightSource \"point\" \"rgb I\" [8 8 8] \"point3 from\" [0 0 2]");
    vertex v = eye_meet(&e, (vec3){0.0f, 0.0f, -0.5f}, (vec3){0.0f, 0.0f, 1.0f});
    sampler where = sampler_make(1, 3, 4, 0, 0);
    rgb all = direct_light_gathered(&e.t, e.worker, &v, &where, 0, (sample_counts){4, 0, 1}, NULL).radiance;
    assert_true(rgb_is_black(all));
    eye_reset(&e);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(ball), cmocka_unit_test(variance_is_told),
                                       cmocka_unit_test(sky), cmocka_unit_test(lights_without_extent),
                                       cmocka_unit_test(nothing_from_behind)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
