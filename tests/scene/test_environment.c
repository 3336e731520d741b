/* test_environment.c: pictures of the sphere: where their pixels lie, how they are sampled, and the photons they send.
 * Directions of octahedral pictures are those of pbrt-v4, of latitude-longitude ones those of pbrt-v3. Threads: one. */
/* ctest: serial */
#include "fixtures/test_scene.h"
#include "light/environment.h"

enum { SAMPLES = 200000 / FEWER };

/* --- the grid --- */

static void cells_are_picked_by_weight(void **state)
{
    (void)state;
    enum { WIDTH = 5, HEIGHT = 4 };
    static const float WEIGHTS[HEIGHT][WIDTH] = {
        {0, 0, 0, 0, 0}, {0, 1, 0, 3, 0}, {0.5f, 0, 0, 0, 2}, {0, 0, 1e-20f, 0, 0}};
    distribution_2d d;
    assert_int_equal(distribution_2d_create(WIDTH, HEIGHT, &WEIGHTS[0][0], &d), AG_OK);
    double whole = 0.0;
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++) {
            assert_close(distribution_2d_probability(&d, x, y), WEIGHTS[y][x] / 6.5, 1e-6);
            assert_true(WEIGHTS[y][x] > 0.0f || distribution_2d_probability(&d, x, y) == 0.0f);
            whole += (double)distribution_2d_probability(&d, x, y);
        }
    assert_close(whole, 1.0, 1e-6);

    uint32_t counts[HEIGHT][WIDTH] = {{0}};
    double within[2] = {0.0, 0.0};
    rng random = test_random(1);
    for (int i = 0; i < SAMPLES; i++) {
        distribution_2d_sample at;
        assert_true(distribution_2d_pick(&d, rng_vec2(&random), &at));
        assert_true(at.probability == distribution_2d_probability(&d, at.x, at.y) && at.probability > 0.0f);
        assert_true(at.within.x >= 0.0f && at.within.x < 1.0f && at.within.y >= 0.0f && at.within.y < 1.0f);
        within[0] += (double)at.within.x / SAMPLES, within[1] += (double)at.within.y / SAMPLES;
        counts[at.y][at.x]++;
    }
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            double p = WEIGHTS[y][x] / 6.5;
            assert_close(counts[y][x], p * SAMPLES, 5.0 * sqrt(p * (1.0 - p) * SAMPLES) + 1e-9);
        }
    assert_close(within[0], 0.5, 5.0 * sqrt(1.0 / 12.0 / SAMPLES));
    assert_close(within[1], 0.5, 5.0 * sqrt(1.0 / 12.0 / SAMPLES));

    /* the ends of the interval */
    distribution_2d_sample at;
    assert_true(distribution_2d_pick(&d, (vec2){0.0f, 0.0f}, &at) && at.x == 1 && at.y == 1);
    assert_true(distribution_2d_pick(&d, (vec2){0x1.fffffep-1f, 0.5f}, &at) && at.x == 3 && at.y == 1);
    assert_true(distribution_2d_pick(&d, (vec2){0x1.fffffep-1f, 0.99f}, &at) && at.x == 4 && at.y == 2);
    distribution_2d_reset(&d);

    static const float NOTHING[4] = {0};
    assert_int_equal(distribution_2d_create(2, 2, NOTHING, &d), AG_OK);
    assert_false(distribution_2d_pick(&d, (vec2){0.5f, 0.5f}, &at));
    assert_true(distribution_2d_probability(&d, 1, 1) == 0.0f);
    distribution_2d_reset(&d);
}

/* The first cell whose running sum is above u, found one by one; the last where none is. */
static uint32_t found_one_by_one(const float *cdf, uint32_t count, float u)
{
    for (uint32_t i = 0; i < count; i++)
        if (cdf[i + 1] > u)
            return i;
    return count - 1;
}

static void expect_same_pick(const distribution_2d *d, vec2 u)
{
    distribution_2d_sample at;
    const uint32_t y = found_one_by_one(d->row_cdf, d->height, u.y);
    assert_true(distribution_2d_pick(d, u, &at));
    assert_int_equal(at.y, y);
    assert_int_equal(at.x, found_one_by_one(d->cell_cdf + (size_t)y * (d->width + 1), d->width, u.x));
}

static void cells_are_those_that_a_walk_over_all_finds(void **state)
{
    (void)state;
    static const uint32_t SIZES[][2] = {{1, 1}, {2, 1}, {1, 3}, {7, 5}, {64, 33}, {1000, 3}, {65535, 2}};
    rng random = test_random(2);
    for (size_t i = 0; i < sizeof SIZES / sizeof *SIZES; i++) {
        const uint32_t width = SIZES[i][0], height = SIZES[i][1];
        float *weights = malloc((size_t)width * height * sizeof *weights);
        assert_non_null(weights);
        for (size_t k = 0; k < (size_t)width * height; k++) /* most are 0, few are large */
            weights[k] = rng_float(&random) < 0.6f ? 0.0f : powf(rng_float(&random), 8.0f);
        weights[(size_t)width * height / 2] = 1.0f;
        distribution_2d d;
        assert_int_equal(distribution_2d_create(width, height, weights, &d), AG_OK);
        for (int k = 0; k < 2000; k++)
            expect_same_pick(&d, rng_vec2(&random));
        for (uint32_t x = 0; x < width; x += 1 + width / 500) { /* at the sums themselves, and beside them */
            const float sum = fminf(d.cell_cdf[x], 0x1.fffffep-1f);
            expect_same_pick(&d, (vec2){sum, 0.0f});
            expect_same_pick(&d, (vec2){fmaxf(nextafterf(sum, 0.0f), 0.0f), 0.0f});
        }
        distribution_2d_reset(&d);
        free(weights);
    }
}

/* --- the maps --- */

/* A picture of noise, some of it black and one pixel bright. */
static environment *noise_create(environment_mapping mapping, uint32_t width, uint32_t height, uint64_t seed)
{
    rng random = test_random(seed);
    rgb *pixels = malloc((size_t)width * height * sizeof *pixels);
    assert_non_null(pixels);
    for (uint32_t i = 0; i < width * height; i++) {
        float x = rng_float(&random), y = rng_float(&random), z = rng_float(&random);
        pixels[i] = x < 0.2f ? rgb_gray(0.0f) : rgb_make(x, y, z);
    }
    pixels[width * height / 3] = rgb_make(20.0f, 15.0f, 5.0f);
    environment *e;
    assert_int_equal(environment_create(mapping, width, height, pixels, &e), AG_OK);
    return e;
}

static void assert_direction(vec3 d, double x, double y, double z)
{
    assert_close(d.x, x, 1e-6);
    assert_close(d.y, y, 1e-6);
    assert_close(d.z, z, 1e-6);
}

static void directions_are_those_of_pbrt(void **state)
{
    (void)state;
    double half = sqrt(0.5), h = 0.25, across = h * sqrt(2.0 - h * h) * half; /* at |u| = |v| = 1/8 from the middle */
    struct {
        environment_mapping mapping;
        float x, y; /* of the picture, [0, 1] */
        double d[3];
    } known[] = {
        {ENVIRONMENT_OCTAHEDRAL, 0.5f, 0.5f, {0, 0, 1}},
        {ENVIRONMENT_OCTAHEDRAL, 1.0f, 0.5f, {1, 0, 0}},
        {ENVIRONMENT_OCTAHEDRAL, 0.0f, 0.5f, {-1, 0, 0}},
        {ENVIRONMENT_OCTAHEDRAL, 0.5f, 1.0f, {0, 1, 0}},
        {ENVIRONMENT_OCTAHEDRAL, 0.5f, 0.0f, {0, -1, 0}},
        {ENVIRONMENT_OCTAHEDRAL, 0.0f, 0.0f, {0, 0, -1}},
        {ENVIRONMENT_OCTAHEDRAL, 1.0f, 0.0f, {0, 0, -1}},
        {ENVIRONMENT_OCTAHEDRAL, 1.0f, 1.0f, {0, 0, -1}},
        {ENVIRONMENT_OCTAHEDRAL, 0.75f, 0.75f, {half, half, 0}},
        {ENVIRONMENT_OCTAHEDRAL, 0.25f, 0.75f, {-half, half, 0}},
        {ENVIRONMENT_OCTAHEDRAL, 0.75f, 0.5f, {0.5 * sqrt(1.75), 0, 0.75}},
        {ENVIRONMENT_OCTAHEDRAL, 0.5625f, 0.5625f, {across, across, 1.0 - h * h}},
        {ENVIRONMENT_OCTAHEDRAL, 0.9375f, 0.9375f, {across, across, h * h - 1.0}},
        {ENVIRONMENT_LATITUDE_LONGITUDE, 0.3f, 0.0f, {0, 0, 1}},
        {ENVIRONMENT_LATITUDE_LONGITUDE, 0.7f, 1.0f, {0, 0, -1}},
        {ENVIRONMENT_LATITUDE_LONGITUDE, 0.0f, 0.5f, {1, 0, 0}},
        {ENVIRONMENT_LATITUDE_LONGITUDE, 0.25f, 0.5f, {0, 1, 0}},
        {ENVIRONMENT_LATITUDE_LONGITUDE, 0.5f, 0.5f, {-1, 0, 0}},
        {ENVIRONMENT_LATITUDE_LONGITUDE, 0.75f, 0.5f, {0, -1, 0}},
        {ENVIRONMENT_LATITUDE_LONGITUDE, 0.125f, 0.25f, {0.5, 0.5, half}},
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        uint32_t height = 16, width = known[i].mapping == ENVIRONMENT_OCTAHEDRAL ? 16 : 32;
        environment *e = noise_create(known[i].mapping, width, height, 1);
        float px = known[i].x * (float)width, py = known[i].y * (float)height;
        uint32_t x = (uint32_t)fminf(px, (float)width - 1.0f), y = (uint32_t)fminf(py, (float)height - 1.0f);
        vec3 d = environment_direction(e, x, y, (vec2){px - (float)x, py - (float)y});
        assert_direction(d, known[i].d[0], known[i].d[1], known[i].d[2]);
        /* the way back ends in the picture, even on seams and poles */
        environment_pixel_at(e, d, &x, &y);
        assert_true(x < width && y < height);
        environment_pixel_at(e, vec3_make(0.0f, -0.0f, copysignf(1.0f, d.z)), &x, &y);
        assert_true(x < width && y < height);
        environment_destroy(e);
    }
}

static const struct {
    environment_mapping mapping;
    uint32_t width, height;
} SIZES[] = {{ENVIRONMENT_OCTAHEDRAL, 1, 1},         {ENVIRONMENT_OCTAHEDRAL, 7, 7},
             {ENVIRONMENT_OCTAHEDRAL, 64, 64},       {ENVIRONMENT_LATITUDE_LONGITUDE, 2, 1},
             {ENVIRONMENT_LATITUDE_LONGITUDE, 6, 3}, {ENVIRONMENT_LATITUDE_LONGITUDE, 64, 32}};
enum { SIZE_COUNT = sizeof SIZES / sizeof *SIZES };

/* A point of the picture becomes a unit direction, which leads back to the same pixel. */
static void points_and_directions_round_trip(void **state)
{
    (void)state;
    for (int k = 0; k < SIZE_COUNT; k++) {
        environment *e = noise_create(SIZES[k].mapping, SIZES[k].width, SIZES[k].height, 2);
        rng random = test_random(2);
        for (int i = 0; i < SAMPLES / 10; i++) {
            uint32_t x = (uint32_t)(rng_float(&random) * (float)e->width), back_x;
            uint32_t y = (uint32_t)(rng_float(&random) * (float)e->height), back_y;
            vec2 u = rng_vec2(&random), within = {0.001f + 0.998f * u.x, 0.001f + 0.998f * u.y};
            vec3 d = environment_direction(e, x, y, within);
            assert_close(vec3_length(d), 1.0, 1e-6);
            environment_pixel_at(e, d, &back_x, &back_y);
            assert_true(back_x == x && back_y == y);
        }
        environment_destroy(e);
    }
}

/* Even directions fall into pixels in proportion to their solid angles, which sum to the sphere's. */
static void pixels_have_their_solid_angles(void **state)
{
    (void)state;
    for (int k = 0; k < SIZE_COUNT; k++) {
        environment *e = noise_create(SIZES[k].mapping, SIZES[k].width, SIZES[k].height, 3);
        uint32_t *counts = calloc((size_t)e->width * e->height, sizeof *counts);
        assert_non_null(counts);
        rng random = test_random(3);
        for (int i = 0; i < SAMPLES; i++) {
            uint32_t x, y;
            environment_pixel_at(e, random_direction(&random), &x, &y);
            counts[y * e->width + x]++;
        }
        double chi = 0.0, whole = 0.0;
        for (uint32_t y = 0; y < e->height; y++)
            for (uint32_t x = 0; x < e->width; x++) {
                double solid_angle = environment_pixel_solid_angle(e, y);
                double expected = solid_angle / (4.0 * PI) * SAMPLES, off = counts[y * e->width + x] - expected;
                whole += solid_angle;
                chi += off * off / expected;
            }
        double degrees = (double)e->width * e->height;
        assert_relative(whole, 4.0 * PI, 1e-6);
        assert_true(chi < degrees + 5.0 * sqrt(2.0 * degrees) + 5.0);
        free(counts);
        environment_destroy(e);
    }
}

/* Small pixels of a large picture, at the poles too, keep their size: what is sampled in them comes back to them. */
static void large_pictures_are_sharp(void **state)
{
    (void)state;
    static const uint32_t ROWS[] = {0, 1, 5, 511, 1023, 1024, 1500, 2046, 2047};
    for (int k = 0; k < 2; k++) {
        environment e = {.mapping = k ? ENVIRONMENT_LATITUDE_LONGITUDE : ENVIRONMENT_OCTAHEDRAL,
                         .width = k ? 4096 : 2048,
                         .height = 2048};
        rng random = test_random(4);
        int missed = 0, count = 0;
        for (size_t row = 0; row < sizeof ROWS / sizeof *ROWS; row++)
            for (int i = 0; i < 1000; i++) {
                uint32_t x = (uint32_t)(rng_float(&random) * (float)e.width), back_x, back_y;
                vec2 u = rng_vec2(&random), within = {0.05f + 0.9f * u.x, 0.05f + 0.9f * u.y};
                environment_pixel_at(&e, environment_direction(&e, x, ROWS[row], within), &back_x, &back_y);
                missed += back_x != x || back_y != ROWS[row];
                count++;
            }
        assert_true(missed <= count / 500);
    }
}

/* --- as a light --- */

/* A scene of a sphere, off the middle, in the given environment; e NULL: constant. */
static scene *lit_scene_create(test_run *r, environment *e, rgb radiance)
{
    static const char *const TEXT =
        "WorldBegin Translate 5 6 7 Material \"diffuse\" Shape \"sphere\" \"float radius\" [2]";
    scene *s = scene_create();
    assert_non_null(s);
    assert_int_equal(pbrt_parse_text(&r->run, "scene", TEXT, strlen(TEXT), s), AG_OK);
    light l = light_make(LIGHT_INFINITE);
    l.as.infinite.radiance.value = radiance;
    l.as.infinite.radiance.picture = e;
    l.as.infinite.radiance.world_from_light = frame_from_z(vec3_normalize(vec3_make(1.0f, -2.0f, 0.5f)));
    l.as.infinite.radiance.world_from_light.y =
        vec3_negate(l.as.infinite.radiance.world_from_light.y); /* a reflection too */
    uint32_t index;
    assert_int_equal(scene_add_light(s, &l, &index), AG_OK);
    assert_int_equal(scene_commit(s, &r->run, NULL), AG_OK);
    assert_int_equal(s->infinite_light_count, 1);
    return s;
}

static double density(void *user, vec3 d) { return light_escaped_pdf(user, (vec3){0.0f, 0.0f, 0.0f}, d); }
static double density_of_photons(void *user, vec3 d)
{
    return light_escaped_pdf(user, (vec3){0.0f, 0.0f, 0.0f}, vec3_negate(d));
}

static environment *environment_for(int k)
{
    return k < SIZE_COUNT ? noise_create(SIZES[k].mapping, SIZES[k].width, SIZES[k].height, 5) : NULL;
}

static void directions_are_sampled_by_their_density(void **state)
{
    (void)state;
    for (int k = 0; k <= SIZE_COUNT; k++) {
        test_run r;
        test_run_init(&r, 1);
        scene *s = lit_scene_create(&r, environment_for(k), rgb_make(2.0f, 1.0f, 0.5f));
        const light *l = &s->lights[0];
        static uint32_t counts[BIN_COUNT];
        static double bins[BIN_COUNT];
        memset(counts, 0, sizeof counts);
        rng random = test_random(6);
        int strangers = 0;
        double integral[3] = {0.0, 0.0, 0.0}, square = 0.0;
        for (int i = 0; i < SAMPLES; i++) {
            light_sample at;
            vec3 point = vec3_make(rng_float(&random), 0.0f, 0.0f);
            assert_true(light_sample_from_point(s, l, point, rng_vec2(&random), &at));
            assert_false(at.is_delta);
            assert_true(isinf(at.distance));
            assert_close(vec3_length(at.direction), 1.0, 1e-6);
            rgb seen = light_escaped_radiance(l, point, at.direction);
            /* what is sampled is what is seen, but for rounding at the borders of pixels */
            strangers += light_escaped_pdf(l, point, at.direction) != at.pdf_solid_angle ||
                         memcmp(&seen, &at.radiance, sizeof seen);
            double inverse = 1.0 / (double)at.pdf_solid_angle / SAMPLES;
            integral[0] += (double)at.radiance.r * inverse, integral[1] += (double)at.radiance.g * inverse;
            integral[2] += (double)at.radiance.b * inverse;
            square += pow((double)at.radiance.g * inverse * SAMPLES, 2) / SAMPLES;
            counts[direction_bin(at.direction)]++;
        }
        assert_true(strangers <= SAMPLES / 1000);
        double whole = integrate_bins(density, (void *)l, 24, bins);
        assert_close(whole, 1.0, 0.004);
        /* borders of pixels run through bins */
        assert_chi_square(counts, bins, SAMPLES, 0.03);
        rgb expected = environment_integral(&l->as.infinite.radiance);
        double tolerance = 5.0 * sqrt(fmax(0.0, square - integral[1] * integral[1]) / SAMPLES) + 1e-5 * expected.g;
        assert_close(integral[1], expected.g, tolerance);
        assert_relative(integral[0], expected.r, 0.02);
        assert_relative(integral[2], expected.b, 0.04);
        scene_destroy(s);
        test_run_reset(&r);
    }
}

/* The integral of a picture is the sum of its pixels times their solid angles, here by directions that are even. */
static void power_is_what_enters_the_bounding_sphere(void **state)
{
    (void)state;
    for (int k = 0; k <= SIZE_COUNT; k++) {
        test_run r;
        test_run_init(&r, 1);
        scene *s = lit_scene_create(&r, environment_for(k), rgb_make(2.0f, 1.0f, 0.5f));
        const light *l = &s->lights[0];
        double sum = 0.0;
        enum { STEPS = 600 };
        for (int i = 0; i < STEPS * STEPS; i++)
            sum += (double)environment_whole_radiance(
                       &l->as.infinite.radiance, sample_uniform_sphere((vec2){((float)(i / STEPS) + 0.5f) / STEPS,
                                                                              ((float)(i % STEPS) + 0.5f) / STEPS}))
                       .r;
        double integral = sum * 4.0 * PI / (STEPS * STEPS), radius = s->bounding_radius;
        assert_relative(radius, 2.0 * sqrt(3.0), 1e-4);
        assert_relative(environment_integral(&l->as.infinite.radiance).r, integral, 0.01);
        assert_relative(l->power.r, PI * radius * radius * integral, 0.01);
        assert_relative(s->light_power.r, l->power.r, 1e-6);
        scene_destroy(s);
        test_run_reset(&r);
    }
}

/* How much of a photon's flux, per area, crosses a ball: its fluence is the integral of radiance, wherever it is. */
static double fluence_in(const light_emission *e, vec3 center, double radius)
{
    vec3 off = vec3_sub(center, e->origin);
    double along = vec3_dot(off, e->direction), square = (double)vec3_length_squared(off) - along * along;
    return along > 0.0 && square < radius * radius ? (double)e->flux.g / (PI * radius * radius) : 0.0;
}

static void photons_fill_the_bounding_sphere_evenly(void **state)
{
    (void)state;
    for (int k = 0; k <= SIZE_COUNT; k++) {
        test_run r;
        test_run_init(&r, 1);
        scene *s = lit_scene_create(&r, environment_for(k), rgb_make(2.0f, 1.0f, 0.5f));
        const light *l = &s->lights[0];
        double R = s->bounding_radius, flux = 0.0, flux_square = 0.0;
        enum { BALLS = 5 };
        vec3 centers[BALLS];
        double sum[BALLS] = {0.0}, square[BALLS] = {0.0};
        rng random = test_random(7);
        for (int b = 0; b < BALLS; b++)
            centers[b] = vec3_add_scaled(s->bounding_center, random_direction(&random), (float)(R * 0.18 * b));
        static uint32_t counts[BIN_COUNT];
        static double bins[BIN_COUNT];
        memset(counts, 0, sizeof counts);
        for (int i = 0; i < SAMPLES; i++) {
            light_emission e;
            assert_true(light_sample_emission(s, l, NULL, &random, &e));
            assert_close(vec3_length(e.direction), 1.0, 1e-6);
            assert_true(vec3_distance_squared(e.origin, s->bounding_center) >= R * R);
            counts[direction_bin(e.direction)]++;
            flux += (double)e.flux.g / SAMPLES, flux_square += (double)e.flux.g * e.flux.g / SAMPLES;
            for (int b = 0; b < BALLS; b++) {
                double f = fluence_in(&e, centers[b], 0.25 * R);
                sum[b] += f / SAMPLES, square[b] += f * f / SAMPLES;
            }
        }
        assert_close(flux, l->power.g, 5.0 * sqrt(fmax(0.0, flux_square - flux * flux) / SAMPLES) + 1e-5 * l->power.g);
        for (int b = 0; b < BALLS; b++)
            assert_close(sum[b], environment_integral(&l->as.infinite.radiance).g,
                         5.0 * sqrt((square[b] - sum[b] * sum[b]) / SAMPLES));
        integrate_bins(density_of_photons, (void *)l, 24, bins);
        assert_chi_square(counts, bins, SAMPLES, 0.03);
        scene_destroy(s);
        test_run_reset(&r);
    }
}

static void a_black_picture_sends_nothing(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    environment *e;
    assert_int_equal(environment_create(ENVIRONMENT_OCTAHEDRAL, 4, 4, calloc(16, sizeof(rgb)), &e), AG_OK);
    scene *s = lit_scene_create(&r, e, rgb_gray(1.0f));
    rng random = test_random(8);
    light_sample at;
    light_emission start;
    assert_false(light_sample_from_point(s, &s->lights[0], vec3_make(0.0f, 0.0f, 0.0f), (vec2){0.5f, 0.5f}, &at));
    assert_false(light_sample_emission(s, &s->lights[0], NULL, &random, &start));
    assert_true(light_escaped_pdf(&s->lights[0], vec3_make(0.0f, 0.0f, 0.0f), vec3_make(0.0f, 0.0f, 1.0f)) == 0.0f);
    assert_true(rgb_is_black(s->light_power));
    scene_destroy(s);
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cells_are_picked_by_weight),
        cmocka_unit_test(cells_are_those_that_a_walk_over_all_finds),
        cmocka_unit_test(directions_are_those_of_pbrt),
        cmocka_unit_test(points_and_directions_round_trip),
        cmocka_unit_test(pixels_have_their_solid_angles),
        cmocka_unit_test(large_pictures_are_sharp),
        cmocka_unit_test(directions_are_sampled_by_their_density),
        cmocka_unit_test(power_is_what_enters_the_bounding_sphere),
        cmocka_unit_test(photons_fill_the_bounding_sphere_evenly),
        cmocka_unit_test(a_black_picture_sends_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
