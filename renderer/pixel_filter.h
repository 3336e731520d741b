/* pixel_filter.h: where in and around a pixel a sample falls, by importance sampling of the reconstruction filter.
 * Rests on: Ernst, Stamminger, Greiner, "Filter Importance Sampling", 2006: a pixel is then the plain mean of its own samples,
 * summed by one thread in a fixed order. The filters are pbrt-v4's.
 * Threads: read-only once made. */
#ifndef AFTERGLOW_PIXEL_FILTER_H
#define AFTERGLOW_PIXEL_FILTER_H

#include "math/vec3.h"
#include "parameter_list.h"

enum { PIXEL_FILTER_STEPS = 256 };

typedef struct pixel_filter {
    float radius[2];                        /* pixels, x and y */
    float cdf[2][PIXEL_FILTER_STEPS + 1];   /* per axis, from -radius to radius */
} pixel_filter;

/* From the PixelFilter directive (box, triangle, gaussian; .name NULL: pbrt-v4's default, gaussian). Others are named in
 * a warning, and the default stands in. Errors: AG_ERROR_SCENE. */
ag_status pixel_filter_create(parameter_list *directive, log_sink *log, pixel_filter *out_filter);

/* Offset from the pixel's centre, in pixels; u in [0,1)^2. */
vec2 pixel_filter_sample(const pixel_filter *filter, vec2 u);

#endif
