/* test_program_lights.c: lights with pictures, windows, and many lamps in a room: photon map and path tracer show the
 * same. Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_agreement.h"

#include "fixtures/environment_picture.h"
#include "light/environment.h"

static const double PI = 3.14159265358979323846;

#define WINDOW "\"point3 portal\" [1 -0.5 0.6  1 -0.5 1.6  1 0.5 1.6  1 0.5 0.6]"

static const char *room_with(const char *lights)
{
    return SCENE_WITH("window_room.pbrt", "THE_LIGHTS", lights, "block.pbrt", PROGRAM_SCENES "block.pbrt");
}

static const agreement_bounds BOUNDS = {AGREEMENT_BLUR, 0.006, 0.03};
static const agreement_bounds UNBIASED = {0.0, 0.005, 0.03};

static void compare(const char *what, const char *scene, const char *samples, const char *path_samples,
                    const char *only)
{
    compare_integrators_by(what, scene, ARGUMENTS(AGREEMENT_MAP, samples, only),
                           ARGUMENTS("--integrator=path", path_samples, only), BOUNDS);
}

/* All light, and indirect light alone. */
static void compare_both(const char *what, const char *lights)
{
    compare_parts_by(what, room_with(lights), ARGUMENTS(AGREEMENT_MAP, "--spp=8"),
                     ARGUMENTS("--integrator=path", "--spp=32"), BOUNDS);
}

/* ---- pictures ---- */

static void write_sky(void)
{
    enum { SIZE = 32 };
    static float pixels[SIZE * SIZE * 3];
    environment e = {.mapping = ENVIRONMENT_OCTAHEDRAL, .width = SIZE, .height = SIZE};
    for (uint32_t y = 0; y < SIZE; y++)
        for (uint32_t x = 0; x < SIZE; x++) {
            vec3 d = environment_direction(&e, x, y, (vec2){0.5f, 0.5f});
            float *p = pixels + 3 * (y * SIZE + x);
            bool is_sky = d.z > 0.0f, is_sun = d.x > 0.78f && d.z > 0.5f && d.y > 0.0f && d.y < 0.2f;
            p[0] = is_sun ? 60.0f : is_sky ? 0.5f + 0.2f * d.y : 0.3f;
            p[1] = is_sun ? 50.0f : is_sky ? 0.7f : 0.25f;
            p[2] = is_sun ? 30.0f : is_sky ? 1.0f - 0.4f * d.z : 0.2f;
        }
    write_environment("sky.exr", SIZE, SIZE, IMAGE_FLOAT, pixels);
}

/* Bright on the left, a third of that and bluer on the right. */
static void write_two_tones(const char *name)
{
    enum { SIZE = 16 };
    static float pixels[SIZE * SIZE * 3];
    for (int i = 0; i < SIZE * SIZE; i++) {
        bool is_left = i % SIZE < SIZE / 2;
        pixels[3 * i] = is_left ? 3.0f : 0.4f, pixels[3 * i + 1] = is_left ? 2.4f : 0.8f;
        pixels[3 * i + 2] = is_left ? 1.2f : 1.0f;
    }
    write_environment(name, SIZE, SIZE, IMAGE_FLOAT, pixels);
}

static void test_goniometric(void **state)
{
    (void)state;
    write_two_tones("lamp.exr");
    compare_both("goniometric", "Translate 0.2 -0.3 1.4 LightSource \"goniometric\" \"string filename\" \"lamp.exr\"");
}

static void test_projection(void **state)
{
    (void)state;
    write_two_tones("slide.exr");
    compare_both("projection",
                 "Translate -0.5 0 1 Rotate 70 0 1 0 LightSource \"projection\" \"float fov\" 70 \"string "
                 "filename\" \"slide.exr\"");
}

static void test_textured_lamps(void **state)
{
    (void)state;
    write_two_tones("screen.exr");
    compare_both("textured lamps",
                 "AreaLightSource \"diffuse\" \"string filename\" \"screen.exr\"\n"
                 "Shape \"bilinearmesh\" \"point3 P\" [-0.5 -0.4 1.98  -0.5 0.4 1.98  0.5 -0.4 1.98  0.5 0.4 1.98]\n"
                 "Translate -0.5 0.6 0.5 Shape \"sphere\" \"float radius\" 0.2");
}

static void test_portal(void **state)
{
    (void)state;
    write_sky();
    compare_both("window", "LightSource \"infinite\" \"string filename\" \"sky.exr\" " WINDOW);
}

/* Where the window is the only way in, all that the portal changes is the noise. */
static void test_portal_adds_nothing(void **state)
{
    (void)state;
    write_sky();
    agreement_means with =
        agreement_render(room_with("LightSource \"infinite\" \"string filename\" \"sky.exr\" " WINDOW),
                         ARGUMENTS("--integrator=path", "--spp=64"));
    agreement_means without = agreement_render(room_with("LightSource \"infinite\" \"string filename\" \"sky.exr\""),
                                               ARGUMENTS("--integrator=path", "--spp=96"));
    expect_agreement("with and without a portal", &with, &without, UNBIASED);
}

/* On a floor that is seen from above, x and y from -1 to 1, of which the eye may see either mirrored: light of a window
 * of radiance 1 in the plane x = 3, as high as it is far, y from -2 to 2; mean over both ways to see it. Irradiance is
 * that of an emitting rectangle, by the form factor of a small area and a rectangle (Siegel, Howell, "Thermal Radiation
 * Heat Transfer", configuration 4 of the catalogue's differential planes): z from 0 to c, y from 0 to b, at distance a:
 * E = L / 2 (atan(b/a) - a / sqrt(a^2 + c^2) atan(b / sqrt(a^2 + c^2))). */
static void floor_by_a_portal(const void *mirrored, double x, double y, double out_rgb[3])
{
    double wx = (*(const bool *)mirrored ? -1.0 : 1.0) * (2.0 * x - 1.0), wy = 2.0 * y - 1.0;
    double a = 3.0 - wx, c = 3.0, s = sqrt(a * a + c * c), irradiance = 0.0;
    for (int side = -1; side <= 1; side += 2) {
        double b = 2.0 + side * wy;
        irradiance += 0.5 * (atan(b / a) - a / s * atan(b / s));
    }
    out_rgb[0] = 2.0 * 0.6 / PI * irradiance;
    out_rgb[1] = 0.5 * out_rgb[0];
    out_rgb[2] = 0.25 * out_rgb[0];
}

/* A floor lit through a window of constant radiance in a plane at right angles to it. The eye sees nothing of the sky
 * beside the portal. */
static void test_floor_under_a_portal(void **state)
{
    (void)state;
    const char *scene =
        write_text("scene.pbrt",
                   "Include \"" PROGRAM_SCENES "floor.pbrt\"\n"
                   "LightSource \"infinite\" \"rgb L\" [2 1 0.5] \"point3 portal\" [3 -2 0  3 -2 3  3 2 3  3 2 0]\n");
    const bool is_mirrored = true;
    agreement_means exact = agreement_exact(floor_by_a_portal, &is_mirrored);
    for (int k = 0; k < 2; k++) {
        agreement_means means = agreement_render(
            scene, ARGUMENTS(k ? "--integrator=path" : "--integrator=photonmap", "--spp=16", "--photons=20000"));
        expect_agreement(k ? "a floor by a portal, paths" : "a floor by a portal", &means, &exact, UNBIASED);
    }
    /* towards the sky: through the portal, and beside it */
    scene = write_text("sky.pbrt", "LookAt 0 0 0  1 0 0  0 0 1\nCamera \"perspective\" \"float fov\" 90\n"
                                   "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\n"
                                   "PixelFilter \"box\"\nWorldBegin\n"
                                   "LightSource \"infinite\" \"rgb L\" [2 1 0.5]\n"
                                   "\"point3 portal\" [2 -1 -1  2 -1 1  2 1 1  2 1 -1]\n");
    for (int k = 0; k < 2; k++) {
        picture p = RENDER(scene, "--integrator", k ? "path" : "photonmap", "--spp=4");
        for (int y = 0; y < p.height; y++)
            for (int x = 0; x < p.width; x++) {
                bool is_through = x >= 4 && x < 12 && y >= 4 && y < 12;
                assert_true(p.pixels[3 * (y * p.width + x)] == (is_through ? 2.0f : 0.0f));
            }
        picture_reset(&p);
    }
}

/* ---- many lights ---- */

/* Thirty lamps of three kinds, a faint sky at the window and a sun that falls in. */
static void write_lamps(char *text, size_t size)
{
    size_t at = 0;
    for (int i = 0; i < 30; i++) {
        double x = -0.5 + 0.3 * (i % 5), y = -0.4 + 0.4 * (i / 5 % 3), z = 0.9 + 0.6 * (i / 15);
        const char *kind = i % 3 == 0 ? "LightSource \"point\" \"float scale\" 0.05"
                           : i % 3 == 1
                               ? "AreaLightSource \"diffuse\" \"float scale\" 2 Shape \"sphere\" \"float radius\" 0.04"
                               : "Rotate 180 1 0 0 LightSource \"spot\" \"float scale\" 0.2";
        at += (size_t)snprintf(text + at, size - at, "AttributeBegin Translate %.3f %.3f %.3f %s AttributeEnd\n", x, y,
                               z, kind);
        assert_true(at < size);
    }
    snprintf(text + at, size - at,
             "LightSource \"distant\" \"point3 from\" [1 0.1 0.8] \"point3 to\" [0 0 0] \"float scale\" 2\n"
             "LightSource \"infinite\" \"rgb L\" [0.2 0.4 0.8] " WINDOW "\n");
}

static void test_many_lamps(void **state)
{
    (void)state;
    char text[8192];
    write_lamps(text, sizeof text);
    compare("many lamps", room_with(text), "--spp=16", "--spp=48", NULL);
}

/* A square of so many lamps side by side, in a file of its own. */
static const char *room_under_lamps(int side)
{
    char text[1024];
    const char *path = in_folder(side == 1 ? "one.pbrt" : "lamps.pbrt");
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    for (int i = 0; i < side * side; i++) {
        double size = 0.8 / side, x = -0.4 + size * (i % side), y = -0.4 + size * (i / side);
        fprintf(file,
                "AreaLightSource \"diffuse\" \"rgb L\" [4 3 2] \"bool twosided\" true Shape \"bilinearmesh\" "
                "\"point3 P\" [%.9g %.9g 1.7 %.9g %.9g 1.7 %.9g %.9g 1.7 %.9g %.9g 1.7]\n",
                x, y, x + size, y, x, y + size, x + size, y + size);
    }
    assert_int_equal(fclose(file), 0);
    snprintf(text, sizeof text, "AttributeBegin Include \"%s\" AttributeEnd", path);
    return room_with(text);
}

/* Side by side they are one large lamp, whichever of them each shadow ray picks and each photon leaves. */
static void test_a_thousand_lamps_are_one(void **state)
{
    (void)state;
    agreement_means one = agreement_render(room_under_lamps(1), ARGUMENTS("--integrator=path", "--spp=64"));
    const char *scene = room_under_lamps(32);
    agreement_means paths = agreement_render(scene, ARGUMENTS("--integrator=path", "--spp=64"));
    agreement_means map = agreement_render(scene, ARGUMENTS(AGREEMENT_MAP, "--spp=16"));
    expect_agreement("a thousand lamps, paths", &paths, &one, UNBIASED);
    expect_agreement("a thousand lamps", &map, &one, BOUNDS);
}

/* "photons" 0 takes a lamp's light out of the map, and leaves it in direct light; another factor changes noise
 * alone. */
static void test_photons(void **state)
{
    (void)state;
    const char *scene = room_with("LightSource \"point\" \"point3 from\" [0 0 1] \"float photons\" 0");
    picture p = RENDER(scene, "--only=indirect", "--spp=4", "--photons=10000");
    for (int i = 0; i < p.width * p.height * 3; i++)
        assert_true(p.pixels[i] == 0.0f);
    picture_reset(&p);
    p = RENDER(scene, "--spp=4", "--photons=10000");
    assert_true(picture_mean(&p, 0) > 0.05);
    picture_reset(&p);
    compare("a quarter of the photons",
            room_with("LightSource \"point\" \"point3 from\" [0 0 1] \"float photons\" 0.25\n"
                      "LightSource \"point\" \"point3 from\" [0.5 -0.5 0.4] \"rgb I\" [0.1 0.2 1]"),
            "--spp=8", "--spp=32", "--only=indirect");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_goniometric),
        TEST_IN_FOLDER(test_projection),
        TEST_IN_FOLDER(test_textured_lamps),
        TEST_IN_FOLDER(test_portal),
        TEST_IN_FOLDER(test_portal_adds_nothing),
        TEST_IN_FOLDER(test_floor_under_a_portal),
        TEST_IN_FOLDER(test_many_lamps),
        TEST_IN_FOLDER(test_photons),
        TEST_IN_FOLDER(test_a_thousand_lamps_are_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
