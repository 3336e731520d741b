/* texture_tile_packing.h: a tile's pixels in fewer bytes: differences between neighbours, byte planes, deflate's runs
 * and Huffman codes alone. Nothing is lost. Only tiles that become half as large are packed: reading others
 * back as they are is ten times as fast.
 * Rests on: Boutell, "PNG Specification", RFC 2083, 1997, 6 (filters); Deutsch, RFC 1950, 1996 (zlib).
 * Flow: texture_store -> [here]. Threads: pure functions. */
#ifndef AFTERGLOW_TEXTURE_TILE_PACKING_H
#define AFTERGLOW_TEXTURE_TILE_PACKING_H

#include "afterglow/base.h"

#include <stddef.h>
#include <stdint.h>

typedef struct tile_format {
    size_t row_values; /* of a row, all channels: pixels times channels */
    size_t row_count;
    size_t channel_count;
    size_t value_bytes; /* 1, 2 or 4 */
} tile_format;

static inline size_t tile_format_bytes(tile_format f) { return f.row_values * f.row_count * f.value_bytes; }

/* Gives how many bytes were written to out: at most half of tile_format_bytes, or all of them, as they were. scratch
 * and out have tile_format_bytes. 0: out of memory. */
size_t tile_pack(tile_format f, const unsigned char *pixels, unsigned char *scratch, unsigned char *out);
/* Errors: AG_ERROR_SYSTEM (these bytes are no packed tile), AG_ERROR_MEMORY. */
ag_status tile_unpack(tile_format f, const unsigned char *packed, size_t packed_bytes, unsigned char *scratch,
                      unsigned char *out_pixels);

/* A checksum of packed bytes. */
uint32_t tile_check(const unsigned char *packed, size_t packed_bytes);

#endif
