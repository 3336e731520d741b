/* test_film.c: what samples add up to: rendering in passes gives the bits of one go, for any filter, integrator and
 * number of threads; a cancelled pass leaves whole samples; variances and means are those of the samples.
 * Threads: the renderer's. */
#define _GNU_SOURCE
#include "film/film_sums.h"
#include "fixtures/layers_fixture.h"

static ag_film *render_in_passes(studio *s, const int *passes)
{
    ag_rendering *rendering = studio_begin(s);
    ag_film *film;
    for (int i = 0; passes[i]; i++)
        assert_int_equal(ag_rendering_continue(rendering, passes[i]), AG_OK);
    ag_rendering_finish(rendering, &film);
    return film;
}

static void test_passes(void **state)
{
    (void)state;
    static const char *const filters[] = {"box", "mitchell"};
    for (int path = 0; path < 2; path++)
        for (int f = 0; f < 2; f++) {
            char text[512];
            snprintf(text, sizeof text, "PixelFilter \"%s\" Include \"%smirror_wall.pbrt\"", filters[f], LAYERS_SCENES);
            studio *s = studio_open(text, 1), *threaded = studio_open(text, 3);
            s->settings.integrator = path ? AG_INTEGRATOR_PATH : AG_INTEGRATOR_PHOTONMAP;
            s->settings.samples_per_pixel = 7;
            s->settings.layers = layers_of("all") | AG_LAYER_GBUFFER;
            threaded->settings = s->settings;
            ag_film *whole = studio_render(s), *passes = render_in_passes(threaded, (const int[]){1, 4, 4, 7, 0});
            expect_same_film(whole, passes);
            ag_film_destroy(passes);
            /* fewer samples are those that come first */
            passes = render_in_passes(s, (const int[]){5, 0});
            expect_within("samples", film_mean(passes, "samples.V"), 5.0, 0.0);
            ag_film_destroy(passes);
            ag_film_destroy(whole);
            studio_close(s);
            studio_close(threaded);
        }
}

/* Layers that are no parts of light leave the picture as it is, to the last bit. */
static void test_layers_leave_the_picture(void **state)
{
    (void)state;
    for (int path = 0; path < 2; path++) {
        studio *s = studio_open(LAYERS_SCENES "glass_and_metal.pbrt", 2);
        s->settings.integrator = path ? AG_INTEGRATOR_PATH : AG_INTEGRATOR_PHOTONMAP;
        ag_film *plain = studio_render(s);
        assert_int_equal(ag_film_channel_count(plain), 3);
        s->settings.layers = layers_of("all") & ~(uint32_t)AG_LAYERS_LIGHT;
        ag_film *layered = studio_render(s);
        int width, height;
        const float *a = ag_film_pixels(plain, &width, &height), *b = ag_film_pixels(layered, &width, &height);
        assert_memory_equal(a, b, (size_t)(3 * width * height) * sizeof *a);
        ag_film_destroy(plain);
        ag_film_destroy(layered);
        studio_close(s);
    }
}

static void cancel_at_half(void *user, ag_phase phase, double fraction)
{
    if (phase == AG_PHASE_RENDER && fraction > 0.3)
        ag_context_cancel(((studio *)user)->context);
}

/* Every pixel of a cancelled film is the mean of its own first samples. */
static void test_cancelled(void **state)
{
    (void)state;
    studio *s = studio_open(LAYERS_SCENES "box_with_blocks.pbrt", 1);
    s->settings.integrator = AG_INTEGRATOR_PATH;
    s->settings.width = s->settings.height = 64;
    s->settings.samples_per_pixel = 2;
    s->settings.layers = AG_LAYER_SAMPLES;
    ag_film *whole = studio_render(s), *part;

    studio broken = *s;
    ag_context_settings settings = ag_default_context_settings();
    settings.progress = cancel_at_half;
    settings.user = &broken;
    settings.thread_count = 1;
    assert_int_equal(ag_context_create(&settings, &broken.context), AG_OK);
    ag_rendering *rendering;
    assert_int_equal(ag_rendering_create(broken.context, s->scene, &s->settings, &rendering), AG_OK);
    ag_status status = ag_rendering_continue(rendering, 2);
    ag_rendering_finish(rendering, &part);
    float *samples = film_channel_of(part, "samples.V");
    int width, height, whole_pixels = 0;
    const float *a = ag_film_pixels(whole, &width, &height), *b = ag_film_pixels(part, &width, &height);
    for (int i = 0; i < width * height; i++) {
        if (samples[i] == 2.0f) {
            whole_pixels++;
            assert_memory_equal(a + 3 * i, b + 3 * i, 3 * sizeof *a);
        } else {
            assert_true(status == AG_CANCELLED);
        }
    }
    assert_true(whole_pixels > 0);
    free(samples);
    ag_film_destroy(whole);
    ag_film_destroy(part);
    ag_context_destroy(broken.context);
    studio_close(s);
}

/* --- sums by hand --- */

static ag_film *film_of(uint32_t layers, bool has_signs)
{
    static const char *const groups[] = {"default"};
    ag_render_settings settings = {.width = 1, .height = 1, .crop_window = {0, 1, 0, 1}, .exposure = 2.0f};
    pixel_filter filter = {.has_signs = has_signs, .mean_sign = 1.0};
    aov_layout layout;
    assert_int_equal(aov_layout_create(layers, (aov_needs){.albedo_and_normal = false}, false, groups, 1, &layout),
                     AG_OK);
    working_space space = working_space_rec709();
    ag_film *film = film_create(&settings, &space, &filter, true, &layout);
    assert_non_null(film);
    return film;
}

static void add(ag_film *film, float radiance, int sign, bool is_hit, float value)
{
    sample_layers layers = {.first = {.is_hit = is_hit,
                                      .depth = value,
                                      .position = {value, 0.0f, 0.0f},
                                      .geometric_normal = {value, 0.0f, 1.0f},
                                      .object_id = (uint32_t)value,
                                      .material_id = 7},
                            .alpha = 1.0f};
    if (!is_hit) {
        layers.first = (first_hit){0};
        layers.alpha = value;
    }
    film_add(film, 0, &(eye_sample){.radiance = rgb_gray(radiance), .sign = sign, .layers = &layers});
}

static double value_of(const ag_film *film, const char *name) { return film_mean(film, name); /* of its one pixel */ }

static void test_sums(void **state)
{
    (void)state;
    ag_film *film =
        film_of((layers_of("all") & ~(uint32_t)(AG_LAYERS_LIGHT | AG_LAYER_CRYPTO_OBJECT | AG_LAYER_CRYPTO_MATERIAL)) |
                    AG_LAYER_GBUFFER,
                false);
    film_resolve(film); /* without any sample */
    expect_within("nothing", value_of(film, "R"), 0.0, 0.0);
    expect_within("depth of nothing", value_of(film, "Z"), (double)1e10f, 0.0);
    add(film, 1.0f, 1, true, 5.0f);
    add(film, 2.0f, 1, true, 3.0f);
    add(film, 6.0f, 1, false, 0.25f);
    film_resolve(film);
    expect_within("R", value_of(film, "R"), 6.0, 1e-6);
    expect_within("A", value_of(film, "A"), 2.25 / 3.0, 1e-6);
    expect_within("Z", value_of(film, "Z"), 3.0, 0.0);
    expect_within("object", value_of(film, "id.object.V"), 3.0, 0.0);
    expect_within("material", value_of(film, "id.material.V"), 7.0, 0.0);
    expect_within("P", value_of(film, "P.X"), 4.0, 1e-6);
    expect_within("N", value_of(film, "N.X"), 4.0 / sqrt(17.0), 1e-6);
    /* of 2, 4, 12, which are the samples exposed; and of those that met something */
    expect_within("variance", value_of(film, "variance.G"), 28.0, 1e-5);
    expect_within("Variance", value_of(film, "Variance.G"), 2.0, 1e-6);
    expect_within("RelativeVariance", value_of(film, "RelativeVariance.G"), 2.0 / 3.0, 1e-6);
    ag_film_destroy(film);
}

/* Light counts with its sign; a point between two points by the signs would be no point. */
static void test_signed_sums(void **state)
{
    (void)state;
    ag_film *film = film_of(AG_LAYER_ALPHA | AG_LAYER_POSITION | AG_LAYER_VARIANCE | AG_LAYERS_LIGHT, true);
    for (int i = 0; i < 3; i++)
        add(film, 4.0f, 1, true, 5.0f);
    add(film, 2.0f, -1, true, 1.0f);
    film_resolve(film);
    expect_within("A", value_of(film, "A"), 1.0, 1e-6);
    expect_within("P", value_of(film, "P.X"), 4.0, 1e-6);
    expect_within("variance", value_of(film, "variance.R"), 4.0, 1e-5);
    expect_within("R is the sum of the parts, which are none", value_of(film, "R"), 0.0, 0.0);
    ag_film_destroy(film);
    film = film_of(AG_LAYER_ALPHA, true);
    for (int i = 0; i < 3; i++)
        add(film, 4.0f, 1, true, 5.0f);
    add(film, 2.0f, -1, true, 1.0f);
    film_resolve(film);
    expect_within("R", value_of(film, "R"), 2.0 * (12.0 - 2.0) / 2.0, 1e-6);
    ag_film_destroy(film);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sums),    cmocka_unit_test(test_signed_sums),
        TEST_IN_FOLDER(test_passes),    TEST_IN_FOLDER(test_layers_leave_the_picture),
        TEST_IN_FOLDER(test_cancelled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
