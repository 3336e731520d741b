/* estimate_fingerprint.h: a fingerprint of the photons that this program traces and of the estimates that it computes,
 * taken on a small built-in scene. The file of a photon map keeps it, and a checkpoint, so that photons and irradiances
 * by another kernel, radius, rounding or way of tracing are recognised without a version number that has to be raised.
 * Flow: fingerprint_scene, photon_tracing, irradiance_estimate, caustic_radius, photon_map -> [here] ->
 * photon_file_key, checkpoint. Threads: one; the run's workers trace photons and build the map. */
#ifndef AFTERGLOW_ESTIMATE_FINGERPRINT_H
#define AFTERGLOW_ESTIMATE_FINGERPRINT_H

#include "irradiance_estimate.h"
#include "math/hash128.h"

/* A function like irradiance_estimate_find. */
typedef irradiance_extent irradiance_estimate_fn(const photon_map *map, vec3 position, vec3 normal,
                                                 photon_neighbor *scratch, uint64_t *in_out_rays, rgb *out_irradiance);

/* A function like photon_tracing_run. */
typedef ag_status photon_tracing_fn(const scene *s, run_context *run, const photon_tracing_settings *settings,
                                    photon_set *out_set);

/* Writes the fingerprint of `trace` and `find`, usually photon_tracing_run and irradiance_estimate_find, on the
 * built-in scene (fingerprint_scene.h): of photons of both maps, by power alone and guided; of estimates from 4096
 * other photons in the open, at walls, corners, ledges and rims, of 20 and of 96 photons, with and without surfaces,
 * and in a steady map of which a quarter keep irradiances; of the slots' words; and of the largest radius of caustic
 * estimates (caustic_radius.h). isa: as scene_commit takes it. It takes about 30 ms of one core. Errors:
 * AG_ERROR_MEMORY, AG_ERROR_RAY_TRACING. */
ag_status estimate_fingerprint(const run_context *run, const char *isa, photon_tracing_fn *trace,
                               irradiance_estimate_fn *find, hash128 *out_hash);

#endif
