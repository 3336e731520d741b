/* test_shape.c: areas, bounds, samples, normals and intersections of meshes, spheres, ellipsoids and disks.
 * Threads: one. */
/* ctest: serial */
#include "fixtures/test_scene.h"

#define LAMP "AreaLightSource \"diffuse\" "
#define BOX                                                                                                            \
    "Shape \"trianglemesh\" \"integer indices\" "                                                                      \
    "[0 3 1 0 2 3 4 5 7 4 7 6 0 1 5 0 5 4 2 7 3 2 6 7 0 6 2 0 4 6 1 7 5 1 3 7]\n"                                      \
    "\"point3 P\" [-1 -1 -1 1 -1 -1 -1 1 -1 1 1 -1 -1 -1 1 1 -1 1 -1 1 1 1 1 1]"

/* Closed shapes, with their outside outside; all shine, so that meshes can be sampled. */
static const char *const CLOSED[] = {
    LAMP "Shape \"sphere\" \"float radius\" [2]",
    "Translate 100 -50 20 Rotate 40 1 2 3 Scale 3 3 3 " LAMP "Shape \"sphere\"",
    "Scale -2 2 2 " LAMP "Shape \"sphere\"",
    "Translate 10 -5 2 Rotate 40 1 2 3 Scale 3 1 0.5 " LAMP "Shape \"sphere\" \"float radius\" [1.5]",
    "Rotate 40 1 2 3 Scale 3 -1 2 " LAMP "Shape \"sphere\"",
    LAMP BOX,
    "Translate 100 -50 20 Rotate 40 1 2 3 Scale 3 1 -0.5 " LAMP BOX,
    "Translate 0.1 0.2 1000 " LAMP "Shape \"sphere\" \"float radius\" [1]",
};
enum { CLOSED_COUNT = sizeof CLOSED / sizeof *CLOSED };

static const char *const DISKS[] = {
    LAMP "Shape \"disk\" \"float radius\" [2] \"float height\" [0.5]",
    "Translate 10 -5 2 Rotate 40 1 2 3 Scale 3 1 -2 " LAMP
    "Shape \"disk\" \"float radius\" [2] \"float innerradius\" [1]",
};

static vec3 shape_middle(const shape *s)
{
    vec3 low, high;
    shape_bounds(s, &low, &high);
    return vec3_scale(vec3_add(low, high), 0.5f);
}

/* --- areas --- */

/* Knud Thomsen's formula for ellipsoids (2004), right within 1.061 %. */
static double thomsen(double a, double b, double c)
{
    const double p = 1.6075;
    return 4.0 * PI * pow((pow(a * b, p) + pow(a * c, p) + pow(b * c, p)) / 3.0, 1.0 / p);
}

static void areas_have_their_closed_forms(void **state)
{
    (void)state;
    assert_relative(test_scene_area("Shape \"sphere\" \"float radius\" [3]"), 4.0 * PI * 9.0, 1e-6);
    assert_relative(test_scene_area("Rotate 30 1 1 1 Scale 2 -2 2 Shape \"sphere\" \"float radius\" [3]"),
                    4.0 * PI * 36.0, 1e-5);
    assert_relative(
        test_scene_area("Rotate 20 1 0 2 Scale 2 3 5 Shape \"disk\" \"float radius\" [2] \"float innerradius\" [1]"),
        PI * 3.0 * 6.0, 1e-6);
    assert_relative(test_scene_area("Scale 1 2 3 " BOX), 2.0 * (2 * 4 + 4 * 6 + 2 * 6), 1e-6);
    /* spheroids: prolate (an egg) and oblate (a lentil) */
    double e = sqrt(1.0 - 1.0 / 9.0);
    assert_relative(test_scene_area("Rotate 20 1 0 2 Scale 1 1 3 Shape \"sphere\""),
                    2.0 * PI * (1.0 + 3.0 / e * asin(e)), 1e-4);
    assert_relative(test_scene_area("Scale 3 1 3 Shape \"sphere\""), 2.0 * PI * (9.0 + atanh(e) / e), 1e-4);
    assert_relative(test_scene_area("Scale 1 2 3 Shape \"sphere\""), thomsen(1, 2, 3), 0.011);
    assert_relative(test_scene_area("Scale 5 0.5 2 Shape \"sphere\" \"float radius\" [2]"), thomsen(10, 1, 4), 0.011);
}

/* --- samples --- */

static bool is_within(vec3 p, vec3 low, vec3 high)
{
    return p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y && p.z >= low.z && p.z <= high.z;
}

static void check_samples(const char *world)
{
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, world);
    const shape *it = &s->shapes[0];
    vec3 low, high, middle = shape_middle(it);
    shape_bounds(it, &low, &high);
    rng random = test_random(1);
    const int count = 20000;
    double inverse = 0.0, square = 0.0;
    vec3 margin = vec3_scale((vec3){1.0f, 1.0f, 1.0f}, 1e-6f * s->bounding_radius + 1e-6f * vec3_max_abs(middle));
    for (int i = 0; i < count; i++) {
        surface_sample at = shape_sample_area(it, rng_vec2(&random));
        assert_true(is_within(at.position, vec3_sub(low, margin), vec3_add(high, margin)));
        assert_close(vec3_length(at.geometric_normal), 1.0, 1e-5);
        assert_true(at.epsilon > 0.0f && at.epsilon < 0.01f * vec3_max_abs(vec3_max(high, vec3_negate(low))));
        assert_relative(shape_pdf_area(it, at.geometric_normal), at.pdf_area, 1e-4);
        inverse += 1.0 / (double)at.pdf_area / count;
        square += 1.0 / (double)at.pdf_area / (double)at.pdf_area / count;
        if (it->kind != SHAPE_DISK) /* closed, convex, and its outside is outside */
            assert_true(vec3_dot(at.geometric_normal, vec3_sub(at.position, middle)) > 0.0f);
        /* a ray straight at it meets it there, from the same side */
        surface_hit hit;
        vec3 from = vec3_add_scaled(at.position, at.geometric_normal, 0.5f);
        bool was_hit = scene_intersect(s, scene_ray_make(from, vec3_negate(at.geometric_normal)), INFINITY, &hit);
        if (!was_hit)
            continue; /* at the very edge of a disk or triangle */
        assert_true(vec3_distance_squared(hit.position, at.position) < 4.0f * at.epsilon * at.epsilon);
        assert_true(vec3_dot(hit.geometric_normal, at.geometric_normal) > 0.99f);
    }
    assert_close(inverse, it->area,
                 5.0 * sqrt(fmax(0.0, square - inverse * inverse) / count) + 1e-4 * (double)it->area);
    scene_destroy(s);
    test_run_reset(&r);
}

static void samples_lie_on_the_surface(void **state)
{
    (void)state;
    for (int i = 0; i < CLOSED_COUNT; i++)
        check_samples(CLOSED[i]);
    for (int i = 0; i < 2; i++)
        check_samples(DISKS[i]);
}

/* Areas of parts get their share: the halves of a sphere, rings of a disk, triangles of a mesh. */
static void samples_are_even(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    rng random = test_random(2);
    const int count = 40000;
    scene *s = test_scene_create(&r, DISKS[0]);
    int inner = 0;
    for (int i = 0; i < count; i++) {
        vec3 p = shape_sample_area(&s->shapes[0], rng_vec2(&random)).position;
        assert_close(p.z, 0.5, 1e-6);
        inner += p.x * p.x + p.y * p.y < 1.0f;
    }
    assert_close(inner, count / 4.0, 4.0 * sqrt(count * 0.25 * 0.75));
    scene_destroy(s);
    s = test_scene_create(&r, "Scale 1 2 3 " LAMP BOX);
    int sides[3] = {0};
    for (int i = 0; i < count; i++) {
        vec3 n = shape_sample_area(&s->shapes[0], rng_vec2(&random)).geometric_normal;
        sides[fabsf(n.x) > 0.9f ? 0 : fabsf(n.y) > 0.9f ? 1 : 2]++;
    }
    assert_close(sides[0], count * 24.0 / 44.0, 4.0 * sqrt(count * 0.25));
    assert_close(sides[1], count * 12.0 / 44.0, 4.0 * sqrt(count * 0.25));
    scene_destroy(s);
    test_run_reset(&r);
}

/* --- normals --- */

static vec3 normal_seen(const char *world, vec3 from, vec3 direction)
{
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, world);
    surface_hit hit;
    assert_true(scene_intersect(s, scene_ray_make(from, direction), INFINITY, &hit));
    assert_true(vec3_dot(hit.geometric_normal, hit.shading_normal) > 0.0f);
    scene_destroy(s);
    test_run_reset(&r);
    return hit.geometric_normal;
}

static void normals_point_outside_unless_turned_over(void **state)
{
    (void)state;
    static const char *const SHAPES[] = {"Shape \"sphere\"", "Scale 1 1 2 Shape \"sphere\"", BOX,
                                         "Shape \"disk\" \"float height\" [1]"};
    static const char *const MIRRORS[] = {"", "Scale -1 1 1 ", "Scale -1 -1 1 ", "Scale -2 -0.5 -1 "};
    vec3 up = {0.0f, 0.0f, 5.0f}, down = {0.01f, 0.02f, -1.0f};
    for (int i = 0; i < 4; i++)
        for (int m = 0; m < 4; m++)
            for (int reversed = 0; reversed < 2; reversed++) {
                char world[512];
                snprintf(world, sizeof world, "%s%s%s", reversed ? "ReverseOrientation " : "", MIRRORS[m], SHAPES[i]);
                vec3 n = normal_seen(world, up, down);
                /* a disk's normal is its z axis; the last mirror turns it away, to be seen from behind */
                double expected = (i == 3 && m == 3 ? -1.0 : 1.0) * (reversed ? -1.0 : 1.0);
                assert_close(n.z, expected, 0.3);
            }
}

/* --- intersections --- */

static vec3 random_around(rng *random, const scene *s, float reach)
{
    return vec3_add_scaled(s->bounding_center, random_direction(random), reach * s->bounding_radius);
}

static void hits_lie_on_the_ray_and_on_the_surface(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    for (int k = 0; k < CLOSED_COUNT + 2; k++) {
        scene *s = test_scene_create(&r, k < CLOSED_COUNT ? CLOSED[k] : DISKS[k - CLOSED_COUNT]);
        const shape *it = &s->shapes[0];
        rng random = test_random(3);
        int hits = 0;
        for (int i = 0; i < 5000; i++) {
            vec3 from = random_around(&random, s, 3.0f);
            vec3 to = vec3_add_scaled(s->bounding_center, random_direction(&random), 0.8f * s->bounding_radius);
            vec3 direction = vec3_normalize(vec3_sub(to, from));
            surface_hit hit;
            if (!scene_intersect(s, scene_ray_make(from, direction), INFINITY, &hit))
                continue;
            hits++;
            double scale = s->bounding_radius + vec3_max_abs(s->bounding_center);
            double slant = fabs((double)vec3_dot(hit.geometric_normal, direction));
            vec3 on_ray = vec3_add_scaled(from, direction, hit.distance);
            assert_close(sqrt(vec3_distance_squared(on_ray, hit.position)), 0.0, 2e-6 * scale / fmax(slant, 1e-3));
            if (it->kind == SHAPE_MESH)
                continue;
            transform back = transform_invert(&it->as.quadric.world_from_object);
            vec3 p = transform_point(&back, hit.position);
            double tolerance = 1e-6 * scale / fmin(1.0, (double)it->as.quadric.radius);
            if (it->kind == SHAPE_SPHERE)
                assert_close(vec3_length(p), it->as.quadric.radius, 4.0 * tolerance);
            else
                assert_close(p.z, it->as.quadric.height, 4.0 * tolerance);
        }
        assert_true(hits > 500);
        scene_destroy(s);
    }
    test_run_reset(&r);
}

/* A ray that leaves a convex shape does not meet it again; one that goes in meets the other side, always. */
static void rays_from_a_surface_do_not_hit_it_again(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    for (int k = 0; k < CLOSED_COUNT + 2; k++) {
        scene *s = test_scene_create(&r, k < CLOSED_COUNT ? CLOSED[k] : DISKS[k - CLOSED_COUNT]);
        rng random = test_random(4);
        for (int i = 0; i < 20000; i++) {
            surface_hit hit, next;
            vec3 from = random_around(&random, s, i % 2 ? 2.0f : 10.0f);
            vec3 direction = vec3_normalize(vec3_sub(random_around(&random, s, 0.9f), from));
            if (!scene_intersect(s, scene_ray_make(from, direction), INFINITY, &hit))
                continue;
            vec3 away = vec3_face_forward(random_direction(&random), vec3_negate(direction));
            away = vec3_face_forward(away, vec3_face_forward(hit.geometric_normal, vec3_negate(direction)));
            vec3 out = surface_ray(&hit, scene_ray_make(hit.position, direction), away).origin;
            assert_false(scene_intersect(s, scene_ray_make(out, away), INFINITY, &next));
            assert_false(scene_occluded(s, scene_ray_make(out, away), INFINITY));
            vec3 in = surface_ray(&hit, scene_ray_make(hit.position, direction), vec3_negate(away)).origin;
            bool is_met = scene_intersect(s, scene_ray_make(in, vec3_negate(away)), INFINITY, &next);
            if (k >= CLOSED_COUNT)
                assert_false(is_met);
            else if (fabsf(vec3_dot(away, hit.geometric_normal)) > 0.02f)
                assert_true(is_met); /* flatter ones may start beyond the far side of a rounded edge */
        }
        scene_destroy(s);
    }
    test_run_reset(&r);
}

/* Embree's own sphere, and ours in double precision. */
static void native_spheres_and_quadrics_agree(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    for (int k = 0; k < 3; k++) {
        scene *s = test_scene_create(&r, CLOSED[k]);
        const shape *it = &s->shapes[0];
        assert_true(it->as.quadric.uniform_radius > 0.0f);
        rng random = test_random(5);
        int hits = 0, differ = 0;
        for (int i = 0; i < 20000; i++) {
            bool inside = i % 3 == 0;
            vec3 from = random_around(&random, s, inside ? 0.3f : 3.0f);
            vec3 direction =
                inside ? random_direction(&random) : vec3_normalize(vec3_sub(random_around(&random, s, 0.8f), from));
            surface_hit hit;
            float t;
            bool a = scene_intersect(s, scene_ray_make(from, direction), INFINITY, &hit);
            bool b = shape_intersect_quadric(it, from, direction, 0.0f, INFINITY, &t);
            differ += a != b; /* at the very silhouette */
            if (!a || !b)
                continue;
            hits++;
            double slant = fabs((double)vec3_dot(hit.geometric_normal, direction));
            double scale = s->bounding_radius + vec3_max_abs(s->bounding_center);
            assert_close(hit.distance, t, 2e-6 * scale / fmax(slant, 1e-3));
        }
        assert_true(hits > 8000 && differ <= 4);
        scene_destroy(s);
    }
    test_run_reset(&r);
}

static void quadric_intersections_respect_their_interval(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    scene *s =
        test_scene_create(&r, "Shape \"sphere\" \"float radius\" [2] Shape \"disk\" \"float innerradius\" [0.5]");
    vec3 from = {0.0f, 0.0f, -5.0f}, z = {0.0f, 0.0f, 1.0f};
    float t;
    assert_true(shape_intersect_quadric(&s->shapes[0], from, z, 0.0f, INFINITY, &t) && t == 3.0f);
    assert_true(shape_intersect_quadric(&s->shapes[0], from, z, 3.5f, INFINITY, &t) && t == 7.0f);
    assert_false(shape_intersect_quadric(&s->shapes[0], from, z, 0.0f, 2.9f, &t));
    assert_false(shape_intersect_quadric(&s->shapes[0], from, z, 7.5f, INFINITY, &t));
    assert_false(shape_intersect_quadric(&s->shapes[0], from, vec3_negate(z), 0.0f, INFINITY, &t));
    assert_false(shape_intersect_quadric(&s->shapes[0], from, (vec3){0.0f, 1.0f, 0.0f}, 0.0f, INFINITY, &t));
    /* through the hole, on the ring, past it, along it; an unnormalised direction counts in its own lengths */
    assert_false(shape_intersect_quadric(&s->shapes[1], from, z, 0.0f, INFINITY, &t));
    vec3 beside = {0.7f, 0.0f, -5.0f};
    assert_true(shape_intersect_quadric(&s->shapes[1], beside, z, 0.0f, INFINITY, &t) && t == 5.0f);
    assert_true(shape_intersect_quadric(&s->shapes[1], beside, vec3_scale(z, 2.0f), 0.0f, INFINITY, &t) && t == 2.5f);
    assert_false(shape_intersect_quadric(&s->shapes[1], (vec3){1.1f, 0.0f, -5.0f}, z, 0.0f, INFINITY, &t));
    assert_false(shape_intersect_quadric(&s->shapes[1], (vec3){5.0f, 0.0f, 0.0f}, (vec3){-1.0f, 0.0f, 0.0f}, 0.0f,
                                         INFINITY, &t));
    scene_destroy(s);
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(areas_have_their_closed_forms),
        cmocka_unit_test(samples_lie_on_the_surface),
        cmocka_unit_test(samples_are_even),
        cmocka_unit_test(normals_point_outside_unless_turned_over),
        cmocka_unit_test(hits_lie_on_the_ray_and_on_the_surface),
        cmocka_unit_test(rays_from_a_surface_do_not_hit_it_again),
        cmocka_unit_test(native_spheres_and_quadrics_agree),
        cmocka_unit_test(quadric_intersections_respect_their_interval),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
