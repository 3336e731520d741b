/* ggx_albedo.c: see ggx_albedo.h. Threads: pure functions. */
#include "material/ggx_albedo.h"

#include "material/fresnel.h"
#include "material/ggx_albedo_table.h"
#include "material/material.h"

/* Where x in [0, 1] lies among even steps. */
static int find_step(float x, int count, float *out_rest)
{
    float along = float_clamp(x, 0.0f, 1.0f) * (float)(count - 1);
    int step = (int)along;
    step = step < count - 2 ? step : count - 2;
    *out_rest = along - (float)step;
    return step;
}

static float between(const uint16_t (*rows)[GGX_ALBEDO_COSINES], int row, int column, float v, float u)
{
    const uint16_t *a = &rows[row][column], *b = &rows[row + 1][column];
    float low = (1.0f - u) * (float)a[0] + u * (float)a[1], high = (1.0f - u) * (float)b[0] + u * (float)b[1];
    return ((1.0f - v) * low + v * high) * (1.0f / 65535.0f);
}

ggx_albedo ggx_albedo_of(float alpha, float cosine)
{
    if (alpha < MATERIAL_SMOOTH_ALPHA) {
        float grazing = fresnel_schlick_weight(cosine);
        return (ggx_albedo){1.0f - grazing, grazing};
    }
    float u, v;
    int row = find_step(sqrtf(alpha), GGX_ALBEDO_ROUGHNESSES, &v);
    int column = find_step(sqrtf(cosine), GGX_ALBEDO_COSINES, &u);
    return (ggx_albedo){between(GGX_ALBEDO_F0, row, column, v, u), between(GGX_ALBEDO_F90, row, column, v, u)};
}
