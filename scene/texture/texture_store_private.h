/* texture_store_private.h: what putting tiles into a store and reading them share.
 * Flow: texture_store.c, texture_store_read.c. Threads: as the fields say. */
#ifndef AFTERGLOW_TEXTURE_STORE_PRIVATE_H
#define AFTERGLOW_TEXTURE_STORE_PRIVATE_H

#include "atomics.h"
#include "texture/texture_store.h"
#include "texture/texture_tile_packing.h"

#include <pthread.h>

enum { SHARD_BITS = 6, SHARDS = 1 << SHARD_BITS };
enum { NO_MEMORY = 1, NO_TEMPORARY = 2 }; /* failures */

/* Read and changed under its shard's lock, but for where it lies in the file, which never changes. */
typedef struct texture_tile {
    unsigned char *pixels; /* NULL: not here */
    uint64_t file_offset;
    uint32_t file_bytes; /* packed */
    uint32_t size_bytes; /* of pixels; 0 where they are NULL */
    uint32_t check;      /* of what lies in a file that is_checked */
    bool was_asked;
} texture_tile;

typedef struct shard {
    _Alignas(64) pthread_mutex_t lock;
    texture_tile **held;
    uint32_t held_count, held_capacity, hand;
    uint64_t bytes, bytes_most, read_count;
} shard;

struct texture_store {
    shard shards[SHARDS];
    uint64_t limit_bytes, whole_bytes, tile_count;
    tile_file temporary;
    atomic_u32 failures; /* relaxed: read behind a barrier of the pass */
};

static inline size_t pixel_bytes_of(const texture_tiles *t) { return (size_t)t->channel_count * t->value_bytes; }

static inline size_t tile_bytes_of(const texture_tiles *t)
{
    return pixel_bytes_of(t) << (t->tile_width_bits + t->tile_height_bits);
}

static inline tile_format format_of(const texture_tiles *t)
{
    return (tile_format){.row_values = (size_t)t->channel_count << t->tile_width_bits,
                         .row_count = (size_t)1 << t->tile_height_bits,
                         .channel_count = t->channel_count,
                         .value_bytes = t->value_bytes};
}

#endif
