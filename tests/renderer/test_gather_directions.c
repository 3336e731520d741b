/* test_gather_directions.c: many directions at once are, to the bit, those made one by one, with any instructions.
 * Threads: one. */
#include "integrator/gather_directions.h"

#include "fixtures/test_scene.h"

/* One direction, as bsdf_sample_direction makes it. */
static vec3 direction_alone(sampler_sequence *sequence, uint32_t i, const frame *around, bool is_below)
{
    vec3 local = sample_cosine_hemisphere(sampler_sequence_at(sequence, i));
    return frame_to_world(around, (vec3){local.x, local.y, is_below ? -local.z : local.z});
}

static void expect_the_same(const sampler_sequence *sequence, uint32_t first, uint32_t count, vec3 z, bool is_below)
{
    frame around = frame_from_z(z);
    sampler_sequence alone = *sequence, together = *sequence, plainly = *sequence;
    float best[3][RAY_FAN_MAX], plain[3][RAY_FAN_MAX];
    float u[2][RAY_FAN_MAX];
    gather_numbers(&together, first, count, u);
    gather_directions(u, count, &around, is_below, best);
    gather_numbers_plain(&plainly, first, count, u);
    gather_directions_plain(u, count, &around, is_below, plain);
    for (uint32_t i = 0; i < count; i++) {
        vec3 d = direction_alone(&alone, first + i, &around, is_below);
        const float expected[3] = {d.x, d.y, d.z};
        assert_close(vec3_length(d), 1.0, 1e-6);
        assert_int_equal(vec3_dot(d, z) < 0.0f, is_below);
        for (int a = 0; a < 3; a++) {
            assert_memory_equal(&best[a][i], &expected[a], sizeof(float));
            assert_memory_equal(&plain[a][i], &expected[a], sizeof(float));
        }
    }
}

static void many_are_those_made_one_by_one(void **state)
{
    (void)state;
    rng random = test_random(1);
    for (uint32_t round = 0; round < 2000 / FEWER; round++) {
        sampler where = sampler_make(round, (int)(rng_next(&random) % 5000), (int)round, round % 8, 3);
        sampler_sequence sequence = sampler_sequence_make(&where, SAMPLE_GATHER, (int)(round % 3), 256);
        expect_the_same(&sequence, (uint32_t)(rng_next(&random) % 192), 1 + round % RAY_FAN_MAX,
                        random_direction(&random), round % 2 == 1);
    }
}

/* The index of a number is of 64 bits, and beyond 32 the scrambles are others. */
static void the_index_may_grow_beyond_32_bits(void **state)
{
    (void)state;
    sampler where = sampler_make(7, 255, 255, 5, 8);
    sampler_sequence sequence = sampler_sequence_make(&where, SAMPLE_GATHER, 0, 1u << 20);
    assert_true(sequence.first >> 32 > 0);
    uint32_t before = (uint32_t)((((sequence.first >> 32) + 1) << 32) - sequence.first);
    for (uint32_t k = 0; k < 8; k++)
        expect_the_same(&sequence, before - 9 * k, RAY_FAN_MAX, (vec3){0.0f, 0.6f, 0.8f}, false);
}

/* Rays are distributed by the cosine: its mean is 2/3, the mean of its square 1/2, and no direction about the axis is
 * preferred. */
static void they_are_spread_by_the_cosine(void **state)
{
    (void)state;
    sampler where = sampler_make(1, 3, 4, 0, 0);
    sampler_sequence sequence = sampler_sequence_make(&where, SAMPLE_GATHER, 0, 1 << 12);
    vec3 z = vec3_normalize((vec3){1.0f, -2.0f, 3.0f});
    frame around = frame_from_z(z);
    double cosines = 0.0, squares = 0.0, x = 0.0, y = 0.0;
    float d[3][RAY_FAN_MAX];
    for (uint32_t first = 0; first < 1 << 12; first += RAY_FAN_MAX) {
        float u[2][RAY_FAN_MAX];
        gather_numbers(&sequence, first, RAY_FAN_MAX, u);
        gather_directions(u, RAY_FAN_MAX, &around, false, d);
        for (uint32_t i = 0; i < RAY_FAN_MAX; i++) {
            vec3 local = frame_to_local(&around, (vec3){d[0][i], d[1][i], d[2][i]});
            cosines += (double)local.z, squares += (double)local.z * (double)local.z;
            x += (double)local.x, y += (double)local.y;
        }
    }
    assert_close(cosines / (1 << 12), 2.0 / 3.0, 1e-4);
    assert_close(squares / (1 << 12), 0.5, 1e-4);
    assert_close(x / (1 << 12), 0.0, 1e-3);
    assert_close(y / (1 << 12), 0.0, 1e-3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(many_are_those_made_one_by_one),
        cmocka_unit_test(the_index_may_grow_beyond_32_bits),
        cmocka_unit_test(they_are_spread_by_the_cosine),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
