/* map_file.h: photon maps that last: read from the file that the settings name, or traced and kept there. Of several
 * processes that want the same one, one traces, the others wait for it, and then all fill it together.
 * Flow: render.c -> [here] -> photon_file. Threads: one of each process. */
#ifndef AFTERGLOW_MAP_FILE_H
#define AFTERGLOW_MAP_FILE_H

#include "context.h"
#include "photon_file.h"

/* Traces photons and builds maps that own what they have. */
typedef ag_status map_file_trace(ag_context *context, const scene *s, const ag_render_settings *settings,
                                 photon_map *out_global, photon_map *out_caustic);

/* The maps that settings->photon_map_file holds, or that trace makes. Says in the log, and in the statistics, which it
 * was. *out_file is to be closed after the maps. Errors: AG_ERROR_INPUT (the file is refused), AG_ERROR_OUTPUT,
 * AG_ERROR_MEMORY, AG_CANCELLED, and those of trace. */
ag_status map_file_obtain(ag_context *context, const scene *s, const ag_render_settings *settings,
                          map_file_trace *trace, photon_file *out_file, photon_map *out_global,
                          photon_map *out_caustic);

#endif
