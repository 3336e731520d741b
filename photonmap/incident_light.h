/* incident_light.h: the directions from which light comes to a point, as the photons around it tell. They guide gather
 * rays and photon paths.
 * Rests on: Jensen, "Importance Driven Path Tracing using the Photon Map", 1995 (directions from a histogram of photons
 * over the square that the cosine's distribution is warped from); Guo et al., "Primary Sample Space Path Sampling",
 * 2018 (that square as the domain of guiding); Veach, Guibas, "Optimally Combining Sampling Techniques", 1995.
 * Flow: photon_map -> [here] -> final_gather; importons -> [here] -> photon_path. Threads: built by one caller on the
 * run's workers; then read-only.
 *
 * A cell is a run of neighbours in the map's order: the photons of a subtree. They are divided by the axis nearest to
 * their normal, and its side; other differences within a cell only cost some of the gain. Each of the six has a
 * histogram over the unit square that sample_cosine_hemisphere warps to directions. Flux already contains the cosine,
 * so light from all directions alike fills the histogram evenly, and no bin lies below the horizon. A share of each bin
 * is uniform, whatever the photons say. Directions are drawn from this mixture and weighted by its density (the balance
 * heuristic), so no ray weighs more than 1 / that share. Photons straight from lamps are left out, since gather rays do
 * not bring their light. */
#ifndef AFTERGLOW_INCIDENT_LIGHT_H
#define AFTERGLOW_INCIDENT_LIGHT_H

#include "incident_guide.h"
#include "photon_tree.h"

/* The number of blocks of photons in a cell, log2, and the most photons of one. */
enum { INCIDENT_CELL_BLOCKS_LOG2 = 5, INCIDENT_CELL_MAX = PHOTON_BLOCK_LANES << INCIDENT_CELL_BLOCKS_LOG2 };

typedef struct incident_light {
    photon_tree tree;    /* borrowed; empty: nothing is guided */
    uint32_t cell_depth; /* depth of the nodes that are cells */
    /* Owned; of each cell the index of its first histogram << 6, and a bit for each of the six faces of a cube that it
     * has a histogram of. */
    uint32_t *cells;
    incident_histogram *histograms; /* owned */
    uint32_t histogram_count;
} incident_light;

/* Builds the guides from a tree's photons, which must not move until it is reset. share, [0, 1]: the largest weight of
 * the photons in the mixture; 0: no guides. Errors: AG_ERROR_MEMORY, AG_CANCELLED. */
ag_status incident_light_create(run_context *run, const photon_tree *tree, float share, incident_light *out_light);
void incident_light_reset(incident_light *l);
uint64_t incident_light_bytes(const incident_light *l);

/* Calls fn once for each histogram, on the run's workers, with the indices of its photons in the tree. histogram: its
 * index, by which callers may keep data of their own. Errors: AG_CANCELLED. */
typedef void incident_photons_fn(void *user, uint32_t histogram, const uint32_t *photons, uint32_t count);
ag_status incident_light_visit(run_context *run, const incident_light *l, incident_photons_fn *fn, void *user);

/* Finds the guide at a point; false where there is none. normal: unit, on the side of the incident light. */
bool incident_light_find(const incident_light *l, vec3 position, vec3 normal, incident_guide *out_guide);

#endif
