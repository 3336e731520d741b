/* test_sample_queue.c: samples wait in their order, get what is gathered for them, and come to their pixels' means;
 * those with layers are fewer, and what is not finite counts as black. Threads: one. */
#include "integrator/sample_queue.h"

#include "fixtures/test_scene.h"

static ag_film *film_of(int width, uint32_t layers)
{
    static const char *const groups[] = {"default"};
    ag_render_settings settings = {.width = width, .height = 1, .crop_window = {0, 1, 0, 1}, .exposure = 1.0f};
    pixel_filter filter = {.mean_sign = 1.0};
    aov_layout layout;
    assert_int_equal(aov_layout_create(layers, (aov_needs){0}, false, groups, 1, &layout), AG_OK);
    working_space space = working_space_rec709();
    ag_film *film = film_create(&settings, &space, &filter, true, &layout);
    assert_non_null(film);
    return film;
}

static eye_sample *begin(sample_queue *q, size_t pixel, bool with_layers, float radiance)
{
    eye_sample *s = sample_queue_begin(q, pixel, with_layers);
    assert_true(rgb_is_black(s->radiance));
    assert_true((s->layers != NULL) == with_layers);
    s->sign = 1;
    s->radiance = rgb_gray(radiance);
    return s;
}

static void full(void **state)
{
    (void)state;
    sample_queue *q = sample_queue_create();
    ag_film *film = film_of(1, 0);
    assert_non_null(q);
    for (int i = 0; i < GATHER_BATCH_SAMPLES; i++) {
        assert_false(sample_queue_is_full(q));
        begin(q, 0, false, 1.0f);
    }
    assert_true(sample_queue_is_full(q));
    assert_int_equal(sample_queue_deliver(q, NULL, 0, film), 0);
    assert_int_equal(film->counts[0], GATHER_BATCH_SAMPLES);
    for (int i = 0; i < SAMPLE_QUEUE_LAYERS; i++) {
        assert_false(sample_queue_is_full(q));
        begin(q, 0, true, 1.0f);
    }
    assert_true(sample_queue_is_full(q));
    ag_film_destroy(film);
    sample_queue_destroy(q);
    sample_queue_destroy(NULL);
}

/* Means of what was sampled and gathered, pixel by pixel; what was gathered is taken from where it was. */
static void gathered_light_arrives(void **state)
{
    (void)state;
    enum { COUNT = 12, PIXELS = 3 };
    sample_queue *q = sample_queue_create();
    ag_film *film = film_of(PIXELS, 0);
    gathered_light gathered[COUNT] = {0};
    double expected[PIXELS] = {0.0};
    for (int i = 0; i < COUNT; i++) {
        begin(q, (size_t)(i % PIXELS), false, (float)i);
        gathered[i].first = rgb_gray(100.0f * (float)i);
        gathered[i].behind = rgb_gray(10000.0f * (float)i);
        expected[i % PIXELS] += 10101.0 * i / (COUNT / PIXELS);
    }
    assert_int_equal(sample_queue_deliver(q, gathered, 0, film), 0);
    assert_int_equal(q->count, 0);
    film_resolve(film);
    for (int p = 0; p < PIXELS; p++)
        assert_relative((double)film->pixels[3 * p], expected[p], 1e-6);
    for (int i = 0; i < COUNT; i++)
        assert_true(rgb_is_black(gathered[i].first) && rgb_is_black(gathered[i].behind));
    ag_film_destroy(film);
    sample_queue_destroy(q);
}

/* Light gathered at what the eye sees is indirect light; light gathered behind a mirror is specular light. */
static void gathered_light_has_its_parts(void **state)
{
    (void)state;
    sample_queue *q = sample_queue_create();
    ag_film *film = film_of(1, AG_LAYERS_LIGHT);
    gathered_light gathered[1] = {0};
    eye_sample *s = begin(q, 0, true, 1.0f);
    eye_sample_add_part(s, PART_EMISSION, rgb_gray(1.0f));
    sample_layers *layers = s->layers;
    gathered[0].first = rgb_gray(2.0f);
    gathered[0].behind = rgb_gray(4.0f);
    sample_queue_deliver(q, gathered, 1, film);
    assert_true(layers->parts[PART_EMISSION].r == 1.0f && layers->parts[PART_INDIRECT].r == 2.0f &&
                layers->parts[PART_SPECULAR].r == 4.0f && layers->groups[1].r == 6.0f && layers->groups[0].r == 0.0f);
    ag_film_destroy(film);
    sample_queue_destroy(q);
}

static void not_finite_is_black(void **state)
{
    (void)state;
    sample_queue *q = sample_queue_create();
    ag_film *film = film_of(1, 0);
    begin(q, 0, false, NAN);
    begin(q, 0, false, INFINITY);
    begin(q, 0, false, 3.0f);
    assert_int_equal(sample_queue_deliver(q, NULL, 0, film), 2);
    film_resolve(film);
    assert_relative((double)film->pixels[0], 1.0, 1e-6);
    ag_film_destroy(film);
    sample_queue_destroy(q);
}

/* A sample that is not finite has lost its light, not the surface that it met. */
static void not_finite_keeps_its_alpha(void **state)
{
    (void)state;
    sample_queue *q = sample_queue_create();
    ag_film *film = film_of(1, AG_LAYER_ALPHA);
    eye_sample *s = begin(q, 0, true, NAN);
    sample_layers *layers = s->layers;
    layers->alpha = 1.0f;
    eye_sample_add_part(s, PART_EMISSION, rgb_gray(2.0f));
    assert_int_equal(sample_queue_deliver(q, NULL, 0, film), 1);
    assert_true(layers->alpha == 1.0f);
    assert_true(layers->parts[PART_EMISSION].r == 0.0f);
    ag_film_destroy(film);
    sample_queue_destroy(q);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(full), cmocka_unit_test(gathered_light_arrives),
                                       cmocka_unit_test(gathered_light_has_its_parts),
                                       cmocka_unit_test(not_finite_is_black),
                                       cmocka_unit_test(not_finite_keeps_its_alpha)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
