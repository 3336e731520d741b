/* film_channels.c: see film_channels.h. */
#include "film/film_channels.h"

#include "film/film_sums.h"

/* Depth where there is nothing, as Cycles has it: far, but a number. */
static const float DEPTH_OF_NOTHING = 1e10f;

static void read_color(const ag_film *film, size_t pixel, int offset, double out[3])
{
    film_sums_mean(film, pixel, offset, 3, out);
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

static float read_value(const ag_film *film, size_t pixel_of_crop, const film_channel *channel)
{
    size_t pixel = film_pixel_of_crop(film, pixel_of_crop);
    double value[3];
    int component = channel->component, at = channel->offset + component;
    const film_nearest nothing = {DEPTH_OF_NOTHING, 0, 0};
    const film_nearest *nearest = film->nearest && film->nearest[pixel].object_id ? &film->nearest[pixel] : &nothing;
    switch (channel->source) {
    case CHANNEL_BEAUTY: return film->pixels[3 * pixel_of_crop + (size_t)component];
    case CHANNEL_COLOR: read_color(film, pixel, channel->offset, value); return (float)value[component];
    case CHANNEL_MEAN: film_sums_mean(film, pixel, at, 1, value); return (float)value[0];
    case CHANNEL_HIT_MEAN: return (float)film_sums_hit_mean(film, pixel, at);
    case CHANNEL_ABSOLUTE: return (float)fabs(film_sums_hit_mean(film, pixel, at));
    case CHANNEL_DIRECTION: {
        double length_squared = 0.0;
        film_sums_mean(film, pixel, channel->offset, 3, value);
        for (int c = 0; c < 3; c++)
            length_squared += value[c] * value[c];
        return length_squared > 0.0 ? (float)(value[component] / sqrt(length_squared)) : 0.0f;
    }
    case CHANNEL_VARIANCE: return (float)film_sums_variance(film, pixel, channel, false);
    case CHANNEL_RELATIVE_VARIANCE: return (float)film_sums_variance(film, pixel, channel, true);
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
    for (size_t i = 0; i < film_crop_count(film); i++)
        out[i * stride] = read_value(film, i, &film->layout.channels[channel]);
}

void film_read_sum(const ag_film *film, film_sum sum, float *out)
{
    double value[3];
    for (size_t i = 0; i < film_crop_count(film); i++) {
        film_sums_mean(film, film_pixel_of_crop(film, i), film->layout.offset[sum], 3, value);
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
