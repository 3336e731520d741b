/* image_file.h: pictures on disk. OpenImageIO encodes to memory, inside a module that is opened when it is first needed
 * (linking it costs half a second at every start); the bytes are written by us, beside the target, and renamed.
 * Flow: film, colour -> [here] -> file. Threads: one caller at a time per call; no state but the loaded module. */
#ifndef AFTERGLOW_IMAGE_FILE_H
#define AFTERGLOW_IMAGE_FILE_H

#include "afterglow/base.h"

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum image_sample_type { IMAGE_UINT8, IMAGE_UINT16, IMAGE_HALF, IMAGE_FLOAT } image_sample_type;

typedef struct image_attribute {
    const char *name;
    const char *text;     /* a string attribute, or NULL: numbers */
    const float *numbers; /* float attribute, count 1 or an array */
    int number_count;
} image_attribute;

/* What to write: float channels, packed per pixel, top row first. */
typedef struct image_description {
    int width, height;           /* of the pixels given (the data window) */
    int x, y;                    /* of its top left corner in the full picture */
    int full_width, full_height; /* the full picture (the display window), from (0, 0) */
    int channel_count;           /* 3 or 4, or more for EXR */
    const char *const *channel_names;
    image_sample_type type;  /* as stored; a format that cannot hold it is an error */
    const char *color_space; /* oiio:ColorSpace, or NULL */
    const image_attribute *attributes;
    int attribute_count;
} image_description;

/* What a file name's extension stands for. */
typedef struct image_format {
    const char *extension; /* lower case, without the dot */
    bool scene_linear;     /* EXR: written as it is; the others through a display and view */
    image_sample_type default_type;
} image_format;

/* NULL where the extension is not known. Known: exr, png, tif, tiff, jpg, jpeg. Needs no module. */
const image_format *image_format_of(const char *path);

/* The types a format can hold. */
bool image_format_can_hold(const image_format *format, image_sample_type type);

/* Encodes and writes atomically: into a temporary file in the target's folder, fsync, rename. On failure the
 * target is as it was and nothing is left beside it. Half values are clamped to +-65504. Non-finite values must have
 * been replaced by the caller. DateTime is set from the attributes or left out, so equal pictures give equal files.
 * JPEG keeps the first three channels, and the attributes up to 16 KiB of text. A path that is a symbolic link writes
 * what it points to; one that is no regular file (a FIFO, a device, /dev/stdout) is written directly.
 * Errors: AG_ERROR_OUTPUT, AG_ERROR_SYSTEM (the module cannot be opened), AG_ERROR_MEMORY; text in message. */
ag_status image_file_write(const char *path, const image_description *description, const float *pixels, char *message,
                           size_t message_size);

/* Whether a file could be created at path now: the extension is known, its folder exists and may be written, it is no
 * folder itself. Called before a long render. Errors: AG_ERROR_OUTPUT. */
ag_status image_file_check_target(const char *path, char *message, size_t message_size);

/* Reads a picture as floats (for tests and tools). *out_pixels is malloc'ed, 'channel_count' packed floats a pixel; the
 * size is that of the data window. Errors: AG_ERROR_INPUT, AG_ERROR_SYSTEM (the module), AG_ERROR_MEMORY. */
ag_status image_file_read(const char *path, int *out_width, int *out_height, int *out_channel_count, float **out_pixels,
                          char *message, size_t message_size);

#ifdef __cplusplus
}
#endif
#endif
