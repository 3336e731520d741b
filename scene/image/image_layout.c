/* image_layout.c: see image_layout.h. */
#include "image/image_layout.h"

#include <stddef.h>
#include <string.h>
#include <strings.h>

enum { LARGEST_TILE_BITS = 9 }; /* TEXTURE_TILE_BITS_MAX, as the test of this file holds */
enum { LEAST_TILE_BITS = 3 };   /* reading smaller ones one by one costs more than their pixels are worth */

/* Returns how many of the first channels are red, green, blue and alpha of one layer, by their names. */
static int count_colors(const char *const *names, int count)
{
    static const char *const SUFFIXES[4][2] = {{"R", "RED"}, {"G", "GREEN"}, {"B", "BLUE"}, {"A", "ALPHA"}};
    size_t layer_length = 0; /* 0: the channels are of no layer */
    int k = 0;
    for (; k < 4 && k < count; k++) {
        const char *dot = strrchr(names[k], '.'), *last = dot ? dot + 1 : names[k];
        const size_t length = dot ? (size_t)(dot - names[k]) : 0;
        if (k > 0 && (length != layer_length || strncmp(names[k], names[0], length) != 0))
            break;
        layer_length = length;
        if (strcasecmp(last, SUFFIXES[k][0]) != 0 && strcasecmp(last, SUFFIXES[k][1]) != 0)
            break;
    }
    return k;
}

int image_layout_find_colors(const char *const *names, int count, int *out_begin)
{
    for (int first = 0; first + 3 <= count; first++) {
        const int colors = count_colors(names + first, count - first);
        if (colors >= 3) {
            *out_begin = first;
            return colors;
        }
    }
    *out_begin = 0;
    return 0;
}

int image_layout_exr_rows(const char *compression)
{
    static const struct {
        const char *compression;
        int rows;
    } ROWS[] = {{"none", 1}, {"rle", 1},  {"zips", 1},  {"zip", 16}, {"pxr24", 16},
                {"piz", 32}, {"b44", 32}, {"b44a", 32}, {"dwaa", 32}};
    for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++)
        if (strcmp(compression, ROWS[i].compression) == 0)
            return ROWS[i].rows;
    return 256;
}

int image_layout_tile_bits(int side)
{
    for (int bits = 0; bits <= LARGEST_TILE_BITS; bits++)
        if (side == 1 << bits)
            return bits;
    return -1;
}

bool image_layout_is_usable_tile(int tile_side, int level_side)
{
    const int bits = image_layout_tile_bits(tile_side);
    return bits >= LEAST_TILE_BITS || (bits >= 0 && level_side <= tile_side);
}

bool image_layout_is_half(int side, int before)
{
    const int down = before / 2 > 1 ? before / 2 : 1;
    return side == down || side == (before + 1) / 2;
}
