/* texture_tile_packing.h: a tile's pixels in fewer bytes: differences between neighbours, in groups of as many bits as
 * the largest of a group needs. Nothing is lost, and it costs little more than copying: deflate, which makes little
 * less of what is noisy, takes thirty times as long. Tiles that become hardly smaller stay as they are.
 * Rests on: Lemire, Boytsov, "Decoding billions of integers per second through vectorization", Software: Practice and
 * Experience 45, 2015 (bit packing across lanes; zigzag as in protocol buffers).
 * Flow: texture_store -> [here]. Threads: pure functions. */
#ifndef AFTERGLOW_TEXTURE_TILE_PACKING_H
#define AFTERGLOW_TEXTURE_TILE_PACKING_H

#include "afterglow/base.h"

#include <stddef.h>
#include <stdint.h>

typedef struct tile_format {
    size_t row_values; /* of a row, all channels: pixels times channels */
    size_t row_count;  /* times row_values: a multiple of 128 */
    size_t channel_count;
    size_t value_bytes; /* 1, 2 or 4 */
} tile_format;

static inline size_t tile_format_bytes(tile_format f) { return f.row_values * f.row_count * f.value_bytes; }
/* Returns the size of the memory that packing and unpacking work in: a uint32_t for each value, aligned as one. */
static inline size_t tile_scratch_bytes(tile_format f) { return f.row_values * f.row_count * sizeof(uint32_t); }

/* Gives how many bytes were written to out: at most seven eighths of tile_format_bytes, or all of them, as they were.
 * scratch has tile_scratch_bytes, out tile_format_bytes. */
size_t tile_pack(tile_format f, const unsigned char *pixels, uint32_t *scratch, unsigned char *out);
/* Errors: AG_ERROR_SYSTEM (these bytes are no packed tile). */
ag_status tile_unpack(tile_format f, const unsigned char *packed, size_t packed_bytes, uint32_t *scratch,
                      unsigned char *out_pixels);

/* A checksum of packed bytes. */
uint32_t tile_check(const unsigned char *packed, size_t packed_bytes);

#endif
