/* spectra.c: see spectra.h. The metals' indices are those in public use for rendering in RGB: Ag, Al, Au and Cu are
 * tables of Palik's "Handbook of Optical Constants of Solids" integrated with the CIE curves (as Tungsten and Mitsuba
 * scenes have them); CuZn, MgO and TiO2 are pbrt-v4's tables at 630, 530 and 450 nm. The glasses are the makers' n_d.
 * The illuminants are the chromaticities of CIE 15:2004, tables T.3 and T.8.2, and of the Academy's TB-2018-001 (D60).
 * Threads: any. */
#include "color/spectra.h"

#include "color/cie.h"
#include "color/color_space.h"

#include <string.h>

/* Converts XYZ of luminance 1 to linear RGB; components outside the gamut become 0. */
static rgb rgb_of(const double xyz[3], const working_space *space)
{
    color_matrix from_xyz = space ? space->from_xyz : color_rec709_from_xyz();
    double c[3];
    color_matrix_apply(&from_xyz, xyz, c);
    return rgb_make((float)double_max(c[0], 0.0), (float)double_max(c[1], 0.0), (float)double_max(c[2], 0.0));
}

static rgb rgb_of_chromaticity(double x, double y, const working_space *space)
{
    const double xyz[3] = {x / y, 1.0, (1.0 - x - y) / y};
    return rgb_of(xyz, space);
}

/* XYZ of luminance 1. */
static void blackbody_xyz(double kelvin, double xyz[3])
{
    static const double SECOND_RADIATION_CONSTANT = 1.438776877e7; /* h c / k in nm K, CODATA 2018 */
    xyz[0] = xyz[1] = xyz[2] = 0.0;
    for (int nm = CIE_FIRST_NM; nm <= CIE_LAST_NM; nm++) {
        double match[3], relative = 560.0 / nm; /* relative to 560 nm: only the shape matters */
        double emitted =
            relative * relative * relative * relative * relative *
            (expm1(SECOND_RADIATION_CONSTANT / (560.0 * kelvin)) / expm1(SECOND_RADIATION_CONSTANT / (nm * kelvin)));
        cie_match(nm, match);
        for (int i = 0; i < 3; i++)
            xyz[i] += emitted * match[i];
    }
    xyz[0] /= xyz[1];
    xyz[2] /= xyz[1];
    xyz[1] = 1.0;
}

double spectra_blackbody_luminance(double kelvin)
{
    /* Wien's law: there the exponent is that of the emission's greatest value */
    const double peak = 4.965114231744276, second_radiation_constant = 1.438776877e7,
                 peak_nm = second_radiation_constant / (peak * kelvin);
    double sum = 0.0, whole = 0.0;
    for (int nm = CIE_FIRST_NM; nm <= CIE_LAST_NM; nm++) {
        double match[3], relative = peak_nm / nm;
        cie_match(nm, match);
        sum += match[1] * relative * relative * relative * relative * relative * (expm1(peak) / expm1(peak * relative));
        whole += match[1];
    }
    return sum / whole;
}

rgb spectra_blackbody(double kelvin, const working_space *space)
{
    double xyz[3];
    blackbody_xyz(kelvin, xyz);
    return rgb_of(xyz, space);
}

void spectra_blackbody_chromaticity(double kelvin, double out_xy[2])
{
    double xyz[3];
    blackbody_xyz(kelvin, xyz);
    out_xy[0] = xyz[0] / (xyz[0] + xyz[1] + xyz[2]);
    out_xy[1] = xyz[1] / (xyz[0] + xyz[1] + xyz[2]);
}

/* Returns the value of the pairs at a wavelength; *in_out_next is the first pair beyond the last wavelength of the
 * calls before, which was lower. */
static double value_at(const double *pairs, size_t count, double nm, bool goes_on, size_t *in_out_next)
{
    while (*in_out_next < count && pairs[2 * *in_out_next] <= nm)
        ++*in_out_next;
    size_t next = *in_out_next;
    const double *above = pairs + 2 * next, *below = above - 2;
    if (next == 0)
        return goes_on ? above[1] : 0.0;
    if (next == count)
        return goes_on || below[0] == nm ? below[1] : 0.0;
    return below[1] + (nm - below[0]) / (above[0] - below[0]) * (above[1] - below[1]);
}

rgb spectra_sampled(const double *pairs, size_t pair_count, spectrum_use use, const working_space *space)
{
    double sum[3] = {0.0, 0.0, 0.0}, whole[3] = {0.0, 0.0, 0.0}, value[3];
    const bool is_index = use == SPECTRUM_INDEX || use == SPECTRUM_DENSITY;
    color_matrix from_xyz = space && !is_index ? space->from_xyz : color_rec709_from_xyz();
    size_t next = 0;
    for (int nm = CIE_FIRST_NM; nm <= CIE_LAST_NM; nm++) {
        double weight[3], v = value_at(pairs, pair_count, nm, use != SPECTRUM_LIGHT, &next);
        cie_match(nm, weight);
        if (use != SPECTRUM_LIGHT)
            color_matrix_apply(&from_xyz, weight, weight);
        for (int i = 0; i < 3; i++) {
            if (use == SPECTRUM_REFLECTANCE)
                weight[i] *= cie_d65(nm);
            if (is_index)
                weight[i] = double_max(weight[i], 0.0);
            sum[i] += weight[i] * v;
            whole[i] += weight[i];
        }
    }
    if (use == SPECTRUM_LIGHT) {
        if (!(sum[1] > 0.0))
            return rgb_gray(0.0f);
        const double xyz[3] = {sum[0] / sum[1], 1.0, sum[2] / sum[1]};
        return rgb_of(xyz, space);
    }
    for (int i = 0; i < 3; i++)
        value[i] = use == SPECTRUM_REFLECTANCE ? double_clamp(sum[i] / whole[i], 0.0, 1.0) : sum[i] / whole[i];
    rgb result = rgb_make((float)value[0], (float)value[1], (float)value[2]);
    return use == SPECTRUM_DENSITY ? working_space_light(space, result) : result;
}

typedef struct named_spectrum {
    const char *name;
    rgb value;
} named_spectrum;

static const named_spectrum NAMED_SPECTRA[] = {
    {"metal-Ag-eta", {0.1552646f, 0.1167233f, 0.1383807f}},
    {"metal-Ag-k", {4.8283433f, 3.1222459f, 2.1469505f}},
    {"metal-Al-eta", {1.6574600f, 0.8803690f, 0.5212287f}},
    {"metal-Al-k", {9.2238692f, 6.2695232f, 4.8370012f}},
    {"metal-Au-eta", {0.1431190f, 0.3749570f, 1.4424786f}},
    {"metal-Au-k", {3.9831604f, 2.3857207f, 1.6032152f}},
    {"metal-Cu-eta", {0.2004377f, 0.9240334f, 1.1022120f}},
    {"metal-Cu-k", {3.9129485f, 2.4528477f, 2.1421880f}},
    {"metal-CuZn-eta", {0.445f, 0.573f, 1.094f}},
    {"metal-CuZn-k", {3.522f, 2.568f, 1.829f}},
    {"metal-MgO-eta", {1.735f, 1.742f, 1.752f}},
    {"metal-MgO-k", {0.0f, 0.0f, 0.0f}},
    {"metal-TiO2-eta", {2.875f, 2.974f, 3.165f}},
    {"metal-TiO2-k", {0.0f, 0.0f, 0.0f}},
    {"glass-BK7", {1.5168f, 1.5168f, 1.5168f}},
    {"glass-BAF10", {1.6700f, 1.6700f, 1.6700f}},
    {"glass-FK51A", {1.4866f, 1.4866f, 1.4866f}},
    {"glass-LASF9", {1.8503f, 1.8503f, 1.8503f}},
    {"glass-F5", {1.6727f, 1.6727f, 1.6727f}}, /* pbrt's F5, F10 and F11 are Schott's SF5, SF10 and SF11 */
    {"glass-F10", {1.7283f, 1.7283f, 1.7283f}},
    {"glass-F11", {1.7847f, 1.7847f, 1.7847f}},
    {"stdillum-D65", {1.0f, 1.0f, 1.0f}},
};

/* x, y for the 2 degree observer. D65 is our white and stands above. */
static const struct {
    const char *name;
    double x, y;
} ILLUMINANTS[] = {
    {"stdillum-A", 0.44758, 0.40745},   {"stdillum-D50", 0.34567, 0.35851}, {"illum-acesD60", 0.32168, 0.33767},
    {"stdillum-F1", 0.31310, 0.33727},  {"stdillum-F2", 0.37208, 0.37529},  {"stdillum-F3", 0.40910, 0.39430},
    {"stdillum-F4", 0.44018, 0.40329},  {"stdillum-F5", 0.31379, 0.34531},  {"stdillum-F6", 0.37790, 0.38835},
    {"stdillum-F7", 0.31292, 0.32933},  {"stdillum-F8", 0.34588, 0.35875},  {"stdillum-F9", 0.37417, 0.37281},
    {"stdillum-F10", 0.34609, 0.35986}, {"stdillum-F11", 0.38052, 0.37713}, {"stdillum-F12", 0.43695, 0.40441},
};

bool spectra_find_named(const char *name, const working_space *space, rgb *out_value)
{
    for (size_t i = 0; i < sizeof NAMED_SPECTRA / sizeof *NAMED_SPECTRA; i++)
        if (strcmp(NAMED_SPECTRA[i].name, name) == 0) {
            *out_value = NAMED_SPECTRA[i].value;
            return true;
        }
    for (size_t i = 0; i < sizeof ILLUMINANTS / sizeof *ILLUMINANTS; i++)
        if (strcmp(ILLUMINANTS[i].name, name) == 0) {
            *out_value = rgb_of_chromaticity(ILLUMINANTS[i].x, ILLUMINANTS[i].y, space);
            return true;
        }
    return false;
}

bool spectra_is_sensor(const char *name, size_t length)
{
    static const char *const SENSORS[] = {
        "canon_eos_100d",     "canon_eos_1dx_mkii", "canon_eos_200d",    "canon_eos_200d_mkii", "canon_eos_5d",
        "canon_eos_5d_mkii",  "canon_eos_5d_mkiii", "canon_eos_5d_mkiv", "canon_eos_5ds",       "canon_eos_m",
        "hasselblad_l1d_20c", "nikon_d810",         "nikon_d850",        "sony_ilce_6400",      "sony_ilce_7m3",
        "sony_ilce_7rm3",     "sony_ilce_9"};
    for (size_t i = 0; i < sizeof SENSORS / sizeof *SENSORS; i++)
        if (strlen(SENSORS[i]) == length && memcmp(SENSORS[i], name, length) == 0)
            return true;
    return false;
}

bool spectra_is_missing(const char *name)
{
    size_t length = strlen(name);
    return length > 2 && name[length - 2] == '_' && strchr("rgb", name[length - 1]) &&
           spectra_is_sensor(name, length - 2);
}
