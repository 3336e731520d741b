/* test_scene_memory.c: scenes that calls put together: the bits of files that say the same, for the scenes of tests and
 * for public ones; what is wrong is named by function, call and parameter; misuse is an error and no crash.
 * Threads: one. */
#define _GNU_SOURCE
#include "fixtures/layers_fixture.h"
#include "fixtures/pbrt_transcript.h"
#include "fixtures/scene_desk.h"
#include "fixtures/shared_folder.h"
#include "image/image_reader.h"

#include <malloc.h>

/* Where everything takes long, one in so many of the scenes that are said both ways is tested. */
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
enum { SCENE_STEP = 4 };
#else
enum { SCENE_STEP = 1 };
#endif
static void expect_same_both_ways(const char *folder_of_file, const char *name)
{
    desk d;
    ag_scene *read;
    float of_memory[3 * SIZE * SIZE], of_file[3 * SIZE * SIZE];
    char text_path[256];
    snprintf(text_path, sizeof text_path, "%s", in_folder("said_again.pbrt"));
    begin(&d);
    transcribe(folder_of_file, name, d.made, text_path);
    if (ag_scene_commit(d.made) != AG_OK)
        fail_msg("%s: %s", name, d.said);
    if (ag_scene_load(d.context, text_path, &read) != AG_OK)
        fail_msg("%s: %s", name, d.said);
    render(d.context, d.made, of_memory);
    render(d.context, read, of_file);
    if (memcmp(of_memory, of_file, sizeof of_file) != 0)
        fail_msg("%s: from memory it is another picture than from a file", name);
    float most = 0.0f;
    for (int i = 0; i < 3 * SIZE * SIZE; i++)
        most = fmaxf(most, of_file[i]);
    assert_true(most > 0.0f);
    ag_scene_destroy(read);
    end(&d);
}

static void memory_has_the_bits_of_files(void **state)
{
    (void)state;
    static const char *const NAMES[] = {"absorbing_spheres",
                                        "alpha_and_relief",
                                        "box_with_blocks",
                                        "curves_in_furnace",
                                        "environment_furnace",
                                        "glass_and_metal",
                                        "lamp_distant",
                                        "lamp_disk",
                                        "lamp_sphere",
                                        "next_room",
                                        "panes",
                                        "principled",
                                        "rough_coats",
                                        "slabs",
                                        "sphere_spot",
                                        "tea_in_glass",
                                        "tuft",
                                        "step"};
    for (size_t i = 0; i < sizeof NAMES / sizeof *NAMES; i += SCENE_STEP) {
        char name[64];
        snprintf(name, sizeof name, "%s.pbrt", NAMES[i]);
        expect_same_both_ways(LAYERS_SCENES, name);
    }
}

/* The public scenes whose files are there have the bits of their files. */
static void public_scenes_have_the_bits_of_files(void **state)
{
    (void)state;
    static const char *const NAMES[][2] = {{"cornell-box", "scene.pbrt"},
                                           {"veach-mis", "scene.pbrt"},
                                           {"coffee", "scene.pbrt"},
                                           {"water-caustic", "scene.pbrt"}};
    const char *shared = shared_folder();
    if (!shared) {
        print_message("SKIPPED: the public scenes are not there\n");
        skip();
    }
    for (size_t i = 0; i < sizeof NAMES / sizeof *NAMES; i += SCENE_STEP) {
        char path[512];
        snprintf(path, sizeof path, "%s/scenes/%s/", shared, NAMES[i][0]);
        expect_same_both_ways(path, NAMES[i][1]);
    }
}

/* Motion and instances made by calls have the bits of the text that says them. */
static void motion_and_instances_have_the_bits_of_text(void **state)
{
    (void)state;
    static const char TEXT[] = "Transform [1 0 0 0  0 1 0 0  0 0 1 0  0 0 2 1] Camera \"perspective\" WorldBegin\n"
                               "LightSource \"point\" \"point3 from\" [0 0 -3]\n"
                               "AttributeBegin ActiveTransform EndTime Translate 1 0 0 ActiveTransform All\n"
                               "Shape \"trianglemesh\" \"point3 P\" [-1 -1 0 1 -1 0 1 1 0 -1 1 0] "
                               "\"integer indices\" [0 1 2 0 2 3] AttributeEnd\n"
                               "ObjectBegin \"ball\" Shape \"sphere\" \"float radius\" 0.25 ObjectEnd\n"
                               "AttributeBegin ActiveTransform EndTime Translate 1 0 0 ActiveTransform All\n"
                               "ObjectInstance \"ball\" AttributeEnd ObjectInstance \"ball\"\n";
    desk d;
    square s;
    ag_scene *read;
    float of_memory[3 * SIZE * SIZE], of_text[3 * SIZE * SIZE];
    const ag_parameter radius = {"radius", AG_PARAMETER_FLOAT, 1, .floats = (const float[]){0.25f}};
    ag_shape ball = ag_default_shape();
    ag_instance instance = ag_default_instance();
    begin(&d);
    light_and_look(&d);
    make_square(&s);
    s.shape.world_from_shape_end = ASIDE;
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape), AG_OK);
    ball.type = "sphere";
    ball.object = instance.object = "ball";
    ball.parameters = &radius;
    ball.parameter_count = 1;
    assert_int_equal(ag_scene_add_shape(d.made, &ball), AG_OK);
    instance.world_from_object_end = ASIDE;
    assert_int_equal(ag_scene_add_instance(d.made, &instance), AG_OK);
    instance.world_from_object_end = NULL;
    assert_int_equal(ag_scene_add_instance(d.made, &instance), AG_OK);
    assert_int_equal(ag_scene_commit(d.made), AG_OK);
    assert_int_equal(ag_scene_load_text(d.context, "text", TEXT, sizeof TEXT - 1, NULL, &read), AG_OK);
    assert_string_equal(d.said, "");
    render(d.context, d.made, of_memory);
    render(d.context, read, of_text);
    assert_memory_equal(of_memory, of_text, sizeof of_text);
    ag_scene_destroy(read);
    end(&d);
}

/* Arrays may be freed as soon as the call has returned. */
static void what_is_handed_over_is_copied(void **state)
{
    (void)state;
    desk d, kept;
    square s;
    float with_freed[3 * SIZE * SIZE], with_kept[3 * SIZE * SIZE];
    begin(&d);
    begin(&kept);
    light_and_look(&d);
    light_and_look(&kept);
    make_square(&s);
    assert_int_equal(ag_scene_add_shape(kept.made, &s.shape), AG_OK);
    float *positions = malloc(sizeof CORNERS);
    char *name = strdup("P"), *type = strdup("trianglemesh");
    assert_true(positions && name && type);
    memcpy(positions, CORNERS, sizeof CORNERS);
    s.parameters[0].floats = positions;
    s.parameters[0].name = name;
    s.shape.type = type;
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape), AG_OK);
    memset(positions, 0x7f, sizeof CORNERS);
    free(positions);
    free(name);
    free(type);
    assert_int_equal(ag_scene_commit(d.made), AG_OK);
    assert_int_equal(ag_scene_commit(kept.made), AG_OK);
    render(d.context, d.made, with_freed);
    render(kept.context, kept.made, with_kept);
    assert_memory_equal(with_freed, with_kept, sizeof with_kept);
    end(&kept);
    end(&d);
}

static void mistakes_are_named_by_call_and_parameter(void **state)
{
    (void)state;
    desk d;
    square s;
    const int32_t out_of_range[] = {0, 1, 9};
    const float not_finite[] = {0, 1, NAN};
    begin(&d);
    light_and_look(&d);
    make_square(&s);
    s.parameters[1] = (ag_parameter){"indices", AG_PARAMETER_INTEGER, 3, .integers = out_of_range};
    s.shape.material = "red";
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape), AG_ERROR_SCENE);
    expect_said(&d, "ag_scene_add_shape:1:2: error: index 9 (value 3 of \"indices\") is out of range, there are 4 "
                    "vertices\n    Shape \"trianglemesh\" of material \"red\"");
    s.shape.material = NULL;
    s.parameters[1] = (ag_parameter){"N", AG_PARAMETER_NORMAL, 3, .floats = not_finite};
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape), AG_ERROR_ARGUMENT);
    expect_said(&d, "ag_scene_add_shape:2:2: error: \"normal N\": value 3 is not finite");
    make_square(&s);
    s.parameters[0].count = 11;
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape), AG_ERROR_ARGUMENT);
    expect_said(&d, "ag_scene_add_shape:3:1: error: \"point3 P\" has 11 numbers, which is no multiple of 3");
    s.parameters[0] = (ag_parameter){"P", AG_PARAMETER_POINT3, 12, .integers = TRIANGLES};
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape), AG_ERROR_ARGUMENT);
    expect_said(&d, ":4:1: error: \"point3 P\": its values should be floats or doubles");
    s.parameters[0] = (ag_parameter){.name = "P", .type = AG_PARAMETER_POINT3, .count = 12};
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape), AG_ERROR_ARGUMENT);
    expect_said(&d, ":5:1: error: \"point3 P\": one of its arrays should be there, and no other");
    s.parameters[0] = (ag_parameter){"P", (ag_parameter_type)99, 12, .floats = CORNERS};
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape), AG_ERROR_ARGUMENT);
    expect_said(&d, ":6:1: error: a parameter has no type that there is");
    s.parameters[0] = (ag_parameter){NULL, AG_PARAMETER_POINT3, 12, .floats = CORNERS};
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape), AG_ERROR_ARGUMENT);
    expect_said(&d, ":7:1: error: a parameter has no name");
    make_square(&s);
    s.shape.type = "cube";
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape), AG_ERROR_SCENE);
    expect_said(&d, "ag_scene_add_shape:8:0: error: unknown shape \"cube\"");
    s.shape.type = NULL;
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape), AG_ERROR_ARGUMENT);
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
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape), AG_OK);
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
    begin(&d);
    light_and_look(&d);
    make_square(&s);
    s.shape.world_from_shape = flat;
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape), AG_ERROR_ARGUMENT);
    expect_said(&d, "its matrix cannot be undone");
    s.shape.world_from_shape = endless;
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape), AG_ERROR_ARGUMENT);
    expect_said(&d, "a number of its matrix is not finite");
    assert_int_equal(ag_scene_add_instance(d.made, &instance), AG_ERROR_ARGUMENT);
    expect_said(&d, "ag_scene_add_instance:1:0: error: the instance names no object");
    s.shape.world_from_shape = NULL;
    s.shape.object = instance.object = "thing";
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape), AG_OK);
    assert_int_equal(ag_scene_add_instance(d.made, &instance), AG_OK);
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape), AG_ERROR_SCENE);
    expect_said(&d, "object \"thing\" has an instance already");
    instance.world_from_object_end = ASIDE;
    assert_int_equal(ag_scene_add_instance(d.made, &instance), AG_OK);
    assert_int_equal(ag_scene_set_camera(d.made, &eye), AG_ERROR_ARGUMENT);
    expect_said(&d, "the camera comes before what moves");
    instance.object = "nothing";
    instance.world_from_object_end = NULL;
    assert_int_equal(ag_scene_add_instance(d.made, &instance), AG_ERROR_SCENE);
    expect_said(&d, "ag_scene_add_instance:4:0: error: no object is named \"nothing\"");
    s.shape.object = NULL;
    s.shape.material = "nothing";
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape), AG_OK); /* it may still come */
    assert_int_equal(ag_scene_commit(d.made), AG_ERROR_SCENE);
    expect_said(&d, "no material is named \"nothing\"");
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape), AG_ERROR_ARGUMENT); /* no more */
    assert_int_equal(ag_scene_commit(d.made), AG_ERROR_ARGUMENT);
    end(&d);
}

static void structs_of_other_sizes_are_refused(void **state)
{
    (void)state;
    desk d;
    square s;
    begin(&d);
    make_square(&s);
    const size_t sizes[] = {0, sizeof(size_t), sizeof(ag_shape) - 1, sizeof(ag_shape) + 8, SIZE_MAX};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        s.shape.struct_size = sizes[i];
        assert_int_equal(ag_scene_add_shape(d.made, &s.shape), AG_ERROR_ARGUMENT);
        expect_said(&d, "struct_size is not one that this library knows");
    }
    assert_int_equal(ag_scene_add_shape(d.made, NULL), AG_ERROR_ARGUMENT);
    expect_said(&d, "there is no description");
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
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape), AG_ERROR_ARGUMENT);
    expect_said(&d, "ag_scene_add_shape: the scene is complete already");
    assert_int_equal(ag_scene_add_shape(NULL, &s.shape), AG_ERROR_ARGUMENT);
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
    assert_int_equal(ag_scene_add_shape(scene, &s.shape), AG_OK);
    ag_scene_destroy(scene);
    end(&d);
}

/* A floor with a picture under a sky that is one: of bytes or floats, from files or from memory. */
static void expect_same_pictures(desk *d, const char *texture, const char *sky, bool is_as_floats)
{
    char text[1024];
    image pixels[2];
    square s;
    ag_scene *read;
    float of_memory[3 * SIZE * SIZE], of_file[3 * SIZE * SIZE];
    snprintf(text, sizeof text,
             "Transform [1 0 0 0 0 1 0 0 0 0 1 0 0 0 2 1] Camera \"perspective\" WorldBegin\n"
             "LightSource \"infinite\" \"string filename\" \"%s\"\n"
             "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"%s\"\n"
             "MakeNamedMaterial \"m\" \"string type\" \"diffuse\" \"texture reflectance\" \"t\" NamedMaterial \"m\"\n"
             "Shape \"trianglemesh\" \"point3 P\" [-1 -1 0 1 -1 0 1 1 0 -1 1 0] \"integer indices\" [0 1 2 0 2 3]\n",
             sky, texture);
    assert_int_equal(ag_scene_load_text(d->context, "text", text, strlen(text), NULL, &read), AG_OK);
    render(d->context, read, of_file);
    ag_scene_destroy(read);

    const char *const files[] = {texture, sky}, *const names[] = {"a picture", "a sky"};
    assert_int_equal(ag_scene_create(d->context, NULL, &d->made), AG_OK);
    for (int i = 0; i < 2; i++) {
        ag_image picture = ag_default_image();
        assert_int_equal(is_as_floats ? image_read_colors(files[i], &pixels[i], message, sizeof message)
                                      : image_read_compact(files[i], &pixels[i], message, sizeof message),
                         AG_OK);
        picture.width = pixels[i].width;
        picture.height = pixels[i].height;
        picture.channel_count = pixels[i].channel_count;
        picture.bytes = pixels[i].bytes;
        picture.floats = pixels[i].pixels;
        assert_true(!picture.bytes == is_as_floats);
        assert_int_equal(ag_scene_add_image(d->made, names[i], &picture), AG_OK);
        image_reset(&pixels[i]); /* it was copied */
    }
    const ag_parameter sky_of = {
        .name = "filename", .type = AG_PARAMETER_STRING, .count = 1, .strings = (const char *const[]){"a sky"}};
    const ag_parameter floor_of = {
        .name = "filename", .type = AG_PARAMETER_STRING, .count = 1, .strings = (const char *const[]){"a picture"}};
    const ag_parameter reflectance = {
        .name = "reflectance", .type = AG_PARAMETER_TEXTURE, .count = 1, .strings = (const char *const[]){"t"}};
    ag_light light = ag_default_light();
    ag_texture image_map = ag_default_texture();
    ag_camera eye = ag_default_camera();
    eye.world_from_camera = AWAY;
    light.type = "infinite";
    light.parameters = &sky_of;
    image_map.name = "t";
    image_map.type = "imagemap";
    image_map.parameters = &floor_of;
    light.parameter_count = image_map.parameter_count = 1;
    make_square(&s);
    s.shape.material = "m";
    assert_int_equal(ag_scene_set_camera(d->made, &eye), AG_OK);
    assert_int_equal(ag_scene_add_light(d->made, &light), AG_OK);
    assert_int_equal(ag_scene_add_texture(d->made, &image_map), AG_OK);
    assert_int_equal(ag_scene_add_material(d->made, "m", "diffuse", &reflectance, 1), AG_OK);
    assert_int_equal(ag_scene_add_shape(d->made, &s.shape), AG_OK);
    assert_int_equal(ag_scene_commit(d->made), AG_OK);
    render(d->context, d->made, of_memory);
    assert_memory_equal(of_memory, of_file, sizeof of_file);
    assert_string_equal(d->said, "");
    ag_scene_destroy(d->made);
    d->made = NULL;
}

static void pictures_in_memory_have_the_bits_of_files(void **state)
{
    (void)state;
    desk d;
    ag_scene *room;
    ag_film *film;
    ag_render_settings settings;
    ag_output_settings output = ag_default_output_settings();
    char png[256], exr[256];
    snprintf(png, sizeof png, "%s", in_folder("a.png"));
    snprintf(exr, sizeof exr, "%s", in_folder("a.exr"));
    begin(&d);
    ag_scene_destroy(d.made);
    assert_int_equal(ag_scene_load(d.context, LAYERS_SCENES "box_with_blocks.pbrt", &room), AG_OK);
    assert_int_equal(ag_render_settings_from_scene(d.context, room, &settings), AG_OK);
    settings.width = settings.height = 16;
    settings.photon_count = 1000;
    assert_int_equal(ag_render(d.context, room, &settings, &film), AG_OK);
    output.type = AG_SAMPLE_FLOAT;
    assert_int_equal(ag_film_write(d.context, film, &output, exr), AG_OK);
    assert_int_equal(ag_film_write(d.context, film, NULL, png), AG_OK);
    ag_film_destroy(film);
    ag_scene_destroy(room);
    expect_same_pictures(&d, png, png, false);
    expect_same_pictures(&d, exr, exr, true);

    const unsigned char grey[4] = {0, 80, 160, 240};
    const float greys[4] = {0, 1, 2, 3};
    ag_image picture = ag_default_image();
    assert_int_equal(ag_scene_create(d.context, NULL, &d.made), AG_OK);
    picture.width = picture.height = 2;
    picture.channel_count = 1;
    assert_int_equal(ag_scene_add_image(d.made, "grey", &picture), AG_ERROR_ARGUMENT);
    expect_said(&d, "ag_scene_add_image:1:0: error: either bytes or floats should be there");
    picture.bytes = grey;
    picture.floats = greys;
    assert_int_equal(ag_scene_add_image(d.made, "grey", &picture), AG_ERROR_ARGUMENT);
    picture.floats = NULL;
    assert_int_equal(ag_scene_add_image(d.made, NULL, &picture), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_scene_add_image(d.made, "grey", &picture), AG_OK);
    d.said[0] = '\0';
    assert_int_equal(ag_scene_add_image(d.made, "grey", &picture), AG_ERROR_SCENE);
    expect_said(&d, "there is a picture \"grey\" already");
    picture.channel_count = 5;
    assert_int_equal(ag_scene_add_image(d.made, "five", &picture), AG_ERROR_ARGUMENT);
    picture.channel_count = 1;
    picture.width = 1 << 20;
    picture.height = 1 << 20;
    assert_int_equal(ag_scene_add_image(d.made, "large", &picture), AG_ERROR_ARGUMENT);
    expect_said(&d, "1 to 2^28 pixels");
    end(&d);
}

static void photon_settings(ag_render_settings *settings, const char *map)
{
    settings->width = settings->height = SIZE;
    settings->samples_per_pixel = 2;
    settings->photon_count = 3000;
    settings->gather_samples = 4;
    settings->photon_map_file = map;
}

/* A scene whose camera was moved is one that had that camera from the beginning; a kept map serves both views. */
static void a_moved_camera_is_as_one_from_the_beginning(void **state)
{
    (void)state;
    static const double there[16] = {1, 0, 0, 0.2, 0, 1, 0, 1.1, 0, 0, -1, 3.7, 0, 0, 0, 1};
    const ag_parameter fov = {.name = "fov", .type = AG_PARAMETER_FLOAT, .count = 1, .floats = (const float[]){50}};
    desk d;
    ag_scene *moved;
    ag_camera eye = ag_default_camera();
    ag_render_settings settings;
    ag_film *film;
    int width, height;
    float first[3 * SIZE * SIZE], second[3 * SIZE * SIZE], again[3 * SIZE * SIZE];
    char map[256];
    snprintf(map, sizeof map, "%s", in_folder("kept.map"));
    begin(&d);
    assert_int_equal(ag_scene_load(d.context, LAYERS_SCENES "box_with_blocks.pbrt", &moved), AG_OK);
    assert_int_equal(ag_render_settings_from_scene(d.context, moved, &settings), AG_OK);
    photon_settings(&settings, map);
    eye.world_from_camera = there;
    eye.parameters = &fov;
    eye.parameter_count = 1;
    float *const pictures[] = {first, second};
    for (int i = 0; i < 2; i++) {
        assert_int_equal(ag_render(d.context, moved, &settings, &film), AG_OK);
        assert_int_equal(ag_context_statistics(d.context).map_file, i == 0 ? AG_MAP_FILE_TRACED : AG_MAP_FILE_OPENED);
        memcpy(pictures[i], ag_film_pixels(film, &width, &height), sizeof first);
        ag_film_destroy(film);
        assert_int_equal(ag_scene_set_camera(moved, &eye), AG_OK);
    }
    assert_memory_not_equal(first, second, sizeof first);

    /* the same camera in a scene that is read anew, and a map of its own */
    ag_scene *fresh;
    char text_path[256];
    snprintf(text_path, sizeof text_path, "%s", in_folder("fresh.pbrt"));
    ag_scene *made;
    assert_int_equal(ag_scene_create(d.context, NULL, &made), AG_OK);
    transcribe(LAYERS_SCENES, "box_with_blocks.pbrt", made, text_path);
    assert_int_equal(ag_scene_set_camera(made, &eye), AG_OK);
    assert_int_equal(ag_scene_commit(made), AG_OK);
    assert_int_equal(ag_scene_load(d.context, text_path, &fresh), AG_OK);
    assert_int_equal(ag_scene_set_camera(fresh, &eye), AG_OK);
    ag_scene *const same[] = {made, fresh};
    float *const pixels[] = {first, again};
    for (int i = 0; i < 2; i++) {
        photon_settings(&settings, i == 0 ? in_folder("made.map") : in_folder("fresh.map"));
        assert_int_equal(ag_render(d.context, same[i], &settings, &film), AG_OK);
        memcpy(pixels[i], ag_film_pixels(film, &width, &height), sizeof first);
        ag_film_destroy(film);
        ag_scene_destroy(same[i]);
    }
    assert_memory_equal(first, again, sizeof first);
    assert_string_equal(d.said, "");
    ag_scene_destroy(moved);
    end(&d);
}

/* Memory in use, of the process's own heap. */
static size_t used_bytes(void)
{
    const struct mallinfo2 heap = mallinfo2();
    return heap.uordblks + heap.hblkhd;
}

/* A host that goes on for hours: views, renders and whole scenes without end. */
static void edits_and_renders_leave_no_memory_behind(void **state)
{
    (void)state;
    enum { ROUNDS = 60, WARM_UP = 10, EDITS = 20 };
    desk d;
    square s;
    ag_render_settings settings;
    ag_film *film;
    size_t before = 0;
    begin(&d);
    ag_scene_destroy(d.made);
    for (int i = 0; i < ROUNDS; i++) {
        if (i == WARM_UP)
            before = used_bytes();
        assert_int_equal(ag_scene_create(d.context, NULL, &d.made), AG_OK);
        light_and_look(&d);
        make_square(&s);
        assert_int_equal(ag_scene_add_shape(d.made, &s.shape), AG_OK);
        s.shape.type = "cube";
        assert_int_equal(ag_scene_add_shape(d.made, &s.shape), AG_ERROR_SCENE);
        assert_int_equal(ag_scene_commit(d.made), AG_OK);
        assert_int_equal(ag_render_settings_from_scene(d.context, d.made, &settings), AG_OK);
        photon_settings(&settings, NULL);
        settings.width = settings.height = 4;
        settings.integrator = i % 8 == 0 ? AG_INTEGRATOR_PHOTONMAP : AG_INTEGRATOR_PATH;
        settings.photon_count = settings.caustic_photon_count = 100;
        for (int k = 0; k < EDITS; k++) {
            ag_camera eye = ag_default_camera();
            eye.world_from_camera = k % 2 == 0 ? AWAY : ASIDE;
            assert_int_equal(ag_scene_set_camera(d.made, &eye), AG_OK);
        }
        assert_int_equal(ag_render(d.context, d.made, &settings, &film), AG_OK);
        ag_film_destroy(film);
        ag_scene_destroy(d.made);
        d.said[0] = '\0';
    }
    const size_t after = used_bytes();
    if (after > before + 64 * 1024)
        fail_msg("%zu bytes were in use, and %zu are", before, after);
    d.made = NULL;
    end(&d);
}

static void a_camera_cannot_change_under_a_rendering(void **state)
{
    (void)state;
    desk d;
    square s;
    ag_rendering *rendering;
    ag_camera eye = ag_default_camera();
    ag_render_settings settings;
    begin(&d);
    light_and_look(&d);
    make_square(&s);
    s.shape.world_from_shape_end = ASIDE;
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape), AG_OK);
    assert_int_equal(ag_scene_commit(d.made), AG_OK);
    assert_int_equal(ag_render_settings_from_scene(d.context, d.made, &settings), AG_OK);
    photon_settings(&settings, NULL);
    assert_int_equal(ag_rendering_create(d.context, d.made, &settings, &rendering), AG_OK);
    assert_int_equal(ag_scene_set_camera(d.made, &eye), AG_ERROR_ARGUMENT);
    expect_said(&d, "ag_scene_set_camera:1:0: error: a rendering of the scene is not finished yet");
    ag_rendering_finish(rendering, NULL);
    assert_int_equal(ag_scene_set_camera(d.made, &eye), AG_OK);
    eye.medium = "water";
    assert_int_equal(ag_scene_set_camera(d.made, &eye), AG_ERROR_ARGUMENT);
    expect_said(&d, "the camera stays in its medium");
    const ag_parameter close = {
        .name = "shutterclose", .type = AG_PARAMETER_FLOAT, .count = 1, .floats = (const float[]){0.5f}};
    eye = ag_default_camera();
    eye.parameters = &close;
    eye.parameter_count = 1;
    assert_int_equal(ag_scene_set_camera(d.made, &eye), AG_ERROR_ARGUMENT);
    expect_said(&d, "what moves was made for another shutter");
    /* destroyed too early, it stays until nobody needs it */
    assert_int_equal(ag_rendering_create(d.context, d.made, &settings, &rendering), AG_OK);
    ag_scene_destroy(d.made);
    d.made = NULL;
    assert_int_equal(ag_rendering_continue(rendering, 1), AG_OK);
    ag_rendering_finish(rendering, NULL);
    end(&d);
}

/* Settings that ask for more than the scene says are heeded as they are for a file. */
static void settings_are_heeded(void **state)
{
    (void)state;
    desk d;
    square s;
    ag_scene *scene;
    ag_scene_settings asked = ag_default_scene_settings();
    float pixels[3 * SIZE * SIZE];
    char sky_file[32] = "gone";
    begin(&d);
    asked.has_camera = true;
    asked.camera_from[2] = -2.0f;
    asked.has_sky = true;
    assert_int_equal(ag_scene_create(d.context, &asked, &scene), AG_OK);
    make_square(&s);
    assert_int_equal(ag_scene_add_shape(scene, &s.shape), AG_OK);
    assert_int_equal(ag_scene_commit(scene), AG_OK);
    render(d.context, scene, pixels);
    const float *middle = &pixels[3 * (SIZE / 2 * SIZE + SIZE / 2)];
    assert_true(fabsf(middle[0] - 0.5f) < 0.1f); /* grey of 0.5 under a sky of 1 */
    ag_scene_destroy(scene);
    asked.sky_file = sky_file;
    assert_int_equal(ag_scene_create(d.context, &asked, &scene), AG_OK);
    memset(sky_file, 'x', sizeof sky_file); /* it was copied */
    assert_int_equal(ag_scene_commit(scene), AG_ERROR_INPUT);
    expect_said(&d, "the sky that is asked for: No such file");
    ag_scene_destroy(scene);
    end(&d);
}

/* A ball under a sun, or what the settings ask for, seen by a camera whose up is z: set before the commit, after it, or
 * both. */
static void render_ball(desk *d, const ag_scene_settings *asked, bool is_before, bool is_after, float *out_pixels)
{
    static const double upright[16] = {1, 0, 0, 0, 0, 0, 1, -3, 0, 1, 0, 0, 0, 0, 0, 1}; /* it looks along y */
    ag_scene *scene;
    ag_shape ball = ag_default_shape();
    ag_camera eye = ag_default_camera();
    eye.world_from_camera = upright;
    ball.type = "sphere";
    assert_int_equal(ag_scene_create(d->context, asked, &scene), AG_OK);
    if (is_before)
        assert_int_equal(ag_scene_set_camera(scene, &eye), AG_OK);
    assert_int_equal(ag_scene_add_shape(scene, &ball), AG_OK);
    assert_int_equal(ag_scene_commit(scene), AG_OK);
    if (is_after)
        assert_int_equal(ag_scene_set_camera(scene, &eye), AG_OK);
    render(d->context, scene, out_pixels);
    ag_scene_destroy(scene);
}

static void settings_take_effect_at_the_commit(void **state)
{
    (void)state;
    enum { COUNT = 3 * SIZE * SIZE };
    desk d;
    float before[COUNT], after[COUNT], both[COUNT], dark[COUNT] = {0};
    ag_scene_settings asked = ag_default_scene_settings();
    begin(&d);
    asked.has_sun = true;
    asked.sun_elevation_degrees = 90.0f;
    render_ball(&d, &asked, true, false, before);
    render_ball(&d, &asked, true, true, both);
    assert_memory_equal(before, both, sizeof both);
    render_ball(&d, &asked, false, true, after); /* without a camera y is up: the sun is behind the ball */
    assert_memory_equal(after, dark, sizeof dark);
    assert_memory_not_equal(before, dark, sizeof dark);
    asked.up = AG_UP_Z;
    render_ball(&d, &asked, false, true, after);
    assert_memory_equal(before, after, sizeof after);

    asked.has_camera = true; /* it takes the place of one that was set before, and not of one after */
    asked.camera_from[0] = -4.0f;
    render_ball(&d, &asked, false, false, after);
    assert_memory_not_equal(before, after, sizeof after);
    render_ball(&d, &asked, true, false, both);
    assert_memory_equal(after, both, sizeof both);
    render_ball(&d, &asked, true, true, both);
    assert_memory_equal(before, both, sizeof both);
    end(&d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(memory_has_the_bits_of_files),
        TEST_IN_FOLDER(public_scenes_have_the_bits_of_files),
        cmocka_unit_test(motion_and_instances_have_the_bits_of_text),
        cmocka_unit_test(what_is_handed_over_is_copied),
        cmocka_unit_test(mistakes_are_named_by_call_and_parameter),
        cmocka_unit_test(matrices_and_order_are_checked),
        cmocka_unit_test(structs_of_other_sizes_are_refused),
        cmocka_unit_test(calls_in_a_wrong_order_are_errors),
        TEST_IN_FOLDER(a_moved_camera_is_as_one_from_the_beginning),
        TEST_IN_FOLDER(pictures_in_memory_have_the_bits_of_files),
        cmocka_unit_test(edits_and_renders_leave_no_memory_behind),
        cmocka_unit_test(a_camera_cannot_change_under_a_rendering),
        cmocka_unit_test(settings_are_heeded),
        cmocka_unit_test(settings_take_effect_at_the_commit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
