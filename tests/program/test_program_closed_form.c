/* test_program_closed_form.c: pictures whose answer is known without rendering: light in a sphere, furnaces, lamps over
 * a floor, a mirror, glass. Each scene of tests/scenes derives its answer in its head; both integrators must give it.
 *
 * Rests on: Pharr, Jakob, Humphreys, 4th ed., 2023, 4.2 (sphere and furnace tests); Howell, "A Catalog of Radiation
 * Configuration Factors", 1982 (disk and rectangle).
 *
 * Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_picture.h"

#include <complex.h>

static const double PI = 3.14159265358979323846;
static const char *const INTEGRATORS[] = {"photonmap", "path"};
enum { INTEGRATOR_COUNT = 2, BLOCK = 8 };

/* Samples that leave a few thousandths of noise in the mean. */
static const char *spp_of(int integrator) { return integrator == 0 ? "2" : "96"; }
/* Paths, and so independent photons, are 1 - rho of the photons stored. */
static const char *photons_of(double rho) { return rho > 0.6 ? "--photons=600000" : "--photons=200000"; }

static const char *reflectance_text(double rho)
{
    static char text[64];
    snprintf(text, sizeof text, "\"rgb reflectance\" [%g %g %g]", rho, rho, rho);
    return text;
}

#define HALF "\"rgb reflectance\" [0.5 0.5 0.5]" /* as the scenes have it */

/* ---- a sphere with a light in it ---- */

static const double REFLECTANCES[] = {0.2, 0.5, 0.8};
static const double SPHERE_DIRECT = 10.0 / 4.0; /* I / R^2 */

static void test_light_in_the_middle(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < INTEGRATOR_COUNT; k++) {
            double rho = REFLECTANCES[i];
            const char *scene = SCENE_WITH("sphere.pbrt", HALF, reflectance_text(rho));
            picture p = RENDER(scene, "--integrator", INTEGRATORS[k], photons_of(rho), "--spp", spp_of(k));
            expect_uniform(INTEGRATORS[k], &p, rho / PI * SPHERE_DIRECT / (1.0 - rho), 0.01, BLOCK, 0.03);
            picture_reset(&p);
        }
}

/* Irradiance kept at few of the photons gives the same light. */
static void test_few_irradiance_photons(void **state)
{
    (void)state;
    static const char *const FRACTIONS[] = {"--irradiance-fraction=0.5", "--irradiance-fraction=0.125"};
    for (int i = 0; i < 2; i++) {
        picture p =
            RENDER(PROGRAM_SCENES "sphere.pbrt", photons_of(0.5), "--spp", spp_of(0), FRACTIONS[i], "--only=indirect");
        expect_uniform(FRACTIONS[i], &p, 0.5 / PI * SPHERE_DIRECT * 0.5 / (1.0 - 0.5), 0.01, BLOCK, 0.04);
        picture_reset(&p);
    }
}

/* Grains or squares that reflect nothing, among others that reflect 0.8: photons per area are those of all the surface,
 * and what it reflects is that of the mean. */
static void test_black_among_white(void **state)
{
    (void)state;
    static const char *const MATERIALS[] = {
        "MakeNamedMaterial \"white\" \"string type\" \"diffusetransmission\" \"rgb reflectance\" [0.8 0.8 0.8] "
        "\"rgb transmittance\" [0 0 0]\n"
        "MakeNamedMaterial \"black\" \"string type\" \"diffusetransmission\" \"rgb reflectance\" [0 0 0] "
        "\"rgb transmittance\" [0 0 0]\n"
        "MakeNamedMaterial \"grains\" \"string type\" \"mix\" \"string materials\" [\"white\" \"black\"] "
        "\"float amount\" 0.5\nNamedMaterial \"grains\"",
        "Texture \"squares\" \"spectrum\" \"checkerboard\" \"float uscale\" 32 \"float vscale\" 32 "
        "\"rgb tex1\" [0.8 0.8 0.8] \"rgb tex2\" [0 0 0]\n"
        "Material \"diffusetransmission\" \"texture reflectance\" \"squares\" \"rgb transmittance\" [0 0 0]",
        "Texture \"squares\" \"float\" \"checkerboard\" \"float uscale\" 32 \"float vscale\" 32 "
        "\"float tex1\" 0 \"float tex2\" 1\n"
        "MakeNamedMaterial \"white\" \"string type\" \"diffuse\" \"rgb reflectance\" [0.8 0.8 0.8]\n"
        "MakeNamedMaterial \"black\" \"string type\" \"conductor\" \"rgb eta\" [1 1 1] \"rgb k\" [0 0 0]\n"
        "MakeNamedMaterial \"squares\" \"string type\" \"mix\" \"string materials\" [\"white\" \"black\"] "
        "\"texture amount\" \"squares\"\nNamedMaterial \"squares\""};
    for (size_t i = 0; i < sizeof MATERIALS / sizeof *MATERIALS; i++)
        for (int k = 0; k < INTEGRATOR_COUNT; k++) {
            const char *scene = SCENE_WITH("sphere.pbrt", "Material \"diffuse\" " HALF, MATERIALS[i]);
            picture p = RENDER(scene, "--integrator", INTEGRATORS[k], photons_of(0.4), "--spp", k == 0 ? "16" : "256");
            expect_uniform(INTEGRATORS[k], &p, 0.4 / PI * SPHERE_DIRECT / (1.0 - 0.4), 0.01, 16, 0.08);
            picture_reset(&p);
        }
}

static void test_light_off_the_middle(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < INTEGRATOR_COUNT; k++) {
            double rho = REFLECTANCES[i];
            const char *scene = SCENE_WITH("sphere.pbrt", HALF, reflectance_text(rho), "\"point3 from\" [0 0 0]",
                                           "\"point3 from\" [0.9 -0.6 0.7]");
            picture p = RENDER(scene, "--integrator", INTEGRATORS[k], photons_of(rho), "--spp", spp_of(k), "--only",
                               "indirect");
            expect_uniform(INTEGRATORS[k], &p, rho / PI * SPHERE_DIRECT * rho / (1.0 - rho), 0.01, BLOCK, 0.04);
            picture_reset(&p);
        }
}

static void test_spot_in_the_sphere(void **state)
{
    (void)state;
    double a = cos(20.0 * PI / 180.0), b = cos(30.0 * PI / 180.0);
    double power = 2.0 * PI * 100.0 * ((1.0 - a) + (a - b) / 2.0);
    for (int k = 0; k < INTEGRATOR_COUNT; k++) {
        picture p = RENDER(PROGRAM_SCENES "sphere_spot.pbrt", "--integrator", INTEGRATORS[k], "--spp",
                           k == 0 ? "2" : "512", photons_of(0.5), "--only", "indirect");
        expect_uniform(INTEGRATORS[k], &p, 0.5 / PI * power / (16.0 * PI), 0.01, BLOCK, 0.05);
        picture_reset(&p);
    }
}

/* The sphere as a mesh fine enough that it is one within a thousandth. */
static void write_sphere_mesh(FILE *file, double radius)
{
    enum { ROWS = 96, COLUMNS = 192 };
    fprintf(file, "Shape \"trianglemesh\" \"point3 P\" [");
    for (int i = 0; i <= ROWS; i++)
        for (int j = 0; j < COLUMNS; j++) {
            double theta = PI * i / ROWS, phi = 2.0 * PI * j / COLUMNS;
            fprintf(file, "%.9g %.9g %.9g\n", radius * sin(theta) * cos(phi), radius * sin(theta) * sin(phi),
                    radius * cos(theta));
        }
    fprintf(file, "] \"integer indices\" [");
    for (int i = 0; i < ROWS; i++)
        for (int j = 0; j < COLUMNS; j++) {
            int a = i * COLUMNS + j, b = i * COLUMNS + (j + 1) % COLUMNS, c = a + COLUMNS, d = b + COLUMNS;
            if (i > 0)
                fprintf(file, "%d %d %d\n", a, c, b);
            if (i < ROWS - 1)
                fprintf(file, "%d %d %d\n", b, c, d);
        }
    fprintf(file, "]\n");
}

static void test_sphere_of_triangles(void **state)
{
    (void)state;
    const char *scene = SCENE_WITH("sphere.pbrt", "Shape \"sphere\" \"float radius\" 2", "");
    FILE *file = fopen(scene, "a");
    assert_non_null(file);
    write_sphere_mesh(file, 2.0);
    assert_int_equal(fclose(file), 0);
    for (int k = 0; k < INTEGRATOR_COUNT; k++) {
        picture p = RENDER(scene, "--integrator", INTEGRATORS[k], photons_of(0.5), "--spp", spp_of(k));
        expect_uniform(INTEGRATORS[k], &p, 0.5 / PI * SPHERE_DIRECT / 0.5, 0.01, BLOCK, 0.03);
        picture_reset(&p);
    }
}

/* Depth D: the first D terms of the series. */
static void test_depth(void **state)
{
    (void)state;
    static const int DEPTHS[] = {0, 1, 2, 3, 5};
    for (int i = 0; i < 5; i++)
        for (int k = 0; k < INTEGRATOR_COUNT; k++) {
            char depth[8];
            snprintf(depth, sizeof depth, "%d", DEPTHS[i]);
            double rho = 0.8, sum = 0.0;
            for (int n = 0; n < DEPTHS[i]; n++)
                sum += pow(rho, n);
            const char *scene = SCENE_WITH("sphere.pbrt", HALF, reflectance_text(rho));
            picture p = RENDER(scene, "--integrator", INTEGRATORS[k], photons_of(rho), "--spp", spp_of(k),
                               "--max-depth", depth);
            expect_uniform(INTEGRATORS[k], &p, rho / PI * SPHERE_DIRECT * sum, 0.01, BLOCK, 0.03);
            picture_reset(&p);
        }
}

/* ---- furnaces ---- */

static void test_furnace(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < INTEGRATOR_COUNT; k++) {
            const char *scene = SCENE_WITH("furnace.pbrt", HALF, reflectance_text(REFLECTANCES[i]));
            picture p = RENDER(scene, "--integrator", INTEGRATORS[k], photons_of(REFLECTANCES[i]), "--spp", spp_of(k));
            expect_uniform(INTEGRATORS[k], &p, 1.0 / (1.0 - REFLECTANCES[i]), 0.01, BLOCK, 0.03);
            picture_reset(&p);
        }
}

static void test_glass_cannot_be_seen(void **state)
{
    (void)state;
    static const char *const INDICES[] = {"\"float eta\" 1.5", "\"float eta\" 1.1", "\"float eta\" 2.4",
                                          "\"float eta\" 0.7"};
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < INTEGRATOR_COUNT; k++) {
            const char *scene =
                SCENE_WITH("glass_in_furnace.pbrt", HALF, reflectance_text(0.0), INDICES[0], INDICES[i]);
            picture p = RENDER(scene, "--integrator", INTEGRATORS[k], "--spp", "64", "--photons=1000",
                               "--caustic-photons=1000");
            expect_uniform(INTEGRATORS[k], &p, 1.0, 0.002, BLOCK, 0.02);
            picture_reset(&p);
        }
}

/* Walls that reflect: light through the glass comes from the caustic map, and gather rays go through it. */
static void test_glass_in_furnace(void **state)
{
    (void)state;
    for (int k = 0; k < INTEGRATOR_COUNT; k++) {
        picture p = RENDER(PROGRAM_SCENES "glass_in_furnace.pbrt", "--integrator", INTEGRATORS[k], "--spp",
                           k == 0 ? "4" : "128", photons_of(0.5), "--caustic-photons=50000");
        expect_uniform(INTEGRATORS[k], &p, 2.0, 0.01, BLOCK, 0.03);
        picture_reset(&p);
    }
}

static void test_eye_in_the_glass(void **state)
{
    (void)state;
    for (int k = 0; k < INTEGRATOR_COUNT; k++) {
        const char *scene =
            SCENE_WITH("glass_in_furnace.pbrt", HALF, reflectance_text(0.0), "LookAt 0 0 -1.5", "LookAt 0 0 -0.001");
        picture p =
            RENDER(scene, "--integrator", INTEGRATORS[k], "--spp", "64", "--photons=1000", "--caustic-photons=1000");
        expect_uniform(INTEGRATORS[k], &p, 1.5 * 1.5, 0.002, BLOCK, 0.02);
        picture_reset(&p);
    }
}

/* ---- lamps over a floor ---- */

typedef double irradiance_fn(double x, double y);

static double under_disk(double x, double y)
{
    double a2 = 0.25, h2 = 2.25, d2 = (x - 0.3) * (x - 0.3) + (y - 0.2) * (y - 0.2), sum = d2 + h2 + a2;
    return 0.5 * PI * 5.0 * (1.0 - (d2 + h2 - a2) / sqrt(sum * sum - 4.0 * a2 * d2));
}

/* A rectangle below one of whose corners the point is; sides in units of its height. */
static double corner_form_factor(double a, double b)
{
    double p = sqrt(1.0 + a * a), q = sqrt(1.0 + b * b);
    return (a / p * atan(b / p) + b / q * atan(a / q)) / (2.0 * PI);
}

static double rectangle_irradiance(double x, double y, double x0, double x1, double y0, double y1, double h)
{
    x0 = (x0 - x) / h, x1 = (x1 - x) / h, y0 = (y0 - y) / h, y1 = (y1 - y) / h;
    return PI * 5.0 *
           (corner_form_factor(x1, y1) - corner_form_factor(x0, y1) - corner_form_factor(x1, y0) +
            corner_form_factor(x0, y0));
}

static double under_rectangle(double x, double y) { return rectangle_irradiance(x, y, -0.2, 0.8, -0.5, 0.3, 1.5); }

static double distance_from_lamp(double x, double y, double h)
{
    return sqrt((x - 0.3) * (x - 0.3) + (y - 0.2) * (y - 0.2) + h * h);
}

static double under_sphere(double x, double y)
{
    double d = distance_from_lamp(x, y, 1.6);
    return PI * 5.0 * 0.16 * 1.6 / (d * d * d);
}

static double under_point(double x, double y)
{
    double d = distance_from_lamp(x, y, 1.5);
    return 10.0 * 1.5 / (d * d * d);
}

static double under_spot(double x, double y)
{
    const double axis[3] = {-0.4, -0.1, -1.5};
    double d = distance_from_lamp(x, y, 1.5), length = sqrt(0.16 + 0.01 + 2.25);
    double cosine = ((x - 0.3) * axis[0] + (y - 0.2) * axis[1] - 1.5 * axis[2]) / (d * length);
    double a = cos(20.0 * PI / 180.0), b = cos(35.0 * PI / 180.0), t = fmin(1.0, fmax(0.0, (cosine - b) / (a - b)));
    return t * t * (3.0 - 2.0 * t) * under_point(x, y);
}

static double under_distant(double x, double y)
{
    (void)x, (void)y;
    return 9.0 / sqrt(14.0);
}

static double beside_mirror(double x, double y)
{
    return rectangle_irradiance(x, y, 0.6, 1.4, -0.5, 0.3, 1.5) +
           0.9999 * rectangle_irradiance(x, y, -3.8, -3.0, -0.5, 0.3, 1.5);
}

/* The mean over a block, from 8 x 8 points of each of its pixels; (x, y) as the camera of floor.pbrt has them: the
 * world's x runs to the left, from 1 to -1. */
static double floor_block(irradiance_fn *irradiance, const picture *p, int left, int top, int size)
{
    enum { POINTS = 8 };
    double sum = 0.0;
    int count = size * POINTS;
    for (int j = 0; j < count; j++)
        for (int i = 0; i < count; i++)
            sum += irradiance(1.0 - 2.0 * (left + (i + 0.5) / POINTS) / p->width,
                              1.0 - 2.0 * (top + (j + 0.5) / POINTS) / p->height);
    return sum / ((double)count * count);
}

/* Each block within of_block of its answer, or of a twentieth of the picture's mean where that is more. */
static void expect_floor(const char *what, const picture *p, irradiance_fn *irradiance, double of_mean, double of_block)
{
    double mean = 0.6 / PI * floor_block(irradiance, p, 0, 0, p->width);
    expect_near(what, picture_mean(p, 0), mean, of_mean);
    for (int y = 0; y < p->height; y += 4)
        for (int x = 0; x < p->width; x += 4) {
            double expected = 0.6 / PI * floor_block(irradiance, p, x, y, 4), value = picture_block(p, x, y, 4, 0);
            if (!(fabs(value - expected) <= of_block * fmax(expected, 0.05 * mean)))
                fail_msg("%s at %d, %d: %.6g is not %.6g", what, x, y, value, expected);
        }
}

static void test_lamps_over_a_floor(void **state)
{
    (void)state;
    static const struct {
        const char *scene;
        irradiance_fn *irradiance;
    } LAMPS[] = {{"lamp_disk", under_disk},   {"lamp_rectangle", under_rectangle}, {"lamp_sphere", under_sphere},
                 {"lamp_point", under_point}, {"lamp_spot", under_spot},           {"lamp_distant", under_distant}};
    for (int i = 0; i < 6; i++)
        for (int k = 0; k < INTEGRATOR_COUNT; k++) {
            char scene[512];
            snprintf(scene, sizeof scene, PROGRAM_SCENES "%s.pbrt", LAMPS[i].scene);
            /* with all depths there is no more light than with one */
            picture p = RENDER(scene, "--integrator", INTEGRATORS[k], "--spp", "16", "--photons", "10000",
                               "--gather-samples", "16", k == 0 ? "--max-depth=1" : "--max-depth=4");
            expect_floor(LAMPS[i].scene, &p, LAMPS[i].irradiance, 0.003, 0.02);
            picture_reset(&p);
        }
}

/* ---- a mirror ---- */

static double fresnel_conductor_squared(double complex amplitude)
{
    return creal(amplitude) * creal(amplitude) + cimag(amplitude) * cimag(amplitude);
}

/* Fresnel's formulas in complex numbers. */
static double mirror_reflectance(double cosine, double eta, double k)
{
    double complex n = eta + k * I, through = csqrt(1.0 - (1.0 - cosine * cosine) / (n * n));
    double perpendicular = fresnel_conductor_squared((cosine - n * through) / (cosine + n * through));
    double parallel = fresnel_conductor_squared((n * cosine - through) / (n * cosine + through));
    return 0.5 * (perpendicular + parallel);
}

/* The cosine between the ray through a point of mirror.pbrt's picture and the mirror's normal. */
static double mirror_cosine(double u, double v)
{
    double half = tan(30.0 * PI / 180.0), x = (2.0 * u - 1.0) * half, y = (1.0 - 2.0 * v) * half;
    return (1.0 - y) / sqrt(2.0) / sqrt(1.0 + x * x + y * y); /* forward and up both have 1 / sqrt 2 of the vertical */
}

static void test_mirror(void **state)
{
    (void)state;
    static const double ETA[3] = {0.2, 0.92, 1.1}, K[3] = {3.9, 2.45, 2.1};
    for (int k = 0; k < INTEGRATOR_COUNT; k++) {
        picture p = RENDER(PROGRAM_SCENES "mirror.pbrt", "--integrator", INTEGRATORS[k], "--spp", "16",
                           "--photons=1000", "--caustic-photons=1000");
        for (int y = 0; y < p.height; y += 4)
            for (int x = 0; x < p.width; x += 4)
                for (int c = 0; c < 3; c++) {
                    double expected = 0.0;
                    for (int j = 0; j < 16; j++)
                        for (int i = 0; i < 16; i++)
                            expected += mirror_reflectance(
                                mirror_cosine((x + (i + 0.5) / 4.0) / p.width, (y + (j + 0.5) / 4.0) / p.height),
                                ETA[c], K[c]);
                    expect_near(INTEGRATORS[k], picture_block(&p, x, y, 4, c), 2.0 * expected / 256.0, 0.005);
                }
        picture_reset(&p);
    }
}

/* A conductor given by its reflectance: that is what it has at normal incidence. */
static void test_mirror_of_given_reflectance(void **state)
{
    (void)state;
    for (int k = 0; k < INTEGRATOR_COUNT; k++) {
        const char *scene = SCENE_WITH("mirror.pbrt", "\"rgb eta\" [0.2 0.92 1.1] \"rgb k\" [3.9 2.45 2.1]",
                                       "\"rgb reflectance\" [0.9 0.5 0.1]", "LookAt 0 0 1  1 0 0",
                                       "LookAt 0 0 1  0.0001 0 0", "\"float fov\" 60", "\"float fov\" 1");
        picture p =
            RENDER(scene, "--integrator", INTEGRATORS[k], "--spp", "16", "--photons=1000", "--caustic-photons=1000");
        static const double EXPECTED[3] = {1.8, 1.0, 0.2};
        for (int c = 0; c < 3; c++)
            expect_near(INTEGRATORS[k], picture_mean(&p, c), EXPECTED[c], 0.002);
        picture_reset(&p);
    }
}

/* Light by way of a mirror: the caustic map's, or found by scattered rays. */
static void test_floor_beside_a_mirror(void **state)
{
    (void)state;
    for (int k = 0; k < INTEGRATOR_COUNT; k++) {
        picture p = RENDER(PROGRAM_SCENES "mirror_wall.pbrt", "--integrator", INTEGRATORS[k], "--spp",
                           k == 0 ? "16" : "512", "--photons=20000", "--caustic-photons=100000");
        expect_floor(INTEGRATORS[k], &p, beside_mirror, 0.01, 0.04);
        picture_reset(&p);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_light_in_the_middle),
        TEST_IN_FOLDER(test_few_irradiance_photons),
        TEST_IN_FOLDER(test_black_among_white),
        TEST_IN_FOLDER(test_light_off_the_middle),
        TEST_IN_FOLDER(test_spot_in_the_sphere),
        TEST_IN_FOLDER(test_sphere_of_triangles),
        TEST_IN_FOLDER(test_depth),
        TEST_IN_FOLDER(test_furnace),
        TEST_IN_FOLDER(test_glass_cannot_be_seen),
        TEST_IN_FOLDER(test_glass_in_furnace),
        TEST_IN_FOLDER(test_eye_in_the_glass),
        TEST_IN_FOLDER(test_lamps_over_a_floor),
        TEST_IN_FOLDER(test_mirror),
        TEST_IN_FOLDER(test_mirror_of_given_reflectance),
        TEST_IN_FOLDER(test_floor_beside_a_mirror),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
