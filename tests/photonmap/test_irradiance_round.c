/* test_irradiance_round.c: estimates that are seen directly on rods and balls, thinner and thicker than the largest
 * disc, have the flux of a beam that falls there. Threads: one at a time. */
#include "fixtures/served_points.h"

/* Rods or balls of one radius, and nothing else. */
typedef struct round_case {
    const char *shape; /* "cylinder" or "sphere" */
    float radius;      /* scene units */
    float spacing;     /* of their axes or centres, scene units */
} round_case;

enum { ROUND_SIDE = 4 }; /* so many stand along each side of a square, or of a cube */
static const float ROD_LENGTH = 3.0f;

/* Writes the rods or balls as pbrt's text. Returns their area in closed form. */
static double make_round_world(const round_case *c, char *world, size_t size)
{
    size_t used = 0;
    int layers = strcmp(c->shape, "sphere") == 0 ? ROUND_SIDE : 1, count = 0;
    for (int i = 0; i < ROUND_SIDE * ROUND_SIDE * layers; i++, count++) {
        double at[3];
        for (int a = 0, rest = i; a < 3; a++, rest /= ROUND_SIDE)
            at[a] = ((double)(rest % ROUND_SIDE) - 0.5 * (ROUND_SIDE - 1)) * (double)c->spacing;
        used += (size_t)snprintf(world + used, size - used,
                                 "AttributeBegin Translate %g %g %g Shape \"%s\" \"float radius\" %g %s AttributeEnd\n",
                                 at[0], at[1], layers > 1 ? at[2] : 0.0, c->shape, (double)c->radius,
                                 layers > 1 ? "" : "\"float zmin\" -1.5 \"float zmax\" 1.5");
        assert_true(used < size);
    }
    double radius = (double)c->radius;
    return count * (layers > 1 ? 4.0 * PI * radius * radius : 2.0 * PI * radius * (double)ROD_LENGTH);
}

/* Photons of a beam of 1 W/m^2 across its direction, where it meets the outside of a surface first. */
static photon_set draw_beam(const scene *s, const served_case *c, vec3 direction, uint64_t lines, uint64_t seed)
{
    photon_set set = {.emitted_paths = lines, .photons = photon_records_create((uint32_t)lines)};
    assert_non_null(set.photons);
    rng random = test_random(seed);
    frame f = frame_from_z(direction);
    const float flux = (float)PI * c->reach * c->reach;
    for (uint64_t i = 0; i < lines; i++) {
        surface_hit hit;
        vec2 d = sample_disk_concentric(rng_vec2(&random));
        vec3 across = vec3_add(vec3_scale(f.x, d.x * c->reach), vec3_scale(f.y, d.y * c->reach));
        vec3 from = vec3_add_scaled(vec3_add(c->center, across), direction, -1.5f * c->reach);
        if (!scene_intersect(s, scene_ray_make(from, direction), INFINITY, &hit) ||
            vec3_dot(hit.geometric_normal, direction) >= 0.0f)
            continue;
        photon *to = &set.photons[set.count];
        to->position[0] = hit.position.x, to->position[1] = hit.position.y, to->position[2] = hit.position.z;
        to->normal = direction_encode(hit.geometric_normal);
        to->direction = arrival_encode(direction, false);
        to->flux = flux_encode(rgb_gray(flux), hash_combine(seed, set.count));
        set.count++;
    }
    return set;
}

/* The mean of what is seen over all of the surface, times its area, over the flux of the photons there. photons_a_disc:
 * on a disc of the largest radius that faces the beam. */
static double see_flux(test_run *r, const scene *s, const served_case *c, double area, double photons_a_disc,
                       vec3 direction, uint64_t seed)
{
    enum { POINTS = 5000 };
    static const double LEAST_SHARE_SEEN = 0.01;
    const double disc = PI * (double)c->radius * (double)c->radius;
    uint64_t lines = (uint64_t)(photons_a_disc * PI * (double)c->reach * (double)c->reach / disc);
    photon_set set = draw_beam(s, c, direction, lines, 2 * seed);
    double flux = PI * (double)c->reach * (double)c->reach * (double)set.count / (double)lines;
    photon_map map;
    photon_neighbor *scratch = make_seen_map(r, s, c, &set, &map);
    point_series p = {.s = s, .c = c, .random = test_random(2 * seed + 1)};
    double seen = 0.0;
    uint64_t rays = 0;
    int points = 0;
    while (points < POINTS) {
        field_point at;
        draw_line(&p);
        while (cross(&p, &at)) {
            seen +=
                (double)irradiance_estimate_seen(&map, at.position, at.normal, LEAST_SHARE_SEEN * disc, scratch, &rays)
                    .g;
            points++;
        }
    }
    free(scratch);
    photon_map_reset(&map);
    return seen / points * area / flux;
}

/* A beam lights rods and balls that are much smaller than the largest disc, as large and larger. What is seen over all
 * of them is its flux, within 3 % and three standard errors, with fewer photons than an estimate sums: more would make
 * discs smaller where it is brighter, and what is seen too bright by that. By the area in the plane of each point rods
 * have 1.2 times their light, and balls 1.28; by the whole disc's area a rod of a twentieth of its radius has 0.05. */
static void round_surfaces_are_seen(void **state)
{
    (void)state;
    enum { FIELDS = 6 };
    static const float LARGEST_DISC = 0.2f;
    static const double PHOTONS_A_DISC[] = {3.0, 30.0};
    static const round_case ROUND[] = {
        {"cylinder", 0.01f, 0.6f}, {"cylinder", 0.05f, 0.25f}, {"cylinder", 0.05f, 0.6f},
        {"cylinder", 0.19f, 1.0f}, {"cylinder", 0.6f, 2.0f},   {"sphere", 0.05f, 0.6f},
        {"sphere", 0.1f, 0.7f},    {"sphere", 0.19f, 1.0f},    {"sphere", 0.6f, 2.0f},
    };
    test_run r;
    test_run_init(&r, 1);
    int wrong = 0;
    for (size_t i = 0; i < sizeof ROUND / sizeof *ROUND; i++) {
        char world[16384];
        double area = make_round_world(&ROUND[i], world, sizeof world);
        float half = 0.5f * (ROUND_SIDE - 1) * ROUND[i].spacing + ROUND[i].radius;
        served_case c = {.radius = LARGEST_DISC,
                         .reach = sqrtf(2.0f * half * half + fmaxf(half * half, 2.25f)),
                         .light_count = 1,
                         .lights = {{1.0f, 0.0f}}};
        scene *s = test_scene_create(&r, world);
        for (size_t d = 0; d < (FEWER > 1 ? 1 : sizeof PHOTONS_A_DISC / sizeof *PHOTONS_A_DISC); d++) {
            double sum = 0.0, squares = 0.0;
            for (int f = 0; f < FIELDS; f++) {
                rng random = test_random((uint64_t)f);
                double one = see_flux(&r, s, &c, area, PHOTONS_A_DISC[d], random_direction(&random), (uint64_t)f + 1);
                sum += one;
                squares += one * one;
            }
            double mean = sum / FIELDS, sigma = sqrt(fmax(0.0, squares / FIELDS - mean * mean) / (FIELDS - 1));
            bool is_right = fabs(mean - 1.0) <= 0.03 + 3.0 * sigma;
            print_message("%s %s of radius %g, %g apart, %g photons a disc: mean %.4f +- %.4f\n",
                          is_right ? "right:" : "WRONG:", ROUND[i].shape, (double)ROUND[i].radius,
                          (double)ROUND[i].spacing, PHOTONS_A_DISC[d], mean, sigma);
            wrong += !is_right;
        }
        scene_destroy(s);
    }
    assert_int_equal(wrong, 0);
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(round_surfaces_are_seen)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
