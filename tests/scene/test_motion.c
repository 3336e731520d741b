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

/* Of motions that are paths by themselves; inner may be NULL. */
static uint32_t steps_of(motion *outer, motion *inner, affine out_steps[MOTION_STEPS_MAX])
{
    const motion_path around = {outer, 1}, within = {inner, 1};
    return motion_steps(&around, inner ? &within : NULL, out_steps);
}

static void as_few_steps_as_do(void **state)
{
    (void)state;
    affine steps[MOTION_STEPS_MAX];
    transform unit = transform_identity();
    motion still = between(turned(30, 1, 2, 3), turned(30, 1, 2, 3));
    assert_int_equal(steps_of(&still, NULL, steps), 1);
    motion glide = between(unit, transform_translate(1e4, 2, 3));
    assert_int_equal(steps_of(&glide, NULL, steps), 2);
    assert_true(steps[0].m[0][3] == 0.0f && steps[1].m[0][3] == 1e4f);
    motion grow = between(turned(30, 1, 2, 3), product(turned(30, 1, 2, 3), scaled(2, 3, 4)));
    assert_int_equal(steps_of(&grow, NULL, steps), 2);
    /* over before the shutter opens */
    transform far = transform_translate(1, 0, 0);
    motion over;
    assert_true(motion_make(&unit, &far, 1.0, 2.0, &over));
    assert_int_equal(steps_of(&over, NULL, steps), 1);
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
    motion *const OUTER[] = {&turn, &slight, &turn, &glide}, *const INNER[] = {NULL, NULL, &glide, &turn};
    for (int k = 0; k < 4; k++) {
        affine steps[MOTION_STEPS_MAX];
        uint32_t count = steps_of(OUTER[k], INNER[k], steps);
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

enum { PASSED_MOST = 8 };

/* Past all of the transforms, each after equally long, from at_opening to at_closing of the whole. */
static motion_path path_past(const transform *passed, uint32_t count, double at_opening, double at_closing,
                             motion out_segments[PASSED_MOST])
{
    for (uint32_t i = 0; i + 1 < count; i++)
        assert_true(motion_make(&passed[i], &passed[i + 1], at_opening * (count - 1) - i, at_closing * (count - 1) - i,
                                &out_segments[i]));
    return (motion_path){out_segments, count - 1};
}

/* A wheel that makes a whole turn, of which its first and its last place say nothing. */
static void a_path_goes_past_all_it_was_given(void **state)
{
    (void)state;
    transform thirds[4];
    motion segments[PASSED_MOST];
    affine steps[MOTION_STEPS_MAX];
    for (int i = 0; i < 4; i++)
        thirds[i] = product(transform_translate(i, 0, 0), turned(120 * i, 0, 0, 1));
    const motion_path wheel = path_past(thirds, 4, 0.0, 1.0, segments);
    const uint32_t count = motion_steps(&wheel, NULL, steps);
    assert_int_equal(count, 97); /* a step at each third, and as many between as there may be */
    for (int i = 0; i <= 300; i++) {
        double t = i / 300.0, at[3][4];
        const transform now = product(transform_translate(3 * t, 0, 0), turned(360 * t, 0, 0, 1));
        motion_path_at(&wheel, t, at);
        expect_matrix(at, &now, 1e-6);
        const float along = (float)t * (float)(count - 1), step = fminf(floorf(along), (float)(count - 2));
        const affine straight = affine_lerp(&steps[(int)step], &steps[(int)step + 1], along - step);
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 4; c++)
                assert_true(fabs((double)straight.m[r][c] - now.m[r][c]) < 6e-4);
    }
}

static void a_path_is_seen_through_the_shutter(void **state)
{
    (void)state;
    const transform corners[3] = {transform_translate(0, 0, 0), transform_translate(8, 0, 0),
                                  transform_translate(8, 8, 0)};
    static const double X[] = {0, 4, 8, 8, 8}, Y[] = {0, 0, 0, 4, 8};
    motion segments[PASSED_MOST];
    double at[3][4];
    /* it waits for a quarter of the time before, and for another behind */
    const motion_path path = path_past(corners, 3, -0.5, 1.5, segments);
    for (int i = 0; i <= 4; i++) {
        motion_path_at(&path, 0.25 + i / 8.0, at);
        assert_true(at[0][3] == X[i] && at[1][3] == Y[i] && at[2][3] == 0.0);
    }
    motion_path_at(&path, 0.0, at);
    assert_true(at[0][3] == 0.0 && at[1][3] == 0.0);
    motion_path_at(&path, 1.0, at);
    assert_true(at[0][3] == 8.0 && at[1][3] == 8.0);
}

static void a_path_has_a_step_at_each_bend(void **state)
{
    (void)state;
    const transform there_and_back[3] = {transform_identity(), transform_translate(1, 0, 0), transform_identity()},
                    up_and_down[4] = {transform_identity(), transform_translate(0, 1, 0), transform_translate(0, 2, 0),
                                      transform_identity()},
                    waits[3] = {transform_translate(2, 0, 0), transform_translate(2, 0, 0),
                                transform_translate(2, 0, 0)};
    motion outer[PASSED_MOST], inner[PASSED_MOST], still[PASSED_MOST];
    affine steps[MOTION_STEPS_MAX];
    const motion_path back = path_past(there_and_back, 3, 0.0, 1.0, outer),
                      down = path_past(up_and_down, 4, 0.0, 1.0, inner), rest = path_past(waits, 3, 0.0, 1.0, still);
    assert_int_equal(motion_steps(&back, NULL, steps), 3); /* both ends are the same place, and yet it moves */
    assert_true(steps[0].m[0][3] == 0.0f && steps[1].m[0][3] == 1.0f && steps[2].m[0][3] == 0.0f);
    assert_int_equal(motion_steps(&down, NULL, steps), 4);
    assert_true(steps[2].m[1][3] == 2.0f);
    assert_int_equal(motion_steps(&back, &down, steps), 7);
    assert_true(steps[3].m[0][3] == 1.0f && steps[3].m[1][3] == 1.5f && steps[4].m[1][3] == 2.0f);
    assert_int_equal(motion_steps(&rest, NULL, steps), 1);
    assert_true(steps[0].m[0][3] == 2.0f);
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
        cmocka_unit_test(a_path_goes_past_all_it_was_given),
        cmocka_unit_test(a_path_is_seen_through_the_shutter),
        cmocka_unit_test(a_path_has_a_step_at_each_bend),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
