/* irradiance_bearers.h: the photons of a map that bear irradiance, where that is not all of them: a tree of their own,
 * so that the nearest is looked for among few.
 * Rests on: Christensen, "Faster Photon Map Global Illumination", 1999 (irradiance at a fraction of the photons).
 * Flow: photon_tree -> [here] -> photon_map. Threads: picked, and their tree built, by the run's workers; then
 * read-only, but for the slots.
 *
 * Of every so many photons that follow each other in the map's order, and so lie together, one bears, picked by a hash:
 * a lane of its own in each block would favour the planes that blocks were parted by. So bearers are as dense as light
 * is, more evenly spread than photons picked one by one, and depend on nothing but the map. Of those of the run that
 * the picked one cannot stand for some bear too, until one is near each photon: in the dark, where photons lie far
 * apart, and where surfaces turn. */
#ifndef AFTERGLOW_IRRADIANCE_BEARERS_H
#define AFTERGLOW_IRRADIANCE_BEARERS_H

#include "photon_tree.h"

/* How many runs the photons are parted into: the fraction (0, 1] of them, but one at least where there are any. */
uint32_t irradiance_bearers_runs(uint32_t photon_count, float fraction);

/* The bearers of a tree of photons: copies, with slots that are empty, and the photon's number where the flux was. One
 * stands for what is no farther away than reach and has a normal whose cosine to its own is above min_cos. Tree and
 * blocks are the caller's: photon_tree_reset, and free of the blocks. Errors: AG_ERROR_MEMORY, AG_CANCELLED. */
ag_status irradiance_bearers_create(run_context *run, const photon_tree *photons, float fraction, float reach,
                                    float min_cos, double progress, photon_tree *out_bearers);

/* The photon that a bearer was copied from. */
static inline uint32_t irradiance_bearers_photon(const photon_tree *bearers, uint32_t bearer)
{
    return photon_block_flux(bearers->blocks, bearer);
}

#endif
