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

/* Checks, before the scene is loaded, that a photon map could be written to path; a file that exists is not read.
 * Errors: AG_ERROR_OUTPUT. */
AG_API ag_status ag_photon_map_check(ag_context *context, const char *path);

/* The contents of a photon map's file. */
typedef struct ag_photon_map_info {
    size_t struct_size;
    char program[56], machine[56]; /* build and processor that made it; others refuse it */
    char scene[33];                /* fingerprint of the parts of the scene that photons depend on, 32 hexadecimals */
    char view[33];       /* fingerprint of the view that the photons are aimed at, 32 hexadecimals; "": none */
    char settings[1024]; /* settings that photons depend on, lines "NOUN: VALUE" */
    uint64_t file_bytes, paths_emitted, photons_global, photons_caustic;
    uint64_t irradiance_photons; /* photons of the global map at which irradiance is kept */
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

/* Merges the irradiances of count >= 1 files of one photon map, which were filled separately on machines with
 * processors of one maker, and writes the result atomically. It does not depend on the order of the files, nor on
 * repetitions. A file at out_path must be a photon map; unless it is damaged, it is merged with the others. out_info:
 * the contents of the new file, or NULL; struct_size: of the program's ag_photon_map_info. Errors: AG_ERROR_INPUT
 * (those of ag_photon_map_read_info; or the files are of different maps, or have different irradiances),
 * AG_ERROR_OUTPUT, AG_ERROR_MEMORY, AG_CANCELLED. */
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
