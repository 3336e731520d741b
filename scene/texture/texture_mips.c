/* texture_mips.c: see texture_mips.h. */
#include "texture/texture_mips.h"

#include "parallel_for.h"

#include <stdlib.h>

static float value_at(const texture_level *l, size_t at)
{
    if (l->bytes)
        return l->table[l->bytes[at]];
    return l->packed ? (float)l->packed[at] * (1.0f / 65535.0f) : l->values[at];
}

rgb texture_level_rgb(const texture_level *l, texture_wraps wraps, texture_filter filter, float s, float t)
{
    const pixel_blend blend = pixel_blend_at(l->width, l->height, wraps, filter, s, t);
    float sums[3] = {0.0f, 0.0f, 0.0f};
    for (int k = 0; k < blend.count; k++)
        for (uint32_t channel = 0; channel < l->channel_count; channel++)
            sums[channel] += blend.weight[k] * value_at(l, blend.pixel[k] * l->channel_count + channel);
    return l->channel_count == 1 ? rgb_gray(sums[0]) : rgb_make(sums[0], sums[1], sums[2]);
}

/* --- making them --- */

/* The pixels of a row or column that a coarser one covers, and how much of it each is. */
typedef struct cover {
    uint32_t first, count;
    float share[3];
} cover;

/* In units of 1 / coarse of a fine pixel everything is whole. */
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
} mip_job;

static void average_pixel(const texture_level *fine, const cover *across, const cover *down, float out_sums[3])
{
    for (uint32_t channel = 0; channel < fine->channel_count; channel++)
        out_sums[channel] = 0.0f;
    for (uint32_t y = 0; y < down->count; y++)
        for (uint32_t x = 0; x < across->count; x++) {
            const float share = down->share[y] * across->share[x];
            const size_t at = ((size_t)(down->first + y) * fine->width + across->first + x) * fine->channel_count;
            for (uint32_t channel = 0; channel < fine->channel_count; channel++)
                out_sums[channel] += share * value_at(fine, at + channel);
        }
}

static void average_rows(void *user, uint64_t begin, uint64_t end, uint64_t block, unsigned worker)
{
    (void)block, (void)worker;
    const mip_job *job = user;
    const texture_level *fine = job->fine;
    texture_level *coarse = job->coarse;
    for (uint32_t y = (uint32_t)begin; y < end; y++) {
        const cover down = cover_of(fine->height, coarse->height, y);
        for (uint32_t x = 0; x < coarse->width; x++) {
            const cover across = cover_of(fine->width, coarse->width, x);
            const size_t at = ((size_t)y * coarse->width + x) * coarse->channel_count;
            float sums[3];
            average_pixel(fine, &across, &down, sums);
            for (uint32_t channel = 0; channel < coarse->channel_count; channel++)
                if (coarse->packed)
                    coarse->packed[at + channel] = (uint16_t)(sums[channel] * 65535.0f + 0.5f);
                else
                    coarse->values[at + channel] = sums[channel];
        }
    }
}

static size_t level_count_of_values(const texture_level *l) { return (size_t)l->width * l->height * l->channel_count; }

static ag_status make_level(run_context *run, const texture_level *fine, texture_level *out)
{
    enum { ROWS = 64 };
    *out = (texture_level){(fine->width + 1) / 2, (fine->height + 1) / 2, fine->channel_count, NULL, NULL, NULL, NULL};
    const size_t count = level_count_of_values(out);
    if (fine->values)
        out->values = malloc(count * sizeof *out->values);
    else
        out->packed = malloc(count * sizeof *out->packed);
    if (!out->values && !out->packed)
        return AG_ERROR_MEMORY;
    mip_job job = {fine, out};
    return parallel_for(run, out->height, ROWS, average_rows, &job, AG_PHASE_PHOTONS, 0.0, 0.0);
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

void texture_mips_destroy(texture_mips *m)
{
    for (uint32_t k = 1; m && k < m->level_count; k++) {
        free(m->levels[k].packed);
        free(m->levels[k].values);
    }
    free(m);
}

size_t texture_mips_size_bytes(const texture_mips *m)
{
    size_t sum = sizeof *m;
    for (uint32_t k = 1; k < m->level_count; k++)
        sum += level_count_of_values(&m->levels[k]) *
               (m->levels[k].packed ? sizeof *m->levels[k].packed : sizeof *m->levels[k].values);
    return sum;
}
