/* texture_pixels.h: which pixels of a picture have a part in its value at a point, and how large a part.
 * Rests on: Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, 10.4 (image texture).
 * Flow: texture_image, texture_mips -> [here]. Threads: pure functions. */
#ifndef AFTERGLOW_TEXTURE_PIXELS_H
#define AFTERGLOW_TEXTURE_PIXELS_H

#include <stddef.h>
#include <stdint.h>

/* How the picture goes on beyond its edges. */
typedef enum texture_wrap {
    TEXTURE_WRAP_REPEAT,
    TEXTURE_WRAP_BLACK,
    TEXTURE_WRAP_CLAMP,
    TEXTURE_WRAP_OCTAHEDRAL, /* the other half of the same edge: a sphere unfolded onto a square */
    TEXTURE_WRAP_MIRROR      /* repeated, every other time mirrored */
} texture_wrap;

/* Along s and t; an octahedral one is so along both. */
typedef struct texture_wraps {
    texture_wrap s, t;
} texture_wraps;

static inline texture_wraps texture_wraps_same(texture_wrap wrap) { return (texture_wraps){wrap, wrap}; }

typedef enum texture_filter { TEXTURE_FILTER_BILINEAR, TEXTURE_FILTER_POINT } texture_filter;

/* Pixels that have a part in a value; what is missing in the weights is black. */
typedef struct pixel_blend {
    int count;
    size_t pixel[4]; /* y * width + x */
    float weight[4];
} pixel_blend;

/* s to the right, t down, from the top left corner (0, 0) to the bottom right one (1, 1). */
pixel_blend pixel_blend_at(uint32_t width, uint32_t height, texture_wraps wraps, texture_filter filter, float s,
                           float t);

#endif
