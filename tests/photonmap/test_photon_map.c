/* test_photon_map.c: density estimates where the answer is known, and the slots' irradiance.
 * In an even field the mean of the estimates is right, at any point and asked for through the nearest photon, where the
 * estimate counts k photons and divides by the area out to the next one.
 * Threads: the map's build. */
#include "fixtures/photon_field.h"

/* The mean over many points, against the truth; photons and points are as many as it takes to see `tolerance`. */
static void expect_mean(field_kind kind, uint32_t nearest, uint32_t photons, uint32_t points, int seeds, bool is_cached,
                        double tolerance)
{
    test_run r;
    test_run_init(&r, 1);
    double mean[3] = {0.0, 0.0, 0.0};
    photons /= FEWER;
    points /= FEWER;
    for (int seed = 0; seed < seeds; seed++) {
        photon_set set = field_photons(kind, photons, (uint64_t)(1000 * seed) + nearest);
        photon_map map = field_map(&r, &set, nearest, kind == FIELD_SPHERE ? FIELD_SPHERE_RADIUS : 0.15f);
        irradiance_cache cache;
        assert_int_equal(
            irradiance_cache_create(&map, is_cached ? IRRADIANCE_ON_DEMAND : IRRADIANCE_UNCACHED, 1, &cache), AG_OK);
        for (uint32_t i = 0; i < points; i++) {
            /* well-spread points, from two irrational steps (Roberts's R2) */
            double x = i * 0.7548776662466927, y = i * 0.5698402909980532;
            field_point at = field_point_at(kind, (vec2){(float)(x - floor(x)), (float)(y - floor(y))});
            irradiance_request request;
            irradiance_cache_get(&cache, at.position, at.normal, 0, &request);
            assert_int_equal(request.irradiance_photon, PHOTON_NONE);
            mean[0] += request.irradiance.r;
            mean[1] += request.irradiance.g;
            mean[2] += request.irradiance.b;
        }
        /* all were answered in the way that is meant */
        irradiance_counters c = irradiance_cache_counters(&cache);
        assert_int_equal(c.requests, points);
        if (is_cached)
            assert_true(c.uncached <= 2 + points / 1000); /* so many have no photon near by, by chance */
        else
            assert_int_equal(c.computed, 0);
        irradiance_cache_reset(&cache);
        photon_map_reset(&map);
    }
    test_run_reset(&r);
    double expected = field_irradiance(kind), share = 1.0 / ((double)points * seeds);
    print_message("%s, %3u nearest, %s: %+.3f %%\n", kind == FIELD_SPHERE ? "sphere" : "plane", nearest,
                  is_cached ? "cached" : "at the point", 100.0 * (mean[0] * share / FIELD_FLUX.r / expected - 1.0));
    assert_relative(mean[0] * share, expected * FIELD_FLUX.r, tolerance * WIDER);
    assert_relative(mean[1] * share, expected * FIELD_FLUX.g, tolerance * WIDER);
    assert_relative(mean[2] * share, expected * FIELD_FLUX.b, 1.5 * tolerance * WIDER);
}

static void the_mean_at_any_point_is_right(void **state)
{
    (void)state;
    expect_mean(FIELD_PLANE, 20, 60000, 40000, 1, false, 3e-3);
    expect_mean(FIELD_PLANE, 50, 60000, 15000, 1, false, 3e-3);
    expect_mean(FIELD_SPHERE, 20, 60000, 40000, 1, false, 3e-3);
    expect_mean(FIELD_SPHERE, 300, 60000, 4000, 1, false, 3e-3);
    expect_mean(FIELD_SPHERE, 5, 60000, 60000, 1, false, 5e-3);
}

static void the_mean_through_the_nearest_photon_is_right(void **state)
{
    (void)state;
    expect_mean(FIELD_SPHERE, 20, 100000, 150000, 1, true, 3e-3);
    expect_mean(FIELD_SPHERE, 50, 50000, 80000, 1, true, 3e-3);
    expect_mean(FIELD_SPHERE, 300, 25000, 40000, 1, true, 3e-3);
    expect_mean(FIELD_PLANE, 20, 60000, 100000, 1, true, 3e-3);
}

/* An even field of which one half has a tenth of the photons, each ten times as bright: beside the border estimates are
 * right on average, although there are more photons on one side. */
static void thinned_photons_give_the_same_light(void **state)
{
    (void)state;
    enum { MAPS = 40 / (FEWER > 1 ? 4 : 1), FIELD = 30000, ASKED = 3000 };
    test_run r;
    test_run_init(&r, 1);
    double sum = 0.0, squares = 0.0;
    for (int m = 0; m < MAPS; m++) {
        photon_set set = field_photons(FIELD_PLANE, FIELD, 77u + (unsigned)m);
        rng random = test_random(500u + (unsigned)m);
        uint32_t kept = 0;
        for (uint32_t i = 0; i < set.count; i++) {
            photon p = set.photons[i];
            float u = rng_float(&random);
            if (p.position[0] > 0.5f && u > 0.1f)
                continue;
            if (p.position[0] > 0.5f)
                p.flux = flux_encode(rgb_scale(flux_decode(p.flux), 10.0f), rng_next(&random));
            set.photons[kept++] = p;
        }
        set.count = kept;
        photon_map map = field_map(&r, &set, 50, 0.15f);
        photon_neighbor *scratch = malloc(photon_map_scratch_count(&map) * sizeof *scratch);
        double mean = 0.0;
        for (int i = 0; i < ASKED; i++) {
            vec3 at = random_in_box(&random, (vec3){0.45f, 0.0f, 0.0f}, (vec3){0.57f, 1.0f, 0.0f});
            mean += (double)irradiance_estimate(&map, at, (vec3){0.0f, 0.0f, 1.0f}, scratch).r / ASKED;
        }
        sum += mean / MAPS;
        squares += mean * mean / MAPS;
        free(scratch);
        photon_map_reset(&map);
    }
    double error = sqrt((squares - sum * sum) / (MAPS - 1));
    print_message("beside thinned photons: %+.2f %% +- %.2f %%\n", 100.0 * (sum / (double)FIELD_FLUX.r - 1.0),
                  100.0 * error / (double)FIELD_FLUX.r);
    assert_close(sum, (double)FIELD_FLUX.r, 0.005 * (double)FIELD_FLUX.r + 3.0 * error);
    test_run_reset(&r);
}

/* --- single estimates --- */

static photon_set few_photons(uint32_t count)
{
    photon_set set = {.emitted_paths = 1};
    set.photons = photon_records_create(count);
    assert_non_null(set.photons);
    return set;
}

static void an_estimate_counts_k_and_reaches_to_the_next(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    photon_set set = few_photons(10);
    vec3 up = {0.0f, 0.0f, 1.0f};
    for (int i = 1; i <= 10; i++) /* at distances 1 to 10; flux 128 i, which is exact */
        field_add(&set, (vec3){(float)i, 0.0f, 0.0f}, up, flux_encode(rgb_gray(128.0f), 0));
    photon_map map = field_map(&r, &set, 4, 7.5f);
    photon_neighbor *scratch = malloc(photon_map_scratch_count(&map) * sizeof *scratch);
    rgb e = irradiance_estimate(&map, (vec3){0.0f, 0.0f, 0.0f}, up, scratch);
    assert_relative(e.r, 4 * 128.0 / (PI * 25.0), 1e-6);
    /* where fewer are in reach: their flux over the whole disc */
    e = irradiance_estimate(&map, (vec3){-4.0f, 0.0f, 0.0f}, up, scratch);
    assert_relative(e.r, 3 * 128.0 / (PI * 7.5 * 7.5), 1e-6);
    /* exactly k: the same */
    e = irradiance_estimate(&map, (vec3){-3.0f, 0.0f, 0.0f}, up, scratch);
    assert_relative(e.r, 4 * 128.0 / (PI * 7.5 * 7.5), 1e-6);
    /* out of reach, and on the other side */
    assert_true(rgb_is_black(irradiance_estimate(&map, (vec3){-40.0f, 0.0f, 0.0f}, up, scratch)));
    assert_true(rgb_is_black(irradiance_estimate(&map, (vec3){0.0f, 0.0f, 0.0f}, vec3_negate(up), scratch)));
    free(scratch);
    photon_map_reset(&map);
    test_run_reset(&r);
}

static void coincident_photons_give_finite_values(void **state)
{
    (void)state;
    enum { COUNT = 1000, NEAREST = 50 };
    test_run r;
    test_run_init(&r, 2);
    photon_set set = few_photons(COUNT);
    vec3 up = {0.0f, 0.0f, 1.0f}, at = {0.3f, 0.4f, 0.5f};
    for (int i = 0; i < COUNT; i++)
        field_add(&set, at, up, flux_encode(rgb_gray(128.0f), (uint64_t)i));
    photon_map map = field_map(&r, &set, NEAREST, 0.5f);
    photon_neighbor *scratch = malloc(photon_map_scratch_count(&map) * sizeof *scratch);
    rgb e = irradiance_estimate(&map, at, up, scratch);
    assert_true(rgb_is_finite(e));
    assert_relative(e.g, NEAREST * 128.0 / (PI * (double)map.min_radius_squared), 1e-5);
    /* a slot can hold so large a value */
    rgb kept = photon_map_decode_irradiance(&map, photon_map_encode_irradiance(&map, e, 7));
    assert_relative(kept.g, e.g, 1 / 127.0);
    free(scratch);
    photon_map_reset(&map);
    test_run_reset(&r);
}

/* A caustic behind a small glass in a large scene: a hundred-thousandth of the largest disc. */
static void a_very_small_disc_is_not_enlarged(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    photon_set set = few_photons(10);
    vec3 up = {0.0f, 0.0f, 1.0f};
    for (int i = 1; i <= 10; i++)
        field_add(&set, (vec3){1e-5f * (float)i, 0.0f, 0.0f}, up, flux_encode(rgb_gray(128.0f), 0));
    photon_map map = field_map(&r, &set, 4, 1.0f);
    photon_neighbor *scratch = malloc(photon_map_scratch_count(&map) * sizeof *scratch);
    rgb e = irradiance_estimate(&map, (vec3){0.0f, 0.0f, 0.0f}, up, scratch);
    assert_relative(e.r, 4 * 128.0 / (PI * 25e-10), 1e-5);
    free(scratch);
    photon_map_reset(&map);
    test_run_reset(&r);
}

/* All photons lie on a thousandth of the scene's surface: what is dark does not enlarge the discs. */
static void dark_surface_does_not_count_for_the_radius(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    float mean[2];
    for (int i = 0; i < 2; i++) {
        photon_set set = field_photons(FIELD_SPHERE, 20000, 5);
        photon_map map;
        photon_map_settings settings = {.nearest = 50, .surface_area = 4.0f * AG_PI * (i == 0 ? 1.0f : 1000.0f)};
        assert_int_equal(photon_map_create(&r.run, &set, &settings, 0.0, 1.0, &map), AG_OK);
        mean[i] = map.mean_radius;
        assert_relative(map.max_radius, 4.0f * map.mean_radius, 1e-6);
        photon_map_reset(&map);
    }
    assert_relative(mean[0], sqrt(50.0 * 4.0 / 20000), 1e-5);
    assert_relative(mean[1], 4.0 * (double)mean[0], 0.05);
    test_run_reset(&r);
}

static void the_order_of_the_photons_does_not_matter(void **state)
{
    (void)state;
    enum { COUNT = 20000 };
    test_run r;
    test_run_init(&r, 2);
    photon_set a = field_photons(FIELD_SPHERE, COUNT, 3), b = field_photons(FIELD_SPHERE, COUNT, 3);
    rng random = test_random(8);
    for (uint32_t i = 0; i < COUNT; i++) { /* unequal photons, so that sums would show their order */
        rgb flux = {rng_float(&random), ldexpf(1.0f, -(int)(rng_next(&random) % 20)), rng_float(&random)};
        a.photons[i].flux = b.photons[i].flux = flux_encode(flux, i);
    }
    for (uint32_t i = COUNT - 1; i > 0; i--) {
        uint32_t j = (uint32_t)(rng_next(&random) % (i + 1));
        photon hold;
        memcpy(&hold, &b.photons[i], sizeof hold);
        memcpy(&b.photons[i], &b.photons[j], sizeof hold);
        memcpy(&b.photons[j], &hold, sizeof hold);
    }
    photon_map map_a = field_map(&r, &a, 50, 1.0f), map_b = field_map(&r, &b, 50, 1.0f);
    photon_neighbor *scratch = malloc(photon_map_scratch_count(&map_a) * sizeof *scratch);
    for (int i = 0; i < 500; i++) {
        field_point at = field_point_at(FIELD_SPHERE, rng_vec2(&random));
        rgb x = irradiance_estimate(&map_a, at.position, at.normal, scratch);
        rgb y = irradiance_estimate(&map_b, at.position, at.normal, scratch);
        assert_memory_equal(&x, &y, sizeof x);
        assert_true(x.r > 0.0f);
    }
    free(scratch);
    photon_map_reset(&map_a);
    photon_map_reset(&map_b);
    test_run_reset(&r);
}

static void a_wall_keeps_its_two_sides_apart(void **state)
{
    uint64_t rays = 0;
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    photon_set set = few_photons(2000);
    rng random = test_random(4);
    vec3 up = {0.0f, 0.0f, 1.0f};
    for (int i = 0; i < 2000; i++) {
        bool front = i % 2;
        vec3 p = {rng_float(&random), rng_float(&random), front ? 0.001f : 0.0f};
        field_add(&set, p, front ? up : vec3_negate(up), flux_encode(front ? rgb_gray(1.0f) : rgb_gray(100.0f), 0));
    }
    photon_map map = field_map(&r, &set, 100, 0.4f);
    photon_neighbor *scratch = malloc(photon_map_scratch_count(&map) * sizeof *scratch);
    vec3 middle = {0.5f, 0.5f, 0.0f};
    assert_relative(irradiance_estimate(&map, middle, up, scratch).r, 1000.0, 0.3);
    assert_relative(irradiance_estimate(&map, middle, vec3_negate(up), scratch).r, 100000.0, 0.3);
    uint32_t front = photon_map_nearest(&map, middle, up, &rays),
             back = photon_map_nearest(&map, middle, vec3_negate(up), &rays);
    assert_true(direction_decode(photon_block_normal(map.blocks, front)).z > 0.9f);
    assert_true(direction_decode(photon_block_normal(map.blocks, back)).z < -0.9f);
    free(scratch);
    photon_map_reset(&map);
    test_run_reset(&r);
}

static void a_map_without_photons_is_dark(void **state)
{
    uint64_t rays = 0;
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    photon_set none = {0};
    photon_map map = field_map(&r, &none, 50, 0.0f);
    photon_neighbor *scratch = malloc(photon_map_scratch_count(&map) * sizeof *scratch);
    assert_non_null(scratch);
    vec3 at = {0.0f, 0.0f, 0.0f}, up = {0.0f, 0.0f, 1.0f};
    assert_true(rgb_is_black(irradiance_estimate(&map, at, up, scratch)));
    assert_int_equal(photon_map_nearest(&map, at, up, &rays), PHOTON_NONE);
    assert_int_equal(photon_map_bytes(&map), 0);
    free(scratch);
    photon_map_reset(&map);
    test_run_reset(&r);
}

static void the_automatic_radius_and_the_size(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 2);
    photon_set set = field_photons(FIELD_SPHERE, 10000, 1);
    photon_map map = field_map(&r, &set, 50, 0.0f);
    /* 50 photons lie in this disc on average */
    assert_relative(10000.0 / (4.0 * PI) * PI * (double)map.mean_radius * (double)map.mean_radius, 50.0, 1e-5);
    assert_true(map.max_radius >= 2.0f * map.mean_radius);
    assert_true(photon_map_bytes(&map) >= 24 * 10000 && photon_map_bytes(&map) <= 28 * 10000);
    photon_map_reset(&map);
    /* a photon's irradiance stands for nothing beyond the largest radius */
    set = field_photons(FIELD_SPHERE, 100, 1);
    map = field_map(&r, &set, 50, 0.1f);
    assert_true(map.mean_radius <= 0.1f);
    photon_map_reset(&map);
    test_run_reset(&r);
}

/* --- the slot's 30 bits --- */

static void expect_unbiased(const photon_map *map, rgb value)
{
    const uint32_t count = (1 << 22) / FEWER;
    double sum[3] = {0.0, 0.0, 0.0};
    for (uint32_t i = 0; i < count; i++) {
        uint32_t code = photon_map_encode_irradiance(map, value, i);
        assert_true((code & ~IRRADIANCE_VALUE_MASK) == 0);
        rgb v = photon_map_decode_irradiance(map, code);
        sum[0] += v.r, sum[1] += v.g, sum[2] += v.b;
    }
    assert_relative(sum[0] / count, value.r, 1e-3 * WIDER);
    assert_relative(sum[1] / count, value.g, 1e-3 * WIDER);
    assert_relative(sum[2] / count, value.b, 1e-3 * WIDER);
}

static void irradiance_survives_without_bias(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    photon_set set = field_photons(FIELD_SPHERE, 1000, 1);
    photon_map map = field_map(&r, &set, 50, 0.0f);
    expect_unbiased(&map, (rgb){0.8f, 0.0801f, 0.0079f});
    expect_unbiased(&map, (rgb){0.0213f, 3.7f, 1.1f});
    /* one photon on the largest disc, and all of an estimate on the smallest one */
    double one = (double)FIELD_FLUX.r / 1000.0 / (PI * (double)map.max_radius * (double)map.max_radius);
    double all = (double)FIELD_FLUX.r / 1000.0 * 51.0 / (PI * (double)map.min_radius_squared);
    for (double v = one; v <= all; v *= 1.37) {
        rgb value = {(float)v, (float)(0.3 * v), 0.0f};
        rgb back = photon_map_decode_irradiance(&map, photon_map_encode_irradiance(&map, value, 3));
        assert_relative(back.r, v, 1 / 127.0);
        assert_close(back.g, 0.3 * v, v / 127.0);
        assert_true(back.b == 0.0f);
    }
    assert_true(
        rgb_is_black(photon_map_decode_irradiance(&map, photon_map_encode_irradiance(&map, rgb_gray(0.0f), 1))));
    photon_map_reset(&map);
    test_run_reset(&r);
}

/* Where photons lie farther apart than the mean tells, most points still have one that stands for them, and what they
 * are told is right on average. */
static void in_the_dark_the_nearest_photon_is_farther(void **state)
{
    (void)state;
    enum { COUNT = 2000, MAPS = 60 / (FEWER > 1 ? 6 : 1), POINTS = 4000 / (FEWER > 1 ? 4 : 1) };
    test_run r;
    test_run_init(&r, 2);
    /* eight photons in the largest disc, half a one in the mean's */
    const double radius = sqrt(8.0 * 4.0 / COUNT);
    double mean = 0.0, uncached = 0.0;
    for (int m = 0; m < MAPS; m++) {
        photon_set set = field_photons(FIELD_SPHERE, COUNT, (uint64_t)m);
        photon_map map;
        photon_map_settings settings = {.nearest = 50,
                                        .max_radius = (float)radius,
                                        .surface_area = (float)(COUNT * PI * radius * radius / 16.0 / 50.0)};
        assert_int_equal(photon_map_create(&r.run, &set, &settings, 0.0, 1.0, &map), AG_OK);
        assert_relative(map.mean_radius, radius / 4.0, 1e-4);
        irradiance_cache cache;
        assert_int_equal(irradiance_cache_create(&map, IRRADIANCE_ON_DEMAND, 1, &cache), AG_OK);
        rng random = test_random((uint64_t)(500 + m));
        for (int i = 0; i < POINTS; i++) {
            irradiance_request request;
            field_point at = field_point_at(FIELD_SPHERE, rng_vec2(&random));
            irradiance_cache_get(&cache, at.position, at.normal, 0, &request);
            mean += (double)request.irradiance.r / (MAPS * (double)POINTS);
        }
        uncached += (double)irradiance_cache_counters(&cache).uncached / (MAPS * (double)POINTS);
        irradiance_cache_reset(&cache);
        photon_map_reset(&map);
    }
    double expected = (double)FIELD_FLUX.r * field_irradiance(FIELD_SPHERE);
    print_message("in the dark: %+.2f %%, %.1f %% of the points without a photon\n", 100.0 * (mean / expected - 1.0),
                  100.0 * uncached);
    assert_relative(mean, expected, 0.01 * WIDER);
    assert_true(fabs(uncached - exp(-2.0)) < 0.02 * WIDER);
    test_run_reset(&r);
}

/* A ball does not hide a photon of its own whose normal is similar; a wall does. */
static void a_ball_is_no_wall(void **state)
{
    uint64_t rays = 0;
    (void)state;
    static const char *const WORLDS[] = {"Shape \"sphere\" \"float radius\" 1",
                                         "Shape \"sphere\" \"float radius\" 1 "
                                         "Shape \"bilinearmesh\" \"point3 P\" [0.17 -1 0 0.17 1 0 0.17 -1 2 0.17 1 2]"};
    for (int i = 0; i < 2; i++) {
        test_run r;
        test_run_init(&r, 1);
        scene *s = test_scene_create(&r, WORLDS[i]);
        photon_set set = few_photons(1);
        vec3 up = {0.0f, 0.0f, 1.0f}, aside = {sinf(0.4f), 0.0f, cosf(0.4f)};
        field_add(&set, up, up, flux_encode(rgb_gray(128.0f), 0));
        photon_map_settings settings = {.nearest = 1, .max_radius = 1.0f, .surface_area = 0.02f, .surfaces = s};
        photon_map map;
        assert_int_equal(photon_map_create(&r.run, &set, &settings, 0.0, 1.0, &map), AG_OK);
        assert_int_equal(photon_map_nearest(&map, aside, aside, &rays), i == 0 ? 0 : PHOTON_HIDDEN);
        assert_int_equal(rays, i == 0 ? 2 : 3); /* two past the ball, and one, to the wall */
        photon_map_reset(&map);
        scene_destroy(s);
        test_run_reset(&r);
    }
}

static hash128 hash_of(const photon_map *map)
{
    hash128 hash = hash128_begin();
    photon_map_add_hash(map, &hash);
    return hash;
}

/* The last photon of a map of 1003, and the last irradiance photon, in every column; not slots, nor unused lanes. */
static void the_hash_has_all_of_a_photon_but_its_irradiance(void **state)
{
    (void)state;
    enum { COUNT = 1003 };
    static const size_t COLUMNS[] = {offsetof(photon_block, position[0]), offsetof(photon_block, position[1]),
                                     offsetof(photon_block, position[2]), offsetof(photon_block, flux),
                                     offsetof(photon_block, direction),   offsetof(photon_block, normal),
                                     offsetof(photon_block, slot)};
    static const size_t SIZES[] = {4, 4, 4, 4, 2, 2, 4};
    test_run r;
    test_run_init(&r, 1);
    photon_set set = field_photons(FIELD_SPHERE, COUNT, 3);
    photon_map_settings settings = {.nearest = 20, .surface_area = 4.0f * AG_PI, .irradiance_fraction = 0.3f};
    photon_map map;
    assert_int_equal(photon_map_create(&r.run, &set, &settings, 0.0, 1.0, &map), AG_OK);
    assert_false(photon_map_all_have_irradiance(&map));
    const hash128 whole = hash_of(&map);
    const struct {
        photon_block *blocks;
        uint32_t count;
    } lists[] = {{map.blocks, map.set.count}, {map.irradiance_photons.blocks, map.irradiance_photons.count}};
    for (size_t list = 0; list < 2; list++)
        for (size_t column = 0; column < sizeof COLUMNS / sizeof *COLUMNS; column++)
            for (uint32_t past = 0; past < 2; past++) {
                const uint32_t index = lists[list].count - 1 + past, lane = index % PHOTON_BLOCK_LANES;
                if (past && lane == 0)
                    continue; /* the last block is full */
                unsigned char *byte = (unsigned char *)&lists[list].blocks[index / PHOTON_BLOCK_LANES] +
                                      COLUMNS[column] + lane * SIZES[column];
                const bool is_counted = !past && COLUMNS[column] != offsetof(photon_block, slot);
                *byte ^= 1;
                assert_int_equal(hash128_is_equal(hash_of(&map), whole), !is_counted);
                *byte ^= 1;
            }
    map.set.emitted_paths++;
    assert_false(hash128_is_equal(hash_of(&map), whole));
    photon_map_reset(&map);
    const photon_map none = {0};
    assert_false(hash128_is_equal(hash_of(&none), whole));
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_mean_at_any_point_is_right),
        cmocka_unit_test(the_mean_through_the_nearest_photon_is_right),
        cmocka_unit_test(thinned_photons_give_the_same_light),
        cmocka_unit_test(an_estimate_counts_k_and_reaches_to_the_next),
        cmocka_unit_test(coincident_photons_give_finite_values),
        cmocka_unit_test(a_very_small_disc_is_not_enlarged),
        cmocka_unit_test(dark_surface_does_not_count_for_the_radius),
        cmocka_unit_test(the_order_of_the_photons_does_not_matter),
        cmocka_unit_test(a_wall_keeps_its_two_sides_apart),
        cmocka_unit_test(a_map_without_photons_is_dark),
        cmocka_unit_test(the_automatic_radius_and_the_size),
        cmocka_unit_test(in_the_dark_the_nearest_photon_is_farther),
        cmocka_unit_test(a_ball_is_no_wall),
        cmocka_unit_test(irradiance_survives_without_bias),
        cmocka_unit_test(the_hash_has_all_of_a_photon_but_its_irradiance),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
