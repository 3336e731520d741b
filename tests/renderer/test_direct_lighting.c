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

/* Returns the variance that a vertex tells of its light samples, over that of its light. */
static double times_that_is_told(eye *e, const vertex *v, sample_counts counts)
{
    double sum = 0.0, squares = 0.0, told = 0.0;
    for (uint32_t k = 0; k < SAMPLES; k++) {
        sampler where = sampler_make(k, 3, 4, 0, 0);
        direct_light direct = direct_light_gathered(&e->t, e->worker, v, &where, 0, counts, NULL);
        double value = (double)rgb_mean(direct.radiance);
        sum += value / SAMPLES;
        squares += value * value / SAMPLES;
        told += (double)direct.variance / SAMPLES;
    }
    return told / (squares - sum * sum);
}

/* A floor under a large lamp that is near: what each row of counts tells is within [least, most] times what is true. */
static void check_variance_told(const sample_counts *counts, size_t rows, double least, double most)
{
    eye e;
    eye_init(&e, FLOOR "AttributeBegin Translate 0 0 2 AreaLightSource \"diffuse\" \"rgb L\" [1 10 1]"
                       " Shape \"sphere\" \"float radius\" 1.8 AttributeEnd");
    vertex v = eye_meet(&e, (vec3){0.1f, 0.0f, 0.1f}, (vec3){0.0f, 0.0f, -1.0f});
    for (size_t i = 0; i < rows; i++) {
        double times = times_that_is_told(&e, &v, counts[i]);
        if (times < least || times > most)
            fail_msg("row %zu tells %g times the variance", i, times);
    }
    eye_reset(&e);
}

/* The variance that a vertex tells of its light samples is not less than that of its light. It may be ten times as
 * large: a lone sample by scattering stands for its own deviation, and those towards lamps are spread evenly. */
static void variance_is_told(void **state)
{
    (void)state;
    static const sample_counts COUNTS[] = {{2, 1, 0.25f}, {2, 1, 0.5f}, {4, 1, 1}, {4, 3, 1}};
    check_variance_told(COUNTS, sizeof COUNTS / sizeof *COUNTS, 1.0, 12.0);
}

/* Samples that are spread evenly over the lamp differ by much more than their mean does, and would each by itself tell
 * twenty times the variance. Their halves tell at most nine times of it, since each half is spread evenly, too. */
static void evenly_spread_samples_tell_little_variance(void **state)
{
    (void)state;
    static const sample_counts COUNTS[] = {{4, 0, 1}, {8, 0, 1}, {16, 0, 1}};
    check_variance_told(COUNTS, sizeof COUNTS / sizeof *COUNTS, 0.8, 9.0);
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

/* A sample of each light, and a ray by the cosine that is weighted against it, as a gather ray's bounce takes them.
 * Returns the radiance that they bring. */
static double each_and_bounce(eye *e, const vertex *v, rng *random)
{
    const light_counts against = {LIGHT_COUNT_EACH, 1.0f};
    rgb sum = direct_light_sample_each(&e->t, e->worker, v, BSDF_GATHERED, random, 1.0f);
    vec3 normal = vertex_light_normal(v, BSDF_GATHERED);
    bsdf_sample next;
    assert_true(bsdf_sample_direction(&v->scattering, BSDF_GATHERED, BSDF_RADIANCE, 0.0f, rng_vec2(random), &next));
    vertex met;
    rgb brought;
    if (!transport_trace(&e->t, e->worker, transport_scattered_ray(&e->t, v, next.direction, false), &met))
        brought = direct_light_escaped(&e->t, vertex_position(v), normal, next.direction, next.pdf_solid_angle, against,
                                       NULL);
    else if (rgb_is_black(brought = vertex_emission(e->t.s, &met)))
        return (double)sum.g;
    else
        brought = rgb_scale(brought, direct_light_scatter_weight(&e->t, vertex_position(v), normal, &met,
                                                                 next.pdf_solid_angle, against));
    return (double)rgb_add(sum, rgb_mul(brought, next.weight)).g;
}

/* A ball, a sky, a point and a sun together, as above, by a sample of each, alone and with a bounce. */
static void each_light(void **state)
{
    (void)state;
    eye e;
    eye_init(&e,
             FLOOR "AttributeBegin Translate 0 0 2 AreaLightSource \"diffuse\" \"rgb L\" [1 10 1]"
                   " Shape \"sphere\" \"float radius\" 1 AttributeEnd LightSource \"infinite\" \"rgb L\" [2 2 2]"
                   " LightSource \"point\" \"rgb I\" [8 8 8] \"point3 from\" [2 0 2]"
                   " LightSource \"distant\" \"rgb L\" [3 3 3] \"point3 from\" [0 1.7320508 1] \"point3 to\" [0 0 0]");
    vertex v = eye_meet(&e, (vec3){0.0f, 0.0f, 0.5f}, (vec3){0.0f, 0.0f, -1.0f});
    /* the ball hides a quarter of the sky, by the cosine; the point is 2 sqrt 2 away at 45 degrees */
    double expected = REFLECTANCE * (10.0 * 0.25 + 2.0 * 0.75) + REFLECTANCE / PI * (8.0 / 8.0 * sqrt(0.5) + 3.0 * 0.5);
    mean_sum alone = {0}, together = {0};
    for (uint32_t i = 0; i < SAMPLES; i++) {
        rng random = test_random(i);
        mean_add(&alone, (double)direct_light_sample_each(&e.t, e.worker, &v, BSDF_GATHERED, &random, 0.0f).g);
        mean_add(&together, each_and_bounce(&e, &v, &random));
    }
    assert_mean(&alone, expected, 1e-4);
    assert_mean(&together, expected, 1e-4);
    eye_reset(&e);
}

/* More skies than are sampled each: one of them is picked, with the weights that belong to that. */
static void many_skies(void **state)
{
    (void)state;
    static const char ONE[] = " LightSource \"infinite\" \"rgb L\" [1 1 1]";
    enum { SKIES = 9 };
    char world[sizeof FLOOR + SKIES * sizeof ONE] = FLOOR;
    for (int i = 0; i < SKIES; i++)
        strcat(world, ONE);
    eye e;
    eye_init(&e, world);
    vertex v = eye_meet(&e, (vec3){0.0f, 0.0f, 0.5f}, (vec3){0.0f, 0.0f, -1.0f});
    mean_sum sum = {0};
    for (uint32_t i = 0; i < SAMPLES; i++) {
        rng random = test_random(i);
        mean_add(&sum, each_and_bounce(&e, &v, &random));
    }
    assert_mean(&sum, REFLECTANCE * SKIES, 1e-4);
    assert_true(e.worker->rays_shadow <= SAMPLES);
    eye_reset(&e);
}

/* However wrong the guide is about a place, a sun brings no more than its light, and a sky's sample at most twice what
 * it brings without a guide. A guide that picks one light for a sample would bring ten times the sun. */
static void wrong_guide_makes_no_specks(void **state)
{
    (void)state;
    eye e;
    eye_init(&e, FLOOR "LightSource \"infinite\" \"rgb L\" [1 1 1]"
                       " LightSource \"distant\" \"rgb L\" [3 3 3] \"point3 from\" [0 0 1] \"point3 to\" [0 0 0]");
    vertex v = eye_meet(&e, (vec3){0.0f, 0.0f, 0.5f}, (vec3){0.0f, 0.0f, -1.0f});
    vec3 positions[DIRECT_GUIDE_CELL_POINTS], normals[DIRECT_GUIDE_CELL_POINTS];
    uint32_t order[DIRECT_GUIDE_CELL_POINTS];
    for (int i = 0; i < DIRECT_GUIDE_CELL_POINTS; i++) {
        positions[i] = (vec3){0.01f * (float)i, 0.0f, 0.0f};
        normals[i] = (vec3){0.0f, 0.0f, 1.0f};
    }
    direct_guide guide;
    assert_int_equal(direct_guide_create(e.t.s, positions, normals, DIRECT_GUIDE_CELL_POINTS, order, &guide), AG_OK);
    direct_bins seen = {.of[3][5] = 1.0f}; /* a hole */
    const float brought[3] = {1.0f, 0.0f, 0.0f};
    for (uint32_t i = 0; i < guide.cell_count; i++)
        direct_guide_fill(&guide, i, 0.8f, brought, &seen);
    e.t.direct_guide = &guide;
    assert_true(direct_guide_find(&guide, vertex_position(&v), normals[0]) != DIRECT_GUIDE_NO_CELL);
    const double of_sun = REFLECTANCE / PI * 3.0;
    mean_sum alone = {0}, together = {0};
    for (uint32_t i = 0; i < SAMPLES; i++) {
        rng random = test_random(i);
        double radiance = (double)direct_light_sample_each(&e.t, e.worker, &v, BSDF_GATHERED, &random, 0.0f).g;
        /* over a sky alike all over, its own sampling brings 4 rho L cos at most, and half of it is this */
        assert_true(radiance >= of_sun * (1.0 - 1e-5) && radiance <= of_sun + 2.0 * 4.0 * REFLECTANCE);
        mean_add(&alone, radiance);
        mean_add(&together, each_and_bounce(&e, &v, &random));
    }
    assert_mean(&alone, REFLECTANCE + of_sun, 1e-4);
    assert_mean(&together, REFLECTANCE + of_sun, 1e-4);
    direct_guide_reset(&guide);
    e.t.direct_guide = NULL;
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
    const struct CMUnitTest tests[] = {cmocka_unit_test(ball),
                                       cmocka_unit_test(variance_is_told),
                                       cmocka_unit_test(evenly_spread_samples_tell_little_variance),
                                       cmocka_unit_test(sky),
                                       cmocka_unit_test(lights_without_extent),
                                       cmocka_unit_test(nothing_from_behind),
                                       cmocka_unit_test(each_light),
                                       cmocka_unit_test(many_skies),
                                       cmocka_unit_test(wrong_guide_makes_no_specks)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
