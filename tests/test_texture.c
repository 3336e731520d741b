/* test_texture.c: textures of scenes against values known otherwise: every kind, mapping, wrap and encoding, pictures
 * written for it, and what the reader says of wrong ones.
 * Flow: tests of scene/texture*.c, scene/image_encoding.c and scene/pbrt_textures.c. Threads: one, but for the last. */
#define _GNU_SOURCE
#include "bvh.h"
#include "image_file.h"
#include "pbrt_fixture.h"
#include "temporary_folder.h"
#include "texture_noise.h"

#include <math.h>
#include <pthread.h>

static const double PI = 3.14159265358979323846;

/* ---- helpers ---- */

static surface_hit hit_at(float u, float v, float x, float y, float z)
{
    surface_hit hit;
    memset(&hit, 0, sizeof hit);
    hit.uv = (vec2){u, v};
    hit.position = vec3_make(x, y, z);
    hit.geometric_normal = vec3_make(0.0f, 0.6f, 0.8f);
    hit.shading_normal = vec3_make(1.0f, 0.0f, 0.0f);
    return hit;
}

/* What stands after WorldBegin, in a file of the temporary folder, so that pictures are found beside it. */
static reading read_world(const char *world)
{
    FILE *file = fopen(in_folder("scene.pbrt"), "w");
    assert_non_null(file);
    assert_true(fprintf(file, "WorldBegin %s", world) > 0);
    assert_int_equal(fclose(file), 0);
    return reading_create(in_folder("scene.pbrt"), NULL, 0);
}

static reading good_world(const char *world)
{
    reading r = read_world(world);
    for (int level = AG_LOG_ERROR; level <= AG_LOG_WARNING; level++)
        if (r.said[level])
            print_error("%s", r.said[level]);
    assert_int_equal(r.status, AG_OK);
    assert_int_equal(r.count[AG_LOG_WARNING], 0);
    return r;
}

static rgb last_rgb(const reading *r, surface_hit hit)
{
    return texture_evaluate_rgb(r->scene, r->scene->texture_count - 1, &hit);
}

static float last_float(const reading *r, surface_hit hit)
{
    return texture_evaluate_float(r->scene, r->scene->texture_count - 1, &hit);
}

/* The last texture of the world at one hit. */
static float float_of(const char *world, surface_hit hit)
{
    reading r = good_world(world);
    float value = last_float(&r, hit);
    reading_destroy(&r);
    return value;
}

static rgb rgb_of(const char *world, surface_hit hit)
{
    reading r = good_world(world);
    rgb value = last_rgb(&r, hit);
    reading_destroy(&r);
    return value;
}

static void write_image(const char *name, int width, int height, int channel_count, image_sample_type type,
                        const float *pixels)
{
    static const char *const names[4] = {"R", "G", "B", "A"};
    static const char *const grey_names[1] = {"Y"};
    const image_description description = {.width = width,
                                           .height = height,
                                           .full_width = width,
                                           .full_height = height,
                                           .channel_count = channel_count,
                                           .channel_names = channel_count == 1 ? grey_names : names,
                                           .type = type};
    if (image_file_write(in_folder(name), &description, pixels, message, sizeof message) != AG_OK)
        fail_msg("%s", message);
}

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

/* Cells around whole numbers have a dot of radius 0.35, or none, by the noise at their corner; all of it lies inside.
 */
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

/* ---- noise ---- */

static void noise_is_perlins(void **state)
{
    (void)state;
    for (int i = -3; i < 3; i++)
        assert_near(texture_noise(vec3_make((float)i, 2.0f, (float)(5 * i))), 0.0, 0.0);
    /* worked out apart, in double precision, as a sum over the corners */
    assert_near(texture_noise(vec3_make(0.5f, 0.5f, 0.5f)), -0.125, 1e-7);
    assert_near(texture_noise(vec3_make(1.25f, 2.5f, 3.75f)), -0.03836345672607422, 1e-6);
    assert_near(texture_noise(vec3_make(-0.3125f, 10.125f, 255.875f)), -0.14796230907450125, 1e-6);
    assert_true(isfinite(texture_noise(vec3_make(INFINITY, NAN, 1e30f))));
    /* period, continuity across cells, bounds, and a mean of 0 */
    double sum = 0.0, sum_absolute = 0.0;
    enum { COUNT = 40 };
    for (int i = 0; i < COUNT; i++)
        for (int j = 0; j < COUNT; j++)
            for (int k = 0; k < COUNT; k++) {
                const vec3 p =
                    vec3_make((float)i * 0.78125f - 12.0f, (float)j * 0.828125f, (float)k * 0.734375f - 3.0f);
                const float value = texture_noise(p);
                assert_true(fabsf(value) <= 1.04f);
                assert_near(texture_noise(vec3_add(p, vec3_make(256.0f, -512.0f, 256.0f))), value, 0.0);
                assert_near(texture_noise(vec3_add(p, vec3_make(1e-3f, -1e-3f, 1e-3f))), value, 0.01);
                sum += (double)value;
                sum_absolute += fabs((double)value);
            }
    assert_near(sum / (COUNT * COUNT * COUNT), 0.0, 0.02);
    assert_near(sum_absolute / (COUNT * COUNT * COUNT), 0.2, 0.06);
    /* along an edge the noise is the two slopes there, faded into one another; slopes are -1, 0 or 1 */
    for (int i = 0; i < 200; i++) {
        const float x = (float)i;
        const double slope_here = (double)texture_noise(vec3_make(x + 0x1p-10f, 7.0f, 3.0f)) * 1024.0;
        const double slope_next = -(double)texture_noise(vec3_make(x + 1.0f - 0x1p-10f, 7.0f, 3.0f)) * 1024.0;
        const double a = round(slope_here), b = round(slope_next);
        assert_near(slope_here, a, 0.01);
        assert_near(slope_next, b, 0.01);
        assert_true(fabs(a) <= 1.0 && fabs(b) <= 1.0);
        assert_near(texture_noise(vec3_make(x + 0.5f, 7.0f, 3.0f)), 0.25 * (a - b), 1e-6);
    }
}

static void octaves_add_up(void **state)
{
    (void)state;
    const surface_hit hit = hit_at(0, 0, 1.3f, -0.4f, 2.7f);
    const vec3 p = vec3_make(0.65f, -0.2f, 1.35f); /* under Scale 2 2 2 */
    double fbm = 0.0, turbulence = 0.0, frequency = 1.0, height = 1.0;
    for (int i = 0; i < 3; i++) {
        const float value = texture_noise(vec3_scale(p, (float)frequency));
        fbm += height * (double)value;
        turbulence += height * fabs((double)value);
        frequency *= 1.99;
        height *= 0.7;
    }
    assert_near(
        float_of("Scale 2 2 2 Texture \"a\" \"float\" \"fbm\" \"integer octaves\" 3 \"float roughness\" 0.7", hit), fbm,
        2e-6);
    assert_near(
        float_of("Scale 2 2 2 Texture \"a\" \"float\" \"wrinkled\" \"integer octaves\" 3 \"float roughness\" 0.7", hit),
        turbulence + 0.2 * height, 2e-6);
    assert_near(float_of("Texture \"a\" \"float\" \"fbm\"", hit), texture_fbm(hit.position, 0.5f, 8), 0.0);
    assert_near(float_of("Texture \"a\" \"float\" \"fbm\" \"integer octaves\" 0", hit), 0.0, 0.0);
    assert_near(float_of("Texture \"a\" \"float\" \"windy\"", hit),
                fabsf(texture_fbm(vec3_scale(hit.position, 0.1f), 0.5f, 3)) * texture_fbm(hit.position, 0.5f, 6), 1e-7);
}

static void marble_follows_its_spline(void **state)
{
    (void)state;
    /* without variation the curve's parameter is 0.5 + 0.5 sin(y) */
    static const char WORLD[] = "Texture \"a\" \"spectrum\" \"marble\" \"float variation\" 0 \"float scale\" 2";
    assert_rgb(rgb_of(WORLD, hit_at(0, 0, 5, (float)(-PI / 4), 1)), 0.87, 0.87, 0.9, 1e-5);
    /* at the very end all of the last control point, at the end's middle (t = 11/12) Bernstein's 1 3 3 1 over 8 */
    assert_rgb(rgb_of(WORLD, hit_at(0, 0, 5, (float)(PI / 4), 1)), 0.87, 0.87, 0.9, 1e-5);
    const double y = asin(2.0 * 11.0 / 12.0 - 1.0) / 2.0;
    const double r = (0.58 + 3 * 0.58 + 3 * 0.2 + 0.58) / 8, b = (0.6 + 3 * 0.6 + 3 * 0.33 + 0.6) / 8;
    assert_rgb(rgb_of(WORLD, hit_at(0, 0, 5, (float)y, 1)), 1.5 * r, 1.5 * r, 1.5 * b, 2e-5);
    const rgb with = rgb_of("Texture \"a\" \"spectrum\" \"marble\"", hit_at(0, 0, 0.3f, 0.7f, 0.2f));
    const rgb without =
        rgb_of("Texture \"a\" \"spectrum\" \"marble\" \"float variation\" 0", hit_at(0, 0, 0.3f, 0.7f, 0.2f));
    assert_true(with.r > 0.3f && with.r < 1.0f && with.r != without.r);
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
        const texture_image *kept = r.scene->texture_images[0];
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
    assert_int_equal(r.scene->texture_count, 5);
    assert_int_equal(r.scene->texture_image_count, 3); /* the default is sRGB */
    assert_int_equal(r.scene->texture_images[0]->channel_count, 3);
    assert_int_equal(r.scene->texture_images[1]->channel_count, 1);
    assert_rgb(texture_evaluate_rgb(r.scene, 0, &hit), 1.0, 0.2, 0.6, 1e-7);
    assert_near(texture_evaluate_float(r.scene, 1, &hit), 0.4, 1e-6); /* alpha */
    const double grey = srgb(51.0 / 255.0);
    assert_rgb(texture_evaluate_rgb(r.scene, 3, &hit), grey, grey, grey, 1e-6);
    assert_rgb(texture_evaluate_rgb(r.scene, 4, &hit), 0.2, 0.2, 0.2, 1e-7);
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
    assert_int_equal(r.scene->textures[0].channel, TEXTURE_CHANNEL_ALL);
    for (int c = 0; c < 6; c++) {
        r.scene->textures[0].channel = CHANNELS[c];
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
    r.scene->textures[0].channel = TEXTURE_CHANNEL_A;
    assert_near(last_float(&r, hit_at(0.375f, 0.5f, 0, 0, 0)), 0.25, 1e-6);
    r.scene->textures[0].channel = TEXTURE_CHANNEL_B;
    assert_near(last_float(&r, hit_at(0.375f, 0.5f, 0, 0, 0)), 0.375, 1e-6);
    reading_destroy(&r);

    r = read_world("Texture \"a\" \"float\" \"imagemap\" \"string filename\" \"bad.exr\"");
    assert_int_equal(r.count[AG_LOG_WARNING], 1); /* says that a value is not finite */
    r.scene->textures[0].channel = TEXTURE_CHANNEL_A;
    assert_near(last_float(&r, hit_at(0.5f, 0.5f, 0, 0, 0)), 0.0, 0.0);
    reading_destroy(&r);
}

/* ---- the reader ---- */

static void wrong_textures_say_why(void **state)
{
    (void)state;
    static float pixels[3 * 64 * 64];
    for (size_t i = 0; i < sizeof pixels / sizeof *pixels; i++)
        pixels[i] = texture_noise(vec3_make((float)i * 0.37f, 0.2f, 0.1f)); /* no less when packed */
    write_image("cut.exr", 64, 64, 3, IMAGE_FLOAT, pixels);
    assert_int_equal(truncate(in_folder("cut.exr"), 3000), 0);
    static const struct {
        const char *world, *at, *text; /* at: what the last of such marks */
        ag_status status;
    } cases[] = {
        {"Texture \"a\" \"float\" \"scale\" \"texture tex\" \"b\"", "\"texture tex", "no float texture is named \"b\"",
         AG_ERROR_SCENE},
        {"Texture \"a\" \"float\" \"scale\" \"texture tex\" \"a\"", "\"texture tex", "no float texture is named \"a\"",
         AG_ERROR_SCENE},
        {"Texture \"b\" \"spectrum\" \"constant\" Texture \"a\" \"float\" \"scale\" \"texture tex\" \"b\"",
         "\"texture tex", "\"b\" is a spectrum texture, but \"tex\" takes a float texture", AG_ERROR_SCENE},
        {"Texture \"b\" \"float\" \"fbm\" Texture \"a\" \"spectrum\" \"scale\" \"texture tex\" \"b\"", "\"texture tex",
         "\"b\" is a float texture, but \"tex\" takes a spectrum texture", AG_ERROR_SCENE},
        {"Texture \"a\" \"float\" \"scale\" \"texture tex\" [ \"b\" \"c\" ]", "\"texture tex",
         "\"texture tex\" should have 1 value, but has 2", AG_ERROR_SCENE},
        {"Texture \"a\" \"float\" \"scale\" \"rgb tex\" [ 1 1 1 ]", "\"rgb tex", "\"rgb tex\" should be \"float tex\"",
         AG_ERROR_SCENE},
        {"Texture \"a\" \"colour\" \"scale\"", "\"colour",
         "texture \"a\" should be of type \"float\" or \"spectrum\", not \"colour\"", AG_ERROR_SCENE},
        {"Texture \"a\" \"float\" \"marble\"", "Texture", "there are no float textures of class \"marble\"",
         AG_ERROR_SCENE},
        {"Texture \"a\" \"spectrum\" \"brick\"", "Texture", "there are no spectrum textures of class \"brick\"",
         AG_ERROR_SCENE},
        {"Texture \"a\" \"float\" \"windy\" Texture \"a\" \"float\" \"windy\"", "Texture",
         "float texture \"a\" is made twice", AG_ERROR_SCENE},
        {"Texture \"a\" \"float\" \"checkerboard\" \"integer dimension\" 4", "\"integer",
         "\"dimension\" should be 2 or 3, not 4", AG_ERROR_SCENE},
        {"Texture \"a\" \"float\" \"dots\" \"string mapping\" \"cube\"", "\"string",
         "unknown mapping \"cube\"; known are uv, spherical, cylindrical, planar", AG_ERROR_SCENE},
        {"Texture \"a\" \"float\" \"directionmix\" \"vector3 dir\" [ 0 0 0 ]", "\"vector3",
         "\"dir\" should have a length above 0", AG_ERROR_SCENE},
        {"Texture \"a\" \"float\" \"fbm\" \"integer octaves\" -1", "\"integer", "\"octaves\" should not be negative",
         AG_ERROR_SCENE},
        {"Texture \"a\" \"float\" \"imagemap\"", "Texture", "Texture \"imagemap\" has no \"string filename\"",
         AG_ERROR_SCENE},
        {"Texture \"a\" \"float\" \"imagemap\" \"string wrap\" \"mirror\"", "\"string wrap",
         "unknown wrap \"mirror\"; known are repeat, black, clamp, octahedralsphere", AG_ERROR_SCENE},
        {"Texture \"a\" \"float\" \"imagemap\" \"string encoding\" \"gamma -1\"", "\"string enc",
         "unknown encoding \"gamma -1\"; known are sRGB, linear and, with a number, gamma", AG_ERROR_SCENE},
        {"Texture \"a\" \"float\" \"imagemap\" \"string filename\" \"none.png\"", "\"string file",
         "/none.png': No such file", AG_ERROR_INPUT},
        {"Texture \"a\" \"float\" \"imagemap\" \"string filename\" \".\"", "\"string file", "it is not a regular file",
         AG_ERROR_INPUT},
        {"Texture \"a\" \"float\" \"imagemap\" \"string filename\" \"scene.pbrt\"", "\"string file",
         "OpenImageIO cannot open it: ", AG_ERROR_INPUT},
        {"Texture \"a\" \"float\" \"imagemap\" \"string filename\" \"cut.exr\"", "\"string file",
         "/cut.exr': OpenImageIO cannot", AG_ERROR_INPUT},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        reading r = read_world(cases[i].world);
        const char *at = cases[i].world;
        for (const char *next = at; (next = strstr(next, cases[i].at)); next++)
            at = next;
        char place[64];
        snprintf(place, sizeof place, "scene.pbrt:1:%d: error: ", (int)(at - cases[i].world) + 12);
        if (r.status != cases[i].status || r.count[AG_LOG_ERROR] != 1 || !strstr(r.said[AG_LOG_ERROR], place) ||
            !strstr(r.said[AG_LOG_ERROR], cases[i].text))
            fail_msg("%s: %s, not at %s: %s", cases[i].world, r.said[AG_LOG_ERROR] ? r.said[AG_LOG_ERROR] : "(nothing)",
                     place, cases[i].text);
        reading_destroy(&r);
    }
}

/* Infinities in a picture are told and are 0. */
static void bad_values_are_told(void **state)
{
    (void)state;
    static const float pixels[4] = {INFINITY, 0.5f, NAN, 0.25f};
    write_image("bad.exr", 4, 1, 1, IMAGE_FLOAT, pixels);
    reading r = read_world("Texture \"a\" \"float\" \"imagemap\" \"string filename\" \"bad.exr\" "
                           "Texture \"b\" \"float\" \"imagemap\" \"string filename\" \"bad.exr\"");
    assert_int_equal(r.status, AG_OK);
    assert_int_equal(r.count[AG_LOG_WARNING], 1);
    assert_non_null(
        strstr(r.said[AG_LOG_WARNING], "\"bad.exr\": 2 values are infinite or not a number, and count as 0"));
    assert_near(last_float(&r, hit_at(0.25f, 0.5f, 0, 0, 0)), 0.25, 1e-6);
    reading_destroy(&r);
}

/* What can be read all the same is told of. */
static void doubtful_textures_are_warned_of(void **state)
{
    (void)state;
    static const struct {
        const char *world, *text;
        double value;
    } cases[] = {
        {"Texture \"a\" \"color\" \"constant\" \"rgb value\" [ 2 2 2 ]",
         "the texture type \"color\" is called \"spectrum\" in pbrt-v4 and is read as that", 2.0},
        {"Texture \"a\" \"spectrum\" \"ptex\" \"string filename\" \"a.ptx\"",
         "Texture \"ptex\" is not supported: a constant of 0.5 stands in", 0.5},
        {"Texture \"a\" \"float\" \"fbm\" \"integer octaves\" 33 \"float roughness\" 0",
         "\"octaves\" is above 32: 32 is used, what is finer cannot be seen", 0.0},
        {"Texture \"a\" \"float\" \"windy\" \"float uscale\" 2",
         "Texture \"windy\": \"float uscale\" is not known, or not supported yet, and is ignored", 0.0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        reading r = read_world(cases[i].world);
        assert_int_equal(r.status, AG_OK);
        assert_int_equal(r.count[AG_LOG_WARNING], 1);
        if (!strstr(r.said[AG_LOG_WARNING], cases[i].text))
            fail_msg("%s: %s", cases[i].world, r.said[AG_LOG_WARNING]);
        assert_near(last_rgb(&r, hit_at(0, 0, 0, 0, 0)).g, cases[i].value, 0.0);
        reading_destroy(&r);
    }
}

/* A texture that doubles in cost with every line would take for ever to look up. */
static void exploding_graphs_are_refused(void **state)
{
    (void)state;
    char world[4096] = "Texture \"t0\" \"float\" \"fbm\" \"integer octaves\" 1 ";
    for (int i = 1; i <= 30; i++) {
        const size_t used = strlen(world);
        snprintf(world + used, sizeof world - used,
                 "Texture \"t%d\" \"float\" \"scale\" \"texture tex\" \"t%d\" \"texture scale\" \"t%d\"\n", i, i - 1,
                 i - 1);
    }
    reading r = read_world(world);
    assert_int_equal(r.status, AG_ERROR_SCENE);
    assert_non_null(strstr(r.said[AG_LOG_ERROR], "texture \"t12\" is made of more than 4096 others"));
    assert_int_equal(r.scene->texture_count, 12);
    const surface_hit hit = hit_at(0, 0, 0.3f, 0.4f, 0.6f);
    assert_true(isfinite(last_float(&r, hit)));
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
        l->values[i] = texture_evaluate_rgb(l->scene, l->scene->texture_count - 1, &hit);
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
        cmocka_unit_test(noise_is_perlins),
        TEST_IN_FOLDER(octaves_add_up),
        TEST_IN_FOLDER(marble_follows_its_spline),
        TEST_IN_FOLDER(lookups_are_bilinear),
        TEST_IN_FOLDER(wraps),
        TEST_IN_FOLDER(scale_and_invert),
        TEST_IN_FOLDER(encodings),
        TEST_IN_FOLDER(channels_and_sharing),
        TEST_IN_FOLDER(float_textures_read_one_channel),
        TEST_IN_FOLDER(wrong_textures_say_why),
        TEST_IN_FOLDER(bad_values_are_told),
        TEST_IN_FOLDER(doubtful_textures_are_warned_of),
        TEST_IN_FOLDER(exploding_graphs_are_refused),
        TEST_IN_FOLDER(threads_and_readings_agree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
