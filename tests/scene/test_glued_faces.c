/* test_glued_faces.c: glass that lies flush on opaque faces: which shapes are found to do so, that every kind of ray
 * meets the opaque one there, in any order of the file and after any turn, and the medium of rays that leave it.
 * Threads: one. */
#include "rays/glued_faces.h"
#include "rays/transmittance.h"

#include "fixtures/test_scene.h"

#define MATTE "Material \"diffuse\"\n"
#define GLASS "Material \"dielectric\"\n"
#define FLOOR                                                                                                          \
    MATTE "Shape \"trianglemesh\" \"point3 P\" [-2 -2 0  2 -2 0  2 2 0  -2 2 0] \"integer indices\" [0 1 2 0 2 3]\n"
/* A box from (-1, -1, low) to (1, 1, 0.25), outwards; the diagonal of its bottom is not the floor's. */
#define BOX(low)                                                                                                       \
    "Shape \"trianglemesh\" \"point3 P\" [-1 -1 " low " 1 -1 " low " 1 1 " low " -1 1 " low                            \
    " -1 -1 .25 1 -1 .25 1 1 .25 -1 1 .25] \"integer indices\" "                                                       \
    "[0 3 1 1 3 2  4 5 6 4 6 7  0 1 5 0 5 4  1 2 6 1 6 5  2 3 7 2 7 6  3 0 4 3 4 7]\n"
#define SHEET(z) "Shape \"trianglemesh\" \"point3 P\" [-1 -1 " z " 1 -1 " z " 1 1 " z "] \"integer indices\" [0 1 2]\n"
#define TURNED   "Translate 3.7 -1.9 0.613 Rotate 37 0.3 1 0.2 Scale 1.3 1.3 1.3\n"
#define MEDIUM                                                                                                         \
    "MakeNamedMedium \"a\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [0 0 0] \"rgb sigma_a\" [0.5 1 2]\n"        \
    "AttributeBegin MediumInterface \"a\" \"\"\n"

/* --- what is found --- */

/* Which shapes of a scene are glued, as bits. */
static unsigned glued_of(const char *text)
{
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, text);
    unsigned glued = 0;
    for (uint32_t i = 0; i < s->shape_count; i++)
        glued |= (unsigned)s->shapes[i].is_glued << i;
    assert_int_equal(s->has_glued_faces, glued != 0);
    scene_destroy(s);
    test_run_reset(&r);
    return glued;
}

static void test_found(void **state)
{
    (void)state;
    static const struct {
        const char *what, *text;
        unsigned glued;
    } CASES[] = {
        {"a plate on the floor", FLOOR GLASS BOX("0"), 2},
        {"before it in the file", GLASS BOX("0") FLOOR, 1},
        {"turned", TURNED FLOOR GLASS BOX("0"), 2},
        {"1 mm above it", FLOOR GLASS BOX("0.001"), 0},
        {"1 mm below it", FLOOR GLASS BOX("-0.001"), 0},
        {"less than rounding above it", FLOOR GLASS BOX("1e-6"), 2},
        {"rough", FLOOR "Material \"dielectric\" \"float roughness\" 0.3\n" BOX("0"), 2},
        {"a pane", FLOOR "Material \"thindielectric\"\n" SHEET("0"), 2},
        {"an interface", FLOOR MEDIUM "Material \"interface\"\n" BOX("0") "AttributeEnd\n", 2},
        {"metal", FLOOR "Material \"conductor\"\n" BOX("0"), 0},
        {"only glass", GLASS BOX("0") SHEET("0"), 0},
        {"a mix of glass and no surface",
         FLOOR "MakeNamedMaterial \"g\" \"string type\" \"dielectric\" MakeNamedMaterial \"i\" \"string type\" "
               "\"interface\" Material \"mix\" \"string materials\" [\"g\" \"i\"]\n" BOX("0"),
         2},
        {"on a lamp", "AreaLightSource \"diffuse\" " MATTE SHEET("0") "AttributeBegin\n" GLASS "AttributeEnd\n", 0},
        {"a disk of glass", FLOOR GLASS "Shape \"disk\" \"float radius\" 0.5", 2},
        {"a disk of the floor", MATTE "Shape \"disk\" \"float radius\" 0.5 " GLASS BOX("0"), 2},
        {"a ball in paint", MATTE "Shape \"sphere\" " GLASS "Shape \"sphere\"", 2},
        {"a small leg under a large top",
         "AttributeBegin " MATTE
         "Translate 0.613 0.387 0 Scale 0.01 0.01 0.01 " SHEET("0") "AttributeEnd\n" GLASS BOX("0"),
         2},
        {"an instance of glass",
         FLOOR "ObjectBegin \"o\"\n" GLASS BOX("0") "ObjectEnd Translate 0 0 5 ObjectInstance \"o\" Translate 0 0 -5 "
                                                    "Scale 0.1 0.1 0.1 ObjectInstance \"o\"",
         2},
        {"an instance of the floor",
         "ObjectBegin \"o\"\n" FLOOR "ObjectEnd\n" GLASS "AttributeBegin Translate 0 0 5 ObjectInstance \"o\" "
         "AttributeEnd AttributeBegin Translate 0.7 0.7 0 Scale 0.1 0.1 0.1 ObjectInstance \"o\" AttributeEnd\n" BOX(
             "0"),
         2},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++)
        if (glued_of(CASES[i].text) != CASES[i].glued)
            fail_msg("%s: %x is not %x", CASES[i].what, glued_of(CASES[i].text), CASES[i].glued);
}

/* One warning names translucent shapes, however many there are, and glass that shines is not glued. */
static void test_translucent(void **state)
{
    (void)state;
    static const char TEXT[] =
        "WorldBegin\n" FLOOR "MakeNamedMaterial \"paper\" \"string type\" \"diffusetransmission\"\n"
        "NamedMaterial \"paper\"\n" SHEET("0") BOX("0") SHEET("0.2") "\n";
    test_run r;
    test_run_init(&r, 1);
    scene *s = scene_create();
    assert_int_equal(pbrt_parse_text(&r.run, "scene", TEXT, strlen(TEXT), s), AG_OK);
    assert_int_equal(scene_commit(s, &r.run, NULL), AG_OK);
    assert_int_equal(r.warning_count, 1);
    assert_non_null(strstr(r.said, "2 of the shapes"));
    assert_non_null(strstr(r.said, "shape 1 of material \"paper\""));
    assert_false(s->has_glued_faces);
    scene_destroy(s);
    test_run_reset(&r);
    assert_int_equal(glued_of(FLOOR "AttributeBegin AreaLightSource \"diffuse\"\n" GLASS BOX("0") "AttributeEnd\n"), 0);
}

/* --- what rays meet --- */

static bool is_matte(const scene *s, const surface_hit *hit)
{
    return s->materials[s->shapes[hit->shape_index].material_index].kind == MATERIAL_DIFFUSE;
}

/* Rays to points of the plate's bottom meet the floor, from within the glass or from below: one by one, bounded, and
 * as fans of few and of many. */
static void expect_floor(const char *text, bool is_turned, float least, float most)
{
    enum { RAYS = 2048 / FEWER, FAN = 64 };
    test_run r;
    rng random = test_random(31);
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, text);
    if (!s->has_glued_faces)
        fail_msg("nothing is glued in %s", text);
    transform turn = transform_identity();
    if (is_turned) {
        transform rotated, scaled, placed = transform_translate(3.7, -1.9, 0.613);
        assert_true(transform_rotate(37.0, 0.3, 1.0, 0.2, &rotated) && transform_scale(1.3, 1.3, 1.3, &scaled));
        rotated = transform_multiply(&rotated, &scaled);
        turn = transform_multiply(&placed, &rotated);
    }
    for (int i = 0; i < RAYS / FAN; i++) {
        ray_fan fan = {.count = i % 2 ? FAN : 8};
        surface_hit hit;
        vec3 from = random_in_box(&random, (vec3){-0.9f, -0.9f, least}, (vec3){0.9f, 0.9f, most});
        vec3 origin = transform_point(&turn, from);
        fan.common = scene_ray_make(origin, (vec3){0.0f, 0.0f, 0.0f});
        for (uint32_t k = 0; k < fan.count; k++) {
            vec3 to =
                transform_point(&turn, random_in_box(&random, (vec3){-0.9f, -0.9f, 0.0f}, (vec3){0.9f, 0.9f, 0.0f}));
            vec3 way = vec3_sub(to, origin), direction = vec3_normalize(way);
            scene_ray ray = scene_ray_make(origin, direction);
            fan.direction[0][k] = direction.x, fan.direction[1][k] = direction.y, fan.direction[2][k] = direction.z;
            assert_true(scene_intersect(s, ray, INFINITY, &hit));
            assert_true(is_matte(s, &hit));
            assert_true(vec3_length(vec3_sub(hit.position, to)) < 1e-3f * vec3_length(way));
            ray.direction = way;
            assert_true(scene_intersect(s, ray, 1.001f, &hit));
            assert_true(is_matte(s, &hit));
            assert_false(scene_intersect(s, ray, 0.999f, &hit));
        }
        scene_intersect_fan(s, &fan);
        for (uint32_t k = 0; k < fan.count; k++) {
            ray_fan_hit(s, &fan, k, &hit);
            assert_true(is_matte(s, &hit));
        }
    }
    scene_destroy(s);
    test_run_reset(&r);
}

static void test_rays(void **state)
{
    (void)state;
    expect_floor(FLOOR GLASS BOX("0"), false, 0.01f, 0.24f);
    expect_floor(GLASS BOX("0") FLOOR, false, 0.01f, 0.24f);
    expect_floor(FLOOR GLASS BOX("1e-6"), false, 0.01f, 0.24f);
    expect_floor(FLOOR GLASS BOX("-1e-6"), false, 0.01f, 0.24f);
    expect_floor(TURNED FLOOR GLASS BOX("0"), true, 0.01f, 0.24f);
    expect_floor(TURNED GLASS BOX("0") FLOOR, true, 0.01f, 0.24f);
    expect_floor(TURNED GLASS BOX("0") FLOOR, true, -3.0f, -0.5f);
    expect_floor(FLOOR "Material \"thindielectric\"\n" BOX("0"), false, -3.0f, -0.5f);
    expect_floor("ObjectBegin \"o\"\n" GLASS BOX("0") "ObjectEnd\n" TURNED "ObjectInstance \"o\"\n" FLOOR, true, 0.01f,
                 0.24f);
}

/* Beside the floor the glass is met as ever, from both sides. */
static void test_beside(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, GLASS BOX("0") "Translate 2 0 0 " FLOOR);
    surface_hit hit;
    assert_true(s->has_glued_faces);
    for (int side = -1; side <= 1; side += 2) {
        scene_ray ray = scene_ray_make((vec3){-0.5f, 0.3f, 0.1f * (float)side}, (vec3){0.0f, 0.0f, -(float)side});
        assert_true(scene_intersect(s, ray, INFINITY, &hit));
        assert_int_equal(hit.shape_index, 0);
        ray.origin.x = 0.5f;
        assert_true(scene_intersect(s, ray, INFINITY, &hit));
        assert_int_equal(hit.shape_index, 1);
        ray.origin.z = 1.0f;
        ray.direction.z = -1.0f;
        assert_true(scene_intersect(s, ray, INFINITY, &hit)); /* the glass's upper face */
        assert_int_equal(hit.shape_index, 0);
    }
    scene_destroy(s);
    test_run_reset(&r);
}

/* --- media --- */

/* A ray comes into a box of a medium that stands on the floor, and one that is refracted starts in it: both arrive in
 * the medium, by Beer's law, and what leaves the floor is in it. */
static void expect_medium(const char *kind, bool starts_within)
{
    static const double SIGMA_A[3] = {0.5, 1.0, 2.0};
    char text[2048];
    test_run r;
    test_run_init(&r, 1);
    snprintf(text, sizeof text, "%s" MEDIUM "Material \"%s\"\n%sAttributeEnd\n", FLOOR, kind, BOX("0"));
    scene *s = test_scene_create(&r, text);
    scene_ray ray = scene_ray_make((vec3){0.2f, 0.3f, starts_within ? 0.2f : 2.0f}, (vec3){0.0f, 0.6f, -0.8f});
    ray.medium = starts_within ? 0 : SCENE_NO_MEDIUM;
    ray.origin.y = starts_within ? 0.3f : -1.3f;
    surface_hit hit;
    rgb left;
    uint64_t cut = 0;
    assert_true(transmittance_intersect(s, &ray, &cut, &hit, &left));
    assert_true(is_matte(s, &hit));
    assert_int_equal(ray.medium, 0);
    const float value[3] = {left.r, left.g, left.b};
    for (int c = 0; c < 3; c++)
        assert_relative(value[c], exp(-SIGMA_A[c] * (starts_within ? 0.2 : 0.25) / 0.8), 1e-4);
    scene_ray next = surface_ray(&hit, ray, (vec3){0.0f, 0.6f, 0.8f});
    assert_int_equal(next.medium, 0);
    assert_true(scene_intersect(s, next, INFINITY, &hit)); /* the upper face, from within */
    assert_int_equal(hit.shape_index, 1);
    assert_close(hit.position.z, 0.25, 1e-6);
    scene_destroy(s);
    test_run_reset(&r);
}

static void test_media(void **state)
{
    (void)state;
    expect_medium("dielectric", true);
    expect_medium("interface", true);
    expect_medium("interface", false);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_found),  cmocka_unit_test(test_translucent), cmocka_unit_test(test_rays),
        cmocka_unit_test(test_beside), cmocka_unit_test(test_media),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
