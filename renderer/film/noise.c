/* noise.c: see noise.h. */
#include "film/noise.h"

#include <stdlib.h>

/* The sums of a pixel of the lattice: how many samples, how many that brought light, how many that the sky lit; the
 * three colours as the film develops them, and their squares; each source, the mean of its colours, and its square. */
enum {
    SUM_COUNT,
    SUM_LIT,
    SUM_SKY_LIT,
    SUM_COLOR,
    SUM_COLOR_SQUARES = SUM_COLOR + 3,
    SUM_SOURCE = SUM_COLOR_SQUARES + 3,
    SUM_SOURCE_SQUARES = SUM_SOURCE + AG_NOISE_SOURCE_COUNT,
    NOISE_VALUES = SUM_SOURCE_SQUARES + AG_NOISE_SOURCE_COUNT
};
enum { LATTICE_PIXELS_MAX = 1 << 14 };
/* Noise below this part of white is not seen in the dark. */
static const double DARKEST = 1e-3;

static int steps(int length, int stride) { return (length + stride - 1) / stride; }

ag_status noise_lattice_create(int width, int height, noise_lattice *out_lattice)
{
    noise_lattice l = {.width = width, .height = height, .stride = 1};
    while ((int64_t)steps(width, l.stride) * steps(height, l.stride) > LATTICE_PIXELS_MAX)
        l.stride++;
    l.columns = steps(width, l.stride);
    l.rows = steps(height, l.stride);
    l.sums = calloc((size_t)l.columns * (size_t)l.rows + 1, NOISE_VALUES * sizeof *l.sums);
    if (!l.sums)
        return AG_ERROR_MEMORY;
    *out_lattice = l;
    return AG_OK;
}

void noise_lattice_reset(noise_lattice *lattice)
{
    free(lattice->sums);
    *lattice = (noise_lattice){0};
}

size_t noise_lattice_bytes(const noise_lattice *lattice)
{
    return (size_t)lattice->columns * (size_t)lattice->rows * NOISE_VALUES * sizeof *lattice->sums;
}

static void develop(const film_response *response, rgb radiance, double out[3])
{
    out[0] = (double)radiance.r;
    out[1] = (double)radiance.g;
    out[2] = (double)radiance.b;
    if (!response->is_plain)
        film_response_develop(response, out);
}

void noise_lattice_add(noise_lattice *lattice, const film_response *response, size_t pixel, const eye_sample *sample)
{
    const rgb *parts = sample->layers->parts;
    rgb sky = sample->layers->sky;
    const rgb sources[AG_NOISE_SOURCE_COUNT] = {[AG_NOISE_EMISSION] = parts[PART_EMISSION],
                                                [AG_NOISE_LAMPS] = rgb_sub(parts[PART_DIRECT], sky),
                                                [AG_NOISE_SKY] = sky,
                                                [AG_NOISE_INDIRECT] = parts[PART_INDIRECT],
                                                [AG_NOISE_CAUSTIC] = parts[PART_CAUSTIC],
                                                [AG_NOISE_SPECULAR] = parts[PART_SPECULAR]};
    size_t x = pixel % (size_t)lattice->width / (size_t)lattice->stride,
           y = pixel / (size_t)lattice->width / (size_t)lattice->stride;
    double *sums = lattice->sums + (y * (size_t)lattice->columns + x) * NOISE_VALUES, value[3];
    sums[SUM_COUNT] += 1.0;
    sums[SUM_LIT] += rgb_is_black(sample->radiance) ? 0.0 : 1.0;
    sums[SUM_SKY_LIT] += rgb_is_black(sky) ? 0.0 : 1.0;
    develop(response, sample->radiance, value);
    for (int c = 0; c < 3; c++) {
        sums[SUM_COLOR + c] += value[c];
        sums[SUM_COLOR_SQUARES + c] += value[c] * value[c];
    }
    for (int i = 0; i < AG_NOISE_SOURCE_COUNT; i++) {
        if (!rgb_is_finite(sources[i]))
            continue;
        develop(response, sources[i], value);
        double mean = (value[0] + value[1] + value[2]) / 3.0;
        sums[SUM_SOURCE + i] += mean;
        sums[SUM_SOURCE_SQUARES + i] += mean * mean;
    }
}

double noise_shown_variance(double mean, double variance)
{
    /* d sqrt(x) = dx / (2 sqrt(x)); above white d ln(x) / 2, which has the same slope there */
    return 0.25 * variance / (double_max(mean, DARKEST) * double_max(mean, 1.0));
}

/* The variance of the mean of so many samples. */
static double variance_of_mean(double count, double sum, double squares)
{
    return double_max(squares - sum * sum / count, 0.0) / ((count - 1.0) * count);
}

noise_summary noise_lattice_read(const noise_lattice *lattice, double scale, int caustic_nearest)
{
    noise_summary out = {.level = -1.0};
    double of_source[AG_NOISE_SOURCE_COUNT] = {0}, all = 0.0, lit = 0.0, sky_lit = 0.0, grain = 0.0, pixels = 0.0;
    for (size_t i = 0; i < (size_t)lattice->columns * (size_t)lattice->rows; i++) {
        const double *sums = lattice->sums + i * NOISE_VALUES;
        double count = sums[SUM_COUNT], mean = 0.0, variance = 0.0;
        if (count < 2.0)
            continue;
        for (int c = 0; c < 3; c++) {
            mean += scale * sums[SUM_COLOR + c] / (3.0 * count);
            variance += scale * scale / 3.0 * variance_of_mean(count, sums[SUM_COLOR + c], sums[SUM_COLOR_SQUARES + c]);
        }
        pixels += 1.0;
        all += noise_shown_variance(mean, variance);
        lit += sums[SUM_LIT];
        sky_lit += sums[SUM_SKY_LIT];
        for (int k = 0; k < AG_NOISE_SOURCE_COUNT; k++)
            of_source[k] += noise_shown_variance(
                mean, scale * scale * variance_of_mean(count, sums[SUM_SOURCE + k], sums[SUM_SOURCE_SQUARES + k]));
        double caustic = scale * sums[SUM_SOURCE + AG_NOISE_CAUSTIC] / count;
        if (caustic_nearest > 0) /* photons of about equal flux: the relative variance of a sum of so many */
            grain += noise_shown_variance(mean, caustic * caustic / caustic_nearest);
    }
    if (pixels == 0.0)
        return out;
    out.level = sqrt(all / pixels);
    out.level_with_grain = sqrt((all + grain) / pixels);
    out.sky_seen = lit > 0.0 ? sky_lit / lit : 0.0;
    out.is_caustic_grain = grain > of_source[AG_NOISE_CAUSTIC];
    of_source[AG_NOISE_CAUSTIC] += grain;
    double sum = 0.0;
    for (int k = 0; k < AG_NOISE_SOURCE_COUNT; k++)
        sum += of_source[k];
    for (int k = 0; k < AG_NOISE_SOURCE_COUNT && sum > 0.0; k++)
        out.share[k] = of_source[k] / sum;
    return out;
}
