/* test_scene_memory.c: scenes that calls put together: the bits of files that say the same, for the scenes of tests and
 * for public ones; pictures in memory stand for files; what is handed over is copied.
 * Threads: one. */
#define _GNU_SOURCE
#include "fixtures/layers_fixture.h"
#include "fixtures/pbrt_transcript.h"
#include "fixtures/sanitizer.h"
#include "fixtures/scene_desk.h"
#include "fixtures/shared_folder.h"
#include "image/image_reader.h"

/* Where everything takes long, one in so many of the scenes that are said both ways is tested. */
enum { SCENE_STEP = IS_SANITIZED ? 4 : 1 };

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
    begin_lit(&d);
    make_square(&s);
    s.shape.world_from_shape_end = ASIDE;
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape, NULL), AG_OK);
    ball.type = "sphere";
    ball.object = instance.object = "ball";
    ball.parameters = &radius;
    ball.parameter_count = 1;
    assert_int_equal(ag_scene_add_shape(d.made, &ball, NULL), AG_OK);
    instance.world_from_object_end = ASIDE;
    assert_int_equal(ag_scene_add_instance(d.made, &instance, NULL), AG_OK);
    instance.world_from_object_end = NULL;
    assert_int_equal(ag_scene_add_instance(d.made, &instance, NULL), AG_OK);
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
    assert_int_equal(ag_scene_add_shape(kept.made, &s.shape, NULL), AG_OK);
    float *positions = malloc(sizeof CORNERS);
    char *name = strdup("P"), *type = strdup("trianglemesh");
    assert_true(positions && name && type);
    memcpy(positions, CORNERS, sizeof CORNERS);
    s.parameters[0].floats = positions;
    s.parameters[0].name = name;
    s.shape.type = type;
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape, NULL), AG_OK);
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
        assert_int_equal(is_as_floats ? image_read_colors(NULL, files[i], &pixels[i], message, sizeof message)
                                      : image_read_compact(NULL, files[i], &pixels[i], message, sizeof message),
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
    assert_int_equal(ag_scene_add_light(d->made, &light, NULL), AG_OK);
    assert_int_equal(ag_scene_add_texture(d->made, &image_map), AG_OK);
    assert_int_equal(ag_scene_add_material(d->made, "m", "diffuse", &reflectance, 1), AG_OK);
    assert_int_equal(ag_scene_add_shape(d->made, &s.shape, NULL), AG_OK);
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(memory_has_the_bits_of_files),
        TEST_IN_FOLDER(public_scenes_have_the_bits_of_files),
        cmocka_unit_test(motion_and_instances_have_the_bits_of_text),
        cmocka_unit_test(what_is_handed_over_is_copied),
        TEST_IN_FOLDER(pictures_in_memory_have_the_bits_of_files),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
