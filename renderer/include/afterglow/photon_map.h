/* photon_map.h: files of photon maps that are kept.
 * Part of afterglow.h, which tells about threads and errors. */
#ifndef AFTERGLOW_PUBLIC_PHOTON_MAP_H
#define AFTERGLOW_PUBLIC_PHOTON_MAP_H

#include "afterglow/context.h"

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Whether a photon map could be kept there; of one that is there already nothing is read. To be asked before the scene
 * is loaded. Errors: AG_ERROR_OUTPUT. */
AG_API ag_status ag_photon_map_check(ag_context *context, const char *path);

/* The contents of a photon map's file. */
typedef struct ag_photon_map_info {
    size_t struct_size;
    char program[56], machine[56]; /* that have made it; those of others refuse it */
    char scene[33];                /* fingerprint of what its photons depend on in the scene, 32 hexadecimals */
    char view[33];                 /* fingerprint of the view that they are aimed at, 32 hexadecimals; "": at none */
    char settings[1024];           /* that they depend on, lines "NOUN: VALUE" */
    uint64_t file_bytes, paths_emitted, photons_global, photons_caustic;
    uint64_t irradiance_photons; /* photons of the global map that irradiance is kept at */
    uint64_t ready;              /* irradiance photons whose irradiance has been computed */
    uint64_t damaged;            /* irradiance photons whose irradiance is damaged, and will be computed again */
} ag_photon_map_info;

/* Reads the contents of a file. struct_size: of the program's ag_photon_map_info. Errors: AG_ERROR_INPUT (it cannot be
 * read, is damaged, or is no photon map; the log says why), AG_ERROR_MEMORY, AG_CANCELLED. */
AG_API ag_status ag_photon_map_read_info_fill(ag_context *context, const char *path, void *out_info,
                                              size_t struct_size);
static inline ag_status ag_photon_map_read_info(ag_context *context, const char *path, ag_photon_map_info *out_info)
{
    return ag_photon_map_read_info_fill(context, path, out_info, sizeof *out_info);
}

/* Puts the irradiances of several files of one map together, which were filled apart, on machines of one maker: in any
 * order, and any of them any number of times, they make the same map. Written atomically; what stands at
 * out_path must be a photon map, and unless it is damaged it is put in with the others. count >= 1. out_info: of the
 * new file, or NULL; struct_size: of the program's ag_photon_map_info. Errors: AG_ERROR_INPUT (the errors of
 * ag_photon_map_read_info; or files of different maps, or with different irradiances), AG_ERROR_OUTPUT,
 * AG_ERROR_MEMORY, AG_CANCELLED. */
AG_API ag_status ag_photon_map_merge_fill(ag_context *context, const char *out_path, const char *const *paths,
                                          size_t count, void *out_info, size_t struct_size);
static inline ag_status ag_photon_map_merge(ag_context *context, const char *out_path, const char *const *paths,
                                            size_t count, ag_photon_map_info *out_info)
{
    return ag_photon_map_merge_fill(context, out_path, paths, count, out_info, sizeof *out_info);
}

#ifdef __cplusplus
}
#endif
#endif
