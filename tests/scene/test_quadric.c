/* test_quadric.c: spheres, cylinders and disks, whole and in part: areas, bounds, what rays meet, (u, v), samples,
 * shadows. Threads: one. */
/* ctest: serial */
#include "fixtures/test_scene.h"
#include "math/angle.h"

#define LAMP   "AreaLightSource \"diffuse\" "
#define PLACED "Translate 10 -5 2 Rotate 40 1 2 3 "

static const char *const SHAPES[] = {
    "Shape \"sphere\" \"float radius\" [2]",
    "Shape \"cylinder\"",
    "Shape \"disk\" \"float radius\" [2] \"float height\" [0.5]",
    "Shape \"sphere\" \"float radius\" [2] \"float zmin\" [-1] \"float zmax\" [1.5] \"float phimax\" [250]",
    "Shape \"sphere\" \"float zmin\" [0.25]",
    "Shape \"sphere\" \"float phimax\" [75]",
    "Shape \"cylinder\" \"float radius\" [0.5] \"float zmin\" [-2] \"float zmax\" [1] \"float phimax\" [100]",
    "Shape \"cylinder\" \"float radius\" [2] \"float zmin\" [1] \"float zmax\" [3] \"float phimax\" [300]",
    "Shape \"disk\" \"float radius\" [2] \"float innerradius\" [1] \"float height\" [-1] \"float phimax\" [120]",
    "Shape \"disk\" \"float phimax\" [200]",
};
static const char *const PLACEMENTS[] = {"", PLACED, PLACED "Scale 3 3 3 ", "Scale 3 1 -0.5 ",
                                         PLACED "Scale 1 -2 0.7 "};
enum { SHAPE_COUNT = sizeof SHAPES / sizeof *SHAPES, PLACEMENT_COUNT = sizeof PLACEMENTS / sizeof *PLACEMENTS };

static scene *make(test_run *r, int shape_index, int placement)
{
    char world[512];
    snprintf(world, sizeof world, "%s" LAMP "%s", PLACEMENTS[placement], SHAPES[shape_index]);
    return test_scene_create(r, world);
}

/* The point of (u, v), by pbrt's formulas, in object space. */
static vec3 object_point(const shape *s, double u, double v)
{
    const quadric *q = &s->as.quadric;
    double phi = u * (double)q->turn * 2.0 * PI, r = q->radius, z;
    if (s->kind == SHAPE_SPHERE) {
        double low = acos(fmax(-1.0, (double)q->z_min / r)), high = acos(fmin(1.0, (double)q->z_max / r));
        double theta = low + v * (high - low);
        z = r * cos(theta);
        r *= sin(theta);
    } else if (s->kind == SHAPE_CYLINDER) {
        z = (double)q->z_min + v * ((double)q->z_max - (double)q->z_min);
    } else {
        z = q->height;
        r += v * ((double)q->inner_radius - r);
    }
    return (vec3){(float)(r * cos(phi)), (float)(r * sin(phi)), (float)z};
}

static vec3 to_object(const shape *s, vec3 p)
{
    transform back = transform_invert(&s->as.quadric.world_from_object);
    return transform_point(&back, p);
}

/* Whether an object-space point is on the part that the file asks for, give or take. */
static bool is_on_part(const shape *s, vec3 p, double slack)
{
    const quadric *q = &s->as.quadric;
    double ring = hypot((double)p.x, (double)p.y), turns = atan2((double)p.y, (double)p.x) / (2.0 * PI);
    double arc_slack = slack / fmax(ring, slack) / 2.0;
    turns += turns < -arc_slack ? 1.0 : 0.0;
    if (turns > (double)q->turn + arc_slack && turns < 1.0 - arc_slack)
        return false;
    if (s->kind == SHAPE_DISK)
        return fabs((double)p.z - (double)q->height) < slack && ring < (double)q->radius + slack &&
               ring > (double)q->inner_radius - slack;
    if (p.z < q->z_min - (float)slack || p.z > q->z_max + (float)slack)
        return false;
    double off = s->kind == SHAPE_SPHERE ? (double)vec3_length(p) : ring;
    return fabs(off - (double)q->radius) < slack;
}

/* --- areas and bounds --- */

static void areas_have_their_closed_forms(void **state)
{
    (void)state;
    assert_relative(test_scene_area("Shape \"cylinder\""), 4.0 * PI, 1e-6);
    assert_relative(test_scene_area(PLACED "Scale 3 -3 3 Shape \"cylinder\" \"float radius\" [2] \"float zmin\" [5] "
                                           "\"float zmax\" [1] \"float phimax\" [90]"),
                    PI / 2 * 2 * 4 * 9, 1e-6);
    assert_relative(test_scene_area("Scale 3 3 5 Shape \"cylinder\""), 2.0 * PI * 3 * 10, 1e-6);
    /* an ellipse's circumference, by the arithmetic-geometric mean: here half axes 2 and 1 */
    double a = 2.0, b = 1.0, sum = 1.0 - 0.5 * 3.0 / 4.0, power = 0.5;
    for (int i = 0; i < 8; i++) {
        double c = (a - b) / 2.0, mean = (a + b) / 2.0;
        b = sqrt(a * b);
        a = mean;
        power *= 2.0;
        sum -= power / 2.0 * c * c * 2.0 / 4.0;
    }
    assert_relative(test_scene_area("Rotate 30 1 2 3 Scale 2 1 4 Shape \"cylinder\""), 2.0 * PI * 4.0 * sum / a * 8.0,
                    1e-5);
    assert_relative(test_scene_area("Shape \"sphere\" \"float zmin\" [0]"), 2.0 * PI, 1e-6);
    assert_relative(
        test_scene_area("Shape \"sphere\" \"float radius\" [3] \"float zmin\" [1] \"float zmax\" [2] \"float phimax\" "
                        "[120]"),
        2.0 * PI * 3.0 / 3.0, 1e-6);
    assert_relative(test_scene_area("Scale 1 2 3 Shape \"sphere\" \"float phimax\" [90]") * 4.0,
                    test_scene_area("Scale 1 2 3 Shape \"sphere\""), 1e-5);
    assert_relative(
        test_scene_area("Scale 2 3 5 Shape \"disk\" \"float radius\" [2] \"float innerradius\" [1] \"float phimax\" "
                        "[60]"),
        PI * 3.0 * 6.0 / 6.0, 1e-6);
    assert_relative(test_scene_area("Shape \"disk\" \"float phimax\" [720]"), PI, 1e-6);
}

/* The box holds every point of the surface, and each of its sides is reached by one. */
static void bounds_are_tight(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    for (int k = 0; k < SHAPE_COUNT; k++)
        for (int placement = 0; placement < PLACEMENT_COUNT; placement++) {
            scene *s = make(&r, k, placement);
            const shape *it = &s->shapes[0];
            vec3 low, high, seen_low = {INFINITY, INFINITY, INFINITY}, seen_high = vec3_negate(seen_low);
            shape_bounds(it, &low, &high);
            enum { STEPS = 120 };
            for (int i = 0; i <= STEPS; i++)
                for (int j = 0; j <= STEPS; j++) {
                    vec3 p = transform_point(&it->as.quadric.world_from_object,
                                             object_point(it, (double)i / STEPS, (double)j / STEPS));
                    seen_low = vec3_min(seen_low, p);
                    seen_high = vec3_max(seen_high, p);
                }
            vec3 size = vec3_sub(high, low);
            float slack = 2e-6f * (vec3_max_abs(size) + vec3_max_abs(low)), loose = 2e-3f * vec3_max_abs(size);
            vec3 below = vec3_sub(seen_low, low), above = vec3_sub(high, seen_high);
            assert_true(fminf(below.x, fminf(below.y, below.z)) >= -slack);
            assert_true(fminf(above.x, fminf(above.y, above.z)) >= -slack);
            assert_true(vec3_max_abs(below) <= loose && vec3_max_abs(above) <= loose);
            scene_destroy(s);
        }
    test_run_reset(&r);
}

/* --- rays --- */

static void angles_are_atan2(void **state)
{
    (void)state;
    for (int i = -720; i <= 720; i++) {
        double phi = i * PI / 720.0 + 1e-4, expected = atan2(sin(phi), cos(phi)) / (2.0 * PI);
        assert_close(angle_turns(3.0 * sin(phi), 3.0 * cos(phi)), expected < 0.0 ? expected + 1.0 : expected, 2e-11);
    }
    assert_true(angle_turns(0.0, 0.0) == 0.0);
    assert_true(angle_turns(0.0, 2.0) == 0.0);
    assert_close(angle_turns(2.0, 0.0), 0.25, 1e-15);
    assert_close(angle_turns(0.0, -2.0), 0.5, 1e-15);
    assert_close(angle_turns(-2.0, 0.0), 0.75, 1e-15);
}

/* A ray straight at the point of (u, v) meets it there, on the side of the normal, and finds (u, v) again. */
static void rays_meet_every_point_with_its_uv(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    for (int k = 0; k < SHAPE_COUNT; k++)
        for (int placement = 0; placement < PLACEMENT_COUNT; placement++) {
            scene *s = make(&r, k, placement);
            const shape *it = &s->shapes[0];
            const transform *world = &it->as.quadric.world_from_object;
            rng random = test_random((uint64_t)k);
            for (int i = 0; i < 400 / FEWER; i++) {
                double u = 0.002 + 0.996 * (double)rng_float(&random), v = 0.002 + 0.996 * (double)rng_float(&random);
                vec3 object = object_point(it, u, v), p = transform_point(world, object);
                vec3 n = it->kind == SHAPE_DISK       ? (vec3){0.0f, 0.0f, 1.0f}
                         : it->kind == SHAPE_CYLINDER ? (vec3){object.x, object.y, 0.0f}
                                                      : object;
                n = vec3_normalize(transform_normal(world, n));
                vec3 from = vec3_add_scaled(p, n, 0.3f);
                surface_hit hit;
                if (!scene_intersect(s, scene_ray_make(from, vec3_negate(n)), INFINITY, &hit))
                    fail_msg("%s%s is not met at %g, %g", PLACEMENTS[placement], SHAPES[k], u, v);
                double scale = s->bounding_radius + vec3_max_abs(s->bounding_center);
                assert_close(hit.distance, 0.3, 1e-5 * scale);
                assert_close(sqrt(vec3_distance_squared(hit.position, p)), 0.0, 1e-5 * scale);
                assert_true(vec3_dot(hit.geometric_normal, n) > 0.9999f);
                assert_true(vec3_dot(hit.shading_normal, n) > 0.9999f);
                assert_close(hit.uv.x, u, 2e-4);
                assert_close(hit.uv.y, v, 2e-4);
                /* from behind the ray meets that point too, and the normal stays */
                from = vec3_add_scaled(p, n, -0.05f);
                assert_true(scene_intersect(s, scene_ray_make(from, n), 0.1f, &hit));
                assert_true(vec3_dot(hit.geometric_normal, n) > 0.9999f);
                assert_true(is_blocked_between(s, from, vec3_add_scaled(p, n, 0.05f)));
            }
            scene_destroy(s);
        }
    test_run_reset(&r);
}

/* Rays from everywhere meet nothing beyond the part, and as many of them as a search in closed form finds. */
static void rays_meet_the_part_alone(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    for (int k = 0; k < SHAPE_COUNT; k++)
        for (int placement = 0; placement < PLACEMENT_COUNT; placement++) {
            scene *s = make(&r, k, placement);
            const shape *it = &s->shapes[0];
            rng random = test_random(100);
            int hits = 0, through = 0;
            double scale = s->bounding_radius + vec3_max_abs(s->bounding_center);
            for (int i = 0; i < 2000 / FEWER; i++) {
                vec3 from = vec3_add_scaled(s->bounding_center, random_direction(&random), 3.0f * s->bounding_radius);
                vec3 to = vec3_add_scaled(s->bounding_center, random_direction(&random), 0.8f * s->bounding_radius);
                vec3 direction = vec3_normalize(vec3_sub(to, from));
                surface_hit hit, next;
                bool is_hit = scene_intersect(s, scene_ray_make(from, direction), INFINITY, &hit);
                assert_int_equal(is_hit, scene_occluded(s, scene_ray_make(from, direction), INFINITY));
                if (!is_hit)
                    continue;
                hits++;
                assert_true(is_on_part(it, to_object(it, hit.position), 1e-5 * scale));
                assert_true(hit.uv.x >= 0.0f && hit.uv.x <= 1.0f && hit.uv.y >= 0.0f && hit.uv.y <= 1.0f);
                /* going on, it never meets the same point again */
                vec3 out = surface_ray(&hit, scene_ray_make(hit.position, direction), direction).origin;
                if (scene_intersect(s, scene_ray_make(out, direction), INFINITY, &next)) {
                    through++;
                    assert_true(next.distance > 0.0f);
                    assert_true(is_on_part(it, to_object(it, next.position), 1e-5 * scale));
                }
            }
            assert_true(hits > 50 / FEWER);
            assert_true(it->kind != SHAPE_DISK || through == 0);
            scene_destroy(s);
        }
    test_run_reset(&r);
}

/* An open cylinder is no wall to what goes through it lengthwise, and one that is cut is none where it is cut. */
static void what_is_cut_away_is_not_met(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, "Shape \"cylinder\" \"float phimax\" [180]");
    surface_hit hit;
    vec3 x = {1.0f, 0.0f, 0.0f}, y = {0.0f, 1.0f, 0.0f}, z = {0.0f, 0.0f, 1.0f};
    assert_false(scene_intersect(s, scene_ray_make(vec3_make(0.2f, 0.3f, -5.0f), z), INFINITY, &hit));
    assert_false(scene_intersect(s, scene_ray_make(vec3_make(-5.0f, 0.5f, 1.1f), x), INFINITY, &hit));
    assert_false(scene_intersect(s, scene_ray_make(vec3_make(-5.0f, -0.5f, 0.5f), x), INFINITY, &hit));
    assert_true(scene_intersect(s, scene_ray_make(vec3_make(0.0f, -5.0f, 0.5f), y), INFINITY, &hit));
    assert_close(hit.distance, 6.0, 1e-5);
    assert_close(hit.uv.x, 0.5, 1e-6);
    assert_close(hit.uv.y, 0.75, 1e-6);
    assert_close(hit.geometric_normal.y, 1.0, 1e-6);
    assert_false(is_blocked_between(s, vec3_make(0.0f, -5.0f, 0.5f), vec3_make(0.0f, 0.9f, 0.5f)));
    assert_true(is_blocked_between(s, vec3_make(0.0f, -5.0f, 0.5f), vec3_make(0.0f, 1.1f, 0.5f)));
    scene_destroy(s);
    s = test_scene_create(&r, "ReverseOrientation Shape \"sphere\" \"float zmax\" [0]");
    assert_true(scene_intersect(s, scene_ray_make(vec3_make(0.0f, 0.0f, 5.0f), vec3_negate(z)), INFINITY, &hit));
    assert_close(hit.distance, 6.0, 1e-5);
    assert_close(hit.uv.y, 0.0, 1e-3);
    assert_close(hit.geometric_normal.z, 1.0, 1e-6); /* outside is below, turned over */
    assert_true(s->shapes[0].as.quadric.uniform_radius == 0.0f);
    scene_destroy(s);
    test_run_reset(&r);
}

/* --- samples --- */

/* The density in u of an even spread is the share of area; on a sphere evenly scaled so is that in height. */
static void samples_are_even_over_the_part(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    for (int k = 0; k < SHAPE_COUNT; k++)
        for (int placement = 0; placement < PLACEMENT_COUNT; placement++) {
            scene *s = make(&r, k, placement);
            const shape *it = &s->shapes[0];
            const quadric *q = &it->as.quadric;
            rng random = test_random(7);
            const int count = 8000 / FEWER;
            int halves[2] = {0, 0};
            double scale = s->bounding_radius + vec3_max_abs(s->bounding_center), inverse = 0.0, square = 0.0;
            vec3 low, high;
            shape_bounds(it, &low, &high);
            for (int i = 0; i < count; i++) {
                surface_sample at = shape_sample_area(it, rng_vec2(&random));
                vec3 p = to_object(it, at.position);
                assert_true(is_on_part(it, p, 1e-5 * scale));
                assert_close(vec3_length(at.geometric_normal), 1.0, 1e-5);
                assert_relative(shape_pdf_area(it, at.geometric_normal), at.pdf_area, 1e-4);
                inverse += 1.0 / (double)at.pdf_area / count;
                square += 1.0 / (double)at.pdf_area / (double)at.pdf_area / count;
                double turns = angle_turns((double)p.y, (double)p.x) / (double)q->turn;
                halves[0] += turns < 0.5 || turns > 0.5 / (double)q->turn + 0.5;
                if (it->kind == SHAPE_DISK)
                    halves[1] +=
                        p.x * p.x + p.y * p.y < 0.5f * (q->radius * q->radius + q->inner_radius * q->inner_radius);
                else
                    halves[1] += p.z < 0.5f * (q->z_min + q->z_max);
                /* the light that is there reaches what is before it */
                vec3 target = vec3_add_scaled(at.position, at.geometric_normal, at.epsilon);
                assert_false(is_blocked_between(s, vec3_add_scaled(at.position, at.geometric_normal, 0.1f), target));
            }
            /* the mean of the density's inverse is the area; halves in object space are halves of what is drawn */
            assert_close(inverse, it->area,
                         5.0 * sqrt(fmax(0.0, square - inverse * inverse) / count) + 1e-4 * (double)it->area);
            assert_close(halves[0], count / 2.0, 5.0 * sqrt(count * 0.25));
            assert_close(halves[1], count / 2.0, 5.0 * sqrt(count * 0.25));
            scene_destroy(s);
        }
    test_run_reset(&r);
}

/* The light that a lamp sends to a point, by its samples, is the light that rays from there find on it. */
static void lamps_shine_as_they_are_seen(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    for (int k = 3; k < SHAPE_COUNT; k++)
        for (int placement = 1; placement < PLACEMENT_COUNT; placement += 3) {
            scene *s = make(&r, k, placement);
            const light *lamp = &s->lights[0];
            rng random = test_random(11);
            vec3 away = random_direction(&random);
            vec3 point = vec3_add_scaled(s->bounding_center, away, 1.5f * s->bounding_radius);
            const int count = 20000 / FEWER;
            double sampled = 0.0, squares = 0.0, seen = 0.0;
            for (int i = 0; i < count; i++) {
                light_sample at;
                if (light_sample_from_point(s, lamp, point, rng_vec2(&random), &at) &&
                    !is_blocked_between(s, point, at.shadow_target)) {
                    double value = (double)at.radiance.r / (double)at.pdf_solid_angle;
                    sampled += value / count;
                    squares += value * value / count;
                    surface_hit hit;
                    if (scene_intersect(s, scene_ray_make(point, at.direction), INFINITY, &hit) &&
                        fabsf(vec3_dot(hit.geometric_normal, at.direction)) > 0.05f) /* flatter ones lose digits */
                        assert_relative(light_pdf_from_point(s, lamp, point, &hit), at.pdf_solid_angle, 0.02);
                }
                /* a cone of a third of a turn holds the scene: its sine is at most 2/3 */
                vec3 local = sample_uniform_cone(rng_vec2(&random), 0.5f);
                frame f = frame_from_z(vec3_negate(away));
                vec3 direction = frame_to_world(&f, local);
                surface_hit hit;
                if (scene_intersect(s, scene_ray_make(point, direction), INFINITY, &hit))
                    seen += (double)light_emitted_radiance(s, lamp, &hit, vec3_negate(direction)).r * PI / count;
            }
            double share = fmin(1.0, seen / PI / (double)lamp->as.area.radiance.r);
            double seen_error = PI * (double)lamp->as.area.radiance.r * sqrt(share * (1.0 - share) / count);
            double error = sqrt((squares - sampled * sampled) / count) + seen_error;
            assert_close(sampled, seen, 5.0 * error + 1e-3);
            scene_destroy(s);
        }
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(areas_have_their_closed_forms),
        cmocka_unit_test(bounds_are_tight),
        cmocka_unit_test(angles_are_atan2),
        cmocka_unit_test(rays_meet_every_point_with_its_uv),
        cmocka_unit_test(rays_meet_the_part_alone),
        cmocka_unit_test(what_is_cut_away_is_not_met),
        cmocka_unit_test(samples_are_even_over_the_part),
        cmocka_unit_test(lamps_shine_as_they_are_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
