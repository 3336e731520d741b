/* output.c: from film to file: scene-linear, or through a display and view.
 * Flow: film -> output_color -> [here] -> image_file. Threads: as in afterglow.h. */
#include "context.h"

#include "atomic_file.h"
#include "clock.h"
#include "output/image_file.h"
#include "output/output_color.h"
#include "output/picture_layers.h"
#include "status.h"

#include <stdlib.h>
#include <string.h>

enum { MESSAGE_SIZE = 1024 };

static image_sample_type stored_type(const image_format *format, ag_sample_type wanted)
{
    switch (wanted) {
    case AG_SAMPLE_UINT8: return IMAGE_UINT8;
    case AG_SAMPLE_UINT16: return IMAGE_UINT16;
    case AG_SAMPLE_HALF: return IMAGE_HALF;
    case AG_SAMPLE_FLOAT: return IMAGE_FLOAT;
    case AG_SAMPLE_DEFAULT: break;
    }
    return format->default_type;
}

static ag_status find_format(ag_context *context, const ag_output_settings *settings, const char *path,
                             const image_format **out_format)
{
    const image_format *format = image_format_of(path);
    if (!format) {
        log_message(
            context->log, AG_LOG_ERROR,
            "%s: the name must end in .exr, .hdr, .pfm, .png, .tif, .tiff, .jpg or .jpeg: it chooses the format", path);
        return AG_ERROR_ARGUMENT;
    }
    if (!image_format_can_hold(format, stored_type(format, settings->type))) {
        log_message(context->log, AG_LOG_ERROR, "%s: .%s cannot hold samples of the type asked for", path,
                    format->extension);
        return AG_ERROR_ARGUMENT;
    }
    *out_format = format;
    return AG_OK;
}

ag_status ag_output_check(ag_context *context, const ag_output_settings *settings, const char *path)
{
    ag_output_settings defaults = ag_default_output_settings();
    if (!context || !path)
        return AG_ERROR_ARGUMENT;
    if (!settings)
        settings = &defaults;
    AG_TRY(output_settings_check(context, settings));
    const image_format *format;
    AG_TRY(find_format(context, settings, path, &format));
    char message[MESSAGE_SIZE];
    phase_begin begin = context_begin_phase(); /* it may load OpenImageIO */
    ag_status status = image_file_check_target(path, message, sizeof message);
    context_add_to_phase(context, AG_PHASE_WRITE, begin);
    if (status != AG_OK) {
        log_message(context->log, AG_LOG_ERROR, "%s", message);
        return status;
    }
    /* a config that is named but cannot be used is an error even where this picture would not need it */
    begin = context_begin_phase();
    status = output_color_check(context, settings, format->scene_linear);
    context_add_to_phase(context, AG_PHASE_LOAD, begin);
    return status;
}

static bool ends_with(const char *text, const char *end)
{
    size_t length = strlen(text), end_length = strlen(end);
    return length >= end_length && strcmp(text + length - end_length, end) == 0;
}

/* Returns whether a layer's red, green and blue begin with this channel. Variances are no colours; the picture's own
 * channels are converted before. */
static bool is_color_layer(const aov_layout *layout, int channel)
{
    const film_channel *c = &layout->channels[channel];
    return channel + 2 < layout->channel_count && ends_with(c[0].name, ".R") && ends_with(c[1].name, ".G") &&
           ends_with(c[2].name, ".B") && c->source != CHANNEL_BEAUTY && c->source != CHANNEL_VARIANCE &&
           c->source != CHANNEL_RELATIVE_VARIANCE;
}

/* Converts layers of colours to the colour space that is asked for. */
static ag_status convert_layers(ag_context *context, const ag_film *film, const ag_output_settings *settings,
                                picture_layers *layers)
{
    const size_t count = (size_t)film->width * (size_t)film->height, stride = (size_t)layers->channel_count;
    float *packed = malloc(3 * count * sizeof *packed);
    ag_status status = packed ? AG_OK : AG_ERROR_MEMORY;
    for (int c = 0; c < layers->channel_count && status == AG_OK; c++) {
        if (!is_color_layer(&film->layout, c))
            continue;
        float *first = layers->pixels + c;
        for (size_t i = 0; i < 3 * count; i++)
            packed[i] = first[i / 3 * stride + i % 3];
        status = output_color_apply(context, settings, true, packed, count);
        for (size_t i = 0; i < 3 * count; i++)
            first[i / 3 * stride + i % 3] = packed[i];
    }
    free(packed);
    return status;
}

/* Makes the channels of a format with layers. out_layers: to be reset by the caller, on failure too. */
static ag_status make_layers(ag_context *context, const ag_film *film, const ag_output_settings *settings,
                             image_sample_type type, const output_color_tag *tag, const float *pixels, const char *path,
                             picture_layers *out_layers)
{
    AG_TRY(picture_layers_create(context, film, pixels, settings, type, path, out_layers));
    if (settings->color_space)
        AG_TRY(convert_layers(context, film, settings, out_layers));
    return tag->has_chromaticities ? picture_layers_add_numbers(out_layers, "chromaticities", tag->chromaticities, 8)
                                   : AG_OK;
}

/* pixels: RGB as they are to be written. */
static ag_status write_picture(ag_context *context, const ag_film *film, const ag_output_settings *settings,
                               const image_format *format, const output_color_tag *tag, const float *pixels,
                               const char *path)
{
    static const char *const names[3] = {"R", "G", "B"};
    static const image_attribute attributes[] = {{.name = "Software", .text = "Afterglow"}};
    ag_sample_type type = settings->type;
    if (type == AG_SAMPLE_DEFAULT && film->float_samples && format->scene_linear)
        type = AG_SAMPLE_FLOAT;
    image_description description = {.width = film->width,
                                     .height = film->height,
                                     .x = film->x0,
                                     .y = film->y0,
                                     .full_width = film->full_width,
                                     .full_height = film->full_height,
                                     .channel_count = 3,
                                     .channel_names = names,
                                     .type = stored_type(format, type),
                                     .is_tiled = settings->tiled,
                                     .color_space = tag->color_space,
                                     .attributes = attributes,
                                     .attribute_count = sizeof attributes / sizeof *attributes};
    picture_layers layers = {0};
    if (format->has_layers) {
        const ag_status status = make_layers(context, film, settings, description.type, tag, pixels, path, &layers);
        if (status != AG_OK) {
            picture_layers_reset(&layers);
            return status;
        }
        description.channel_count = layers.channel_count;
        description.channel_names = layers.names;
        description.channel_types = layers.types;
        description.attributes = layers.attributes;
        description.attribute_count = layers.attribute_count;
        pixels = layers.pixels;
    }
    char message[MESSAGE_SIZE];
    const ag_status status = image_file_write(&context->run, path, &description, pixels, message, sizeof message);
    if (status != AG_OK && status != AG_CANCELLED)
        log_message(context->log, AG_LOG_ERROR, "%s", message);
    picture_layers_reset(&layers);
    return status;
}

/* Converts the film's colours where the format or the settings want it, and writes them. */
static ag_status convert_and_write(ag_context *context, const ag_film *film, const ag_output_settings *settings,
                                   const image_format *format, const char *path)
{
    const size_t count = (size_t)film->width * (size_t)film->height;
    output_color_tag tag = {0};
    if (format->scene_linear)
        AG_TRY(output_color_find_tag(context, settings, film, &tag));
    if (format->scene_linear && !settings->color_space)
        return write_picture(context, film, settings, format, &tag, film->pixels, path);
    float *shown = malloc(count * 3 * sizeof *shown);
    if (!shown)
        return AG_ERROR_MEMORY;
    memcpy(shown, film->pixels, count * 3 * sizeof *shown);
    ag_status status = output_color_apply(context, settings, format->scene_linear, shown, count);
    if (status == AG_OK)
        status = write_picture(context, film, settings, format, &tag, shown, path);
    free(shown);
    return status;
}

ag_status ag_film_write(ag_context *context, const ag_film *film, const ag_output_settings *settings, const char *path)
{
    ag_output_settings defaults = ag_default_output_settings();
    if (!context || !film || !path)
        return AG_ERROR_ARGUMENT;
    if (!settings)
        settings = &defaults;
    AG_TRY(output_settings_check(context, settings));
    if (run_is_cancelled(&context->run))
        return AG_CANCELLED;
    phase_begin begin = context_begin_phase();
    const image_format *format;
    AG_TRY(find_format(context, settings, path, &format));
    AG_TRY(convert_and_write(context, film, settings, format, path));
    run_progress(&context->run, AG_PHASE_WRITE, 1.0);
    context_end_phase(context, AG_PHASE_WRITE, begin);
    return AG_OK;
}

void ag_abandon_files(void) { atomic_file_unlink_pending(); }

void ag_end_waits(void) { atomic_file_end_waits(); }
