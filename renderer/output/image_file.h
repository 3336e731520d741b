/* image_file.h: pictures onto disk. EXR is encoded to memory by OpenEXR's library in C, PFM here, the others by
 * OpenImageIO, inside a module that is opened when it is first needed (linking it costs 0.3 s at every start); the
 * bytes are written by us, beside the target, and renamed. Flow: film, colour -> [here] -> file. Threads: one caller at
 * a time per call; no state but the loaded module. */
#ifndef AFTERGLOW_IMAGE_FILE_H
#define AFTERGLOW_IMAGE_FILE_H

#include "afterglow/base.h"
#include "image/image.h"
#include "run_context.h"

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The format that a file name's extension stands for. */
typedef struct image_format {
    const char *extension; /* lower case, without the dot */
    bool scene_linear;     /* EXR, Radiance, PFM: written as it is; the others through a display and view */
    image_sample_type default_type;
    bool has_layers; /* beside red, green and blue; and attributes of any kind */
} image_format;

/* Returns the format of a file name's extension; NULL where it is not known. Known are exr, hdr, pfm, png, tif, tiff,
 * jpg, jpeg. Needs no module. */
const image_format *image_format_of(const char *path);

/* The types a format can hold. */
bool image_format_can_hold(const image_format *format, image_sample_type type);

/* Encodes and writes atomically: into a temporary file in the target's folder, fsync, rename. On failure the
 * target is as it was and nothing is left beside it. Half values are clamped to +-65504. Non-finite values must have
 * been replaced by the caller. DateTime is set from the attributes or left out, so equal pictures give equal files.
 * JPEG keeps the first three channels, and the attributes up to 16 KiB of text. A path that is a symbolic link writes
 * what it points to; one that is no regular file (a FIFO, a device, /dev/stdout) is written directly, and waited for
 * until run is cancelled; NULL: for as long as it takes. Errors: AG_ERROR_OUTPUT, AG_ERROR_SYSTEM (the module cannot be
 * opened), AG_ERROR_MEMORY, AG_CANCELLED; text in message. */
ag_status image_file_write(const run_context *run, const char *path, const image_description *description,
                           const float *pixels, char *message, size_t message_size);

/* Checks whether a file could be created at path now: the extension is known, its folder exists and may be written, it
 * is no folder itself, and the module can be opened where the format needs it. Called before a long render. Errors:
 * AG_ERROR_OUTPUT, AG_ERROR_SYSTEM. */
ag_status image_file_check_target(const char *path, char *message, size_t message_size);

#ifdef __cplusplus
}
#endif
#endif
