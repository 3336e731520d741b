/* test_hostile_hosts.c: hosts that misuse the public interface get errors and no crash: NULL in the place of every
 * pointer that may not be, values that no enum has, a context that goes before its scenes, scenes with a
 * context of other settings.
 * Threads: one. */
#define _GNU_SOURCE
#include "atomics.h"
#include "fixtures/scene_desk.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <sys/stat.h>
#include <unistd.h>

/* A scene that is complete, one that is open, and what was made of the first. */
typedef struct host {
    desk d; /* its scene is the complete one */
    ag_scene *open;
    ag_rendering *rendering;
    ag_render_settings settings;
    ag_film *film;
    atomic_u32 is_waiting; /* only the thread that waits writes it, and it orders nothing: relaxed */
} host;

static void begin_host(host *h)
{
    square s;
    begin(&h->d);
    make_square(&s);
    light_and_look(&h->d);
    assert_int_equal(ag_scene_add_shape(h->d.made, &s.shape, NULL), AG_OK);
    assert_int_equal(ag_scene_commit(h->d.made), AG_OK);
    assert_int_equal(ag_scene_create(h->d.context, NULL, &h->open), AG_OK);
    assert_int_equal(ag_render_settings_from_scene(h->d.context, h->d.made, &h->settings), AG_OK);
    h->settings.width = h->settings.height = 4;
    h->settings.samples_per_pixel = 2;
    h->settings.photon_count = h->settings.caustic_photon_count = 100;
    h->settings.gather_samples = 2;
    h->settings.noise_level = 0.0f;
    assert_int_equal(ag_render(h->d.context, h->d.made, &h->settings, &h->film), AG_OK);
    assert_int_equal(ag_rendering_create(h->d.context, h->d.made, &h->settings, &h->rendering), AG_OK);
}

static void end_host(host *h)
{
    ag_rendering_finish(h->rendering, NULL);
    ag_film_destroy(h->film);
    ag_scene_destroy(h->open);
    end(&h->d);
}

#define REFUSED(call) assert_int_equal(call, AG_ERROR_ARGUMENT)

static void null_is_refused_by_contexts_and_scenes(void **state)
{
    (void)state;
    host h;
    ag_scene *scene = NULL;
    const char *text, *other;
    begin_host(&h);
    ag_context *context = h.d.context;
    REFUSED(ag_context_create(NULL, NULL));
    REFUSED(ag_color_summary(NULL, &text));
    REFUSED(ag_color_summary(context, NULL));
    REFUSED(ag_color_view_at(NULL, 0, &text, &other));
    REFUSED(ag_color_view_at(context, 0, NULL, &other));
    REFUSED(ag_color_view_at(context, 0, &text, NULL));
    assert_int_equal(ag_context_thread_count(NULL), 0);
    ag_context_cancel(NULL);
    ag_context_clear_cancel(NULL);
    ag_context_pause(NULL);
    ag_context_take_frame(NULL, context);
    ag_context_take_frame(context, NULL);
    ag_context_expect_host_memory(NULL, 1);
    ag_context_note_end(NULL, AG_END_SAMPLES);
    REFUSED(ag_scene_load(NULL, "none.pbrt", &scene));
    REFUSED(ag_scene_load(context, NULL, &scene));
    REFUSED(ag_scene_load(context, "none.pbrt", NULL));
    REFUSED(ag_scene_load_text(NULL, "t", "WorldBegin", 10, NULL, &scene));
    REFUSED(ag_scene_load_text(context, NULL, "WorldBegin", 10, NULL, &scene));
    REFUSED(ag_scene_load_text(context, "t", NULL, 10, NULL, &scene));
    REFUSED(ag_scene_load_text(context, "t", "WorldBegin", 10, NULL, NULL));
    assert_null(scene);
    REFUSED(ag_scene_commit(NULL));
    REFUSED(ag_scene_add_material(NULL, "a", "diffuse", NULL, 0));
    REFUSED(ag_scene_add_material(h.open, NULL, "diffuse", NULL, 0));
    REFUSED(ag_scene_add_material(h.open, "a", NULL, NULL, 0));
    REFUSED(ag_scene_add_material(h.open, "a", "diffuse", NULL, 1));
    REFUSED(ag_scene_add_medium(NULL, "a", "homogeneous", NULL, 0));
    REFUSED(ag_scene_add_image(h.open, "a", NULL));
    REFUSED(ag_scene_add_texture(h.open, NULL));
    REFUSED(ag_scene_add_shape(h.open, NULL, NULL));
    REFUSED(ag_scene_add_instance(h.open, NULL, NULL));
    REFUSED(ag_scene_add_light(h.open, NULL, NULL));
    REFUSED(ag_scene_set_camera(NULL, NULL));
    REFUSED(ag_scene_set_camera(h.open, NULL));
    REFUSED(ag_scene_set_hint(h.open, AG_HINT_FILM, NULL, NULL, 0));
    REFUSED(ag_scene_move(NULL, 1, AWAY, NULL));
    REFUSED(ag_scene_remove(NULL, 1));
    REFUSED(ag_scene_remove_named(h.open, AG_NAMED_MATERIAL, NULL));
    assert_null(ag_scene_film_file_name(NULL));
    assert_false(ag_scene_has_own_samples(NULL));
    assert_false(ag_scene_was_read_from(NULL, __FILE__));
    assert_false(ag_scene_was_read_from(h.d.made, NULL));
    assert_int_equal(ag_scene_commit_counts(NULL).commits, 0);
    end_host(&h);
}

static void null_is_refused_by_renderings(void **state)
{
    (void)state;
    host h;
    ag_film *film = NULL;
    ag_rendering *rendering = NULL;
    float v[4][3] = {{0, 0, -2}, {0, 0, 0}, {0, 1, 0}}, fov;
    begin_host(&h);
    ag_context *context = h.d.context;
    REFUSED(ag_render_settings_from_scene(NULL, h.d.made, &h.settings));
    REFUSED(ag_render_settings_from_scene(context, NULL, &h.settings));
    REFUSED(ag_render_settings_set(NULL, "spp", "4"));
    REFUSED(ag_render_settings_set(&h.settings, NULL, "4"));
    REFUSED(ag_render(NULL, h.d.made, &h.settings, &film));
    REFUSED(ag_render(context, NULL, &h.settings, &film));
    REFUSED(ag_render(context, h.d.made, NULL, &film));
    REFUSED(ag_render(context, h.d.made, &h.settings, NULL));
    REFUSED(ag_rendering_create(context, h.d.made, &h.settings, NULL));
    REFUSED(ag_rendering_create_view(NULL, v[0], v[1], v[2], 1, &rendering));
    REFUSED(ag_rendering_create_view(h.rendering, NULL, v[1], v[2], 1, &rendering));
    REFUSED(ag_rendering_create_view(h.rendering, v[0], NULL, v[2], 1, &rendering));
    REFUSED(ag_rendering_create_view(h.rendering, v[0], v[1], NULL, 1, &rendering));
    REFUSED(ag_rendering_create_view(h.rendering, v[0], v[1], v[2], 1, NULL));
    assert_true(!film && !rendering);
    REFUSED(ag_rendering_continue(NULL, 1));
    REFUSED(ag_rendering_keep_passes(NULL));
    REFUSED(ag_rendering_go_back(NULL));
    REFUSED(ag_rendering_write_checkpoint(NULL, in_folder("a")));
    REFUSED(ag_rendering_write_checkpoint(h.rendering, NULL));
    REFUSED(ag_rendering_read_checkpoint(NULL, in_folder("a")));
    REFUSED(ag_rendering_read_checkpoint(h.rendering, NULL));
    REFUSED(ag_rendering_write_photons(NULL, in_folder("a")));
    REFUSED(ag_rendering_write_photons(h.rendering, NULL));
    assert_null(ag_rendering_film(NULL));
    assert_int_equal(ag_rendering_sample_counts(NULL).most, 0);
    ag_rendering_finish(NULL, NULL);
    ag_rendering_find_place(NULL, v[0], v[1], v[2], v[3], &fov);
    ag_rendering_find_place(h.rendering, NULL, v[1], v[2], v[3], &fov);
    ag_rendering_find_place(h.rendering, v[0], NULL, v[2], v[3], &fov);
    ag_rendering_find_place(h.rendering, v[0], v[1], NULL, v[3], &fov);
    ag_rendering_find_place(h.rendering, v[0], v[1], v[2], NULL, &fov);
    ag_rendering_find_place(h.rendering, v[0], v[1], v[2], v[3], NULL);
    end_host(&h);
}

/* Structs that the library fills: without their object they are zeros, but for their size. */
static void null_is_refused_by_what_fills_structs(void **state)
{
    (void)state;
    host h;
    begin_host(&h);
    const ag_statistics s = ag_context_statistics(NULL), r = ag_rendering_statistics(NULL);
    assert_true(s.struct_size == sizeof s && s.threads == 0 && r.struct_size == sizeof r && r.threads == 0);
    assert_true(ag_context_prediction(NULL).memory_needed_bytes == 0);
    assert_true(ag_rendering_growth(NULL).irradiance_photons == 0);
    assert_true(ag_rendering_noise(NULL).level < 0);
    ag_context_statistics_fill(h.d.context, NULL, sizeof s);
    ag_context_prediction_fill(h.d.context, NULL, 64);
    ag_rendering_statistics_fill(h.rendering, NULL, sizeof s);
    ag_rendering_growth_fill(h.rendering, NULL, 64);
    ag_rendering_noise_fill(h.rendering, NULL, 64);
    ag_struct_fill(AG_STRUCT_SHAPE, NULL, sizeof(ag_shape));
    ag_struct_fill(AG_STRUCT_RENDER_SETTINGS, NULL, sizeof(ag_render_settings));
    REFUSED(ag_predict_fill(h.d.context, h.d.made, &h.settings, NULL, sizeof(ag_prediction)));
    REFUSED(ag_predict_memory_fill(h.d.context, h.d.made, &h.settings, NULL, sizeof(ag_prediction)));
    REFUSED(ag_photon_map_read_info_fill(h.d.context, in_folder("none.map"), NULL, 64));
    end_host(&h);
}

static void null_is_refused_by_films_and_files(void **state)
{
    (void)state;
    host h;
    ag_tile tile;
    ag_view *view;
    int width = 7, height = 7;
    float values[3 * AG_TILE_SIZE * AG_TILE_SIZE];
    char name[8];
    begin_host(&h);
    ag_context *context = h.d.context;
    assert_null(ag_film_pixels(NULL, &width, &height));
    assert_true(width == 0 && height == 0);
    assert_non_null(ag_film_pixels(h.film, NULL, NULL));
    ag_film_chromaticities(NULL, values);
    ag_film_chromaticities(h.film, NULL);
    assert_int_equal(ag_film_channel_count(NULL), 0);
    assert_null(ag_film_channel_name(NULL, 0));
    REFUSED(ag_film_read_channel(NULL, 0, values));
    REFUSED(ag_film_read_channel(h.film, 0, NULL));
    assert_false(ag_film_matte_name(NULL, AG_LAYER_CRYPTO_OBJECT, 1, name, sizeof name));
    assert_int_equal(ag_film_tile_count(NULL), 0);
    assert_false(ag_film_read_tile(NULL, 0, 0, &tile, values));
    assert_false(ag_film_read_tile(h.film, 0, 0, NULL, values));
    assert_false(ag_film_read_tile(h.film, 0, 0, &tile, NULL));
    assert_int_equal(ag_film_read_picture(NULL, 0, values), 0);
    ag_film_read_picture(h.film, 0, NULL);
    REFUSED(ag_film_denoise(NULL, h.film));
    REFUSED(ag_film_denoise(context, NULL));
    REFUSED(ag_denoise_check(NULL));
    REFUSED(ag_film_write(NULL, h.film, NULL, in_folder("a.exr")));
    REFUSED(ag_film_write(context, NULL, NULL, in_folder("a.exr")));
    REFUSED(ag_film_write(context, h.film, NULL, NULL));
    REFUSED(ag_output_check(NULL, NULL, in_folder("a.exr")));
    REFUSED(ag_output_check(context, NULL, NULL));
    REFUSED(ag_view_create(NULL, NULL, &view));
    REFUSED(ag_view_create(context, NULL, NULL));
    REFUSED(ag_view_apply(NULL, values, 1));
    REFUSED(ag_layers_parse(NULL, NULL));
    REFUSED(ag_statistics_check(NULL, in_folder("a.json")));
    REFUSED(ag_statistics_check(context, NULL));
    REFUSED(ag_statistics_write(NULL, in_folder("a.json")));
    REFUSED(ag_statistics_write(context, NULL));
    REFUSED(ag_photon_map_check(NULL, in_folder("a.map")));
    REFUSED(ag_photon_map_check(context, NULL));
    assert_int_not_equal(access(in_folder("a.exr"), F_OK), 0);
    end_host(&h);
}

static void values_that_no_enum_has_are_refused(void **state)
{
    (void)state;
    host h;
    ag_film *film = NULL;
    ag_scene *scene = NULL;
    ag_view *view = NULL;
    begin_host(&h);
    for (int k = 0; k < 2; k++) {
        const int odd = k ? 1000 : -1;
        ag_render_settings settings = h.settings;
        settings.integrator = (ag_integrator)odd;
        REFUSED(ag_render(h.d.context, h.d.made, &settings, &film));
        settings = h.settings;
        settings.cache = (ag_cache_mode)odd;
        REFUSED(ag_render(h.d.context, h.d.made, &settings, &film));
        ag_output_settings output = ag_default_output_settings();
        output.type = (ag_sample_type)odd;
        REFUSED(ag_film_write(h.d.context, h.film, &output, in_folder("a.exr")));
        expect_said(&h.d, "type is no ag_sample_type");
        output = ag_default_output_settings();
        output.exposure_stops = k ? NAN : INFINITY;
        REFUSED(ag_film_write(h.d.context, h.film, &output, in_folder("a.png")));
        REFUSED(ag_view_create(h.d.context, &output, &view));
        expect_said(&h.d, "exposure_stops is not finite");
        ag_scene_settings made = ag_default_scene_settings();
        made.up = (ag_up_axis)odd;
        REFUSED(ag_scene_create(h.d.context, &made, &scene));
        made = ag_default_scene_settings();
        made.gltf_light_units = (ag_gltf_light_units)odd;
        REFUSED(ag_scene_create(h.d.context, &made, &scene));
        REFUSED(ag_scene_set_hint(h.open, (ag_scene_hint)odd, "rgb", NULL, 0));
        REFUSED(ag_scene_remove_named(h.open, (ag_named)odd, "a"));
        assert_non_null(ag_status_text((ag_status)odd));
        assert_non_null(ag_phase_name((ag_phase)odd));
        assert_int_equal(ag_struct_size((ag_struct)odd), 0);
        assert_false(ag_integrator_has_photons((ag_integrator)odd));
        assert_false(ag_film_matte_name(h.film, (ag_layer)odd, 1, (char[8]){0}, 8));
    }
    assert_true(!film && !scene && !view);
    ag_context_settings confined = ag_default_context_settings();
    ag_context *context = NULL;
    confined.is_confined = true;
    confined.confined_count = 1;
    REFUSED(ag_context_create(&confined, &context));
    confined.confined_to = (const char *const[]){NULL};
    REFUSED(ag_context_create(&confined, &context));
    assert_null(context);
    end_host(&h);
}

static void a_scene_needs_a_context_like_its_own(void **state)
{
    (void)state;
    host h;
    ag_film *film = NULL;
    ag_rendering *rendering = NULL;
    ag_prediction prediction;
    ag_context *other = NULL;
    begin_host(&h);
    ag_context_settings settings = ag_default_context_settings();
    settings.thread_count = 1;
    assert_int_equal(ag_context_create(&settings, &other), AG_OK);
    assert_int_equal(ag_render(other, h.d.made, &h.settings, &film), AG_OK);
    assert_memory_equal(ag_film_pixels(film, NULL, NULL), ag_film_pixels(h.film, NULL, NULL),
                        3 * 4 * 4 * sizeof(float));
    ag_film_destroy(film);
    ag_context_destroy(other);
    film = NULL;
    settings.log = hear;
    settings.user = &h.d;
    for (int k = 0; k < 2; k++) {
        settings.isa = k ? "sse2" : NULL;
        settings.working_space = k ? NULL : "ACEScg";
        assert_int_equal(ag_context_create(&settings, &other), AG_OK);
        REFUSED(ag_render(other, h.d.made, &h.settings, &film));
        expect_said(&h.d, "the scene was made with a context of other settings");
        REFUSED(ag_rendering_create(other, h.d.made, &h.settings, &rendering));
        REFUSED(ag_render_settings_from_scene(other, h.d.made, &h.settings));
        REFUSED(ag_predict(other, h.d.made, &h.settings, &prediction));
        assert_true(!film && !rendering);
        ag_context_destroy(other);
    }
    end_host(&h);
}

/* The log is silent then, as its user may be gone; all work is cancelled, and all memory freed (the leak checker of
 * builds with sanitizers sees it). */
static void a_context_may_go_before_what_was_made_with_it(void **state)
{
    (void)state;
    host h;
    ag_film *film = NULL;
    begin_host(&h);
    ag_context_destroy(h.d.context);
    expect_said(&h.d, "2 of its scenes have not been destroyed before it");
    ag_context_clear_cancel(h.d.context); /* it stays cancelled */
    ag_context_destroy(h.d.context);
    assert_int_equal(ag_rendering_continue(h.rendering, 2), AG_CANCELLED);
    assert_int_equal(ag_render(h.d.context, h.d.made, &h.settings, &film), AG_CANCELLED);
    assert_null(film);
    assert_int_not_equal(ag_scene_commit(h.open), AG_OK);
    ag_scene_destroy(h.d.made); /* the rendering keeps it */
    ag_scene_destroy(h.open);
    assert_int_equal(ag_rendering_continue(h.rendering, 2), AG_CANCELLED);
    ag_rendering_finish(h.rendering, NULL);
    ag_film_destroy(h.film);
    assert_string_equal(h.d.said, "");
}

/* Cancels the context a moment later. Where that does not end the wait within ten seconds, ends all waits, so that the
 * test fails instead of hanging. */
static void *cancel_later(void *user)
{
    host *h = user;
    usleep(100000);
    ag_context_cancel(h->d.context);
    for (int i = 0; i < 200 && load_relaxed_u32(&h->is_waiting); i++)
        usleep(50000);
    if (load_relaxed_u32(&h->is_waiting))
        ag_end_waits();
    return NULL;
}

/* Tried with a FIFO that has no reader, and with one whose reader reads nothing. */
static void cancelling_ends_the_wait_for_a_reader(void **state)
{
    (void)state;
    host h;
    pthread_t thread;
    static const char *const NAMES[] = {"pipe.exr", "pipe.json", "pipe.ply", "pipe.state"};
    begin_host(&h);
    for (int i = 0; i < 8; i++) {
        const char *name = NAMES[i / 2];
        int reader = -1;
        if (i % 2 == 0) {
            assert_int_equal(mkfifo(in_folder(name), 0600), 0);
        } else { /* filled beforehand, since an empty pipe could hold the whole file */
            static const char FILLING[4096];
            reader = open(in_folder(name), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
            const int writer = open(in_folder(name), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
            while (write(writer, FILLING, sizeof FILLING) > 0)
                ;
            assert_int_equal(errno, EAGAIN);
            close(writer);
        }
        store_relaxed_u32(&h.is_waiting, 1);
        assert_int_equal(pthread_create(&thread, NULL, cancel_later, &h), 0);
        const ag_status status = i / 2 == 0   ? ag_film_write(h.d.context, h.film, NULL, in_folder(name))
                                 : i / 2 == 1 ? ag_statistics_write(h.d.context, in_folder(name))
                                 : i / 2 == 2 ? ag_rendering_write_photons(h.rendering, in_folder(name))
                                              : ag_rendering_write_checkpoint(h.rendering, in_folder(name));
        store_relaxed_u32(&h.is_waiting, 0);
        assert_int_equal(pthread_join(thread, NULL), 0);
        if (reader >= 0)
            close(reader);
        if (status != AG_CANCELLED)
            fail_msg("%s, %d: %s", name, i, ag_status_text(status));
        ag_context_clear_cancel(h.d.context);
    }
    assert_string_equal(h.d.said, "");
    end_host(&h);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(null_is_refused_by_contexts_and_scenes),
        TEST_IN_FOLDER(null_is_refused_by_renderings),
        TEST_IN_FOLDER(null_is_refused_by_what_fills_structs),
        TEST_IN_FOLDER(null_is_refused_by_films_and_files),
        TEST_IN_FOLDER(values_that_no_enum_has_are_refused),
        cmocka_unit_test(a_scene_needs_a_context_like_its_own),
        cmocka_unit_test(a_context_may_go_before_what_was_made_with_it),
        TEST_IN_FOLDER(cancelling_ends_the_wait_for_a_reader),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
