/* test_splitting.c: how many gather rays, light samples and camera rays blocks of pixels choose: the best numbers in
 * closed form where variances and costs are known; the expectation stays; the picture is the same for any number of
 * threads, however the work is cut into passes, and in crops; and the choice pays. Threads: the renderer's. */
#define _GNU_SOURCE
#include "film/film_sums.h"
#include "film/splitting.h"
#include "fixtures/layers_fixture.h"
#include "fixtures/sanitizer.h"
#include "math/rng.h"

/* --- of samples made up --- */

enum { WIDTH = 16, HEIGHT = 8 }; /* two blocks */

static ag_film *create_film(const ag_render_settings *settings)
{
    static const char *const groups[] = {"default"};
    pixel_filter filter = {.mean_sign = 1.0};
    aov_layout layout;
    assert_int_equal(aov_layout_create(0, (aov_needs){.albedo_and_normal = false}, false, groups, 1, &layout), AG_OK);
    working_space space = working_space_rec709();
    ag_film *film = film_create(settings, &space, &filter, true, &layout);
    assert_non_null(film);
    return film;
}

static ag_render_settings settings_of(float noise_level, int samples)
{
    ag_render_settings s = ag_default_render_settings();
    s.width = WIDTH;
    s.height = HEIGHT;
    s.noise_level = noise_level;
    s.samples_per_pixel = samples;
    return s;
}

/* A block's pixels get four samples of these variances: of their own, by one gather ray, by one light sample and by one
 * camera ray; and of this mean square of caustics. */
typedef struct made_up {
    double own, by_ray, by_light, caustic, by_camera_ray;
} made_up;

/* A ray costs 4, as does a light sample, a further camera ray 24, a caustic and the rest of a camera sample 40 each. */
static void add_block(ag_film *film, int x0, made_up block)
{
    for (int y = 0; y < HEIGHT; y++)
        for (int x = x0; x < x0 + FILM_BLOCK; x++) {
            size_t pixel = film_pixel_at(film, x, y);
            split_counts counts = film->splits[pixel].counts;
            double rays = (double)counts.rays, lights = (double)(counts.lights * split_camera_rays(counts));
            eye_sample s = {.sign = 1,
                            .gather_variance = (float)(block.by_ray / rays),
                            .light_variance = (float)(block.by_light / lights),
                            .caustic_square = (float)block.caustic,
                            .caustic_cost = 40,
                            .gather_cost = 4 * counts.rays,
                            .light_cost = 4 * counts.lights * split_camera_rays(counts),
                            .further_cost = 24 * counts.further,
                            .rest_cost = 40};
            double own = block.own + block.by_ray / rays;
            double all = own + block.by_light / lights + block.by_camera_ray / (double)split_camera_rays(counts);
            for (int i = 0; i < 4; i++) {
                double sign = i % 2 ? 1.0 : -1.0;
                s.radiance = rgb_gray(1.0f + (float)(sign * sqrt(0.75 * all)));
                s.own = (float)(sign * sqrt(0.75 * own));
                film_add(film, pixel, &s);
            }
        }
}

/* first_rays: of each of the samples so far. */
static void expect_counts(const ag_film *film, int x, uint32_t first_rays, uint32_t rays, uint32_t lights)
{
    size_t pixel = film_pixel_at(film, x, 3);
    split_counts got = film->splits[pixel].counts;
    /* the next sample's rays follow those of the first four */
    assert_int_equal((film->counts[pixel] + got.ray_shift) * got.rays, first_rays * film->counts[pixel]);
    if (got.rays != rays || got.lights != lights)
        fail_msg("%u gather rays, %u light samples where %u and %u are best", got.rays, got.lights, rays, lights);
}

/* Of a block that goes on until it is quiet enough. */
static void test_best_numbers(void **state)
{
    (void)state;
    /* sqrt(0.04 / 0.04 * 40 / 4) = 3.2 and sqrt(0.02 / 0.04 * 40 / 4) = 2.2; and sqrt(0.008 / 0.032 * 40 / 40) = 1 / 2
     * for caustics, which is nearest to 1 then */
    ag_render_settings settings = settings_of(0.01f, 16);
    ag_film *film = create_film(&settings);
    for (size_t k = 0; k < film_area_count(film); k++)
        film->wanted[k] = 16;
    assert_int_equal(splitting_decide(film, &settings, 16), 4);
    expect_counts(film, 3, 16, 16, 4); /* by each of three camera rays */
    add_block(film, 0, (made_up){0.04, 0.04, 0.01, 0.008, 0.0});
    add_block(film, FILM_BLOCK, (made_up){.own = 0.04});
    for (int times = 0; times < 2; times++) { /* again changes nothing */
        assert_int_equal(splitting_decide(film, &settings, 16), 16);
        expect_counts(film, 3, 16, 4, 2);
        expect_counts(film, 11, 16, 1, 1);
        assert_int_equal(film->splits[film_pixel_at(film, 3, 3)].counts.caustic_bits, 1);
        assert_int_equal(film->splits[film_pixel_at(film, 11, 3)].counts.caustic_bits, 1);
    }
    assert_int_equal(splitting_decide(film, &settings, 4), 4); /* nothing to do */
    ag_film_destroy(film);
}

/* With a fixed number of samples, variance and cost of both halves together decide; of the samples' own variance that
 * the small picture tells, 1 / sqrt(N) counts. */
static void test_best_numbers_of_frames(void **state)
{
    (void)state;
    /* Caustics without light are asked for by each fourth sample, for 10. Halves that are alike: sqrt(0.64 / 0.04 * 50
     * / 4) = 14.1 rays, sqrt(0.16 / 0.04 * 50 / 4) = 7.1 light samples; with 150 more for each sample, 28.3 and 14.1.
     * Where one half has all the samples' own variance and the other all that of rays, these have half of the variance
     * 0.64 and half of the cost 4: sqrt(0.32 / 0.04 * 56 / 2) = 15.0, with 10 for caustics, 4 for the light sample and
     * 2 for the other half's ray in the 56. For itself alone, that half would want 64. */
    static const struct {
        double own[2], by_ray[2], by_light, fixed;
        uint32_t rays, lights;
    } cases[] = {{{0.04, 0.04}, {0.64, 0.64}, 0.16, 0.0, 16, 8},
                 {{0.04, 0.04}, {0.64, 0.64}, 0.16, 150.0, 32, 16},
                 {{0.0, 0.08}, {0.64, 0.0}, 0.0, 0.0, 16, 1}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        ag_render_settings settings = settings_of(0.0f, 8), pilots = settings_of(0.0f, 4);
        ag_film *film = create_film(&settings), *pilot = create_film(&pilots);
        for (int half = 0; half < 2; half++)
            add_block(pilot, half * FILM_BLOCK,
                      (made_up){sqrt(8.0) * cases[i].own[half], cases[i].by_ray[half], cases[i].by_light, 0.0, 0.0});
        double samples = (double)settings.samples_per_pixel * WIDTH * HEIGHT;
        assert_int_equal(splitting_begin(film, pilot, cases[i].fixed * samples, &settings), AG_OK);
        uint32_t first = film->splits[0].counts.rays;
        for (int half = 0; half < 2; half++)
            add_block(film, half * FILM_BLOCK,
                      (made_up){cases[i].own[half], cases[i].by_ray[half], cases[i].by_light, 0.0, 0.0});
        assert_int_equal(splitting_decide(film, &settings, 8), 8);
        split_counts got = film->splits[film_pixel_at(film, 3, 3)].counts;
        if (first != cases[i].rays || got.rays != cases[i].rays || got.lights != cases[i].lights)
            fail_msg("%u gather rays at first, %u and %u light samples later where %u and %u are best", first, got.rays,
                     got.lights, cases[i].rays, cases[i].lights);
        ag_film_destroy(film);
        ag_film_destroy(pilot);
    }
}

/* With a level of noise, a block that the least number of samples makes quiet enough takes the numbers by the whole
 * frame, and a block that needs more of them those for itself; where no more are allowed, the frame's again. */
static void test_best_numbers_at_a_level(void **state)
{
    (void)state;
    /* A quarter of a variance of 1 is shown. By the frame: sqrt(0.01 / 4 * 2400) = 2.4 gather rays and 1.2 light
     * samples in the quiet block, 24.5 and 12.2 in the noisy one. For itself that has 3.2 and 1.6, as in
     * test_best_numbers. */
    static const made_up quiet = {.own = 0.04, .by_ray = 0.04, .by_light = 0.01},
                         noisy = {.own = 4.0, .by_ray = 4.0, .by_light = 1.0};
    for (int k = 0; k < 2; k++) {
        const bool may_have_more = k == 0;
        ag_render_settings settings = settings_of(0.05f, may_have_more ? 1024 : 16);
        assert_int_equal(settings.noise_min_samples, 16);
        ag_film *film = create_film(&settings);
        const uint32_t first_rays = film->splits[0].counts.rays;
        film->prior.cost_per_variance = 2400.0;
        for (size_t pixel = 0; pixel < film_area_count(film); pixel++)
            film->wanted[pixel] = 16;
        add_block(film, 0, quiet);
        add_block(film, FILM_BLOCK, noisy);
        assert_int_equal(splitting_decide(film, &settings, 16), 16);
        expect_counts(film, 3, first_rays, 2, 1);
        expect_counts(film, 11, first_rays, may_have_more ? 4 : 32, may_have_more ? 2 : 16);
        ag_film_destroy(film);
    }
}

static uint32_t camera_rays_at(const ag_film *film, int x)
{
    return split_camera_rays(film->splits[film_pixel_at(film, x, 3)].counts);
}

/* How many camera rays a sample has, by the variance that these bring, of which 1 / sqrt(N) counts. */
static void test_best_camera_rays(void **state)
{
    (void)state;
    /* A block by itself: 40 for the rest, 20 for half of the caustics, 4 for a gather ray, 4 for a light sample of each
     * of n camera rays, 24 for each but the first: (0.02 + 0.16 / n) (40 + 28 n) is 12.2, 9.6, 9.1, 9.4 and 11.0 for 1,
     * 2, 3, 5 and 9. */
    ag_render_settings settings = settings_of(0.01f, 16);
    ag_film *film = create_film(&settings);
    for (size_t k = 0; k < film_area_count(film); k++)
        film->wanted[k] = 16;
    assert_int_equal(camera_rays_at(film, 3), 3);
    add_block(film, 0, (made_up){.own = 0.02, .by_camera_ray = sqrt(16.0) * 0.16});
    add_block(film, FILM_BLOCK, (made_up){.own = 0.04, .by_ray = 0.04});
    for (int times = 0; times < 2; times++) { /* again changes nothing */
        assert_int_equal(splitting_decide(film, &settings, 16), 16);
        assert_int_equal(camera_rays_at(film, 3), 3);
        assert_int_equal(camera_rays_at(film, 11), 1);
    }
    ag_film_destroy(film);

    /* With a fixed number of samples sqrt(S / 24 * F / E) camera rays; a quarter of a variance of 1 is shown. 3.1 is
     * nearest to 3, 1.3 to 1. */
    settings = settings_of(0.0f, 8);
    film = create_film(&settings);
    film->prior.cost_per_variance = 2400.0;
    add_block(film, 0, (made_up){.own = 0.01, .by_camera_ray = sqrt(8.0) * 0.384});
    add_block(film, FILM_BLOCK, (made_up){.own = 0.01, .by_camera_ray = sqrt(8.0) * 0.0676});
    assert_int_equal(splitting_decide(film, &settings, 8), 8);
    assert_int_equal(camera_rays_at(film, 3), 3);
    assert_int_equal(camera_rays_at(film, 11), 1);
    ag_film_destroy(film);

    /* few samples have one more, at least; indirect light alone comes by one */
    for (int samples = 1; samples <= 9; samples++) {
        settings = settings_of(0.0f, samples);
        assert_int_equal(sample_split_first(&settings, true).further, samples < 9);
        assert_int_equal(sample_split_first(&settings, false).further, 0);
        settings.only = AG_ONLY_INDIRECT;
        assert_int_equal(sample_split_first(&settings, true).further, 0);
        assert_int_equal(sample_split_most(&settings, true).further, 0);
    }
}

/* Light so bright that its square is no number leaves counts that can be used. */
static void test_blinding_light(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        ag_render_settings settings = settings_of(k == 0 ? 0.01f : 0.0f, 16);
        ag_film *film = create_film(&settings);
        for (size_t pixel = 0; pixel < film_area_count(film); pixel++) {
            if (film->wanted)
                film->wanted[pixel] = 16;
            for (int i = 0; i < 4; i++)
                film_add(film, pixel,
                         &(eye_sample){.radiance = rgb_gray((float)i * 1e22f), .sign = 1, .rest_cost = 40});
        }
        assert_int_equal(splitting_decide(film, &settings, 16), 16);
        split_counts got = film->splits[0].counts;
        assert_true(got.rays >= 1 && got.lights >= 1);
        ag_film_destroy(film);
    }
}

/* Before the first sample, by a picture of the whole frame; the same counts again when the film is emptied. */
static void test_first_numbers(void **state)
{
    (void)state;
    ag_render_settings settings = settings_of(0.0f, 16), pilots = settings_of(0.0f, 4);
    ag_film *pilot = create_film(&pilots), *film;
    add_block(pilot, 0, (made_up){sqrt(16.0) * 0.04, 0.64, 0.16, 0.004, 0.0});
    add_block(pilot, FILM_BLOCK, (made_up){.own = sqrt(16.0) * 0.04});
    settings.width = 5 * WIDTH; /* five blocks of it lie in one of the pilot */
    settings.crop_window[0] = 0.3;
    film = create_film(&settings);
    assert_int_equal(splitting_begin(film, pilot, 0.0, &settings), AG_OK);
    for (int times = 0; times < 2; times++) {
        split_counts lit = film->splits[film_pixel_at(film, 31, 3)].counts,
                     dark = film->splits[film_pixel_at(film, 64, 3)].counts;
        /* F / E (splitting.h) is 1290, in closed form by iteration: sqrt(0.64 / 4 * 1290) = 14.4 rays, sqrt(0.16 / 4 *
         * 1290) = 7.2 light samples, sqrt(0.004 / 40 * 1290) = 0.36 of the caustics; in the dark the least of both. A
         * quarter of a variance of 1 is shown. */
        assert_true(fabs(0.25 * film->prior.cost_per_variance - 1290.0) < 10.0);
        assert_true(lit.rays == 16 && lit.lights == 8 && lit.caustic_bits == 1 && lit.ray_shift == 0);
        assert_true(dark.rays == 4 && dark.lights == 4);
        film_clear(film, &settings);
    }
    ag_film_destroy(film);
    ag_film_destroy(pilot);
}

/* Few samples never choose again: edges that the small picture has met get camera rays, and all else two; gather rays
 * need not tell their variance. */
static void test_first_camera_rays(void **state)
{
    (void)state;
    ag_render_settings settings = settings_of(0.0f, 4);
    ag_film *pilot = create_film(&settings), *film = create_film(&settings);
    add_block(pilot, 0, (made_up){.own = 0.04, .by_ray = 0.001, .by_light = 0.04});
    add_block(pilot, FILM_BLOCK, (made_up){.own = 0.04, .by_ray = 0.04, .by_light = 0.04, .by_camera_ray = 0.6});
    assert_int_equal(splitting_begin(film, pilot, 0.0, &settings), AG_OK);
    /* F / E is 2039, in closed form by iteration: sqrt(0.3 / 24 * 2039) = 5.0 camera rays, sqrt(0.001 / 4 * 2039) = 0.7
     * gather rays */
    assert_true(fabs(0.25 * film->prior.cost_per_variance - 2039.0) < 10.0);
    assert_int_equal(camera_rays_at(film, 3), 2);
    assert_int_equal(camera_rays_at(film, 11), 5);
    assert_int_equal(film->splits[film_pixel_at(film, 3, 3)].counts.rays, 1);
    ag_film_destroy(film);
    ag_film_destroy(pilot);
}

/* Where the pilot has met nothing that gathers or is lit, blocks begin as they would without it. */
static void test_first_numbers_of_the_unknown(void **state)
{
    (void)state;
    ag_render_settings settings = settings_of(0.0f, 64), pilots = settings_of(0.0f, 4);
    ag_film *pilot = create_film(&pilots), *film = create_film(&settings);
    for (size_t i = 0; i < film_area_count(pilot); i++)
        for (int k = 0; k < 4; k++)
            film_add(pilot, i, &(eye_sample){.sign = 1, .rest_cost = 1});
    split_counts first = sample_split_first(&settings, true);
    assert_int_equal(splitting_begin(film, pilot, 0.0, &settings), AG_OK);
    assert_true(film->splits[0].counts.rays == first.rays && film->splits[0].counts.lights == first.lights);
    assert_true(first.rays == 4 && first.lights == 16);
    ag_film_destroy(film);
    ag_film_destroy(pilot);
}

/* Where light is bounded caustics are asked for always. */
static void test_bounded_light(void **state)
{
    (void)state;
    ag_render_settings settings = settings_of(0.0f, 16);
    settings.clamp_indirect = 1.0f;
    ag_film *film = create_film(&settings);
    add_block(film, 0, (made_up){0.04, 0.04, 0.02, 0.0, 0.0});
    add_block(film, FILM_BLOCK, (made_up){.own = 0.04});
    assert_int_equal(splitting_decide(film, &settings, 16), 16);
    for (size_t pixel = 0; pixel < film_area_count(film); pixel++)
        assert_int_equal(film->splits[pixel].counts.caustic_bits, 0);
    ag_film_destroy(film);
}

static void test_given_number(void **state)
{
    (void)state;
    ag_render_settings settings = settings_of(0.0f, 16);
    settings.gather_samples = 20;
    ag_film *film = create_film(&settings);
    assert_false(sample_split_is_open(&settings, true));
    assert_null(film->splits);
    split_counts counts = sample_split_first(&settings, true);
    assert_true(counts.rays == 20 && counts.lights == 3);
    ag_film_destroy(film);
    settings.gather_samples = 0;
    assert_true(sample_split_is_open(&settings, true));
    assert_false(sample_split_is_open(&settings, false));
}

/* A sample of mean 2, skewed: 1 / share with probability share, and as much in the mean by gather rays. */
static void add_skewed(ag_film *film, size_t pixel, rng *random)
{
    static const float OWN = 0.2f, RAY = 0.1f;
    uint32_t rays = film->splits[pixel].counts.rays, found = 0;
    for (uint32_t i = 0; i < rays; i++)
        found += rng_float(random) < RAY;
    float n = (float)rays, sum = (float)found / RAY, squares = (float)found / (RAY * RAY);
    float variance = rays > 1 ? (squares - sum * sum / n) / (n * (n - 1.0f)) : 0.5f * squares;
    float value = (rng_float(random) < OWN ? 1.0f / OWN : 0.0f) + sum / n;
    film_add(film, pixel,
             &(eye_sample){.radiance = rgb_gray(value),
                           .sign = 1,
                           .gather_variance = variance,
                           .own = value,
                           .gather_cost = 4 * rays,
                           .light_cost = 8,
                           .rest_cost = 40});
}

/* The numbers are chosen by the samples' values: that must not show in the mean. */
static void test_expectation(void **state)
{
    (void)state;
    if (IS_SANITIZED)
        skip(); /* statistics of what test_best_numbers runs */
    enum { FILMS = 400, SAMPLES = 8 };
    const ag_render_settings settings = settings_of(0.0f, SAMPLES);
    double sum = 0.0, squares = 0.0;
    uint32_t least = UINT32_MAX, most = 0;
    for (int i = 0; i < FILMS; i++) {
        ag_film *film = create_film(&settings);
        rng random = rng_make(5, 6, (uint64_t)i);
        for (uint32_t done = 0; done < SAMPLES;) {
            uint32_t next = splitting_decide(film, &settings, SAMPLES);
            for (size_t pixel = 0; pixel < film_area_count(film); pixel++)
                for (uint32_t k = done; k < next; k++)
                    add_skewed(film, pixel, &random);
            done = next;
        }
        uint32_t rays = film->splits[0].counts.rays;
        least = rays < least ? rays : least;
        most = rays > most ? rays : most;
        film_resolve(film);
        double mean = film_mean(film, "R");
        sum += mean;
        squares += mean * mean;
        ag_film_destroy(film);
    }
    double mean = sum / FILMS, error = sqrt((squares / FILMS - mean * mean) / FILMS);
    print_message("mean %.4f +- %.4f, by %u to %u rays\n", mean, error, least, most);
    assert_true(most > least && error < 0.01);
    expect_within("mean", mean, 2.0, 4.0 * error);
}

/* --- of pictures --- */

static studio *open_room(unsigned threads, float noise_level)
{
    studio *s = studio_open(LAYERS_SCENES "glass_ball_room.pbrt", threads);
    s->settings.width = 29, s->settings.height = 27;
    s->settings.samples_per_pixel = 24;
    s->settings.noise_level = noise_level;
    s->settings.gather_samples = 0;
    s->settings.layers = AG_LAYERS_LIGHT;
    return s;
}

static const float LEVELS[] = {0.0f, 0.06f};

static void test_same_bits(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        studio *s = open_room(1, LEVELS[k]), *threaded = open_room(3, LEVELS[k]);
        ag_film *whole = studio_render(s), *other = studio_render(threaded), *cut;
        expect_same_film(whole, other);
        ag_rendering *r = studio_begin(threaded);
        static const int passes[] = {1, 2, 4, 7, 16, 16, 17, 24, 24};
        for (size_t i = 0; i < sizeof passes / sizeof *passes; i++) {
            ag_context_pause(threaded->context);
            assert_int_equal(ag_rendering_continue(r, passes[i]), AG_PAUSED);
            if (i != 3)
                assert_int_equal(ag_rendering_continue(r, passes[i]), AG_OK);
            if (i == 3) { /* another goes on */
                assert_int_equal(ag_rendering_write_checkpoint(r, in_folder("c")), AG_OK);
                ag_rendering_finish(r, NULL);
                studio *hold = s;
                s = threaded;
                threaded = hold;
                r = studio_begin(threaded);
                assert_int_equal(ag_rendering_read_checkpoint(r, in_folder("c")), AG_OK);
            }
        }
        ag_rendering_finish(r, &cut);
        expect_same_film(whole, cut);
        ag_film_destroy(whole);
        ag_film_destroy(other);
        ag_film_destroy(cut);
        studio_close(s);
        studio_close(threaded);
    }
}

/* A picture whose blocks choose cannot be gone on with by one whose do not. */
static void test_checkpoint_of_other(void **state)
{
    (void)state;
    studio *s = open_room(1, 0.0f);
    ag_rendering *r = studio_begin(s);
    assert_int_equal(ag_rendering_continue(r, 1), AG_OK);
    assert_int_equal(ag_rendering_write_checkpoint(r, in_folder("c")), AG_OK);
    ag_rendering_finish(r, NULL);
    s->settings.gather_samples = 10;
    r = studio_begin(s);
    assert_int_equal(ag_rendering_read_checkpoint(r, in_folder("c")), AG_ERROR_INPUT);
    assert_non_null(strstr(s->said, "another number of gather rays"));
    ag_rendering_finish(r, NULL);
    studio_close(s);
}

static void test_crops(void **state)
{
    (void)state;
    for (int level = 0; level < 2; level++) {
        studio *s = open_room(2, LEVELS[level]);
        ag_film *whole = studio_render(s);
        static const int crops[][4] = {{5, 19, 3, 22}, {8, 16, 8, 16}, {27, 29, 25, 27}};
        for (size_t i = 0; i < sizeof crops / sizeof *crops; i++) {
            const int *crop = crops[i];
            for (int k = 0; k < 4; k++)
                s->settings.crop_window[k] = (double)crop[k] / (k < 2 ? 29.0 : 27.0);
            ag_film *part = studio_render(s);
            int width = crop[1] - crop[0], told_width, told_height;
            const float *a = ag_film_pixels(whole, &told_width, &told_height),
                        *b = ag_film_pixels(part, &told_width, &told_height);
            assert_true(told_width == width && told_height == crop[3] - crop[2]);
            for (int y = crop[2]; y < crop[3]; y++)
                assert_memory_equal(a + 3 * (y * 29 + crop[0]), b + 3 * (y - crop[2]) * width,
                                    3 * (size_t)width * sizeof *a);
            ag_film_destroy(part);
        }
        ag_film_destroy(whole);
        studio_close(s);
    }
}

/* Caustics that are asked for by chance have the mean of those that are asked for always, on the same photons. */
static void test_caustics_by_chance(void **state)
{
    (void)state;
    if (IS_SANITIZED)
        skip(); /* statistics of what test_same_bits runs */
    enum { SEEDS = 24 };
    studio *s = open_room(1, 0.0f);
    s->settings.photon_seed = 7;
    double sum = 0.0, squares = 0.0, always = 0.0;
    uint32_t rare = 0;
    for (int i = 0; i < SEEDS; i++) {
        double mean[2];
        s->settings.seed = (uint64_t)i + 1;
        for (int k = 0; k < 2; k++) {
            s->settings.gather_samples = k == 0 ? 0 : 4;
            ag_film *film = studio_render(s);
            for (size_t pixel = 0; k == 0 && pixel < film_area_count(film); pixel++)
                rare += film->splits[pixel].counts.caustic_bits > 0;
            mean[k] = film_mean(film, "caustic.R");
            ag_film_destroy(film);
        }
        sum += mean[0] - mean[1];
        squares += (mean[0] - mean[1]) * (mean[0] - mean[1]);
        always += mean[1] / SEEDS;
    }
    double mean = sum / SEEDS, error = sqrt((squares / SEEDS - mean * mean) / (SEEDS - 1));
    print_message("caustics %.4e, by chance %+.2e +- %.2e more; in %u pixels\n", always, mean, error, rare / SEEDS);
    assert_true(rare > 0 && always > 0.0 && error < 0.02 * always);
    expect_within("caustics by chance", mean, 0.0, 4.0 * error);
    studio_close(s);
}

/* Further camera rays bring what the samples' own ones bring, of each part, on the same photons. Channels that a scene
 * has nothing in agree in that. */
static void test_expectation_of_further_rays(void **state)
{
    (void)state;
    if (IS_SANITIZED)
        skip(); /* statistics of what test_same_bits runs */
    enum { SEEDS = 16, CHANNELS = 6, SCENES = 4 };
    static const char *const scenes[SCENES] = {LAYERS_SCENES "rough_coats.pbrt", LAYERS_SCENES "glass_and_metal.pbrt",
                                               LAYERS_SCENES "foggy_room.pbrt", LAYERS_SCENES "environment.pbrt"};
    static const char *const channels[CHANNELS] = {"R", "emission.R", "direct.R", "specular.R", "indirect.R", "A"};
    uint32_t found = 0, several = 0;
    for (int n = 0; n < SCENES; n++) {
        studio *s = studio_open(scenes[n], 1);
        s->settings.width = 29, s->settings.height = 27;
        s->settings.noise_level = 0.0f;
        s->settings.photon_count = 30000;
        s->settings.photon_seed = 7;
        s->settings.layers = AG_LAYERS_LIGHT | AG_LAYER_ALPHA;
        double sum[CHANNELS] = {0}, squares[CHANNELS] = {0}, single[CHANNELS] = {0};
        for (int i = 0; i < SEEDS; i++) {
            ag_film *films[2];
            s->settings.seed = (uint64_t)i + 1;
            for (int k = 0; k < 2; k++) {
                s->settings.gather_samples = k == 0 ? 0 : 4;
                s->settings.samples_per_pixel = k == 0 ? 1 : 8;
                films[k] = studio_render(s);
            }
            for (size_t pixel = 0; pixel < film_area_count(films[0]); pixel++) {
                uint32_t further = films[0]->splits[pixel].counts.further;
                assert_true(further > 0);
                several |= further;
            }
            for (int c = 0; c < CHANNELS; c++) {
                double mean = film_mean(films[1], channels[c]), more = film_mean(films[0], channels[c]) - mean;
                sum[c] += more;
                squares[c] += more * more;
                single[c] += mean / SEEDS;
            }
            ag_film_destroy(films[0]);
            ag_film_destroy(films[1]);
        }
        for (int c = 0; c < CHANNELS; c++) {
            double mean = sum[c] / SEEDS, error = sqrt(fmax(squares[c] / SEEDS - mean * mean, 0.0) / (SEEDS - 1));
            print_message("%s %.4e, by several camera rays %+.2e +- %.2e more\n", channels[c], single[c], mean, error);
            assert_true(c > 0 || (single[c] > 0.0 && error < 0.01 * single[c]));
            found |= (uint32_t)(error > 0.0 && error < 0.01 * single[c]) << c;
            expect_within(channels[c], mean, 0.0, 4.0 * error + 1e-6 * single[0]);
        }
        studio_close(s);
    }
    assert_int_equal(found, (1 << CHANNELS) - 1); /* each is told by one of the scenes */
    assert_true(several >= 4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_best_numbers),
        cmocka_unit_test(test_best_numbers_of_frames),
        cmocka_unit_test(test_best_numbers_at_a_level),
        cmocka_unit_test(test_best_camera_rays),
        cmocka_unit_test(test_blinding_light),
        cmocka_unit_test(test_first_numbers),
        cmocka_unit_test(test_first_camera_rays),
        cmocka_unit_test(test_first_numbers_of_the_unknown),
        cmocka_unit_test(test_bounded_light),
        cmocka_unit_test(test_given_number),
        cmocka_unit_test(test_expectation),
        TEST_IN_FOLDER(test_same_bits),
        TEST_IN_FOLDER(test_crops),
        TEST_IN_FOLDER(test_caustics_by_chance),
        cmocka_unit_test(test_expectation_of_further_rays),
        TEST_IN_FOLDER(test_checkpoint_of_other),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
