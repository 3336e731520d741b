/* test_shading_frame.c: bump maps against the normals of the surfaces they stand for, normal maps against what their
 * colours say, the frame along the grain of brushed metal, and normals that stay above the horizon. Threads: the run's
 * workers build, one asks. */
#include "material/shading_frame.h"

#include "fixtures/shared_run.h"
#include "material/bsdf.h"

enum { POINTS = 300 / FEWER };

#define RAMP                                                                                                           \
    "Texture \"ramp\" \"float\" \"bilerp\" \"float v00\" 0.1 \"float v10\" 0.4 \"float v01\" 0.3 \"float v11\" 0.6\n"
static const double RISE_U = 0.3, RISE_V = 0.2;
#define RAISED "Material \"diffuse\" \"texture displacement\" \"ramp\"\n"
/* 2 by 4; u along x, v along y */
#define PLANE                                                                                                          \
    "Shape \"trianglemesh\" \"point3 P\" [ -1 -2 0 1 -2 0 1 2 0 -1 2 0 ] \"integer indices\" [ 0 1 2 0 2 3 ]\n"        \
    "\"point2 uv\" [ 0 0 1 0 1 1 0 1 ]\n"

static surface_hit hit_from_above(const scene *s, float x, float y)
{
    surface_hit hit;
    assert_true(scene_intersect(s, scene_ray_make((vec3){x, y, 5.0f}, (vec3){0.0f, 0.0f, -1.0f}), INFINITY, &hit));
    return hit;
}

static vec3 normal_at(const scene *s, const surface_hit *hit)
{
    bsdf b;
    bsdf_init(s, hit, hit->geometric_normal, &b);
    return b.shading.z;
}

static void assert_direction(vec3 value, double x, double y, double z, double tolerance)
{
    double length = sqrt(x * x + y * y + z * z);
    assert_close((double)value.x, x / length, tolerance);
    assert_close((double)value.y, y / length, tolerance);
    assert_close((double)value.z, z / length, tolerance);
}

static void a_ramp_on_a_plane(void **state)
{
    (void)state;
    /* height rises by 0.3 on 2 and by 0.2 on 4 */
    scene *s = test_scene_create(&run, RAMP RAISED PLANE);
    surface_hit hit = hit_from_above(s, 0.3f, 0.7f);
    assert_direction(normal_at(s, &hit), -RISE_U / 2.0, -RISE_V / 4.0, 1.0, 1e-4);
    scene_destroy(s);
    /* turned over, it is raised towards the new outside */
    s = test_scene_create(&run, RAMP RAISED "ReverseOrientation " PLANE);
    hit = hit_from_above(s, 0.3f, 0.7f);
    assert_direction(normal_at(s, &hit), -RISE_U / 2.0, -RISE_V / 4.0, -1.0, 1e-4);
    scene_destroy(s);
    /* larger, the relief is as high as before, and flatter for that; in a mirror */
    s = test_scene_create(&run, RAMP RAISED "Scale -2 2 2 " PLANE);
    hit = hit_from_above(s, 0.3f, 0.7f);
    assert_direction(normal_at(s, &hit), RISE_U / 4.0, -RISE_V / 8.0, 1.0, 1e-4);
    scene_destroy(s);
    /* uvs askew: u = x + y, v = y */
    s = test_scene_create(&run, RAMP RAISED
                          "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"point2 uv\" [ 0 0 1 0 1 1 ]");
    hit = hit_from_above(s, 0.3f, 0.2f);
    assert_direction(normal_at(s, &hit), -RISE_U, -RISE_U - RISE_V, 1.0, 1e-4);
    scene_destroy(s);
}

/* r(u, v) = R + d: its normal is n - (dd/du u^ / |dp/du| + dd/dv v^ / |dp/dv|) with the tangents of the raised
 * sphere. */
static void a_ramp_on_a_sphere(void **state)
{
    (void)state;
    static const char *const WORLDS[] = {RAMP RAISED "Shape \"sphere\" \"float radius\" 1.5",
                                         RAMP RAISED "ReverseOrientation Shape \"sphere\" \"float radius\" 1.5"};
    for (int w = 0; w < 2; w++) {
        scene *s = test_scene_create(&run, WORLDS[w]);
        rng random = test_random(5);
        double side = w == 0 ? 1.0 : -1.0; /* inwards, the raised sphere is a smaller one */
        for (int i = 0; i < POINTS; i++) {
            vec3 out = random_direction(&random);
            surface_hit hit;
            assert_true(scene_intersect(s, scene_ray_make(vec3_scale(out, 5.0f), vec3_negate(out)), INFINITY, &hit));
            double theta = PI * (1.0 - (double)hit.uv.y), phi = 2.0 * PI * (double)hit.uv.x;
            if (sin(theta) < 0.3)
                continue;
            double height = 0.1 + RISE_U * (double)hit.uv.x + RISE_V * (double)hit.uv.y, r = 1.5 + side * height;
            double slope_phi = side * RISE_U / (2.0 * PI * r * sin(theta)), slope_theta = -side * RISE_V / (PI * r);
            double n[3] = {sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)};
            double along_phi[3] = {-sin(phi), cos(phi), 0.0};
            double along_theta[3] = {cos(theta) * cos(phi), cos(theta) * sin(phi), -sin(theta)};
            double expected[3];
            for (int k = 0; k < 3; k++)
                expected[k] = side * (n[k] - slope_phi * along_phi[k] - slope_theta * along_theta[k]);
            assert_direction(normal_at(s, &hit), expected[0], expected[1], expected[2], 1e-3);
        }
        scene_destroy(s);
    }
}

/* Solid textures too: displacement 0.2 x, of a disk, by a planar mapping. */
static void a_relief_in_space(void **state)
{
    (void)state;
    scene *s = test_scene_create(
        &run, "Texture \"ramp\" \"float\" \"bilerp\" \"string mapping\" \"planar\" \"float v00\" 0\n"
              "\"float v10\" 0.2 \"float v01\" 0 \"float v11\" 0.2\n" RAISED "Shape \"disk\" \"float radius\" 2");
    surface_hit hit = hit_from_above(s, 0.6f, -0.7f);
    assert_direction(normal_at(s, &hit), -0.2, 0.0, 1.0, 1e-3);
    scene_destroy(s);
}

/* The material that a mix picks keeps its own maps. */
static void mixes_have_the_maps_of_what_they_pick(void **state)
{
    (void)state;
    scene *s = test_scene_create(
        &run, RAMP "MakeNamedMaterial \"flat\" \"string type\" \"diffuse\"\n"
                   "MakeNamedMaterial \"raised\" \"string type\" \"diffuse\" \"texture displacement\" \"ramp\"\n"
                   "Material \"mix\" \"string materials\" [ \"flat\" \"raised\" ]\n" PLANE);
    rng random = test_random(6);
    int raised = 0;
    for (int i = 0; i < POINTS; i++) {
        surface_hit hit = hit_from_above(s, 1.8f * (rng_float(&random) - 0.5f), 3.8f * (rng_float(&random) - 0.5f));
        vec3 n = normal_at(s, &hit);
        bool is_raised = n.x < -0.01f;
        if (is_raised)
            assert_direction(n, -RISE_U / 2.0, -RISE_V / 4.0, 1.0, 1e-4);
        else
            assert_direction(n, 0.0, 0.0, 1.0, 0.0);
        raised += is_raised;
    }
    assert_close((double)raised / POINTS, 0.5, 4.5 * sqrt(0.25 / POINTS));
    scene_destroy(s);
}

/* A material with a normal map of one colour. */
static material with_normal_map(scene *s, rgb color)
{
    texture t;
    memset(&t, 0, sizeof t);
    t.kind = TEXTURE_CONSTANT;
    t.is_spectrum = true;
    t.inputs[0].value = color;
    for (int i = 0; i < 4; i++)
        t.inputs[i].texture_index = SCENE_NO_TEXTURE;
    material m = material_make(MATERIAL_DIFFUSE);
    assert_int_equal(texture_set_add(&s->textures, &t, &m.normal_map_texture), AG_OK);
    return m;
}

static void normal_maps_say_the_normal(void **state)
{
    (void)state;
    scene *s = test_scene_create(&run, PLANE);
    material m = with_normal_map(s, rgb_make(0.5f + 0.5f * 0.36f, 0.5f - 0.5f * 0.48f, 0.9f)); /* (.36 -.48 .8) */
    surface_hit hit = hit_from_above(s, 0.3f, 0.7f);
    frame f = shading_frame_at(s, &hit, &m, false);
    assert_direction(f.z, 0.36, -0.48, 0.8, 1e-5);
    assert_close((double)vec3_dot(f.x, f.z), 0.0, 1e-6);
    m.normal_scale = 0.5f;
    assert_direction(shading_frame_at(s, &hit, &m, false).z, 0.18, -0.24, 0.8, 1e-5);
    m.normal_scale = 0.0f;
    assert_direction(shading_frame_at(s, &hit, &m, false).z, 0.0, 0.0, 1.0, 1e-6);
    scene_destroy(s);
    /* on mirrored uvs red goes with u, green with v */
    s = test_scene_create(&run, "Scale -1 1 1 Rotate 90 0 0 1 " PLANE);
    m = with_normal_map(s, rgb_make(0.5f + 0.5f * 0.36f, 0.5f - 0.5f * 0.48f, 0.9f));
    hit = hit_from_above(s, 0.3f, 0.7f);
    /* u runs along +y, v along +x; outside stays up */
    assert_direction(shading_frame_at(s, &hit, &m, false).z, -0.48, 0.36, 0.8, 1e-5);
    scene_destroy(s);
}

/* However a map tilts it, the normal stays unit and above the surface. */
static void normals_stay_usable(void **state)
{
    (void)state;
    static const rgb COLORS[] = {{1.0f, 0.5f, 0.5f}, {1.0f, 1.0f, 0.0f}, {0.5f, 0.5f, 0.0f},
                                 {0.5f, 0.5f, 0.5f}, {0.0f, 0.2f, 0.3f}, {9.0f, -7.0f, 2.0f}};
    scene *s = test_scene_create(&run, PLANE);
    surface_hit hit = hit_from_above(s, 0.3f, 0.7f);
    for (size_t i = 0; i < sizeof COLORS / sizeof *COLORS; i++) {
        material m = with_normal_map(s, COLORS[i]);
        frame f = shading_frame_at(s, &hit, &m, false);
        assert_close((double)vec3_length(f.z), 1.0, 1e-5);
        assert_close((double)vec3_length(f.x), 1.0, 1e-5);
        assert_true(vec3_dot(f.z, hit.geometric_normal) > 0.01f);
    }
    /* tilted as far as it goes it still points where the map says */
    material m = with_normal_map(s, COLORS[0]);
    assert_true(shading_frame_at(s, &hit, &m, false).z.x > 0.99f);
    scene_destroy(s);
}

static bool has_grain(const material *m)
{
    material_point point;
    material_point_of(m, &point);
    return material_point_has_grain(&point);
}

static void the_grain_runs_along_u(void **state)
{
    (void)state;
    scene *s =
        test_scene_create(&run, "Rotate 90 0 0 1 " PLANE "Rotate 30 1 2 3 Shape \"sphere\" \"float radius\" 0.1");
    surface_hit hit = hit_from_above(s, 1.3f, 0.7f);
    material brushed = material_make(MATERIAL_CONDUCTOR);
    brushed.alpha_u = 0.3f, brushed.alpha_v = 0.1f;
    frame f = shading_frame_at(s, &hit, &brushed, has_grain(&brushed));
    assert_direction(f.x, 0.0, 1.0, 0.0, 1e-6);
    assert_direction(f.y, -1.0, 0.0, 0.0, 1e-6);
    brushed.alpha_u = brushed.alpha_v; /* which needs none */
    frame plain = frame_from_z(hit.shading_normal);
    f = shading_frame_at(s, &hit, &brushed, has_grain(&brushed));
    assert_memory_equal(&f, &plain, sizeof f);
    brushed.kind = MATERIAL_COATED_CONDUCTOR;
    brushed.base_alpha_u = 0.2f;
    f = shading_frame_at(s, &hit, &brushed, has_grain(&brushed));
    assert_direction(f.x, 0.0, 1.0, 0.0, 1e-6);
    /* on a sphere it follows the circles of latitude */
    hit = hit_from_above(s, 0.03f, 0.02f);
    vec3 dpdu, dpdv;
    surface_tangents(s, &hit, &dpdu, &dpdv);
    f = shading_frame_at(s, &hit, &brushed, has_grain(&brushed));
    assert_close((double)vec3_dot(f.x, vec3_normalize(dpdu)), 1.0, 1e-5);
    assert_close((double)vec3_dot(f.z, hit.shading_normal), 1.0, 1e-6);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ramp_on_a_plane),          cmocka_unit_test(a_ramp_on_a_sphere),
        cmocka_unit_test(a_relief_in_space),          cmocka_unit_test(mixes_have_the_maps_of_what_they_pick),
        cmocka_unit_test(normal_maps_say_the_normal), cmocka_unit_test(normals_stay_usable),
        cmocka_unit_test(the_grain_runs_along_u),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
