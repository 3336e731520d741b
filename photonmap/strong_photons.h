/* strong_photons.h: caustic photons that are far stronger than the others are divided into parts that lie around them.
 * A few paths gain flux wherever light is followed over shading normals, or are followed far more rarely than they
 * carry light; the disc of such a photon is seen as a bright ellipse. Its parts have no more flux than other photons,
 * and lie as far apart as these must to be dark, so the same light shows as a faint blur.
 * Rests on: Abramson, "On Bandwidth Variation in Kernel Estimates", 1982 (each sample has a width of its own; unlike
 * a wider estimate where a strong photon is found, that keeps the sum of what is estimated).
 * Flow: photon_tracing, caustic_radius -> [here] -> photon_map of caustics. Threads: pure. */
#ifndef AFTERGLOW_STRONG_PHOTONS_H
#define AFTERGLOW_STRONG_PHOTONS_H

#include "photon_tracing.h"

enum { STRONG_PHOTON_RATIO = 4 };

/* Divides the photons of a caustic map that have more than STRONG_PHOTON_RATIO times the mean flux, weighted by flux,
 * into equal parts of at most about that mean. They are spread evenly over the disc, along the surface, on which they
 * are as bright as one photon of that ratio on a disc of the largest radius (caustic_radius.h), scene units. A part
 * whose place is not on that surface, or is not seen from above the photon, stays where the photon was. The flux stays
 * the same in sum but for the rounding of photons' flux, which is right on average; the rounded total of the energy
 * balance is not told anew. Errors: AG_ERROR_MEMORY; the set is then unchanged. */
ag_status strong_photons_divide(const scene *s, float radius, photon_set *in_out_set);

#endif
