/* image_reader.h: pictures from disk and memory, by OpenImageIO, in a module that is opened when it is first needed.
 * Flow: file -> [here] -> textures, lights of images, tests and tools. Threads: any; no state but the loaded module. */
#ifndef AFTERGLOW_IMAGE_READER_H
#define AFTERGLOW_IMAGE_READER_H

#include "afterglow/base.h"
#include "image/image.h"
#include "run_context.h"

#include <stddef.h>

/* Reads all channels of the first picture of a file, beginning with its colours; *out_image is to be reset. On failure
 * *out_image is empty and message says why, with OpenImageIO's text. Errors: AG_ERROR_INPUT, AG_ERROR_SYSTEM (the
 * module cannot be opened), AG_ERROR_MEMORY. */
ag_status image_read(const char *path, image *out_image, char *message, size_t message_size);

/* image_read of the colours alone: what textures and lights are made of. The file is opened as of input_file_open,
 * which asks the run's inputs; run may be NULL. Where the run is cancelled reading ends with AG_CANCELLED, before the
 * next piece of the picture (image_module.h says which formats have none). */
ag_status image_read_colors(const run_context *run, const char *path, image *out_image, char *message,
                            size_t message_size);

/* Works as image_read_colors, but values of 8 bits stay bytes. */
ag_status image_read_compact(const run_context *run, const char *path, image *out_image, char *message,
                             size_t message_size);

/* Reads a PNG or JPEG file in memory, which its first bytes tell apart; values of 8 bits stay bytes. run: NULL, or
 * whom to ask whether to end. name: for messages. Errors: as of image_read_colors. */
ag_status image_read_memory(const run_context *run, const char *name, const unsigned char *bytes, size_t size,
                            image *out_image, char *message, size_t message_size);

/* Brings a picture to its display window: what lies outside is cut off, what is missing is 0. name: for messages.
 * Errors: AG_ERROR_INPUT (the picture does not fill a window of more than 2^28 pixels), AG_ERROR_MEMORY. */
ag_status image_fill_window(image *in_out, const char *name, char *message, size_t message_size);

/* Copies a picture. as_floats: bytes become floats, as when a file is read. Returns false, with *out_copy zeroed, when
 * out of memory. */
bool image_copy(const image *picture, bool as_floats, image *out_copy);

void image_reset(image *picture); /* frees the pixels; leaves it zeroed */

#endif
