/* test_alpha.c: which rays a surface stops that is not wholly there: by a share, by a picture, by a cutoff; meshes and
 * quadrics; and lamps that are invisible. Counts are held against their binomial distribution.
 * Threads: the run's workers build, one casts. */
#include "light/light.h"
#include "rays/transmittance.h"
#include "shape/alpha.h"

#include "fixtures/shared_run.h"

enum { RAYS = 40000 / FEWER };

#define SQUARE                                                                                                         \
    "Shape \"trianglemesh\" \"point3 P\" [ -1 -1 0 1 -1 0 1 1 0 -1 1 0 ] \"integer indices\" [ 0 1 2 0 2 3 ]\n"
#define WITH_UV "\"point2 uv\" [ 0 0 1 0 1 1 0 1 ]\n"

/* Downwards from a point above a point of the square |x|, |y| < 1. */
static scene_ray ray_down(rng *random, float spread)
{
    vec3 on = random_in_box(random, (vec3){-1.0f, -1.0f, 0.0f}, (vec3){1.0f, 1.0f, 0.0f});
    vec3 from = {on.x + spread * (rng_float(random) - 0.5f), on.y, 3.0f};
    return scene_ray_make(from, vec3_normalize(vec3_sub(on, from)));
}

/* The share of rays that anything stops; shadow rays, and the same rays again, fare alike. */
static double share_stopped(const char *world, float spread, uint64_t seed)
{
    scene *s = test_scene_create(&run, world);
    rng random = test_random(seed);
    int stopped = 0;
    for (int i = 0; i < RAYS; i++) {
        scene_ray ray = ray_down(&random, spread);
        surface_hit hit, again;
        bool is_stopped = scene_intersect(s, ray, INFINITY, &hit);
        assert_int_equal(scene_intersect(s, ray, INFINITY, &again), is_stopped);
        assert_int_equal(scene_occluded(s, ray, INFINITY), is_stopped);
        if (is_stopped)
            assert_memory_equal(&hit.position, &again.position, sizeof hit.position);
        stopped += is_stopped;
    }
    scene_destroy(s);
    return (double)stopped / RAYS;
}

static void assert_share(double share, double expected)
{
    assert_close(share, expected, 4.5 * sqrt(expected * (1.0 - expected) / RAYS) + 1e-9);
}

static void a_share_of_the_rays_is_stopped(void **state)
{
    (void)state;
    assert_share(share_stopped(SQUARE "\"float alpha\" 0.3", 1.0f, 1), 0.3);
    assert_share(share_stopped(SQUARE "\"float alpha\" 0.93", 0.0f, 2), 0.93);
    /* one after the other, each anew */
    assert_share(
        share_stopped(SQUARE "\"float alpha\" 0.3 Translate 0 0 -1 Scale 2 2 1 " SQUARE "\"float alpha\" 0.5", 1.0f, 3),
        1.0 - 0.7 * 0.5);
    /* quadrics: a disk's one crossing, two of all others; a whole sphere, a partial one, one that is none any more */
    assert_share(share_stopped("Shape \"disk\" \"float radius\" 2 \"float alpha\" 0.3", 1.0f, 4), 0.3);
    assert_share(share_stopped("Shape \"sphere\" \"float radius\" 2 \"float alpha\" 0.3", 1.0f, 5), 0.51);
    assert_share(share_stopped("Shape \"sphere\" \"float radius\" 2 \"float zmax\" 1 \"float alpha\" 0.3", 0.0f, 6),
                 0.3);
    assert_share(share_stopped("Scale 1 1.3 1 Shape \"sphere\" \"float radius\" 2 \"float alpha\" 0.6", 1.0f, 7), 0.84);
    assert_share(
        share_stopped("Rotate 90 1 0 0 Shape \"cylinder\" \"float radius\" 2 \"float zmin\" -2 \"float zmax\" 2 "
                      "\"float alpha\" 0.3",
                      0.0f, 8),
        0.51);
    /* instances: two of one object, one of them mirrored and stretched, stop rays each by themselves */
    assert_share(share_stopped("ObjectBegin \"o\" " SQUARE
                               "\"float alpha\" 0.3 ObjectEnd ObjectInstance \"o\" Translate 0 "
                               "0 -1 Scale -3 2 2 ObjectInstance \"o\"",
                               1.0f, 10),
                 0.51);
    assert_share(
        share_stopped("ObjectBegin \"o\" Shape \"sphere\" \"float radius\" 1 \"float alpha\" 0.3 ObjectEnd Scale 2 2 "
                      "-2 ObjectInstance \"o\"",
                      1.0f, 11),
        0.51);
    /* all and nothing */
    assert_true(share_stopped(SQUARE "\"float alpha\" 1", 1.0f, 9) == 1.0);
    assert_true(share_stopped(SQUARE "\"float alpha\" 7", 1.0f, 9) == 1.0);
    assert_true(share_stopped(SQUARE "\"float alpha\" 0", 1.0f, 9) == 0.0);
    assert_true(share_stopped("Shape \"sphere\" \"float radius\" 2 \"float alpha\" -1", 1.0f, 9) == 0.0);
}

/* Rays that look for surfaces find alpha surfaces always, and holes never. */
static void probes_find_alpha_surfaces(void **state)
{
    (void)state;
    scene *s =
        test_scene_create(&run, SQUARE "\"float alpha\" 0.01 Translate 0 0 5 Shape \"sphere\" \"float alpha\" 0");
    for (int i = 0; i < 100; i++) {
        rng random = test_random((uint64_t)(40 + i));
        scene_ray ray = ray_down(&random, 0.0f);
        surface_hit hit;
        ray.origin.z = 9.0f;
        assert_true(scene_find_surface(s, ray, INFINITY, &hit) && hit.shape_index == 0);
        assert_true(scene_is_blocked(s, ray, INFINITY));
    }
    scene_destroy(s);
}

/* The nearest of a ray's hits is the one that counts, also of a shape behind one that lets it through. */
static void what_is_behind_is_met(void **state)
{
    (void)state;
    scene *s = test_scene_create(&run, SQUARE "\"float alpha\" 0.5 Translate 0 0 -2 Scale 3 3 1 " SQUARE);
    rng random = test_random(20);
    int behind = 0;
    for (int i = 0; i < RAYS; i++) {
        surface_hit hit;
        assert_true(scene_intersect(s, ray_down(&random, 0.5f), INFINITY, &hit));
        assert_close((double)hit.position.z, hit.shape_index == 0 ? 0.0 : -2.0, 1e-6);
        behind += hit.shape_index == 1;
    }
    assert_share((double)behind / RAYS, 0.5);
    scene_destroy(s);
}

#define HOLES                                                                                                          \
    "Texture \"holes\" \"float\" \"checkerboard\" \"float uscale\" 4 \"float vscale\" 4 "                              \
    "\"float tex1\" 1 \"float tex2\" 0\n"

static bool is_in_hole(float u, float v) { return ((int)floorf(4.0f * u) + (int)floorf(4.0f * v)) % 2 != 0; }

static void holes_are_where_the_texture_has_them(void **state)
{
    (void)state;
    static const char *const WORLDS[] = {
        HOLES SQUARE WITH_UV "\"texture alpha\" \"holes\"",
        HOLES SQUARE "\"texture alpha\" \"holes\"",
        HOLES "Shape \"disk\" \"float radius\" 1.5 \"texture alpha\" \"holes\"",
    };
    for (int w = 0; w < 3; w++) {
        scene *s = test_scene_create(&run, WORLDS[w]);
        rng random = test_random((uint64_t)(30 + w));
        int stopped = 0;
        for (int i = 0; i < RAYS / 4; i++) {
            scene_ray ray = ray_down(&random, 0.0f);
            float x = ray.origin.x, y = ray.origin.y, u = 0.5f * (x + 1.0f), v = 0.5f * (y + 1.0f);
            if (w == 1) { /* (0, 0), (1, 0), (1, 1) on both triangles: b1 + b2, b2 */
                float b2 = x > y ? v : v - u, b1 = x > y ? u - v : u;
                u = b1 + b2, v = b2;
            } else if (w == 2) {
                u = (float)(atan2((double)y, (double)x) / (2.0 * PI));
                u = u < 0.0f ? u + 1.0f : u;
                v = 1.0f - sqrtf(x * x + y * y) / 1.5f;
            }
            float cell_u = 4.0f * u - floorf(4.0f * u), cell_v = 4.0f * v - floorf(4.0f * v);
            if (fminf(fminf(cell_u, 1.0f - cell_u), fminf(cell_v, 1.0f - cell_v)) < 1e-3f)
                continue;
            surface_hit hit;
            bool is_stopped = scene_intersect(s, ray, INFINITY, &hit);
            assert_int_equal(is_stopped, !is_in_hole(u, v));
            assert_int_equal(scene_occluded(s, ray, INFINITY), is_stopped);
            stopped += is_stopped;
        }
        assert_true(stopped > RAYS / 16 && stopped < 3 * RAYS / 16);
        scene_destroy(s);
    }
}

/* Alpha rises from 0 to 1 along u, is multiplied by a factor, and cut off. */
static void cutoffs_make_masks(void **state)
{
    (void)state;
    scene *s = test_scene_create(
        &run,
        "Texture \"ramp\" \"float\" \"bilerp\" \"float v00\" 0 \"float v01\" 0 \"float v10\" 1 \"float v11\" 1\n" SQUARE
            WITH_UV "\"texture alpha\" \"ramp\"");
    shape *square = &s->shapes[0];
    surface_hit hit = {.uv = {0.7f, 0.5f}};
    assert_close((double)alpha_at(s, square, &hit), 0.7, 1e-6);
    square->alpha = 0.5f;
    assert_close((double)alpha_at(s, square, &hit), 0.35, 1e-6);
    square->alpha_cutoff = 0.4f;
    assert_true(alpha_at(s, square, &hit) == 0.0f);
    hit.uv.x = 0.81f;
    assert_true(alpha_at(s, square, &hit) == 1.0f);
    assert_false(shape_is_opaque(square));
    assert_false(shape_is_invisible(square));
    square->alpha_texture = SCENE_NO_TEXTURE;
    assert_true(shape_is_opaque(square)); /* 0.5 is above the cutoff */
    square->alpha = 0.3f;
    assert_true(shape_is_invisible(square));
    scene_destroy(s);
}

static void invisible_lamps_shine(void **state)
{
    (void)state;
    scene *s = test_scene_create(&run, "AreaLightSource \"diffuse\" \"rgb L\" [ 2 2 2 ]\n"
                                       "Shape \"disk\" \"float radius\" 0.5 \"float alpha\" 0\n"
                                       "Translate 0 0 5 Shape \"disk\" \"float radius\" 0.5");
    const vec3 below = {0.1f, 0.2f, 1.0f};
    light_sample sample;
    assert_true(light_sample_from_point(s, &s->lights[0], below, (vec2){0.3f, 0.6f}, &sample));
    assert_true(sample.is_delta); /* no scattered ray meets it, so nothing is shared with any */
    assert_true(sample.pdf_solid_angle > 0.0f && sample.radiance.g == 2.0f);
    surface_hit hit;
    assert_false(scene_intersect(s, scene_ray_make((vec3){0.1f, 0.2f, -1.0f}, (vec3){0.0f, 0.0f, 1.0f}), 3.0f, &hit));
    assert_relative((double)s->lights[0].power.r, 2.0 * PI * PI * 0.25, 1e-5);
    assert_true(light_sample_from_point(s, &s->lights[1], (vec3){0.0f, 0.0f, 6.0f}, (vec2){0.3f, 0.6f}, &sample));
    assert_false(sample.is_delta);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_share_of_the_rays_is_stopped),
        cmocka_unit_test(probes_find_alpha_surfaces),
        cmocka_unit_test(what_is_behind_is_met),
        cmocka_unit_test(holes_are_where_the_texture_has_them),
        cmocka_unit_test(cutoffs_make_masks),
        cmocka_unit_test(invisible_lamps_shine),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
