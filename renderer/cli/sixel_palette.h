/* sixel_palette.h: the colours that stand for all those of a picture, where a terminal has few.
 * Flow: pixels as they are shown -> [here] -> sixel. Threads: any. */
#ifndef AFTERGLOW_SIXEL_PALETTE_H
#define AFTERGLOW_SIXEL_PALETTE_H

#include <stdbool.h>
#include <stddef.h>

enum { SIXEL_LEVELS = 101, SIXEL_COLORS_MOST = 256 }; /* sixels give each channel in per cent */

typedef struct sixel_palette {
    unsigned char colors[SIXEL_COLORS_MOST][3]; /* RGB, per cent */
    int count;
} sixel_palette;

/* Finds at most color_count colours, 1 to 256, for the pixels: RGB, of which [0, 1] is shown. Where the picture has no
 * more colours, counted in whole per cent, they are its own; else boxes of colours are parted at their means, the one
 * with the largest squared error first. out_indices: one for each pixel. Returns false where there is no memory. */
bool sixel_palette_make(const float *pixels, size_t pixel_count, int color_count, sixel_palette *out,
                        unsigned char *out_indices);

#endif
