/* test_irradiance_cache.c: an irradiance is computed once, whoever asks and however many at once, and its bits depend
 * on neither. Threads: up to 64, more than there are processors. */
#include "fixtures/photon_field.h"

#include <pthread.h>
#include <sched.h>

enum { PHOTONS = 20000 / FEWER, NEAREST = 50 };

/* Everything a test needs: a run, a map over the even field in a sphere, a cache over it. */
typedef struct fixture {
    test_run r;
    photon_map map;
    irradiance_cache cache;
} fixture;

static void fixture_init(fixture *f, irradiance_cache_mode mode, unsigned workers)
{
    test_run_init(&f->r, workers);
    photon_set set = field_photons(FIELD_SPHERE, PHOTONS, 3);
    f->map = field_map(&f->r, &set, NEAREST, 1.0f);
    assert_int_equal(irradiance_cache_create(&f->map, mode, workers, &f->cache), AG_OK);
}

static void fixture_reset(fixture *f)
{
    irradiance_cache_reset(&f->cache);
    photon_map_reset(&f->map);
    test_run_reset(&f->r);
}

/* --- alone --- */

static void the_second_request_finds_it_ready(void **state)
{
    (void)state;
    fixture f;
    fixture_init(&f, IRRADIANCE_ON_DEMAND, 1);
    field_point p = field_photon(&f.map, 123);
    irradiance_request a, b;
    irradiance_cache_get(&f.cache, p.position, p.normal, 0, &a);
    irradiance_cache_get(&f.cache, p.position, p.normal, 0, &b);
    assert_int_equal(a.irradiance_photon, PHOTON_NONE);
    assert_memory_equal(&a, &b, sizeof a);
    /* the answer is what the slot holds, not what was computed */
    uint32_t word = irradiance_slot_read(photon_block_slot(f.map.blocks, 123));
    assert_int_equal(irradiance_word_state(word), IRRADIANCE_READY);
    rgb kept = photon_map_decode_irradiance(&f.map, word & IRRADIANCE_VALUE_MASK);
    assert_memory_equal(&a.irradiance, &kept, sizeof kept);
    rgb full = irradiance_estimate(&f.map, p.position, p.normal, f.cache.scratch[0].neighbors);
    assert_relative(kept.r, full.r, 1 / 127.0);

    irradiance_counters c = irradiance_cache_counters(&f.cache);
    assert_int_equal(c.requests, 2);
    assert_int_equal(c.computed, 1);
    assert_int_equal(c.uncached, 0);
    assert_int_equal(c.deferred + c.waited + c.duplicated, 0);
    assert_int_equal(irradiance_cache_distinct(&f.cache), 1);
    fixture_reset(&f);
}

static void uncached_answers_at_the_point(void **state)
{
    (void)state;
    fixture f;
    fixture_init(&f, IRRADIANCE_UNCACHED, 1);
    rng random = test_random(1);
    for (int i = 0; i < 100; i++) {
        field_point at = field_point_at(FIELD_SPHERE, rng_vec2(&random));
        irradiance_request request;
        irradiance_cache_get(&f.cache, at.position, at.normal, 0, &request);
        rgb expected = irradiance_estimate(&f.map, at.position, at.normal, f.cache.scratch[0].neighbors);
        assert_int_equal(request.irradiance_photon, PHOTON_NONE);
        assert_memory_equal(&request.irradiance, &expected, sizeof expected);
    }
    irradiance_counters c = irradiance_cache_counters(&f.cache);
    assert_int_equal(c.requests, 100);
    assert_int_equal(c.uncached, 100);
    assert_int_equal(c.computed, 0);
    assert_int_equal(irradiance_cache_distinct(&f.cache), 0);
    fixture_reset(&f);
}

/* Where no photon is near, the estimate is made at the point, and counted. */
static void a_point_without_photons_is_estimated_uncached(void **state)
{
    (void)state;
    fixture f;
    fixture_init(&f, IRRADIANCE_ON_DEMAND, 1);
    irradiance_request request;
    irradiance_cache_get(&f.cache, (vec3){5.0f, 0.0f, 0.0f}, (vec3){1.0f, 0.0f, 0.0f}, 0, &request);
    assert_int_equal(request.irradiance_photon, PHOTON_NONE);
    assert_true(rgb_is_black(request.irradiance));
    irradiance_counters c = irradiance_cache_counters(&f.cache);
    assert_int_equal(c.uncached, 1);
    assert_int_equal(c.computed, 0);
    fixture_reset(&f);
}

/* --- set aside --- */

typedef struct late_claimer {
    irradiance_slot *slot;
    uint32_t value;
    atomic_u32 *go;
} late_claimer;

static void *publish_late(void *user)
{
    late_claimer *late = user;
    while (load_acquire_u32(late->go) == 0)
        sched_yield();
    for (int i = 0; i < 100; i++)
        sched_yield(); /* the other one is likely to wait by now; it is right either way */
    return irradiance_slot_publish(late->slot, 7, irradiance_word(IRRADIANCE_READY, late->value)) ? user : NULL;
}

static void a_request_set_aside_comes_back(void **state)
{
    (void)state;
    fixture f;
    fixture_init(&f, IRRADIANCE_ON_DEMAND, 2);
    field_point p = field_photon(&f.map, PHOTONS / 2);
    irradiance_slot *slot = photon_block_slot(f.map.blocks, PHOTONS / 2);
    uint32_t word;
    assert_true(irradiance_slot_try_claim(slot, 7, &word)); /* somebody else is at it */
    irradiance_request request, other;
    irradiance_cache_get(&f.cache, p.position, p.normal, 1, &request);
    assert_int_equal(request.irradiance_photon, PHOTONS / 2);
    assert_int_equal(irradiance_cache_counters(&f.cache).deferred, 1);

    /* meanwhile others are served */
    field_point q = field_photon(&f.map, 1);
    irradiance_cache_get(&f.cache, q.position, q.normal, 1, &other);
    assert_int_equal(other.irradiance_photon, PHOTON_NONE);

    /* it comes back, without waiting where it is ready, and after waiting where it is not */
    uint32_t value = photon_map_encode_irradiance(&f.map, rgb_gray(3.0f), 0);
    rgb expected = photon_map_decode_irradiance(&f.map, value);
    atomic_u32 go = 0;
    late_claimer late = {slot, value, &go};
    pthread_t thread;
    assert_int_equal(pthread_create(&thread, NULL, publish_late, &late), 0);
    irradiance_request copy = request;
    store_release_u32(&go, 1);
    irradiance_cache_retry(&f.cache, NULL, &request, 1);
    void *published;
    pthread_join(thread, &published);
    assert_non_null(published);
    assert_int_equal(request.irradiance_photon, PHOTON_NONE);
    assert_memory_equal(&request.irradiance, &expected, sizeof expected);
    uint64_t waited = irradiance_cache_counters(&f.cache).waited;
    assert_true(waited <= 1);
    irradiance_cache_retry(&f.cache, NULL, &copy, 1);
    assert_memory_equal(&copy.irradiance, &expected, sizeof expected);
    assert_int_equal(irradiance_cache_counters(&f.cache).waited, waited);
    assert_int_equal(irradiance_cache_counters(&f.cache).duplicated, 0);
    fixture_reset(&f);
}

/* Many at once: each gets what it would have got alone, at its own point, and what another computes comes last. */
static void many_at_once_are_as_each_alone(void **state)
{
    (void)state;
    enum { POINTS = 3000 };
    static irradiance_query queries[POINTS];
    static rgb many[POINTS];
    static bool holds[POINTS];
    const irradiance_cache_mode modes[] = {IRRADIANCE_ON_DEMAND, IRRADIANCE_UNCACHED};
    for (int m = 0; m < 2; m++) {
        fixture f, single;
        fixture_init(&f, modes[m], 1);
        fixture_init(&single, modes[m], 1);
        rng random = test_random(5);
        for (int i = 0; i < POINTS; i++) {
            field_point at = field_point_at(FIELD_SPHERE, rng_vec2(&random));
            if (i % 100 == 0)
                at.position = vec3_scale(at.position, 5.0f); /* no photon is near */
            queries[i] = (irradiance_query){at.position, at.normal};
        }
        irradiance_cache_get_many(&f.cache, &f.r.run, queries, POINTS, 0, many, holds);
        for (int i = 0; i < POINTS; i++) {
            irradiance_request request;
            irradiance_cache_get(&single.cache, queries[i].position, queries[i].normal, 0, &request);
            assert_memory_equal(&many[i], &request.irradiance, sizeof many[i]);
        }
        irradiance_counters a = irradiance_cache_counters(&f.cache), b = irradiance_cache_counters(&single.cache);
        assert_int_equal(a.requests, POINTS);
        assert_int_equal(a.computed, b.computed);
        assert_int_equal(a.uncached, b.uncached);
        assert_int_equal(a.computed, irradiance_cache_distinct(&f.cache));
        fixture_reset(&single);
        fixture_reset(&f);
    }
}

static void many_at_once_come_back_to_what_another_computes(void **state)
{
    (void)state;
    enum { POINTS = 50 };
    fixture f;
    fixture_init(&f, IRRADIANCE_ON_DEMAND, 2);
    irradiance_query queries[POINTS];
    rgb found[POINTS];
    bool holds[POINTS];
    for (uint32_t i = 0; i < POINTS; i++) {
        field_point p = field_photon(&f.map, i * (PHOTONS / POINTS));
        queries[i] = (irradiance_query){p.position, p.normal};
    }
    enum { HELD = 20 };
    irradiance_slot *slot = photon_block_slot(f.map.blocks, HELD * (PHOTONS / POINTS));
    uint32_t word, value = photon_map_encode_irradiance(&f.map, rgb_gray(3.0f), 0);
    assert_true(irradiance_slot_try_claim(slot, 7, &word));
    atomic_u32 go = 1;
    late_claimer late = {slot, value, &go};
    pthread_t thread;
    assert_int_equal(pthread_create(&thread, NULL, publish_late, &late), 0);
    irradiance_cache_get_many(&f.cache, &f.r.run, queries, POINTS, 1, found, holds);
    void *published;
    pthread_join(thread, &published);
    assert_non_null(published);
    rgb expected = photon_map_decode_irradiance(&f.map, value);
    assert_memory_equal(&found[HELD], &expected, sizeof expected);
    irradiance_counters c = irradiance_cache_counters(&f.cache);
    assert_int_equal(c.computed, POINTS - 1);
    assert_true(c.deferred <= 1);
    assert_int_equal(c.duplicated, 0);
    fixture_reset(&f);
}

/* A claim that was taken away is seen by the counters. */
static void a_second_computation_would_be_counted(void **state)
{
    (void)state;
    fixture f;
    fixture_init(&f, IRRADIANCE_ON_DEMAND, 1);
    uint32_t word;
    assert_true(irradiance_slot_try_claim(photon_block_slot(f.map.blocks, 5), 9, &word));
    assert_false(irradiance_slot_publish(photon_block_slot(f.map.blocks, 5), 0, irradiance_word(IRRADIANCE_READY, 1)));
    assert_int_equal(irradiance_cache_distinct(&f.cache), 0);
    assert_true(irradiance_slot_publish(photon_block_slot(f.map.blocks, 5), 9, irradiance_word(IRRADIANCE_READY, 1)));
    assert_int_equal(irradiance_cache_distinct(&f.cache), 1); /* counted by looking, though this cache computed none */
    assert_int_equal(irradiance_cache_counters(&f.cache).computed, 0);
    fixture_reset(&f);
}

/* --- many at once --- */

enum { FEW = 24, ROUNDS = 40, RAYS = 64 };

typedef struct crowd {
    fixture *f;
    field_point few[FEW];
    rgb expected[FEW]; /* from another map, precomputed */
    uint32_t wrong[64];
    uint32_t open[64]; /* set aside, by worker */
} crowd;

/* Works as a final gather does: asks for all, and comes back to those that another thread computes. */
static void demand(void *user, unsigned worker)
{
    crowd *all = user;
    irradiance_request requests[RAYS];
    for (uint32_t round = 0; round < ROUNDS; round++) {
        for (uint32_t i = 0; i < RAYS; i++) {
            field_point p = all->few[(i + round) % FEW];
            irradiance_cache_get(&all->f->cache, p.position, p.normal, worker, &requests[i]);
        }
        for (uint32_t i = 0; i < RAYS; i++)
            if (requests[i].irradiance_photon != PHOTON_NONE) {
                all->open[worker]++;
                irradiance_cache_retry(&all->f->cache, NULL, &requests[i], worker);
            }
        for (uint32_t i = 0; i < RAYS; i++)
            all->wrong[worker] += memcmp(&requests[i].irradiance, &all->expected[(i + round) % FEW], sizeof(rgb)) != 0;
    }
}

static void many_threads_demand_the_same_few_photons(void **state)
{
    (void)state;
    static const unsigned WORKERS[] = {1, 2, 8, 64};
    fixture reference;
    fixture_init(&reference, IRRADIANCE_PRECOMPUTE, 3);
    assert_int_equal(irradiance_cache_precompute(&reference.cache, &reference.r.run), AG_OK);
    assert_int_equal(irradiance_cache_counters(&reference.cache).computed, PHOTONS);
    assert_int_equal(irradiance_cache_distinct(&reference.cache), PHOTONS);

    for (size_t w = 0; w < sizeof WORKERS / sizeof *WORKERS; w++)
        for (int repeat = 0; repeat < 3; repeat++) {
            fixture f;
            fixture_init(&f, IRRADIANCE_ON_DEMAND, WORKERS[w]);
            static crowd all;
            all = (crowd){.f = &f};
            for (uint32_t i = 0; i < FEW; i++) {
                uint32_t index = i * (PHOTONS / FEW);
                all.few[i] = field_photon(&f.map, index);
                field_point same = field_photon(&reference.map, index);
                assert_memory_equal(&all.few[i], &same, sizeof same);
                uint32_t word = irradiance_slot_read(photon_block_slot(reference.map.blocks, index));
                all.expected[i] = photon_map_decode_irradiance(&reference.map, word & IRRADIANCE_VALUE_MASK);
            }
            thread_pool_run(f.r.pool, demand, &all);
            irradiance_counters c = irradiance_cache_counters(&f.cache);
            uint32_t open = 0;
            for (unsigned i = 0; i < WORKERS[w]; i++) {
                assert_int_equal(all.wrong[i], 0);
                open += all.open[i];
            }
            assert_int_equal(c.requests, (uint64_t)WORKERS[w] * ROUNDS * RAYS);
            assert_int_equal(c.computed, FEW);
            assert_int_equal(irradiance_cache_distinct(&f.cache), FEW);
            assert_int_equal(c.duplicated, 0);
            assert_int_equal(c.uncached, 0);
            assert_int_equal(c.deferred, open);
            assert_true(c.waited <= c.deferred);
            if (WORKERS[w] == 1)
                assert_int_equal(c.deferred, 0);
            fixture_reset(&f);
        }
    fixture_reset(&reference);
}

static void ask_all(void *user, unsigned worker)
{
    fixture *f = user;
    unsigned workers = thread_pool_worker_count(f->r.pool);
    for (uint32_t i = 0; i < PHOTONS; i++) { /* each from another end, so that they meet */
        field_point p = field_photon(&f->map, (i + worker * (PHOTONS / workers)) % PHOTONS);
        irradiance_request request;
        irradiance_cache_get(&f->cache, p.position, p.normal, worker, &request);
        if (request.irradiance_photon != PHOTON_NONE)
            irradiance_cache_retry(&f->cache, NULL, &request, worker);
    }
}

static void on_demand_and_precomputed_slots_are_the_same(void **state)
{
    (void)state;
    fixture a, b;
    fixture_init(&a, IRRADIANCE_ON_DEMAND, 8);
    fixture_init(&b, IRRADIANCE_PRECOMPUTE, 2);
    thread_pool_run(a.r.pool, ask_all, &a);
    assert_int_equal(irradiance_cache_precompute(&b.cache, &b.r.run), AG_OK);
    irradiance_counters c = irradiance_cache_counters(&a.cache);
    assert_int_equal(c.computed, irradiance_cache_distinct(&a.cache));
    assert_true(c.computed > PHOTONS * 9 / 10 && c.computed <= PHOTONS);
    assert_int_equal(c.duplicated, 0);
    for (uint32_t i = 0; i < PHOTONS; i++) {
        uint32_t word = irradiance_slot_read(photon_block_slot(a.map.blocks, i));
        if (word != 0) /* a photon that coincides with another, by normal too, may not be anybody's nearest */
            assert_int_equal(word, irradiance_slot_read(photon_block_slot(b.map.blocks, i)));
    }
    fixture_reset(&a);
    fixture_reset(&b);
}

static void a_second_cache_sees_what_was_ready(void **state)
{
    (void)state;
    fixture f;
    fixture_init(&f, IRRADIANCE_ON_DEMAND, 2);
    irradiance_request request;
    for (uint32_t i = 0; i < 50; i++) {
        field_point p = field_photon(&f.map, i);
        irradiance_cache_get(&f.cache, p.position, p.normal, i % 2, &request);
    }
    assert_int_equal(irradiance_cache_distinct(&f.cache), 50);
    irradiance_cache second;
    assert_int_equal(irradiance_cache_create(&f.map, IRRADIANCE_ON_DEMAND, 2, &second), AG_OK);
    assert_int_equal(second.ready_before, 50);
    assert_int_equal(irradiance_cache_distinct(&second), 0);
    for (uint32_t i = 40; i < 60; i++) {
        field_point p = field_photon(&f.map, i);
        irradiance_cache_get(&second, p.position, p.normal, i % 2, &request);
    }
    assert_int_equal(irradiance_cache_counters(&second).requests, 20);
    assert_int_equal(irradiance_cache_counters(&second).computed, 10);
    assert_int_equal(irradiance_cache_distinct(&second), 10);
    /* precomputing the rest computes no more than the rest */
    assert_int_equal(irradiance_cache_precompute(&second, &f.r.run), AG_OK);
    assert_int_equal(irradiance_cache_counters(&second).computed, PHOTONS - 50);
    assert_int_equal(irradiance_cache_distinct(&second), PHOTONS - 50);
    irradiance_cache_reset(&second);
    fixture_reset(&f);
}

static void precomputing_can_be_cancelled(void **state)
{
    (void)state;
    fixture f;
    fixture_init(&f, IRRADIANCE_PRECOMPUTE, 2);
    run_cancel(&f.r.run);
    assert_int_equal(irradiance_cache_precompute(&f.cache, &f.r.run), AG_CANCELLED);
    assert_int_equal(irradiance_cache_counters(&f.cache).computed, irradiance_cache_distinct(&f.cache));
    fixture_reset(&f);
}

static void an_empty_map_answers_black(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    photon_set none = {0};
    photon_map map = field_map(&r, &none, NEAREST, 0.0f);
    irradiance_cache cache;
    assert_int_equal(irradiance_cache_create(&map, IRRADIANCE_ON_DEMAND, 1, &cache), AG_OK);
    assert_int_equal(irradiance_cache_precompute(&cache, &r.run), AG_OK);
    irradiance_request request;
    irradiance_cache_get(&cache, (vec3){0.0f, 0.0f, 0.0f}, (vec3){0.0f, 0.0f, 1.0f}, 0, &request);
    assert_int_equal(request.irradiance_photon, PHOTON_NONE);
    assert_true(rgb_is_black(request.irradiance));
    irradiance_cache_reset(&cache);
    photon_map_reset(&map);
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_second_request_finds_it_ready),
        cmocka_unit_test(uncached_answers_at_the_point),
        cmocka_unit_test(a_point_without_photons_is_estimated_uncached),
        cmocka_unit_test(a_request_set_aside_comes_back),
        cmocka_unit_test(many_at_once_are_as_each_alone),
        cmocka_unit_test(many_at_once_come_back_to_what_another_computes),
        cmocka_unit_test(a_second_computation_would_be_counted),
        cmocka_unit_test(many_threads_demand_the_same_few_photons),
        cmocka_unit_test(on_demand_and_precomputed_slots_are_the_same),
        cmocka_unit_test(a_second_cache_sees_what_was_ready),
        cmocka_unit_test(precomputing_can_be_cancelled),
        cmocka_unit_test(an_empty_map_answers_black),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
