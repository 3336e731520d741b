/* test_last_frame_edits.c: a scene from memory that is changed and rendered again with fixed photon paths: irradiances
 * are kept from picture to picture, and each has the bits of a scene that was made afresh.
 * Threads: one. */
#define _GNU_SOURCE
#include "fixtures/scene_desk.h"

enum { VALUES = 3 * SIZE * SIZE };

/* The values of a test scene of two squares that face each other, with a ball between them. */
typedef struct contents {
    double ball_x, camera_x;
    bool is_red, has_plate;
} contents;

typedef struct handles {
    ag_handle wall, ball, plate;
} handles;

static void place(double out[16], double x, double y, double z)
{
    const double at[16] = {1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z, 0, 0, 0, 1};
    memcpy(out, at, sizeof at);
}

static ag_handle add_square(desk *d, double z, double y, const char *material)
{
    square s;
    double at[16];
    ag_handle handle;
    make_square(&s);
    place(at, 0, y, z);
    s.shape.world_from_shape = at;
    s.shape.material = material;
    assert_int_equal(ag_scene_add_shape(d->made, &s.shape, &handle), AG_OK);
    return handle;
}

static void look(desk *d, double x)
{
    double at[16];
    ag_camera eye = ag_default_camera();
    place(at, x, 0, -2);
    eye.world_from_camera = at;
    assert_int_equal(ag_scene_set_camera(d->made, &eye), AG_OK);
}

static handles say(desk *d, const contents *c)
{
    const ag_parameter red = {"reflectance", AG_PARAMETER_RGB, 3, .floats = (const float[]){.7f, .2f, .2f}};
    const ag_parameter radius = {"radius", AG_PARAMETER_FLOAT, 1, .floats = (const float[]){.05f}};
    double at[16];
    handles h = {0};
    ag_shape ball = ag_default_shape();
    assert_int_equal(ag_scene_add_material(d->made, "red", "diffuse", &red, 1), AG_OK);
    look(d, c->camera_x);
    h.wall = add_square(d, 0, 0, c->is_red ? "red" : NULL);
    add_square(d, -4, 0, NULL);
    place(at, c->ball_x, .5, -1);
    ball.type = "sphere";
    ball.parameters = &radius;
    ball.parameter_count = 1;
    ball.world_from_shape = at;
    assert_int_equal(ag_scene_add_shape(d->made, &ball, &h.ball), AG_OK);
    if (c->has_plate)
        h.plate = add_square(d, -.01, 1.9, NULL);
    return h;
}

static uint64_t render_steadily(desk *d, float out[VALUES])
{
    ag_render_settings settings;
    ag_film *film;
    int width, height;
    const uint64_t before = ag_context_statistics(d->context).irradiance_kept;
    assert_int_equal(ag_scene_commit(d->made), AG_OK);
    assert_int_equal(ag_render_settings_from_scene(d->context, d->made, &settings), AG_OK);
    settings.width = settings.height = SIZE;
    settings.samples_per_pixel = 2;
    settings.gather_samples = 16;
    settings.nearest = 10;
    settings.photon_paths = 100000;
    settings.cache = AG_CACHE_PRECOMPUTE;
    assert_int_equal(ag_render(d->context, d->made, &settings, &film), AG_OK);
    memcpy(out, ag_film_pixels(film, &width, &height), VALUES * sizeof *out);
    ag_film_destroy(film);
    return ag_context_statistics(d->context).irradiance_kept - before;
}

/* Renders the changed scene, and one with the same contents from the beginning. Returns how many are kept. */
static uint64_t expect_fresh(desk *d, const contents *c, bool is_other, float last[VALUES])
{
    desk fresh;
    float follows[VALUES], alone[VALUES];
    const uint64_t kept = render_steadily(d, follows);
    begin_lit(&fresh);
    say(&fresh, c);
    assert_int_equal(render_steadily(&fresh, alone), 0);
    assert_memory_equal(follows, alone, sizeof alone);
    if (is_other)
        assert_memory_not_equal(follows, last, sizeof alone);
    memcpy(last, follows, sizeof follows);
    end(&fresh);
    return kept;
}

static void test_edits(void **state)
{
    (void)state;
    desk d;
    double at[16];
    float last[VALUES];
    contents c = {.ball_x = .2};
    begin_lit_editable(&d);
    handles h = say(&d, &c);
    assert_int_equal(expect_fresh(&d, &c, false, last), 0);
    const uint64_t photons = ag_context_statistics(d.context).photons_stored_global;

    c.ball_x = .25;
    place(at, c.ball_x, .5, -1);
    assert_int_equal(ag_scene_move(d.made, h.ball, at, NULL), AG_OK);
    assert_true(expect_fresh(&d, &c, true, last) > photons / 2);

    c.camera_x = .1;
    look(&d, c.camera_x);
    assert_true(expect_fresh(&d, &c, true, last) > photons - photons / 50);

    c.is_red = true;
    assert_int_equal(ag_scene_assign_material(d.made, h.wall, "red"), AG_OK);
    expect_fresh(&d, &c, true, last);

    c.has_plate = true;
    h.plate = add_square(&d, -.01, 1.9, NULL);
    expect_fresh(&d, &c, true, last);

    c.has_plate = false;
    assert_int_equal(ag_scene_remove(d.made, h.plate), AG_OK);
    expect_fresh(&d, &c, true, last);
    assert_string_equal(d.said, "");
    end(&d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test_setup_teardown(test_edits, make_folder, remove_folder)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
