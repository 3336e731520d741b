/* sixel.h: a picture as sixels, DEC's graphics for terminals: columns of six pixels, colour by colour.
 * Flow: pixels as they are shown -> sixel_palette -> [here] -> film_watch. Threads: any. */
#ifndef AFTERGLOW_SIXEL_H
#define AFTERGLOW_SIXEL_H

#include <stdbool.h>
#include <stdio.h>

enum { SIXEL_BYTES_PER_PIXEL = 32 }; /* about what the picture and its text take */

/* Writes the picture where the cursor stands; its place afterwards is the terminal's choice. pixels: RGB, of which
 * [0, 1] is shown, top row first; color_count: 1 to 256. False: there is no memory, and nothing is written. */
bool sixel_write(FILE *file, const float *pixels, int width, int height, int color_count);

#endif
