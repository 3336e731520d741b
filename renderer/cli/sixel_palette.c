/* sixel_palette.c: see sixel_palette.h. */
#include "sixel_palette.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { CHANNEL_BITS = 7, CHANNEL_MASK = (1 << CHANNEL_BITS) - 1, PIXEL_BITS = 40 };

/* A colour of the picture, and how many pixels have it. */
typedef struct shade {
    unsigned char rgb[3];
    uint32_t key, count;
} shade;

/* The shades that one colour of the palette stands for. */
typedef struct box {
    size_t begin, end;
    double mean[3];
    double error[3]; /* squared, of all pixels */
} box;

static int level_of(float value)
{
    const float scaled = value * (SIXEL_LEVELS - 1) + 0.5f;
    return scaled >= SIXEL_LEVELS - 1 ? SIXEL_LEVELS - 1 : scaled > 0.0f ? (int)scaled : 0;
}

static int compare_keys(const void *a, const void *b)
{
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

static int compare_shades(const void *a, const void *b)
{
    const uint32_t x = ((const shade *)a)->key, y = ((const shade *)b)->key;
    return (x > y) - (x < y);
}

/* Each pixel's shade and number, sorted by the shade. */
static void fill_keys(const float *pixels, size_t count, uint64_t *out)
{
    for (size_t i = 0; i < count; i++) {
        uint64_t shade_key = 0;
        for (size_t c = 0; c < 3; c++)
            shade_key = shade_key << CHANNEL_BITS | (uint64_t)level_of(pixels[3 * i + c]);
        out[i] = shade_key << PIXEL_BITS | i;
    }
    qsort(out, count, sizeof *out, compare_keys);
}

static size_t fill_shades(const uint64_t *keys, size_t count, shade *out)
{
    size_t shade_count = 0;
    for (size_t i = 0; i < count; i++) {
        const uint32_t key = (uint32_t)(keys[i] >> PIXEL_BITS);
        if (shade_count == 0 || out[shade_count - 1].key != key) {
            shade *s = &out[shade_count++];
            *s = (shade){.key = key};
            for (int c = 0; c < 3; c++)
                s->rgb[c] = (unsigned char)(key >> CHANNEL_BITS * (2 - c) & CHANNEL_MASK);
        }
        out[shade_count - 1].count++;
    }
    return shade_count;
}

static void measure(const shade *shades, box *b)
{
    double count = 0.0, sum[3] = {0.0}, squares[3] = {0.0};
    for (size_t i = b->begin; i < b->end; i++) {
        const double weight = shades[i].count;
        count += weight;
        for (int c = 0; c < 3; c++) {
            const double level = shades[i].rgb[c];
            sum[c] += weight * level;
            squares[c] += weight * level * level;
        }
    }
    for (int c = 0; c < 3; c++) {
        b->mean[c] = sum[c] / count;
        b->error[c] = b->end - b->begin > 1 ? squares[c] - sum[c] * b->mean[c] : 0.0;
    }
}

static int widest(const box *b)
{
    int found = 0;
    for (int c = 1; c < 3; c++)
        found = b->error[c] > b->error[found] ? c : found;
    return found;
}

/* Parts a box at its mean. Returns false where its shades are one, but for rounding. */
static bool part(shade *shades, box *b, box *out_upper)
{
    const int channel = widest(b);
    size_t middle = b->begin;
    for (size_t i = b->begin; i < b->end; i++)
        if (shades[i].rgb[channel] <= b->mean[channel]) {
            const shade lower = shades[i];
            shades[i] = shades[middle];
            shades[middle++] = lower;
        }
    if (middle == b->begin || middle == b->end)
        return false;
    *out_upper = (box){.begin = middle, .end = b->end};
    b->end = middle;
    measure(shades, b);
    measure(shades, out_upper);
    return true;
}

static int make_boxes(shade *shades, size_t shade_count, int color_count, box *boxes)
{
    int count = 1;
    boxes[0] = (box){.begin = 0, .end = shade_count};
    measure(shades, &boxes[0]);
    while (count < color_count) {
        int worst = 0;
        for (int i = 1; i < count; i++)
            if (boxes[i].error[widest(&boxes[i])] > boxes[worst].error[widest(&boxes[worst])])
                worst = i;
        const double error = boxes[worst].error[widest(&boxes[worst])];
        if (!(error > 0.0))
            break;
        if (part(shades, &boxes[worst], &boxes[count]))
            count++;
        else
            memset(boxes[worst].error, 0, sizeof boxes[worst].error);
    }
    return count;
}

bool sixel_palette_make(const float *pixels, size_t pixel_count, int color_count, sixel_palette *out,
                        unsigned char *out_indices)
{
    box boxes[SIXEL_COLORS_MOST];
    uint64_t *keys = malloc(pixel_count * sizeof *keys);
    shade *shades = malloc(pixel_count * sizeof *shades);
    const bool is_whole = keys && shades && pixel_count > 0;
    if (is_whole) {
        fill_keys(pixels, pixel_count, keys);
        const size_t shade_count = fill_shades(keys, pixel_count, shades);
        out->count = make_boxes(shades, shade_count, color_count, boxes);
        for (int i = 0; i < out->count; i++) {
            for (int c = 0; c < 3; c++)
                out->colors[i][c] = (unsigned char)(boxes[i].mean[c] + 0.5);
            for (size_t s = boxes[i].begin; s < boxes[i].end; s++)
                shades[s].count = (uint32_t)i; /* of no more use else */
        }
        qsort(shades, shade_count, sizeof *shades, compare_shades);
        for (size_t i = 0, s = 0; i < pixel_count; i++) {
            while (shades[s].key != (uint32_t)(keys[i] >> PIXEL_BITS))
                s++;
            out_indices[keys[i] & ((UINT64_C(1) << PIXEL_BITS) - 1)] = (unsigned char)shades[s].count;
        }
    }
    free(keys);
    free(shades);
    return is_whole;
}
