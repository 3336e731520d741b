/* test_transform.c: matrices and their inverses, points, vectors and normals. Threads: one. */
#include "math/transform.h"

#include "fixtures/test_scene.h"

static void assert_vec3(vec3 v, double x, double y, double z, double tolerance)
{
    assert_close(v.x, x, tolerance);
    assert_close(v.y, y, tolerance);
    assert_close(v.z, z, tolerance);
}

static transform random_transform(rng *random)
{
    transform a, b, t = transform_translate(rng_float(random) * 10.0, rng_float(random) - 5.0, rng_float(random));
    vec3 axis = random_direction(random);
    assert_true(transform_rotate(rng_float(random) * 360.0, axis.x, axis.y, axis.z, &a));
    assert_true(transform_scale(0.1 + rng_float(random), -0.1 - rng_float(random), 3.0 * rng_float(random) + 0.1, &b));
    t = transform_multiply(&t, &a);
    return transform_multiply(&t, &b);
}

static void a_transform_and_its_inverse_cancel(void **state)
{
    (void)state;
    rng random = test_random(1);
    for (int i = 0; i < 200; i++) {
        transform t = random_transform(&random), back = transform_invert(&t), again;
        assert_true(transform_from_matrix((const double(*)[4])t.m, &again));
        vec3 p = random_in_box(&random, (vec3){-5.0f, -5.0f, -5.0f}, (vec3){5.0f, 5.0f, 5.0f});
        vec3 q = transform_point(&back, transform_point(&t, p));
        assert_vec3(q, p.x, p.y, p.z, 1e-4);
        for (int r = 0; r < 4; r++)
            for (int c = 0; c < 4; c++)
                assert_close(again.inverse[r][c], t.inverse[r][c], 1e-9);
    }
}

static void products_apply_the_second_first(void **state)
{
    (void)state;
    transform move = transform_translate(1, 2, 3), turn, both;
    assert_true(transform_rotate(90, 0, 0, 1, &turn));
    both = transform_multiply(&move, &turn);
    assert_vec3(transform_point(&both, (vec3){1.0f, 0.0f, 0.0f}), 1, 3, 3, 1e-6);
    assert_vec3(transform_vector(&both, (vec3){1.0f, 0.0f, 0.0f}), 0, 1, 0, 1e-6);
    both = transform_multiply(&turn, &move);
    assert_vec3(transform_point(&both, (vec3){1.0f, 0.0f, 0.0f}), -2, 2, 3, 1e-6);
    transform none = transform_identity();
    assert_vec3(transform_point(&none, (vec3){4.0f, 5.0f, 6.0f}), 4, 5, 6, 0);
}

static void rotations_turn_by_the_right_hand(void **state)
{
    (void)state;
    transform t;
    assert_true(transform_rotate(90, 2, 0, 0, &t));
    assert_vec3(transform_vector(&t, (vec3){0.0f, 1.0f, 0.0f}), 0, 0, 1, 1e-6);
    assert_true(transform_rotate(90, 0, 0.1, 0, &t));
    assert_vec3(transform_vector(&t, (vec3){0.0f, 0.0f, 1.0f}), 1, 0, 0, 1e-6);
    assert_true(transform_rotate(120, 1, 1, 1, &t));
    assert_vec3(transform_vector(&t, (vec3){1.0f, 2.0f, 3.0f}), 3, 1, 2, 1e-6);
    assert_false(transform_swaps_handedness(&t));
}

static void what_has_no_inverse_is_refused(void **state)
{
    (void)state;
    transform t = transform_translate(1, 2, 3), kept = t;
    double singular[4][4] = {{1, 2, 3, 0}, {2, 4, 6, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    double broken[4][4] = {{NAN, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    assert_false(transform_from_matrix((const double(*)[4])singular, &t));
    assert_false(transform_from_matrix((const double(*)[4])broken, &t));
    assert_false(transform_scale(1, 0, 1, &t));
    assert_false(transform_rotate(30, 0, 0, 0, &t));
    assert_false(transform_rotate(INFINITY, 0, 0, 1, &t));
    const double here[3] = {1, 1, 1}, there[3] = {1, 1, 5}, up[3] = {0, 0, 2}, nowhere[3] = {0, 0, 0};
    assert_false(transform_look_at(here, here, up, &t));
    assert_false(transform_look_at(here, there, up, &t));
    assert_false(transform_look_at(here, there, nowhere, &t));
    assert_memory_equal(&t, &kept, sizeof t);
}

static void look_at_makes_a_left_handed_camera(void **state)
{
    (void)state;
    const double eye[3] = {1, 2, 3}, look[3] = {1, 2, -7}, up[3] = {0, 5, 0.5};
    transform camera_from_world;
    assert_true(transform_look_at(eye, look, up, &camera_from_world));
    assert_vec3(transform_point(&camera_from_world, (vec3){1.0f, 2.0f, 3.0f}), 0, 0, 0, 1e-6);
    assert_vec3(transform_point(&camera_from_world, (vec3){1.0f, 2.0f, -7.0f}), 0, 0, 10, 1e-5);
    assert_vec3(transform_vector(&camera_from_world, (vec3){0.0f, 1.0f, 0.0f}), 0, 1, 0, 1e-6);
    /* looking along -z, with y up, x goes to the right in pbrt's left-handed camera space */
    assert_vec3(transform_vector(&camera_from_world, (vec3){1.0f, 0.0f, 0.0f}), -1, 0, 0, 1e-6);
    assert_close(transform_uniform_scale(&camera_from_world), 1.0, 1e-12);
}

static void normals_stay_perpendicular(void **state)
{
    (void)state;
    rng random = test_random(2);
    for (int i = 0; i < 200; i++) {
        transform t = random_transform(&random);
        vec3 n = random_direction(&random);
        frame f = frame_from_z(n);
        vec3 m = vec3_normalize(transform_normal(&t, n));
        assert_close(vec3_dot(m, vec3_normalize(transform_vector(&t, f.x))), 0.0, 1e-5);
        assert_close(vec3_dot(m, vec3_normalize(transform_vector(&t, f.y))), 0.0, 1e-5);
        /* normals stay on their side of the surface */
        assert_true(vec3_dot(m, transform_vector(&t, n)) > 0.0f);
    }
}

static void handedness_and_uniform_scale(void **state)
{
    (void)state;
    transform mirror, stretch, turn, t;
    assert_true(transform_scale(-2, 2, 2, &mirror));
    assert_true(transform_scale(1, 2, 1, &stretch));
    assert_true(transform_rotate(77, 3, 1, 2, &turn));
    assert_true(transform_swaps_handedness(&mirror));
    assert_false(transform_swaps_handedness(&stretch));
    t = transform_multiply(&turn, &mirror);
    assert_true(transform_swaps_handedness(&t));
    assert_close(transform_uniform_scale(&t), 2.0, 1e-9);
    t = transform_multiply(&t, &mirror);
    assert_false(transform_swaps_handedness(&t));
    assert_close(transform_uniform_scale(&t), 4.0, 1e-9);
    assert_true(transform_uniform_scale(&stretch) == 0.0);
}

static void frames_are_orthonormal(void **state)
{
    (void)state;
    rng random = test_random(3);
    for (int i = 0; i < 10000; i++) {
        vec3 z = i == 0 ? (vec3){0.0f, 0.0f, -1.0f} : i == 1 ? (vec3){0.0f, 0.0f, 1.0f} : random_direction(&random);
        frame f = frame_from_z(z);
        assert_close(vec3_length(f.x), 1.0, 1e-5);
        assert_close(vec3_length(f.y), 1.0, 1e-5);
        assert_close(vec3_dot(f.x, f.y), 0.0, 1e-5);
        assert_close(vec3_dot(f.x, z), 0.0, 1e-5);
        vec3 cross = vec3_cross(f.x, f.y);
        assert_vec3(cross, z.x, z.y, z.z, 1e-5);
        vec3 v = random_direction(&random), back = frame_to_world(&f, frame_to_local(&f, v));
        assert_vec3(back, v.x, v.y, v.z, 1e-5);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_transform_and_its_inverse_cancel), cmocka_unit_test(products_apply_the_second_first),
        cmocka_unit_test(rotations_turn_by_the_right_hand),   cmocka_unit_test(what_has_no_inverse_is_refused),
        cmocka_unit_test(look_at_makes_a_left_handed_camera), cmocka_unit_test(normals_stay_perpendicular),
        cmocka_unit_test(handedness_and_uniform_scale),       cmocka_unit_test(frames_are_orthonormal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
