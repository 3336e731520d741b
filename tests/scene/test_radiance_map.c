/* test_radiance_map.c: lamps with a texture: their power, the density with which their light is sampled, and the
 * photons they send. Threads: one. */
/* ctest: serial */
#include "fixtures/light_fixture.h"

#include "light/lamp_value.h"
#include "light/radiance_map.h"

enum { SAMPLES = 60000 / FEWER };

/* Squares, sixteen of them; a quarter of the lamp bright, the rest dark; and one that changes slowly. */
static const char *const CHECKS =
    "Texture \"t\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [4 3 2] \"rgb tex2\" [0.5 0.4 0.3] \"float uscale\" 4 "
    "\"float vscale\" 4\n";
static const char *const SPECKS =
    "Texture \"a\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [0 0 0] \"rgb tex2\" [30 20 10] \"float uscale\" 2 "
    "\"float vscale\" 2\n"
    "Texture \"t\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [0 0 0] \"texture tex2\" \"a\" \"float uscale\" 8 "
    "\"float vscale\" 8\n";
static const char *const SLOPE = "Texture \"t\" \"spectrum\" \"bilerp\" \"rgb v00\" [0 0 0] \"rgb v01\" [0 0 0] "
                                 "\"rgb v10\" [1 2 3] \"rgb v11\" [1 2 3]\n";

#define LAMP "AreaLightSource \"diffuse\" \"rgb L\" [1 2 3] "

/* A lamp of the last texture there is. */
static scene *lamp_scene(test_run *r, const char *textures, const char *world)
{
    char all[2048];
    snprintf(all, sizeof all, "%s%s", textures, world);
    scene *s = scene_with_light(r, all, NULL);
    assert_int_equal(s->light_count, 1);
    s->lights[0].as.area.radiance_texture = s->textures.count - 1;
    assert_int_equal(scene_commit(s, &r->run, NULL), AG_OK);
    assert_non_null(s->lights[0].as.area.map);
    return s;
}

static const char *const SHAPES[] = {
    LAMP "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 2 -1 1 2 1 -1 2 1 1 2]",
    LAMP "\"bool twosided\" true Shape \"bilinearmesh\" \"point3 P\" [-1 -1 2 -1 1 2.5 1 -1 1.5 1.4 1 2]",
    "Translate 0 0 1.5 " LAMP "ReverseOrientation Shape \"disk\" \"float radius\" 1.2",
    "Translate 0 0.3 3 Rotate 70 1 0 0 " LAMP "Shape \"sphere\" \"float radius\" 1.2",
    "Translate 0 0.3 3 Rotate 70 0 1 0 " LAMP "Shape \"cylinder\" \"float radius\" 0.7",
    "Translate 0 0.3 3 Scale 1 2 0.5 " LAMP "Shape \"sphere\" \"float radius\" 1.2",
};
enum { SHAPE_COUNT = sizeof SHAPES / sizeof *SHAPES };

/* The mean of the texture by even samples of the shape. */
static void power_is_that_of_the_mean(void **state)
{
    (void)state;
    for (size_t i = 0; i < SHAPE_COUNT; i++)
        for (int k = 0; k < 2; k++) {
            test_run r;
            test_run_init(&r, 1);
            scene *s = lamp_scene(&r, k ? SLOPE : CHECKS, SHAPES[i]);
            const light *l = &s->lights[0];
            const shape *lamp = &s->shapes[0];
            rng random = test_random(1);
            mean value = {0.0, 0.0};
            for (int n = 0; n < SAMPLES; n++) {
                surface_hit hit;
                surface_sample at = shape_sample_area(lamp, rng_vec2(&random));
                shape_sample_surface(lamp, 0, &at, &hit);
                assert_close(vec3_length(vec3_sub(hit.position, at.position)), 0.0, 1e-5);
                assert_close(vec3_dot(hit.geometric_normal, at.geometric_normal), 1.0, 1e-5);
                mean_add(&value, (double)lamp_texture_value(s, l, &hit).g / (double)(at.pdf_area * lamp->area),
                         SAMPLES);
            }
            double expected = 2.0 * value.value * PI * (double)lamp->area * (l->as.area.two_sided ? 2.0 : 1.0);
            double error = 5.0 * mean_error(value, SAMPLES) / value.value + 0.002; /* its own grid's */
            assert_relative(l->power.g, expected, error);
            expect_power_of_photons(s, SAMPLES);
            scene_destroy(s);
            test_run_reset(&r);
        }
}

/* A square of radiance L half of which is dark. */
static void two_tones(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    scene *s = lamp_scene(&r,
                          "Texture \"t\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [1 1 1] \"rgb tex2\" [0 0 0] "
                          "\"float uscale\" 2 \"float vscale\" 2\n",
                          SHAPES[0]);
    assert_relative(s->lights[0].power.r, PI * 4.0 * 0.5, 2e-3);
    assert_relative(s->lights[0].power.b, 3.0 * PI * 4.0 * 0.5, 2e-3);
    scene_destroy(s);
    test_run_reset(&r);
}

/* Back to the numbers that picked a point. */
static void samples_of_meshes_are_undone(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    scene *s = lamp_scene(&r, CHECKS,
                          LAMP "Shape \"trianglemesh\" \"integer indices\" [0 1 2 1 3 2 0 2 4]\n"
                               "\"point3 P\" [-1 -1 2 2 -1 2 -1 1 1.5 1 3 2 -2 -2 0]");
    rng random = test_random(2);
    vec2 back;
    for (int i = 0; i < 10000; i++) {
        vec2 u = rng_vec2(&random);
        surface_hit hit;
        surface_sample at = shape_sample_area(&s->shapes[0], u);
        shape_sample_surface(&s->shapes[0], 0, &at, &hit);
        assert_true(shape_sample_inverse(&s->shapes[0], &hit, &back));
        assert_close(back.x, u.x, 2e-5);
        assert_close(back.y, u.y, 2e-5);
    }
    scene_destroy(s);
    s = lamp_scene(&r, CHECKS, SHAPES[2]);
    surface_hit hit = {0};
    assert_false(shape_sample_inverse(&s->shapes[0], &hit, &back));
    scene_destroy(s);
    test_run_reset(&r);
}

typedef struct view {
    const scene *s;
    vec3 point;
} view;

static double density(void *user, vec3 d)
{
    const view *v = user;
    surface_hit hit;
    if (!scene_intersect(v->s, scene_ray_make(v->point, d), INFINITY, &hit) ||
        rgb_is_black(light_emitted_radiance(v->s, &v->s->lights[0], &hit, vec3_negate(d))))
        return 0.0;
    return light_pdf_from_point(v->s, &v->s->lights[0], v->point, &hit);
}

/* Towards a point: the density said is the one sampled, at hits as at samples, and the light is that of even
 * samples. */
static void light_is_sampled_by_its_density(void **state)
{
    (void)state;
    const vec3 point = {0.2f, -0.3f, 0.0f};
    for (size_t i = 0; i < SHAPE_COUNT; i++) {
        test_run r;
        test_run_init(&r, 1);
        scene *s = lamp_scene(&r, CHECKS, SHAPES[i]);
        const light *l = &s->lights[0];
        static uint32_t counts[BIN_COUNT];
        static double bins[BIN_COUNT];
        memset(counts, 0, sizeof counts);
        rng random = test_random(3);
        mean by_map = {0.0, 0.0}, by_area = {0.0, 0.0};
        int strangers = 0;
        for (int n = 0; n < SAMPLES; n++) {
            light_sample at;
            if (light_sample_from_point(s, l, point, rng_vec2(&random), &at)) {
                surface_hit hit;
                bool is_seen = !is_blocked_between(s, point, at.shadow_target);
                if (is_seen)
                    mean_add(&by_map, (double)at.radiance.g / (double)at.pdf_solid_angle, SAMPLES);
                counts[direction_bin(at.direction)] += is_seen;
                if (is_seen && scene_intersect(s, scene_ray_make(point, at.direction), INFINITY, &hit)) {
                    rgb seen = light_emitted_radiance(s, l, &hit, vec3_negate(at.direction));
                    float pdf = light_pdf_from_point(s, l, point, &hit);
                    bool is_flat = fabsf(vec3_dot(hit.geometric_normal, at.direction)) < 0.05f;
                    strangers += !is_flat && (fabsf(pdf / at.pdf_solid_angle - 1.0f) > 0.01f ||
                                              fabsf(seen.g - at.radiance.g) > 1e-3f);
                }
            }
            /* points picked evenly */
            surface_sample sample = shape_sample_area(&s->shapes[0], rng_vec2(&random));
            vec3 to = vec3_sub(sample.position, point), d = vec3_normalize(to);
            surface_hit there;
            shape_sample_surface(&s->shapes[0], 0, &sample, &there);
            vec3 stop =
                vec3_add_scaled(sample.position, vec3_face_forward(sample.geometric_normal, vec3_negate(d)), 1e-4f);
            if (!is_blocked_between(s, point, stop))
                mean_add(&by_area,
                         (double)light_emitted_radiance(s, l, &there, vec3_negate(d)).g *
                             fabs((double)vec3_dot(d, sample.geometric_normal)) /
                             ((double)vec3_length_squared(to) * (double)sample.pdf_area),
                         SAMPLES);
        }
        assert_true(strangers < SAMPLES / 100); /* at the borders of squares and of cells */
        assert_close(by_map.value, by_area.value,
                     5.0 * hypot(mean_error(by_map, SAMPLES), mean_error(by_area, SAMPLES)));
        view v = {s, point};
        double whole = integrate_bins(density, &v, 24 / (FEWER > 1 ? 3 : 1), bins), drawn = 0.0;
        for (int n = 0; n < BIN_COUNT; n++)
            drawn += counts[n];
        assert_close(whole, drawn / SAMPLES, 0.02 * WIDER);
        if (!strstr(SHAPES[i], "cylinder")) /* along whose outline densities are infinite */
            assert_chi_square(counts, bins, SAMPLES, 0.1 * WIDER);
        scene_destroy(s);
        test_run_reset(&r);
    }
}

/* Small bright points on a dark screen are found: photons are nearly alike, and direct light has little noise. */
static void bright_specks_are_found(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    scene *s = lamp_scene(&r, SPECKS, SHAPES[0]);
    const light *l = &s->lights[0];
    rng random = test_random(5);
    mean flux = {0.0, 0.0}, direct = {0.0, 0.0};
    const vec3 point = {0.0f, 0.0f, -3.0f};
    for (int i = 0; i < SAMPLES; i++) {
        light_emission e;
        light_sample at;
        if (light_sample_emission(s, l, NULL, &random, &e))
            mean_add(&flux, e.flux.g, SAMPLES);
        if (light_sample_from_point(s, l, point, rng_vec2(&random), &at))
            mean_add(&direct, (double)at.radiance.g / (double)at.pdf_solid_angle, SAMPLES);
    }
    /* of a quarter of the screen by even samples: variance 3 */
    assert_true(flux.square / (flux.value * flux.value) - 1.0 < 0.8);
    assert_true(direct.square / (direct.value * direct.value) - 1.0 < 0.8);
    scene_destroy(s);
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(power_is_that_of_the_mean),    cmocka_unit_test(two_tones),
        cmocka_unit_test(samples_of_meshes_are_undone), cmocka_unit_test(light_is_sampled_by_its_density),
        cmocka_unit_test(bright_specks_are_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
