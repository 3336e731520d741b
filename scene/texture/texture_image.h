/* texture_image.h: pictures as textures look them up: linear values between the middles of pixels. Pixels of 8 bits
 * stay bytes, and are decoded by a table of 256; a picture may serve as colours and as numbers. Rests on: Pharr, Jakob,
 * Humphreys, "Physically Based Rendering", 4th ed., 2023, 10.4 (image texture). Flow: texture_image_load ->
 * [here] -> texture. Threads: one loads; then any number look up. */
#ifndef AFTERGLOW_TEXTURE_IMAGE_H
#define AFTERGLOW_TEXTURE_IMAGE_H

#include "math/hash128.h"
#include "math/vec3.h"
#include "texture/image_colors.h"
#include "texture/texture_mips.h"
#include "texture/texture_pixels.h"

#include <stdint.h>

struct image;

/* The channels of a picture: all three colours of a grey one are the same; alpha is 1 where it has none. */
typedef enum texture_channel {
    TEXTURE_CHANNEL_ALL,  /* as pbrt has it: alpha of pictures that have one (of tiles: any), else the colours' mean */
    TEXTURE_CHANNEL_MEAN, /* of the colours */
    TEXTURE_CHANNEL_R,
    TEXTURE_CHANNEL_G,
    TEXTURE_CHANNEL_B,
    TEXTURE_CHANNEL_A /* never encoded */
} texture_channel;

/* Pixels that pictures of scenes that follow one another hold together. */
typedef struct texture_image_share {
    unsigned holder_count;
    texture_mips *mips; /* once one of them has wanted any */
    float table[256];   /* of all of them, for the mips */
} texture_image_share;

typedef struct texture_image {
    char *path;
    uint64_t version;           /* of what the path names: another one is another picture */
    texture_image_share *share; /* NULL: its pixels are its alone */
    image_encoding encoding;
    uint32_t width, height;
    uint32_t channel_count;     /* 1 or 3 */
    unsigned char *bytes;       /* packed, top row first; or NULL: values */
    float *values;              /* linear */
    float table[256];           /* linear values of the bytes */
    unsigned char *alpha_bytes; /* with bytes, or NULL: 1 everywhere */
    float *alpha_values;        /* with values, or NULL: 1 everywhere */
    image_colors colors;        /* from linear values to the working space's, of those that are colours */
    texture_mips *mips;         /* coarser levels, for filtering; NULL: none are wanted */
    bool is_stored;             /* all pixels lie in the scene's texture_store: those above are NULL, mips are there */
    texture_level stored_alpha; /* then, where it has one: tiles is not NULL */
    hash128 stored_content;     /* then, what texture_image_content was */
    bool is_first_of_several;   /* its file holds other pictures, too */
    bool is_by_file;            /* its levels are those of its file, whose bytes are its fingerprint */
    struct texture_file_levels *file; /* from which tiles are read, or NULL */
    struct texture_kept *kept;        /* the file of a cache folder that its tiles lie in, or NULL */
    uint64_t bad_count;               /* values that were not finite, and are 0 now */
    float least, most;                /* of the linear values, before `colors` */
    struct texture_udim *udim; /* many pictures side by side, see texture_udim.h, or NULL. Then the sizes above are the
                                  largest, the counts and bounds all of them's; it has no pixels or colours itself */
    bool has_tile_alpha;       /* then, whether any of them has alpha */
} texture_image;

/* Takes the pixels of a picture that was read, of which *i has path and encoding so far. Errors: AG_ERROR_COLOR,
 * AG_ERROR_MEMORY; text in message. */
ag_status texture_image_take(const image_colors_target *target, texture_image *i, struct image *picture, char *message,
                             size_t message_size);
void texture_image_destroy(texture_image *i); /* NULL is fine */
/* Frees a picture's coarser levels, its stored tiles and the cache's file, and leaves these members empty. */
void texture_image_drop_store(texture_image *i);
/* Another picture with the same pixels, as it was read; for pictures that are held whole. NULL when out of memory. */
texture_image *texture_image_hold(texture_image *i);

/* The picture itself as a level, whose memory stays the picture's. Not of one that is stored. */
static inline texture_level texture_image_finest(const texture_image *i)
{
    return (texture_level){.width = i->width,
                           .height = i->height,
                           .channel_count = i->channel_count,
                           .sample = i->bytes ? TEXTURE_BYTES : TEXTURE_FLOATS,
                           .bytes = i->bytes,
                           .table = i->table,
                           .values = i->values};
}

/* Whether alpha is below 1 anywhere; of one in tiles, on any of them. */
static inline bool texture_image_has_alpha(const texture_image *i)
{
    return i->alpha_bytes || i->alpha_values || i->stored_alpha.tiles || i->has_tile_alpha;
}

/* The picture's alpha as a level, stored or not, where it has one. is_encoded: bytes are decoded as those of colours
 * are. */
static inline texture_level texture_image_alpha(const texture_image *i, bool is_encoded)
{
    texture_level alpha = i->stored_alpha;
    if (!i->is_stored)
        alpha = (texture_level){.width = i->width,
                                .height = i->height,
                                .channel_count = 1,
                                .sample = i->alpha_bytes ? TEXTURE_BYTES : TEXTURE_FLOATS,
                                .bytes = i->alpha_bytes,
                                .values = i->alpha_values};
    alpha.table = is_encoded ? i->table : NULL;
    return alpha;
}

/* A fingerprint of its pixels, the same whether they are stored or not. */
hash128 texture_image_content(const texture_image *i);

/* s to the right, t down, from the top left corner (0, 0) to the bottom right one (1, 1). The first is a colour of the
 * working space, the others are numbers as they stand in the picture, made linear. */
rgb texture_image_color(const texture_image *i, texture_wraps wraps, texture_filter filter, float s, float t);
rgb texture_image_rgb(const texture_image *i, texture_wraps wraps, texture_filter filter, float s, float t);
float texture_image_float(const texture_image *i, texture_channel channel, texture_wraps wraps, texture_filter filter,
                          float s, float t);

#endif
