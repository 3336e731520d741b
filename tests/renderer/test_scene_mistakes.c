/* test_scene_mistakes.c: mistakes in scenes that calls put together are named by function, call and parameter; calls in
 * a wrong order are errors and no crash. Threads: one. */
#define _GNU_SOURCE
#include "fixtures/layers_fixture.h"
#include "fixtures/scene_desk.h"

static void mistakes_are_named_by_call_and_parameter(void **state)
{
    (void)state;
    desk d;
    square s;
    const int32_t out_of_range[] = {0, 1, 9};
    const float not_finite[] = {0, 1, NAN};
    begin_lit(&d);
    make_square(&s);
    s.parameters[1] = (ag_parameter){"indices", AG_PARAMETER_INTEGER, 3, .integers = out_of_range};
    s.shape.material = "red";
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape, NULL), AG_ERROR_SCENE);
    expect_said(&d, "ag_scene_add_shape:1:2: error: index 9 (value 3 of \"indices\") is out of range, there are 4 "
                    "vertices\n    Shape \"trianglemesh\" of material \"red\"");
    s.shape.material = NULL;
    s.parameters[1] = (ag_parameter){"N", AG_PARAMETER_NORMAL, 3, .floats = not_finite};
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape, NULL), AG_ERROR_ARGUMENT);
    expect_said(&d, "ag_scene_add_shape:2:2: error: \"normal N\": value 3 is not finite");
    make_square(&s);
    s.parameters[0].count = 11;
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape, NULL), AG_ERROR_ARGUMENT);
    expect_said(&d, "ag_scene_add_shape:3:1: error: \"point3 P\" has 11 numbers, which is no multiple of 3");
    s.parameters[0] = (ag_parameter){"P", AG_PARAMETER_POINT3, 12, .integers = TRIANGLES};
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape, NULL), AG_ERROR_ARGUMENT);
    expect_said(&d, ":4:1: error: \"point3 P\": its values should be floats or doubles");
    s.parameters[0] = (ag_parameter){.name = "P", .type = AG_PARAMETER_POINT3, .count = 12};
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape, NULL), AG_ERROR_ARGUMENT);
    expect_said(&d, ":5:1: error: \"point3 P\": one of its arrays should be there, and no other");
    s.parameters[0] = (ag_parameter){"P", (ag_parameter_type)99, 12, .floats = CORNERS};
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape, NULL), AG_ERROR_ARGUMENT);
    expect_said(&d, ":6:1: error: a parameter has no type that there is");
    s.parameters[0] = (ag_parameter){NULL, AG_PARAMETER_POINT3, 12, .floats = CORNERS};
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape, NULL), AG_ERROR_ARGUMENT);
    expect_said(&d, ":7:1: error: a parameter has no name");
    make_square(&s);
    s.shape.type = "cube";
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape, NULL), AG_ERROR_SCENE);
    expect_said(&d, "ag_scene_add_shape:8:0: error: unknown shape \"cube\"");
    s.shape.type = NULL;
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape, NULL), AG_ERROR_ARGUMENT);
    expect_said(&d, ":9:0: error: the shape has no type");
    const char *const no_strings[] = {NULL};
    const ag_parameter file = {"filename", AG_PARAMETER_STRING, 1, .strings = no_strings};
    assert_int_equal(ag_scene_add_material(d.made, "m", "diffuse", &file, 1), AG_ERROR_ARGUMENT);
    expect_said(&d, "ag_scene_add_material:1:1: error: \"string filename\": a string is NULL");
    assert_int_equal(ag_scene_add_material(d.made, "m", "velvet", NULL, 0), AG_ERROR_SCENE);
    expect_said(&d, "ag_scene_add_material:2:0: error: unknown material \"velvet\"\n"
                    "    MakeNamedMaterial \"m\", \"velvet\"");
    assert_int_equal(ag_scene_add_material(d.made, NULL, "diffuse", NULL, 0), AG_ERROR_ARGUMENT);
    expect_said(&d, "ag_scene_add_material:3:0: error: a name or a type is NULL");
    assert_int_equal(ag_scene_add_material(d.made, "m", "diffuse", NULL, 1), AG_ERROR_ARGUMENT);
    expect_said(&d, "ag_scene_add_material:4:0: error:");
    /* all of this has left no trace */
    make_square(&s);
    assert_int_equal(ag_scene_add_material(d.made, "m", "diffuse", NULL, 0), AG_OK);
    assert_int_equal(ag_scene_add_material(d.made, "m", "diffuse", NULL, 0), AG_ERROR_SCENE);
    expect_said(&d, "is made twice, first at ag_scene_add_material:5:0");
    s.shape.material = "m";
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape, NULL), AG_OK);
    assert_string_equal(d.said, "");
    assert_int_equal(ag_scene_commit(d.made), AG_OK);
    end(&d);
}

static void matrices_and_order_are_checked(void **state)
{
    (void)state;
    static const double flat[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1};
    static const double endless[16] = {1, 0, 0, INFINITY, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    desk d;
    square s;
    ag_instance instance = ag_default_instance();
    ag_camera eye = ag_default_camera();
    begin_lit(&d);
    make_square(&s);
    s.shape.world_from_shape = flat;
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape, NULL), AG_ERROR_ARGUMENT);
    expect_said(&d, "its matrix cannot be undone");
    s.shape.world_from_shape = endless;
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape, NULL), AG_ERROR_ARGUMENT);
    expect_said(&d, "a number of its matrix is not finite");
    assert_int_equal(ag_scene_add_instance(d.made, &instance, NULL), AG_ERROR_ARGUMENT);
    expect_said(&d, "ag_scene_add_instance:1:0: error: the instance names no object");
    s.shape.world_from_shape = NULL;
    s.shape.object = instance.object = "thing";
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape, NULL), AG_OK);
    assert_int_equal(ag_scene_add_instance(d.made, &instance, NULL), AG_OK);
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape, NULL), AG_ERROR_SCENE);
    expect_said(&d, "object \"thing\" has an instance already");
    instance.world_from_object_end = ASIDE;
    assert_int_equal(ag_scene_add_instance(d.made, &instance, NULL), AG_OK);
    assert_int_equal(ag_scene_set_camera(d.made, &eye), AG_ERROR_ARGUMENT);
    expect_said(&d, "the camera comes before what moves");
    instance.object = "nothing";
    instance.world_from_object_end = NULL;
    assert_int_equal(ag_scene_add_instance(d.made, &instance, NULL), AG_ERROR_SCENE);
    expect_said(&d, "ag_scene_add_instance:4:0: error: no object is named \"nothing\"");
    s.shape.object = NULL;
    s.shape.material = "nothing";
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape, NULL), AG_OK); /* it may still come */
    assert_int_equal(ag_scene_commit(d.made), AG_ERROR_SCENE);
    expect_said(&d, "no material is named \"nothing\"");
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape, NULL), AG_ERROR_ARGUMENT); /* no more */
    assert_int_equal(ag_scene_commit(d.made), AG_ERROR_ARGUMENT);
    end(&d);
}

static void calls_in_a_wrong_order_are_errors(void **state)
{
    (void)state;
    desk d;
    square s;
    ag_render_settings settings = ag_default_render_settings();
    ag_prediction prediction;
    ag_film *film = NULL;
    ag_scene *scene = NULL;
    begin(&d);
    make_square(&s);
    assert_int_equal(ag_render(d.context, d.made, &settings, &film), AG_ERROR_ARGUMENT);
    expect_said(&d, "the scene is not complete: ag_scene_commit comes first");
    assert_int_equal(ag_render_settings_from_scene(d.context, d.made, &settings), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_predict(d.context, d.made, &settings, &prediction), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_predict_memory(d.context, d.made, &settings, &prediction), AG_ERROR_ARGUMENT);
    assert_null(ag_scene_film_file_name(d.made));
    assert_false(ag_scene_has_own_samples(d.made));
    assert_false(ag_scene_was_read_from(d.made, LAYERS_SCENES "block.pbrt"));
    light_and_look(&d);
    assert_int_equal(ag_scene_commit(d.made), AG_OK);
    assert_int_equal(ag_scene_commit(d.made), AG_ERROR_ARGUMENT);
    expect_said(&d, "ag_scene_commit: the scene is complete already");
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape, NULL), AG_ERROR_ARGUMENT);
    expect_said(&d, "ag_scene_add_shape: the scene is complete already");
    assert_int_equal(ag_scene_add_shape(NULL, &s.shape, NULL), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_scene_set_hint(d.made, (ag_scene_hint)7, "rgb", NULL, 0), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_scene_create(NULL, NULL, &scene), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_scene_create(d.context, NULL, NULL), AG_ERROR_ARGUMENT);
    const ag_definition definition = {"a", "1", false};
    ag_scene_settings asked = ag_default_scene_settings();
    asked.definitions = &definition;
    asked.definition_count = 1;
    assert_int_equal(ag_scene_create(d.context, &asked, &scene), AG_ERROR_ARGUMENT);
    assert_null(scene);
    assert_int_equal(ag_scene_create(d.context, NULL, &scene), AG_OK); /* dropped half made */
    assert_int_equal(ag_scene_add_shape(scene, &s.shape, NULL), AG_OK);
    ag_scene_destroy(scene);
    end(&d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mistakes_are_named_by_call_and_parameter),
        cmocka_unit_test(matrices_and_order_are_checked),
        cmocka_unit_test(calls_in_a_wrong_order_are_errors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
