/* test_spherical_triangle.c: solid angles of triangles are those of closed forms, and points are uniform in them.
 * Threads: one. */
#include "math/spherical_triangle.h"

#include "fixtures/test_scene.h"

enum { SAMPLES = 40000 / FEWER, PARTS = 4 };

static const vec3 ORIGIN = {0.0f, 0.0f, 0.0f};

static spherical_triangle seen(vec3 point, vec3 a, vec3 b, vec3 c)
{
    spherical_triangle t;
    spherical_triangle_see(point, a, b, c, &t);
    return t;
}

static void solid_angles_are_those_of_closed_forms(void **state)
{
    (void)state;
    vec3 x = {2.0f, 0.0f, 0.0f}, y = {0.0f, 0.5f, 0.0f}, z = {0.0f, 0.0f, 7.0f};
    assert_close(seen(ORIGIN, x, y, z).turns, 0.25, 1e-9); /* an eighth of the sphere */
    assert_close(spherical_triangle_area(&(spherical_triangle){.b = {3.0, 0.0, 0.0}, .c = {1.0, 4.0, 0.0}}), 6.0,
                 1e-12);

    /* half of a cube's face, from the cube's center */
    vec3 at = {10.0f, -20.0f, 30.0f};
    spherical_triangle half = seen(at, vec3_add(at, (vec3){-1.0f, -1.0f, 1.0f}),
                                   vec3_add(at, (vec3){1.0f, -1.0f, 1.0f}), vec3_add(at, (vec3){1.0f, 1.0f, 1.0f}));
    assert_close(half.turns, 1.0 / 6.0, 1e-9);

    /* right above the middle of a triangle that grows: half of the sphere */
    spherical_triangle wide =
        seen(ORIGIN, (vec3){-1e6f, -1e6f, 1.0f}, (vec3){1e6f, -1e6f, 1.0f}, (vec3){0.0f, 1e6f, 1.0f});
    assert_close(wide.turns, 1.0, 1e-5);

    /* small and far: area over squared distance; from the front, the back, and in its own plane */
    vec3 a = {100.0f, 0.0f, 0.0f}, b = {100.0f, 0.01f, 0.0f}, c = {100.0f, 0.0f, 0.02f};
    spherical_triangle small = seen(ORIGIN, a, b, c);
    assert_relative(small.turns * 2.0 * PI, 0.5 * 0.01 * 0.02 / 1e4, 1e-6);
    assert_true(small.is_from_back);
    assert_false(seen(ORIGIN, a, c, b).is_from_back);
    assert_close(seen((vec3){100.0f, 5.0f, 5.0f}, a, b, c).turns, 0.0, 1e-12);
}

static vec3 between(const vec3 p[3], vec2 weights)
{
    vec3 at = vec3_scale(p[0], 1.0f - weights.x - weights.y);
    return vec3_add_scaled(vec3_add_scaled(at, p[1], weights.x), p[2], weights.y);
}

/* Cuts the triangle into PARTS * PARTS of equal weights of corners: each is hit as often as its solid angle says. */
static void check_uniform(const vec3 p[3])
{
    spherical_triangle t = seen(ORIGIN, p[0], p[1], p[2]);
    double expected[PARTS * PARTS] = {0.0};
    uint32_t counts[PARTS * PARTS] = {0};
    for (int i = 0; i < PARTS; i++) {
        for (int j = 0; i + j < PARTS; j++) {
            const float step = 1.0f / PARTS, u = (float)i * step, v = (float)j * step;
            vec3 q[4] = {between(p, (vec2){u, v}), between(p, (vec2){u + step, v}), between(p, (vec2){u, v + step}),
                         between(p, (vec2){u + step, v + step})};
            expected[i * PARTS + j] = seen(ORIGIN, q[0], q[1], q[2]).turns / t.turns;
            if (i + j + 1 < PARTS) /* the square's other half, counted with it */
                expected[i * PARTS + j] += seen(ORIGIN, q[1], q[3], q[2]).turns / t.turns;
        }
    }
    rng random = test_random(3);
    for (int i = 0; i < SAMPLES; i++) {
        vec2 w = spherical_triangle_sample(&t, rng_vec2(&random));
        assert_true(w.x >= 0.0f && w.y >= 0.0f && w.x + w.y <= 1.000001f);
        int column = (int)fminf(w.x * PARTS, PARTS - 1.0f), row = (int)fminf(w.y * PARTS, PARTS - 1.0f);
        counts[column * PARTS + row]++;
    }
    for (int i = 0; i < PARTS * PARTS; i++) {
        double mean = expected[i] * SAMPLES;
        assert_close(counts[i], mean, 5.0 * sqrt(mean) + 1.0);
    }
}

static void points_are_uniform_in_solid_angle(void **state)
{
    (void)state;
    check_uniform((vec3[3]){{2.0f, 0.0f, 0.0f}, {0.0f, 0.5f, 0.0f}, {0.0f, 0.0f, 7.0f}});
    check_uniform((vec3[3]){{-1.0f, -1.0f, 0.1f}, {5.0f, -1.0f, 0.1f}, {-1.0f, 4.0f, 0.1f}}); /* close below */
    check_uniform((vec3[3]){{-1.0f, -1.0f, 0.1f}, {-1.0f, 4.0f, 0.1f}, {5.0f, -1.0f, 0.1f}}); /* from behind */
    check_uniform((vec3[3]){{1.0f, 0.0f, 30.0f}, {0.0f, 1.0f, 30.0f}, {0.0f, 0.0f, 31.0f}});  /* small */
    for (int k = 0; k < 3; k++) { /* close to the middle of each side */
        for (float height = 1e-3f; height > 5e-5f; height *= 0.1f) {
            vec3 p[3];
            p[k] = (vec3){-1.0f, 0.0f, height};
            p[(k + 1) % 3] = (vec3){1.0f, 0.0f, height};
            p[(k + 2) % 3] = (vec3){0.0f, 1.5f, height};
            check_uniform(p);
        }
    }
    check_uniform((vec3[3]){{-9.0f, 0.0f, 1.0f}, {9.0f, 0.0f, 1.0f}, {0.0f, 0.2f, 1.0f}}); /* long and thin */
}

/* Numbers at the square's edges give points of the triangle's edges, not of elsewhere. */
static void the_ends_of_the_numbers_are_the_triangle_s_edges(void **state)
{
    (void)state;
    vec3 p[3] = {{-1.0f, -1.0f, 0.5f}, {2.0f, -1.0f, 0.7f}, {-1.0f, 1.0f, 0.6f}};
    spherical_triangle t = seen(ORIGIN, p[0], p[1], p[2]);
    for (int i = 0; i <= 20; i++) {
        float u = fminf((float)i / 20.0f, 0.99999994f);
        vec2 fan = spherical_triangle_sample(&t, (vec2){u, 0.0f}),
             first = spherical_triangle_sample(&t, (vec2){0.0f, u});
        vec2 far = spherical_triangle_sample(&t, (vec2){u, 0.99999994f});
        assert_close(fan.x + fan.y, 0.0, 1e-3);
        assert_close(first.y, 0.0, 1e-4);
        assert_close(far.x + far.y, 1.0, 1e-4);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(solid_angles_are_those_of_closed_forms),
        cmocka_unit_test(points_are_uniform_in_solid_angle),
        cmocka_unit_test(the_ends_of_the_numbers_are_the_triangle_s_edges),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
