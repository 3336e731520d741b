/* texture_image.c: see texture_image.h. Threads: one takes; then any number look up. */
#define _POSIX_C_SOURCE 200809L
#include "texture/texture_image.h"

#include "image/image.h"
#include "texture/texture_cache.h"
#include "texture/texture_file_levels.h"
#include "texture/texture_udim.h"

#include <stdlib.h>
#include <string.h>

/* Keeps the first `kept` of the channels, in place; gives the array, which may have moved. */
static void *keep_channels(void *values, size_t value_size, size_t pixel_count, size_t channel_count, size_t kept)
{
    if (kept == channel_count)
        return values;
    char *bytes = values;
    for (size_t pixel = 0; pixel < pixel_count; pixel++)
        memmove(bytes + pixel * kept * value_size, bytes + pixel * channel_count * value_size, kept * value_size);
    void *smaller = realloc(values, pixel_count * kept * value_size);
    return smaller ? smaller : values;
}

/* Alpha as a plane of its own, which look-ups of colours step over; none where it is 1 everywhere. */
static ag_status take_alpha(texture_image *i, const image *picture, size_t pixel_count)
{
    const size_t channel_count = (size_t)picture->channel_count, alpha = channel_count >= 3 ? 3 : 1;
    bool is_opaque = true;
    if (channel_count <= alpha)
        return AG_OK;
    for (size_t k = 0; k < pixel_count && is_opaque; k++)
        is_opaque = picture->bytes ? picture->bytes[k * channel_count + alpha] == 255
                                   : picture->pixels[k * channel_count + alpha] == 1.0f;
    if (is_opaque)
        return AG_OK;
    if (picture->bytes)
        i->alpha_bytes = malloc(pixel_count);
    else
        i->alpha_values = malloc(pixel_count * sizeof *i->alpha_values);
    if (!i->alpha_bytes && !i->alpha_values)
        return AG_ERROR_MEMORY;
    for (size_t k = 0; k < pixel_count; k++) {
        if (picture->bytes) {
            i->alpha_bytes[k] = picture->bytes[k * channel_count + alpha];
            continue;
        }
        const float value = picture->pixels[k * channel_count + alpha];
        const bool is_good = isfinite(value);
        i->bad_count += is_good ? 0 : 1;
        i->alpha_values[k] = is_good ? value : 0.0f;
    }
    return AG_OK;
}

static void clean_values(texture_image *i, size_t count)
{
    for (size_t k = 0; k < count; k++)
        if (!isfinite(i->values[k])) {
            i->values[k] = 0.0f;
            i->bad_count++;
        }
}

/* From a colour space that is more than a curve and a matrix: three floats for each pixel, of the working space. */
static ag_status decode_pixels(const image_colors_target *target, texture_image *i, const image *picture, char *message,
                               size_t message_size)
{
    const size_t pixel_count = (size_t)picture->width * (size_t)picture->height;
    const size_t channel_count = (size_t)picture->channel_count;
    i->values = malloc(3 * pixel_count * sizeof *i->values);
    if (!i->values)
        return AG_ERROR_MEMORY;
    for (size_t pixel = 0; pixel < pixel_count; pixel++)
        for (size_t k = 0; k < 3; k++) {
            const size_t from = pixel * channel_count + (channel_count >= 3 ? k : 0);
            i->values[3 * pixel + k] =
                picture->bytes ? (float)picture->bytes[from] * (1.0f / 255.0f) : picture->pixels[from];
        }
    i->channel_count = 3;
    if (i->alpha_bytes) { /* they go with bytes */
        i->alpha_values = malloc(pixel_count * sizeof *i->alpha_values);
        if (!i->alpha_values)
            return AG_ERROR_MEMORY;
        for (size_t k = 0; k < pixel_count; k++)
            i->alpha_values[k] = (float)i->alpha_bytes[k] * (1.0f / 255.0f);
        free(i->alpha_bytes);
        i->alpha_bytes = NULL;
    }
    ag_status status = image_colors_decode(target, &i->colors, i->values, pixel_count, message, message_size);
    clean_values(i, 3 * pixel_count);
    return status;
}

/* Takes the picture's pixels. */
static ag_status take_pixels(const image_colors_target *target, texture_image *i, image *picture, char *message,
                             size_t message_size)
{
    const size_t channel_count = (size_t)picture->channel_count, kept = channel_count >= 3 ? 3 : 1;
    const size_t pixel_count = (size_t)picture->width * (size_t)picture->height;
    i->width = (uint32_t)picture->width;
    i->height = (uint32_t)picture->height;
    i->channel_count = (uint32_t)kept;
    ag_status status = take_alpha(i, picture, pixel_count);
    if (status == AG_OK)
        status = image_colors_find(target, i->encoding, picture, &i->colors, message, message_size);
    if (status != AG_OK)
        return status;
    if (i->colors.space)
        return decode_pixels(target, i, picture, message, message_size);
    if (picture->bytes) {
        i->bytes = keep_channels(picture->bytes, 1, pixel_count, channel_count, kept);
        picture->bytes = NULL;
        return image_encoding_table(i->colors.encoding, 256, i->table, message, message_size);
    }
    picture->pixels = keep_channels(picture->pixels, sizeof *picture->pixels, pixel_count, channel_count, kept);
    picture->channel_count = (int)kept;
    status = image_linearize(picture, i->colors.encoding, message, message_size);
    i->values = picture->pixels;
    picture->pixels = NULL;
    clean_values(i, pixel_count * kept);
    return status;
}

static void find_range(texture_image *i)
{
    const float *values = i->bytes ? i->table : i->values;
    const size_t count = i->bytes ? 256 : (size_t)i->width * i->height * i->channel_count;
    i->least = INFINITY;
    i->most = -INFINITY;
    for (size_t k = 0; k < count; k++) {
        i->least = values[k] < i->least ? values[k] : i->least;
        i->most = values[k] > i->most ? values[k] : i->most;
    }
}

ag_status texture_image_take(const image_colors_target *target, texture_image *i, image *picture, char *message,
                             size_t message_size)
{
    ag_status status = take_pixels(target, i, picture, message, message_size);
    if (status == AG_OK)
        find_range(i);
    return status;
}

/* From now on its pixels may be held by several. */
static bool begin_share(texture_image *i)
{
    if (i->share)
        return true;
    i->share = calloc(1, sizeof *i->share);
    if (!i->share)
        return false;
    i->share->holder_count = 1;
    i->share->mips = i->mips;
    memcpy(i->share->table, i->table, sizeof i->table);
    if (i->mips && i->mips->levels[0].table)
        i->mips->levels[0].table = i->share->table;
    return true;
}

texture_image *texture_image_hold(texture_image *i)
{
    texture_image *other = malloc(sizeof *other);
    char *path = strdup(i->path);
    if (!other || !path || !begin_share(i)) {
        free(other);
        free(path);
        return NULL;
    }
    i->share->holder_count++;
    *other = *i;
    other->path = path;
    other->mips = NULL;
    return other;
}

void texture_image_drop_store(texture_image *i)
{
    texture_mips_destroy(i->mips);
    texture_tiles_destroy(i->stored_alpha.tiles);
    texture_kept_destroy(i->kept);
    i->mips = NULL;
    i->kept = NULL;
    memset(&i->stored_alpha, 0, sizeof i->stored_alpha);
}

void texture_image_destroy(texture_image *i)
{
    if (!i)
        return;
    free(i->path);
    if (i->share && --i->share->holder_count > 0) {
        free(i);
        return;
    }
    free(i->bytes);
    free(i->values);
    free(i->alpha_bytes);
    free(i->alpha_values);
    texture_mips_destroy(i->share ? i->share->mips : i->mips);
    free(i->share);
    texture_tiles_destroy(i->stored_alpha.tiles);
    texture_file_levels_destroy(i->file);
    texture_kept_destroy(i->kept);
    texture_udim_destroy(i->udim);
    free(i);
}

static void add_array(hash128 *h, const void *items, size_t count, size_t item_size)
{
    HASH128_ADD(h, count);
    hash128_add(h, items, items ? count * item_size : 0);
}

/* How the file's values are converted: the bytes of the file do not say that the scene has them decoded otherwise. */
static hash128 file_content(const texture_image *i)
{
    const image_encoding encoding = i->colors.encoding;
    const image_curve curve = encoding.curve == IMAGE_CURVE_DEFAULT ? IMAGE_CURVE_SRGB : encoding.curve;
    hash128 h = texture_file_content(i->path);
    HASH128_ADD(&h, curve);
    HASH128_ADD(&h, encoding.gamma);
    return h;
}

hash128 texture_image_content(const texture_image *i)
{
    const size_t count = (size_t)i->width * i->height;
    hash128 h = hash128_begin();
    if (i->udim)
        return texture_udim_content(i->udim);
    if (i->is_by_file)
        return file_content(i);
    if (i->is_stored)
        return i->stored_content;
    if (i->bytes)
        HASH128_ADD(&h, i->table);
    add_array(&h, i->bytes, count * i->channel_count, 1);
    add_array(&h, i->values, count * i->channel_count, sizeof *i->values);
    add_array(&h, i->alpha_bytes, count, 1);
    add_array(&h, i->alpha_values, count, sizeof *i->alpha_values);
    return h;
}
