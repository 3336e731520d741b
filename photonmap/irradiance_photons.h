/* irradiance_photons.h: the irradiance photons of a map: the fraction of its photons at which irradiance is computed
 * and kept, in a tree of their own, so that the nearest one is looked up among few.
 * Rests on: Christensen, "Faster Photon Map Global Illumination", 1999 (irradiance at a fraction of the photons).
 * Flow: photon_tree -> [here] -> photon_map. Threads: picked, and their tree built, by the run's workers; then
 * read-only, except the slots.
 *
 * The photons are divided into runs of neighbours in the map's order, which lie near each other. One photon of each run
 * becomes an irradiance photon, picked by a hash: a fixed lane of each block would favour the planes by which blocks
 * were split. Irradiance photons are thus as dense as light, more evenly spread than photons that are picked
 * independently, and depend on nothing but the map. Photons of the run that the picked one cannot represent become
 * irradiance photons too, until each photon has one nearby: in the dark, where photons are sparse, and where surfaces
 * curve. */
#ifndef AFTERGLOW_IRRADIANCE_PHOTONS_H
#define AFTERGLOW_IRRADIANCE_PHOTONS_H

#include "photon_tree.h"

/* Returns the number of runs: the fraction, (0, 1], of the photons, but at least one where there are any. */
uint32_t irradiance_photons_runs(uint32_t photon_count, float fraction);

/* Picks the irradiance photons of a tree. They are copies with empty slots, and with the photon's index in place of the
 * flux. Each represents the photons within `reach` whose normals have a cosine above min_cos to its own. The caller
 * owns tree and blocks: photon_tree_reset, and free for the blocks. progress: of AG_PHASE_MAP, which stays as it is
 * meanwhile. Errors: AG_ERROR_MEMORY, AG_CANCELLED. */
ag_status irradiance_photons_create(run_context *run, const photon_tree *photons, float fraction, float reach,
                                    float min_cos, double progress, photon_tree *out_irradiance_photons);

/* Returns the photon of which an irradiance photon is a copy. */
static inline uint32_t irradiance_photons_source(const photon_tree *tree, uint32_t irradiance_photon)
{
    return photon_block_flux(tree->blocks, irradiance_photon);
}

#endif
