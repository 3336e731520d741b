/* test_moving_curves.c: curves whose points move: how they are put together and cut, and how far off them rays start.
 * Where they are at each time: test_curves.c. Threads: one. */
#include "fixtures/test_scene.h"

#define TUBE      "Shape \"curve\" \"string type\" \"cylinder\" "
#define FLAT      "Shape \"curve\" \"string type\" \"flat\" "
#define BENT      "\"point3 P\" [0 0 0 0 0 1 1 0 1 1 0 2] "
#define TWO_STEPS TUBE "\"integer motionsteps\" 2 \"point3 P\" [0 0 0 0 0 1 1 0 1 1 0 2  1 0 0 1 0 1 2 0 1 2 0 2] "

/* Points half way between two far ones are rounded as those are: rays start so far off, wherever the points are. */
static void far_points_are_allowed_for_between_them(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    scene *s =
        test_scene_create(&r, TUBE "\"float width\" .002 \"integer motionsteps\" 3 \"point3 P\" "
                                   "[-1000 0 0 -1000 0 1 -1000 0 2 -1000 0 3  1000 0 0 1000 0 1 1000 0 2 1000 0 3 "
                                   " 0 0 0 0 0 1 0 0 2 0 0 3]");
    static const float TIMES[][3] = {{0.25f, 0.0f, 1000.0f}, {0.75f, 500.0f, 1000.0f}, {1.0f, 0.0f, 1000.0f}};
    for (int k = 0; k < 3; k++) {
        scene_ray ray = scene_ray_make((vec3){TIMES[k][1], -5.0f, 1.5f}, (vec3){0.0f, 1.0f, 0.0f});
        surface_hit h;
        ray.time = TIMES[k][0];
        assert_true(scene_intersect(s, ray, INFINITY, &h));
        assert_true(h.epsilon >= TIMES[k][2] * SHAPE_EPSILON_RELATIVE);
        assert_true(h.epsilon < 1.01f * TIMES[k][2] * SHAPE_EPSILON_RELATIVE);
    }
    scene_destroy(s);
    test_run_reset(&r);
}

/* Curves of as many steps share a shape, others do not; and a flat one is cut as its most bent step needs it. */
static void curves_of_as_many_steps_join(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, TWO_STEPS TWO_STEPS TUBE BENT TWO_STEPS);
    assert_int_equal(s->shape_count, 3);
    const curves *c = &s->shapes[0].as.curves;
    assert_true(c->segment_count == 2 && c->motion_segments == 1 && s->shapes[1].as.curves.motion_segments == 0);
    assert_true(c->first_points[1] == 8 && c->points[8 + 4].at.x == 1.0f && c->points[8 + 3].at.z == 2.0f);
    assert_true(s->bounds_max.x >= 2.5f); /* where it is at the closing */
    scene_destroy(s);
    s = test_scene_create(&r, FLAT "\"float width\" .002 \"integer motionsteps\" 2 \"point3 P\" "
                                   "[0 0 0 0 0 1 0 0 2 0 0 3  0 0 0 9 0 1 -9 0 2 0 0 3] ");
    assert_true(s->shapes[0].as.curves.segment_count > 4);
    scene_destroy(s);
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(far_points_are_allowed_for_between_them),
        cmocka_unit_test(curves_of_as_many_steps_join),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
