/* incident_guide.h: directions sampled by a histogram of where light comes from (incident_light.h makes them), and
 * their density. Rests on: Jensen, "Importance Driven Path Tracing using the Photon Map", 1995 (directions from a
 * histogram over the square that the cosine's distribution is warped from). Flow: incident_light -> [here] ->
 * final_gather, onward_ways. Threads: pure functions. */
#ifndef AFTERGLOW_INCIDENT_GUIDE_H
#define AFTERGLOW_INCIDENT_GUIDE_H

#include "math/vec3.h"

#include <stdint.h>

enum { INCIDENT_SIDE = 8, INCIDENT_BINS = INCIDENT_SIDE * INCIDENT_SIDE, INCIDENT_ONE = 1 << 16 };

/* The lower bounds of the bins in [0, INCIDENT_ONE), strictly ascending from 0, row by row. They are stored by column
 * and row, so that a column is one vector. */
typedef struct incident_histogram {
    uint16_t begins[INCIDENT_SIDE][INCIDENT_SIDE];
} incident_histogram;

/* A histogram that guides rays from a point, and its frame. */
typedef struct incident_guide {
    frame around; /* z is the normal */
    const incident_histogram *histogram;
} incident_guide;

/* Returns the row or the column of the bins that a number of [0, 1) falls in; of other numbers, the nearest one. */
static inline uint32_t incident_guide_bin(float u)
{
    int i = (int)(u * INCIDENT_SIDE);
    return (uint32_t)(i < 0 ? 0 : i >= INCIDENT_SIDE ? INCIDENT_SIDE - 1 : i);
}

/* Warps up to INCIDENT_WARPS_MAX points of the unit square by the guide's density. out_weights: 1 / that density: the
 * factor of a ray by the new point, mapped by sample_cosine_hemisphere in the guide's frame, relative to a cosine
 * sampled one. The arrays are read and written up to a multiple of eight elements, which must be numbers of [0, 1). */
enum { INCIDENT_WARPS_MAX = 64 };
void incident_guide_warp(const incident_guide *guide, uint32_t count, float in_out_u[2][INCIDENT_WARPS_MAX],
                         float out_weights[INCIDENT_WARPS_MAX]);

/* incident_guide_warp of a single pair of numbers, in plain C, with the same bits. */
float incident_guide_warp_one(const incident_guide *guide, vec2 *in_out_u);

/* Returns the density per solid angle of directions that are warped so and mapped by sample_cosine_hemisphere; 0 below
 * the surface. direction: unit. */
float incident_guide_density(const incident_guide *guide, vec3 direction);

#endif
