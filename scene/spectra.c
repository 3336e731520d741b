/* spectra.c: see spectra.h. The metals' indices are those in public use for rendering in RGB: Ag, Al, Au and Cu are
 * tables of Palik's "Handbook of Optical Constants of Solids" integrated with the CIE curves (as Tungsten and Mitsuba
 * scenes have them); CuZn, MgO and TiO2 are pbrt-v4's tables at 630, 530 and 450 nm. The glasses are the makers' n_d.
 * Threads: any. */
#include "spectra.h"

#include <stddef.h>
#include <string.h>

static double lobe(double x, double height, double mean, double width_below, double width_above)
{
    double t = (x - mean) / (x < mean ? width_below : width_above);
    return height * exp(-0.5 * t * t);
}

/* CIE 1931 matching functions, Wyman et al. 2013, table 1 (multi-lobe fit); wavelength in nm. */
static void match_xyz(double nm, double out_xyz[3])
{
    out_xyz[0] =
        lobe(nm, 1.056, 599.8, 37.9, 31.0) + lobe(nm, 0.362, 442.0, 16.0, 26.7) + lobe(nm, -0.065, 501.1, 20.4, 26.2);
    out_xyz[1] = lobe(nm, 0.821, 568.8, 46.9, 40.5) + lobe(nm, 0.286, 530.9, 16.3, 31.1);
    out_xyz[2] = lobe(nm, 1.217, 437.0, 11.8, 36.0) + lobe(nm, 0.681, 459.0, 26.0, 13.8);
}

rgb spectra_blackbody(double kelvin)
{
    static const double SECOND_RADIATION_CONSTANT = 1.438776877e7; /* h c / k in nm K, CODATA 2018 */
    double xyz[3] = {0.0, 0.0, 0.0};
    for (int nm = 360; nm <= 830; nm++) {
        double match[3], relative = 560.0 / nm; /* relative to 560 nm: only the shape matters */
        double emitted =
            relative * relative * relative * relative * relative *
            (expm1(SECOND_RADIATION_CONSTANT / (560.0 * kelvin)) / expm1(SECOND_RADIATION_CONSTANT / (nm * kelvin)));
        match_xyz(nm, match);
        for (int i = 0; i < 3; i++)
            xyz[i] += emitted * match[i];
    }
    double x = xyz[0] / xyz[1], z = xyz[2] / xyz[1];
    /* IEC 61966-2-1: XYZ to linear RGB with sRGB's primaries */
    double r = 3.2404542 * x - 1.5371385 - 0.4985314 * z;
    double g = -0.9692660 * x + 1.8760108 + 0.0415560 * z;
    double b = 0.0556434 * x - 0.2040259 + 1.0572252 * z;
    return (rgb){(float)fmax(r, 0.0), (float)fmax(g, 0.0), (float)fmax(b, 0.0)};
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

bool spectra_find_named(const char *name, rgb *out_value)
{
    for (size_t i = 0; i < sizeof NAMED_SPECTRA / sizeof *NAMED_SPECTRA; i++)
        if (strcmp(NAMED_SPECTRA[i].name, name) == 0) {
            *out_value = NAMED_SPECTRA[i].value;
            return true;
        }
    return false;
}
