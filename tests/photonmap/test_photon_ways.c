/* test_photon_ways.c: paths that importons lead carry the flux of those that go by the cosine. Threads: those of the
 * tracing. */
#include "onward_ways.h"
#include "photon_tracing.h"

#include "fixtures/test_scene.h"

/* The unit sphere around a lamp; the whole of its light stays within. */
#define SPHERE_OF(material)                                                                                            \
    "LightSource \"point\" \"rgb I\" [3 2 1] \"point3 from\" [0.3 -0.2 0.4]\n" material                                \
    "Shape \"sphere\" \"float radius\" [1]\n"
static const char SPHERE[] = SPHERE_OF("Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n");
static const char COATED[] =
    SPHERE_OF("Material \"coateddiffuse\" \"rgb reflectance\" [0.5 0.5 0.5] \"float roughness\" [0.2]\n");

enum { IMPORTONS = 4000, LED_SEEDS = 20, LED_PHOTONS = 20000 };

/* Importons on the unit sphere that come from one side of it. */
static void importons_from_one_side(test_run *r, onward_ways *out_ways)
{
    photon *importons = photon_records_create(IMPORTONS);
    rng random = test_random(11);
    assert_non_null(importons);
    for (int i = 0; i < IMPORTONS; i++) {
        vec3 at = sample_uniform_sphere(rng_vec2(&random)), from = {0.8f, 0.2f, 0.0f};
        importons[i] = (photon){.position = {at.x, at.y, at.z},
                                .flux = flux_encode(rgb_gray(1.0f), 0),
                                .direction = arrival_encode(vec3_normalize(vec3_sub(at, from)), true),
                                .normal = direction_encode(vec3_negate(at))};
    }
    assert_int_equal(onward_ways_create(&r->run, importons, IMPORTONS, out_ways), AG_OK);
}

/* Means over seeds, and their variances. */
typedef struct led_flux {
    double all, all_variance, aside, aside_variance; /* aside: on the half of the sphere that importons come from */
} led_flux;

static led_flux trace_led(test_run *r, const scene *s, photon_kind kind, const onward_ways *ways)
{
    led_flux sum = {0.0, 0.0, 0.0, 0.0};
    for (int seed = 0; seed < LED_SEEDS; seed++) {
        photon_tracing_settings settings = {
            .kind = kind, .wanted = LED_PHOTONS / FEWER, .max_scatterings = 100, .seed = (uint64_t)seed, .ways = ways};
        photon_set set;
        double all = 0.0, aside = 0.0;
        assert_int_equal(photon_tracing_run(s, &r->run, &settings, &set), AG_OK);
        for (uint32_t i = 0; i < set.count; i++) {
            double flux = (double)flux_decode(set.photons[i].flux).g / (double)set.emitted_paths;
            all += flux;
            aside += set.photons[i].position[0] > 0.0f ? flux : 0.0;
        }
        sum.all += all / LED_SEEDS, sum.all_variance += all * all / LED_SEEDS;
        sum.aside += aside / LED_SEEDS, sum.aside_variance += aside * aside / LED_SEEDS;
        photon_set_reset(&set);
    }
    sum.all_variance = (sum.all_variance - sum.all * sum.all) / (LED_SEEDS - 1);
    sum.aside_variance = (sum.aside_variance - sum.aside * sum.aside) / (LED_SEEDS - 1);
    return sum;
}

/* In a closed sphere of albedo 1/2 twice the lamp's flux arrives, and as much on each side, wherever paths are led. */
static void led_paths_carry_the_same_flux(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 2);
    scene *s = test_scene_create(&r, SPHERE);
    onward_ways ways;
    importons_from_one_side(&r, &ways);
    led_flux led = trace_led(&r, s, PHOTON_GLOBAL, &ways), plain = trace_led(&r, s, PHOTON_GLOBAL, NULL);
    double expected = 2.0 * 4.0 * PI * 2.0;
    print_message("flux, led %.4f +- %.4f, not %.4f, expected %.4f; aside %.4f +- %.4f, %.4f\n", led.all,
                  sqrt(led.all_variance), plain.all, expected, led.aside, sqrt(led.aside_variance), plain.aside);
    assert_close(led.all, expected, 4.0 * sqrt(led.all_variance) + 1e-4 * expected);
    assert_close(led.aside, plain.aside, 4.0 * sqrt(led.aside_variance + plain.aside_variance));
    onward_ways_reset(&ways);
    scene_destroy(s);
    test_run_reset(&r);
}

/* A coat reflects besides; led or not, as much arrives, in the map of all paths and in that of caustics. */
static void led_paths_of_coats_carry_the_same_flux(void **state)
{
    (void)state;
    static const photon_kind KINDS[] = {PHOTON_GLOBAL, PHOTON_CAUSTIC};
    test_run r;
    test_run_init(&r, 2);
    scene *s = test_scene_create(&r, COATED);
    onward_ways ways;
    importons_from_one_side(&r, &ways);
    for (int i = 0; i < 2; i++) {
        led_flux led = trace_led(&r, s, KINDS[i], &ways), plain = trace_led(&r, s, KINDS[i], NULL);
        double all_variance = led.all_variance + plain.all_variance;
        double aside_variance = led.aside_variance + plain.aside_variance;
        print_message("flux, led %.4f, not %.4f +- %.4f; aside %.4f, %.4f +- %.4f\n", led.all, plain.all,
                      sqrt(all_variance), led.aside, plain.aside, sqrt(aside_variance));
        assert_true(led.all_variance > 0.0 && led.all != plain.all);
        assert_true(sqrt(all_variance) < 0.02 * plain.all);
        assert_close(led.all, plain.all, 4.0 * sqrt(all_variance));
        assert_close(led.aside, plain.aside, 4.0 * sqrt(aside_variance));
    }
    onward_ways_reset(&ways);
    scene_destroy(s);
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(led_paths_carry_the_same_flux),
                                       cmocka_unit_test(led_paths_of_coats_carry_the_same_flux)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
