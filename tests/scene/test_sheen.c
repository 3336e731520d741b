/* test_sheen.c: the sheen of fibres: closed forms, the table of what is reflected in all, energy of cloth in a furnace,
 * and the roughness that has a direction. test_bsdf_table.c holds samples against densities, and both ways against each
 * other. Threads: one. */
#define _POSIX_C_SOURCE 200809L
#include "fixtures/bsdf_fixture.h"
#include "fixtures/temporary_folder.h"
#include "material/principled.h"
#include "material/sheen.h"
#include "output/image_file.h"

/* The share that is reflected of light from `cosine`, over directions that are dense along the surface. */
static double integrate(sheen_model model, double roughness, double cosine)
{
    enum { STEPS = 300 / FEWER };
    const vec3 o = {(float)sqrt(1.0 - cosine * cosine), 0.0f, (float)cosine};
    double sum = 0.0;
    for (int k = 0; k < STEPS; k++) {
        const double x = (k + 0.5) / STEPS, z = x * x, radius = sqrt(1.0 - z * z);
        for (int i = 0; i < STEPS; i++) {
            const double turn = (i + 0.5) / STEPS * PI; /* one half is as the other */
            const vec3 d = {(float)(radius * cos(turn)), (float)(radius * sin(turn)), (float)z};
            sum += (double)sheen_value(model, (float)roughness, o, d) * z * 2.0 * x;
        }
    }
    return sum * 2.0 * PI / STEPS / STEPS;
}

static const sheen_model MODELS[] = {SHEEN_CHARLIE, SHEEN_SCHLICK, SHEEN_VELVET};

/* --- closed forms --- */

/* At a right angle the half vector is half way down: with c its cosine, the integral of 8 pi c (1 - c)^5 (2 c^2 - 1)
 * from c = cos 45 degrees to 1. */
static double schlick_at_right_angle(void)
{
    static const double BINOMIAL[6] = {1, -5, 10, -10, 5, -1};
    double sum = 0.0;
    for (int k = 0; k < 6; k++) {
        const double a = k + 4, b = k + 2;
        sum += BINOMIAL[k] * (2.0 * (1.0 - pow(0.5, 0.5 * a)) / a - (1.0 - pow(0.5, 0.5 * b)) / b);
    }
    return 8.0 * PI * sum;
}

static void schlick_has_a_closed_form(void **state)
{
    (void)state;
    const double expected = schlick_at_right_angle();
    print_message("at a right angle %.6f\n", expected);
    assert_close(integrate(SHEEN_SCHLICK, 0.0, 1.0), expected, 0.01 * expected);
    assert_close(sheen_albedo(SHEEN_SCHLICK, 0.0f, 1.0f), expected, 2e-5);
    rng random = test_random(31);
    for (int i = 0; i < 1000; i++) {
        vec3 o = random_direction(&random), d = random_direction(&random);
        o.z = fabsf(o.z), d.z = fabsf(d.z);
        /* half the angle between the two: cos^2 = (1 + cos) / 2 */
        const double half = sqrt(fmax(0.0, 0.5 * (1.0 + (double)vec3_dot(o, d))));
        assert_close(sheen_value(SHEEN_SCHLICK, 0.3f, o, d), pow(1.0 - half, 5.0), 1e-5);
    }
}

/* One pair of directions by the extension's own formulas, in double. */
static void charlie_is_khronoss(void **state)
{
    (void)state;
    /* a roughness of 0.6, and cosines of 0.8 and 0.3 in one plane */
    const double alpha = 0.36, t = (1.0 - alpha) * (1.0 - alpha);
    const double a = 21.5473 + (25.3245 - 21.5473) * t, b = 3.82987 + (3.32435 - 3.82987) * t,
                 c = 0.19823 + (0.16801 - 0.19823) * t, d = -1.97760 + (1.97760 - 1.27393) * t,
                 e = -4.32054 + (4.32054 - 4.85967) * t;
    const double at_half = a / (1.0 + b * pow(0.5, c)) + d * 0.5 + e;
    const double high = exp(2.0 * at_half - (a / (1.0 + b * pow(0.2, c)) + d * 0.2 + e));
    const double low = exp(a / (1.0 + b * pow(0.3, c)) + d * 0.3 + e);
    const double ox = 0.6, oz = 0.8, ix = -sqrt(1.0 - 0.09), iz = 0.3;
    const double hx = ox + ix, hz = oz + iz, sine2 = hx * hx / (hx * hx + hz * hz);
    const double density = (2.0 + 1.0 / alpha) * pow(sine2, 0.5 / alpha) / (2.0 * PI);
    const double expected = density / ((1.0 + high + low) * 4.0 * oz * iz);
    const vec3 o = {(float)ox, 0.0f, (float)oz}, i = {(float)ix, 0.0f, (float)iz};
    assert_close(sheen_value(SHEEN_CHARLIE, 0.6f, o, i), expected, 1e-4 * expected);
}

/* Grooves hide nothing from light along the surface that other grooves do not reflect. */
static void velvet_reflects_all_at_grazing_angles(void **state)
{
    (void)state;
    for (double sigma = 0.2; sigma <= 1.0; sigma += 0.2) {
        assert_close(integrate(SHEEN_VELVET, sigma, 1e-3), 1.0, 0.01);
        assert_close(sheen_albedo(SHEEN_VELVET, (float)sigma, 1e-3f), 1.0, 0.01);
    }
}

/* --- the table --- */

static void albedo_is_the_integral(void **state)
{
    (void)state;
    double worst = 0.0, most = 0.0;
    for (int k = 0; k < 3; k++)
        for (double roughness = 0.07; roughness <= 1.0; roughness += 0.081 * FEWER)
            for (double cosine = 0.021; cosine <= 1.0; cosine += 0.0612 * FEWER) {
                const double sum = integrate(MODELS[k], roughness, cosine);
                const double table = (double)sheen_albedo(MODELS[k], (float)roughness, (float)cosine);
                const double factor = (double)sheen_factor_max(MODELS[k]);
                const bool is_bound = MODELS[k] == SHEEN_CHARLIE && roughness < 0.3;
                worst = is_bound ? worst : fmax(worst, fabs(table - sum));
                most = fmax(most, factor * sum);
                if (!(sum <= table + 0.01) || !(is_bound || sum >= table - 0.01) || !(factor * table <= 1.0))
                    fail_msg("model %d, roughness %g, cosine %g: %g, of the table %g", (int)MODELS[k], roughness,
                             cosine, sum, table);
            }
    print_message("the table is at most %.4f off; at most %.4f is reflected\n", worst, most);
    assert_true(most <= 1.005);
}

static void values_are_symmetric_and_bounded(void **state)
{
    (void)state;
    rng random = test_random(32);
    for (int n = 0; n < 6000; n++) {
        vec3 o = random_direction(&random), i = random_direction(&random);
        o.z = fabsf(o.z), i.z = fabsf(i.z);
        const float roughness = rng_float(&random);
        const float there = sheen_value(MODELS[n % 3], roughness, o, i),
                    back = sheen_value(MODELS[n % 3], roughness, i, o);
        assert_true(there >= 0.0f && isfinite(there));
        assert_close(there, back, 1e-3 * (double)there + 1e-7);
    }
    for (int k = 0; k < 3; k++) { /* the edges of all arguments */
        const vec3 along = {1.0f, 0.0f, 1e-6f}, back = {-1.0f, 0.0f, 1e-6f};
        assert_true(isfinite(sheen_value(MODELS[k], 0.0f, UP, UP)) &&
                    isfinite(sheen_value(MODELS[k], 0.0f, along, along)));
        assert_true(isfinite(sheen_value(MODELS[k], 1.0f, along, back)) &&
                    isfinite(sheen_albedo(MODELS[k], 0.0f, 0.0f)));
        assert_true(sheen_albedo(MODELS[k], 2.0f, -1.0f) >= 0.0f && isfinite(sheen_albedo(MODELS[k], 2.0f, 3.0f)));
    }
}

/* --- cloth --- */

/* Writes the share of even light that a sheen reflects together with its white base, which gives back all that the
 * sheen leaves to it, and the share that the sheen reflects alone. Directions are dense along the surface. */
static void furnace(const bsdf *b, double *out_all, double *out_sheen)
{
    enum { STEPS = 300 / FEWER };
    *out_all = *out_sheen = 0.0;
    for (int k = 0; k < STEPS; k++) {
        const double x = (k + 0.5) / STEPS, z = x * x, radius = sqrt(1.0 - z * z), part = 2.0 * x * 2.0 * PI;
        for (int i = 0; i < STEPS; i++) {
            const double turn = (i + 0.5) / STEPS * 2.0 * PI;
            const vec3 d = {(float)(radius * cos(turn)), (float)(radius * sin(turn)), (float)z};
            *out_all += (double)bsdf_evaluate(b, BSDF_ALL, BSDF_RADIANCE, d).g * part;
            *out_sheen += (double)bsdf_evaluate(b, BSDF_TRACED, BSDF_RADIANCE, d).g * part;
        }
    }
    *out_all /= STEPS * STEPS, *out_sheen /= STEPS * STEPS;
}

static void white_cloth_is_white(void **state)
{
    (void)state;
    double least = 2.0, least_of_bounds = 2.0, most = 0.0;
    for (int k = 0; k < 3; k++)
        for (double roughness = 0.1; roughness <= 1.0; roughness += 0.3)
            for (double degrees = 3.0; degrees < 88.0; degrees += 12.0 * FEWER) {
                material m = principled(0.0f, 1.0f, 0.0f, 0.0f, 0.0f);
                m.reflectance = rgb_gray(1.0f), m.specular = 0.0f;
                m = with_sheen(m, MODELS[k], rgb_gray(sheen_factor_max(MODELS[k])), (float)roughness);
                const bsdf b = flat(&m, direction_at(degrees, 20.0));
                double all, sheen;
                assert_true(b.lobe_count == 2 && b.gathered_lobes == 1);
                furnace(&b, &all, &sheen);
                const double expected =
                    (double)sheen_factor_max(MODELS[k]) * integrate(MODELS[k], roughness, cos(degrees * PI / 180.0));
                assert_close(sheen, expected, 0.01 * expected + 1e-4);
                /* there the table is an upper bound, and the base loses more than the sheen reflects */
                double *lowest = MODELS[k] == SHEEN_CHARLIE && roughness < 0.3 ? &least_of_bounds : &least;
                *lowest = fmin(*lowest, all);
                most = fmax(most, all);
                if (!(all <= 1.01))
                    fail_msg("model %d, roughness %g, %g degrees: %g", (int)MODELS[k], roughness, degrees, all);
            }
    print_message("from %.4f to %.4f; from %.4f where the table is a bound\n", least, most, least_of_bounds);
    assert_true(least > 0.98 && least_of_bounds > 0.85);
}

/* The base loses what the sheen of the strongest colour reflects, and nothing of it is left of a black sheen. */
static void a_coloured_sheen_covers_by_its_strongest_colour(void **state)
{
    (void)state;
    material m = principled(1.0f, 0.5f, 0.0f, 0.0f, 0.0f), bare = m;
    m = with_sheen(m, SHEEN_CHARLIE, (rgb){0.2f, 0.9f, 0.1f}, 0.5f);
    for (double degrees = 10.0; degrees < 85.0; degrees += 15.0) {
        const vec3 o = direction_at(degrees, 0.0), i = direction_at(degrees, 180.0);
        const bsdf with = flat(&m, o), without = flat(&bare, o);
        const float cosine = (float)cos(degrees * PI / 180.0);
        const double left = 1.0 - 0.9 * (double)sheen_albedo(SHEEN_CHARLIE, 0.5f, cosine);
        const double value = (double)sheen_value(SHEEN_CHARLIE, 0.5f, o, i) * (double)cosine;
        const rgb a = bsdf_evaluate(&with, BSDF_ALL, BSDF_RADIANCE, i);
        const rgb c = bsdf_evaluate(&without, BSDF_ALL, BSDF_RADIANCE, i);
        assert_close(a.r, 0.2 * value + left * (double)c.r, 1e-4 * (double)a.r);
        assert_close(a.g, 0.9 * value + left * (double)c.g, 1e-4 * (double)a.g);
    }
    bsdf b = flat(&bare, UP);
    assert_true(b.lobe_count == 1);
    material glass =
        with_sheen(solid(principled(0.0f, 0.2f, 1.0f, 0.0f, 0.0f), 1.5f), SHEEN_CHARLIE, rgb_gray(1.0f), 0.5f);
    b = flat(&glass, vec3_negate(UP)); /* within there are no fibres */
    assert_true(b.lobe_count == 1);
    material wild = with_sheen(bare, SHEEN_SCHLICK, (rgb){-1.0f, NAN, 1e9f}, 7.0f);
    prepare(&wild);
    assert_true(wild.sheen.r == 0.0f && wild.sheen.g == 0.0f && wild.sheen.b == sheen_factor_max(SHEEN_SCHLICK));
    assert_true(wild.sheen_roughness == 1.0f);
}

/* --- roughness along the grain and across it --- */

static void anisotropy_is_khronoss(void **state)
{
    (void)state;
    const ggx even = principled_facets(0.6f, -1.0f, 0.0f), along = principled_facets(0.5f, -1.0f, 0.8f);
    assert_true(even.alpha_u == even.alpha_v && even.alpha_u == 0.6f * 0.6f);
    assert_close(along.alpha_u, 0.25 + 0.75 * 0.64, 1e-6); /* mix(roughness^2, 1, strength^2) */
    assert_close(along.alpha_v, 0.25, 1e-6);
    const ggx both = principled_facets(0.4f, 0.9f, 0.0f);
    assert_close(both.alpha_u, 0.16, 1e-6);
    assert_close(both.alpha_v, 0.81, 1e-6);
    const ggx sharp = principled_facets(0.0f, -1.0f, 0.5f);
    assert_true(sharp.alpha_v > 0.0f && sharp.alpha_u == 0.25f);
}

/* Metal of perfect mirrors, whose grain is turned: its value is that of directions which are turned back. The sense is
 * that of the uvs, but of a mesh's own tangents counterclockwise about the normal. */
#define QUAD(more)                                                                                                     \
    "Shape \"trianglemesh\" \"point3 P\" [-9 -9 0 9 -9 0 9 9 0 -9 9 0] \"integer indices\" [0 1 2 0 2 3] " more
#define UVS           "\"point2 uv\" [0 0 1 0 1 1 0 1] "
#define MIRRORED_UVS  "\"point2 uv\" [0 1 1 1 1 0 0 0] "
#define ALONG_X       "\"vector3 S\" [1 0 0 1 0 0 1 0 0 1 0 0] "
#define ALONG_Y       "\"vector3 S\" [0 1 0 0 1 0 0 1 0 0 1 0] "
#define PLACED(shape) "ObjectBegin \"o\" " shape "ObjectEnd Scale -1 1 1 ObjectInstance \"o\""

/* A picture whose colours say one direction, in degrees from u towards v. */
static const char *picture_of_direction(double degrees)
{
    static const char *const CHANNELS[] = {"R", "G", "B"};
    const image_description description = {.width = 1,
                                           .height = 1,
                                           .full_width = 1,
                                           .full_height = 1,
                                           .channel_count = 3,
                                           .channel_names = CHANNELS,
                                           .type = IMAGE_FLOAT};
    const float pixel[3] = {(float)(0.5 + 0.5 * cos(degrees * PI / 180.0)),
                            (float)(0.5 + 0.5 * sin(degrees * PI / 180.0)), 0.5f};
    const char *name = in_folder("direction.exr");
    assert_int_equal(image_file_write(NULL, name, &description, pixel, message, sizeof message), AG_OK);
    return name;
}

static void the_grain_turns(void **state)
{
    (void)state;
    const struct {
        double u, v, rotation, map; /* 0: there is no map */
        const char *shape;
        double degrees; /* by which directions are turned back */
    } ROWS[] = {{0.3, 0.8, 0, 0, QUAD(UVS), 0},
                {0.8, 0.3, 90, 0, QUAD(UVS), 0},
                {0.3, 0.8, 45, 0, QUAD(UVS), 45},
                {0.3, 0.8, 405, 0, QUAD(UVS), 45},
                {0.3, 0.8, -30, 0, QUAD(UVS), -30},
                {0.3, 0.8, 45, 0, QUAD(MIRRORED_UVS), -45},
                {0.3, 0.8, 30, 0, PLACED(QUAD(UVS)), -30},
                {0.3, 0.8, 30, 0, QUAD(UVS ALONG_X), 30},
                {0.3, 0.8, 30, 0, QUAD(MIRRORED_UVS ALONG_X), 30},
                {0.3, 0.8, 30, 0, QUAD(ALONG_X), 30},
                {0.3, 0.8, 30, 0, QUAD(UVS ALONG_Y), 120},
                {0.3, 0.8, 30, 0, "Scale -1 1 1 " QUAD(UVS ALONG_X), 30},
                {0.3, 0.8, 30, 0, PLACED(QUAD(UVS ALONG_X)), 30},
                {0.3, 0.8, 30, 0, PLACED(QUAD(MIRRORED_UVS ALONG_X)), 30},
                {0.3, 0.8, 75, 0, QUAD(UVS), 75},
                {0.3, 0.8, 0, 45, QUAD(UVS), 45},
                {0.3, 0.8, 30, 45, QUAD(UVS), 75},
                {0.3, 0.8, 30, 20, QUAD(UVS), 50},
                {0.3, 0.8, 30, 20, QUAD(MIRRORED_UVS), -50},
                {0.3, 0.8, 30, 20, QUAD(MIRRORED_UVS ALONG_X), 50}};
    const material plain = along_grain(principled(1.0f, 0.3f, 0.0f, 0.0f, 0.0f), 0.8f, 0.0f);
    material white = plain;
    white.reflectance = rgb_gray(1.0f);
    prepare(&white);
    for (size_t k = 0; k < sizeof ROWS / sizeof *ROWS; k++) {
        char world[1024];
        test_run run;
        test_run_init(&run, 1);
        snprintf(world, sizeof world,
                 "Material \"principled\" \"float uroughness\" %g \"float vroughness\" %g \"float grain_rotation\" %g "
                 "\"string grainmap\" \"%s\" %s",
                 ROWS[k].u, ROWS[k].v, ROWS[k].rotation, ROWS[k].map != 0.0 ? picture_of_direction(ROWS[k].map) : "",
                 ROWS[k].shape);
        scene *s = test_scene_create(&run, world);
        surface_hit hit;
        assert_true(
            scene_intersect(s, scene_ray_make((vec3){2.0f, 0.3f, 2.0f}, (vec3){0.0f, 0.0f, -1.0f}), INFINITY, &hit));
        for (double turn = 0.0; turn < 360.0; turn += 25.0) {
            bsdf b, expected = bsdf_of(&white, UP, direction_at(50.0, turn - ROWS[k].degrees));
            bsdf_init(s, &hit, direction_at(50.0, turn), &b);
            const double value = (double)bsdf_evaluate(&b, BSDF_ALL, BSDF_RADIANCE, direction_at(30.0, turn + 140.0)).g;
            const vec3 back = direction_at(30.0, turn + 140.0 - ROWS[k].degrees);
            const double other = (double)bsdf_evaluate(&expected, BSDF_ALL, BSDF_RADIANCE, back).g;
            if (!(fabs(value - other) <= 1e-3 * other))
                fail_msg("row %zu, turned %g: %g, not %g", k, turn, value, other);
        }
        scene_destroy(s);
        test_run_reset(&run);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(schlick_has_a_closed_form),
        cmocka_unit_test(charlie_is_khronoss),
        cmocka_unit_test(velvet_reflects_all_at_grazing_angles),
        cmocka_unit_test(albedo_is_the_integral),
        cmocka_unit_test(values_are_symmetric_and_bounded),
        cmocka_unit_test(white_cloth_is_white),
        cmocka_unit_test(a_coloured_sheen_covers_by_its_strongest_colour),
        cmocka_unit_test(anisotropy_is_khronoss),
        TEST_IN_FOLDER(the_grain_turns),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
