/* caustic_radius.h: how far an estimate of caustics reaches where few of their photons lie.
 * A caustic's photons crowd, and each carries little where many paths were traced for them. Where they are sparse, k of
 * them lie metres apart, and a disc as large carries their light to where it is not, and out of sight. So the largest
 * disc is the one on which k photons are as bright as the dim parts of the scene: chance among fewer photons on it does
 * not show beside the light that is there.
 * Rests on: Jensen, "Realistic Image Synthesis Using Photon Mapping", 2001, 7.2 (bias and noise of the disc's size).
 * Flow: photon_map of all light, photons of caustics -> [here] -> photon_map of caustics. Threads: pure. */
#ifndef AFTERGLOW_CAUSTIC_RADIUS_H
#define AFTERGLOW_CAUSTIC_RADIUS_H

#include "photon_map.h"

/* The largest radius [scene units] of caustic estimates: no larger than the global map's, and just that where either
 * has no photon or the dim parts are black; 0 where the global map has none. Errors: AG_ERROR_MEMORY. */
ag_status caustic_radius_find(const photon_map *global, const photon_set *caustic, float *out_radius);

#endif
