/* test_rendering_view.c: a rendering of the scene from elsewhere, beside another and on its photon map: it has the bits
 * of a fresh one of that camera on the same map, the other keeps its own, and either may end first; going back to whole
 * passes.
 * Threads: one. */
#define _GNU_SOURCE
#include "fixtures/layers_fixture.h"
#include "fixtures/scene_desk.h"

enum { SAMPLES = 4, VALUES = 3 * SIZE * SIZE };
static const float FROM[3] = {0.2f, 1.1f, 3.7f}, TO[3] = {0.1f, 0.9f, 0.2f}, UP[3] = {0, 1, 0};

typedef struct bench {
    desk d;
    ag_scene *scene;
    ag_render_settings settings;
    ag_rendering *first;
} bench;

static ag_render_settings settings_with(const bench *b, const char *map)
{
    ag_render_settings settings;
    assert_int_equal(ag_render_settings_from_scene(b->d.context, b->scene, &settings), AG_OK);
    settings.width = settings.height = SIZE;
    settings.samples_per_pixel = SAMPLES;
    settings.photon_count = 3000;
    settings.photon_map_file = map;
    return settings;
}

static void open_bench(bench *b, const char *map)
{
    begin(&b->d);
    assert_int_equal(ag_scene_load(b->d.context, LAYERS_SCENES "box_with_blocks.pbrt", &b->scene), AG_OK);
    b->settings = settings_with(b, map);
    assert_int_equal(ag_rendering_create(b->d.context, b->scene, &b->settings, &b->first), AG_OK);
}

static void close_bench(bench *b)
{
    ag_rendering_finish(b->first, NULL);
    ag_scene_destroy(b->scene);
    end(&b->d);
}

static void copy_pixels(const ag_rendering *r, float out[VALUES])
{
    int width, height;
    memcpy(out, ag_film_pixels(ag_rendering_film(r), &width, &height), VALUES * sizeof *out);
    assert_int_equal(width * height, SIZE * SIZE);
}

/* The picture of a fresh process, as it were: of the command line's camera, on the kept map. */
static void render_fresh(const char *map, const float fov, float out[VALUES])
{
    bench b;
    ag_scene_settings asked = ag_default_scene_settings();
    begin(&b.d);
    asked.has_camera = true;
    memcpy(asked.camera_from, FROM, sizeof FROM);
    memcpy(asked.camera_to, TO, sizeof TO);
    memcpy(asked.camera_up, UP, sizeof UP);
    asked.camera_fov_degrees = fov;
    assert_int_equal(ag_scene_load_as(b.d.context, LAYERS_SCENES "box_with_blocks.pbrt", &asked, &b.scene), AG_OK);
    b.settings = settings_with(&b, map);
    assert_int_equal(ag_rendering_create(b.d.context, b.scene, &b.settings, &b.first), AG_OK);
    assert_int_equal(ag_rendering_continue(b.first, SAMPLES), AG_OK);
    assert_int_equal(ag_context_statistics(b.d.context).map_file, AG_MAP_FILE_OPENED);
    copy_pixels(b.first, out);
    close_bench(&b);
}

static void a_view_has_the_bits_of_a_fresh_rendering(void **state)
{
    (void)state;
    bench b, alone;
    ag_rendering *view;
    float from[3], to[3], up[3], right[3], fov, seen[VALUES], fresh[VALUES], picture[VALUES], expected[VALUES];
    char map[256];
    snprintf(map, sizeof map, "%s", in_folder("view.map"));
    open_bench(&b, map);
    ag_rendering_find_place(b.first, from, to, up, right, &fov);
    assert_true(fov > 0.0f);
    assert_int_equal(ag_rendering_continue(b.first, 1), AG_OK);
    assert_int_equal(ag_rendering_create_view(b.first, FROM, TO, UP, 1, &view), AG_OK);
    assert_int_equal(ag_rendering_continue(view, 1), AG_OK); /* in turns */
    assert_int_equal(ag_rendering_continue(b.first, 2), AG_OK);
    assert_int_equal(ag_rendering_continue(view, SAMPLES), AG_OK);
    copy_pixels(view, seen);
    ag_rendering_finish(view, NULL);
    assert_int_equal(ag_rendering_continue(b.first, SAMPLES), AG_OK);
    copy_pixels(b.first, picture);
    const ag_statistics under_way = ag_rendering_statistics(b.first);
    close_bench(&b);
    render_fresh(map, fov, fresh);
    assert_memory_equal(seen, fresh, sizeof seen);
    assert_memory_not_equal(seen, picture, sizeof seen);
    assert_true(under_way.irradiance_requests > 0 && under_way.irradiance_duplicated == 0);

    open_bench(&alone, NULL);
    alone.settings.photon_map_file = map;
    ag_rendering_finish(alone.first, NULL);
    assert_int_equal(ag_rendering_create(alone.d.context, alone.scene, &alone.settings, &alone.first), AG_OK);
    assert_int_equal(ag_rendering_continue(alone.first, SAMPLES), AG_OK);
    copy_pixels(alone.first, expected);
    close_bench(&alone);
    assert_memory_equal(picture, expected, sizeof picture);
}

/* Two renderings share a map in memory, and either may end first; what each asked for is counted once. */
static void either_may_end_first(void **state)
{
    (void)state;
    bench b;
    ag_rendering *view, *other;
    float seen[2][VALUES];
    open_bench(&b, NULL);
    assert_int_equal(ag_rendering_create_view(b.first, FROM, TO, UP, 1, &view), AG_OK);
    assert_int_equal(ag_rendering_continue(b.first, 1), AG_OK);
    const uint64_t asked = ag_rendering_statistics(b.first).irradiance_requests;
    assert_true(asked > 0);
    const ag_growth growth = ag_rendering_growth(view); /* of the map that both share */
    assert_int_equal(growth.irradiance_requests, asked);
    assert_true(growth.irradiance_computed > 0 && growth.irradiance_computed <= growth.irradiance_photons);
    assert_true(growth.photon_density > 0.0);
    assert_int_equal(ag_context_statistics(b.d.context).irradiance_requests, 0);
    ag_rendering_finish(b.first, NULL);
    b.first = NULL;
    assert_int_equal(ag_context_statistics(b.d.context).irradiance_requests, asked);
    assert_int_equal(ag_rendering_continue(view, SAMPLES), AG_OK);
    assert_int_equal(ag_rendering_create_view(view, FROM, TO, UP, 1, &other), AG_OK);
    assert_int_equal(ag_rendering_continue(other, SAMPLES), AG_OK);
    copy_pixels(view, seen[0]);
    copy_pixels(other, seen[1]);
    assert_memory_equal(seen[0], seen[1], sizeof seen[0]);
    ag_rendering_finish(view, NULL);
    ag_rendering_finish(other, NULL);
    const ag_statistics done = ag_context_statistics(b.d.context);
    assert_true(done.irradiance_requests > asked);
    assert_int_equal(done.irradiance_computed, done.irradiance_distinct);
    close_bench(&b);
}

static void a_place_can_be_found_and_gone_to(void **state)
{
    (void)state;
    bench b;
    ag_rendering *view, *none = NULL;
    float from[3], to[3], up[3], right[3], fov;
    static const float nan3[3] = {NAN, 0, 0};
    open_bench(&b, NULL);
    assert_int_equal(ag_rendering_create_view(b.first, FROM, TO, UP, 1, &view), AG_OK);
    ag_rendering_find_place(view, from, to, up, right, &fov);
    float along = 0.0f, length = 0.0f;
    for (int i = 0; i < 3; i++) {
        assert_true(fabsf(from[i] - FROM[i]) < 1e-6f);
        along += (to[i] - from[i]) * (TO[i] - FROM[i]);
        length += (TO[i] - FROM[i]) * (TO[i] - FROM[i]);
    }
    assert_true(along > 0.0f && right[0] < -0.9f && up[1] > 0.9f && length > 0.0f);
    ag_rendering_finish(view, NULL);
    assert_int_equal(ag_rendering_create_view(b.first, FROM, FROM, UP, 1, &none), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_rendering_create_view(b.first, nan3, TO, UP, 1, &none), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_rendering_create_view(b.first, FROM, TO, (const float[3]){0}, 1, &none), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_rendering_create_view(b.first, FROM, TO, UP, 0, &none), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_rendering_create_view(NULL, FROM, TO, UP, 1, &none), AG_ERROR_ARGUMENT);
    assert_null(none);
    close_bench(&b);
}

static void a_coarse_view_shows_the_same(void **state)
{
    (void)state;
    bench b;
    ag_rendering *view[2];
    double mean[2] = {0.0, 0.0};
    open_bench(&b, NULL);
    for (int i = 0; i < 2; i++) {
        int width, height;
        assert_int_equal(ag_rendering_create_view(b.first, FROM, TO, UP, i == 0 ? 1 : 4, &view[i]), AG_OK);
        assert_int_equal(ag_rendering_continue(view[i], SAMPLES), AG_OK);
        const float *pixels = ag_film_pixels(ag_rendering_film(view[i]), &width, &height);
        assert_int_equal(width, i == 0 ? SIZE : SIZE / 4);
        assert_int_equal(height, i == 0 ? SIZE : SIZE / 4);
        for (int k = 0; k < 3 * width * height; k++)
            mean[i] += (double)pixels[k] / (3.0 * width * height);
        ag_rendering_finish(view[i], NULL);
    }
    assert_true(fabs(mean[1] - mean[0]) < 0.15 * mean[0]);
    close_bench(&b);
}

/* A pass that is cut leaves pixels with more samples, which going back drops; going on has the bits of never going. */
static void whole_passes_are_gone_back_to(void **state)
{
    (void)state;
    bench b;
    float whole[VALUES], back[VALUES], expected[VALUES], final[VALUES];
    open_bench(&b, NULL);
    assert_int_equal(ag_rendering_go_back(b.first), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_rendering_keep_passes(b.first), AG_OK);
    assert_int_equal(ag_rendering_go_back(b.first), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_rendering_continue(b.first, 2), AG_OK);
    copy_pixels(b.first, whole);
    ag_context_pause(b.d.context);
    assert_int_equal(ag_rendering_continue(b.first, SAMPLES), AG_PAUSED);
    assert_int_equal(ag_rendering_go_back(b.first), AG_OK);
    copy_pixels(b.first, back);
    assert_memory_equal(whole, back, sizeof whole);
    const ag_sample_counts counts = ag_rendering_sample_counts(b.first);
    assert_true(counts.least == 2 && counts.most == 2);
    assert_int_equal(ag_rendering_continue(b.first, SAMPLES), AG_OK);
    copy_pixels(b.first, final);
    close_bench(&b);
    open_bench(&b, NULL);
    assert_int_equal(ag_rendering_continue(b.first, SAMPLES), AG_OK);
    copy_pixels(b.first, expected);
    close_bench(&b);
    assert_memory_equal(final, expected, sizeof final);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(a_view_has_the_bits_of_a_fresh_rendering),
        TEST_IN_FOLDER(either_may_end_first),
        TEST_IN_FOLDER(a_place_can_be_found_and_gone_to),
        TEST_IN_FOLDER(a_coarse_view_shows_the_same),
        TEST_IN_FOLDER(whole_passes_are_gone_back_to),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
