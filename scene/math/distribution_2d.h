/* distribution_2d.h: picks cells of a grid in proportion to weights: a row by the rows' sums, then a cell of the row.
 * Rests on: Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, appendix A.5 (inversion in two
 * steps); Chen, Asau, "On Generating Random Variates from an Empirical Distribution", 1974 (a table of where searches
 * begin). Neighbouring random numbers pick neighbouring cells, so samples that are well spread stay so. Threads:
 * read-only once created. */
#ifndef AFTERGLOW_DISTRIBUTION_2D_H
#define AFTERGLOW_DISTRIBUTION_2D_H

#include "afterglow/base.h"
#include "math/vec3.h"

#include <stddef.h>
#include <stdint.h>

typedef struct distribution_2d {
    uint32_t width, height;
    float *row_cdf;  /* [height + 1], from 0 to 1; owned */
    float *cell_cdf; /* [height][width + 1], likewise, of each row; owned */
    /* For equal parts of [0, 1), a power of two of them, the first row or cell that numbers there can pick; behind the
     * last part the last row or cell; owned. */
    uint32_t row_parts, cell_parts;
    uint16_t *first_rows;  /* [row_parts + 1] */
    uint16_t *first_cells; /* [height][cell_parts + 1] */
    /* The owner may set here what it reads of each cell that is picked, [height][width] of value_bytes, borrowed;
     * distribution_2d_pick then fetches that while it still looks for the cell. NULL: it fetches nothing. */
    const void *values;
    size_t value_bytes;
} distribution_2d;

/* A cell and a point in it, of [0,1)^2. */
typedef struct distribution_2d_sample {
    uint32_t x, y;
    vec2 within;       /* in the cell, [0,1)^2 */
    float probability; /* of the cell, > 0 */
} distribution_2d_sample;

/* weights: [height][width], finite and not negative. width, height: from 1 to 65535. Errors: AG_ERROR_MEMORY. */
ag_status distribution_2d_create(uint32_t width, uint32_t height, const float *weights,
                                 distribution_2d *out_distribution);
void distribution_2d_reset(distribution_2d *d);

/* u in [0,1)^2. false where all weights are 0. Cells without weight are never picked. */
bool distribution_2d_pick(const distribution_2d *d, vec2 u, distribution_2d_sample *out_sample);

/* The probability with which the cell is picked, as its sums are rounded. */
static inline float distribution_2d_probability(const distribution_2d *d, uint32_t x, uint32_t y)
{
    const float *cells = d->cell_cdf + (size_t)y * (d->width + 1);
    return (d->row_cdf[y + 1] - d->row_cdf[y]) * (cells[x + 1] - cells[x]);
}

/* The numbers for which distribution_2d_pick gives that point in the cell, up to rounding. */
static inline vec2 distribution_2d_numbers(const distribution_2d *d, uint32_t x, uint32_t y, vec2 within)
{
    const float *rows = d->row_cdf + y, *cells = d->cell_cdf + (size_t)y * (d->width + 1) + x;
    return (vec2){float_below_one(cells[0] + within.x * (cells[1] - cells[0])),
                  float_below_one(rows[0] + within.y * (rows[1] - rows[0]))};
}

#endif
