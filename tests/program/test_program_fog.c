/* test_program_fog.c: pictures of media that scatter light: those whose answer is known, which the scenes derive in
 * their heads, and rooms without a closed form, where photon map and path tracer must show the same light. Flow: tests
 * of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_agreement.h"

static const double PI = 3.14159265358979323846;
static const char *const INTEGRATORS[] = {"--integrator=photonmap", "--integrator=path"};
enum { INTEGRATOR_COUNT = 2 };
static const agreement_bounds BLURRED = {AGREEMENT_BLUR, 0.01, 0.05};
static const agreement_bounds UNBIASED = {0.0, 0.005, 0.03};

/* A medium that absorbs nothing, under an even sky of radiance 1, is seen with radiance 1, however it scatters. */
static void test_furnace(void **state)
{
    (void)state;
    const agreement_means white = agreement_uniform(1.0, 1.0, 1.0);
    static const char *const G[] = {"g\" 0.4", "g\" 0", "g\" -0.8"};
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < INTEGRATOR_COUNT; k++) {
            const char *scene = SCENE_WITH("fog_furnace.pbrt", "g\" 0.4", G[i]);
            char what[64];
            snprintf(what, sizeof what, "furnace, %s, %s", G[i], INTEGRATORS[k]);
            agreement_means found = agreement_render(scene, ARGUMENTS(INTEGRATORS[k], "--spp=64", "--photons=1000"));
            expect_agreement(what, &found, &white, UNBIASED);
        }
}

/* Neither does it where light is scattered hundreds of times: across the ball are 40 and 400 mean free paths. */
static void test_thick_furnace(void **state)
{
    (void)state;
    const agreement_means white = agreement_uniform(1.0, 1.0, 1.0);
    static const char *const THICK[] = {"sigma_s\" [20 20 20]", "sigma_s\" [200 200 200]"};
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < INTEGRATOR_COUNT; k++) {
            const char *scene = SCENE_WITH("fog_furnace.pbrt", "sigma_s\" [1 2 3]", THICK[i], "g\" 0.4", "g\" 0");
            char what[64];
            snprintf(what, sizeof what, "furnace, %s, %s", THICK[i], INTEGRATORS[k]);
            agreement_means found = agreement_render(scene, ARGUMENTS(INTEGRATORS[k], "--spp=8", "--photons=1000"));
            expect_agreement(what, &found, &white, (agreement_bounds){0.0, i == 0 ? 0.005 : 0.008, 0.03});
        }
}

/* Eye and fog in a ball that shines by 1 and reflects a half: of that is 2 everywhere. */
static void test_shining_wall(void **state)
{
    (void)state;
    const agreement_means two = agreement_uniform(2.0, 2.0, 2.0);
    for (int k = 0; k < INTEGRATOR_COUNT; k++) {
        const char *scene = SCENE_WITH(
            "fog_furnace.pbrt", "LookAt 0 0 -3", "MediumInterface \"\" \"fog\" LookAt 0 0 0.5",
            "LightSource \"infinite\" \"rgb L\" [1 1 1]", "AreaLightSource \"diffuse\"", "Material \"interface\"",
            "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5] ReverseOrientation", "\"fog\" \"\"",
            "\"\" \"fog\"");
        agreement_means found = agreement_render(scene, ARGUMENTS(INTEGRATORS[k], AGREEMENT_MAP, "--spp=48"));
        expect_agreement(INTEGRATORS[k], &found, &two, k == 0 ? BLURRED : UNBIASED);
    }
}

static const double ABSORBED[3] = {0.1, 0.3, 0.0}, SCATTERED[3] = {0.4, 0.2, 2.0};

/* The integral of fog_slab.pbrt by midpoints, also for an eye below. cosine: of the angle by which light turns. */
static double scattered_once(int c, double cosine, bool is_below)
{
    enum { STEPS = 20000 };
    const double g = 0.35, depth = 0.5, lost = ABSORBED[c] + SCATTERED[c];
    double square = 1.0 + g * g - 2.0 * g * cosine, sum = 0.0;
    for (int i = 0; i < STEPS; i++) {
        double z = depth * (i + 0.5) / STEPS, back = is_below ? depth - z : z;
        sum += exp(-lost * (z / 0.8 + back / 0.6)) * depth / STEPS;
    }
    return 2.0 * (1.0 - g * g) / (4.0 * PI * square * sqrt(square)) * SCATTERED[c] / 0.6 * sum;
}

static void test_slab_scatters_once(void **state)
{
    (void)state;
    static const struct {
        const char *look_at;
        double cosine; /* of the sun's direction (0.6, 0, -0.8) and the light's to the eye */
        bool is_below;
    } VIEWS[] = {{"LookAt -4 0 3", -0.96, false}, {"LookAt 4 0 3", 0.0, false}, {"LookAt 4 0 -3", 0.96, true}};
    for (int v = 0; v < 3; v++) {
        const char *scene = SCENE_WITH("fog_slab.pbrt", "LookAt -4 0 3", VIEWS[v].look_at);
        double expected[3];
        for (int c = 0; c < 3; c++)
            expected[c] = scattered_once(c, VIEWS[v].cosine, VIEWS[v].is_below);
        const agreement_means truth = agreement_uniform(expected[0], expected[1], expected[2]);
        for (int k = 0; k < INTEGRATOR_COUNT; k++) {
            agreement_means found = agreement_render(scene, ARGUMENTS(INTEGRATORS[k], "--spp=128", "--max-depth=1"));
            expect_agreement(VIEWS[v].look_at, &found, &truth, UNBIASED);
        }
    }
}

/* The radiance of absorbing_slab.pbrt, whose slab takes as much out of the way by scattering and absorbing. */
static void radiance_of_floor(const void *lost, double x, double y, double out_rgb[3])
{
    const double *sigma = lost, at_x = 1.0 - 2.0 * x, at_y = 1.0 - 2.0 * y;
    double d = sqrt((at_x - 0.3) * (at_x - 0.3) + (at_y - 0.2) * (at_y - 0.2) + 2.25);
    double v = sqrt(at_x * at_x + at_y * at_y + 1.0);
    for (int c = 0; c < 3; c++)
        out_rgb[c] = 0.6 / PI * 10.0 * 1.5 / (d * d * d) * exp(-sigma[c] * (d / 3.0 + v / 2.0));
}

/* Fog before an empty background hides what it scatters or absorbs, and lets through the rest: at a cosine of 0.6. */
static void test_alpha(void **state)
{
    (void)state;
    static const char *const MEDIA[] = {"sigma_s\" [0.4 0.2 2]", "sigma_s\" [0 0 0]"};
    for (int m = 0; m < 2; m++) {
        double expected = 1.0;
        for (int c = 0; c < 3; c++)
            expected -= exp(-(ABSORBED[c] + (m == 0 ? SCATTERED[c] : 0.0)) * 0.5 / 0.6) / 3.0;
        for (int k = 0; k < INTEGRATOR_COUNT; k++) {
            const char *scene = SCENE_WITH("fog_slab.pbrt", MEDIA[0], MEDIA[m]);
            image read = render_image(
                scene, ARGUMENTS(INTEGRATORS[k], "--aov=A", "--spp=64", "--photons=1000", "--max-depth=1"));
            assert_int_equal(read.channel_count, 4);
            double sum = 0.0;
            int count = read.width * read.height;
            for (int i = 0; i < count; i++)
                sum += (double)read.pixels[4 * i + 3] / count;
            /* without scattering there is no chance in it */
            double most = m == 0 ? 4.0 * sqrt(expected * (1.0 - expected) / (64.0 * count)) : 1e-5;
            print_message("alpha of %s by %s: %.6f of %.6f\n", MEDIA[m], INTEGRATORS[k], sum, expected);
            assert_true(fabs(sum - expected) < most);
            image_reset(&read);
        }
    }
}

/* The layer of direct light holds what no medium has scattered. */
static void test_direct_light_is_what_is_not_scattered(void **state)
{
    (void)state;
    static const double LOST[3] = {0.5, 1.0, 1.5};
    const agreement_means truth = agreement_exact(radiance_of_floor, LOST);
    for (int k = 0; k < INTEGRATOR_COUNT; k++) {
        const char *scene = SCENE_WITH("absorbing_slab.pbrt", "sigma_s\" [0 0 0] \"rgb sigma_a\" [0.5 1 3]",
                                       "sigma_s\" [0.4 0.5 1.5] \"rgb sigma_a\" [0.1 0.5 0]");
        agreement_parts found =
            agreement_over_seeds(scene, ARGUMENTS(INTEGRATORS[k], "--spp=128", "--photons=1000"), "--aov=direct");
        expect_agreement(INTEGRATORS[k], &found.indirect, &truth, UNBIASED);
    }
}

/* Nothing of a lamp's light comes from infinitely far through a medium without bound that scatters, and photons of the
 * sun are none there. */
static void test_sun_in_a_boundless_fog(void **state)
{
    (void)state;
    for (int k = 0; k < INTEGRATOR_COUNT; k++) {
        const char *scene =
            SCENE_WITH("fog_slab.pbrt", "LookAt", "MediumInterface \"\" \"fog\" LookAt", "Material \"interface\"",
                       "Material \"diffuse\"", "MediumInterface \"fog\" \"\"", "MediumInterface \"fog\" \"fog\"",
                       "LightSource", "MediumInterface \"fog\" LightSource");
        picture p = RENDER(scene, INTEGRATORS[k], "--spp=4", "--photons=1000");
        for (int c = 0; c < 3; c++)
            assert_true(picture_mean(&p, c) == 0.0);
        picture_reset(&p);
    }
}

static void test_room_with_a_lamp(void **state)
{
    (void)state;
    compare_integrators("foggy_room", "--spp=192", NULL, BLURRED);
    compare_integrators("foggy_room", "--spp=192", "--only=indirect", BLURRED);
}

static void test_room_with_a_window(void **state)
{
    (void)state;
    compare_integrators("foggy_window", "--spp=384", NULL, BLURRED);
}

/* The parts that light from a medium belongs to are the same by both. */
static void test_layers(void **state)
{
    (void)state;
    static const char *const LAYERS[] = {"--aov=indirect", "--aov=specular"};
    const char *scene = PROGRAM_SCENES "foggy_room.pbrt";
    for (int i = 0; i < 2; i++) {
        agreement_parts map = agreement_over_seeds(scene, ARGUMENTS(AGREEMENT_MAP, "--spp=12"), LAYERS[i]);
        agreement_parts path = agreement_over_seeds(scene, ARGUMENTS("--integrator=path", "--spp=192"), LAYERS[i]);
        expect_agreement(LAYERS[i], &map.indirect, &path.indirect, (agreement_bounds){AGREEMENT_BLUR, 0.01, 0.08});
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_furnace),
        TEST_IN_FOLDER(test_thick_furnace),
        TEST_IN_FOLDER(test_shining_wall),
        TEST_IN_FOLDER(test_slab_scatters_once),
        TEST_IN_FOLDER(test_alpha),
        TEST_IN_FOLDER(test_direct_light_is_what_is_not_scattered),
        TEST_IN_FOLDER(test_sun_in_a_boundless_fog),
        TEST_IN_FOLDER(test_room_with_a_lamp),
        TEST_IN_FOLDER(test_room_with_a_window),
        TEST_IN_FOLDER(test_layers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
