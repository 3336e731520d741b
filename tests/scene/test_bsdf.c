/* test_bsdf.c: scattering: white furnaces, the closed forms of Fresnel and Snell, shading normals. What holds for every
 * material alike is in test_bsdf_table.c. Threads: one. */
/* ctest: serial */
#include "fixtures/bsdf_fixture.h"

#include "material/lambert.h"

enum { SAMPLES = 200000 / FEWER };

static const rgb WHITE = {1.0f, 1.0f, 1.0f};

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
                bsdf b = flat(&m, direction_at(degrees, 10.0));
                rng random = test_random(3);
                double sum = 0.0;
                for (int i = 0; i < 20000; i++) {
                    bsdf_sample s;
                    float u_lobe = rng_float(&random);
                    if (bsdf_sample_direction(&b, BSDF_ALL, BSDF_FLUX, u_lobe, rng_vec2(&random), &s))
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
    bsdf b = flat(&m, UP);
    assert_true(bsdf_has(&b, BSDF_GATHERED) && !bsdf_has(&b, BSDF_TRACED) && bsdf_has(&b, BSDF_ALL));
    rgb albedo = bsdf_gathered_reflection(&b);
    assert_memory_equal(&albedo, &m.reflectance, sizeof albedo);
    assert_true(rgb_is_black(bsdf_gathered_transmission(&b)));
    rng random = test_random(4);
    for (int i = 0; i < 1000; i++) {
        bsdf_sample s;
        vec3 out = random_direction(&random);
        b = flat(&m, out);
        assert_true(bsdf_sample_direction(&b, BSDF_GATHERED, BSDF_RADIANCE, 0.0f, rng_vec2(&random), &s));
        assert_relative(s.weight.r, 0.8, 1e-5);
        assert_relative(s.weight.b, 0.1, 1e-5);
        assert_true(s.direction.z * out.z > 0.0f);
        assert_false(bsdf_sample_direction(&b, BSDF_TRACED, BSDF_RADIANCE, 0.0f, rng_vec2(&random), &s));
    }
}

/* Flux is not compressed where it enters another medium; radiance is, by the square of the relative index. */
static void radiance_and_flux_differ_by_the_square_of_the_index(void **state)
{
    (void)state;
    material rough = dielectric(1.5f, 0.3f, 0.3f), smooth = dielectric(1.5f, 0.0f, 0.0f);
    for (int side = -1; side <= 1; side += 2) {
        vec3 out = direction_at(30.0, 70.0), through = direction_at(160.0, 250.0), back = direction_at(35.0, 250.0);
        out.z *= (float)side, through.z *= (float)side, back.z *= (float)side;
        bsdf b = flat(&rough, out), c = flat(&smooth, out);
        double square = side > 0 ? 2.25 : 1.0 / 2.25; /* index beyond, over index here */
        rgb flux = bsdf_evaluate(&b, BSDF_TRACED, BSDF_FLUX, through);
        rgb radiance = bsdf_evaluate(&b, BSDF_TRACED, BSDF_RADIANCE, through);
        assert_true(flux.g > 0.0f);
        assert_relative(radiance.g, flux.g / square, 1e-5);
        flux = bsdf_evaluate(&b, BSDF_TRACED, BSDF_FLUX, back);
        radiance = bsdf_evaluate(&b, BSDF_TRACED, BSDF_RADIANCE, back);
        assert_true(flux.g > 0.0f && flux.g == radiance.g);

        bsdf_sample s;
        assert_true(bsdf_sample_direction(&c, BSDF_TRACED, BSDF_RADIANCE, 0.9999f, (vec2){0.5f, 0.5f}, &s));
        assert_true(s.direction.z * out.z < 0.0f);
        assert_relative(s.weight.r, 1.0 / square, 1e-5);
        assert_true(bsdf_sample_direction(&c, BSDF_TRACED, BSDF_FLUX, 0.9999f, (vec2){0.5f, 0.5f}, &s));
        assert_relative(s.weight.r, 1.0, 1e-5);
    }
}

/* --- smooth surfaces: closed forms --- */

/* The share of u_lobe for which a smooth dielectric reflects. */
static double reflected_share(const material *m, vec3 out)
{
    bsdf b = flat(m, out);
    int count = 0;
    enum { STEPS = 20000 };
    for (int i = 0; i < STEPS; i++) {
        bsdf_sample s;
        float u = ((float)i + 0.5f) / STEPS;
        assert_true(bsdf_sample_direction(&b, BSDF_ALL, BSDF_FLUX, u, (vec2){0.3f, 0.7f}, &s));
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
        bsdf b = flat(&m, UP);
        assert_true(b.lobe_count == 1 && b.smooth_lobes == 1 && !bsdf_is_sampled_from_light(&b, BSDF_ALL));
        assert_true(bsdf_has_many_ways(&b, BSDF_TRACED) && !bsdf_has_many_ways(&b, BSDF_GATHERED));
        double normal = (n - 1.0) * (n - 1.0) / ((n + 1.0) * (n + 1.0));
        assert_close(reflected_share(&m, UP), normal, 1e-4);
        assert_close(reflected_share(&m, (vec3){0.0f, 0.0f, -1.0f}), normal, 1e-4);
        for (int side = -1; side <= 1; side += 2)
            for (double degrees = 10.0; degrees < 90.0; degrees += 13.0) {
                double eta = side > 0 ? n : 1.0 / n, sine = sin(degrees * PI / 180.0),
                       cosine = cos(degrees * PI / 180.0);
                vec3 out = direction_at(degrees, 33.0);
                out.z *= (float)side;
                double share = reflected_share(&m, out), through = sine / eta;
                if (through >= 1.0) { /* total reflection */
                    assert_true(share == 1.0);
                    continue;
                }
                double ct = sqrt(1.0 - through * through);
                double s = (cosine - eta * ct) / (cosine + eta * ct), p = (eta * cosine - ct) / (eta * cosine + ct);
                assert_close(share, 0.5 * (s * s + p * p), 2e-4);
                bsdf_sample sample;
                b = flat(&m, out);
                assert_true(bsdf_sample_direction(&b, BSDF_ALL, BSDF_FLUX, 0.99999f, (vec2){0.0f, 0.0f}, &sample));
                vec3 d = sample.direction;
                assert_close(sqrt((double)d.x * (double)d.x + (double)d.y * (double)d.y), through, 1e-5);
                assert_close(d.x * out.y - d.y * out.x, 0.0, 1e-6); /* in the plane of incidence, on the far side */
                assert_true(d.x * out.x < 0.0f && d.z * out.z < 0.0f);
                assert_true(bsdf_sample_direction(&b, BSDF_ALL, BSDF_FLUX, 0.0f, (vec2){0.0f, 0.0f}, &sample));
                assert_close(vec3_distance_squared(sample.direction, (vec3){-out.x, -out.y, out.z}), 0.0, 1e-10);
            }
    }
}

/* Brewster's angle: what is reflected is half of the perpendicular part alone. */
static void smooth_metal_obeys_fresnel(void **state)
{
    (void)state;
    material m = conductor(0.0f, 0.0f);
    bsdf b = flat(&m, UP);
    bsdf_sample s;
    assert_true(bsdf_sample_direction(&b, BSDF_ALL, BSDF_RADIANCE, 0.5f, (vec2){0.0f, 0.0f}, &s));
    assert_true(s.is_delta && s.direction.z > 0.999999f);
    const float eta[3] = {m.eta.r, m.eta.g, m.eta.b}, k[3] = {m.k.r, m.k.g, m.k.b};
    const float weight[3] = {s.weight.r, s.weight.g, s.weight.b};
    for (int c = 0; c < 3; c++) {
        double n = eta[c], a = k[c];
        assert_relative(weight[c], ((n - 1) * (n - 1) + a * a) / ((n + 1) * (n + 1) + a * a), 1e-5);
    }
    /* towards grazing it reflects all */
    b = flat(&m, direction_at(89.99, 0.0));
    assert_true(bsdf_sample_direction(&b, BSDF_ALL, BSDF_RADIANCE, 0.5f, (vec2){0, 0}, &s));
    assert_close(s.weight.g, 1.0, 1e-3);
    assert_close(s.direction.x, -1.0, 1e-5);
    /* without absorption it is a dielectric that only reflects: Brewster's angle for an index of 1.5 */
    m.eta = rgb_gray(1.5f), m.k = rgb_gray(0.0f);
    double brewster = atan(1.5), ct = cos(asin(sin(brewster) / 1.5)), c = cos(brewster);
    double perpendicular = (c - 1.5 * ct) / (c + 1.5 * ct);
    b = flat(&m, direction_at(brewster * 180.0 / PI, 0.0));
    assert_true(bsdf_sample_direction(&b, BSDF_ALL, BSDF_RADIANCE, 0.5f, (vec2){0, 0}, &s));
    assert_relative(s.weight.g, 0.5 * perpendicular * perpendicular, 1e-4);
}

/* An index of 1 is no surface at all, however rough. */
static void an_index_of_one_is_passed_straight(void **state)
{
    (void)state;
    for (int rough = 0; rough < 2; rough++) {
        material m = dielectric(1.0f, rough ? 0.3f : 0.0f, rough ? 0.3f : 0.0f);
        vec3 out = direction_at(50.0, 20.0);
        bsdf b = flat(&m, out);
        bsdf_sample s;
        assert_true(bsdf_sample_direction(&b, BSDF_ALL, BSDF_RADIANCE, 0.3f, (vec2){0.2f, 0.9f}, &s));
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
        vec3 normal = vec3_face_forward(random_direction(&random), UP), out = random_direction(&random);
        bsdf b = bsdf_at(&m, normal, out);
        bsdf_sample s;
        if (bsdf_sample_direction(&b, BSDF_ALL, BSDF_FLUX, 0.5f, rng_vec2(&random), &s)) {
            assert_true(s.direction.z * out.z > 0.0f);
            assert_true(rgb_is_finite(s.weight) && s.weight.r <= BSDF_SHADING_NORMAL_MAX);
        }
        vec3 d = random_direction(&random);
        if (d.z * out.z < 0.0f)
            assert_true(rgb_is_black(bsdf_evaluate(&b, BSDF_ALL, BSDF_RADIANCE, d)));
        b = bsdf_at(&m, normal, d);
        float factor = bsdf_arrival_factor(&b);
        assert_true(factor >= 0.0f && factor <= BSDF_SHADING_NORMAL_MAX);
    }
    bsdf b = flat(&m, direction_at(60.0, 1.0));
    assert_true(bsdf_arrival_factor(&b) == 1.0f);
    b = bsdf_at(&m, direction_at(20.0, 0.0), direction_at(60.0, 0.0));
    assert_relative(bsdf_arrival_factor(&b), cos(40.0 * PI / 180.0) / 0.5, 1e-5);
}

/* Beyond the horizon of either normal there is no diffuse light: none is computed, none stored, none drawn. */
static void diffuse_light_ends_at_the_shading_horizon(void **state)
{
    (void)state;
    material all[] = {diffuse(), diffuse_transmission(), coated_diffuse(0.0f, 0.0f)};
    rng random = test_random(7);
    for (int k = 0; k < 3; k++) {
        int beyond = 0, before = 0;
        for (int i = 0; i < 20000; i++) {
            vec3 normal = vec3_face_forward(random_direction(&random), UP), out = random_direction(&random);
            vec3 d = random_direction(&random);
            bsdf b = bsdf_at(&all[k], normal, out), arrived = bsdf_at(&all[k], normal, d);
            bool is_beyond = d.z * vec3_dot(d, normal) <= 0.0f, is_through = d.z * out.z < 0.0f;
            rgb value = bsdf_evaluate(&b, BSDF_GATHERED, BSDF_RADIANCE, d);
            if (is_beyond) {
                assert_true(rgb_is_black(value) && bsdf_pdf(&b, BSDF_GATHERED, BSDF_RADIANCE, d) == 0.0f);
                assert_true(bsdf_arrival_factor(&arrived) == 0.0f);
                beyond++;
            } else if (!is_through || all[k].kind == MATERIAL_DIFFUSE_TRANSMISSION) {
                assert_true(value.g > 0.0f && bsdf_pdf(&b, BSDF_GATHERED, BSDF_RADIANCE, d) > 0.0f);
                assert_true(bsdf_arrival_factor(&arrived) > 0.0f);
                before++;
            }
            bsdf_sample s;
            float u_lobe = rng_float(&random);
            if (bsdf_sample_direction(&b, BSDF_GATHERED, BSDF_RADIANCE, u_lobe, rng_vec2(&random), &s))
                assert_true(s.direction.z * vec3_dot(s.direction, normal) > 0.0f);
        }
        assert_true(beyond > 1000 && before > 1000);
    }
}

/* Flux that comes from a lamp and goes to the eye is the radiance that the eye sees of that lamp (Veach 1997, 5.3.2):
 * f |cos shading normal| times the geometric cosines' ratio. Also where the shading normal does not face the eye. */
static void flux_goes_where_radiance_comes_from(void **state)
{
    (void)state;
    material all[] = {diffuse(), diffuse_transmission(), coated_diffuse(0.0f, 0.0f)};
    rng random = test_random(13);
    for (int k = 0; k < 3; k++) {
        int beyond = 0;
        for (int i = 0; i < 20000; i++) {
            vec3 normal = vec3_face_forward(random_direction(&random), UP);
            vec3 eye = random_direction(&random), lamp = random_direction(&random);
            bsdf from_eye = bsdf_at(&all[k], normal, eye), from_lamp = bsdf_at(&all[k], normal, lamp);
            rgb radiance = bsdf_evaluate(&from_eye, BSDF_GATHERED, BSDF_RADIANCE, lamp);
            rgb flux = bsdf_evaluate(&from_lamp, BSDF_GATHERED, BSDF_FLUX, eye);
            if (fabsf(vec3_dot(lamp, normal)) >= BSDF_SHADING_NORMAL_MAX * fabsf(lamp.z))
                continue;
            assert_close(flux.g * fabsf(lamp.z), radiance.g * fabsf(eye.z), 1e-5);
            beyond += radiance.g > 0.0f && eye.z * vec3_dot(eye, normal) < 0.0f;
        }
        assert_true(beyond > 1000);
    }
}

/* The flux that a shading normal leaning by 45 or 60 degrees, as on smooth prisms of eight and three sides, reflects of
 * even light is the light that the eye sees: BSDF_SHADING_NORMAL_MAX cuts off less than 1 % of what arrives at diffuse
 * surfaces, and 4 % of what metal sends on. A bound of 8 would cut off 3 % and 11 %. */
static void the_bound_of_shading_normals_keeps_nearly_all_flux(void **state)
{
    (void)state;
    const material all[] = {diffuse(), conductor(0.0f, 0.0f), conductor(0.1f, 0.1f)};
    const float degrees[] = {45.0f, 60.0f};
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 2; i++) {
            rng random = test_random(31);
            const vec3 normal = direction_at(degrees[i], 0.0);
            double flux = 0.0, seen = 0.0, arrived = 0.0, facing = 0.0;
            for (int n = 0; n < SAMPLES; n++) {
                const vec3 from = vec3_face_forward(random_direction(&random), UP);
                const bsdf b = bsdf_at(&all[k], normal, from);
                const float u_lobe = rng_float(&random);
                const vec2 u = rng_vec2(&random);
                bsdf_sample of_flux, of_radiance;
                if (k == 0 && vec3_dot(from, normal) > 0.0f) {
                    arrived += (double)bsdf_arrival_factor(&b) * (double)from.z;
                    facing += (double)vec3_dot(from, normal);
                }
                if (k == 0 || !bsdf_sample_direction(&b, BSDF_TRACED, BSDF_FLUX, u_lobe, u, &of_flux) ||
                    !bsdf_sample_direction(&b, BSDF_TRACED, BSDF_RADIANCE, u_lobe, u, &of_radiance))
                    continue;
                /* the flux through the surface, and the same by the cosines of the shading normal (Veach 1997,
                 * 5.3.2) */
                flux += (double)of_flux.weight.g * (double)from.z;
                seen +=
                    (double)of_radiance.weight.g *
                    fabs((double)(vec3_dot(from, normal) * of_flux.direction.z / vec3_dot(of_flux.direction, normal)));
            }
            const double lost = k == 0 ? 1.0 - arrived / facing : 1.0 - flux / seen;
            print_message("material %d, %g degrees: %.2f %% lost\n", k, (double)degrees[i], 100.0 * lost);
            assert_true(lost >= -1e-5 && lost < (k == 0 ? 0.01 : 0.04));
        }
}

/* Facets scatter by the shading normal alone: the same light as on a surface that lies as the normal says, and that
 * into the surface too. A test of the geometry before lost 13 % of a mirror of six sides (test_program_surface.c). */
static void facets_lose_nothing_where_normals_lean(void **state)
{
    (void)state;
    material all[] = {conductor(0.0f, 0.0f),        conductor(0.1f, 0.3f),
                      dielectric(1.5f, 0.0f, 0.0f), coated_diffuse(0.0f, 0.0f),
                      dielectric(1.5f, 0.4f, 0.2f), principled(1.0f, 0.5f, 0.0f, 0.8f, 0.5f)};
    rng random = test_random(14);
    for (int k = 0; k < 6; k++) {
        int crossed = 0, compared = 0;
        for (int i = 0; i < 5000; i++) {
            vec3 normal = vec3_face_forward(random_direction(&random), UP), out = random_direction(&random);
            bsdf leaning = bsdf_at(&all[k], normal, out), level = leaning;
            level.geometric_normal = normal;
            uint64_t key = (uint64_t)i;
            rng a = test_random(key), b = test_random(key);
            float u_lobe = rng_float(&a), same = rng_float(&b);
            bsdf_sample s, expected;
            bool found = bsdf_sample_direction(&leaning, BSDF_TRACED, BSDF_RADIANCE, u_lobe, rng_vec2(&a), &s);
            assert_true(found ==
                        bsdf_sample_direction(&level, BSDF_TRACED, BSDF_RADIANCE, same, rng_vec2(&b), &expected));
            if (!found)
                continue;
            assert_close(vec3_length(vec3_sub(s.direction, expected.direction)), 0.0, 1e-6);
            assert_close(s.weight.g, expected.weight.g, 1e-5 * (1.0 + (double)expected.weight.g));
            crossed += (s.direction.z * out.z > 0.0f) != (vec3_dot(s.direction, normal) * vec3_dot(out, normal) > 0.0f);
            compared++;
        }
        assert_true(compared > 2000 && crossed > 500);
    }
}

/* A normal that a map tilts sends nothing through the surface, which may be a wall without thickness: neither what is
 * drawn nor what is claimed crosses it, but by glass. */
static void tilted_normals_do_not_leak(void **state)
{
    (void)state;
    material all[] = {conductor(0.0f, 0.0f), conductor(0.3f, 0.3f), coated_diffuse(0.4f, 0.4f),
                      dielectric(1.5f, 0.4f, 0.4f)};
    rng random = test_random(15);
    for (int k = 0; k < 4; k++) {
        int drawn = 0, kept = 0;
        for (int i = 0; i < 5000; i++) {
            vec3 normal = vec3_face_forward(random_direction(&random), UP), out = random_direction(&random);
            vec3 direction = random_direction(&random);
            bsdf leaning = bsdf_at(&all[k], normal, out), tilted = leaning;
            tilted.is_tilted = true;
            bool is_apart =
                (direction.z * out.z > 0.0f) != (vec3_dot(direction, normal) * vec3_dot(out, normal) > 0.0f);
            if (is_apart)
                assert_true(rgb_is_black(bsdf_evaluate(&tilted, BSDF_TRACED, BSDF_RADIANCE, direction)));
            bsdf_sample s;
            float u_lobe = rng_float(&random);
            vec2 u = rng_vec2(&random);
            drawn += bsdf_sample_direction(&leaning, BSDF_TRACED, BSDF_RADIANCE, u_lobe, u, &s);
            if (!bsdf_sample_direction(&tilted, BSDF_TRACED, BSDF_RADIANCE, u_lobe, u, &s))
                continue;
            kept++;
            assert_true((s.direction.z * out.z > 0.0f) ==
                        (vec3_dot(s.direction, normal) * vec3_dot(out, normal) > 0.0f));
        }
        assert_true(kept > 1000 && kept < drawn - 300);
        for (int i = 0; i < 3; i++) {
            bsdf b = bsdf_at(&all[k], direction_at(30.0, 0.0), direction_at(20.0 + 30.0 * i, 180.0));
            b.is_tilted = true;
            check_lobes(&b, BSDF_ALL, SAMPLES / 5, false);
        }
    }
}

/* Seen from both sides, and from between the two horizons: all that is claimed is drawn. */
static void leaning_normals_claim_what_is_drawn(void **state)
{
    (void)state;
    material all[] = {diffuse(),
                      diffuse_transmission(),
                      conductor(0.4f, 0.4f),
                      dielectric(1.5f, 0.4f, 0.4f),
                      coated_diffuse(0.0f, 0.0f),
                      coated_diffuse(0.4f, 0.4f),
                      coated_conductor(0.0f, 0.4f, 0.4f),
                      coated_conductor(0.4f, 0.3f, 0.5f)};
    vec3 normal = direction_at(30.0, 0.0);
    vec3 outs[] = {direction_at(20.0, 50.0), direction_at(60.0, 180.0), direction_at(75.0, 170.0),
                   direction_at(130.0, 20.0), direction_at(105.0, 0.0)};
    for (int k = 0; k < 8; k++)
        for (int i = 0; i < 5; i++) {
            bsdf b = bsdf_at(&all[k], normal, outs[i]);
            check_lobes(&b, BSDF_ALL, SAMPLES / 5, false);
        }
}

/* Photons meet most surfaces without a bsdf: what it would have said must come out. */
static void lambert_alone_is_the_same(void **state)
{
    (void)state;
    material m = diffuse();
    const material_point point = point_of(&m);
    rng random = test_random(12);
    int absorbed = 0, dark = 0;
    for (int i = 0; i < 20000; i++) {
        surface_hit hit = {.geometric_normal = random_direction(&random)};
        hit.shading_normal = vec3_face_forward(random_direction(&random), hit.geometric_normal);
        if (i % 2)
            hit.shading_normal = hit.geometric_normal;
        vec3 arrived = random_direction(&random), direction;
        bsdf b;
        bsdf_init_of(&point, &hit, vec3_negate(arrived), &b);
        assert_relative(lambert_arrival_factor(&hit, arrived), bsdf_arrival_factor(&b), 1e-6);
        dark += bsdf_arrival_factor(&b) == 0.0f;
        vec2 u = rng_vec2(&random);
        bsdf_sample s;
        float correction;
        bool goes_on = bsdf_sample_direction(&b, BSDF_ALL, BSDF_FLUX, 0.0f, u, &s);
        assert_true(lambert_sample_flux(&hit, arrived, u, &direction, &correction) == goes_on);
        absorbed += !goes_on;
        if (!goes_on)
            continue;
        assert_close(vec3_length(vec3_sub(direction, s.direction)), 0.0, 1e-6);
        assert_close(correction, s.weight.r / m.reflectance.r, 1e-4);
    }
    assert_true(absorbed > 1000 && dark > 1000);
}

static void what_is_lambertian(void **state)
{
    (void)state;
    scene s = {0};
    shape at = shape_make(SHAPE_DISK);
    material m = diffuse();
    s.shapes = &at, s.materials = &m;
    surface_hit hit = {.distance = 1.0f};
    prepare(&m);
    assert_ptr_equal(lambert_albedo(&s, &hit), &m.reflectance);
    hit.is_strand = true;
    assert_null(lambert_albedo(&s, &hit));
    hit.is_strand = false;
    uint32_t *const textures[] = {&m.reflectance_texture, &m.displacement_texture, &m.normal_map_texture};
    for (int i = 0; i < 3; i++) {
        *textures[i] = 0;
        prepare(&m);
        assert_null(lambert_albedo(&s, &hit));
        *textures[i] = SCENE_NO_TEXTURE;
    }
    m = diffuse_transmission();
    prepare(&m);
    assert_null(lambert_albedo(&s, &hit));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_white_furnace_stays_white),
        cmocka_unit_test(diffuse_weights_are_the_reflectance),
        cmocka_unit_test(radiance_and_flux_differ_by_the_square_of_the_index),
        cmocka_unit_test(smooth_glass_obeys_fresnel_and_snell),
        cmocka_unit_test(smooth_metal_obeys_fresnel),
        cmocka_unit_test(an_index_of_one_is_passed_straight),
        cmocka_unit_test(shading_normals_never_let_diffuse_light_through),
        cmocka_unit_test(diffuse_light_ends_at_the_shading_horizon),
        cmocka_unit_test(the_bound_of_shading_normals_keeps_nearly_all_flux),
        cmocka_unit_test(facets_lose_nothing_where_normals_lean),
        cmocka_unit_test(tilted_normals_do_not_leak),
        cmocka_unit_test(leaning_normals_claim_what_is_drawn),
        cmocka_unit_test(flux_goes_where_radiance_comes_from),
        cmocka_unit_test(lambert_alone_is_the_same),
        cmocka_unit_test(what_is_lambertian),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
