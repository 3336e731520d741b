/* test_program_slabs.c: light straight through slabs of solid glass is direct light, in both integrators: closed forms
 * for suns, skies, points and glass that absorbs; a white furnace; what the eye sees; blocks, which bend light as ever;
 * a room behind slabs against paths that know no panes; the same bits. Flow: tests of the whole program. Threads: the
 * program's. */
#define _GNU_SOURCE
#include "fixtures/pane_light.h"
#include "fixtures/slab_text.h"

#define ROOM PROGRAM_SCENES "slabs.pbrt"
#define SKY  "LightSource \"infinite\" \"rgb L\" [1 1 1]\n"

/* The text of the scene at hand; each test begins it anew. */
static slab_text text;

static const char *box_of(const char *words, float low, float high)
{
    text.length = 0;
    slab_say(&text, words);
    slab_box(&text, vec3_make(-50.0f, low, -50.0f), vec3_make(50.0f, high, 50.0f));
    return text.text;
}

static const char *sun_at(double cosine)
{
    static char words[256];
    snprintf(words, sizeof words,
             "LightSource \"distant\" \"rgb L\" [3 3 3] \"point3 from\" [%.9g %.9g 0] \"point3 to\" [0 0 0]\n" GLASS,
             sqrt(1.0 - cosine * cosine), cosine);
    return words;
}

/* E cos(theta) T(theta) for a slab, in two faces, of double glazing (what goes to and fro between two slabs is no
 * direct light), and of an instance on its way along its own plane; nothing below a block, which bends light. */
static void test_sun(void **state)
{
    (void)state;
    static const double COSINES[] = {1.0, 0.6, 0.2};
    for (int i = 0; i < 3; i++) {
        double c = COSINES[i], t = thin_glass(c, 1.5), e = 3.0 * c;
        expect_gray_floor("a slab", box_of(sun_at(c), 1.0f, 1.5f), e * t, 3e-4, "--spp=1");
        expect_gray_floor("a block", box_of(sun_at(c), 1.0f, 41.0f), 0.0, 0.0, "--spp=1");
        text.length = 0;
        slab_say(&text, sun_at(c));
        slab_faces_of(&text, vec3_make(-50, 1, -50), vec3_make(50, 1.01f, 50), "yY");
        expect_gray_floor("two faces", text.text, e * t, 3e-4, "--spp=1");
        box_of(sun_at(c), 1.0f, 1.5f);
        slab_box(&text, vec3_make(-50, 1.6f, -50), vec3_make(50, 1.9f, 50));
        expect_gray_floor("double glazing", text.text, e * t * t, 3e-4, "--spp=1");
        text.length = 0;
        slab_say(&text, "ObjectBegin \"cube\"");
        slab_say(&text, GLASS);
        slab_box(&text, vec3_make(-1, -1, -1), vec3_make(1, 1, 1));
        slab_say(&text, "ObjectEnd");
        slab_say(&text, sun_at(c));
        slab_say(&text, "AttributeBegin ActiveTransform EndTime Translate 3 0 2 ActiveTransform All\n"
                        "Translate 0 1.5 0 Scale 50 0.2 50 ObjectInstance \"cube\" AttributeEnd");
        expect_gray_floor("an instance that moves", text.text, e * t, 3e-4, "--spp=4");
    }
}

/* Glass that absorbs: (1 - R)^2 a / (1 - R^2 a^2), a along the way that light takes within. */
static void test_absorption(void **state)
{
    (void)state;
    static const double COSINES[] = {1.0, 0.5}, SIGMA[] = {0.5, 1.0, 4.0};
    for (int i = 0; i < 2; i++) {
        double c = COSINES[i], within = sqrt(1.0 - (1.0 - c * c) / 2.25), t = thin_glass(c, 1.5),
               r = (1.0 - t) / (1.0 + t);
        double irradiance[3];
        for (int k = 0; k < 3; k++) {
            double a = exp(-0.25 * SIGMA[k] / within);
            irradiance[k] = 3.0 * c * (1.0 - r) * (1.0 - r) * a / (1.0 - r * r * a * a);
        }
        text.length = 0;
        slab_say(&text, "MakeNamedMedium \"green\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [0.5 1 4] "
                        "\"rgb sigma_s\" [0 0 0]\nAttributeBegin MediumInterface \"green\" \"\"");
        slab_say(&text, sun_at(c));
        slab_box(&text, vec3_make(-50, 1, -50), vec3_make(50, 1.25f, 50));
        slab_say(&text, "AttributeEnd");
        expect_floor("glass that absorbs", text.text, irradiance, 5e-4, "--spp=1");
    }
}

/* Tested by shadow rays and scattered rays, weighed against each other, and by paths that bend at both faces. */
static void test_sky(void **state)
{
    (void)state;
    const char *above = box_of(SKY GLASS, 1.0f, 1.5f);
    expect_noisy_floor("a sky", above, sky_through_glass());
    /* The dark floor's own light alone counts: what the slab mirrors from below is black, and what of the floor's own
     * light it sends back is 0.15 % at most. */
    slab_say(&text, "Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n" SQUARE("60", "-0.1"));
    const char *dark = scene_of("Material \"diffuse\" \"rgb reflectance\" [0.01 0.01 0.01]\n", text.text);
    const double radiance = 0.01 * sky_through_glass() / PI;
    const agreement_means means = OVER_SEEDS(dark, PATH, TRACED, "--spp=64"),
                          truth = agreement_uniform(radiance, radiance, radiance);
    /* Rare paths that go to and fro in the slab are too bright for the means of blocks to be normal. */
    expect_same_mean("a sky, traced", &means.whole, &truth.whole, 0.0015, 0.006);
}

/* A point at a height of 2 through glass of thickness d: straight, I cos T / r^2. Bent, its image is nearer by what the
 * glass shifts it: just below by d / 3, so that light is 2 d / (3 * 2) brighter there, to first order. The photons of
 * `traced` say so. */
static void test_point(void **state)
{
    (void)state;
    static const double THICKNESS = 0.3;
    double t = thin_glass(1.0, 1.5), straight = 7.0 / 4.0 * t, bent = 7.0 * t / pow(2.0 - THICKNESS / 3.0, 2.0);
    text.length = 0;
    slab_say(&text, "LightSource \"point\" \"rgb I\" [7 7 7] \"point3 from\" [0 2 0]\n" GLASS);
    slab_box(&text, vec3_make(-8, 1, -8), vec3_make(8, 1.3f, 8));
    expect_gray_floor("a point", text.text, straight, 1e-3, "--spp=1");
    /* Straight light has 10 % less. What is of second order in the thickness is half a hundredth. */
    const layers_means measured =
        LAYERS_OVER_SEEDS(scene_of(DIFFUSE_FLOOR, text.text), "--size=8x8", MAP, TRACED, "--spp=4", "--photons=1000",
                          "--caustic-photons=4e5", "--nearest=2000", "--only=indirect");
    const seeds_mean truth = seeds_exactly(bent * REFLECTANCE / PI);
    expect_same_mean("a point, bent", &measured.caustic, &truth, AGREEMENT_BLUR, 0.01);
}

/* A white floor under an even sky is as bright as the sky, also with a slab above it. */
static void test_furnace(void **state)
{
    (void)state;
    text.length = 0;
    slab_say(&text, SKY GLASS);
    slab_box(&text, vec3_make(-3, 0.5f, -3), vec3_make(3, 0.6f, 3));
    const char *scene = scene_of("Material \"diffuse\" \"rgb reflectance\" [1 1 1]\n", text.text);
    const agreement_means truth = agreement_uniform(1.0, 1.0, 1.0);
    for (int i = 0; i < 2; i++) {
        const agreement_means means =
            i == 0 ? OVER_SEEDS(scene, PATH, "--spp=16")
                   : OVER_SEEDS(scene, MAP, "--spp=4", "--photons=5e4", "--caustic-photons=1e5", "--nearest=500");
        expect_agreement(INTEGRATORS[i], &means, &truth,
                         (agreement_bounds){i == 0 ? 0.0 : AGREEMENT_BLUR, 0.005, 0.02});
    }
}

/* The eye sees slabs as glass that bends: a picture of one before a sky and a lamp, at its rims and within, is the same
 * to the bit whether panes are known or not. How samples are split is given, since the small picture beforehand would
 * choose it by what photons cost, which differs. */
static void test_seen(void **state)
{
    (void)state;
#define SMALL "--size=16x16", "--spp=4", "--gather-samples=4"
    static const char *const EYES[] = {"LookAt 3 0.02 0.1 0 0.02 0 0 1 0", "LookAt 0.2 2 0.3 0 0 0 0 0 1",
                                       "LookAt 0.2 0.03 0.3 1 0.1 0 0 1 0"};
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 2; k++) {
            text.length = 0;
            slab_say(&text, EYES[i]);
            slab_say(&text, "Camera \"perspective\" \"float fov\" 50\nWorldBegin\n" SKY LAMP("3", "1", "-1") GLASS);
            slab_box(&text, vec3_make(-1, 0, -1), vec3_make(1, 0.06f, 1));
            const char *scene = write_text("seen.pbrt", text.text);
            picture direct = RENDER(scene, SMALL, INTEGRATORS[k], FEW_PHOTONS, DIRECT);
            picture traced = RENDER(scene, SMALL, INTEGRATORS[k], FEW_PHOTONS, TRACED);
            assert_memory_equal(direct.pixels, traced.pixels, 3 * 16 * 16 * sizeof *direct.pixels);
            assert_true(picture_mean(&direct, 1) > 0.1);
            picture_reset(&direct);
            picture_reset(&traced);
        }
#undef SMALL
}

/* Below one slab the sun is direct light and no caustic; what floor and slab throw to and fro is indirect, and the
 * photon map has it of photons that came straight. */
static void test_layers(void **state)
{
    (void)state;
    text.length = 0;
    slab_say(&text, "LookAt 0 0.3 0 0 0 0 0 0 1 Camera \"perspective\" \"float fov\" 60\nWorldBegin\n" SUN GLASS);
    slab_box(&text, vec3_make(-4, 0.5f, -4), vec3_make(4, 0.6f, 4));
    slab_say(&text, DIFFUSE_FLOOR SQUARE("4", "0"));
    const char *scene = write_text("layers.pbrt", text.text);
    double radiance = 3.0 * thin_glass(1.0, 1.5) * REFLECTANCE / PI;
    layers map = LAYERS(scene, "--size=16x16", "--spp=4", "--gather-samples=4", "--photons=1e5", "--nearest=30");
    layers path = LAYERS(scene, "--size=16x16", "--spp=16", PATH);
    expect_near("straight", map.direct, radiance, 3e-4);
    expect_near("straight, paths", path.direct, radiance, 3e-4);
    const layers_means maps = LAYERS_OVER_SEEDS(scene, "--size=16x16", "--spp=8", "--gather-samples=16",
                                                "--photons=1e5", "--nearest=30"),
                       paths = LAYERS_OVER_SEEDS(scene, "--size=16x16", "--spp=128", PATH);
    expect_same_mean("to and fro", &maps.indirect, &paths.indirect, AGREEMENT_BLUR, 0.01);
    assert_true(map.specular == 0.0 && map.emission == 0.0 && path.specular == 0.0 && path.emission == 0.0);
    assert_true(map.caustic < 1e-3 * map.direct); /* the rims are far away */
}

/* Path tracing tells of light that it cannot find: bent by blocks, not by slabs. */
static void test_warning(void **state)
{
    (void)state;
    static const float HIGH[] = {1.5f, 41.0f};
    static const char *const MODES[] = {DIRECT, TRACED};
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 2; k++) {
            program_run run = RUN("--size=4x4", "--spp=1", PATH, MODES[k], "-o", "w.exr",
                                  scene_of(DIFFUSE_FLOOR, box_of(sun_at(1.0), 1.0f, HIGH[i])));
            expect_exit(&run, 0);
            assert_int_equal(strstr(run.err, "suns, points and spots") != NULL, i == 1 || k == 1);
            program_run_reset(&run);
        }
}

/* Double glazing with a bar across it, a showcase, a ball of glass. */
static void test_room(void **state)
{
    (void)state;
    expect_same_room(ROOM);
}

/* Paths that know slabs find the sun behind one, as the photon map does. */
static void test_sunny_room(void **state)
{
    (void)state;
    text.length = 0;
    slab_say(&text, GLASS);
    slab_box(&text, vec3_make(-2.03f, 0.9f, -1.1f), vec3_make(-2.02f, 2.3f, 1.1f));
    const char *scene = sunny_room(text.text);
    expect_same_light("sun, indirect", OVER_SEEDS(scene, SUNNY_PHOTONS, "--only=indirect"),
                      OVER_SEEDS(scene, PATHS, "--only=indirect"));
    expect_same_direct_light(scene);
}

static void test_same_bits(void **state)
{
    (void)state;
    expect_same_bits(ROOM);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_sun),        TEST_IN_FOLDER(test_absorption), TEST_IN_FOLDER(test_sky),
        TEST_IN_FOLDER(test_point),      TEST_IN_FOLDER(test_furnace),    TEST_IN_FOLDER(test_seen),
        TEST_IN_FOLDER(test_layers),     TEST_IN_FOLDER(test_warning),    TEST_IN_FOLDER(test_room),
        TEST_IN_FOLDER(test_sunny_room), TEST_IN_FOLDER(test_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
