/* strong_photons.h: caustic photons that are far stronger than the others are divided into parts that lie around them.
 * A path may gain flux over shading normals many times, or start where the emission guide sends few paths; its photon
 * is then so strong that its disc is seen as a bright ellipse. The parts are no stronger than the photons that bring
 * most of the light, and the light shows as a faint blur. Rests on: Abramson, "On Bandwidth Variation in Kernel
 * Estimates", 1982: each sample has a width of its own. That keeps the sum of what is estimated; larger discs wherever
 * a strong photon is found would not. Flow: photon_tracing, caustic_radius -> [here] -> photon_map of caustics.
 * Threads: one. */
#ifndef AFTERGLOW_STRONG_PHOTONS_H
#define AFTERGLOW_STRONG_PHOTONS_H

#include "photon_tracing.h"

enum { STRONG_PHOTON_RATIO = 4 };

/* Divides each photon that is more than STRONG_PHOTON_RATIO times as strong as the mean flux, weighted by flux, into
 * equal parts of at most that mean. radius: the largest one of the map's estimates, scene units. A photon of
 * STRONG_PHOTON_RATIO times the mean has a disc of that radius; the parts of a stronger one lie evenly, along the
 * surface, on a disc that is larger by as much as the photon is stronger. Where that disc reaches past the edge of the
 * surface, or behind something, parts lie on the opposite side of the photon; those that have no place there either
 * stay together, as one photon, where the photon was. The sum of the flux stays, but for the rounding of each photon's,
 * which is right on average; the set's balance is that of before. At most, the number of photons doubles. The rays cast
 * are added to the set's. Errors: AG_ERROR_MEMORY, AG_CANCELLED; the set is then unchanged. */
ag_status strong_photons_divide(const scene *s, const run_context *run, float radius, photon_set *in_out_set);

#endif
