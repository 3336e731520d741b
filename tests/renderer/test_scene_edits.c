/* test_scene_edits.c: scenes that are changed, and rendered again: moved cameras have the bits of cameras from the
 * beginning, nothing grows, settings of a scene take effect at its commit.
 * Threads: one. */
#define _GNU_SOURCE
#include "fixtures/layers_fixture.h"
#include "fixtures/pbrt_transcript.h"
#include "fixtures/scene_desk.h"

#include <malloc.h>

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

    /* that camera in a scene which is read anew, and a map of its own */
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
        assert_int_equal(ag_scene_add_shape(d.made, &s.shape, NULL), AG_OK);
        s.shape.type = "cube";
        assert_int_equal(ag_scene_add_shape(d.made, &s.shape, NULL), AG_ERROR_SCENE);
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
    begin_lit(&d);
    make_square(&s);
    s.shape.world_from_shape_end = ASIDE;
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape, NULL), AG_OK);
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
    assert_int_equal(ag_scene_add_shape(scene, &s.shape, NULL), AG_OK);
    assert_int_equal(ag_scene_commit(scene), AG_OK);
    render(d.context, scene, pixels);
    const float *middle = &pixels[3 * (SIZE / 2 * SIZE + SIZE / 2)];
    assert_true(fabsf(middle[0] - 0.5f) < 0.1f); /* grey of 0.5 under a sky of 1 */
    ag_scene_destroy(scene);
    asked.sky_file = sky_file;
    assert_int_equal(ag_scene_create(d.context, &asked, &scene), AG_OK);
    memset(sky_file, 'x', sizeof sky_file); /* it was copied */
    assert_int_equal(ag_scene_commit(scene), AG_ERROR_INPUT);
    expect_said(&d, "the sky that is asked for, \"gone\": No such file");
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
    assert_int_equal(ag_scene_add_shape(scene, &ball, NULL), AG_OK);
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
        TEST_IN_FOLDER(a_moved_camera_is_as_one_from_the_beginning),
        cmocka_unit_test(edits_and_renders_leave_no_memory_behind),
        cmocka_unit_test(a_camera_cannot_change_under_a_rendering),
        cmocka_unit_test(settings_are_heeded),
        cmocka_unit_test(settings_take_effect_at_the_commit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
