/* test_emission_guide.c: a guide's density is a density, it is the one by which starts are drawn, no weight exceeds
 * five, and a small useful part is found. Threads: one. */
#include "emission_guide.h"

#include "fixtures/test_scene.h"

enum { TRIALS = 60000, DRAWS = 400000 };

/* Useful: a slanted slab in four of the numbers, a tenth wide in each of three ways. About one start in 300. */
static float slab(const emission_start *s)
{
    return s->u[0] < 0.3f && fabsf(s->u[1] - s->u[3]) < 0.05f && fabsf(s->u[2] - s->u[4]) < 0.05f ? 1.0f + s->u[5]
                                                                                                  : 0.0f;
}

static float whole(const emission_start *s)
{
    (void)s;
    return 1.0f;
}

/* The last number's corner, next to 1. */
static float corner(const emission_start *s) { return s->u[4] > 0.97f && s->u[5] > 0.97f ? 1.0f : 0.0f; }

static emission_guide learn_beside(float (*value)(const emission_start *), uint32_t count, int rounds,
                                   const emission_guide *other)
{
    emission_trial *trials = malloc((size_t)rounds * count * sizeof *trials);
    emission_guide guides[4] = {{0}};
    assert_non_null(trials);
    rng random = test_random(3);
    for (int k = 0; k < rounds; k++) {
        for (uint32_t i = 0; i < count; i++) {
            float density;
            emission_start start = emission_guide_sample(&guides[k], &random, &density);
            trials[(uint32_t)k * count + i] = (emission_trial){start, value(&start), density};
        }
        uint32_t all = (uint32_t)(k + 1) * count;
        for (uint32_t i = 0; i < all; i++) {
            float sum = 0.0f;
            for (int r = 0; r <= k; r++)
                sum += emission_guide_density(&guides[r], &trials[i].start);
            trials[i].density = sum / (float)(k + 1);
        }
        assert_int_equal(emission_guide_create(trials, all, 0.8f, other, &guides[k + 1]), AG_OK);
    }
    for (int k = 0; k < rounds; k++)
        emission_guide_reset(&guides[k]);
    free(trials);
    return guides[rounds];
}

static emission_guide learn(float (*value)(const emission_start *), uint32_t count, int rounds)
{
    return learn_beside(value, count, rounds, NULL);
}

/* Weights of guided draws have the mean 1, and the value has the mean of plain draws within 4 sigma. */
static void expect_right_guide(const emission_guide *guide, float (*value)(const emission_start *), double least_useful)
{
    rng random = test_random(4);
    int draws = DRAWS / FEWER;
    double weights = 0.0, weights_squared = 0.0, plain = 0.0, plain_squared = 0.0, guided = 0.0, guided_squared = 0.0;
    double densities = 0.0, densities_squared = 0.0, useful = 0.0;
    for (int i = 0; i < draws; i++) {
        float density;
        emission_start s = emission_guide_sample(guide, &random, &density);
        for (int a = 0; a < EMISSION_DIMENSIONS; a++)
            assert_true(s.u[a] >= 0.0f && s.u[a] < 1.0f);
        assert_true(density >= 0.1999999f);
        assert_true(density == emission_guide_density(guide, &s));
        double weight = 1.0 / (double)density, brought = (double)value(&s) * weight;
        weights += weight / draws, weights_squared += weight * weight / draws;
        guided += brought / draws, guided_squared += brought * brought / draws;
        useful += value(&s) > 0.0f ? 1.0 / draws : 0.0;
        s = emission_start_draw(&random);
        double at = (double)emission_guide_density(guide, &s);
        densities += at / draws, densities_squared += at * at / draws;
        plain += (double)value(&s) / draws, plain_squared += (double)value(&s) * (double)value(&s) / draws;
    }
    double of_weights = sqrt(fmax(0.0, weights_squared - weights * weights) / draws);
    double of_densities = sqrt(fmax(0.0, densities_squared - densities * densities) / draws);
    double variance = guided_squared - guided * guided, plain_variance = plain_squared - plain * plain;
    assert_close(weights, 1.0, 4.0 * of_weights + 1e-5);
    assert_close(densities, 1.0, 4.0 * of_densities + 1e-5);
    assert_close(guided, plain, 4.0 * sqrt((variance + plain_variance) / draws) + 1e-5 * plain);
    print_message("useful %.4f, variance %.4g, plain %.4g, expected gain %.3g\n", useful, variance, plain_variance,
                  (double)guide->gain);
    assert_true(useful >= least_useful);
}

static void expect_right(float (*value)(const emission_start *), int rounds, double least_useful)
{
    emission_guide guide = learn(value, TRIALS, rounds);
    expect_right_guide(&guide, value, least_useful);
    emission_guide_reset(&guide);
}

static void a_slanted_slab_is_found(void **state)
{
    (void)state;
    expect_right(slab, 1, 0.01 / WIDER);
    expect_right(slab, 3, 0.04 / WIDER); /* of starts by power alone 0.003 are useful */
}

static void a_corner_is_found(void **state)
{
    (void)state;
    expect_right(corner, 2, 0.4 / WIDER); /* 0.0009 */
}

static float slab_or_corner(const emission_start *s) { return fmaxf(slab(s), corner(s)); }

/* A guide of one part, with another one beside it that knows the other part, finds both. */
static void a_guide_may_have_another_one_beside_it(void **state)
{
    (void)state;
    emission_guide of_corner = learn(corner, TRIALS, 2), both = learn_beside(slab, TRIALS, 3, &of_corner);
    assert_ptr_equal(both.other, &of_corner);
    expect_right_guide(&both, slab_or_corner, 0.2 / WIDER);
    emission_guide_reset(&both);
    emission_guide_reset(&of_corner);
}

static void where_all_is_alike_there_is_no_gain(void **state)
{
    (void)state;
    expect_right(whole, 1, 1.0);
    emission_guide guide = learn(whole, TRIALS, 1);
    assert_close((double)guide.gain, 1.0, 0.1);
    emission_guide_reset(&guide);
}

static float nothing(const emission_start *s)
{
    (void)s;
    return 0.0f;
}

static void without_use_there_is_no_guide(void **state)
{
    (void)state;
    emission_guide guide = learn(nothing, 1000, 2);
    assert_null(guide.nodes);
    rng random = test_random(5);
    float density;
    emission_start s = emission_guide_sample(&guide, &random, &density);
    assert_true(density == 1.0f && emission_guide_density(&guide, &s) == 1.0f);
    emission_guide_reset(&guide);
    assert_int_equal(emission_guide_create(NULL, 0, 0.8f, NULL, &guide), AG_OK);
    assert_null(guide.nodes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_slanted_slab_is_found),
        cmocka_unit_test(a_corner_is_found),
        cmocka_unit_test(a_guide_may_have_another_one_beside_it),
        cmocka_unit_test(where_all_is_alike_there_is_no_gain),
        cmocka_unit_test(without_use_there_is_no_guide),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
