/* texture_image.c: see texture_image.h. Threads: one loads; then any number look up. */
#define _POSIX_C_SOURCE 200809L
#include "texture/texture_image.h"

#include "image/image_reader.h"
#include "scene.h"
#include "status.h"

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

static void find_range(texture_image *i)
{
    const float *values = i->bytes ? i->table : i->values;
    const size_t count = i->bytes ? 256 : (size_t)i->width * i->height * i->channel_count;
    i->least = INFINITY;
    i->most = -INFINITY;
    for (size_t k = 0; k < count; k++) {
        i->least = fminf(i->least, values[k]);
        i->most = fmaxf(i->most, values[k]);
    }
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
    if (status == AG_OK)
        find_range(i);
    image_reset(&picture);
    return status;
}

/* With its coarser levels, which may be made later, and alpha. */
static uint64_t whole_bytes(const texture_image *i)
{
    const uint64_t pixels = (uint64_t)i->width * i->height, values = pixels * i->channel_count;
    const uint64_t finest = i->bytes ? values : values * sizeof *i->values;
    const uint64_t coarser = values / 3 * (i->bytes ? sizeof(uint16_t) : sizeof(float));
    return finest + coarser + (i->alpha_bytes ? pixels : 0) + (i->alpha_values ? pixels * sizeof *i->alpha_values : 0);
}

/* Moves what does not fit into the scene's store, pixels, coarser levels and alpha. */
static ag_status put_into_store(scene *s, texture_image *i, char *message, size_t message_size)
{
    const texture_level finest = texture_image_finest(i);
    i->stored_content = texture_image_content(i);
    AG_TRY(texture_mips_create(NULL, &finest, &i->mips));
    AG_TRY(texture_mips_put(i->mips, s->texture_store, message, message_size));
    if (texture_image_has_alpha(i)) {
        i->stored_alpha = (texture_level){.width = i->width,
                                          .height = i->height,
                                          .channel_count = 1,
                                          .sample = i->alpha_bytes ? TEXTURE_BYTES : TEXTURE_FLOATS,
                                          .bytes = i->alpha_bytes,
                                          .values = i->alpha_values};
        AG_TRY(texture_level_put(&i->stored_alpha, s->texture_store, message, message_size));
    }
    free(i->bytes);
    free(i->values);
    free(i->alpha_bytes);
    free(i->alpha_values);
    i->bytes = i->alpha_bytes = NULL;
    i->values = i->alpha_values = NULL;
    i->is_stored = true;
    return AG_OK;
}

static ag_status hold_within_limit(scene *s, texture_image *i, char *message, size_t message_size)
{
    const uint64_t limit_bytes = s->request ? s->request->texture_memory_bytes : 0;
    if (limit_bytes == 0)
        return AG_OK;
    if (!s->texture_store)
        s->texture_store = texture_store_create(limit_bytes);
    if (!s->texture_store)
        return AG_ERROR_MEMORY;
    return texture_store_keeps(s->texture_store, whole_bytes(i)) ? AG_OK : put_into_store(s, i, message, message_size);
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
    if (status == AG_OK)
        status = hold_within_limit(s, i, message, message_size);
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
    texture_tiles_destroy(i->stored_alpha.tiles);
    free(i);
}

texture_level texture_image_finest(const texture_image *i)
{
    return (texture_level){.width = i->width,
                           .height = i->height,
                           .channel_count = i->channel_count,
                           .sample = i->bytes ? TEXTURE_BYTES : TEXTURE_FLOATS,
                           .bytes = i->bytes,
                           .table = i->table,
                           .values = i->values};
}

static void add_array(hash128 *h, const void *items, size_t count, size_t item_size)
{
    HASH128_ADD(h, count);
    hash128_add(h, items, items ? count * item_size : 0);
}

hash128 texture_image_content(const texture_image *i)
{
    const size_t count = (size_t)i->width * i->height;
    hash128 h = hash128_begin();
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
