/* test_ray_cone.c: the widths of cones against those of neighbouring rays that are traced: from cameras, by way of
 * mirrors and through glass, flat and round; and the footprint on a slanted plane against its closed form.
 * Threads: one. */
#include "fixtures/test_scene.h"

#include "camera.h"
#include "material/surface_footprint.h"
#include "rays/ray_cone.h"
#include "scene.h"

/* A pixel of a wall at distance 5 that is seen straight on, and of one that is seen from afar by parallel rays. */
static void cameras(void **state)
{
    (void)state;
    camera c = {.kind = CAMERA_PERSPECTIVE, .world_from_camera = transform_identity(), .fov_degrees = 60.0f};
    c.tan_half_fov = (float)tan(PI / 6.0);
    const vec2 lens = {0.5f, 0.5f};
    scene_ray ray = camera_generate_ray(&c, 0.5f, 0.5f, 2.0f, lens, 0.0f);
    ray_cone cone = camera_ray_cone(&c, &ray, 0.5f, 0.5f, 1.0f / 200.0f, 1.0f / 100.0f, 2.0f, lens);
    assert_relative((double)ray_cone_at(&cone, 5.0f).width, 5.0 * 2.0 * tan(PI / 6.0) / 100.0, 1e-3);
    c.kind = CAMERA_ORTHOGRAPHIC;
    ray = camera_generate_ray(&c, 0.3f, 0.6f, 2.0f, lens, 0.0f);
    cone = camera_ray_cone(&c, &ray, 0.3f, 0.6f, 1.0f / 200.0f, 1.0f / 100.0f, 2.0f, lens);
    assert_relative((double)ray_cone_at(&cone, 5.0f).width, 0.02, 1e-4);
    assert_true(cone.spread == 0.0f && !cone.is_coarse);
}

static vec3 mirrored(vec3 d, vec3 n) { return vec3_add_scaled(d, n, -2.0f * vec3_dot(d, n)); }

static vec3 refracted(vec3 d, vec3 n, float ratio)
{
    n = vec3_face_forward(n, d);
    vec3 across = vec3_scale(vec3_add_scaled(d, n, -vec3_dot(d, n)), ratio);
    return vec3_add_scaled(across, n, sqrtf(1.0f - vec3_length_squared(across)));
}

/* Two rays near the axis of a round or flat surface, `apart` at their origins and opening by `spread`: how far they are
 * apart `behind` the surface, and what the cone says of that. */
static void compare_bent(const char *world, float z_from, float z_direction, float index, float behind)
{
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, world);
    const float apart = 1e-3f, spread = 2e-3f;
    vec3 ends[2];
    ray_cone cone = {apart, spread, false};
    for (int k = 0; k < 2; k++) {
        vec3 from = {(float)k * apart, 0.0f, z_from};
        vec3 direction = vec3_normalize((vec3){(float)k * spread, 0.0f, z_direction});
        surface_hit hit;
        assert_true(scene_intersect(s, scene_ray_make(from, direction), INFINITY, &hit));
        bool is_inside = vec3_dot(hit.shading_normal, direction) > 0.0f;
        vec3 bent = index > 0.0f ? refracted(direction, hit.shading_normal, is_inside ? index : 1.0f / index)
                                 : mirrored(direction, hit.shading_normal);
        ends[k] = vec3_add_scaled(hit.position, bent, behind);
        if (k == 0) {
            cone = ray_cone_at(&cone, hit.distance);
            cone = ray_cone_bent(s, &cone, &hit, direction, bent, index > 0.0f ? index : 1.5f);
        }
    }
    assert_relative((double)ray_cone_at(&cone, behind).width, (double)(ends[1].x - ends[0].x), 0.02);
    scene_destroy(s);
    test_run_reset(&r);
}

/* Turned, so that no pole is on the axis. */
#define BALL " Rotate 90 1 0 0 Shape \"sphere\" \"float radius\" 1"
#define WALL " Shape \"disk\" \"float radius\" 3"

static void mirrors(void **state)
{
    (void)state;
    compare_bent(WALL, 3.0f, -1.0f, 0.0f, 2.0f);
    compare_bent(BALL, 3.0f, -1.0f, 0.0f, 2.0f); /* convex: spreads */
    compare_bent(BALL, -0.5f, 1.0f, 0.0f, 0.3f); /* concave, before the focus */
    compare_bent(BALL, -0.5f, 1.0f, 0.0f, 2.0f); /* behind the focus, where the rays have crossed */
    compare_bent("Scale 1 1 2" BALL, 5.0f, -1.0f, 0.0f, 1.0f);
}

static void glass(void **state)
{
    (void)state;
    compare_bent(WALL, 3.0f, -1.0f, 1.5f, 2.0f);
    compare_bent(BALL, 3.0f, -1.0f, 1.5f, 1.5f); /* into a ball */
    compare_bent(BALL, -0.5f, 1.0f, 1.5f, 1.0f); /* out of a ball */
}

/* A mesh with smooth normals, a patch of 2 degrees of the unit sphere, has the sphere's curvature within what its
 * corners leave. */
static void smooth_mesh(void **state)
{
    (void)state;
    char world[1024];
    const double a = 0.02, z = sqrt(1.0 - a * a);
    snprintf(
        world, sizeof world,
        "Shape \"trianglemesh\" \"point3 P\" [%g 0 %g  %g %g %g  %g %g %g] \"normal N\" [%g 0 %g  %g %g %g  %g %g %g] "
        "\"integer indices\" [0 1 2]",
        a, z, -0.5 * a, 0.866 * a, z, -0.5 * a, -0.866 * a, z, a, z, -0.5 * a, 0.866 * a, z, -0.5 * a, -0.866 * a, z);
    compare_bent(world, 3.0f, -1.0f, 0.0f, 2.0f);
}

/* Scattering spreads a cone by its density, up to that of diffuse points, and never narrows it. */
static void scattering(void **state)
{
    (void)state;
    const ray_cone cone = {-0.1f, -0.01f, false};
    ray_cone wide = ray_cone_scattered(&cone, (float)(1.0 / PI)), sharp = ray_cone_scattered(&cone, 1e6f);
    assert_relative((double)wide.spread, (double)RAY_CONE_DIFFUSE_SPREAD, 1e-3);
    assert_true(wide.width == 0.1f && sharp.spread == 0.01f);
    assert_true(ray_cone_scattered(&cone, 1e-9f).spread == RAY_CONE_DIFFUSE_SPREAD);
}

/* A plane whose u and v are twice and half its coordinates, met at 60 degrees from its normal. */
static void footprints(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(
        &r, "Shape \"trianglemesh\" \"point3 P\" [-9 -9 0  9 -9 0  -9 9 0] \"point2 uv\" [-18 -4.5  18 -4.5  -18 4.5] "
            "\"integer indices\" [0 1 2]");
    vec3 direction = {sinf((float)PI / 3.0f), 0.0f, -0.5f};
    surface_hit hit;
    surface_footprint f;
    assert_true(scene_intersect(s, scene_ray_make((vec3){-5.0f, -1.0f, 1.0f}, direction), INFINITY, &hit));
    assert_false(surface_footprint_at(s, &hit, &f));
    hit.footprint = (ray_footprint){0.01f, false, direction};
    assert_true(surface_footprint_at(s, &hit, &f));
    assert_relative((double)fabsf(f.axes[0].y), 0.01, 1e-5);
    assert_relative((double)fabsf(f.axes[1].x), 0.02, 1e-5);
    assert_relative((double)fabsf(f.uv_axes[0].y), 0.005, 1e-5);
    assert_relative((double)fabsf(f.uv_axes[1].x), 0.04, 1e-5);
    assert_true(fabsf(f.uv_axes[0].x) < 1e-6f && fabsf(f.uv_axes[1].y) < 1e-6f);
    scene_destroy(s);
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cameras),     cmocka_unit_test(mirrors),    cmocka_unit_test(glass),
        cmocka_unit_test(smooth_mesh), cmocka_unit_test(scattering), cmocka_unit_test(footprints),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
