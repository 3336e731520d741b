/* test_hair.c: how hair scatters: what it keeps in a furnace and what it absorbs, in closed form; the model written out
 * with libm; where light is reflected to; photons beside the eye. See test_bsdf_table.c for its samples and density.
 * Rests on: Chiang et al., "A Practical and Controllable Hair and Fur Model for Production Path Tracing", 2016.
 * Threads: one. */
#include "fixtures/bsdf_fixture.h"
#include "material/fresnel.h"

static material hair(float beta_m, float beta_n, float tilt_degrees, float sigma_a)
{
    material m = material_make(MATERIAL_HAIR);
    m.ior = 1.55f;
    m.hair_beta_m = beta_m, m.hair_beta_n = beta_n, m.hair_tilt_degrees = tilt_degrees;
    m.hair_sigma_a = rgb_make(sigma_a, 2.0f * sigma_a, 4.0f * sigma_a);
    return m;
}

/* The direction of theta, the angle to the plane across the axis x, and of phi about that axis. */
static vec3 toward(double theta, double phi)
{
    return (vec3){(float)sin(theta), (float)(cos(theta) * cos(phi)), (float)(cos(theta) * sin(phi))};
}

/* The fibre is kept for the next point alone, or for two of one material. */
static hair_point point_at(const material *m, float v, vec3 out)
{
    static hair_fibre fibre;
    fibre = hair_fibre_make(m->ior, m->hair_beta_m, m->hair_beta_n, m->hair_tilt_degrees);
    return hair_point_at(&fibre, m->hair_sigma_a, v, out);
}

static rgb scattered(const hair_point *h, bool is_flux, vec3 direction)
{
    rgb value;
    float pdf;
    hair_evaluate(h, is_flux, true, direction, &value, &pdf);
    return value;
}

/* The radiance that leaves for the eye in a furnace of radiance 1. */
static rgb furnace_of(const hair_point *h)
{
    enum { ROWS = 160, COLUMNS = 160 };
    double sum[3] = {0.0, 0.0, 0.0};
    for (int j = 0; j < ROWS; j++)
        for (int k = 0; k < COLUMNS; k++) {
            double sine = -1.0 + 2.0 * (j + 0.5) / ROWS;
            rgb value = scattered(h, false, toward(asin(sine), 2.0 * PI * (k + 0.5) / COLUMNS));
            sum[0] += (double)value.r, sum[1] += (double)value.g, sum[2] += (double)value.b;
        }
    float cell = (float)(4.0 * PI / ROWS / COLUMNS);
    return rgb_scale(rgb_make((float)sum[0], (float)sum[1], (float)sum[2]), cell);
}

static void white_hair_keeps_all(void **state)
{
    (void)state;
    static const float BETAS[][2] = {{0.3f, 0.3f}, {0.25f, 0.8f}, {0.6f, 0.2f}, {1.0f, 1.0f}};
    for (int k = 0; k < 4; k++)
        for (int i = 0; i < 5; i++) {
            material m = hair(BETAS[k][0], BETAS[k][1], 2.0f, 0.0f);
            hair_point h = point_at(&m, 0.03f + 0.22f * (float)i, toward(-1.2 + 0.6 * i, 0.4 + i));
            rgb all = furnace_of(&h);
            assert_close(all.r, 1.0, 2e-3);
        }
}

/* Straight through the middle light goes by the diameter each time: R + (1 - R)^2 T / (1 - R T). */
static void colored_hair_absorbs(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        material m = hair(0.4f, 0.4f, 0.0f, 0.05f * (float)(1 + k));
        hair_point h = point_at(&m, 0.5f, toward(0.0, 1.0));
        rgb all = furnace_of(&h);
        double r = (double)fresnel_dielectric(1.0f, 1.55f);
        const float values[3] = {all.r, all.g, all.b};
        for (int c = 0; c < 3; c++) {
            double t = exp(-0.1 * (1 + k) * (1 << c));
            assert_close(values[c], r + (1.0 - r) * (1.0 - r) * t / (1.0 - r * t), 2e-3);
        }
    }
}

/* --- the model, written out --- */

static double bessel_i0(double x)
{
    double sum = 0.0;
    for (int k = 0; k < 400; k++)
        sum += exp(x * cos(PI * (k + 0.5) / 400)) / 400;
    return sum;
}

static double logistic_in_turn(double x, double s)
{
    x = remainder(x, 2.0 * PI);
    return exp(-fabs(x) / s) / (s * pow(1.0 + exp(-fabs(x) / s), 2)) / tanh(PI / (2.0 * s));
}

static double written_out(const material *m, double offset, double theta_o, double theta_i, double turn)
{
    double bm = (double)m->hair_beta_m, bn = (double)m->hair_beta_n, eta = (double)m->ior, sum = 0.0;
    double root = 0.726 * bm + 0.812 * bm * bm + 3.7 * pow(bm, 20), tilt = (double)m->hair_tilt_degrees * PI / 180.0;
    double s = sqrt(PI / 8.0) * (0.265 * bn + 1.194 * bn * bn + 5.372 * pow(bn, 22));
    double bent = sqrt(eta * eta - sin(theta_o) * sin(theta_o)) / cos(theta_o), within = asin(offset / bent);
    double t = exp(-(double)m->hair_sigma_a.r * 2.0 * cos(within) / cos(asin(sin(theta_o) / eta)));
    double f = (double)fresnel_dielectric((float)(cos(theta_o) * cos(asin(offset))), m->ior);
    const double shares[4] = {f, (1 - f) * (1 - f) * t, (1 - f) * (1 - f) * t * t * f,
                              (1 - f) * (1 - f) * pow(t, 3) * f * f / (1 - t * f)};
    const double shifts[4] = {-2.0 * tilt, tilt, 4.0 * tilt, 0.0}, widths[4] = {1.0, 0.25, 4.0, 4.0};
    for (int p = 0; p < 4; p++) {
        double v = widths[p] * root * root, o = theta_o + shifts[p];
        double along =
            bessel_i0(cos(theta_i) * fabs(cos(o)) / v) * exp(-sin(theta_i) * sin(o) / v) / (2.0 * v * sinh(1.0 / v));
        double middle = 2.0 * p * within - 2.0 * asin(offset) + p * PI;
        sum += shares[p] * along * (p < 3 ? logistic_in_turn(turn - middle, s) : 0.5 / PI);
    }
    return sum;
}

static void values_are_those_of_the_model(void **state)
{
    (void)state;
    rng random = test_random(3);
    for (int k = 0; k < 2000; k++) {
        material m = hair(0.15f + 0.8f * rng_float(&random), 0.1f + 0.9f * rng_float(&random),
                          6.0f * rng_float(&random), rng_float(&random));
        float v = rng_float(&random);
        double o = 2.8 * (double)rng_float(&random) - 1.4, i = 2.8 * (double)rng_float(&random) - 1.4;
        double phi = 6.0 * (double)rng_float(&random), turn = 6.0 * (double)rng_float(&random) - 3.0;
        double expected = written_out(&m, 1.0 - 2.0 * (double)v, o, i, turn);
        hair_point h = point_at(&m, v, toward(o, phi));
        rgb value = scattered(&h, false, toward(i, phi + turn));
        assert_close(value.r, expected, 1e-3 * expected + 1e-5);
    }
}

/* --- photons --- */

/* Over all offsets across, light that comes from a and leaves to b is as much, seen from either end: photons meet a
 * fibre as often as it seems wide to them. */
static void photons_and_eye_agree(void **state)
{
    (void)state;
    rng random = test_random(5);
    material m = hair(0.4f, 0.5f, 3.0f, 0.2f);
    for (int k = 0; k < 200; k++) {
        double theta_a = 2.4 * (double)rng_float(&random) - 1.2, theta_b = 2.4 * (double)rng_float(&random) - 1.2;
        vec3 a = toward(theta_a, 6.0 * (double)rng_float(&random)), b = toward(theta_b, 1.0);
        double eye = 0.0, photons = 0.0;
        enum { OFFSETS = 64 };
        for (int i = 0; i < OFFSETS; i++) {
            float v = ((float)i + 0.5f) / OFFSETS;
            hair_point of_eye = point_at(&m, v, b), of_photon = point_at(&m, v, a);
            eye += (double)scattered(&of_eye, false, a).r * cos(theta_b) / OFFSETS;
            photons += (double)scattered(&of_photon, true, b).r * cos(theta_a) / OFFSETS;
        }
        assert_close(photons, eye, 1e-3 * eye + 1e-6);
    }
}

/* --- where on a curve --- */

/* Black hair, all but smooth, mirrors: about the normal of the tube that a flat curve stands for, and a ribbon, from
 * whichever side it is seen. */
static void reflection_is_that_of_a_tube(void **state)
{
    (void)state;
    test_run run;
    test_run_init(&run, 1);
    static const char *const TYPES[] = {"flat", "cylinder",
                                        "ribbon\" \"normal N\" [0 0 1 0 0 1] \"string basis\" \"bezier",
                                        "ribbon\" \"normal N\" [0 0 -1 0 0 -1] \"string basis\" \"bezier"};
    enum { TYPE_COUNT = sizeof TYPES / sizeof *TYPES };
    for (int k = 0; k < 2 * TYPE_COUNT; k++) {
        char text[512];
        snprintf(
            text, sizeof text,
            "Material \"hair\" \"rgb sigma_a\" [99 99 99] \"float beta_m\" .05 \"float beta_n\" .05 \"float alpha\" "
            "0 %s Shape \"curve\" \"string type\" \"%s\" \"float width\" 2 \"point3 P\" [0 -9 0 0 -3 0 0 3 0 0 9 0]",
            k < TYPE_COUNT ? "" : "ReverseOrientation", TYPES[k % TYPE_COUNT]);
        scene *s = test_scene_create(&run, text);
        for (int i = 0; i < 7; i++) {
            float x = -0.75f + 0.25f * (float)i;
            scene_ray down = scene_ray_make((vec3){x, 0.5f, 5.0f}, (vec3){0.0f, 0.0f, -1.0f});
            surface_hit hit;
            assert_true(scene_intersect(s, down, INFINITY, &hit));
            bsdf b;
            bsdf_init(s, &hit, UP, &b);
            vec3 normal = {x, 0.0f, sqrtf(1.0f - x * x)}, mean = {0.0f, 0.0f, 0.0f};
            rng random = test_random(7);
            for (int n = 0; n < 400; n++) {
                bsdf_sample sample;
                if (bsdf_sample_direction(&b, BSDF_ALL, BSDF_RADIANCE, rng_float(&random), rng_vec2(&random), &sample))
                    mean = vec3_add(mean, sample.direction);
            }
            vec3 mirrored = {2.0f * normal.z * normal.x, 0.0f, 2.0f * normal.z * normal.z - 1.0f};
            mean = vec3_normalize(mean);
            assert_true(vec3_dot(mean, mirrored) > 0.995f);
        }
        scene_destroy(s);
    }
    test_run_reset(&run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(white_hair_keeps_all),          cmocka_unit_test(colored_hair_absorbs),
        cmocka_unit_test(values_are_those_of_the_model), cmocka_unit_test(photons_and_eye_agree),
        cmocka_unit_test(reflection_is_that_of_a_tube),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
