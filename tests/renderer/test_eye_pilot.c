/* test_eye_pilot.c: where importons of the eye's pilot say that light goes on to where it is asked for: a closed box
 * against its geometric series, the ground before a window, the outer side of a curtain. Threads: two workers. */
#include "integrator/eye_pilot.h"

#include "fixtures/test_scene.h"
#include "photon_aim.h"

enum { POINTS = 4000, PHOTONS = 200000 / FEWER, SEEDS = 16 };

/* A scene of this world, seen from the origin along z. */
static scene *scene_of(test_run *r, const char *world)
{
    char text[4096];
    scene *s = scene_create();
    assert_non_null(s);
    snprintf(text, sizeof text, "Camera \"perspective\" \"float fov\" [90]\nWorldBegin\n%s", world);
    assert_int_equal(pbrt_parse_text(&r->run, "scene", text, strlen(text), s), AG_OK);
    assert_int_equal(scene_commit(s, &r->run, NULL), AG_OK);
    return s;
}

static eye_pilot look_at(test_run *r, const scene *s, int max_depth)
{
    eye_pilot pilot;
    ag_render_settings settings = ag_default_render_settings();
    settings.width = settings.height = 64;
    settings.max_depth = max_depth;
    assert_int_equal(eye_pilot_look(s, &r->run, &settings, &pilot), AG_OK);
    return pilot;
}

static eye_pilot look(test_run *r, const char *world, int max_depth)
{
    scene *s = scene_of(r, world);
    eye_pilot pilot = look_at(r, s, max_depth);
    scene_destroy(s);
    return pilot;
}

/* The mean importance at points between low and high, which lie in one plane. */
static double mean_importance(const importance_map *importance, vec3 low, vec3 high, vec3 normal)
{
    rng random = test_random(3);
    double sum = 0.0;
    for (int i = 0; i < POINTS; i++)
        sum += (double)importance_map_at(importance, random_in_box(&random, low, high), normal);
    return sum / POINTS;
}

/* The camera stands in the middle. An importon is scattered by walls that reflect half of it seven times at most: all
 * walls together have 1/2 + 1/4 + ... of it, and hardly anything on their outside. */
static void a_closed_box_has_its_series(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 2);
    eye_pilot pilot = look(&r,
                           "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n"
                           "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 -1  1 -1 -1  -1 1 -1  1 1 -1]\n"
                           "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 1  1 -1 1  -1 1 1  1 1 1]\n"
                           "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 -1  1 -1 -1  -1 -1 1  1 -1 1]\n"
                           "Shape \"bilinearmesh\" \"point3 P\" [-1 1 -1  1 1 -1  -1 1 1  1 1 1]\n"
                           "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 -1  -1 1 -1  -1 -1 1  -1 1 1]\n"
                           "Shape \"bilinearmesh\" \"point3 P\" [1 -1 -1  1 1 -1  1 -1 1  1 1 1]\n",
                           32);
    const vec3 low = {-1.0f, -1.0f, -1.0f}, high = {1.0f, 1.0f, 1.0f};
    double sum = 0.0;
    for (int axis = 0; axis < 3; axis++)
        for (int side = -1; side <= 1; side += 2) {
            vec3 a = low, b = high, inward = {0.0f, 0.0f, 0.0f};
            *(axis == 0 ? &a.x : axis == 1 ? &a.y : &a.z) = (float)side;
            *(axis == 0 ? &b.x : axis == 1 ? &b.y : &b.z) = (float)side;
            *(axis == 0 ? &inward.x : axis == 1 ? &inward.y : &inward.z) = (float)-side;
            sum += 4.0 * mean_importance(&pilot.onward, a, b, inward);
            assert_true(mean_importance(&pilot.onward, a, b, vec3_negate(inward)) < 0.002);
        }
    print_message("onward, over all walls: %.4f of 0.9922\n", sum);
    assert_relative(sum, 1.0 - 1.0 / 128.0, 0.04);
    eye_pilot_reset(&pilot);
    test_run_reset(&r);
}

/* A room around the camera with a window in the wall x = 1, on a ground of 24 x 24. */
#define ROOM                                                                                                           \
    "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n"                                                         \
    "Shape \"bilinearmesh\" \"point3 P\" [-12 -1.01 -12  12 -1.01 -12  -12 -1.01 12  12 -1.01 12]\n"                   \
    "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 -1  1 -1 -1  -1 1 -1  1 1 -1]\n"                                       \
    "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 1  1 -1 1  -1 1 1  1 1 1]\n"                                           \
    "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 -1  1 -1 -1  -1 -1 1  1 -1 1]\n"                                       \
    "Shape \"bilinearmesh\" \"point3 P\" [-1 1 -1  1 1 -1  -1 1 1  1 1 1]\n"                                           \
    "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 -1  -1 1 -1  -1 -1 1  -1 1 1]\n"                                       \
    "Shape \"bilinearmesh\" \"point3 P\" [1 -1 -1  1 -0.5 -1  1 -1 1  1 -0.5 1]\n"                                     \
    "Shape \"bilinearmesh\" \"point3 P\" [1 0.5 -1  1 1 -1  1 0.5 1  1 1 1]\n"                                         \
    "Shape \"bilinearmesh\" \"point3 P\" [1 -0.5 -1  1 0.5 -1  1 -0.5 -0.5  1 0.5 -0.5]\n"                             \
    "Shape \"bilinearmesh\" \"point3 P\" [1 -0.5 0.5  1 0.5 0.5  1 -0.5 1  1 0.5 1]\n"
#define WINDOW "Shape \"bilinearmesh\" \"point3 P\" [1 -0.5 -0.5  1 0.5 -0.5  1 -0.5 0.5  1 0.5 0.5]\n"

static const vec3 UP = {0.0f, 1.0f, 0.0f};
/* A square meter before the window, another one behind the house. */
static const vec3 BEFORE_LOW = {2.0f, -1.01f, -0.5f}, BEFORE_HIGH = {3.0f, -1.01f, 0.5f};
static const vec3 BEHIND_LOW = {-3.0f, -1.01f, -0.5f}, BEHIND_HIGH = {-2.0f, -1.01f, 0.5f};

static double share_before_window(test_run *r, const char *world)
{
    eye_pilot pilot = look(r, world, 32);
    double before = mean_importance(&pilot.onward, BEFORE_LOW, BEFORE_HIGH, UP);
    double behind = mean_importance(&pilot.onward, BEHIND_LOW, BEHIND_HIGH, UP);
    assert_true(behind < 0.05 * before); /* more than nothing: the ground there is seen by way of none but chance */
    eye_pilot_reset(&pilot);
    return before;
}

/* A pane lets through what thin glass does: some nine tenths. */
static void the_ground_before_a_window_sends_light_in(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 2);
    double open = share_before_window(&r, ROOM);
    double behind_pane = share_before_window(&r, ROOM "Material \"thindielectric\"\n" WINDOW);
    print_message("onward, before the window: %.5f, behind a pane %.5f\n", open, behind_pane);
    assert_true(open > 1e-3);
    assert_true(behind_pane > 0.7 * open && behind_pane < 1.05 * open);
    test_run_reset(&r);
}

/* Light that arrives on a curtain's outer side goes on inside; with another one before it, that of its inner side does
 * too. */
static void a_curtain_passes_light_on_from_its_outer_side(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 2);
    eye_pilot pilot = look(&r,
                           ROOM "Material \"diffusetransmission\" \"rgb reflectance\" [0 0 0] "
                                "\"rgb transmittance\" [0.8 0.8 0.8]\n" WINDOW,
                           32);
    const vec3 low = {1.0f, -0.5f, -0.5f}, high = {1.0f, 0.5f, 0.5f}, outward = {1.0f, 0.0f, 0.0f};
    double outer = mean_importance(&pilot.onward, low, high, outward);
    double inner = mean_importance(&pilot.onward, low, high, vec3_negate(outward));
    print_message("onward, on a curtain's outer side %.5f, on its inner side %.5f\n", outer, inner);
    assert_true(outer > 0.01 && inner < 0.1 * outer);
    eye_pilot_reset(&pilot);
    test_run_reset(&r);
}

/* Where the last photons that count are those of light that has not been scattered, none goes on. */
static void at_a_depth_of_two_no_light_goes_on(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 2);
    eye_pilot pilot = look(&r, ROOM, 2);
    assert_non_null(pilot.gathered.nodes);
    assert_null(pilot.onward.nodes);
    eye_pilot_reset(&pilot);
    test_run_reset(&r);
}

typedef struct spread {
    double mean, deviation; /* from seed to seed */
    double brightest;       /* photon of those that have been scattered, on average over the seeds */
} spread;

/* How a pilot helps photons beside the guide that trials teach. */
typedef enum pilot_help { HELP_NONE, HELP_SPLIT, HELP_SPLIT_AND_GUIDE } pilot_help;

/* How the flux of a map's photons inside of ROOM is spread. */
static spread spread_inside(test_run *r, const scene *s, eye_pilot *pilot, pilot_help help)
{
    double sum = 0.0, squares = 0.0, brightest = 0.0;
    for (int seed = 0; seed < SEEDS; seed++) {
        photon_tracing_settings settings = {.kind = PHOTON_GLOBAL,
                                            .wanted = PHOTONS,
                                            .max_scatterings = 30,
                                            .seed = (uint64_t)seed,
                                            .asked = &pilot->gathered,
                                            .onward = help != HELP_NONE ? &pilot->onward : NULL,
                                            .ways = help == HELP_SPLIT_AND_GUIDE ? &pilot->ways : NULL};
        photon_aim aim;
        photon_set set;
        double inside = 0.0, most = 0.0;
        const emission_starts none = {0}, *starts = help == HELP_SPLIT_AND_GUIDE ? &pilot->starts : &none;
        assert_int_equal(photon_aim_learn(s, &r->run, &settings, starts, 0.8f, &aim), AG_OK);
        photon_aim_apply(&aim, &settings);
        assert_int_equal(photon_tracing_run(s, &r->run, &settings, &set), AG_OK);
        for (uint32_t i = 0; i < set.count; i++) {
            const photon *p = &set.photons[i];
            vec3 at = photon_position(p);
            if (fmaxf(fmaxf(fabsf(at.x), fabsf(at.y)), fabsf(at.z)) > 1.001f ||
                vec3_dot(at, direction_decode(p->normal)) > 0.0f)
                continue;
            double flux = (double)flux_decode(p->flux).g / (double)set.emitted_paths;
            inside += flux;
            most = fmax(most, arrival_is_diffuse(p->direction) ? flux : 0.0);
        }
        brightest += most / SEEDS;
        sum += inside / SEEDS;
        squares += inside * inside / SEEDS;
        photon_set_reset(&set);
        photon_aim_reset(&aim);
    }
    return (spread){sum, sqrt((squares - sum * sum) * SEEDS / (SEEDS - 1)), brightest};
}

/* The flux inside is what it is without parts, within 3 sigma, and no photon of scattered light holds as much of it.
 * Where the pilot says how paths begin and go on, it differs less from seed to seed. */
static void bright_paths_are_split_and_led(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 2);
    scene *s = scene_of(&r, "LightSource \"infinite\" \"rgb L\" [1 1 1]\n" ROOM);
    eye_pilot pilot = look_at(&r, s, 32);
    spread whole = spread_inside(&r, s, &pilot, HELP_NONE), split = spread_inside(&r, s, &pilot, HELP_SPLIT);
    spread guided = spread_inside(&r, s, &pilot, HELP_SPLIT_AND_GUIDE);
    print_message(
        "flux inside: %.4f, deviation %.4f, brightest %.4f; split %.4f, %.4f, %.4f; guided %.4f, %.4f, %.4f\n",
        whole.mean, whole.deviation, whole.brightest, split.mean, split.deviation, split.brightest, guided.mean,
        guided.deviation, guided.brightest);
    assert_close(split.mean, whole.mean, 3.0 * hypot(whole.deviation, split.deviation) / sqrt(SEEDS));
    assert_close(guided.mean, split.mean, 4.0 * hypot(guided.deviation, split.deviation) / sqrt(SEEDS));
    assert_true(FEWER > 1 || split.brightest < 0.6 * whole.brightest);
    assert_true(FEWER > 1 || guided.deviation < 0.9 * split.deviation);
    eye_pilot_reset(&pilot);
    scene_destroy(s);
    test_run_reset(&r);
}

/* Returns how much of a view is enclosed, seen from the origin along z. */
static double enclosure(test_run *r, const char *world)
{
    scene *s = scene_of(r, world);
    double found;
    ag_render_settings settings = ag_default_render_settings();
    settings.width = settings.height = 64;
    assert_int_equal(eye_pilot_find_enclosure(s, &r->run, &settings, &found), AG_OK);
    scene_destroy(s);
    return found;
}

#define PLATE "Shape \"bilinearmesh\" \"point3 P\" [-9 -9 2  9 -9 2  -9 9 2  9 9 2]\n"

/* A plate in front of the camera and, far behind it, a disc whose radius is its distance, so that its form factor is a
 * half: of eight gather rays the square of the share that meets it is (1/2)^2 + 1/32 on average if they are
 * independent, and no less than (1/2)^2. */
static void a_view_is_enclosed_by_what_its_gather_rays_meet(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 2);
    assert_close(enclosure(&r, ROOM WINDOW), 1.0, 1e-9);
    assert_close(enclosure(&r, PLATE), 0.0, 1e-9);
    double half = enclosure(&r, PLATE "Translate 0 0 -1998 Shape \"disk\" \"float radius\" [2000]\n");
    print_message("enclosed: %.4f by a disc of form factor one half\n", half);
    assert_true(half > 0.5 && half < sqrt(0.25 + 1.0 / 32.0) + 0.005);
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_closed_box_has_its_series),
        cmocka_unit_test(the_ground_before_a_window_sends_light_in),
        cmocka_unit_test(a_curtain_passes_light_on_from_its_outer_side),
        cmocka_unit_test(bright_paths_are_split_and_led),
        cmocka_unit_test(at_a_depth_of_two_no_light_goes_on),
        cmocka_unit_test(a_view_is_enclosed_by_what_its_gather_rays_meet),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
