/* texture_image.c: see texture_image.h. Threads: one loads; then any number look up. */
#define _POSIX_C_SOURCE 200809L
#include "texture/texture_image.h"

#include "image/image_reader.h"
#include "scene.h"

#include <stdlib.h>
#include <string.h>

/* Loading */

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
static ag_status decode_pixels(const scene *s, texture_image *i, const image *picture, char *message,
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
    ag_status status = image_colors_decode(s, &i->colors, i->values, pixel_count, message, message_size);
    clean_values(i, 3 * pixel_count);
    return status;
}

/* Takes the picture's pixels. */
static ag_status take_pixels(const scene *s, texture_image *i, image *picture, char *message, size_t message_size)
{
    const size_t channel_count = (size_t)picture->channel_count, kept = channel_count >= 3 ? 3 : 1;
    const size_t pixel_count = (size_t)picture->width * (size_t)picture->height;
    i->width = (uint32_t)picture->width;
    i->height = (uint32_t)picture->height;
    i->channel_count = (uint32_t)kept;
    ag_status status = take_alpha(i, picture, pixel_count);
    if (status == AG_OK)
        status = image_colors_find(s, i->encoding, picture, &i->colors, message, message_size);
    if (status != AG_OK)
        return status;
    if (i->colors.space)
        return decode_pixels(s, i, picture, message, message_size);
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

/* A file's bytes; NULL: they are on disk. */
typedef struct file_bytes {
    const unsigned char *bytes;
    size_t size;
} file_bytes;

static ag_status read_image(const scene *s, texture_image *i, const char *path, file_bytes file, char *message,
                            size_t message_size)
{
    i->path = strdup(path);
    if (!i->path)
        return AG_ERROR_MEMORY;
    image picture;
    ag_status status = file.bytes ? image_read_memory(path, file.bytes, file.size, &picture, message, message_size)
                                  : image_read_compact(path, &picture, message, message_size);
    if (status == AG_OK)
        status = take_pixels(s, i, &picture, message, message_size);
    image_reset(&picture);
    return status;
}

static ag_status load(scene *s, const char *path, file_bytes file, image_encoding encoding, uint32_t *out_index,
                      char *message, size_t message_size)
{
    for (uint32_t k = 0; k < s->texture_image_count; k++)
        if (image_encoding_equal(s->texture_images[k]->encoding, encoding) &&
            strcmp(s->texture_images[k]->path, path) == 0) {
            *out_index = k;
            return AG_OK;
        }
    texture_image *i = calloc(1, sizeof *i);
    if (!i)
        return AG_ERROR_MEMORY;
    i->encoding = encoding;
    ag_status status = read_image(s, i, path, file, message, message_size);
    if (status != AG_OK)
        texture_image_destroy(i);
    return status ? status : scene_add_texture_image(s, i, out_index);
}

ag_status texture_image_load(struct scene *s, const char *path, image_encoding encoding, uint32_t *out_index,
                             char *message, size_t message_size)
{
    return load(s, path, (file_bytes){NULL, 0}, encoding, out_index, message, message_size);
}

ag_status texture_image_load_memory(struct scene *s, const char *name, const unsigned char *bytes, size_t size,
                                    image_encoding encoding, uint32_t *out_index, char *message, size_t message_size)
{
    return load(s, name, (file_bytes){bytes, size}, encoding, out_index, message, message_size);
}

void texture_image_destroy(texture_image *i)
{
    if (!i)
        return;
    free(i->path);
    free(i->bytes);
    free(i->values);
    free(i->alpha_bytes);
    free(i->alpha_values);
    texture_mips_destroy(i->mips);
    free(i);
}

/* Looking up */

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
    const pixel_blend f = find_pixels(i, wraps, filter, s, t);
    const float first = sum_channel(i, &f, 0);
    return i->channel_count == 1 ? rgb_gray(first) : rgb_make(first, sum_channel(i, &f, 1), sum_channel(i, &f, 2));
}

rgb texture_image_color(const texture_image *i, texture_wraps wraps, texture_filter filter, float s, float t)
{
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

float texture_image_float(const texture_image *i, texture_channel channel, texture_wraps wraps, texture_filter filter,
                          float s, float t)
{
    const pixel_blend f = find_pixels(i, wraps, filter, s, t);
    if (channel == TEXTURE_CHANNEL_A)
        return sum_alpha(i, &f, false);
    if (channel == TEXTURE_CHANNEL_ALL && i->channel_count == 3 && (i->alpha_bytes || i->alpha_values))
        return sum_alpha(i, &f, true);
    if (i->channel_count == 1)
        return sum_channel(i, &f, 0);
    if (channel == TEXTURE_CHANNEL_ALL || channel == TEXTURE_CHANNEL_MEAN)
        return (sum_channel(i, &f, 0) + sum_channel(i, &f, 1) + sum_channel(i, &f, 2)) * (1.0f / 3.0f);
    return sum_channel(i, &f, (size_t)(channel - TEXTURE_CHANNEL_R));
}
