/* direct_guide.h: guides shadow rays to the lights, and to the part of the sky, that bring light to a point, as a pilot
 * has seen there.
 * Rests on: Vevoda, Kondapaneni, Krivanek, "Bayesian Online Regression for Adaptive Direct Illumination Sampling", 2018
 * (shares of lights learned in cells of space, by the root of the mean square); Guo et al., "Primary Sample Space Path
 * Sampling", 2018 (a histogram over the random numbers of an existing sampler).
 * Flow: direct_pilot fills the guide; direct lighting asks it. Threads: read-only once filled.
 *
 * Cells divide the points that the picture sees, by position and by the direction that the surface faces: six
 * directions, and one more kind for surfaces that transmit light. In a cell, each light that reaches everywhere has a
 * share of the samples, and all lamps together have one share, which the light tree distributes among them. A histogram
 * warps the random numbers that sample an infinite light without a portal; within a bin the light's own picture
 * decides. Whatever the pilot has seen, a sample has at least (1 - guided_share) of the density that equal shares and
 * the light's own distribution give it (direct_guide_fill). */
#ifndef AFTERGLOW_DIRECT_GUIDE_H
#define AFTERGLOW_DIRECT_GUIDE_H

#include "scene.h"

enum {
    DIRECT_GUIDE_SIDE = 32,           /* bins of a histogram in width and height */
    DIRECT_GUIDE_ONE = 1 << 16,       /* the number 1, where bins begin */
    DIRECT_GUIDE_SHARES_MAX = 16,     /* of a cell; with more lights that reach everywhere nothing is guided */
    DIRECT_GUIDE_CELL_POINTS = 16,    /* a cell has no more, unless they lie at one place */
    DIRECT_GUIDE_CELL_POINTS_MIN = 4, /* fewer make no cell */
    DIRECT_GUIDE_TREES = 7            /* by the axis nearest to the normal and its sign, and one without a normal */
};
#define DIRECT_GUIDE_NO_CELL UINT32_MAX

/* Over the unit square: where rows begin, and in each row where columns begin, in [0, DIRECT_GUIDE_ONE), strictly
 * ascending from 0. */
typedef struct direct_histogram {
    uint16_t rows[DIRECT_GUIDE_SIDE], columns[DIRECT_GUIDE_SIDE][DIRECT_GUIDE_SIDE];
} direct_histogram;

typedef struct direct_guide_node {
    float at;       /* where it is divided; the next node is the child below, `other` the one above */
    uint32_t axis;  /* 0, 1, 2; 3: a leaf */
    uint32_t other; /* of a leaf: its cell, or DIRECT_GUIDE_NO_CELL */
} direct_guide_node;

/* The points of the list that a cell was made for. */
typedef struct direct_guide_cell {
    uint32_t begin, count;
} direct_guide_cell;

typedef struct direct_guide {
    uint32_t roots[DIRECT_GUIDE_TREES]; /* nodes; DIRECT_GUIDE_NO_CELL: there is no such point */
    direct_guide_node *nodes;           /* owned, as are all arrays that follow */
    uint32_t node_count;
    direct_guide_cell *cells;
    uint32_t cell_count;
    uint32_t
        share_count; /* of a cell: one for each of scene.everywhere_lights, and a last one for all lamps together */
    float *shares;   /* [cell_count][share_count]; those of a cell sum to 1, or are all 0 where it is not guided */
    uint32_t histogram_count;                       /* of a cell */
    uint32_t histogram_of[DIRECT_GUIDE_SHARES_MAX]; /* the histogram of each share; histogram_count: none */
    direct_histogram *histograms;                   /* [cell_count][histogram_count] */
} direct_guide;

/* Returns whether there is anything to guide in a scene: more than one light, or an infinite one, and not too many. */
bool direct_guide_serves(const scene *s);

/* Makes cells for points, and sorts the points by cells: out_order[i] is the index of a point. normals: unit, or zero
 * where light from all sides counts. All shares are 0. Errors: AG_ERROR_MEMORY. */
ag_status direct_guide_create(const scene *s, const vec3 *positions, const vec3 *normals, uint32_t count,
                              uint32_t *out_order, direct_guide *out_guide);
void direct_guide_reset(direct_guide *g);

typedef struct direct_bins {
    float of[DIRECT_GUIDE_SIDE][DIRECT_GUIDE_SIDE]; /* by row and column */
} direct_bins;

/* Fills a cell with what the pilot has seen in it. Where no light was seen, or light whose sum is not finite, the cell
 * stays unguided. brought: [share_count], >= 0, the light that the lights of each share bring; seen: [histogram_count],
 * root mean squares over the bins. guided_share: (0, 0.8], of the samples that follow the guide. */
void direct_guide_fill(direct_guide *g, uint32_t cell, float guided_share, const float *brought,
                       const direct_bins *seen);

/* Returns the cell of a point; DIRECT_GUIDE_NO_CELL where nothing is known. normal: unit, or zero where light from all
 * sides counts. g: may be NULL. */
uint32_t direct_guide_find(const direct_guide *g, vec3 point, vec3 normal);

/* Picks a light as scene_pick_light does, guided by the cell, and gives the probability of a pick as
 * scene_light_probability does. */
uint32_t direct_guide_pick(const direct_guide *g, const scene *s, uint32_t cell, vec3 point, vec3 normal, float u,
                           float *out_probability);
float direct_guide_probability(const direct_guide *g, const scene *s, uint32_t cell, uint32_t light_index, vec3 point,
                               vec3 normal);

/* Warps uniform numbers to those by which the light is sampled in the cell; returns their density. */
float direct_guide_warp(const direct_guide *g, const scene *s, uint32_t cell, uint32_t light_index, vec2 *in_out_u);
/* Returns the density, by direct_guide_warp, of the numbers by which the light's sampling picks a direction. */
float direct_guide_density(const direct_guide *g, const scene *s, uint32_t cell, uint32_t light_index, vec3 direction);

#endif
