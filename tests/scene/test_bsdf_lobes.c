/* test_bsdf_lobes.c: scattering by materials of several lobes: diffuse transmission, coats and panes. Energy and
 * closed forms. See test_bsdf_table.c too.
 * Threads: one. */
/* ctest: serial */
#include "fixtures/bsdf_fixture.h"
#include "material/fresnel.h"
#include "material/microfacet.h"

enum { SAMPLES = 60000 / FEWER };

static void metals_of_huge_indices_reflect_all(void **state)
{
    (void)state;
    static const float HUGE_INDICES[] = {1e8f, 4.29e9f, 1e19f, 3e38f};
    for (size_t i = 0; i < sizeof HUGE_INDICES / sizeof *HUGE_INDICES; i++)
        for (int degrees = 0; degrees <= 90; degrees += 15) {
            float cosine = direction_at(degrees, 0.0).z, huge = HUGE_INDICES[i];
            assert_close(fresnel_conductor_channel(cosine, 1.0f, huge), 1.0, 1e-6);
            assert_close(fresnel_conductor_channel(fmaxf(cosine, 0.1f), huge, 0.0f), 1.0, 1e-6);
            assert_close(fresnel_conductor_channel(fmaxf(cosine, 0.1f), huge, huge), 1.0, 1e-6);
        }
}

/* Picks of the groups, and what is said of them. */
static void samples_tell_their_group(void **state)
{
    (void)state;
    material all[] = {coated_diffuse(0.0f, 0.0f), coated_diffuse(0.3f, 0.3f), diffuse_transmission(),
                      coated_conductor(0.0f, 0.3f, 0.3f)};
    rng random = test_random(11);
    for (int k = 0; k < 4; k++) {
        bsdf b = flat(&all[k], direction_at(70.0, 10.0));
        int gathered = 0, drawn = 0;
        for (int i = 0; i < SAMPLES; i++) {
            bsdf_sample s;
            float u_lobe = rng_float(&random);
            vec2 u = rng_vec2(&random);
            if (bsdf_sample_direction(&b, BSDF_GATHERED, BSDF_FLUX, u_lobe, u, &s))
                assert_true(s.group == BSDF_GATHERED && !s.is_delta);
            if (bsdf_sample_direction(&b, BSDF_TRACED, BSDF_FLUX, u_lobe, u, &s))
                assert_true(s.group == BSDF_TRACED);
            if (!bsdf_sample_direction(&b, BSDF_ALL, BSDF_FLUX, u_lobe, u, &s))
                continue;
            drawn++;
            gathered += s.group == BSDF_GATHERED;
            if (k == 0) /* the coat is smooth, its base is not */
                assert_true(s.is_delta == (s.group == BSDF_TRACED));
        }
        double share = bsdf_probability(&b, BSDF_GATHERED);
        assert_close((double)gathered / SAMPLES, share, 5.0 * sqrt(share * (1.0 - share) / SAMPLES));
        assert_true(drawn > SAMPLES / 2);
    }
}

/* --- energy by quadrature --- */

typedef struct furnace {
    const bsdf *b;
    bsdf_lobes lobes;
} furnace;

static double furnace_value(void *user, vec3 d)
{
    const furnace *f = user;
    return bsdf_evaluate(f->b, f->lobes, BSDF_RADIANCE, (vec3){d.x, -d.z, d.y}).g;
}

/* Green of what leaves in a furnace of radiance 1: the integral of the value, and the weight of what is smooth. */
static double furnace_of(const bsdf *b, bsdf_lobes lobes)
{
    static double bins[BIN_COUNT];
    furnace f = {b, lobes};
    double sum = integrate_bins(furnace_value, &f, 8, bins);
    for (int k = 0; k < b->lobe_count; k++) {
        bsdf_sample s;
        bsdf one = *b;
        if (!(bsdf_lobe_set(b, lobes) & b->smooth_lobes & 1u << k))
            continue;
        bsdf_keep_lobe(&one, k);
        assert_true(bsdf_sample_direction(&one, BSDF_ALL, BSDF_RADIANCE, 0.5f, (vec2){0.5f, 0.5f}, &s));
        assert_true(s.is_delta);
        sum += s.weight.g;
    }
    return sum;
}

/* Fresnel's reflectance, from sines and cosines in doubles. */
static double fresnel(double cosine, double eta)
{
    double through = sqrt(1.0 - cosine * cosine) / eta;
    if (through >= 1.0)
        return 1.0;
    double ct = sqrt(1.0 - through * through);
    double s = (cosine - eta * ct) / (cosine + eta * ct), p = (eta * cosine - ct) / (eta * cosine + ct);
    return 0.5 * (s * s + p * p);
}

/* Fresnel reflectance of diffuse light. */
static double fresnel_diffuse(double eta)
{
    enum { STEPS = 20000 };
    double sum = 0.0;
    for (int i = 0; i < STEPS; i++) {
        double c = (i + 0.5) / STEPS;
        sum += 2.0 * fresnel(c, eta) * c / STEPS;
    }
    return sum;
}

static void diffuse_transmission_parts_the_light(void **state)
{
    (void)state;
    material m = diffuse_transmission();
    rng random = test_random(12);
    for (int i = 0; i < 1000; i++) {
        vec3 out = random_direction(&random), d = random_direction(&random);
        bsdf b = flat(&m, out);
        assert_true(bsdf_has(&b, BSDF_GATHERED) && !bsdf_has(&b, BSDF_TRACED));
        rgb value = bsdf_evaluate(&b, BSDF_ALL, BSDF_RADIANCE, d);
        rgb expected = out.z * d.z > 0.0f ? m.reflectance : m.transmittance;
        double cosine = fabs((double)d.z) / PI;
        assert_relative(value.r, (double)expected.r * cosine, 1e-5);
        assert_relative(value.g, (double)expected.g * cosine, 1e-5);
        assert_relative(value.b, (double)expected.b * cosine, 1e-5);
        rgb reflection = bsdf_gathered_reflection(&b), transmission = bsdf_gathered_transmission(&b);
        assert_memory_equal(&reflection, &m.reflectance, sizeof(rgb));
        assert_memory_equal(&transmission, &m.transmittance, sizeof(rgb));
        assert_true(bsdf_arrival_factor(&b) == 1.0f);
    }
    for (double degrees = 20.0; degrees < 180.0; degrees += 50.0) {
        bsdf b = flat(&m, direction_at(degrees, 40.0));
        assert_relative(furnace_of(&b, BSDF_ALL), 0.2 + 0.6, 1e-3);
    }
    /* one side only: the other is never picked */
    m.reflectance = rgb_gray(0.0f);
    for (int i = 0; i < 1000; i++) {
        vec3 out = random_direction(&random);
        bsdf b = flat(&m, out);
        bsdf_sample s;
        float u_lobe = rng_float(&random);
        assert_true(bsdf_sample_direction(&b, BSDF_ALL, BSDF_FLUX, u_lobe, rng_vec2(&random), &s));
        assert_true(s.direction.z * out.z < 0.0f);
        assert_relative(s.weight.g, 0.6, 1e-5);
    }
}

/* A white base under a clear smooth coat loses nothing; one of reflectance r shows what a plain series of reflections
 * to and fro between base and coat says. */
static void a_smooth_coat_on_a_diffuse_base_keeps_all(void **state)
{
    (void)state;
    static const float IORS[] = {1.0f, 1.33f, 1.5f, 2.4f, 0.8f}, REFLECTANCES[] = {1.0f, 0.7f, 0.2f, 0.0f};
    for (int n = 0; n < 5; n++) {
        double ior = IORS[n], kept = fresnel_diffuse(1.0 / ior);
        for (int k = 0; k < 4; k++) {
            material m = coated_diffuse(0.0f, 0.0f);
            double r = REFLECTANCES[k];
            m.ior = IORS[n];
            m.reflectance = rgb_gray(REFLECTANCES[k]);
            for (double degrees = 2.0; degrees < 180.0; degrees += 31.0) {
                bsdf b = flat(&m, direction_at(degrees, 5.0));
                double f = fresnel(fabs(cos(degrees * PI / 180.0)), ior);
                double expected = f + (1.0 - f) * (1.0 - kept) * r / (1.0 - r * kept), sum = furnace_of(&b, BSDF_ALL);
                if (!(fabs(sum - expected) <= 0.01 * expected + 1e-4))
                    fail_msg("index %g, reflectance %g, %g degrees: %g, not %g", ior, r, degrees, sum, expected);
                if (k == 0)
                    assert_close(sum, 1.0, 0.01);
                assert_close(furnace_of(&b, BSDF_TRACED), f, 1e-4);
            }
        }
    }
}

/* Without a change of index there is no coat. */
static void a_coat_of_index_one_is_no_coat(void **state)
{
    (void)state;
    material coated = coated_diffuse(0.0f, 0.0f), plain = diffuse();
    coated.ior = 1.0f;
    rng random = test_random(13);
    for (int i = 0; i < 1000; i++) {
        vec3 out = random_direction(&random), d = random_direction(&random);
        bsdf a = flat(&coated, out), b = flat(&plain, out);
        assert_close(bsdf_evaluate(&a, BSDF_ALL, BSDF_RADIANCE, d).r, bsdf_evaluate(&b, BSDF_ALL, BSDF_RADIANCE, d).r,
                     1e-5);
        assert_relative(bsdf_gathered_reflection(&a).r, bsdf_gathered_reflection(&b).r, 1e-5);
        coated.kind = MATERIAL_COATED_CONDUCTOR;
        coated.eta = (rgb){0.2f, 0.9f, 1.5f}, coated.k = (rgb){3.9f, 2.4f, 1.9f};
        coated.base_alpha_u = coated.base_alpha_v = 0.4f;
        material metal = conductor(0.4f, 0.4f);
        a = flat(&coated, out), b = flat(&metal, out);
        double expected = bsdf_evaluate(&b, BSDF_ALL, BSDF_RADIANCE, d).r;
        assert_close(bsdf_evaluate(&a, BSDF_ALL, BSDF_RADIANCE, d).r, expected, 1e-3 * expected + 1e-5);
        coated = coated_diffuse(0.0f, 0.0f);
        coated.ior = 1.0f;
    }
}

/* Nothing gains, however smooth or rough, on bases that reflect all. */
static void coats_make_no_light(void **state)
{
    (void)state;
    static const float IORS[] = {1.1f, 1.5f, 2.4f, 0.7f}, ALPHAS[] = {0.0f, 0.2f, 0.6f};
    for (int n = 0; n < 4; n++)
        for (int coat = 0; coat < 3; coat++)
            for (int base = -1; base < 3; base++)
                for (double degrees = 5.0; degrees < 90.0; degrees += 26.5) {
                    float a = ALPHAS[coat], c = base < 0 ? 0.0f : ALPHAS[base];
                    material m = base < 0 ? coated_diffuse(a, a) : coated_conductor(a, c, c);
                    m.ior = IORS[n];
                    m.reflectance = rgb_gray(1.0f);
                    m.eta = rgb_gray(1.0f), m.k = rgb_gray(1e4f); /* reflects all */
                    bsdf b = flat(&m, direction_at(degrees, 5.0));
                    double sum = furnace_of(&b, BSDF_ALL);
                    bool is_closed = coat == 0 && base == 0; /* all smooth: nothing is masked either */
                    if (!(sum <= 1.003 && sum >= (is_closed ? 0.999 : 0.1)))
                        fail_msg("index %g, coat %g, base %g, %g degrees: %g", (double)m.ior, (double)a,
                                 base < 0 ? -1.0 : (double)c, degrees, sum);
                }
}

/* Light that the coat turns away by total reflection is lost to what is below it, and to nothing else. */
static void a_thin_coat_reflects_totally(void **state)
{
    (void)state;
    material all[] = {coated_diffuse(0.0f, 0.0f), coated_conductor(0.0f, 0.3f, 0.3f),
                      coated_conductor(0.0f, 0.0f, 0.0f)};
    vec3 grazing = direction_at(70.0, 30.0), steep = direction_at(20.0, 200.0);
    for (int k = 0; k < 3; k++) {
        all[k].ior = 0.7f;
        bsdf from_grazing = flat(&all[k], grazing), from_steep = flat(&all[k], steep);
        rgb value = bsdf_evaluate(&from_grazing, BSDF_ALL, BSDF_RADIANCE, steep);
        assert_true(rgb_is_black(value));
        value = bsdf_evaluate(&from_steep, BSDF_ALL, BSDF_RADIANCE, grazing);
        assert_true(rgb_is_black(value));
        bsdf_sample s;
        assert_true(bsdf_sample_direction(&from_grazing, BSDF_ALL, BSDF_FLUX, 0.5f, (vec2){0.2f, 0.2f}, &s));
        assert_true(s.is_delta && s.group == BSDF_TRACED);
        assert_relative(s.weight.r, 1.0, 1e-5);
        assert_close(bsdf_pdf(&from_grazing, BSDF_ALL, BSDF_FLUX, steep), 0.0, 0.0);
    }
}

/* Smooth on smooth: one direction, with the series of reflections between coat and conductor. */
static void a_lacquered_mirror_obeys_the_series(void **state)
{
    (void)state;
    material m = coated_conductor(0.0f, 0.0f, 0.0f);
    for (double degrees = 0.0; degrees < 90.0; degrees += 14.0) {
        vec3 out = direction_at(degrees, 60.0);
        bsdf b = flat(&m, out);
        assert_false(bsdf_is_sampled_from_light(&b, BSDF_ALL));
        assert_false(bsdf_has_many_ways(&b, BSDF_ALL));
        /* red of the conductor at the refracted angle, with complex numbers avoided by its own smooth lobe */
        double sine = sin(degrees * PI / 180.0) / 1.5, inside = asin(sine) * 180.0 / PI;
        material metal = conductor(0.0f, 0.0f);
        bsdf c = flat(&metal, direction_at(inside, 0.0));
        bsdf_sample s;
        assert_true(bsdf_sample_direction(&c, BSDF_ALL, BSDF_FLUX, 0.5f, (vec2){0.5f, 0.5f}, &s));
        double r = s.weight.r, f = fresnel(cos(degrees * PI / 180.0), 1.5), expected = f;
        double inner = (1.0 - f) * (1.0 - f) * r;
        for (int bounce = 0; bounce < 200; bounce++, inner *= f * r)
            expected += inner;
        double sum = 0.0;
        enum { STEPS = 4000 };
        for (int i = 0; i < STEPS; i++) {
            float u = ((float)i + 0.5f) / STEPS;
            assert_true(bsdf_sample_direction(&b, BSDF_ALL, BSDF_FLUX, u, (vec2){0.5f, 0.5f}, &s));
            assert_true(s.is_delta);
            assert_close(vec3_distance_squared(s.direction, (vec3){-out.x, -out.y, out.z}), 0.0, 1e-10);
            sum += (double)s.weight.r / STEPS;
        }
        assert_close(sum, expected, 2e-3);
    }
}

/* --- a walk between coat and conductor, which the lobes stand for --- */

/* Flux that leaves of 1 that came: refracted, reflected or kept in as Fresnel says, by a smooth coat,
 * and thrown back by the conductor's facets, until nothing is left. */
static rgb walk_between(const material *m, vec3 out, int walks)
{
    const ggx facets = {m->base_alpha_u, m->base_alpha_v};
    rng random = test_random(31);
    double n = m->ior, sum[3] = {0.0, 0.0, 0.0};
    for (int k = 0; k < walks; k++) {
        double f = fresnel(out.z, n);
        if ((double)rng_float(&random) < f) {
            for (int c = 0; c < 3; c++)
                sum[c] += 1.0;
            continue;
        }
        vec3 o = {out.x / m->ior, out.y / m->ior, 0.0f};
        o.z = sqrtf(1.0f - o.x * o.x - o.y * o.y);
        rgb kept = rgb_gray(expf(-m->coat_thickness / o.z));
        for (int bounce = 0; bounce < (m->coat_bounces ? m->coat_bounces : 200) && kept.g > 1e-4f; bounce++) {
            vec3 h = ggx_sample_visible(facets, o, rng_vec2(&random)), i = reflect_about(o, h);
            if (i.z <= 0.0f)
                break;
            float share = ggx_masking_shadowing(facets, o, i) / ggx_masking(facets, o);
            share *= expf(-m->coat_thickness / i.z);
            kept = rgb_mul(kept, rgb_scale(fresnel_conductor(vec3_dot(o, h), m->eta, m->k), share));
            if ((double)rng_float(&random) >= fresnel(i.z, 1.0 / n)) {
                sum[0] += kept.r, sum[1] += kept.g, sum[2] += kept.b;
                break;
            }
            kept = rgb_scale(kept, expf(-m->coat_thickness / i.z));
            o = i;
        }
    }
    return (rgb){(float)(sum[0] / walks), (float)(sum[1] / walks), (float)(sum[2] / walks)};
}

/* The albedo of a bsdf, estimated by samples. */
static rgb sampled_albedo(const bsdf *b, int samples)
{
    rng random = test_random(32);
    rgb sum = rgb_gray(0.0f);
    for (int k = 0; k < samples; k++) {
        bsdf_sample s;
        float u_lobe = rng_float(&random);
        if (bsdf_sample_direction(b, BSDF_ALL, BSDF_FLUX, u_lobe, rng_vec2(&random), &s))
            sum = rgb_add(sum, s.weight);
    }
    return rgb_scale(sum, 1.0f / (float)samples);
}

static void a_coat_gives_back_what_it_traps(void **state)
{
    (void)state;
    enum { WALKS = 20000 / FEWER };
    static const float IORS[] = {1.2f, 1.5f, 2.0f}, ALPHAS[] = {0.05f, 0.15f, 0.3f, 0.6f};
    double worst = 0.0;
    for (int which = 0; which < 3 * 4 * 3; which++) {
        material m = coated_conductor(0.0f, ALPHAS[which / 3 % 4], ALPHAS[which / 3 % 4]);
        m.ior = IORS[which % 3];
        m.eta = rgb_scale(m.eta, 1.0f / m.ior), m.k = rgb_scale(m.k, 1.0f / m.ior);
        if (which / 12 == 1)
            m.eta = rgb_gray(1.0f), m.k = rgb_gray(1e4f); /* reflects all */
        if (which / 12 == 2)
            m.coat_thickness = 0.1f, m.coat_bounces = 5;
        for (double degrees = 2.0; degrees < 90.0; degrees += 38.0) {
            bsdf b = flat(&m, direction_at(degrees, 70.0));
            rgb expected = walk_between(&m, b.out, WALKS), got = sampled_albedo(&b, WALKS);
            double error = fmax(fabs((double)(got.r - expected.r)), fabs((double)(got.b - expected.b)));
            worst = fmax(worst, error);
            if (!(error < 0.06 * WIDER && (double)got.r < 1.0 + 0.01 * WIDER))
                fail_msg("index %g, base %g, sort %d, %g degrees: %.3f %.3f %.3f, not %.3f %.3f %.3f", (double)m.ior,
                         (double)m.base_alpha_u, which / 12, degrees, (double)got.r, (double)got.g, (double)got.b,
                         (double)expected.r, (double)expected.g, (double)expected.b);
        }
    }
    print_message("at most %.3f off\n", worst);
}

/* --- rough glass --- */

/* A ball of glass under an even sky of radiance 1, seen from afar. Its inside keeps light by total reflection for many
 * scatterings: 0.944 comes back in all, 0.928 by 12 scatterings at most, as pbrt-v4 has it at depth 12. */
static void a_ball_of_rough_glass_keeps_light_for_long(void **state)
{
    (void)state;
    enum { PATHS = 200000 / FEWER };
    material m = dielectric(1.5f, 0.1f, 0.1f);
    prepare(&m);
    rng random = test_random(45);
    double by_twelve = 0.0, all = 0.0;
    for (int k = 0; k < PATHS; k++) {
        float square = 0.96f * ((float)k + 0.5f) / PATHS; /* of the distance to the middle of the picture */
        vec3 out = {sqrtf(square), 0.0f, sqrtf(1.0f - square)};
        double weight = 1.0;
        for (int n = 1; n < 1000; n++) {
            bsdf b = bsdf_of(&m, UP, out);
            bsdf_sample s;
            float u_lobe = rng_float(&random);
            if (!bsdf_sample_direction(&b, BSDF_ALL, BSDF_FLUX, u_lobe, rng_vec2(&random), &s))
                break;
            weight *= (double)s.weight.g;
            if (s.direction.z > 0.0f) {
                all += weight / PATHS;
                by_twelve += n <= 12 ? weight / PATHS : 0.0;
                break;
            }
            /* across the ball it comes to the surface at the same angle */
            out = (vec3){-s.direction.x, -s.direction.y, s.direction.z};
        }
    }
    print_message("in all %.4f, by 12 scatterings %.4f\n", all, by_twelve);
    assert_close(all, 0.944, 0.003 * WIDER);
    assert_close(by_twelve, 0.928, 0.003 * WIDER);
}

/* --- panes --- */

static void a_pane_reflects_and_passes_straight(void **state)
{
    (void)state;
    static const float IORS[] = {1.0f, 1.33f, 1.5f, 2.4f};
    for (int n = 0; n < 4; n++) {
        material m = material_make(MATERIAL_THIN_DIELECTRIC);
        m.ior = IORS[n];
        for (double degrees = 0.0; degrees < 180.0; degrees += 19.0) {
            vec3 out = direction_at(degrees, 33.0);
            bsdf b = flat(&m, out);
            assert_true(bsdf_has(&b, BSDF_TRACED) && !bsdf_has(&b, BSDF_GATHERED));
            assert_false(bsdf_is_sampled_from_light(&b, BSDF_ALL));
            double r = fresnel(fabs(cos(degrees * PI / 180.0)), IORS[n]), reflected = 0.0, passed = 0.0;
            enum { STEPS = 20000 };
            for (int i = 0; i < STEPS; i++) {
                bsdf_sample s;
                float u = ((float)i + 0.5f) / STEPS;
                assert_true(
                    bsdf_sample_direction(&b, BSDF_ALL, i % 2 ? BSDF_FLUX : BSDF_RADIANCE, u, (vec2){0.3f, 0.7f}, &s));
                assert_true(s.is_delta && s.group == BSDF_TRACED);
                bool is_reflected = s.direction.z * out.z > 0.0f;
                vec3 expected = is_reflected ? (vec3){-out.x, -out.y, out.z} : vec3_negate(out);
                assert_close(vec3_distance_squared(s.direction, expected), 0.0, 1e-11);
                assert_relative(s.weight.r, 1.0, 1e-6); /* neither bent nor compressed: flux and radiance alike */
                (*(is_reflected ? &reflected : &passed)) += (double)s.weight.g / STEPS;
            }
            assert_close(reflected + passed, 1.0, 1e-6);
            assert_close(reflected, 2.0 * r / (1.0 + r), 2e-4);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(metals_of_huge_indices_reflect_all),
        cmocka_unit_test(samples_tell_their_group),
        cmocka_unit_test(diffuse_transmission_parts_the_light),
        cmocka_unit_test(a_smooth_coat_on_a_diffuse_base_keeps_all),
        cmocka_unit_test(a_coat_of_index_one_is_no_coat),
        cmocka_unit_test(coats_make_no_light),
        cmocka_unit_test(a_thin_coat_reflects_totally),
        cmocka_unit_test(a_lacquered_mirror_obeys_the_series),
        cmocka_unit_test(a_coat_gives_back_what_it_traps),
        cmocka_unit_test(a_ball_of_rough_glass_keeps_light_for_long),
        cmocka_unit_test(a_pane_reflects_and_passes_straight),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
