/* output.c: from film to file: scene-linear as it is, or through a display and view on all threads.
 * Flow: film -> color -> [here] -> image_file. Threads: as in afterglow.h. */
#include "context.h"

#include "atomic_file.h"
#include "clock.h"
#include "color.h"
#include "image_file.h"
#include "parallel_for.h"
#include "picture_layers.h"

#include <stdlib.h>
#include <string.h>

enum { PIXELS_PER_BLOCK = 1 << 14, MESSAGE_SIZE = 1024 };

ag_output_settings ag_default_output_settings(void) { return (ag_output_settings){0}; }

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
        log_message(context->log, AG_LOG_ERROR,
                    "%s: the name must end in .exr, .png, .tif, .tiff, .jpg or .jpeg: it chooses the format", path);
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

static ag_status create_processor(ag_context *context, const ag_output_settings *settings, color_config **out_config,
                                  color_processor **out_processor)
{
    char message[MESSAGE_SIZE];
    color_config *config;
    ag_status status = color_config_create(settings->color_config, message, sizeof message, &config);
    if (status == AG_OK) {
        status =
            color_processor_create(config, settings->display, settings->view, message, sizeof message, out_processor);
        if (status != AG_OK)
            color_config_destroy(config);
        else
            *out_config = config;
    }
    if (status != AG_OK)
        log_message(context->log, AG_LOG_ERROR, "%s", message);
    return status;
}

ag_status ag_output_check(ag_context *context, const ag_output_settings *settings, const char *path)
{
    ag_output_settings defaults = ag_default_output_settings();
    if (!context || !path)
        return AG_ERROR_ARGUMENT;
    if (!settings)
        settings = &defaults;
    const image_format *format;
    ag_status status = find_format(context, settings, path, &format);
    if (status != AG_OK)
        return status;
    char message[MESSAGE_SIZE];
    status = image_file_check_target(path, message, sizeof message);
    if (status != AG_OK) {
        log_message(context->log, AG_LOG_ERROR, "%s", message);
        return status;
    }
    /* a config that is named but cannot be used is an error even where this picture would not need it */
    color_config *config;
    color_processor *processor;
    status = create_processor(context, settings, &config, &processor);
    if (status != AG_OK)
        return status;
    color_processor_destroy(processor);
    color_config_destroy(config);
    return AG_OK;
}

typedef struct color_job {
    const color_processor *processor;
    float *pixels;
    atomic_u32 has_failed;
    char message[MESSAGE_SIZE]; /* of the one that failed first */
} color_job;

static void apply_block(void *user, uint64_t begin, uint64_t end, uint64_t block, unsigned worker)
{
    (void)block, (void)worker;
    color_job *job = user;
    char message[MESSAGE_SIZE];
    if (color_processor_apply(job->processor, job->pixels + 3 * begin, (size_t)(end - begin), message,
                              sizeof message) == AG_OK)
        return;
    uint32_t expected = 0;
    if (cas_acquire_u32(&job->has_failed, &expected, 1)) /* read after the workers have been joined */
        memcpy(job->message, message, sizeof message);
}

static ag_status apply_view(ag_context *context, const ag_output_settings *settings, float *pixels, uint64_t count)
{
    color_config *config;
    color_job job = {.pixels = pixels};
    color_processor *processor;
    ag_status status = create_processor(context, settings, &config, &processor);
    if (status != AG_OK)
        return status;
    job.processor = processor;
    status = parallel_for(&context->run, count, PIXELS_PER_BLOCK, apply_block, &job, AG_PHASE_WRITE, 0.0, 0.5);
    if (status == AG_OK && load_relaxed_u32(&job.has_failed)) {
        log_message(context->log, AG_LOG_ERROR, "%s", job.message);
        status = AG_ERROR_COLOR;
    }
    color_processor_destroy(processor);
    color_config_destroy(config);
    return status;
}

/* pixels: RGB as they are to be written. */
static ag_status write_picture(ag_context *context, const ag_film *film, const ag_output_settings *settings,
                               const image_format *format, const float *pixels, const char *path)
{
    static const char *const names[3] = {"R", "G", "B"};
    static const float rec709[8] = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};
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
                                     .color_space = format->scene_linear ? "Linear" : NULL,
                                     .attributes = attributes,
                                     .attribute_count = sizeof attributes / sizeof *attributes};
    picture_layers layers = {0};
    ag_status status = AG_OK;
    if (format->scene_linear) { /* the only one that holds layers */
        status = picture_layers_create(context, film, pixels, settings, description.type, path, &layers);
        if (status != AG_OK)
            return status;
        picture_layers_add_numbers(&layers, "chromaticities", rec709, 8);
        description.channel_count = layers.channel_count;
        description.channel_names = layers.names;
        description.channel_types = layers.types;
        description.attributes = layers.attributes;
        description.attribute_count = layers.attribute_count;
        pixels = layers.pixels;
    }
    char message[MESSAGE_SIZE];
    status = image_file_write(path, &description, pixels, message, sizeof message);
    if (status != AG_OK)
        log_message(context->log, AG_LOG_ERROR, "%s", message);
    picture_layers_reset(&layers);
    return status;
}

ag_status ag_film_write(ag_context *context, const ag_film *film, const ag_output_settings *settings, const char *path)
{
    ag_output_settings defaults = ag_default_output_settings();
    if (!context || !film || !path)
        return AG_ERROR_ARGUMENT;
    if (!settings)
        settings = &defaults;
    if (run_is_cancelled(&context->run))
        return AG_CANCELLED;
    double begin = clock_seconds();
    const image_format *format;
    ag_status status = find_format(context, settings, path, &format);
    if (status != AG_OK)
        return status;

    const float *pixels = film->pixels;
    float *shown = NULL;
    size_t count = (size_t)film->width * (size_t)film->height;
    if (!format->scene_linear) {
        shown = malloc(count * 3 * sizeof *shown);
        if (!shown)
            return AG_ERROR_MEMORY;
        memcpy(shown, film->pixels, count * 3 * sizeof *shown);
        pixels = shown;
        status = apply_view(context, settings, shown, count);
    }
    if (status == AG_OK)
        status = write_picture(context, film, settings, format, pixels, path);
    free(shown);
    if (status == AG_OK) {
        run_progress(&context->run, AG_PHASE_WRITE, 1.0);
        context_end_phase(context, AG_PHASE_WRITE, begin);
    }
    return status;
}

void ag_abandon_files(void) { atomic_file_unlink_pending(); }
