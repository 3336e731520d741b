/* test_film_tiles.c: a picture that is watched while it is rendered: tiles come before the end, a copy that is brought
 * up to date is the picture, versions tell what has changed, and reading by another thread changes no bit.
 * Threads: many. */
#define _GNU_SOURCE
#include "fixtures/layers_fixture.h"

#include "film/film_tiles.h"

#include <pthread.h>
#include <stdatomic.h>

enum { WIDTH = 75, HEIGHT = 70, TILE_FLOATS = 3 * AG_TILE_SIZE * AG_TILE_SIZE };

typedef struct watched {
    ag_context *context;
    ag_scene *scene;
    ag_rendering *rendering;
    const ag_film *film;
    uint64_t version;
    int width, height;
    float *copy;       /* of the picture, brought up to date by callbacks or a thread */
    int tiles_seen;    /* most tiles that a callback has seen, before the end */
    int updates;       /* how often a callback has seen a change */
    atomic_bool ended; /* for the thread */
} watched;

static int count_shown(const ag_film *film)
{
    float pixels[TILE_FLOATS];
    ag_tile tile;
    int count = 0;
    for (size_t i = 0; i < ag_film_tile_count(film); i++)
        count += ag_film_read_tile(film, i, 0, &tile, pixels);
    return count;
}

static void watch(void *user, ag_phase phase, double fraction)
{
    watched *w = user;
    if (phase != AG_PHASE_RENDER || !w->film || fraction >= 1.0)
        return;
    const uint64_t before = w->version;
    w->version = ag_film_read_picture(w->film, w->version, w->copy);
    w->updates += w->version != before;
    const int shown = count_shown(w->film);
    w->tiles_seen = shown > w->tiles_seen ? shown : w->tiles_seen;
}

static void begin(watched *w, unsigned threads, bool by_callback)
{
    *w = (watched){.ended = false};
    ag_context_settings made = ag_default_context_settings();
    ag_render_settings settings;
    made.thread_count = threads;
    made.user = w;
    made.progress = by_callback ? watch : NULL;
    assert_int_equal(ag_context_create(&made, &w->context), AG_OK);
    assert_int_equal(ag_scene_load(w->context, LAYERS_SCENES "glass_and_metal.pbrt", &w->scene), AG_OK);
    assert_int_equal(ag_render_settings_from_scene(w->context, w->scene, &settings), AG_OK);
    settings.width = WIDTH + 14;
    settings.height = HEIGHT + 3;
    settings.crop_window[0] = 13.0 / settings.width; /* neither at a tile's nor at a block's edge */
    settings.crop_window[1] = 1.0 - 1.0 / settings.width;
    settings.crop_window[2] = 3.0 / settings.height;
    settings.samples_per_pixel = 6;
    settings.photon_count = settings.caustic_photon_count = 3000;
    settings.gather_samples = 4;
    settings.noise_level = 0.001f;
    settings.noise_min_samples = 2;
    assert_int_equal(ag_rendering_create(w->context, w->scene, &settings, &w->rendering), AG_OK);
    const ag_film *film = ag_rendering_film(w->rendering);
    ag_film_pixels(film, &w->width, &w->height);
    assert_int_equal(w->width, WIDTH);
    assert_int_equal(w->height, HEIGHT);
    w->copy = calloc(3 * WIDTH * HEIGHT, sizeof *w->copy);
    assert_non_null(w->copy);
    w->film = film;
}

static void end(watched *w)
{
    ag_rendering_finish(w->rendering, NULL);
    ag_scene_destroy(w->scene);
    ag_context_destroy(w->context);
    free(w->copy);
}

static void expect_copy_is_picture(const watched *w)
{
    int width, height;
    assert_memory_equal(w->copy, ag_film_pixels(w->film, &width, &height), 3 * WIDTH * HEIGHT * sizeof *w->copy);
}

static void tiles_come_before_the_end(void **state)
{
    (void)state;
    watched w;
    begin(&w, 1, true);
    assert_int_equal(ag_film_tile_count(w.film), 9); /* 3 by 3 */
    assert_int_equal(count_shown(w.film), 0);
    assert_int_equal(ag_rendering_continue(w.rendering, 6), AG_OK);
    assert_in_range(w.tiles_seen, 1, 9);
    assert_in_range(w.updates, 3, 10000);
    assert_int_equal(count_shown(w.film), 9);
    w.version = ag_film_read_picture(w.film, w.version, w.copy);
    expect_copy_is_picture(&w);
    end(&w);
}

static void versions_tell_what_has_changed(void **state)
{
    (void)state;
    watched w;
    float pixels[TILE_FLOATS + 1];
    ag_tile tile = {.width = -1};
    begin(&w, 2, false);
    assert_false(ag_film_read_tile(w.film, 0, 0, &tile, pixels));
    assert_int_equal(tile.width, -1);
    assert_int_equal(ag_film_read_picture(w.film, 0, w.copy), 0);
    assert_int_equal(ag_rendering_continue(w.rendering, 1), AG_OK);
    const uint64_t version = ag_film_read_picture(w.film, 0, w.copy);
    expect_copy_is_picture(&w);
    int covered[WIDTH * HEIGHT] = {0}, width, height;
    const float *picture = ag_film_pixels(w.film, &width, &height);
    for (size_t i = 0; i < ag_film_tile_count(w.film); i++) {
        pixels[TILE_FLOATS] = 17.0f;
        assert_true(ag_film_read_tile(w.film, i, 0, &tile, pixels));
        assert_true(tile.version > 0 && tile.version <= version);
        for (int y = 0; y < tile.height; y++)
            for (int x = 0; x < tile.width; x++) {
                const int at = (tile.y + y) * WIDTH + tile.x + x;
                covered[at]++;
                assert_memory_equal(&pixels[3 * (y * tile.width + x)], &picture[3 * at], 3 * sizeof *pixels);
            }
        assert_true(pixels[TILE_FLOATS] == 17.0f);
        assert_false(ag_film_read_tile(w.film, i, tile.version, &tile, pixels));
    }
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        assert_int_equal(covered[i], 1);
    assert_int_equal(ag_film_read_picture(w.film, version, w.copy), version); /* nothing has changed */
    assert_int_equal(ag_rendering_continue(w.rendering, 3), AG_OK);
    assert_true(ag_film_read_picture(w.film, version, w.copy) > version);
    expect_copy_is_picture(&w);

    assert_false(ag_film_read_tile(w.film, 9, 0, &tile, pixels));
    assert_false(ag_film_read_tile(NULL, 0, 0, &tile, pixels));
    assert_false(ag_film_read_tile(w.film, 0, 0, NULL, pixels));
    assert_false(ag_film_read_tile(w.film, 0, 0, &tile, NULL));
    assert_int_equal(ag_film_tile_count(NULL), 0);
    assert_int_equal(ag_film_read_picture(NULL, 5, w.copy), 5);
    end(&w);
}

/* This runs in a thread, where nothing may be asserted. */
static void *read_all_along(void *user)
{
    watched *w = user;
    while (!atomic_load(&w->ended)) {
        w->version = ag_film_read_picture(w->film, w->version, w->copy);
        const struct timespec pause = {.tv_nsec = 200000};
        nanosleep(&pause, NULL);
    }
    w->version = ag_film_read_picture(w->film, w->version, w->copy);
    return NULL;
}

static void another_thread_may_read(void **state)
{
    (void)state;
    watched w, alone;
    pthread_t reader;
    int width, height;
    begin(&w, 2, false);
    begin(&alone, 1, false);
    assert_int_equal(pthread_create(&reader, NULL, read_all_along, &w), 0);
    const ag_status status = ag_rendering_continue(w.rendering, 6);
    atomic_store(&w.ended, true);
    assert_int_equal(pthread_join(reader, NULL), 0);
    assert_int_equal(status, AG_OK);
    expect_copy_is_picture(&w);
    assert_int_equal(ag_rendering_continue(alone.rendering, 6), AG_OK);
    assert_memory_equal(w.copy, ag_film_pixels(alone.film, &width, &height), 3 * WIDTH * HEIGHT * sizeof *w.copy);
    end(&alone);
    end(&w);
}

static void a_change_behind_the_lock_is_of_all_tiles(void **state)
{
    (void)state;
    watched w;
    begin(&w, 2, false);
    assert_int_equal(ag_rendering_continue(w.rendering, 1), AG_OK);
    w.version = ag_film_read_picture(w.film, 0, w.copy);
    film_tiles_begin_change(w.film->tiles);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        w.film->pixels[i] += 1.0f;
    film_tiles_end_change(w.film->tiles);
    assert_true(ag_film_read_picture(w.film, w.version, w.copy) > w.version);
    expect_copy_is_picture(&w);
    end(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tiles_come_before_the_end),
        cmocka_unit_test(versions_tell_what_has_changed),
        cmocka_unit_test(another_thread_may_read),
        cmocka_unit_test(a_change_behind_the_lock_is_of_all_tiles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
