/* photon_merge.h: merges irradiances that were computed on different machines into one map. An irradiance is a pure
 * function of the map and the photon, so it does not matter where it was computed.
 * Flow: photon_file (read) -> [here] -> photon_file (write). Threads: one. */
#ifndef AFTERGLOW_PHOTON_MERGE_H
#define AFTERGLOW_PHOTON_MERGE_H

#include "photon_map.h"

typedef enum photon_merge_result {
    PHOTON_MERGE_DONE,
    PHOTON_MERGE_DIFFERS /* both are ready and differ: *out_irradiance_photon is the first such photon; `into` is
                            unchanged */
} photon_merge_result;

/* Copies ready slots of `from` to empty ones of `into`, a map of the same photons in the same order. *in_out_added:
 * their number is added. */
photon_merge_result photon_merge(photon_map *into, const photon_map *from, uint64_t *in_out_added,
                                 uint32_t *out_irradiance_photon);

#endif
