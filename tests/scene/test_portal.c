/* test_portal.c: infinite light through a window: what a point sees, with which density it is sampled, and the photons
 * that enter. Threads: one. */
/* ctest: serial */
#include "fixtures/light_fixture.h"

enum { SAMPLES = 24000 / (FEWER > 1 ? 4 : 1) };

/* A floor far behind gives the scene its size, and hides nothing. */
static scene *window_scene(test_run *r, int k)
{
    light l = window_light_number(k);
    scene *s = scene_with_light(r, "Translate -9 0 -8 Shape \"disk\" \"float radius\" 3", &l);
    assert_int_equal(scene_commit(s, &r->run, NULL), AG_OK);
    return s;
}

static const vec3 POINTS[] = {{0.0f, 0.0f, 0.0f}, {1.6f, 0.2f, 0.3f}, {-6.0f, 5.0f, -4.0f}, {1.5f, -4.0f, 0.0f}};
enum { POINT_COUNT = sizeof POINTS / sizeof *POINTS };

static void only_rectangles_are_portals(void **state)
{
    (void)state;
    vec3 corners[4], moved[4];
    portal p;
    make_corners(corners);
    assert_true(portal_init(corners, &p));
    assert_close(p.width, 2.0, 1e-5);
    assert_close(p.height, 1.5, 1e-5);
    assert_close(vec3_dot(p.axes.z, vec3_normalize(vec3_make(1.0f, 0.2f, -0.1f))), 1.0, 1e-6);
    assert_true(portal_is_before(&p, vec3_make(0.0f, 0.0f, 0.0f)));
    assert_false(portal_is_before(&p, vec3_make(9.0f, 0.0f, 0.0f)));
    for (int i = 0; i < 4; i++) {
        memcpy(moved, corners, sizeof moved);
        moved[i] = vec3_add(moved[i], vec3_make(0.1f, 0.1f, 0.3f));
        assert_false(portal_init(moved, &p));
    }
    memcpy(moved, corners, sizeof moved);
    moved[1] = moved[0];
    assert_false(portal_init(moved, &p));
    vec3 crossed[4] = {corners[0], corners[2], corners[1], corners[3]};
    assert_false(portal_init(crossed, &p));
}

/* The mirror's order: light comes from the other side. */
static void the_order_of_corners_says_where_outside_is(void **state)
{
    (void)state;
    vec3 corners[4];
    portal p;
    make_corners(corners);
    vec3 turned[4] = {corners[0], corners[3], corners[2], corners[1]};
    assert_true(portal_init(turned, &p));
    assert_true(p.axes.z.x < 0.0f);
    assert_false(portal_is_before(&p, vec3_make(0.0f, 0.0f, 0.0f)));
}

static double density(void *user, vec3 d)
{
    const struct {
        const light *l;
        vec3 point;
    } *v = user;
    return light_escaped_pdf(v->l, v->point, d);
}

/* Whether the ray meets the window, in doubles. */
static bool passes(const portal *p, vec3 from, vec3 d)
{
    vec3 z = p->axes.z, x = p->axes.x, y = p->axes.y, c = vec3_sub(p->corner, from);
    double down = (double)z.x * d.x + (double)z.y * d.y + (double)z.z * d.z;
    double t = ((double)z.x * c.x + (double)z.y * c.y + (double)z.z * c.z) / down;
    if (!(down > 0.0 && t > 0.0))
        return false;
    double q[3] = {t * d.x - c.x, t * d.y - c.y, t * d.z - c.z};
    double a = q[0] * x.x + q[1] * x.y + q[2] * x.z, b = q[0] * y.x + q[1] * y.y + q[2] * y.z;
    return a >= 0.0 && a <= p->width && b >= 0.0 && b <= p->height;
}

static void directions_are_sampled_by_their_density(void **state)
{
    (void)state;
    for (int k = 0; k < WINDOW_LIGHT_COUNT; k++) {
        test_run r;
        test_run_init(&r, 1);
        scene *s = window_scene(&r, k);
        const light *l = &s->lights[0];
        for (int index = 0; index < POINT_COUNT; index++) {
            struct {
                const light *l;
                vec3 point;
            } v = {l, POINTS[index]};
            static uint32_t counts[BIN_COUNT];
            static double bins[BIN_COUNT];
            memset(counts, 0, sizeof counts);
            rng random = test_random(6);
            int strangers = 0, drawn = 0, outside = 0;
            for (int i = 0; i < SAMPLES; i++) {
                light_sample at;
                if (!light_sample_from_point(s, l, v.point, rng_vec2(&random), &at))
                    continue; /* a black pixel */
                drawn++;
                assert_false(at.is_delta);
                assert_true(isinf(at.distance));
                assert_close(vec3_length(at.direction), 1.0, 1e-6);
                counts[direction_bin(at.direction)]++;
                outside += !passes(l->as.infinite.portal, v.point, at.direction);
                rgb seen = light_escaped_radiance(l, v.point, at.direction);
                float pdf = light_escaped_pdf(l, v.point, at.direction);
                strangers += fabsf(pdf / at.pdf_solid_angle - 1.0f) > 1e-4f || memcmp(&seen, &at.radiance, sizeof seen);
            }
            assert_true(drawn > SAMPLES / 10);
            /* what is sampled is what is seen, but for rounding at the borders of pixels and of the window */
            assert_true(outside <= SAMPLES / 1000);
            assert_true(strangers <= SAMPLES / 300);
            double whole = integrate_bins(density, &v, k == 0 ? 40 : 16, bins);
            assert_close(whole, 1.0, 0.06 * WIDER);
            if (k == 0) { /* of others black pixels, which are never kept, have a little density too */
                assert_int_equal(drawn, SAMPLES);
                assert_chi_square(counts, bins, SAMPLES, 0.1 * WIDER);
            }
        }
        scene_destroy(s);
        test_run_reset(&r);
    }
}

/* Light through the window by sampling the window, and by sampling all directions and asking which pass. */
static void the_light_is_what_comes_through(void **state)
{
    (void)state;
    for (int k = 0; k < WINDOW_LIGHT_COUNT; k++) {
        test_run r;
        test_run_init(&r, 1);
        scene *s = window_scene(&r, k);
        const light *l = &s->lights[0];
        for (int index = 0; index < POINT_COUNT; index++) {
            vec3 point = POINTS[index];
            rng random = test_random(7);
            mean through = {0.0, 0.0}, all = {0.0, 0.0};
            enum { ALL = 10 * SAMPLES };
            for (int i = 0; i < SAMPLES; i++) {
                light_sample at;
                bool is_lit = light_sample_from_point(s, l, point, rng_vec2(&random), &at);
                mean_add(&through, is_lit ? (double)at.radiance.g / (double)at.pdf_solid_angle : 0.0, SAMPLES);
            }
            for (int i = 0; i < ALL; i++) {
                vec3 d = random_direction(&random);
                if (passes(l->as.infinite.portal, point, d))
                    mean_add(&all, 4.0 * PI * (double)environment_whole_radiance(&l->as.infinite.radiance, d).g, ALL);
                assert_true(passes(l->as.infinite.portal, point, d) || i % 64 ||
                            rgb_is_black(light_escaped_radiance(l, point, d)));
            }
            assert_close(through.value, all.value, 5.0 * hypot(mean_error(through, SAMPLES), mean_error(all, ALL)));
            /* nearly by radiance: little noise is left */
            double noise = mean_error(through, SAMPLES) * sqrt(SAMPLES) / through.value;
            assert_true(noise < (k == 0 ? 0.2 : 1.5));
        }
        /* nothing from behind */
        light_sample at;
        vec3 behind = vec3_make(6.0f, 0.0f, 0.0f), back = vec3_make(-1.0f, 0.0f, 0.0f);
        assert_false(light_sample_from_point(s, l, behind, (vec2){0.5f, 0.5f}, &at));
        assert_true(rgb_is_black(light_escaped_radiance(l, behind, back)));
        assert_true(light_escaped_pdf(l, behind, back) == 0.0f);
        scene_destroy(s);
        test_run_reset(&r);
    }
}

/* Van Oosterom, Strackee, "The Solid Angle of a Plane Triangle", 1983. */
static double solid_angle(vec3 point, const vec3 corners[3])
{
    vec3 a = vec3_sub(corners[0], point), b = vec3_sub(corners[1], point), c = vec3_sub(corners[2], point);
    double la = vec3_length(a), lb = vec3_length(b), lc = vec3_length(c);
    double below =
        la * lb * lc + (double)vec3_dot(a, b) * lc + (double)vec3_dot(a, c) * lb + (double)vec3_dot(b, c) * la;
    return 2.0 * atan2(fabs((double)vec3_dot(a, vec3_cross(b, c))), below);
}

static void a_constant_sky_fills_the_windows_solid_angle(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    scene *s = window_scene(&r, 0);
    vec3 c[4];
    make_corners(c);
    for (int index = 0; index < POINT_COUNT; index++) {
        double expected = solid_angle(POINTS[index], c) + solid_angle(POINTS[index], (vec3[]){c[0], c[2], c[3]});
        rng random = test_random(8);
        mean angle = {0.0, 0.0};
        for (int i = 0; i < SAMPLES; i++) {
            light_sample at;
            assert_true(light_sample_from_point(s, &s->lights[0], POINTS[index], rng_vec2(&random), &at));
            mean_add(&angle, 1.0 / (double)at.pdf_solid_angle, SAMPLES);
        }
        assert_close(angle.value, expected, 5.0 * mean_error(angle, SAMPLES) + 1e-5 * expected);
    }
    scene_destroy(s);
    test_run_reset(&r);
}

/* The flux that enters is area times irradiance, which is pi L for a constant sky. The photons carry it in nearly equal
 * parts. */
static void photons_enter_by_the_window(void **state)
{
    (void)state;
    for (int k = 0; k < WINDOW_LIGHT_COUNT; k++) {
        test_run r;
        test_run_init(&r, 1);
        scene *s = window_scene(&r, k);
        const light *l = &s->lights[0];
        rng random = test_random(9);
        mean irradiance = {0.0, 0.0}, flux = {0.0, 0.0};
        for (int i = 0; i < SAMPLES; i++) {
            vec3 d = random_direction(&random);
            double cosine = fmax(0.0, (double)vec3_dot(d, l->as.infinite.portal->axes.z));
            mean_add(&irradiance, 4.0 * PI * cosine * (double)environment_whole_radiance(&l->as.infinite.radiance, d).g,
                     SAMPLES);
            light_emission e;
            if (!light_sample_emission(s, l, NULL, &random, &e))
                continue;
            mean_add(&flux, e.flux.g, SAMPLES);
            assert_true(
                passes(l->as.infinite.portal, vec3_add_scaled(e.origin, e.direction, 1.0f), vec3_negate(e.direction)));
        }
        assert_close(l->power.g, 3.0 * irradiance.value, 15.0 * mean_error(irradiance, SAMPLES));
        if (k == 0)
            assert_relative(l->power.g, 3.0 * 2.0 * PI, 1e-4);
        assert_true(sqrt(flux.square - flux.value * flux.value) < (k == 0 ? 0.1 : 1.3) * flux.value);
        scene_destroy(s);
        test_run_reset(&r);
    }
}

/* A wall outside takes all of the light, a wall inside takes none. */
static void what_stands_outside_shadows(void **state)
{
    (void)state;
    for (int outside = 0; outside < 2; outside++) {
        test_run r;
        test_run_init(&r, 1);
        light l = window_light_number(1);
        scene *s = scene_with_light(&r,
                                    outside ? "Translate 5 0 0 Rotate 90 0 1 0 Shape \"disk\" \"float radius\" 500"
                                            : "Translate -5 0 0 Rotate 90 0 1 0 Shape \"disk\" \"float radius\" 500",
                                    &l);
        assert_int_equal(scene_commit(s, &r.run, NULL), AG_OK);
        rng random = test_random(10);
        int sent = 0;
        for (int i = 0; i < 1000; i++) {
            light_emission e;
            sent += light_sample_emission(s, &s->lights[0], NULL, &random, &e);
        }
        assert_true(outside ? sent < 30 : sent > 500);
        scene_destroy(s);
        test_run_reset(&r);
    }
}

static void a_black_sky(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    light l = window_light(ENVIRONMENT_OCTAHEDRAL, 4, 4, calloc(16, sizeof(rgb)));
    scene *s = scene_with_light(&r, "Shape \"sphere\"", &l);
    assert_int_equal(scene_commit(s, &r.run, NULL), AG_OK);
    rng random = test_random(10);
    light_sample at;
    light_emission e;
    assert_false(light_sample_from_point(s, &s->lights[0], POINTS[0], (vec2){0.5f, 0.5f}, &at));
    assert_false(light_sample_emission(s, &s->lights[0], NULL, &random, &e));
    assert_true(light_escaped_pdf(&s->lights[0], POINTS[0], vec3_make(1.0f, 0.0f, 0.0f)) == 0.0f);
    assert_true(rgb_is_black(s->light_power));
    scene_destroy(s);
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(only_rectangles_are_portals),
        cmocka_unit_test(the_order_of_corners_says_where_outside_is),
        cmocka_unit_test(directions_are_sampled_by_their_density),
        cmocka_unit_test(the_light_is_what_comes_through),
        cmocka_unit_test(a_constant_sky_fills_the_windows_solid_angle),
        cmocka_unit_test(photons_enter_by_the_window),
        cmocka_unit_test(what_stands_outside_shadows),
        cmocka_unit_test(a_black_sky),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
