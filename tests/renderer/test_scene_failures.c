/* test_scene_failures.c: calls that fail leave no trace in a scene from memory: those that follow, and the picture, are
 * as if it had not been made. Threads: one. */
#define _GNU_SOURCE
#include "fixtures/scene_desk.h"

static const double BEYOND_FLOATS[16] = {1, 0, 0, 1e39, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
static const float NEGATIVE[] = {-5, -5, -5}, HALF[] = {0.5f, 0.5f, 0.5f}, NOTHING[] = {0, 0, 0};

static ag_parameter color_of(const char *name, const float *rgb)
{
    return (ag_parameter){.name = name, .type = AG_PARAMETER_RGB, .count = 3, .floats = rgb};
}

/* A ball in front of the square; the caller changes what it likes. */
static const float QUARTER[] = {0.25f};
static const ag_parameter RADIUS = {.name = "radius", .type = AG_PARAMETER_FLOAT, .count = 1, .floats = QUARTER};

static ag_shape make_ball(const char *object)
{
    ag_shape ball = ag_default_shape();
    ball.type = "sphere";
    ball.object = object;
    ball.parameters = &RADIUS;
    ball.parameter_count = 1;
    return ball;
}

static void add_square(desk *d)
{
    square s;
    make_square(&s);
    assert_int_equal(ag_scene_add_shape(d->made, &s.shape, NULL), AG_OK);
}

/* Commits both, of which the second saw no call that failed. */
static void expect_same_picture(desk *d, desk *sound)
{
    float pixels[2][3 * SIZE * SIZE], most = 0.0f;
    d->said[0] = '\0';
    desk *const both[] = {d, sound};
    for (int i = 0; i < 2; i++) {
        if (ag_scene_commit(both[i]->made) != AG_OK)
            fail_msg("%s", both[i]->said);
        render(both[i]->context, both[i]->made, pixels[i]);
        assert_string_equal(both[i]->said, "");
        end(both[i]);
    }
    for (int i = 0; i < 3 * SIZE * SIZE; i++)
        most = fmaxf(most, pixels[1][i]);
    assert_true(most > 0.0f);
    assert_memory_equal(pixels[0], pixels[1], sizeof pixels[0]);
}

static void a_medium_that_failed_can_be_made_again(void **state)
{
    (void)state;
    desk d, sound;
    desk *const both[] = {&d, &sound};
    const ag_parameter wrong = color_of("sigma_a", NEGATIVE);
    const ag_parameter right[] = {color_of("sigma_a", HALF), color_of("sigma_s", NOTHING)};
    for (int i = 0; i < 2; i++) {
        begin(both[i]);
        light_and_look(both[i]);
        add_square(both[i]);
        if (i == 0) {
            assert_int_equal(ag_scene_add_medium(d.made, "ink", "homogeneous", &wrong, 1), AG_ERROR_SCENE);
            expect_said(&d, "ag_scene_add_medium:1:1: error: \"rgb sigma_a\" has a negative component");
        }
        assert_int_equal(ag_scene_add_medium(both[i]->made, "ink", "homogeneous", right, 2), AG_OK);
        ag_shape ball = make_ball(NULL);
        ball.material = "clear";
        ball.medium_inside = "ink";
        assert_int_equal(ag_scene_add_material(both[i]->made, "clear", "interface", NULL, 0), AG_OK);
        assert_int_equal(ag_scene_add_shape(both[i]->made, &ball, NULL), AG_OK);
    }
    expect_same_picture(&d, &sound);
    begin(&d);
    assert_int_equal(ag_scene_add_medium(d.made, "ink", "homogeneous", &wrong, 1), AG_ERROR_SCENE);
    ag_shape ball = make_ball(NULL);
    ball.medium_inside = "ink";
    assert_int_equal(ag_scene_add_shape(d.made, &ball, NULL), AG_OK);
    assert_int_equal(ag_scene_commit(d.made), AG_ERROR_SCENE);
    expect_said(&d, "no medium is named \"ink\"");
    end(&d);
}

/* A shape of no type, one that shines beyond floats, in a medium that never comes, and instances that cannot be. */
static void shapes_and_instances_that_failed_leave_no_trace(void **state)
{
    (void)state;
    desk d, sound;
    desk *const both[] = {&d, &sound};
    const float tiny[] = {1e-18f}, great[] = {1e38f};
    ag_instance instance = ag_default_instance();
    for (int i = 0; i < 2; i++) {
        begin(both[i]);
        light_and_look(both[i]);
        add_square(both[i]);
    }
    ag_shape ball = make_ball(NULL);
    ball.type = "cube";
    ball.world_from_shape_end = ASIDE;
    assert_int_equal(ag_scene_add_shape(d.made, &ball, NULL), AG_ERROR_SCENE);
    ball.object = instance.object = "ball";
    assert_int_equal(ag_scene_add_shape(d.made, &ball, NULL), AG_ERROR_SCENE);
    instance.world_from_object_end = ASIDE;
    assert_int_equal(ag_scene_add_instance(d.made, &instance, NULL), AG_ERROR_SCENE); /* the object has nothing yet */
    expect_said(&d, "no object is named \"ball\"");
    instance.world_from_object = BEYOND_FLOATS;
    instance.object = "nothing";
    assert_int_equal(ag_scene_add_instance(d.made, &instance, NULL), AG_ERROR_SCENE);
    ball = make_ball(NULL);
    const ag_parameter radius = {.name = "radius", .type = AG_PARAMETER_FLOAT, .count = 1, .floats = tiny};
    const ag_parameter power = {.name = "power", .type = AG_PARAMETER_FLOAT, .count = 1, .floats = great};
    ball.parameters = &radius;
    ball.is_light = true;
    ball.light_parameters = &power;
    ball.light_parameter_count = 1;
    ball.medium_outside = "fog";
    assert_int_equal(ag_scene_add_shape(d.made, &ball, NULL), AG_ERROR_SCENE);
    expect_said(&d, "the light is too bright for a float");

    /* neither is the camera locked, nor the object */
    ag_camera eye = ag_default_camera();
    eye.world_from_camera = AWAY;
    assert_int_equal(ag_scene_set_camera(d.made, &eye), AG_OK);
    instance.object = "ball";
    for (int i = 0; i < 2; i++) {
        ball = make_ball("ball");
        assert_int_equal(ag_scene_add_shape(both[i]->made, &ball, NULL), AG_OK);
        ball.is_light = true;
        assert_int_equal(ag_scene_add_shape(both[i]->made, &ball, NULL), AG_OK);
        if (i == 0) { /* its lamp would stay without the body */
            instance.world_from_object = BEYOND_FLOATS;
            instance.world_from_object_end = NULL;
            assert_int_equal(ag_scene_add_instance(d.made, &instance, NULL), AG_ERROR_SCENE);
        }
        ball.is_light = false;
        ball.world_from_shape = ASIDE;
        assert_int_equal(ag_scene_add_shape(both[i]->made, &ball, NULL), AG_OK);
        instance.world_from_object = NULL;
        assert_int_equal(ag_scene_add_instance(both[i]->made, &instance, NULL), AG_OK);
    }
    expect_same_picture(&d, &sound);
}

/* An instance whose lamps lie too far off, when its body is there already; and one whose body cannot be, whose lamps
 * are. */
static void an_instance_has_its_body_and_its_lamps_or_neither(void **state)
{
    (void)state;
    static const double inside_out[16] = {-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1};
    desk d, sound;
    desk *const both[] = {&d, &sound};
    ag_instance instance = ag_default_instance();
    instance.object = "lamp";
    for (int i = 0; i < 2; i++) {
        begin(both[i]);
        light_and_look(both[i]);
        add_square(both[i]);
        ag_shape ball = make_ball("lamp");
        assert_int_equal(ag_scene_add_shape(both[i]->made, &ball, NULL), AG_OK);
        ball.is_light = true;
        assert_int_equal(ag_scene_add_shape(both[i]->made, &ball, NULL), AG_OK);
        if (i == 1)
            continue;
        static const double far[16] = {1, 0, 0, 1e19, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
        instance.world_from_object = far;
        assert_int_equal(ag_scene_add_instance(d.made, &instance, NULL), AG_ERROR_SCENE);
        expect_said(&d, "a lamp of object \"lamp\" reaches beyond 1e18 units");
        instance.world_from_object = NULL;
        instance.world_from_object_end = inside_out;
        assert_int_equal(ag_scene_add_instance(d.made, &instance, NULL), AG_ERROR_SCENE);
        expect_said(&d, "turns inside out on its way");
    }
    expect_same_picture(&d, &sound);
}

/* Rays from so far would leave the range in which they can be traced in an instance's space. */
static void cameras_out_of_reach_are_refused(void **state)
{
    (void)state;
    static const double FAR[16] = {1, 0, 0, 1e19, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    static const double FLAT[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, .005, 0, 0, 0, 0, 1};
    static const double DISTANT[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1e16, 0, 0, 0, 1};
    desk d;
    ag_camera eye = ag_default_camera();
    ag_instance instance = ag_default_instance();
    begin(&d);
    light_and_look(&d);
    add_square(&d);
    const ag_shape ball = make_ball("ball");
    assert_int_equal(ag_scene_add_shape(d.made, &ball, NULL), AG_OK);
    instance.object = "ball";
    instance.world_from_object = FLAT;
    assert_int_equal(ag_scene_add_instance(d.made, &instance, NULL), AG_OK);
    assert_int_equal(ag_scene_commit(d.made), AG_OK);
    eye.world_from_camera = FAR;
    assert_int_equal(ag_scene_set_camera(d.made, &eye), AG_ERROR_SCENE);
    expect_said(&d, "its camera lies beyond 1e18 units");
    eye.world_from_camera = NULL;
    eye.world_from_camera_end = FAR;
    assert_int_equal(ag_scene_set_camera(d.made, &eye), AG_ERROR_SCENE);
    eye.world_from_camera = DISTANT;
    eye.world_from_camera_end = NULL;
    assert_int_equal(ag_scene_set_camera(d.made, &eye), AG_ERROR_SCENE);
    expect_said(&d, "an instance of object \"ball\" is so small");
    eye.world_from_camera = NULL;
    assert_int_equal(ag_scene_set_camera(d.made, &eye), AG_OK);
    end(&d);
}

/* The last camera that was made counts, and no other. */
static void cameras_that_failed_or_were_replaced_leave_no_trace(void **state)
{
    (void)state;
    static const double inside_out[16] = {-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1};
    desk d, sound;
    ag_camera eye = ag_default_camera();
    begin(&d);
    begin(&sound);
    eye.medium = "fog";
    assert_int_equal(ag_scene_set_camera(d.made, &eye), AG_OK);
    light_and_look(&d);
    light_and_look(&sound);
    eye.world_from_camera_end = inside_out;
    assert_int_equal(ag_scene_set_camera(d.made, &eye), AG_ERROR_SCENE);
    expect_said(&d, "turns inside out on its way");
    add_square(&d);
    add_square(&sound);
    expect_same_picture(&d, &sound);
    begin_lit(&d);
    eye.world_from_camera_end = NULL;
    assert_int_equal(ag_scene_set_camera(d.made, &eye), AG_OK);
    assert_int_equal(ag_scene_commit(d.made), AG_ERROR_SCENE);
    expect_said(&d, "no medium is named \"fog\"");
    end(&d);
}

static void transposed_matrices_are_refused(void **state)
{
    (void)state;
    static const double transposed[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -2, 1};
    static const double halved[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2};
    static const double rounded[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -2, 0, 1e-9, 0, 1.0 + 1e-9};
    const double *const wrong[] = {transposed, halved};
    desk d;
    begin(&d);
    ag_camera eye = ag_default_camera();
    ag_shape ball = make_ball(NULL);
    for (int i = 0; i < 2; i++) {
        eye.world_from_camera = wrong[i];
        assert_int_equal(ag_scene_set_camera(d.made, &eye), AG_ERROR_ARGUMENT);
        expect_said(&d, "the translation is in the last column");
        ball.world_from_shape_end = wrong[i];
        assert_int_equal(ag_scene_add_shape(d.made, &ball, NULL), AG_ERROR_ARGUMENT);
        expect_said(&d, "the translation is in the last column");
    }
    eye.world_from_camera = rounded;
    assert_int_equal(ag_scene_set_camera(d.made, &eye), AG_OK);
    end(&d);
}

static void expect_settings_refused(desk *d, const ag_scene_settings *asked, const char *said)
{
    ag_scene *scene = NULL;
    assert_int_equal(ag_scene_load_text(d->context, "t", "WorldBegin", 10, asked, &scene), AG_ERROR_ARGUMENT);
    expect_said(d, said);
    assert_int_equal(ag_scene_create(d->context, asked, &scene), AG_ERROR_ARGUMENT);
    expect_said(d, "the settings of the scene: ");
    assert_null(scene);
}

static void settings_out_of_range_are_named(void **state)
{
    (void)state;
    const ag_scene_settings sound = ag_default_scene_settings();
    desk d;
    begin(&d);
    ag_scene_settings asked = sound;
    asked.texture_memory_bytes = 5;
    expect_settings_refused(&d, &asked, "the settings of the scene: texture_memory_bytes should be");
    asked = sound;
    asked.texture_cache = "";
    expect_settings_refused(&d, &asked, "texture_cache should be a folder");
    asked = sound;
    asked.has_sun = true;
    asked.sun_irradiance = NAN;
    expect_settings_refused(&d, &asked, "sun_irradiance should be finite");
    asked.sun_irradiance = INFINITY;
    expect_settings_refused(&d, &asked, "sun_irradiance should be finite");
    asked = sound;
    asked.has_sky = true;
    asked.sky_radiance[1] = -1.0f;
    expect_settings_refused(&d, &asked, "sky_radiance should be finite, and not negative");
    asked = sound;
    asked.definition_count = 1;
    expect_settings_refused(&d, &asked, "definitions is NULL");
    asked = sound;
    asked.has_camera = true;
    asked.camera_name = "eye";
    expect_settings_refused(&d, &asked, "has_camera and camera_name exclude each other");
    asked = sound;
    asked.up = (ag_up_axis)99;
    expect_settings_refused(&d, &asked, "up is no axis");
    end(&d);
}

/* Every misuse is named in a message. */
static void misuse_is_named(void **state)
{
    (void)state;
    desk d;
    ag_scene *scene = NULL;
    begin(&d);
    assert_int_equal(ag_scene_set_hint(d.made, (ag_scene_hint)77, "rgb", NULL, 0), AG_ERROR_ARGUMENT);
    expect_said(&d, "ag_scene_set_hint:1:0: error: there is no such hint");
    assert_int_equal(ag_scene_create(d.context, NULL, NULL), AG_ERROR_ARGUMENT);
    expect_said(&d, "out_scene is NULL");
    assert_int_equal(ag_scene_load_text(d.context, "t", NULL, 10, NULL, &scene), AG_ERROR_ARGUMENT);
    expect_said(&d, "its text is NULL");
    assert_int_equal(ag_scene_load_text(d.context, NULL, "WorldBegin", 10, NULL, &scene), AG_ERROR_ARGUMENT);
    expect_said(&d, "its name is NULL");
    assert_int_equal(ag_scene_load_text(d.context, "t", "WorldBegin", SIZE_MAX, NULL, &scene), AG_ERROR_INPUT);
    expect_said(&d, "t: the text is larger than ");
    ag_shape ball = make_ball(NULL);
    ag_parameter many = RADIUS;
    ball.parameters = &many;
    for (int i = 0; i < 2; i++) {
        many.count = SIZE_MAX / (i == 0 ? 8 : 9);
        assert_int_equal(ag_scene_add_shape(d.made, &ball, NULL), AG_ERROR_ARGUMENT);
        expect_said(&d, "\"float radius\": it has more than 2^33 values");
    }
    end(&d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_medium_that_failed_can_be_made_again),
        cmocka_unit_test(shapes_and_instances_that_failed_leave_no_trace),
        cmocka_unit_test(an_instance_has_its_body_and_its_lamps_or_neither),
        cmocka_unit_test(cameras_out_of_reach_are_refused),
        cmocka_unit_test(cameras_that_failed_or_were_replaced_leave_no_trace),
        cmocka_unit_test(transposed_matrices_are_refused),
        cmocka_unit_test(settings_out_of_range_are_named),
        cmocka_unit_test(misuse_is_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
