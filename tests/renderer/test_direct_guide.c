/* test_direct_guide.c: what guides shadow rays: the numbers by which the sky is sampled follow its histogram, with a
 * density that is the one asked for and sums to 1; lights are picked as often as they say; and what was not seen keeps
 * its share. Threads: one. */
#include "integrator/direct_guide.h"

#include "fixtures/test_scene.h"
#include "light/environment.h"

enum { SAMPLES = 400000 / FEWER, POINTS = 500, PARTS = 8 };

#define LIGHTS                                                                                                         \
    "LightSource \"distant\" \"rgb L\" [3 3 3] LightSource \"infinite\" \"rgb L\" [1 1 1]"                             \
    " LightSource \"point\" \"rgb I\" [1 1 1] Shape \"sphere\""

static const float SHARE = 0.8f;

static direct_guide guide_of(const scene *s, direct_bins *seen)
{
    rng random = test_random(1);
    vec3 positions[POINTS], normals[POINTS];
    uint32_t order[POINTS];
    for (int i = 0; i < POINTS; i++) {
        positions[i] = random_in_box(&random, (vec3){-1.0f, -1.0f, -1.0f}, (vec3){1.0f, 1.0f, 1.0f});
        normals[i] = (vec3){0.0f, 0.0f, i % 2 ? 1.0f : -1.0f};
    }
    direct_guide g;
    assert_true(direct_guide_serves(s));
    assert_int_equal(direct_guide_create(s, positions, normals, POINTS, order, &g), AG_OK);
    assert_true(g.cell_count > POINTS / DIRECT_GUIDE_CELL_POINTS && g.share_count == 3 && g.histogram_count == 1);
    uint32_t placed = 0;
    for (uint32_t i = 0; i < g.cell_count; i++) {
        float way = normals[order[g.cells[i].begin]].z;
        for (uint32_t k = 0; k < g.cells[i].count; k++, placed++) {
            uint32_t point = order[g.cells[i].begin + k];
            assert_true(normals[point].z == way);
        }
        assert_true(g.cells[i].count >= DIRECT_GUIDE_CELL_POINTS_MIN && g.cells[i].count <= DIRECT_GUIDE_CELL_POINTS);
    }
    assert_int_equal(placed, POINTS);
    assert_int_equal(direct_guide_find(&g, positions[0], normals[0]), DIRECT_GUIDE_NO_CELL); /* nothing is seen yet */

    /* a window, a dim part, and nothing else */
    const float brought[3] = {0.5f, 2.0f, 1.5f};
    *seen = (direct_bins){0};
    for (int y = 0; y < 12; y++)
        for (int x = 0; x < DIRECT_GUIDE_SIDE; x++)
            seen->of[y][x] = y > 4 && y < 8 && x > 20 && x < 26 ? 5.0f + (float)x : 0.1f;
    for (uint32_t i = 0; i < g.cell_count; i++)
        direct_guide_fill(&g, i, SHARE, brought, seen);
    for (int i = 0; i < POINTS; i++)
        assert_true(direct_guide_find(&g, positions[i], normals[i]) < g.cell_count);
    assert_int_equal(direct_guide_find(&g, positions[0], (vec3){1.0f, 0.0f, 0.0f}), DIRECT_GUIDE_NO_CELL);
    assert_int_equal(direct_guide_find(NULL, positions[0], normals[0]), DIRECT_GUIDE_NO_CELL);
    return g;
}

static void lights_are_picked_as_they_say(void **state)
{
    (void)state;
    test_run r;
    direct_bins seen;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, LIGHTS);
    direct_guide g = guide_of(s, &seen);
    vec3 point = {0.1f, 0.2f, 1.5f}, normal = {0.0f, 0.0f, 0.0f};
    uint32_t counts[3] = {0};
    rng random = test_random(2);
    float sum = 0.0f, expected[3] = {0.2f / 3 + 0.8f * 0.125f, 0.2f / 3 + 0.8f * 0.5f, 0.2f / 3 + 0.8f * 0.375f};
    for (uint32_t i = 0; i < 3; i++) {
        assert_close(direct_guide_probability(&g, s, 0, i, point, normal), expected[i], 1e-6);
        sum += direct_guide_probability(&g, s, 0, i, point, normal);
    }
    assert_close(sum, 1.0, 1e-6);
    for (int i = 0; i < SAMPLES; i++) {
        float probability;
        uint32_t lamp = direct_guide_pick(&g, s, 0, point, normal, rng_float(&random), &probability);
        assert_true(lamp < 3);
        assert_close(probability, expected[lamp], 1e-6);
        counts[lamp]++;
    }
    for (int i = 0; i < 3; i++)
        assert_close((double)counts[i] / SAMPLES, expected[i], 5.0 * sqrt(0.25 / SAMPLES));
    float probability; /* at the end of the interval */
    assert_true(direct_guide_pick(&g, s, 0, point, normal, 0x1.fffffep-1f, &probability) == 2 && probability > 0.0f);
    direct_guide_reset(&g);
    scene_destroy(s);
    test_run_reset(&r);
}

/* The light's own picture is changed on the way: even, octahedral, latitude and longitude. */
static void expect_density(scene *s, const direct_guide *g, const direct_bins *seen)
{
    light *sky = &s->lights[1];
    double counts[PARTS][PARTS] = {{0}}, masses[PARTS][PARTS] = {{0}}, whole = 0.0, squares = 0.0, seen_sum = 0.0;
    rng random = test_random(3);
    uint32_t elsewhere = 0, taken = 0;
    float least = 1e9f;
    for (int y = 0; y < DIRECT_GUIDE_SIDE; y++)
        for (int x = 0; x < DIRECT_GUIDE_SIDE; x++)
            seen_sum += (double)seen->of[y][x] / (DIRECT_GUIDE_SIDE * DIRECT_GUIDE_SIDE);
    for (int i = 0; i < SAMPLES; i++) {
        vec2 u = rng_vec2(&random), even = rng_vec2(&random);
        vec3 direction;
        rgb radiance;
        float pdf, density = direct_guide_warp(g, s, 0, 1, &u);
        assert_true(u.x >= 0.0f && u.x < 1.0f && u.y >= 0.0f && u.y < 1.0f && density > 0.0f);
        counts[(int)(u.y * PARTS)][(int)(u.x * PARTS)] += 1.0;
        if (!environment_sample_whole(&sky->as.infinite.radiance, u, &direction, &radiance, &pdf))
            continue;
        taken++;
        float again = direct_guide_density(g, s, 0, 1, direction);
        elsewhere += fabsf(again / density - 1.0f) > 1e-5f; /* rounded into the next bin */

        /* over even numbers the density's mean is 1 */
        if (environment_sample_whole(&sky->as.infinite.radiance, even, &direction, &radiance, &pdf)) {
            float there = direct_guide_density(g, s, 0, 1, direction);
            masses[(int)(even.y * PARTS)][(int)(even.x * PARTS)] += (double)there;
            whole += (double)there / SAMPLES;
            squares += (double)there * (double)there;
            least = fminf(least, there);
            double learned = (double)seen->of[(int)(even.y * 32.0f)][(int)(even.x * 32.0f)] / seen_sum;
            double floor_of = (0.2 / 3.0) / (0.2 / 3.0 + 0.4);
            assert_true(fabs((double)there / (floor_of + (1.0 - floor_of) * learned) - 1.0) < 0.1 ||
                        fabs(even.x * 32.0f - roundf(even.x * 32.0f)) < 1e-3f ||
                        fabs(even.y * 32.0f - roundf(even.y * 32.0f)) < 1e-3f);
        }
    }
    assert_int_equal(taken, SAMPLES);
    assert_true(elsewhere < SAMPLES / 2000 + 3);
    double sigma = sqrt((squares / SAMPLES - whole * whole) / SAMPLES);
    assert_close(whole, 1.0, 4.0 * sigma);
    assert_true(sigma < 0.02 * WIDER);
    assert_true(least > 0.95f * (0.2f / 3.0f) / (0.2f / 3.0f + 0.4f));
    double chi_square = 0.0;
    for (int y = 0; y < PARTS; y++)
        for (int x = 0; x < PARTS; x++) {
            double variance = counts[y][x] + 12.0 * masses[y][x] + 1.0; /* the masses are of samples, too */
            chi_square += (counts[y][x] - masses[y][x]) * (counts[y][x] - masses[y][x]) / variance;
        }
    print_message("chi-square %.1f of %d parts\n", chi_square, PARTS * PARTS);
    assert_true(chi_square < 2.0 * PARTS * PARTS);
}

static void sky_is_sampled_by_its_density(void **state)
{
    (void)state;
    test_run r;
    direct_bins seen;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, LIGHTS);
    direct_guide g = guide_of(s, &seen);
    expect_density(s, &g, &seen);
    static const struct {
        environment_mapping mapping;
        uint32_t width, height;
    } PICTURES[] = {{ENVIRONMENT_OCTAHEDRAL, 16, 16}, {ENVIRONMENT_LATITUDE_LONGITUDE, 24, 12}};
    for (int k = 0; k < 2; k++) {
        uint32_t count = PICTURES[k].width * PICTURES[k].height;
        rgb *pixels = malloc(count * sizeof *pixels);
        rng random = test_random(4);
        assert_non_null(pixels);
        for (uint32_t i = 0; i < count; i++)
            pixels[i] = rgb_gray(0.1f + rng_float(&random));
        assert_int_equal(environment_create(PICTURES[k].mapping, PICTURES[k].width, PICTURES[k].height, pixels,
                                            &s->lights[1].as.infinite.radiance.picture),
                         AG_OK);
        s->lights[1].as.infinite.radiance.world_from_light = frame_from_z(vec3_normalize((vec3){1.0f, 2.0f, 3.0f}));
        expect_density(s, &g, &seen);
        environment_destroy(s->lights[1].as.infinite.radiance.picture);
        s->lights[1].as.infinite.radiance.picture = NULL;
    }
    direct_guide_reset(&g);
    scene_destroy(s);
    test_run_reset(&r);
}

static void some_scenes_have_no_choice(void **state)
{
    (void)state;
    static const struct {
        const char *world;
        bool serves;
    } KNOWN[] = {{"LightSource \"point\" \"rgb I\" [1 1 1]", false},
                 {"LightSource \"distant\" \"rgb L\" [1 1 1]", false},
                 {"LightSource \"infinite\" \"rgb L\" [1 1 1]", true},
                 {"LightSource \"distant\" \"rgb L\" [1 1 1] LightSource \"point\" \"rgb I\" [1 1 1]", true}};
    for (size_t i = 0; i < sizeof KNOWN / sizeof *KNOWN; i++) {
        test_run r;
        test_run_init(&r, 1);
        scene *s = test_scene_create(&r, KNOWN[i].world);
        assert_int_equal(direct_guide_serves(s), KNOWN[i].serves);
        scene_destroy(s);
        test_run_reset(&r);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lights_are_picked_as_they_say),
        cmocka_unit_test(sky_is_sampled_by_its_density),
        cmocka_unit_test(some_scenes_have_no_choice),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
