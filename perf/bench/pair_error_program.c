/* pair_error_program.c: the program afterglow-pair-error: what pair_error.h tells of four picture files, as CSV.
 * Flow: equal_error.py -> [here]. Threads: one. */
#include "bench/pair_error.h"
#include "image/image_reader.h"

#include <stdio.h>
#include <stdlib.h>

static const double LEFT_OUT = 0.01;

/* Returns the picture's first three channels, packed; NULL where it cannot be had. */
static float *read_colors(const char *path, int *in_out_width, int *in_out_height)
{
    char message[512] = "";
    image read = {0};
    if (image_read(path, &read, message, sizeof message) != AG_OK) {
        fprintf(stderr, "%s: error: %s\n", path, message);
        return NULL;
    }
    size_t pixels = (size_t)read.width * (size_t)read.height, step = (size_t)read.channel_count;
    bool fits = step >= 3 && (*in_out_width == 0 || (*in_out_width == read.width && *in_out_height == read.height));
    float *colors = fits ? malloc((pixels + 1) * 3 * sizeof *colors) : NULL;
    if (!fits)
        fprintf(stderr, "%s: error: not of the shape of the other pictures, or not in colour\n", path);
    for (size_t i = 0; colors && i < 3 * pixels; i++)
        colors[i] = read.pixels[i / 3 * step + i % 3];
    *in_out_width = read.width;
    *in_out_height = read.height;
    image_reset(&read);
    return colors;
}

int main(int argc, char **argv)
{
    if (argc != 5) {
        fputs(
            "usage: afterglow-pair-error PICTURE PICTURE REFERENCE REFERENCE\n"
            "Of two pictures of different seeds against two halves of a reference, relative: mean square error, variance,\n"
            "squared bias; the same without the worst hundredth of the pixels; mean / mean of the reference.\n",
            stderr);
        return 2;
    }
    float *colors[4] = {NULL};
    int width = 0, height = 0, count = 0;
    while (count < 4 && (colors[count] = read_colors(argv[count + 1], &width, &height)) != NULL)
        count++;
    pair_errors e;
    int exit_code = 1;
    if (count == 4) {
        size_t pixels = (size_t)width * (size_t)height;
        if (pair_errors_of(colors[0], colors[1], colors[2], colors[3], pixels, LEFT_OUT, &e)) {
            printf("%.8g,%.8g,%.8g,%.8g,%.8g,%.8g,%.8g\n", e.whole.error, e.whole.variance, e.whole.bias_squared,
                   e.trimmed.error, e.trimmed.variance, e.trimmed.bias_squared, e.mean_ratio);
            exit_code = 0;
        } else {
            fprintf(stderr, "%s: error: a pixel of it, or of a picture beside it, is not a finite number\n", argv[1]);
        }
    }
    for (int i = 0; i < 4; i++)
        free(colors[i]);
    return exit_code;
}
