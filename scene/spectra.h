/* spectra.h: spectra of scene files as linear RGB: black bodies, and the named metals and glasses of pbrt-v4.
 * Rests on: Planck's law; Wyman, Sloan, Shirley, "Simple Analytic Approximations to the CIE XYZ Color Matching
 * Functions", JCGT 2(2), 2013. Flow: parameter_list asks. Threads: any. */
#ifndef AFTERGLOW_SPECTRA_H
#define AFTERGLOW_SPECTRA_H

#include "math/vec3.h"

#define SPECTRA_MIN_KELVIN 500.0
#define SPECTRA_MAX_KELVIN 1e6

/* The colour of a black body in linear RGB with sRGB's primaries, of luminance 1: that is what pbrt makes of a light
 * whose scale is 1. Components outside the gamut become 0. kelvin in [SPECTRA_MIN_KELVIN, SPECTRA_MAX_KELVIN]. */
rgb spectra_blackbody(double kelvin);

/* "metal-Ag-eta", "metal-Ag-k", ... (index of refraction and absorption for red, green and blue), "glass-BK7", ...
 * (index at the d line, three times the same), "stdillum-D65" (white). False where the name is not known. */
bool spectra_find_named(const char *name, rgb *out_value);

#endif
