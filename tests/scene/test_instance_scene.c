/* test_instance_scene.c: what instances add to a scene: bounds, areas, the names that hits tell, and maps that are
 * refused. Threads: the build's. */
#include "fixtures/test_scene.h"

#include "scene_extent.h"

#define BALL      "Shape \"sphere\" \"float radius\" .8 "
#define ELLIPSOID "Scale 1 .5 2 Shape \"sphere\" "

static void bounds_and_area_count_instances(void **state)
{
    (void)state;
#define BOX                                                                                                            \
    "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 -1 1 -1 -1 -1 1 -1 1 1 -1] "                                           \
    "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 -1 -1 -1 1 -1 1 -1 -1 1 1] "                                           \
    "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 -1 1 -1 -1 -1 -1 1 1 -1 1] "
    static const char *const INSIDE[] = {BOX, BALL, ELLIPSOID, BOX BALL};
    static const double TOLERANCES[] = {1e-5, 0.01, 0.02, 0.01};
    test_run r;
    test_run_init(&r, 1);
    for (int k = 0; k < 4; k++) {
        char text[4096];
        snprintf(text, sizeof text,
                 "Translate 9 0 0 Shape \"sphere\" Identity AttributeBegin Scale 10 .1 1 %s AttributeEnd "
                 "AttributeBegin Translate 0 0 7 Scale 3 3 -3 %s AttributeEnd",
                 INSIDE[k], INSIDE[k]);
        scene *moved = test_scene_create(&r, text);
        snprintf(text, sizeof text,
                 "ObjectBegin \"a\" %s ObjectEnd ObjectBegin \"unseen\" Scale 1e9 1e9 1e9 Shape \"sphere\" ObjectEnd "
                 "Translate 9 0 0 Shape \"sphere\" Identity AttributeBegin Scale 10 .1 1 ObjectInstance \"a\" "
                 "AttributeEnd AttributeBegin Translate 0 0 7 Scale 3 3 -3 ObjectInstance \"a\" AttributeEnd",
                 INSIDE[k]);
        scene *instanced = test_scene_create(&r, text);
        assert_relative(instanced->surface_area, moved->surface_area, TOLERANCES[k]);
        expect_near_point(instanced->bounds_min, moved->bounds_min, 1e-4f);
        expect_near_point(instanced->bounds_max, moved->bounds_max, 1e-4f);
        scene_destroy(moved);
        scene_destroy(instanced);
    }
    /* wherever it goes */
    scene *s = test_scene_create(&r, "ActiveTransform EndTime Translate 10 0 0 Shape \"sphere\"");
    expect_near_point(s->bounds_min, (vec3){-1.0f, -1.0f, -1.0f}, 1e-4f);
    expect_near_point(s->bounds_max, (vec3){11.0f, 1.0f, 1.0f}, 1e-4f);
    assert_relative(s->surface_area, 4 * PI, 1e-3);
    scene_destroy(s);
    test_run_reset(&r);
}

static bool is_disk(const scene *s, const shape *item)
{
    (void)s;
    return item->kind == SHAPE_DISK;
}

static void bounds_of_some_shapes(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    vec3 low, high;
    scene *s = test_scene_create(&r, "ObjectBegin \"a\" Shape \"disk\" Translate 0 0 5 Shape \"sphere\" ObjectEnd "
                                     "Translate 3 0 0 ObjectInstance \"a\" Shape \"sphere\" \"float radius\" 9");
    assert_int_equal(scene_find_bounds(s, is_disk, &low, &high), AG_OK);
    expect_near_point(low, (vec3){2.0f, -1.0f, 0.0f}, 1e-4f);
    expect_near_point(high, (vec3){4.0f, 1.0f, 0.0f}, 1e-4f);
    scene_destroy(s);
    s = test_scene_create(&r, "ObjectBegin \"a\" Shape \"disk\" ObjectEnd Shape \"sphere\"");
    assert_int_equal(scene_find_bounds(s, is_disk, &low, &high), AG_OK);
    assert_true(low.x > high.x); /* it is nowhere */
    scene_destroy(s);
    test_run_reset(&r);
}

/* A grid of instances of two objects, some of them of more than one shape, among shapes of the world's own. */
static void every_hit_names_its_shape_and_instance(void **state)
{
    (void)state;
    enum { N = 8 };
    static char text[40000];
    size_t used = (size_t)snprintf(
        text, sizeof text,
        "Translate 0 0 100 Shape \"sphere\" Identity\n" /* shape 0 */
        "ObjectBegin \"a\" Shape \"sphere\" \"float radius\" .3 Translate 0 0 1 Shape \"disk\" \"float radius\" .2 "
        "ObjectEnd\nObjectBegin \"none\" ObjectEnd ObjectInstance \"none\"\n" /* shapes 1, 2; instance 0 */
        "Translate 0 0 -100 Shape \"disk\" Identity\n"                        /* shape 3 */
        "ObjectBegin \"b\" Shape \"disk\" \"float radius\" .2 ObjectEnd\n");  /* shape 4 */
    for (int i = 0; i < N * N; i++)
        used += (size_t)snprintf(text + used, sizeof text - used,
                                 "AttributeBegin Translate %d %d 0 ObjectInstance \"%s\" AttributeEnd\n", i % N, i / N,
                                 (i + i / N) % 2 ? "b" : "a");
    static const unsigned WORKERS[] = {1, 2, 3, 8};
    static surface_hit first[2 * N * N], hits[2 * N * N];
    for (size_t w = 0; w < sizeof WORKERS / sizeof *WORKERS; w++) {
        test_run r;
        test_run_init(&r, WORKERS[w]);
        scene *s = test_scene_create(&r, text);
        assert_int_equal(s->instance_count, 1 + N * N);
        memset(hits, 0, sizeof hits);
        for (int i = 0; i < N * N; i++)
            for (int side = 0; side < 2; side++) {
                surface_hit *hit = &hits[2 * i + side];
                float z = side ? 3.0f : -3.0f;
                bool is_b = (i + i / N) % 2;
                vec3 from = {(float)(i % N) + 0.1f, (float)(i / N), z};
                assert_true(scene_intersect(s, scene_ray_make(from, (vec3){0.0f, 0.0f, -z}), 1.5f, hit));
                assert_int_equal(hit->instance_index, 1 + i);
                assert_int_equal(hit->shape_index, is_b ? 4 : side ? 2 : 1);
            }
        if (w == 0)
            memcpy(first, hits, sizeof hits);
        assert_memory_equal(hits, first, sizeof hits);
        surface_hit hit;
        assert_true(
            scene_intersect(s, scene_ray_make((vec3){-0.5f, -0.5f, 0.0f}, (vec3){0.0f, 0.0f, -1.0f}), INFINITY, &hit));
        assert_true(hit.shape_index == 3 && hit.instance_index == SCENE_NO_INSTANCE);
        scene_destroy(s);
        test_run_reset(&r);
    }
}

static void what_cannot_be_undone_is_refused(void **state)
{
    (void)state;
    scene *s = scene_create();
    assert_non_null(s);
    uint32_t object, index;
    assert_int_equal(scene_add_object(s, &object), AG_OK);
    affine good = {{{1.0f, 0.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f, 0.0f}}};
    affine flat = good, endless = good;
    flat.m[2][2] = 0.0f;
    endless.m[0][3] = INFINITY;
    affine steps[2] = {good, flat};
    assert_int_equal(scene_add_instance(s, object, &flat, 1, &index), AG_ERROR_SCENE);
    assert_int_equal(scene_add_instance(s, object, &endless, 1, &index), AG_ERROR_SCENE);
    assert_int_equal(scene_add_instance(s, object, steps, 2, &index), AG_ERROR_SCENE);
    assert_int_equal(s->instance_count, 0);
    assert_int_equal(scene_add_instance(s, object, &good, 1, &index), AG_OK);
    assert_int_equal(index, 0);
    scene_destroy(s);
    /* beyond what floats can square, in the world or in the instance's space, where Embree asserts */
    static const struct {
        const char *text, *said;
    } CASES[] = {
        {"WorldBegin ObjectBegin \"a\" Shape \"sphere\" ObjectEnd Scale 1e10 1e10 1e10 Translate 1e10 0 0 "
         "ObjectInstance \"a\"",
         "an instance reaches beyond 1e18 units in world space"},
        {"WorldBegin Shape \"sphere\" \"float radius\" 1e16 ObjectBegin \"a\" Shape \"sphere\" ObjectEnd "
         "Scale 1 1 .005 ObjectInstance \"a\"",
         "an instance of object \"a\" is so small, or so flat, that the scene reaches beyond 1e18 units in its space"},
        {"Translate 0 0 1e16 Camera \"perspective\" WorldBegin ObjectBegin \"a\" Shape \"sphere\" ObjectEnd "
         "Scale 1 1 .005 ObjectInstance \"a\"",
         "an instance of object \"a\" is so small"},
        {"Translate 0 0 1e19 Camera \"perspective\" WorldBegin ObjectBegin \"a\" Shape \"sphere\" ObjectEnd "
         "ObjectInstance \"a\"",
         "its camera lies beyond 1e18 units in world space"},
    };
    test_run r;
    test_run_init(&r, 1);
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        s = scene_create();
        assert_int_equal(pbrt_parse_text(&r.run, "t", CASES[i].text, strlen(CASES[i].text), s), AG_OK);
        assert_int_equal(scene_commit(s, &r.run, NULL), AG_ERROR_SCENE);
        assert_non_null(strstr(r.said, CASES[i].said));
        scene_destroy(s);
    }
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bounds_and_area_count_instances),
        cmocka_unit_test(bounds_of_some_shapes),
        cmocka_unit_test(every_hit_names_its_shape_and_instance),
        cmocka_unit_test(what_cannot_be_undone_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
