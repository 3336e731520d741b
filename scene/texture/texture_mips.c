/* texture_mips.c: see texture_mips.h. */
#include "texture/texture_mips.h"

#include "atomics.h"
#include "parallel_for.h"
#include "status.h"

#include <stdlib.h>
#include <string.h>

static float value_at(const texture_level *l, size_t at)
{
    switch (l->sample) {
    case TEXTURE_BYTES: return l->table ? l->table[l->bytes[at]] : (float)l->bytes[at] * (1.0f / 255.0f);
    case TEXTURE_PACKED: return (float)l->packed[at] * (1.0f / 65535.0f);
    default: return l->values[at];
    }
}

static float blend_channel(const texture_level *l, const pixel_blend *blend, uint32_t channel)
{
    float sum = 0.0f;
    for (int k = 0; k < blend->count; k++)
        sum += blend->weight[k] * value_at(l, blend->pixel[k] * l->channel_count + channel);
    return sum;
}

static rgb blend_values(const texture_level *l, const pixel_blend *blend)
{
    float sums[3] = {0.0f, 0.0f, 0.0f};
    for (int k = 0; k < blend->count; k++)
        for (uint32_t channel = 0; channel < l->channel_count; channel++)
            sums[channel] += blend->weight[k] * value_at(l, blend->pixel[k] * l->channel_count + channel);
    return l->channel_count == 1 ? rgb_gray(sums[0]) : rgb_make(sums[0], sums[1], sums[2]);
}

typedef union blend_pixels {
    unsigned char bytes[4 * TEXTURE_PIXEL_BYTES_MAX];
    uint16_t packed[4 * 3];
    float values[4 * 3];
} blend_pixels;

/* The blend's pixels, read from their tiles one behind the other, as a level of their own, which the blend then is
 * of. */
static texture_level read_tiles(const texture_level *l, pixel_blend *in_out_blend, blend_pixels *out_pixels)
{
    texture_level read = *l;
    texture_tiles_read(l->tiles, in_out_blend, out_pixels->bytes);
    read.bytes = out_pixels->bytes;
    read.packed = out_pixels->packed;
    read.values = out_pixels->values;
    for (int k = 0; k < in_out_blend->count; k++)
        in_out_blend->pixel[k] = (size_t)k;
    return read;
}

rgb texture_level_rgb(const texture_level *l, texture_wraps wraps, texture_filter filter, float s, float t)
{
    pixel_blend blend = pixel_blend_at(l->width, l->height, wraps, filter, s, t);
    if (!l->tiles)
        return blend_values(l, &blend);
    blend_pixels pixels;
    const texture_level read = read_tiles(l, &blend, &pixels);
    return blend_values(&read, &blend);
}

float texture_level_channel(const texture_level *l, uint32_t channel, texture_wraps wraps, texture_filter filter,
                            float s, float t)
{
    pixel_blend blend = pixel_blend_at(l->width, l->height, wraps, filter, s, t);
    if (!l->tiles)
        return blend_channel(l, &blend, channel);
    blend_pixels pixels;
    const texture_level read = read_tiles(l, &blend, &pixels);
    return blend_channel(&read, &blend, channel);
}

/* --- making them --- */

/* The pixels of a row or column that a coarser one covers, and how much of it each is. */
typedef struct cover {
    uint32_t first, count;
    float share[3];
} cover;

/* All numbers are whole in units of 1 / coarse of a fine pixel. */
static cover cover_of(uint32_t fine, uint32_t coarse, uint32_t index)
{
    uint64_t begin = (uint64_t)index * fine, end = begin + fine;
    cover c = {(uint32_t)(begin / coarse), 0, {0.0f, 0.0f, 0.0f}};
    for (uint64_t at = begin; at < end;) {
        uint64_t next = (at / coarse + 1) * coarse;
        next = next < end ? next : end;
        c.share[c.count++] = (float)(next - at) / (float)fine;
        at = next;
    }
    return c;
}

typedef struct mip_job {
    const texture_level *fine;
    texture_level *coarse;
    atomic_u32 has_failed; /* relaxed: out of memory; read when all is done */
} mip_job;

/* A row's values, linear. */
static void widen_row(const texture_level *l, uint32_t y, float *out)
{
    const size_t count = (size_t)l->width * l->channel_count, from = y * count;
    if (l->sample == TEXTURE_BYTES && l->table)
        for (size_t k = 0; k < count; k++)
            out[k] = l->table[l->bytes[from + k]];
    else if (l->sample == TEXTURE_PACKED)
        for (size_t k = 0; k < count; k++)
            out[k] = (float)l->packed[from + k] * (1.0f / 65535.0f);
    else
        for (size_t k = 0; k < count; k++)
            out[k] = value_at(l, from + k);
}

/* Means of the rows' values, which lie one behind the other, over the width of each coarse pixel. */
static void average_row(const texture_level *fine, uint32_t width, const cover *down, const float *rows, float *out)
{
    const size_t channels = fine->channel_count, row_values = fine->width * channels;
    for (uint32_t x = 0; x < width; x++, out += channels) {
        const cover across = cover_of(fine->width, width, x);
        for (size_t channel = 0; channel < channels; channel++)
            out[channel] = 0.0f;
        for (uint32_t row = 0; row < down->count; row++)
            for (uint32_t k = 0; k < across.count; k++) {
                const float share = down->share[row] * across.share[k];
                const float *from = rows + row * row_values + (across.first + k) * channels;
                for (size_t channel = 0; channel < channels; channel++)
                    out[channel] += share * from[channel];
            }
    }
}

/* average_row where each coarse pixel covers two by two: the same sums, in the same order. */
static void average_fours(size_t channels, uint32_t width, const float *upper, const float *lower, float *out)
{
    for (uint32_t x = 0; x < width; x++, out += channels, upper += 2 * channels, lower += 2 * channels)
        for (size_t channel = 0; channel < channels; channel++)
            out[channel] = 0.0f + 0.25f * upper[channel] + 0.25f * upper[channels + channel] + 0.25f * lower[channel] +
                           0.25f * lower[channels + channel];
}

static void store_row(texture_level *l, uint32_t y, const float *values)
{
    const size_t count = (size_t)l->width * l->channel_count, to = y * count;
    if (l->sample == TEXTURE_FLOATS)
        memcpy(l->values + to, values, count * sizeof *values);
    else
        for (size_t k = 0; k < count; k++)
            l->packed[to + k] = (uint16_t)(values[k] * 65535.0f + 0.5f);
}

static void average_rows(void *user, uint64_t begin, uint64_t end, uint64_t block, unsigned worker)
{
    (void)block, (void)worker;
    enum { COVERED_MAX = 3 };
    mip_job *job = user;
    const texture_level *fine = job->fine;
    texture_level *coarse = job->coarse;
    const size_t channels = fine->channel_count, row_values = fine->width * channels;
    float *rows = malloc((COVERED_MAX * row_values + coarse->width * channels) * sizeof *rows);
    if (!rows) {
        store_relaxed_u32(&job->has_failed, 1);
        return;
    }
    float *means = rows + COVERED_MAX * row_values;
    for (uint32_t y = (uint32_t)begin; y < end; y++) {
        const cover down = cover_of(fine->height, coarse->height, y);
        for (uint32_t k = 0; k < down.count; k++)
            widen_row(fine, down.first + k, rows + k * row_values);
        if (fine->width % 2 || fine->height % 2)
            average_row(fine, coarse->width, &down, rows, means);
        else if (channels == 3) /* each with a constant, for the compiler */
            average_fours(3, coarse->width, rows, rows + row_values, means);
        else
            average_fours(1, coarse->width, rows, rows + row_values, means);
        store_row(coarse, y, means);
    }
    free(rows);
}

static size_t level_count_of_values(const texture_level *l) { return (size_t)l->width * l->height * l->channel_count; }

static ag_status make_level(run_context *run, const texture_level *fine, texture_level *out)
{
    enum { ROWS = 64 };
    *out = (texture_level){.width = (fine->width + 1) / 2,
                           .height = (fine->height + 1) / 2,
                           .channel_count = fine->channel_count,
                           .sample = fine->sample == TEXTURE_FLOATS ? TEXTURE_FLOATS : TEXTURE_PACKED};
    const size_t count = level_count_of_values(out);
    if (out->sample == TEXTURE_FLOATS)
        out->values = malloc(count * sizeof *out->values);
    else
        out->packed = malloc(count * sizeof *out->packed);
    if (!out->values && !out->packed)
        return AG_ERROR_MEMORY;
    mip_job job = {.fine = fine, .coarse = out};
    ag_status status = AG_OK;
    if (run && run->pool)
        status = parallel_for(run, out->height, ROWS, average_rows, &job, AG_PHASE_PHOTONS, 0.0, 0.0);
    else
        average_rows(&job, 0, out->height, 0, 0);
    return status == AG_OK && load_relaxed_u32(&job.has_failed) ? AG_ERROR_MEMORY : status;
}

ag_status texture_mips_create(run_context *run, const texture_level *finest, texture_mips **out_mips)
{
    texture_mips *m = calloc(1, sizeof *m);
    *out_mips = m;
    if (!m)
        return AG_ERROR_MEMORY;
    m->levels[m->level_count++] = *finest;
    const texture_level *last = finest;
    ag_status status = AG_OK;
    while ((last->width > 1 || last->height > 1) && status == AG_OK) {
        texture_level *next = &m->levels[m->level_count++];
        status = make_level(run, last, next);
        last = next;
    }
    if (status != AG_OK) {
        texture_mips_destroy(m);
        *out_mips = NULL;
    }
    return status;
}

texture_layout texture_level_layout(const texture_level *l)
{
    return (texture_layout){.width = l->width,
                            .height = l->height,
                            .channel_count = l->channel_count,
                            .value_bytes = l->sample == TEXTURE_BYTES    ? 1
                                           : l->sample == TEXTURE_PACKED ? 2
                                                                         : 4};
}

ag_status texture_level_put(run_context *run, texture_level *l, texture_store *store, tile_file *into, char *message,
                            size_t message_size)
{
    const void *pixels = l->sample == TEXTURE_BYTES    ? (const void *)l->bytes
                         : l->sample == TEXTURE_PACKED ? (const void *)l->packed
                                                       : l->values;
    return texture_store_put(store, run, pixels, texture_level_layout(l), into, &l->tiles, message, message_size);
}

static void free_level(texture_level *l)
{
    free((void *)l->bytes);
    free(l->packed);
    free(l->values);
    l->bytes = NULL;
    l->packed = NULL;
    l->values = NULL;
}

ag_status texture_mips_put(run_context *run, texture_mips *m, texture_store *store, tile_file *into, char *message,
                           size_t message_size)
{
    for (uint32_t k = 0; k < m->level_count; k++) {
        AG_TRY(texture_level_put(run, &m->levels[k], store, into, message, message_size));
        if (k > 0)
            free_level(&m->levels[k]);
    }
    m->levels[0].bytes = NULL;
    m->levels[0].values = NULL;
    return AG_OK;
}

void texture_mips_destroy(texture_mips *m)
{
    for (uint32_t k = 0; m && k < m->level_count; k++) {
        texture_tiles_destroy(m->levels[k].tiles);
        if (k > 0)
            free_level(&m->levels[k]);
    }
    free(m);
}
