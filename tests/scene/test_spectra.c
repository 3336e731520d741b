/* test_spectra.c: the standard observer, colours of lights and reflectances against closed forms and published figures,
 * colour spaces against the matrices of their standards.
 * Threads: one. */
#include "color/cie.h"
#include "color/color_space.h"
#include "color/spectra.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.9g is not %.9g within %g", value, expected, tolerance);
}

static void chromaticity(rgb color, double out_xy[2], double *out_luminance)
{
    const double c[3] = {color.r, color.g, color.b};
    double xyz[3];
    color_matrix m = color_xyz_from_rec709();
    color_matrix_apply(&m, c, xyz);
    out_xy[0] = xyz[0] / (xyz[0] + xyz[1] + xyz[2]);
    out_xy[1] = xyz[1] / (xyz[0] + xyz[1] + xyz[2]);
    *out_luminance = xyz[1];
}

/* The areas of the 1 nm tables are 106.8653, 106.8569 and 106.8922: equal, so that equal energy is white. Under D65 the
 * chromaticity is that of CIE 15:2004, table T.3, and single values are those of its table T.1. */
static void the_observer_is_the_standards(void **state)
{
    (void)state;
    double sum[3] = {0.0, 0.0, 0.0}, daylight[3] = {0.0, 0.0, 0.0}, m[3];
    for (int nm = CIE_FIRST_NM; nm <= CIE_LAST_NM; nm++) {
        cie_match(nm, m);
        for (int i = 0; i < 3; i++) {
            sum[i] += m[i];
            daylight[i] += m[i] * cie_d65(nm);
        }
    }
    assert_near(sum[0], 106.8653, 2e-3);
    assert_near(sum[1], 106.8569, 2e-3);
    assert_near(sum[2], 106.8922, 2e-3);
    double all = daylight[0] + daylight[1] + daylight[2];
    assert_near(daylight[0] / all, 0.31272, 5e-5);
    assert_near(daylight[1] / all, 0.32903, 5e-5);
    static const double D65[][2] = {{400, 82.7549}, {450, 117.008}, {500, 109.354}, {600, 90.0062}, {700, 71.6091}};
    for (size_t i = 0; i < sizeof D65 / sizeof *D65; i++)
        assert_near(cie_d65(D65[i][0]), D65[i][1], 1e-3);
    cie_match(359.9, m);
    assert_near(m[0] + m[1] + m[2], 0.0, 0.0);
    cie_match(557.5, m); /* half way between two entries */
    assert_near(m[1], 0.5 * (1.0 + 0.995), 1e-9);
    double xy[2];
    cie_daylight_chromaticity(5000.0 * 1.4388 / 1.4380, xy); /* D50 */
    assert_near(xy[0], 0.34567, 5e-5);
    assert_near(xy[1], 0.35851, 2e-4);
}

/* Wyszecki and Stiles, "Color Science", 2nd ed., 1982, table 1(3.11): the Planckian locus. */
static void black_bodies(void **state)
{
    (void)state;
    static const double CASES[][3] = {{2856, .44757, .40745},
                                      {4000, .3805, .3768},
                                      {5000, .3451, .3516},
                                      {6500, .3135, .3237},
                                      {10000, .2806, .2883}};
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        double xy[2], luminance;
        chromaticity(spectra_blackbody(CASES[i][0], NULL), xy, &luminance);
        assert_near(luminance, 1.0, 1e-6);
        assert_near(xy[0], CASES[i][1], 1e-4);
        assert_near(xy[1], CASES[i][2], 1e-4);
        spectra_blackbody_chromaticity(CASES[i][0], xy);
        assert_near(xy[0], CASES[i][1], 1e-4);
        assert_near(xy[1], CASES[i][2], 1e-4);
    }
}

static void light_has_luminance_one(void **state)
{
    (void)state;
    /* equal energy is at x = y = 1/3, whatever its value */
    static const double EVEN[2][4] = {{300, 1, 900, 1}, {300, 7, 900, 7}};
    for (int i = 0; i < 2; i++) {
        double xy[2], luminance;
        chromaticity(spectra_sampled(EVEN[i], 2, SPECTRUM_LIGHT, NULL), xy, &luminance);
        assert_near(luminance, 1.0, 1e-6);
        assert_near(xy[0], 1.0 / 3.0, 5e-5);
        assert_near(xy[1], 1.0 / 3.0, 5e-5);
    }
    /* a black body by its values */
    double planck[2 * 96];
    for (int i = 0; i < 96; i++) {
        double nm = 358.0 + 5.0 * i;
        planck[2 * i] = nm;
        planck[2 * i + 1] = pow(560.0 / nm, 5.0) / expm1(1.438776877e7 / (nm * 4500.0));
    }
    rgb sampled = spectra_sampled(planck, 96, SPECTRUM_LIGHT, NULL), exact = spectra_blackbody(4500.0, NULL);
    assert_near(sampled.r, exact.r, 2e-4);
    assert_near(sampled.g, exact.g, 2e-4);
    assert_near(sampled.b, exact.b, 2e-4);
    /* outside its wavelengths there is none */
    static const double RED[] = {620, 1, 700, 1}, NONE[] = {400, 0, 700, 0}, INFRARED[] = {900, 1, 1000, 1};
    rgb red = spectra_sampled(RED, 2, SPECTRUM_LIGHT, NULL);
    assert_true(red.r > 3.0f && red.g == 0.0f && red.b == 0.0f);
    assert_true(rgb_is_black(spectra_sampled(NONE, 2, SPECTRUM_LIGHT, NULL)));
    assert_true(rgb_is_black(spectra_sampled(INFRARED, 2, SPECTRUM_LIGHT, NULL)));
    /* one wavelength is a line: 580 nm, whose chromaticity is .5125 .4866; blue is outside the gamut and becomes 0 */
    static const double LINE[] = {580, 1};
    rgb line = spectra_sampled(LINE, 1, SPECTRUM_LIGHT, NULL);
    color_matrix m = color_rec709_from_xyz();
    const double xyz[3] = {.9163 / .87, 1.0, .001650001 / .87};
    double c[3];
    color_matrix_apply(&m, xyz, c);
    assert_near(line.r, c[0], 1e-6);
    assert_near(line.g, c[1], 1e-6);
    assert_true(c[2] < 0.0 && line.b == 0.0f);
}

static void reflectances_are_shares(void **state)
{
    (void)state;
    static const double HALF[] = {400, .5, 700, .5}, WHITE[] = {550, 1}, STEP[] = {300, 0, 589.5, 0, 590.5, 1, 900, 1};
    rgb c = spectra_sampled(HALF, 2, SPECTRUM_REFLECTANCE, NULL);
    assert_near(c.r, 0.5, 1e-6);
    assert_near(c.g, 0.5, 1e-6);
    assert_near(c.b, 0.5, 1e-6);
    c = spectra_sampled(WHITE, 1, SPECTRUM_REFLECTANCE, NULL);
    assert_near(c.r + c.g + c.b, 3.0, 1e-6);
    /* a reflectance and the rest of the light make white: they are linear while nothing is clipped */
    c = spectra_sampled(STEP, 4, SPECTRUM_REFLECTANCE, NULL);
    assert_true(c.r > 0.7f && c.r <= 1.0f && c.g < 0.2f && c.b < 0.02f);
    static const double SLOPE[] = {360, .2, 830, .8}, REST[] = {360, .8, 830, .2};
    rgb a = spectra_sampled(SLOPE, 2, SPECTRUM_REFLECTANCE, NULL),
        b = spectra_sampled(REST, 2, SPECTRUM_REFLECTANCE, NULL);
    assert_near(a.r + b.r, 1.0, 1e-6);
    assert_near(a.g + b.g, 1.0, 1e-6);
    assert_near(a.b + b.b, 1.0, 1e-6);
    assert_true(a.r > a.g && a.g > a.b);
}

static void indices_stay_between_their_values(void **state)
{
    (void)state;
    static const double GLASS[] = {400, 1.5, 700, 1.5}, SLOPE[] = {400, 4, 700, 1}, STEP[] = {499, 1.5, 501, .2};
    rgb c = spectra_sampled(GLASS, 2, SPECTRUM_INDEX, NULL);
    assert_near(c.r, 1.5, 1e-6);
    assert_near(c.b, 1.5, 1e-6);
    c = spectra_sampled(SLOPE, 2, SPECTRUM_INDEX, NULL);
    assert_near(c.b, 4.0 - .01 * 50, 0.1); /* each at its wavelength: about 450, 540 and 600 nm */
    assert_near(c.g, 4.0 - .01 * 140, 0.1);
    assert_near(c.r, 4.0 - .01 * 200, 0.15);
    c = spectra_sampled(STEP, 2, SPECTRUM_INDEX, NULL);
    assert_true(c.r >= .2f && c.g >= .2f && c.b <= 1.5f && c.b > 1.3f);
}

static void names(void **state)
{
    (void)state;
    static const char *const KNOWN[] = {
        "glass-BK7",    "glass-BAF10",    "glass-FK51A",  "glass-LASF9",    "glass-F5",     "glass-F10",
        "glass-F11",    "metal-Ag-eta",   "metal-Ag-k",   "metal-Al-eta",   "metal-Al-k",   "metal-Au-eta",
        "metal-Au-k",   "metal-Cu-eta",   "metal-Cu-k",   "metal-CuZn-eta", "metal-CuZn-k", "metal-MgO-eta",
        "metal-MgO-k",  "metal-TiO2-eta", "metal-TiO2-k", "stdillum-A",     "stdillum-D50", "stdillum-D65",
        "stdillum-F1",  "stdillum-F2",    "stdillum-F3",  "stdillum-F4",    "stdillum-F5",  "stdillum-F6",
        "stdillum-F7",  "stdillum-F8",    "stdillum-F9",  "stdillum-F10",   "stdillum-F11", "stdillum-F12",
        "illum-acesD60"};
    rgb c;
    for (size_t i = 0; i < sizeof KNOWN / sizeof *KNOWN; i++)
        if (!spectra_find_named(KNOWN[i], NULL, &c) || spectra_is_missing(KNOWN[i]))
            fail_msg("%s", KNOWN[i]);
    assert_false(spectra_find_named("stdillum-F13", NULL, &c));
    assert_true(spectra_is_missing("nikon_d810_g") && spectra_is_missing("canon_eos_100d_r"));
    assert_false(spectra_is_missing("nikon_d810_x") || spectra_is_missing("nikon_d811_g") || spectra_is_missing("_g"));
    assert_true(spectra_is_sensor("sony_ilce_9", 11));
    /* A is a black body of 2855.54 K */
    assert_true(spectra_find_named("stdillum-A", NULL, &c));
    rgb body = spectra_blackbody(2855.54, NULL);
    assert_near(c.r, body.r, 2e-3);
    assert_near(c.g, body.g, 2e-3);
    assert_near(c.b, body.b, 2e-3);
    double xy[2], luminance;
    assert_true(spectra_find_named("stdillum-F11", NULL, &c));
    chromaticity(c, xy, &luminance);
    assert_near(xy[0], .38052, 1e-6);
    assert_near(xy[1], .37713, 1e-6);
    assert_near(luminance, 1.0, 1e-6);
}

static void check_matrix(color_space from, bool is_light, const double expected[3][3], double tolerance)
{
    color_matrix m = color_space_to_rec709(from, is_light);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            assert_near(m.m[i][k], expected[i][k], tolerance);
}

static void color_spaces(void **state)
{
    (void)state;
    static const double ONE[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    /* ITU-R BT.2407-0, 2.2 */
    static const double REC2020[3][3] = {{1.6605, -.5876, -.0728}, {-.1246, 1.1329, -.0083}, {-.0182, -.1006, 1.1187}};
    /* SMPTE EG 432-1 */
    static const double P3[3][3] = {{1.2249, -.2249, 0}, {-.0420, 1.0420, 0}, {-.0196, -.0786, 1.0983}};
    /* AP0 to Rec. 709 as ACES' output transforms have it, by Bradford */
    static const double ACES[3][3] = {
        {2.52169, -1.13413, -.38756}, {-.27648, 1.37272, -.09624}, {-.01538, -.15298, 1.16835}};
    for (int light = 0; light < 2; light++) {
        check_matrix(COLOR_SPACE_SRGB, light, ONE, 1e-12);
        check_matrix(COLOR_SPACE_REC2020, light, REC2020, 1e-4);
        check_matrix(COLOR_SPACE_DCI_P3, light, P3, 1e-4);
    }
    check_matrix(COLOR_SPACE_ACES2065_1, false, ACES, 2e-5);
    /* of light, white is the white of the space */
    color_matrix m = color_space_to_rec709(COLOR_SPACE_ACES2065_1, true);
    rgb white = rgb_make((float)(m.m[0][0] + m.m[0][1] + m.m[0][2]), (float)(m.m[1][0] + m.m[1][1] + m.m[1][2]),
                         (float)(m.m[2][0] + m.m[2][1] + m.m[2][2]));
    double xy[2], luminance;
    chromaticity(white, xy, &luminance);
    assert_near(xy[0], .32168, 1e-6);
    assert_near(xy[1], .33767, 1e-6);
    assert_near(luminance, 1.0, 1e-6);
    color_space s;
    assert_true(color_space_find("ACES2065-1", &s) && s == COLOR_SPACE_ACES2065_1);
    assert_true(color_space_find("sRGB", &s) && s == COLOR_SPACE_SRGB);
    assert_false(color_space_find("rec709", &s));
}

/* The white that it is from goes exactly to the white that it is to, and what is grey stays grey. */
static void adaptation(void **state)
{
    (void)state;
    static const double WARM[2] = {.44757, .40745};
    color_matrix m = color_adaptation(WARM, COLOR_WHITE_XY), back = color_adaptation(COLOR_WHITE_XY, WARM);
    const double white[3] = {WARM[0] / WARM[1], 1.0, (1.0 - WARM[0] - WARM[1]) / WARM[1]};
    double out[3];
    color_matrix_apply(&m, white, out);
    assert_near(out[0] / (out[0] + out[1] + out[2]), COLOR_WHITE_XY[0], 1e-9);
    assert_near(out[1] / (out[0] + out[1] + out[2]), COLOR_WHITE_XY[1], 1e-9);
    assert_near(out[1], 1.0, 1e-9);
    color_matrix both = color_matrix_multiply(&back, &m);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            assert_near(both.m[i][k], i == k ? 1.0 : 0.0, 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_observer_is_the_standards),
        cmocka_unit_test(black_bodies),
        cmocka_unit_test(light_has_luminance_one),
        cmocka_unit_test(reflectances_are_shares),
        cmocka_unit_test(indices_stay_between_their_values),
        cmocka_unit_test(names),
        cmocka_unit_test(color_spaces),
        cmocka_unit_test(adaptation),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
