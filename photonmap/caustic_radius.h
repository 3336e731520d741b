/* caustic_radius.h: the largest radius of caustic estimates. Caustic photons are dense within caustics, and each has
 * little flux. Between caustics they are metres apart, and a disc of k photons would carry their light to points that
 * it does not reach. The largest disc is therefore one on which k photons, each of the mean flux weighted by flux, are
 * half as bright as the dim parts of the scene: the variance of fewer photons does not show beside the other light.
 * Rests on: Jensen, "Realistic Image Synthesis Using Photon Mapping", 2001, 7.2 (bias and noise of the disc's size).
 * Flow: photon_map of all light, photons of caustics -> [here] -> photon_map of caustics. Threads: pure. */
#ifndef AFTERGLOW_CAUSTIC_RADIUS_H
#define AFTERGLOW_CAUSTIC_RADIUS_H

#include "photon_map.h"

/* Writes the largest radius of caustic estimates, scene units. It is at most the global map's radius, and equal to it
 * where either map is empty or the dim parts are black; 0 where the global map has none. Errors: AG_ERROR_MEMORY. */
ag_status caustic_radius_find(const photon_map *global, const photon_set *caustic, float *out_radius);

/* Returns the mean of the photons' flux, each of the largest channel and weighted by itself, as it is stored: the
 * strongest photons bring most of the light, and make the spots. 0 where there is none. */
double caustic_flux_each(const photon_set *caustic);

/* Returns the least area, m^2, on which the photons of an estimate of that map count. Where the map's largest radius is
 * that of caustic_radius_find, and no other bound's, a photon of the mean flux, weighted by flux, that the map's
 * photons had when that radius was found is as bright there as the dim parts of the scene. */
double caustic_least_area(const photon_map *caustic);

#endif
