/* terminal_picture.h: a picture for a terminal, in its place above the cursor's line: as half blocks (U+2580), each two
 * pixels, one above the other, in 24-bit colours (ISO/IEC 8613-6), or as sixels.
 * Flow: pixels as they are shown -> [here] -> film_watch. Threads: the caller's. */
#ifndef AFTERGLOW_TERMINAL_PICTURE_H
#define AFTERGLOW_TERMINAL_PICTURE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* A terminal's size in characters, and of each in pixels; 0: not told. */
typedef struct terminal_size {
    int columns, rows, cell_width, cell_height;
} terminal_size;

/* Returns why no picture can be shown there, NULL: one can. */
const char *terminal_picture_obstacle(int descriptor);
/* Finds the terminal's size. Returns false where it is not known, or too small for a picture. */
bool terminal_picture_room(int descriptor, terminal_size *out_size);

/* Computes the picture's size in half blocks, or for sixels in pixels, for which the size of a character must be known.
 * It is at most the picture's own, and leaves the terminal's last column and last two rows free. */
void terminal_picture_fit(int width, int height, const terminal_size *terminal, bool is_by_sixels, int *out_width,
                          int *out_height);

/* Computes the means of the pixels under each half block or sixel; pixels: RGB, top row first. out_means: 3 * out_width
 * * out_height. */
void terminal_picture_reduce(const float *pixels, int width, int height, float *out_means, int out_width,
                             int out_height);

/* Writes the rows, each ended by the attributes' reset and a line feed. shown: RGB, of which [0, 1] is what the
 * terminal can show. Gives the number of rows. */
int terminal_picture_write(FILE *file, const float *shown, int width, int height);

/* Puts the picture by sixels of so many colours (sixel.h) into the rows above the cursor's line: over the drawn_rows
 * that stand there if they are as many as it needs, else, where there are none, into new ones. Gives the number of
 * rows; 0: there is no memory, and nothing is written. */
int terminal_picture_write_sixels(FILE *file, const float *shown, int width, int height, const terminal_size *terminal,
                                  int color_count, int drawn_rows);

/* Writes the codes that remove rows above the cursor's line, and what stands on that line. */
void terminal_picture_erase(FILE *file, int rows);

#endif
