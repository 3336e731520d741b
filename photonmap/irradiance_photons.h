/* irradiance_photons.h: the irradiance photons of a map, which are the photons that irradiance is computed and kept at,
 * where those are not all: a tree of their own, so that the nearest one is looked for among few.
 * Rests on: Christensen, "Faster Photon Map Global Illumination", 1999 (irradiance at a fraction of the photons).
 * Flow: photon_tree -> [here] -> photon_map. Threads: picked, and their tree built, by the run's workers; then
 * read-only, but for the slots.
 *
 * The photons are parted into runs that follow each other in the map's order, and so lie together. Of each run one
 * photon becomes an irradiance photon, picked by a hash: a lane of its own in each block would favour the planes that
 * blocks were parted by. So irradiance photons are as dense as light is, more evenly spread than photons picked one by
 * one, and depend on nothing but the map. Photons of the run that the picked one cannot stand for become irradiance
 * photons too, until one is near each photon: in the dark, where photons lie far apart, and where surfaces turn. */
#ifndef AFTERGLOW_IRRADIANCE_PHOTONS_H
#define AFTERGLOW_IRRADIANCE_PHOTONS_H

#include "photon_tree.h"

/* The number of runs that the photons are parted into: the fraction (0, 1] of them, but one at least where there are
 * any. */
uint32_t irradiance_photons_runs(uint32_t photon_count, float fraction);

/* Picks the irradiance photons of a tree of photons: copies, with empty slots, and the photon's index instead of
 * the flux. One stands for the photons that are no farther away than reach and have a normal whose cosine to its own is
 * above min_cos. Tree and blocks are the caller's: photon_tree_reset, and free of the blocks. Errors: AG_ERROR_MEMORY,
 * AG_CANCELLED. */
ag_status irradiance_photons_create(run_context *run, const photon_tree *photons, float fraction, float reach,
                                    float min_cos, double progress, photon_tree *out_irradiance_photons);

/* The photon that an irradiance photon was copied from. */
static inline uint32_t irradiance_photons_source(const photon_tree *tree, uint32_t irradiance_photon)
{
    return photon_block_flux(tree->blocks, irradiance_photon);
}

#endif
