/* image_levels.h: parts of a picture whose file holds tiles and coarser levels, down to a single pixel, as maketx makes
 * them (.tx), and tiled OpenEXR and TIFF files with such levels. At most some files are open at once; the others are
 * opened for each part. Flow: file -> image_module -> [here] -> texture_levels. Threads: one opens and closes; any
 * number read. */
#ifndef AFTERGLOW_IMAGE_LEVELS_H
#define AFTERGLOW_IMAGE_LEVELS_H

#include "afterglow/base.h"
#include "image/image.h"
#include "run_context.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct image_levels image_levels;

/* Opens a file of which tiles are to be read, by input_file_open; run may be NULL. *out_levels is NULL, with AG_OK,
 * where the file holds no levels, is of a kind that is only read whole, or cannot be read, which is an error once it is
 * read whole. Errors: AG_ERROR_MEMORY. */
ag_status image_levels_open(const run_context *run, const char *path, image_levels **out_levels);
void image_levels_close(image_levels *l); /* NULL is fine */

const image_levels_header *image_levels_describe(const image_levels *l);

/* Reads the tile with its upper left corner at (x, y), of channels [channel_begin, channel_end), as bytes or floats,
 * row by row; what is beyond the picture is left as it is. Errors: AG_ERROR_INPUT, AG_ERROR_MEMORY. */
ag_status image_levels_read(image_levels *l, int level, int x, int y, int channel_begin, int channel_end, bool as_bytes,
                            void *out_pixels);

/* Returns whether the file is still the one that was opened. */
bool image_levels_is_unchanged(const image_levels *l);

#endif
