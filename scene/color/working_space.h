/* working_space.h: the linear RGB that light is carried in: that of the colour config's role, linear Rec. 709 where
 * there is no config. Rests on: OpenColorIO's roles rendering and scene_linear; Gulbrandsen, "Artist Friendly Metallic
 * Fresnel", 2014 (what a metal is in other primaries). White is white in all: a grey of any brightness is the same
 * three numbers, and D65's light is 1 1 1, by the Bradford transform where the space's own white is another. Flow:
 * color -> [here] -> scene; readers make their colours by it, the film its XYZ. Threads: pure functions. */
#ifndef AFTERGLOW_WORKING_SPACE_H
#define AFTERGLOW_WORKING_SPACE_H

#include "color/color_space.h"

typedef struct working_space {
    bool is_rec709;  /* its matrices change nothing, and are not applied */
    bool keeps_gray; /* what is grey in Rec. 709 is the same grey, to the last bit */
    color_matrix from_rec709;
    color_matrix from_xyz, to_xyz; /* XYZ as D65 is white */
    rgb luminance;                 /* of each channel */
    double primaries[3][2], white[2];
} working_space;

working_space working_space_rec709(void);

/* Makes a working space of a matrix from linear Rec. 709, row by row. Near the unit matrix (by 1e-3: configs round) it
 * is Rec. 709. False where it cannot be undone. */
bool working_space_make(const double from_rec709[9], working_space *out_space);

/* NULL for the space stands for Rec. 709 in all that follows. */

/* Converts light and densities (absorption per distance); colours outside the space's gamut are clipped to 0. */
rgb working_space_light(const working_space *space, rgb rec709);
/* A reflectance or transmittance in the working space: clipped to [0, 1] where it was no more than that. */
rgb working_space_reflectance(const working_space *space, rgb rec709);
/* Index and absorption of a metal, whose channels were Rec. 709's: what it reflects, head-on and at the edge, is
 * converted, and the index and absorption that reflect so. Where nothing absorbs that stays so. */
void working_space_metal(const working_space *space, rgb *in_out_eta, rgb *in_out_k);

static inline float working_space_luminance(const working_space *space, rgb c)
{
    return space->luminance.r * c.r + space->luminance.g * c.g + space->luminance.b * c.b;
}

/* Red, green, blue, white, each x and y, as EXR files have them: of spaces with a name the published ones, of others as
 * seen with D65 for white. */
void working_space_chromaticities(const working_space *space, float out_chromaticities[8]);

#endif
