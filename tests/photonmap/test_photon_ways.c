/* test_photon_ways.c: paths that importons guide carry the flux of those that go by the cosine. Threads: those of the
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

enum { IMPORTONS = 4000, GUIDED_SEEDS = 20, GUIDED_PHOTONS = 20000 };

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
typedef struct guided_flux {
    double all, all_variance, aside, aside_variance; /* aside: on the half of the sphere that importons come from */
} guided_flux;

static guided_flux trace_guided(test_run *r, const scene *s, photon_kind kind, const onward_ways *ways)
{
    guided_flux sum = {0.0, 0.0, 0.0, 0.0};
    for (int seed = 0; seed < GUIDED_SEEDS; seed++) {
        photon_tracing_settings settings = {.kind = kind,
                                            .wanted = GUIDED_PHOTONS / FEWER,
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
        sum.all += all / GUIDED_SEEDS, sum.all_variance += all * all / GUIDED_SEEDS;
        sum.aside += aside / GUIDED_SEEDS, sum.aside_variance += aside * aside / GUIDED_SEEDS;
        photon_set_reset(&set);
    }
    sum.all_variance = (sum.all_variance - sum.all * sum.all) / (GUIDED_SEEDS - 1);
    sum.aside_variance = (sum.aside_variance - sum.aside * sum.aside) / (GUIDED_SEEDS - 1);
    return sum;
}

/* In a closed sphere of albedo 1/2 twice the lamp's flux arrives. Guiding changes neither that nor a side's share. */
static void guided_paths_carry_the_same_flux(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 2);
    scene *s = test_scene_create(&r, SPHERE);
    onward_ways ways;
    importons_from_one_side(&r, &ways);
    guided_flux guided = trace_guided(&r, s, PHOTON_GLOBAL, &ways), plain = trace_guided(&r, s, PHOTON_GLOBAL, NULL);
    double expected = 2.0 * 4.0 * PI * 2.0;
    print_message("flux, guided %.4f +- %.4f, not %.4f, expected %.4f; aside %.4f +- %.4f, %.4f\n", guided.all,
                  sqrt(guided.all_variance), plain.all, expected, guided.aside, sqrt(guided.aside_variance),
                  plain.aside);
    assert_close(guided.all, expected, 4.0 * sqrt(guided.all_variance) + 1e-4 * expected);
    assert_close(guided.aside, plain.aside, 4.0 * sqrt(guided.aside_variance + plain.aside_variance));
    onward_ways_reset(&ways);
    scene_destroy(s);
    test_run_reset(&r);
}

/* A coat reflects besides; guided or not, as much arrives, in the map of all paths and in that of caustics. */
static void guided_paths_of_coats_carry_the_same_flux(void **state)
{
    (void)state;
    static const photon_kind KINDS[] = {PHOTON_GLOBAL, PHOTON_CAUSTIC};
    test_run r;
    test_run_init(&r, 2);
    scene *s = test_scene_create(&r, COATED);
    onward_ways ways;
    importons_from_one_side(&r, &ways);
    for (int i = 0; i < 2; i++) {
        guided_flux guided = trace_guided(&r, s, KINDS[i], &ways), plain = trace_guided(&r, s, KINDS[i], NULL);
        double all_variance = guided.all_variance + plain.all_variance;
        double aside_variance = guided.aside_variance + plain.aside_variance;
        print_message("flux, guided %.4f, not %.4f +- %.4f; aside %.4f, %.4f +- %.4f\n", guided.all, plain.all,
                      sqrt(all_variance), guided.aside, plain.aside, sqrt(aside_variance));
        assert_true(guided.all_variance > 0.0 && guided.all != plain.all);
        assert_true(sqrt(all_variance) < 0.02 * plain.all);
        assert_close(guided.all, plain.all, 4.0 * sqrt(all_variance));
        assert_close(guided.aside, plain.aside, 4.0 * sqrt(aside_variance));
    }
    onward_ways_reset(&ways);
    scene_destroy(s);
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(guided_paths_carry_the_same_flux),
                                       cmocka_unit_test(guided_paths_of_coats_carry_the_same_flux)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
