/* test_motion.c: ways between transforms, against turns and scales written out; and how few straight steps stand for
 * them. Threads: one. */
#include "math/motion.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <string.h>

static transform turned(double degrees, double x, double y, double z)
{
    transform t;
    assert_true(transform_rotate(degrees, x, y, z, &t));
    return t;
}

static transform scaled(double x, double y, double z)
{
    transform t;
    assert_true(transform_scale(x, y, z, &t));
    return t;
}

static transform product(transform a, transform b) { return transform_multiply(&a, &b); }

static void expect_matrix(double m[3][4], const transform *expected, double tolerance)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 4; j++)
            if (!(fabs(m[i][j] - expected->m[i][j]) <= tolerance))
                fail_msg("entry %d, %d is %.9g, not %.9g", i, j, m[i][j], expected->m[i][j]);
}

static motion between(transform start, transform end)
{
    motion m;
    assert_true(motion_make(&start, &end, 0.0, 1.0, &m));
    return m;
}

/* Translation straight, turn even, scale straight, each as if alone: T R S. */
static void each_part_goes_its_own_way(void **state)
{
    (void)state;
    static const double AXES[][3] = {{0, 0, 1}, {1, 0, 0}, {-1, 2, 3}, {0.1, -0.9, 0.3}};
    static const double ANGLES[] = {0.0, 1e-3, 0.5, 30.0, 120.0, 179.0, -100.0};
    for (size_t a = 0; a < 4; a++)
        for (size_t k = 0; k < sizeof ANGLES / sizeof *ANGLES; k++)
            for (int mirror = 0; mirror < 2; mirror++) {
                const double *x = AXES[a], sign = mirror ? -1.0 : 1.0;
                transform first = turned(20.0, x[0], x[1], x[2]), last = turned(20.0 + ANGLES[k], x[0], x[1], x[2]);
                motion m = between(product(transform_translate(1, 2, 3), product(first, scaled(sign, 2, 3))),
                                   product(transform_translate(-5, 2, 7), product(last, scaled(2 * sign, 2, 1))));
                for (int i = 0; i <= 4; i++) {
                    double t = i / 4.0, at[3][4];
                    transform now = product(product(transform_translate(1 - 6 * t, 2, 3 + 4 * t),
                                                    turned(20.0 + t * ANGLES[k], x[0], x[1], x[2])),
                                            scaled(sign * (1 + t), 2, 3 - 2 * t));
                    motion_at(&m, t, at);
                    expect_matrix(at, &now, 3e-6);
                }
            }
}

/* A stretch along axes of its own; a turn of more than half is undone the shorter way. */
static void ends_are_kept(void **state)
{
    (void)state;
    transform skew = transform_identity();
    skew.m[0][1] = 1.5, skew.m[2][0] = -0.7;
    assert_true(transform_from_matrix((const double(*)[4])skew.m, &skew));
    transform a = product(transform_translate(3, -4, 1e3), product(turned(77, 1, 2, -3), skew));
    transform b = product(turned(250, 0, 1, 1), product(scaled(1e-3, 5, 1e4), skew));
    motion m = between(a, b);
    double at[3][4];
    motion_at(&m, 0.0, at);
    expect_matrix(at, &a, 1e-5);
    motion_at(&m, 1.0, at);
    expect_matrix(at, &b, 1e-2); /* of 1.5e4 */
    m = between(transform_identity(), turned(270, 0, 0, 1));
    motion_at(&m, 0.5, at);
    transform back = turned(-45, 0, 0, 1);
    expect_matrix(at, &back, 1e-6);
}

static void nothing_moves_before_and_after(void **state)
{
    (void)state;
    transform start = transform_identity(), end = transform_translate(8, 0, 0);
    motion m;
    double at[3][4];
    /* of a motion that takes 4 s from 1 s on, seen from 0 s to 8 s */
    assert_true(motion_make(&start, &end, -0.25, 1.75, &m));
    static const double X[] = {0, 0, 4, 8, 8};
    for (int i = 0; i < 5; i++) {
        motion_at(&m, i == 1 ? 0.125 : i == 2 ? 0.375 : i / 4.0, at);
        assert_true(fabs(at[0][3] - X[i]) < 1e-12);
    }
}

static void what_turns_inside_out_is_refused(void **state)
{
    (void)state;
    motion m;
    transform start = transform_identity(), mirror = scaled(-1, 1, 1), tiny = scaled(1e-30, 1e-30, 1e-30);
    transform projective = transform_identity();
    projective.m[3][2] = 0.5;
    assert_false(motion_make(&start, &mirror, 0, 1, &m));
    assert_false(motion_make(&mirror, &start, 0, 1, &m));
    assert_true(motion_make(&mirror, &mirror, 0, 1, &m));
    assert_false(motion_make(&start, &tiny, 0, 1, &m));
    assert_false(motion_make(&start, &projective, 0, 1, &m));
}

static void as_few_steps_as_do(void **state)
{
    (void)state;
    affine steps[MOTION_STEPS_MAX];
    transform unit = transform_identity();
    motion still = between(turned(30, 1, 2, 3), turned(30, 1, 2, 3));
    assert_int_equal(motion_steps(&still, NULL, steps), 1);
    motion glide = between(unit, transform_translate(1e4, 2, 3));
    assert_int_equal(motion_steps(&glide, NULL, steps), 2);
    assert_true(steps[0].m[0][3] == 0.0f && steps[1].m[0][3] == 1e4f);
    motion grow = between(turned(30, 1, 2, 3), product(turned(30, 1, 2, 3), scaled(2, 3, 4)));
    assert_int_equal(motion_steps(&grow, NULL, steps), 2);
    /* over before the shutter opens */
    transform far = transform_translate(1, 0, 0);
    motion over;
    assert_true(motion_make(&unit, &far, 1.0, 2.0, &over));
    assert_int_equal(motion_steps(&over, NULL, steps), 1);
    assert_true(steps[0].m[0][3] == 1.0f);
}

/* Turns, alone and within another motion: the steps hold what they promise. */
static void steps_keep_to_the_way(void **state)
{
    (void)state;
    transform unit = transform_identity();
    motion turn = between(product(transform_translate(7, 8, 9), turned(10, 1, 1, 0)),
                          product(transform_translate(7, 9, 9), turned(170, 1, 1, 0)));
    motion slight = between(unit, turned(3, 0, 1, 0)), glide = between(unit, transform_translate(4, 0, 0));
    const motion *const OUTER[] = {&turn, &slight, &turn, &glide}, *const INNER[] = {NULL, NULL, &glide, &turn};
    for (int k = 0; k < 4; k++) {
        affine steps[MOTION_STEPS_MAX];
        uint32_t count = motion_steps(OUTER[k], INNER[k], steps);
        assert_true(count > 2 && count <= MOTION_STEPS_MAX);
        if (k == 1)
            assert_int_equal(count, 3);
        for (int i = 0; i <= 1000; i++) {
            double t = i / 1000.0, a[3][4], b[3][4];
            float at = (float)t * (float)(count - 1), step = fminf(floorf(at), (float)(count - 2));
            affine now = affine_lerp(&steps[(int)step], &steps[(int)step + 1], at - step);
            transform outer = unit, inner = unit;
            motion_at(OUTER[k], t, a);
            memcpy(outer.m, a, sizeof a);
            if (INNER[k]) {
                motion_at(INNER[k], t, b);
                memcpy(inner.m, b, sizeof b);
            }
            transform both = transform_multiply(&outer, &inner);
            for (int r = 0; r < 3; r++)
                for (int c = 0; c < 4; c++)
                    assert_true(fabs((double)now.m[r][c] - both.m[r][c]) < (c < 3 ? 2e-4 : 1e-3));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_part_goes_its_own_way),
        cmocka_unit_test(ends_are_kept),
        cmocka_unit_test(nothing_moves_before_and_after),
        cmocka_unit_test(what_turns_inside_out_is_refused),
        cmocka_unit_test(as_few_steps_as_do),
        cmocka_unit_test(steps_keep_to_the_way),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
