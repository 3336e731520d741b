/* test_instance.c: hits on instances, at rest and moving, against the same shapes moved by hand; starts that do not
 * meet their own surface, far away and under any affine map. Threads: the build's. */
/* ctest: serial */
#include "fixtures/test_scene.h"

#include "material/bsdf.h"
#include "math/motion.h"

#define TETRAHEDRON                                                                                                    \
    "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 0 0 1] \"integer indices\" [0 2 1 0 1 3 0 3 2 1 2 3] "
#define SMOOTH                                                                                                         \
    "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 1 1 .3 0 1 0] \"integer indices\" [0 1 2 0 2 3] "                \
    "\"normal N\" [0 .2 1 .3 0 1 0 -.3 1 0 0 1] \"point2 uv\" [0 0 2 0 2 3 0 3] "
#define BALL      "Shape \"sphere\" \"float radius\" .8 "
#define ELLIPSOID "Scale 1 .5 2 Shape \"sphere\" "
#define PIPE      "Shape \"cylinder\" \"float radius\" .5 \"float phimax\" 200 "
#define RING      "Shape \"disk\" \"float innerradius\" .4 "

static const char *const SHAPES[] = {TETRAHEDRON, SMOOTH, BALL, ELLIPSOID, PIPE, RING};
enum { SHAPE_KINDS = sizeof SHAPES / sizeof *SHAPES, CLOSED_KINDS_A = 0, CLOSED_KINDS_B = 2, CLOSED_KINDS_C = 3 };

/* A turn, a stretch of up to four to one, mirrored every other time, and a way from the origin. */
static void random_map(rng *random, double scale, double away, char *text, size_t size)
{
    frame f = frame_from_z(random_direction(random));
    const vec3 rows[3] = {f.x, f.y, f.z};
    double stretch[3], m[3][3];
    for (int j = 0; j < 3; j++)
        stretch[j] = scale * (0.5 + 1.5 * (double)rng_float(random));
    stretch[0] *= rng_float(random) < 0.5f ? -1.0 : 1.0;
    for (int j = 0; j < 3; j++)
        m[j][0] = (double)rows[j].x * stretch[0], m[j][1] = (double)rows[j].y * stretch[1],
        m[j][2] = (double)rows[j].z * stretch[2];
    vec3 way = random_direction(random);
    snprintf(text, size, "Transform [%.9g %.9g %.9g 0 %.9g %.9g %.9g 0 %.9g %.9g %.9g 0 %.9g %.9g %.9g 1] ", m[0][0],
             m[1][0], m[2][0], m[0][1], m[1][1], m[2][1], m[0][2], m[1][2], m[2][2], (double)way.x * away,
             (double)way.y * away, (double)way.z * away);
}

static scene_ray random_ray(rng *random, const scene *s)
{
    vec3 from = vec3_add_scaled(s->bounding_center, random_direction(random), 3.0f * s->bounding_radius);
    vec3 to = vec3_add_scaled(s->bounding_center, random_direction(random), s->bounding_radius * rng_float(random));
    return scene_ray_make(from, vec3_normalize(vec3_sub(to, from)));
}

/* Holds a hit in one scene against the hit of the same ray in another; tolerance in lengths of the scene. Where the ray
 * grazes, roundings go far along the surface, and nothing is asked. */
static void expect_same_hit(const scene_ray *ray, const surface_hit *a, const surface_hit *b, float tolerance)
{
    if (fabsf(vec3_dot(ray->direction, a->geometric_normal)) < 0.1f)
        return;
    assert_int_equal(a->shape_index, b->shape_index);
    assert_int_equal(a->primitive_index, b->primitive_index);
    assert_int_equal(a->is_flat, b->is_flat);
    expect_near_point(a->position, b->position, tolerance);
    expect_near_point(a->geometric_normal, b->geometric_normal, 2e-3f);
    expect_near_point(a->shading_normal, b->shading_normal, a->is_flat ? 0.1f : 2e-3f); /* mixed before or after */
    assert_close(a->distance, b->distance, tolerance);
    assert_close(a->uv.y, b->uv.y, 4e-3);
    if (fabsf(a->uv.x - b->uv.x) < 0.5f) /* else on either side of the seam */
        assert_close(a->uv.x, b->uv.x, 4e-3);
}

static void instances_are_their_shapes_moved(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    rng random = test_random(1);
    for (int trial = 0; trial < 8; trial++)
        for (int kind = 0; kind < SHAPE_KINDS; kind++) {
            char map[512], before[128], text[2048];
            random_map(&random, 1.0, 5.0, map, sizeof map);
            snprintf(before, sizeof before, "%s Translate .2 .1 0 %s ", trial % 2 ? "ReverseOrientation" : "",
                     trial % 4 < 2 ? "Scale 1 -1 1" : "");
            snprintf(text, sizeof text, "%s %s %s", map, before, SHAPES[kind]);
            scene *moved = test_scene_create(&r, text);
            snprintf(text, sizeof text, "ObjectBegin \"a\" %s %s ObjectEnd %s ObjectInstance \"a\"", before,
                     SHAPES[kind], map);
            scene *instanced = test_scene_create(&r, text);
            uint32_t met = 0, different = 0;
            for (uint32_t i = 0; i < 2000 / FEWER; i++) {
                scene_ray ray = random_ray(&random, moved);
                surface_hit a, b;
                bool is_a = scene_intersect(moved, ray, INFINITY, &a),
                     is_b = scene_intersect(instanced, ray, INFINITY, &b);
                assert_int_equal(is_b, scene_occluded(instanced, ray, INFINITY));
                /* an edge may be on either side by a rounding, and what is behind it may be seen instead */
                if (is_a != is_b || (is_a && fabsf(a.distance - b.distance) > 0.01f * moved->bounding_radius)) {
                    different++;
                    continue;
                }
                if (!is_a)
                    continue;
                met++;
                assert_int_equal(a.instance_index, SCENE_NO_INSTANCE);
                assert_int_equal(b.instance_index, 0);
                if (a.primitive_index == b.primitive_index)
                    expect_same_hit(&ray, &b, &a, 1e-3f * moved->bounding_radius);
                assert_true(b.epsilon > 0.0f && b.epsilon < 4e-4f);
            }
            assert_true(met > 100 / FEWER);
            assert_true(different <= 2);
            scene_destroy(moved);
            scene_destroy(instanced);
        }
    test_run_reset(&r);
}

/* Fails unless both scenes show the fibre at one point, with the offset across it on the same side. */
static void expect_same_hair(const scene *a, const scene *b, const scene_ray *ray, rng *random, uint32_t *met)
{
    surface_hit of_a, of_b;
    if (!scene_intersect(a, *ray, INFINITY, &of_a) || !scene_intersect(b, *ray, INFINITY, &of_b) ||
        of_a.primitive_index != of_b.primitive_index || fabsf(of_a.distance - of_b.distance) > 1e-3f)
        return;
    vec3 out = vec3_negate(ray->direction);
    bsdf in_a, in_b;
    bsdf_init(a, &of_a, out, &in_a);
    bsdf_init(b, &of_b, out, &in_b);
    for (int i = 0; i < 8; i++) {
        vec3 from = random_direction(random);
        rgb f = bsdf_evaluate(&in_a, BSDF_ALL, BSDF_RADIANCE, from);
        rgb g = bsdf_evaluate(&in_b, BSDF_ALL, BSDF_RADIANCE, from);
        assert_close(g.g, f.g, 0.02f * f.g + 0.002f);
    }
    ++*met;
}

static void hair_scatters_alike_in_a_mirror(void **state)
{
    (void)state;
    static const char *const TYPES[] = {"flat", "cylinder", "ribbon"};
    test_run r;
    test_run_init(&r, 1);
    rng random = test_random(2);
    for (int k = 0; k < 3; k++)
        for (int mirrored = 0; mirrored < 2; mirrored++) {
            char hair[512], text[1024];
            const char *map = mirrored ? "Rotate 40 1 2 3 Scale -1 1 1" : "Rotate 40 1 2 3";
            snprintf(hair, sizeof hair,
                     "Material \"hair\" \"rgb sigma_a\" [.1 .2 .4] Shape \"curve\" \"string type\" \"%s\" "
                     "\"float width\" .6 \"point3 P\" [-1 0 0 -.3 .3 0 .3 .3 .2 1 0 .2] %s ",
                     TYPES[k], k == 2 ? "\"normal N\" [0 0 1 0 .3 1]" : "");
            snprintf(text, sizeof text, "%s %s", map, hair);
            scene *by_hand = test_scene_create(&r, text);
            snprintf(text, sizeof text, "ObjectBegin \"a\" %s ObjectEnd %s ObjectInstance \"a\"", hair, map);
            scene *instanced = test_scene_create(&r, text);
            uint32_t met = 0;
            for (uint32_t i = 0; i < 2000 / FEWER; i++) {
                scene_ray ray = random_ray(&random, by_hand);
                expect_same_hair(by_hand, instanced, &ray, &random, &met);
            }
            assert_true(met > 100 / FEWER);
            scene_destroy(by_hand);
            scene_destroy(instanced);
        }
    test_run_reset(&r);
}

/* A ray that leaves the outside of a convex shape meets nothing; one that goes into a closed shape meets it again. */
static void expect_clean_starts(const scene *s, rng *random, const scene_ray *ray, bool is_closed)
{
    surface_hit hit, next;
    if (!scene_intersect(s, *ray, INFINITY, &hit))
        return;
    vec3 on_ray = vec3_add_scaled(ray->origin, ray->direction, hit.distance);
    expect_near_point(hit.position, on_ray, 1e-3f * s->bounding_radius + 8.0f * hit.epsilon);
    vec3 n = vec3_face_forward(hit.geometric_normal, vec3_negate(ray->direction)), away = random_direction(random);
    float cosine = vec3_dot(away, n), wanted = rng_float(random) < 0.5f ? 2e-3f : fabsf(cosine);
    away = vec3_normalize(vec3_add_scaled(away, n, wanted - cosine)); /* half of them graze */
    if (vec3_dot(away, n) < 1e-3f)
        return;
    scene_ray out = surface_ray(&hit, *ray, away);
    assert_true(out.time == ray->time);
    if (scene_intersect(s, out, INFINITY, &next))
        fail_msg("met itself at %g, epsilon %g", (double)next.distance, (double)hit.epsilon);
    assert_false(scene_occluded(s, out, INFINITY));
    /* the way in, steeply enough that what is behind lies farther than epsilon */
    if (!is_closed || hit.epsilon > 1e-4f * s->bounding_radius)
        return;
    vec3 through = vec3_normalize(vec3_sub(s->bounding_center, hit.position));
    if (vec3_dot(through, n) < -0.1f)
        assert_true(scene_intersect(s, surface_ray(&hit, *ray, through), INFINITY, &next));
}

static void starts_do_not_meet_their_own_surface(void **state)
{
    (void)state;
    static const int KINDS[] = {CLOSED_KINDS_A, CLOSED_KINDS_B, CLOSED_KINDS_C};
    /* how far the instance is from the world's origin, and the shape from its object's, in sizes of the shape */
    static const double AWAY[][2] = {{0, 0}, {10, 0}, {300, 0}, {0, 100}, {30, 30}}, SCALES[] = {1.0, 1e-3, 500.0};
    test_run r;
    test_run_init(&r, 1);
    rng random = test_random(2);
    for (size_t k = 0; k < 3; k++)
        for (size_t a = 0; a < sizeof AWAY / sizeof *AWAY; a++)
            for (size_t scale = 0; scale < 3; scale++) {
                char map[512], text[2048];
                random_map(&random, SCALES[scale], SCALES[scale] * AWAY[a][0], map, sizeof map);
                snprintf(text, sizeof text, "ObjectBegin \"a\" Translate %g %g %g %s ObjectEnd %s ObjectInstance \"a\"",
                         AWAY[a][1], 0.3 * AWAY[a][1], -0.7 * AWAY[a][1], SHAPES[KINDS[k]], map);
                scene *s = test_scene_create(&r, text);
                bool is_closed = true;
                for (uint32_t i = 0; i < 2000 / FEWER; i++) {
                    scene_ray ray = random_ray(&random, s);
                    expect_clean_starts(s, &random, &ray, is_closed);
                }
                scene_destroy(s);
            }
    test_run_reset(&r);
}

/* --- motion --- */

static const char *const MOVES[] = {"ActiveTransform EndTime Translate 3 1 0 ActiveTransform All ",
                                    "Translate 1 2 3 ActiveTransform EndTime Rotate 150 1 2 -1 ActiveTransform All ",
                                    "ActiveTransform EndTime Translate 1 0 0 Rotate 60 0 1 0 Scale 2 1 .5 "
                                    "ActiveTransform StartTime Scale -.5 1 1 ActiveTransform EndTime Scale -1 1 1 "
                                    "ActiveTransform All "};
enum { MOVE_COUNT = sizeof MOVES / sizeof *MOVES };

/* A ray at a time meets what stands there at that time: where the ray's point is, to start from again; and where a
 * scene at rest has it whose instance is put there by the motion itself. */
static void moving_shapes_are_met_where_they_are(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    rng random = test_random(3);
    for (int kind = 0; kind < SHAPE_KINDS; kind++)
        for (int move = 0; move < MOVE_COUNT; move++) {
            char text[2048];
            snprintf(text, sizeof text, "%s %s", MOVES[move], SHAPES[kind]);
            scene *s = test_scene_create(&r, text);
            assert_true(s->has_motion);
            assert_int_equal(s->instance_count, 1);
            bool is_closed = kind == CLOSED_KINDS_A || kind == CLOSED_KINDS_B || kind == CLOSED_KINDS_C;
            uint32_t met = 0, different = 0;
            for (int t = 0; t <= 10; t++) {
                /* a scene at rest, as it is at that time */
                scene *still = scene_create();
                affine now = instance_at(s, 0, (float)t / 10.0f);
                uint32_t index;
                /* (a transform before the shape belongs to the instance) */
                int length = snprintf(text, sizeof text, "WorldBegin ObjectBegin \"a\" %s ObjectEnd",
                                      strstr(SHAPES[kind], "Shape"));
                assert_int_equal(pbrt_parse_text(&r.run, "t", text, (size_t)length, still), AG_OK);
                assert_int_equal(scene_add_instance(still, 0, &now, 1, &index), AG_OK);
                assert_int_equal(scene_commit(still, &r.run, NULL), AG_OK);
                assert_false(still->has_motion);
                for (uint32_t i = 0; i < 400 / FEWER; i++) {
                    scene_ray ray = random_ray(&random, still);
                    ray.time = (float)t / 10.0f;
                    surface_hit a, b;
                    bool is_a = scene_intersect(s, ray, INFINITY, &a), is_b = scene_intersect(still, ray, INFINITY, &b);
                    assert_int_equal(is_a, scene_occluded(s, ray, INFINITY));
                    if (is_a && is_b && a.primitive_index == b.primitive_index &&
                        fabsf(a.distance - b.distance) < 0.01f * s->bounding_radius) {
                        met++;
                        assert_true(a.time == ray.time);
                        expect_same_hit(&ray, &a, &b, 1e-4f * s->bounding_radius);
                    } else {
                        different += is_a != is_b; /* an edge */
                    }
                    if (is_closed)
                        expect_clean_starts(s, &random, &ray, false);
                }
                scene_destroy(still);
            }
            assert_true(met > 400 / FEWER);
            assert_true(different <= 4);
            scene_destroy(s);
        }
    test_run_reset(&r);
}

static void a_surface_is_found_where_it_was_at_first(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    rng random = test_random(4);
    for (int kind = 0; kind < SHAPE_KINDS; kind++) {
        char text[2048];
        /* three times as large in the end: nine times the area */
        snprintf(text, sizeof text,
                 "ActiveTransform EndTime Translate 5 0 1 Rotate 80 1 0 1 Scale 3 3 3 ActiveTransform All %s",
                 SHAPES[kind]);
        scene *s = test_scene_create(&r, text);
        for (uint32_t i = 0; i < 20000 / FEWER; i++) {
            scene_ray ray = random_ray(&random, s);
            surface_hit hit, first;
            ray.time = rng_float(&random);
            if (!scene_intersect(s, ray, INFINITY, &hit))
                continue;
            surface_rest rest = surface_at_opening(s, &hit);
            double scale = 1.0 + 2.0 * (double)ray.time;
            assert_relative(rest.area_ratio, 1.0 / (scale * scale), 1e-3);
            assert_close(vec3_length(rest.geometric_normal), 1.0, 1e-5);
            /* a ray from above that point at the opening meets it there */
            vec3 above = vec3_add_scaled(rest.position, rest.geometric_normal, 1e-3f);
            if (!scene_intersect(s, scene_ray_make(above, vec3_negate(rest.geometric_normal)), 3e-3f, &first))
                continue; /* an edge */
            expect_near_point(first.position, rest.position, 1e-3f);
            if (first.primitive_index == hit.primitive_index)
                expect_near_point(first.geometric_normal, rest.geometric_normal, 5e-3f);
            rest = surface_at_opening(s, &first);
            expect_near_point(rest.position, first.position, 1e-5f);
        }
        scene_destroy(s);
    }
    /* at rest nothing is changed, not by a bit */
    scene *s = test_scene_create(
        &r, "ObjectBegin \"a\" Shape \"sphere\" ObjectEnd Rotate 30 1 2 3 ObjectInstance \"a\" "
            "Translate 5 0 0 Shape \"sphere\" ActiveTransform EndTime Translate 0 90 0 Shape \"disk\"");
    for (uint32_t i = 0; i < 1000; i++) {
        surface_hit hit;
        scene_ray ray = random_ray(&random, s);
        if (!scene_intersect(s, ray, INFINITY, &hit) || hit.instance_index == 1)
            continue;
        surface_rest rest = surface_at_opening(s, &hit);
        assert_memory_equal(&rest.position, &hit.position, sizeof hit.position);
        assert_memory_equal(&rest.geometric_normal, &hit.geometric_normal, sizeof hit.geometric_normal);
        assert_true(rest.area_ratio == 1.0f);
    }
    scene_destroy(s);
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(instances_are_their_shapes_moved),
        cmocka_unit_test(hair_scatters_alike_in_a_mirror),
        cmocka_unit_test(starts_do_not_meet_their_own_surface),
        cmocka_unit_test(moving_shapes_are_met_where_they_are),
        cmocka_unit_test(a_surface_is_found_where_it_was_at_first),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
