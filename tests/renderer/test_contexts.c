/* test_contexts.c: several contexts in one process, each on a thread of its own and with workers of its own, at the
 * same time: pictures and files are those of one alone; what is cancelled or goes wrong in one stays there. Threads:
 * many. */
#define _GNU_SOURCE
#include "fixtures/layers_fixture.h"

#include <pthread.h>

enum { JOB_COUNT = 6, SIZE = 24, PATH_SIZE = 160 };

/* A thread's work with its context, and its results. Threads make no asserts. */
typedef struct job {
    const char *scene;
    char file[2][PATH_SIZE]; /* to write; "": none */
    const char *working_space;
    bool is_cancelled; /* as soon as it renders */
    ag_context *context;
    pthread_t thread;
    ag_status status;
    float pixels[3 * SIZE * SIZE];
    char said[512]; /* errors and warnings */
    int progress[AG_PHASE_COUNT];
} job;

static void hear(void *user, ag_log_level level, const char *text)
{
    job *j = user;
    size_t length = strlen(j->said);
    if (level <= AG_LOG_WARNING)
        snprintf(j->said + length, sizeof j->said - length, "%s\n", text);
}

static void watch(void *user, ag_phase phase, double fraction)
{
    job *j = user;
    j->progress[phase] = (int)(100.0 * fraction);
    if (j->is_cancelled && phase == AG_PHASE_RENDER)
        ag_context_cancel(j->context);
}

static void *work(void *user)
{
    job *j = user;
    ag_context_settings made = ag_default_context_settings();
    ag_render_settings settings;
    ag_output_settings output = ag_default_output_settings();
    ag_scene *loaded = NULL;
    ag_film *film = NULL;
    made.thread_count = 2;
    made.working_space = j->working_space;
    made.log = hear;
    made.progress = watch;
    made.user = j;
    output.reproducible = true;
    j->status = ag_context_create(&made, &j->context);
    if (j->status == AG_OK)
        j->status = ag_scene_load(j->context, j->scene, &loaded);
    if (j->status == AG_OK)
        j->status = ag_render_settings_from_scene(j->context, loaded, &settings);
    if (j->status == AG_OK) {
        settings.width = settings.height = SIZE;
        settings.samples_per_pixel = 2;
        settings.photon_count = settings.caustic_photon_count = 2000;
        settings.gather_samples = 4;
        j->status = ag_render(j->context, loaded, &settings, &film);
    }
    for (int i = 0; i < 2 && j->status == AG_OK && j->file[i][0]; i++)
        j->status = ag_film_write(j->context, film, &output, j->file[i]);
    int width, height;
    if (j->status == AG_OK)
        memcpy(j->pixels, ag_film_pixels(film, &width, &height), sizeof j->pixels);
    ag_film_destroy(film);
    ag_scene_destroy(loaded);
    ag_context_destroy(j->context);
    return NULL;
}

static void make_job(job *j, int number, const char *run)
{
    static const char *const scenes[JOB_COUNT] = {
        LAYERS_SCENES "glass_and_metal.pbrt", LAYERS_SCENES "alpha_and_relief.pbrt", LAYERS_SCENES "next_room.pbrt",
        LAYERS_SCENES "glass_and_metal.pbrt", LAYERS_SCENES "box_with_blocks.pbrt",  NULL};
    *j = (job){.scene = scenes[number], .working_space = number == 3 ? "acescg" : NULL, .is_cancelled = number == 4};
    snprintf(j->file[0], PATH_SIZE, "%s/%s%d.exr", folder, run, number);
    snprintf(j->file[1], PATH_SIZE, "%s/%s%d.png", folder, run, number);
}

static void contexts_work_side_by_side(void **state)
{
    (void)state;
    static job alone[JOB_COUNT], together[JOB_COUNT];
    FILE *broken = fopen(in_folder("broken.pbrt"), "w");
    assert_non_null(broken);
    assert_true(fputs("WorldBegin\nShape \"cube\"\n", broken) >= 0);
    assert_int_equal(fclose(broken), 0);
    char broken_path[PATH_SIZE];
    snprintf(broken_path, sizeof broken_path, "%s", in_folder("broken.pbrt"));
    for (int k = 0; k < JOB_COUNT; k++) {
        make_job(&alone[k], k, "alone");
        make_job(&together[k], k, "together");
    }
    alone[5].scene = together[5].scene = broken_path;
    for (int k = 0; k < JOB_COUNT; k++)
        work(&alone[k]);
    for (int k = 0; k < JOB_COUNT; k++)
        assert_int_equal(pthread_create(&together[k].thread, NULL, work, &together[k]), 0);
    for (int k = 0; k < JOB_COUNT; k++)
        assert_int_equal(pthread_join(together[k].thread, NULL), 0);

    for (int k = 0; k < JOB_COUNT; k++) {
        static const ag_status expected[JOB_COUNT] = {AG_OK, AG_OK, AG_OK, AG_OK, AG_CANCELLED, AG_ERROR_SCENE};
        if (together[k].status != expected[k] || alone[k].status != expected[k])
            fail_msg("%d: %s, %s: %s%s", k, ag_status_text(alone[k].status), ag_status_text(together[k].status),
                     alone[k].said, together[k].said);
        assert_string_equal(together[k].said, alone[k].said);
        if (expected[k] != AG_OK)
            continue;
        assert_memory_equal(together[k].pixels, alone[k].pixels, sizeof alone[k].pixels);
        for (int i = 0; i < 2; i++)
            expect_same_files(strrchr(together[k].file[i], '/') + 1, strrchr(alone[k].file[i], '/') + 1);
        for (ag_phase phase = AG_PHASE_LOAD; phase < AG_PHASE_COUNT; phase++)
            assert_int_equal(together[k].progress[phase], phase == AG_PHASE_PRECOMPUTE ? 0 : 100);
    }
    assert_non_null(strstr(together[5].said, "broken.pbrt:2:1: error:"));
    assert_memory_not_equal(alone[0].pixels, alone[3].pixels, sizeof alone[0].pixels); /* the other working space */
}

typedef struct canceller {
    ag_context *context;
    ag_phase phase; /* AG_PHASE_COUNT: nothing is cancelled */
    bool has_cancelled;
} canceller;

/* Cancels once, in the middle of the phase. */
static void cancel_in_phase(void *user, ag_phase phase, double fraction)
{
    canceller *c = user;
    if (phase == c->phase && !c->has_cancelled && fraction < 1.0) {
        c->has_cancelled = true;
        ag_context_cancel(c->context);
    }
}

/* Renders with one context and scene; what is cancelled is done again, or gone on with, by the same two. */
static void render_cancelled(ag_phase phase, float *out_pixels)
{
    canceller c = {.phase = phase};
    ag_context_settings made = ag_default_context_settings();
    ag_render_settings settings;
    ag_scene *loaded;
    ag_rendering *rendering = NULL;
    ag_film *film;
    made.thread_count = 2;
    made.progress = cancel_in_phase;
    made.user = &c;
    assert_int_equal(ag_context_create(&made, &c.context), AG_OK);
    ag_status status = ag_scene_load(c.context, AG_SOURCE_DIR "/tests/scenes/glass_and_metal.pbrt", &loaded);
    if (status == AG_CANCELLED) {
        assert_int_equal(ag_scene_load(c.context, AG_SOURCE_DIR "/tests/scenes/glass_and_metal.pbrt", &loaded),
                         AG_CANCELLED);
        ag_context_clear_cancel(c.context);
        status = ag_scene_load(c.context, AG_SOURCE_DIR "/tests/scenes/glass_and_metal.pbrt", &loaded);
    }
    assert_int_equal(status, AG_OK);
    assert_int_equal(ag_render_settings_from_scene(c.context, loaded, &settings), AG_OK);
    settings.width = settings.height = SIZE;
    settings.samples_per_pixel = 4;
    settings.gather_samples = 4;
    settings.photon_count = 5000;
    settings.caustic_photon_count = 500;
    status = ag_rendering_create(c.context, loaded, &settings, &rendering);
    if (status == AG_CANCELLED) {
        ag_context_clear_cancel(c.context);
        status = ag_rendering_create(c.context, loaded, &settings, &rendering);
    }
    assert_int_equal(status, AG_OK);
    status = ag_rendering_continue(rendering, 4);
    if (status == AG_CANCELLED) {
        assert_int_equal(ag_rendering_continue(rendering, 4), AG_CANCELLED);
        ag_context_clear_cancel(c.context);
        status = ag_rendering_continue(rendering, 4);
    }
    assert_int_equal(status, AG_OK);
    assert_true(c.has_cancelled || phase == AG_PHASE_COUNT);
    ag_rendering_finish(rendering, &film);
    int width, height;
    memcpy(out_pixels, ag_film_pixels(film, &width, &height), 3 * SIZE * SIZE * sizeof *out_pixels);
    assert_int_equal(width * height, SIZE * SIZE);
    ag_film_destroy(film);
    ag_scene_destroy(loaded);
    ag_context_destroy(c.context);
}

static void what_was_cancelled_can_go_on(void **state)
{
    (void)state;
    static float whole[3 * SIZE * SIZE], pixels[3 * SIZE * SIZE];
    static const ag_phase PHASES[] = {AG_PHASE_LOAD, AG_PHASE_PHOTONS, AG_PHASE_MAP, AG_PHASE_RENDER};
    render_cancelled(AG_PHASE_COUNT, whole);
    for (int i = 0; i < 4; i++) {
        render_cancelled(PHASES[i], pixels);
        assert_memory_equal(pixels, whole, sizeof whole);
    }
}

/* A view without tone mapping is the display's curve alone, sRGB's. */
static void views_are_those_of_files(void **state)
{
    (void)state;
    ag_context *context;
    ag_view *view = NULL, *none = NULL;
    ag_context_settings made = ag_default_context_settings();
    ag_output_settings output = ag_default_output_settings();
    made.thread_count = 1;
    assert_int_equal(ag_context_create(&made, &context), AG_OK);
    output.view = "Un-tone-mapped";
    output.exposure_stops = 1.0f;
    assert_int_equal(ag_view_create(context, &output, &view), AG_OK);
    float pixels[6] = {0.0f, 0.25f, 0.5f, 0.1f, 0.05f, 0.0f};
    const double linear[6] = {0.0, 0.5, 1.0, 0.2, 0.1, 0.0};
    assert_int_equal(ag_view_apply(view, pixels, 2), AG_OK);
    for (int i = 0; i < 6; i++)
        assert_true(fabs((double)pixels[i] - (linear[i] > 0.0 ? 1.055 * pow(linear[i], 1.0 / 2.4) - 0.055 : 0.0)) <
                    1e-4);
    assert_int_equal(ag_view_apply(view, NULL, 2), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_view_apply(NULL, pixels, 2), AG_ERROR_ARGUMENT);
    ag_view_destroy(view);
    ag_view_destroy(NULL);

    assert_int_equal(ag_view_create(context, NULL, &view), AG_OK);
    ag_view_destroy(view);
    output.view = "no such view";
    assert_int_equal(ag_view_create(context, &output, &none), AG_ERROR_COLOR);
    output.struct_size = 3;
    assert_int_equal(ag_view_create(context, &output, &none), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_view_create(NULL, NULL, &none), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_view_create(context, NULL, NULL), AG_ERROR_ARGUMENT);
    assert_null(none);
    ag_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {TEST_IN_FOLDER(contexts_work_side_by_side),
                                       cmocka_unit_test(views_are_those_of_files),
                                       cmocka_unit_test(what_was_cancelled_can_go_on)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
