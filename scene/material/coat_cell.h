/* coat_cell.h: totals of walks between coat and base, by the cosine outside, for one roughness of the interface and one
 * of the base.
 * Flow: coat_walk -> [here] -> coat_table. Threads: made by one, then read-only. */
#ifndef AFTERGLOW_COAT_CELL_H
#define AFTERGLOW_COAT_CELL_H

#include "material/coat_walk.h"
#include "material/material.h"

enum {
    COAT_COSINES = 16, /* cosines (k / 15)^2 */
    COAT_ORDERS = 8    /* reflections by the metal that are told apart; of the last, and more */
};

/* The tables of one roughness of the interface and one of the metal. */
typedef struct coat_cell {
    /* For a diffuse base: the share of light from outside that reaches it; and the share of light leaving it that
     * returns. */
    float entry[COAT_COSINES];
    rgb entry_tint; /* the square of the factor of `entry` by a gap with coloured scattering */
    rgb back;

    /* For a metal: the lobe of light that no facet reflected totally. */
    float breadth;                 /* its roughness over what coat_lobe_facets computes */
    float scale[COAT_COSINES];     /* its factor, at either end */
    float albedo[COAT_COSINES];    /* for a metal of reflectance 1 */
    float lobe_share[COAT_ORDERS]; /* of its albedo, by the number of reflections */

    /* For both: light that leaves at any angle, a product. On a metal, light that was reflected totally or scattered;
     * on a diffuse base, light that the gap scatters back before it arrives. */
    float scattered[COAT_COSINES]; /* its albedo for a metal of reflectance 1, mean of the channels */
    float forward[COAT_COSINES];   /* of that light: how much it keeps of the way it went along the surface, [0, 1) */
    float scattered_mean;          /* over the hemisphere; 0: there is none */
    rgb scattered_share[COAT_ORDERS]; /* of its albedo, by the number of reflections, each channel */
} coat_cell;

/* Fills a cell of zeros by walk_count walks for each cosine, where the base is a metal; key: of their random numbers.
 * The material's roughnesses are those of the cell. Returns false when out of memory. */
bool coat_cell_fill(coat_cell *out_cell, const material *m, int metal_walks, uint64_t key);

/* Returns the cosine of a number, > 0. */
static inline float coat_cosine(int number)
{
    float root = (float)number / (float)(COAT_COSINES - 1);
    return float_max(root * root, 1e-3f);
}

static inline vec3 coat_direction(float cosine)
{
    return (vec3){sqrtf(float_max(1.0f - cosine * cosine, 0.0f)), 0.0f, cosine};
}

static inline float coat_interpolate(const float values[COAT_COSINES], float cosine)
{
    float along = sqrtf(float_clamp(cosine, 0.0f, 1.0f)) * (float)(COAT_COSINES - 1);
    int step = along < (float)(COAT_COSINES - 2) ? (int)along : COAT_COSINES - 2;
    float u = along - (float)step;
    return (1.0f - u) * values[step] + u * values[step + 1];
}

#endif
