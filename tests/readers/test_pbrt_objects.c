/* test_pbrt_objects.c: objects, instances and the two ends of the current transform, as the reader hands them to the
 * scene. Threads: one. */
#include "fixtures/pbrt_fixture.h"

#include "rays/rays.h"
#include "scene.h"

#define TRIANGLE "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"normal N\" [0 0 1 0 1 1 1 0 1] "

static void check_errors(const char *const *cases, size_t count)
{
    for (size_t i = 0; i < count; i += 2) {
        reading r = reading_create(NULL, cases[i], strlen(cases[i]));
        if (r.status != AG_ERROR_SCENE || r.count[AG_LOG_ERROR] != 1 || !strstr(r.said[AG_LOG_ERROR], cases[i + 1]))
            fail_msg("%s: status %d, said %s", cases[i], (int)r.status,
                     r.said[AG_LOG_ERROR] ? r.said[AG_LOG_ERROR] : "nothing");
        reading_destroy(&r);
    }
}

static void errors_say_what_is_wrong(void **state)
{
    (void)state;
    static const char *const CASES[] = {
        "WorldBegin\nObjectInstance \"a\" ObjectInstance \"b\"",
        "t:2:1: error: no object is named \"a\"",
        "WorldBegin ObjectBegin \"a\" ObjectEnd\nObjectBegin \"a\" ObjectEnd",
        "t:2:1: error: object \"a\" is there already, from t:1:12",
        "WorldBegin ObjectBegin \"a\" ObjectBegin \"b\"",
        "t:1:28: error: ObjectBegin within another object",
        "WorldBegin ObjectBegin \"a\" ObjectInstance \"a\"",
        "t:1:28: error: ObjectInstance within an object",
        "WorldBegin ObjectEnd",
        "t:1:12: error: ObjectEnd without ObjectBegin",
        "WorldBegin ObjectBegin \"a\" Shape \"disk\" ObjectEnd Scale 1e-30 1e-30 1e-30\nObjectInstance \"a\"",
        "t:2:1: error: ObjectInstance: the transform cannot be undone",
        "WorldBegin ObjectBegin \"a\" ObjectEnd ConcatTransform [1 0 0 .1 0 1 0 0 0 0 1 0 0 0 0 1]\nObjectInstance "
        "\"a\"",
        "t:2:1: error: ObjectInstance: the transform cannot be undone: it is not affine",
        /* that mistake where the object comes after its instance */
        "WorldBegin Scale 1e-30 1e-30 1e-30\nObjectInstance \"a\" ObjectBegin \"a\" Shape \"disk\" ObjectEnd",
        "t:2:1: error: ObjectInstance: the transform cannot be undone",
        "WorldBegin ObjectBegin \"a\" ObjectEnd ActiveTransform EndTime Scale -1 1 1\nObjectInstance \"a\"",
        "t:2:1: error: ObjectInstance moves by way of a transform that cannot be undone",
        "WorldBegin ActiveTransform EndTime Scale -1 1 1\nShape \"disk\"",
        "t:2:1: error: Shape moves by way of a transform that cannot be undone",
        "ActiveTransform StartTime Scale -1 1 1\nCamera \"perspective\" WorldBegin",
        "t:2:1: error: Camera moves by way of a transform that cannot be undone",
        "TransformTimes 1 1 WorldBegin",
        "t:1:1: error: TransformTimes 1 1: the end should be later",
        "Scale 0 1 1 WorldBegin",
        "cannot be undone",
        "WorldBegin ObjectBegin \"a\" AreaLightSource \"diffuse\" Shape \"disk\" ObjectEnd Scale 1e20 1e20 "
        "1\nObjectInstance \"a\"",
        "t:2:1: error: a lamp of object \"a\" reaches beyond 1e18 units",
        "WorldBegin ActiveTransform All ActiveTransform Start",
        "ActiveTransform expects StartTime, EndTime or All",
    };
    check_errors(CASES, sizeof CASES / sizeof *CASES);
}

static affine step_of(const reading *r, uint32_t instance, uint32_t step)
{
    assert_true(instance < r->scene->instance_count);
    assert_true(step < r->scene->instances[instance].step_count);
    return r->scene->instance_steps[r->scene->instances[instance].first_step + step];
}

/* Fails unless the origin of the object comes to lie there. */
static void check_step(const reading *r, uint32_t instance, uint32_t step, double x, double y, double z)
{
    affine a = step_of(r, instance, step);
    assert_vec3(affine_point(&a, vec3_make(0, 0, 0)), x, y, z, 1e-5);
}

static void objects_are_kept_once(void **state)
{
    (void)state;
    reading r = reading_of("WorldBegin Translate 1 0 0 ObjectBegin \"a\" Translate 0 2 0 Shape \"sphere\" " TRIANGLE
                           "ObjectEnd Shape \"disk\" ObjectInstance \"a\" Translate 0 0 3 ObjectInstance \"a\"\n"
                           "ObjectBegin \"empty\" ObjectEnd ObjectInstance \"empty\"");
    const scene *s = r.scene;
    assert_int_equal(s->shape_count, 3);
    assert_int_equal(s->object_count, 2);
    assert_int_equal(s->shapes[0].object_index, 0);
    assert_int_equal(s->shapes[1].object_index, 0);
    assert_int_equal(s->shapes[2].object_index, SCENE_NO_OBJECT);
    /* the object's shapes lie where they would in the world, the transform of its instances comes on top */
    assert_vec3(transform_point(&s->shapes[0].as.quadric.world_from_object, vec3_make(0, 0, 0)), 1, 2, 0, 0);
    assert_vec3(transform_point(&s->shapes[2].as.quadric.world_from_object, vec3_make(0, 0, 0)), 1, 0, 0, 0);
    assert_int_equal(s->instance_count, 3);
    check_step(&r, 0, 0, 1, 0, 0);
    check_step(&r, 1, 0, 1, 0, 3);
    assert_int_equal(s->instances[2].object_index, 1);
    assert_int_equal(s->instance_step_count, 3);
    reading_destroy(&r);
}

static void instances_may_come_first(void **state)
{
    (void)state;
    reading r =
        reading_of("WorldBegin Translate 4 5 6 ObjectInstance \"b\" ObjectBegin \"a\" Shape \"disk\" ObjectEnd\n"
                   "ObjectInstance \"a\" ObjectBegin \"b\" Shape \"sphere\" ObjectEnd");
    assert_int_equal(r.scene->instance_count, 2);
    check_step(&r, 1, 0, 4, 5, 6);
    assert_int_equal(r.scene->instances[1].object_index, r.scene->shapes[1].object_index);
    assert_int_equal(r.scene->shapes[1].kind, SHAPE_SPHERE);
    reading_destroy(&r);
}

static void state_returns_at_the_end_of_an_object(void **state)
{
    (void)state;
    reading r = reading_of("WorldBegin ObjectBegin \"a\" ReverseOrientation Translate 9 9 9 Material \"conductor\"\n"
                           "Shape \"sphere\" ObjectEnd Shape \"sphere\"");
    const shape *s = r.scene->shapes;
    assert_true(s[0].flip_normal && !s[1].flip_normal);
    assert_int_not_equal(s[0].material_index, s[1].material_index);
    assert_vec3(transform_point(&s[1].as.quadric.world_from_object, vec3_make(0, 0, 0)), 0, 0, 0, 0);
    reading_destroy(&r);
}

/* Shapes that shine are copied: shape and light are as if they stood there without an object. */
static void lamps_within_objects_come_into_the_world(void **state)
{
    (void)state;
    static const char *const INSIDE[] = {"Translate 1 1 1 " TRIANGLE, "Scale 1 2 3 Shape \"sphere\" "};
    for (int k = 0; k < 2; k++)
        for (int mirror = 0; mirror < 2; mirror++) {
            char text[1024], placement[128];
            snprintf(placement, sizeof placement, "Rotate 40 1 2 3 Scale 2 %d 3 ", mirror ? -1 : 1);
            snprintf(
                text, sizeof text,
                "WorldBegin ObjectBegin \"a\" Shape \"disk\" AreaLightSource \"diffuse\" \"rgb L\" [ 1 2 3 ] \"float "
                "power\" 10 %s ObjectEnd AttributeBegin %s ObjectInstance \"a\" AttributeEnd ObjectInstance \"a\"",
                INSIDE[k], placement);
            reading r = reading_of(text);
            assert_int_equal(r.count[AG_LOG_INFO], 1);
            assert_non_null(strstr(r.said[AG_LOG_INFO], "shapes that shine within an object are copied"));
            snprintf(
                text, sizeof text,
                "WorldBegin AreaLightSource \"diffuse\" \"rgb L\" [ 1 2 3 ] \"float power\" 10 AttributeBegin %s %s "
                "AttributeEnd %s",
                placement, INSIDE[k], INSIDE[k]);
            reading by_hand = reading_of(text);
            assert_int_equal(r.scene->shape_count, 3);
            assert_int_equal(r.scene->light_count, 2);
            assert_int_equal(r.scene->shapes[0].kind, SHAPE_DISK);
            assert_int_equal(r.scene->instance_count, 2);
            for (uint32_t i = 0; i < 2; i++) {
                shape *a = &r.scene->shapes[1 + i], *b = &by_hand.scene->shapes[i];
                assert_int_equal(a->object_index, SCENE_NO_OBJECT);
                assert_int_equal(a->light_index, i);
                assert_int_equal(r.scene->lights[i].as.area.shape_index, 1 + i);
                assert_int_equal(a->flip_normal, b->flip_normal);
                rgb l = by_hand.scene->lights[i].as.area.radiance;
                assert_rgb(r.scene->lights[i].as.area.radiance, l.r, l.g, l.b, 1e-4);
                assert_int_equal(shape_commit(a), AG_OK);
                assert_int_equal(shape_commit(b), AG_OK);
                for (int u = 0; u < 25; u++) {
                    vec2 at = {(float)(u % 5) * 0.2f + 0.1f, (float)(u / 5) * 0.2f + 0.1f};
                    surface_sample x = shape_sample_area(a, at), y = shape_sample_area(b, at);
                    assert_vec3(x.position, y.position.x, y.position.y, y.position.z, 1e-5);
                    assert_vec3(x.geometric_normal, y.geometric_normal.x, y.geometric_normal.y, y.geometric_normal.z,
                                1e-5);
                }
                for (uint32_t v = 0; k == 0 && v < 3; v++) {
                    vec3 n = b->as.mesh.normals[v];
                    assert_vec3(a->as.mesh.normals[v], n.x, n.y, n.z, 1e-5);
                }
            }
            reading_destroy(&r);
            reading_destroy(&by_hand);
        }
}

static void lamps_within_objects_have_a_limit(void **state)
{
    (void)state;
    enum { COUNT = 300 };
    char *text = malloc(COUNT * 64);
    assert_non_null(text);
    size_t used = (size_t)sprintf(text, "WorldBegin AreaLightSource \"diffuse\" ObjectBegin \"a\"");
    for (int i = 0; i < COUNT; i++)
        used += (size_t)sprintf(text + used, " Shape \"sphere\"");
    used += (size_t)sprintf(text + used, " ObjectEnd\n");
    for (int i = 0; i < COUNT; i++)
        used += (size_t)sprintf(text + used, "ObjectInstance \"a\"\n");
    reading r = reading_create(NULL, text, used);
    assert_int_equal(r.status, AG_ERROR_SCENE);
    assert_non_null(strstr(r.said[AG_LOG_ERROR],
                           "t:220:1: error: too many lamps come from the instances of objects: more than "
                           "65536"));
    reading_destroy(&r);
    free(text);
}

/* --- motion --- */

static void transforms_have_two_ends(void **state)
{
    (void)state;
    /* a sphere that moves is an instance of an object in its own space */
    reading r =
        reading_of("WorldBegin ActiveTransform EndTime Translate 5 0 0 ActiveTransform StartTime Translate 1 0 0\n"
                   "ActiveTransform All Translate 0 1 0 Shape \"sphere\" \"float radius\" 2");
    assert_int_equal(r.scene->instance_count, 1);
    assert_int_equal(r.scene->shape_count, 1);
    assert_int_equal(r.scene->shapes[0].object_index, r.scene->instances[0].object_index);
    assert_vec3(transform_point(&r.scene->shapes[0].as.quadric.world_from_object, vec3_make(0, 0, 0)), 0, 0, 0, 0);
    assert_int_equal(r.scene->instances[0].step_count, 2);
    check_step(&r, 0, 0, 1, 1, 0);
    check_step(&r, 0, 1, 5, 1, 0);
    reading_destroy(&r);
    /* blocks and coordinate systems keep both; Identity and Transform set what is active */
    r = reading_of(
        "WorldBegin AttributeBegin ActiveTransform EndTime Translate 5 0 0 CoordinateSystem \"c\" AttributeEnd\n"
        "Shape \"disk\" AttributeBegin CoordSysTransform \"c\" Translate 0 2 0 Shape \"disk\" AttributeEnd\n"
        "Translate 0 0 9 Shape \"disk\" ActiveTransform EndTime Identity Shape \"disk\"\n"
        "ActiveTransform All Transform [1 0 0 0 0 1 0 0 0 0 1 0 7 8 9 1] Shape \"disk\"");
    assert_int_equal(r.scene->shape_count, 5);
    assert_int_equal(r.scene->instance_count, 2);
    check_step(&r, 0, 0, 0, 2, 0);
    check_step(&r, 0, 1, 5, 2, 0);
    check_step(&r, 1, 0, 0, 0, 9);
    check_step(&r, 1, 1, 0, 0, 0);
    assert_vec3(transform_point(&r.scene->shapes[4].as.quadric.world_from_object, vec3_make(0, 0, 0)), 7, 8, 9, 0);
    reading_destroy(&r);
    /* moving instances, of a shape that moves by itself as well */
    r = reading_of(
        "WorldBegin ObjectBegin \"a\" Shape \"disk\" ActiveTransform EndTime Translate 0 1 0 Shape \"sphere\"\n"
        "ActiveTransform All ObjectEnd Translate 0 0 1 ObjectInstance \"a\" ActiveTransform EndTime\n"
        "Translate 3 0 0 ObjectInstance \"a\"");
    assert_int_equal(r.scene->instance_count, 4);
    assert_int_equal(r.scene->instances[0].step_count, 1);
    check_step(&r, 1, 1, 0, 1, 1);
    assert_int_equal(r.scene->instances[1].object_index, r.scene->shapes[1].object_index);
    check_step(&r, 2, 1, 3, 0, 1);
    check_step(&r, 3, 0, 0, 0, 1);
    check_step(&r, 3, 1, 3, 1, 1);
    reading_destroy(&r);
}

static void the_shutter_sees_its_part_of_the_motion(void **state)
{
    (void)state;
    static const struct {
        const char *times, *shutter;
        double from, to;
    } CASES[] = {{"", "", 0, 8},
                 {"", "\"float shutteropen\" .25 \"float shutterclose\" .5", 2, 4},
                 {"TransformTimes 0 2", "", 0, 4},
                 {"TransformTimes 10 12", "\"float shutteropen\" 10.5 \"float shutterclose\" 11.5", 2, 6}};
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        char text[512];
        snprintf(text, sizeof text,
                 "%s Camera \"perspective\" %s WorldBegin ActiveTransform EndTime Translate 8 0 0 Shape \"disk\"",
                 CASES[i].times, CASES[i].shutter);
        reading r = reading_of(text);
        check_step(&r, 0, 0, CASES[i].from, 0, 0);
        check_step(&r, 0, 1, CASES[i].to, 0, 0);
        reading_destroy(&r);
    }
    /* what has yet to begin, and what has come to rest before: at rest */
    static const char *const STILL[] = {"\"float shutteropen\" -1 \"float shutterclose\" 0",
                                        "\"float shutteropen\" 1 \"float shutterclose\" 3"};
    for (int i = 0; i < 2; i++) {
        char text[512];
        snprintf(text, sizeof text,
                 "Camera \"perspective\" %s WorldBegin ActiveTransform EndTime Translate 8 0 0 Shape \"disk\"",
                 STILL[i]);
        reading r = reading_of(text);
        assert_int_equal(r.scene->instances[0].step_count, 1);
        check_step(&r, 0, 0, i == 0 ? 0 : 8, 0, 0);
        reading_destroy(&r);
    }
}

static void cameras_move(void **state)
{
    (void)state;
    /* the camera's transform is that of the world into its space: it goes the other way */
    reading r = reading_of("ActiveTransform EndTime Translate -4 0 0 Camera \"perspective\" WorldBegin\n"
                           "CoordSysTransform \"camera\" Shape \"disk\"");
    assert_true(r.scene->camera.is_moving);
    for (int i = 0; i <= 4; i++) {
        scene_ray ray = camera_generate_ray(&r.scene->camera, 0.5f, 0.5f, 1.0f, (vec2){0.5f, 0.5f}, 0.25f * (float)i);
        assert_vec3(ray.origin, i, 0, 0, 1e-6);
        assert_vec3(ray.direction, 0, 0, 1, 1e-6);
        assert_true(ray.time == 0.25f * (float)i);
    }
    check_step(&r, 0, 1, 4, 0, 0); /* what is placed in "camera" goes with it */
    reading_destroy(&r);
    r = reading_of("ActiveTransform EndTime Rotate -90 0 1 0 ActiveTransform All Camera \"perspective\" WorldBegin");
    scene_ray ray = camera_generate_ray(&r.scene->camera, 0.5f, 0.5f, 1.0f, (vec2){0.5f, 0.5f}, 0.5f);
    assert_vec3(ray.direction, sqrt(0.5), 0, sqrt(0.5), 1e-6);
    reading_destroy(&r);
    r = reading_of("Translate 1 2 3 ActiveTransform EndTime ActiveTransform All Camera \"perspective\" WorldBegin");
    assert_false(r.scene->camera.is_moving);
    reading_destroy(&r);
}

/* Lights and textures that move are warned of, and stand as they do at the start, as in pbrt-v4. */
static void lights_and_textures_stand_still(void **state)
{
    (void)state;
    static const struct {
        const char *text, *warning;
    } CASES[] = {
        {"AreaLightSource \"diffuse\" Shape \"sphere\" Shape \"disk\"",
         "a shape with an area light that moves is not supported, as in pbrt-v4: it stands as it does at the start "
         "time"},
        {"LightSource \"point\"",
         "a light that moves is not supported, as in pbrt-v4: it stands as it does at the start time"},
        {"Texture \"t\" \"float\" \"fbm\"",
         "a texture in space that moves is not supported, as in pbrt-v4: it stands as it does at the start time"},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        char text[512];
        int length = snprintf(
            text, sizeof text,
            "WorldBegin Translate 1 0 0 ActiveTransform EndTime Translate 2 0 0 ActiveTransform All %s", CASES[i].text);
        reading r = reading_create(NULL, text, (size_t)length);
        assert_int_equal(r.status, AG_OK);
        assert_int_equal(r.count[AG_LOG_WARNING], 1);
        assert_non_null(strstr(r.said[AG_LOG_WARNING], CASES[i].warning));
        assert_int_equal(r.scene->instance_count, 0);
        if (i == 0)
            assert_vec3(transform_point(&r.scene->shapes[0].as.quadric.world_from_object, vec3_make(0, 0, 0)), 1, 0, 0,
                        0);
        if (i == 1)
            assert_vec3(r.scene->lights[0].as.point.position, 1, 0, 0, 0);
        reading_destroy(&r);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_say_what_is_wrong),
        cmocka_unit_test(objects_are_kept_once),
        cmocka_unit_test(instances_may_come_first),
        cmocka_unit_test(state_returns_at_the_end_of_an_object),
        cmocka_unit_test(lamps_within_objects_come_into_the_world),
        cmocka_unit_test(lamps_within_objects_have_a_limit),
        cmocka_unit_test(transforms_have_two_ends),
        cmocka_unit_test(the_shutter_sees_its_part_of_the_motion),
        cmocka_unit_test(cameras_move),
        cmocka_unit_test(lights_and_textures_stand_still),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
