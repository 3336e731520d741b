/* test_photon_aim.c: photons aimed at the inside of a room with a small window under the sky: many more of them arrive
 * there, the light is that of the closed form, and all is the same for any number of threads. Where light comes in by
 * the ground before a window, paths are split there, and no few photons hold much of the light.
 * Threads: those of the tracing. */
#include "photon_aim.h"

#include "fixtures/test_scene.h"

/* A room of 2 x 2 x 2 on a ground of 8 x 8, with a window of 0.5 x 0.5 in its ceiling, under a sky of radiance 1. */
static const char *const ROOM =
    "%s\nMaterial \"diffuse\" \"rgb reflectance\" [0.5 0.4 0.3]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [-4 -4 -0.01  4 -4 -0.01  -4 4 -0.01  4 4 -0.01]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 0  1 -1 0  -1 1 0  1 1 0]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 0  1 -1 0  -1 -1 2  1 -1 2]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [-1 1 0  1 1 0  -1 1 2  1 1 2]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 0  -1 1 0  -1 -1 2  -1 1 2]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [1 -1 0  1 1 0  1 -1 2  1 1 2]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 2  1 -1 2  -1 -0.25 2  1 -0.25 2]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [-1 0.25 2  1 0.25 2  -1 1 2  1 1 2]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [-1 -0.25 2  -0.25 -0.25 2  -1 0.25 2  -0.25 0.25 2]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [0.25 -0.25 2  1 -0.25 2  0.25 0.25 2  1 0.25 2]\n";
static const char *const SKY = "LightSource \"infinite\" \"rgb L\" [1 1 1]";
static const double THROUGH_WINDOW = 3.14159265358979 * 0.5 * 0.5; /* W: pi radiance area */

enum { POINTS = 8000, PHOTONS = 100000, SEEDS = 8 };

/* The closed room of ROOM, on a ground of 16 x 16, with a window of 0.8 x 0.8 in the wall x = 1. */
static const char *const SIDE_ROOM =
    "%s\nMaterial \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [-8 -8 -0.01  8 -8 -0.01  -8 8 -0.01  8 8 -0.01]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 0  1 -1 0  -1 1 0  1 1 0]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 2  1 -1 2  -1 1 2  1 1 2]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 0  1 -1 0  -1 -1 2  1 -1 2]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [-1 1 0  1 1 0  -1 1 2  1 1 2]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 0  -1 1 0  -1 -1 2  -1 1 2]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [1 -1 0  1 1 0  1 -1 0.6  1 1 0.6]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [1 -1 1.4  1 1 1.4  1 -1 2  1 1 2]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [1 -1 0.6  1 -0.4 0.6  1 -1 1.4  1 -0.4 1.4]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [1 0.4 0.6  1 1 0.6  1 0.4 1.4  1 1 1.4]\n";

static scene *scene_of(test_run *r, const char *shapes, const char *lights)
{
    char text[4096];
    snprintf(text, sizeof text, shapes, lights);
    return test_scene_create(r, text);
}

static scene *room_scene(test_run *r, const char *lights) { return scene_of(r, ROOM, lights); }

/* Adds points on the floor and the walls of the room, on their inner sides. */
static void add_inside(query_point points[POINTS])
{
    rng random = test_random(6);
    for (int i = 0; i < POINTS; i++) {
        vec3 p = random_in_box(&random, (vec3){-1.0f, -1.0f, 0.0f}, (vec3){1.0f, 1.0f, 2.0f});
        vec3 n = {0.0f, 0.0f, 1.0f};
        switch (i % 5) {
        case 0: p.z = 0.0f; break;
        case 1: p.x = -1.0f, n = (vec3){1.0f, 0.0f, 0.0f}; break;
        case 2: p.x = 1.0f, n = (vec3){-1.0f, 0.0f, 0.0f}; break;
        case 3: p.y = -1.0f, n = (vec3){0.0f, 1.0f, 0.0f}; break;
        default: p.y = 1.0f, n = (vec3){0.0f, -1.0f, 0.0f}; break;
        }
        points[i] = (query_point){p, n};
    }
}

static importance_map ask_inside(void)
{
    query_point *points = malloc(POINTS * sizeof *points);
    importance_map importance;
    assert_non_null(points);
    add_inside(points);
    assert_int_equal(importance_map_create(points, POINTS, &importance), AG_OK);
    free(points);
    return importance;
}

/* An importance map by which about half of the light goes on to the inside of SIDE_ROOM, and a fortieth by its window:
 * points lie inside, and where rays that leave by the window meet the ground. */
static importance_map pass_to_inside(void)
{
    enum { OUTSIDE = POINTS / 20, WHOLE = 2 * POINTS };
    query_point *points = malloc((POINTS + OUTSIDE) * sizeof *points);
    importance_map importance;
    uint32_t count = POINTS;
    assert_non_null(points);
    add_inside(points);
    rng random = test_random(9);
    while (count < POINTS + OUTSIDE) {
        vec3 from = random_in_box(&random, (vec3){-1.0f, -1.0f, 0.0f}, (vec3){-0.5f, 1.0f, 2.0f});
        vec3 by = random_in_box(&random, (vec3){1.0f, -0.4f, 0.6f}, (vec3){1.0f, 0.4f, 1.4f});
        vec3 way = vec3_sub(by, from);
        vec3 at = vec3_add(from, vec3_scale(way, from.z / fmaxf(-way.z, 1e-6f)));
        if (at.x < 8.0f && fabsf(at.y) < 8.0f)
            points[count++] = (query_point){{at.x, at.y, -0.01f}, {0.0f, 0.0f, 1.0f}};
    }
    vec3 low = {-12.0f, -12.0f, -12.0f}, high = {12.0f, 12.0f, 12.0f};
    assert_int_equal(importance_map_create_smooth(points, count, WHOLE, low, high, &importance), AG_OK);
    free(points);
    return importance;
}

static bool is_inside(const photon *p)
{
    vec3 at = photon_position(p);
    vec3 to_middle = vec3_sub((vec3){0.0f, 0.0f, 1.0f}, at);
    return fabsf(to_middle.x) < 1.001f && fabsf(to_middle.y) < 1.001f && fabsf(to_middle.z) < 1.001f &&
           vec3_dot(to_middle, direction_decode(p->normal)) > 0.0f;
}

/* How photons are traced; without importance they begin by power alone. */
typedef struct photon_order {
    photon_kind kind;
    const importance_map *asked, *onward;
    bool stay_whole;     /* paths are not split */
    bool all_are_stored; /* not a share of the photons */
} photon_order;

static photon_set trace(test_run *r, const scene *s, photon_order order, uint64_t seed)
{
    photon_tracing_settings settings = {
        .kind = order.kind, .wanted = PHOTONS / FEWER, .max_scatterings = 100, .seed = seed, .progress_end = 1.0};
    photon_aim aim = {0};
    photon_set set;
    if (order.asked) {
        settings.asked = order.asked;
        settings.onward = order.onward;
        assert_int_equal(photon_aim_learn(s, &r->run, &settings, &(emission_starts){0}, 0.8f, &aim), AG_OK);
        assert_true(FEWER > 1 || aim.guide.nodes); /* fewer trials may not find a window */
        assert_true(aim.tried.paths > 0 && aim.tried.rays >= aim.tried.paths / 2 &&
                    aim.tried.photons >= aim.tried.asked && aim.tried.asked > 0);
        assert_true(aim.stored_share >= 0.25f && aim.stored_share <= 1.0f);
        bool may_split = order.onward || order.kind == PHOTON_CAUSTIC;
        assert_true(may_split && aim.guide.nodes ? aim.split_above > 0.0f : aim.split_above == 0.0f);
        photon_aim_apply(&aim, &settings);
        if (order.stay_whole)
            settings.split_above = 0.0f;
        if (order.all_are_stored)
            settings.stored_share = 1.0f;
    }
    assert_int_equal(photon_tracing_run(s, &r->run, &settings, &set), AG_OK);
    photon_aim_reset(&aim);
    return set;
}

typedef struct result {
    double share;   /* of the photons, that lie inside */
    double squares; /* of the fluxes inside, over the square of their sum: 1 over how many alike would vary so much */
    double direct, direct_error, all, all_error;
} result;

static result trace_seeds(test_run *r, const scene *s, photon_order order)
{
    result sum = {0};
    double direct_squared = 0.0, all_squared = 0.0;
    for (int seed = 0; seed < SEEDS; seed++) {
        photon_set set = trace(r, s, order, (uint64_t)seed);
        double direct = 0.0, all = 0.0, squares = 0.0;
        for (uint32_t i = 0; i < set.count; i++) {
            if (!is_inside(&set.photons[i]))
                continue;
            double flux = (double)flux_decode(set.photons[i].flux).g / (double)set.emitted_paths;
            sum.share += 1.0 / set.count / SEEDS;
            all += flux;
            squares += flux * flux;
            direct += arrival_is_diffuse(set.photons[i].direction) ? 0.0 : flux;
        }
        sum.squares += squares / (all * all) / SEEDS;
        const energy_balance *b = &set.balance;
        for (int c = 0; c < 3; c++) {
            assert_relative(b->stored[c] + b->cut[c] + b->thinned[c], b->arrived[c], 1e-3 * WIDER);
            assert_relative(b->absorbed[c] + b->escaped[c] + b->lost[c] + b->truncated[c], b->emitted[c] + b->gained[c],
                            1e-6);
        }
        sum.direct += direct / SEEDS, direct_squared += direct * direct / SEEDS;
        sum.all += all / SEEDS, all_squared += all * all / SEEDS;
        photon_set_reset(&set);
    }
    sum.direct_error = sqrt((direct_squared - sum.direct * sum.direct) / (SEEDS - 1));
    sum.all_error = sqrt((all_squared - sum.all * sum.all) / (SEEDS - 1));
    return sum;
}

/* A scene in which the inside of the room is asked for. */
typedef struct asked_room {
    test_run run;
    scene *s;
    importance_map asked;
} asked_room;

static void open_room(asked_room *room, const char *shapes)
{
    test_run_init(&room->run, 2);
    room->s = scene_of(&room->run, shapes, SKY);
    room->asked = ask_inside();
}

static void close_room(asked_room *room)
{
    importance_map_reset(&room->asked);
    scene_destroy(room->s);
    test_run_reset(&room->run);
}

/* Straight through the window comes pi radiance area, aimed or not; by way of walls and ground both say the same, and
 * all within 3 sigma. */
static void a_small_window_is_found_and_its_light_is_right(void **state)
{
    (void)state;
    if (IS_SANITIZED)
        skip(); /* statistics of what any_number_of_threads_has_the_same_photons runs */
    asked_room room;
    open_room(&room, ROOM);
    photon_order by_power = {0}, by_aim = {.asked = &room.asked};
    result plain = trace_seeds(&room.run, room.s, by_power), aimed = trace_seeds(&room.run, room.s, by_aim);
    print_message("inside: share %.4f plain, %.4f aimed; direct %.4f +- %.4f, %.4f +- %.4f of %.4f; all %.4f +- %.4f, "
                  "%.4f +- %.4f\n",
                  plain.share, aimed.share, plain.direct, plain.direct_error, aimed.direct, aimed.direct_error,
                  THROUGH_WINDOW, plain.all, plain.all_error, aimed.all, aimed.all_error);
    assert_close(plain.direct, THROUGH_WINDOW, 3.0 * plain.direct_error);
    assert_close(aimed.direct, THROUGH_WINDOW, 3.0 * aimed.direct_error);
    assert_close(aimed.all, plain.all, 3.0 * hypot(aimed.all_error, plain.all_error));
    assert_true(aimed.share > 10.0 * plain.share);
    close_room(&room);
}

/* The room in a landscape thirty times as large, where light from afar that were spread evenly would meet the window
 * once in 10^5 paths: it is densest around what is asked for, so the room's light is well known. */
static void a_room_in_a_landscape_is_found(void **state)
{
    (void)state;
    if (IS_SANITIZED)
        skip(); /* statistics of what any_number_of_threads_has_the_same_photons runs */
    asked_room room;
    char shapes[4096];
    snprintf(shapes, sizeof shapes, "%sTranslate 20 30 -0.02 Shape \"disk\" \"float radius\" [60]\n", ROOM);
    open_room(&room, shapes);
    assert_true(room.s->detail_radius == 0.0f);
    result aimed = trace_seeds(&room.run, room.s, (photon_order){.asked = &room.asked});
    print_message("inside: share %.4f, direct %.4f +- %.4f of %.4f, all %.4f +- %.4f\n", aimed.share, aimed.direct,
                  aimed.direct_error, THROUGH_WINDOW, aimed.all, aimed.all_error);
    assert_close(aimed.direct, THROUGH_WINDOW, 3.0 * aimed.direct_error);
    assert_true(aimed.direct_error < 0.015 * THROUGH_WINDOW);
    close_room(&room);
}

static void no_photon_is_more_than_five_times_as_bright(void **state)
{
    (void)state;
    asked_room room;
    open_room(&room, ROOM);
    photon_order by_power = {0}, by_aim = {.asked = &room.asked, .all_are_stored = true};
    photon_set plain = trace(&room.run, room.s, by_power, 1), aimed = trace(&room.run, room.s, by_aim, 1);
    float most_plain = 0.0f, most_aimed = 0.0f;
    for (uint32_t i = 0; i < plain.count; i++)
        most_plain = fmaxf(most_plain, rgb_max(flux_decode(plain.photons[i].flux)));
    for (uint32_t i = 0; i < aimed.count; i++)
        most_aimed = fmaxf(most_aimed, rgb_max(flux_decode(aimed.photons[i].flux)));
    assert_true(most_aimed <= 5.02f * most_plain);
    photon_set_reset(&plain);
    photon_set_reset(&aimed);
    close_room(&room);
}

/* Aimed and split paths bring as much light inside as paths by power alone, within 3 sigma; with split paths fewer
 * photons hold less of it. */
static void paths_are_split_where_their_light_comes_in(void **state)
{
    (void)state;
    if (IS_SANITIZED)
        skip(); /* statistics of what any_number_of_threads_has_the_same_photons runs */
    asked_room room;
    open_room(&room, SIDE_ROOM);
    importance_map onward = pass_to_inside();
    photon_order by_power = {0}, by_aim = {.asked = &room.asked};
    result plain = trace_seeds(&room.run, room.s, by_power), aimed = trace_seeds(&room.run, room.s, by_aim);
    result split = trace_seeds(&room.run, room.s, (photon_order){.asked = &room.asked, .onward = &onward});
    print_message("inside: all %.4f +- %.4f plain, %.4f +- %.4f aimed, %.4f +- %.4f split; squares %.3g, %.3g, %.3g\n",
                  plain.all, plain.all_error, aimed.all, aimed.all_error, split.all, split.all_error, plain.squares,
                  aimed.squares, split.squares);
    assert_close(split.all, plain.all, 3.0 * hypot(split.all_error, plain.all_error));
    assert_close(split.all, aimed.all, 3.0 * hypot(split.all_error, aimed.all_error));
    assert_true(split.squares < 0.8 * aimed.squares);
    importance_map_reset(&onward);
    close_room(&room);
}

/* SIDE_ROOM with brushed metal: a tray below the window, and a ledge on the ground outside. */
static void add_metal(char *out_shapes, size_t size)
{
    snprintf(out_shapes, size,
             "%sMaterial \"conductor\" \"float roughness\" 0.3 \"bool remaproughness\" false\n"
             "Shape \"bilinearmesh\" \"point3 P\" [-0.9 -0.4 0.5  -0.1 -0.4 0.5  -0.9 0.4 0.5  -0.1 0.4 0.5]\n"
             "Shape \"bilinearmesh\" \"point3 P\" [1.2 -2 0.02  3 -2 0.02  1.2 2 0.02  3 2 0.02]\n",
             SIDE_ROOM);
}

/* Caustics of that metal: as bright as by power alone, within 3 sigma, and with parts fewer photons hold less of the
 * light. */
static void caustics_are_split_by_rough_metal(void **state)
{
    (void)state;
    if (IS_SANITIZED)
        skip(); /* statistics of what any_number_of_threads_has_the_same_photons runs */
    asked_room room;
    char shapes[4096];
    add_metal(shapes, sizeof shapes);
    open_room(&room, shapes);
    photon_order order = {.kind = PHOTON_CAUSTIC};
    result plain = trace_seeds(&room.run, room.s, order);
    order.asked = &room.asked;
    result split = trace_seeds(&room.run, room.s, order);
    order.stay_whole = true;
    result aimed = trace_seeds(&room.run, room.s, order);
    print_message("inside: all %.5f +- %.5f plain, %.5f +- %.5f aimed, %.5f +- %.5f split; squares %.3g, %.3g, %.3g\n",
                  plain.all, plain.all_error, aimed.all, aimed.all_error, split.all, split.all_error, plain.squares,
                  aimed.squares, split.squares);
    assert_close(split.all, plain.all, 3.0 * hypot(split.all_error, plain.all_error));
    assert_close(split.all, aimed.all, 3.0 * hypot(split.all_error, aimed.all_error));
    assert_true(split.squares < 0.8 * aimed.squares);
    close_room(&room);
}

static void expect_same_for_any_threads(const char *shapes, photon_order order)
{
    photon_set first = {0};
    for (unsigned threads = 1; threads <= 3; threads++) {
        test_run r;
        test_run_init(&r, threads);
        scene *s = scene_of(&r, shapes, SKY);
        photon_set set = trace(&r, s, order, 7);
        assert_true(set.parts > 0);
        if (threads == 1) {
            first = set;
        } else {
            assert_int_equal(set.count, first.count);
            assert_int_equal(set.emitted_paths, first.emitted_paths);
            assert_memory_equal(set.photons, first.photons, set.count * sizeof *set.photons);
            photon_set_reset(&set);
        }
        scene_destroy(s);
        test_run_reset(&r);
    }
    photon_set_reset(&first);
}

static void any_number_of_threads_has_the_same_photons(void **state)
{
    (void)state;
    char shapes[4096];
    importance_map asked = ask_inside(), onward = pass_to_inside();
    expect_same_for_any_threads(SIDE_ROOM, (photon_order){.asked = &asked, .onward = &onward});
    add_metal(shapes, sizeof shapes);
    expect_same_for_any_threads(shapes, (photon_order){.kind = PHOTON_CAUSTIC, .asked = &asked});
    importance_map_reset(&onward);
    importance_map_reset(&asked);
}

static void expect_no_guide(const scene *s, test_run *r, photon_kind kind, const importance_map *asked)
{
    photon_tracing_settings settings = {.kind = kind, .wanted = 1000, .max_scatterings = 100, .asked = asked};
    photon_aim aim;
    assert_int_equal(photon_aim_learn(s, &r->run, &settings, &(emission_starts){0}, 0.8f, &aim), AG_OK);
    assert_null(aim.guide.nodes);
}

/* Nothing asked for, asked for where no light comes, no lamp, nothing to be met, no traced lobes. */
static void where_there_is_nothing_to_aim_at_power_decides(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 2);
    importance_map inside = ask_inside(), nothing = {0}, elsewhere;
    const query_point far_away = {{0.0f, 0.0f, 500.0f}, {0.0f, 0.0f, 1.0f}};
    assert_int_equal(importance_map_create(&far_away, 1, &elsewhere), AG_OK);
    scene *s = room_scene(&r, SKY);
    expect_no_guide(s, &r, PHOTON_GLOBAL, &nothing);
    expect_no_guide(s, &r, PHOTON_GLOBAL, &elsewhere);
    expect_no_guide(s, &r, PHOTON_CAUSTIC, &inside);
    scene_destroy(s);
    s = room_scene(&r, "");
    expect_no_guide(s, &r, PHOTON_GLOBAL, &inside);
    scene_destroy(s);
    s = test_scene_create(&r, SKY);
    expect_no_guide(s, &r, PHOTON_GLOBAL, &inside);
    scene_destroy(s);
    s = test_scene_create(&r, "LightSource \"point\" \"rgb I\" [1 1 1]");
    expect_no_guide(s, &r, PHOTON_GLOBAL, &inside);
    scene_destroy(s);
    importance_map_reset(&inside);
    importance_map_reset(&elsewhere);
    test_run_reset(&r);
}

static scene *lit_sphere(test_run *r)
{
    return test_scene_create(r, "LightSource \"point\" \"rgb I\" [1 1 1]\nMaterial \"diffuse\"\n"
                                "Shape \"sphere\" \"float radius\" [1]");
}

/* Light is asked for on the inside of a sphere of radius 1: this share of the points lies above z = 0.95, the others
 * anywhere. */
static importance_map ask_in_sphere(float share_above)
{
    query_point *points = malloc(POINTS * sizeof *points);
    importance_map asked;
    assert_non_null(points);
    rng random = test_random(8);
    for (int i = 0; i < POINTS; i++) {
        vec3 d = random_direction(&random);
        while ((float)i < share_above * (float)POINTS && d.z < 0.95f)
            d = random_direction(&random);
        points[i] = (query_point){d, vec3_negate(d)};
    }
    assert_int_equal(importance_map_create(points, POINTS, &asked), AG_OK);
    free(points);
    return asked;
}

/* In a closed room with all of it asked for alike a guide would gain nothing: there is none. */
static void a_room_that_is_lit_from_within_needs_no_aim(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 2);
    scene *s = lit_sphere(&r);
    importance_map asked = ask_in_sphere(0.0f);
    expect_no_guide(s, &r, PHOTON_GLOBAL, &asked);
    importance_map_reset(&asked);
    scene_destroy(s);
    test_run_reset(&r);
}

/* All photons land where somebody asks for light, most of them where hardly anybody does: they are aimed. */
static void photons_of_little_use_are_aimed(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 2);
    scene *s = lit_sphere(&r);
    importance_map asked = ask_in_sphere(0.95f);
    photon_tracing_settings settings = {
        .kind = PHOTON_GLOBAL, .wanted = PHOTONS, .max_scatterings = 100, .asked = &asked};
    photon_aim aim;
    assert_int_equal(photon_aim_learn(s, &r.run, &settings, &(emission_starts){0}, 0.8f, &aim), AG_OK);
    assert_non_null(aim.guide.nodes);
    assert_true((double)aim.tried.asked > 0.9 * (double)aim.tried.photons);
    photon_aim_reset(&aim);
    importance_map_reset(&asked);
    scene_destroy(s);
    test_run_reset(&r);
}

/* As many photons are stored where a share of them is, by as many more paths. */
static void a_share_of_the_photons_is_of_more_paths(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 2);
    scene *s = lit_sphere(&r);
    importance_map asked = ask_in_sphere(0.95f);
    photon_order order = {.asked = &asked};
    photon_set share = trace(&r, s, order, 1);
    order.all_are_stored = true;
    photon_set all = trace(&r, s, order, 1);
    double more = (double)share.emitted_paths / (double)all.emitted_paths;
    print_message("%.2f times the paths\n", more);
    assert_int_equal(share.count, all.count);
    assert_true(more > 3.8 && more < 4.2);
    photon_set_reset(&share);
    photon_set_reset(&all);
    importance_map_reset(&asked);
    scene_destroy(s);
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_small_window_is_found_and_its_light_is_right),
        cmocka_unit_test(a_room_in_a_landscape_is_found),
        cmocka_unit_test(no_photon_is_more_than_five_times_as_bright),
        cmocka_unit_test(paths_are_split_where_their_light_comes_in),
        cmocka_unit_test(caustics_are_split_by_rough_metal),
        cmocka_unit_test(any_number_of_threads_has_the_same_photons),
        cmocka_unit_test(where_there_is_nothing_to_aim_at_power_decides),
        cmocka_unit_test(a_room_that_is_lit_from_within_needs_no_aim),
        cmocka_unit_test(photons_of_little_use_are_aimed),
        cmocka_unit_test(a_share_of_the_photons_is_of_more_paths),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
