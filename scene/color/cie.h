/* cie.h: the CIE 1931 standard observer and the CIE's daylight: what spectra are seen with and seen under.
 * Rests on: ISO/CIE 11664-1:2019 (the colour matching functions, every 5 nm); CIE 15:2004, 3.1 and table T.2
 * (daylight). Flow: spectra and color_space ask. Threads: pure functions. */
#ifndef AFTERGLOW_CIE_H
#define AFTERGLOW_CIE_H

/* Sums over wavelengths go from the first to the last of these by single nanometres. */
enum { CIE_FIRST_NM = 360, CIE_LAST_NM = 830 };

/* The matching functions at a wavelength, linear between the entries; 0 outside [CIE_FIRST_NM, CIE_LAST_NM]. */
void cie_match(double nm, double out_xyz[3]);

/* The relative power of illuminant D65, 100 at 560 nm; nm in [CIE_FIRST_NM, CIE_LAST_NM]. */
double cie_d65(double nm);

/* The chromaticity x, y of daylight of that colour temperature, in [4000, 25000] K. */
void cie_daylight_chromaticity(double kelvin, double out_xy[2]);

#endif
