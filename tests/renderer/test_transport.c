/* test_transport.c: ways of eye paths by closed forms: Beer's law, panes, roulette, lamps that shine on one side; and
 * caustics as often as they count. Threads: one. */
#include "fixtures/eye_fixture.h"

enum { SAMPLES = 100000 / FEWER };

/* A ball 2 across stands between the eye and a wall; it absorbs 0.5 of green per unit, and 1 of blue. */
static void absorption(void **state)
{
    (void)state;
    eye e;
    eye_init(&e,
             "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [0 0.5 1] \"rgb sigma_s\" [0 0 0]"
             " AttributeBegin MediumInterface \"m\" \"\" Material \"interface\" Translate 0 0 -3"
             " Shape \"sphere\" \"float radius\" 1 AttributeEnd"
             " Translate 0 0 -5 Shape \"disk\" \"float radius\" 10");
    vertex v = eye_meet(&e, (vec3){0.0f, 0.0f, 0.0f}, (vec3){0.0f, 0.0f, -1.0f});
    assert_close((double)v.hit.position.z, -5.0, 1e-4);
    assert_close((double)v.transmittance.r, 1.0, 1e-6);
    assert_close((double)v.transmittance.g, exp(-1.0), 1e-5);
    assert_close((double)v.transmittance.b, exp(-2.0), 1e-5);
    v = eye_meet(&e, (vec3){4.0f, 0.0f, 0.0f}, (vec3){0.0f, 0.0f, -1.0f}); /* beside it */
    assert_close((double)v.transmittance.b, 1.0, 0.0);
    vertex none;
    assert_false(transport_trace(&e.t, e.worker, scene_ray_make((vec3){0}, (vec3){0.0f, 0.0f, 1.0f}), &none));
    eye_reset(&e);
}

/* Three panes of index 1.5, met straight: each lets (1 - R) / (1 + R) through, R = 0.04. */
static void panes(void **state)
{
    (void)state;
    eye e;
    eye_init(&e, "AttributeBegin Material \"thindielectric\" \"float eta\" 1.5"
                 " Translate 0 0 -1 Shape \"disk\" Translate 0 0 -1 Shape \"disk\" Translate 0 0 -1 Shape \"disk\""
                 " AttributeEnd Translate 0 0 -9 Shape \"disk\"");
    assert_true(e.t.panes_are_direct);
    vertex v;
    scene_ray ray = scene_ray_make((vec3){0.1f, 0.2f, 0.0f}, (vec3){0.0f, 0.0f, -1.0f});
    assert_true(transport_trace(&e.t, e.worker, ray, &v));
    assert_close((double)v.hit.position.z, -1.0, 1e-5);
    assert_true(transport_is_open_pane(&e.t, &v));
    assert_true(transport_trace_through_panes(&e.t, e.worker, ray, &v));
    assert_close((double)v.hit.position.z, -9.0, 1e-5);
    assert_close((double)v.transmittance.g, pow(0.96 / 1.04, 3.0), 1e-5);
    e.t.panes_are_direct = false; /* they are surfaces like others */
    assert_true(transport_trace_through_panes(&e.t, e.worker, ray, &v));
    assert_close((double)v.hit.position.z, -1.0, 1e-5);
    eye_reset(&e);
}

/* Paths that survive roulette carry the share of those that do not, so the mean stays. */
static void roulette(void **state)
{
    (void)state;
    static const rgb BEFORE[] = {{0.3f, 0.1f, 0.0f}, {0.01f, 0.01f, 0.02f}, {1.0f, 0.5f, 0.2f}, {3.0f, 1.0f, 1.0f}};
    rng random = test_random(1);
    for (size_t k = 0; k < sizeof BEFORE / sizeof *BEFORE; k++) {
        mean_sum sum = {0};
        for (uint32_t i = 0; i < SAMPLES; i++) {
            rgb throughput = BEFORE[k];
            float level = i % 2 ? 1.0f : 1.0f / 16.0f;
            bool survives = transport_survives(&throughput, level, rng_float(&random));
            assert_true(survives || rgb_max(BEFORE[k]) < level);
            assert_true(!survives || rgb_max(throughput) >= 0.999f * level);
            mean_add(&sum, survives ? (double)throughput.r : 0.0);
        }
        assert_mean(&sum, (double)BEFORE[k].r, 1e-5);
    }
    rgb black = rgb_gray(0.0f);
    assert_false(transport_survives(&black, 1.0f, 0.0f));
}

/* Behind so many scatterings by media that roulette has begun, the mean stays, too: what nothing absorbs is carried on
 * by fewer paths, and what media absorb by no more than that. */
static void roulette_in_media(void **state)
{
    (void)state;
    static const struct {
        float albedo, most; /* most: that a path carries at the end */
    } MEDIA[] = {{1.0f, 4.01f}, {0.998f, 4.01f}};
    enum { SCATTERINGS = 400, PATHS = 40000 };
    rng random = test_random(2);
    for (size_t k = 0; k < sizeof MEDIA / sizeof *MEDIA; k++) {
        mean_sum sum = {0};
        int survivors = 0;
        for (int i = 0; i < PATHS; i++) {
            rgb throughput = rgb_gray(1.0f);
            bool survives = true;
            for (int n = 1; survives && n <= SCATTERINGS; n++) {
                throughput = rgb_scale(throughput, MEDIA[k].albedo);
                survives = transport_survives(&throughput, medium_roulette_level(n), rng_float(&random));
            }
            assert_true(!survives || throughput.r <= MEDIA[k].most);
            survivors += survives;
            mean_add(&sum, survives ? (double)throughput.r : 0.0);
        }
        double expected = pow((double)MEDIA[k].albedo, SCATTERINGS);
        assert_mean(&sum, expected, 1e-4);
        assert_true(survivors < PATHS * expected / 3.6);
    }
}

static void lamps_shine_on_their_side(void **state)
{
    (void)state;
    for (int two_sided = 0; two_sided < 2; two_sided++) {
        eye e;
        eye_init(&e, two_sided ? "AreaLightSource \"diffuse\" \"rgb L\" [1 2 3] \"bool twosided\" true Shape \"disk\""
                               : "AreaLightSource \"diffuse\" \"rgb L\" [1 2 3] Shape \"disk\"");
        vertex front = eye_meet(&e, (vec3){0.0f, 0.0f, 1.0f}, (vec3){0.0f, 0.0f, -1.0f});
        vertex back = eye_meet(&e, (vec3){0.0f, 0.0f, -1.0f}, (vec3){0.0f, 0.0f, 1.0f});
        assert_true(front.lamp && back.lamp);
        assert_close((double)vertex_emission(e.t.s, &front).g, 2.0, 0.0);
        assert_close((double)vertex_emission(e.t.s, &back).g, two_sided ? 2.0 : 0.0, 0.0);
        assert_true(vertex_facing_normal(&front).z > 0.0f && vertex_facing_normal(&back).z < 0.0f);
        eye_reset(&e);
    }
}

/* Reflected light of the caustic map, rho E / pi: asked for each time, and only as often as it counts. */
static void caustics(void **state)
{
    (void)state;
    enum { PHOTONS = 20000 / FEWER };
    eye e;
    eye_init_with_photons(
        &e, "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5] ReverseOrientation Shape \"sphere\"", PHOTONS, 50);
    e.t.caustic = &e.global;
    rng random = test_random(2);
    mean_sum whole = {0}, some = {0};
    for (uint32_t i = 0; i < 4000; i++) {
        vertex v = eye_meet(&e, (vec3){0}, random_direction(&random));
        mean_add(&whole, (double)transport_caustics(&e.t, e.worker, &v).r);
        mean_add(&some, (double)transport_some_caustics(&e.t, e.worker, &v, 0.05f, rng_float(&random)).r);
    }
    double expected = 0.5 / PI * (double)FIELD_FLUX.r * field_irradiance(FIELD_SPHERE);
    double field = 3.0 / sqrt(50.0 * fmin(PHOTONS / 50.0, 4000.0)); /* points nearby share their photons */
    assert_mean(&whole, expected, 0.005 + field);
    assert_mean(&some, expected, 0.005 + field);
    eye_reset(&e);
}

/* Four samples towards lamps have one by scattering. Behind the first surface fewer have one by chance; but not under a
 * bound, which would cut what chance has made brighter. */
static void samples_by_scattering(void **state)
{
    (void)state;
    static const struct {
        uint32_t lights;
        float behind, first;
    } ROWS[] = {{1, 0.25f, 1.0f}, {2, 0.5f, 1.0f}, {4, 1.0f, 1.0f}, {16, 4.0f, 4.0f}};
    eye e;
    eye_init(&e, "LightSource \"infinite\" \"rgb L\" [1 1 1]");
    for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++)
        for (int is_bounded = 0; is_bounded < 2; is_bounded++)
            for (int is_first = 0; is_first < 2; is_first++) {
                e.settings.clamp_indirect = (float)is_bounded;
                sample_counts counts = transport_sample_counts(&e.t, ROWS[i].lights, is_first);
                float wanted = is_bounded || is_first ? ROWS[i].first : ROWS[i].behind;
                assert_close((double)((float)counts.scatter * counts.scatter_probability), (double)wanted, 0.0);
            }
    eye_reset(&e);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(samples_by_scattering),
                                       cmocka_unit_test(absorption),
                                       cmocka_unit_test(panes),
                                       cmocka_unit_test(roulette),
                                       cmocka_unit_test(roulette_in_media),
                                       cmocka_unit_test(lamps_shine_on_their_side),
                                       cmocka_unit_test(caustics)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
