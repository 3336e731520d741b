/* test_pbrt_light_pictures.c: lights with pictures, windows and "photons", as the pbrt reader makes them. Threads:
 * one. */
#define _GNU_SOURCE
#include "fixtures/pbrt_fixture.h" /* first: its arguments would hide what the next one declares */

#include "fixtures/environment_picture.h"
#include "light/environment.h"
#include "light/portal.h"
#include "light/projection.h"
#include "rays/rays.h"
#include "scene.h"

static const double PI = 3.14159265358979323846;

static const light *only_light(const reading *r, light_kind kind)
{
    assert_int_equal(r->scene->light_count, 1);
    assert_int_equal(r->scene->lights[0].kind, kind);
    return &r->scene->lights[0];
}

/* Each %s is the path. */
static reading reading_with(const char *format, const char *path)
{
    char text[1024];
    snprintf(text, sizeof text, format, path);
    return reading_of(text);
}

static const char *write_constant(const char *name, int width, int height, float r, float g, float b)
{
    static float pixels[64 * 64 * 3];
    assert_true(width * height <= 64 * 64);
    for (int i = 0; i < width * height; i++)
        pixels[3 * i] = r, pixels[3 * i + 1] = g, pixels[3 * i + 2] = b;
    return write_environment(name, width, height, IMAGE_FLOAT, pixels);
}

static void goniometric(void **state)
{
    (void)state;
    const char *path = write_constant("a.exr", 8, 8, 3.0f, 2.0f, 1.0f);
    reading r =
        reading_with("WorldBegin Translate 1 2 3 LightSource \"goniometric\" \"rgb I\" [ 1 2 3 ] \"float scale\" 2 "
                     "\"string filename\" \"%s\"",
                     path);
    const light *l = only_light(&r, LIGHT_GONIOMETRIC);
    assert_vec3(l->as.point.position, 1, 2, 3, 0);
    assert_rgb(l->as.goniometric.intensity.value, 2, 4, 6, 0);
    assert_rgb(l->as.goniometric.intensity.picture->pixels[7], 2, 2, 2, 1e-6); /* the mean of the channels */
    assert_rgb(light_intensity(l, vec3_make(0.0f, 0.6f, 0.8f)), 4, 8, 12, 1e-5);
    /* the picture's z is up, along y */
    assert_vec3(l->as.goniometric.intensity.world_from_light.x, 1, 0, 0, 1e-6);
    assert_vec3(l->as.goniometric.intensity.world_from_light.y, 0, 0, 1, 1e-6);
    assert_vec3(l->as.goniometric.intensity.world_from_light.z, 0, 1, 0, 1e-6);
    reading_destroy(&r);
    /* power is that of I 1, times I and scale */
    r = reading_with("WorldBegin LightSource \"goniometric\" \"rgb I\" [ 1 .5 0 ] \"float scale\" 2 \"float power\" 10 "
                     "\"string filename\" \"%s\"",
                     path);
    l = only_light(&r, LIGHT_GONIOMETRIC);
    assert_rgb(environment_integral(&l->as.goniometric.intensity), 20, 10, 0, 1e-4);
    assert_rgb(l->as.goniometric.intensity.value, 20 / (8 * PI), 10 / (8 * PI), 0, 1e-5);
    reading_destroy(&r);
}

/* The directions of pixels: +x, -x, +y, -y of the picture's space are the right, left, bottom and top edges' middles,
 * its z the middle. */
static void goniometric_directions(void **state)
{
    (void)state;
    enum { SIZE = 8 };
    float pixels[SIZE * SIZE * 3];
    for (int i = 0; i < SIZE * SIZE * 3; i++)
        pixels[i] = (float)(i / 3);
    const char *path = write_environment("a.exr", SIZE, SIZE, IMAGE_FLOAT, pixels);
    reading r = reading_with("WorldBegin Rotate 90 0 1 0 LightSource \"goniometric\" \"string filename\" \"%s\"", path);
    const light *l = only_light(&r, LIGHT_GONIOMETRIC);
    /* the rotation takes x to -z, z to x */
    assert_near(light_intensity(l, vec3_make(0.01f, 0.999f, -0.01f)).g, 4 * SIZE + 4, 0);
    assert_near(light_intensity(l, vec3_make(0.04f, 0.02f, -0.999f)).g, 4 * SIZE + 7, 0);
    assert_near(light_intensity(l, vec3_make(0.04f, 0.02f, 0.999f)).g, 4 * SIZE, 0);
    assert_near(light_intensity(l, vec3_make(0.999f, 0.02f, -0.04f)).g, 7 * SIZE + 4, 0);
    assert_near(light_intensity(l, vec3_make(-0.999f, 0.02f, -0.04f)).g, 4, 0);
    reading_destroy(&r);
}

static void projections(void **state)
{
    (void)state;
    float pixels[2 * 2 * 3];
    for (int i = 0; i < 12; i++)
        pixels[i] = (float)(i / 3 + 1);
    const char *path = write_environment("a.exr", 2, 2, IMAGE_FLOAT, pixels);
    reading r = reading_with("WorldBegin Translate 1 2 3 Rotate 90 0 1 0 LightSource \"projection\" \"float scale\" 2 "
                             "\"float fov\" 60 \"string filename\" \"%s\"",
                             path);
    const light *l = only_light(&r, LIGHT_PROJECTION);
    assert_vec3(l->as.point.position, 1, 2, 3, 0);
    assert_vec3(l->as.projection.world_from_light.z, 1, 0, 0, 1e-6);
    assert_rgb(l->as.projection.intensity, 2, 2, 2, 0);
    assert_near(l->as.projection.picture->reach_x, tan(PI / 6), 1e-6);
    /* along x: the picture's right is -z, its top y */
    assert_near(light_intensity(l, vec3_normalize(vec3_make(1.0f, 0.3f, 0.3f))).g, 2, 0);
    assert_near(light_intensity(l, vec3_normalize(vec3_make(1.0f, 0.3f, -0.3f))).g, 4, 0);
    assert_near(light_intensity(l, vec3_normalize(vec3_make(1.0f, -0.3f, 0.3f))).g, 6, 0);
    assert_near(light_intensity(l, vec3_normalize(vec3_make(1.0f, -0.3f, -0.3f))).g, 8, 0);
    reading_destroy(&r);
    const char *constant = write_constant("b.exr", 4, 2, 3.0f, 2.0f, 1.0f);
    r = reading_with("WorldBegin LightSource \"projection\" \"float scale\" 2 \"float power\" 10 \"string filename\" "
                     "\"%s\"",
                     constant);
    l = only_light(&r, LIGHT_PROJECTION);
    assert_near(l->as.projection.picture->reach_x, 2, 1e-6);
    assert_near(l->as.projection.picture->reach_y, 1, 1e-6);
    assert_near(rgb_luminance(rgb_mul(l->as.projection.intensity, l->as.projection.picture->integral)), 20, 1e-3);
    reading_destroy(&r);
}

static void area_lights(void **state)
{
    (void)state;
    float pixels[2 * 2 * 3] = {1.0f, 1.0f, 1.0f, 2.0f, 2.0f, 2.0f, 3.0f, 3.0f, 3.0f, 6.0f, 6.0f, 6.0f};
    const char *path = write_environment("a.exr", 2, 2, IMAGE_FLOAT, pixels);
    reading r = reading_with("WorldBegin AreaLightSource \"diffuse\" \"float scale\" 2 \"string filename\" \"%s\" "
                             "Shape \"disk\" Shape \"disk\"",
                             path);
    assert_int_equal(r.scene->light_count, 2);
    for (int i = 0; i < 2; i++) {
        const light *l = &r.scene->lights[i];
        assert_int_equal(l->as.area.radiance_texture, 0);
        assert_rgb(l->as.area.radiance, 2, 2, 2, 0);
        /* v 1 is the top; edges go on */
        surface_hit hit = {.uv = {0.01f, 0.99f}, .geometric_normal = {0.0f, 0.0f, 1.0f}};
        assert_rgb(light_emitted_radiance(r.scene, l, &hit, vec3_make(0.0f, 0.0f, 1.0f)), 2, 2, 2, 1e-6);
        hit.uv = (vec2){0.99f, 0.01f};
        assert_rgb(light_emitted_radiance(r.scene, l, &hit, vec3_make(0.0f, 0.0f, 1.0f)), 12, 12, 12, 1e-5);
        assert_rgb(light_emitted_radiance(r.scene, l, &hit, vec3_make(0.0f, 0.0f, -1.0f)), 0, 0, 0, 0);
    }
    assert_int_equal(r.scene->textures.image_count, 1);
    reading_destroy(&r);
    /* as much as makes a lamp of the picture's mean have that power */
    r = reading_with(
        "WorldBegin AreaLightSource \"diffuse\" \"float power\" 30 \"string filename\" \"%s\" \"bool twosided\" "
        "true Shape \"disk\" \"float radius\" 2",
        path);
    assert_near(only_light(&r, LIGHT_AREA)->as.area.radiance.g, 30 / (8 * PI * PI * 3), 1e-6);
    reading_destroy(&r);
}

static void portals(void **state)
{
    (void)state;
    /* in world space, whatever the transform */
    static const char *const CORNERS = "\"point3 portal\" [ 1 0 0  1 0 3  1 2 3  1 2 0 ]";
    char text[512];
    snprintf(text, sizeof text, "WorldBegin Translate 5 5 5 LightSource \"infinite\" \"rgb L\" [ 1 2 3 ] %s", CORNERS);
    reading r = reading_of(text);
    const light *l = only_light(&r, LIGHT_INFINITE);
    assert_non_null(l->as.infinite.portal);
    assert_vec3(l->as.infinite.portal->corner, 1, 0, 0, 0);
    assert_vec3(l->as.infinite.portal->axes.x, 0, 1, 0, 0);
    assert_vec3(l->as.infinite.portal->axes.y, 0, 0, 1, 0);
    assert_vec3(l->as.infinite.portal->axes.z, 1, 0, 0, 0);
    assert_near(l->as.infinite.portal->width, 2, 0);
    assert_near(l->as.infinite.portal->height, 3, 0);
    assert_rgb(l->as.infinite.portal->irradiance, PI, 2 * PI, 3 * PI, 1e-5);
    reading_destroy(&r);
    /* to pbrt a constant light with a portal is a picture of one pixel, which looks up */
    snprintf(text, sizeof text, "WorldBegin LightSource \"infinite\" \"rgb L\" [ 2 2 2 ] \"float illuminance\" 30 %s",
             CORNERS);
    r = reading_of(text);
    assert_near(only_light(&r, LIGHT_INFINITE)->as.infinite.radiance.value.g, 30 / (2 * PI), 1e-5);
    reading_destroy(&r);
    char format[512];
    snprintf(format, sizeof format, "WorldBegin LightSource \"infinite\" %s \"string filename\" \"%%s\"", CORNERS);
    r = reading_with(format, write_constant("a.exr", 16, 16, 1.0f, 2.0f, 4.0f));
    l = only_light(&r, LIGHT_INFINITE);
    assert_non_null(l->as.infinite.radiance.picture);
    assert_rgb(l->as.infinite.portal->irradiance, PI, 2 * PI, 4 * PI, 1e-3);
    reading_destroy(&r);
}

static void photons(void **state)
{
    (void)state;
    reading r = reading_of("WorldBegin LightSource \"point\" LightSource \"infinite\" \"float photons\" 2.5\n"
                           "AreaLightSource \"diffuse\" \"float photons\" 0 Shape \"disk\"");
    assert_int_equal(r.scene->light_count, 3);
    assert_near(r.scene->lights[0].photons, 1, 0);
    assert_near(r.scene->lights[1].photons, 2.5, 0);
    assert_near(r.scene->lights[2].photons, 0, 0);
    assert_string_equal(r.said[AG_LOG_INFO],
                        "t:2:1: info: the light sends no photons: its indirect light and caustics are "
                        "missing from the photon map\n");
    reading_destroy(&r);
}

static void errors(void **state)
{
    (void)state;
    char black[256], lines[256], good[256];
    snprintf(black, sizeof black, "\"string filename\" \"%s\"", write_constant("black.exr", 2, 2, 0.0f, 0.0f, 0.0f));
    snprintf(lines, sizeof lines, "\"string filename\" \"%s\"", write_constant("lines.exr", 3, 2, 1.0f, 1.0f, 1.0f));
    snprintf(good, sizeof good, "\"string filename\" \"%s\"", write_constant("good.exr", 2, 2, 1.0f, 1.0f, 1.0f));
    const struct {
        const char *directive, *picture, *parameters, *error;
    } cases[] = {
        {"LightSource \"goniometric\"", "", "", "a \"goniometric\" light needs a picture, \"string filename\""},
        {"LightSource \"projection\"", "", "", "a \"projection\" light needs a picture, \"string filename\""},
        {"LightSource \"goniometric\"", lines, "", "is 3 x 2: the picture of such a light is square"},
        {"LightSource \"goniometric\"", black, "\"float power\" 3", "the picture is black"},
        {"LightSource \"projection\"", black, "\"float power\" 3", "the picture is black"},
        {"LightSource \"projection\"", good, "\"float fov\" 180", "\"fov\" should be within (0, 180) degrees"},
        {"LightSource \"projection\"", good, "\"float scale\" -1", "\"scale\" should not be negative"},
        {"LightSource \"goniometric\"", good, "\"rgb I\" [ 1e38 1 1 ]", "the light is too bright for a float"},
        {"LightSource \"projection\"", "", "\"string filename\" \"none.exr\"", "none.exr"},
        {"AreaLightSource \"diffuse\"", good, "\"rgb L\" [ 1 1 1 ]",
         "an area light has \"L\" or \"filename\", not both"},
        {"AreaLightSource \"diffuse\"", black, "\"float power\" 3", "the picture is black"},
        {"AreaLightSource \"diffuse\"", "", "\"string filename\" \"none.exr\"", "none.exr"},
        {"LightSource \"point\"", "", "\"float photons\" -1", "\"photons\" should not be negative"},
        {"LightSource \"infinite\"", "", "\"point3 portal\" [ 0 0 0  1 0 0  1 1 0 ]",
         "\"portal\" has four corners, not 3"},
        {"LightSource \"infinite\"", good, "\"point3 portal\" [ 0 0 0  1 0 0  1 1 0  0 1 1 ]",
         "\"portal\" is not a rectangle, corner by corner"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[1024];
        snprintf(text, sizeof text, "WorldBegin\n  %s %s %s", cases[i].directive, cases[i].picture,
                 cases[i].parameters);
        expect_light_refused(text, cases[i].error);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(goniometric), TEST_IN_FOLDER(goniometric_directions),
        TEST_IN_FOLDER(projections), TEST_IN_FOLDER(area_lights),
        TEST_IN_FOLDER(portals),     cmocka_unit_test(photons),
        TEST_IN_FOLDER(errors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
