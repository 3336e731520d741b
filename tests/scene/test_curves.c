/* test_curves.c: tubes, flat curves and ribbons: what rays meet, held against a cylinder, a rectangle and the width as
 * it is seen; (u, v), tangents, rays that leave; alpha, objects and motion. Threads: one. */
#include "fixtures/test_scene.h"

#define STRAIGHT  "\"point3 P\" [0 0 -1 0 0 -.25 0 0 .5 0 0 1] " /* u is no even measure of it */
#define BENT      "\"point3 P\" [0 0 0 0 0 1 1 0 1 1 0 2] "
#define TUBE      "Shape \"curve\" \"string type\" \"cylinder\" "
#define FLAT      "Shape \"curve\" \"string type\" \"flat\" "
#define RIBBON    "Shape \"curve\" \"string type\" \"ribbon\" "
#define PLACED    "Translate 10 -5 2 Rotate 40 1 2 3 "
#define IN_OBJECT "ObjectBegin \"o\" "
#define SEEN      " ObjectEnd Translate 3 1 2 Rotate 200 2 1 1 Scale 2 1 -1.5 ObjectInstance \"o\""

static const struct {
    const char *before, *after;
} PLACEMENTS[] = {{"", ""},
                  {PLACED, ""},
                  {PLACED "Scale 3 3 -3 ", ""},
                  {PLACED "Scale 1 2 0.7 ", ""},
                  {"Scale 0.002 0.002 0.002 ", ""},
                  {IN_OBJECT, SEEN},
                  {IN_OBJECT PLACED "Scale .5 1 1 ", SEEN}};
enum { PLACEMENT_COUNT = sizeof PLACEMENTS / sizeof *PLACEMENTS };

static scene *make(test_run *r, int placement, const char *what)
{
    char world[1024];
    snprintf(world, sizeof world, "%s%s%s", PLACEMENTS[placement].before, what, PLACEMENTS[placement].after);
    return test_scene_create(r, world);
}

/* A ray from around the scene to somewhere within its box. */
static scene_ray random_ray(const scene *s, rng *random)
{
    vec3 to = random_in_box(random, s->bounds_min, s->bounds_max);
    vec3 from = vec3_add_scaled(s->bounding_center, random_direction(random), 3.0f * s->bounding_radius);
    return scene_ray_make(from, vec3_normalize(vec3_sub(to, from)));
}

/* A ray from around the scene to its first, straight, curve. */
static scene_ray ray_at_curve(const scene *s, rng *random)
{
    const curve_point *p = s->shapes[0].as.curves.points;
    float t = rng_float(random);
    vec3 to = vec3_add(vec3_scale(p[0].at, 1.0f - t), vec3_scale(p[3].at, t));
    to = vec3_add_scaled(to, random_direction(random), p[0].radius * rng_float(random));
    for (uint32_t i = 0; i < s->instance_count; i++)
        if (s->instances[i].object_index == s->shapes[0].object_index) {
            affine world_from_object = instance_at(s, i, 0.0f);
            to = affine_point(&world_from_object, to);
        }
    vec3 from = vec3_add_scaled(s->bounding_center, random_direction(random), 3.0f * s->bounding_radius);
    return scene_ray_make(from, vec3_normalize(vec3_sub(to, from)));
}

/* --- the same rays at a curve and at what it should be --- */

typedef struct comparison {
    int rays, met, differ; /* one was met, the other not */
} comparison;

/* Compares where a ray meets both scenes: the point, the normal (of two-sided surfaces either way) and v. */
static comparison compare(const scene *a, const scene *b, bool is_two_sided, double tolerance)
{
    comparison c = {.rays = 4000 / FEWER};
    for (int i = 0; i < c.rays; i++) {
        rng random = test_random((uint64_t)i);
        scene_ray ray = random_ray(b, &random);
        surface_hit h, g;
        if (!is_two_sided && i % 4 == 0) /* from within */
            ray.origin = random_in_box(&random, b->bounds_min, b->bounds_max);
        bool is_a = scene_intersect(a, ray, INFINITY, &h), is_b = scene_intersect(b, ray, INFINITY, &g);
        assert_true(scene_occluded(a, ray, INFINITY) == is_a);
        c.met += is_a && is_b;
        if (is_a != is_b) {
            c.differ++;
            continue;
        }
        if (!is_a)
            continue;
        double off = sqrt((double)vec3_distance_squared(h.position, g.position)) / (double)b->bounding_radius;
        double turned = (double)vec3_dot(h.geometric_normal, g.geometric_normal);
        if (off > tolerance || (is_two_sided ? fabs(turned) : turned) < 1.0 - 1e-4)
            c.differ++;
    }
    return c;
}

static void expect_alike(const char *what, int placement, comparison c)
{
    if (c.met < c.rays / 16 || c.differ > c.rays / 500) /* rays that graze an edge */
        fail_msg("%s, placement %d: of %d rays %d meet both, %d differ", what, placement, c.rays, c.met, c.differ);
}

static void a_straight_tube_is_a_cylinder(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    for (int placement = 0; placement < PLACEMENT_COUNT; placement++)
        for (int side = 0; side < 2; side++) {
            char tube[256], cylinder[256];
            snprintf(tube, sizeof tube, "%s" TUBE STRAIGHT "\"float width\" .6", side ? "ReverseOrientation " : "");
            snprintf(cylinder, sizeof cylinder, "%sShape \"cylinder\" \"float radius\" .3",
                     side ? "ReverseOrientation " : "");
            scene *a = make(&r, placement, tube), *b = make(&r, placement, cylinder);
            expect_alike("tube", placement, compare(a, b, false, 1e-4));
            if (placement == 0)
                assert_relative(shape_area(&a->shapes[0]), shape_area(&b->shapes[0]), 1e-3);
            scene_destroy(a);
            scene_destroy(b);
        }
    test_run_reset(&r);
}

static void a_straight_ribbon_is_a_rectangle(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    for (int placement = 0; placement < PLACEMENT_COUNT; placement++) {
        /* of the normals only what is across the curve counts */
        scene *a = make(&r, placement, RIBBON STRAIGHT "\"float width\" .6 \"normal N\" [0 2 0  0 2 1]");
        scene *b = make(&r, placement, "Shape \"bilinearmesh\" \"point3 P\" [-.3 0 -1 .3 0 -1 -.3 0 1 .3 0 1]");
        expect_alike("ribbon", placement, compare(a, b, true, 1e-4));
        scene_destroy(a);
        scene_destroy(b);
    }
    test_run_reset(&r);
}

/* A quarter of a circle, as near as a cubic comes to it (within 0.03 % of its radius), against a torus' quarter. */
static void a_bent_tube_is_a_torus(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, TUBE "\"point3 P\" [1 0 0  1 .5522847 0  .5522847 1 0  0 1 0] \"float width\" .4");
    int met = 0;
    for (int i = 0; i < 4000 / FEWER; i++) {
        rng random = test_random((uint64_t)i);
        scene_ray ray = random_ray(s, &random);
        surface_hit h;
        if (!scene_intersect(s, ray, INFINITY, &h))
            continue;
        double ring = hypot((double)h.position.x, (double)h.position.y);
        double x[3] = {(double)h.position.x / ring * (ring - 1.0), (double)h.position.y / ring * (ring - 1.0),
                       (double)h.position.z};
        double away = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
        assert_close(away, 0.2, 1e-3);
        double cosine = ((double)h.geometric_normal.x * x[0] + (double)h.geometric_normal.y * x[1] +
                         (double)h.geometric_normal.z * x[2]) /
                        away;
        assert_true(cosine > 1.0 - 1e-4);
        double miss =
            sqrt((double)vec3_distance_squared(vec3_add_scaled(ray.origin, ray.direction, h.distance), h.position));
        double grazing = fabs((double)vec3_dot(ray.direction, h.geometric_normal));
        assert_true(miss < 1e-3 || grazing < 0.1); /* the point is the ray's */
        met++;
    }
    assert_true(met > 1000 / FEWER);
    scene_destroy(s);
    test_run_reset(&r);
}

/* A taper of a fifth: the normal of a cone. */
static void a_tapered_tube_is_a_cone(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    scene *s =
        test_scene_create(&r, TUBE "\"point3 P\" [0 0 0 0 0 1 0 0 2 0 0 3] \"float width0\" .8 \"float width1\" .2");
    int met = 0;
    for (int i = 0; i < 2000 / FEWER; i++) {
        rng random = test_random((uint64_t)i);
        surface_hit h;
        if (!scene_intersect(s, random_ray(s, &random), INFINITY, &h))
            continue;
        double ring = hypot((double)h.position.x, (double)h.position.y), slope = 0.1;
        assert_close(ring, 0.4 - slope * (double)h.position.z, 1e-5);
        double c = 1.0 / sqrt(1.0 + slope * slope);
        assert_close((double)h.geometric_normal.z, slope * c, 1e-4);
        assert_close((double)h.geometric_normal.x, (double)h.position.x / ring * c, 1e-4);
        assert_close((double)h.uv.x, (double)h.position.z / 3.0, 1e-4);
        met++;
    }
    assert_true(met > 200 / FEWER);
    scene_destroy(s);
    test_run_reset(&r);
}

/* --- flat curves --- */

/* From every side a flat curve shows its width, and its length foreshortened; its normal is across it, towards the
 * ray, and v goes from edge to edge. */
static void a_flat_curve_is_as_wide_from_every_side(void **state)
{
    (void)state;
    enum { GRID = 200 };
    const double width = 0.3, length = 2.0;
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, FLAT STRAIGHT "\"float width\" .3");
    for (int i = 0; i < 24 / (FEWER > 1 ? 4 : 1); i++) {
        rng random = test_random((uint64_t)i);
        vec3 d = random_direction(&random), along = {0.0f, 0.0f, 1.0f};
        frame f = frame_from_z(d);
        int met = 0;
        for (int k = 0; k < GRID * GRID; k++) {
            float x = ((float)(k % GRID) + 0.5f) / GRID * 2.6f - 1.3f,
                  y = ((float)(k / GRID) + 0.5f) / GRID * 2.6f - 1.3f;
            vec3 from = vec3_add_scaled(vec3_add_scaled(vec3_scale(d, -5.0f), f.x, x), f.y, y);
            surface_hit h;
            if (!scene_intersect(s, scene_ray_make(from, d), INFINITY, &h))
                continue;
            met++;
            double facing = (double)vec3_dot(h.geometric_normal, d), across = sqrt(1.0 - (double)d.z * (double)d.z);
            assert_close((double)vec3_dot(h.geometric_normal, along), 0.0, 1e-4);
            assert_close(facing, -across, 1e-4);
            /* v: how far the ray passes the middle line by, to the side that is z x the way back */
            vec3 side = vec3_normalize(vec3_cross(along, vec3_negate(d)));
            assert_close((double)h.uv.y, 0.5 + (double)vec3_dot(from, side) / width, 1e-3);
            double z = (double)h.position.z, u = (double)h.uv.x, w = 1.0 - u;
            assert_close(z, -w * w * w - 0.75 * u * w * w + 1.5 * u * u * w + u * u * u, 1e-3);
        }
        double seen = met * 2.6 * 2.6 / (GRID * GRID),
               expected = width * length * sqrt(1.0 - (double)d.z * (double)d.z);
        /* a row of the grid on either side of its outline, and half a width's slant at the ends */
        assert_close(seen, expected, 0.025 * expected + 0.01);
    }
    scene_destroy(s);
    test_run_reset(&r);
}

/* --- what leaves --- */

static const struct {
    const char *text;
    bool is_closed; /* a tube: into it goes a ray as well */
} LEFT[] = {{TUBE STRAIGHT "\"float width\" .6", true},
            {FLAT STRAIGHT "\"float width\" .6", false},
            {RIBBON STRAIGHT "\"float width\" .6 \"normal N\" [0 2 0  0 2 1]", false},
            {TUBE STRAIGHT "\"float width\" .002", true},
            {FLAT STRAIGHT "\"float width\" .002", false},
            {RIBBON STRAIGHT "\"float width\" .02 \"normal N\" [0 1 0 1 1 0]", false}};
enum { LEFT_COUNT = sizeof LEFT / sizeof *LEFT };

/* A straight curve is not met again by what leaves it outwards, in any direction; a tube is met by what goes in, across
 * it. */
static void rays_that_leave_do_not_come_back(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    for (int k = 0; k < LEFT_COUNT; k++)
        for (int placement = 0; placement < PLACEMENT_COUNT; placement++) {
            scene *s = make(&r, placement, LEFT[k].text);
            int left = 0, back = 0, in = 0, lost = 0;
            for (int i = 0; i < 2000 / FEWER; i++) {
                rng random = test_random((uint64_t)i);
                scene_ray ray = ray_at_curve(s, &random);
                surface_hit h, again;
                vec3 to = random_direction(&random);
                if (!scene_intersect(s, ray, INFINITY, &h))
                    continue;
                bool is_out = vec3_dot(to, h.geometric_normal) > 0.0f;
                if (is_out || !LEFT[k].is_closed) {
                    left++;
                    back += scene_intersect(s, surface_ray(&h, ray, to), INFINITY, &again);
                } else if (h.uv.x > 0.4f && h.uv.x < 0.6f && fabsf(vec3_dot(to, h.geometric_normal)) > 0.85f) {
                    in++;
                    if (!scene_intersect(s, surface_ray(&h, ray, to), INFINITY, &again) ||
                        vec3_dot(to, again.geometric_normal) < 0.0f)
                        lost++;
                }
            }
            /* a long way off, a turned ribbon comes round again */
            if (left < 200 / FEWER || (LEFT[k].is_closed && in < 10 / FEWER) || back > (k == 5 ? left / 20 : 0) ||
                lost > in / 50)
                fail_msg("%s, placement %d: of %d rays %d come back, of %d that go in %d are lost", LEFT[k].text,
                         placement, left, back, in, lost);
            scene_destroy(s);
        }
    test_run_reset(&r);
}

/* --- (u, v) and tangents --- */

/* Two hits side by side differ by what dp/du and dp/dv say. */
static void tangents_go_where_uv_goes(void **state)
{
    (void)state;
    enum { RAYS = FEWER > 1 ? 1000 : 3000 };
    static const char *const CURVES[] = {TUBE BENT "\"float width\" .3", FLAT BENT "\"float width\" .3",
                                         RIBBON BENT "\"float width\" .3 \"normal N\" [0 1 0 0 1 0]"};
    test_run r;
    test_run_init(&r, 1);
    for (int k = 0; k < 3; k++)
        for (int placement = 0; placement < PLACEMENT_COUNT; placement++) {
            scene *s = make(&r, placement, CURVES[k]);
            int tried = 0, wrong = 0;
            for (int i = 0; i < RAYS; i++) {
                rng random = test_random((uint64_t)i);
                scene_ray ray = random_ray(s, &random), beside = ray;
                surface_hit h, g;
                float step = 1e-3f * s->bounding_radius;
                beside.origin = vec3_add_scaled(ray.origin, random_direction(&random), step);
                if (!scene_intersect(s, ray, INFINITY, &h) || !scene_intersect(s, beside, INFINITY, &g))
                    continue;
                vec3 dpdu, dpdv, moved = vec3_sub(g.position, h.position);
                if (fabsf(vec3_dot(ray.direction, h.geometric_normal)) < 0.7f || fabsf(h.uv.y - 0.5f) > 0.3f ||
                    h.uv.x < 0.02f || h.uv.x > 0.98f || vec3_length(moved) > 8.0f * step)
                    continue;
                surface_tangents(s, &h, &dpdu, &dpdv);
                assert_close((double)vec3_dot(dpdu, h.geometric_normal) / (double)vec3_length(dpdu), 0.0, 1e-3);
                float du = g.uv.x - h.uv.x, dv = g.uv.y - h.uv.y;
                vec3 along = vec3_scale(dpdu, du), expected = vec3_add_scaled(along, dpdv, dv);
                /* a tube's v is what is seen of it, so that dp/dv is longer by the slant; and inside it bends */
                double off = (double)vec3_length(vec3_sub(moved, k == 0 ? along : expected));
                double bound = k == 0 ? 1.3 * fabs((double)dv) * (double)vec3_length(dpdv) + 0.3 * (double)step
                                      : 0.25 * (double)step;
                tried++;
                wrong += off > bound || (k == 0 && (double)vec3_dot(moved, dpdv) * (double)dv < -1e-3 * (double)step);
            }
            if (tried < RAYS / 100 || wrong > 1 + tried / 25)
                fail_msg("%s, placement %d: %d of %d wrong", CURVES[k], placement, wrong, tried);
            scene_destroy(s);
        }
    test_run_reset(&r);
}

/* --- alpha, objects, motion --- */

/* Each of a tube's two walls lets a half through, a flat curve's one. */
static void alpha_surfaces_let_their_share_through(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        double through;
    } CASES[] = {{TUBE STRAIGHT "\"float width\" 1.6 \"float alpha\" .5", 0.25},
                 {FLAT STRAIGHT "\"float width\" 1.6 \"float alpha\" .5", 0.5},
                 {RIBBON STRAIGHT "\"float width\" 1.6 \"float alpha\" .5 \"normal N\" [0 1 0 0 1 0]", 0.5},
                 {"Texture \"edge\" \"float\" \"checkerboard\" \"float uscale\" .5 \"float vscale\" 2 \"float tex1\" 0 "
                  "\"float tex2\" 1 " FLAT STRAIGHT "\"float width\" 1.6 \"texture alpha\" \"edge\"",
                  0.5}};
    test_run r;
    test_run_init(&r, 1);
    for (int k = 0; k < 4; k++) {
        scene *s = test_scene_create(&r, CASES[k].text);
        int count = 20000 / FEWER, through = 0;
        for (int i = 0; i < count; i++) {
            rng random = test_random((uint64_t)i);
            vec3 from = {0.7f * (2.0f * rng_float(&random) - 1.0f), -4.0f, 0.9f * (2.0f * rng_float(&random) - 1.0f)};
            through += !scene_occluded(s, scene_ray_make(from, (vec3){0.0f, 1.0f, 0.0f}), INFINITY);
        }
        assert_close((double)through / count, CASES[k].through, 0.015 * WIDER);
        scene_destroy(s);
    }
    test_run_reset(&r);
}

static void a_moving_curve_is_where_its_time_says(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, "ActiveTransform EndTime Translate 4 0 0 ActiveTransform All " TUBE STRAIGHT
                                     "\"float width\" .4 " TUBE "\"point3 P\" [0 0 5 0 0 6 0 0 7 0 0 8]");
    assert_int_equal(s->object_count, 1); /* the second has joined it */
    assert_int_equal(s->shape_count, 1);
    for (int i = 0; i <= 8; i++) {
        scene_ray ray = scene_ray_make((vec3){(float)i * 0.5f, -5.0f, 0.0f}, (vec3){0.0f, 1.0f, 0.0f});
        surface_hit h;
        ray.time = (float)i / 8.0f;
        assert_true(scene_intersect(s, ray, INFINITY, &h));
        assert_close((double)h.position.y, -0.2, 1e-4);
        ray.origin.x += 0.25f;
        assert_false(scene_occluded(s, ray, INFINITY));
        ray.origin.z = 6.0f;
        assert_true(scene_occluded(s, ray, INFINITY));
    }
    scene_destroy(s);
    test_run_reset(&r);
}

/* The numbers of a bent curve at a time of the shutter, of those at three. */
static void bent_at(double time, char *out_text, size_t size)
{
    static const double SETS[3][12] = {{0, 0, 0, 0, 0, 1, 1, 0, 1, 1, 0, 2},
                                       {0, 0, 0.5, 0, 1, 1, 1, 2, 1, 1, 0, 2.5},
                                       {-2, 0, 0, 0, 0, 1, 1, 0, 2, 3, 1, 2}};
    const int step = time < 0.5 ? 0 : 1;
    size_t length = 0;
    for (int i = 0; i < 12; i++) {
        const double t = 2.0 * time - step, value = (1.0 - t) * SETS[step][i] + t * SETS[step + 1][i];
        length += (size_t)snprintf(out_text + length, size - length, "%.9g ", value);
    }
}

/* At each time, rays meet a moving curve where they would meet a still curve with the points of that time. */
static void points_that_move_are_where_their_time_says(void **state)
{
    (void)state;
    static const char *const TYPES[] = {TUBE "\"float width0\" .5 \"float width1\" .2 ",
                                        FLAT "\"float width0\" .5 \"float width1\" .2 "};
    static const char *const PLACES[][2] = {
        {"", ""}, {PLACED "Scale 1 2 0.7 ", ""}, {IN_OBJECT, SEEN}, {IN_OBJECT PLACED "Scale .5 1 1 ", SEEN}};
    enum { TIMES = 9 };
    char sets[3][512], text[2048];
    test_run r;
    test_run_init(&r, 1);
    for (int k = 0; k < 3; k++)
        bent_at(0.5 * k, sets[k], sizeof sets[k]);
    for (int place = 0; place < 4; place++)
        for (int type = 0; type < 2; type++) {
            snprintf(text, sizeof text, "%s%s\"integer motionsteps\" 3 \"point3 P\" [%s %s %s]%s", PLACES[place][0],
                     TYPES[type], sets[0], sets[1], sets[2], PLACES[place][1]);
            scene *moving = test_scene_create(&r, text);
            assert_true(moving->has_motion);
            for (int k = 0; k < TIMES; k++) {
                const float time = (float)k / (TIMES - 1);
                char now[512];
                int met = 0, differ = 0;
                bent_at((double)time, now, sizeof now);
                snprintf(text, sizeof text, "%s%s\"point3 P\" [%s]%s", PLACES[place][0], TYPES[type], now,
                         PLACES[place][1]);
                scene *still = test_scene_create(&r, text);
                for (int i = 0; i < 3000 / FEWER; i++) {
                    rng random = test_random((uint64_t)i);
                    scene_ray ray = random_ray(still, &random);
                    surface_hit h, g;
                    ray.time = time;
                    const bool is_moving_met = scene_intersect(moving, ray, INFINITY, &h),
                               is_still_met = scene_intersect(still, ray, INFINITY, &g);
                    assert_true(scene_occluded(moving, ray, INFINITY) == is_moving_met);
                    met += is_moving_met && is_still_met;
                    differ += is_moving_met != is_still_met;
                    if (!is_moving_met || !is_still_met)
                        continue;
                    const float size = still->bounding_radius;
                    vec3 dpdu[2], dpdv[2];
                    surface_tangents(moving, &h, &dpdu[0], &dpdv[0]);
                    surface_tangents(still, &g, &dpdu[1], &dpdv[1]);
                    differ += vec3_length(vec3_sub(h.position, g.position)) > 1e-4f * size ||
                              vec3_dot(h.geometric_normal, g.geometric_normal) < 0.9999f ||
                              fabsf(h.uv.x - g.uv.x) > 1e-3f || fabsf(h.uv.y - g.uv.y) > 2e-2f ||
                              vec3_length(vec3_sub(dpdu[0], dpdu[1])) > 1e-2f * vec3_length(dpdu[1]) ||
                              h.epsilon < 0.999f * g.epsilon || h.epsilon > 1.25f * g.epsilon; /* of both sets */
                }
                /* of flat ones the moving one is cut for all times: edges are a little elsewhere */
                if (met < 20 / FEWER || differ > 3 + met / (type == 0 ? 100 : 25))
                    fail_msg("place %d, type %d, time %g: %d met, %d differ", place, type, (double)time, met, differ);
                scene_destroy(still);
            }
            scene_destroy(moving);
        }
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_straight_tube_is_a_cylinder),
        cmocka_unit_test(a_straight_ribbon_is_a_rectangle),
        cmocka_unit_test(a_bent_tube_is_a_torus),
        cmocka_unit_test(a_tapered_tube_is_a_cone),
        cmocka_unit_test(a_flat_curve_is_as_wide_from_every_side),
        cmocka_unit_test(rays_that_leave_do_not_come_back),
        cmocka_unit_test(tangents_go_where_uv_goes),
        cmocka_unit_test(alpha_surfaces_let_their_share_through),
        cmocka_unit_test(a_moving_curve_is_where_its_time_says),
        cmocka_unit_test(points_that_move_are_where_their_time_says),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
