/* test_transmittance.c: what is left of light on its way through media and across interfaces, by Beer's law, and the
 * medium it arrives in. Threads: one. */
#include "medium/medium.h"
#include "rays/transmittance.h"

#include "fixtures/test_scene.h"

#define MEDIA                                                                                                          \
    "MakeNamedMedium \"a\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [0 0 0] \"rgb sigma_a\" [0.1 0.5 2]\n"      \
    "MakeNamedMedium \"b\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [0 0 0] \"rgb sigma_a\" [0.7 0 0.3]\n"
#define SQUARE(z, indices)                                                                                             \
    "Shape \"trianglemesh\" \"integer indices\" [" indices "] \"point3 P\" [-5 -5 " z "  5 -5 " z "  5 5 " z           \
    "  -5 5 " z "]\n"
#define UP(z)   SQUARE(z, "0 1 2 0 2 3")
#define DOWN(z) SQUARE(z, "0 2 1 0 3 2")

static const double A[3] = {0.1, 0.5, 2.0}, B[3] = {0.7, 0.0, 0.3};
static const uint32_t IN_A = 0, IN_B = 1;

static void assert_left(rgb left, double in_a, double in_b, double relative)
{
    const float value[3] = {left.r, left.g, left.b};
    for (int c = 0; c < 3; c++)
        assert_relative(value[c], exp(-A[c] * in_a - B[c] * in_b), relative);
}

static scene_ray ray_between(vec3 from, vec3 to, uint32_t medium_index)
{
    scene_ray ray = scene_ray_make(from, vec3_normalize(vec3_sub(to, from)));
    ray.medium = medium_index;
    return ray;
}

/* Asks in both ways, along the whole straight line to a surface. */
static void expect_way(const scene *s, vec3 from, vec3 to, uint32_t start, double in_a, double in_b, uint32_t end)
{
    scene_ray ray = ray_between(from, to, start);
    surface_hit hit;
    rgb left;
    uint64_t cut = 0;
    vec3 origin = ray.origin;
    assert_true(transmittance_intersect(s, &ray, &cut, &hit, &left));
    assert_left(left, in_a, in_b, 1e-5);
    assert_int_equal(ray.medium, end);
    assert_memory_equal(&ray.origin, &origin, sizeof origin);
    assert_true(vec3_length(vec3_sub(hit.position, to)) < 1e-3f);
    assert_relative(hit.distance, (double)vec3_length(vec3_sub(to, from)), 1e-4);

    /* of any length; to just before the surface; and beyond it */
    ray = ray_between(from, to, start);
    ray.direction = vec3_scale(vec3_sub(to, from), 0.25f);
    assert_left(transmittance_of_ray(s, ray, 4.0f * 0.9999f, &cut), in_a, in_b, 2e-3);
    assert_true(rgb_is_black(transmittance_of_ray(s, ray, 4.1f, &cut)));
    assert_true(rgb_is_black(transmittance_of_ray(s, ray, INFINITY, &cut)));
    assert_int_equal(cut, 0);
}

static void beers_law(void **state)
{
    (void)state;
    medium m = medium_make(MEDIUM_HOMOGENEOUS);
    m.as.homogeneous.sigma_a = (rgb){0.1f, 0.0f, 7.0f};
    for (int i = 0; i <= 40; i++) {
        float distance = 0.25f * (float)i;
        rgb left = medium_transmittance(&m, &(medium_stretch){{1.0f, 2.0f, 3.0f}, {0.0f, 0.0f, 1.0f}, distance});
        assert_relative(left.r, exp(-0.1f * (double)distance), 1e-6);
        assert_true(left.g == 1.0f);
        assert_relative(left.b, exp(-7.0 * (double)distance), 1e-4);
    }
    rgb far = medium_transmittance(&m, &(medium_stretch){{1.0f, 2.0f, 3.0f}, {0.0f, 0.0f, 1.0f}, INFINITY});
    assert_true(far.r == 0.0f && far.g == 1.0f && far.b == 0.0f);
    rgb found, scattered;
    assert_true(medium_find_preset("Espresso", &found, &scattered) && found.g == 6.5751f && scattered.g == 0.84557f);
    assert_false(medium_find_preset("espresso", &found, &scattered));
}

/* A slab of a, in which lies one of b, under a ceiling. */
static void slabs(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(
        &r, MEDIA "Material \"interface\"\n"
                  "MediumInterface \"a\" \"\"\n" DOWN("1") UP("3") "MediumInterface \"b\" \"a\"\n" DOWN("1.5")
                      UP("2") "MediumInterface \"\" \"\" Material \"diffuse\"\n" UP("4") DOWN("-1"));
    assert_true(s->has_interfaces);
    expect_way(s, vec3_make(0.2f, 0.3f, 0.0f), vec3_make(0.2f, 0.3f, 4.0f), SCENE_NO_MEDIUM, 1.5, 0.5, SCENE_NO_MEDIUM);
    expect_way(s, vec3_make(0.2f, 0.3f, 0.0f), vec3_make(3.2f, 0.3f, 4.0f), SCENE_NO_MEDIUM, 1.5 * 1.25, 0.5 * 1.25,
               SCENE_NO_MEDIUM);
    /* from within, up and down */
    expect_way(s, vec3_make(0.2f, 0.3f, 1.75f), vec3_make(0.2f, 0.3f, 4.0f), IN_B, 1.0, 0.25, SCENE_NO_MEDIUM);
    expect_way(s, vec3_make(0.2f, 0.3f, 1.75f), vec3_make(0.2f, 0.3f, -1.0f), IN_B, 0.5, 0.25, SCENE_NO_MEDIUM);
    expect_way(s, vec3_make(0.2f, 0.3f, 2.5f), vec3_make(0.2f, 0.3f, -1.0f), IN_A, 1.0, 0.5, SCENE_NO_MEDIUM);
    uint64_t cut = 0;
    /* that ends within */
    scene_ray up = ray_between(vec3_make(0.2f, 0.3f, 0.0f), vec3_make(0.2f, 0.3f, 4.0f), SCENE_NO_MEDIUM);
    assert_left(transmittance_of_ray(s, up, 1.25f, &cut), 0.25, 0.0, 1e-5);
    assert_left(transmittance_of_ray(s, up, 1.75f, &cut), 0.5, 0.25, 1e-5);
    assert_left(transmittance_of_ray(s, up, 1.5f, &cut), 0.5, 0.0, 1e-4); /* just on the interface */
    assert_left(transmittance_of_ray(s, up, 0.5f, &cut), 0.0, 0.0, 0.0);
    /* surfaces alone, in lengths of any direction */
    surface_hit hit;
    up.direction.z = 0.5f;
    assert_true(scene_find_surface(s, up, 8.1f, &hit));
    assert_relative(hit.distance, 8.0, 1e-5);
    assert_relative(hit.position.z, 4.0, 1e-5);
    assert_false(scene_find_surface(s, up, 7.9f, &hit));
    assert_true(scene_is_blocked(s, up, INFINITY));
    assert_false(scene_is_blocked(s, up, 7.9f));
    scene_destroy(s);
    test_run_reset(&r);
}

/* Chords of balls in balls; turned inside out they part the same media. */
static void balls(void **state)
{
    (void)state;
    static const char *const BALLS[] = {
        "MediumInterface \"a\" \"\" Shape \"sphere\" \"float radius\" 2\n"
        "MediumInterface \"b\" \"a\" Shape \"sphere\" \"float radius\" 1\n",
        "ReverseOrientation MediumInterface \"\" \"a\" Shape \"sphere\" \"float radius\" 2\n"
        "MediumInterface \"a\" \"b\" Shape \"sphere\" \"float radius\" 1\n",
        "MediumInterface \"a\" \"\" Shape \"sphere\" \"float radius\" 2\n"
        "Scale 1 1 -1 MediumInterface \"b\" \"a\" Shape \"sphere\" \"float radius\" 1\n"};
    for (int k = 0; k < 3; k++) {
        char text[2048];
        snprintf(text, sizeof text, MEDIA "Shape \"sphere\" \"float radius\" 5\nMaterial \"interface\"\n%s", BALLS[k]);
        test_run r;
        test_run_init(&r, 1);
        scene *s = test_scene_create(&r, text);
        for (int i = 0; i < 40; i++) {
            /* from the wall, past the middle by h */
            double h = 0.06 * i, long_half = sqrt(25.0 - h * h);
            double outer = h < 2.0 ? 2.0 * sqrt(4.0 - h * h) : 0.0, inner = h < 1.0 ? 2.0 * sqrt(1.0 - h * h) : 0.0;
            vec3 from = vec3_make((float)h, (float)(-0.999 * long_half), 0.0f);
            expect_way(s, from, vec3_make((float)h, (float)long_half, 0.0f), SCENE_NO_MEDIUM, outer - inner, inner,
                       SCENE_NO_MEDIUM);
        }
        /* from the middle */
        expect_way(s, vec3_make(0, 0, 0), vec3_make(3, 0, 4), IN_B, 1.0, 1.0, SCENE_NO_MEDIUM);
        scene_destroy(s);
        test_run_reset(&r);
    }
}

/* A ray that leaves a surface is in the medium of its side where there are two, else in that in which it came. */
static void surfaces_tell_rays_their_medium(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(
        &r, MEDIA "MediumInterface \"a\" \"b\" Material \"dielectric\" " UP(
                "1") "MediumInterface \"\" \"\" Material \"diffuse\" " UP("2") "MediumInterface \"a\" \"a\" " UP("3"));
    assert_false(s->has_interfaces);
    const vec3 up = {0.0f, 0.0f, 1.0f}, down = {0.0f, 0.0f, -1.0f};
    static const double FROM[] = {0.5, 1.5, 2.5};
    for (int i = 0; i < 3; i++) {
        scene_ray ray = scene_ray_make(vec3_make(0.1f, 0.2f, (float)FROM[i]), up);
        ray.medium = IN_B;
        surface_hit hit;
        rgb left;
        uint64_t cut = 0;
        assert_true(transmittance_intersect(s, &ray, &cut, &hit, &left));
        assert_left(left, 0.0, 0.5, 1e-5);
        assert_int_equal(ray.medium, IN_B);
        assert_int_equal(surface_ray(&hit, ray, up).medium, IN_B);
        assert_int_equal(surface_ray(&hit, ray, down).medium, i == 0 ? IN_A : IN_B);
        assert_left(transmittance_of_ray(s, ray, 0.4f, &cut), 0.0, 0.4, 1e-5);
        assert_true(rgb_is_black(transmittance_of_ray(s, ray, 0.6f, &cut)));
    }
    /* nothing in the way: to infinity nothing is left, but of what is not absorbed at all */
    scene_ray ray = scene_ray_make(vec3_make(0.1f, 0.2f, 4.0f), up);
    surface_hit hit;
    rgb left;
    uint64_t cut = 0;
    assert_false(transmittance_intersect(s, &ray, &cut, &hit, &left));
    assert_true(left.r == 1.0f && left.g == 1.0f && left.b == 1.0f);
    ray.medium = IN_B;
    assert_false(transmittance_intersect(s, &ray, &cut, &hit, &left));
    assert_true(left.r == 0.0f && left.g == 1.0f && left.b == 0.0f);
    left = transmittance_of_ray(s, ray, INFINITY, &cut);
    assert_true(left.r == 0.0f && left.g == 1.0f && left.b == 0.0f);
    scene_destroy(s);
    test_run_reset(&r);
}

/* Half of the points of a mix with an interface are not there; and a medium is passed there without a trace of it. */
static void mixes_with_an_interface_have_holes(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    scene *s =
        test_scene_create(&r, MEDIA "MakeNamedMaterial \"n\" \"string type\" \"interface\"\n"
                                    "MakeNamedMaterial \"d\" \"string type\" \"diffuse\"\n"
                                    "Material \"mix\" \"string materials\" [\"n\" \"d\"] \"float amount\" 0.3\n" UP(
                                        "1") "Material \"diffuse\" " UP("2"));
    assert_true(s->has_interfaces);
    enum { RAYS = 20000 };
    rng random = test_random(0);
    int passed = 0;
    for (int i = 0; i < RAYS; i++) {
        vec3 from = random_in_box(&random, vec3_make(-4, -4, 0), vec3_make(4, 4, 0.5f));
        scene_ray ray = ray_between(from, vec3_make(0, 0, 1), IN_A);
        surface_hit hit;
        rgb left;
        uint64_t cut = 0;
        ray.direction = vec3_make(0, 0, 1);
        assert_true(transmittance_intersect(s, &ray, &cut, &hit, &left));
        bool is_through = hit.position.z > 1.5f;
        passed += is_through;
        assert_left(left, (is_through ? 2.0 : 1.0) - (double)from.z, 0.0, 1e-4);
        assert_int_equal(
            rgb_is_black(transmittance_of_ray(s, ray_between(from, vec3_add(from, ray.direction), IN_A), 1.4f, &cut)),
            !is_through);
        assert_int_equal(ray.medium, IN_A);
    }
    assert_close(passed, 0.7 * RAYS, 5.0 * sqrt(0.7 * 0.3 * RAYS));
    scene_destroy(s);
    test_run_reset(&r);
}

/* A way across more interfaces than are followed is dark, and is counted. */
static void crossings_have_an_end(void **state)
{
    (void)state;
    char *text = malloc(1u << 18);
    assert_non_null(text);
    for (int more = 0; more < 2; more++) {
        size_t size = (size_t)sprintf(text, MEDIA "MediumInterface \"b\" \"\" Material \"interface\"\n");
        for (int i = 0; i < TRANSMITTANCE_CROSSINGS_MAX + more; i++) {
            char z[32];
            snprintf(z, sizeof z, "%g", 0.01 * (i + 1));
            size += (size_t)sprintf(text + size, "Shape \"disk\" \"float radius\" 3 \"float height\" %s\n", z);
        }
        sprintf(
            text + size,
            "MediumInterface \"\" \"\" Material \"diffuse\" Shape \"disk\" \"float radius\" 3 \"float height\" 4\n");
        test_run r;
        test_run_init(&r, 1);
        scene *s = test_scene_create(&r, text);
        scene_ray ray = scene_ray_make(vec3_make(0.1f, 0.2f, 0.0f), vec3_make(0, 0, 1));
        surface_hit hit;
        rgb left;
        uint64_t cut = 0;
        assert_int_equal(transmittance_intersect(s, &ray, &cut, &hit, &left), !more);
        assert_int_equal(rgb_is_black(left), more);
        assert_int_equal(cut, more);
        ray.medium = SCENE_NO_MEDIUM;
        left = transmittance_of_ray(s, ray, 3.9f, &cut);
        assert_int_equal(rgb_is_black(left), more);
        assert_int_equal(cut, 2 * more);
        scene_destroy(s);
        test_run_reset(&r);
    }
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(beers_law),
        cmocka_unit_test(slabs),
        cmocka_unit_test(balls),
        cmocka_unit_test(surfaces_tell_rays_their_medium),
        cmocka_unit_test(mixes_with_an_interface_have_holes),
        cmocka_unit_test(crossings_have_an_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
