/* incident_light.h: from where light comes, as the photons around a point tell: to send gather rays there.
 * Rests on: Jensen, "Importance Driven Path Tracing using the Photon Map", 1995 (directions from a histogram of photons
 * over the square that the cosine's distribution is warped from); Guo et al., "Primary Sample Space Path Sampling",
 * 2018 (that square as the domain of guiding); Veach, Guibas, "Optimally Combining Sampling Techniques", 1995.
 * Flow: photon_map -> [here] -> final_gather; importons -> [here] -> photon_path. Threads: built by one caller on the
 * run's workers; then read-only.
 *
 * A cell is a run of neighbours in the map's order: all of a subtree. In each, photons are parted by the axis that
 * their normal is nearest to, six ways; whatever else mixes there only costs some of the gain. Each part is a histogram
 * over the unit square that sample_cosine_hemisphere warps to directions: flux already holds the cosine, so that light
 * from everywhere alike fills it evenly, and nothing lies below the horizon. A share of each bin is even, whatever the
 * photons say: what is drawn is the mixture of the two, the density is the mixture's (the balance heuristic), and no
 * ray weighs more than 1 / that share. Light straight from lamps is left out: gather rays do not bring it. */
#ifndef AFTERGLOW_INCIDENT_LIGHT_H
#define AFTERGLOW_INCIDENT_LIGHT_H

#include "photon_tree.h"

enum { INCIDENT_SIDE = 8, INCIDENT_BINS = INCIDENT_SIDE * INCIDENT_SIDE, INCIDENT_ONE = 1 << 16 };

/* A cell has so many blocks of photons, and so many photons at most. */
enum { INCIDENT_CELL_BLOCKS_LOG2 = 5, INCIDENT_CELL_MAX = PHOTON_BLOCK_LANES << INCIDENT_CELL_BLOCKS_LOG2 };

/* The beginnings of the bins in [0, INCIDENT_ONE), strictly ascending from 0, row by row. They are stored by column and
 * row, so that a column is what a vector holds. */
typedef struct incident_histogram {
    uint16_t begins[INCIDENT_SIDE][INCIDENT_SIDE];
} incident_histogram;

typedef struct incident_light {
    photon_tree tree;               /* borrowed; empty: no point is guided */
    uint32_t cell_depth;            /* cells are the nodes so deep in it */
    uint32_t *cells;                /* owned: of each the first histogram << 6, and as bits which ways there are */
    incident_histogram *histograms; /* owned */
    uint32_t histogram_count;
} incident_light;

/* Makes the guides of a tree's photons, which must not move before it is reset. share, [0, 1]: how much photons decide
 * where they are many; 0 makes none. Errors: AG_ERROR_MEMORY, AG_CANCELLED. */
ag_status incident_light_create(run_context *run, const photon_tree *tree, float share, incident_light *out_light);
void incident_light_reset(incident_light *l);
uint64_t incident_light_bytes(const incident_light *l);

/* Tells of each histogram which photons it is of, by their indices in the tree: the histogram's own index is that of
 * what a caller may keep beside it. fn: called by the run's workers, of each histogram once. Errors: AG_CANCELLED. */
typedef void incident_photons_fn(void *user, uint32_t histogram, const uint32_t *photons, uint32_t count);
ag_status incident_light_visit(run_context *run, const incident_light *l, incident_photons_fn *fn, void *user);

/* The histogram that guides rays from a point, and its frame. */
typedef struct incident_guide {
    frame around; /* z: the normal */
    const incident_histogram *histogram;
} incident_guide;

/* Whether the photons there tell anything. normal: unit, on the side that the light arrives at. */
bool incident_light_find(const incident_light *l, vec3 position, vec3 normal, incident_guide *out_guide);

/* Warps points of the unit square, up to INCIDENT_WARPS_MAX, to ones by the guide's density. out_weights: 1 / that
 * density: what a ray by the new point, warped on by sample_cosine_hemisphere in the guide's frame, weighs more than
 * one by the cosine alone. All of the columns up to a multiple of eight is overwritten, and must be numbers of
 * [0, 1). */
enum { INCIDENT_WARPS_MAX = 64 };
void incident_guide_warp(const incident_guide *guide, uint32_t count, float in_out_u[2][INCIDENT_WARPS_MAX],
                         float out_weights[INCIDENT_WARPS_MAX]);

/* incident_guide_warp of a single pair of numbers, in plain C, with the same bits. */
float incident_guide_warp_one(const incident_guide *guide, vec2 *in_out_u);

/* The density, per solid angle, of directions that are warped so, and on by sample_cosine_hemisphere; 0 below the
 * surface. direction: unit. */
float incident_guide_density(const incident_guide *guide, vec3 direction);

#endif
