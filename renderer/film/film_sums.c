/* film_sums.c: see film_sums.h. */
#include "film/film_sums.h"

#include <stddef.h>

/* --- samples in --- */

static void add_rgb(double *sums, rgb value)
{
    sums[0] += (double)value.r;
    sums[1] += (double)value.g;
    sums[2] += (double)value.b;
}

/* Where in sample_layers the members lie that are summed as they are; the width of all other sums is 0 here. */
typedef struct summed_value {
    size_t offset;
    int width;
    bool is_of_hit;
} summed_value;
static const summed_value VALUES[FILM_SUM_COUNT] = {
#define SUM_ROW(sum, width, needs_first_hit)
#define SUM_OF_SAMPLE(sum, type, member, needs_first_hit)                                                              \
    [sum] = {offsetof(sample_layers, member), sizeof(type) / sizeof(float), false},
#define SUM_OF_HIT(sum, type, member, needs_first_hit)                                                                 \
    [sum] = {offsetof(sample_layers, first) + offsetof(first_hit, member), sizeof(type) / sizeof(float), true},
    FILM_SUM_LIST(SUM_ROW, SUM_OF_SAMPLE, SUM_OF_HIT)
#undef SUM_ROW
#undef SUM_OF_SAMPLE
#undef SUM_OF_HIT
};

static void add_values(const aov_layout *layout, double *sums, const sample_layers *l)
{
    for (film_sum sum = 0; sum < FILM_SUM_COUNT; sum++) {
        if (!aov_has(layout, sum) || (VALUES[sum].is_of_hit && !l->first.is_hit))
            continue;
        const float *values = (const float *)(const void *)((const char *)l + VALUES[sum].offset);
        for (int i = 0; i < VALUES[sum].width; i++)
            sums[layout->offset[sum] + i] += (double)values[i];
    }
}

/* A sample as the film develops it, and its square. */
static void add_squares(const ag_film *film, double *squares, double *developed, rgb radiance)
{
    double value[3] = {(double)radiance.r, (double)radiance.g, (double)radiance.b};
    if (!film->response.is_plain)
        film_response_develop(&film->response, value);
    for (int c = 0; c < 3; c++) {
        squares[c] += value[c] * value[c];
        developed[c] += value[c];
    }
}

static void add_layers(ag_film *film, size_t pixel, double *sums, const eye_sample *sample)
{
    const aov_layout *layout = &film->layout;
    const sample_layers *l = sample->layers;
    const first_hit *first = &l->first;
    const int *offset = layout->offset;
    for (int i = 0; aov_has(layout, SUM_PARTS) && i < LIGHT_PART_COUNT; i++)
        add_rgb(sums + offset[SUM_PARTS] + 3 * i, l->parts[i]);
    for (int i = 0; aov_has(layout, SUM_GROUPS) && i <= layout->group_count; i++)
        add_rgb(sums + offset[SUM_GROUPS] + 3 * i, l->groups[i]);
    add_values(layout, sums, l);
    if (!first->is_hit)
        return;

    if (aov_has(layout, SUM_HITS))
        sums[offset[SUM_HITS]] += 1.0;
    if (aov_has(layout, SUM_HIT_SQUARES))
        add_squares(film, sums + offset[SUM_HIT_SQUARES], sums + offset[SUM_HIT_DEVELOPED], sample->radiance);
    const uint32_t ids[CRYPTOMATTE_KIND_COUNT] = {first->object_id, first->material_id};
    for (int i = 0; i < CRYPTOMATTE_KIND_COUNT; i++)
        if (film->slots[i])
            cryptomatte_add(&film->mattes[i], ids[i], sample->sign, film->slots[i] + CRYPTOMATTE_SLOTS * pixel);
    if (film->nearest) {
        film_nearest *nearest = &film->nearest[pixel];
        if (nearest->object_id == 0 || first->depth < nearest->depth)
            *nearest = (film_nearest){first->depth, first->object_id, first->material_id};
    }
}

void film_add(ag_film *film, size_t pixel, const eye_sample *sample)
{
    double *sums = film->sums + pixel * film_sums_of_pixel(film);
    if (sample->sign < 0) {
        sums += film->layout.sum_count;
        film->negatives[pixel]++;
    }
    film->counts[pixel]++;
    add_rgb(sums, sample->radiance);
    const int *offset = film->layout.offset;
    if (aov_has(&film->layout, SUM_SQUARES))
        add_squares(film, sums + offset[SUM_SQUARES], sums + offset[SUM_DEVELOPED], sample->radiance);
    if (film->splits)
        split_sums_add(&film->splits[pixel], sample);
    if (!sample->layers)
        return;
    if (film->layout.needs_layers)
        add_layers(film, pixel, sums, sample);
    if (noise_lattice_holds(&film->noise, pixel))
        noise_lattice_add(&film->noise, &film->response, pixel, sample);
}

/* --- what their sums tell --- */

void film_sums_mean(const ag_film *film, size_t pixel, int offset, int count, double out[3])
{
    const double *sums = film->sums + pixel * film_sums_of_pixel(film) + offset;
    uint32_t samples = film->counts[pixel];
    out[0] = out[1] = out[2] = 0.0;
    if (samples == 0)
        return;
    if (!film->filter.has_signs) {
        for (int c = 0; c < count; c++)
            out[c] = sums[c] / samples;
        return;
    }
    pixel_sum sum = {.positive_count = samples - film->negatives[pixel], .negative_count = film->negatives[pixel]};
    for (int c = 0; c < count; c++) {
        sum.positive[c] = sums[c];
        sum.negative[c] = sums[film->layout.sum_count + c];
    }
    pixel_filter_resolve(&film->filter, &sum, out);
}

/* A sum over all samples, whatever their sign. */
static double total(const ag_film *film, size_t pixel, int offset)
{
    const double *sums = film->sums + pixel * film_sums_of_pixel(film);
    return sums[offset] + (film->filter.has_signs ? sums[film->layout.sum_count + offset] : 0.0);
}

/* Signs are left out: a sum of points by sign would be no point. */
double film_sums_hit_mean(const ag_film *film, size_t pixel, int offset)
{
    double hits = total(film, pixel, film->layout.offset[SUM_HITS]);
    return hits > 0.0 ? total(film, pixel, offset) / hits : 0.0;
}

double film_sums_variance(const ag_film *film, size_t pixel, const film_channel *channel, bool is_relative)
{
    bool is_of_hits = channel->sum == SUM_HIT_SQUARES;
    int developed = film->layout.offset[is_of_hits ? SUM_HIT_DEVELOPED : SUM_DEVELOPED];
    double count = is_of_hits ? total(film, pixel, film->layout.offset[SUM_HITS]) : (double)film->counts[pixel];
    if (count < 2.0)
        return 0.0;
    double sum = total(film, pixel, developed + channel->component), mean = sum / count;
    double squares = total(film, pixel, channel->offset + channel->component);
    double variance = double_max(squares - sum * mean, 0.0) / (count - 1.0);
    if (!is_relative)
        return variance;
    return mean != 0.0 ? variance / mean : 0.0; /* as pbrt: over the mean, not its square */
}

void film_read_noise(const ag_film *film, size_t pixel, double *out_mean, double *out_variance)
{
    const int *offset = film->layout.offset;
    double count = (double)film->counts[pixel], mean = 0.0, variance = 0.0;
    for (int c = 0; c < 3 && count >= 2.0; c++) {
        double sum = total(film, pixel, offset[SUM_DEVELOPED] + c);
        double squares = total(film, pixel, offset[SUM_SQUARES] + c);
        mean += sum / count;
        variance += double_max(squares - sum * sum / count, 0.0) / ((count - 1.0) * count);
    }
    *out_mean = mean / 3.0;
    *out_variance = variance / 3.0;
}
