/* texture_image_lookup.c: values of pictures at a place, see texture_image.h. Threads: pure functions. */
#include "texture/texture_image.h"

#include "texture/texture_udim.h"

static pixel_blend find_pixels(const texture_image *i, texture_wraps wraps, texture_filter filter, float s, float t)
{
    return pixel_blend_at(i->width, i->height, wraps, filter, s, t);
}

static float sum_channel(const texture_image *i, const pixel_blend *f, size_t channel)
{
    float sum = 0.0f;
    for (int k = 0; k < f->count; k++) {
        const size_t at = f->pixel[k] * i->channel_count + channel;
        sum += f->weight[k] * (i->bytes ? i->table[i->bytes[at]] : i->values[at]);
    }
    return sum;
}

rgb texture_image_rgb(const texture_image *i, texture_wraps wraps, texture_filter filter, float s, float t)
{
    if (i->udim && !texture_udim_enter(&i, &wraps, &s, &t))
        return rgb_gray(0.0f);
    if (i->is_stored)
        return texture_level_rgb(&i->mips->levels[0], wraps, filter, s, t);
    const pixel_blend f = find_pixels(i, wraps, filter, s, t);
    const float first = sum_channel(i, &f, 0);
    return i->channel_count == 1 ? rgb_gray(first) : rgb_make(first, sum_channel(i, &f, 1), sum_channel(i, &f, 2));
}

rgb texture_image_color(const texture_image *i, texture_wraps wraps, texture_filter filter, float s, float t)
{
    if (i->udim && !texture_udim_enter(&i, &wraps, &s, &t))
        return rgb_gray(0.0f);
    rgb c = texture_image_rgb(i, wraps, filter, s, t);
    return i->colors.has_matrix ? image_colors_convert(&i->colors, c) : c;
}

/* is_encoded: bytes are decoded as those of colours are. */
static float sum_alpha(const texture_image *i, const pixel_blend *f, bool is_encoded)
{
    float sum = 0.0f;
    for (int k = 0; k < f->count; k++) {
        const size_t pixel = f->pixel[k];
        const float alpha = i->alpha_bytes && is_encoded ? i->table[i->alpha_bytes[pixel]]
                            : i->alpha_bytes             ? (float)i->alpha_bytes[pixel] * (1.0f / 255.0f)
                            : i->alpha_values            ? i->alpha_values[pixel]
                                                         : 1.0f;
        sum += f->weight[k] * alpha;
    }
    return sum;
}

/* 1 where there is none, and on the black beyond the picture's edges 0. */
static float stored_alpha(const texture_image *i, bool is_encoded, texture_wraps wraps, texture_filter filter, float s,
                          float t)
{
    texture_level alpha = i->stored_alpha;
    if (!alpha.tiles) {
        const pixel_blend f = find_pixels(i, wraps, filter, s, t);
        return sum_alpha(i, &f, is_encoded);
    }
    alpha.table = is_encoded ? i->table : NULL;
    return texture_level_rgb(&alpha, wraps, filter, s, t).r;
}

static float stored_float(const texture_image *i, texture_channel channel, texture_wraps wraps, texture_filter filter,
                          float s, float t)
{
    if (channel == TEXTURE_CHANNEL_A)
        return stored_alpha(i, false, wraps, filter, s, t);
    if (channel == TEXTURE_CHANNEL_ALL && i->channel_count == 3 && texture_image_has_alpha(i))
        return stored_alpha(i, true, wraps, filter, s, t);
    const rgb c = texture_level_rgb(&i->mips->levels[0], wraps, filter, s, t);
    if (i->channel_count == 1 || channel == TEXTURE_CHANNEL_R)
        return c.r;
    if (channel == TEXTURE_CHANNEL_ALL || channel == TEXTURE_CHANNEL_MEAN)
        return (c.r + c.g + c.b) * (1.0f / 3.0f);
    return channel == TEXTURE_CHANNEL_G ? c.g : c.b;
}

float texture_image_float(const texture_image *i, texture_channel channel, texture_wraps wraps, texture_filter filter,
                          float s, float t)
{
    if (i->udim && !texture_udim_enter(&i, &wraps, &s, &t))
        return 0.0f;
    if (i->is_stored)
        return stored_float(i, channel, wraps, filter, s, t);
    const pixel_blend f = find_pixels(i, wraps, filter, s, t);
    if (channel == TEXTURE_CHANNEL_A)
        return sum_alpha(i, &f, false);
    if (channel == TEXTURE_CHANNEL_ALL && i->channel_count == 3 && texture_image_has_alpha(i))
        return sum_alpha(i, &f, true);
    if (i->channel_count == 1)
        return sum_channel(i, &f, 0);
    if (channel == TEXTURE_CHANNEL_ALL || channel == TEXTURE_CHANNEL_MEAN)
        return (sum_channel(i, &f, 0) + sum_channel(i, &f, 1) + sum_channel(i, &f, 2)) * (1.0f / 3.0f);
    return sum_channel(i, &f, (size_t)(channel - TEXTURE_CHANNEL_R));
}
