/* test_estimate_fingerprint.c: the fingerprint of the estimates that a photon map's file keeps: the same for any number
 * of threads and any ISA of ray traversal, another for every other estimate, however little it differs and wherever.
 * Threads: one and several. */
#include "fixtures/photon_field.h"

#include "estimate_fingerprint.h"

static hash128 fingerprint(unsigned threads, const char *isa, irradiance_estimate_fn *find)
{
    test_run r;
    hash128 hash;
    test_run_init(&r, threads);
    assert_int_equal(estimate_fingerprint(&r.run, isa, find, &hash), AG_OK);
    assert_int_equal(r.warning_count, 0);
    test_run_reset(&r);
    return hash;
}

static void same_for_threads_and_isas(void **state)
{
    (void)state;
    hash128 one = fingerprint(1, "avx2", irradiance_estimate_find);
    assert_true(hash128_is_equal(one, fingerprint(1, "avx2", irradiance_estimate_find)));
    assert_true(hash128_is_equal(one, fingerprint(4, "avx2", irradiance_estimate_find)));
    assert_true(hash128_is_equal(one, fingerprint(3, "sse2", irradiance_estimate_find)));
}

/* Count calls of without_surfaces, those that give another value, and how far the map's own estimates hold. */
static int calls, at_rims, of_extent[IRRADIANCE_HOLDS_EVERYWHERE + 1];

/* The estimate of irradiance, brighter by one unit in the last place. */
static irradiance_extent brighter(const photon_map *map, vec3 position, vec3 normal, photon_neighbor *scratch,
                                  uint64_t *in_out_rays, rgb *out)
{
    irradiance_extent extent = irradiance_estimate_find(map, position, normal, scratch, in_out_rays, out);
    out->g = nextafterf(out->g, INFINITY);
    return extent;
}

/* A photon less in each estimate. */
static irradiance_extent of_fewer(const photon_map *map, vec3 position, vec3 normal, photon_neighbor *scratch,
                                  uint64_t *in_out_rays, rgb *out)
{
    photon_map other = *map;
    other.nearest--;
    return irradiance_estimate_find(&other, position, normal, scratch, in_out_rays, out);
}

/* Blind to where surfaces end: what lies in the open stays as it is. */
static irradiance_extent without_surfaces(const photon_map *map, vec3 position, vec3 normal, photon_neighbor *scratch,
                                          uint64_t *in_out_rays, rgb *out)
{
    photon_map other = *map;
    rgb with;
    other.surfaces = NULL;
    of_extent[irradiance_estimate_find(map, position, normal, scratch, in_out_rays, &with)]++;
    irradiance_extent extent = irradiance_estimate_find(&other, position, normal, scratch, in_out_rays, out);
    calls++;
    at_rims += map->surfaces && memcmp(&with, out, sizeof with) != 0;
    return extent;
}

/* An estimate with the map's own values that says they hold everywhere. */
static irradiance_extent sure(const photon_map *map, vec3 position, vec3 normal, photon_neighbor *scratch,
                              uint64_t *in_out_rays, rgb *out)
{
    irradiance_estimate_find(map, position, normal, scratch, in_out_rays, out);
    return IRRADIANCE_HOLDS_EVERYWHERE;
}

static void depends_on_the_estimate(void **state)
{
    (void)state;
    static irradiance_estimate_fn *const OTHERS[] = {brighter, of_fewer, without_surfaces, sure};
    hash128 one = fingerprint(1, "avx2", irradiance_estimate_find);
    for (size_t i = 0; i < sizeof OTHERS / sizeof *OTHERS; i++)
        if (hash128_is_equal(one, fingerprint(1, "avx2", OTHERS[i])))
            fail_msg("the fingerprint does not tell estimate %zu from ours", i);
    assert_true(at_rims > calls / 16); /* at many points, and not at all of them */
    assert_true(at_rims < calls / 2);
    for (int i = 0; i <= IRRADIANCE_HOLDS_EVERYWHERE; i++)
        assert_true(of_extent[i] > calls / 64); /* rules that are never met would not be in the fingerprint */
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(same_for_threads_and_isas),
                                       cmocka_unit_test(depends_on_the_estimate)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
