/* distribution_2d.c: see distribution_2d.h. */
#include "math/distribution_2d.h"

#include <assert.h>
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

/* About two cells to a part. */
static uint32_t part_count(uint32_t count)
{
    uint32_t parts = 1;
    while (parts < count / 2)
        parts *= 2;
    return parts;
}

static void fill_first(const float *cdf, uint32_t count, uint32_t parts, uint16_t *out_first)
{
    uint32_t i = 0;
    for (uint32_t part = 0; part < parts; part++) {
        while (i < count - 1 && !(cdf[i + 1] > (float)part / (float)parts))
            i++;
        out_first[part] = (uint16_t)i;
    }
    out_first[parts] = (uint16_t)(count - 1);
}

ag_status distribution_2d_create(uint32_t width, uint32_t height, const float *weights,
                                 distribution_2d *out_distribution)
{
    distribution_2d d = {
        .width = width, .height = height, .row_parts = part_count(height), .cell_parts = part_count(width)};
    double *sums = malloc(height * sizeof *sums);
    d.row_cdf = malloc(((size_t)height + 1) * sizeof *d.row_cdf);
    d.cell_cdf = malloc((size_t)height * ((size_t)width + 1) * sizeof *d.cell_cdf);
    d.first_rows = malloc(((size_t)d.row_parts + 1) * sizeof *d.first_rows);
    d.first_cells = malloc((size_t)height * ((size_t)d.cell_parts + 1) * sizeof *d.first_cells);
    if (!sums || !d.row_cdf || !d.cell_cdf || !d.first_rows || !d.first_cells) {
        free(sums);
        distribution_2d_reset(&d);
        *out_distribution = d;
        return AG_ERROR_MEMORY;
    }
    for (uint32_t y = 0; y < height; y++) {
        float *cdf = d.cell_cdf + (size_t)y * (width + 1);
        sums[y] = accumulate(weights + (size_t)y * width, NULL, width, cdf);
        fill_first(cdf, width, d.cell_parts, d.first_cells + (size_t)y * (d.cell_parts + 1));
    }
    accumulate(NULL, sums, height, d.row_cdf);
    fill_first(d.row_cdf, height, d.row_parts, d.first_rows);
    free(sums);
    *out_distribution = d;
    return AG_OK;
}

void distribution_2d_reset(distribution_2d *d)
{
    free(d->row_cdf);
    free(d->cell_cdf);
    free(d->first_rows);
    free(d->first_cells);
    *d = (distribution_2d){0};
}

/* The cell whose share of [0, 1) u is in, and where in it. values: of the first cell; NULL: none. */
static uint32_t find(const float *cdf, const uint16_t *first, uint32_t parts, float u, const char *values,
                     size_t value_bytes, float *out_within)
{
    assert(u >= 0.0f && u < 1.0f);
    const uint32_t part = (uint32_t)(u * (float)parts); /* exact: parts is a power of two */
    uint32_t low = first[part], high = first[part + 1];
    if (values)
        __builtin_prefetch(values + low * value_bytes);
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
    const size_t y = find(d->row_cdf, d->first_rows, d->row_parts, u.y, NULL, 0, &out_sample->within.y);
    const char *values = d->values ? (const char *)d->values + y * d->width * d->value_bytes : NULL;
    out_sample->y = (uint32_t)y;
    out_sample->x = find(d->cell_cdf + y * (d->width + 1), d->first_cells + y * (d->cell_parts + 1), d->cell_parts, u.x,
                         values, d->value_bytes, &out_sample->within.x);
    out_sample->probability = distribution_2d_probability(d, out_sample->x, out_sample->y);
    return out_sample->probability > 0.0f;
}
