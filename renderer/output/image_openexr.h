/* image_openexr.h: a picture as the bytes of an EXR file, by OpenEXR's library in C, which is linked: unlike the module
 * of OpenImageIO it costs a run nothing at its start.
 * Rests on: openexr.com, "OpenEXR File Layout" and "Standard Attributes".
 * Flow: image_file -> [here] -> bytes in memory. Threads: any. */
#ifndef AFTERGLOW_IMAGE_OPENEXR_H
#define AFTERGLOW_IMAGE_OPENEXR_H

#include "afterglow/base.h"
#include "image/image.h"

#include <stddef.h>

/* One part, its channels sorted by their names as the format wants it, lines from the top or tiles of 64 x 64, ZIP of
 * 16 lines or a tile. Channels that are stored as half are clamped to +-65504. A text DateTime becomes capDate, eight
 * numbers called chromaticities become the attribute of that type, sixteen numbers a matrix, one a float, others a
 * vector of floats; color_space is not written, since EXR has no name for it.
 * *out_bytes is the caller's, to be freed. Errors: AG_ERROR_OUTPUT, AG_ERROR_MEMORY; text in message. */
ag_status image_openexr_encode(const image_description *description, const float *pixels, unsigned char **out_bytes,
                               size_t *out_size, char *message, size_t message_size);

#endif
