/* test_texture.c: textures of scenes against values known otherwise: kinds, mappings, wraps and encodings, pictures
 * written for it. Flow: tests of scene/texture*.c and scene/image/image_encoding.c. Threads: one, but for the last. */
#define _GNU_SOURCE
#include "fixtures/texture_fixture.h"
#include "texture/texture_noise.h"

#include <math.h>
#include <pthread.h>

static const double PI = 3.14159265358979323846;

/* 3 x 2, grey: 0 0.1 0.2 above, 0.4 0.6 1 below. */
static const float GREYS[6] = {0.0f, 0.1f, 0.2f, 0.4f, 0.6f, 1.0f};

static double srgb(double v) { return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4); }

/* ---- what has no picture ---- */

static void constants_scales_and_mixes(void **state)
{
    (void)state;
    const surface_hit hit = hit_at(0.5f, 0.5f, 0.0f, 0.0f, 0.0f);
    assert_near(float_of("Texture \"a\" \"float\" \"constant\"", hit), 1.0, 0.0);
    assert_near(float_of("Texture \"a\" \"float\" \"constant\" \"float value\" -2.5", hit), -2.5, 0.0);
    assert_rgb(rgb_of("Texture \"a\" \"spectrum\" \"constant\" \"rgb value\" [ 0.1 0.2 0.3 ]", hit), 0.1, 0.2, 0.3,
               1e-7);
    assert_near(float_of("Texture \"a\" \"float\" \"scale\"", hit), 1.0, 0.0);
    assert_rgb(
        rgb_of("Texture \"f\" \"float\" \"bilerp\" \"float v00\" 2 \"float v01\" 2 \"float v10\" 2 \"float v11\" 2 "
               "Texture \"a\" \"spectrum\" \"scale\" \"rgb tex\" [ 0.1 0.2 0.4 ] \"texture scale\" \"f\"",
               hit),
        0.2, 0.4, 0.8, 1e-6);
    assert_near(float_of("Texture \"a\" \"float\" \"mix\"", hit), 0.5, 0.0);
    assert_rgb(rgb_of("Texture \"a\" \"spectrum\" \"mix\" \"rgb tex1\" [ 1 0 0 ] \"rgb tex2\" [ 0 1 0.5 ] "
                      "\"float amount\" 0.25",
                      hit),
               0.75, 0.25, 0.125, 1e-7);
    /* the normal is (0, 0.6, 0.8); tex1 where it points along dir */
    assert_near(float_of("Texture \"a\" \"float\" \"directionmix\"", hit), 0.4, 1e-6);
    assert_near(
        float_of("Rotate 90 1 0 0 Texture \"a\" \"float\" \"directionmix\" \"float tex1\" 5 \"float tex2\" 0", hit),
        4.0, 1e-5);
    assert_near(float_of("Texture \"a\" \"float\" \"directionmix\" \"vector3 dir\" [ 0 -6 -8 ] \"float tex1\" 5", hit),
                5.0, 1e-5);
}

static void bilerp_is_bilinear(void **state)
{
    (void)state;
    const surface_hit hit = hit_at(0.25f, 0.75f, 0.0f, 0.0f, 0.0f);
    assert_near(float_of("Texture \"a\" \"float\" \"bilerp\"", hit), 0.75, 1e-7); /* v by default */
    const double expected = 0.75 * 0.25 * 1 + 0.75 * 0.75 * 2 + 0.25 * 0.25 * 4 + 0.25 * 0.75 * 8;
    assert_near(
        float_of("Texture \"a\" \"float\" \"bilerp\" \"float v00\" 1 \"float v01\" 2 \"float v10\" 4 \"float v11\" 8",
                 hit),
        expected, 1e-6);
    assert_rgb(rgb_of("Texture \"a\" \"spectrum\" \"bilerp\" \"rgb v00\" [ 1 0 0 ] \"rgb v01\" [ 0 1 0 ] "
                      "\"rgb v10\" [ 0 0 1 ] \"rgb v11\" [ 0 0 0 ]",
                      hit),
               0.1875, 0.5625, 0.0625, 1e-6);
}

/* The mappings show through bilerp, which is s or t itself. */
#define S_ITSELF "Texture \"a\" \"float\" \"bilerp\" \"float v00\" 0 \"float v01\" 0 \"float v10\" 1 \"float v11\" 1 "
#define T_ITSELF "Texture \"a\" \"float\" \"bilerp\" "

static void assert_st(const char *before, const char *mapping, surface_hit hit, double s, double t)
{
    char world[1024];
    snprintf(world, sizeof world, "%s %s %s", before, S_ITSELF, mapping);
    assert_near(float_of(world, hit), s, 2e-6);
    snprintf(world, sizeof world, "%s %s %s", before, T_ITSELF, mapping);
    assert_near(float_of(world, hit), t, 2e-6);
}

static void mappings(void **state)
{
    (void)state;
    const surface_hit hit = hit_at(0.25f, 0.75f, 1.0f, -2.0f, 0.5f);
    assert_st("", "", hit, 0.25, 0.75);
    assert_st("", "\"float uscale\" 4 \"float vscale\" -2 \"float udelta\" 0.5 \"float vdelta\" 3", hit, 1.5, 1.5);
    assert_st("", "\"string mapping\" \"planar\"", hit, 1.0, -2.0);
    assert_st("Translate 1 1 1 Scale 2 2 2",
              "\"string mapping\" \"planar\" \"vector3 v1\" [ 0 2 0 ] \"vector3 v2\" [ 1 0 -4 ] \"float udelta\" 0.5 "
              "\"float vdelta\" 0.125",
              hit, 2.0 * -1.5 + 0.5, 0.0 + 4.0 * 0.25 + 0.125);
    const double r = sqrt(5.0), theta = atan2(r, 0.5), phi = atan2(-2.0, 1.0);
    assert_st("", "\"string mapping\" \"spherical\"", hit, theta / PI, phi / (2.0 * PI) + 1.0);
    assert_st("Rotate 90 0 0 1", "\"string mapping\" \"spherical\"", hit, theta / PI, phi / (2.0 * PI) + 0.75);
    assert_st("", "\"string mapping\" \"cylindrical\"", hit, (phi + PI) / (2.0 * PI), 0.5);
    assert_st("Translate 0 0 -3 Scale 1 1 2", "\"string mapping\" \"cylindrical\"", hit_at(0, 0, -1.0f, 1.0f, 0.5f),
              (0.75 * PI + PI) / (2.0 * PI), 1.75);
}

static void checkerboards(void **state)
{
    (void)state;
    reading r = good_world("Texture \"a\" \"float\" \"checkerboard\" \"float uscale\" 8 \"float vscale\" 4");
    for (int i = 0; i < 8; i++)
        for (int j = 0; j < 4; j++)
            assert_near(last_float(&r, hit_at(((float)i + 0.3f) / 8.0f, ((float)j + 0.7f) / 4.0f, 0, 0, 0)),
                        (i + j) % 2 == 0, 0.0);
    assert_near(last_float(&r, hit_at(-0.01f, 0.1f, 0, 0, 0)), 0.0, 0.0);
    assert_near(last_float(&r, hit_at(-0.01f, -0.1f, 0, 0, 0)), 1.0, 0.0);
    assert_near(last_float(&r, hit_at(1e30f, 0.1f, 0, 0, 0)), 1.0, 0.0); /* whole and even, like all such */
    reading_destroy(&r);

    r = good_world("Scale 2 2 2 Texture \"a\" \"spectrum\" \"checkerboard\" \"integer dimension\" 3 "
                   "\"rgb tex1\" [ 1 0.5 0 ] \"rgb tex2\" [ 0 0 0.25 ]");
    for (int i = -2; i < 2; i++)
        for (int j = -2; j < 2; j++)
            for (int k = -2; k < 2; k++) {
                const bool even = (i + j + k) % 2 == 0;
                assert_rgb(
                    last_rgb(&r, hit_at(0, 0, 2.0f * (float)i + 0.4f, 2.0f * (float)j + 1.8f, 2.0f * (float)k + 1)),
                    even ? 1.0 : 0.0, even ? 0.5 : 0.0, even ? 0.0 : 0.25, 0.0);
            }
    reading_destroy(&r);
}

/* Cells around whole numbers have a dot of radius 0.35, or none, by the noise at their corner; all of it lies
 * inside. */
static void dots_fill_their_share(void **state)
{
    (void)state;
    reading r = good_world("Texture \"a\" \"float\" \"dots\" \"float inside\" 3 \"float outside\" -1 "
                           "\"float uscale\" 40 \"float vscale\" 40");
    enum { CELLS = 24, STEPS = 20 };
    int dot_count = 0, inside_count = 0;
    for (int i = 0; i < CELLS; i++)
        for (int j = 0; j < CELLS; j++) {
            int inside = 0;
            for (int k = 0; k < STEPS * STEPS; k++) {
                const float s = (float)i - 0.5f + ((float)(k / STEPS) + 0.5f) / STEPS;
                const float t = (float)j - 0.5f + ((float)(k % STEPS) + 0.5f) / STEPS;
                const float value = last_float(&r, hit_at(s / 40.0f, t / 40.0f, 0, 0, 0));
                assert_true(value == 3.0f || value == -1.0f);
                inside += value == 3.0f;
            }
            const bool has_dot = texture_noise(vec3_make((float)i + 0.5f, (float)j + 0.5f, 0.5f)) > 0.0f;
            assert_int_equal(inside > 0, has_dot);
            dot_count += has_dot;
            inside_count += inside;
        }
    assert_true(dot_count > CELLS * CELLS / 4 && dot_count < CELLS * CELLS * 3 / 4);
    assert_near((double)inside_count / dot_count / (STEPS * STEPS), PI * 0.35 * 0.35, 0.005);
    reading_destroy(&r);
}

/* ---- pictures ---- */

static void lookups_are_bilinear(void **state)
{
    (void)state;
    write_image("a.exr", 3, 2, 1, IMAGE_FLOAT, GREYS);
    reading r = good_world("Texture \"a\" \"float\" \"imagemap\" \"string filename\" \"a.exr\"");
    for (int y = 0; y < 2; y++) /* in the middle of a pixel its own value; v grows upwards */
        for (int x = 0; x < 3; x++)
            assert_near(last_float(&r, hit_at(((float)x + 0.5f) / 3.0f, 1.0f - ((float)y + 0.5f) / 2.0f, 0, 0, 0)),
                        (double)GREYS[3 * y + x], 1e-6);
    assert_near(last_float(&r, hit_at(0.5f, 0.5f, 0, 0, 0)), 0.35, 1e-6);
    assert_near(last_float(&r, hit_at(1.0f / 3.0f, 0.75f, 0, 0, 0)), 0.05, 1e-6);
    reading_destroy(&r);
    r = good_world("Texture \"a\" \"spectrum\" \"imagemap\" \"string filename\" \"a.exr\" \"string filter\" \"point\"");
    assert_rgb(last_rgb(&r, hit_at(0.34f, 0.99f, 0, 0, 0)), 0.1, 0.1, 0.1, 1e-7);
    assert_rgb(last_rgb(&r, hit_at(0.65f, 0.51f, 0, 0, 0)), 0.1, 0.1, 0.1, 1e-7);
    assert_rgb(last_rgb(&r, hit_at(0.68f, 0.49f, 0, 0, 0)), 1.0, 1.0, 1.0, 1e-7);
    reading_destroy(&r);
}

static void wraps(void **state)
{
    (void)state;
    write_image("a.exr", 3, 2, 1, IMAGE_FLOAT, GREYS);
    static const struct {
        const char *wrap;
        double left, far, corner,
            middle; /* at the left edge, far beyond it, at the lower right corner, beyond the top */
    } expected[] = {
        {"repeat", 0.1, 0.2, 0.4, 0.35},
        {"black", 0.0, 0.0, 0.25, 0.0},
        {"clamp", 0.0, 0.0, 1.0, 0.1},
        {"octahedralsphere", 0.2, 0.2, 0.4, 0.1},
    };
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        char world[256];
        snprintf(world, sizeof world,
                 "Texture \"a\" \"float\" \"imagemap\" \"string filename\" \"a.exr\" \"string wrap\" \"%s\"",
                 expected[i].wrap);
        reading r = good_world(world);
        const float half_pixel_up = 0.75f; /* the middle of the upper row */
        assert_near(last_float(&r, hit_at(0.0f, half_pixel_up, 0, 0, 0)), expected[i].left, 1e-6);
        assert_near(last_float(&r, hit_at(-7.0f + 2.5f / 3.0f, half_pixel_up, 0, 0, 0)), expected[i].far, 1e-5);
        assert_near(last_float(&r, hit_at(1.0f, 0.0f, 0, 0, 0)), expected[i].corner, 1e-6);
        assert_near(last_float(&r, hit_at(0.5f, 3.0f, 0, 0, 0)), expected[i].middle, 1e-6);
        assert_true(isfinite(last_float(&r, hit_at(1e30f, -1e30f, 0, 0, 0))));
        assert_true(isfinite(last_float(&r, hit_at(INFINITY, NAN, 0, 0, 0))));
        reading_destroy(&r);
    }
}

static void scale_and_invert(void **state)
{
    (void)state;
    static const float colours[3] = {0.25f, 0.5f, 1.0f}, mean = 1.75f / 3.0f;
    write_image("a.exr", 1, 1, 3, IMAGE_FLOAT, colours);
    const surface_hit hit = hit_at(0.5f, 0.5f, 0, 0, 0);
#define IMAGE_OF(type) "Texture \"a\" \"" type "\" \"imagemap\" \"string filename\" \"a.exr\" "
    assert_rgb(rgb_of(IMAGE_OF("spectrum") "\"float scale\" 3", hit), 0.75, 1.5, 3.0, 1e-6);
    assert_rgb(rgb_of(IMAGE_OF("spectrum") "\"float scale\" 1.5 \"bool invert\" true", hit), 0.625, 0.25, 0.0, 1e-6);
    assert_near(float_of(IMAGE_OF("float") "\"float scale\" 2", hit), 2 * mean, 1e-6); /* of its colours */
    assert_near(float_of(IMAGE_OF("float") "\"bool invert\" true", hit), 1 - mean, 1e-6);
    assert_near(float_of(IMAGE_OF("float") "\"bool invert\" true \"float scale\" 8", hit), 0.0, 0.0);
    assert_near(float_of(IMAGE_OF("float") "\"float scale\" -1", hit), -mean, 1e-7);
#undef IMAGE_OF
}

static void encodings(void **state)
{
    (void)state;
    float ramp[256 * 3];
    for (int i = 0; i < 256; i++)
        for (int c = 0; c < 3; c++)
            ramp[3 * i + c] = (float)((i * (c + 1)) % 256) / 255.0f;
    write_image("8.png", 256, 1, 3, IMAGE_UINT8, ramp);
    write_image("16.png", 256, 1, 3, IMAGE_UINT16, ramp);
    write_image("half.exr", 256, 1, 3, IMAGE_HALF, ramp);
    write_image("float.tif", 256, 1, 3, IMAGE_FLOAT, ramp);
    static const struct {
        const char *file, *encoding;
        double gamma; /* 0: sRGB */
    } cases[] = {
        {"8.png", "", 0.0},
        {"8.png", "\"string encoding\" \"sRGB\"", 0.0},
        {"8.png", "\"string encoding\" \"linear\"", 1.0},
        {"8.png", "\"string encoding\" \"gamma 2.2\"", 2.2},
        {"16.png", "", 0.0},
        {"16.png", "\"string encoding\" \"linear\"", 1.0},
        {"16.png", "\"string encoding\" \"gamma 1.8\"", 1.8},
        {"half.exr", "", 1.0},
        {"half.exr", "\"string encoding\" \"sRGB\"", 1.0}, /* floats are linear whatever it says */
        {"float.tif", "", 1.0},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char world[256];
        snprintf(world, sizeof world, "Texture \"a\" \"spectrum\" \"imagemap\" \"string filename\" \"%s\" %s",
                 cases[k].file, cases[k].encoding);
        reading r = good_world(world);
        const texture_image *kept = r.scene->textures.images[0];
        assert_int_equal(kept->bytes != NULL, strcmp(cases[k].file, "8.png") == 0);
        assert_int_equal(kept->values == NULL, kept->bytes != NULL);
        const double tolerance = strcmp(cases[k].file, "half.exr") == 0 ? 3e-4 : 1e-5;
        for (int i = 0; i < 256; i++) {
            double v[3];
            for (int c = 0; c < 3; c++) {
                const double coded = (i * (c + 1)) % 256 / 255.0;
                v[c] = cases[k].gamma > 0.0 ? pow(coded, cases[k].gamma) : srgb(coded);
            }
            assert_rgb(last_rgb(&r, hit_at(((float)i + 0.5f) / 256.0f, 0.5f, 0, 0, 0)), v[0], v[1], v[2], tolerance);
        }
        reading_destroy(&r);
    }
}

static void channels_and_sharing(void **state)
{
    (void)state;
    static const float pixel[4] = {1.0f, 0.2f, 0.6f, 0.4f};
    write_image("rgba.exr", 1, 1, 4, IMAGE_FLOAT, pixel);
    write_image("grey.png", 1, 1, 1, IMAGE_UINT8, pixel + 1);
    reading r = good_world(
        "Texture \"a\" \"spectrum\" \"imagemap\" \"string filename\" \"rgba.exr\" "
        "Texture \"a\" \"float\" \"imagemap\" \"string filename\" \"rgba.exr\" \"string wrap\" \"clamp\" "
        "Texture \"b\" \"spectrum\" \"imagemap\" \"string filename\" \"grey.png\" "
        "Texture \"c\" \"spectrum\" \"imagemap\" \"string filename\" \"grey.png\" \"string encoding\" \"sRGB\" "
        "Texture \"d\" \"spectrum\" \"imagemap\" \"string filename\" \"grey.png\" \"string encoding\" \"linear\"");
    const surface_hit hit = hit_at(0.1f, 0.9f, 0, 0, 0);
    assert_int_equal(r.scene->textures.count, 5);
    assert_int_equal(r.scene->textures.image_count, 3); /* the default is sRGB */
    assert_int_equal(r.scene->textures.images[0]->channel_count, 3);
    assert_int_equal(r.scene->textures.images[1]->channel_count, 1);
    assert_rgb(texture_evaluate_rgb(&r.scene->textures, 0, &hit), 1.0, 0.2, 0.6, 1e-7);
    assert_near(texture_evaluate_float(&r.scene->textures, 1, &hit), 0.4, 1e-6); /* alpha */
    const double grey = srgb(51.0 / 255.0);
    assert_rgb(texture_evaluate_rgb(&r.scene->textures, 3, &hit), grey, grey, grey, 1e-6);
    assert_rgb(texture_evaluate_rgb(&r.scene->textures, 4, &hit), 0.2, 0.2, 0.2, 1e-7);
    reading_destroy(&r);
}

/* The picture's channels as float textures; in that order A, R, G, B, the mean of colours, and as pbrt has it. */
static void assert_channels(const char *name, const char *encoding, const double expected[6])
{
    char world[512];
    snprintf(world, sizeof world,
             "Texture \"a\" \"float\" \"imagemap\" \"string filename\" \"%s\" \"string encoding\" \"%s\"", name,
             encoding);
    static const texture_channel CHANNELS[6] = {TEXTURE_CHANNEL_A, TEXTURE_CHANNEL_R,    TEXTURE_CHANNEL_G,
                                                TEXTURE_CHANNEL_B, TEXTURE_CHANNEL_MEAN, TEXTURE_CHANNEL_ALL};
    reading r = good_world(world);
    assert_int_equal(r.scene->textures.items[0].channel, TEXTURE_CHANNEL_ALL);
    for (int c = 0; c < 6; c++) {
        r.scene->textures.items[0].channel = CHANNELS[c];
        assert_near(last_float(&r, hit_at(0.1f, 0.9f, 0, 0, 0)), expected[c], 2e-5);
    }
    reading_destroy(&r);
}

static void float_textures_read_one_channel(void **state)
{
    (void)state;
    static const float pixel[4] = {1.0f, 1.0f / 3, 2.0f / 3, 0.6f}, opaque[4] = {0.4f, 0.2f, 0.6f, 1.0f},
                       bad[4] = {1, 1, 1, NAN};
    static const float multiplied[4] = {0.6f, 0.2f, 0.4f, 0.6f}; /* PNG files are written divided by alpha */
    write_image("rgba.png", 1, 1, 4, IMAGE_UINT8, multiplied);
    write_image("rgba16.png", 1, 1, 4, IMAGE_UINT16, multiplied);
    write_image("rgba.exr", 1, 1, 4, IMAGE_FLOAT, pixel);
    write_image("opaque.png", 1, 1, 4, IMAGE_UINT8, opaque);
    write_image("bad.exr", 1, 1, 4, IMAGE_FLOAT, bad);
    write_image("grey.png", 1, 1, 1, IMAGE_UINT8, opaque + 1);
    /* colours are decoded, alpha is as it stands; but to pbrt bytes of alpha are encoded too */
    const double mean = (1.0 + srgb(1.0 / 3) + srgb(2.0 / 3)) / 3;
    const double raw[6] = {0.6, 1.0, 1.0 / 3, 2.0 / 3, 2.0 / 3, 0.6};
    double decoded[6] = {0.6, 1.0, srgb(1.0 / 3), srgb(2.0 / 3), mean, srgb(0.6)};
    assert_channels("rgba.png", "sRGB", decoded);
    assert_channels("rgba.png", "linear", raw);
    decoded[5] = 0.6;
    assert_channels("rgba16.png", "sRGB", decoded);
    assert_channels("rgba.exr", "linear", raw);
    assert_channels("opaque.png", "linear", (const double[6]){1.0, 0.4, 0.2, 0.6, 0.4, 0.4});
    assert_channels("grey.png", "linear", (const double[6]){1.0, 0.2, 0.2, 0.2, 0.2, 0.2});

    /* between two pixels */
    static const float two[8] = {0.1f, 0.2f, 0.3f, 0.0f, 0.4f, 0.5f, 0.6f, 1.0f};
    write_image("two.exr", 2, 1, 4, IMAGE_FLOAT, two);
    reading r = good_world("Texture \"a\" \"float\" \"imagemap\" \"string filename\" \"two.exr\"");
    r.scene->textures.items[0].channel = TEXTURE_CHANNEL_A;
    assert_near(last_float(&r, hit_at(0.375f, 0.5f, 0, 0, 0)), 0.25, 1e-6);
    r.scene->textures.items[0].channel = TEXTURE_CHANNEL_B;
    assert_near(last_float(&r, hit_at(0.375f, 0.5f, 0, 0, 0)), 0.375, 1e-6);
    reading_destroy(&r);

    r = read_world("Texture \"a\" \"float\" \"imagemap\" \"string filename\" \"bad.exr\"");
    assert_int_equal(r.count[AG_LOG_WARNING], 1); /* says that a value is not finite */
    r.scene->textures.items[0].channel = TEXTURE_CHANNEL_A;
    assert_near(last_float(&r, hit_at(0.5f, 0.5f, 0, 0, 0)), 0.0, 0.0);
    reading_destroy(&r);
}

/* ---- the same from everywhere ---- */

enum { LOOKUP_COUNT = 2000, THREAD_COUNT = 4 };

typedef struct lookups {
    const scene *scene;
    rgb values[LOOKUP_COUNT];
} lookups;

static void *look_up_all(void *user)
{
    lookups *l = user;
    for (int i = 0; i < LOOKUP_COUNT; i++) {
        const float x = (float)i * 0.01f;
        const surface_hit hit = hit_at(x * 0.37f - 2.0f, 3.0f - x * 0.21f, x, x * 0.5f - 4.0f, 7.0f - x);
        l->values[i] = texture_evaluate_rgb(&l->scene->textures, l->scene->textures.count - 1, &hit);
    }
    return NULL;
}

static void threads_and_readings_agree(void **state)
{
    (void)state;
    write_image("a.png", 3, 2, 1, IMAGE_UINT8, GREYS);
    static const char WORLD[] =
        "Texture \"n\" \"float\" \"wrinkled\" Texture \"i\" \"spectrum\" \"imagemap\" \"string filename\" \"a.png\" "
        "\"string mapping\" \"spherical\" Texture \"m\" \"spectrum\" \"marble\" "
        "Texture \"c\" \"spectrum\" \"checkerboard\" \"texture tex1\" \"i\" \"texture tex2\" \"m\" "
        "Texture \"l\" \"spectrum\" \"mix\" \"texture tex1\" \"c\" \"texture tex2\" \"m\" \"texture amount\" \"n\"";
    reading first = good_world(WORLD), second = good_world(WORLD);
    static lookups all[THREAD_COUNT];
    pthread_t threads[THREAD_COUNT];
    for (int i = 0; i < THREAD_COUNT; i++) {
        all[i].scene = i % 2 == 0 ? first.scene : second.scene;
        assert_int_equal(pthread_create(&threads[i], NULL, look_up_all, &all[i]), 0);
    }
    for (int i = 0; i < THREAD_COUNT; i++)
        assert_int_equal(pthread_join(threads[i], NULL), 0);
    for (int i = 1; i < THREAD_COUNT; i++)
        assert_memory_equal(all[i].values, all[0].values, sizeof all[0].values);
    bool differs = false;
    for (int i = 1; i < LOOKUP_COUNT; i++)
        differs = differs || all[0].values[i].r != all[0].values[0].r;
    assert_true(differs);
    reading_destroy(&first);
    reading_destroy(&second);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(constants_scales_and_mixes),
        TEST_IN_FOLDER(bilerp_is_bilinear),
        TEST_IN_FOLDER(mappings),
        TEST_IN_FOLDER(checkerboards),
        TEST_IN_FOLDER(dots_fill_their_share),
        TEST_IN_FOLDER(lookups_are_bilinear),
        TEST_IN_FOLDER(wraps),
        TEST_IN_FOLDER(scale_and_invert),
        TEST_IN_FOLDER(encodings),
        TEST_IN_FOLDER(channels_and_sharing),
        TEST_IN_FOLDER(float_textures_read_one_channel),
        TEST_IN_FOLDER(threads_and_readings_agree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
