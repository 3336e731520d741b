/* pair_error.c: see pair_error.h. */
#include "bench/pair_error.h"

#include <math.h>
#include <stdlib.h>

/* The error of one pixel, the mean over its colours. */
typedef struct pixel_error {
    double measured; /* against the reference, whose own variance is in it */
    double variance, reference_variance;
} pixel_error;

static int compare_measured(const void *a, const void *b)
{
    double x = ((const pixel_error *)a)->measured, y = ((const pixel_error *)b)->measured;
    return (x > y) - (x < y);
}

static pair_error mean_of(const pixel_error *errors, size_t count)
{
    double measured = 0.0, variance = 0.0, reference_variance = 0.0;
    for (size_t i = 0; i < count; i++) {
        measured += errors[i].measured;
        variance += errors[i].variance;
        reference_variance += errors[i].reference_variance;
    }
    double error = (measured - reference_variance) / (double)count, own = variance / (double)count;
    return (pair_error){error, own, error - own};
}

bool pair_errors_of(const float *a, const float *b, const float *r1, const float *r2, size_t pixel_count,
                    double left_out, pair_errors *out)
{
    double sum = 0.0, reference_sum = 0.0;
    for (size_t i = 0; i < 3 * pixel_count; i++) {
        sum += ((double)a[i] + (double)b[i]) / 2.0;
        reference_sum += ((double)r1[i] + (double)r2[i]) / 2.0;
    }
    pixel_error *errors = calloc(pixel_count + 1, sizeof *errors);
    if (!errors || !isfinite(sum) || !isfinite(reference_sum) || pixel_count == 0) {
        free(errors);
        return false;
    }
    double mean = reference_sum / (3.0 * (double)pixel_count);
    for (size_t i = 0; i < 3 * pixel_count; i++) {
        double reference = ((double)r1[i] + (double)r2[i]) / 2.0, from_a = (double)a[i] - reference,
               from_b = (double)b[i] - reference, apart = (double)a[i] - (double)b[i],
               reference_apart = (double)r1[i] - (double)r2[i];
        double weight = 1.0 / (3.0 * (reference * reference + 0.01 * mean * mean));
        if (!isfinite(weight)) /* a black reference has nothing to compare with */
            weight = 0.0;
        pixel_error *e = &errors[i / 3];
        e->measured += weight * (from_a * from_a + from_b * from_b) / 2.0;
        e->variance += weight * apart * apart / 2.0;
        e->reference_variance += weight * reference_apart * reference_apart / 4.0;
    }
    out->whole = mean_of(errors, pixel_count);
    qsort(errors, pixel_count, sizeof *errors, compare_measured);
    out->trimmed = mean_of(errors, pixel_count - (size_t)(left_out * (double)pixel_count));
    out->mean_ratio = sum / reference_sum;
    free(errors);
    return true;
}
