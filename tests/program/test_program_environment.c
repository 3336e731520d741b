/* test_program_environment.c: light from all around: bodies in environments whose answer is known, and a box under a
 * sky that photon map and path tracer must show alike. Rests on: Pharr, Jakob, Humphreys, 4th ed., 2023, 4.2 (furnace
 * tests). Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_agreement.h"

#include "fixtures/environment_picture.h"
#include "light/environment.h"

static const double PI = 3.14159265358979323846;
static const char *const INTEGRATORS[] = {"--integrator=photonmap", "--integrator=path"};
enum { INTEGRATOR_COUNT = 2 };
static const agreement_bounds BOUNDS = {AGREEMENT_BLUR, 0.005, 0.03}, UNBIASED = {0.0, 0.003, 0.02};

static const char *spp_of(int integrator) { return integrator == 0 ? "--spp=8" : "--spp=64"; }

static const char *world_with(const char *name, const char *world)
{
    static const char *const HEAD = "LookAt 0 0 0  0 1 0  0 0 1\nCamera \"perspective\" \"float fov\" 90\n"
                                    "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 32\n"
                                    "PixelFilter \"box\"\nWorldBegin\n";
    char text[2048];
    snprintf(text, sizeof text, "%s%s\n", HEAD, world);
    return write_text(name, text);
}

/* ---- the same radiance from everywhere ---- */

static void test_convex_body(void **state)
{
    (void)state;
    const char *body_alone = SCENE_WITH("environment.pbrt", "53.13", "20");
    agreement_means exact = agreement_uniform(0.9, 0.9, 0.9);
    for (int k = 0; k < INTEGRATOR_COUNT; k++) {
        agreement_means means = agreement_render(body_alone, ARGUMENTS(INTEGRATORS[k], spp_of(k), "--photons=20000"));
        expect_agreement(INTEGRATORS[k], &means, &exact, UNBIASED);
        picture p = RENDER(PROGRAM_SCENES "environment.pbrt", INTEGRATORS[k], "--spp=4", "--photons=20000");
        for (int c = 0; c < 3; c++)
            expect_near(INTEGRATORS[k], picture_block(&p, 0, 0, 4, c), 1.5, 1e-6);
        picture_reset(&p);
        p = RENDER(PROGRAM_SCENES "environment.pbrt", INTEGRATORS[k], "--spp=4", "--photons=20000", "--only=indirect");
        for (int i = 0; i < p.width * p.height * 3; i++)
            assert_true(p.pixels[i] == 0.0f);
        picture_reset(&p);
    }
}

/* Two environments add up. */
static void test_floor(void **state)
{
    (void)state;
    const char *scene = write_text("scene.pbrt", "Include \"" PROGRAM_SCENES "floor.pbrt\"\n"
                                                 "LightSource \"infinite\" \"rgb L\" [1 0.5 0.2] \"float scale\" 2\n"
                                                 "LightSource \"infinite\" \"rgb L\" [0.1 0.2 2]\n");
    agreement_means exact = agreement_uniform(0.6 * 2.1, 0.6 * 1.2, 0.6 * 2.4);
    for (int k = 0; k < INTEGRATOR_COUNT; k++) {
        agreement_means means = agreement_render(scene, ARGUMENTS(INTEGRATORS[k], spp_of(k), "--photons=20000"));
        expect_agreement(INTEGRATORS[k], &means, &exact, UNBIASED);
    }
}

static void test_furnace(void **state)
{
    (void)state;
    agreement_means exact = agreement_uniform(1.5, 1.5, 1.5);
    for (int k = 0; k < INTEGRATOR_COUNT; k++) {
        agreement_means means = agreement_render(PROGRAM_SCENES "environment_furnace.pbrt",
                                                 ARGUMENTS(INTEGRATORS[k], spp_of(k), "--photons=1e5", "--nearest=8"));
        expect_agreement(INTEGRATORS[k], &means, &exact, k == 0 ? BOUNDS : UNBIASED);
    }
}

/* Glass cannot be seen either. */
static void test_glass(void **state)
{
    (void)state;
    const char *scene =
        SCENE_WITH("environment.pbrt", "\"diffuse\" \"rgb reflectance\" [0.6 0.6 0.6]", "\"dielectric\"");
    agreement_means exact = agreement_uniform(1.5, 1.5, 1.5);
    for (int k = 0; k < INTEGRATOR_COUNT; k++) {
        agreement_means means =
            agreement_render(scene, ARGUMENTS(INTEGRATORS[k], "--spp=32", "--photons=1000", "--caustic-photons=0"));
        expect_agreement(INTEGRATORS[k], &means, &exact, UNBIASED);
    }
}

static void test_nothing_else(void **state)
{
    (void)state;
    const char *scene = world_with("scene.pbrt", "LightSource \"infinite\" \"rgb L\" [1 2 3]");
    for (int k = 0; k < INTEGRATOR_COUNT; k++) {
        picture p = RENDER(scene, INTEGRATORS[k], "--spp=1");
        for (int i = 0; i < p.width * p.height * 3; i++)
            /* the shares of several camera rays are rounded */
            assert_true(fabsf(p.pixels[i] / (1.0f + (float)(i % 3)) - 1.0f) < 0x1p-21f);
        picture_reset(&p);
    }
}

/* ---- pictures ---- */

/* A camera sees each pixel where the mapping puts it. The world's axes are the light's, turned by the transform. */
static void test_what_the_eye_sees(void **state)
{
    (void)state;
    enum { SIZE = 4 };
    for (int wide = 0; wide < 2; wide++) {
        float pixels[2 * SIZE * SIZE * 3];
        int width = wide ? 2 * SIZE : SIZE;
        for (int i = 0; i < width * SIZE * 3; i++)
            pixels[i] = (float)(i + 1);
        write_environment("sky.exr", width, SIZE, IMAGE_FLOAT, pixels);
        /* pbrt's camera space is left-handed: who looks along y, z up, has -x to the right */
        const char *scene =
            world_with("scene.pbrt", "Rotate 90 0 0 1 LightSource \"infinite\" \"string filename\" \"sky.exr\"");
        picture p = RENDER(scene, "--integrator=path", "--spp=1");
        rgb copy[2 * SIZE * SIZE];
        memcpy(copy, pixels, sizeof(rgb) * (size_t)(width * SIZE));
        environment e = {.mapping = wide ? ENVIRONMENT_LATITUDE_LONGITUDE : ENVIRONMENT_OCTAHEDRAL,
                         .width = (uint32_t)width,
                         .height = SIZE,
                         .pixels = copy};
        int strangers = 0;
        for (int y = 0; y < p.height; y++)
            for (int x = 0; x < p.width; x++) {
                float across = 2.0f * ((float)x + 0.5f) / (float)p.width - 1.0f;
                float up = 1.0f - 2.0f * ((float)y + 0.5f) / (float)p.height;
                vec3 world = vec3_normalize(vec3_make(-across, 1.0f, up));
                uint32_t px, py; /* the light's x is the world's y, its y the world's -x */
                environment_pixel_at(&e, vec3_make(world.y, -world.x, world.z), &px, &py);
                strangers += p.pixels[3 * (y * p.width + x)] != pixels[3 * (py * (uint32_t)width + px)];
            }
        /* samples are anywhere in their pixels: those on borders may differ */
        assert_true(strangers < p.width * p.height / 6);
        picture_reset(&p);
    }
}

/* One bright pixel is all but a distant light: its irradiance on the floor. */
static void test_small_sun(void **state)
{
    (void)state;
    enum { SIZE = 32, X = 9, Y = 12 };
    for (int wide = 0; wide < 2; wide++) {
        static float pixels[2 * SIZE * SIZE * 3];
        int width = wide ? 2 * SIZE : SIZE, at = wide ? 6 * width + 20 : Y * width + X;
        memset(pixels, 0, sizeof pixels);
        pixels[3 * at] = 1000.0f, pixels[3 * at + 1] = 800.0f, pixels[3 * at + 2] = 100.0f;
        write_environment("sun.exr", width, SIZE, IMAGE_FLOAT, pixels);
        const char *scene = write_text("scene.pbrt", "Include \"" PROGRAM_SCENES "floor.pbrt\"\nRotate 37 0 0 1\n"
                                                     "LightSource \"infinite\" \"string filename\" \"sun.exr\"\n");
        environment e = {.mapping = wide ? ENVIRONMENT_LATITUDE_LONGITUDE : ENVIRONMENT_OCTAHEDRAL,
                         .width = (uint32_t)width,
                         .height = SIZE};
        double cosine = 0.0;
        uint32_t x = (uint32_t)(at % width), y = (uint32_t)(at / width);
        for (int i = 0; i < 16; i++)
            for (int j = 0; j < 16; j++)
                cosine +=
                    (double)environment_direction(&e, x, y, (vec2){((float)i + 0.5f) / 16, ((float)j + 0.5f) / 16}).z /
                    256;
        assert_true(cosine > 0.5);
        double expected = 0.6 / PI * 1000.0 * environment_pixel_solid_angle(&e, y) * cosine;
        agreement_means exact = agreement_uniform(expected, 0.8 * expected, 0.1 * expected);
        for (int k = 0; k < INTEGRATOR_COUNT; k++) {
            agreement_means means = agreement_render(scene, ARGUMENTS(INTEGRATORS[k], "--spp=4", "--photons=1000"));
            expect_agreement(INTEGRATORS[k], &means, &exact, UNBIASED);
        }
    }
}

/* A sky with a sun in it, and ground below. */
static void write_sky(void)
{
    enum { SIZE = 16 };
    static float pixels[SIZE * SIZE * 3];
    environment e = {.mapping = ENVIRONMENT_OCTAHEDRAL, .width = SIZE, .height = SIZE};
    for (uint32_t y = 0; y < SIZE; y++)
        for (uint32_t x = 0; x < SIZE; x++) {
            vec3 d = environment_direction(&e, x, y, (vec2){0.5f, 0.5f});
            float *p = pixels + 3 * (y * SIZE + x);
            bool is_sky = d.z > 0.0f;
            p[0] = is_sky ? 0.3f + 0.2f * d.x : 0.2f;
            p[1] = is_sky ? 0.5f : 0.15f;
            p[2] = is_sky ? 1.0f - 0.4f * d.z : 0.1f;
            if (x == 10 && y == 9)
                p[0] = 60.0f, p[1] = 50.0f, p[2] = 30.0f;
        }
    write_environment("sky.exr", SIZE, SIZE, IMAGE_FLOAT, pixels);
}

static void test_open_box(void **state)
{
    (void)state;
    const char *scene = SCENE_WITH("open_box.pbrt", "block.pbrt", PROGRAM_SCENES "block.pbrt");
    write_sky();
    compare_parts_by("open box", scene, ARGUMENTS(AGREEMENT_MAP, "--spp=12"),
                     ARGUMENTS("--integrator=path", "--spp=64"), BOUNDS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_convex_body), TEST_IN_FOLDER(test_floor),        TEST_IN_FOLDER(test_furnace),
        TEST_IN_FOLDER(test_glass),       TEST_IN_FOLDER(test_nothing_else), TEST_IN_FOLDER(test_what_the_eye_sees),
        TEST_IN_FOLDER(test_small_sun),   TEST_IN_FOLDER(test_open_box),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
