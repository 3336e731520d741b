/* texture_pixels.c: see texture_pixels.h. Threads: pure functions. */
#include "texture/texture_pixels.h"

#include "math/min_max.h"

#include <math.h>
#include <stdbool.h>

/* A coordinate brought to where all neighbours are at most one pixel beyond an edge, or where all is black. */
static float tame(texture_wrap wrap, float x)
{
    switch (wrap) {
    case TEXTURE_WRAP_REPEAT: return fabsf(x) < 1e9f ? x - floorf(x) : 0.0f;
    case TEXTURE_WRAP_BLACK: return float_clamp(x, -1.0f, 2.0f);
    case TEXTURE_WRAP_MIRROR:
        x = fabsf(x) < 1e9f ? 0.5f * x - floorf(0.5f * x) : 0.0f;
        return x < 0.5f ? 2.0f * x : 2.0f - 2.0f * x;
    default: return float_clamp(x, 0.0f, 1.0f);
    }
}

/* Brings x, which is beyond an edge, to [0, size); false where all is black there. */
static bool wrap_axis(texture_wrap wrap, int64_t size, int64_t *x)
{
    if (wrap == TEXTURE_WRAP_REPEAT)
        *x = *x < 0 ? *x + size : *x - size;
    else /* the edge's own pixel is also what a mirror shows next to it */
        *x = *x < 0 ? 0 : size - 1;
    return wrap != TEXTURE_WRAP_BLACK;
}

/* Brings pixel (x, y) into the picture; false where it is black. */
static bool wrap_pixel(int64_t width, int64_t height, texture_wraps wraps, int64_t *x, int64_t *y)
{
    const bool beyond_x = *x < 0 || *x >= width, beyond_y = *y < 0 || *y >= height;
    if (!beyond_x && !beyond_y)
        return true;
    if (wraps.s == TEXTURE_WRAP_OCTAHEDRAL) {
        if (beyond_x) {
            *x = *x < 0 ? 0 : width - 1;
            *y = height - 1 - *y;
        }
        if (*y < 0 || *y >= height) {
            *y = *y < 0 ? 0 : height - 1;
            *x = width - 1 - *x;
        }
        return true;
    }
    return (!beyond_x || wrap_axis(wraps.s, width, x)) && (!beyond_y || wrap_axis(wraps.t, height, y));
}

typedef struct pixel_grid {
    uint32_t width, height;
    texture_wraps wraps;
} pixel_grid;

static void add_pixel(const pixel_grid *g, int64_t x, int64_t y, float weight, pixel_blend *f)
{
    if (!wrap_pixel(g->width, g->height, g->wraps, &x, &y))
        return;
    f->pixel[f->count] = (size_t)y * g->width + (size_t)x;
    f->weight[f->count++] = weight;
}

pixel_blend pixel_blend_at(uint32_t width, uint32_t height, texture_wraps wraps, texture_filter filter, float s,
                           float t)
{
    const pixel_grid g = {width, height, wraps};
    pixel_blend f;
    f.count = 0;
    float x = tame(wraps.s, s) * (float)width, y = tame(wraps.t, t) * (float)height;
    if (filter == TEXTURE_FILTER_POINT) {
        add_pixel(&g, (int64_t)floorf(x), (int64_t)floorf(y), 1.0f, &f);
        return f;
    }
    x -= 0.5f;
    y -= 0.5f;
    const float left = floorf(x), top = floorf(y), u = x - left, v = y - top;
    const int64_t x0 = (int64_t)left, y0 = (int64_t)top;
    add_pixel(&g, x0, y0, (1.0f - u) * (1.0f - v), &f);
    add_pixel(&g, x0 + 1, y0, u * (1.0f - v), &f);
    add_pixel(&g, x0, y0 + 1, (1.0f - u) * v, &f);
    add_pixel(&g, x0 + 1, y0 + 1, u * v, &f);
    return f;
}
