/* test_pane.c: which materials let light straight through, how much, and that photons and eye (samples) and shadow rays
 * (transmittance) are told the same. Threads: one. */
#include "material/bsdf.h"
#include "material/pane.h"
#include "rays/transmittance.h"

#include "fixtures/test_scene.h"

#define SQUARE(z)                                                                                                      \
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [-50 -50 " z "  50 -50 " z "  50 50 " z     \
    "  -50 50 " z "]\n"
#define THIN      "Material \"thindielectric\" \"float eta\" 1.5\n"
#define WALL      "Material \"diffuse\"\n"
#define TINTED    "\"float transmission\" 1 \"float metallic\" 0 \"rgb reflectance\" [0.8 0.4 0.2] "
#define UP_TO_END 4.5f

/* Fresnel's reflectance of one face, from the angles. */
static double face(double cosine, double index)
{
    double in = acos(cosine), through = asin(sin(in) / index);
    if (in < 1e-6)
        return pow((index - 1.0) / (index + 1.0), 2.0);
    double s = sin(in - through) / sin(in + through), p = tan(in - through) / tan(in + through);
    return 0.5 * (s * s + p * p);
}

static double thin_glass(double cosine, double index)
{
    double r = face(cosine, index);
    return (1.0 - r) * (1.0 - r) / (1.0 - r * r);
}

static rgb passed(const scene *s, vec3 from, vec3 direction, bool through_panes)
{
    uint64_t cut = 0;
    scene_ray ray = scene_ray_make(from, direction);
    rgb left = through_panes ? transmittance_through_panes(s, ray, UP_TO_END / direction.z, &cut)
                             : transmittance_of_ray(s, ray, UP_TO_END / direction.z, &cut);
    assert_int_equal(cut, 0);
    return left;
}

/* Upwards from z = 0 at some angles, past whatever is there up to UP_TO_END. */
static void expect_passed(const char *what, double (*of_cosine)(double), const double tint[3])
{
    static const float COSINES[] = {1.0f, 0.9f, 0.6f, 0.3f, 0.15f};
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, what);
    assert_true(s->has_panes);
    for (int i = 0; i < 5; i++) {
        float c = COSINES[i], side = sqrtf(1.0f - c * c);
        vec3 from = {-0.1f, -0.2f, 0.0f}, direction = {side, 0.0f, c};
        rgb left = passed(s, from, direction, true);
        const float value[3] = {left.r, left.g, left.b};
        for (int k = 0; k < 3; k++)
            assert_relative(value[k], of_cosine((double)c) * tint[k], 1e-4);
        assert_true(rgb_is_black(passed(s, from, direction, false)));
    }
    scene_destroy(s);
    test_run_reset(&r);
}

static double one_pane(double c) { return thin_glass(c, 1.5); }
static double two_panes(double c) { return thin_glass(c, 1.5) * thin_glass(c, 1.8); }
static double all_of_it(double c) { return c > 0.0 ? 1.0 : 0.0; }
static double schlick_of(double c) { return 1.0 - (0.04 + 0.96 * pow(1.0 - c, 5.0)); }

static void test_transmittance(void **state)
{
    (void)state;
    static const double CLEAR[3] = {1.0, 1.0, 1.0}, TINT[3] = {0.8, 0.4, 0.2};
    expect_passed(THIN SQUARE("1"), one_pane, CLEAR);
    expect_passed("ReverseOrientation\n" THIN SQUARE("1"), one_pane, CLEAR);
    expect_passed(THIN SQUARE("1") "Material \"thindielectric\" \"float eta\" 1.8\n" SQUARE("1.01"), two_panes, CLEAR);
    expect_passed("Material \"interface\"\n" SQUARE("0.5") THIN SQUARE("1"), one_pane, CLEAR);
    expect_passed("Material \"dielectric\" \"float eta\" 1\n" SQUARE("1") SQUARE("2"), all_of_it, CLEAR);
    expect_passed("Material \"dielectric\" \"float eta\" 1 \"float roughness\" 0.5\n" SQUARE("1"), all_of_it, CLEAR);
    expect_passed("Material \"thindielectric\" \"float eta\" 1\n" SQUARE("1"), all_of_it, CLEAR);
    expect_passed("Material \"principled\" " TINTED "\"float roughness\" 0\n" SQUARE("1"), schlick_of, TINT);
    expect_passed("MakeNamedMaterial \"g\" \"string type\" \"thindielectric\" \"float eta\" 1.5\n"
                  "Material \"mix\" \"string materials\" [\"g\" \"g\"]\n" SQUARE("1"),
                  one_pane, CLEAR);
}

/* A wall behind, rough glass, glass that refracts, a pane that shines: nothing passes. */
static void test_blocked(void **state)
{
    (void)state;
    static const char *const SCENES[] = {
        THIN SQUARE("1") WALL SQUARE("2"),
        WALL SQUARE("1") THIN SQUARE("2"),
        THIN SQUARE("1") "Material \"dielectric\" \"float eta\" 1.5\n" SQUARE("2"),
        THIN SQUARE("1") "Material \"principled\" " TINTED "\"float roughness\" 0.3\n" SQUARE("2"),
        THIN SQUARE("1") "AreaLightSource \"diffuse\"\n" SQUARE("2"),
    };
    for (size_t i = 0; i < sizeof SCENES / sizeof *SCENES; i++) {
        test_run r;
        test_run_init(&r, 1);
        scene *s = test_scene_create(&r, SCENES[i]);
        assert_true(rgb_is_black(passed(s, vec3_make(0.1f, 0.2f, 0.0f), vec3_make(0.0f, 0.6f, 0.8f), true)));
        scene_destroy(s);
        test_run_reset(&r);
    }
    /* where there are none it is said so */
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, "Material \"dielectric\"\n" SQUARE("1") WALL SQUARE("2"));
    assert_false(s->has_panes);
    scene_destroy(s);
    test_run_reset(&r);
}

/* A pane that is there in part: by the hash of each ray either the pane is there, or nothing. */
static void test_alpha_surface(void **state)
{
    (void)state;
    enum { RAYS = 20000 };
    static const double ALPHA = 0.3;
    test_run r;
    test_run_init(&r, 1);
    scene *s =
        test_scene_create(&r, THIN "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"float alpha\" 0.3 "
                                   "\"point3 P\" [-5 -5 1 5 -5 1 5 5 1 -5 5 1]");
    double sum = 0.0, glass = one_pane(1.0);
    for (int i = 0; i < RAYS; i++)
        sum += (double)passed(s, vec3_make(-1.0f + 1e-4f * (float)i, 0.3f, 0.0f), vec3_make(0.0f, 0.0f, 1.0f), true).g;
    double sigma = sqrt(ALPHA * (1.0 - ALPHA) / RAYS) * (1.0 - glass);
    assert_true(fabs(sum / RAYS - (1.0 - ALPHA + ALPHA * glass)) < 4.0 * sigma);
    scene_destroy(s);
    test_run_reset(&r);
}

/* The share of samples that go straight on, by their weights, is the transmittance; they go exactly as they came. */
static void test_samples(void **state)
{
    (void)state;
    enum { SAMPLES = 20000 };
    static const char *const PANES[] = {
        THIN SQUARE("1"), "Material \"dielectric\" \"float eta\" 1\n" SQUARE("1"),
        "Material \"principled\" " TINTED "\"float roughness\" 0 \"float clearcoat\" 1\n" SQUARE("1"),
        "Material \"principled\" \"float transmission\" 0.5 \"float metallic\" 0.2 \"float roughness\" 0\n" SQUARE("1"),
        "Material \"principled\" " TINTED "\"float roughness\" 0 \"bool is_thin\" false \"float ior\" 1\n" SQUARE("1")};
    for (size_t i = 0; i < sizeof PANES / sizeof *PANES; i++)
        for (int side = -1; side <= 1; side += 2)
            for (int transport = 0; transport < 2; transport++) {
                test_run r;
                test_run_init(&r, 1);
                scene *s = test_scene_create(&r, PANES[i]);
                vec3 direction = {0.6f, 0.0f, 0.8f * (float)side};
                scene_ray ray = scene_ray_make(vec3_make(0.0f, 0.1f, 1.0f - (float)side), direction);
                surface_hit hit;
                assert_true(scene_intersect(s, ray, INFINITY, &hit));
                bsdf b;
                bsdf_init(s, &hit, vec3_negate(direction), &b);
                assert_true(b.is_pane);
                rng random = test_random(7);
                double sum = 0.0, squares = 0.0;
                for (int k = 0; k < SAMPLES; k++) {
                    bsdf_sample next;
                    float u_lobe = rng_float(&random);
                    bool is_there = bsdf_sample_direction(&b, BSDF_ALL, transport ? BSDF_FLUX : BSDF_RADIANCE, u_lobe,
                                                          rng_vec2(&random), &next);
                    bool is_through = is_there && next.is_delta && vec3_dot(next.direction, direction) > 0.9999f;
                    assert_int_equal(is_there && next.is_straight, is_through);
                    double value = is_through ? (double)next.weight.r : 0.0;
                    sum += value, squares += value * value;
                }
                double mean = sum / SAMPLES, sigma = sqrt((squares / SAMPLES - mean * mean) / SAMPLES);
                assert_true(fabs(mean - (double)bsdf_straight_transmittance(&b).r) <= 4.0 * sigma + 1e-5);
                scene_destroy(s);
                test_run_reset(&r);
            }
}

/* The ray goes on along its line, however many panes there are; and too many of them are counted. */
static void test_many(void **state)
{
    (void)state;
    static char text[1 << 16];
    for (int count = TRANSMITTANCE_CROSSINGS_MAX; count <= TRANSMITTANCE_CROSSINGS_MAX + 1; count++) {
        size_t length = (size_t)snprintf(text, sizeof text, "Material \"thindielectric\" \"float eta\" 1\n");
        for (int i = 0; i < count; i++)
            length += (size_t)snprintf(text + length, sizeof text - length,
                                       "Shape \"trianglemesh\" \"integer indices\" [0 1 2] "
                                       "\"point3 P\" [-9 -9 %.2f 9 -9 %.2f 0 9 %.2f]\n",
                                       1.0 + 0.01 * i, 1.0 + 0.01 * i, 1.0 + 0.01 * i);
        test_run r;
        test_run_init(&r, 1);
        scene *s = test_scene_create(&r, text);
        uint64_t cut = 0;
        scene_ray up = scene_ray_make(vec3_make(0.1f, 0.2f, 0.0f), vec3_make(0.0f, 0.0f, 1.0f));
        rgb left = transmittance_through_panes(s, up, INFINITY, &cut);
        assert_int_equal(cut, count > TRANSMITTANCE_CROSSINGS_MAX);
        assert_true(left.g == (count > TRANSMITTANCE_CROSSINGS_MAX ? 0.0f : 1.0f));
        scene_destroy(s);
        test_run_reset(&r);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_transmittance), cmocka_unit_test(test_blocked), cmocka_unit_test(test_alpha_surface),
        cmocka_unit_test(test_samples),       cmocka_unit_test(test_many),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
