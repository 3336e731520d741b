/* test_program_hard_scenes.c: scenes that are right and yet hard: far too large or small, the eye or a lamp inside of
 * things, surfaces at the same point, lamps without area. What has an answer must have it; all else must end, in finite
 * pixels.
 *
 * Rests on: Hecht, "Optics", 5th ed., 2017, 4.6 (Fresnel at normal incidence).
 *
 * Flow: tests of the whole program, and of the library. Threads: theirs. */
#define _GNU_SOURCE
#include "fixtures/program_picture.h"

#include "afterglow/afterglow.h"

static const double PI = 3.14159265358979323846;
static const char *const INTEGRATORS[] = {"--integrator=photonmap", "--integrator=path"};
enum { INTEGRATOR_COUNT = 2 };

/* The warnings and errors. */
typedef struct hearing {
    char said[4096];
    size_t length;
} hearing;

static void hear(void *user, ag_log_level level, const char *text)
{
    hearing *h = user;
    if (level <= AG_LOG_WARNING && h->length < sizeof h->said)
        h->length += (size_t)snprintf(h->said + h->length, sizeof h->said - h->length, "%s\n", text);
}

/* Rendered by both, without a sample that is no number; in this process, for to start the program takes ten times as
 * long. warning NULL: nothing is said. *out_mean (or NULL): of green, the photon map's and the path tracer's. */
static void expect_finite(const char *name, const char *text, const char *warning, double out_mean[INTEGRATOR_COUNT])
{
    const char *path = write_text("scene.pbrt", text);
    for (int k = 0; k < INTEGRATOR_COUNT; k++) {
        hearing heard = {.length = 0};
        ag_context_settings made = ag_default_context_settings();
        ag_context *context;
        ag_scene *loaded = NULL;
        ag_film *film = NULL;
        ag_render_settings settings;
        made.log = hear;
        made.user = &heard;
        assert_int_equal(ag_context_create(&made, &context), AG_OK);
        ag_status status = ag_scene_load(context, path, &loaded);
        if (status == AG_OK)
            status = ag_render_settings_from_scene(context, loaded, &settings);
        if (status == AG_OK) {
            settings.integrator = k == 0 ? AG_INTEGRATOR_PHOTONMAP : AG_INTEGRATOR_PATH;
            settings.photon_count = 20000, settings.caustic_photon_count = 300;
            settings.samples_per_pixel = 4, settings.gather_samples = 2;
            settings.width = 8, settings.height = 6;
            status = ag_render(context, loaded, &settings, &film);
        }
        if (status != AG_OK || (warning ? !strstr(heard.said, warning) : heard.said[0] != '\0'))
            fail_msg("%s, %s: %s, and said: %s", name, INTEGRATORS[k], ag_status_text(status), heard.said);
        if (ag_context_statistics(context).samples_not_finite != 0)
            fail_msg("%s, %s: samples that are no numbers", name, INTEGRATORS[k]);
        int width, height;
        const float *pixels = ag_film_pixels(film, &width, &height);
        double sum = 0.0;
        for (int i = 0; i < 3 * width * height; i++) {
            if (!isfinite(pixels[i]))
                fail_msg("%s, %s: a pixel that is no number", name, INTEGRATORS[k]);
            sum += i % 3 == 1 ? (double)pixels[i] : 0.0;
        }
        if (out_mean)
            out_mean[k] = sum / (width * height);
        ag_film_destroy(film);
        ag_scene_destroy(loaded);
        ag_context_destroy(context);
    }
}

/* ---- scales ---- */

/* A room is as bright in millimetres as it is in miles: radiance knows no length. */
static void test_scales(void **state)
{
    (void)state;
    static const double SCALES[] = {1.0, 1e-6, 1e6};
    double mean[3][INTEGRATOR_COUNT];
    for (int i = 0; i < 3; i++) {
        char text[1024];
        double s = SCALES[i];
        snprintf(text, sizeof text,
                 "LookAt %g %g %g  0 %g %g  0 1 0\nCamera \"perspective\" \"float fov\" 80\nPixelFilter \"box\"\n"
                 "WorldBegin\nScale %g %g %g\nInclude \"" PROGRAM_SCENES "lit_room.pbrt\"\n",
                 2.5 * s, 1.2 * s, 0.4 * s, 1.0 * s, 2.5 * s, s, s, s);
        const char *scene = write_text("room.pbrt", text);
        for (int k = 0; k < INTEGRATOR_COUNT; k++) {
            picture p =
                RENDER(scene, INTEGRATORS[k], "--size=16x16", "--spp=4", "--photons=20000", "--gather-samples=16");
            mean[i][k] = picture_mean(&p, 1);
            picture_reset(&p);
            assert_true(mean[i][k] > 0.1 && mean[i][k] < 1.0);
            expect_near(INTEGRATORS[k], mean[i][k], mean[0][k], 0.003);
        }
    }
}

static void test_beyond_all_measure(void **state)
{
    (void)state;
#define SPHERE_AND_LIGHT "WorldBegin\nLightSource \"distant\"\nMaterial \"diffuse\"\nShape \"sphere\"\n"
#define SEEN_SPHERE      "LookAt 0 0 -3 0 0 0 0 1 0\nCamera \"perspective\"\nWorldBegin\nShape \"sphere\"\n"
    static const struct {
        const char *name, *text;
    } CASES[] = {
        {"an eye far away", "LookAt 1e12 0 0 0 0 0 0 1 0\nCamera \"perspective\"\n" SPHERE_AND_LIGHT},
        {"an eye beyond reach", "LookAt 1e19 0 0 0 0 0 0 1 0\nCamera \"perspective\"\n" SPHERE_AND_LIGHT},
        {"an eye nowhere", "Translate 0 0 1e200\nCamera \"perspective\"\n" SPHERE_AND_LIGHT},
        {"a large eye", "Scale 1e-12 1e-12 1e-12\nCamera \"perspective\"\n" SPHERE_AND_LIGHT},
        {"a small eye", "Scale 1e12 1e12 1e12\nCamera \"perspective\"\n" SPHERE_AND_LIGHT},
        {"a wide window",
         "Camera \"orthographic\" \"float screenwindow\" [ -1e30 1e30 -1e30 1e30 ]\n" SPHERE_AND_LIGHT},
        {"a wide angle", "Camera \"perspective\" \"float fov\" 179.9999\n" SPHERE_AND_LIGHT},
        {"a wide lens", "Camera \"perspective\" \"float lensradius\" 1e30\n" SPHERE_AND_LIGHT},
        {"a far focus",
         "Camera \"perspective\" \"float lensradius\" 0.1 \"float focaldistance\" 1e30\n" SPHERE_AND_LIGHT},
        {"a near focus",
         "Camera \"perspective\" \"float lensradius\" 0.1 \"float focaldistance\" 1e-30\n" SPHERE_AND_LIGHT},
        {"a lamp far away", SEEN_SPHERE "LightSource \"point\" \"point3 from\" [ 0 1e15 0 ]\n"},
        {"a lamp beyond reach", SEEN_SPHERE "LightSource \"point\" \"point3 from\" [ 0 1e30 0 ]\n"},
        {"a lamp on the surface", SEEN_SPHERE "LightSource \"point\" \"point3 from\" [ 0 0 -1 ]\n"},
        {"a small lamp",
         SEEN_SPHERE "AreaLightSource \"diffuse\"\nTranslate 0 3 0\nShape \"sphere\" \"float radius\" 1e-12\n"},
        {"a large lamp",
         SEEN_SPHERE "AreaLightSource \"diffuse\"\nTranslate 0 2e12 0\nShape \"sphere\" \"float radius\" 1e12\n"},
        {"a bright lamp",
         SEEN_SPHERE "LightSource \"point\" \"rgb I\" [ 1e30 1e30 1e30 ] \"point3 from\" [ 0 0 -3 ]\n"},
        {"a dim lamp",
         SEEN_SPHERE "LightSource \"point\" \"rgb I\" [ 1e-30 1e-30 1e-30 ] \"point3 from\" [ 0 0 -3 ]\n"},
        {"things smaller than a float is there",
         "LookAt 0 0 4294967290 0 0 4294967296 0 1 0\nCamera \"perspective\" \"float fov\" 170\nWorldBegin\n"
         "LightSource \"infinite\"\nTranslate 0 0 4294967296\nShape \"sphere\"\nScale 1 2 3\nShape \"sphere\"\nShape "
         "\"cylinder\"\n"},
        {"all that there is",
         SEEN_SPHERE "LightSource \"point\" \"point3 from\" [ 0 0 -3 ]\nShape \"sphere\" \"float radius\" 1e17\n"},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++)
        expect_finite(CASES[i].name, CASES[i].text, "", NULL);
    program_run run =
        RUN("-q", "-o", "b.exr", write_text("b.pbrt", SEEN_SPHERE "Translate 1e100 0 0\nLightSource \"point\"\n"));
    expect_exit(&run, 1);
    expect_said(&run, "b.pbrt:6:1: error: the light is too far away");
    program_run_reset(&run);
    expect_listing("b.pbrt scene.pbrt");
}

/* ---- inside of things ---- */

#define EYE_INSIDE                                                                                                     \
    "Camera \"perspective\"\nWorldBegin\nLightSource \"point\" \"point3 from\" [ 0 5 0 ]\nLightSource \"infinite\"\n"

/* Outside of all that is looked at: where nothing is diffuse, photons are sent by the million before the map is given
 * up. */
#define SCREEN                                                                                                         \
    "AttributeBegin\nMaterial \"diffuse\"\nTranslate 0 0 -5\nShape \"disk\" \"float radius\" 3\nAttributeEnd\n"

/* Light from outside does not come in, and nothing is there for the eye but the dark inside. That wants photons enough:
 * of a few hundred, an estimate reaches across the thing to the outside of its far side. In a corner that is so sharp
 * that rays slip out of it by the edge, both integrators show some millionths of the sky. */
static void test_eye_inside_of_opaque_things(void **state)
{
    (void)state;
    static const char *const THINGS[] = {
        "Material \"diffuse\"\nShape \"sphere\"\n",
        SCREEN "Material \"conductor\"\nShape \"sphere\"\n",
        SCREEN "Material \"conductor\" \"float roughness\" 0.3\nScale 1 2 3\nShape \"sphere\"\n",
        ("Material \"coateddiffuse\"\nShape \"trianglemesh\" \"point3 P\" [ -1 -1 -1  3 0 0  0 3 0  0 0 3 ]\n"
         "\"integer indices\" [ 0 1 2  0 2 3  0 3 1  1 3 2 ]\n"),
    };
    for (size_t i = 0; i < sizeof THINGS / sizeof *THINGS; i++) {
        char text[512];
        double mean[INTEGRATOR_COUNT];
        snprintf(text, sizeof text, EYE_INSIDE "%s", THINGS[i]);
        expect_finite(THINGS[i], text, "", mean);
        for (int k = 0; k < INTEGRATOR_COUNT; k++)
            assert_in_range((uint64_t)(mean[k] * 1e9), 0, i == 3 ? 10000 : 0);
    }
}

/* A black lamp of radius a and radiance L in the middle of a ball of glass, over a floor at distance h from that
 * middle. Its light meets the glass all but straight on: T = 1 - ((n - 1) / (n + 1))^2 = 0.96 of it leaves, and goes on
 * as it was (from a / b = 0.3, T is 0.9598 on average); what is reflected comes back to the lamp, which takes it. So
 * below it the irradiance is T pi L (a / h)^2, whatever n. */
static void test_lamp_inside_of_glass(void **state)
{
    (void)state;
    const char *scene = write_text(
        "scene.pbrt",
        "LookAt 0 0 2  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 6\nPixelFilter \"box\"\nWorldBegin\n"
        "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n"
        "Shape \"disk\" \"float radius\" 1.5\nTranslate 0 0 4\nAttributeBegin\nMaterial \"dielectric\"\n"
        "Shape \"sphere\"\nAttributeEnd\nAreaLightSource \"diffuse\" \"rgb L\" [100 100 100]\n"
        "Material \"diffuse\" \"rgb reflectance\" [0 0 0]\nShape \"sphere\" \"float radius\" 0.3\n");
    const double irradiance = 0.9598 * PI * 100.0 * 0.09 / 16.0;
    picture map = RENDER(scene, INTEGRATORS[0], "--size=16x16", "--spp=4", "--photons=1000", "--caustic-photons=50000",
                         "--nearest=1000");
    picture path = RENDER(scene, INTEGRATORS[1], "--size=16x16", "--spp=1024");
    expect_near("photon map", picture_mean(&map, 1), 0.5 / PI * irradiance, 0.03);
    expect_near("path", picture_mean(&path, 1), 0.5 / PI * irradiance, 0.06);
    picture_reset(&map);
    picture_reset(&path);
}

/* ---- at the same point, and of no size ---- */

static void test_surfaces_at_the_same_point(void **state)
{
    (void)state;
    static const char *const THINGS[] = {
        /* glass in glass, to the last bit */
        "Material \"dielectric\"\nShape \"sphere\"\nShape \"sphere\"\nScale -1 1 1\nShape \"sphere\"\n",
        /* a lamp, a mirror and glass on one square; the eye in it */
        "Material \"dielectric\"\n"
        "Shape \"bilinearmesh\" \"point3 P\" [ -1 -1 0 1 -1 0 -1 1 0 1 1 0 ]\n"
        "Material \"conductor\"\n"
        "Shape \"bilinearmesh\" \"point3 P\" [ -1 -1 0 1 -1 0 -1 1 0 1 1 0 ]\n"
        "AreaLightSource \"diffuse\"\n"
        "Shape \"bilinearmesh\" \"point3 P\" [ -1 -1 0 1 -1 0 -1 1 0 1 1 0 ]\n",
        /* a lamp that is its own other side */
        "AreaLightSource \"diffuse\" \"bool twosided\" true\nShape \"disk\"\nReverseOrientation\nShape \"disk\"\n",
    };
    static const char *const EYES[] = {"", "LookAt 0 0 -3 0 0 0 0 1 0\n", "LookAt 0.5 0 0 0 0 0 0 1 0\n"};
    for (size_t i = 0; i < sizeof THINGS / sizeof *THINGS; i++)
        for (int e = 0; e < 3; e++) {
            char text[1024];
            snprintf(text, sizeof text, "%s" EYE_INSIDE SCREEN "%s", EYES[e], THINGS[i]);
            expect_finite(THINGS[i], text, "", NULL);
        }
}

static void test_things_of_no_size(void **state)
{
    (void)state;
#define BEFORE "LookAt 0 0 -3 0 0 0 0 1 0\nCamera \"perspective\"\nWorldBegin\n"
#define LAMP   BEFORE "AreaLightSource \"diffuse\"\n"
    static const struct {
        const char *name, *text, *warning;
    } CASES[] = {
        {"points for triangles", LAMP "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 0 0 0 0 0 0 ]\n",
         "scene.pbrt:5:1: warning: Shape \"trianglemesh\": 1 of 1 triangles have no area and are left out"},
        {"a mesh of nothing",
         LAMP "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ ]\n",
         "scene.pbrt:5:1: warning: Shape \"trianglemesh\" is empty and is left out"},
        {"a sphere that floats cannot tell", LAMP "Shape \"sphere\" \"float radius\" 1e-25\n",
         "scene.pbrt:5:1: warning: Shape \"sphere\" is too small, or scaled by too much or too little, for floats and "
         "is left out"},
        {"a flat sphere", LAMP "Scale 1 1 1e-25\nShape \"sphere\"\n",
         "scene.pbrt:6:1: warning: Shape \"sphere\" is too small"},
        {"a flat sphere that floats can tell", LAMP "Scale 1 1 1e-12\nShape \"sphere\"\n", ""},
        {"a needle for a lamp", LAMP "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1e-20 0 ]\n", ""},
        {"a lamp of no light", BEFORE "AreaLightSource \"diffuse\" \"float scale\" 0\nShape \"sphere\"\n", "no light"},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++)
        expect_finite(CASES[i].name, CASES[i].text, CASES[i].warning, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_scales),
        TEST_IN_FOLDER(test_beyond_all_measure),
        TEST_IN_FOLDER(test_eye_inside_of_opaque_things),
        TEST_IN_FOLDER(test_lamp_inside_of_glass),
        TEST_IN_FOLDER(test_surfaces_at_the_same_point),
        TEST_IN_FOLDER(test_things_of_no_size),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
