/* test_irradiance_photons.c: a fraction of the photons are irradiance photons: the right number of them, one of each
 * run of neighbours and some of those it cannot stand for, no lane before others, the same for any number of threads;
 * and what is asked for through them is right, once computed, and the same bits on demand and precomputed. Threads: the
 * map's, up to 4. */
/* ctest: sanitize */
#include "fixtures/photon_field.h"

enum { PHOTONS = 40960 / FEWER };

static photon_map fraction_map(test_run *r, photon_set *set, uint32_t nearest, float irradiance_fraction)
{
    photon_map map;
    photon_map_settings settings = {.nearest = nearest,
                                    .max_radius = 1.0f,
                                    .surface_area = 4.0f * AG_PI,
                                    .irradiance_fraction = irradiance_fraction};
    assert_int_equal(photon_map_create(&r->run, set, &settings, 0.0, 1.0, &map), AG_OK);
    return map;
}

static photon_map fraction_field(test_run *r, uint32_t count, uint64_t seed, float irradiance_fraction)
{
    photon_set set = field_photons(FIELD_SPHERE, count, seed);
    return fraction_map(r, &set, 50, irradiance_fraction);
}

static void a_fraction_is_rounded_and_never_none(void **state)
{
    (void)state;
    assert_int_equal(irradiance_photons_runs(1000, 1.0f), 1000);
    assert_int_equal(irradiance_photons_runs(1000, 0.125f), 125);
    assert_int_equal(irradiance_photons_runs(1000, 0.0116f), 12);
    assert_int_equal(irradiance_photons_runs(1000, 1e-9f), 1);
    assert_int_equal(irradiance_photons_runs(0, 0.5f), 0);
    assert_int_equal(irradiance_photons_runs(UINT32_MAX - 1, 1.0f), UINT32_MAX - 1);
    assert_int_equal(irradiance_photons_runs(UINT32_MAX - 1, 0.5f), UINT32_MAX / 2);
}

static void at_one_the_photons_bear_themselves(void **state)
{
    uint64_t rays = 0;
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    photon_map all = fraction_field(&r, 1000, 1, 1.0f), some = fraction_field(&r, 1000, 1, 0.25f), none;
    assert_true(photon_map_all_have_irradiance(&all));
    assert_ptr_equal(all.irradiance_photons.blocks, all.blocks);
    assert_int_equal(all.irradiance_photons.count, 1000);
    assert_false(photon_map_all_have_irradiance(&some));
    uint32_t count = some.irradiance_photons.count;
    assert_true(count >= 250 && count <= 300);
    /* a quarter of the photons again, and hardly more */
    uint64_t extra = photon_map_bytes(&some) - photon_map_bytes(&all);
    assert_true(extra >= 24 * count && extra <= 26 * count + sizeof(photon_block));
    photon_set empty = {0};
    none = fraction_map(&r, &empty, 50, 0.25f);
    assert_int_equal(none.irradiance_photons.count, 0);
    assert_int_equal(photon_map_nearest(&none, (vec3){0.0f, 0.0f, 1.0f}, (vec3){0.0f, 0.0f, -1.0f}, &rays),
                     PHOTON_NONE);
    photon_map_reset(&all);
    photon_map_reset(&some);
    photon_map_reset(&none);
    test_run_reset(&r);
}

/* Each photon of a run of eight is an irradiance photon, or another of its run stands for it; copies as they are there,
 * with empty slots; all lanes of a block alike often. */
static void irradiance_photons_are_spread_as_the_photons_are(void **state)
{
    (void)state;
    enum { EACH = 8, RUNS = PHOTONS / EACH };
    test_run r;
    test_run_init(&r, 2);
    photon_map map = fraction_field(&r, PHOTONS, 2, 1.0f / EACH);
    assert_true(map.irradiance_photons.count >= RUNS && map.irradiance_photons.count < RUNS + RUNS / 10);
    unsigned char *has_irradiance = calloc(PHOTONS, 1);
    double lanes[PHOTON_BLOCK_LANES] = {0.0}, chi_squared = 0.0;
    for (uint32_t i = 0; i < map.irradiance_photons.count; i++) {
        uint32_t photon_index = irradiance_photons_source(&map.irradiance_photons, i);
        assert_true(photon_index < PHOTONS);
        assert_false(has_irradiance[photon_index]);
        has_irradiance[photon_index] = 1;
        lanes[photon_index % PHOTON_BLOCK_LANES]++;
        vec3 a = photon_block_position(map.irradiance_photons.blocks, i),
             b = photon_block_position(map.blocks, photon_index);
        assert_memory_equal(&a, &b, sizeof a);
        assert_int_equal(photon_block_normal(map.irradiance_photons.blocks, i),
                         photon_block_normal(map.blocks, photon_index));
        assert_int_equal(irradiance_slot_read(photon_map_slot(&map, i)), 0);
    }
    for (uint32_t i = 0; i < PHOTONS; i++) {
        bool is_served = has_irradiance[i];
        field_point p = field_photon(&map, i);
        for (uint32_t k = i / EACH * EACH; k < (i / EACH + 1) * EACH && !is_served; k++) {
            field_point q = field_photon(&map, k);
            is_served = has_irradiance[k] &&
                        vec3_distance_squared(p.position, q.position) <= 0.25f * map.max_radius * map.max_radius &&
                        vec3_dot(p.normal, q.normal) > PHOTON_NEAREST_MIN_COS;
        }
        assert_true(is_served);
    }
    double expected = (double)map.irradiance_photons.count / PHOTON_BLOCK_LANES;
    for (int i = 0; i < PHOTON_BLOCK_LANES; i++)
        chi_squared += (lanes[i] - expected) * (lanes[i] - expected) / expected;
    assert_true(chi_squared < 37.7); /* one in a thousand, 15 degrees of freedom */
    free(has_irradiance);
    photon_map_reset(&map);
    test_run_reset(&r);
}

/* Photons on a line too far apart for one to stand for another, and photons at one point that look six ways, of which
 * no more than six are irradiance photons in each run. */
static void what_cannot_be_stood_for_bears(void **state)
{
    (void)state;
    enum { COUNT = 600 };
    static const vec3 WAYS[6] = {{1.0f, 0.0f, 0.0f},  {-1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f},
                                 {0.0f, -1.0f, 0.0f}, {0.0f, 0.0f, 1.0f},  {0.0f, 0.0f, -1.0f}};
    test_run r;
    test_run_init(&r, 1);
    for (int kind = 0; kind < 2; kind++) {
        photon_set set = {.emitted_paths = 1};
        set.photons = photon_records_create(COUNT);
        assert_non_null(set.photons);
        for (uint32_t i = 0; i < COUNT; i++)
            field_add(&set, kind == 0 ? (vec3){100.0f * (float)i, 0.0f, 0.0f} : (vec3){0.0f, 0.0f, 0.0f},
                      kind == 0 ? WAYS[4] : WAYS[i % 6], flux_encode(rgb_gray(1.0f), i));
        photon_map map = fraction_map(&r, &set, 50, 0.01f);
        bool has_way[6] = {false};
        for (uint32_t i = 0; i < map.irradiance_photons.count; i++)
            for (int k = 0; k < 6; k++)
                has_way[k] |= photon_block_normal(map.irradiance_photons.blocks, i) == direction_encode(WAYS[k]);
        for (int k = 0; k < 6; k++)
            assert_true(has_way[k] || kind == 0);
        if (kind == 0)
            assert_int_equal(map.irradiance_photons.count, COUNT);
        else
            assert_true(map.irradiance_photons.count <= 6 * irradiance_photons_runs(COUNT, 0.01f));
        photon_map_reset(&map);
    }
    test_run_reset(&r);
}

static void threads_do_not_matter(void **state)
{
    (void)state;
    photon_map maps[2];
    test_run r[2];
    for (int i = 0; i < 2; i++) {
        test_run_init(&r[i], i == 0 ? 1 : 4);
        maps[i] = fraction_field(&r[i], PHOTONS, 3, 0.3f);
    }
    assert_int_equal(maps[0].irradiance_photons.count, maps[1].irradiance_photons.count);
    assert_memory_equal(maps[0].irradiance_photons.blocks, maps[1].irradiance_photons.blocks,
                        (size_t)photon_block_count(maps[0].irradiance_photons.count) * sizeof(photon_block));
    for (int i = 0; i < 2; i++) {
        photon_map_reset(&maps[i]);
        test_run_reset(&r[i]);
    }
}

/* In an even field the irradiance that points get from their nearest irradiance photons is right on average, in each
 * map. */
static void the_mean_through_the_nearest_irradiance_photon_is_right(void **state)
{
    (void)state;
    enum { MAPS = 12 / (FEWER > 1 ? 4 : 1), POINTS = 10000 / FEWER };
    static const float FRACTIONS[] = {0.5f, 0.25f, 0.125f};
    for (int f = 0; f < 3; f++) {
        double mean = 0.0;
        for (int m = 0; m < MAPS; m++) {
            test_run r;
            test_run_init(&r, 2);
            photon_map map = fraction_field(&r, PHOTONS, (uint64_t)m, FRACTIONS[f]);
            irradiance_cache cache;
            assert_int_equal(irradiance_cache_create(&map, IRRADIANCE_ON_DEMAND, 1, &cache), AG_OK);
            rng random = test_random((uint64_t)(100 + m));
            for (int i = 0; i < POINTS; i++) {
                irradiance_request request;
                field_point at = field_point_at(FIELD_SPHERE, rng_vec2(&random));
                irradiance_cache_get(&cache, at.position, at.normal, 0, &request);
                mean += (double)request.irradiance.r / (MAPS * POINTS);
            }
            irradiance_counters c = irradiance_cache_counters(&cache);
            assert_true(c.computed > 0 && c.computed <= map.irradiance_photons.count);
            assert_int_equal(c.computed, irradiance_cache_distinct(&cache));
            assert_true(c.uncached <= POINTS / 10); /* nearly all have an irradiance photon nearby */
            irradiance_cache_reset(&cache);
            photon_map_reset(&map);
            test_run_reset(&r);
        }
        double expected = (double)FIELD_FLUX.r * field_irradiance(FIELD_SPHERE);
        print_message("a fraction of %g: %+.2f %%\n", (double)FRACTIONS[f], 100.0 * (mean / expected - 1.0));
        assert_relative(mean, expected, 0.004 * WIDER);
    }
}

static void on_demand_and_precomputed_are_the_same_bits(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 4);
    photon_map a = fraction_field(&r, PHOTONS, 5, 0.125f), b = fraction_field(&r, PHOTONS, 5, 0.125f);
    irradiance_cache on_demand, precomputed;
    assert_int_equal(irradiance_cache_create(&a, IRRADIANCE_ON_DEMAND, 4, &on_demand), AG_OK);
    assert_int_equal(irradiance_cache_create(&b, IRRADIANCE_PRECOMPUTE, 4, &precomputed), AG_OK);
    assert_int_equal(irradiance_cache_precompute(&precomputed, &r.run), AG_OK);
    assert_int_equal(irradiance_cache_distinct(&precomputed), b.irradiance_photons.count);
    rng random = test_random(7);
    for (int i = 0; i < 2000; i++) {
        irradiance_request x, y;
        field_point at = field_point_at(FIELD_SPHERE, rng_vec2(&random));
        irradiance_cache_get(&on_demand, at.position, at.normal, 1, &x);
        irradiance_cache_get(&precomputed, at.position, at.normal, 2, &y);
        assert_memory_equal(&x.irradiance, &y.irradiance, sizeof x.irradiance);
    }
    /* the slots of all other photons stay as they were */
    for (uint32_t i = 0; i < b.set.count; i++)
        assert_int_equal(irradiance_slot_read(photon_block_slot(b.blocks, i)), 0);
    irradiance_cache_reset(&on_demand);
    irradiance_cache_reset(&precomputed);
    photon_map_reset(&a);
    photon_map_reset(&b);
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_fraction_is_rounded_and_never_none),
        cmocka_unit_test(at_one_the_photons_bear_themselves),
        cmocka_unit_test(irradiance_photons_are_spread_as_the_photons_are),
        cmocka_unit_test(what_cannot_be_stood_for_bears),
        cmocka_unit_test(threads_do_not_matter),
        cmocka_unit_test(the_mean_through_the_nearest_irradiance_photon_is_right),
        cmocka_unit_test(on_demand_and_precomputed_are_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
