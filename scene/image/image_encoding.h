/* image_encoding.h: how the integers of an image file stand for light, and the way back to linear values.
 * The names are pbrt-v4's (pbrt.org/fileformat-v4, "Textures"); sRGB is IEC 61966-2-1, by OpenColorIO.
 * Flow: image_reader -> [here] -> texture_image, environments. Threads: any. */
#ifndef AFTERGLOW_IMAGE_ENCODING_H
#define AFTERGLOW_IMAGE_ENCODING_H

#include "afterglow/base.h"

#include <stdbool.h>
#include <stddef.h>

struct image;

typedef enum image_curve {
    IMAGE_CURVE_DEFAULT, /* sRGB */
    IMAGE_CURVE_LINEAR,
    IMAGE_CURVE_SRGB,
    IMAGE_CURVE_GAMMA,
    IMAGE_CURVE_SPACE /* a colour space of the config: see image_colors.h */
} image_curve;

/* An encoding counts for integers alone: half and float values are linear. Only a colour space counts for these too.
 * Zeroed, it is the default. */
typedef struct image_encoding {
    image_curve curve;
    float gamma;       /* linear = encoded ^ gamma; > 0; of IMAGE_CURVE_GAMMA, else 0 */
    const char *space; /* of IMAGE_CURVE_SPACE: the colour config's own string; else NULL */
    bool is_rule;      /* of IMAGE_CURVE_SPACE: the config's file rules say so, not the scene */
} image_encoding;

/* Parses "sRGB", "linear" or "gamma NUMBER"; returns false where the text is none of these. */
bool image_encoding_parse(const char *text, image_encoding *out_encoding);
/* Returns whether two encodings decode every picture alike. */
bool image_encoding_equal(image_encoding a, image_encoding b);

/* Computes the linear values of the integers 0 to size - 1, of which the last stands for 1. size: 256 or 65536. Errors:
 * AG_ERROR_COLOR, AG_ERROR_MEMORY; text in message. */
ag_status image_encoding_table(image_encoding encoding, size_t size, float *out_table, char *message,
                               size_t message_size);

/* Makes the floats of a picture linear, in place: all channels, as pbrt does. Errors: as above. */
ag_status image_linearize(struct image *picture, image_encoding encoding, char *message, size_t message_size);

#endif
