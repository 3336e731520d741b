/* test_strong_photons.c: a caustic photon that is far stronger than the others is divided into parts, which lie on its
 * surface, bring its flux, and are seen as no spot. Threads: one at a time. */
#include "caustic_radius.h"
#include "fixtures/served_points.h"
#include "strong_photons.h"

/* The photons of a case are weak, of one watt, but for one that is STRENGTH times as strong. */
enum { WEAK = 8000, STRENGTH = 200 };
static const float RADIUS = 0.05f;
static const double FLUX_ERROR = 0.01; /* by the rounding of parts' flux */
static const rgb COLOR = {1.0f, 0.5f, 0.0f};

/* A square of two units' side, and what stands on it. */
#define FLOOR "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 0  1 -1 0  -1 1 0  1 1 0]\n"

static void add_photon(photon_set *set, vec3 position, vec3 normal, float flux)
{
    photon *p = &set->photons[set->count++];
    memset(p, 0, sizeof *p);
    photon_set_position(p, position);
    p->normal = direction_encode(normal);
    p->direction = arrival_encode(vec3_negate(normal), false);
    p->flux = flux_encode(rgb_scale(COLOR, flux), set->count);
}

/* Weak photons lie evenly on the square. strength: of the one that comes after them; 0: none does. */
static photon_set draw_set(int weak, vec3 strong_at, vec3 strong_normal, float strength)
{
    photon_set set = {.emitted_paths = 1, .photons = photon_records_create((uint32_t)weak + 1)};
    assert_non_null(set.photons);
    rng random = test_random(7);
    for (int i = 0; i < weak; i++) {
        vec2 u = rng_vec2(&random);
        add_photon(&set, (vec3){2.0f * u.x - 1.0f, 2.0f * u.y - 1.0f, 0.0f}, (vec3){0.0f, 0.0f, 1.0f}, 1.0f);
    }
    if (strength > 0.0f)
        add_photon(&set, strong_at, strong_normal, strength);
    return set;
}

/* Of the first channel, which is the strongest. */
static double flux_of(const photon_set *set)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < set->count; i++)
        sum += (double)flux_decode(set->photons[i].flux).r;
    return sum;
}

/* How far the parts lie from the strong photon, as strong_photons.h has it. */
static float reach_of(double each) { return RADIUS * (float)sqrt(STRENGTH / (each * STRONG_PHOTON_RATIO)); }

/* Divides the strong photon of a set, whose flux, colour and direction its parts keep, and which leaves the others as
 * they were. Returns the mean flux, weighted by flux, of before. */
static double divide(const test_run *r, const scene *s, photon_set *set)
{
    double each = caustic_flux_each(set), before = flux_of(set);
    const photon_set others = draw_set(WEAK, (vec3){0.0f, 0.0f, 0.0f}, (vec3){0.0f, 0.0f, 1.0f}, 0.0f);
    const uint16_t direction = set->photons[WEAK].direction;
    uint32_t parts = (uint32_t)ceil((double)flux_largest(set->photons[WEAK].flux) / each);
    assert_true(parts > STRONG_PHOTON_RATIO);
    assert_int_equal(strong_photons_divide(s, &r->run, RADIUS, set), AG_OK);
    assert_in_range(set->count, WEAK + 1, WEAK + parts);
    assert_true(fabs(flux_of(set) - before) < FLUX_ERROR * STRENGTH);
    assert_memory_equal(set->photons, others.photons, WEAK * sizeof *others.photons);
    for (uint32_t i = WEAK; i < set->count; i++) {
        rgb flux = flux_decode(set->photons[i].flux);
        assert_int_equal(set->photons[i].direction, direction);
        assert_true(fabsf(flux.g - 0.5f * flux.r) < 0.02f * flux.r && flux.b == 0.0f);
    }
    free(others.photons);
    return each;
}

static double seen_at(const photon_map *map, vec3 at, photon_neighbor *scratch)
{
    uint64_t rays = 0;
    return (double)irradiance_estimate_seen(map, at, (vec3){0.0f, 0.0f, 1.0f}, caustic_least_area(map), scratch, &rays)
        .r;
}

/* What is seen at points of the square, as far out as `half` along x and y: their mean, and the largest. */
static double see(test_run *r, const scene *s, float radius, float half, photon_set *set, double *out_largest)
{
    enum { SIDE = 120 };
    photon_map map;
    served_case c = {.radius = radius};
    photon_neighbor *scratch = make_seen_map(r, s, &c, set, &map);
    double sum = 0.0;
    *out_largest = 0.0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        float x = (2.0f * (float)(i % SIDE) + 1.0f) / SIDE - 1.0f, y = (2.0f * (float)(i / SIDE) + 1.0f) / SIDE - 1.0f;
        double seen = seen_at(&map, (vec3){half * x, half * y, 0.0f}, scratch);
        sum += seen;
        *out_largest = fmax(*out_largest, seen);
    }
    free(scratch);
    photon_map_reset(&map);
    return sum / (SIDE * SIDE);
}

/* On an open floor the parts lie evenly around the photon. What is seen has the light that the strong photon added, and
 * none of the spot: without parts that is as bright as STRENGTH photons on the largest disc. */
static void a_spot_becomes_a_blur(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, FLOOR);
    const vec3 at = {0.1f, -0.05f, 0.0f}, up = {0.0f, 0.0f, 1.0f};
    photon_set set = draw_set(WEAK, at, up, STRENGTH);
    double each = divide(&r, s, &set);
    float reach = reach_of(each), farthest = 0.0f, middle_x = 0.0f, middle_y = 0.0f;
    uint32_t parts = set.count - WEAK, near = 0;
    for (uint32_t i = WEAK; i < set.count; i++) {
        vec3 p = photon_position(&set.photons[i]);
        float distance = sqrtf(vec3_distance_squared(p, at));
        farthest = fmaxf(farthest, distance);
        near += distance < 0.5f * reach;
        middle_x += p.x / (float)parts, middle_y += p.y / (float)parts;
        assert_float_equal(p.z, 0.0f, 1e-5f);
        assert_true(flux_largest(set.photons[i].flux) < 1.1f * (float)each);
    }
    assert_true(farthest <= reach * 1.001f && farthest > 0.9f * reach);
    assert_in_range(near, parts / 4 - 1, parts / 4 + 1);
    assert_float_equal(middle_x, at.x, 0.05f * reach);
    assert_float_equal(middle_y, at.y, 0.05f * reach);

    photon_set whole = draw_set(WEAK, at, up, STRENGTH), none = draw_set(WEAK, at, up, 0.0f);
    double largest_whole, largest_parts, largest_none;
    double with_whole = see(&r, s, RADIUS, 0.5f, &whole, &largest_whole);
    double with_parts = see(&r, s, RADIUS, 0.5f, &set, &largest_parts);
    double with_none = see(&r, s, RADIUS, 0.5f, &none, &largest_none);
    double of_ratio = STRONG_PHOTON_RATIO * each / (PI * (double)RADIUS * (double)RADIUS);
    print_message("mean %g whole, %g in parts, %g without; largest %g, %g, %g; %d photons' worth is %g\n", with_whole,
                  with_parts, with_none, largest_whole, largest_parts, largest_none, STRONG_PHOTON_RATIO, of_ratio);
    /* a unit of area is looked at */
    assert_true(fabs(with_parts - with_none - STRENGTH) < 0.02 * STRENGTH);
    assert_true(largest_whole > 8.0 * of_ratio);
    assert_true(largest_parts < largest_none + 1.5 * of_ratio);
    scene_destroy(s);
    test_run_reset(&r);
}

/* The light of strong photons that lie evenly beside a floor's edge is seen whole, though photons are sparse and many
 * places of parts lie beyond the edge: if those parts stayed apart, at one place, they would be taken for a brighter
 * rim, and left out around it. */
static void the_light_of_all_places_is_seen(void **state)
{
    (void)state;
    enum { SETS = 100, FEW = 2000, STRENGTH_OF_FEW = 45 };
    const float radius = 0.06f;
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, FLOOR);
    rng random = test_random(3);
    double sum = 0.0, squares = 0.0, largest;
    photon_set others = draw_set(FEW, (vec3){0.0f, 0.0f, 0.0f}, (vec3){0.0f, 0.0f, 1.0f}, 0.0f);
    double of_others = 4.0 * see(&r, s, radius, 1.0f, &others, &largest);
    for (int i = 0; i < SETS; i++) {
        vec2 u = rng_vec2(&random);
        vec3 at = {1.0f - 0.3f * u.x, 2.0f * u.y - 1.0f, 0.0f};
        photon_set set = draw_set(FEW, at, (vec3){0.0f, 0.0f, 1.0f}, STRENGTH_OF_FEW);
        assert_int_equal(strong_photons_divide(s, &r.run, radius, &set), AG_OK);
        assert_true(set.count > FEW + 1);
        double seen = (4.0 * see(&r, s, radius, 1.0f, &set, &largest) - of_others) / STRENGTH_OF_FEW;
        sum += seen, squares += seen * seen;
    }
    double mean = sum / SETS, sigma = sqrt((squares / SETS - mean * mean) / (SETS - 1));
    print_message("%.4f +- %.4f of the strong photons' flux is seen\n", mean, sigma);
    assert_true(fabs(mean - 1.0) < 0.005 + 3.0 * sigma && sigma < 0.005);
    scene_destroy(s);
    test_run_reset(&r);
}

/* A strong photon somewhere, and where its parts may lie. */
typedef struct ground_case {
    const char *name, *world;
    vec3 at, normal;
    float least_spread, most_spread; /* bounds of the share of the flux that lies elsewhere than the photon did */
    bool (*is_on)(vec3 position, vec3 normal);
} ground_case;

static bool is_on_floor(vec3 p, vec3 n)
{
    return fabsf(p.z) < 1e-5f && n.z > 0.99f && fabsf(p.x) <= 1.0f && fabsf(p.y) <= 1.0f;
}

/* The part of the floor on which the photon was. */
static bool is_on_floor_before_wall(vec3 p, vec3 n) { return is_on_floor(p, n) && p.x <= 0.0f; }

static bool is_on_upper_step(vec3 p, vec3 n) { return is_on_floor(p, n) && p.x <= 0.05f; }

static bool is_on_board(vec3 p, vec3 n) { return fabsf(p.z - 0.1f) < 1e-5f && n.z > 0.99f && fabsf(p.x) <= 0.1f; }

static bool is_on_ball(vec3 p, vec3 n)
{
    return fabsf(vec3_length(p) - 0.5f) < 1e-4f && vec3_dot(n, vec3_normalize(p)) > 0.99f;
}

static bool is_in_ball(vec3 p, vec3 n) { return is_on_ball(p, vec3_negate(n)); }

static bool is_under_floor(vec3 p, vec3 n) { return is_on_floor(p, vec3_negate(n)); }

static void parts_stay_on_their_surface(void **state)
{
    (void)state;
    static const ground_case CASES[] = {
        {"a floor's edge", FLOOR, {0.99f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f}, 1.0f, 1.0f, is_on_floor},
        {"the side below", FLOOR, {0.2f, 0.0f, 0.0f}, {0.0f, 0.0f, -1.0f}, 1.0f, 1.0f, is_under_floor},
        {"before a wall",
         FLOOR "Shape \"bilinearmesh\" \"point3 P\" [0 -1 0  0 1 0  0 -1 1  0 1 1]\n",
         {-0.02f, 0.0f, 0.0f},
         {0.0f, 0.0f, 1.0f},
         1.0f,
         1.0f,
         is_on_floor_before_wall},
        {"beside a step of the same mesh",
         "Shape \"trianglemesh\" \"point3 P\" [-1 -1 0  0.05 -1 0  0.05 1 0  -1 1 0  0.05 -1 -0.1  1 -1 -0.1  1 1 -0.1 "
         " 0.05 1 -0.1] \"integer indices\" [0 1 2  0 2 3  4 5 6  4 6 7  4 7 2  4 2 1]\n",
         {0.0f, 0.0f, 0.0f},
         {0.0f, 0.0f, 1.0f},
         1.0f,
         1.0f,
         is_on_upper_step},
        {"under a pane",
         "AttributeBegin Material \"dielectric\" Shape \"bilinearmesh\" \"point3 P\" [-1 -1 5e-4  1 -1 5e-4  -1 1 5e-4 "
         " 1 1 5e-4] AttributeEnd\n" FLOOR,
         {0.1f, 0.1f, 0.0f},
         {0.0f, 0.0f, 1.0f},
         1.0f,
         1.0f,
         is_on_floor},
        {"a board above the floor",
         "Shape \"bilinearmesh\" \"point3 P\" [-0.1 -1 0.1  0.1 -1 0.1  -0.1 1 0.1  0.1 1 0.1]\n" FLOOR,
         {0.0f, 0.0f, 0.1f},
         {0.0f, 0.0f, 1.0f},
         0.7f,
         0.9f,
         is_on_board},
        {"below a board",
         FLOOR "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 0.02  1 -1 0.02  -1 1 0.02  1 1 0.02]\n",
         {0.1f, 0.1f, 0.0f},
         {0.0f, 0.0f, 1.0f},
         1.0f,
         1.0f,
         is_on_floor},
        {"a ball",
         "Shape \"sphere\" \"float radius\" 0.5\n",
         {0.0f, 0.5f, 0.0f},
         {0.0f, 1.0f, 0.0f},
         0.9f,
         1.0f,
         is_on_ball},
        {"in a ball",
         "Shape \"sphere\" \"float radius\" 0.5\n",
         {0.0f, 0.5f, 0.0f},
         {0.0f, -1.0f, 0.0f},
         0.9f,
         1.0f,
         is_in_ball},
        {"nothing there", FLOOR, {0.0f, 0.0f, 0.5f}, {0.0f, 0.0f, 1.0f}, 0.0f, 0.0f, NULL},
    };
    test_run r;
    test_run_init(&r, 1);
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        const ground_case *c = &CASES[i];
        scene *s = test_scene_create(&r, c->world);
        photon_set set = draw_set(WEAK, c->at, c->normal, STRENGTH);
        divide(&r, s, &set);
        double staying = 0.0;
        uint32_t off = 0, together = 0;
        for (uint32_t k = WEAK; k < set.count; k++) {
            vec3 p = photon_position(&set.photons[k]);
            bool stays = vec3_distance_squared(p, c->at) == 0.0f;
            together += stays;
            staying += stays ? (double)flux_decode(set.photons[k].flux).r : 0.0;
            off += !stays && (!c->is_on || !c->is_on(p, direction_decode(set.photons[k].normal)));
        }
        float spread = 1.0f - (float)(staying / STRENGTH);
        print_message("%s: %.2f of the flux lies elsewhere, %u parts of it off the surface\n", c->name, (double)spread,
                      off);
        assert_true(together <= 1);
        assert_int_equal(off, 0);
        assert_true(spread >= c->least_spread && spread <= c->most_spread);
        photon_set_reset(&set);
        scene_destroy(s);
    }
    test_run_reset(&r);
}

/* Photons that are alike, or up to STRONG_PHOTON_RATIO times the mean, keep all their bits. */
static void others_are_left_alone(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, FLOOR);
    const vec3 at = {0.0f, 0.0f, 0.0f}, up = {0.0f, 0.0f, 1.0f};
    static const float STRENGTHS[] = {0.0f, 1.0f, STRONG_PHOTON_RATIO};
    for (size_t i = 0; i < sizeof STRENGTHS / sizeof *STRENGTHS; i++) {
        photon_set set = draw_set(WEAK, at, up, STRENGTHS[i]), before = draw_set(WEAK, at, up, STRENGTHS[i]);
        assert_int_equal(strong_photons_divide(s, &r.run, RADIUS, &set), AG_OK);
        assert_int_equal(set.count, before.count);
        assert_memory_equal(set.photons, before.photons, set.count * sizeof *set.photons);
        photon_set_reset(&set);
        photon_set_reset(&before);
    }
    photon_set empty = {.emitted_paths = 1};
    assert_int_equal(strong_photons_divide(s, &r.run, RADIUS, &empty), AG_OK);
    assert_int_equal(empty.count, 0);
    scene_destroy(s);
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_spot_becomes_a_blur),
        cmocka_unit_test(the_light_of_all_places_is_seen),
        cmocka_unit_test(parts_stay_on_their_surface),
        cmocka_unit_test(others_are_left_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
