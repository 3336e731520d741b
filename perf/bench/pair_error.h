/* pair_error.h: how far a renderer's pictures are from the truth, of two pictures of different seeds and two of the
 * truth. Rests on: E[(a - b)^2] / 2 is the variance of either of two independent pictures; of the mean of two
 * references E[(r1 - r2)^2] / 4 is the variance, which is taken off what is measured against it. Flow: pictures ->
 * [here] -> equal_error.py. Threads: plain functions.
 *
 * Errors are relative: of each colour of a pixel squared, over the reference squared and a hundredth of the square of
 * the reference's mean, so that black pixels weigh no more than dark ones. */
#ifndef AFTERGLOW_PAIR_ERROR_H
#define AFTERGLOW_PAIR_ERROR_H

#include <stdbool.h>
#include <stddef.h>

/* Means over pixels and colours: error = variance + bias squared. The latter may come out below 0 where there is
 * none. */
typedef struct pair_error {
    double error, variance, bias_squared;
} pair_error;

typedef struct pair_errors {
    pair_error whole, trimmed; /* the latter without the pixels of the largest error */
    double mean_ratio;         /* of the pair's mean to the references' */
} pair_errors;

/* a, b: pictures of two seeds; r1, r2: two halves of the reference; packed RGB. left_out: share of the pixels, [0, 1),
 * rounded down to whole ones. false: a value is not finite, or out of memory. */
bool pair_errors_of(const float *a, const float *b, const float *r1, const float *r2, size_t pixel_count,
                    double left_out, pair_errors *out);

#endif
