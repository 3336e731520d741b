/* film.c: see film.h. */
#include "film/film.h"

#include "film/film_tiles.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

/* Depth where there is nothing, as Cycles has it: far, but a number. */
static const float DEPTH_OF_NOTHING = 1e10f;

static size_t pixel_count(const ag_film *film) { return (size_t)film->width * (size_t)film->height; }

/* The index within the film's area of a pixel of the crop. */
static size_t area_pixel(const ag_film *film, size_t pixel)
{
    size_t width = (size_t)film->width;
    return film_pixel_at(film, film->x0 + (int)(pixel % width), film->y0 + (int)(pixel / width));
}

/* doubles of a pixel */
static size_t sums_of_pixel(const ag_film *film)
{
    return (size_t)film->layout.sum_count * (film->filter.has_signs ? 2 : 1);
}

static void set_crop(ag_film *film, const ag_render_settings *settings, bool splits_samples)
{
    /* as pbrt: pixels from ceil(x0 width) on; a hair less, so that pixel / width times width is that pixel */
    const double *crop = settings->crop_window;
    int edges[4];
    for (int i = 0; i < 4; i++)
        edges[i] = (int)ceil(crop[i] * (i < 2 ? settings->width : settings->height) - 1e-6);
    film->x0 = edges[0];
    film->y0 = edges[2];
    film->width = edges[1] - edges[0];
    film->height = edges[3] - edges[2];
    film->full_width = settings->width;
    film->full_height = settings->height;
    if (film->width < 1 || film->height < 1)
        film->width = film->height = 0;
    film->area = (film_area){film->x0, film->y0, film->width, film->height};
    if ((settings->noise_level > 0.0f || sample_split_goes_on(settings, splits_samples)) && film->width > 0) {
        int x0 = edges[0] / FILM_BLOCK * FILM_BLOCK, y0 = edges[2] / FILM_BLOCK * FILM_BLOCK;
        int x1 = (edges[1] + FILM_BLOCK - 1) / FILM_BLOCK * FILM_BLOCK,
            y1 = (edges[3] + FILM_BLOCK - 1) / FILM_BLOCK * FILM_BLOCK;
        film->area = (film_area){x0, y0, (x1 < settings->width ? x1 : settings->width) - x0,
                                 (y1 < settings->height ? y1 : settings->height) - y0};
    }
}

size_t film_block_number(const ag_film *film, int x, int y)
{
    const film_area *all = &film->area;
    int column = all->x0 / FILM_BLOCK, columns = (all->x0 + all->width - 1) / FILM_BLOCK - column + 1;
    return (size_t)(y / FILM_BLOCK - all->y0 / FILM_BLOCK) * (size_t)columns + (size_t)(x / FILM_BLOCK - column);
}

ag_film *film_create(const ag_render_settings *settings, const working_space *space, const pixel_filter *filter,
                     bool splits_samples, aov_layout *layout)
{
    ag_film *film = calloc(1, sizeof *film);
    if (!film) {
        aov_layout_reset(layout);
        return NULL;
    }
    set_crop(film, settings, splits_samples);
    film->float_samples = settings->float_samples;
    film->filter = *filter;
    film->space = *space;
    film->response = film_response_make(settings, space);
    film->layout = *layout;
    *layout = (aov_layout){0};
    size_t count = film_area_count(film) + 1; /* never none */
    film->sums = calloc(count, sums_of_pixel(film) * sizeof *film->sums);
    film->counts = calloc(count, sizeof *film->counts);
    film->pixels = calloc(pixel_count(film) + 1, 3 * sizeof *film->pixels);
    film->tiles = film_tiles_create(film->width, film->height);
    bool is_whole = film->sums && film->counts && film->pixels && film->tiles;
    if (filter->has_signs) {
        film->negatives = calloc(count, sizeof *film->negatives);
        is_whole = is_whole && film->negatives;
    }
    for (int i = 0; i < FILM_VIEW_COUNT; i++)
        if (film->layout.has_view[i]) {
            film->views[i] = calloc(count, sizeof *film->views[i]);
            is_whole = is_whole && film->views[i];
        }
    for (int i = 0; i < CRYPTOMATTE_KIND_COUNT; i++)
        if (film->layout.has_matte[i]) {
            film->slots[i] = calloc(count, CRYPTOMATTE_SLOTS * sizeof *film->slots[i]);
            is_whole = is_whole && film->slots[i];
        }
    if (settings->noise_level > 0.0f) {
        film->wanted = calloc(count, sizeof *film->wanted);
        is_whole = is_whole && film->wanted;
    }
    if (sample_split_is_open(settings, splits_samples)) {
        film->splits = calloc(count, sizeof *film->splits);
        is_whole = is_whole && film->splits;
        film_set_first_splits(film, settings);
    }
    if (film->layout.needs_nearest) {
        film->nearest = calloc(count, sizeof *film->nearest);
        is_whole = is_whole && film->nearest;
    }
    is_whole = is_whole && noise_lattice_create(film->area.width, film->area.height, &film->noise) == AG_OK;
    if (is_whole)
        return film;
    ag_film_destroy(film);
    return NULL;
}

void ag_film_destroy(ag_film *film)
{
    if (!film)
        return;
    free(film->sums);
    free(film->counts);
    free(film->wanted);
    free(film->splits);
    split_prior_reset(&film->prior);
    free(film->negatives);
    free(film->nearest);
    for (int i = 0; i < FILM_VIEW_COUNT; i++)
        free(film->views[i]);
    for (int i = 0; i < CRYPTOMATTE_KIND_COUNT; i++) {
        free(film->slots[i]);
        cryptomatte_reset(&film->mattes[i]);
    }
    free(film->pixels);
    film_tiles_destroy(film->tiles);
    noise_lattice_reset(&film->noise);
    free(film->origin.defined);
    aov_layout_reset(&film->layout);
    free(film);
}

/* The planes that samples fill. */
static int sample_planes(ag_film *film, film_plane out_planes[FILM_PLANES_MAX])
{
    size_t pixels = film_area_count(film);
    int count = 0;
    out_planes[count++] = (film_plane){film->sums, pixels * sums_of_pixel(film) * sizeof *film->sums};
    out_planes[count++] = (film_plane){film->counts, pixels * sizeof *film->counts};
    if (film->wanted)
        out_planes[count++] = (film_plane){film->wanted, pixels * sizeof *film->wanted};
    if (film->splits)
        out_planes[count++] = (film_plane){film->splits, pixels * sizeof *film->splits};
    if (film->negatives)
        out_planes[count++] = (film_plane){film->negatives, pixels * sizeof *film->negatives};
    for (int i = 0; i < FILM_VIEW_COUNT; i++)
        if (film->views[i])
            out_planes[count++] = (film_plane){film->views[i], pixels * sizeof *film->views[i]};
    for (int i = 0; i < CRYPTOMATTE_KIND_COUNT; i++)
        if (film->slots[i])
            out_planes[count++] = (film_plane){film->slots[i], pixels * CRYPTOMATTE_SLOTS * sizeof *film->slots[i]};
    if (film->nearest)
        out_planes[count++] = (film_plane){film->nearest, pixels * sizeof *film->nearest};
    out_planes[count++] = (film_plane){film->noise.sums, noise_lattice_bytes(&film->noise)};
    return count;
}

int film_planes(ag_film *film, film_plane out_planes[FILM_PLANES_MAX])
{
    int count = sample_planes(film, out_planes);
    double *of_pilot = &film->prior.cost_per_variance;
    out_planes[count++] = (film_plane){of_pilot, sizeof *of_pilot};
    return count;
}

void film_set_first_splits(struct ag_film *film, const ag_render_settings *settings)
{
    const film_area *all = &film->area;
    for (int y = all->y0; film->splits && y < all->y0 + all->height; y++)
        for (int x = all->x0; x < all->x0 + all->width; x++)
            film->splits[film_pixel_at(film, x, y)].counts =
                film->prior.first ? film->prior.first[film_block_number(film, x, y)] : sample_split_first(settings);
}

void film_clear(ag_film *film, const ag_render_settings *settings)
{
    film_plane planes[FILM_PLANES_MAX];
    for (int i = sample_planes(film, planes) - 1; i >= 0; i--)
        memset(planes[i].bytes, 0, planes[i].size);
    film_set_first_splits(film, settings);
}

film_area film_block_at(const ag_film *film, int column, int row)
{
    const film_area *all = &film->area;
    int x = column * FILM_BLOCK, y = row * FILM_BLOCK;
    int width = all->width - x < FILM_BLOCK ? all->width - x : FILM_BLOCK,
        height = all->height - y < FILM_BLOCK ? all->height - y : FILM_BLOCK;
    return (film_area){all->x0 + x, all->y0 + y, width, height};
}

film_count film_count_samples(const ag_film *film)
{
    film_count count = {.least = UINT32_MAX};
    uint64_t sum = 0;
    size_t pixels = pixel_count(film);
    for (size_t i = 0; i < pixels; i++) {
        uint32_t samples = film->counts[area_pixel(film, i)];
        sum += samples;
        count.least = samples < count.least ? samples : count.least;
        count.most = samples > count.most ? samples : count.most;
    }
    if (pixels == 0)
        return (film_count){0};
    count.mean = (double)sum / (double)pixels;
    return count;
}

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
    double *sums = film->sums + pixel * sums_of_pixel(film);
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
        split_trial_add(&film->splits[pixel], sample);
    if (!sample->layers)
        return;
    if (film->layout.needs_layers)
        add_layers(film, pixel, sums, sample);
    if (noise_lattice_holds(&film->noise, pixel))
        noise_lattice_add(&film->noise, &film->response, pixel, sample);
}

/* --- the picture out --- */

/* The mean of count <= 3 sums that follow each other; of filters with negative lobes with the samples' signs. */
static void read_mean(const ag_film *film, size_t pixel, int offset, int count, double out[3])
{
    const double *sums = film->sums + pixel * sums_of_pixel(film) + offset;
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

/* The mean over the samples that met a surface, by their number. Signs are left out: a sum of points by sign
 * would be no point. */
static double read_hit_mean(const ag_film *film, size_t pixel, int offset)
{
    const double *sums = film->sums + pixel * sums_of_pixel(film);
    int of_hits = film->layout.offset[SUM_HITS];
    double hits = sums[of_hits], value = sums[offset];
    if (film->filter.has_signs) {
        const double *negative = sums + film->layout.sum_count;
        hits += negative[of_hits];
        value += negative[offset];
    }
    return hits > 0.0 ? value / hits : 0.0;
}

/* A sum over all samples, whatever their sign. */
static double read_total(const ag_film *film, size_t pixel, int offset)
{
    const double *sums = film->sums + pixel * sums_of_pixel(film);
    return sums[offset] + (film->filter.has_signs ? sums[film->layout.sum_count + offset] : 0.0);
}

/* The variance of the samples, not of their mean. */
static double read_variance(const ag_film *film, size_t pixel, const film_channel *channel, bool is_relative)
{
    bool is_of_hits = channel->sum == SUM_HIT_SQUARES;
    int developed = film->layout.offset[is_of_hits ? SUM_HIT_DEVELOPED : SUM_DEVELOPED];
    double count = is_of_hits ? read_total(film, pixel, film->layout.offset[SUM_HITS]) : (double)film->counts[pixel];
    if (count < 2.0)
        return 0.0;
    double sum = read_total(film, pixel, developed + channel->component), mean = sum / count;
    double squares = read_total(film, pixel, channel->offset + channel->component);
    double variance = fmax(squares - sum * mean, 0.0) / (count - 1.0);
    if (!is_relative)
        return variance;
    return mean != 0.0 ? variance / mean : 0.0; /* as pbrt: over the mean, not its square */
}

void film_read_noise(const ag_film *film, size_t pixel, double *out_mean, double *out_variance)
{
    const int *offset = film->layout.offset;
    double count = (double)film->counts[pixel], mean = 0.0, variance = 0.0;
    for (int c = 0; c < 3 && count >= 2.0; c++) {
        double sum = read_total(film, pixel, offset[SUM_DEVELOPED] + c);
        double squares = read_total(film, pixel, offset[SUM_SQUARES] + c);
        mean += sum / count;
        variance += fmax(squares - sum * sum / count, 0.0) / ((count - 1.0) * count);
    }
    *out_mean = mean / 3.0;
    *out_variance = variance / 3.0;
}

static void read_color(const ag_film *film, size_t pixel, int offset, double out[3])
{
    read_mean(film, pixel, offset, 3, out);
    if (!film->response.is_plain)
        film_response_develop(&film->response, out);
}

/* Where the film has the parts of light, the picture is their sum in floats, in their order, so that the layers of a
 * file add up to it. */
void film_develop(const ag_film *film, size_t pixel, float out[3])
{
    double color[3];
    const aov_layout *layout = &film->layout;
    if (!aov_has(layout, SUM_PARTS)) {
        read_color(film, pixel, layout->offset[SUM_RADIANCE], color);
        for (int c = 0; c < 3; c++)
            out[c] = (float)color[c];
        return;
    }
    for (int i = 0; i < LIGHT_PART_COUNT; i++) {
        read_color(film, pixel, layout->offset[SUM_PARTS] + 3 * i, color);
        for (int c = 0; c < 3; c++)
            out[c] = i == 0 ? (float)color[c] : out[c] + (float)color[c];
    }
}

void film_resolve(ag_film *film) { film_show(film, film->area); }

static float read_value(const ag_film *film, size_t pixel_of_crop, const film_channel *channel)
{
    size_t pixel = area_pixel(film, pixel_of_crop);
    double value[3];
    int component = channel->component, at = channel->offset + component;
    const film_nearest nothing = {DEPTH_OF_NOTHING, 0, 0};
    const film_nearest *nearest = film->nearest && film->nearest[pixel].object_id ? &film->nearest[pixel] : &nothing;
    switch (channel->source) {
    case CHANNEL_BEAUTY: return film->pixels[3 * pixel_of_crop + (size_t)component];
    case CHANNEL_COLOR: read_color(film, pixel, channel->offset, value); return (float)value[component];
    case CHANNEL_MEAN: read_mean(film, pixel, at, 1, value); return (float)value[0];
    case CHANNEL_HIT_MEAN: return (float)read_hit_mean(film, pixel, at);
    case CHANNEL_ABSOLUTE: return (float)fabs(read_hit_mean(film, pixel, at));
    case CHANNEL_DIRECTION: {
        double length_squared = 0.0;
        read_mean(film, pixel, channel->offset, 3, value);
        for (int c = 0; c < 3; c++)
            length_squared += value[c] * value[c];
        return length_squared > 0.0 ? (float)(value[component] / sqrt(length_squared)) : 0.0f;
    }
    case CHANNEL_VARIANCE: return (float)read_variance(film, pixel, channel, false);
    case CHANNEL_RELATIVE_VARIANCE: return (float)read_variance(film, pixel, channel, true);
    case CHANNEL_SAMPLES: return (float)film->counts[pixel];
    case CHANNEL_DEPTH: return nearest->depth;
    case CHANNEL_OBJECT: return (float)nearest->object_id;
    case CHANNEL_MATERIAL: return (float)nearest->material_id;
    case CHANNEL_CRYPTO_ID:
    case CHANNEL_CRYPTO_COVERAGE: {
        float id, coverage;
        int64_t negatives = film->negatives ? (int64_t)film->negatives[pixel] : 0;
        cryptomatte_rank(film->slots[component / CRYPTOMATTE_RANKS] + CRYPTOMATTE_SLOTS * pixel,
                         component % CRYPTOMATTE_RANKS, (int64_t)film->counts[pixel] - 2 * negatives, &id, &coverage);
        return channel->source == CHANNEL_CRYPTO_ID ? id : coverage;
    }
    case CHANNEL_VIEW: return film->views[component][pixel];
    }
    return 0.0f;
}

void film_read_channel(const ag_film *film, int channel, float *out, size_t stride)
{
    for (size_t i = 0; i < pixel_count(film); i++)
        out[i * stride] = read_value(film, i, &film->layout.channels[channel]);
}

void film_read_sum(const ag_film *film, film_sum sum, float *out)
{
    double value[3];
    for (size_t i = 0; i < pixel_count(film); i++) {
        read_mean(film, area_pixel(film, i), film->layout.offset[sum], 3, value);
        for (int c = 0; c < 3; c++)
            out[3 * i + (size_t)c] = (float)value[c];
    }
}

/* --- as the public interface shows it --- */

const float *ag_film_pixels(const ag_film *film, int *out_width, int *out_height)
{
    if (out_width)
        *out_width = film ? film->width : 0;
    if (out_height)
        *out_height = film ? film->height : 0;
    return film ? film->pixels : NULL;
}

int ag_film_channel_count(const ag_film *film) { return film ? film->layout.channel_count : 0; }

const char *ag_film_channel_name(const ag_film *film, int channel)
{
    return film && channel >= 0 && channel < film->layout.channel_count ? film->layout.channels[channel].name : NULL;
}

bool ag_film_matte_name(const ag_film *film, ag_layer layer, float id, char *out_name, size_t size)
{
    const cryptomatte_kind kind = layer == AG_LAYER_CRYPTO_MATERIAL ? CRYPTOMATTE_MATERIAL : CRYPTOMATTE_OBJECT;
    if (!film || !out_name || size == 0 || (layer != AG_LAYER_CRYPTO_OBJECT && layer != AG_LAYER_CRYPTO_MATERIAL))
        return false;
    return cryptomatte_name(&film->mattes[kind], id, out_name, size);
}

ag_status ag_film_read_channel(const ag_film *film, int channel, float *out_values)
{
    if (!film || !out_values || channel < 0 || channel >= film->layout.channel_count)
        return AG_ERROR_ARGUMENT;
    film_read_channel(film, channel, out_values, 1);
    return AG_OK;
}
