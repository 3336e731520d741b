/* test_gather_batch.c: what gather rays over a hemisphere of known radiance come to: their mean and its variance in
 * closed form, the same bits whenever the batch is resolved, bounds, rays with two ends, and queries without an answer.
 * Threads: one. */
#include "fixtures/test_scene.h"

#include "integrator/gather_batch.h"

enum { RAYS = 4096 };

static gather_batch *batch_create(float most_indirect)
{
    gather_batch *b = gather_batch_create(most_indirect);
    assert_non_null(b);
    return b;
}

static gather_end end_of(uint32_t number)
{
    return (gather_end){{{(float)number, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f}, 1e-3f}, 7, 5};
}

/* Irradiance of pi cos at the end of each ray, by its direction's cosine: radiance of cos, weighed by 1 / pi. */
static float cosine_of(uint32_t number)
{
    rng random = test_random(number);
    return sample_cosine_hemisphere(rng_vec2(&random)).z;
}

static void answer(gather_batch *b)
{
    for (uint32_t i = 0; i < b->query_count; i++) {
        b->irradiance[i] = rgb_gray(AG_PI * cosine_of(b->rests[i].number));
        b->holds[i] = true;
    }
}

static void ask(gather_batch *b, uint32_t number)
{
    gather_end end = end_of(number);
    gather_batch_ask(b, &end, number, rgb_gray(AG_INV_PI), 0.0f);
}

/* For directions drawn by the cosine, cos has the mean 2/3 and cos^2 1/2, so the variance of a ray is 1/18. */
static void mean_over_a_hemisphere(void **state)
{
    (void)state;
    gather_batch *b = batch_create(INFINITY);
    for (int is_first = 0; is_first < 2; is_first++) {
        gather_batch_begin(b, 3, is_first, rgb_gray(0.25f / RAYS), 1.0f, RAYS, 0);
        for (uint32_t i = 0; i < RAYS; i++)
            ask(b, i);
        gather_batch_end(b, rgb_gray(0.0f));
        answer(b);
        gather_batch_sum(b);
        assert_int_equal(b->query_count, 0);
        assert_int_equal(b->gather_count, 0);
        double variance = 0.25 * 0.25 / 18.0 / RAYS;
        gathered_light *g = &b->gathered[3];
        assert_close((double)(is_first ? g->first : g->behind).g, 0.25 * 2.0 / 3.0, 4.0 * sqrt(variance));
        assert_true(rgb_is_black(is_first ? g->behind : g->first));
        /* of cos about its mean the fourth moment is 1/135: that of the variance follows */
        assert_relative((double)g->variance, variance, 4.0 * sqrt((18.0 * 18.0 / 135.0 - 1.0) / RAYS));
        *g = (gathered_light){0};
    }
    gather_batch_destroy(b);
    gather_batch_destroy(NULL);
}

/* Rays that end at two sides of a cloth are no more rays: light and variance are those of rays with one end that brings
 * the sum. */
static void two_ends_are_of_one_ray(void **state)
{
    (void)state;
    gather_batch *b = batch_create(INFINITY);
    for (uint32_t sample = 0; sample < 2; sample++) {
        gather_batch_begin(b, sample, true, rgb_gray(1.0f / RAYS), 1.0f, RAYS, 0);
        for (uint32_t i = 0; i < RAYS; i++) {
            gather_ends ends = {.count = sample == 0 ? 1 : 2, .end = {end_of(i), end_of(i)}};
            ends.weight[0] = rgb_gray(sample == 0 ? 1.0f : 0.25f);
            ends.weight[1] = rgb_gray(0.75f);
            gather_batch_ask_all(b, &ends, i, 0.5f);
        }
        gather_batch_end(b, rgb_gray(0.5f * RAYS));
    }
    assert_int_equal(b->query_count, 3 * RAYS);
    answer(b);
    gather_batch_sum(b);
    const gathered_light *one = &b->gathered[0], *two = &b->gathered[1];
    assert_true(one->variance > 0.0f);
    assert_relative((double)two->first.g, (double)one->first.g, 1e-5);
    assert_relative((double)two->variance, (double)one->variance, 1e-3);
    gather_batch_destroy(b);
}

/* One of two ends, by its weight: on average both count in full. Ends of no weight stay so. */
static void one_end_of_two(void **state)
{
    (void)state;
    enum { PICKS = 1000 };
    double sums[2] = {0.0};
    for (int i = 0; i < PICKS; i++) {
        gather_ends ends = {.count = 2, .weight = {{0.3f, 0.1f, 0.2f}, {0.1f, 0.1f, 0.05f}}};
        ends.end[1].medium = 1;
        gather_ends_pick(&ends, ((float)i + 0.5f) / PICKS);
        assert_int_equal(ends.count, 1);
        sums[ends.end[0].medium] += (double)ends.weight[0].b / PICKS;
    }
    assert_close(sums[0], 0.2, 1e-3);
    assert_close(sums[1], 0.05, 1e-3);
    gather_ends black = {.count = 2};
    gather_ends_pick(&black, 0.5f);
    assert_true(black.count == 1 && rgb_is_black(black.weight[0]));
    gather_ends single = {.count = 1, .weight = {{1.0f, 2.0f, 3.0f}}};
    gather_ends_pick(&single, 0.99f);
    assert_true(single.count == 1 && single.weight[0].g == 2.0f);
}

/* The light of one gather among others, where the batch is resolved after this many of its rays. Every eighth ray
 * brings light of its own alone, and every eighth has two ends. */
static gathered_light resolved_after(uint32_t rays)
{
    gather_batch *b = batch_create(INFINITY);
    float known = 0.0f;
    for (uint32_t sample = 0; sample < 3; sample++) {
        gather_batch_begin(b, sample, true, rgb_gray(0.25f / RAYS), 1.0f, RAYS, sample);
        for (uint32_t i = 0; i < RAYS / 4; i++) {
            if (sample == 1 && i == rays) {
                answer(b);
                gather_batch_sum(b);
                assert_int_equal(b->gather_count, 1);
            }
            if (i % 8 == 7) {
                known += cosine_of(i);
                gather_batch_note(b, cosine_of(i));
            } else if (i % 8 == 3) {
                gather_ends ends = {.count = 2, .end = {end_of(i), end_of(i)}};
                ends.weight[0] = ends.weight[1] = rgb_gray(0.5f);
                gather_batch_ask_all(b, &ends, i, 0.0f);
            } else {
                ask(b, i);
            }
        }
        gather_batch_end(b, rgb_gray(known));
        known = 0.0f;
    }
    answer(b);
    gather_batch_sum(b);
    gathered_light g = b->gathered[1];
    assert_memory_equal(&g, &b->gathered[2], sizeof g);
    gather_batch_destroy(b);
    return g;
}

static void same_bits_whenever_it_is_resolved(void **state)
{
    (void)state;
    gathered_light whole = resolved_after(RAYS);
    static const uint32_t PARTS[] = {0, 1, 100, RAYS / 4 - 1};
    for (size_t i = 0; i < sizeof PARTS / sizeof *PARTS; i++) {
        gathered_light parts = resolved_after(PARTS[i]);
        assert_memory_equal(&parts, &whole, sizeof whole);
    }
}

/* A gather brings no more than its share of the bound, and keeps its colour. */
static void bounded(void **state)
{
    (void)state;
    gather_batch *b = batch_create(2.0f);
    gather_batch_begin(b, 0, true, (rgb){1.0f, 0.5f, 0.25f}, 0.5f, 1, 0);
    ask(b, 0);
    gather_batch_end(b, rgb_gray(10.0f));
    answer(b);
    gather_batch_sum(b);
    assert_relative((double)b->gathered[0].first.r, 1.0, 1e-6);
    assert_relative((double)b->gathered[0].first.b, 0.25, 1e-6);
    gather_batch_reset(b);
    assert_true(rgb_is_black(b->gathered[0].first));
    gather_batch_destroy(b);
}

/* Queries without an answer become detours in their order, in several parts where they are many, each with the weight
 * of its query and the key of its gather; what they find is what the query brings. */
static void detours(void **state)
{
    (void)state;
    enum { GATHERS = 50, EACH = 2 * GATHER_BATCH_DETOURS / GATHERS };
    gather_batch *b = batch_create(INFINITY);
    for (uint32_t g = 0; g < GATHERS; g++) {
        gather_batch_begin(b, g, true, rgb_gray(0.5f), 1.0f, EACH, 1000 + g);
        for (uint32_t i = 0; i < EACH; i++)
            ask(b, g * EACH + i);
        if (g < GATHERS - 1) /* the last one is still open */
            gather_batch_end(b, rgb_gray(0.0f));
    }
    answer(b);
    uint32_t lost = 0;
    for (uint32_t i = 0; i < b->query_count; i++)
        if (i % 3 != 0) {
            b->holds[i] = false;
            b->irradiance[i] = rgb_gray(NAN);
            lost++;
        }
    uint32_t next = 0, count, found = 0;
    while ((count = gather_batch_make_detours(b, &next)) > 0) {
        assert_true(count == GATHER_BATCH_DETOURS || next == b->query_count);
        for (uint32_t i = 0; i < count; i++) {
            const gather_detour *d = &b->detours[i];
            assert_int_not_equal(d->query % 3, 0);
            assert_int_equal(d->number, d->query);
            assert_int_equal(d->key, 1000 + d->query / EACH);
            assert_true(d->end.point.position.x == (float)d->query && d->end.medium == 7);
            assert_int_equal(d->end.scatterings_left, 5);
            assert_true(d->weight.r == AG_INV_PI && d->share_seen == 0.5f);
            b->irradiance[d->query] = rgb_add(b->irradiance[d->query], rgb_gray(2.0f));
        }
        found += count;
    }
    assert_int_equal(found, lost);
    gather_batch_sum(b);
    assert_int_equal(b->gather_count, 1);
    gather_batch_end(b, rgb_gray(0.0f));
    gather_batch_sum(b);
    for (uint32_t g = 0; g < GATHERS; g++) {
        double expected = 0.0;
        for (uint32_t i = g * EACH; i < (g + 1) * EACH; i++)
            expected += i % 3 == 0 ? (double)cosine_of(i) : 2.0;
        assert_relative((double)b->gathered[g].first.r, 0.5 * expected, 1e-5);
    }
    gather_batch_destroy(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(mean_over_a_hemisphere),
                                       cmocka_unit_test(same_bits_whenever_it_is_resolved),
                                       cmocka_unit_test(bounded),
                                       cmocka_unit_test(two_ends_are_of_one_ray),
                                       cmocka_unit_test(one_end_of_two),
                                       cmocka_unit_test(detours)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
