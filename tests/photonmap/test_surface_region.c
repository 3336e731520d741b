/* test_surface_region.c: what is surface around a point: nothing to tell in the open and on a ball, half planes at
 * walls and edges, a corner's quarter, none of the next room; and estimates that are right right up to the edge.
 * Threads: one at a time. */
#include "surface_region.h"

#include "irradiance_estimate.h"

#include "fixtures/test_scene.h"

/* A floor of 2 x 2 whose edge at x = 1 is open, with walls at x = -1 and z = -1, and a partition at z = 0.5 from x = 0
 * on. */
static const char ROOM[] = "Shape \"bilinearmesh\" \"point3 P\" [-1 0 -1  1 0 -1  -1 0 1  1 0 1]\n"
                           "Shape \"bilinearmesh\" \"point3 P\" [-1 0 -1  -1 1 -1  -1 0 1  -1 1 1]\n"
                           "Shape \"bilinearmesh\" \"point3 P\" [-1 0 -1  1 0 -1  -1 1 -1  1 1 -1]\n"
                           "Shape \"bilinearmesh\" \"point3 P\" [0 0 0.5  1 0 0.5  0 1 0.5  1 1 0.5]\n"
                           "Translate 5 0 0 Shape \"sphere\" \"float radius\" 1\n";
static const vec3 UP = {0.0f, 1.0f, 0.0f};

/* Area of the disc of radius 1 on the near side of a line at that distance. */
static double cut_disc(double distance) { return PI - (acos(distance) - distance * sqrt(1.0 - distance * distance)); }

typedef struct test_point {
    vec3 at;
    double expected; /* area over radius squared; 0: nothing ends it */
} test_point;

static void areas_are_those_of_cut_discs(void **state)
{
    (void)state;
    uint64_t rays = 0, known = 0;
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, ROOM);
    const float radius = 0.2f;
    const test_point points[] = {
        {{-0.3f, 0.0f, -0.2f}, 0.0},           /* in the open */
        {{-0.9f, 0.0f, 0.0f}, cut_disc(0.5)},  /* a wall */
        {{0.94f, 0.0f, -0.4f}, cut_disc(0.3)}, /* an open edge */
        {{0.5f, 0.0f, 0.44f}, cut_disc(0.3)},  /* both sides of a wall without thickness */
        {{0.5f, 0.0f, 0.56f}, cut_disc(0.3)},  {{-0.998f, 0.0f, -0.998f}, PI / 4.0 + 0.02}, /* a corner */
    };
    rng random = test_random(3);
    for (size_t i = 0; i < sizeof points / sizeof *points; i++) {
        double sum = 0.0;
        enum { TRIALS = 200 };
        for (int k = 0; k < TRIALS; k++) {
            vec3 jitter = {(rng_float(&random) - 0.5f) * 2e-3f, 0.0f, (rng_float(&random) - 0.5f) * 2e-3f};
            surface_region region = {0};
            bool is_bounded =
                surface_region_find(s, NULL, vec3_add(points[i].at, jitter), UP, 0.5f, radius, &rays, &region);
            assert_int_equal(is_bounded, points[i].expected > 0.0);
            sum += is_bounded ? surface_region_area(&region, radius) / ((double)radius * radius) : 0.0;
            /* what need not be cast changes nothing */
            clear_space space;
            surface_region same = region;
            clear_space_find(s, points[i].at, UP, 2.0f * radius, &space);
            uint64_t fewer = 0;
            assert_int_equal(
                surface_region_find(s, &space, vec3_add(points[i].at, jitter), UP, 0.5f, radius, &fewer, &same),
                is_bounded);
            assert_true(!is_bounded || memcmp(&same, &region, sizeof same) == 0);
            known += fewer;
        }
        double mean = sum / TRIALS;
        if (points[i].expected > 0.0 && !(fabs(mean - points[i].expected) < 0.01 * points[i].expected))
            fail_msg("point %zu: area %.4f, not %.4f", i, mean, points[i].expected);
    }
    assert_true(known < rays / 2);
    scene_destroy(s);
    test_run_reset(&r);
}

/* Area is what contains() says, by counting; and next to nothing of it is off the surface or beyond a wall: between two
 * directions a straight edge may turn a corner. */
static void area_and_membership_agree(void **state)
{
    (void)state;
    uint64_t rays = 0;
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, ROOM);
    rng random = test_random(4);
    enum { DISCS = 300, POINTS = 4000 };
    const float radius = 0.3f;
    int bounded = 0, all_astray = 0, all_inside = 0;
    for (int i = 0; i < DISCS; i++) {
        vec3 at = {2.0f * rng_float(&random) - 1.0f, 0.0f, 2.0f * rng_float(&random) - 1.0f};
        surface_region region = {0};
        if (!surface_region_find(s, NULL, at, UP, 0.5f, radius, &rays, &region))
            continue;
        bounded++;
        int inside = 0, astray = 0;
        for (int k = 0; k < POINTS; k++) {
            vec2 d = sample_disk_concentric(rng_vec2(&random));
            vec3 p = {at.x + radius * d.x, 0.0f, at.z + radius * d.y};
            if (!surface_region_contains(&region, p))
                continue;
            inside++;
            bool is_off = fabsf(p.x) > 1.003f || fabsf(p.z) > 1.003f;
            bool is_across = at.x > radius && p.x > 0.0f && (at.z - 0.5f) * (p.z - 0.5f) < -1e-5f;
            astray += is_off || is_across;
        }
        double area = surface_region_area(&region, radius), counted = PI * (double)(radius * radius) * inside / POINTS;
        double deviation = PI * (double)(radius * radius) * sqrt(0.25 / POINTS);
        assert_true(fabs(area - counted) < 5.0 * deviation);
        all_astray += astray;
        all_inside += inside;
    }
    assert_true(bounded > DISCS / 4);
    print_message("%.2f %% of the regions is no surface\n", 100.0 * all_astray / all_inside);
    assert_true(all_astray < all_inside / 100);
    scene_destroy(s);
    test_run_reset(&r);
}

static void a_ball_has_no_edge(void **state)
{
    (void)state;
    uint64_t rays = 0;
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, ROOM);
    rng random = test_random(5);
    for (int i = 0; i < 200; i++) {
        vec3 n = sample_uniform_sphere(rng_vec2(&random));
        surface_region region = {0};
        assert_false(
            surface_region_find(s, NULL, vec3_add((vec3){5.0f, 0.0f, 0.0f}, n), n, 0.5f, 0.4f, &rays, &region));
    }
    /* where there is no surface there is no region */
    surface_region region = {0};
    assert_false(surface_region_find(s, NULL, (vec3){0.0f, 0.5f, 0.0f}, UP, 0.5f, 0.4f, &rays, &region));
    scene_destroy(s);
    test_run_reset(&r);
}

/* Photons even over a floor alone: estimates near one of its edges, on average, with and without knowing of it, against
 * the photons that really lie there. */
static void estimates_hold_up_to_the_edge(void **state)
{
    (void)state;
    enum { PHOTONS = 40000, QUERIES = 4000, NEAREST = 50 };
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, "Shape \"bilinearmesh\" \"point3 P\" [0 0 0  1 0 0  0 0 1  1 0 1]");
    double mean[2];
    for (int knows = 0; knows < 2; knows++) {
        photon_set set = {.count = PHOTONS, .emitted_paths = PHOTONS};
        set.photons = photon_records_create(PHOTONS);
        assert_non_null(set.photons);
        memset(set.photons, 0, PHOTONS * sizeof *set.photons);
        rng random = test_random(6);
        for (uint32_t i = 0; i < PHOTONS; i++) {
            photon *p = &set.photons[i];
            p->position[0] = rng_float(&random);
            p->position[2] = rng_float(&random);
            p->normal = direction_encode(UP);
            p->flux = flux_encode(rgb_gray(1.0f), i);
        }
        photon_map_settings settings = {.nearest = NEAREST, .surface_area = 1.0f, .surfaces = knows ? s : NULL};
        photon_map map;
        assert_int_equal(photon_map_create(&r.run, &set, &settings, 0.0, 1.0, &map), AG_OK);
        photon_neighbor *scratch = malloc(photon_map_scratch_count(&map) * sizeof *scratch);
        assert_non_null(scratch);
        double sum = 0.0, strip = 2.0 * (double)map.mean_radius, there = 0.0;
        for (uint32_t i = 0; i < PHOTONS; i++)
            there += (double)photon_block_position(map.blocks, i).x < strip;
        there /= strip * PHOTONS;
        for (int i = 0; i < QUERIES; i++) {
            vec3 at = {rng_float(&random) * (float)strip, 0.0f, rng_float(&random)};
            sum += (double)irradiance_estimate(&map, at, UP, scratch).g;
        }
        mean[knows] = sum / QUERIES / there;
        free(scratch);
        photon_map_reset(&map);
    }
    print_message("within two radii of an edge: %.3f without the region, %.3f with it\n", mean[0], mean[1]);
    assert_true(mean[0] < 0.91);
    assert_true(fabs(mean[1] - 1.0) < 0.015);
    scene_destroy(s);
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(areas_are_those_of_cut_discs),
        cmocka_unit_test(area_and_membership_agree),
        cmocka_unit_test(a_ball_has_no_edge),
        cmocka_unit_test(estimates_hold_up_to_the_edge),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
