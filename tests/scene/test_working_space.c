/* test_working_space.c: colours, metals and pictures in other primaries than Rec. 709's.
 * Flow: tests of scene/color/working_space.c, color_space.c and spectra.c. Threads: one. */
#include "color/spectra.h"
#include "material/fresnel.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

/* ACEScg from linear Rec. 709, as the Academy's transforms have it. */
static const double ACESCG[9] = {0.613097402, 0.339523146, 0.047379451, 0.070193822, 0.916353879,
                                 0.013452399, 0.020615593, 0.109569773, 0.869814635};

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        print_error("%.9g is not within %g of %.9g\n", value, tolerance, expected);
    assert_true(fabs(value - expected) <= tolerance);
}

static void assert_rgb(rgb c, double r, double g, double b, double tolerance)
{
    assert_near((double)c.r, r, tolerance);
    assert_near((double)c.g, g, tolerance);
    assert_near((double)c.b, b, tolerance);
}

static working_space acescg(void)
{
    working_space s;
    assert_true(working_space_make(ACESCG, &s));
    assert_false(s.is_rec709);
    return s;
}

static void matrices(void **state)
{
    (void)state;
    working_space s = acescg();
    rgb c = working_space_light(&s, rgb_make(1.0f, 0.0f, 0.0f));
    assert_rgb(c, 0.613097, 0.070194, 0.020616, 2e-6);
    assert_near((double)working_space_luminance(&s, c), 0.2126, 2e-6);
    assert_near((double)working_space_luminance(&s, rgb_gray(1.0f)), 1.0, 2e-6);
    /* greys to the last bit */
    c = working_space_light(&s, rgb_gray(0.1f));
    assert_true(c.r == 0.1f && c.g == 0.1f && c.b == 0.1f);
    /* there and back, by way of XYZ */
    double xyz[3] = {0.3, 0.4, 0.5}, back[3];
    color_matrix_apply(&s.from_xyz, xyz, back);
    color_matrix_apply(&s.to_xyz, back, back);
    for (int i = 0; i < 3; i++)
        assert_near(back[i], xyz[i], 1e-9);
    /* D65 is white */
    const double d65[3] = {0.3127 / 0.3290, 1.0, (1.0 - 0.3127 - 0.3290) / 0.3290};
    color_matrix_apply(&s.from_xyz, d65, back);
    for (int i = 0; i < 3; i++)
        assert_near(back[i], 1.0, 1e-6);

    static const double NEARLY[9] = {1.0, 4e-4, 0.0, 0.0, 0.9996, 0.0, 0.0, 0.0, 1.0003},
                        FLAT[9] = {1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0};
    assert_true(working_space_make(NEARLY, &s));
    assert_true(s.is_rec709);
    assert_true(s.from_rec709.m[0][1] == 0.0);
    assert_false(working_space_make(FLAT, &s));
    c = working_space_light(NULL, rgb_make(0.3f, 0.2f, 0.1f));
    assert_true(c.r == 0.3f && c.g == 0.2f && c.b == 0.1f);
}

static void what_does_not_fit_is_clipped(void **state)
{
    (void)state;
    working_space s = acescg(), narrow;
    color_matrix to_rec709;
    double rows[9];
    assert_true(color_matrix_invert(&s.from_rec709, &to_rec709));
    for (int i = 0; i < 9; i++)
        rows[i] = to_rec709.m[i / 3][i % 3];
    assert_true(working_space_make(rows, &narrow)); /* as far within Rec. 709 as that is within ACEScg */
    rgb c = working_space_reflectance(&narrow, rgb_make(0.9f, 0.0f, 0.0f));
    assert_rgb(c, 1.0, 0.0, 0.0, 1e-6);
    c = working_space_light(&narrow, rgb_make(0.9f, 0.0f, 0.0f));
    assert_rgb(c, 0.9 * 1.7050510, 0.0, 0.0, 1e-5);
}

/* The spaces that have a name get back the chromaticities that they were published with; others are seen by D65. */
static void chromaticities(void **state)
{
    (void)state;
    static const float AP1[8] = {.713f, .293f, .165f, .83f, .128f, .044f, .32168f, .33767f};
    static const float P3[8] = {.68f, .32f, .265f, .69f, .15f, .06f, .3127f, .329f};
    static const double HALF[9] = {0.8, 0.1, 0.1, 0.1, 0.8, 0.1, 0.1, 0.1, 0.8};
    float xy[8];
    working_space s = acescg();
    working_space_chromaticities(&s, xy);
    for (int i = 0; i < 8; i++)
        assert_near((double)xy[i], (double)AP1[i], 1e-6);
    working_space_chromaticities(NULL, xy);
    assert_near((double)xy[0], 0.64, 1e-6);

    color_matrix to_rec709, from_rec709;
    double rows[9];
    assert_true(color_chromaticities_to_rec709(P3, &to_rec709));
    assert_true(color_matrix_invert(&to_rec709, &from_rec709));
    for (int i = 0; i < 9; i++)
        rows[i] = from_rec709.m[i / 3][i % 3];
    assert_true(working_space_make(rows, &s));
    working_space_chromaticities(&s, xy);
    for (int i = 0; i < 8; i++)
        assert_near((double)xy[i], (double)P3[i], 1e-6);

    /* whoever reads them gets the same matrix */
    assert_true(working_space_make(HALF, &s));
    working_space_chromaticities(&s, xy);
    assert_true(color_chromaticities_to_rec709(xy, &to_rec709));
    assert_true(color_matrix_invert(&to_rec709, &from_rec709));
    for (int i = 0; i < 9; i++)
        assert_near(from_rec709.m[i / 3][i % 3], HALF[i], 1e-5);

    static const float NONE[8] = {0}, LINE[8] = {.6f, .3f, .6f, .3f, .6f, .3f, .3f, .3f};
    assert_false(color_chromaticities_to_rec709(NONE, &to_rec709));
    assert_false(color_chromaticities_to_rec709(LINE, &to_rec709));
}

/* A metal reflects head-on what it reflects in Rec. 709, converted; what does not absorb goes on so; greys stay. */
static void metals(void **state)
{
    (void)state;
    static const char *const NAMES[] = {"metal-Au", "metal-Ag", "metal-Cu", "metal-CuZn", "metal-Al", "metal-TiO2"};
    working_space s = acescg();
    for (size_t i = 0; i < sizeof NAMES / sizeof *NAMES; i++) {
        char name[32];
        rgb eta, k;
        snprintf(name, sizeof name, "%s-eta", NAMES[i]);
        assert_true(spectra_find_named(name, &s, &eta));
        snprintf(name, sizeof name, "%s-k", NAMES[i]);
        assert_true(spectra_find_named(name, &s, &k));
        rgb before = fresnel_conductor(1.0f, eta, k), expected = working_space_reflectance(&s, before);
        const bool absorbs = !rgb_is_black(k);
        working_space_metal(&s, &eta, &k);
        rgb after = fresnel_conductor(1.0f, eta, k);
        assert_rgb(after, (double)expected.r, (double)expected.g, (double)expected.b, 2e-5);
        assert_true(absorbs != rgb_is_black(k));
    }
    rgb eta = rgb_gray(0.4f), k = rgb_gray(2.5f);
    working_space_metal(&s, &eta, &k);
    assert_rgb(eta, 0.4, 0.4, 0.4, 1e-5);
    assert_rgb(k, 2.5, 2.5, 2.5, 1e-5);
}

/* A line of light that Rec. 709 has to clip is the same light in the wider space. */
static void spectra(void **state)
{
    (void)state;
    working_space s = acescg();
    rgb sun = spectra_blackbody(3000.0, NULL), wide = spectra_blackbody(3000.0, &s);
    rgb expected = working_space_light(&s, sun);
    assert_rgb(wide, (double)expected.r, (double)expected.g, (double)expected.b, 2e-6);
    static const double LINE[] = {524.0, 0.0, 525.0, 1.0, 526.0, 0.0}, HALF[] = {400.0, 0.5, 700.0, 0.5};
    rgb clipped = spectra_sampled(LINE, 3, SPECTRUM_LIGHT, NULL), green = spectra_sampled(LINE, 3, SPECTRUM_LIGHT, &s);
    assert_true(clipped.r == 0.0f && clipped.b == 0.0f);
    double unclipped[3] = {(double)green.r, (double)green.g, (double)green.b};
    assert_near((double)working_space_luminance(&s, green), 1.0, 0.05); /* it all but fits */
    color_matrix_apply(&s.to_xyz, unclipped, unclipped);
    assert_near(unclipped[1] / (unclipped[0] + unclipped[1] + unclipped[2]), 0.8, 0.02);
    assert_rgb(spectra_sampled(HALF, 2, SPECTRUM_REFLECTANCE, &s), 0.5, 0.5, 0.5, 1e-6);
    /* densities are converted, indices are not */
    static const double SLOPE[] = {400.0, 3.0, 700.0, 1.0};
    rgb index = spectra_sampled(SLOPE, 2, SPECTRUM_INDEX, &s), same = spectra_sampled(SLOPE, 2, SPECTRUM_INDEX, NULL);
    assert_memory_equal(&index, &same, sizeof index);
    rgb density = spectra_sampled(SLOPE, 2, SPECTRUM_DENSITY, &s), converted = working_space_light(&s, same);
    assert_memory_equal(&density, &converted, sizeof density);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(matrices),       cmocka_unit_test(what_does_not_fit_is_clipped),
        cmocka_unit_test(chromaticities), cmocka_unit_test(metals),
        cmocka_unit_test(spectra),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
