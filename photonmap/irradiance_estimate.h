/* irradiance_estimate.h: what the photons around a place say of the light there.
 * Rests on: Jensen, "Realistic Image Synthesis Using Photon Mapping", 2001, ch. 7 (density estimates).
 * Flow: photon_k_nearest, disc_kernels, surface_region -> [here] -> irradiance_cache, caustics.
 * Threads: pure functions, but for the caller's scratch memory. */
#ifndef AFTERGLOW_IRRADIANCE_ESTIMATE_H
#define AFTERGLOW_IRRADIANCE_ESTIMATE_H

#include "photon_map.h"

/* Irradiance [W/m^2] on the side of `normal` (unit), from the k nearest photons: their flux over the area out to the
 * next one, the (k+1)-th; where fewer lie within max_radius, over the area of that disc. Near an edge, of either as far
 * as there is surface. scratch: photon_map_scratch_count(map) of them.
 *
 * Returns whether the estimate holds. It does not where the surface within the disc is too small for the photons that a
 * disc holds: on a strip, a moulding, a leaf. There photons per area is right in the mean only, by values that are
 * nearly always 0 and else a thousand times too large; *out_irradiance is then the whole disc's, which is not of this
 * surface alone but bounded. The answer rests on geometry, and on how dense photons are in all of the scene, never on
 * how many were found: to keep some draws of a count and not others would change the mean. Does not fail, does not
 * allocate. */
bool irradiance_estimate_holds(const photon_map *map, vec3 position, vec3 normal, photon_neighbor *scratch,
                               rgb *out_irradiance);

/* The value alone. */
static inline rgb irradiance_estimate(const photon_map *map, vec3 position, vec3 normal, photon_neighbor *scratch)
{
    rgb irradiance;
    irradiance_estimate_holds(map, position, normal, scratch, &irradiance);
    return irradiance;
}

#endif
