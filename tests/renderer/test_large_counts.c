/* test_large_counts.c: what a render of a week counts: workers' rays and the cache's requests go on beyond 2^32, reach
 * the statistics and their JSON whole, and calls that edit a scene are counted beyond 2^31. Flow: tests of
 * renderer/rendering_counts.c, output/statistics_json.c, making/scene_memory.c. Threads: one. */
#define _GNU_SOURCE
#include "rendering_counts.h"

#include "fixtures/layers_fixture.h"
#include "fixtures/scene_desk.h"
#include "making/scene_making.h"

#include <jansson.h>
#include <unistd.h>

static const uint64_t NEAR_32_BITS = UINT32_MAX - 2u;

/* All counts of a worker are near the limit, twice. */
static void rays_are_counted_beyond(void **state)
{
    (void)state;
    desk d;
    begin(&d);
    ag_statistics *s = &d.context->statistics;
    eye_worker *workers = aligned_alloc(64, s->threads * sizeof *workers);
    assert_non_null(workers);
    ag_rendering r = {.context = d.context, .workers = workers};
    for (int round = 1; round <= 2; round++) {
        memset(workers, 0, s->threads * sizeof *workers);
        for (unsigned k = 0; k < s->threads; k++)
            workers[k] = (eye_worker){.rays_camera = NEAR_32_BITS,
                                      .rays_shadow = NEAR_32_BITS + 1,
                                      .rays_gather = NEAR_32_BITS + 2,
                                      .rays_path = NEAR_32_BITS + 3,
                                      .rays_estimate = NEAR_32_BITS + 4,
                                      .camera_rays_met = NEAR_32_BITS,
                                      .samples_not_finite = NEAR_32_BITS};
        rendering_count_rays(&r);
        const uint64_t all = (uint64_t)round * s->threads;
        assert_true(s->rays_camera == all * NEAR_32_BITS && s->rays_shadow == all * (NEAR_32_BITS + 1));
        assert_true(s->rays_gather == all * (NEAR_32_BITS + 2) && s->rays_path == all * (NEAR_32_BITS + 3));
        assert_true(s->rays_estimate == all * (NEAR_32_BITS + 4) && s->samples_not_finite == all * NEAR_32_BITS);
        assert_true(r.camera_rays == all * NEAR_32_BITS && r.camera_rays_met == all * NEAR_32_BITS);
    }
    free(workers);
    end(&d);
}

static void irradiances_are_counted_beyond(void **state)
{
    (void)state;
    irradiance_counters counters = {0};
    maps *m = calloc(1, sizeof *m);
    ag_statistics s = {0};
    assert_non_null(m);
    m->cache.worker_count = 1;
    m->cache.counters = &counters;
    for (uint64_t round = 1; round <= 2; round++) {
        counters.requests = counters.computed = counters.deferred = counters.waited = round * NEAR_32_BITS;
        counters.uncached = counters.refused = counters.rays = counters.reclaimed = round * NEAR_32_BITS;
        s = (ag_statistics){0};
        rendering_count_irradiance(&s, m, false);
        assert_true(s.irradiance_requests == round * NEAR_32_BITS && s.irradiance_computed == round * NEAR_32_BITS);
        assert_true(s.irradiance_deferred == round * NEAR_32_BITS && s.irradiance_waited == round * NEAR_32_BITS);
        assert_true(s.irradiance_uncached == round * NEAR_32_BITS && s.irradiance_refused == round * NEAR_32_BITS);
        assert_true(s.rays_estimate == round * NEAR_32_BITS && s.irradiance_reclaimed == round * NEAR_32_BITS);
    }
    free(m);
}

static void json_holds_them(void **state)
{
    (void)state;
    desk d;
    char path[] = "/tmp/afterglow_counts.XXXXXX";
    const int file = mkstemp(path);
    assert_true(file >= 0);
    close(file);
    begin(&d);
    d.context->statistics.rays_gather = d.context->statistics.irradiance_requests = UINT64_C(1) << 40;
    assert_int_equal(ag_statistics_write(d.context, path), AG_OK);
    json_t *stats = json_load_file(path, 0, NULL);
    assert_non_null(stats);
    assert_true(json_integer_value(json_object_get(json_object_get(stats, "rays"), "gather")) == 1LL << 40);
    assert_true(json_integer_value(json_object_get(json_object_get(stats, "irradiance"), "requests")) == 1LL << 40);
    json_decref(stats);
    unlink(path);
    end(&d);
}

/* The place in a message stays at the largest int. */
static void calls_are_counted_beyond(void **state)
{
    (void)state;
    desk d;
    square s;
    begin(&d);
    light_and_look(&d);
    make_square(&s);
    s.parameters[0].count = 11;
    uint64_t *count = &d.made->making->call_counts[DEED_MAKE][CALL_SHAPE];
    *count = INT_MAX - 2;
    static const char *const PLACES[] = {"ag_scene_add_shape:2147483646:1: error",
                                         "ag_scene_add_shape:2147483647:1: error",
                                         "ag_scene_add_shape:2147483647:1: error"};
    for (int k = 0; k < 3; k++) {
        assert_int_equal(ag_scene_add_shape(d.made, &s.shape, NULL), AG_ERROR_ARGUMENT);
        expect_said(&d, PLACES[k]);
    }
    assert_true(*count == (uint64_t)INT_MAX + 1);
    *count = UINT32_MAX;
    assert_int_equal(ag_scene_add_shape(d.made, &s.shape, NULL), AG_ERROR_ARGUMENT);
    expect_said(&d, PLACES[2]);
    assert_true(*count == (uint64_t)UINT32_MAX + 1);
    end(&d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rays_are_counted_beyond),
        cmocka_unit_test(irradiances_are_counted_beyond),
        cmocka_unit_test(json_holds_them),
        cmocka_unit_test(calls_are_counted_beyond),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
