/* estimate_fingerprint.h: a fingerprint of what this program's estimates say, taken from some on a small built-in map.
 * A photon map's file keeps it, so that irradiances by another kernel, radius or rounding are known to be another
 * program's, without a version number that somebody would have to raise.
 * Flow: irradiance_estimate, photon_map -> [here] -> photon_file_key. Threads: one; the run's workers build the map. */
#ifndef AFTERGLOW_ESTIMATE_FINGERPRINT_H
#define AFTERGLOW_ESTIMATE_FINGERPRINT_H

#include "irradiance_estimate.h"
#include "math/hash128.h"

/* A function like irradiance_estimate_find. */
typedef irradiance_extent irradiance_estimate_fn(const photon_map *map, vec3 position, vec3 normal,
                                                 photon_neighbor *scratch, uint64_t *in_out_rays, rgb *out_irradiance);

/* The fingerprint of `find`, in general irradiance_estimate_find, on some 1000 photons over two discs, one of which
 * lies above the other: in the open, at rims, on both levels, with and without surfaces; as estimates and as the slots'
 * words. isa: as scene_commit takes it. Costs less than a millisecond beside the start of a renderer's first scene.
 * Errors: AG_ERROR_MEMORY, AG_ERROR_RAY_TRACING. */
ag_status estimate_fingerprint(const run_context *run, const char *isa, irradiance_estimate_fn *find,
                               hash128 *out_hash);

#endif
