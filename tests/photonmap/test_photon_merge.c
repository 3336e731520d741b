/* test_photon_merge.c: irradiances of two maps in one: what is ready fills what is empty and nothing else; two that
 * differ are found before anything is changed. Flow: tests of photonmap/photon_merge.c. Threads: one. */
/* ctest: sanitize */
#define _GNU_SOURCE
#include "fixtures/photon_field.h"
#include "photon_merge.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

enum { PHOTONS = 600 };

static photon_map make_map(test_run *r)
{
    photon_set set = field_photons(FIELD_SPHERE, PHOTONS, 3);
    return field_map(r, &set, 20, 1.0f);
}

/* Any word that is ready and belongs to that photon. */
static uint32_t word_of(uint32_t i)
{
    return irradiance_word(i % 2 ? IRRADIANCE_READY : IRRADIANCE_READY_IN_SIGHT, 77 * i);
}

static void set(photon_map *map, uint32_t i, uint32_t word) { store_relaxed_u32(photon_map_slot(map, i), word); }
static uint32_t get(const photon_map *map, uint32_t i) { return irradiance_slot_read(photon_map_slot(map, i)); }

static void test_union(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    photon_map into = make_map(&r), from = make_map(&r);
    uint64_t added = 5;
    uint32_t irradiance_photon;
    for (uint32_t i = 0; i < PHOTONS; i++) {
        if (i % 3 == 0)
            set(&into, i, word_of(i));
        if (i % 4 == 0)
            set(&from, i, word_of(i));
    }
    assert_int_equal(photon_map_count_ready(&into), PHOTONS / 3);
    assert_int_equal(photon_merge(&into, &from, &added, &irradiance_photon), PHOTON_MERGE_DONE);
    assert_int_equal(added, 5 + PHOTONS / 4 - PHOTONS / 12);
    assert_int_equal(photon_map_count_ready(&into), PHOTONS / 3 + PHOTONS / 4 - PHOTONS / 12);
    for (uint32_t i = 0; i < PHOTONS; i++) {
        assert_int_equal(get(&into, i), i % 3 == 0 || i % 4 == 0 ? word_of(i) : 0);
        assert_int_equal(get(&from, i), i % 4 == 0 ? word_of(i) : 0);
    }
    assert_int_equal(photon_merge(&into, &from, &added, &irradiance_photon),
                     PHOTON_MERGE_DONE); /* once more: nothing */
    assert_int_equal(added, 5 + PHOTONS / 4 - PHOTONS / 12);
    photon_map_reset(&into);
    photon_map_reset(&from);
    test_run_reset(&r);
}

static void test_differing(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    photon_map into = make_map(&r), from = make_map(&r);
    uint64_t added = 0;
    uint32_t irradiance_photon = 0;
    set(&from, 3, word_of(3));
    set(&into, 500, word_of(500));
    set(&from, 500, word_of(500) ^ 1);
    assert_int_equal(photon_merge(&into, &from, &added, &irradiance_photon), PHOTON_MERGE_DIFFERS);
    assert_int_equal(irradiance_photon, 500);
    assert_int_equal(added, 0);
    assert_int_equal(get(&into, 3), 0);
    photon_map_reset(&into);
    photon_map_reset(&from);
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_union), cmocka_unit_test(test_differing)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
