/* test_final_gather.c: gather rays under a hemisphere whose irradiance is known, and eye paths that end in them.
 * Photons lie evenly over the unit sphere, E W/m^2; what reflects rho shows rho E / pi, so a point in it receives rho
 * E, and one that reflects sigma shows sigma rho E / pi. The field has noise of its own: of N photons half lie in the
 * hemisphere, weighted by 2 cos, so that what is gathered has a standard deviation of sqrt(8 / 3 / N) however many rays
 * there are. Threads: one. */
#include "fixtures/eye_fixture.h"

#include "integrator/final_gather.h"
#include "integrator/gather_path.h"
#include "integrator/shading.h"

enum { PHOTONS = 200000 / FEWER, NEAREST = 50, GATHERS = 400, RAYS = 64, SAMPLES = 400 };

#define DOME                                                                                                           \
    "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5] ReverseOrientation Shape \"sphere\" \"float radius\" 1 "
#define SHINING_DOME "AreaLightSource \"diffuse\" \"rgb L\" [2 2 2] " DOME
#define PLATE                                                                                                          \
    "Material \"diffuse\" \"rgb reflectance\" [0.8 0.8 0.8] ReverseOrientation Shape \"disk\" \"float radius\" 0.05 "

static double dome_irradiance(void) { return (double)FIELD_FLUX.r * field_irradiance(FIELD_SPHERE); }

/* Three standard deviations of the field, and half a percent for the blur. */
static double field_bound(void) { return 0.005 + 3.0 * sqrt(8.0 / 3.0 / PHOTONS); }

/* Casts the gather rays of a vertex that the eye meets first. Returns their cost. */
static uint32_t gather_at(eye *e, const vertex *v, const sampler *where, int scatterings_left, uint32_t count,
                          float throughput)
{
    gather_request request = {.from = v,
                              .where = where,
                              .is_first = true,
                              .scatterings_left = scatterings_left,
                              .count = count,
                              .throughput = rgb_gray(throughput),
                              .share = 1.0f};
    return final_gather(&e->t, e->worker, &request);
}

static void take_gathered(eye *e, mean_sum *sum, bool is_first)
{
    final_gather_resolve(&e->t, e->worker);
    gathered_light *g = &e->worker->batch->gathered[0];
    mean_add(sum, (double)(is_first ? g->first : g->behind).r);
    assert_true(rgb_is_black(is_first ? g->behind : g->first));
    *g = (gathered_light){0};
}

static camera_sample camera_sample_of(uint32_t i, vec3 position, vec3 direction)
{
    return (camera_sample){.ray = scene_ray_make(position, direction),
                           .where = sampler_make(i, 3, 4, 0, 0),
                           .split = {.rays = RAYS, .lights = 1}};
}

/* A plate in the middle of the sphere gathers from the half above it. */
static void plate_under_a_dome(void **state)
{
    (void)state;
    static const uint32_t COUNTS[] = {1, 7, RAYS};
    eye e;
    eye_init_with_photons(&e, DOME PLATE, PHOTONS, NEAREST);
    vertex v = eye_meet(&e, (vec3){0.0f, 0.0f, 0.5f}, (vec3){0.0f, 0.0f, -1.0f});
    for (size_t k = 0; k < sizeof COUNTS / sizeof *COUNTS; k++) {
        mean_sum sum = {0};
        for (uint32_t i = 0; i < GATHERS * RAYS / COUNTS[k]; i++) {
            sampler where = sampler_make(i, 3, 4, 0, 0);
            assert_true(gather_at(&e, &v, &where, 100, COUNTS[k], 0.25f) >= COUNTS[k] * (uint32_t)EYE_COST_OF_RAY);
            take_gathered(&e, &sum, true);
        }
        assert_mean(&sum, 0.25 * 0.8 * 0.5 * dome_irradiance() / PI, field_bound());
    }
    irradiance_counters c = irradiance_cache_counters(&e.cache);
    assert_true(c.requests >= 3 * GATHERS * RAYS * 9 / 10);
    assert_true(c.computed > 0 && c.computed <= PHOTONS);
    assert_int_equal(c.duplicated, 0);
    eye_reset(&e);
}

/* An eye in the sphere: its wall gathers from the rest of it. With too few scatterings nothing may be gathered: light
 * from the lamp by way of a photon has met the wall that the ray meets, too. */
static void wall_of_a_sphere(void **state)
{
    (void)state;
    eye e;
    eye_init_with_photons(&e, DOME, PHOTONS, NEAREST);
    e.t.ray_bits = sampler_bits(RAYS);
    for (int most = 0; most <= 100; most += most < 2 ? 1 : 98) {
        e.settings.max_depth = most;
        mean_sum sum = {0};
        for (uint32_t i = 0; i < SAMPLES; i++) {
            rng random = test_random(i);
            eye_sample s = {.most_direct = INFINITY, .most_indirect = INFINITY};
            camera_sample from = camera_sample_of(i, (vec3){0.2f, 0.0f, 0.0f}, random_direction(&random));
            shading_radiance(&e.t, e.worker, &from, &s);
            assert_true(rgb_is_black(s.radiance)); /* no lamp, no caustic */
            take_gathered(&e, &sum, true);
        }
        assert_mean(&sum, most < 2 ? 0.0 : 0.25 * dome_irradiance() / PI, field_bound());
    }
    eye_reset(&e);
}

/* In a mirror the same light is of the second kind, however little the mirror reflects. It takes what it does not
 * reflect of the gather rays that meet it. */
static void check_wall_in_a_mirror(double reflectance)
{
    const double covered = 0.2 * 0.2 / (1.0 + 0.2 * 0.2); /* the mirror's share of them */
    char text[400];
    snprintf(text, sizeof text,
             DOME "Material \"conductor\" \"float roughness\" 0 \"rgb reflectance\" [%g %g %g]"
                  " ReverseOrientation Shape \"disk\" \"float radius\" 0.2",
             reflectance, reflectance, reflectance);
    eye e;
    eye_init_with_photons(&e, text, PHOTONS, NEAREST);
    e.t.ray_bits = sampler_bits(RAYS);
    mean_sum sum = {0};
    for (uint32_t i = 0; i < SAMPLES; i++) {
        rng random = test_random(i);
        vec3 at = {0.1f * rng_float(&random), 0.0f, 0.6f};
        eye_sample s = {.most_direct = INFINITY, .most_indirect = INFINITY};
        camera_sample from = camera_sample_of(i, at, (vec3){0.0f, 0.0f, -1.0f});
        shading_radiance(&e.t, e.worker, &from, &s);
        take_gathered(&e, &sum, false);
    }
    assert_mean(&sum, reflectance * (1.0 - (1.0 - reflectance) * covered) * 0.25 * dome_irradiance() / PI,
                field_bound());
    eye_reset(&e);
}

static void wall_in_a_mirror(void **state)
{
    (void)state;
    check_wall_in_a_mirror(1.0);
    check_wall_in_a_mirror(0.02);
}

/* A dome of cloth, which lets 0.2 through, and no light comes from outside: each single ray brings what is inside, with
 * the field's noise alone. If it asked one side by chance, it would bring all or nothing. */
static void ray_asks_both_sides_of_a_cloth(void **state)
{
    (void)state;
    eye e;
    eye_init_with_photons(&e,
                          "Material \"diffusetransmission\" \"rgb reflectance\" [0.3 0.3 0.3]"
                          " \"rgb transmittance\" [0.2 0.2 0.2] ReverseOrientation"
                          " Shape \"sphere\" \"float radius\" 1 " PLATE,
                          PHOTONS, NEAREST);
    vertex v = eye_meet(&e, (vec3){0.0f, 0.0f, 0.5f}, (vec3){0.0f, 0.0f, -1.0f});
    mean_sum sum = {0};
    double squares = 0.0, radiance = 0.8 * 0.3 * dome_irradiance() / PI;
    for (uint32_t i = 0; i < GATHERS * RAYS; i++) {
        sampler where = sampler_make(i, 3, 4, 0, 0);
        gather_at(&e, &v, &where, 100, 1, 1.0f);
        final_gather_resolve(&e.t, e.worker);
        double brought = (double)e.worker->batch->gathered[0].first.r;
        mean_add(&sum, brought);
        squares += (brought - radiance) * (brought - radiance) / (GATHERS * RAYS);
        e.worker->batch->gathered[0] = (gathered_light){0};
    }
    assert_mean(&sum, radiance, field_bound());
    assert_true(squares < 2.0 / NEAREST * radiance * radiance); /* of k nearest photons the share 1 / k */
    eye_reset(&e);
}

/* In a closed sphere that shines L inward and reflects rho, light after k scatterings is L rho^k. With an infinite
 * distance to the cache gather rays bounce until they end: n scatterings bring k = 2 to n. */
static void bounces_in_a_shining_sphere(void **state)
{
    (void)state;
    static const int LEFT[] = {2, 3, 100};
    eye e;
    eye_init_with_photons(&e, SHINING_DOME, NEAREST, NEAREST);
    e.t.gather_min_distance = INFINITY;
    vertex v = eye_meet(&e, (vec3){0.2f, 0.0f, 0.0f}, (vec3){0.0f, 0.0f, -1.0f});
    for (size_t k = 0; k < sizeof LEFT / sizeof *LEFT; k++) {
        mean_sum sum = {0};
        for (uint32_t i = 0; i < GATHERS; i++) {
            sampler where = sampler_make(i, 3, 4, 0, 0);
            gather_at(&e, &v, &where, LEFT[k], RAYS, 1.0f);
            take_gathered(&e, &sum, true);
        }
        double expected = 2.0 * (0.25 - pow(0.5, LEFT[k] + 1)) / 0.5;
        assert_mean(&sum, expected, 1e-3);
    }
    eye_reset(&e);
}

/* Returns what bounces from a white end with weight rho / pi bring until they end. */
static double bounce_on(eye *e, vec3 position, int scatterings_left, uint32_t number)
{
    gather_end end = {{position, {0.0f, 0.0f, 1.0f}, 1e-4f}, SCENE_NO_MEDIUM, scatterings_left};
    rgb weight = rgb_gray(0.5f * AG_INV_PI), known = rgb_gray(0.0f);
    for (uint64_t bounce = 0;
         gather_path_bounce(&e->t, e->worker, rng_make(1, bounce, number), 1.0f, &end, &weight, &known); bounce++) {
    }
    return (double)known.g;
}

/* Bounces from places where no estimate holds: in a sphere that shines, and on a floor under a sky, from which every
 * bounce escapes. */
static void bounces_where_no_estimate_holds(void **state)
{
    (void)state;
    static const int LEFT[] = {1, 2, 3, 100};
    eye sphere, floor;
    eye_init_with_photons(&sphere, SHINING_DOME, NEAREST, NEAREST);
    eye_init_with_photons(&floor, "Shape \"disk\" \"float radius\" 9 LightSource \"infinite\" \"rgb L\" [2 2 2]",
                          NEAREST, NEAREST);
    for (size_t k = 0; k < sizeof LEFT / sizeof *LEFT; k++) {
        mean_sum in_sphere = {0}, on_floor = {0};
        for (uint32_t i = 0; i < GATHERS * RAYS; i++) {
            mean_add(&in_sphere, bounce_on(&sphere, (vec3){0.0f, 0.0f, -0.999f}, LEFT[k], i));
            mean_add(&on_floor, bounce_on(&floor, (vec3){0.0f, 0.0f, 0.0f}, LEFT[k], i));
        }
        assert_mean(&in_sphere, 2.0 * (0.5 - pow(0.5, LEFT[k] + 1)) / 0.5, 1e-3);
        assert_mean(&on_floor, 2.0 * 0.5, 1e-3);
    }
    eye_reset(&sphere);
    eye_reset(&floor);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(plate_under_a_dome),
                                       cmocka_unit_test(wall_of_a_sphere),
                                       cmocka_unit_test(wall_in_a_mirror),
                                       cmocka_unit_test(ray_asks_both_sides_of_a_cloth),
                                       cmocka_unit_test(bounces_in_a_shining_sphere),
                                       cmocka_unit_test(bounces_where_no_estimate_holds)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
