/* test_lost_map.c: a photon map's file is cut short or overwritten, or one look at it fails: what is under way is
 * broken off, the film is that of the last pass that saw the file whole, no checkpoint is written, and the context
 * works on. Threads: those of the renderings. */
#define _GNU_SOURCE
#include "context.h"
#include "fixtures/layers_fixture.h"
#include "math/rng.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

enum { SIZE = 24, VALUES = 3 * SIZE * SIZE, ENDLESS = 1000000 }; /* so many samples take half an hour */

/* Tells the thread sanitizer which races are expected: searches in an overwritten map follow whatever its nodes now
 * hold, and read bytes that other threads write without any order between them. Nothing of what they find is used. */
__attribute__((visibility("default"))) const char *__tsan_default_suppressions(void);
const char *__tsan_default_suppressions(void) { return "race:irradiance_cache_get\nrace:precompute_block"; }

typedef enum loss { LOSS_CUT, LOSS_OVERWRITTEN, LOSS_OF_ONE_LOOK, LOSS_KINDS } loss;

typedef struct work {
    char map[160];
    ag_context *context;
    loss kind;
    ag_phase phase;
    bool is_armed, is_done;
    double last_fraction; /* the last that was told of the phase */
    char said[512];
    ag_scene *loaded;
    ag_render_settings settings;
} work;

static void hear(void *user, ag_log_level level, const char *text)
{
    work *w = user;
    if (level == AG_LOG_ERROR)
        snprintf(w->said, sizeof w->said, "%s", text);
}

/* Overwrites all of a file with random bytes, so that nodes, indices and slots may be anything. */
static void overwrite(const char *path)
{
    rng random = rng_make(1, 0, 0);
    struct stat status;
    int file = open(path, O_WRONLY);
    if (file < 0 || fstat(file, &status) != 0)
        abort();
    for (off_t left = status.st_size; left > 0;) {
        uint64_t words[512];
        for (size_t i = 0; i < sizeof words / sizeof *words; i++)
            words[i] = rng_next(&random);
        size_t size = left < (off_t)sizeof words ? (size_t)left : sizeof words;
        if (write(file, words, size) != (ssize_t)size)
            abort();
        left -= (off_t)size;
    }
    if (close(file) != 0)
        abort();
}

static void lose(work *w)
{
    if (w->kind == LOSS_OF_ONE_LOOK) {
        run_break_off(&w->context->run);
    } else if (w->kind == LOSS_CUT) {
        if (truncate(w->map, 0) != 0)
            abort();
    } else {
        overwrite(w->map);
    }
}

static void watch(void *user, ag_phase phase, double fraction)
{
    work *w = user;
    if (!w->is_armed || phase != w->phase)
        return;
    w->last_fraction = fraction;
    if (w->is_done || fraction <= 1.0 / ENDLESS)
        return;
    w->is_done = true;
    lose(w);
    if (phase == AG_PHASE_PRECOMPUTE)
        store_relaxed_u64(&w->context->run.next_look, 0); /* else the map is looked at after half a second only */
}

static work begin_work(loss kind)
{
    work w = {.kind = kind, .phase = AG_PHASE_RENDER};
    snprintf(w.map, sizeof w.map, "%s", in_folder("lost.map"));
    return w;
}

/* The context's callbacks refer to the work, which must not move until close_scene. */
static void open_scene(work *w)
{
    ag_context_settings made = ag_default_context_settings();
    made.thread_count = 2;
    made.log = hear;
    made.progress = watch;
    made.user = w;
    assert_int_equal(ag_context_create(&made, &w->context), AG_OK);
    assert_int_equal(ag_scene_load(w->context, LAYERS_SCENES "box_with_blocks.pbrt", &w->loaded), AG_OK);
    assert_int_equal(ag_render_settings_from_scene(w->context, w->loaded, &w->settings), AG_OK);
    w->settings.width = w->settings.height = SIZE;
    w->settings.samples_per_pixel = ENDLESS;
    w->settings.photon_count = 3000;
    w->settings.noise_level = 0.0f;
    w->settings.photon_map_file = w->map;
}

static void close_scene(work *w)
{
    ag_scene_destroy(w->loaded);
    ag_context_destroy(w->context);
}

static void assert_told(const work *w)
{
    assert_non_null(strstr(w->said, "the photon map was cut short or overwritten"));
}

static ag_rendering *begin_rendering(work *w)
{
    ag_rendering *rendering;
    assert_int_equal(ag_rendering_create(w->context, w->loaded, &w->settings, &rendering), AG_OK);
    return rendering;
}

static void copy_film(const ag_rendering *rendering, float out[VALUES])
{
    int width, height;
    memcpy(out, ag_film_pixels(ag_rendering_film(rendering), &width, &height), VALUES * sizeof *out);
}

/* Continues the rendering until the map is lost, and expects that its film is then as before. */
static void assert_broken_off(work *w, ag_rendering *rendering)
{
    float before[VALUES], after[VALUES];
    copy_film(rendering, before);
    w->is_armed = true;
    assert_int_equal(ag_rendering_continue(rendering, ENDLESS), AG_ERROR_SYSTEM);
    assert_true(w->is_done);
    assert_told(w);
    copy_film(rendering, after);
    assert_memory_equal(after, before, sizeof before);
    assert_int_equal(ag_rendering_sample_counts(rendering).most, 1);
}

/* Expects that the context renders another picture as if no map had been lost. */
static void assert_works_on(work *w)
{
    w->settings.samples_per_pixel = 1;
    w->settings.photon_map_file = NULL;
    w->settings.cache = AG_CACHE_ON_DEMAND;
    ag_rendering *rendering = begin_rendering(w);
    assert_int_equal(ag_rendering_continue(rendering, 1), AG_OK);
    ag_rendering_finish(rendering, NULL);
}

static void a_pass_is_broken_off(void **state)
{
    (void)state;
    for (int k = 0; k < LOSS_KINDS; k++) {
        work w = begin_work((loss)k);
        open_scene(&w);
        ag_rendering *rendering = begin_rendering(&w);
        assert_int_equal(ag_rendering_continue(rendering, 1), AG_OK);
        assert_broken_off(&w, rendering);
        ag_rendering_finish(rendering, NULL);
        assert_int_equal(unlink(w.map), 0);
        assert_works_on(&w);
        close_scene(&w);
    }
}

/* Where the first pass after reading a checkpoint is broken off, the film is the checkpoint's. */
static void the_picture_of_a_checkpoint_stays(void **state)
{
    (void)state;
    work w = begin_work(LOSS_OVERWRITTEN);
    open_scene(&w);
    ag_rendering *rendering = begin_rendering(&w);
    assert_int_equal(ag_rendering_continue(rendering, 1), AG_OK);
    assert_int_equal(ag_rendering_write_checkpoint(rendering, in_folder("one.checkpoint")), AG_OK);
    ag_rendering_finish(rendering, NULL);
    rendering = begin_rendering(&w);
    assert_int_equal(ag_rendering_read_checkpoint(rendering, in_folder("one.checkpoint")), AG_OK);
    assert_broken_off(&w, rendering);
    ag_rendering_finish(rendering, NULL);
    close_scene(&w);
    assert_int_equal(unlink(w.map) | unlink(in_folder("one.checkpoint")), 0);
}

/* Since a checkpoint holds irradiances and a hash of the photons, none is written from a map that was lost. */
static void no_checkpoint_of_a_lost_map(void **state)
{
    (void)state;
    for (int k = 0; k < 2 * (LOSS_OVERWRITTEN + 1); k++) {
        work w = begin_work((loss)(k / 2));
        open_scene(&w);
        w.settings.cache = k % 2 == 0 ? AG_CACHE_ON_DEMAND : AG_CACHE_OFF;
        ag_rendering *rendering = begin_rendering(&w);
        assert_int_equal(ag_rendering_continue(rendering, 1), AG_OK);
        lose(&w);
        assert_int_equal(ag_rendering_write_checkpoint(rendering, in_folder("lost.checkpoint")), AG_ERROR_SYSTEM);
        assert_told(&w);
        assert_int_equal(access(in_folder("lost.checkpoint"), F_OK), -1);
        ag_rendering_finish(rendering, NULL);
        close_scene(&w);
        assert_int_equal(unlink(w.map), 0);
    }
}

static void computing_beforehand_is_broken_off(void **state)
{
    (void)state;
    for (int k = 0; k < LOSS_KINDS; k++) {
        work w = begin_work((loss)k);
        open_scene(&w);
        w.phase = AG_PHASE_PRECOMPUTE;
        w.settings.photon_count = 60000;
        w.settings.cache = AG_CACHE_PRECOMPUTE;
        w.is_armed = true;
        ag_rendering *rendering = NULL;
        assert_int_equal(ag_rendering_create(w.context, w.loaded, &w.settings, &rendering), AG_ERROR_SYSTEM);
        assert_null(rendering);
        assert_true(w.is_done);
        assert_true(w.last_fraction < 1.0);
        assert_told(&w);
        assert_int_equal(unlink(w.map), 0);
        assert_works_on(&w);
        close_scene(&w);
    }
}

/* When the first pass is dropped, the rendering runs its pilot again, and the picture has the bits of an undisturbed
 * one. */
static void the_first_pass_is_broken_off(void **state)
{
    (void)state;
    enum { SAMPLES = 8 };
    float pictures[2][VALUES];
    for (int k = 0; k < 2; k++) {
        work w = begin_work(LOSS_OF_ONE_LOOK);
        open_scene(&w);
        w.settings.samples_per_pixel = SAMPLES;
        ag_rendering *rendering = begin_rendering(&w);
        if (k == 1) {
            w.is_armed = true;
            assert_int_equal(ag_rendering_continue(rendering, SAMPLES), AG_ERROR_SYSTEM);
            assert_true(w.is_done);
            assert_int_equal(ag_rendering_sample_counts(rendering).most, 0);
        }
        assert_int_equal(ag_rendering_continue(rendering, SAMPLES), AG_OK);
        copy_film(rendering, pictures[k]);
        ag_rendering_finish(rendering, NULL);
        assert_int_equal(unlink(w.map), 0);
        close_scene(&w);
    }
    assert_memory_equal(pictures[0], pictures[1], sizeof pictures[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(a_pass_is_broken_off), TEST_IN_FOLDER(the_first_pass_is_broken_off),
        TEST_IN_FOLDER(the_picture_of_a_checkpoint_stays), TEST_IN_FOLDER(no_checkpoint_of_a_lost_map),
        TEST_IN_FOLDER(computing_beforehand_is_broken_off)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
