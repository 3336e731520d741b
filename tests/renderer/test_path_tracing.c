/* test_path_tracing.c: radiance by path tracing in closed furnaces, whatever the number of scatterings, and which part
 * of the light is which. Threads: one. */
#include "fixtures/eye_fixture.h"

#include "integrator/path_tracing.h"

enum { SAMPLES = 20000 / FEWER, BOUNDS = 5 };

/* A closed sphere that emits 1 and reflects 0.5: after n scatterings at most sum of 0.5^i, 2 in all. */
#define FURNACE                                                                                                        \
    "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]"             \
    " ReverseOrientation Shape \"sphere\" \"float radius\" 1"

static eye_sample sample_of(eye *e, uint32_t i, sample_layers *layers)
{
    eye_sample s = {.most_direct = INFINITY, .most_indirect = INFINITY, .layers = layers};
    camera_sample from = {.ray = scene_ray_make((vec3){0.3f, 0.2f, 0.1f}, (vec3){0.0f, 0.6f, 0.8f}),
                          .where = sampler_make(i, 3, 4, 0, 0)};
    path_tracing_radiance(&e->t, e->worker, &from, &s);
    return s;
}

static void furnace(void **state)
{
    (void)state;
    static const int MOST[BOUNDS] = {0, 1, 2, 5, 100};
    static const double RADIANCE[BOUNDS] = {1.0, 1.5, 1.75, 1.96875, 2.0};
    eye e;
    eye_init(&e, FURNACE);
    for (int k = 0; k < BOUNDS; k++) {
        e.settings.max_depth = MOST[k];
        mean_sum sum = {0};
        for (uint32_t i = 0; i < SAMPLES; i++)
            mean_add(&sum, (double)sample_of(&e, i, NULL).radiance.r);
        assert_mean(&sum, RADIANCE[k], 1e-4);
    }
    eye_reset(&e);
}

/* Emission 1, direct light 0.5, indirect light the rest; the parts add up to the radiance. */
static void parts(void **state)
{
    (void)state;
    eye e;
    eye_init(&e, FURNACE);
    e.settings.max_depth = 100;
    mean_sum sums[LIGHT_PART_COUNT] = {{0}};
    static const double PARTS[LIGHT_PART_COUNT] = {[PART_EMISSION] = 1.0, [PART_DIRECT] = 0.5, [PART_INDIRECT] = 0.5};
    for (uint32_t i = 0; i < SAMPLES; i++) {
        sample_layers layers = {0};
        eye_sample s = sample_of(&e, i, &layers);
        rgb all = rgb_gray(0.0f);
        for (int k = 0; k < LIGHT_PART_COUNT; k++) {
            mean_add(&sums[k], (double)layers.parts[k].r);
            all = rgb_add(all, layers.parts[k]);
        }
        assert_relative((double)all.r, (double)s.radiance.r, 1e-5);
    }
    for (int k = 0; k < LIGHT_PART_COUNT; k++)
        assert_mean(&sums[k], PARTS[k], 1e-4);
    eye_reset(&e);
}

/* Indirect light alone: neither what is seen nor what falls straight on it. */
static void only_indirect(void **state)
{
    (void)state;
    eye e;
    eye_init(&e, FURNACE);
    e.settings.max_depth = 100;
    e.settings.only = AG_ONLY_INDIRECT;
    mean_sum sum = {0};
    for (uint32_t i = 0; i < SAMPLES; i++)
        mean_add(&sum, (double)sample_of(&e, i, NULL).radiance.r);
    assert_mean(&sum, 0.5, 1e-4);
    eye_reset(&e);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(furnace), cmocka_unit_test(parts),
                                       cmocka_unit_test(only_indirect)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
