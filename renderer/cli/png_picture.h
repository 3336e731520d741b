/* png_picture.h: a picture as the bytes of a PNG file, 8 bits a channel, quickly: for who looks on.
 * Rests on: PNG Specification, 3rd edition (W3C, 2023). Flow: page_picture -> [here]. Threads: pure functions. */
#ifndef AFTERGLOW_PNG_PICTURE_H
#define AFTERGLOW_PNG_PICTURE_H

#include <stddef.h>

/* Makes a PNG file in memory. pixels: 3 floats each, of which [0, 1] is shown, rounded as ag_film_write does it; top
 * row first. The bytes are to be freed; NULL: no memory. */
unsigned char *png_picture_encode(const float *pixels, int width, int height, size_t *out_size);

#endif
