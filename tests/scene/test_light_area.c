/* test_light_area.c: light from lamps with extent is sampled towards a point with the density that is said.
 * Threads: one. */
/* ctest: serial */
#include "fixtures/test_scene.h"

enum { SAMPLES = 100000 / FEWER };

/* --- towards a point --- */

typedef struct view {
    const scene *s;
    vec3 point;
    bool sees_lamp[BIN_COUNT], sees_none[BIN_COUNT];
} view;

static double lamp_density(const view *v, vec3 d)
{
    const light *l = &v->s->lights[0];
    surface_hit hit;
    if (!scene_intersect(v->s, scene_ray_make(v->point, d), INFINITY, &hit) ||
        rgb_is_black(light_emitted_radiance(v->s, l, &hit, vec3_negate(d))))
        return 0.0;
    return light_pdf_from_point(v->s, l, v->point, &hit);
}

static double density(void *user, vec3 d)
{
    view *v = user;
    double value = lamp_density(v, d);
    *(value > 0.0 ? &v->sees_lamp[direction_bin(d)] : &v->sees_none[direction_bin(d)]) = true;
    return value;
}

/* A scene of one lamp that hides no part of itself but by facing away. solid_angle: of what is seen of it, where there
 * is a closed form, else 0. */
static void check_lamp(const char *world, vec3 point, double solid_angle)
{
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, world);
    const light *l = &s->lights[0];
    static view v;
    v = (view){.s = s, .point = point};
    static uint32_t counts[BIN_COUNT];
    static double bins[BIN_COUNT];
    memset(counts, 0, sizeof counts);
    rng random = test_random(1);
    uint32_t sampled = 0, missed = 0;
    double sum = 0.0, square = 0.0;
    for (int i = 0; i < SAMPLES; i++) {
        light_sample at;
        if (!light_sample_from_point(s, l, point, rng_vec2(&random), &at))
            continue;
        sampled++;
        counts[direction_bin(at.direction)]++;
        assert_false(at.is_delta);
        assert_close(vec3_length(at.direction), 1.0, 1e-5);
        assert_memory_equal(&at.radiance, &l->as.area.radiance, sizeof(rgb));
        double inverse = 1.0 / (double)at.pdf_solid_angle;
        sum += inverse / SAMPLES, square += inverse * inverse / SAMPLES;
        assert_false(is_blocked_between(s, point, at.shadow_target));
        if (i % 10)
            continue;
        /* a ray that way meets the lamp there, and its density is the same */
        surface_hit hit;
        if (!scene_intersect(s, scene_ray_make(point, at.direction), INFINITY, &hit)) {
            missed++; /* past the very edge */
            continue;
        }
        float pdf = light_pdf_from_point(s, l, point, &hit);
        if (fabsf(vec3_dot(hit.geometric_normal, at.direction)) < 0.03f)
            continue; /* nearly along the surface: rounding moves the point */
        assert_relative(hit.distance, at.distance, 1e-3);
        assert_relative(pdf, at.pdf_solid_angle, 5e-3);
    }
    assert_true(missed <= 1 + sampled / 5000);
    double whole = integrate_bins(density, &v, 16, bins);
    assert_close(whole, (double)sampled / SAMPLES, 0.015 * WIDER);
    for (int i = 0; i < BIN_COUNT; i++)
        if (v.sees_lamp[i] && v.sees_none[i]) /* the outline runs through it, where densities may be infinite */
            bins[i] = counts[i] = 0;
    assert_chi_square(counts, bins, SAMPLES, 0.01 * WIDER);
    if (solid_angle > 0.0)
        assert_close(sum, solid_angle, 5.0 * sqrt(fmax(0.0, square - sum * sum) / SAMPLES) + 1e-4 * solid_angle);
    scene_destroy(s);
    test_run_reset(&r);
}

#define LAMP "AreaLightSource \"diffuse\" \"rgb L\" [3 2 1] "

static double cone(double radius, double distance)
{
    return 2.0 * PI * (1.0 - sqrt(1.0 - radius * radius / distance / distance));
}

static void a_sphere_from_outside_and_inside(void **state)
{
    (void)state;
    vec3 origin = {0.0f, 0.0f, 0.0f};
    check_lamp("Translate 1 2 0.5 " LAMP "Shape \"sphere\" \"float radius\" [2]", origin, cone(2.0, sqrt(5.25)));
    check_lamp("Translate -3 1 2 Scale 0.5 0.5 0.5 " LAMP "Shape \"sphere\" \"float radius\" [2]", origin,
               cone(1.0, sqrt(14.0)));
    check_lamp("Translate 0.3 0.4 0.5 ReverseOrientation " LAMP "Shape \"sphere\" \"float radius\" [2]", origin,
               4.0 * PI);
    check_lamp("Translate 0.3 0.4 0.5 " LAMP "\"bool twosided\" true Shape \"sphere\" \"float radius\" [2]", origin,
               4.0 * PI);
}

static void an_ellipsoid_from_outside_and_inside(void **state)
{
    (void)state;
    vec3 origin = {0.0f, 0.0f, 0.0f};
    check_lamp("Translate 1.5 2 0.5 Rotate 30 1 1 0 Scale 1 2 0.4 " LAMP "Shape \"sphere\"", origin, 0.0);
    check_lamp("Translate 0.3 0.2 0.1 Rotate 30 1 1 0 Scale -1 2 0.7 ReverseOrientation " LAMP "Shape \"sphere\"",
               origin, 4.0 * PI);
}

/* Van Oosterom, Strackee, "The Solid Angle of a Plane Triangle", 1983. */
static double triangle_solid_angle(vec3 a, vec3 b, vec3 c)
{
    double la = vec3_length(a), lb = vec3_length(b), lc = vec3_length(c);
    double above = vec3_dot(a, vec3_cross(b, c));
    double below =
        la * lb * lc + (double)vec3_dot(a, b) * lc + (double)vec3_dot(a, c) * lb + (double)vec3_dot(b, c) * la;
    return 2.0 * atan2(fabs(above), below);
}

static void meshes(void **state)
{
    (void)state;
    vec3 origin = {0.0f, 0.0f, 0.0f}, p[4] = {{-1, -1, 1}, {2, -1, 1.5f}, {-1, 1, 1}, {0, 3, 0.5f}};
    double angle = triangle_solid_angle(p[0], p[2], p[1]) + triangle_solid_angle(p[1], p[2], p[3]);
    static const char *const POINTS = "\"point3 P\" [-1 -1 1  2 -1 1.5  -1 1 1  0 3 0.5]";
    char text[512];
    snprintf(text, sizeof text, LAMP "Shape \"trianglemesh\" \"integer indices\" [0 2 1 1 2 3] %s", POINTS);
    check_lamp(text, origin, angle);
    snprintf(text, sizeof text,
             LAMP "\"bool twosided\" true Shape \"trianglemesh\" \"integer indices\" [0 1 2 1 2 3] %s", POINTS);
    check_lamp(text, origin, angle);
    /* the side that shines by vertex normals, or turned over */
    static const char *const SQUARE =
        "Shape \"trianglemesh\" \"integer indices\" [0 2 1 0 3 2] \"point3 P\" [-1 -1 1 1 -1 "
        "1 1 1 1 -1 1 1]";
    snprintf(text, sizeof text, LAMP "%s \"normal N\" [0 0 -1 0.1 0 -1 0 0.1 -1 0 0 -1]", SQUARE);
    check_lamp(text, (vec3){0.2f, 0.1f, 0.5f}, 0.0);
    snprintf(text, sizeof text, "ReverseOrientation " LAMP "%s", SQUARE);
    check_lamp(text, (vec3){0.2f, 0.1f, 1.5f}, 0.0);
    /* a closed box, seen from outside */
    check_lamp("Translate 2 3 1 " LAMP "Shape \"trianglemesh\" \"integer indices\" [0 3 1 0 2 3 4 5 7 4 7 6 0 1 5 0 5 "
               "4 2 7 3 2 6 7 0 6 2 0 4 6 1 7 5 1 3 7]\n"
               "\"point3 P\" [-1 -1 -1 1 -1 -1 -1 1 -1 1 1 -1 -1 -1 1 1 -1 1 -1 1 1 1 1 1]",
               origin, 0.0);
}

/* Samples the lamp from a point on a surface that faces up. A sample weighs the cosine over its density; the mean is
 * the irradiance of a lamp of radiance 1, and no sample weighs more than `largest` times the mean, since such a sample
 * would be a bright speck in a picture. */
static void check_weights(const char *world, vec3 point, double irradiance, double largest)
{
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, world);
    rng random = test_random(4);
    double sum = 0.0, square = 0.0, most = 0.0;
    for (int i = 0; i < SAMPLES; i++) {
        light_sample at;
        if (!light_sample_from_point(s, &s->lights[0], point, rng_vec2(&random), &at))
            continue;
        double weight = fmax((double)at.direction.z, 0.0) / (double)at.pdf_solid_angle;
        sum += weight / SAMPLES, square += weight * weight / SAMPLES;
        most = fmax(most, weight);
    }
    assert_close(sum, irradiance, 5.0 * sqrt(fmax(square - sum * sum, 0.0) / SAMPLES) + 1e-4 * irradiance);
    assert_true(most <= largest * sum);
    scene_destroy(s);
    test_run_reset(&r);
}

/* The form factor of a rectangle a by b at height 1, from below one of its corners, times pi. */
static double corner_irradiance(double a, double b)
{
    double x = sqrt(1.0 + a * a), y = sqrt(1.0 + b * b);
    return 0.5 * (a / x * atan(b / x) + b / y * atan(a / y));
}

static void near_and_turned_lamps_give_even_samples(void **state)
{
    (void)state;
    /* 5 cm below a square of 2 m */
    const double closely = 4.0 * corner_irradiance(20.0, 20.0);
    vec3 below = {0.0f, 0.0f, 0.95f};
    check_weights(LAMP "Shape \"trianglemesh\" \"integer indices\" [0 2 1 0 3 2] \"point3 P\" [-1 -1 1  1 -1 1  1 1 1 "
                       "-1 1 1]",
                  below, closely, 2.5);
    /* as a mesh of many triangles, one of which is picked by area */
    char text[2048], *end = text + sprintf(text, LAMP "Shape \"trianglemesh\" \"integer indices\" [");
    for (int i = 0; i < 9; i++)
        end += sprintf(end, "%d %d %d %d %d %d ", i, i + 10, i + 1, i + 10, i + 11, i + 1);
    end += sprintf(end, "] \"point3 P\" [");
    for (int i = 0; i < 20; i++)
        end += sprintf(end, "%g %d 1 ", (i % 10) / 4.5 - 1.0, 2 * (i / 10) - 1);
    sprintf(end, "]");
    check_weights(text, below, closely, 20.0);
    /* a box above, 1 m wide and high, of which the lower side alone shines down here */
    check_weights(
        "Translate 0 0 1.5 " LAMP
        "Shape \"trianglemesh\" \"integer indices\" [0 3 1 0 2 3 4 5 7 4 7 6 0 1 5 0 5 4 2 7 3 2 6 7 0 6 2 0 4 "
        "6 1 7 5 1 3 7]\n"
        "\"point3 P\" [-.5 -.5 -.5 .5 -.5 -.5 -.5 .5 -.5 .5 .5 -.5 -.5 -.5 .5 .5 -.5 .5 -.5 .5 .5 .5 .5 .5]",
        (vec3){0.0f, 0.0f, 0.0f}, 4.0 * corner_irradiance(0.5, 0.5), 1.5);
}

static void disks(void **state)
{
    (void)state;
    vec3 origin = {0.0f, 0.0f, 0.0f};
    /* on the axis, facing it */
    check_lamp("Translate 0 0 1.5 ReverseOrientation " LAMP
               "Shape \"disk\" \"float radius\" [2] \"float innerradius\" [0.5]",
               origin, 2.0 * PI * 1.5 * (1.0 / sqrt(1.5 * 1.5 + 0.25) - 1.0 / sqrt(1.5 * 1.5 + 4.0)));
    check_lamp("Rotate 50 1 2 3 Translate 0.7 0.3 1 Scale 2 1 1 " LAMP
               "\"bool twosided\" true Shape \"disk\" \"float radius\" [1]",
               origin, 0.0);
}

static void a_lamp_is_dark_from_behind(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, "Translate 0 0 2 " LAMP "Shape \"disk\"");
    rng random = test_random(2);
    for (int i = 0; i < 1000; i++) {
        light_sample at;
        assert_false(light_sample_from_point(s, &s->lights[0], (vec3){0.0f, 0.0f, 0.0f}, rng_vec2(&random), &at));
        assert_true(light_sample_from_point(s, &s->lights[0], (vec3){0.0f, 0.0f, 4.0f}, rng_vec2(&random), &at));
    }
    scene_destroy(s);
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sphere_from_outside_and_inside),
        cmocka_unit_test(an_ellipsoid_from_outside_and_inside),
        cmocka_unit_test(meshes),
        cmocka_unit_test(near_and_turned_lamps_give_even_samples),
        cmocka_unit_test(disks),
        cmocka_unit_test(a_lamp_is_dark_from_behind),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
