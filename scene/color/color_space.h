/* color_space.h: from the RGB of other primaries and whites to ours, linear Rec. 709.
 * Rests on: ITU-R BT.709-6, BT.2020-2; SMPTE EG 432-1 (P3 with D65 white, as pbrt-v4 means "dci-p3"); SMPTE ST 2065-1;
 * the Academy's S-2014-004 (ACEScg);
 * SMPTE RP 177 (matrices from primaries); Lam, "Metamerism and Colour Constancy", 1985 (the Bradford transform).
 * Flow: pbrt_spectra, spectra and the renderer's film ask. Threads: pure functions. */
#ifndef AFTERGLOW_COLOR_SPACE_H
#define AFTERGLOW_COLOR_SPACE_H

#include "math/vec3.h"

typedef enum color_space {
    COLOR_SPACE_SRGB, /* its primaries; values are linear */
    COLOR_SPACE_DCI_P3,
    COLOR_SPACE_REC2020,
    COLOR_SPACE_ACES2065_1,
    COLOR_SPACE_ACESCG, /* not pbrt's */
    COLOR_SPACE_COUNT
} color_space;

typedef struct color_matrix {
    double m[3][3]; /* row, column */
} color_matrix;

/* Finds a space by pbrt's names: "srgb", "dci-p3", "rec2020", "aces2065-1", in any case; and "acescg". */
bool color_space_find(const char *name, color_space *out_space);
/* x and y of red, green, blue, and of white. */
void color_space_chromaticities(color_space space, double out_primaries[3][2], double out_white[2]);

/* To linear Rec. 709. Of light the colour is kept, and white becomes the white of the space; of what reflects or
 * refracts the white is kept, by the Bradford transform: 1 1 1 reflects all light in every space. */
color_matrix color_space_to_rec709(color_space from, bool is_light);

/* The matrix to Rec. 709, for reflectances, from any chromaticities, as EXR files have them (red, green, blue, white,
 * each x and y). False where they are no primaries. */
bool color_chromaticities_to_rec709(const float chromaticities[8], color_matrix *out_matrix);

color_matrix color_xyz_from_rec709(void);
color_matrix color_rec709_from_xyz(void);

/* The Bradford transform in XYZ that takes one chromaticity to the other, and bends all others along. */
color_matrix color_adaptation(const double from_xy[2], const double to_xy[2]);
/* The chromaticity of our white, D65. */
extern const double COLOR_WHITE_XY[2];

color_matrix color_matrix_multiply(const color_matrix *a, const color_matrix *b);  /* applies b first */
bool color_matrix_invert(const color_matrix *a, color_matrix *out_inverse);        /* false: it cannot be undone */
void color_matrix_apply(const color_matrix *a, const double in[3], double out[3]); /* in and out may be the same */

#endif
