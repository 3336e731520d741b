/* test_slab.c: which slabs of glass light passes straight, how much of it, that samples and shadow rays are told the
 * same, that a line is judged alike in both directions; and which glass is no slab. Threads: one. */
#include "material/bsdf.h"
#include "rays/slab_faces.h"
#include "rays/transmittance.h"

#include "fixtures/slab_text.h"
#include "fixtures/test_scene.h"

#define UP_TO_END 16.0f

static const float COSINES[] = {1.0f, 0.9f, 0.6f, 0.3f, 0.15f};

/* (1 - R)^2 a / (1 - R^2 a^2), by the angles; a = exp(-depth / cosine within). */
static double slab_share(double cosine, double index, double depth)
{
    double in = acos(cosine), through = asin(sin(in) / index), r = pow((index - 1.0) / (index + 1.0), 2.0);
    if (in > 1e-5) {
        double s = sin(in - through) / sin(in + through), p = tan(in - through) / tan(in + through);
        r = 0.5 * (s * s + p * p);
    }
    double a = exp(-depth / cos(through));
    return (1.0 - r) * (1.0 - r) * a / (1.0 - r * r * a * a);
}

static scene *scene_of(test_run *r, slab_text *t)
{
    test_run_init(r, 1);
    return test_scene_create(r, t->text);
}

static void end_scene(test_run *r, scene *s)
{
    scene_destroy(s);
    test_run_reset(r);
}

static rgb passed(const scene *s, vec3 from, vec3 direction)
{
    uint64_t cut = 0;
    rgb left = transmittance_through_panes(s, scene_ray_make(from, direction), UP_TO_END, &cut);
    assert_int_equal(cut, 0);
    return left;
}

/* Upwards from the origin at several angles. */
static void expect_passed(const char *what, slab_text *t, double index, const double depth[3], int slabs)
{
    test_run r;
    scene *s = scene_of(&r, t);
    if (!s->has_panes || !s->slab_faces)
        fail_msg("%s: there is no slab", what);
    for (int i = 0; i < 5; i++) {
        float c = COSINES[i];
        rgb left = passed(s, vec3_make(0.013f, 0.021f, 0.0f), vec3_make(sqrtf(1.0f - c * c), 0.0f, c));
        const float value[3] = {left.r, left.g, left.b};
        for (int k = 0; k < 3; k++)
            assert_relative(value[k], pow(slab_share((double)c, index, depth[k]), slabs), 2e-4);
    }
    end_scene(&r, s);
}

static const double CLEAR[3] = {0.0, 0.0, 0.0};
static const vec3 LOW = {-20.0f, -20.0f, 1.0f}, HIGH = {20.0f, 20.0f, 1.25f};

static void test_transmittance(void **state)
{
    (void)state;
    slab_text t = {.length = 0};
    slab_say(&t, GLASS);
    slab_box(&t, LOW, HIGH);
    expect_passed("a box", &t, 1.5, CLEAR, 1);

    t.length = 0;
    slab_say(&t, GLASS);
    slab_faces_of(&t, LOW, HIGH, "xXyYzZ");
    expect_passed("six shapes", &t, 1.5, CLEAR, 1);

    t.length = 0;
    slab_say(&t, "Material \"dielectric\" \"float eta\" 1.8\n");
    slab_faces_of(&t, LOW, HIGH, "zZ");
    expect_passed("two faces", &t, 1.8, CLEAR, 1);

    t.length = 0;
    slab_say(&t, GLASS);
    slab_grid(&t, LOW, vec3_make(0, 40, 0), vec3_make(40, 0, 0), 24, "");
    slab_grid(&t, vec3_make(-20, -20, 1.25f), vec3_make(40, 0, 0), vec3_make(0, 40, 0), 7, "");
    expect_passed("faces of many triangles", &t, 1.5, CLEAR, 1);

    /* a file's normals are rounded */
    t.length = 0;
    slab_say(&t, GLASS);
    slab_grid(&t, LOW, vec3_make(0, 40, 0), vec3_make(40, 0, 0), 1,
              "\"normal N\" [.004 .004 -1 0 .005 -1 -.004 -.004 -1 .004 0 -1]");
    slab_grid(&t, vec3_make(-20, -20, 1.25f), vec3_make(40, 0, 0), vec3_make(0, 40, 0), 1,
              "\"normal N\" [.004 -.004 1 -.003 .004 1 0 0 1 0 -.005 1]");
    expect_passed("normals of bytes", &t, 1.5, CLEAR, 1);

    t.length = 0;
    slab_say(&t, GLASS);
    slab_box(&t, LOW, HIGH);
    slab_box(&t, vec3_make(-20, -20, 1.5f), vec3_make(20, 20, 1.75f));
    expect_passed("double glazing", &t, 1.5, CLEAR, 2);

    t.length = 0;
    slab_say(&t, "ObjectBegin \"cube\"\n" GLASS);
    slab_box(&t, vec3_make(-1, -1, -1), vec3_make(1, 1, 1));
    slab_say(&t, "ObjectEnd\nAttributeBegin Translate 0 0 60 ObjectInstance \"cube\" AttributeEnd\n"
                 "AttributeBegin Translate 0 0 1.2 Scale 30 -30 0.1 ObjectInstance \"cube\" AttributeEnd");
    expect_passed("an instance that makes a slab of a cube", &t, 1.5, CLEAR, 1);

    static const double DEPTH[3] = {0.125, 0.25, 0.5};
    t.length = 0;
    slab_say(&t, "MakeNamedMedium \"green\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [0.5 1 2] \"rgb sigma_s\" "
                 "[0 0 0]\nAttributeBegin\n" GLASS "MediumInterface \"green\" \"\"\n");
    slab_box(&t, LOW, HIGH);
    slab_say(&t, "AttributeEnd");
    expect_passed("glass that absorbs", &t, 1.5, DEPTH, 1);
}

/* A third of a radian of a cylinder about an axis along y, at z = 1 and above, of facets that turn by less than
 * FLAT_ANGLE_MAX. */
static void bent_face(slab_text *t, float radius, bool is_turned)
{
    enum { STEPS = 400 };
    char word[96];
    slab_say(t, "Shape \"trianglemesh\" \"point3 P\" [");
    for (int i = 0; i <= STEPS; i++)
        for (int side = -1; side <= 1; side += 2) {
            double angle = 8e-4 * (i - STEPS / 2);
            snprintf(word, sizeof word, "%.9g %d %.9g", (double)radius * sin(angle), 20 * side,
                     (double)radius * cos(angle) - 99.0);
            slab_say(t, word);
        }
    slab_say(t, "] \"integer indices\" [");
    for (int i = 0; i < 2 * STEPS; i += 2) {
        int a = i, b = is_turned ? i + 1 : i + 2, c = is_turned ? i + 2 : i + 1;
        snprintf(word, sizeof word, "%d %d %d %d %d %d", a, b, i + 3, a, i + 3, c);
        slab_say(t, word);
    }
    slab_say(t, "]");
}

/* No light passes straight, and scenes without slabs are told of none: a block, a wedge, a plate whose normals are
 * bent, a fine cylinder, rough glass, a single face, faces turned inwards, a plate that shines or is there in part,
 * two materials, and glass in which a medium scatters light. */
static void test_other_glass(void **state)
{
    (void)state;
    static slab_text t[12];
    int n = 0;
    slab_say(&t[n], GLASS);
    slab_box(&t[n++], LOW, vec3_make(20, 20, 3.0f));
    slab_say(&t[n], GLASS);
    slab_grid(&t[n], LOW, vec3_make(0, 40, 0), vec3_make(40, 0, 0.2f), 1, "");
    slab_grid(&t[n++], vec3_make(-20, -20, 1.25f), vec3_make(40, 0, 0), vec3_make(0, 40, 0), 1, "");
    slab_say(&t[n], GLASS);
    static const char BENT[] = "\"normal N\" [-.1 0 -1 .1 0 -1 -.1 0 -1 .1 0 -1]";
    slab_grid(&t[n], LOW, vec3_make(0, 40, 0), vec3_make(40, 0, 0), 1, BENT);
    slab_grid(&t[n++], vec3_make(-20, -20, 1.25f), vec3_make(40, 0, 0), vec3_make(0, 40, 0), 1, "");
    slab_say(&t[n], "Material \"dielectric\" \"float roughness\" 0.2\n");
    slab_box(&t[n++], LOW, HIGH);
    slab_say(&t[n], GLASS);
    slab_faces_of(&t[n++], LOW, HIGH, "Z");
    slab_say(&t[n], GLASS "ReverseOrientation\n");
    slab_box(&t[n++], LOW, HIGH);
    slab_say(&t[n], GLASS "AreaLightSource \"diffuse\"\n");
    slab_box(&t[n++], LOW, HIGH);
    slab_say(&t[n], GLASS);
    slab_grid(&t[n], LOW, vec3_make(0, 40, 0), vec3_make(40, 0, 0), 1, "\"float alpha\" 0.5");
    slab_grid(&t[n++], vec3_make(-20, -20, 1.25f), vec3_make(40, 0, 0), vec3_make(0, 40, 0), 1, "");
    slab_say(&t[n], GLASS);
    slab_faces_of(&t[n], LOW, HIGH, "z");
    slab_say(&t[n], "Material \"dielectric\" \"float eta\" 1.6\n");
    slab_faces_of(&t[n++], LOW, HIGH, "Z");
    slab_say(&t[n], "ObjectBegin \"plate\"\n" GLASS);
    slab_box(&t[n], LOW, HIGH);
    slab_say(&t[n++], "ObjectEnd\nTranslate 0 0 -18 Scale 1 1 20 ObjectInstance \"plate\"\n");
    slab_say(&t[n], GLASS);
    bent_face(&t[n], 100.25f, false);
    bent_face(&t[n++], 100.0f, true);
    slab_say(&t[n], "MakeNamedMedium \"milk\" \"string type\" \"homogeneous\"\nAttributeBegin\n" GLASS
                    "MediumInterface \"milk\" \"\"\n");
    slab_box(&t[n], LOW, HIGH);
    slab_say(&t[n++], "AttributeEnd");
    assert_int_equal(n, 12);
    for (int i = 0; i < n; i++) {
        test_run r;
        scene *s = scene_of(&r, &t[i]);
        if (s->has_panes || s->slab_faces)
            fail_msg("scene %d: has slabs", i);
        if (!rgb_is_black(passed(s, vec3_make(0.1f, 0.2f, 0.0f), vec3_make(0.0f, 0.6f, 0.8f))))
            fail_msg("scene %d: light passes", i);
        end_scene(&r, s);
    }
}

/* The way that samples take straight on weighs what shadow rays are told, the rest is mirrored, and together they are
 * what the slab does not absorb. */
static void test_samples(void **state)
{
    (void)state;
    enum { SAMPLES = 20000 };
    static const char *const MATERIALS[] = {
        GLASS, "Material \"principled\" \"float transmission\" 1 \"float metallic\" 0 \"rgb reflectance\" [.9 .8 .7] "
               "\"float roughness\" 0 \"bool is_thin\" false \"float ior\" 1.5\n"};
    for (int i = 0; i < 2; i++)
        for (int side = -1; side <= 1; side += 2) {
            static slab_text t;
            t.length = 0;
            slab_say(&t, MATERIALS[i]);
            slab_box(&t, LOW, HIGH);
            test_run r;
            scene *s = scene_of(&r, &t);
            vec3 direction = {0.6f, 0.0f, 0.8f * (float)side};
            scene_ray ray = scene_ray_make(vec3_make(0.0f, 0.1f, 1.0f - (float)side), direction);
            surface_hit hit;
            rgb way;
            uint64_t cut = 0;
            /* to the eye it is glass that bends */
            assert_true(transmittance_intersect(s, &ray, &cut, &hit, &way));
            bsdf b;
            bsdf_init(s, &hit, vec3_negate(direction), &b);
            assert_false(b.is_pane);
            ray.slabs_are_panes = true;
            assert_true(transmittance_intersect(s, &ray, &cut, &hit, &way));
            bsdf_init(s, &hit, vec3_negate(direction), &b);
            assert_true(b.is_pane);
            rng random = test_random(7);
            double through = 0.0, back = 0.0, squares = 0.0;
            for (int k = 0; k < SAMPLES; k++) {
                bsdf_sample next;
                float u_lobe = rng_float(&random);
                assert_true(bsdf_sample_direction(&b, BSDF_ALL, BSDF_FLUX, u_lobe, rng_vec2(&random), &next));
                bool is_through = vec3_dot(next.direction, direction) > 0.9999f;
                assert_true(next.is_delta && next.is_straight == is_through);
                *(is_through ? &through : &back) += (double)next.weight.g / SAMPLES;
                squares += is_through ? (double)next.weight.g * (double)next.weight.g / SAMPLES : 0.0;
            }
            double expected = (double)passed(s, ray.origin, direction).g;
            double sigma = sqrt((squares - through * through) / SAMPLES);
            assert_true(fabs(through - expected) <= 4.0 * sigma + 1e-5);
            assert_true(through + back <= 1.0 + 4.0 * sigma);
            if (i == 0) {
                assert_relative(expected, slab_share(0.8, 1.5, 0.0), 1e-4);
                assert_true(fabs(through + back - 1.0) <= 1e-4);
            }
            scene_ray on = scene_ray_continue(&hit, &ray);
            assert_true((on.origin.z - (side > 0 ? HIGH.z : LOW.z)) * (float)side > 0.0f);
            assert_true(fabsf(on.origin.x - 0.75f * fabsf(on.origin.z - ray.origin.z)) < 1e-3f);
            end_scene(&r, s);
        }
}

/* Random lines through two slabs with bars, frames and a lamp's housing in them, both ways: what passes is the same,
 * and some of each kind there are. */
static void test_both_ways(void **state)
{
    (void)state;
    enum { LINES = 20000 / FEWER };
    static slab_text t;
    t.length = 0;
    slab_say(&t, GLASS);
    slab_box(&t, vec3_make(-1, -1, 1), vec3_make(1, 1, 1.05f));
    slab_box(&t, vec3_make(-1.5f, -1, 1.1f), vec3_make(0.8f, 1, 1.12f));
    slab_say(&t, "Material \"diffuse\"\n");
    slab_box(&t, vec3_make(-0.1f, -1, 0.98f), vec3_make(0, 1, 1.08f));         /* a bar across the first one */
    slab_box(&t, vec3_make(0.3f, -0.2f, 1.01f), vec3_make(0.5f, 0.2f, 1.03f)); /* within its glass */
    slab_box(&t, vec3_make(-1.2f, -1, 0.9f), vec3_make(-0.9f, 1, 1.2f));       /* a frame about one edge of both */
    test_run r;
    scene *s = scene_of(&r, &t);
    rng random = test_random(3);
    int open = 0, shut = 0, differ = 0;
    for (int i = 0; i < LINES; i++) {
        vec3 from = {3.0f * rng_float(&random) - 1.5f, 2.0f * rng_float(&random) - 1.0f, 0.5f};
        vec3 to = {3.0f * rng_float(&random) - 1.5f, 2.0f * rng_float(&random) - 1.0f, 1.6f};
        uint64_t cut = 0;
        rgb up = transmittance_through_panes(s, scene_ray_make(from, vec3_sub(to, from)), 1.0f, &cut);
        rgb down = transmittance_through_panes(s, scene_ray_make(to, vec3_sub(from, to)), 1.0f, &cut);
        differ += fabsf(up.g - down.g) > 1e-4f;
        open += up.g > 0.0f;
        shut += up.g == 0.0f;
    }
    assert_true(open > LINES / 4 && shut > LINES / 10);
    assert_true(differ <= LINES / 5000); /* lines within a rounding of an edge */
    end_scene(&r, s);
}

/* An end within the glass is not to be reached straight. */
static void test_end_within(void **state)
{
    (void)state;
    static slab_text t;
    t.length = 0;
    slab_say(&t, GLASS);
    slab_box(&t, LOW, HIGH);
    test_run r;
    scene *s = scene_of(&r, &t);
    static const float ENDS[] = {0.9f, 1.1f, 1.3f};
    for (int i = 0; i < 3; i++) {
        uint64_t cut = 0;
        scene_ray up = scene_ray_make(vec3_make(0.1f, 0.2f, 0.0f), vec3_make(0.0f, 0.0f, 1.0f));
        float left = transmittance_through_panes(s, up, ENDS[i], &cut).g;
        assert_true(i == 0 ? left == 1.0f : i == 1 ? left == 0.0f : left > 0.9f && left < 0.93f);
    }
    end_scene(&r, s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_transmittance), cmocka_unit_test(test_other_glass), cmocka_unit_test(test_samples),
        cmocka_unit_test(test_both_ways),     cmocka_unit_test(test_end_within),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
