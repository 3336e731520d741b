/* texture_store.h: pictures that do not fit into memory: tiles of their levels, which are read when they are asked for
 * and dropped when others need their room. They come from a temporary file, packed, or from wherever a fetch function
 * has them. What a pixel is does not depend on that.
 * Flow: texture_image_load puts them here; texture_mips reads them. Threads: one puts, by the run's workers; then any
 * number read at once. */
#ifndef AFTERGLOW_TEXTURE_STORE_H
#define AFTERGLOW_TEXTURE_STORE_H

#include "afterglow/base.h"
#include "run_context.h"
#include "texture/texture_pixels.h"
#include "texture/texture_tile_file.h"

#include <stdbool.h>

typedef struct texture_store texture_store;

/* Fills out_pixels with a whole tile, row by row; what is beyond the picture may be anything. Any number of threads.
 * Errors: AG_ERROR_MEMORY, AG_ERROR_INPUT. */
typedef ag_status texture_tile_fetch(void *user, int level, uint32_t x, uint32_t y, unsigned char *out_pixels);

/* Where tiles come from, and how they are cut. */
typedef struct texture_tile_source {
    texture_tile_fetch *fetch;
    void *user;
    int level;
    uint32_t tile_width_bits, tile_height_bits; /* of a tile's sides' logarithms; at most TEXTURE_TILE_BITS_MAX */
} texture_tile_source;

/* One level of a picture, or its alpha. */
typedef struct texture_tiles {
    texture_store *store;
    uint32_t width, tiles_across;
    uint32_t tile_width_bits, tile_height_bits;
    uint32_t channel_count, value_bytes;
    texture_tile_source source;   /* fetch NULL: the file */
    tile_file *file;              /* borrowed */
    uint64_t first_number;        /* of its first tile among all tiles */
    struct texture_tile *entries; /* of each tile; owned */
    size_t entry_count;
} texture_tiles;

enum { TEXTURE_PIXEL_BYTES_MAX = 12, TEXTURE_TILE_BITS = 6, TEXTURE_TILE_BITS_MAX = 9 };

/* limit_bytes: of all pictures, whole ones and tiles. NULL when out of memory. */
texture_store *texture_store_create(uint64_t limit_bytes);
void texture_store_destroy(texture_store *s); /* NULL is fine; after its tiles */

/* Whether texture_store_keeps would say so. */
bool texture_store_has_room(const texture_store *s, uint64_t picture_bytes);
/* Whether a picture of that size may stay in memory whole: as long as they take half of the limit. If so, it counts. */
bool texture_store_keeps(texture_store *s, uint64_t picture_bytes);

/* A level's size, and the type of its values: 1, 2 or 4 bytes of 1 or 3 channels. */
typedef struct texture_layout {
    uint32_t width, height, channel_count, value_bytes;
} texture_layout;

/* Writes pixels, packed row by row, as tiles, to a file that outlives them; into NULL: the store's temporary file.
 * Errors: AG_ERROR_MEMORY, AG_CANCELLED, AG_ERROR_SYSTEM (no temporary file, or no room); text in message. */
ag_status texture_store_put(texture_store *s, run_context *run, const void *pixels, texture_layout layout,
                            tile_file *into, texture_tiles **out_tiles, char *message, size_t message_size);
/* Tiles that such a file holds already, packed one by one as the parts say; there are as many parts as tiles.
 * Errors: AG_ERROR_MEMORY. */
typedef struct texture_tile_part {
    uint64_t offset;
    uint32_t size_bytes, check;
} texture_tile_part;
ag_status texture_store_take(texture_store *s, tile_file *from, texture_layout layout, const texture_tile_part *parts,
                             texture_tiles **out_tiles);
size_t texture_layout_tile_count(texture_layout layout); /* of what is put and taken */
size_t texture_layout_tile_bytes(texture_layout layout); /* of each, unpacked */
void texture_tiles_parts(const texture_tiles *t, texture_tile_part *out_parts);
/* Tiles that are read from a source, which outlives them. Errors: AG_ERROR_MEMORY. */
ag_status texture_store_lend(texture_store *s, texture_tile_source source, texture_layout layout,
                             texture_tiles **out_tiles);
void texture_tiles_destroy(texture_tiles *t); /* NULL is fine */

/* Copies the blend's pixels, one behind the other. Zeros where a tile cannot be read: see texture_store_state; of a
 * source that fails, the source is to know. */
void texture_tiles_read(const texture_tiles *t, const pixel_blend *blend, unsigned char *out_pixels);

typedef struct texture_store_counts {
    uint64_t whole_bytes;     /* of pictures held whole, with their coarser levels */
    uint64_t tile_bytes_most; /* of tiles, the most at any time */
    uint64_t file_bytes;      /* of the temporary file */
    uint64_t tiles_read;      /* from it, or from their sources */
} texture_store_counts;

/* NULL: all zero. */
texture_store_counts texture_store_count(const texture_store *s);

/* Whether there was memory for all tiles since the store was made, and those of files could be read. NULL
 * is fine. Errors: AG_ERROR_MEMORY, AG_ERROR_SYSTEM. */
ag_status texture_store_state(const texture_store *s);

#endif
