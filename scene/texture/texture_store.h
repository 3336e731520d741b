/* texture_store.h: pictures that do not fit into memory: their levels lie in a temporary file, in tiles, and tiles are
 * read when they are asked for and dropped when others need their room. What a pixel is does not depend on that.
 * Flow: texture_image puts them here; texture_mips reads them. Threads: one puts; then any number read at once. */
#ifndef AFTERGLOW_TEXTURE_STORE_H
#define AFTERGLOW_TEXTURE_STORE_H

#include "afterglow/base.h"
#include "texture/texture_pixels.h"

#include <stdbool.h>

typedef struct texture_store texture_store;

/* One level of a picture, or its alpha. */
typedef struct texture_tiles {
    texture_store *store;
    uint32_t width, tiles_across;
    uint32_t pixel_bytes;         /* at most TEXTURE_PIXEL_BYTES_MAX */
    uint64_t file_offset;         /* of the first tile */
    struct texture_tile *entries; /* of each tile; owned */
    size_t entry_count;
} texture_tiles;

enum { TEXTURE_PIXEL_BYTES_MAX = 12, TEXTURE_TILE_SIDE = 64 };

/* limit_bytes: of all pictures, whole ones and tiles. NULL when out of memory. */
texture_store *texture_store_create(uint64_t limit_bytes);
void texture_store_destroy(texture_store *s); /* NULL is fine; after its tiles */

/* Whether a picture of that size may stay in memory whole: as long as they take half of the limit. If so, it counts. */
bool texture_store_keeps(texture_store *s, uint64_t picture_bytes);

/* Writes pixels, packed row by row, as tiles. Errors: AG_ERROR_MEMORY, AG_ERROR_SYSTEM (no temporary file, or no room
 * in it); text in message. */
ag_status texture_store_put(texture_store *s, const void *pixels, uint32_t width, uint32_t height, uint32_t pixel_bytes,
                            texture_tiles **out_tiles, char *message, size_t message_size);
void texture_tiles_destroy(texture_tiles *t); /* NULL is fine */

/* Copies the blend's pixels, one behind the other. Zeros where the file cannot be read: see texture_store_state. */
void texture_tiles_read(const texture_tiles *t, const pixel_blend *blend, unsigned char *out_pixels);

typedef struct texture_store_counts {
    uint64_t whole_bytes;     /* of pictures held whole, with their coarser levels */
    uint64_t tile_bytes_most; /* of tiles, the most at any time */
    uint64_t file_bytes;      /* of the temporary file */
    uint64_t tiles_read;      /* from it */
} texture_store_counts;

/* NULL: all zero. */
texture_store_counts texture_store_count(const texture_store *s);

/* Whether all tiles could be read since the store was made. NULL is fine. Errors: AG_ERROR_MEMORY, AG_ERROR_SYSTEM (the
 * file cannot be read). */
ag_status texture_store_state(const texture_store *s);

#endif
