/* image_reader.c: see image_reader.h.
 * Flow: file -> image_oiio.cpp -> [here]. Threads: any. */
#define _POSIX_C_SOURCE 200809L
#include "image/image_reader.h"

#include "image/image_module_loader.h"
#include "image/jpeg_end.h"
#include "image/png_chunks.h"
#include "text/input_file.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static ag_status refuse_cut_jpeg(image *picture, char *message, size_t message_size)
{
    image_reset(picture);
    snprintf(message, message_size, "the JPEG file is cut short");
    return AG_ERROR_INPUT;
}

/* Puts the file's own name where OpenImageIO tells the path that it has opened. */
static void name_file(char *text, size_t size, const char *opened, const char *path)
{
    char *at = opened == path ? NULL : strstr(text, opened), rest[1024];
    for (; at; at = strstr(at, opened)) {
        snprintf(rest, sizeof rest, "%s", at + strlen(opened));
        const int length = snprintf(at, size - (size_t)(at - text), "%s%s", path, rest);
        if ((size_t)length >= size - (size_t)(at - text))
            break;
        at += strlen(path);
    }
}

static bool is_cancelled(const void *run) { return run_is_cancelled(run); }

static image_request make_request(const run_context *run, image_wish wish)
{
    return (image_request){.wish = wish, .is_cancelled = run ? is_cancelled : NULL, .user = run};
}

/* Decodes a file. Its first bytes tell the format, or else the end of its name. */
static ag_status decode_file(const image_module *module, const char *opened, const char *path,
                             const image_request *request, image *out_image, char *reason, size_t reason_size)
{
    const char *wrong = png_file_chunks_wrong(opened);
    if (wrong) {
        snprintf(reason, reason_size, "%s", wrong);
        return AG_ERROR_INPUT;
    }
    ag_status status = module->decode(opened, path, request, out_image, reason, reason_size);
    if (status == AG_OK && jpeg_file_is_cut_short(opened))
        status = refuse_cut_jpeg(out_image, reason, reason_size);
    name_file(reason, reason_size, opened, path);
    return status;
}

static ag_status read_picture(const run_context *run, const char *path, image_wish wish, image *out_image,
                              char *message, size_t message_size)
{
    char reason[1024], text[INPUT_FILE_OPENED_SIZE];
    *out_image = (image){0};
    const int descriptor = input_file_open(run, path, reason, sizeof reason);
    ag_status status = AG_ERROR_INPUT;
    if (descriptor >= 0) {
        const image_module *module = image_module_get(message, message_size);
        const image_request request = make_request(run, wish);
        if (module)
            status = decode_file(module, input_file_opened_path(descriptor, path, text), path, &request, out_image,
                                 reason, sizeof reason);
        close(descriptor);
        if (!module)
            return AG_ERROR_SYSTEM;
    }
    if (status != AG_OK)
        snprintf(message, message_size, "cannot read '%s': %s", path, reason);
    return status;
}

ag_status image_read(const char *path, image *out_image, char *message, size_t message_size)
{
    return read_picture(NULL, path, IMAGE_ALL_CHANNELS, out_image, message, message_size);
}

ag_status image_read_colors(const run_context *run, const char *path, image *out_image, char *message,
                            size_t message_size)
{
    return read_picture(run, path, IMAGE_COLORS, out_image, message, message_size);
}

ag_status image_read_compact(const run_context *run, const char *path, image *out_image, char *message,
                             size_t message_size)
{
    return read_picture(run, path, IMAGE_COMPACT_COLORS, out_image, message, message_size);
}

/* Returns the extension of PNG or JPEG bytes, the formats that glTF knows; NULL for others. */
static const char *extension_of(const unsigned char *bytes, size_t size)
{
    static const unsigned char PNG[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'}, JPEG[] = {0xff, 0xd8, 0xff};
    if (size >= sizeof PNG && memcmp(bytes, PNG, sizeof PNG) == 0)
        return "png";
    return size >= sizeof JPEG && memcmp(bytes, JPEG, sizeof JPEG) == 0 ? "jpg" : NULL;
}

ag_status image_read_memory(const run_context *run, const char *name, const unsigned char *bytes, size_t size,
                            image *out_image, char *message, size_t message_size)
{
    *out_image = (image){0};
    const char *extension = extension_of(bytes, size);
    if (!extension) {
        snprintf(message, message_size, "cannot read '%s': it is neither a PNG nor a JPEG picture", name);
        return AG_ERROR_INPUT;
    }
    const char *wrong = png_chunks_wrong(bytes, size);
    if (wrong) {
        snprintf(message, message_size, "cannot read '%s': %s", name, wrong);
        return AG_ERROR_INPUT;
    }
    const image_module *module = image_module_get(message, message_size);
    if (!module)
        return AG_ERROR_SYSTEM;
    char reason[1024];
    const image_request request = make_request(run, IMAGE_COMPACT_COLORS);
    ag_status status = module->decode_memory(extension, bytes, size, &request, out_image, reason, sizeof reason);
    if (status == AG_OK && jpeg_is_cut_short(bytes, size))
        status = refuse_cut_jpeg(out_image, reason, sizeof reason);
    if (status != AG_OK)
        snprintf(message, message_size, "cannot read '%s': %s", name, reason);
    return status;
}

/* Copies a row of the data window to its place in the row of the display window, of which it may be a part. */
static void copy_row(const image *i, int y, size_t pixel_bytes, const unsigned char *from, unsigned char *out)
{
    const int64_t right = (int64_t)i->x + i->width, row = (int64_t)i->y + y;
    const int64_t begin = i->x > 0 ? i->x : 0, end = right < i->full_width ? right : i->full_width;
    if (begin >= end || row < 0 || row >= i->full_height)
        return;
    memcpy(out + (size_t)(row * i->full_width + begin) * pixel_bytes,
           from + (size_t)((int64_t)y * i->width + begin - i->x) * pixel_bytes, (size_t)(end - begin) * pixel_bytes);
}

ag_status image_fill_window(image *i, const char *name, char *message, size_t message_size)
{
    static const int64_t PIXELS_MAX = (int64_t)1 << 28;
    const bool is_filled = i->x == 0 && i->y == 0 && i->width == i->full_width && i->height == i->full_height;
    if (is_filled || i->full_width < 1 || i->full_height < 1)
        return AG_OK;
    if ((int64_t)i->full_width * i->full_height > PIXELS_MAX) {
        snprintf(message, message_size,
                 "cannot read '%s': its data window of %d x %d pixels from (%d, %d) on is not its display window of %d "
                 "x %d, which is too large to be filled up with black",
                 name, i->width, i->height, i->x, i->y, i->full_width, i->full_height);
        return AG_ERROR_INPUT;
    }
    const size_t pixel_bytes = (size_t)i->channel_count * (i->bytes ? 1 : sizeof *i->pixels);
    void *window = calloc((size_t)i->full_width * (size_t)i->full_height, pixel_bytes);
    if (!window)
        return AG_ERROR_MEMORY;
    for (int y = 0; y < i->height; y++)
        copy_row(i, y, pixel_bytes, i->bytes ? i->bytes : (const unsigned char *)i->pixels, window);
    if (i->bytes) {
        free(i->bytes);
        i->bytes = window;
    } else {
        free(i->pixels);
        i->pixels = window;
    }
    i->width = i->full_width;
    i->height = i->full_height;
    i->x = i->y = 0;
    return AG_OK;
}

bool image_copy(const image *picture, bool as_floats, image *out_copy)
{
    const size_t count = (size_t)picture->width * (size_t)picture->height * (size_t)picture->channel_count;
    const size_t value_bytes = picture->bytes && !as_floats ? 1 : sizeof *picture->pixels;
    void *values = malloc(count * value_bytes);
    *out_copy = values ? *picture : (image){0};
    if (!values)
        return false;
    out_copy->bytes = value_bytes == 1 ? values : NULL;
    out_copy->pixels = value_bytes == 1 ? NULL : values;
    if (!picture->bytes || !as_floats) {
        memcpy(values, picture->bytes ? (const void *)picture->bytes : picture->pixels, count * value_bytes);
        return true;
    }
    for (size_t i = 0; i < count; i++)
        out_copy->pixels[i] = (float)picture->bytes[i] * (1.0f / 255.0f);
    return true;
}

void image_reset(image *picture)
{
    free(picture->pixels);
    free(picture->bytes);
    *picture = (image){0};
}
