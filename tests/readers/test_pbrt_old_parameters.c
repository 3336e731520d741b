/* test_pbrt_old_parameters.c: scenes in pbrt-v3's words, as the reader makes pbrt-v4's of them; and names given twice.
 * Threads: one. */
#include "fixtures/pbrt_fixture.h"

#include "color/spectra.h"

/* Reads text of which the reader says, in warnings, `count` things, and each of the words. */
static reading told(const char *text, int count, const char *const *words)
{
    reading r = reading_create(NULL, text, strlen(text));
    if (r.said[AG_LOG_ERROR])
        print_error("%s", r.said[AG_LOG_ERROR]);
    assert_int_equal(r.status, AG_OK);
    if (r.count[AG_LOG_WARNING] != count)
        fail_msg("%d warnings instead of %d:\n%s", r.count[AG_LOG_WARNING], count, r.said[AG_LOG_WARNING]);
    for (; count > 0 && *words; words++)
        if (!strstr(r.said[AG_LOG_WARNING], *words))
            fail_msg("\"%s\" is missing from\n%s", *words, r.said[AG_LOG_WARNING]);
    return r;
}

static void options(void **state)
{
    (void)state;
    reading r =
        told("Film \"image\" \"float scale\" 2.5 \"float maxsampleluminance\" 9\n"
             "PixelFilter \"gaussian\" \"float xwidth\" 3 \"float ywidth\" 4 \"float alpha\" 2\n"
             "Sampler \"02sequence\" Camera \"environment\" WorldBegin",
             8,
             (const char *const[]){"t:1:1: warning: Film: \"image\" is pbrt-v3's: it is read as \"rgb\"",
                                   "t:1:14: warning: Film: \"scale\" is pbrt-v3's: it is read as \"iso\"",
                                   "t:2:58: warning: PixelFilter: \"alpha\"",
                                   "t:3:1: warning: Sampler: ", "t:3:22: warning: Camera: \"environment\"", NULL});
    const scene_hints *hints = &r.scene->hints;
    assert_near(hints->iso, 250, 1e-9);
    assert_near(hints->max_component, 9, 0);
    assert_int_equal(hints->filter.kind, FILTER_GAUSSIAN);
    assert_near(hints->filter.radius[0], 3, 0);
    assert_near(hints->filter.radius[1], 4, 0);
    assert_near(hints->filter.sigma, 0.5, 1e-12);
    assert_true(hints->has_sampler);
    assert_int_equal(r.scene->camera.kind, CAMERA_EQUIRECTANGULAR);
    reading_destroy(&r);
    /* where the new name is there too it holds */
    r = told("Film \"rgb\" \"float iso\" 50 \"float scale\" 2 WorldBegin", 1,
             (const char *const[]){"t:1:27: warning: Film \"rgb\": \"float scale\" is not known", NULL});
    assert_near(r.scene->hints.iso, 50, 0);
    reading_destroy(&r);
}

static rgb light_of(const char *text, int warnings, const char *word)
{
    char whole[512];
    snprintf(whole, sizeof whole, "WorldBegin %s Shape \"disk\"", text);
    reading r = told(whole, warnings, (const char *const[]){word, NULL});
    assert_int_equal(r.scene->light_count, 1);
    const light *l = &r.scene->lights[0];
    rgb color = l->kind == LIGHT_POINT     ? l->as.point.intensity
                : l->kind == LIGHT_DISTANT ? l->as.distant.irradiance
                : l->kind == LIGHT_AREA    ? l->as.area.radiance
                                           : l->as.infinite.radiance.value;
    reading_destroy(&r);
    return color;
}

static void lights(void **state)
{
    (void)state;
    const char *scale = "\"rgb scale\" is pbrt-v3's";
    assert_rgb(light_of("LightSource \"point\" \"rgb scale\" [ 3 3 3 ] \"rgb I\" [ 1 2 4 ]", 1, scale), 3, 6, 12, 1e-6);
    assert_rgb(light_of("LightSource \"point\" \"rgb scale\" [ 3 2 1 ] \"rgb I\" [ 1 2 4 ]", 1, scale), 3, 4, 4, 1e-6);
    assert_rgb(light_of("LightSource \"distant\" \"rgb scale\" [ 3 2 1 ]", 1, scale), 3, 2, 1, 1e-6);
    assert_rgb(light_of("LightSource \"infinite\" \"integer samples\" 8 \"rgb L\" [ 1 2 3 ]", 0, NULL), 1, 2, 3, 1e-6);
    assert_rgb(light_of("AreaLightSource \"area\" \"rgb L\" [ 1 2 3 ] \"integer nsamples\" 8", 1, "\"area\""), 1, 2, 3,
               1e-6);
    const char *text = "WorldBegin LightSource \"point\" \"rgb scale\" [ 1 2 3 ] \"blackbody I\" 3000";
    reading r = reading_create(NULL, text, strlen(text));
    assert_int_equal(r.status, AG_ERROR_SCENE);
    assert_non_null(strstr(r.said[AG_LOG_ERROR], "t:1:32: error: \"rgb scale\" can be read beside \"rgb I\" alone"));
    reading_destroy(&r);
}

/* The eye's sensitivity by two lobes: Wyman, Sloan, Shirley, "Simple Analytic Approximations to the CIE XYZ Color
 * Matching Functions", 2013. */
static double sensitivity(double nm)
{
    const double a = (nm - 568.8) / (nm < 568.8 ? 46.9 : 40.5), b = (nm - 530.9) / (nm < 530.9 ? 16.3 : 31.1);
    return 0.821 * exp(-0.5 * a * a) + 0.286 * exp(-0.5 * b * b);
}

static void black_bodies_have_a_peak_of_one(void **state)
{
    (void)state;
    static const double KELVIN[] = {2000, 2700, 5221, 9000};
    for (size_t i = 0; i < sizeof KELVIN / sizeof *KELVIN; i++) {
        double sum = 0, whole = 0;
        for (double nm = 380.5; nm < 780; nm++) { /* Planck's law relative to its greatest value */
            const double x = 1.4387769e7 / (nm * KELVIN[i]), peak = 4.9651142;
            sum += sensitivity(nm) * pow(x / peak, 5) * expm1(peak) / expm1(x);
            whole += sensitivity(nm);
        }
        assert_near(spectra_blackbody_luminance(KELVIN[i]) / (sum / whole), 1, 0.01);
    }
    assert_true(spectra_blackbody_luminance(5221) < 1);
    const rgb one = spectra_blackbody(2700, NULL);
    const double l = 5 * 2 * spectra_blackbody_luminance(2700);
    assert_rgb(light_of("AreaLightSource \"diffuse\" \"blackbody L\" [ 2700 5 ] \"float scale\" 2", 1,
                        "is as bright as there"),
               l * one.r, l * one.g, l * one.b, 1e-5);
    assert_rgb(light_of("LightSource \"point\" \"blackbody I\" [ 2700 10 ]", 1, "is as bright as there"), l * one.r,
               l * one.g, l * one.b, 1e-5);
}

static void shapes(void **state)
{
    (void)state;
    reading r = told(
        "WorldBegin\n"
        "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"float uv\" [ 0 0 2 0 0 3 ]\n"
        "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"float st\" [ 0 0 4 0 0 5 ]\n"
        "  \"bool discarddegenerateUVs\" true\n"
        "Shape \"loopsubdiv\" \"integer nlevels\" 1 \"integer indices\" [ 0 1 2 ] \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ]\n"
        "Shape \"cone\"",
        4,
        (const char *const[]){
            "t:2:55: warning: Shape: \"float uv\" is pbrt-v3's", "\"st\" is pbrt-v3's", "\"nlevels\" is pbrt-v3's",
            "t:6:1: warning: Shape \"cone\" is pbrt-v3's and not part of pbrt-v4: it is left out", NULL});
    assert_int_equal(r.scene->shape_count, 3);
    assert_near(r.scene->shapes[0].as.mesh.uvs[2].y, 3, 0);
    assert_near(r.scene->shapes[1].as.mesh.uvs[1].x, 4, 0);
    assert_int_equal(r.scene->shapes[2].as.mesh.triangle_count, 4);
    reading_destroy(&r);
}

static void media(void **state)
{
    (void)state;
    reading r =
        told("MakeNamedMedium \"m\" \"string type\" \"heterogeneous\" \"float density\" [ 1 3 ]\n"
             "\"rgb sigma_a\" [ 1 2 3 ] \"rgb sigma_s\" [ 0 0 0 ] WorldBegin",
             2, (const char *const[]){"\"heterogeneous\" is pbrt-v3's", "\"uniformgrid\" are not supported", NULL});
    assert_rgb(r.scene->media[0].as.homogeneous.sigma_a, 2, 4, 6, 1e-6);
    reading_destroy(&r);
}

static void the_last_of_two_counts(void **state)
{
    (void)state;
    reading r =
        told("WorldBegin LightSource \"point\" \"float scale\" 2 \"rgb I\" [ 1 1 1 ] \"float scale\" 3", 1,
             (const char *const[]){
                 "t:1:66: warning: LightSource: \"scale\" is given twice, first at 1:32: the last counts", NULL});
    assert_rgb(r.scene->lights[0].as.point.intensity, 3, 3, 3, 0);
    reading_destroy(&r);
    /* of another type too */
    r = told("WorldBegin Material \"dielectric\" \"float eta\" 2 \"spectrum eta\" \"glass-BK7\" Shape \"sphere\"", 1,
             (const char *const[]){"\"eta\" is given twice", NULL});
    assert_near(r.scene->materials[r.scene->shapes[0].material_index].ior, 1.5168, 1e-6);
    reading_destroy(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(options), cmocka_unit_test(lights), cmocka_unit_test(black_bodies_have_a_peak_of_one),
        cmocka_unit_test(shapes),  cmocka_unit_test(media),  cmocka_unit_test(the_last_of_two_counts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
