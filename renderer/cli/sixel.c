/* sixel.c: see sixel.h. */
#include "sixel.h"

#include "sixel_palette.h"

#include <stdlib.h>
#include <string.h>

enum { BAND = 6, SHORTEST_RUN = 4 }; /* rows; characters that a repetition saves */

/* A character for each column: which of its six pixels have the colour. */
static void write_run(FILE *file, unsigned char bits, int length)
{
    if (length >= SHORTEST_RUN) {
        fprintf(file, "!%d%c", length, '?' + bits);
        return;
    }
    while (length-- > 0)
        fputc('?' + bits, file);
}

static void write_color(FILE *file, const unsigned char *bits, int width)
{
    while (width > 0 && bits[width - 1] == 0)
        width--;
    for (int x = 0, begin = 0; x < width; x++)
        if (x + 1 == width || bits[x + 1] != bits[x]) {
            write_run(file, bits[x], x + 1 - begin);
            begin = x + 1;
        }
}

/* bits: of each colour, width of them, all 0 before and after. */
static void write_band(FILE *file, const unsigned char *indices, int width, int rows, int color_count,
                       unsigned char *bits)
{
    bool is_there[SIXEL_COLORS_MOST] = {false}, is_first = true;
    for (int y = 0; y < rows; y++)
        for (int x = 0; x < width; x++) {
            const unsigned char index = indices[(size_t)y * (size_t)width + (size_t)x];
            is_there[index] = true;
            bits[(size_t)index * (size_t)width + (size_t)x] |= (unsigned char)(1 << y);
        }
    for (int i = 0; i < color_count; i++) {
        if (!is_there[i])
            continue;
        unsigned char *own = bits + (size_t)i * (size_t)width;
        fprintf(file, "%s#%d", is_first ? "" : "$", i);
        write_color(file, own, width);
        memset(own, 0, (size_t)width);
        is_first = false;
    }
}

bool sixel_write(FILE *file, const float *pixels, int width, int height, int color_count)
{
    const size_t count = (size_t)width * (size_t)height;
    sixel_palette palette;
    unsigned char *indices = malloc(count), *bits = calloc((size_t)color_count, (size_t)width);
    const bool is_whole = indices && bits && sixel_palette_make(pixels, count, color_count, &palette, indices);
    if (is_whole) {
        fprintf(file, "\033P0;1;0q\"1;1;%d;%d", width, height); /* square pixels; what is not drawn stays */
        for (int i = 0; i < palette.count; i++)
            fprintf(file, "#%d;2;%d;%d;%d", i, palette.colors[i][0], palette.colors[i][1], palette.colors[i][2]);
        for (int y = 0; y < height; y += BAND) {
            if (y > 0)
                fputc('-', file);
            write_band(file, indices + (size_t)y * (size_t)width, width, height - y < BAND ? height - y : BAND,
                       palette.count, bits);
        }
        fputs("\033\\", file);
    }
    free(indices);
    free(bits);
    return is_whole;
}
