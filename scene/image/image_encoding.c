/* image_encoding.c: see image_encoding.h. Threads: any. */
#include "image/image_encoding.h"

#include "color/color.h"
#include "image/image.h"
#include "status.h"
#include "text/decimal.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool image_encoding_parse(const char *text, image_encoding *out_encoding)
{
    static const char GAMMA[] = "gamma ";
    image_encoding encoding = {.curve = IMAGE_CURVE_LINEAR};
    if (strcmp(text, "sRGB") == 0) {
        encoding.curve = IMAGE_CURVE_SRGB;
    } else if (strncmp(text, GAMMA, sizeof GAMMA - 1) == 0) {
        const char *number = text + sizeof GAMMA - 1;
        double gamma = 0.0;
        number = decimal_parse(number, &gamma);
        if (!number || *number != '\0' || !(gamma > 0.0 && gamma <= 1000.0))
            return false;
        encoding = (image_encoding){.curve = IMAGE_CURVE_GAMMA, .gamma = (float)gamma};
    } else if (strcmp(text, "linear") != 0) {
        return false;
    }
    *out_encoding = encoding;
    return true;
}

static image_curve curve_of(image_encoding e) { return e.curve == IMAGE_CURVE_DEFAULT ? IMAGE_CURVE_SRGB : e.curve; }

bool image_encoding_equal(image_encoding a, image_encoding b)
{
    if (curve_of(a) != curve_of(b))
        return false;
    if (a.curve == IMAGE_CURVE_SPACE)
        return a.space == b.space && a.is_rule == b.is_rule;
    return a.curve != IMAGE_CURVE_GAMMA || a.gamma == b.gamma;
}

/* Decodes numbers as greys, since OpenColorIO takes colours. It uses the config that is compiled in, because what the
 * encodings mean is the scene file's matter and not that of the user's config. */
static ag_status decode_greys(const color_config *config, float *greys, size_t count, char *message,
                              size_t message_size)
{
    color_processor *processor;
    AG_TRY(color_decoder_create(config, "sRGB - Texture", message, message_size, &processor));
    const ag_status status = color_processor_apply(processor, greys, count, message, message_size);
    color_processor_destroy(processor);
    return status;
}

static ag_status decode_srgb(float *values, size_t count, char *message, size_t message_size)
{
    color_config *config;
    AG_TRY(color_config_create_builtin(message, message_size, &config));
    float *greys = malloc(3 * count * sizeof *greys);
    for (size_t i = 0; greys && i < count; i++)
        greys[3 * i] = greys[3 * i + 1] = greys[3 * i + 2] = values[i];
    const ag_status status = greys ? decode_greys(config, greys, count, message, message_size) : AG_ERROR_MEMORY;
    for (size_t i = 0; status == AG_OK && i < count; i++)
        values[i] = greys[3 * i];
    color_config_destroy(config);
    free(greys);
    return status;
}

ag_status image_encoding_table(image_encoding encoding, size_t size, float *out_table, char *message,
                               size_t message_size)
{
    snprintf(message, message_size, "%s", "");
    for (size_t i = 0; i < size; i++)
        out_table[i] = (float)i / (float)(size - 1);
    switch (curve_of(encoding)) {
    case IMAGE_CURVE_GAMMA:
        for (size_t i = 0; i < size; i++)
            out_table[i] = (float)pow((double)i / (double)(size - 1), (double)encoding.gamma);
        return AG_OK;
    case IMAGE_CURVE_SRGB: return decode_srgb(out_table, size, message, message_size);
    default: return AG_OK;
    }
}

ag_status image_linearize(struct image *picture, image_encoding encoding, char *message, size_t message_size)
{
    snprintf(message, message_size, "%s", "");
    const bool is_integer = picture->type == IMAGE_UINT8 || picture->type == IMAGE_UINT16;
    if (!is_integer || curve_of(encoding) == IMAGE_CURVE_LINEAR)
        return AG_OK;
    const size_t size = picture->type == IMAGE_UINT8 ? 256 : 65536;
    const size_t count = (size_t)picture->width * (size_t)picture->height * (size_t)picture->channel_count;
    const float last = (float)(size - 1);
    float *table = malloc(size * sizeof *table);
    ag_status status = table ? image_encoding_table(encoding, size, table, message, message_size) : AG_ERROR_MEMORY;
    if (status == AG_OK)
        for (size_t i = 0; i < count; i++) /* readers give values in [0, 1] */
            picture->pixels[i] = table[(size_t)(fminf(fmaxf(picture->pixels[i], 0.0f), 1.0f) * last + 0.5f)];
    free(table);
    return status;
}
