/* output_color.c: see output_color.h; and the context's colour config, which is read when it is first asked for.
 * Threads: see output_color.h. */
#include "output/output_color.h"

#include "color/color.h"
#include "parallel_for.h"
#include "status.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PIXELS_PER_BLOCK = 1 << 12, MESSAGE_SIZE = 2048 };

ag_status context_color_config(ag_context *context, const color_config **out_config)
{
    char message[MESSAGE_SIZE];
    double from_rec709[9];
    *out_config = context->color_config;
    if (*out_config)
        return AG_OK;
    color_config *config;
    ag_status status = color_config_create(context->color_config_path, context->working_space_name, context->log,
                                           message, sizeof message, &config);
    if (status != AG_OK) {
        log_message(context->log, AG_LOG_ERROR, "%s", message);
        return status;
    }
    if (!color_config_from_rec709(config, from_rec709))
        log_message(context->log, AG_LOG_WARNING,
                    "the OpenColorIO config '%s' does not say what the primaries of '%s' are: they are taken for Rec. "
                    "709's",
                    color_config_name(config), color_config_working_space(config));
    if (!working_space_make(from_rec709, &context->working_space)) {
        log_message(context->log, AG_LOG_ERROR, "the working space '%s' cannot hold all colours: it is singular",
                    color_config_working_space(config));
        color_config_destroy(config);
        return AG_ERROR_COLOR;
    }
    log_message(context->log, AG_LOG_INFO, "colour: config '%s', working space '%s'", color_config_name(config),
                color_config_working_space(config));
    *out_config = context->color_config = config;
    return AG_OK;
}

ag_status ag_color_summary(ag_context *context, const char **out_text)
{
    char message[MESSAGE_SIZE];
    const color_config *config;
    if (!context || !out_text)
        return AG_ERROR_ARGUMENT;
    AG_TRY(context_color_config(context, &config));
    if (!context->color_summary) {
        const ag_status status = color_config_describe(config, message, sizeof message, &context->color_summary);
        if (status != AG_OK) {
            log_message(context->log, AG_LOG_ERROR, "%s", message);
            return status;
        }
    }
    *out_text = context->color_summary;
    return AG_OK;
}

ag_status ag_color_view_at(ag_context *context, size_t index, const char **out_display, const char **out_view)
{
    char message[MESSAGE_SIZE];
    const color_config *config;
    if (!context || !out_display || !out_view)
        return AG_ERROR_ARGUMENT;
    AG_TRY(context_color_config(context, &config));
    if (!context->color_views) {
        const ag_status status = color_config_list_views(config, message, sizeof message, &context->color_views);
        if (status != AG_OK) {
            log_message(context->log, AG_LOG_ERROR, "%s", message);
            return status;
        }
    }
    const char *display = context->color_views;
    for (; *display && index > 0; index--) {
        display += strlen(display) + 1;
        display += strlen(display) + 1;
    }
    if (!*display)
        return AG_ERROR_ARGUMENT;
    *out_display = display;
    *out_view = display + strlen(display) + 1;
    return AG_OK;
}

struct ag_view {
    color_processor *processor; /* owned */
};

ag_status output_settings_check(ag_context *context, const ag_output_settings *settings)
{
    AG_TRY(context_check_struct(context, "ag_output_settings", settings->struct_size, sizeof *settings));
    const char *wrong = (int)settings->type < AG_SAMPLE_DEFAULT || settings->type > AG_SAMPLE_FLOAT
                            ? "type is no ag_sample_type"
                        : !isfinite(settings->exposure_stops) ? "exposure_stops is not finite"
                                                              : NULL;
    if (wrong)
        log_message(context->log, AG_LOG_ERROR, "ag_output_settings: %s", wrong);
    return wrong ? AG_ERROR_ARGUMENT : AG_OK;
}

/* NULL where values stay as they are. */
static ag_status create_processor(ag_context *context, const ag_output_settings *settings, bool scene_linear,
                                  color_processor **out_processor)
{
    char message[MESSAGE_SIZE];
    const color_config *config;
    const color_view view = {settings->display, settings->view, settings->look, settings->exposure_stops};
    *out_processor = NULL;
    AG_TRY(context_color_config(context, &config));
    if (scene_linear && !settings->color_space)
        return AG_OK;
    const ag_status status =
        scene_linear ? color_encoder_create(config, settings->color_space, message, sizeof message, out_processor)
                     : color_processor_create(config, &view, message, sizeof message, out_processor);
    if (status != AG_OK)
        log_message(context->log, AG_LOG_ERROR, "%s", message);
    return status;
}

ag_status output_color_check(ag_context *context, const ag_output_settings *settings, bool scene_linear)
{
    const bool names_view = settings->display || settings->view || settings->look;
    for (int is_linear = !names_view && scene_linear; is_linear < 2; is_linear++) {
        color_processor *processor;
        AG_TRY(create_processor(context, settings, is_linear, &processor));
        color_processor_destroy(processor);
    }
    return AG_OK;
}

ag_status ag_view_create(ag_context *context, const ag_output_settings *settings, ag_view **out_view)
{
    const ag_output_settings defaults = ag_default_output_settings();
    color_processor *processor = NULL;
    if (!context || !out_view)
        return AG_ERROR_ARGUMENT;
    *out_view = NULL;
    if (!settings)
        settings = &defaults;
    AG_TRY(output_settings_check(context, settings));
    AG_TRY(create_processor(context, settings, false, &processor));
    ag_view *view = calloc(1, sizeof *view);
    if (!view) {
        color_processor_destroy(processor);
        return AG_ERROR_MEMORY;
    }
    view->processor = processor;
    *out_view = view;
    return AG_OK;
}

void ag_view_destroy(ag_view *view)
{
    if (!view)
        return;
    color_processor_destroy(view->processor);
    free(view);
}

ag_status ag_view_apply(const ag_view *view, float *pixels, size_t count)
{
    char message[MESSAGE_SIZE];
    if (!view || !pixels)
        return AG_ERROR_ARGUMENT;
    return color_processor_apply(view->processor, pixels, count, message, sizeof message);
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

ag_status output_color_apply(ag_context *context, const ag_output_settings *settings, bool scene_linear, float *pixels,
                             uint64_t count)
{
    color_job job = {.pixels = pixels};
    color_processor *processor;
    AG_TRY(create_processor(context, settings, scene_linear, &processor));
    if (!processor)
        return AG_OK;
    job.processor = processor;
    ag_status status =
        parallel_for(&context->run, count, PIXELS_PER_BLOCK, apply_block, &job, AG_PHASE_WRITE, 0.0, 0.5);
    if (status == AG_OK && load_relaxed_u32(&job.has_failed)) {
        log_message(context->log, AG_LOG_ERROR, "%s", job.message);
        status = AG_ERROR_COLOR;
    }
    color_processor_destroy(processor);
    return status;
}

/* Finds a linear space other than the film's, by its matrix to the film's working space. */
static bool find_other_space(const working_space *film_space, const double to_working[9], working_space *out_space)
{
    color_matrix to, from;
    double rows[9];
    for (int i = 0; i < 9; i++)
        to.m[i / 3][i % 3] = to_working[i];
    if (!color_matrix_invert(&to, &from))
        return false;
    from = color_matrix_multiply(&from, &film_space->from_rec709);
    for (int i = 0; i < 9; i++)
        rows[i] = from.m[i / 3][i % 3];
    return working_space_make(rows, out_space);
}

ag_status output_color_find_tag(ag_context *context, const ag_output_settings *settings, const ag_film *film,
                                output_color_tag *out_tag)
{
    char message[MESSAGE_SIZE];
    const color_config *config;
    color_curve curve = COLOR_CURVE_LINEAR;
    double to_working[9];
    working_space space = film->space;
    AG_TRY(context_color_config(context, &config));
    ag_status status = AG_OK;
    output_color_tag tag = {.color_space = color_config_working_space(config), .has_chromaticities = true};
    if (settings->color_space) {
        status = color_config_study_space(config, settings->color_space, message, sizeof message, &curve, to_working);
        tag.color_space = color_config_find_space(config, settings->color_space, message, sizeof message);
        tag.has_chromaticities =
            curve == COLOR_CURVE_LINEAR && status == AG_OK && find_other_space(&film->space, to_working, &space);
    }
    if (tag.has_chromaticities) {
        working_space_chromaticities(&space, tag.chromaticities);
        if (space.is_rec709)
            tag.color_space = "Linear"; /* as OpenImageIO calls it */
    }
    *out_tag = tag;
    if (status != AG_OK)
        log_message(context->log, AG_LOG_ERROR, "%s", message);
    return status;
}
