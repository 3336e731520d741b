/* test_clear_space.c: what a clear space tells of rays is what casting them tells, among all kinds of shapes; and it
 * tells much. Threads: one. */
#include "rays/clear_space.h"

#include "rays/transmittance.h"
#include "shape/alpha.h"

#include "fixtures/test_scene.h"

/* A closed box of 10 x 10 x 10. In it, above the floor of y = 0: spheres, of which one goes through the floor; a disk,
 * an ellipsoid, a tent, a plate that stands on the floor, and one with holes that lies on it. */
static const char ROOM[] =
    "Shape \"bilinearmesh\" \"point3 P\" [0 0 0  10 0 0  0 0 10  10 0 10]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [0 10 0  10 10 0  0 10 10  10 10 10]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [0 0 0  0 10 0  0 0 10  0 10 10]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [10 0 0  10 10 0  10 0 10  10 10 10]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [0 0 0  10 0 0  0 10 0  10 10 0]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [0 0 10  10 0 10  0 10 10  10 10 10]\n"
    "Shape \"trianglemesh\" \"point3 P\" [6 0 2  9 0 2  9 0 5  7.5 2 3.5] \"integer indices\" [0 1 3 1 2 3 2 0 3]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [2 0 7  4 0 8  2 3 7  4 3 8]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [1 0.00001 1  3 0.00001 1  1 0.00001 3  3 0.00001 3] \"float alpha\" 0.5\n"
    "AttributeBegin Translate 3 3 4 Shape \"sphere\" \"float radius\" 1.5 AttributeEnd\n"
    "AttributeBegin Translate 5.5 2.5 5 Shape \"sphere\" \"float radius\" 0.9 AttributeEnd\n"
    "AttributeBegin Translate 7 0.2 7 Shape \"sphere\" \"float radius\" 0.8 AttributeEnd\n"
    "AttributeBegin Translate 7.5 6 7 Scale 1.5 0.8 1 Shape \"sphere\" AttributeEnd\n"
    "AttributeBegin Translate 3 7 7 Rotate 70 1 0 0 Shape \"disk\" \"float radius\" 1.2 AttributeEnd\n";

/* A point on a surface in the room, with the normal of its clear side. */
static void random_point(const scene *s, rng *random, vec3 *out_position, vec3 *out_normal)
{
    surface_hit hit;
    vec3 from = {9.0f * rng_float(random) + 0.5f, 9.0f * rng_float(random) + 0.5f, 9.0f * rng_float(random) + 0.5f};
    vec3 direction = random_direction(random);
    assert_true(scene_find_surface(s, scene_ray_make(from, direction), INFINITY, &hit));
    *out_position = hit.position;
    *out_normal = vec3_face_forward(hit.geometric_normal, vec3_negate(direction));
}

static void answers_are_those_of_rays(void **state)
{
    (void)state;
    enum { POINTS = 4000 / FEWER, RAYS = 24 };
    static const float RADIUS = 2.5f, MIN_COS = 0.5f;
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, ROOM);
    rng random = test_random(5);
    uint64_t free_lines = 0, known_lines = 0, met = 0, known_met = 0;
    for (int i = 0; i < POINTS; i++) {
        vec3 at, normal;
        clear_space space;
        random_point(s, &random, &at, &normal);
        clear_space_find(s, at, normal, RADIUS, &space);
        assert_true(space.radius >= 0.0f && space.radius <= RADIUS);
        for (int k = 0; k < RAYS; k++) {
            /* lines near the surface, and any */
            float reach = RADIUS * rng_float(&random), lift = k % 2 ? 0.02f * reach : reach;
            vec3 from = vec3_add_scaled(vec3_add_scaled(at, normal, lift), random_direction(&random), reach),
                 to = vec3_add_scaled(vec3_add_scaled(at, normal, lift), random_direction(&random), reach);
            bool is_free = !scene_is_blocked(s, scene_ray_make(from, vec3_sub(to, from)), 1.0f);
            bool is_known = clear_space_has_line(s, &space, from, to);
            assert_true(is_free || !is_known);
            free_lines += is_free, known_lines += is_known;

            /* rays down onto the surface, and any */
            surface_hit hit;
            vec3 down = k % 2 ? vec3_negate(normal) : random_direction(&random);
            from = vec3_add_scaled(vec3_add_scaled(at, normal, 0.1f * reach), random_direction(&random), 0.09f * reach);
            bool meets = scene_find_surface(s, scene_ray_make(from, down), reach, &hit) &&
                         fabsf(vec3_dot(hit.geometric_normal, down)) > MIN_COS;
            is_known = clear_space_ends_ray(s, &space, from, down, reach, MIN_COS);
            assert_true(meets || !is_known);
            assert_true(!is_known || shape_is_opaque(&s->shapes[hit.shape_index]));
            met += meets, known_met += is_known;
        }
    }
    print_message("known: %.3f of the free lines, %.3f of the rays that meet something\n",
                  (double)known_lines / (double)free_lines, (double)known_met / (double)met);
    assert_true((double)known_lines > 0.4 * (double)free_lines);
    assert_true((double)known_met > 0.4 * (double)met);
    scene_destroy(s);
    test_run_reset(&r);
}

static void nothing_is_known_where_not_all_can_be_found(void **state)
{
    (void)state;
    static const char FLOOR[] = "Shape \"bilinearmesh\" \"point3 P\" [0 0 0  10 0 0  0 0 10  10 0 10]\n";
    static const char *const BESIDE[] = {
        "", /* there it is */
        "Shape \"curve\" \"point3 P\" [8 1 8  8 2 8  8 3 8  8 4 8] \"float width\" 0.1\n",
        "ObjectBegin \"ball\" Shape \"sphere\" ObjectEnd Translate 8 3 8 ObjectInstance \"ball\"\n"};
    test_run r;
    test_run_init(&r, 1);
    for (size_t i = 0; i < sizeof BESIDE / sizeof *BESIDE; i++) {
        char text[1000];
        snprintf(text, sizeof text, "%s%s", FLOOR, BESIDE[i]);
        scene *s = test_scene_create(&r, text);
        clear_space space;
        clear_space_find(s, (vec3){3.0f, 0.0f, 2.0f}, (vec3){0.0f, 1.0f, 0.0f}, 1.0f, &space);
        assert_int_equal(space.radius > 0.9f, i == 0);
        assert_true(i == 0 || space.radius == 0.0f);
        /* nor off any surface */
        clear_space_find(s, (vec3){3.0f, 0.1f, 2.0f}, (vec3){0.0f, 1.0f, 0.0f}, 1.0f, &space);
        assert_true(space.radius == 0.0f);
        scene_destroy(s);
    }
    test_run_reset(&r);
}

/* More spheres than are looked through one by one; a tessellation of more triangles than a query looks at. */
static void crowds_are_left_alone(void **state)
{
    (void)state;
    enum { SPHERES = 65, CELLS = 40 };
    test_run r;
    test_run_init(&r, 1);
    char *text = malloc(200000), *end = text;
    assert_non_null(text);
    end += sprintf(end, "Shape \"bilinearmesh\" \"point3 P\" [0 0 0  10 0 0  0 0 10  10 0 10]\n");
    for (int i = 0; i < SPHERES; i++)
        end += sprintf(end, "AttributeBegin Translate %d 5 0 Shape \"sphere\" AttributeEnd\n", 3 * i);
    scene *s = test_scene_create(&r, text);
    clear_space space;
    clear_space_find(s, (vec3){3.0f, 0.0f, 2.0f}, (vec3){0.0f, 1.0f, 0.0f}, 1.0f, &space);
    assert_true(space.radius == 0.0f);
    scene_destroy(s);

    end = text;
    end += sprintf(end, "Shape \"trianglemesh\" \"point3 P\" [");
    for (int i = 0; i <= CELLS; i++)
        for (int k = 0; k <= CELLS; k++)
            end += sprintf(end, "%d 0 %d ", i, k);
    end += sprintf(end, "] \"integer indices\" [");
    for (int i = 0; i < CELLS; i++)
        for (int k = 0; k < CELLS; k++) {
            int a = i * (CELLS + 1) + k, b = a + CELLS + 1;
            end += sprintf(end, "%d %d %d %d %d %d ", a, a + 1, b, b, a + 1, b + 1);
        }
    sprintf(end, "]");
    s = test_scene_create(&r, text);
    clear_space_find(s, (vec3){20.3f, 0.0f, 20.3f}, (vec3){0.0f, 1.0f, 0.0f}, 16.0f, &space);
    assert_true(space.radius > 0.9f && space.radius < 4.0f); /* of what is less far, all the same */
    free(text);
    scene_destroy(s);
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(answers_are_those_of_rays),
        cmocka_unit_test(nothing_is_known_where_not_all_can_be_found),
        cmocka_unit_test(crowds_are_left_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
