/* test_photon_ways.c: paths that importons lead carry the flux of those that go by the cosine. Threads: those of the
 * tracing. */
#include "incident_light.h"
#include "photon_tracing.h"

#include "fixtures/test_scene.h"

/* The unit sphere around a lamp; the whole of its light stays within. */
static const char SPHERE[] = "LightSource \"point\" \"rgb I\" [3 2 1] \"point3 from\" [0.3 -0.2 0.4]\n"
                             "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n"
                             "Shape \"sphere\" \"float radius\" [1]\n";

enum { IMPORTONS = 4000, LED_SEEDS = 20, LED_PHOTONS = 20000 };

/* Importons on the unit sphere that come from one side of it. */
static photon_tree importons_from_one_side(test_run *r)
{
    photon *importons = photon_records_create(IMPORTONS);
    photon_tree tree;
    rng random = test_random(11);
    assert_non_null(importons);
    for (int i = 0; i < IMPORTONS; i++) {
        vec3 at = sample_uniform_sphere(rng_vec2(&random)), from = {0.8f, 0.2f, 0.0f};
        importons[i] = (photon){.position = {at.x, at.y, at.z},
                                .flux = flux_encode(rgb_gray(1.0f), 0),
                                .direction = arrival_encode(vec3_normalize(vec3_sub(at, from)), true),
                                .normal = direction_encode(vec3_negate(at))};
    }
    assert_int_equal(photon_tree_build(&r->run, importons, IMPORTONS, 0.0, 0.0, &tree), AG_OK);
    return tree;
}

/* Means over seeds, and their variances. */
typedef struct led_flux {
    double all, all_variance, aside, aside_variance; /* aside: on the half of the sphere that importons come from */
} led_flux;

static led_flux trace_led(test_run *r, const scene *s, const incident_light *ways)
{
    led_flux sum = {0.0, 0.0, 0.0, 0.0};
    for (int seed = 0; seed < LED_SEEDS; seed++) {
        photon_tracing_settings settings = {.kind = PHOTON_GLOBAL,
                                            .wanted = LED_PHOTONS / FEWER,
                                            .max_scatterings = 100,
                                            .seed = (uint64_t)seed,
                                            .ways = ways};
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
    photon_tree importons = importons_from_one_side(&r);
    incident_light ways;
    assert_int_equal(incident_light_create(&r.run, &importons, 0.8f, &ways), AG_OK);
    led_flux led = trace_led(&r, s, &ways), plain = trace_led(&r, s, NULL);
    double expected = 2.0 * 4.0 * PI * 2.0;
    print_message("flux, led %.4f +- %.4f, not %.4f, expected %.4f; aside %.4f +- %.4f, %.4f\n", led.all,
                  sqrt(led.all_variance), plain.all, expected, led.aside, sqrt(led.aside_variance), plain.aside);
    assert_close(led.all, expected, 4.0 * sqrt(led.all_variance) + 1e-4 * expected);
    assert_close(led.aside, plain.aside, 4.0 * sqrt(led.aside_variance + plain.aside_variance));
    incident_light_reset(&ways);
    free(importons.blocks);
    photon_tree_reset(&importons);
    scene_destroy(s);
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(led_paths_carry_the_same_flux)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
