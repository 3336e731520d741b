/* test_bsdf_principled.c: glTF's material: energy, closed forms of its parts. See test_bsdf_table.c too.
 * Threads: one. */
#include "fixtures/bsdf_fixture.h"
#include "material/fresnel.h"
#include "material/microfacet.h"
#include "material/principled.h"

enum { SAMPLES = 30000 / FEWER };

/* --- energy --- */

/* Green of diffuse flux that leaves of 1 that came: of a product, that of its two factors. */
static double gathered_furnace(const bsdf *b)
{
    enum { STEPS = 64 };
    double mean = 0.0;
    for (int i = 0; i < STEPS; i++) {
        double cosine = (i + 0.5) / STEPS;
        bsdf in = bsdf_of_point(&b->material, UP,
                                (vec3){(float)sqrt(1.0 - cosine * cosine), 0.0f, copysignf((float)cosine, b->out.z)});
        mean += 2.0 * cosine * (double)bsdf_arrival_factor(&in) / STEPS;
    }
    return mean * (double)bsdf_gathered_reflection(b).g;
}

/* The furnace's value of the lobes asked for: a mean over an even grid for each lobe, weighted by the lobe's
 * probability. */
static double furnace_of(const bsdf *b, bsdf_lobes lobes)
{
    enum { STEPS = 24 };
    double sum = 0.0;
    for (int k = 0; k < b->lobe_count; k++) {
        bsdf one = *b;
        if (!(bsdf_lobe_set(b, lobes) >> k & 1))
            continue;
        if (b->gathered_lobes >> k & 1) {
            sum += gathered_furnace(b);
            continue;
        }
        bsdf_keep_lobe(&one, k);
        for (int i = 0; i < STEPS * STEPS; i++) {
            bsdf_sample s;
            vec2 u = {((float)(i / STEPS) + 0.5f) / STEPS, ((float)(i % STEPS) + 0.5f) / STEPS};
            double turn = 0.6180339887 * i;
            if (bsdf_sample_direction(&one, BSDF_ALL, BSDF_FLUX, (float)(turn - floor(turn)), u, &s))
                sum += (double)s.weight.g / (STEPS * STEPS);
        }
    }
    return sum;
}

static void nothing_gains(void **state)
{
    (void)state;
    static const float PARTS[] = {0.0f, 0.5f, 1.0f}, ROUGHNESSES[] = {0.0f, 0.1f, 0.4f, 1.0f};
    static const float IORS[] = {1.0f, 1.5f, 2.5f, 0.0f};
    double most = 0.0;
    for (int index = 0; index<3 * 4 * 3 * 3 * 2 * 4; index += FEWER> 1 ? 35 : 5) {
        int rest = index;
        material m = principled(PARTS[rest % 3], ROUGHNESSES[rest / 3 % 4], 0.0f, 0.0f, 0.0f);
        rest /= 12;
        m.transmission = PARTS[rest % 3], m.clearcoat = PARTS[rest / 3 % 3];
        rest /= 9;
        m.is_thin = rest % 2, m.ior = IORS[rest / 2];
        m.clearcoat_roughness = ROUGHNESSES[index % 4];
        m.reflectance = rgb_gray(1.0f);
        m.specular_color = (rgb){0.5f, 1.0f, 3.0f};
        for (double degrees = 4.0; degrees < 180.0; degrees += 41.0) {
            bsdf b = flat(&m, direction_at(degrees, 20.0));
            double sum = furnace_of(&b, BSDF_ALL);
            most = fmax(most, sum);
            if (!(sum <= 1.006))
                fail_msg("metallic %g, roughness %g, transmission %g, clearcoat %g, ior %g, thin %d, %g degrees: %g",
                         (double)m.metallic, (double)m.roughness, (double)m.transmission, (double)m.clearcoat,
                         (double)m.ior, m.is_thin, degrees, sum);
        }
    }
    print_message("at most %.4f\n", most);
}

/* A white base under an interface gives all back, whatever the roughness: what facets lose goes to the base. Metal and
 * glass lose what their facets mask, and a coat a little more. */
static void a_white_furnace(void **state)
{
    (void)state;
    static const float ROUGHNESSES[] = {0.0f, 0.3f, 0.6f, 1.0f};
    static const char *const NAMES[] = {"plastic",      "coated plastic", "metal",
                                        "coated metal", "thin glass",     "solid glass"};
    static const double LEAST[6][4] = {{0.999, 0.999, 0.999, 0.999}, {0.999, 0.98, 0.99, 0.995},
                                       {0.999, 0.89, 0.77, 0.30},    {0.999, 0.90, 0.75, 0.31},
                                       {0.999, 0.89, 0.77, 0.30},    {0.999, 0.93, 0.87, 0.70}};
    for (int k = 0; k < 6; k++)
        for (int r = 0; r < 4; r++) {
            material m = principled(k == 2 || k == 3, ROUGHNESSES[r], k >= 4, k == 1 || k == 3, 0.0f);
            m.is_thin = k != 5;
            m.reflectance = rgb_gray(1.0f);
            double least = 2.0, most = 0.0;
            for (double degrees = 2.0; degrees < 84.0; degrees += 10.0) {
                bsdf b = flat(&m, direction_at(degrees, 20.0));
                double sum = furnace_of(&b, BSDF_ALL);
                least = fmin(least, sum), most = fmax(most, sum);
            }
            print_message("%s, roughness %g: %.4f to %.4f\n", NAMES[k], (double)ROUGHNESSES[r], least, most);
            if (!(least >= LEAST[k][r] && most <= 1.006))
                fail_msg("%s, roughness %g: %g to %g", NAMES[k], (double)ROUGHNESSES[r], least, most);
        }
}

/* Brushed facets and the base below them reflect no more light than comes, whatever its direction about the normal:
 * the base gets what the axis that reflects more leaves to it. */
static void brushed_surfaces_gain_nothing(void **state)
{
    (void)state;
    double least = 2.0, most = 0.0;
    for (int k = 0; k < 6; k++)
        for (double degrees = 4.0; degrees < 88.0; degrees += 14.0 * FEWER)
            for (double turn = 0.0; turn <= 90.0; turn += 30.0) {
                static const float ROUGHNESSES[6][2] = {{0.1f, 0.5f}, {0.1f, 1.0f},  {0.3f, 0.9f},
                                                        {0.5f, 0.8f}, {0.05f, 0.3f}, {0.9f, 0.2f}};
                material m =
                    along_grain(principled(0.0f, ROUGHNESSES[k][0], 0.0f, 0.0f, 0.0f), ROUGHNESSES[k][1], 0.0f);
                m.reflectance = rgb_gray(1.0f);
                bsdf b = flat(&m, direction_at(degrees, turn));
                const double sum = furnace_of(&b, BSDF_ALL);
                least = fmin(least, sum), most = fmax(most, sum);
            }
    print_message("from %.4f to %.4f\n", least, most);
    assert_true(least > 0.79 && most < 1.006);
}

/* --- closed forms --- */

static double schlick(double f0, double f90, double cosine) { return f0 + (f90 - f0) * pow(1.0 - cosine, 5.0); }

static void metals_and_plastics_reflect_as_gltf_says(void **state)
{
    (void)state;
    rng random = test_random(24);
    for (int i = 0; i < 2000; i++) {
        vec3 o = random_direction(&random), d = random_direction(&random);
        d.z = copysignf(d.z, o.z);
        if (fabsf(o.z) < 0.05f || fabsf(d.z) < 0.05f)
            continue;
        material m = principled(i % 3 == 0 ? 1.0f : i % 3 == 1 ? 0.25f : 0.0f, 0.6f, 0.0f, 0.0f, 0.0f);
        m.specular = 0.8f, m.specular_color = (rgb){1.0f, 30.0f, 0.0f}, m.ior = 1.8f;
        vec3 h = vec3_normalize(vec3_add(o, d));
        double alpha = 0.36, hz = h.z, t = hz * hz * (alpha * alpha - 1.0) + 1.0;
        double density = alpha * alpha / (PI * t * t);
        double zo = fabs((double)o.z), zd = fabs((double)d.z);
        double lo = sqrt(alpha * alpha + (1 - alpha * alpha) * zo * zo),
               ld = sqrt(alpha * alpha + (1 - alpha * alpha) * zd * zd);
        double visibility = 0.5 / (zd * lo + zo * ld), oh = vec3_dot(o, h);
        const double f0[3] = {0.8 * 0.64 / 7.84, 0.8, 0.0}; /* (0.8 / 2.8)^2 */
        const double base[3] = {0.9f, 0.6f, 0.2f};
        bsdf b = flat(&m, o);
        rgb value = bsdf_evaluate(&b, BSDF_TRACED, BSDF_RADIANCE, d);
        const double got[3] = {value.r, value.g, value.b};
        for (int c = 0; c < 3; c++) {
            double green = c == 1 ? fmin(0.8 * 30.0 * 0.64 / 7.84, 0.8) : f0[c], metallic = m.metallic;
            double f = (1.0 - metallic) * schlick(green, 0.8, oh) + metallic * schlick(base[c], 1.0, oh);
            assert_close(got[c], f * density * visibility * zd, 2e-3 * got[c] + 1e-6);
        }
    }
}

/* The shares of u_lobe that a smooth surface, seen under an angle, gives to each way on. */
typedef struct ways {
    double reflected, through;
    vec3 passed;
} ways;

static ways smooth_ways(const bsdf *b, bsdf_transport transport)
{
    enum { STEPS = 20000 };
    ways w = {0.0, 0.0, {0.0f, 0.0f, 0.0f}};
    for (int i = 0; i < STEPS; i++) {
        bsdf_sample s;
        assert_true(
            bsdf_sample_direction(b, BSDF_TRACED, transport, ((float)i + 0.5f) / STEPS, (vec2){0.3f, 0.3f}, &s));
        assert_true(s.is_delta);
        bool is_reflection = s.direction.z * b->out.z > 0.0f;
        *(is_reflection ? &w.reflected : &w.through) += (double)s.weight.g / STEPS;
        if (is_reflection)
            assert_close(vec3_distance_squared(s.direction, (vec3){-b->out.x, -b->out.y, b->out.z}), 0.0, 1e-10);
        else
            w.passed = s.direction;
    }
    return w;
}

static void smooth_glass_thin_and_solid(void **state)
{
    (void)state;
    for (double degrees = 1.0; degrees < 180.0; degrees += 17.0) {
        material m = principled(0.0f, 0.0f, 0.75f, 0.0f, 0.0f);
        vec3 out = direction_at(degrees, 33.0);
        double cosine = fabs(cos(degrees * PI / 180.0)), f = schlick(0.04, 1.0, cosine);
        bsdf b = flat(&m, out);
        ways w = smooth_ways(&b, BSDF_RADIANCE);
        assert_close(w.reflected, f, 1e-3);
        assert_close(w.through, 0.75 * 0.6 * (1.0 - f), 1e-3);
        assert_close(vec3_distance_squared(w.passed, vec3_negate(out)), 0.0, 1e-11); /* straight on */
        double diffuse = furnace_of(&b, BSDF_GATHERED);
        assert_close(diffuse, 0.25 * 0.6 * (1.0 - f), 5e-3);

        m = solid(m, 1.5f);
        b = flat(&m, out);
        double sine = sqrt(1.0 - cosine * cosine) * (out.z < 0.0f ? 1.5 : 1.0 / 1.5);
        if (out.z < 0.0f) /* within the glass: as from outside at the refracted angle, or totally; the rest is opaque */
            f = 0.25 * f + 0.75 * (sine >= 1.0 ? 1.0 : schlick(0.04, 1.0, sqrt(1.0 - sine * sine)));
        for (int t = BSDF_RADIANCE; t <= BSDF_FLUX; t++) {
            w = smooth_ways(&b, (bsdf_transport)t);
            assert_close(w.reflected, f, 1e-3);
            if (sine >= 1.0) {
                assert_true(w.through == 0.0);
                continue;
            }
            double entered = out.z < 0.0f ? schlick(0.04, 1.0, sqrt(1.0 - sine * sine)) : f;
            double compressed = t == BSDF_FLUX ? 1.0 : out.z < 0.0f ? 2.25 : 1.0 / 2.25;
            assert_close(w.through, 0.75 * 0.6 * (1.0 - entered) * compressed, 3e-3);
            double bent = sqrt((double)w.passed.x * (double)w.passed.x + (double)w.passed.y * (double)w.passed.y);
            assert_close(bent, sine, 1e-5);
        }
    }
}

/* Rough thin glass: the lobe of reflection, mirrored; no index squared. */
static void a_rough_thin_wall_mirrors_its_reflection(void **state)
{
    (void)state;
    rng random = test_random(25);
    material m = principled(0.0f, 0.5f, 1.0f, 0.0f, 0.0f);
    for (int i = 0; i < 1000; i++) {
        vec3 o = random_direction(&random), d = random_direction(&random), mirrored = {d.x, d.y, -d.z};
        if (o.z * d.z < 0.0f || fabsf(o.z) < 0.05f)
            continue;
        bsdf b = flat(&m, o);
        double f = schlick(0.04, 1.0, fabs((double)vec3_dot(o, vec3_normalize(vec3_add(o, d)))));
        double reflected = bsdf_evaluate(&b, BSDF_ALL, BSDF_RADIANCE, d).g;
        double through = bsdf_evaluate(&b, BSDF_ALL, i % 2 ? BSDF_FLUX : BSDF_RADIANCE, mirrored).g;
        assert_close(through * f, reflected * 0.6 * (1.0 - f), 1e-3 * reflected + 1e-7);
    }
}

static void a_coat_takes_its_share(void **state)
{
    (void)state;
    material coated = principled(1.0f, 0.0f, 0.0f, 0.5f, 0.0f), bare = principled(1.0f, 0.0f, 0.0f, 0.0f, 0.0f);
    for (double degrees = 1.0; degrees < 90.0; degrees += 11.0) {
        vec3 out = direction_at(degrees, 200.0);
        bsdf a = flat(&coated, out), b = flat(&bare, out);
        double f = 0.5 * schlick(0.04, 1.0, cos(degrees * PI / 180.0));
        assert_close(furnace_of(&a, BSDF_ALL), f + (1.0 - f) * furnace_of(&b, BSDF_ALL), 2e-3);
    }
}

/* --- what is there at all --- */

static void parts_that_carry_nothing_are_left_out(void **state)
{
    (void)state;
    material metal = principled(1.0f, 0.3f, 1.0f, 0.0f, 0.0f), matte = principled(0.0f, 0.3f, 0.0f, 0.0f, 0.0f);
    matte.specular = 0.0f;
    material all = principled(0.2f, 0.3f, 0.2f, 1.0f, 0.1f), black = principled(0.0f, 0.3f, 0.0f, 0.0f, 0.0f);
    black.reflectance = rgb_gray(0.0f);
    bsdf b = flat(&metal, UP);
    assert_true(b.lobe_count == 1 && !bsdf_has(&b, BSDF_GATHERED));
    b = flat(&matte, UP);
    assert_true(b.lobe_count == 1 && !bsdf_has(&b, BSDF_TRACED));
    rgb value = bsdf_evaluate(&b, BSDF_ALL, BSDF_RADIANCE, UP);
    assert_close(value.g, 0.6 / PI, 1e-3); /* Lambert's: nothing lies on it */
    b = flat(&black, UP);
    assert_true(b.lobe_count == 1 && !bsdf_has(&b, BSDF_GATHERED));
    b = flat(&all, UP);
    assert_true(b.lobe_count == 3 && bsdf_scatters_through(&b, BSDF_TRACED) &&
                !bsdf_scatters_through(&b, BSDF_GATHERED));
    all.transmission = 0.0f;
    b = flat(&all, UP);
    assert_true(b.lobe_count == 3 && !bsdf_scatters_through(&b, BSDF_ALL));
    all.transmission = 0.2f;
    all.is_thin = false; /* within the volume there is no coat */
    b = flat(&all, vec3_negate(UP));
    assert_true(b.lobe_count == 2);
    matte.reflectance = rgb_gray(0.0f);
    b = flat(&matte, UP);
    bsdf_sample s;
    assert_true(!bsdf_sample_direction(&b, BSDF_ALL, BSDF_RADIANCE, 0.5f, (vec2){0.5f, 0.5f}, &s) ||
                rgb_is_black(s.weight));
}

static void wild_values_are_bounded(void **state)
{
    (void)state;
    material m = material_make(MATERIAL_PRINCIPLED);
    m.reflectance = (rgb){7.0f, -1.0f, NAN};
    m.metallic = NAN, m.roughness = -2.0f, m.transmission = 3.0f, m.specular = 2.0f, m.clearcoat = INFINITY;
    m.specular_color = (rgb){-1.0f, NAN, INFINITY};
    m.ior = 0.3f;
    prepare(&m);
    assert_true(m.reflectance.r == 1.0f && m.reflectance.g == 0.0f && m.reflectance.b == 0.0f);
    assert_true(m.metallic == 0.0f && m.alpha_u == 0.0f && m.transmission == 1.0f && m.specular == 1.0f);
    assert_true(m.clearcoat == 1.0f && m.ior == 1.0f);
    rng random = test_random(26);
    for (int i = 0; i < 100; i++) {
        bsdf b = flat(&m, random_direction(&random));
        bsdf_sample s;
        float u_lobe = rng_float(&random);
        if (bsdf_sample_direction(&b, BSDF_ALL, BSDF_FLUX, u_lobe, rng_vec2(&random), &s))
            assert_true(rgb_is_finite(s.weight));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_gains),
        cmocka_unit_test(a_white_furnace),
        cmocka_unit_test(brushed_surfaces_gain_nothing),
        cmocka_unit_test(metals_and_plastics_reflect_as_gltf_says),
        cmocka_unit_test(smooth_glass_thin_and_solid),
        cmocka_unit_test(a_rough_thin_wall_mirrors_its_reflection),
        cmocka_unit_test(a_coat_takes_its_share),
        cmocka_unit_test(parts_that_carry_nothing_are_left_out),
        cmocka_unit_test(wild_values_are_bounded),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
