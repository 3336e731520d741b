/* test_clear_space.c: what a clear space tells of rays is what casting them tells, among all kinds of shapes; and it
 * tells much. Threads: one. */
#include "rays/clear_space.h"

#include "rays/transmittance.h"
#include "shape/alpha.h"

#include "fixtures/test_scene.h"

/* A closed box of 10 x 10 x 10. In it, above the floor of y = 0: spheres, of which one goes through the floor; a disk,
 * an ellipsoid, a tent, a plate that stands on the floor, and one with holes that lies on it. */
static const char ROOM[] =
    "Shape \"bilinearmesh\" \"point3 P\" [0 0 0  10 0 0  0 0 10  10 0 10]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [0 10 0  10 10 0  0 10 10  10 10 10]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [0 0 0  0 10 0  0 0 10  0 10 10]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [10 0 0  10 10 0  10 0 10  10 10 10]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [0 0 0  10 0 0  0 10 0  10 10 0]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [0 0 10  10 0 10  0 10 10  10 10 10]\n"
    "Shape \"trianglemesh\" \"point3 P\" [6 0 2  9 0 2  9 0 5  7.5 2 3.5] \"integer indices\" [0 1 3 1 2 3 2 0 3]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [2 0 7  4 0 8  2 3 7  4 3 8]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [1 0.00001 1  3 0.00001 1  1 0.00001 3  3 0.00001 3] \"float alpha\" 0.5\n"
    "AttributeBegin Translate 3 3 4 Shape \"sphere\" \"float radius\" 1.5 AttributeEnd\n"
    "AttributeBegin Translate 5.5 2.5 5 Shape \"sphere\" \"float radius\" 0.9 AttributeEnd\n"
    "AttributeBegin Translate 7 0.2 7 Shape \"sphere\" \"float radius\" 0.8 AttributeEnd\n"
    "AttributeBegin Translate 7.5 6 7 Scale 1.5 0.8 1 Shape \"sphere\" AttributeEnd\n"
    "AttributeBegin Translate 3 7 7 Rotate 70 1 0 0 Shape \"disk\" \"float radius\" 1.2 AttributeEnd\n";

/* A point on a surface in the room, with the normal of its clear side. */
static void random_point(const scene *s, rng *random, vec3 *out_position, vec3 *out_normal)
{
    surface_hit hit;
    vec3 from = {9.0f * rng_float(random) + 0.5f, 9.0f * rng_float(random) + 0.5f, 9.0f * rng_float(random) + 0.5f};
    vec3 direction = random_direction(random);
    assert_true(scene_find_surface(s, scene_ray_make(from, direction), INFINITY, &hit));
    *out_position = hit.position;
    *out_normal = vec3_face_forward(hit.geometric_normal, vec3_negate(direction));
}

static void answers_are_those_of_rays(void **state)
{
    (void)state;
    enum { POINTS = 4000 / FEWER, RAYS = 24 };
    static const float RADIUS = 2.5f, MIN_COS = 0.5f;
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, ROOM);
    rng random = test_random(5);
    uint64_t free_lines = 0, known_lines = 0, met = 0, known_met = 0;
    for (int i = 0; i < POINTS; i++) {
        vec3 at, normal;
        clear_space space;
        random_point(s, &random, &at, &normal);
        clear_space_find(s, at, normal, RADIUS, &space);
        assert_true(space.radius >= 0.0f && space.radius <= RADIUS);
        for (int k = 0; k < RAYS; k++) {
            /* lines near the surface, and any */
            float reach = RADIUS * rng_float(&random), lift = k % 2 ? 0.02f * reach : reach;
            vec3 from = vec3_add_scaled(vec3_add_scaled(at, normal, lift), random_direction(&random), reach),
                 to = vec3_add_scaled(vec3_add_scaled(at, normal, lift), random_direction(&random), reach);
            bool is_free = !scene_is_blocked(s, scene_ray_make(from, vec3_sub(to, from)), 1.0f);
            bool is_known = clear_space_has_line(s, &space, from, to);
            assert_true(is_free || !is_known);
            free_lines += is_free, known_lines += is_known;

            /* rays down onto the surface, and any */
            surface_hit hit;
            vec3 down = k % 2 ? vec3_negate(normal) : random_direction(&random);
            from = vec3_add_scaled(vec3_add_scaled(at, normal, 0.1f * reach), random_direction(&random), 0.09f * reach);
            bool meets = scene_find_surface(s, scene_ray_make(from, down), reach, &hit) &&
                         fabsf(vec3_dot(hit.geometric_normal, down)) > MIN_COS;
            is_known = clear_space_ends_ray(s, &space, from, down, reach, MIN_COS);
            assert_true(meets || !is_known);
            assert_true(!is_known || shape_is_opaque(&s->shapes[hit.shape_index]));
            met += meets, known_met += is_known;
        }
    }
    print_message("known: %.3f of the free lines, %.3f of the rays that meet something\n",
                  (double)known_lines / (double)free_lines, (double)known_met / (double)met);
    assert_true((double)known_lines > 0.4 * (double)free_lines);
    assert_true((double)known_met > 0.4 * (double)met);
    scene_destroy(s);
    test_run_reset(&r);
}

#define PLATE            "Shape \"bilinearmesh\" \"point3 P\" [0 0 0  1 0 0  0 0 1  1 0 1]\n"
#define FLOOR            "Shape \"bilinearmesh\" \"point3 P\" [0 0 0  10 0 0  0 0 10  10 0 10]\n"
#define BALL(at, radius) "AttributeBegin Translate " at " Shape \"sphere\" \"float radius\" " radius " AttributeEnd\n"
#define FOG(corners)                                                                                                   \
    "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [.1 .1 .1] \"rgb sigma_s\" [0 0 0]\n"     \
    "AttributeBegin MediumInterface \"fog\" \"\" Material \"interface\"\n"                                             \
    "Shape \"trianglemesh\" \"point3 P\" [" corners "] \"integer indices\" [0 1 2 0 2 3] AttributeEnd\n"

/* Places of which all is the same but the scene. */
#define OVER_THE_FLOOR {1, 1, 5}, {9, 1, 5}, {0, 0, 8}, {0, -1, 0}, 1.0f, 0.3f, false

/* Points are those that are seen along `toward`, any way where that is 0, from beside a line between two points. */
typedef struct place {
    const char *what, *text;
    vec3 first, last, beside, toward;
    float radius; /* of the spaces */
    float near;   /* what rays are aimed at is no farther from a point */
    bool tells_much;
} place;

static const place PLACES[] = {
    {"a mix with an interface",
     "MakeNamedMaterial \"a\" \"string type\" \"interface\" MakeNamedMaterial \"b\" \"string type\" \"diffuse\"\n"
     "MakeNamedMaterial \"m\" \"string type\" \"mix\" \"string materials\" [\"a\" \"b\"] \"float amount\" 0.5\n"
     "NamedMaterial \"m\"\n" FLOOR,
     OVER_THE_FLOOR},
    {"an interface on the floor", FOG("2 0 2  8 0 2  8 0 8  2 0 8") FLOOR, OVER_THE_FLOOR},
    {"the same behind it", FLOOR FOG("2 0 2  8 0 2  8 0 8  2 0 8"), OVER_THE_FLOOR},
    {"the same a little above it", FLOOR FOG("2 0.0001 2  8 0.0001 2  8 0.0001 8  2 0.0001 8"), OVER_THE_FLOOR},
    {"a plate over a plain that is a sphere",
     "Shape \"bilinearmesh\" \"point3 P\" [0 0.3 0  1 0.3 0  0 0.5 1  1 0.5 1]\n" BALL("0 -100000 0", "100000"),
     {.5f, .05f, .5f},
     {.5f, .05f, .5f},
     {.8f, .1f, .8f},
     {0, 1, 0},
     0.8f,
     0.3f,
     false},
    {"a plate beside such a sphere",
     PLATE BALL("-70710 10 -70710", "100000"),
     {.5f, .5f, .5f},
     {.5f, .5f, .5f},
     {.9f, 0, .9f},
     {0, -1, 0},
     0.8f,
     0.3f,
     false},
    {"a ball on a hill",
     BALL("0 1 0", "1") BALL("0 -1000 0", "1000"),
     {0, .5f, 0},
     {0, .5f, 0},
     {4, 1, 4},
     {0, 0, 0},
     0.8f,
     0.3f,
     true},
    {"a strip at 1000",
     "Shape \"trianglemesh\" \"point3 P\" [1000 0 0  1005 0 7  1005.02 0 7] \"integer indices\" [0 1 2]\n",
     {1001.506f, 1, 2.1f},
     {1004.516f, 1, 6.3f},
     {.02f, 0, 0},
     {0, -1, 0},
     3.0f,
     0.03f,
     false},
    {"a strip at 10000",
     "Shape \"trianglemesh\" \"point3 P\" [10000 0 0  10005 0 7  10005.02 0 7] \"integer indices\" [0 1 2]\n",
     {10001.506f, 1, 2.1f},
     {10004.516f, 1, 6.3f},
     {.02f, 0, 0},
     {0, -1, 0},
     3.0f,
     0.03f,
     false},
    {"a tilted chip within the rounding of a floor at 1000",
     "Shape \"bilinearmesh\" \"point3 P\" [990 0 0  1010 0 0  990 0 10  1010 0 10]\n"
     "Shape \"trianglemesh\" \"point3 P\" [1000 -.004 5  1000.3 .005 5  1000 -.004 5.3] \"integer indices\" [0 1 2]\n",
     {1000.1f, 1, 5.1f},
     {1000.1f, 1, 5.1f},
     {.6f, 0, .6f},
     {0, -1, 0},
     1.0f,
     0.4f,
     false},
    {"tiles around the origin",
     "Shape \"trianglemesh\" \"point3 P\" [-3 0 -3  .1 0 -3  3 0 -3  -3 0 .1  .1 0 .1  3 0 .1  -3 0 3  .1 0 3  3 0 3]\n"
     "\"integer indices\" [0 1 3 3 1 4 1 2 4 4 2 5 3 4 6 6 4 7 4 5 7 7 5 8]\n",
     {0, 1, 0},
     {0, 1, 0},
     {5, 0, 5},
     {0, -1, 0},
     1.0f,
     0.3f,
     true},
};

typedef struct tally {
    uint64_t lines, wrong_lines, ends, wrong_ends; /* that are known */
} tally;

/* A line somewhere in the space, or one that just misses what a plane parts from it. */
static void ask_of_line(const scene *s, const place *p, const clear_space *space, vec3 normal, int k, rng *random,
                        tally *t)
{
    vec3 ends[2];
    float reach = p->radius * rng_float(random);
    for (int i = 0; i < 2; i++) {
        ends[i] =
            vec3_add_scaled(vec3_add_scaled(space->center, normal, 0.02f * reach), random_direction(random), reach);
        if (k % 2 == 0 || space->plane_count == 0)
            continue;
        const clear_space_plane *plane = &space->plane[(uint32_t)k / 2 % space->plane_count];
        float height = plane->height + 2.0f * space->margin + 0.01f * p->radius * rng_float(random);
        ends[i] = vec3_add_scaled(ends[i], plane->normal, height - vec3_dot(ends[i], plane->normal));
    }
    if (!clear_space_has_line(s, space, ends[0], ends[1]))
        return;
    t->lines++;
    t->wrong_lines += scene_is_blocked(s, scene_ray_make(ends[0], vec3_sub(ends[1], ends[0])), 1.0f);
}

/* A ray down, or one that comes as slanted as it may, to a place near the point. */
static void ask_of_end(const scene *s, const place *p, const clear_space *space, vec3 normal, int k, rng *random,
                       tally *t)
{
    static const float MIN_COS = 0.5f;
    surface_hit hit;
    frame f = frame_from_z(normal);
    float cosine = k % 2 ? MIN_COS + 0.03f * rng_float(random) : 1.0f - 0.4f * rng_float(random), turn_sin, turn_cos;
    float sine = sqrtf(1.0f - cosine * cosine);
    sincos_turns(rng_float(random), &turn_sin, &turn_cos);
    vec3 down = vec3_normalize(
        vec3_add_scaled(vec3_add_scaled(vec3_scale(f.x, sine * turn_cos), f.y, sine * turn_sin), normal, -cosine));
    vec3 aim = random_direction(random);
    aim = vec3_add_scaled(aim, normal, -vec3_dot(aim, normal));
    aim = vec3_add_scaled(space->center, aim, p->near);
    vec3 from = vec3_add_scaled(aim, down, -0.5f * p->radius * rng_float(random));
    if (!clear_space_ends_ray(s, space, from, down, p->radius, MIN_COS))
        return;
    t->ends++;
    t->wrong_ends += !scene_find_surface(s, scene_ray_make(from, down), p->radius, &hit) ||
                     !(fabsf(vec3_dot(hit.geometric_normal, down)) > MIN_COS);
}

static tally ask_in_place(const place *p, uint64_t *out_known)
{
    enum { POINTS = 1000 / FEWER, QUESTIONS = 200 };
    tally t = {0};
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, p->text);
    rng random = test_random(5);
    *out_known = 0;
    for (int i = 0; i < POINTS; i++) {
        surface_hit hit;
        clear_space space;
        vec3 from = vec3_add_scaled(p->first, vec3_sub(p->last, p->first), rng_float(&random));
        from.x += p->beside.x * (rng_float(&random) - 0.5f);
        from.y += p->beside.y * (rng_float(&random) - 0.5f);
        from.z += p->beside.z * (rng_float(&random) - 0.5f);
        vec3 toward = vec3_length_squared(p->toward) > 0.0f ? p->toward : random_direction(&random);
        if (!scene_find_surface(s, scene_ray_make(from, toward), INFINITY, &hit))
            continue;
        vec3 normal = vec3_face_forward(hit.geometric_normal, vec3_negate(toward));
        clear_space_find(s, hit.position, normal, p->radius, &space);
        *out_known += space.radius > 0.0f;
        for (int k = 0; space.radius > 0.0f && k < QUESTIONS; k++) {
            ask_of_line(s, p, &space, normal, k, &random, &t);
            ask_of_end(s, p, &space, normal, k, &random, &t);
        }
    }
    scene_destroy(s);
    test_run_reset(&r);
    return t;
}

static void answers_are_right_in_odd_places(void **state)
{
    (void)state;
    uint64_t wrong = 0;
    for (size_t i = 0; i < sizeof PLACES / sizeof *PLACES; i++) {
        uint64_t known;
        tally t = ask_in_place(&PLACES[i], &known);
        print_message("%s: %llu spaces; wrong: %llu of %llu lines, %llu of %llu ends\n", PLACES[i].what,
                      (unsigned long long)known, (unsigned long long)t.wrong_lines, (unsigned long long)t.lines,
                      (unsigned long long)t.wrong_ends, (unsigned long long)t.ends);
        wrong += t.wrong_lines + t.wrong_ends;
        assert_true(!PLACES[i].tells_much || (known > 0 && t.lines > 50 * known && t.ends > 100 * known));
    }
    assert_int_equal(wrong, 0);
}

static void nothing_is_known_where_not_all_can_be_found(void **state)
{
    (void)state;
    static const char *const BESIDE[] = {
        "", /* there it is */
        "Shape \"curve\" \"point3 P\" [8 1 8  8 2 8  8 3 8  8 4 8] \"float width\" 0.1\n",
        "ObjectBegin \"ball\" Shape \"sphere\" ObjectEnd Translate 8 3 8 ObjectInstance \"ball\"\n"};
    test_run r;
    test_run_init(&r, 1);
    for (size_t i = 0; i < sizeof BESIDE / sizeof *BESIDE; i++) {
        char text[1000];
        snprintf(text, sizeof text, "%s%s", FLOOR, BESIDE[i]);
        scene *s = test_scene_create(&r, text);
        clear_space space;
        clear_space_find(s, (vec3){3.0f, 0.0f, 2.0f}, (vec3){0.0f, 1.0f, 0.0f}, 1.0f, &space);
        assert_int_equal(space.radius > 0.9f, i == 0);
        assert_int_equal(clear_space_is_told(s), i == 0);
        assert_true(i == 0 || space.radius == 0.0f);
        /* nor off any surface */
        clear_space_find(s, (vec3){3.0f, 0.1f, 2.0f}, (vec3){0.0f, 1.0f, 0.0f}, 1.0f, &space);
        assert_true(space.radius == 0.0f);
        scene_destroy(s);
    }
    test_run_reset(&r);
}

/* More spheres than are looked through one by one; a tessellation of more triangles than a query looks at. */
static void crowds_are_left_alone(void **state)
{
    (void)state;
    enum { SPHERES = 65, CELLS = 40 };
    test_run r;
    test_run_init(&r, 1);
    char *text = malloc(200000), *end = text;
    assert_non_null(text);
    end += sprintf(end, FLOOR);
    for (int i = 0; i < SPHERES; i++)
        end += sprintf(end, "AttributeBegin Translate %d 5 0 Shape \"sphere\" AttributeEnd\n", 3 * i);
    scene *s = test_scene_create(&r, text);
    clear_space space;
    clear_space_find(s, (vec3){3.0f, 0.0f, 2.0f}, (vec3){0.0f, 1.0f, 0.0f}, 1.0f, &space);
    assert_true(space.radius == 0.0f);
    scene_destroy(s);

    end = text;
    end += sprintf(end, "Shape \"trianglemesh\" \"point3 P\" [");
    for (int i = 0; i <= CELLS; i++)
        for (int k = 0; k <= CELLS; k++)
            end += sprintf(end, "%d 0 %d ", i, k);
    end += sprintf(end, "] \"integer indices\" [");
    for (int i = 0; i < CELLS; i++)
        for (int k = 0; k < CELLS; k++) {
            int a = i * (CELLS + 1) + k, b = a + CELLS + 1;
            end += sprintf(end, "%d %d %d %d %d %d ", a, a + 1, b, b, a + 1, b + 1);
        }
    sprintf(end, "]");
    s = test_scene_create(&r, text);
    clear_space_find(s, (vec3){20.3f, 0.0f, 20.3f}, (vec3){0.0f, 1.0f, 0.0f}, 16.0f, &space);
    assert_true(space.radius > 0.9f && space.radius < 4.0f); /* of what is less far, all the same */
    free(text);
    scene_destroy(s);
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(answers_are_those_of_rays),
        cmocka_unit_test(answers_are_right_in_odd_places),
        cmocka_unit_test(nothing_is_known_where_not_all_can_be_found),
        cmocka_unit_test(crowds_are_left_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
