/* test_pbrt_media.c: MakeNamedMedium, MediumInterface and the material "interface": what they become in the scene, and
 * every error and warning. Threads: one. */
#include "fixtures/pbrt_fixture.h"
#include "rays/rays.h"
#include "scene.h"

#include <math.h>

/* The absorption of a homogeneous medium with these parameters; warnings: how many are expected. */
static rgb absorption_of(const char *parameters, int warnings)
{
    char text[512];
    snprintf(text, sizeof text, "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" %s WorldBegin", parameters);
    reading r = reading_create(NULL, text, strlen(text));
    assert_int_equal(r.status, AG_OK);
    assert_int_equal(r.count[AG_LOG_WARNING], warnings);
    assert_int_equal(r.scene->medium_count, 1);
    rgb sigma_a = r.scene->media[0].as.homogeneous.sigma_a;
    reading_destroy(&r);
    return sigma_a;
}

static void absorption_is_read(void **state)
{
    (void)state;
    assert_rgb(absorption_of("\"rgb sigma_a\" [1 2 3] \"rgb sigma_s\" [0 0 0]", 0), 1, 2, 3, 0);
    assert_rgb(absorption_of("\"rgb sigma_a\" [1 2 3] \"rgb sigma_s\" [0 0 0] \"float scale\" 10 \"float g\" 0.7", 0),
               10, 20, 30, 0);
    assert_rgb(absorption_of("", 0), 1, 1, 1, 0); /* as in pbrt */
    assert_rgb(absorption_of("\"rgb sigma_s\" [0 0 0]", 0), 1, 1, 1, 0);
    assert_rgb(absorption_of("\"rgb sigma_a\" [0 0 0] \"float scale\" 0", 0), 0, 0, 0, 0);
    /* presets come before what is given beside them, as in pbrt; what is not known does not */
    assert_rgb(absorption_of("\"string preset\" \"Merlot\"", 0), 0.11632, 0.25191, 0.29434, 1e-7);
    assert_rgb(absorption_of("\"string preset\" \"Pacific Ocean Surface Water\" \"float scale\" 1000", 0), 31.845,
               31.324, 30.147, 1e-4);
    assert_rgb(absorption_of("\"string preset\" \"Water\" \"rgb sigma_a\" [1 2 3] \"rgb sigma_s\" [0 0 0]", 1), 1, 2, 3,
               0);
    assert_rgb(absorption_of("\"rgb Le\" [1 1 1] \"rgb sigma_s\" [0 0 0]", 1), 1, 1, 1, 0);
    assert_rgb(absorption_of("\"rgb sigma_s\" [0 0 0] \"float thickness\" 1", 1), 1, 1, 1, 0);
}

static void scattering_is_read(void **state)
{
    (void)state;
    static const struct {
        const char *parameters;
        double r, g, b, mean_cosine;
    } CASES[] = {
        {"", 1, 1, 1, 0}, /* as in pbrt */
        {"\"rgb sigma_s\" [1 2 3] \"float g\" -0.75", 1, 2, 3, -0.75},
        {"\"rgb sigma_a\" [0 0 0] \"rgb sigma_s\" [1 2 3] \"float scale\" 0.5", 0.5, 1, 1.5, 0},
        {"\"spectrum sigma_s\" [300 4 900 4]", 4, 4, 4, 0},
        {"\"string preset\" \"Marble\" \"float scale\" 10 \"float g\" 0.25", 21.9, 26.2, 30, 0.25},
        {"\"float scale\" 0", 0, 0, 0, 0},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        char text[512];
        snprintf(text, sizeof text, "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" %s WorldBegin",
                 CASES[i].parameters);
        reading r = reading_of(text);
        const medium *m = &r.scene->media[0];
        assert_rgb(m->as.homogeneous.sigma_s, CASES[i].r, CASES[i].g, CASES[i].b, 1e-4);
        assert_true((double)m->phase.g == CASES[i].mean_cosine);
        assert_int_equal(medium_scatters(m), CASES[i].b > 0);
        reading_destroy(&r);
    }
}

/* The current transform does not scale it; an Attribute gives what it does not say itself. */
static void absorption_is_the_same_everywhere(void **state)
{
    (void)state;
    static const char *const BEFORE[] = {"Scale 10 10 10", "Attribute \"medium\" \"float scale\" 3"};
    for (int i = 0; i < 2; i++) {
        char text[512];
        snprintf(text, sizeof text,
                 "%s MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [1 2 3] "
                 "\"rgb sigma_s\" [0 0 0] WorldBegin",
                 BEFORE[i]);
        reading r = reading_of(text);
        double scale = i == 0 ? 1.0 : 3.0;
        assert_rgb(r.scene->media[0].as.homogeneous.sigma_a, scale, 2.0 * scale, 3.0 * scale, 0);
        reading_destroy(&r);
    }
}

static void what_varies_gets_its_mean(void **state)
{
    (void)state;
    static const struct {
        const char *text, *warning;
        double r, g, b;
    } CASES[] = {
        {"\"uniformgrid\" \"integer nx\" 2 \"float density\" [1 5] \"rgb sigma_a\" [1 2 3] \"float scale\" 2 \"rgb "
         "sigma_s\" [0 0 0]",
         "media of type \"uniformgrid\" are not supported: \"m\" absorbs alike everywhere, by its mean \"sigma_a\", as "
         "do any others",
         6, 12, 18},
        {"\"uniformgrid\" \"integer nx\" 2 \"float density\" [1 5] \"rgb sigma_a\" [1 2 3]",
         "media of type \"uniformgrid\" are not supported: \"m\" neither absorbs nor scatters, as do any others", 0, 0,
         0},
        {"\"rgbgrid\" \"integer nx\" 2 \"rgb sigma_a\" [1 2 3 5 6 7] \"rgb sigma_s\" [0 0 0 0 0 0] \"float scale\" 2",
         "media of type \"rgbgrid\" are not supported: \"m\" absorbs alike everywhere, by its mean \"sigma_a\", as do "
         "any others",
         6, 8, 10},
        {"\"rgbgrid\" \"rgb sigma_s\" [1 2 3]",
         "media of type \"rgbgrid\" are not supported: \"m\" neither absorbs nor scatters, as do any others", 0, 0, 0},
        {"\"rgbgrid\" \"rgb sigma_a\" [1 2 3]",
         "media of type \"rgbgrid\" are not supported: \"m\" neither absorbs nor scatters, as do any others", 0, 0, 0},
        {"\"cloud\"", "media of type \"cloud\" are not supported: \"m\" neither absorbs nor scatters, as do any others",
         0, 0, 0},
        {"\"nanovdb\" \"string filename\" \"smoke.nvdb\"",
         "media of type \"nanovdb\" are not supported: \"m\" neither absorbs nor scatters, as do any others", 0, 0, 0},
        {"\"homogeneous\" \"rgb sigma_s\" [0 0 0] \"rgb Le\" [0 0 1]",
         "media that emit light are not supported: \"Le\" of \"m\" is ignored, as are any others", 1, 1, 1},
        {"\"homogeneous\" \"rgb sigma_s\" [0 0 0] \"string preset\" \"Tea\"",
         "no medium has the preset \"Tea\": \"sigma_a\" counts", 1, 1, 1},
        {"\"homogeneous\" \"rgb sigma_s\" [0 0 0] \"float density\" 1",
         "MakeNamedMedium \"homogeneous\": \"float density\" is not known, or not supported yet, and is ignored", 1, 1,
         1},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        char text[512];
        snprintf(text, sizeof text, "MakeNamedMedium \"m\" \"string type\" %s WorldBegin", CASES[i].text);
        reading r = reading_create(NULL, text, strlen(text));
        assert_int_equal(r.status, AG_OK);
        if (r.count[AG_LOG_WARNING] != 1 || !strstr(r.said[AG_LOG_WARNING], CASES[i].warning))
            fail_msg("%s: %s", CASES[i].text, r.said[AG_LOG_WARNING] ? r.said[AG_LOG_WARNING] : "nothing said");
        assert_rgb(r.scene->media[0].as.homogeneous.sigma_a, CASES[i].r, CASES[i].g, CASES[i].b, 1e-6);
        reading_destroy(&r);
    }
}

#define MEDIUM(name) "MakeNamedMedium \"" name "\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [0 0 0]\n"

/* Shapes keep the media on both of their sides; media may be made after shapes name them. */
static void sides_are_kept(void **state)
{
    (void)state;
    reading r = reading_of(
        MEDIUM("a") "MediumInterface \"\" \"a\" Camera \"perspective\" WorldBegin\n"
                    "LightSource \"point\" Shape \"sphere\"\n"
                    "AttributeBegin MediumInterface \"b\" \"a\" Material \"dielectric\" Shape \"sphere\"\n"
                    "MediumInterface \"b\" Shape \"sphere\" LightSource \"infinite\" AttributeEnd\n"
                    "Shape \"disk\" MediumInterface \"\" Shape \"sphere\" LightSource \"spot\"\n" MEDIUM("b"));
    const scene *s = r.scene;
    const uint32_t a = 0, b = 1, none = SCENE_NO_MEDIUM;
    static const bool DIFFER[] = {true, true, false, true, false};
    const uint32_t inside[] = {none, b, b, none, none}, outside[] = {a, a, b, a, none};
    assert_int_equal(s->medium_count, 2);
    assert_int_equal(s->camera_medium, a);
    assert_int_equal(s->shape_count, 5);
    for (int i = 0; i < 5; i++) {
        assert_int_equal(s->shapes[i].medium_inside, inside[i]);
        assert_int_equal(s->shapes[i].medium_outside, outside[i]);
        assert_int_equal(s->shapes[i].has_medium_interface, DIFFER[i]);
    }
    assert_int_equal(s->light_count, 3);
    assert_int_equal(s->lights[0].medium, a);
    assert_int_equal(s->lights[1].medium, b);
    assert_int_equal(s->lights[2].medium, none);
    reading_destroy(&r);
    r = reading_of("Camera \"perspective\" WorldBegin");
    assert_int_equal(r.scene->camera_medium, SCENE_NO_MEDIUM);
    reading_destroy(&r);
}

/* Interfaces are there where they part two media, or may. */
static void interfaces_are_kept_where_they_matter(void **state)
{
    (void)state;
    static const char *const NAMES[] = {"interface", "none", ""};
    for (int i = 0; i < 3; i++) {
        char text[512];
        snprintf(text, sizeof text,
                 "WorldBegin " MEDIUM(
                     "a") "Material \"%s\" Shape \"sphere\" MediumInterface \"a\" Shape \"sphere\" "
                          "MediumInterface \"a\" \"\" Shape \"sphere\" Material \"diffuse\" Shape \"sphere\"",
                 NAMES[i]);
        reading r = reading_of(text);
        assert_int_equal(r.scene->shape_count, 2);
        assert_int_equal(r.scene->materials[r.scene->shapes[0].material_index].kind, MATERIAL_INTERFACE);
        assert_int_equal(r.scene->materials[r.scene->shapes[1].material_index].kind, MATERIAL_DIFFUSE);
        reading_destroy(&r);
    }
    reading r = reading_of("WorldBegin NamedMaterial \"n\" Shape \"sphere\" NamedMaterial \"n\" Shape \"disk\"\n"
                           "MakeNamedMaterial \"n\" \"string type\" \"none\" NamedMaterial \"n\" Shape \"disk\"");
    assert_int_equal(r.scene->shape_count, 2);
    for (int i = 0; i < 2; i++)
        assert_int_equal(r.scene->materials[r.scene->shapes[i].material_index].kind, MATERIAL_INTERFACE);
    reading_destroy(&r);
}

/* As in pbrt, interfaces do not shine. */
static void interfaces_do_not_shine(void **state)
{
    (void)state;
    static const char *const TEXTS[] = {
        "WorldBegin AreaLightSource \"diffuse\" Material \"interface\" Shape \"sphere\"",
        "WorldBegin AreaLightSource \"diffuse\" NamedMaterial \"n\" Shape \"sphere\"\n"
        "MakeNamedMaterial \"n\" \"string type\" \"interface\""};
    static const char *const WARNINGS[] = {
        "t:1:59: warning: a shape with the material \"interface\" cannot shine: its area light is left out\n",
        "t: warning: shapes with the material \"interface\" cannot shine: their area lights are left out\n"};
    for (int i = 0; i < 2; i++) {
        reading r = reading_create(NULL, TEXTS[i], strlen(TEXTS[i]));
        assert_int_equal(r.status, AG_OK);
        assert_int_equal(r.count[AG_LOG_WARNING], 1);
        assert_string_equal(r.said[AG_LOG_WARNING], WARNINGS[i]);
        assert_int_equal(r.scene->shape_count, 1);
        assert_int_equal(r.scene->shapes[0].light_index, SHAPE_NO_LIGHT);
        for (uint32_t k = 0; k < r.scene->light_count; k++)
            assert_true(rgb_is_black(r.scene->lights[k].as.area.radiance));
        reading_destroy(&r);
    }
}

static void errors_name_their_location(void **state)
{
    (void)state;
    static const struct {
        const char *text, *error;
    } CASES[] = {
        {"MakeNamedMedium \"m\" WorldBegin", "t:1:1: error: MakeNamedMedium \"m\" has no \"string type\""},
        {"MakeNamedMedium \"m\" \"string type\" \"fog\" WorldBegin", "t:1:21: error: unknown medium \"fog\""},
        {MEDIUM("m") MEDIUM("m") "WorldBegin", "t:2:1: error: medium \"m\" is made twice, first at t:1:1"},
        {"WorldBegin MediumInterface \"m\" \"\" Shape \"sphere\"", "t:1:12: error: no medium is named \"m\""},
        {"WorldBegin MediumInterface \"\" \"m\" LightSource \"point\"", "t:1:12: error: no medium is named \"m\""},
        {"MediumInterface \"\" \"m\" Camera \"perspective\" WorldBegin", "t:1:1: error: no medium is named \"m\""},
        {"WorldBegin MediumInterface 1", "t:1:28: error: MediumInterface expects a quoted name, not 1"},
        {"MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"float scale\" -1 WorldBegin",
         "t:1:49: error: \"scale\" should not be negative"},
        {"MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [1e30 1 1] \"float scale\" 1e30 "
         "WorldBegin",
         "t:1:74: error: it absorbs more than a float holds"},
        {"MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [-1 1 1] WorldBegin",
         "t:1:49: error: \"rgb sigma_a\" has a negative component, -1"},
        {"MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [0 -2 0] WorldBegin",
         "t:1:49: error: \"rgb sigma_s\" has a negative component, -2"},
        {"MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"spectrum sigma_s\" [400 -1 700 1] WorldBegin",
         "t:1:49: error: \"spectrum sigma_s\" has a negative value, -1"},
        {"MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [1 1e30 1] \"float scale\" 1e30 "
         "WorldBegin",
         "t:1:74: error: it scatters more than a float holds"},
        {"MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"float g\" 1 WorldBegin",
         "t:1:49: error: \"g\" should be more than -1 and less than 1"},
        {"MakeNamedMedium \"m\" \"string type\" \"homogeneous\"\n\"float g\" -1.5 WorldBegin",
         "t:2:1: error: \"g\" should be more than -1 and less than 1"},
        {"MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"float sigma_a\" 1 WorldBegin",
         "t:1:49: error: \"float sigma_a\" should be \"rgb sigma_a\""},
        {"MakeNamedMedium \"m\" \"string type\" \"uniformgrid\" WorldBegin",
         "t:1:1: error: a medium of type \"uniformgrid\" needs \"float density\""},
        {"MakeNamedMedium \"m\" \"string type\" \"uniformgrid\" \"float density\" [1 -1] WorldBegin",
         "t:1:49: error: \"density\" has a negative value, -1"},
        {"MakeNamedMedium \"m\" \"string type\" \"rgbgrid\" WorldBegin",
         "t:1:1: error: a medium of type \"rgbgrid\" needs \"sigma_a\" or \"sigma_s\""},
        {"MakeNamedMedium \"m\" \"string type\" \"rgbgrid\" \"rgb sigma_a\" [1 -1 0] WorldBegin",
         "t:1:45: error: \"sigma_a\" has a negative component, -1"},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        reading r = reading_create(NULL, CASES[i].text, strlen(CASES[i].text));
        assert_int_equal(r.status, AG_ERROR_SCENE);
        if (!r.said[AG_LOG_ERROR] || strncmp(r.said[AG_LOG_ERROR], CASES[i].error, strlen(CASES[i].error)) != 0)
            fail_msg("%s: %s", CASES[i].text, r.said[AG_LOG_ERROR] ? r.said[AG_LOG_ERROR] : "nothing said");
        reading_destroy(&r);
    }
    /* what nothing is in need not be there, as in pbrt */
    reading r = reading_of("WorldBegin MediumInterface \"m\" \"n\" MediumInterface \"\" Shape \"sphere\"");
    reading_destroy(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(absorption_is_read),
        cmocka_unit_test(scattering_is_read),
        cmocka_unit_test(absorption_is_the_same_everywhere),
        cmocka_unit_test(what_varies_gets_its_mean),
        cmocka_unit_test(sides_are_kept),
        cmocka_unit_test(interfaces_are_kept_where_they_matter),
        cmocka_unit_test(interfaces_do_not_shine),
        cmocka_unit_test(errors_name_their_location),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
