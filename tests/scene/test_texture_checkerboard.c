/* test_texture_checkerboard.c: shares of a checkerboard's odd cells over footprints against means of many points, in
 * the plane and in space, along the cells and askew, and that their mean over a surface is that of the points. Flow:
 * tests of scene/texture/texture_checkerboard.c. Threads: one. */
#define _GNU_SOURCE
#include "fixtures/texture_fixture.h"
#include "math/rng.h"
#include "texture/texture_checkerboard.h"

enum { SIDE = 256 };

/* The share of odd cells among points of a rectangle with these sides. */
static double share_of_points(vec3 p, vec3 a, vec3 b)
{
    unsigned odd = 0;
    for (int i = 0; i < SIDE; i++)
        for (int k = 0; k < SIDE; k++) {
            const float along_a = ((float)i + 0.5f) / SIDE - 0.5f, along_b = ((float)k + 0.5f) / SIDE - 0.5f;
            odd += checkerboard_is_odd(vec3_add_scaled(vec3_add_scaled(p, a, along_a), b, along_b));
        }
    return (double)odd / (SIDE * SIDE);
}

static void expect_share(vec3 p, vec3 a, vec3 b, bool is_solid, double tolerance)
{
    const vec3 axes[2] = {a, b};
    assert_near((double)checkerboard_odd_share(p, axes, is_solid), share_of_points(p, a, b), tolerance);
}

static vec3 random_point(rng *random, bool is_solid)
{
    vec3 p = vec3_make(20.0f * rng_float(random) - 10.0f, 20.0f * rng_float(random) - 10.0f, 0.5f);
    if (is_solid)
        p.z = 20.0f * rng_float(random) - 10.0f;
    return p;
}

static void along_the_cells(void **state)
{
    (void)state;
    static const float SIZES[][2] = {{0.1f, 0.1f}, {0.7f, 0.3f}, {1.0f, 1.5f}, {2.5f, 0.25f}, {9.75f, 3.5f}};
    rng random = rng_make(1, 1, 0);
    for (int k = 0; k < 100; k++) {
        const float *size = SIZES[k % 5];
        const vec3 x = vec3_make(size[0], 0.0f, 0.0f), y = vec3_make(0.0f, size[1], 0.0f),
                   z = vec3_make(0.0f, 0.0f, size[1]);
        const double error = 0.01 + 0.02 * (double)(size[0] * size[1]) / SIDE; /* of the points */
        expect_share(random_point(&random, false), x, y, false, error);
        expect_share(random_point(&random, true), x, z, true, error);
        expect_share(random_point(&random, true), z, vec3_negate(y), true, error);
    }
    const vec3 none[2] = {vec3_make(0, 0, 0), vec3_make(0, 0, 0)};
    for (int k = 0; k < 100; k++) {
        const vec3 p = random_point(&random, true);
        assert_true(checkerboard_odd_share(p, none, true) == (checkerboard_is_odd(p) ? 1.0f : 0.0f));
    }
}

/* Conjugate diameters of a circle are any two at right angles: the same footprint. */
static void askew_in_the_plane(void **state)
{
    (void)state;
    rng random = rng_make(1, 2, 0);
    double squares = 0.0;
    enum { COUNT = 400 };
    for (int k = 0; k < COUNT; k++) {
        const float angle = 6.2831853f * rng_float(&random), width = 0.05f + 0.3f * rng_float(&random),
                    length = width * (1.0f + 9.0f * rng_float(&random));
        const vec3 p = random_point(&random, false), along = vec3_make(cosf(angle), sinf(angle), 0.0f),
                   a = vec3_scale(along, length), b = vec3_scale(vec3_make(-along.y, along.x, 0.0f), width),
                   skew[2] = {vec3_scale(vec3_add(a, b), 0.70710678f), vec3_scale(vec3_sub(a, b), 0.70710678f)},
                   axes[2] = {a, b};
        const double share = (double)checkerboard_odd_share(p, axes, false), off = share - share_of_points(p, a, b);
        assert_near((double)checkerboard_odd_share(p, skew, false), share, 1e-4);
        assert_true(fabs(off) < 0.15);
        squares += off * off;
    }
    assert_true(sqrt(squares / COUNT) < 0.02);
}

/* Of places u / 10 and v / 10 apart on a surface, on which cells come again after some of these. */
static void expect_mean(vec3 origin, vec3 u, vec3 v, float size, bool is_solid)
{
    const vec3 axes[2] = {vec3_scale(u, size), vec3_scale(v, 4.0f * size)};
    double shares = 0.0, points = 0.0;
    enum { COUNT = 200 };
    for (int i = 0; i < COUNT; i++)
        for (int k = 0; k < COUNT; k++) {
            const vec3 p = vec3_add_scaled(vec3_add_scaled(origin, u, 0.1f * (float)i), v, 0.1f * (float)k);
            shares += (double)checkerboard_odd_share(p, axes, is_solid);
            points += checkerboard_is_odd(p);
        }
    assert_near(shares / (COUNT * COUNT), points / (COUNT * COUNT), 0.02);
}

/* Cells go along with one another where a surface lies askew: on x + y = 1/2 an odd x is mostly with an odd y. */
static void means_of_surfaces(void **state)
{
    (void)state;
    const float h = 0.70710678f;
    static const float SIZES[] = {0.02f, 0.1f, 0.3f, 2.0f, 30.0f};
    for (int k = 0; k < 5; k++) {
        expect_mean(vec3_make(0.25f, -0.25f, 0.5f), vec3_make(h, -h, 0), vec3_make(0, 0, 1), SIZES[k],
                    true); /* corners */
        expect_mean(vec3_make(0.3f, 0.2f, 0.5f), vec3_make(1, 0, 0), vec3_make(0, 1, 0), SIZES[k], false);
        expect_mean(vec3_make(0.3f, 0.2f, 0.5f), vec3_make(h, h, 0), vec3_make(-h, h, 0), SIZES[k], false);
        expect_mean(vec3_make(0.3f, 0.2f, 0.5f), vec3_make(h, -h, 0), vec3_make(0, 0, 1), SIZES[k], true);
        expect_mean(vec3_make(0.25f, 0.15f, 0.5f), vec3_make(h, -h, 0), vec3_make(0.3f, 0.3f, 0.9f), SIZES[k], true);
    }
}

/* Numbers that are too large, or none. */
static void hard_footprints(void **state)
{
    (void)state;
    static const float NUMBERS[] = {0.0f, 1e-30f, 1e-6f, 1.0f, 1e7f, 1e14f, 1e30f, INFINITY, NAN};
    enum { COUNT = sizeof NUMBERS / sizeof *NUMBERS };
    for (int i = 0; i < COUNT * COUNT * COUNT; i++) {
        const float x = NUMBERS[i % COUNT], a = NUMBERS[i / COUNT % COUNT], b = NUMBERS[i / COUNT / COUNT];
        const vec3 axes[2] = {vec3_make(a, b, 0.0f), vec3_make(-b, a, 0.0f)};
        for (int solid = 0; solid < 2; solid++) {
            const float share = checkerboard_odd_share(vec3_make(x, -x, 0.5f), axes, solid);
            assert_true(share >= 0.0f && share <= 1.0f);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(along_the_cells),
        cmocka_unit_test(askew_in_the_plane),
        cmocka_unit_test(means_of_surfaces),
        cmocka_unit_test(hard_footprints),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
