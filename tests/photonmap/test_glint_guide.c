/* test_glint_guide.c: what guides rays of rough reflections: directions fall into the cones around those that photons
 * came from, by flux, with the density that is told; photons of surfaces that face another way, far ones, and too few
 * guide none. Threads: one. */
/* ctest: sanitize */
#include "glint_guide.h"

#include "fixtures/photon_field.h"

static const vec3 UP = {0.0f, 0.0f, 1.0f}, MIDDLE = {0.5f, 0.5f, 0.0f};
static const rgb FAINT = {1.0f, 1.0f, 1.0f}, BRIGHT = {3.0f, 3.0f, 3.0f};

/* Two places that light comes from, more than two of the widest cones apart, which is of 18 degrees. */
static const vec3 LEFT = {-0.6f, 0.0f, 0.8f}, RIGHT = {0.6f, 0.0f, 0.8f};

static void add(photon_set *set, vec3 at, vec3 normal, vec3 from, rgb flux)
{
    field_add(set, at, normal, flux_encode(flux, set->count));
    set->photons[set->count - 1].direction = arrival_encode(vec3_negate(from), false);
}

/* Half of the photons of an even square come from the left, half from the right, three times as bright. */
static void lit_from_two_sides(uint32_t count, vec3 normal, photon_map *out)
{
    test_run r;
    test_run_init(&r, 1);
    rng random = test_random(3);
    photon_set set = {.photons = photon_records_create(count), .emitted_paths = count};
    assert_non_null(set.photons);
    for (uint32_t k = 0; k < count; k++) {
        vec2 u = rng_vec2(&random);
        add(&set, (vec3){u.x, u.y, 0.0f}, normal, k % 2 ? RIGHT : LEFT, k % 2 ? BRIGHT : FAINT);
    }
    photon_map_settings settings = {.nearest = 50, .max_radius = 0.5f, .surface_area = 1.0f};
    assert_int_equal(photon_map_create(&r.run, &set, &settings, 0.0, 1.0, out), AG_OK);
    test_run_reset(&r);
}

static double angle_between(vec3 a, vec3 b) { return acos(fmin(1.0, (double)vec3_dot(a, b))) * 180.0 / PI; }

static glint_guide guide_at(const photon_map *map, vec3 normal)
{
    glint_guide g;
    assert_true(glint_guide_find(&map->tree, MIDDLE, normal, 1.0f, &g));
    return g;
}

/* The share of the flux in the guide's photons that comes from the right. */
static double share_from_right(const glint_guide *g)
{
    double share = 0.0;
    for (uint32_t i = 0; i < g->count; i++)
        if (g->to_light[i].x > 0.0f)
            share += (double)(g->end[i] - (i > 0 ? g->end[i - 1] : 0.0f));
    return share;
}

/* A third of the samples each fall into cones of 2, 6 and 18 degrees around the photons' directions, evenly, so that
 * of the solid angle of the cone of 2 degrees, s, those of 6 and 18 have about s / 9 and s / 80 each. */
static void directions_fall_into_cones(void **state)
{
    (void)state;
    enum { SAMPLES = 200000, WITHIN = 3 };
    photon_map map;
    lit_from_two_sides(4096, UP, &map);
    glint_guide g = guide_at(&map, UP);
    assert_int_equal(g.count, GLINT_PHOTONS);
    assert_true(g.end[g.count - 1] == 1.0f);

    static const double degrees[WITHIN] = {2.0, 6.0, 18.0};
    rng random = test_random(4);
    double from_right = share_from_right(&g), within[WITHIN] = {0.0}, right = 0.0;
    vec3 left_axis = {0}, right_axis = {0}; /* as photons keep them */
    for (uint32_t i = 0; i < g.count; i++)
        *(g.to_light[i].x > 0.0f ? &right_axis : &left_axis) = g.to_light[i];
    assert_true(from_right > 0.6 && from_right < 0.9);
    for (int k = 0; k < SAMPLES; k++) {
        float u_pick = rng_float(&random);
        vec3 d = glint_guide_sample(&g, u_pick, rng_vec2(&random));
        assert_close((double)vec3_length(d), 1.0, 1e-5);
        bool is_right = d.x > 0.0f;
        double away = angle_between(d, is_right ? right_axis : left_axis);
        right += is_right;
        assert_true(away < 18.01);
        for (int i = 0; i < WITHIN; i++)
            within[i] += away < degrees[i];
    }
    assert_close(right / SAMPLES, from_right, 0.01);
    for (int i = 0; i < WITHIN; i++) {
        double expected = 0.0;
        for (int cone = 0; cone < WITHIN; cone++)
            expected +=
                fmin(1.0, (1.0 - cos(degrees[i] * PI / 180.0)) / (1.0 - cos(degrees[cone] * PI / 180.0))) / WITHIN;
        assert_close(within[i] / SAMPLES, expected, 0.005);
    }
    photon_map_reset(&map);
}

/* The mean of 1 / density over samples is the solid angle that they may fall into: two cones of 18 degrees. */
static void the_density_is_that_of_the_samples(void **state)
{
    (void)state;
    enum { SAMPLES = 400000 };
    photon_map map;
    lit_from_two_sides(4096, UP, &map);
    glint_guide g = guide_at(&map, UP);
    rng random = test_random(5);
    double sum = 0.0, solid_angle = 2.0 * PI * (1.0 - cos(18.0 * PI / 180.0));
    for (int k = 0; k < SAMPLES; k++) {
        float u_pick = rng_float(&random);
        sum += 1.0 / (double)glint_guide_density(&g, glint_guide_sample(&g, u_pick, rng_vec2(&random)));
    }
    assert_close(sum / SAMPLES, 2.0 * solid_angle, 0.01 * solid_angle);
    assert_true(glint_guide_density(&g, UP) == 0.0f);
    photon_map_reset(&map);
}

static void what_faces_elsewhere_or_is_far_or_few_guides_none(void **state)
{
    (void)state;
    photon_map map, empty = {0};
    glint_guide g;
    lit_from_two_sides(4096, (vec3){0.0f, 0.0f, -1.0f}, &map);
    assert_false(glint_guide_find(&map.tree, MIDDLE, UP, 1.0f, &g));
    photon_map_reset(&map);
    lit_from_two_sides(4096, UP, &map);
    assert_false(glint_guide_find(&map.tree, (vec3){0.5f, 0.5f, 0.2f}, UP, 0.19f, &g));
    photon_map_reset(&map);
    lit_from_two_sides(7, UP, &map);
    assert_false(glint_guide_find(&map.tree, MIDDLE, UP, 1.0f, &g));
    photon_map_reset(&map);
    lit_from_two_sides(8, UP, &map);
    assert_true(glint_guide_find(&map.tree, MIDDLE, UP, 1.0f, &g) && g.count == 8);
    photon_map_reset(&map);
    assert_false(glint_guide_find(&empty.tree, MIDDLE, UP, 1.0f, &g));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(directions_fall_into_cones),
        cmocka_unit_test(the_density_is_that_of_the_samples),
        cmocka_unit_test(what_faces_elsewhere_or_is_far_or_few_guides_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
