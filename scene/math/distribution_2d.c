/* distribution_2d.c: see distribution_2d.h. */
#include "math/distribution_2d.h"

#include <stdlib.h>

/* Running sums of the weights over their total, which it returns; exactly 1 from the last weight on. */
static double accumulate(const float *weights, const double *sums, uint32_t count, float *out_cdf)
{
    double total = 0.0, sum = 0.0;
    uint32_t last = 0; /* behind the last cell that has weight */
    for (uint32_t i = 0; i < count; i++) {
        double weight = weights ? (double)weights[i] : sums[i];
        total += weight;
        if (weight > 0.0)
            last = i + 1;
    }
    out_cdf[0] = 0.0f;
    for (uint32_t i = 0; i < count; i++) {
        sum += weights ? (double)weights[i] : sums[i];
        out_cdf[i + 1] = !(total > 0.0) ? 0.0f : i + 1 >= last ? 1.0f : (float)(sum / total);
    }
    return total;
}

ag_status distribution_2d_create(uint32_t width, uint32_t height, const float *weights,
                                 distribution_2d *out_distribution)
{
    distribution_2d d = {width, height, NULL, NULL};
    double *sums = malloc(height * sizeof *sums);
    d.row_cdf = malloc(((size_t)height + 1) * sizeof *d.row_cdf);
    d.cell_cdf = malloc((size_t)height * ((size_t)width + 1) * sizeof *d.cell_cdf);
    if (!sums || !d.row_cdf || !d.cell_cdf) {
        free(sums);
        distribution_2d_reset(&d);
        *out_distribution = d;
        return AG_ERROR_MEMORY;
    }
    for (uint32_t y = 0; y < height; y++)
        sums[y] = accumulate(weights + (size_t)y * width, NULL, width, d.cell_cdf + (size_t)y * (width + 1));
    accumulate(NULL, sums, height, d.row_cdf);
    free(sums);
    *out_distribution = d;
    return AG_OK;
}

void distribution_2d_reset(distribution_2d *d)
{
    free(d->row_cdf);
    free(d->cell_cdf);
    *d = (distribution_2d){0};
}

/* The cell whose share of [0, 1) u is in, and where in it. */
static uint32_t find(const float *cdf, uint32_t count, float u, float *out_within)
{
    uint32_t low = 0, high = count - 1;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (cdf[middle + 1] > u)
            high = middle;
        else
            low = middle + 1;
    }
    *out_within = float_below_one((u - cdf[low]) / (cdf[low + 1] - cdf[low]));
    return low;
}

bool distribution_2d_pick(const distribution_2d *d, vec2 u, distribution_2d_sample *out_sample)
{
    if (!(d->row_cdf[d->height] > 0.0f))
        return false;
    out_sample->y = find(d->row_cdf, d->height, u.y, &out_sample->within.y);
    out_sample->x = find(d->cell_cdf + (size_t)out_sample->y * (d->width + 1), d->width, u.x, &out_sample->within.x);
    out_sample->probability = distribution_2d_probability(d, out_sample->x, out_sample->y);
    return out_sample->probability > 0.0f;
}
