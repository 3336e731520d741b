/* test_importance_map.c: the importance of a point is the share of questions per area around it, on its own side of a
 * surface, and nothing elsewhere. Threads: one. */
#include "importance_map.h"

#include "fixtures/test_scene.h"

enum { COUNT = 20000 };

static query_point *field(vec3 low, vec3 high, vec3 normal, uint32_t count)
{
    query_point *points = malloc(count * sizeof *points);
    assert_non_null(points);
    rng random = test_random(count);
    for (uint32_t i = 0; i < count; i++)
        points[i] = (query_point){random_in_box(&random, low, high), normal};
    return points;
}

/* Evenly asked for, on a square of 3 x 2 that is turned by 30 degrees about x. */
static void an_even_field_is_even(void **state)
{
    (void)state;
    const float c = 0.8660254f, s = 0.5f;
    query_point *points = field((vec3){0.0f, 0.0f, 5.0f}, (vec3){3.0f, 2.0f, 5.0f}, (vec3){0.0f, -s, c}, COUNT);
    for (int i = 0; i < COUNT; i++)
        points[i].position = (vec3){points[i].position.x, c * points[i].position.y, 5.0f + s * points[i].position.y};
    importance_map importance;
    assert_int_equal(importance_map_create(points, COUNT, &importance), AG_OK);
    rng random = test_random(1);
    double sum = 0.0;
    int empty = 0, tries = 20000;
    for (int i = 0; i < tries; i++) {
        float x = 3.0f * rng_float(&random), y = 2.0f * rng_float(&random);
        vec3 point = {x, c * y, 5.0f + s * y};
        float at = importance_map_at(&importance, point, (vec3){0.0f, -s, c});
        sum += (double)at / tries;
        empty += at == 0.0f;
        assert_true(importance_map_at(&importance, point, (vec3){0.0f, s, -c}) == 0.0f);
        point.z += 1.0f;
        assert_true(importance_map_at(&importance, point, (vec3){0.0f, -s, c}) == 0.0f);
    }
    /* a cube that is cut askew counts by its edge, not by the area of the cut: right within a factor of two */
    assert_true(sum > 0.5 / 6.0 && sum < 2.0 / 6.0);
    assert_true(empty < tries / 100);
    importance_map_reset(&importance);
    free(points);
}

/* Nine in ten questions around one place; the others a kilometre away. */
static void the_focus_is_around_most_points(void **state)
{
    (void)state;
    const vec3 up = {0.0f, 0.0f, 1.0f};
    query_point *points = field((vec3){3.0f, -2.0f, 1.0f}, (vec3){5.0f, 2.0f, 1.0f}, up, COUNT);
    for (int i = 0; i < COUNT; i += 12)
        points[i].position.x += 1000.0f;
    importance_map importance;
    assert_int_equal(importance_map_create(points, COUNT, &importance), AG_OK);
    assert_close(importance.focus.center.x, 4.0 + 1.0 / 11.0, 0.05);
    assert_close(importance.focus.center.y, 0.0, 0.1);
    assert_close(importance.focus.center.z, 1.0, 1e-6);
    int within = 0;
    for (int i = 0; i < COUNT; i++)
        within += vec3_distance_squared(points[i].position, importance.focus.center) <=
                  importance.focus.radius * importance.focus.radius;
    assert_close((double)within / COUNT, 0.9, 1e-3);
    assert_true(importance.focus.radius < 2.4f);
    importance_map_reset(&importance);
    free(points);
}

/* Half of the questions on a hundredth of the area. */
static void what_is_asked_more_counts_more(void **state)
{
    (void)state;
    query_point *points = field((vec3){0.0f, 0.0f, 0.0f}, (vec3){1.0f, 1.0f, 0.0f}, (vec3){0.0f, 0.0f, 1.0f}, COUNT);
    for (int i = 0; i < COUNT / 2; i++)
        points[i].position = vec3_scale(points[i].position, 0.1f);
    importance_map importance;
    assert_int_equal(importance_map_create(points, COUNT, &importance), AG_OK);
    rng random = test_random(2);
    double near = 0.0, far = 0.0;
    for (int i = 0; i < 1000; i++) {
        vec3 point = random_in_box(&random, (vec3){0.0f, 0.0f, 0.0f}, (vec3){1.0f, 1.0f, 0.0f});
        near += 1e-3 * (double)importance_map_at(&importance, vec3_scale(point, 0.1f), (vec3){0.0f, 0.0f, 1.0f});
        point.x = 0.2f + 0.8f * point.x;
        far += 1e-3 * (double)importance_map_at(&importance, point, (vec3){0.0f, 0.0f, 1.0f});
    }
    assert_relative(near, 50.5, 0.3);
    assert_relative(far, 0.5, 0.3);
    importance_map_reset(&importance);
    free(points);
}

static void odd_fields_are_safe(void **state)
{
    (void)state;
    importance_map importance;
    query_point same[100];
    const vec3 up = {0.0f, 0.0f, 1.0f}, there = {1e6f, -3.0f, 2.0f};
    assert_int_equal(importance_map_create(NULL, 0, &importance), AG_OK);
    assert_true(importance_map_at(&importance, there, up) == 0.0f);
    importance_map_reset(&importance);
    for (int i = 0; i < 100; i++)
        same[i] = (query_point){there, up};
    assert_int_equal(importance_map_create(same, 100, &importance), AG_OK);
    float at = importance_map_at(&importance, there, up);
    assert_true(at > 0.0f && isfinite(at));
    assert_true(importance_map_at(&importance, (vec3){NAN, 0.0f, 0.0f}, up) == 0.0f);
    assert_true(importance_map_at(&importance, (vec3){INFINITY, 0.0f, 0.0f}, up) == 0.0f);
    importance_map_reset(&importance);
}

/* 64 points a square meter on the left half of a square of 8 x 8, and none on the right one, as shares of twice as
 * many: the left reads as it is, the right as more than nothing and less than two points for each part that was looked
 * at, and whatever faces another way as nothing. */
static void a_smooth_field_is_nowhere_nothing(void **state)
{
    (void)state;
    enum { HALF_COUNT = 2048 };
    query_point *points = malloc(HALF_COUNT * sizeof *points);
    importance_map importance;
    const vec3 up = {0.0f, 0.0f, 1.0f};
    assert_non_null(points);
    rng random = test_random(4);
    for (int i = 0; i < HALF_COUNT; i++)
        points[i] = (query_point){random_in_box(&random, (vec3){-4.0f, -4.0f, 0.0f}, (vec3){0.0f, 4.0f, 0.0f}), up};
    assert_int_equal(importance_map_create_smooth(points, HALF_COUNT, 2 * HALF_COUNT, (vec3){-5.0f, -5.0f, -5.0f},
                                                  (vec3){5.0f, 5.0f, 5.0f}, &importance),
                     AG_OK);
    double left = 0.0, right = 0.0, least = INFINITY;
    for (int i = 0; i < 4000; i++) {
        vec3 at = random_in_box(&random, (vec3){-3.9f, -3.9f, 0.0f}, (vec3){-0.1f, 3.9f, 0.0f});
        left += (double)importance_map_at(&importance, at, up) / 4000.0;
        assert_true(importance_map_at(&importance, at, vec3_negate(up)) == 0.0f);
        at.x += 4.4f;
        double there = (double)importance_map_at(&importance, at, up);
        right += there / 4000.0;
        least = fmin(least, there);
    }
    assert_relative(left, 0.5 / 32.0, 0.1);
    assert_true(least > 0.0 && right < 0.02 * left);
    importance_map_reset(&importance);
    assert_int_equal(importance_map_create_smooth(NULL, 0, 0, up, up, &importance), AG_OK);
    assert_true(importance_map_at(&importance, up, up) == 0.0f);
    free(points);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_even_field_is_even),
        cmocka_unit_test(what_is_asked_more_counts_more),
        cmocka_unit_test(the_focus_is_around_most_points),
        cmocka_unit_test(a_smooth_field_is_nowhere_nothing),
        cmocka_unit_test(odd_fields_are_safe),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
