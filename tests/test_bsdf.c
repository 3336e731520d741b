/* test_bsdf.c: scattering: no energy is made, sampling follows its density, value and weight agree, and the closed
 * forms of Fresnel and Snell hold. Threads: one. */
#include "bsdf.h"

#include "test_scene.h"

enum { SAMPLES = 200000 / FEWER };

static const rgb WHITE = {1.0f, 1.0f, 1.0f};

static material diffuse(void)
{
    return (material){.kind = MATERIAL_DIFFUSE, .reflectance = {0.8f, 0.5f, 0.1f}, .ior = 1.5f};
}

static material conductor(float alpha_u, float alpha_v)
{
    return (material){.kind = MATERIAL_CONDUCTOR,
                      .eta = {0.2f, 0.9f, 1.5f},
                      .k = {3.9f, 2.4f, 1.9f},
                      .alpha_u = alpha_u,
                      .alpha_v = alpha_v};
}

static material dielectric(float ior, float alpha_u, float alpha_v)
{
    return (material){.kind = MATERIAL_DIELECTRIC, .ior = ior, .alpha_u = alpha_u, .alpha_v = alpha_v};
}

/* A place whose normals are the z axis, or with a shading normal that leans. */
static bsdf flat(const material *m)
{
    surface_hit hit = {.geometric_normal = {0.0f, 0.0f, 1.0f}, .shading_normal = {0.0f, 0.0f, 1.0f}};
    return bsdf_create(m, &hit);
}

static vec3 direction_at(double degrees, double turn_degrees)
{
    double t = degrees * PI / 180.0, p = turn_degrees * PI / 180.0;
    return (vec3){(float)(sin(t) * cos(p)), (float)(sin(t) * sin(p)), (float)cos(t)};
}

/* --- sampling against density, for all rough materials from all sides --- */

typedef struct view {
    const bsdf *b;
    vec3 out;
    bsdf_lobes lobes;
} view;

/* The bins' poles lie in the surface: round about its normal, where scattering may be narrow, they are even. */
static vec3 bins_from_world(vec3 d) { return (vec3){d.x, d.z, -d.y}; }

static double density(void *user, vec3 d)
{
    const view *v = user;
    return bsdf_pdf(v->b, v->lobes, v->out, (vec3){d.x, -d.z, d.y});
}

static void check_view(const bsdf *b, vec3 out)
{
    static uint32_t counts[BIN_COUNT];
    static double bins[BIN_COUNT];
    memset(counts, 0, sizeof counts);
    rng random = test_random(1);
    bsdf_lobes lobes = BSDF_ALL;
    uint32_t sampled = 0;
    double energy[3] = {0.0, 0.0, 0.0};
    for (int i = 0; i < SAMPLES; i++) {
        bsdf_sample s;
        float u_lobe = rng_float(&random);
        if (!bsdf_sample_direction(b, lobes, BSDF_FLUX, out, u_lobe, rng_vec2(&random), &s))
            continue;
        sampled++;
        counts[direction_bin(bins_from_world(s.direction))]++;
        energy[0] += s.weight.r, energy[1] += s.weight.g, energy[2] += s.weight.b;
        assert_false(s.is_delta);
        assert_close(vec3_length(s.direction), 1.0, 1e-5);
        if (i % 50)
            continue;
        /* what it says of itself is what the other two functions say */
        for (int t = BSDF_RADIANCE; t <= BSDF_FLUX; t++) {
            bsdf_sample again;
            rng same = test_random(2 + (uint64_t)i);
            float lobe = rng_float(&same);
            if (!bsdf_sample_direction(b, lobes, (bsdf_transport)t, out, lobe, rng_vec2(&same), &again))
                continue;
            float pdf = bsdf_pdf(b, lobes, out, again.direction);
            rgb value = bsdf_evaluate(b, lobes, (bsdf_transport)t, out, again.direction);
            assert_relative(again.pdf_solid_angle, pdf, 1e-4);
            assert_relative(again.weight.r, value.r / pdf, 1e-3);
            assert_relative(again.weight.b, value.b / pdf, 1e-3);
        }
    }
    /* no channel gains */
    for (int c = 0; c < 3; c++)
        assert_true(energy[c] / SAMPLES <= 1.0 + 4.0 / sqrt(SAMPLES));
    double whole = integrate_bins(density, &(view){b, out, lobes}, 12, bins);
    assert_true(whole <= 1.002);
    assert_close(whole, (double)sampled / SAMPLES, 0.003 + 4.0 / sqrt(SAMPLES) * (1.0 - whole));
    assert_chi_square(counts, bins, SAMPLES, 0.01);
}

static void check_material(material m, bool from_below)
{
    bsdf b = flat(&m);
    static const double ANGLES[] = {3, 40, 75};
    for (int i = 0; i < 3; i++) {
        vec3 out = direction_at(ANGLES[i], 25.0 + 130.0 * i);
        check_view(&b, out);
        if (from_below)
            check_view(&b, (vec3){out.x, out.y, -out.z});
    }
}

static void diffuse_sampling_follows_its_density(void **state)
{
    (void)state;
    check_material(diffuse(), true);
}

static void conductor_sampling_follows_its_density(void **state)
{
    (void)state;
    check_material(conductor(0.3f, 0.3f), true);
    check_material(conductor(0.2f, 0.6f), false);
}

static void dielectric_sampling_follows_its_density(void **state)
{
    (void)state;
    check_material(dielectric(1.5f, 0.3f, 0.3f), true);
    check_material(dielectric(1.33f, 0.6f, 0.25f), true);
    check_material(dielectric(0.7f, 0.4f, 0.4f), false);
}

/* --- energy and reciprocity --- */

/* A perfect mirror of rough facets loses only what is shadowed; rough glass absorbs nothing else either. */
static void a_white_furnace_stays_white(void **state)
{
    (void)state;
    static const float ALPHAS[] = {0.01f, 0.1f, 0.3f, 0.7f};
    static const double AT_LEAST[] = {0.99, 0.92, 0.75, 0.5};
    for (int a = 0; a < 4; a++)
        for (int kind = 0; kind < 2; kind++)
            for (double degrees = 5.0; degrees < 80.0; degrees += 34.0) {
                material m = kind ? dielectric(1.5f, ALPHAS[a], ALPHAS[a]) : conductor(ALPHAS[a], ALPHAS[a]);
                m.eta = WHITE, m.k = rgb_gray(1e4f); /* reflects all */
                bsdf b = flat(&m);
                rng random = test_random(3);
                double sum = 0.0;
                for (int i = 0; i < 20000; i++) {
                    bsdf_sample s;
                    float u_lobe = rng_float(&random);
                    if (bsdf_sample_direction(&b, BSDF_ALL, BSDF_FLUX, direction_at(degrees, 10.0), u_lobe,
                                              rng_vec2(&random), &s))
                        sum += s.weight.g / 20000.0;
                }
                if (!(sum <= 1.001 && sum >= AT_LEAST[a]))
                    fail_msg("alpha %g, %g degrees, %s: %g", (double)ALPHAS[a], degrees, kind ? "glass" : "mirror",
                             sum);
            }
}

static void diffuse_weights_are_the_reflectance(void **state)
{
    (void)state;
    material m = diffuse();
    bsdf b = flat(&m);
    assert_true(bsdf_has(&b, BSDF_GATHERED) && !bsdf_has(&b, BSDF_TRACED) && bsdf_has(&b, BSDF_ALL));
    rgb albedo = bsdf_gathered_albedo(&b);
    assert_memory_equal(&albedo, &m.reflectance, sizeof albedo);
    rng random = test_random(4);
    for (int i = 0; i < 1000; i++) {
        bsdf_sample s;
        vec3 out = random_direction(&random);
        assert_true(bsdf_sample_direction(&b, BSDF_GATHERED, BSDF_RADIANCE, out, 0.0f, rng_vec2(&random), &s));
        assert_relative(s.weight.r, 0.8, 1e-5);
        assert_relative(s.weight.b, 0.1, 1e-5);
        assert_true(s.direction.z * out.z > 0.0f);
        assert_false(bsdf_sample_direction(&b, BSDF_TRACED, BSDF_RADIANCE, out, 0.0f, rng_vec2(&random), &s));
    }
}

static void scattering_is_reciprocal(void **state)
{
    (void)state;
    material all[] = {diffuse(), conductor(0.3f, 0.3f), conductor(0.15f, 0.5f), dielectric(1.5f, 0.3f, 0.3f),
                      dielectric(1.5f, 0.5f, 0.2f)};
    rng random = test_random(5);
    for (int k = 0; k < 5; k++) {
        bsdf b = flat(&all[k]);
        int compared = 0;
        for (int i = 0; i < 5000; i++) {
            vec3 o = random_direction(&random), d = random_direction(&random);
            /* f of radiance, and f the other way round: equal, but for the square of the index where it changes */
            double there = bsdf_evaluate(&b, BSDF_ALL, BSDF_RADIANCE, o, d).g / fabs((double)d.z);
            double back = bsdf_evaluate(&b, BSDF_ALL, BSDF_RADIANCE, d, o).g / fabs((double)o.z);
            if (o.z * d.z < 0.0f && all[k].kind == MATERIAL_DIELECTRIC) {
                double ratio =
                    (double)all[k].ior * (double)all[k].ior; /* light that goes from d, outside or inside, to o */
                there *= d.z > 0.0f ? 1.0 / ratio : 1.0;
                back *= o.z > 0.0f ? 1.0 / ratio : 1.0;
            }
            if (fabs((double)o.z) < 0.02 || fabs((double)d.z) < 0.02)
                continue; /* cancellation near grazing */
            assert_close(there, back, 1e-2 * fabs(back) + 1e-5);
            compared += back > 0.0;
        }
        assert_true(compared > 1000);
    }
}

/* Flux is not compressed where it enters another medium; radiance is, by the square of the relative index. */
static void radiance_and_flux_differ_by_the_square_of_the_index(void **state)
{
    (void)state;
    material rough = dielectric(1.5f, 0.3f, 0.3f), smooth = dielectric(1.5f, 0.0f, 0.0f);
    bsdf b = flat(&rough), c = flat(&smooth);
    for (int side = -1; side <= 1; side += 2) {
        vec3 out = direction_at(30.0, 70.0), through = direction_at(160.0, 250.0), back = direction_at(35.0, 250.0);
        out.z *= (float)side, through.z *= (float)side, back.z *= (float)side;
        double square = side > 0 ? 2.25 : 1.0 / 2.25; /* index beyond, over index here */
        rgb flux = bsdf_evaluate(&b, BSDF_TRACED, BSDF_FLUX, out, through);
        rgb radiance = bsdf_evaluate(&b, BSDF_TRACED, BSDF_RADIANCE, out, through);
        assert_true(flux.g > 0.0f);
        assert_relative(radiance.g, flux.g / square, 1e-5);
        flux = bsdf_evaluate(&b, BSDF_TRACED, BSDF_FLUX, out, back);
        radiance = bsdf_evaluate(&b, BSDF_TRACED, BSDF_RADIANCE, out, back);
        assert_true(flux.g > 0.0f && flux.g == radiance.g);

        bsdf_sample s;
        assert_true(bsdf_sample_direction(&c, BSDF_TRACED, BSDF_RADIANCE, out, 0.9999f, (vec2){0.5f, 0.5f}, &s));
        assert_true(s.direction.z * out.z < 0.0f);
        assert_relative(s.weight.r, 1.0 / square, 1e-5);
        assert_true(bsdf_sample_direction(&c, BSDF_TRACED, BSDF_FLUX, out, 0.9999f, (vec2){0.5f, 0.5f}, &s));
        assert_relative(s.weight.r, 1.0, 1e-5);
    }
}

/* --- smooth surfaces: closed forms --- */

/* The share of u_lobe for which a smooth dielectric reflects. */
static double reflected_share(const bsdf *b, vec3 out)
{
    int count = 0;
    enum { STEPS = 20000 };
    for (int i = 0; i < STEPS; i++) {
        bsdf_sample s;
        float u = ((float)i + 0.5f) / STEPS;
        assert_true(bsdf_sample_direction(b, BSDF_ALL, BSDF_FLUX, out, u, (vec2){0.3f, 0.7f}, &s));
        assert_true(s.is_delta);
        count += s.direction.z * out.z > 0.0f;
    }
    return (double)count / STEPS;
}

static void smooth_glass_obeys_fresnel_and_snell(void **state)
{
    (void)state;
    static const float IORS[] = {1.33f, 1.5f, 2.4f, 0.7f};
    for (int i = 0; i < 4; i++) {
        double n = IORS[i];
        material m = dielectric(IORS[i], 0.0f, 0.0f);
        bsdf b = flat(&m);
        assert_true(b.is_smooth && !bsdf_is_sampled_from_light(&b, BSDF_ALL));
        double normal = (n - 1.0) * (n - 1.0) / ((n + 1.0) * (n + 1.0));
        assert_close(reflected_share(&b, (vec3){0.0f, 0.0f, 1.0f}), normal, 1e-4);
        assert_close(reflected_share(&b, (vec3){0.0f, 0.0f, -1.0f}), normal, 1e-4);
        for (int side = -1; side <= 1; side += 2)
            for (double degrees = 10.0; degrees < 90.0; degrees += 13.0) {
                double eta = side > 0 ? n : 1.0 / n, sine = sin(degrees * PI / 180.0),
                       cosine = cos(degrees * PI / 180.0);
                vec3 out = direction_at(degrees, 33.0);
                out.z *= (float)side;
                double share = reflected_share(&b, out), through = sine / eta;
                if (through >= 1.0) { /* total reflection */
                    assert_true(share == 1.0);
                    continue;
                }
                double ct = sqrt(1.0 - through * through);
                double s = (cosine - eta * ct) / (cosine + eta * ct), p = (eta * cosine - ct) / (eta * cosine + ct);
                assert_close(share, 0.5 * (s * s + p * p), 2e-4);
                bsdf_sample sample;
                assert_true(bsdf_sample_direction(&b, BSDF_ALL, BSDF_FLUX, out, 0.99999f, (vec2){0.0f, 0.0f}, &sample));
                vec3 d = sample.direction;
                assert_close(sqrt((double)d.x * (double)d.x + (double)d.y * (double)d.y), through, 1e-5);
                assert_close(d.x * out.y - d.y * out.x, 0.0, 1e-6); /* in the plane of incidence, on the far side */
                assert_true(d.x * out.x < 0.0f && d.z * out.z < 0.0f);
                assert_true(bsdf_sample_direction(&b, BSDF_ALL, BSDF_FLUX, out, 0.0f, (vec2){0.0f, 0.0f}, &sample));
                assert_close(vec3_distance_squared(sample.direction, (vec3){-out.x, -out.y, out.z}), 0.0, 1e-10);
            }
    }
}

/* Brewster's angle: what is reflected is half of the perpendicular part alone. */
static void smooth_metal_obeys_fresnel(void **state)
{
    (void)state;
    material m = conductor(0.0f, 0.0f);
    bsdf b = flat(&m);
    bsdf_sample s;
    assert_true(
        bsdf_sample_direction(&b, BSDF_ALL, BSDF_RADIANCE, (vec3){0.0f, 0.0f, 1.0f}, 0.5f, (vec2){0.0f, 0.0f}, &s));
    assert_true(s.is_delta && s.direction.z > 0.999999f);
    const float eta[3] = {m.eta.r, m.eta.g, m.eta.b}, k[3] = {m.k.r, m.k.g, m.k.b};
    const float weight[3] = {s.weight.r, s.weight.g, s.weight.b};
    for (int c = 0; c < 3; c++) {
        double n = eta[c], a = k[c];
        assert_relative(weight[c], ((n - 1) * (n - 1) + a * a) / ((n + 1) * (n + 1) + a * a), 1e-5);
    }
    /* towards grazing it reflects all */
    assert_true(bsdf_sample_direction(&b, BSDF_ALL, BSDF_RADIANCE, direction_at(89.99, 0.0), 0.5f, (vec2){0, 0}, &s));
    assert_close(s.weight.g, 1.0, 1e-3);
    assert_close(s.direction.x, -1.0, 1e-5);
    /* without absorption it is a dielectric that only reflects: Brewster's angle for an index of 1.5 */
    m.eta = rgb_gray(1.5f), m.k = rgb_gray(0.0f);
    double brewster = atan(1.5), ct = cos(asin(sin(brewster) / 1.5)), c = cos(brewster);
    double perpendicular = (c - 1.5 * ct) / (c + 1.5 * ct);
    assert_true(bsdf_sample_direction(&b, BSDF_ALL, BSDF_RADIANCE, direction_at(brewster * 180.0 / PI, 0.0), 0.5f,
                                      (vec2){0, 0}, &s));
    assert_relative(s.weight.g, 0.5 * perpendicular * perpendicular, 1e-4);
}

/* An index of 1 is no surface at all, however rough. */
static void an_index_of_one_is_passed_straight(void **state)
{
    (void)state;
    for (int rough = 0; rough < 2; rough++) {
        material m = dielectric(1.0f, rough ? 0.3f : 0.0f, rough ? 0.3f : 0.0f);
        bsdf b = flat(&m);
        vec3 out = direction_at(50.0, 20.0);
        bsdf_sample s;
        assert_true(bsdf_sample_direction(&b, BSDF_ALL, BSDF_RADIANCE, out, 0.3f, (vec2){0.2f, 0.9f}, &s));
        assert_close(vec3_dot(s.direction, out), -1.0, 1e-6);
        assert_relative(s.weight.r, 1.0, 1e-6);
    }
}

/* --- shading normals --- */

static void shading_normals_never_let_diffuse_light_through(void **state)
{
    (void)state;
    material m = diffuse();
    rng random = test_random(6);
    for (int i = 0; i < 20000; i++) {
        surface_hit hit = {.geometric_normal = {0.0f, 0.0f, 1.0f}};
        hit.shading_normal = vec3_face_forward(random_direction(&random), hit.geometric_normal);
        bsdf b = bsdf_create(&m, &hit);
        vec3 out = random_direction(&random);
        bsdf_sample s;
        if (bsdf_sample_direction(&b, BSDF_ALL, BSDF_FLUX, out, 0.5f, rng_vec2(&random), &s)) {
            assert_true(s.direction.z * out.z > 0.0f);
            assert_true(rgb_is_finite(s.weight) && s.weight.r <= 8.0f);
        }
        vec3 d = random_direction(&random);
        if (d.z * out.z < 0.0f)
            assert_true(rgb_is_black(bsdf_evaluate(&b, BSDF_ALL, BSDF_RADIANCE, out, d)));
        float correction = bsdf_arrival_correction(&b, d);
        assert_true(correction >= 0.0f && correction <= 8.0f);
    }
    bsdf b = flat(&m);
    assert_true(bsdf_arrival_correction(&b, direction_at(60.0, 1.0)) == 1.0f);
    surface_hit hit = {.geometric_normal = {0.0f, 0.0f, 1.0f}, .shading_normal = direction_at(20.0, 0.0)};
    b = bsdf_create(&m, &hit);
    assert_relative(bsdf_arrival_correction(&b, direction_at(60.0, 0.0)), cos(40.0 * PI / 180.0) / 0.5, 1e-5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(diffuse_sampling_follows_its_density),
        cmocka_unit_test(conductor_sampling_follows_its_density),
        cmocka_unit_test(dielectric_sampling_follows_its_density),
        cmocka_unit_test(a_white_furnace_stays_white),
        cmocka_unit_test(diffuse_weights_are_the_reflectance),
        cmocka_unit_test(scattering_is_reciprocal),
        cmocka_unit_test(radiance_and_flux_differ_by_the_square_of_the_index),
        cmocka_unit_test(smooth_glass_obeys_fresnel_and_snell),
        cmocka_unit_test(smooth_metal_obeys_fresnel),
        cmocka_unit_test(an_index_of_one_is_passed_straight),
        cmocka_unit_test(shading_normals_never_let_diffuse_light_through),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
