/* test_adaptive.c: adaptive sampling reaches the noise that it is asked for, where it is needed; the picture is the
 * same for any number of threads and however the work is cut into passes.
 * Threads: the renderer's. */
#define _GNU_SOURCE
#include "fixtures/layers_fixture.h"
#include "fixtures/sanitizer.h"

static studio *open_adaptive(unsigned threads, float level)
{
    studio *s = studio_open(LAYERS_SCENES "mirror_wall.pbrt", threads);
    s->settings.integrator = AG_INTEGRATOR_PATH;
    s->settings.width = s->settings.height = 24;
    s->settings.samples_per_pixel = 400;
    s->settings.noise_level = level;
    s->settings.layers = AG_LAYER_SAMPLES;
    return s;
}

static void test_same_bits(void **state)
{
    (void)state;
    studio *s = open_adaptive(1, 0.03f), *threaded = open_adaptive(3, 0.03f);
    ag_film *whole = studio_render(s), *other = studio_render(threaded), *cut;
    expect_same_film(whole, other);
    ag_rendering *r;
    assert_int_equal(ag_rendering_create(threaded->context, threaded->scene, &threaded->settings, &r), AG_OK);
    static const int passes[] = {1, 2, 7, 16, 16, 17, 33, 100, 400, 400};
    for (size_t i = 0; i < sizeof passes / sizeof *passes; i++) {
        ag_context_pause(threaded->context);
        assert_int_equal(ag_rendering_continue(r, passes[i]), AG_PAUSED);
        assert_int_equal(ag_rendering_continue(r, passes[i]), AG_OK);
        assert_true(ag_rendering_sample_counts(r).most <= passes[i]);
        if (i == 5) { /* another goes on */
            assert_int_equal(ag_rendering_write_checkpoint(r, in_folder("c")), AG_OK);
            ag_rendering_finish(r, NULL);
            assert_int_equal(ag_rendering_create(s->context, s->scene, &s->settings, &r), AG_OK);
            assert_int_equal(ag_rendering_read_checkpoint(r, in_folder("c")), AG_OK);
            studio *hold = s;
            s = threaded;
            threaded = hold;
        }
    }
    ag_rendering_finish(r, &cut);
    expect_same_film(whole, cut);
    float *samples = film_channel_of(whole, "samples.V");
    float least = INFINITY, most = 0.0f;
    for (int i = 0; i < film_pixel_count(whole); i++) {
        least = fminf(least, samples[i]);
        most = fmaxf(most, samples[i]);
    }
    free(samples);
    assert_true(least >= 16.0f && most <= 400.0f && most >= 2.0f * least);
    ag_film_destroy(whole);
    ag_film_destroy(other);
    ag_film_destroy(cut);
    studio_close(s);
    studio_close(threaded);
}

/* A crop that cuts through blocks of pixels has the full picture's values, and its sample counts. */
static void test_crops(void **state)
{
    (void)state;
    studio *s = open_adaptive(2, 0.03f);
    s->settings.width = 29, s->settings.height = 27;
    ag_film *whole = studio_render(s);
    static const int crops[][4] = {{5, 19, 3, 22}, {8, 16, 8, 16}, {0, 29, 13, 14}, {27, 29, 25, 27}};
    for (size_t i = 0; i < sizeof crops / sizeof *crops; i++) {
        const int *crop = crops[i];
        for (int k = 0; k < 4; k++)
            s->settings.crop_window[k] = (double)crop[k] / (k < 2 ? 29.0 : 27.0);
        ag_film *part = studio_render(s);
        int width = crop[1] - crop[0], height = crop[3] - crop[2], told_width, told_height;
        ag_film_pixels(part, &told_width, &told_height);
        assert_int_equal(told_width, width);
        assert_int_equal(told_height, height);
        static const char *const channels[] = {"R", "G", "B", "samples.V"};
        for (int c = 0; c < 4; c++) {
            float *a = film_channel_of(whole, channels[c]), *b = film_channel_of(part, channels[c]);
            for (int y = 0; y < height; y++)
                assert_memory_equal(a + (y + crop[2]) * 29 + crop[0], b + y * width, (size_t)width * sizeof *a);
            free(a);
            free(b);
        }
        ag_film_destroy(part);
    }
    ag_film_destroy(whole);
    studio_close(s);
}

/* Four times as bright where it is shown is twice the noise there. */
static void test_shown_exposure(void **state)
{
    (void)state;
    if (IS_SANITIZED)
        skip(); /* statistics of what test_same_bits runs */
    studio *s = open_adaptive(2, 0.03f);
    ag_film *plain = studio_render(s);
    s->settings.shown_exposure_stops = -2.0f;
    ag_film *darker = studio_render(s);
    s->settings.noise_level = 0.015f;
    ag_film *quiet = studio_render(s);
    double by_plain = film_mean(plain, "samples.V"), by_darker = film_mean(darker, "samples.V"),
           by_quiet = film_mean(quiet, "samples.V");
    if (!(by_darker < 0.7 * by_plain) || !(fabs(by_quiet / by_plain - 1.0) < 0.1))
        fail_msg("%g samples, %g when shown darker, %g for half the noise then", by_plain, by_darker, by_quiet);
    ag_film_destroy(plain);
    ag_film_destroy(darker);
    ag_film_destroy(quiet);
    studio_close(s);
}

/* The error as it is shown, root mean square over the picture, against one of many samples. */
static double shown_error(const ag_film *film, const ag_film *truth)
{
    int width, height;
    const float *a = ag_film_pixels(film, &width, &height), *b = ag_film_pixels(truth, &width, &height);
    double sum = 0.0;
    for (int i = 0; i < width * height; i++) {
        double mean = 0.0, squares = 0.0;
        for (int c = 0; c < 3; c++) {
            double off = (double)a[3 * i + c] - (double)b[3 * i + c];
            mean += (double)b[3 * i + c] / 3.0;
            squares += off * off / 3.0;
        }
        sum += 0.25 * squares / fmax(mean, 1e-3);
    }
    return sqrt(sum / (width * height));
}

static void test_noise_is_reached(void **state)
{
    (void)state;
    if (IS_SANITIZED)
        skip(); /* statistics of what test_same_bits runs */
    studio *s = open_adaptive(2, 0.0f);
    s->settings.samples_per_pixel = 4096;
    s->settings.seed = 8;
    ag_film *truth = studio_render(s);
    double mean_before = 0.0;
    for (int i = 0; i < 3; i++) {
        float level = 0.04f / (float)(1 << i);
        s->settings.noise_level = level;
        s->settings.seed = 0;
        ag_film *film = studio_render(s);
        double error = shown_error(film, truth), mean = film_mean(film, "samples.V");
        /* spread samples are better than their variance tells */
        if (!(error < 1.1 * (double)level) || !(error > 0.2 * (double)level))
            fail_msg("noise %g where %g was asked for, with %g samples", error, (double)level, mean);
        assert_true(mean > mean_before);
        mean_before = mean;
        ag_film_destroy(film);
    }
    ag_film_destroy(truth);
    studio_close(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_same_bits),
        TEST_IN_FOLDER(test_crops),
        TEST_IN_FOLDER(test_shown_exposure),
        TEST_IN_FOLDER(test_noise_is_reached),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
