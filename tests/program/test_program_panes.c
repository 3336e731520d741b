/* test_program_panes.c: light straight through thin glass is direct light, in both integrators: closed forms for suns,
 * points, skies and large lamps behind it; two panes and what goes to and fro between them; a room with windows against
 * the path tracer that knows no panes; the layers; the same bits.
 * Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/pane_light.h"

#define ROOM PROGRAM_SCENES "panes.pbrt"

#define THIN "Material \"thindielectric\" \"float eta\" 1.5\n"

/* E cos(theta) T(theta): the sun brings 3 W/m^2 across its way. */
static void test_sun(void **state)
{
    (void)state;
    static const double COSINES[] = {1.0, 0.6, 0.2};
    for (int i = 0; i < 3; i++) {
        char above[2048];
        double c = COSINES[i], t = thin_glass(c, 1.5);
        const struct {
            const char *name, *panes;
            double transmittance;
        } PANES[] = {
            {"no pane", "", 1.0},
            {"a pane", THIN SQUARE("50", "1"), t},
            {"two panes", THIN SQUARE("50", "1") SQUARE("50", "1.01"), t * t},
            {"thin glass of index 1", "Material \"thindielectric\" \"float eta\" 1\n" SQUARE("50", "1"), 1.0},
            {"faces of index 1", "Material \"dielectric\" \"float eta\" 1\n" SQUARE("50", "1") SQUARE("50", "2"), 1.0},
            {"an interface and a pane", "Material \"interface\" " SQUARE("50", "0.5") THIN SQUARE("50", "1"), t},
        };
        for (size_t k = 0; k < sizeof PANES / sizeof *PANES; k++) {
            snprintf(
                above, sizeof above,
                "LightSource \"distant\" \"rgb L\" [3 3 3] \"point3 from\" [%.9g %.9g 0] \"point3 to\" [0 0 0]\n%s",
                sqrt(1.0 - c * c), c, PANES[k].panes);
            expect_gray_floor(PANES[k].name, above, 3.0 * c * PANES[k].transmittance, 2e-4, "--spp=1");
        }
    }
}

/* A pane of alpha 0.3 is there for that share of the rays; a tinted pane of glTF's material lets through its
 * colour times what Schlick's formula does not reflect; of one with a chequered colour the eye's floor is under white
 * at [0, 1) and under grey beyond. */
static void test_other_panes(void **state)
{
    (void)state;
    /* sigma of a sample: sqrt(0.21) (1 - T) = 0.035, of 64 x 256 of them 0.0003 */
    expect_gray_floor("a pane of alpha", SUN THIN SQUARE_WITH("50", "1", "\"float alpha\" 0.3"),
                      3.0 * (0.7 + 0.3 * thin_glass(1.0, 1.5)), 4.0 * 0.0003, "--spp=256");
    const double tinted[3] = {3.0 * 0.96 * 0.8, 3.0 * 0.96 * 0.4, 3.0 * 0.96 * 0.2};
    expect_floor("a tinted pane",
                 SUN "Material \"principled\" \"rgb reflectance\" [0.8 0.4 0.2] \"float transmission\" 1 "
                     "\"float metallic\" 0 \"float roughness\" 0\n" SQUARE("50", "1"),
                 tinted, 2e-4, "--spp=1");
    static const char *const FROM[2] = {"0.3", "1.3"};
    static const double VALUE[2] = {1.0, 0.25};
    for (int i = 0; i < 2; i++) {
        char above[2048];
        snprintf(above, sizeof above,
                 "Texture \"c\" \"spectrum\" \"checkerboard\" \"string mapping\" \"planar\" \"vector3 v1\" [1 0 0] "
                 "\"vector3 v2\" [0 0 1] \"rgb tex1\" [1 1 1] \"rgb tex2\" [0.25 0.25 0.25]\n"
                 "LightSource \"distant\" \"rgb L\" [3 3 3] \"point3 from\" [%s 1 0.3] \"point3 to\" [0 0 0]\n"
                 "Material \"principled\" \"texture reflectance\" \"c\" \"float transmission\" 1 \"float metallic\" 0 "
                 "\"float roughness\" 0\n" SQUARE("50", "1"),
                 FROM[i]);
        double x = atof(FROM[i]), c = 1.0 / sqrt(1.0 + x * x + 0.09);
        double clear = 1.0 - (0.04 + 0.96 * pow(1.0 - c, 5.0));
        expect_gray_floor("a chequered pane", above, 3.0 * c * clear * VALUE[i], 5e-4, "--spp=1");
    }
}

/* I cos(theta) T(theta) / d^2, of a point and within the whole cone of a spot. */
static void test_points(void **state)
{
    (void)state;
    double d2 = 1.5 * 1.5 + 2.0 * 2.0, c = 2.0 / sqrt(d2), e = 7.0 * c / d2 * thin_glass(c, 1.5);
    expect_gray_floor("a point",
                      "LightSource \"point\" \"rgb I\" [7 7 7] \"point3 from\" [1.5 2 0]\n" THIN SQUARE("50", "1"), e,
                      2e-3, "--spp=1");
    expect_gray_floor("a spot",
                      "LightSource \"spot\" \"rgb I\" [7 7 7] \"point3 from\" [1.5 2 0] \"point3 to\" [0 0 0] "
                      "\"float coneangle\" 30 \"float conedeltaangle\" 5\n" THIN SQUARE("50", "1"),
                      e, 2e-3, "--spp=1");
}

/* Radiance 1 of a square of side 4 at a height of 2, about the origin: the integral of T c c' / d^2. */
static double lamp_through_glass(bool has_glass)
{
    enum { STEPS = 500 };
    double sum = 0.0, step = 4.0 / STEPS;
    for (int i = 0; i < STEPS; i++)
        for (int k = 0; k < STEPS; k++) {
            double x = -2.0 + (i + 0.5) * step, z = -2.0 + (k + 0.5) * step, d2 = x * x + z * z + 4.0;
            double c = 2.0 / sqrt(d2);
            sum += c * c / d2 * (has_glass ? thin_glass(c, 1.5) : 1.0) * step * step;
        }
    return sum;
}

/* Found by sampling the lamp and by scattered rays, weighted against each other: the right mean, and the one of rays
 * that know no panes. */
static void test_sky_and_large_lamps(void **state)
{
    (void)state;
    expect_noisy_floor("a sky", "LightSource \"infinite\" \"rgb L\" [1 1 1]\n" THIN SQUARE("50", "1"),
                       sky_through_glass());
    expect_noisy_floor("a large lamp", LAMP("1", "2", "2") THIN SQUARE("50", "1"), lamp_through_glass(true));
    const char *scene = scene_of(DIFFUSE_FLOOR, LAMP("1", "2", "2") THIN SQUARE("50", "1"));
    const double radiance = REFLECTANCE / PI * lamp_through_glass(true);
    agreement_means means = OVER_SEEDS(scene, "--max-depth=2", PATH, TRACED, "--spp=64");
    agreement_means truth = agreement_uniform(radiance, radiance, radiance);
    expect_agreement("a large lamp, traced", &means, &truth, (agreement_bounds){0.0, 0.005, 0.02});
    /* rough metal, which is traced on: its scattered rays find the lamp too */
    scene = scene_of(ROUGH_FLOOR, LAMP("1", "2", "2") THIN SQUARE("50", "1"));
    truth = OVER_SEEDS(scene, "--max-depth=2", PATH, TRACED, "--spp=64");
    for (int i = 0; i < 2; i++) {
        means = OVER_SEEDS(scene, "--max-depth=1", INTEGRATORS[i], "--spp=64");
        expect_agreement("a large lamp on rough metal", &means, &truth, (agreement_bounds){0.0, 0.005, 0.03});
    }
}

/* A pane that shines is no pane: what comes through it is found by scattered rays alone, once. */
static void test_shining_pane(void **state)
{
    (void)state;
    const char *scene = scene_of(
        DIFFUSE_FLOOR, LAMP("2", "2", "2") "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" "
                                           "[1 1 1] \"bool twosided\" true\n" THIN SQUARE("50", "1") "AttributeEnd\n");
    double expected = REFLECTANCE / PI * (PI + 2.0 * lamp_through_glass(true));
    static const char *const MODES[] = {DIRECT, TRACED};
    const agreement_means truth = agreement_uniform(expected, expected, expected);
    for (int i = 0; i < 2; i++) {
        agreement_means means = OVER_SEEDS(scene, "--max-depth=2", PATH, MODES[i], "--spp=64");
        expect_agreement("a shining pane", &means, &truth, (agreement_bounds){0.0, 0.005, 0.02});
    }
}

/* --- layers --- */

/* Two panes, each of which reflects r and lets t through: t^2 comes straight, t^2 (r^2 + r^4 + ...) after reflections
 * between them, which is a caustic. The eye is between panes and floor. */
static void test_between_panes(void **state)
{
    (void)state;
    const char *scene = write_text(
        "between.pbrt", "LookAt 0 0.9 0 0 0 0 0 0 1 Camera \"perspective\" \"float fov\" 80\nWorldBegin\n" SUN
                        "Material \"thindielectric\" \"float eta\" 3\n" SQUARE("2", "1") SQUARE("2", "1.01")
                            DIFFUSE_FLOOR SQUARE("2", "0"));
    double t = thin_glass(1.0, 3.0), r2 = (1.0 - t) * (1.0 - t), radiance = 3.0 * REFLECTANCE / PI;
    layers map = LAYERS(scene, "--size=24x24", "--spp=4", "--photons=1e4", "--caustic-photons=1e4");
    layers_means many = LAYERS_OVER_SEEDS(scene, "--size=24x24", "--spp=4", "--photons=1e4", "--caustic-photons=1e5");
    seeds_mean truth = seeds_exactly(radiance * t * t * r2 / (1.0 - r2));
    expect_near("straight", map.direct, radiance * t * t, 2e-4);
    expect_same_mean("to and fro", &many.caustic, &truth, AGREEMENT_BLUR, 0.01);
    assert_true(map.specular == 0.0 && map.emission == 0.0);
    layers path = LAYERS(scene, "--size=24x24", "--spp=4", PATH);
    expect_near("straight, paths", path.direct, radiance * t * t, 2e-4);
    /* traced, all of it is a caustic, and the path tracer finds none of a sun */
    many = LAYERS_OVER_SEEDS(scene, "--size=24x24", "--spp=4", "--photons=1e4", "--caustic-photons=1e5", TRACED);
    truth = seeds_exactly(radiance * t * t / (1.0 - r2));
    assert_true(many.direct.squares == 0.0);
    expect_same_mean("traced", &many.caustic, &truth, AGREEMENT_BLUR, 0.01);
    path = LAYERS(scene, "--size=24x24", "--spp=4", PATH, TRACED);
    assert_true(path.direct + path.caustic + path.indirect == 0.0);
}

#define UNDER_A_PANE(y)                                                                                                \
    "LookAt 0 0.04 0 0 0 0 0 0 1 Camera \"perspective\" \"float fov\" 80\nWorldBegin\n" SUN THIN SQUARE("4", y)        \
    DIFFUSE_FLOOR SQUARE("4", "0")

/* One pane: no caustic at all. What floor and pane throw to and fro is indirect; the pane's reflectance of diffuse
 * light is b / rho, so that the floor gets b + b^2 + ... of the direct light. The photon map has it of the sun's
 * photons that came through the pane. */
static void test_global_map_keeps_it(void **state)
{
    (void)state;
    double t = thin_glass(1.0, 1.5), b = REFLECTANCE * (1.0 - sky_through_glass() / PI);
    double radiance = 3.0 * t * REFLECTANCE / PI;
    const char *low = write_text("low.pbrt", UNDER_A_PANE("0.05"));
    layers_means many = LAYERS_OVER_SEEDS(low, "--size=16x16", "--spp=128", PATH);
    const seeds_mean truth = seeds_exactly(radiance * b / (1.0 - b));
    expect_same_mean("to and fro, paths", &many.indirect, &truth, AGREEMENT_BLUR, 0.005);
    layers path = LAYERS(low, "--size=16x16", "--spp=16", PATH);
    assert_true(path.caustic == 0.0 && path.specular == 0.0 && path.emission == 0.0);
    const char *high = write_text("high.pbrt", UNDER_A_PANE("0.5"));
    layers map = LAYERS(high, "--size=16x16", "--spp=4", "--gather-samples=4", "--photons=1e5", "--nearest=30");
    expect_near("straight", map.direct, radiance, 2e-4);
    assert_true(map.caustic == 0.0 && map.specular == 0.0 && map.emission == 0.0);
    const layers_means paths = LAYERS_OVER_SEEDS(high, "--size=16x16", "--spp=128", PATH);
    many = LAYERS_OVER_SEEDS(high, "--size=16x16", "--spp=8", "--gather-samples=16", "--photons=1e5", "--nearest=30");
    expect_same_mean("to and fro", &many.indirect, &paths.indirect, AGREEMENT_BLUR, 0.01);
}

/* A lamp seen through a pane is emission, of L T; traced it comes by the pane's other lobes. */
static void test_lamp_seen(void **state)
{
    (void)state;
    const char *scene = write_text("seen.pbrt", "LookAt 0 0 0 0 1 0 0 0 1 Camera \"perspective\" \"float fov\" 1\n"
                                                "WorldBegin\n" LAMP("2", "2", "2") THIN SQUARE("3", "1"));
    double sigma = sqrt(0.077 * 0.923 / (64 * 512)), expected = 2.0 * thin_glass(1.0, 1.5);
    for (int i = 0; i < 2; i++) {
        layers direct = LAYERS(scene, "--size=8x8", "--spp=512", INTEGRATORS[i], FEW_PHOTONS);
        layers traced = LAYERS(scene, "--size=8x8", "--spp=512", INTEGRATORS[i], FEW_PHOTONS, TRACED);
        expect_near("seen", direct.emission, expected, 4.0 * sigma / 0.923);
        expect_near("seen, traced", traced.specular, expected, 4.0 * sigma / 0.923);
        assert_true(direct.specular == 0.0 && traced.emission == 0.0);
    }
}

/* A sun behind glass that path tracing cannot find is told of. */
static void test_warning(void **state)
{
    (void)state;
    static const char *const WARNING = "suns, points and spots";
    const struct {
        const char *glass, *integrator, *mode;
        bool is_told;
    } CASES[] = {{THIN, PATH, DIRECT, false},
                 {THIN, PATH, TRACED, true},
                 {THIN, MAP, TRACED, false},
                 {"Material \"dielectric\"\n", PATH, DIRECT, true},
                 {"Material \"dielectric\" \"float roughness\" 0.5\n", PATH, DIRECT, false},
                 {"Material \"diffuse\"\n", PATH, TRACED, false}};
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        char above[1024];
        snprintf(above, sizeof above, SUN "%s" SQUARE("50", "1"), CASES[i].glass);
        program_run run = RUN("--size=4x4", "--spp=1", "--photons=100", "--caustic-photons=100", CASES[i].integrator,
                              CASES[i].mode, "-o", "w.exr", scene_of(DIFFUSE_FLOOR, above));
        expect_exit(&run, 0);
        assert_int_equal(strstr(run.err, WARNING) != NULL, CASES[i].is_told);
        program_run_reset(&run);
    }
}

/* --- a room --- */

/* Double panes, a showcase, a mirror ball, glass; lit by sky and a lamp outside. */
static void test_room(void **state)
{
    (void)state;
    expect_same_room(ROOM);
}

/* The sun behind a pane, in a room without caustics, which paths cannot find. */
static void test_sunny_room(void **state)
{
    (void)state;
    const char *sunny = sunny_room(THIN "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" "
                                        "[-2.02 0.9 -1.1 -2.02 2.3 -1.1 -2.02 2.3 1.1 -2.02 0.9 1.1]");
    expect_same_light("sun, indirect", OVER_SEEDS(sunny, SUNNY_PHOTONS, "--only=indirect"),
                      OVER_SEEDS(sunny, PATHS, "--only=indirect"));
    expect_same_direct_light(sunny);
}

/* A portal in the window says where the sky comes in; the panes before it let photons through. The truth has the portal
 * too, since a portal leaves out the light that the outer faces of the wall send in by way of the outer pane: 5 % of
 * the sky's, and none where there is but one pane. */
static void test_portal_behind_panes(void **state)
{
    (void)state;
    char portal[512];
    snprintf(portal, sizeof portal, "%s",
             SCENE_WITH("panes.pbrt", "[1 1.2 1.5]",
                        "[1 1.2 1.5] \"point3 portal\" [-1.98 1 1 -1.98 1 -1 -1.98 2.2 -1 -1.98 2.2 1]"));
    expect_same_light("photon map, a portal", OVER_SEEDS(portal, AGREEMENT_MAP, "--spp=12", "--only=indirect"),
                      OVER_SEEDS(portal, PATHS, "--only=indirect"));
}

static void test_same_bits(void **state)
{
    (void)state;
    expect_same_bits(ROOM);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_sun),
        TEST_IN_FOLDER(test_other_panes),
        TEST_IN_FOLDER(test_points),
        TEST_IN_FOLDER(test_sky_and_large_lamps),
        TEST_IN_FOLDER(test_shining_pane),
        TEST_IN_FOLDER(test_between_panes),
        TEST_IN_FOLDER(test_global_map_keeps_it),
        TEST_IN_FOLDER(test_lamp_seen),
        TEST_IN_FOLDER(test_warning),
        TEST_IN_FOLDER(test_room),
        TEST_IN_FOLDER(test_sunny_room),
        TEST_IN_FOLDER(test_portal_behind_panes),
        TEST_IN_FOLDER(test_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
