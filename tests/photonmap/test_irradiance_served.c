/* test_irradiance_served.c: the irradiance that a point receives through the cache is right in the mean, over points
 * drawn evenly from all the surfaces of a scene. Where no estimate holds, a point receives the truth instead, as the
 * renderer follows the light on from there. Threads: one at a time. */
/* ctest: serial */
#include "irradiance_cache.h"

#include "fixtures/test_scene.h"

/* The irradiance on the two sides of a shape, W/m^2; 0: photons and requests stay away from there. */
typedef struct shape_light {
    float outside, inside;
} shape_light;

typedef struct served_case {
    const char *name, *world;
    float radius; /* of the largest disc, scene units */
    vec3 center;  /* of a sphere around the scene */
    float reach;  /* its radius */
    uint32_t light_count;
    shape_light lights[2]; /* by shape; shapes beyond have the last */
} served_case;

typedef struct field_point {
    vec3 position, normal;
    float irradiance;
    uint32_t shape_index;
} field_point;

/* Points evenly spread over all surfaces: where straight lines, drawn evenly through the sphere, cross them. A line
 * crosses one side of a surface of area A with probability A / (4 pi reach^2), by Cauchy's formula. */
typedef struct point_series {
    const scene *s;
    const served_case *c;
    rng random;
    scene_ray line;
    bool is_under_way;
    uint64_t lines;
} point_series;

static float largest_irradiance(const served_case *c)
{
    float largest = 0.0f;
    for (uint32_t i = 0; i < c->light_count; i++)
        largest = fmaxf(largest, fmaxf(c->lights[i].outside, c->lights[i].inside));
    return largest;
}

/* The next crossing of the current line; false where the line is at its end. */
static bool cross(point_series *p, field_point *out_point)
{
    surface_hit hit;
    while (scene_intersect(p->s, p->line, INFINITY, &hit)) {
        uint32_t i = hit.shape_index < p->c->light_count ? hit.shape_index : p->c->light_count - 1;
        bool is_outside = vec3_dot(hit.geometric_normal, p->line.direction) < 0.0f;
        p->line.origin = vec3_add_scaled(hit.position, hit.geometric_normal, (is_outside ? -2.0f : 2.0f) * hit.epsilon);
        float irradiance = is_outside ? p->c->lights[i].outside : p->c->lights[i].inside;
        if (irradiance == 0.0f)
            continue;
        vec3 normal = is_outside ? hit.geometric_normal : vec3_negate(hit.geometric_normal);
        *out_point = (field_point){hit.position, normal, irradiance, hit.shape_index};
        return true;
    }
    return false;
}

static void draw_line(point_series *p)
{
    vec3 direction = random_direction(&p->random);
    frame f = frame_from_z(direction);
    vec2 d = sample_disk_concentric(rng_vec2(&p->random));
    vec3 across = vec3_add(vec3_scale(f.x, d.x * p->c->reach), vec3_scale(f.y, d.y * p->c->reach));
    p->line =
        scene_ray_make(vec3_add_scaled(vec3_add(p->c->center, across), direction, -1.5f * p->c->reach), direction);
    p->lines++;
}

/* Photons of the case's irradiances: so dense where these are largest that a whole disc holds photons_a_disc. */
static photon_set draw_photons(const scene *s, const served_case *c, double photons_a_disc, uint64_t seed)
{
    double disc = PI * (double)c->radius * (double)c->radius, sphere = 4.0 * PI * (double)c->reach * (double)c->reach;
    float largest = largest_irradiance(c);
    uint64_t lines = (uint64_t)(photons_a_disc * sphere / disc), room = 1024;
    photon_set set = {.emitted_paths = lines};
    point_series p = {.s = s, .c = c, .random = test_random(seed)};
    photon *photons = NULL;
    while (p.lines < lines) {
        field_point at;
        draw_line(&p);
        while (cross(&p, &at)) {
            if (rng_float(&p.random) * largest >= at.irradiance)
                continue;
            if (!photons || set.count == room) {
                room *= 2;
                photons = realloc(photons, room * sizeof *photons);
                assert_non_null(photons);
            }
            photon *to = &photons[set.count];
            memset(to, 0, sizeof *to);
            to->position[0] = at.position.x, to->position[1] = at.position.y, to->position[2] = at.position.z;
            to->normal = direction_encode(at.normal);
            to->direction = arrival_encode(vec3_negate(at.normal), false);
            to->flux = flux_encode(rgb_gray((float)(sphere * (double)largest)), hash_combine(seed, set.count));
            set.count++;
        }
    }
    set.photons = photon_records_create(set.count);
    assert_non_null(set.photons);
    if (set.count > 0)
        memcpy(set.photons, photons, set.count * sizeof *photons);
    free(photons);
    return set;
}

#define BOX(X0, X1, Y0, Y1, Z0, Z1)                                                                                           \
    "Shape \"trianglemesh\" \"integer indices\" [0 2 1 1 2 3  4 5 6 5 7 6  0 1 4 1 5 4  2 6 3 3 6 7  0 4 2 2 4 6  1 3 5 3 7 " \
    "5] \"point3 P\" [" X0 " " Y0 " " Z0 " " X1 " " Y0 " " Z0 " " X0 " " Y1 " " Z0 " " X1 " " Y1 " " Z0 " " X0 " " Y0         \
    " " Z1 " " X1 " " Y0 " " Z1 " " X0 " " Y1 " " Z1 " " X1 " " Y1 " " Z1 "]\n"
#define QUAD(P) "Shape \"bilinearmesh\" \"point3 P\" [" P "]\n"

static const served_case CASES[] = {
    {"corners of a room", BOX("-1", "1", "-1", "1", "-1", "1"), 0.3f, {0, 0, 0}, 1.8f, 1, {{0, 1}}},
    {"edges of a plate", QUAD("-1 0 -1  1 0 -1  -1 0 1  1 0 1"), 0.3f, {0, 0, 0}, 1.5f, 1, {{1, 1}}},
    {"a step of 1 mm, and a wall that faces it",
     QUAD("-1 0 -1  -1 0 1  0 0 -1  0 0 1") QUAD("0 0.001 -1  0 0.001 1  1 0.001 -1  1 0.001 1")
         QUAD("0 0 -1  0 0 1  0 0.001 -1  0 0.001 1") QUAD("-0.5 0 -1  -0.5 0 1  -0.5 1 -1  -0.5 1 1"),
     0.3f,
     {0, 0, 0},
     1.8f,
     1,
     {{1, 1}}},
    {"boards of 20 x 10 mm on a wall",
     QUAD("-1 0 -1  1 0 -1  -1 0 1  1 0 1") BOX("-1", "1", "0", "0.01", "0", "0.02")
         BOX("-1", "1", "0", "0.01", "0.2", "0.22") BOX("-1", "1", "0", "0.01", "0.4", "0.42"),
     0.3f,
     {0, 0, 0},
     1.5f,
     1,
     {{1, 1}}},
    {"a strip with four times the light of the wall",
     QUAD("-1 0 -1  1 0 -1  -1 0 1  1 0 1") QUAD("-1 0.01 0  1 0.01 0  -1 0.01 0.02  1 0.01 0.02"),
     0.3f,
     {0, 0, 0},
     1.5f,
     2,
     {{0.25f, 0.25f}, {1, 1}}},
    {"disks smaller than the radius",
     "Shape \"disk\" \"float radius\" 0.05\nTranslate 0 0 0.3 Shape \"disk\" \"float radius\" 0.1\n"
     "Translate 0 0 0.3 Shape \"disk\" \"float radius\" 0.02\nTranslate 0 0 0.3 Shape \"disk\" \"float radius\" 0.2\n"
     "Translate 0 0 0.01 Shape \"disk\" \"float radius\" 0.5\n",
     0.2f,
     {0, 0, 0.5f},
     0.8f,
     1,
     {{1, 1}}},
    {"spheres",
     "Shape \"sphere\" \"float radius\" 0.5\nTranslate 0.7 0 0 Shape \"sphere\" \"float radius\" 0.1\n"
     "Translate 0.2 0 0 Shape \"sphere\" \"float radius\" 0.02\n",
     0.2f,
     {0.1f, 0, 0},
     1.0f,
     1,
     {{1, 0}}},
    {"leaves",
     "Shape \"trianglemesh\" \"integer indices\" ["
     "0 1 2 1 3 2 4 5 6 5 7 6 8 9 10 9 11 10 12 13 14 13 15 14 16 17 18 17 19 18 20 21 22 21 23 22 24 25 "
     "26 25 27 26 28 29 30 29 31 30 32 33 34 33 35 34 36 37 38 37 39 38 40 41 42 41 43 42 44 45 46 45 47 "
     "46 48 49 50 49 51 50 52 53 54 53 55 54 56 57 58 57 59 58 60 61 62 61 63 62 64 65 66 65 67 66 68 69 "
     "70 69 71 70 72 73 74 73 75 74 76 77 78 77 79 78 80 81 82 81 83 82 84 85 86 85 87 86 88 89 90 89 91 "
     "90 92 93 94 93 95 94 "
     "] \"point3 P\" ["
     "0.083 0.293 0.268  0.071 0.195 0.284  0.175 0.288 0.306  0.163 0.191 0.323  -0.229 0.416 0.184 "
     "-0.318 0.376 0.205  -0.272 0.506 0.176  -0.361 0.466 0.198  -0.215 0.002 0.145  -0.127 -0.038 0.169 "
     "-0.242 0.001 0.241  -0.154 -0.040 0.265  -0.352 0.303 0.319  -0.442 0.267 0.343  -0.342 0.229 0.251 "
     "-0.432 0.194 0.276  -0.352 -0.358 -0.359  -0.384 -0.447 -0.328  -0.261 -0.396 -0.375  -0.293 -0.485 "
     "-0.343  -0.514 0.427 -0.465  -0.456 0.347 -0.478  -0.433 0.485 -0.456  -0.374 0.405 -0.470  0.232 "
     "0.011 -0.146  0.207 -0.080 -0.178  0.252 0.038 -0.240  0.227 -0.053 -0.272  -0.257 0.245 0.315 "
     "-0.290 0.313 0.380  -0.166 0.251 0.355  -0.199 0.319 0.420  -0.144 0.192 -0.288  -0.149 0.273 -0.231 "
     "-0.125 0.136 -0.208  -0.129 0.217 -0.150  -0.248 0.137 -0.099  -0.179 0.169 -0.034  -0.320 0.174 "
     "-0.040  -0.251 0.206 0.024  0.282 -0.185 0.302  0.382 -0.181 0.308  0.275 -0.119 0.377  0.374 -0.115 "
     "0.384  0.203 -0.388 0.254  0.244 -0.305 0.215  0.217 -0.351 0.346  0.257 -0.268 0.307  0.262 -0.526 "
     "-0.320  0.244 -0.480 -0.406  0.197 -0.465 -0.274  0.179 -0.419 -0.360  -0.269 0.471 -0.517  -0.305 "
     "0.385 -0.552  -0.219 0.421 -0.446  -0.256 0.335 -0.481  0.439 0.256 -0.055  0.524 0.294 -0.090 "
     "0.393 0.343 -0.071  0.478 0.381 -0.107  0.520 0.472 0.141  0.425 0.488 0.169  0.489 0.448 0.049 "
     "0.394 0.464 0.077  -0.157 0.519 -0.106  -0.161 0.420 -0.117  -0.256 0.525 -0.124  -0.260 0.426 "
     "-0.134  -0.172 0.232 0.291  -0.260 0.278 0.280  -0.154 0.286 0.373  -0.242 0.332 0.362  -0.399 0.253 "
     "-0.131  -0.386 0.190 -0.208  -0.378 0.330 -0.190  -0.365 0.268 -0.268  0.228 0.109 -0.530  0.178 "
     "0.100 -0.444  0.312 0.082 -0.483  0.262 0.073 -0.397  0.174 0.146 0.042  0.268 0.120 0.018  0.149 "
     "0.145 -0.054  0.242 0.119 -0.079  0.345 0.384 -0.367  0.305 0.475 -0.372  0.256 0.346 -0.343  0.216 "
     "0.437 -0.347  0.248 -0.424 -0.299  0.317 -0.361 -0.264  0.307 -0.502 -0.276  0.376 -0.439 -0.241 "
     "0.398 0.193 -0.324  0.428 0.170 -0.416  0.476 0.255 -0.314  0.506 0.232 -0.407 "
     "]\n",
     0.2f,
     {0, 0, 0},
     1.0f,
     1,
     {{1, 1}}},
    {"a thin wall between a room and a dark one",
     BOX("-1", "0", "-1", "1", "-1", "1") BOX("0.01", "1", "-1", "1", "-1", "1"),
     0.3f,
     {0, 0, 0},
     1.8f,
     2,
     {{0, 1}, {0, 0.01f}}},
};

typedef struct served_sums {
    double ratio;   /* of what points received over what they should */
    double refused; /* share of the points that no estimate holds for */
    double largest; /* irradiance served, over the truth where that is largest */
    double dim;     /* the ratio of those points that have less than the largest irradiance */
} served_sums;

static served_sums ask(test_run *r, const scene *s, const served_case *c, double photons_a_disc, uint32_t nearest,
                       irradiance_cache_mode mode, uint64_t seed)
{
    enum { POINTS = 5000 };
    photon_set set = draw_photons(s, c, photons_a_disc, 2 * seed);
    photon_map map;
    photon_map_settings settings = {
        .nearest = nearest, .max_radius = c->radius, .surface_area = s->surface_area, .surfaces = s};
    assert_int_equal(photon_map_create(&r->run, &set, &settings, 0.0, 1.0, &map), AG_OK);
    irradiance_cache cache;
    assert_int_equal(irradiance_cache_create(&map, mode, 1, &cache), AG_OK);
    point_series p = {.s = s, .c = c, .random = test_random(2 * seed + 1)};
    double received = 0.0, truth = 0.0, largest = 0.0, dim_received = 0.0, dim_truth = 0.0;
    int points = 0, refused = 0;
    while (points < POINTS) {
        field_point at;
        draw_line(&p);
        while (cross(&p, &at)) {
            irradiance_request request;
            irradiance_cache_get(&cache, at.position, at.normal, 0, &request);
            assert_int_equal(request.irradiance_photon, PHOTON_NONE);
            double one = (double)(request.holds ? request.irradiance.g : at.irradiance);
            received += one;
            truth += (double)at.irradiance;
            if (at.irradiance < largest_irradiance(c)) {
                dim_received += one;
                dim_truth += (double)at.irradiance;
            }
            refused += !request.holds;
            largest = fmax(largest, (double)request.irradiance.g);
            points++;
        }
    }
    irradiance_cache_reset(&cache);
    photon_map_reset(&map);
    return (served_sums){received / truth, (double)refused / points, largest / (double)largest_irradiance(c),
                         dim_received / dim_truth};
}

/* The largest value that a Poisson count of that mean exceeds in one of so many draws. */
static double poisson_bound(double mean, double draws)
{
    double term = exp(-mean), sum = term;
    int k = 0;
    while (1.0 - sum > 1.0 / draws && k < 100000)
        sum += term *= mean / ++k;
    return k;
}

/* An estimate holds on this share of a disc at least, as irradiance_estimate.c has it. */
static const double LEAST_SHARE = 0.2;

static bool judge(test_run *r, const scene *s, const served_case *c, double photons_a_disc, int fields,
                  irradiance_cache_mode mode)
{
    enum { NEAREST = 50 };
    double sum = 0.0, squares = 0.0, refused = 0.0, largest = 0.0;
    for (int f = 0; f < fields; f++) {
        served_sums one = ask(r, s, c, photons_a_disc, NEAREST, mode, (uint64_t)(f + 1));
        sum += one.ratio;
        squares += one.ratio * one.ratio;
        refused += one.refused;
        largest = fmax(largest, one.largest);
    }
    double mean = sum / fields, sigma = sqrt(fmax(0.0, squares / fields - mean * mean) / (fields - 1));
    double least = LEAST_SHARE * fmin(photons_a_disc, (double)NEAREST); /* photons on the least surface, on average */
    double bound = (1.0 + poisson_bound(least, 1e3 * 5000.0 * fields)) / least;
    bool is_right = fabs(mean - 1.0) <= 0.005 + 3.0 * sigma && largest <= bound;
    print_message("%s %s, %g photons a disc, %s: mean %.4f +- %.4f, largest %.3g of at most %.3g, %.0f %% without\n",
                  is_right ? "right:" : "WRONG:", c->name, photons_a_disc,
                  mode == IRRADIANCE_UNCACHED ? "at the point" : "on demand", mean, sigma, largest, bound,
                  100.0 * refused / fields);
    return is_right;
}

static void points_receive_what_is_there(void **state)
{
    (void)state;
    static const struct {
        double photons_a_disc;
        int fields;
    } DENSITIES[] = {{3, 16}, {10, 12}, {30, 10}, {300, 5}, {3000, 4}};
    test_run r;
    test_run_init(&r, 1);
    int wrong = 0;
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        scene *s = test_scene_create(&r, CASES[i].world);
        for (size_t d = 0; d < (FEWER > 1 ? 2 : sizeof DENSITIES / sizeof *DENSITIES); d++) {
            wrong += !judge(&r, s, &CASES[i], DENSITIES[d].photons_a_disc, DENSITIES[d].fields, IRRADIANCE_ON_DEMAND);
            wrong += !judge(&r, s, &CASES[i], DENSITIES[d].photons_a_disc, DENSITIES[d].fields, IRRADIANCE_UNCACHED);
        }
        scene_destroy(s);
    }
    assert_int_equal(wrong, 0);
    test_run_reset(&r);
}

/* Makes a map of the photons, whose estimates have the case's radius. Returns the scratch of its searches. */
static photon_neighbor *make_seen_map(test_run *r, const scene *s, const served_case *c, photon_set *in_out_set,
                                      photon_map *out_map)
{
    enum { NEAREST = 50 };
    photon_map_settings settings = {
        .nearest = NEAREST, .max_radius = c->radius, .surface_area = s->surface_area, .surfaces = s};
    assert_int_equal(photon_map_create(&r->run, in_out_set, &settings, 0.0, 1.0, out_map), AG_OK);
    photon_neighbor *scratch = malloc(photon_map_scratch_count(out_map) * sizeof *scratch);
    assert_non_null(scratch);
    return scratch;
}

/* The mean over the case's surfaces of what is seen there, over the truth; *out_whole_disc: where the whole disc
 * answers for surfaces that are too small; *out_largest: the largest, over the largest irradiance. */
static double see(test_run *r, const scene *s, const served_case *c, double photons_a_disc, double least_share,
                  uint64_t seed, double *out_whole_disc, double *out_largest)
{
    enum { POINTS = 20000 };
    photon_set set = draw_photons(s, c, photons_a_disc, 2 * seed);
    photon_map map;
    photon_neighbor *scratch = make_seen_map(r, s, c, &set, &map);
    point_series p = {.s = s, .c = c, .random = test_random(2 * seed + 1)};
    const double least_area = least_share * PI * (double)c->radius * (double)c->radius;
    double seen = 0.0, whole_disc = 0.0, truth = 0.0, largest = 0.0;
    uint64_t rays = 0;
    for (int points = 0; points < POINTS;) {
        field_point at;
        draw_line(&p);
        while (cross(&p, &at)) {
            double one = (double)irradiance_estimate_seen(&map, at.position, at.normal, least_area, scratch, &rays).g;
            seen += one;
            whole_disc += (double)irradiance_estimate(&map, at.position, at.normal, scratch).g;
            truth += (double)at.irradiance;
            largest = fmax(largest, one);
            points++;
        }
    }
    free(scratch);
    photon_map_reset(&map);
    *out_whole_disc = whole_disc / truth;
    *out_largest = largest / (double)largest_irradiance(c);
    return seen / truth;
}

/* Boards, small balls and leaves have their light where estimates are seen directly, within 3 % and three standard
 * errors, with few photons a disc and with many, and no estimate is brighter than so many photons on the least area. */
static void small_surfaces_are_seen(void **state)
{
    (void)state;
    enum { FIELDS = 6 };
    static const double LEAST_SHARE_SEEN = 0.01, PHOTONS_A_DISC[] = {3.0, 30.0, 300.0};
    static const char *const NAMES[] = {"boards of 20 x 10 mm on a wall", "spheres", "leaves"};
    test_run r;
    test_run_init(&r, 1);
    int wrong = 0, cases = 0;
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++)
        for (size_t n = 0; n < sizeof NAMES / sizeof *NAMES; n++) {
            if (strcmp(CASES[i].name, NAMES[n]) != 0)
                continue;
            cases++;
            scene *s = test_scene_create(&r, CASES[i].world);
            for (size_t d = 0; d < (FEWER > 1 ? 1 : sizeof PHOTONS_A_DISC / sizeof *PHOTONS_A_DISC); d++) {
                double sum = 0.0, squares = 0.0, whole_disc = 0.0, largest = 0.0;
                for (int f = 0; f < FIELDS; f++) {
                    double whole, most;
                    double one =
                        see(&r, s, &CASES[i], PHOTONS_A_DISC[d], LEAST_SHARE_SEEN, (uint64_t)(f + 1), &whole, &most);
                    sum += one;
                    squares += one * one;
                    whole_disc += whole;
                    largest = fmax(largest, most);
                }
                double mean = sum / FIELDS;
                double sigma = sqrt(fmax(0.0, squares / FIELDS - mean * mean) / (FIELDS - 1));
                double least = LEAST_SHARE_SEEN * fmin(PHOTONS_A_DISC[d], 50.0);
                double bound = (1.0 + poisson_bound(least, 1e3 * 20000.0 * FIELDS)) / least;
                bool is_right = fabs(mean - 1.0) <= 0.03 + 3.0 * sigma && largest <= bound;
                print_message(
                    "%s %s seen, %g photons a disc: mean %.4f +- %.4f, by the whole disc %.4f, largest %.3g of "
                    "at most %.3g\n",
                    is_right ? "right:" : "WRONG:", CASES[i].name, PHOTONS_A_DISC[d], mean, sigma, whole_disc / FIELDS,
                    largest, bound);
                wrong += !is_right;
            }
            scene_destroy(s);
        }
    assert_int_equal(cases, sizeof NAMES / sizeof *NAMES);
    assert_int_equal(wrong, 0);
    test_run_reset(&r);
}

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

/* A patch of light on a floor with a hundredth of it, metres of which lie within the largest radius. The k nearest
 * photons to a point in the dark are the patch's as soon as its edge is nearer than k photons of the dark, and the
 * photon nearest to it is one at that edge: by both together the floor has a third too much light, or more. */
static void light_stays_in_its_patch(void **state)
{
    (void)state;
    static const served_case PATCH = {
        "a patch of light",
        QUAD("-.5 0 -.5  .5 0 -.5  -.5 0 .5  .5 0 .5") QUAD("-2 0 -2  2 0 -2  -2 0 -.5  2 0 -.5")
            QUAD("-2 0 .5  2 0 .5  -2 0 2  2 0 2") QUAD("-2 0 -.5  -.5 0 -.5  -2 0 .5  -.5 0 .5")
                QUAD(".5 0 -.5  2 0 -.5  .5 0 .5  2 0 .5"),
        2.0f,
        {0, 0, 0},
        3.0f,
        2,
        {{1, 1}, {0.01f, 0.01f}}};
    static const uint32_t NEAREST[] = {12, 50};
    enum {
        FIELDS = FEWER > 1 ? 4 : 16,
        NUMBERS = FEWER > 1 ? 1 : 2,
        PHOTONS_A_DISC = 50000
    }; /* 4,000 in the patch, on each side */
    static const double MOST[] = {1.04, 1.02};
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, PATCH.world);
    int wrong = 0;
    for (int k = 0; k < NUMBERS; k++)
        for (int mode = IRRADIANCE_ON_DEMAND; mode <= IRRADIANCE_UNCACHED; mode += IRRADIANCE_UNCACHED) {
            double sum = 0.0, squares = 0.0;
            for (int f = 0; f < FIELDS; f++) {
                double one =
                    ask(&r, s, &PATCH, PHOTONS_A_DISC, NEAREST[k], (irradiance_cache_mode)mode, (uint64_t)f + 1).ratio;
                sum += one;
                squares += one * one;
            }
            double mean = sum / FIELDS, sigma = sqrt(fmax(0.0, squares / FIELDS - mean * mean) / (FIELDS - 1));
            bool is_right = mean >= 0.99 - 3.0 * sigma && mean <= MOST[k] + 3.0 * sigma;
            print_message("%s %s, %u nearest, %s: mean %.4f +- %.4f\n", is_right ? "right:" : "WRONG:", PATCH.name,
                          NEAREST[k], mode == IRRADIANCE_UNCACHED ? "at the point" : "on demand", mean, sigma);
            wrong += !is_right;
        }
    scene_destroy(s);
    assert_int_equal(wrong, 0);
    test_run_reset(&r);
}

/* A door that ends 1 mm above the floor, which has a hundredth of the light on its other side. Photons beyond the door
 * are the nearest ones to some of the dark points beside it, and a line close above the floor passes below the door. */
static void light_stays_behind_a_door(void **state)
{
    (void)state;
    static const served_case DOOR = {"a door with a gap of 1 mm",
                                     QUAD("-.5 0 -.5  0 0 -.5  -.5 0 .5  0 0 .5")
                                         QUAD("0 0 -.5  1 0 -.5  0 0 .5  1 0 .5")
                                             QUAD("0 .001 -.5  0 1 -.5  0 .001 .5  0 1 .5"),
                                     0.3f,
                                     {0, 0, 0},
                                     1.6f,
                                     2,
                                     {{0, 1}, {0, 0.01f}}};
    enum { FIELDS = 8, PHOTONS_A_DISC = 300, NEAREST = 50 };
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, DOOR.world);
    double sum = 0.0, squares = 0.0;
    for (int f = 0; f < FIELDS; f++) {
        double one = ask(&r, s, &DOOR, PHOTONS_A_DISC, NEAREST, IRRADIANCE_ON_DEMAND, (uint64_t)f + 1).dim;
        sum += one;
        squares += one * one;
    }
    double mean = sum / FIELDS, sigma = sqrt(fmax(0.0, squares / FIELDS - mean * mean) / (FIELDS - 1));
    print_message("%s: mean of the dark side %.4f +- %.4f\n", DOOR.name, mean, sigma);
    assert_true(fabs(mean - 1.0) <= 0.03 + 3.0 * sigma);
    scene_destroy(s);
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_receive_what_is_there), cmocka_unit_test(small_surfaces_are_seen),
        cmocka_unit_test(round_surfaces_are_seen), cmocka_unit_test(light_stays_in_its_patch),
        cmocka_unit_test(light_stays_behind_a_door)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
