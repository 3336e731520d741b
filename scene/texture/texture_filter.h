/* texture_filter.h: a picture's mean over the footprint of a ray, an ellipse: probes along its longer axis, each
 * between the two levels whose pixels are about as large as the ellipse is wide. So what is seen at grazing angles is
 * not blurred across, and what is seen larger than its pixels is looked up as if nothing were filtered, with the same
 * bits. Rests on: McCormack et al., "Feline: Fast Elliptical Lines for Anisotropic Texture Mapping", SIGGRAPH 1999.
 * Flow: texture -> [here] -> texture_mips. Threads: pure functions. */
#ifndef AFTERGLOW_TEXTURE_FILTER_H
#define AFTERGLOW_TEXTURE_FILTER_H

#include "texture/texture_image.h"

typedef struct texture_footprint {
    vec2 axes[2];   /* conjugate diameters, as steps of s and t (whose directions are those of texture_image.h) */
    bool is_coarse; /* a gather ray's or a photon's: one probe, at no coarser a level than one of 256 pixels */
} texture_footprint;

/* texture_image_color and texture_image_rgb over the footprint, of a picture that has mips. */
rgb texture_filter_color(const texture_image *i, texture_wraps wraps, texture_filter filter, float s, float t,
                         const texture_footprint *footprint);
rgb texture_filter_rgb(const texture_image *i, texture_wraps wraps, texture_filter filter, float s, float t,
                       const texture_footprint *footprint);

#endif
