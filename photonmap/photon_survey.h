/* photon_survey.h: measures a quantity at a sample of a map's photons, evenly spaced in its order, and sorts the
 * values: medians and other quantiles over the whole scene at little cost.
 * Flow: photon_tree -> [here] -> photon_map, caustic_radius: bounds of the estimates' radii. Threads: one. */
#ifndef AFTERGLOW_PHOTON_SURVEY_H
#define AFTERGLOW_PHOTON_SURVEY_H

#include "photon_map.h"

enum { PHOTON_SURVEY_MAX = 255 };

/* The quantity at a photon, given its position and the unit normal of the surface there. scratch:
 * photon_map_scratch_count of the map. */
typedef float photon_survey_measure(const photon_map *map, vec3 position, vec3 normal, photon_neighbor *scratch);

/* Measures at PHOTON_SURVEY_MAX photons, or at all where there are fewer; of a steady map, at about 192 that are chosen
 * by their positions. out_sorted: ascending. Errors: AG_ERROR_MEMORY. */
ag_status photon_survey(const photon_map *map, photon_survey_measure *measure, float out_sorted[PHOTON_SURVEY_MAX],
                        uint32_t *out_count);

#endif
