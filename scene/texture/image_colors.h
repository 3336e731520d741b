/* image_colors.h: from the values of a picture file to colours of the working space. What the scene file says of the
 * picture counts first; then the chromaticities that the picture itself brings; then the file rules of the colour
 * config, but for its rule for all that no other fits; else integers are sRGB and floats linear with its primaries.
 * Flow: image_reader -> [here] -> texture_image, environments. Threads: pure functions. */
#ifndef AFTERGLOW_IMAGE_COLORS_H
#define AFTERGLOW_IMAGE_COLORS_H

#include "color/working_space.h"
#include "image/image_encoding.h"
#include "math/vec3.h"

struct image;
struct color_config;

/* The space that colours of pictures are converted to. Both members are borrowed. */
typedef struct image_colors_target {
    const working_space *space;
    const struct color_config *config; /* that names it, and tells how pictures are encoded; NULL: none */
} image_colors_target;

/* The conversion that is left for values that were made linear by `encoding`. */
typedef struct image_colors {
    image_encoding encoding; /* never of a colour space */
    const char *space;       /* the values are taken as they are, and decoded from this one; or NULL. The config's */
    bool has_matrix;
    float matrix[9]; /* of linear values, row by row */
} image_colors;

/* Returns the encoding of a picture of colours for which the scene gives none: by the config's file rules, else the
 * default. */
image_encoding image_colors_rule(const image_colors_target *target, const char *path);

/* Parses an encoding of a scene file: as image_encoding_parse, or a colour space of the config. Returns false where it
 * is neither, and writes the known ones to message. */
bool image_colors_parse(const image_colors_target *target, const char *text, image_encoding *out_encoding,
                        char *message, size_t message_size);

/* Errors: AG_ERROR_COLOR, AG_ERROR_MEMORY; text in message. */
ag_status image_colors_find(const image_colors_target *target, image_encoding encoding, const struct image *picture,
                            image_colors *out_colors, char *message, size_t message_size);

/* Decodes from colors->space, which is not NULL, in place. Errors: as above. */
ag_status image_colors_decode(const image_colors_target *target, const image_colors *colors, float *rgb_pixels,
                              size_t count, char *message, size_t message_size);

/* Converts by the matrix; colours outside the gamut are clipped to 0. Asked for only where has_matrix. */
static inline rgb image_colors_convert(const image_colors *colors, rgb c)
{
    const float *m = colors->matrix;
    return rgb_make(float_max(m[0] * c.r + m[1] * c.g + m[2] * c.b, 0.0f),
                    float_max(m[3] * c.r + m[4] * c.g + m[5] * c.b, 0.0f),
                    float_max(m[6] * c.r + m[7] * c.g + m[8] * c.b, 0.0f));
}

#endif
