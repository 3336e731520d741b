/* png_picture.c: see png_picture.h. */
#include "png_picture.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum { LEVEL = 1, HEAD = 8 + 25 + 8, TAIL = 4 + 12 }; /* bytes in front of the packed rows, and behind them */

static void put_u32(unsigned char *out, size_t value)
{
    for (int i = 0; i < 4; i++)
        out[i] = (unsigned char)(value >> (24 - 8 * i));
}

/* The checksum behind a chunk's data, over its type and them. */
static void end_chunk(unsigned char *type, size_t data_size)
{
    put_u32(type + 4 + data_size, crc32(crc32(0, NULL, 0), type, (uInt)(4 + data_size)));
}

static unsigned char byte_of(float value)
{
    const float scaled = value * 255.0f + 0.5f;
    return scaled >= 255.0f ? 255 : scaled > 0.0f ? (unsigned char)scaled : 0;
}

/* Each row is the difference to the row above ("Up"), which a view's even areas pack well by. */
static void filter_rows(const float *pixels, int width, int height, unsigned char *out)
{
    const size_t row = 3 * (size_t)width;
    for (size_t y = 0; y < (size_t)height; y++) {
        *out++ = 2;
        for (size_t i = 0; i < row; i++) {
            const unsigned above = y > 0 ? byte_of(pixels[(y - 1) * row + i]) : 0;
            *out++ = (unsigned char)(byte_of(pixels[y * row + i]) - above);
        }
    }
}

unsigned char *png_picture_encode(const float *pixels, int width, int height, size_t *out_size)
{
    static const unsigned char SIGNATURE[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    const size_t raw_size = (1 + 3 * (size_t)width) * (size_t)height;
    uLongf size = compressBound((uLong)raw_size);
    unsigned char *raw = malloc(raw_size), *out = malloc(HEAD + size + TAIL);
    const bool is_whole = raw && out && size <= UINT32_MAX / 2;
    if (is_whole)
        filter_rows(pixels, width, height, raw);
    if (!is_whole || compress2(out + HEAD, &size, raw, (uLong)raw_size, LEVEL) != Z_OK) {
        free(raw);
        free(out);
        return NULL;
    }
    free(raw);
    memcpy(out, SIGNATURE, sizeof SIGNATURE);
    unsigned char *header = out + 8;
    put_u32(header, 13);
    memcpy(header + 4, "IHDR", 4);
    put_u32(header + 8, (size_t)width);
    put_u32(header + 12, (size_t)height);
    memcpy(header + 16, "\x08\x02\x00\x00\x00", 5); /* 8 bits, RGB, the usual packing and filter, not interlaced */
    end_chunk(header + 4, 13);
    unsigned char *data = header + 25;
    put_u32(data, size);
    memcpy(data + 4, "IDAT", 4);
    end_chunk(data + 4, size);
    unsigned char *end = data + 12 + size;
    put_u32(end, 0);
    memcpy(end + 4, "IEND", 4);
    end_chunk(end + 4, 0);
    *out_size = (size_t)(end + 12 - out);
    return out;
}
