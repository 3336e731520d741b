/* test_tangents.c: dp/du, dp/dv and how the normal turns: a small step along them changes u, v and the normal by as
 * much as they say, on all shapes, under any map, with uvs and without. Threads: the run's workers build, one asks. */
#include "shape/tangents.h"

#include "fixtures/shared_run.h"

enum { POINTS = 400 / FEWER };

/* A point of the only shape that a ray from afar meets. */
static bool random_hit(const scene *s, rng *random, surface_hit *out_hit)
{
    vec3 out = random_direction(random), into = random_in_box(random, (vec3){-1, -1, -1}, (vec3){1, 1, 1});
    vec3 from = vec3_add_scaled(into, out, 20.0f);
    return scene_intersect(s, scene_ray_make(from, vec3_negate(out)), INFINITY, out_hit);
}

/* The point beside, which a ray along the normal puts back onto the surface. */
static bool step(const scene *s, const surface_hit *hit, vec3 along, float h, surface_hit *out_hit)
{
    vec3 n = hit->geometric_normal, p = vec3_add_scaled(hit->position, along, h);
    return scene_intersect(s, scene_ray_make(vec3_add_scaled(p, n, 0.01f), vec3_negate(n)), 0.02f, out_hit);
}

static double change(float before, float after, float h) { return ((double)after - (double)before) / (double)h; }

static void check_along(const scene *s, const surface_hit *hit, vec3 dp, vec3 dn, double du, double dv, int *checked)
{
    const float h = 2e-3f;
    surface_hit ahead, back;
    if (!step(s, hit, dp, h, &ahead) || !step(s, hit, dp, -h, &back) || ahead.primitive_index != back.primitive_index)
        return;
    if (fabsf(ahead.uv.x - back.uv.x) > 0.5f)
        return; /* over the seam */
    assert_close(change(back.uv.x, ahead.uv.x, 2.0f * h), du, 0.02);
    assert_close(change(back.uv.y, ahead.uv.y, 2.0f * h), dv, 0.02);
    double tolerance = 0.02 + 0.03 * (double)vec3_length(dn);
    assert_close(change(back.shading_normal.x, ahead.shading_normal.x, 2.0f * h), (double)dn.x, tolerance);
    assert_close(change(back.shading_normal.y, ahead.shading_normal.y, 2.0f * h), (double)dn.y, tolerance);
    assert_close(change(back.shading_normal.z, ahead.shading_normal.z, 2.0f * h), (double)dn.z, tolerance);
    ++*checked;
}

static void check_shape(const char *world, uint64_t seed)
{
    scene *s = test_scene_create(&run, world);
    rng random = test_random(seed);
    int checked = 0;
    for (int i = 0; i < POINTS; i++) {
        surface_hit hit;
        if (!random_hit(s, &random, &hit))
            continue;
        surface_differentials d = surface_differentials_at(s, &hit);
        if (vec3_length(d.dpdu) < 0.1f)
            continue; /* near a pole */
        check_along(s, &hit, d.dpdu, d.dndu, 1.0, 0.0, &checked);
        check_along(s, &hit, d.dpdv, d.dndv, 0.0, 1.0, &checked);
        vec3 dpdu, dpdv;
        surface_tangents(s, &hit, &dpdu, &dpdv);
        assert_memory_equal(&dpdu, &d.dpdu, sizeof dpdu);
        assert_memory_equal(&dpdv, &d.dpdv, sizeof dpdv);
    }
    if (checked < POINTS / 8)
        fail_msg("only %d points checked of %s", checked, world);
    scene_destroy(s);
}

#define MAP "Translate 0.1 0.2 0 Rotate 30 1 2 3 Scale 1.2 0.8 1.1 Rotate 50 3 1 1 "

static void quadrics(void **state)
{
    (void)state;
    static const char *const WORLDS[] = {
        "Shape \"sphere\" \"float radius\" 1.5",
        "ReverseOrientation Shape \"sphere\" \"float radius\" 1.5",
        MAP "Shape \"sphere\" \"float radius\" 1.5",
        MAP "ReverseOrientation Shape \"sphere\" \"float zmin\" -0.5 \"float zmax\" 0.7 \"float phimax\" 200",
        "Scale -1 1 1 Shape \"sphere\"",
        MAP "Shape \"cylinder\" \"float radius\" 0.7 \"float zmin\" -0.5 \"float zmax\" 1 \"float phimax\" 300",
        "Shape \"cylinder\"",
        MAP "Shape \"disk\" \"float radius\" 1.5 \"float innerradius\" 0.4 \"float phimax\" 250",
    };
    for (size_t i = 0; i < sizeof WORLDS / sizeof *WORLDS; i++)
        check_shape(WORLDS[i], 100 + i);
}

#define TRIANGLES                                                                                                      \
    "Shape \"trianglemesh\" \"point3 P\" [ -1 -1 0 1 -1 0.2 1 1 0 -1 1 0.4 ] \"integer indices\" [ 0 1 2 0 2 3 ]\n"

static void meshes(void **state)
{
    (void)state;
    static const char *const WORLDS[] = {
        TRIANGLES,
        TRIANGLES "\"point2 uv\" [ 0 0 2 0.1 1.5 1 0.2 0.7 ]",
        TRIANGLES "\"point2 uv\" [ 1 0 0 0 0 1 1 1 ]", /* mirrored */
        TRIANGLES "\"normal N\" [ -0.3 -0.3 1 0.3 -0.3 1 0.3 0.3 1 -0.3 0.3 1 ]",
        MAP "ReverseOrientation " TRIANGLES
            "\"normal N\" [ -0.3 -0.3 1 0.3 -0.3 1 0.3 0.3 1 -0.3 0.3 1 ] \"point2 uv\" [ 0 0 2 0.1 1.5 1 0.2 0.7 ]",
        MAP "Shape \"bilinearmesh\" \"point3 P\" [ -1 -1 0 1 -1 0 -1 1 0.3 1 1 0.3 ]",
    };
    for (size_t i = 0; i < sizeof WORLDS / sizeof *WORLDS; i++)
        check_shape(WORLDS[i], 200 + i);
}

#define INSTANCE(before, shape, transform)                                                                             \
    before "ObjectBegin \"o\" " shape " ObjectEnd " transform "ObjectInstance \"o\""

static void instances(void **state)
{
    (void)state;
    static const char *const WORLDS[] = {
        INSTANCE("", "Shape \"sphere\" \"float radius\" 1.5", MAP),
        INSTANCE("ReverseOrientation ", MAP "Shape \"sphere\" \"float phimax\" 200", "Scale -1.3 1 1 "),
        INSTANCE("", "Shape \"cylinder\" \"float radius\" 0.7", MAP),
        INSTANCE("", "Shape \"disk\" \"float innerradius\" 0.4", "Scale 1.5 1.5 -1 " MAP),
        INSTANCE("", TRIANGLES "\"normal N\" [ -0.3 -0.3 1 0.3 -0.3 1 0.3 0.3 1 -0.3 0.3 1 ]", MAP),
        INSTANCE("", "Scale 1 1 -1 " TRIANGLES "\"point2 uv\" [ 0 0 2 0.1 1.5 1 0.2 0.7 ]", MAP "Scale -1 1 1 "),
        /* as it stands when the shutter opens */
        MAP "ActiveTransform EndTime Translate 3 0 0 Rotate 90 1 2 0 ActiveTransform All Shape \"sphere\"",
    };
    for (size_t i = 0; i < sizeof WORLDS / sizeof *WORLDS; i++)
        check_shape(WORLDS[i], 300 + i);
}

static surface_hit hit_from_above(const scene *s, float x, float y)
{
    surface_hit hit;
    assert_true(scene_intersect(s, scene_ray_make((vec3){x, y, 5.0f}, (vec3){0.0f, 0.0f, -1.0f}), INFINITY, &hit));
    return hit;
}

/* uv of patches and triangles without any, as pbrt has them */
static void uvs_where_there_are_none(void **state)
{
    (void)state;
    scene *s = test_scene_create(&run, "Shape \"bilinearmesh\" \"point3 P\" [ -1 -1 0 1 -1 0 -1 1 0 1 1 0 ]");
    surface_hit hit = hit_from_above(s, 0.2f, -0.4f);
    assert_close((double)hit.uv.x, 0.6, 1e-6);
    assert_close((double)hit.uv.y, 0.3, 1e-6);
    scene_destroy(s);
    s = test_scene_create(&run, "Shape \"trianglemesh\" \"point3 P\" [ -1 -1 0 1 -1 0 1 1 0 ]");
    hit = hit_from_above(s, 0.2f, -0.4f);
    assert_close((double)hit.uv.x, 0.6, 1e-6);
    assert_close((double)hit.uv.y, 0.3, 1e-6);
    scene_destroy(s);
}

static void tangents_of_the_file_and_of_uvs_that_say_nothing(void **state)
{
    (void)state;
    vec3 dpdu, dpdv;
    /* "S", turned by the transform; v is to the left of u */
    scene *s = test_scene_create(&run, "Rotate 90 0 0 1 " TRIANGLES "\"vector3 S\" [ 1 1 0 1 1 0 1 1 0 1 1 0 ]");
    surface_hit hit = hit_from_above(s, 0.3f, 0.1f);
    surface_tangents(s, &hit, &dpdu, &dpdv);
    assert_close((double)dpdu.x, -(double)dpdu.y, 1e-5);
    assert_true(dpdu.y > 0.0f);
    assert_close((double)vec3_dot(dpdu, dpdv), 0.0, 1e-5);
    assert_true(vec3_dot(vec3_cross(dpdu, dpdv), hit.geometric_normal) > 0.0f);
    /* the uvs' own derivatives stay what they are */
    assert_true(fabsf(surface_differentials_at(s, &hit).dpdu.x) < 1.0f);
    scene_destroy(s);
    s = test_scene_create(&run, "ObjectBegin \"o\" " TRIANGLES "\"vector3 S\" [ 1 1 0 1 1 0 1 1 0 1 1 0 ] ObjectEnd "
                                "Rotate 90 0 0 1 ObjectInstance \"o\"");
    hit = hit_from_above(s, 0.3f, 0.1f);
    surface_tangents(s, &hit, &dpdu, &dpdv);
    assert_close((double)dpdu.x, -(double)dpdu.y, 1e-5);
    assert_true(dpdu.y > 0.0f);
    scene_destroy(s);
    s = test_scene_create(&run, TRIANGLES "\"point2 uv\" [ 0.5 0.5 0.5 0.5 0.5 0.5 0.5 0.5 ]");
    hit = hit_from_above(s, 0.3f, 0.1f);
    surface_tangents(s, &hit, &dpdu, &dpdv);
    assert_close((double)vec3_length(dpdu), 1.0, 1e-5);
    assert_close((double)vec3_length(dpdv), 1.0, 1e-5);
    assert_close((double)vec3_dot(dpdu, hit.geometric_normal), 0.0, 1e-5);
    assert_close((double)vec3_dot(dpdv, hit.geometric_normal), 0.0, 1e-5);
    scene_destroy(s);
    /* a sphere's pole */
    s = test_scene_create(&run, "Shape \"sphere\"");
    hit = hit_from_above(s, 0.0f, 0.0f);
    surface_tangents(s, &hit, &dpdu, &dpdv);
    assert_true(vec3_is_finite(dpdu) && vec3_is_finite(dpdv) && vec3_length(dpdu) > 0.0f);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quadrics),
        cmocka_unit_test(meshes),
        cmocka_unit_test(instances),
        cmocka_unit_test(uvs_where_there_are_none),
        cmocka_unit_test(tangents_of_the_file_and_of_uvs_that_say_nothing),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
