/* irradiance_estimate.h: the irradiance at a point from the density of the photons around it.
 * Rests on: Jensen, "Realistic Image Synthesis Using Photon Mapping", 2001, ch. 7 (density estimates).
 * Flow: photon_k_nearest, disc_kernels, surface_region -> [here] -> irradiance_cache, caustic_radius, transport.
 * Threads: pure functions, but for the caller's scratch memory. */
#ifndef AFTERGLOW_IRRADIANCE_ESTIMATE_H
#define AFTERGLOW_IRRADIANCE_ESTIMATE_H

#include "photon_found.h"
#include "photon_map.h"

/* The points at which an estimate holds, among those whose nearest photon is the estimate's. */
typedef enum irradiance_extent {
    IRRADIANCE_HOLDS_NOWHERE,
    IRRADIANCE_HOLDS_IN_SIGHT,  /* only points that see the estimate's point: a surface ends nearby, or another one lies
                                   above or below */
    IRRADIANCE_HOLDS_EVERYWHERE /* no surface ends within photon_map_sight_distance */
} irradiance_extent;

/* Writes the irradiance, W/m^2, on the side of the unit normal, from the k nearest photons: their flux over the area
 * out to the next one, the (k+1)-th; where fewer lie within max_radius, over the area of that disc. Near an edge both
 * are restricted to the surface; beside brighter light, to the disc that ends before it. scratch:
 * photon_map_scratch_count(map) neighbours. The rays that it casts to find where surfaces end are added to
 * *in_out_rays. Does not fail, does not allocate.
 *
 * Returns where the estimate holds. It holds nowhere if the surface within the disc is too small for the photons that a
 * disc holds, as on a strip, a moulding or a leaf: photons per area are right there only on average, by values that are
 * nearly always 0 and otherwise a thousand times too large. *out_irradiance is then that of the whole disc, which
 * includes other surfaces but is bounded. It holds nowhere either if most of the photons found lie on surfaces above
 * or below that the point does not see, whose density has then set the radius. The decision depends on geometry, on the
 * density of photons in the whole scene and on the photons of other surfaces, never on the number of photons found on
 * this surface: to accept some outcomes of a random count and not others would bias the mean. */
irradiance_extent irradiance_estimate_find(const photon_map *map, vec3 position, vec3 normal, photon_neighbor *scratch,
                                           uint64_t *in_out_rays, rgb *out_irradiance);

/* irradiance_estimate_find, which also writes its reach: *out_reach_squared (NULL: not wanted) is the squared radius
 * out to the (k+1)-th photon, or of the largest disc. The bits of extent and irradiance depend neither on photons
 * farther away, nor on photons that face the other way, nor on geometry beyond IRRADIANCE_REACH_OF_RAYS times that
 * radius. A reach of 0 promises nothing of this: the k-th and the next photon are equally far, or the disc was the
 * smallest one. in_out_hint may be NULL. */
irradiance_extent irradiance_estimate_find_reach(const photon_map *map, vec3 position, vec3 normal,
                                                 photon_neighbor *scratch, photon_search_hint *in_out_hint,
                                                 uint64_t *in_out_rays, rgb *out_irradiance, float *out_reach_squared);

/* Returns the word that an irradiance photon's slot keeps of the estimate at it: a final one (irradiance_slot.h). */
uint32_t irradiance_estimate_word(const photon_map *map, uint32_t irradiance_photon, irradiance_extent extent,
                                  rgb irradiance);

/* Returns the irradiance where it is seen directly, so that another estimate cannot take its place: on a surface too
 * small to hold one, the flux of its own photons over its area, m^2, along the surface as it bends, or over least_area
 * (> 0) where that is larger. The mean is then right on flat and round surfaces that are not smaller than that; rods
 * thinner than a fortieth of the disc's radius have up to a fifth too little. No photon counts for more than its flux
 * over least_area. */
rgb irradiance_estimate_seen(const photon_map *map, vec3 position, vec3 normal, double least_area,
                             photon_neighbor *scratch, uint64_t *in_out_rays);

/* All rays of an estimate end within 1.2 times its radius; the rest is for rounding. */
#define IRRADIANCE_REACH_OF_RAYS 1.5f

/* Returns the irradiance alone, and counts no rays. */
static inline rgb irradiance_estimate(const photon_map *map, vec3 position, vec3 normal, photon_neighbor *scratch)
{
    rgb irradiance;
    uint64_t rays = 0;
    irradiance_estimate_find(map, position, normal, scratch, &rays, &irradiance);
    return irradiance;
}

#endif
