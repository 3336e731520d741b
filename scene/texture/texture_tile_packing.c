/* texture_tile_packing.c: see texture_tile_packing.h. */
#include "texture/texture_tile_packing.h"

#include <stdbool.h>
#include <stdint.h>
#include <string.h>
#include <zlib.h>

static uint32_t value_at(const unsigned char *pixels, size_t at, size_t value_bytes)
{
    uint16_t two;
    uint32_t four;
    switch (value_bytes) {
    case 1: return pixels[at];
    case 2: memcpy(&two, pixels + 2 * at, 2); return two;
    default: memcpy(&four, pixels + 4 * at, 4); return four;
    }
}

static void set_value(unsigned char *pixels, size_t at, size_t value_bytes, uint32_t value)
{
    const uint16_t two = (uint16_t)value;
    switch (value_bytes) {
    case 1: pixels[at] = (unsigned char)value; break;
    case 2: memcpy(pixels + 2 * at, &two, 2); break;
    default: memcpy(pixels + 4 * at, &value, 4); break;
    }
}

/* The value before: of the pixel to the left, at the beginning of a row above; 0 at the very first. */
static uint32_t value_before(const unsigned char *pixels, tile_format f, size_t row, size_t x)
{
    const size_t at = row * f.row_values + x;
    if (x >= f.channel_count)
        return value_at(pixels, at - f.channel_count, f.value_bytes);
    return row > 0 ? value_at(pixels, at - f.row_values, f.value_bytes) : 0;
}

/* Differences, a plane for each byte of theirs. */
static void filter(tile_format f, const unsigned char *pixels, unsigned char *planes)
{
    const size_t count = f.row_values * f.row_count;
    for (size_t row = 0; row < f.row_count; row++)
        for (size_t x = 0; x < f.row_values; x++) {
            const size_t at = row * f.row_values + x;
            const uint32_t difference = value_at(pixels, at, f.value_bytes) - value_before(pixels, f, row, x);
            for (size_t byte = 0; byte < f.value_bytes; byte++)
                planes[byte * count + at] = (unsigned char)(difference >> 8 * byte);
        }
}

static void unfilter(tile_format f, const unsigned char *planes, unsigned char *pixels)
{
    const size_t count = f.row_values * f.row_count;
    for (size_t row = 0; row < f.row_count; row++)
        for (size_t x = 0; x < f.row_values; x++) {
            const size_t at = row * f.row_values + x;
            uint32_t difference = 0;
            for (size_t byte = 0; byte < f.value_bytes; byte++)
                difference |= (uint32_t)planes[byte * count + at] << 8 * byte;
            set_value(pixels, at, f.value_bytes, difference + value_before(pixels, f, row, x));
        }
}

size_t tile_pack(tile_format f, const unsigned char *pixels, unsigned char *scratch, unsigned char *out)
{
    const size_t size = tile_format_bytes(f);
    z_stream z = {.next_in = scratch, .avail_in = (uInt)size, .next_out = out, .avail_out = (uInt)(size / 2)};
    enum { LEVEL = 1, WINDOW_BITS = 9, MEMORY_LEVEL = 8 }; /* runs need no window */
    if (deflateInit2(&z, LEVEL, Z_DEFLATED, WINDOW_BITS, MEMORY_LEVEL, Z_RLE) != Z_OK)
        return 0;
    filter(f, pixels, scratch);
    const bool is_smaller = deflate(&z, Z_FINISH) == Z_STREAM_END;
    const size_t packed_bytes = (size_t)z.total_out;
    deflateEnd(&z);
    if (is_smaller)
        return packed_bytes;
    memcpy(out, pixels, size);
    return size;
}

ag_status tile_unpack(tile_format f, const unsigned char *packed, size_t packed_bytes, unsigned char *scratch,
                      unsigned char *out_pixels)
{
    const size_t size = tile_format_bytes(f);
    uLongf unpacked = (uLongf)size;
    if (packed_bytes == size) {
        memcpy(out_pixels, packed, size);
        return AG_OK;
    }
    const int result = uncompress(scratch, &unpacked, packed, (uLong)packed_bytes);
    if (result != Z_OK || unpacked != size)
        return result == Z_MEM_ERROR ? AG_ERROR_MEMORY : AG_ERROR_SYSTEM;
    unfilter(f, scratch, out_pixels);
    return AG_OK;
}

uint32_t tile_check(const unsigned char *packed, size_t packed_bytes)
{
    return (uint32_t)crc32(0, packed, (uInt)packed_bytes);
}
