/* image_module.h: the one table between the program and the module that knows OpenImageIO. Private; both sides are
 * built together.
 * Flow: image_reader.c, image_file.c (renderer) -> [here] -> image_oiio.cpp.
 * Threads: the functions may be called from many at once. */
#ifndef AFTERGLOW_IMAGE_MODULE_H
#define AFTERGLOW_IMAGE_MODULE_H

#include "afterglow/base.h"
#include "image/image.h"

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#define IMAGE_MODULE_FILE_NAME  "afterglow_image.so"
#define IMAGE_MODULE_ENTRY_NAME "afterglow_image_module"

/* Raised whenever this file or image.h changes. */
enum { IMAGE_MODULE_INTERFACE = 11 };

typedef struct image_module {
    int interface_number; /* IMAGE_MODULE_INTERFACE of the module */

    /* The picture as a file's bytes, malloc'ed. extension: hdr, png, tif, tiff, jpg or jpeg. Errors: AG_ERROR_OUTPUT,
     * AG_ERROR_MEMORY. */
    ag_status (*encode)(const char *extension, const image_description *description, const float *pixels,
                        unsigned char **out_bytes, size_t *out_size, char *message, size_t message_size);

    /* Reads the first picture of a file, piece by piece: a megabyte of rows or tiles, or what the format packs together
     * where that is more. Some formats are decoded as a whole when the file is opened or its first piece is read, and
     * do not end before that: interlaced PNG, progressive JPEG (in part), HEIF, AVIF, JPEG 2000, WebP, GIF, compressed
     * Targa, DDS, IFF, cameras' raw pictures, TIFF files of unusual colours, and the channels of a TIFF file that lie
     * apart in a single strip each. name: the file's own, whose end may tell its format, where path is another way to
     * it. Errors: AG_ERROR_INPUT, AG_ERROR_MEMORY, AG_CANCELLED (without a message). */
    ag_status (*decode)(const char *path, const char *name, const image_request *request, image *out_image,
                        char *message, size_t message_size);

    /* Works as decode, on a file's bytes in memory. extension: of their format, in lower case. */
    ag_status (*decode_memory)(const char *extension, const unsigned char *bytes, size_t size,
                               const image_request *request, image *out_image, char *message, size_t message_size);

    /* Opens a file that holds tiles and coarser levels, the last a single pixel. path, name: as of decode; path is to
     * stay valid. *out_file is to be closed; NULL, with AG_OK, where it holds none of that kind. Errors:
     * AG_ERROR_INPUT, AG_ERROR_MEMORY. */
    ag_status (*open_levels)(const char *path, const char *name, void **out_file, image_levels_header *out_header,
                             char *message, size_t message_size);
    /* A tile, from its upper left corner, of some of the channels, as bytes or floats; rows are as long as the level's
     * tiles are wide. header: what the caller's memory was measured by; where the file says other sizes by now, nothing
     * is read. Any number of threads may read from one file; they wait for one another. Errors: as of open_levels. */
    ag_status (*read_tile)(void *file, const image_levels_header *header, int level, int x, int y, int channel_begin,
                           int channel_end, bool as_bytes, void *out_pixels);
    void (*close_levels)(void *file);
} image_module;

/* The module's only symbol. NULL where OpenImageIO cannot be set up. */
typedef const image_module *image_module_entry(void);
AG_API const image_module *afterglow_image_module(void);

#ifdef __cplusplus
}
#endif
#endif
