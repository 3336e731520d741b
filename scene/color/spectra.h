/* spectra.h: spectra of scene files as linear RGB of the working space: given by their values, black bodies, and those
 * that pbrt-v4 has names for. Rests on: Planck's law; CIE 15:2004 (colour of lights and of what reflects them). How
 * much a spectrum of light is, and what it is outside its wavelengths, is as in pbrt-v4. Flow: parameter_list and
 * pbrt_spectra ask. Threads: any. */
#ifndef AFTERGLOW_SPECTRA_H
#define AFTERGLOW_SPECTRA_H

#include "color/working_space.h"

#include <stddef.h>

#define SPECTRA_MIN_KELVIN 500.0
#define SPECTRA_MAX_KELVIN 1e6

/* The quantity that a spectrum's values are of. */
typedef enum spectrum_use {
    SPECTRUM_LIGHT, /* emitted: the colour as it is seen, of luminance 1, as pbrt makes of a light whose scale is 1;
                     * so its values matter by their proportions alone. 0 outside its wavelengths */
    SPECTRUM_REFLECTANCE, /* a share of the light: its colour under D65, so that a constant becomes that grey */
    SPECTRUM_INDEX, /* of refraction and absorption in metals: for each channel of Rec. 709, whatever the working space,
                     * the mean over the wavelengths that it is most sensitive to, within the range of the values */
    SPECTRUM_DENSITY /* absorbed, scattered per distance: as an index, but converted to the working space */
} spectrum_use;

/* space NULL: Rec. 709, here and below.
 * pairs: wavelength in nm, increasing, and value, not negative; linear between them. What reflects or refracts goes on
 * with its first and last value. Components outside the gamut become 0, those of a reflectance at most 1. */
rgb spectra_sampled(const double *pairs, size_t pair_count, spectrum_use use, const working_space *space);

/* The colour of a black body, of luminance 1. Components outside the gamut become
 * 0. kelvin in [SPECTRA_MIN_KELVIN, SPECTRA_MAX_KELVIN]. */
rgb spectra_blackbody(double kelvin, const working_space *space);
/* Luminance of a black body whose greatest spectral value is 1, relative to light that is 1 at all wavelengths; and its
 * chromaticity. */
double spectra_blackbody_luminance(double kelvin);
void spectra_blackbody_chromaticity(double kelvin, double out_xy[2]);

/* "metal-Ag-eta", "metal-Ag-k", ... (index of refraction and absorption for red, green and blue), "glass-BK7", ...
 * (index at the d line, three times the same; indices are Rec. 709's), "stdillum-A", ... (colour, of luminance 1).
 * False where there is none. */
bool spectra_find_named(const char *name, const working_space *space, rgb *out_value);

/* Whether pbrt-v4 has a spectrum of that name, and we have not: the sensitivities of cameras. */
bool spectra_is_missing(const char *name);
/* Whether pbrt-v4 has a sensor of that name, "cie1931" not among them. */
bool spectra_is_sensor(const char *name, size_t length);

#endif
