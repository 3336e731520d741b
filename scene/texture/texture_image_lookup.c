/* texture_image_lookup.c: values of pictures at a point, see texture_image.h. Threads: pure functions. */
#include "texture/texture_image.h"

#include "texture/texture_udim.h"

static texture_level finest_of(const texture_image *i)
{
    return i->is_stored ? i->mips->levels[0] : texture_image_finest(i);
}

rgb texture_image_rgb(const texture_image *i, texture_wraps wraps, texture_filter filter, float s, float t)
{
    if (i->udim && !texture_udim_enter(&i, &wraps, &s, &t))
        return rgb_gray(0.0f);
    const texture_level finest = finest_of(i);
    return texture_level_rgb(&finest, wraps, filter, s, t);
}

rgb texture_image_color(const texture_image *i, texture_wraps wraps, texture_filter filter, float s, float t)
{
    if (i->udim && !texture_udim_enter(&i, &wraps, &s, &t))
        return rgb_gray(0.0f);
    rgb c = texture_image_rgb(i, wraps, filter, s, t);
    return i->colors.has_matrix ? image_colors_convert(&i->colors, c) : c;
}

/* 1 where there is none, and on the black beyond the picture's edges 0. is_encoded: bytes are decoded as those of
 * colours are. */
static float alpha_at(const texture_image *i, bool is_encoded, texture_wraps wraps, texture_filter filter, float s,
                      float t)
{
    if (texture_image_has_alpha(i)) {
        const texture_level alpha = texture_image_alpha(i, is_encoded);
        return texture_level_channel(&alpha, 0, wraps, filter, s, t);
    }
    const pixel_blend blend = pixel_blend_at(i->width, i->height, wraps, filter, s, t);
    float sum = 0.0f;
    for (int k = 0; k < blend.count; k++)
        sum += blend.weight[k];
    return sum;
}

float texture_image_float(const texture_image *i, texture_channel channel, texture_wraps wraps, texture_filter filter,
                          float s, float t)
{
    /* of the whole: a tile without alpha is opaque where others have it */
    const bool is_encoded_alpha = channel == TEXTURE_CHANNEL_ALL && i->channel_count == 3 && texture_image_has_alpha(i);
    if (i->udim && !texture_udim_enter(&i, &wraps, &s, &t))
        return 0.0f;
    if (is_encoded_alpha || channel == TEXTURE_CHANNEL_A)
        return alpha_at(i, is_encoded_alpha, wraps, filter, s, t);
    const texture_level finest = finest_of(i);
    if (i->channel_count == 1)
        return texture_level_channel(&finest, 0, wraps, filter, s, t);
    if (channel == TEXTURE_CHANNEL_ALL || channel == TEXTURE_CHANNEL_MEAN) {
        const rgb c = texture_level_rgb(&finest, wraps, filter, s, t);
        return (c.r + c.g + c.b) * (1.0f / 3.0f);
    }
    return texture_level_channel(&finest, (uint32_t)(channel - TEXTURE_CHANNEL_R), wraps, filter, s, t);
}
