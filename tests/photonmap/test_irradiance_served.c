/* test_irradiance_served.c: the irradiance that a point receives through the cache is right in the mean, over points
 * drawn evenly from all the surfaces of a scene. Where no estimate holds, a point receives the truth instead, as the
 * renderer follows the light on from there. Threads: one at a time. */
/* ctest: serial */
#include "fixtures/served_points.h"

#include "irradiance_cache.h"
#include "material/bsdf.h"

#define BOX(X0, X1, Y0, Y1, Z0, Z1)                                                                                           \
    "Shape \"trianglemesh\" \"integer indices\" [0 2 1 1 2 3  4 5 6 5 7 6  0 1 4 1 5 4  2 6 3 3 6 7  0 4 2 2 4 6  1 3 5 3 7 " \
    "5] \"point3 P\" [" X0 " " Y0 " " Z0 " " X1 " " Y0 " " Z0 " " X0 " " Y1 " " Z0 " " X1 " " Y1 " " Z0 " " X0 " " Y0         \
    " " Z1 " " X1 " " Y0 " " Z1 " " X0 " " Y1 " " Z1 " " X1 " " Y1 " " Z1 "]\n"
#define QUAD(P) "Shape \"bilinearmesh\" \"point3 P\" [" P "]\n"

/* A board on the plane y = 0, and its sides. */
#define SLAT(Z0, Z1)                                                                                                   \
    QUAD("-1 .02 " Z0 "  1 .02 " Z0 "  -1 .02 " Z1 "  1 .02 " Z1)                                                      \
    QUAD("-1 0 " Z0 "  1 0 " Z0 "  -1 .02 " Z0 "  1 .02 " Z0)                                                          \
    QUAD("-1 0 " Z1 "  1 0 " Z1 "  -1 .02 " Z1 "  1 .02 " Z1)

/* 16 curves that grow out of the plane y = 0 and lean, and one that lies across it, 1 mm above. */
#define CURVE(TYPE, WIDTHS, P) "Shape \"curve\" \"string type\" " TYPE WIDTHS " \"point3 P\" [" P "]\n"
#define BLADE(TYPE)            CURVE(TYPE, "\"float width0\" .04 \"float width1\" .02", "0 -.01 0 0 .15 .02 .05 .3 .05 .15 .35 .1")
#define NEXT(X, Y, Z)          "Translate " X " " Y " " Z " "
#define BLADES(TYPE)                                                                                                   \
    BLADE(TYPE) NEXT("0", "0", ".5") BLADE(TYPE) NEXT("0", "0", ".5") BLADE(TYPE) NEXT("0", "0", ".5") BLADE(TYPE)
#define LAWN(TYPE)                                                                                                     \
    CURVE(TYPE, "\"float width\" .004", "-1 .003 .1 -.5 .003 .3 .5 .003 .2 1 .003 .25")                                \
    NEXT("-.75", "0", "-.75")                                                                                          \
    BLADES(TYPE)                                                                                                       \
    NEXT(".5", "0", "-1.5") BLADES(TYPE) NEXT(".5", "0", "-1.5") BLADES(TYPE) NEXT(".5", "0", "-1.5") BLADES(TYPE)
#define POST BOX("-.01", ".01", "0.05", "0.15", "-.01", ".01")
#define POSTS                                                                                                          \
    NEXT("-.75", "0", "-.25")                                                                                          \
    POST NEXT(".5", "0", "0") POST NEXT(".5", "0", "0") POST NEXT(".5", "0", "0") POST NEXT("0", "0", ".5")            \
        POST NEXT("-.5", "0", "0") POST NEXT("-.5", "0", "0") POST NEXT("-.5", "0", "0") POST
#define TUBE   "\"cylinder\""
#define FLAT   "\"flat\""
#define RIBBON "\"ribbon\" \"normal N\" [0 .3 1 1 .5 0]"
#define PLATE  QUAD("-1 0 -1  1 0 -1  -1 0 1  1 0 1")

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
    {"boards with ten times the light of the wall, 50 mm behind them",
     QUAD("-1 0 -1  1 0 -1  -1 0 1  1 0 1") QUAD("-1 0.05 -0.90  1 0.05 -0.90  -1 0.05 -0.75  1 0.05 -0.75")
         QUAD("-1 0.05 -0.50  1 0.05 -0.50  -1 0.05 -0.35  1 0.05 -0.35")
             QUAD("-1 0.05 -0.10  1 0.05 -0.10  -1 0.05 0.05  1 0.05 0.05")
                 QUAD("-1 0.05 0.30  1 0.05 0.30  -1 0.05 0.45  1 0.05 0.45")
                     QUAD("-1 0.05 0.70  1 0.05 0.70  -1 0.05 0.85  1 0.05 0.85"),
     0.3f,
     {0, 0, 0},
     1.5f,
     2,
     {{0.1f, 0.1f}, {1, 1}}},
    {"boards with four times the light of the wall, 20 mm thick",
     QUAD("-1 0 -1  1 0 -1  -1 0 1  1 0 1") SLAT("-1", "-0.8") SLAT("-0.5", "-0.3") SLAT("0", "0.2") SLAT("0.5", "0.7"),
     0.3f,
     {0, 0, 0},
     1.5f,
     2,
     {{0.25f, 0.25f}, {1, 1}}},
    {"posts on a board with ten times the light of the wall behind it",
     "Shape \"trianglemesh\" \"integer indices\" [0 1 2 1 3 2] \"point3 P\" [-1 0 -1  1 0 -1  -1 0 1  1 0 1]\n" QUAD(
         "-1 0.05 -0.5  1 0.05 -0.5  -1 0.05 0.5  1 0.05 0.5") POSTS,
     0.3f,
     {0, 0, 0},
     1.5f,
     2,
     {{0.1f, 0.1f}, {1, 1}}},
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
    /* photons lie on the plate alone, for curves have none: curves_are_asked_for_nothing */
    {"a plate under tubes", PLATE LAWN(TUBE), 0.3f, {0, 0, 0}, 1.5f, 2, {{1, 1}, {0, 0}}},
    {"a plate under flat curves", PLATE LAWN(FLAT), 0.3f, {0, 0, 0}, 1.5f, 2, {{1, 1}, {0, 0}}},
    {"a plate under ribbons", PLATE LAWN(RIBBON), 0.3f, {0, 0, 0}, 1.5f, 2, {{1, 1}, {0, 0}}},
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

/* Writes ridges of trapezoids as pbrt's text: a mesh of their fronts, below and on top, and one of their flanks, which
 * lean by 50 degrees. */
static void make_moulding(char *world, size_t size)
{
    enum { RIDGES = 16 };
    static const double X[] = {0.0, 0.04, 0.06, 0.1, 0.12}, Y[] = {0.0, 0.0, 0.0238, 0.0238, 0.0};
    size_t used = 0;
    for (int first = 0; first < 2; first++) { /* strips of a ridge: 0 and 2 are fronts, 1 and 3 are flanks */
        used += (size_t)snprintf(world + used, size - used, "Shape \"trianglemesh\" \"integer indices\" [");
        for (int i = 0; i < 2 * RIDGES; i++)
            used += (size_t)snprintf(world + used, size - used, "%d %d %d %d %d %d ", 4 * i, 4 * i + 1, 4 * i + 2,
                                     4 * i + 1, 4 * i + 3, 4 * i + 2);
        used += (size_t)snprintf(world + used, size - used, "] \"point3 P\" [");
        for (int i = 0; i < 4 * RIDGES; i += 2)
            for (int end = 0; end < 2; end++) {
                double x = 0.12 * (i / 4) - 0.06 * RIDGES + X[first + i % 4 + end], y = Y[first + i % 4 + end];
                used += (size_t)snprintf(world + used, size - used, "%.4g %.4g -1 %.4g %.4g 1 ", x, y, x, y);
            }
        used += (size_t)snprintf(world + used, size - used, "]\n");
    }
    assert_true(used < size);
}

/* The flanks of a moulding beside a window have ten times the light of its fronts. Fronts receive their own, within 12
 * %: where the next front is found beyond a flank, the flank's area counts, and none of its photons. With photons of
 * all normals within 60 degrees fronts received 3.7 to 5.5 times their light. */
static void fronts_have_no_light_of_flanks(void **state)
{
    (void)state;
    enum { FIELDS = 6, NEAREST = 50 };
    static const double PHOTONS_A_DISC[] = {30.0, 300.0, 3000.0};
    static char world[16384];
    make_moulding(world, sizeof world);
    const served_case c = {"a moulding", world, 0.3f, {0, 0, 0}, 1.5f, 2, {{0.1f, 0.1f}, {1, 1}}};
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(&r, world);
    int wrong = 0;
    for (size_t d = 0; d < sizeof PHOTONS_A_DISC / sizeof *PHOTONS_A_DISC; d++) {
        double sum = 0.0, squares = 0.0;
        for (int f = 0; f < FIELDS; f++) {
            double one = ask(&r, s, &c, PHOTONS_A_DISC[d], NEAREST, IRRADIANCE_ON_DEMAND, (uint64_t)(f + 1)).dim;
            sum += one, squares += one * one;
        }
        double mean = sum / FIELDS, sigma = sqrt(fmax(0.0, squares / FIELDS - mean * mean) / (FIELDS - 1));
        print_message("fronts, %g photons a disc: mean %.4f +- %.4f\n", PHOTONS_A_DISC[d], mean, sigma);
        wrong += fabs(mean - 1.0) > 0.12 + 3.0 * sigma;
    }
    assert_int_equal(wrong, 0);
    scene_destroy(s);
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

/* Curves are thinner than discs, and flat ones have no side that photons and rays could agree on: no photon lies on
 * them, of either map, and of hits drawn evenly from them none has a lobe that irradiance is asked for. What they
 * receive is therefore what a ray is followed on for. */
static void curves_are_asked_for_nothing(void **state)
{
    (void)state;
    static const char *const LAWNS[] = {LAWN(TUBE), LAWN(FLAT), LAWN(RIBBON)};
    static const char *const MATERIALS[] = {"\"diffuse\"", "\"coateddiffuse\"", "\"diffusetransmission\"",
                                            "\"mix\" \"string materials\" [\"matte\" \"metal\"] \"float amount\" 0.5"};
    enum { HITS = 2000 / FEWER, PHOTONS = 4000 / FEWER };
    static const float PLATE_THICKNESS = 1e-4f;
    test_run r;
    test_run_init(&r, 1);
    for (int k = 0; k < 3 * 4; k++) {
        char world[8192];
        const served_case c = {.reach = 1.5f, .light_count = 2, .lights = {{0, 0}, {1, 1}}};
        int length = snprintf(world, sizeof world,
                              "LightSource \"infinite\" \"rgb L\" [1 1 1]\n" PLATE
                              "MakeNamedMaterial \"matte\" \"string type\" \"diffuse\"\n"
                              "MakeNamedMaterial \"metal\" \"string type\" \"conductor\"\nMaterial %s\n%s",
                              MATERIALS[k % 4], LAWNS[k / 4]);
        assert_true(length < (int)sizeof world);
        scene *s = test_scene_create(&r, world);
        point_series p = {.s = s, .c = &c, .random = test_random((uint64_t)k)};
        for (int hits = 0; hits < HITS;) {
            surface_hit hit;
            bsdf b;
            draw_line(&p);
            if (!scene_intersect(s, p.line, INFINITY, &hit) || hit.shape_index == 0)
                continue;
            bsdf_init(s, &hit, vec3_negate(p.line.direction), &b);
            assert_true(bsdf_has(&b, BSDF_TRACED) && !bsdf_has(&b, BSDF_GATHERED));
            hits++;
        }
        for (int kind = PHOTON_GLOBAL; kind <= PHOTON_CAUSTIC; kind++) {
            photon_set set;
            const photon_tracing_settings settings = {
                .kind = (photon_kind)kind, .wanted = PHOTONS, .max_scatterings = 8, .seed = 1, .progress_end = 1.0};
            assert_int_equal(photon_tracing_run(s, &r.run, &settings, &set), AG_OK);
            assert_true(set.count > 0);
            for (uint32_t i = 0; i < set.count; i++)
                assert_true(fabsf(set.photons[i].position[1]) < PLATE_THICKNESS);
            photon_set_reset(&set);
        }
        scene_destroy(s);
    }
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_receive_what_is_there), cmocka_unit_test(small_surfaces_are_seen),
        cmocka_unit_test(curves_are_asked_for_nothing), cmocka_unit_test(light_stays_in_its_patch),
        cmocka_unit_test(light_stays_behind_a_door),    cmocka_unit_test(fronts_have_no_light_of_flanks)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
