/* image_file.c: what may be written under which name, and the way from pixels to a finished file.
 * Flow: film, colour -> [here] -> image_openexr.c or image_oiio.cpp (bytes) -> atomic_file.c (disk). Threads: see
 * image_file.h. */
#include "output/image_file.h"

#include "atomic_file.h"
#include "image/image_module_loader.h"
#include "output/image_openexr.h"
#include "status.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct format_entry {
    image_format format;   /* first: image_format_can_hold gets back to its entry from it */
    unsigned sample_types; /* bits 1 << image_sample_type */
    int channel_limit;     /* 0: none */
} format_entry;

#define BIT(type) (1u << (type))

static const format_entry formats[] = {
    {{"exr", true, IMAGE_HALF, true}, BIT(IMAGE_HALF) | BIT(IMAGE_FLOAT), 0},
    {{"hdr", true, IMAGE_FLOAT, false}, BIT(IMAGE_FLOAT), 3},
    {{"pfm", true, IMAGE_FLOAT, false}, BIT(IMAGE_FLOAT), 3},
    {{"png", false, IMAGE_UINT8, false}, BIT(IMAGE_UINT8) | BIT(IMAGE_UINT16), 4},
    {{"tif", false, IMAGE_UINT16, false}, BIT(IMAGE_UINT8) | BIT(IMAGE_UINT16) | BIT(IMAGE_FLOAT), 0},
    {{"tiff", false, IMAGE_UINT16, false}, BIT(IMAGE_UINT8) | BIT(IMAGE_UINT16) | BIT(IMAGE_FLOAT), 0},
    {{"jpg", false, IMAGE_UINT8, false}, BIT(IMAGE_UINT8), 0},
    {{"jpeg", false, IMAGE_UINT8, false}, BIT(IMAGE_UINT8), 0},
};
enum { FORMAT_COUNT = sizeof formats / sizeof *formats };

static const char *const type_names[] = {
    [IMAGE_UINT8] = "8-bit", [IMAGE_UINT16] = "16-bit", [IMAGE_HALF] = "half", [IMAGE_FLOAT] = "float"};

/* Compares ASCII letters, whatever the locale. */
static bool same_letters(const char *text, const char *lower_case)
{
    for (; *text != '\0' && *lower_case != '\0'; text++, lower_case++) {
        const char letter = *text >= 'A' && *text <= 'Z' ? (char)(*text - 'A' + 'a') : *text;
        if (letter != *lower_case)
            return false;
    }
    return *text == *lower_case;
}

const image_format *image_format_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path;
    const char *dot = strrchr(name, '.');
    if (!dot || dot == name) /* ".png" is a hidden file without an extension */
        return NULL;
    for (int i = 0; i < FORMAT_COUNT; i++)
        if (same_letters(dot + 1, formats[i].format.extension))
            return &formats[i].format;
    return NULL;
}

bool image_format_can_hold(const image_format *format, image_sample_type type)
{
    return ((const format_entry *)(const void *)format)->sample_types & BIT(type);
}

static ag_status unknown_extension(const char *path, char *message, size_t message_size)
{
    char known[128] = "";
    for (int i = 0; i < FORMAT_COUNT; i++) {
        const size_t length = strlen(known);
        snprintf(known + length, sizeof known - length, "%s.%s", i > 0 ? ", " : "", formats[i].format.extension);
    }
    snprintf(message, message_size, "cannot write '%s': its extension is not one of %s", path, known);
    return AG_ERROR_OUTPUT;
}

/* Refuses a description that is not valid, which is the caller's error, and what the format cannot hold. */
static ag_status check_description(const char *path, const image_format *format, const image_description *description,
                                   char *message, size_t message_size)
{
    const format_entry *entry = (const format_entry *)(const void *)format;
    if (description->width < 1 || description->height < 1 || description->full_width < 1 ||
        description->full_height < 1 || description->channel_count < 1 || !description->channel_names ||
        description->attribute_count < 0 || (description->attribute_count > 0 && !description->attributes)) {
        snprintf(message, message_size, "cannot write '%s': the picture's description is not valid", path);
        return AG_ERROR_ARGUMENT;
    }
    if (!image_format_can_hold(format, description->type)) {
        snprintf(message, message_size, "cannot write '%s': %s cannot hold %s values", path, format->extension,
                 type_names[description->type]);
        return AG_ERROR_OUTPUT;
    }
    if (entry->channel_limit > 0 && description->channel_count > entry->channel_limit) {
        snprintf(message, message_size, "cannot write '%s': %s cannot hold %d channels", path, format->extension,
                 description->channel_count);
        return AG_ERROR_OUTPUT;
    }
    return AG_OK;
}

/* Portable float map: three floats a pixel, the bottom row first; a scale below 0 says that they are little-endian.
 * Rests on: Debevec, "PFM Portable FloatMap Image Format", pauldebevec.com/Research/HDR/PFM. */
static ag_status encode_pfm(const image_description *description, const float *pixels, unsigned char **out_bytes,
                            size_t *out_size)
{
    char header[64];
    const size_t width = (size_t)description->width, height = (size_t)description->height;
    const size_t channels = (size_t)description->channel_count, row = 3 * width * sizeof *pixels;
    const size_t header_size = (size_t)snprintf(header, sizeof header, "PF\n%zu %zu\n-1.0\n", width, height);
    unsigned char *bytes = malloc(header_size + height * row);
    if (!bytes)
        return AG_ERROR_MEMORY;
    memcpy(bytes, header, header_size);
    for (size_t y = 0; y < height; y++)
        for (size_t x = 0; x < width; x++)
            memcpy(bytes + header_size + (height - 1 - y) * row + 3 * x * sizeof *pixels,
                   pixels + (y * width + x) * channels, 3 * sizeof *pixels);
    *out_bytes = bytes;
    *out_size = header_size + height * row;
    return AG_OK;
}

/* EXR and PFM are written without OpenImageIO. */
static bool needs_module(const image_format *format)
{
    return strcmp(format->extension, "exr") != 0 && strcmp(format->extension, "pfm") != 0;
}

ag_status image_file_write(const run_context *run, const char *path, const image_description *description,
                           const float *pixels, char *message, size_t message_size)
{
    snprintf(message, message_size, "%s", "");
    const image_format *format = image_format_of(path);
    if (!format)
        return unknown_extension(path, message, message_size);
    AG_TRY(check_description(path, format, description, message, message_size));
    const image_module *module = NULL;
    if (needs_module(format) && !(module = image_module_get(message, message_size)))
        return AG_ERROR_SYSTEM;

    unsigned char *bytes = NULL;
    size_t size = 0;
    char reason[1024] = "there is no memory for it";
    ag_status status;
    if (module)
        status = module->encode(format->extension, description, pixels, &bytes, &size, reason, sizeof reason);
    else if (format->has_layers)
        status = image_openexr_encode(description, pixels, &bytes, &size, reason, sizeof reason);
    else
        status = encode_pfm(description, pixels, &bytes, &size);
    if (status == AG_OK)
        status = atomic_file_write(run, path, bytes, size, message, message_size);
    else
        snprintf(message, message_size, "cannot write '%s': %s", path, reason);
    free(bytes);
    return status;
}

ag_status image_file_check_target(const char *path, char *message, size_t message_size)
{
    const image_format *format = image_format_of(path);
    if (!format)
        return unknown_extension(path, message, message_size);
    AG_TRY(atomic_file_check(path, message, message_size));
    return needs_module(format) && !image_module_get(message, message_size) ? AG_ERROR_SYSTEM : AG_OK;
}
