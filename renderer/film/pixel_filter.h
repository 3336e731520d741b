/* pixel_filter.h: where in and around a pixel a sample falls, by importance sampling of the reconstruction filter.
 * Rests on: Ernst, Stamminger, Greiner, "Filter Importance Sampling", 2006: a pixel is then made of its own samples
 * alone, summed by one thread in a fixed order. The filters are pbrt-v4's; those with negative lobes are sampled by
 * their magnitude, and samples count with their sign. Threads: read-only once made. */
#ifndef AFTERGLOW_PIXEL_FILTER_H
#define AFTERGLOW_PIXEL_FILTER_H

#include "math/vec3.h"
#include "scene_hints.h"

enum { PIXEL_FILTER_STEPS = 256 };

typedef struct pixel_filter {
    float radius[2];                         /* pixels, x and y; 0: all samples fall on the pixel's centre */
    float cdf[2][PIXEL_FILTER_STEPS + 1];    /* per axis, from -radius to radius */
    signed char sign[2][PIXEL_FILTER_STEPS]; /* 1 or -1 */
    bool has_signs;                          /* some are -1 */
    double mean_sign;                        /* of a sample, (0, 1] */
} pixel_filter;

/* Tabulates the filter. is_centered: no jitter, whatever the filter. Errors: AG_ERROR_SCENE, with a message (nothing is
 * left of it: the Gaussian is too narrow for its table, or negative lobes cancel the rest). */
ag_status pixel_filter_create(const filter_hint *hint, bool is_centered, log_sink *log, pixel_filter *out_filter);

/* Returns an offset from the pixel's centre, in pixels; u in [0,1)^2. *out_sign: 1 or -1. */
vec2 pixel_filter_sample(const pixel_filter *filter, vec2 u, int *out_sign);

/* Sums of the samples of a pixel by their sign. */
typedef struct pixel_sum {
    double positive[3], negative[3];
    uint32_t positive_count, negative_count;
} pixel_sum;

/* Gives the pixel, of one sample or more: the samples with their signs over the sum of the signs, as in pbrt, so that
 * what is even stays even. Where by chance the signs all but cancel out, which would multiply the noise, only the
 * positive samples count. */
void pixel_filter_resolve(const pixel_filter *filter, const pixel_sum *sum, double out_pixel[3]);

#endif
