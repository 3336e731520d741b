/* test_irradiance_carry.c: irradiances that one steady map takes over from another have the bits that they would get
 * there, also where photons are equally far and where many lie at one point; and the photons that differ are counted.
 * Threads: the map's. */
#include "fixtures/photon_field.h"
#include "irradiance_carry.h"

enum { NEAREST = 12, SIDE = 96, PATHS = 1000 };

static const scene_difference NO_DIFFERENCE = {.is_known = true};

/* A lattice on a plane, on which many photons are equally far from each: with fluxes of their own. In another order of
 * its columns where is_turned; `more` photons beyond it. */
static photon_set lattice(bool is_turned, uint32_t more)
{
    photon_set set = {.emitted_paths = PATHS, .photons = photon_records_create(SIDE * SIDE + 4096)};
    assert_non_null(set.photons);
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        uint32_t k = is_turned ? SIDE * SIDE - 1 - i : i;
        rng random = rng_make(5, 0, k);
        rgb flux = {rng_float(&random), rng_float(&random), rng_float(&random)};
        field_add(&set, (vec3){(float)(k % SIDE) / 64.0f, (float)(k / SIDE) / 64.0f, 0.0f}, (vec3){0.0f, 0.0f, 1.0f},
                  flux_encode(flux, k));
    }
    for (uint32_t i = 0; i < more; i++)
        field_add(&set, (vec3){3.0f + (float)i / 256.0f, 0.5f, 0.0f}, (vec3){0.0f, 0.0f, 1.0f},
                  flux_encode(rgb_gray(0.5f), i));
    return set;
}

static photon_map steady_map(test_run *r, photon_set *set, uint32_t nearest)
{
    photon_map map;
    photon_map_settings settings = {.nearest = nearest, .max_radius = 0.2f, .surface_area = 2.0f, .is_steady = true};
    assert_int_equal(photon_map_create(&r->run, set, &settings, 0.0, 1.0, &map), AG_OK);
    return map;
}

static void compute(test_run *r, photon_map *map)
{
    irradiance_cache cache;
    assert_int_equal(irradiance_cache_create(map, IRRADIANCE_PRECOMPUTE, 2, &cache), AG_OK);
    assert_int_equal(irradiance_cache_precompute(&cache, &r->run), AG_OK);
    assert_int_equal(irradiance_cache_counters(&cache).duplicated, 0);
    irradiance_cache_reset(&cache);
}

static uint32_t word_of(const photon_map *map, uint32_t index)
{
    return irradiance_slot_read(photon_map_slot(map, index));
}

/* Whether a map's slots that are ready, all of which were taken over, are those of the map that was computed. */
static void expect_words(const photon_map *carried, const photon_map *computed, uint64_t kept)
{
    uint64_t ready = 0;
    for (uint32_t i = 0; i < carried->set.count; i++) {
        uint32_t word = word_of(carried, i);
        ready += word != 0;
        if (word != 0 && word != word_of(computed, i))
            fail_msg("photon %u has %08x, not %08x", i, word, word_of(computed, i));
        if (word != 0)
            assert_true(carried->reaches_squared[i] == computed->reaches_squared[i]);
    }
    assert_int_equal(ready, kept);
}

static void test_ties(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 2);
    photon_set sets[3] = {lattice(false, 0), lattice(true, 40), lattice(true, 40)};
    photon_map before = steady_map(&r, &sets[0], NEAREST), after = steady_map(&r, &sets[1], NEAREST),
               fresh = steady_map(&r, &sets[2], NEAREST);
    irradiance_carry carry;
    compute(&r, &before);
    compute(&r, &fresh);
    assert_int_equal(irradiance_carry_over(&r.run, &before, &NO_DIFFERENCE, &after, &carry), AG_OK);
    assert_int_equal(carry.came, 40);
    assert_int_equal(carry.went, 0);
    expect_words(&after, &fresh, carry.kept);
    /* in the middle of a lattice the 12 nearest, itself among them, are 11 of the 20 whose rings end at 1, 2, 4, 5
     * steps squared: 1 + 4 + 4 + 4 = 13, so that the twelfth and the thirteenth are equally far; not so at its edge */
    assert_true(carry.kept > 0 && carry.kept < SIDE * SIDE / 4);
    photon_map_reset(&before);
    photon_map_reset(&after);
    photon_map_reset(&fresh);
    test_run_reset(&r);
}

/* 13 photons and a fourteenth that is farther: none is equally far, and all but those near the edge are taken over. */
static void test_clear_rings(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 2);
    photon_set sets[3] = {lattice(false, 0), lattice(true, 40), lattice(true, 40)};
    photon_map before = steady_map(&r, &sets[0], NEAREST + 1), after = steady_map(&r, &sets[1], NEAREST + 1),
               fresh = steady_map(&r, &sets[2], NEAREST + 1);
    irradiance_carry carry;
    compute(&r, &before);
    compute(&r, &fresh);
    assert_int_equal(irradiance_carry_over(&r.run, &before, &NO_DIFFERENCE, &after, &carry), AG_OK);
    expect_words(&after, &fresh, carry.kept);
    assert_true(carry.kept > (uint64_t)(SIDE - 8) * (SIDE - 8));
    photon_map_reset(&before);
    photon_map_reset(&after);
    photon_map_reset(&fresh);
    test_run_reset(&r);
}

/* A hundred photons of the same bytes, of which the other map has sixty; and a thousand at one point that differ. */
static void test_same_bytes(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 2);
    photon_map maps[2];
    for (int i = 0; i < 2; i++) {
        photon_set set = lattice(false, 0);
        for (int k = 0; k < (i == 0 ? 100 : 60); k++)
            field_add(&set, (vec3){0.2f, 0.3f, 0.0f}, (vec3){0.0f, 0.0f, 1.0f}, flux_encode(rgb_gray(0.5f), 3));
        for (uint32_t k = 0; k < 300; k++)
            field_add(&set, (vec3){0.9f, 0.9f, 0.0f}, (vec3){0.0f, 0.0f, 1.0f},
                      flux_encode(rgb_gray(0.5f + 0.001f * (float)k), k));
        maps[i] = steady_map(&r, &set, NEAREST + 1);
    }
    irradiance_carry carry;
    compute(&r, &maps[0]);
    assert_int_equal(irradiance_carry_over(&r.run, &maps[0], &NO_DIFFERENCE, &maps[1], &carry), AG_OK);
    assert_int_equal(carry.came, 0);
    assert_int_equal(carry.went, 40);
    assert_true(carry.kept > 0);
    photon_map_reset(&maps[0]);
    photon_map_reset(&maps[1]);
    test_run_reset(&r);
}

/* Nothing is taken over where all estimates are others, where the scenes cannot be compared, or near a difference. */
static void test_refusals(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 2);
    photon_set set = lattice(false, 0);
    photon_map before = steady_map(&r, &set, NEAREST + 1);
    compute(&r, &before);
    const scene_difference unknown = {.is_known = false};
    const scene_difference everywhere = {
        .is_known = true, .count = 1, .boxes = {{{-1.0f, -1.0f, -1.0f}, {3.0f, 3.0f, 3.0f}}}};
    const scene_difference beside = {
        .is_known = true, .count = 1, .boxes = {{{0.5f, 0.5f, 0.01f}, {0.6f, 0.6f, 0.02f}}}};
    for (int i = 0; i < 6; i++) {
        photon_set other = lattice(false, 0);
        if (i == 3)
            other.emitted_paths++;
        if (i == 4) /* brighter than all others, and so the largest exponent of flux */
            field_add(&other, (vec3){1.0f, 1.0f, 0.0f}, (vec3){0.0f, 0.0f, 1.0f}, flux_encode(rgb_gray(1e6f), 1));
        photon_map after = steady_map(&r, &other, i == 2 ? NEAREST : NEAREST + 1);
        irradiance_carry carry;
        const scene_difference *difference = i == 0   ? &unknown
                                             : i == 1 ? &everywhere
                                             : i == 5 ? &beside
                                                      : &NO_DIFFERENCE;
        assert_int_equal(irradiance_carry_over(&r.run, &before, difference, &after, &carry), AG_OK);
        if (i < 5)
            assert_int_equal(carry.kept, 0);
        for (uint32_t k = 0; i == 5 && k < after.set.count; k++) {
            vec3 at = photon_block_position(after.blocks, k);
            bool is_inside = at.x >= 0.5f && at.x <= 0.6f && at.y >= 0.5f && at.y <= 0.6f;
            bool is_far = at.x < 0.3f && at.y < 0.3f && at.x > 0.1f && at.y > 0.1f;
            if (is_inside || is_far)
                assert_int_equal(word_of(&after, k) != 0, is_far);
        }
        photon_map_reset(&after);
    }
    photon_map_reset(&before);
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_ties), cmocka_unit_test(test_clear_rings),
                                       cmocka_unit_test(test_same_bytes), cmocka_unit_test(test_refusals)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
