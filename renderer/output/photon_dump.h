/* photon_dump.h: photons as a PLY file that viewers and scripts read.
 * Flow: photon maps -> [here] -> atomic_file. Threads: one, while no tiles run. */
#ifndef AFTERGLOW_PHOTON_DUMP_H
#define AFTERGLOW_PHOTON_DUMP_H

#include "photon_map.h"

/* See ag_rendering_write_photons. Errors: AG_ERROR_MEMORY, AG_ERROR_OUTPUT (with text in message), AG_CANCELLED (run
 * is, while a reader is waited for). */
ag_status photon_dump_write(const run_context *run, const photon_map *global, const photon_map *caustic,
                            const char *path, char *message, size_t message_size);

#endif
