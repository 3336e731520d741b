/* picture_error.c: the program afterglow-picture-error: how far a picture is from another one: pixels that differ in
 * any bit, the relative mean square error, and the ratio of the means; as CSV. The error of a channel of a pixel is
 * (picture - reference)^2 / (reference^2 + (mean / 100)^2), the mean that of the reference: without a unit, and finite
 * where the reference is black. The picture's own noise and its bias are both in it; that of the reference too, so it
 * is to be far longer than what is held against it. Flow: error_against_time.sh, thread_scaling.sh -> [here]. Threads:
 * one. */
#include "image/image_reader.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static bool read_picture(const char *path, image *out_picture)
{
    char message[512] = "";
    if (image_read(path, out_picture, message, sizeof message) == AG_OK)
        return true;
    fprintf(stderr, "%s: error: %s\n", path, message);
    return false;
}

int main(int argc, char **argv)
{
    if (argc != 3) {
        fputs("usage: afterglow-picture-error PICTURE REFERENCE\n"
              "Prints: differing pixels, relative mean square error, mean / mean of the reference.\n",
              stderr);
        return 2;
    }
    image picture = {0}, reference = {0};
    int exit_code = 1;
    if (read_picture(argv[1], &picture) && read_picture(argv[2], &reference)) {
        if (picture.width != reference.width || picture.height != reference.height || picture.channel_count < 3 ||
            reference.channel_count < 3) {
            fprintf(stderr, "%s: error: not of the shape of %s, or not in colour\n", argv[1], argv[2]);
        } else {
            size_t pixels = (size_t)picture.width * (size_t)picture.height, differing = 0;
            size_t step = (size_t)picture.channel_count, reference_step = (size_t)reference.channel_count;
            double sum = 0.0, reference_sum = 0.0, error = 0.0;
            for (size_t i = 0; i < pixels; i++)
                for (size_t c = 0; c < 3; c++) {
                    sum += (double)picture.pixels[i * step + c];
                    reference_sum += (double)reference.pixels[i * reference_step + c];
                }
            double floor = 0.01 * reference_sum / (3.0 * (double)pixels);
            for (size_t i = 0; i < pixels; i++) {
                const float *a = picture.pixels + i * step, *b = reference.pixels + i * reference_step;
                differing += memcmp(a, b, 3 * sizeof *a) != 0;
                for (size_t c = 0; c < 3; c++) {
                    double difference = (double)a[c] - (double)b[c];
                    error += difference * difference / ((double)b[c] * (double)b[c] + floor * floor);
                }
            }
            printf("%zu,%.6g,%.6g\n", differing, error / (3.0 * (double)pixels), sum / reference_sum);
            exit_code = 0;
        }
    }
    image_reset(&picture);
    image_reset(&reference);
    return exit_code;
}
