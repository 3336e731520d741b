/* test_pbrt_environments.c: LightSource "infinite" as the pbrt reader makes it. Threads: one. */
#define _GNU_SOURCE
#include "fixtures/pbrt_fixture.h" /* first: its arguments would hide what the next one declares */

#include "fixtures/environment_picture.h"
#include "light/environment.h"

static const double PI = 3.14159265358979323846;

static const light *only_light(const reading *r)
{
    assert_int_equal(r->scene->light_count, 1);
    assert_int_equal(r->scene->lights[0].kind, LIGHT_INFINITE);
    return &r->scene->lights[0];
}

static reading reading_with(const char *parameters, const char *path)
{
    char text[1024];
    snprintf(text, sizeof text, "WorldBegin LightSource \"infinite\" %s \"string filename\" \"%s\"", parameters, path);
    return reading_of(text);
}

static void constant(void **state)
{
    (void)state;
    reading r = reading_of("WorldBegin LightSource \"infinite\"");
    assert_rgb(only_light(&r)->as.infinite.radiance.value, 1, 1, 1, 0);
    assert_null(only_light(&r)->as.infinite.radiance.picture);
    reading_destroy(&r);
    r = reading_of("WorldBegin Rotate 20 0 0 1 LightSource \"infinite\" \"rgb L\" [ 1 2 3 ] \"float scale\" 2");
    assert_rgb(only_light(&r)->as.infinite.radiance.value, 2, 4, 6, 0);
    reading_destroy(&r);
    /* on a surface that faces up: pi L */
    r = reading_of(
        "WorldBegin LightSource \"infinite\" \"rgb L\" [ 1 .5 2 ] \"float illuminance\" 10 \"float scale\" 3");
    assert_rgb(only_light(&r)->as.infinite.radiance.value, 30 / PI, 15 / PI, 60 / PI, 1e-5);
    reading_destroy(&r);
    r = reading_of("WorldBegin LightSource \"infinite\" \"rgb L\" [ 0 0 0 ]");
    assert_string_equal(r.said[AG_LOG_DEBUG], "t:1:12: debug: LightSource \"infinite\" has no power\n");
    reading_destroy(&r);
}

static void pictures(void **state)
{
    (void)state;
    enum { SIZE = 8 };
    float pixels[SIZE * SIZE * 3];
    for (int i = 0; i < SIZE * SIZE * 3; i++)
        pixels[i] = (float)i;
    const char *square = write_environment("square.exr", SIZE, SIZE, IMAGE_FLOAT, pixels);
    reading r = reading_with("\"float scale\" 2", square);
    const light *l = only_light(&r);
    const environment *e = l->as.infinite.radiance.picture;
    assert_non_null(e);
    assert_int_equal(e->mapping, ENVIRONMENT_OCTAHEDRAL);
    assert_true(e->width == SIZE && e->height == SIZE);
    assert_rgb(l->as.infinite.radiance.value, 2, 2, 2, 0);
    for (int i = 0; i < SIZE * SIZE; i++)
        assert_rgb(e->pixels[i], 3 * i, 3 * i + 1, 3 * i + 2, 0);
    /* +x, -x, +y, -y, +z, -z of the light are the right, left, bottom, top edges', the middle's and the corner's */
    assert_true(environment_whole_radiance(&l->as.infinite.radiance, vec3_make(0.999f, 0.04f, 0.02f)).r ==
                2.0f * pixels[3 * (4 * SIZE + 7)]);
    assert_true(environment_whole_radiance(&l->as.infinite.radiance, vec3_make(-0.999f, 0.04f, 0.02f)).r ==
                2.0f * pixels[3 * (4 * SIZE + 0)]);
    assert_true(environment_whole_radiance(&l->as.infinite.radiance, vec3_make(0.04f, 0.999f, 0.02f)).r ==
                2.0f * pixels[3 * (7 * SIZE + 4)]);
    assert_true(environment_whole_radiance(&l->as.infinite.radiance, vec3_make(0.04f, -0.999f, 0.02f)).r ==
                2.0f * pixels[3 * (0 * SIZE + 4)]);
    assert_true(environment_whole_radiance(&l->as.infinite.radiance, vec3_make(0.01f, 0.01f, 1.0f)).r ==
                2.0f * pixels[3 * (4 * SIZE + 4)]);
    assert_true(environment_whole_radiance(&l->as.infinite.radiance, vec3_make(0.01f, 0.01f, -1.0f)).r ==
                2.0f * pixels[3 * (7 * SIZE + 7)]);
    reading_destroy(&r);

    const char *wide = write_environment("wide.exr", 4, 2, IMAGE_HALF, pixels);
    r = reading_with("", wide);
    assert_int_equal(only_light(&r)->as.infinite.radiance.picture->mapping, ENVIRONMENT_LATITUDE_LONGITUDE);
    reading_destroy(&r);

    /* 8 bits: decoded from sRGB */
    float coded[3] = {0.5f, 0.03f, 1.0f};
    const char *small = write_environment("small.png", 1, 1, IMAGE_UINT8, coded);
    r = reading_with("", small);
    assert_rgb(only_light(&r)->as.infinite.radiance.picture->pixels[0], 0.2140, 0.03 / 12.92, 1.0, 0.003);
    reading_destroy(&r);
}

/* The light's z axis is where the transform turns it; a reflection is kept, a scale is not. */
static void transforms(void **state)
{
    (void)state;
    float pixels[3] = {1.0f, 1.0f, 1.0f};
    const char *path = write_environment("one.exr", 1, 1, IMAGE_FLOAT, pixels);
    char text[1024];
    snprintf(
        text, sizeof text,
        "WorldBegin Translate 1 2 3 Rotate -90 1 0 0 Scale 3 3 3 LightSource \"infinite\" \"string filename\" \"%s\"",
        path);
    reading r = reading_of(text);
    frame f = only_light(&r)->as.infinite.radiance.world_from_light;
    assert_vec3(f.x, 1, 0, 0, 1e-6);
    assert_vec3(f.y, 0, 0, -1, 1e-6);
    assert_vec3(f.z, 0, 1, 0, 1e-6);
    reading_destroy(&r);
    snprintf(text, sizeof text, "WorldBegin Scale -1 1 1 LightSource \"infinite\" \"string filename\" \"%s\"", path);
    r = reading_of(text);
    f = only_light(&r)->as.infinite.radiance.world_from_light;
    assert_vec3(f.x, -1, 0, 0, 1e-6);
    assert_vec3(f.y, 0, 1, 0, 1e-6);
    assert_vec3(f.z, 0, 0, 1, 1e-6);
    reading_destroy(&r);
    snprintf(text, sizeof text, "WorldBegin Scale 1 1 2 LightSource \"infinite\" \"string filename\" \"%s\"", path);
    r = reading_create(NULL, text, strlen(text));
    assert_int_equal(r.status, AG_OK);
    assert_non_null(strstr(r.said[AG_LOG_WARNING], "t:1:24: warning: LightSource \"infinite\": the transform is not"));
    assert_vec3(only_light(&r)->as.infinite.radiance.world_from_light.z, 0, 0, 1, 1e-6);
    reading_destroy(&r);
}

/* Illuminance is pbrt-v4's: each pixel of the upper half counts 2 pi / count cos theta; of L everywhere that is pi L
 * / 2. */
static void illuminance(void **state)
{
    (void)state;
    enum { SIZE = 64 };
    static float pixels[2 * SIZE * SIZE * 3];
    for (int i = 0; i < 2 * SIZE * SIZE; i++)
        pixels[3 * i] = 1.0f, pixels[3 * i + 1] = 2.0f, pixels[3 * i + 2] = 0.5f;
    double luminance = 0.2126 + 2.0 * 0.7152 + 0.5 * 0.0722, expected = 3.0 * 100.0 / (luminance * PI / 2.0);
    const char *square = write_environment("square.exr", SIZE, SIZE, IMAGE_FLOAT, pixels);
    reading r = reading_with("\"float illuminance\" 100 \"float scale\" 3", square);
    assert_near(only_light(&r)->as.infinite.radiance.value.g / expected, 1.0, 1e-3);
    reading_destroy(&r);
    const char *wide = write_environment("wide.exr", 2 * SIZE, SIZE, IMAGE_FLOAT, pixels);
    r = reading_with("\"float illuminance\" 100 \"float scale\" 3", wide);
    assert_near(only_light(&r)->as.infinite.radiance.value.g / expected, 1.0, 1e-3);
    reading_destroy(&r);
}

static void bad_pixels_count_as_black(void **state)
{
    (void)state;
    float pixels[4 * 3] = {-1.0f, 2.0f, 3.0f, NAN, 1.0f, 1.0f, 4.0f, INFINITY, 5.0f, 6.0f, 7.0f, 8.0f};
    const char *path = write_environment("bad.exr", 2, 2, IMAGE_FLOAT, pixels);
    char text[1024];
    snprintf(text, sizeof text, "WorldBegin LightSource \"infinite\" \"string filename\" \"%s\"", path);
    reading r = reading_create(NULL, text, strlen(text));
    assert_int_equal(r.status, AG_OK);
    snprintf(text, sizeof text,
             "t:1:35: warning: \"%s\": 3 pixels are negative, infinite or not a number; what is counts as 0\n", path);
    assert_string_equal(r.said[AG_LOG_WARNING], text);
    const rgb *p = only_light(&r)->as.infinite.radiance.picture->pixels;
    assert_rgb(p[0], 0, 2, 3, 0);
    assert_rgb(p[1], 0, 1, 1, 0);
    assert_rgb(p[2], 4, 0, 5, 0);
    assert_rgb(p[3], 6, 7, 8, 0);
    reading_destroy(&r);
}

static void errors(void **state)
{
    (void)state;
    float pixels[3 * 3 * 2] = {0.0f};
    const char *odd = write_environment("odd.exr", 3, 2, IMAGE_FLOAT, pixels);
    const char *black = write_environment("black.exr", 2, 2, IMAGE_FLOAT, pixels);
    char parameters[4][512];
    snprintf(parameters[0], sizeof parameters[0], "\"string filename\" \"%s\"", odd);
    snprintf(parameters[1], sizeof parameters[1], "\"string filename\" \"%s\" \"float illuminance\" 3", black);
    snprintf(parameters[2], sizeof parameters[2], "\"string filename\" \"%s\" \"rgb L\" [ 1 1 1 ]", black);
    snprintf(parameters[3], sizeof parameters[3], "\"string filename\" \"%s/none.exr\"", folder);
    const struct {
        const char *parameters, *error;
    } cases[] = {
        {parameters[0], "is 3 x 2: the picture of such a light is square (octahedral) or twice as wide as high"},
        {parameters[1], "no light comes from the upper half of the picture"},
        {parameters[2], "an infinite light has \"L\" or \"filename\", not both"},
        {parameters[3], "none.exr\": "},
        {"\"float scale\" -1", "\"scale\" should not be negative"},
        {"\"rgb L\" [ 1e38 1 1 ]", "the light is too bright for a float"},
        {"\"float filename\" 1", "filename"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[1024];
        snprintf(text, sizeof text, "WorldBegin\n  LightSource \"infinite\" %s", cases[i].parameters);
        expect_light_refused(text, cases[i].error);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(constant),
        TEST_IN_FOLDER(pictures),
        TEST_IN_FOLDER(transforms),
        TEST_IN_FOLDER(illuminance),
        TEST_IN_FOLDER(bad_pixels_count_as_black),
        TEST_IN_FOLDER(errors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
