/* texture_tile_packing.c: see texture_tile_packing.h. A packed tile is:
 *
 *     shift      a byte: how many of the lowest bits are 0 in all values, and left out
 *     first      the first pixel's values, four bytes each
 *     widths     a byte for each group of values: the bits of each of its differences
 *     groups     for each lane the differences of its values, bit behind bit, in words of four bytes that lie lane
 *                beside lane */
#include "texture/texture_tile_packing.h"

#include "math/hash128.h"

#include <string.h>

enum { LANES = 4, WORD_BITS = 32, GROUP = LANES * WORD_BITS };

static size_t head_bytes(tile_format f)
{
    return 1 + f.channel_count * sizeof(uint32_t) + f.row_values * f.row_count / GROUP;
}

static uint32_t mask_of(uint32_t bits) { return UINT32_MAX >> (WORD_BITS - bits); }

/* --- differences --- */

/* Small numbers for small differences of either sign, of numbers of so many bits. */
static uint32_t fold(uint32_t difference, uint32_t bits)
{
    const uint32_t sign = 0u - (difference >> (bits - 1) & 1);
    return (difference << 1 ^ sign) & mask_of(bits);
}

static uint32_t unfold(uint32_t folded) { return folded >> 1 ^ (0u - (folded & 1)); }

static void widen(tile_format f, const unsigned char *pixels, uint32_t *out)
{
    const size_t count = f.row_values * f.row_count;
    if (f.value_bytes == 4)
        memcpy(out, pixels, count * sizeof *out);
    for (size_t k = 0; f.value_bytes == 1 && k < count; k++)
        out[k] = pixels[k];
    for (size_t k = 0; f.value_bytes == 2 && k < count; k++) {
        uint16_t two;
        memcpy(&two, pixels + 2 * k, sizeof two);
        out[k] = two;
    }
}

static void narrow(tile_format f, const uint32_t *values, unsigned char *out_pixels)
{
    const size_t count = f.row_values * f.row_count;
    if (f.value_bytes == 4)
        memcpy(out_pixels, values, count * sizeof *values);
    for (size_t k = 0; f.value_bytes == 1 && k < count; k++)
        out_pixels[k] = (unsigned char)values[k];
    for (size_t k = 0; f.value_bytes == 2 && k < count; k++) {
        const uint16_t two = (uint16_t)values[k];
        memcpy(out_pixels + 2 * k, &two, sizeof two);
    }
}

/* Differences from the pixel to the left, at the beginning of a row from that above, in place of the values; from the
 * end on, as each needs the values before it. The first pixel's become 0. */
static void subtract(tile_format f, uint32_t shift, uint32_t *values)
{
    const uint32_t bits = (uint32_t)f.value_bytes * 8 - shift;
    const size_t channels = f.channel_count;
    for (size_t row = f.row_count; row-- > 0;) {
        uint32_t *at = values + row * f.row_values;
        for (size_t x = f.row_values; x-- > channels;)
            at[x] = fold((at[x] >> shift) - (at[x - channels] >> shift), bits);
        for (size_t x = 0; x < channels; x++)
            at[x] = row > 0 ? fold((at[x] >> shift) - ((at - f.row_values)[x] >> shift), bits) : 0;
    }
}

/* Restores the values from the differences that subtract has put in their place. first: the first pixel's values, as
 * the packed tile has them. */
static void add_up(tile_format f, uint32_t shift, const unsigned char *first, uint32_t *values)
{
    const size_t channels = f.channel_count;
    for (size_t row = 0; row < f.row_count; row++) {
        uint32_t *at = values + row * f.row_values;
        for (size_t x = 0; x < channels && row == 0; x++)
            memcpy(&at[x], first + x * sizeof *at, sizeof *at);
        for (size_t x = 0; x < channels && row > 0; x++)
            at[x] = (at - f.row_values)[x] + (unfold(at[x]) << shift);
        for (size_t x = channels; x < f.row_values; x++)
            at[x] = at[x - channels] + (unfold(at[x]) << shift);
    }
}

/* --- groups --- */

static uint32_t width_of(const uint32_t *group)
{
    uint32_t any = 0, width = 0;
    for (int k = 0; k < GROUP; k++)
        any |= group[k];
    while (width < WORD_BITS && any >> width)
        width++;
    return width;
}

static size_t group_bytes(uint32_t width) { return (size_t)width * LANES * sizeof(uint32_t); }

static void pack_group(const uint32_t *group, uint32_t width, unsigned char *out)
{
    uint32_t words[LANES] = {0}, filled = 0;
    for (int k = 0; k < WORD_BITS; k++, group += LANES) {
        for (int lane = 0; lane < LANES; lane++)
            words[lane] |= group[lane] << filled;
        filled += width;
        if (filled < WORD_BITS)
            continue;
        memcpy(out, words, sizeof words);
        out += sizeof words;
        filled -= WORD_BITS;
        for (int lane = 0; lane < LANES; lane++) /* the bits that are left; by two steps, as none is no shift by 32 */
            words[lane] = filled > 0 ? group[lane] >> (width - filled) : 0;
    }
}

static void unpack_group(const unsigned char *packed, uint32_t width, uint32_t *out_group)
{
    const uint32_t mask = width > 0 ? mask_of(width) : 0;
    uint32_t words[LANES] = {0}, left = 0; /* bits of the words */
    for (int k = 0; k < WORD_BITS; k++, out_group += LANES) {
        uint32_t next[LANES];
        if (left >= width) {
            for (int lane = 0; lane < LANES; lane++)
                out_group[lane] = words[lane] & mask;
            left -= width;
            for (int lane = 0; lane < LANES; lane++)
                words[lane] = width < WORD_BITS ? words[lane] >> width : 0;
            continue;
        }
        memcpy(next, packed, sizeof next);
        packed += sizeof next;
        const uint32_t taken = width - left; /* of the next words */
        for (int lane = 0; lane < LANES; lane++) {
            out_group[lane] = (words[lane] | next[lane] << left) & mask;
            words[lane] = taken < WORD_BITS ? next[lane] >> taken : 0;
        }
        left = WORD_BITS - taken;
    }
}

/* --- tiles --- */

static uint32_t shift_of(tile_format f, const uint32_t *values)
{
    uint32_t any = 0, shift = 0;
    for (size_t k = 0; k < f.row_values * f.row_count; k++)
        any |= values[k];
    while (shift < 8 * f.value_bytes - 1 && !(any >> shift & 1))
        shift++;
    return shift;
}

size_t tile_pack(tile_format f, const unsigned char *pixels, uint32_t *scratch, unsigned char *out)
{
    const size_t size = tile_format_bytes(f), head = head_bytes(f), groups = f.row_values * f.row_count / GROUP;
    unsigned char *widths = out + head - groups;
    size_t packed_bytes = head;
    widen(f, pixels, scratch);
    const uint32_t shift = shift_of(f, scratch);
    out[0] = (unsigned char)shift;
    memcpy(out + 1, scratch, f.channel_count * sizeof *scratch);
    subtract(f, shift, scratch);
    for (size_t k = 0; k < groups; k++) {
        widths[k] = (unsigned char)width_of(scratch + k * GROUP);
        packed_bytes += group_bytes(widths[k]);
    }
    if (packed_bytes > size - size / 8) {
        memcpy(out, pixels, size);
        return size;
    }
    out += head;
    for (size_t k = 0; k < groups; k++) {
        pack_group(scratch + k * GROUP, widths[k], out);
        out += group_bytes(widths[k]);
    }
    return packed_bytes;
}

ag_status tile_unpack(tile_format f, const unsigned char *packed, size_t packed_bytes, uint32_t *scratch,
                      unsigned char *out_pixels)
{
    const size_t size = tile_format_bytes(f), head = head_bytes(f), groups = f.row_values * f.row_count / GROUP;
    if (packed_bytes == size) {
        memcpy(out_pixels, packed, size);
        return AG_OK;
    }
    if (packed_bytes < head || packed[0] >= 8 * f.value_bytes)
        return AG_ERROR_SYSTEM;
    const unsigned char *widths = packed + head - groups, *next = packed + head;
    size_t expected = head;
    for (size_t k = 0; k < groups; k++) {
        if (widths[k] > 8 * f.value_bytes)
            return AG_ERROR_SYSTEM;
        expected += group_bytes(widths[k]);
    }
    if (expected != packed_bytes)
        return AG_ERROR_SYSTEM;
    for (size_t k = 0; k < groups; k++) {
        unpack_group(next, widths[k], scratch + k * GROUP);
        next += group_bytes(widths[k]);
    }
    add_up(f, packed[0], packed + 1, scratch);
    narrow(f, scratch, out_pixels);
    return AG_OK;
}

uint32_t tile_check(const unsigned char *packed, size_t packed_bytes)
{
    hash128 h = hash128_begin();
    hash128_add(&h, packed, packed_bytes);
    return (uint32_t)h.bits[0];
}
