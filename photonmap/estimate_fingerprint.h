/* estimate_fingerprint.h: a fingerprint of the estimates that this program computes, taken on a small built-in map. The
 * file of a photon map keeps it, so that irradiances by another kernel, radius or rounding are recognised without a
 * version number that has to be raised.
 * Flow: irradiance_estimate, caustic_radius, photon_map -> [here] -> photon_file_key. Threads: one; the run's workers
 * build the map. */
#ifndef AFTERGLOW_ESTIMATE_FINGERPRINT_H
#define AFTERGLOW_ESTIMATE_FINGERPRINT_H

#include "irradiance_estimate.h"
#include "math/hash128.h"

/* A function like irradiance_estimate_find. */
typedef irradiance_extent irradiance_estimate_fn(const photon_map *map, vec3 position, vec3 normal,
                                                 photon_neighbor *scratch, uint64_t *in_out_rays, rgb *out_irradiance);

/* Writes the fingerprint of `find`, usually irradiance_estimate_find, on 4096 photons over a heap of discs: in the
 * open, at walls, corners, ledges and rims, of 20 and of 96 photons, with and without surfaces; of the estimates and of
 * the slots' words; and of the largest radius of caustic estimates (caustic_radius.h). isa: as scene_commit takes it.
 * It takes about 10 ms of one core. Errors: AG_ERROR_MEMORY, AG_ERROR_RAY_TRACING. */
ag_status estimate_fingerprint(const run_context *run, const char *isa, irradiance_estimate_fn *find,
                               hash128 *out_hash);

#endif
