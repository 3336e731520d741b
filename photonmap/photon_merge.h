/* photon_merge.h: irradiances that were computed on different machines, put together in one map: an irradiance is a
 * pure function of the map and the photon, so it does not matter whose it is. Flow: photon_file (read) -> [here] ->
 * photon_file (write). Threads: one. */
#ifndef AFTERGLOW_PHOTON_MERGE_H
#define AFTERGLOW_PHOTON_MERGE_H

#include "photon_map.h"

typedef enum photon_merge_result {
    PHOTON_MERGE_DONE,
    PHOTON_MERGE_DIFFERS /* both are ready and are not the same: *out_irradiance_photon is the first such one; into is
                            unchanged */
} photon_merge_result;

/* Fills what is empty in `into` with what is ready in `from`, which is a map of the same photons in the same order.
 * *in_out_added: those are added. */
photon_merge_result photon_merge(photon_map *into, const photon_map *from, uint64_t *in_out_added,
                                 uint32_t *out_irradiance_photon);

/* The number of slots that are ready. */
uint64_t photon_merge_count_ready(const photon_map *map);

#endif
