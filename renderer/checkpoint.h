/* checkpoint.h: a rendering written down, so that another process can go on where this one ended, to the same bits.
 * Flow: rendering (film, irradiance that was demanded) -> [here] -> atomic_file; and back. Threads: as in afterglow.h.
 *
 * A file is a checkpoint_header, the film's planes, the irradiance words, and a CRC-32 of all that; numbers as the
 * machine has them. Photons are not in it: they are traced again, by the same random numbers. */
#ifndef AFTERGLOW_CHECKPOINT_H
#define AFTERGLOW_CHECKPOINT_H

#include "math/hash128.h"
#include "rendering.h"

/* The layout's number is raised with every change of the header or of what the film's planes hold. */
enum { CHECKPOINT_LAYOUT = 10, CHECKPOINT_SETTINGS_MAX = 512 };

/* The header has no gaps: its bytes are written to the file as they are in memory. */
typedef struct checkpoint_header {
    char magic[8];
    uint32_t layout, byte_order;
    char program[32], isa[16];
    hash128 scene, view, filter;
    hash128 estimates, photons;            /* where there is a photon map, else zeros: context_estimates,
                                              maps_photons_hash */
    uint64_t plane_sizes[FILM_PLANES_MAX]; /* bytes; 0 behind the last */
    uint64_t photon_count;                 /* irradiance words; 0: none */
    uint32_t settings_size, spare;
    unsigned char settings[CHECKPOINT_SETTINGS_MAX]; /* settings_of_picture */
} checkpoint_header;

/* Makes the header that the rendering's checkpoint has. Errors: those of context_estimates. */
ag_status checkpoint_header_make(const struct ag_rendering *r, checkpoint_header *out_header);

/* Names what differs between a file's header and the rendering's, in words; NULL: nothing does. */
const char *checkpoint_header_difference(const checkpoint_header *file, const checkpoint_header *ours);

#endif
