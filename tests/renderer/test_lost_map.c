/* test_lost_map.c: a photon map's file is cut short or overwritten within a pass, or one look at it fails: the pass is
 * broken off, the film is that of the last pass that saw the file whole, and the context works on. Threads: those of
 * the renderings. */
#define _GNU_SOURCE
#include "context.h"
#include "fixtures/layers_fixture.h"

#include <fcntl.h>
#include <unistd.h>

enum { SIZE = 24, VALUES = 3 * SIZE * SIZE, ENDLESS = 1000000 }; /* so many samples take half an hour */

/* Searches in an overwritten map go by whatever its nodes say, into the bytes beside each value that others publish:
 * between these accesses nothing is ordered, and nothing comes of them. For the thread sanitizer. */
__attribute__((visibility("default"))) const char *__tsan_default_suppressions(void);
const char *__tsan_default_suppressions(void) { return "race:irradiance_cache_get"; }

typedef enum loss { LOSS_CUT, LOSS_OVERWRITTEN, LOSS_OF_ONE_LOOK, LOSS_KINDS } loss;

typedef struct work {
    char map[160];
    ag_context *context;
    loss kind;
    bool is_armed, is_done;
    char said[512];
} work;

static void hear(void *user, ag_log_level level, const char *text)
{
    work *w = user;
    if (level == AG_LOG_ERROR)
        snprintf(w->said, sizeof w->said, "%s", text);
}

static void watch(void *user, ag_phase phase, double fraction)
{
    work *w = user;
    if (!w->is_armed || w->is_done || phase != AG_PHASE_RENDER || fraction <= 1.0 / ENDLESS)
        return;
    w->is_done = true;
    if (w->kind == LOSS_OF_ONE_LOOK) {
        run_break_off(&w->context->run);
        return;
    }
    if (w->kind == LOSS_CUT) {
        if (truncate(w->map, 0) != 0)
            abort();
        return;
    }
    char other[4096] = "another map";
    int file = open(w->map, O_WRONLY);
    if (file < 0 || write(file, other, sizeof other) != (ssize_t)sizeof other || close(file) != 0)
        abort();
}

static void a_pass_is_broken_off(void **state)
{
    (void)state;
    for (int k = 0; k < LOSS_KINDS; k++) {
        work w = {.kind = (loss)k};
        snprintf(w.map, sizeof w.map, "%s", in_folder("lost.map"));
        ag_context_settings made = ag_default_context_settings();
        ag_context *context;
        ag_scene *loaded;
        ag_rendering *rendering;
        ag_render_settings settings;
        float before[VALUES];
        int width, height;
        made.thread_count = 2;
        made.log = hear;
        made.progress = watch;
        made.user = &w;
        assert_int_equal(ag_context_create(&made, &context), AG_OK);
        w.context = context;
        assert_int_equal(ag_scene_load(context, LAYERS_SCENES "box_with_blocks.pbrt", &loaded), AG_OK);
        assert_int_equal(ag_render_settings_from_scene(context, loaded, &settings), AG_OK);
        settings.width = settings.height = SIZE;
        settings.samples_per_pixel = ENDLESS;
        settings.photon_count = 3000;
        settings.noise_level = 0.0f;
        settings.photon_map_file = w.map;
        assert_int_equal(ag_rendering_create(context, loaded, &settings, &rendering), AG_OK);
        assert_int_equal(ag_rendering_continue(rendering, 1), AG_OK);
        memcpy(before, ag_film_pixels(ag_rendering_film(rendering), &width, &height), sizeof before);
        w.is_armed = true;
        assert_int_equal(ag_rendering_continue(rendering, ENDLESS), AG_ERROR_SYSTEM);
        assert_true(w.is_done);
        assert_non_null(strstr(w.said, "the photon map was cut short or overwritten"));
        assert_memory_equal(ag_film_pixels(ag_rendering_film(rendering), &width, &height), before, sizeof before);
        ag_rendering_finish(rendering, NULL);
        assert_int_equal(unlink(w.map), 0);

        settings.samples_per_pixel = 1;
        settings.photon_map_file = NULL;
        assert_int_equal(ag_rendering_create(context, loaded, &settings, &rendering), AG_OK);
        assert_int_equal(ag_rendering_continue(rendering, 1), AG_OK);
        ag_rendering_finish(rendering, NULL);
        ag_scene_destroy(loaded);
        ag_context_destroy(context);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {TEST_IN_FOLDER(a_pass_is_broken_off)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
