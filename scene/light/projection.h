/* projection.h: a picture thrown by a slide projector: intensity by direction within a pyramid around z.
 * Rests on: Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, 12.2.3 (texture projection lights).
 * Flow: pbrt_light_pictures makes it; light and light_emission ask. Threads: read-only once created. */
#ifndef AFTERGLOW_PROJECTION_H
#define AFTERGLOW_PROJECTION_H

#include "math/distribution_2d.h"

/* Constant over each pixel. Directions are unit, in the light's own space: x to the right of the picture, y up. */
typedef struct projection {
    uint32_t width, height;
    rgb *pixels;            /* [height][width], top row first; owned */
    distribution_2d picks;  /* picks pixels in proportion to their flux */
    float reach_x, reach_y; /* half the picture at z = 1 */
    rgb integral;           /* over the pyramid, sr times the pixels' unit */
} projection;

/* Creates a projection. fov_degrees: of the shorter side, in (0, 180). pixels: finite and not negative, from malloc;
 * taken over, on failure too. Errors: AG_ERROR_MEMORY. */
ag_status projection_create(uint32_t width, uint32_t height, rgb *pixels, float fov_degrees,
                            projection **out_projection);
void projection_destroy(projection *p); /* NULL is fine */

/* Returns the pixel in a direction, black outside the pyramid. */
rgb projection_value(const projection *p, vec3 direction);
/* Samples a direction nearly in proportion to the pixels, by u in [0,1)^2. Returns false where they are all black. */
bool projection_sample(const projection *p, vec2 u, vec3 *out_direction, rgb *out_value, float *out_pdf_solid_angle);
/* Finds the numbers, up to rounding, by which projection_sample gives that direction. Returns false where it never
 * does. */
bool projection_sample_numbers(const projection *p, vec3 direction, vec2 *out_u);
/* Returns the cosine between z and the corners. */
float projection_corner_cosine(const projection *p);

#endif
