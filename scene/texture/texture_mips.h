/* texture_mips.h: coarser levels of a picture, for filtered look-ups. Each pixel of a level is the mean of the linear
 * values that it covers in the level before, by area where sizes are odd, so that every level has the picture's mean.
 * Rests on: Williams, "Pyramidal Parametrics", SIGGRAPH 1983; for odd sizes Guthe, Heckbert, "Non-Power-of-Two
 * Mipmapping", 2005. Flow: texture_image -> [here] -> texture_filter. Threads: built by the run's workers; then
 * read-only. */
#ifndef AFTERGLOW_TEXTURE_MIPS_H
#define AFTERGLOW_TEXTURE_MIPS_H

#include "afterglow/base.h"
#include "math/vec3.h"
#include "run_context.h"
#include "texture/texture_pixels.h"
#include "texture/texture_store.h"

enum { TEXTURE_LEVELS_MAX = 32 };

/* How a value is kept: linear, but for bytes, whose linear values are in a table. */
typedef enum texture_sample { TEXTURE_BYTES, TEXTURE_PACKED, TEXTURE_FLOATS } texture_sample;

/* Pixels, packed, top row first: of bytes, packed and values the one that `sample` says, or in tiles. */
typedef struct texture_level {
    uint32_t width, height;
    uint32_t channel_count; /* 1 or 3 */
    texture_sample sample;
    const unsigned char *bytes;
    const float *table; /* of bytes; NULL: they are in 1/255 */
    uint16_t *packed;   /* in 1/65535 */
    float *values;
    texture_tiles *tiles; /* instead of these; owned by whoever puts them there; NULL: they are in memory */
} texture_level;

typedef struct texture_mips {
    uint32_t level_count;                     /* >= 1 */
    texture_level levels[TEXTURE_LEVELS_MAX]; /* the first is the picture itself, borrowed; each other is half as wide
                                                 and high as the one before, rounded up; the last is a single pixel */
} texture_mips;

/* run NULL, or without a pool: by this thread alone. Errors: AG_ERROR_MEMORY, AG_CANCELLED. */
ag_status texture_mips_create(run_context *run, const texture_level *finest, texture_mips **out_mips);
void texture_mips_destroy(texture_mips *m); /* NULL is fine */

/* Moves all levels into the store, the finest, of which the memory stays the caller's, too. into, errors: as of
 * texture_store_put. */
ag_status texture_mips_put(run_context *run, texture_mips *m, texture_store *store, tile_file *into, char *message,
                           size_t message_size);
/* Moves a single level into the store, as texture_mips_put does. */
ag_status texture_level_put(run_context *run, texture_level *in_out, texture_store *store, tile_file *into,
                            char *message, size_t message_size);
/* The sizes of its pixels as they are put. */
texture_layout texture_level_layout(const texture_level *l);

/* Linear values between the middles of a level's pixels; of a grey picture all three are the same. */
rgb texture_level_rgb(const texture_level *l, texture_wraps wraps, texture_filter filter, float s, float t);
/* A single channel of these, below l->channel_count. */
float texture_level_channel(const texture_level *l, uint32_t channel, texture_wraps wraps, texture_filter filter,
                            float s, float t);

#endif
