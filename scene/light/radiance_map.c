/* radiance_map.c: see radiance_map.h. */
#include "light/radiance_map.h"

#include "light/lamp_value.h"
#include "scene.h"

#include <stdlib.h>

enum { SIZE = 64, LOOKS = 16 * SIZE * SIZE }; /* cells along a side; points looked at */
/* The share of the mean of all cells that even a black one keeps, so that nothing is missed between the points looked
 * at. */
static const double FLOOR = 0.1;

/* Looks at points of a lattice by the golden ratio: no two alike in either number, so that meshes of many triangles are
 * looked at everywhere. Gives the sum of its values, and of its mean channel in each cell. */
static void look(const scene *s, const light *l, double out_sum[3], double out_cells[SIZE * SIZE],
                 uint32_t out_counts[SIZE * SIZE])
{
    const shape *lamp = &s->shapes[l->as.area.shape_index];
    for (uint32_t k = 0; k < LOOKS; k++) {
        double turn = k * 0.61803398874989485;
        vec2 u = {((float)k + 0.5f) / LOOKS, float_below_one((float)(turn - floor(turn)))};
        surface_sample at = shape_sample_area(lamp, u);
        rgb c = lamp_sampled_value(s, l, &at);
        /* ellipsoids are not sampled evenly: the weight undoes that */
        double weight = 1.0 / ((double)at.pdf_area * (double)lamp->area);
        uint32_t cell = (uint32_t)(u.y * SIZE) * SIZE + (uint32_t)(u.x * SIZE);
        out_sum[0] += weight * (double)c.r, out_sum[1] += weight * (double)c.g, out_sum[2] += weight * (double)c.b;
        out_cells[cell] += weight * ((double)c.r + c.g + c.b) / 3.0;
        out_counts[cell]++;
    }
}

ag_status radiance_map_create(const scene *s, const light *l, radiance_map **out_map)
{
    radiance_map *m = calloc(1, sizeof *m);
    float *weights = malloc(SIZE * SIZE * sizeof *weights);
    double *cells = calloc(SIZE * SIZE, sizeof *cells), sum[3] = {0.0, 0.0, 0.0};
    uint32_t *counts = calloc(SIZE * SIZE, sizeof *counts);
    ag_status status = m && weights && cells && counts ? AG_OK : AG_ERROR_MEMORY;
    if (status == AG_OK) {
        look(s, l, sum, cells, counts);
        m->mean = rgb_make((float)(sum[0] / LOOKS), (float)(sum[1] / LOOKS), (float)(sum[2] / LOOKS));
        double least = FLOOR * (sum[0] + sum[1] + sum[2]) / (3.0 * LOOKS);
        for (uint32_t i = 0; i < SIZE * SIZE; i++)
            weights[i] = (float)(least + (counts[i] > 0 ? cells[i] / counts[i] : least));
        status = distribution_2d_create(SIZE, SIZE, weights, &m->picks);
    }
    free(weights);
    free(cells);
    free(counts);
    if (status != AG_OK) {
        free(m);
        m = NULL;
    }
    *out_map = m;
    return status;
}

void radiance_map_destroy(radiance_map *m)
{
    if (!m)
        return;
    distribution_2d_reset(&m->picks);
    free(m);
}

bool radiance_map_sample(const radiance_map *m, vec2 u, vec2 *out_u, float *out_density)
{
    distribution_2d_sample pick;
    if (!distribution_2d_pick(&m->picks, u, &pick))
        return false;
    *out_u = (vec2){float_below_one(((float)pick.x + pick.within.x) / SIZE),
                    float_below_one(((float)pick.y + pick.within.y) / SIZE)};
    *out_density = pick.probability * (SIZE * SIZE);
    return true;
}

float radiance_map_density(const radiance_map *m, vec2 u)
{
    float x = float_clamp(u.x * SIZE, 0.0f, SIZE - 1), y = float_clamp(u.y * SIZE, 0.0f, SIZE - 1);
    return distribution_2d_probability(&m->picks, (uint32_t)x, (uint32_t)y) * (SIZE * SIZE);
}
