/* direct_guide.h: which lights, and which part of the sky, bring light to a point, as a pilot has seen it: to send
 * shadow rays there.
 * Rests on: Vevoda, Kondapaneni, Krivanek, "Bayesian Online Regression for Adaptive Direct Illumination Sampling", 2018
 * (shares of lights learned in cells of space, by the root of the mean square); Guo et al., "Primary Sample Space Path
 * Sampling", 2018 (a histogram over the random numbers of a sampler that is there).
 * Flow: direct_pilot fills it; direct lighting asks it. Threads: read-only once filled.
 *
 * Cells part the points that the picture sees, and the ways that surfaces face: six, and surfaces that light passes. In
 * a cell each light that is everywhere has a share of the samples, and all lamps have one, which the light tree deals
 * out. The numbers by which an infinite light without a portal is sampled are warped by a histogram, so that its own
 * picture still decides within a bin. Wherever and whatever the pilot has seen, a sample has at least (1 - share) of
 * the density that equal shares and the light's own distribution give it. */
#ifndef AFTERGLOW_DIRECT_GUIDE_H
#define AFTERGLOW_DIRECT_GUIDE_H

#include "scene.h"

enum {
    DIRECT_GUIDE_SIDE = 32,
    DIRECT_GUIDE_ONE = 1 << 16,
    DIRECT_GUIDE_SHARES_MAX = 16, /* with more lights that are everywhere, nothing is guided */
    DIRECT_GUIDE_CELL_POINTS = 16,
    DIRECT_GUIDE_CELL_POINTS_MIN = 4
};
#define DIRECT_GUIDE_NO_CELL UINT32_MAX

/* Over the unit square: where rows begin, and in each row where columns begin, in [0, DIRECT_GUIDE_ONE), strictly
 * ascending from 0. */
typedef struct direct_histogram {
    uint16_t rows[DIRECT_GUIDE_SIDE], columns[DIRECT_GUIDE_SIDE][DIRECT_GUIDE_SIDE];
} direct_histogram;

typedef struct direct_guide_node {
    float at;       /* where it is divided; children: the next node, below, and `other` */
    uint32_t axis;  /* 0, 1, 2; 3: a leaf */
    uint32_t other; /* of a leaf: its cell, or DIRECT_GUIDE_NO_CELL */
} direct_guide_node;

/* The points of the list that a cell was made for. */
typedef struct direct_guide_cell {
    uint32_t begin, count;
} direct_guide_cell;

enum { DIRECT_GUIDE_WAYS = 7 };

typedef struct direct_guide {
    uint32_t roots[DIRECT_GUIDE_WAYS]; /* nodes, DIRECT_GUIDE_NO_CELL: no such point */
    direct_guide_node *nodes;          /* owned, as are all arrays that follow */
    uint32_t node_count;
    direct_guide_cell *cells;
    uint32_t cell_count;
    uint32_t share_count; /* of a cell: one for each of scene.everywhere_lights, and one more, the last, for all lamps
                             there are */
    float *shares;        /* [cell_count][share_count], that sum to 1, or all 0: a cell that is not guided */
    uint32_t histogram_count;                       /* of a cell */
    uint32_t histogram_of[DIRECT_GUIDE_SHARES_MAX]; /* of a share and of all lamps; histogram_count: it has none */
    direct_histogram *histograms;                   /* [cell_count][histogram_count] */
} direct_guide;

/* Whether there is anything to guide in a scene: more than one light, or an infinite one, and not too many. */
bool direct_guide_serves(const scene *s);

/* Makes cells for points, which it puts in the cells' order: order[i] is the index of the point. normals: unit, or zero
 * where light from all sides counts. All shares are 0. Errors: AG_ERROR_MEMORY. */
ag_status direct_guide_create(const scene *s, const vec3 *positions, const vec3 *normals, uint32_t count,
                              uint32_t *out_order, direct_guide *out_guide);
void direct_guide_reset(direct_guide *g);

typedef struct direct_bins {
    float of[DIRECT_GUIDE_SIDE][DIRECT_GUIDE_SIDE]; /* by row and column */
} direct_bins;

/* Tells a cell what was seen in it; where nothing was, or light whose sum is not finite, it stays unguided. brought:
 * [share_count], not negative, what the shares' lights bring there; seen: [histogram_count], root mean squares over the
 * bins. share: (0, 1), of the samples that follow it. */
void direct_guide_fill(direct_guide *g, uint32_t cell, float share, const float *brought, const direct_bins *seen);

/* The cell of a point, DIRECT_GUIDE_NO_CELL where nothing is known of it. normal: unit, or zero where
 * light from all sides counts. g: may be NULL. */
uint32_t direct_guide_find(const direct_guide *g, vec3 point, vec3 normal);

/* Picks a light as scene_pick_light does, guided by the cell, and gives the probability of a pick as
 * scene_light_probability does. */
uint32_t direct_guide_pick(const direct_guide *g, const scene *s, uint32_t cell, vec3 point, vec3 normal, float u,
                           float *out_probability);
float direct_guide_probability(const direct_guide *g, const scene *s, uint32_t cell, uint32_t light_index, vec3 point,
                               vec3 normal);

/* Turns evenly distributed numbers into those that the light is sampled with there; returns their density. */
float direct_guide_warp(const direct_guide *g, const scene *s, uint32_t cell, uint32_t light_index, vec2 *in_out_u);
/* The density, by direct_guide_warp, of the numbers that make the light's sampling pick a direction. */
float direct_guide_density(const direct_guide *g, const scene *s, uint32_t cell, uint32_t light_index, vec3 direction);

#endif
