/* context.c: creating and destroying the public objects, but scenes.
 * Threads: as in afterglow.h. */
#define _POSIX_C_SOURCE 200809L
#include "context.h"

#include "clock.h"
#include "estimate_fingerprint.h"
#include "film/film_tiles.h"
#include "floating_point.h"
#include "last_frame.h"
#include "public_structs.h"
#include "status.h"
#include "texture/texture_cache.h"
#include "texture/texture_file_levels.h"
#include "texture/texture_udim.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

ag_status context_check_struct(ag_context *context, const char *type, size_t size, size_t known_size)
{
    if (size == known_size)
        return AG_OK;
    log_message(context->log, AG_LOG_ERROR,
                "%s: struct_size is %zu, and of this library's %zu: ag_default_...() sets it, and the program is to be "
                "compiled with the headers of this release",
                type, size, known_size);
    return AG_ERROR_ARGUMENT;
}

ag_status context_estimates(ag_context *context, hash128 *out_hash)
{
    if (!context->has_estimates) {
        unsigned callers_arithmetic = floating_point_enter();
        ag_status status = estimate_fingerprint(&context->run, context->isa, photon_tracing_run,
                                                irradiance_estimate_find, &context->estimates);
        floating_point_leave(callers_arithmetic);
        AG_TRY(status);
        context->has_estimates = true;
    }
    *out_hash = context->estimates;
    return AG_OK;
}

static bool copy_confinement(const ag_context_settings *settings, ag_context *c)
{
    c->is_confined = settings->is_confined;
    c->confined_to = calloc(settings->confined_count + 1, sizeof *c->confined_to);
    for (; c->confined_to && c->confined_count < settings->confined_count; c->confined_count++)
        if (!(c->confined_to[c->confined_count] = strdup(settings->confined_to[c->confined_count])))
            return false;
    return c->confined_to != NULL;
}

static void free_confinement(ag_context *c)
{
    for (size_t i = 0; i < c->confined_count; i++)
        free(c->confined_to[i]);
    free(c->confined_to);
}

static void tell_too_many_threads(log_sink *log, unsigned thread_count)
{
    if (thread_count > 0)
        log_message(log, AG_LOG_ERROR,
                    "the system does not give this process %u threads: try fewer, or higher limits "
                    "of processes and memory",
                    thread_count);
    else
        log_message(log, AG_LOG_ERROR,
                    "the system does not give this process a thread for each processor: try fewer, "
                    "or higher limits of processes and memory");
}

ag_status ag_context_create(const ag_context_settings *settings, ag_context **out_context)
{
    static const char *const known_isas[] = {"sse2", "sse4.2", "avx", "avx2", "avx512"};
    ag_context_settings defaults = ag_default_context_settings();
    if (!settings)
        settings = &defaults;
    if (settings->struct_size != sizeof *settings)
        return AG_ERROR_ARGUMENT;
    const char *isa = settings->isa ? settings->isa : "avx2";
    bool is_known = false;
    for (size_t i = 0; i < sizeof known_isas / sizeof *known_isas; i++)
        is_known = is_known || strcmp(isa, known_isas[i]) == 0;
    if (!out_context || !is_known || (settings->confined_count > 0 && !settings->confined_to))
        return AG_ERROR_ARGUMENT;
    for (size_t i = 0; i < settings->confined_count; i++)
        if (!settings->confined_to[i])
            return AG_ERROR_ARGUMENT;
    ag_context *c = calloc(1, sizeof *c);
    if (!c)
        return AG_ERROR_MEMORY;
    c->created_at = clock_seconds();
    snprintf(c->isa, sizeof c->isa, "%s", isa);
    c->color_config_path = settings->color_config ? strdup(settings->color_config) : NULL;
    c->working_space_name = settings->working_space ? strdup(settings->working_space) : NULL;
    const bool is_copied = copy_confinement(settings, c) && !settings->color_config == !c->color_config_path &&
                           !settings->working_space == !c->working_space_name;
    ag_status status = AG_ERROR_MEMORY;
    c->log = log_create(settings->log, settings->user);
    if (c->log && is_copied)
        status = thread_pool_create(settings->thread_count, &c->pool);
    if (status == AG_ERROR_SYSTEM)
        tell_too_many_threads(c->log, settings->thread_count);
    if (status != AG_OK) {
        log_destroy(c->log);
        free(c->color_config_path);
        free(c->working_space_name);
        free_confinement(c);
        free(c);
        return status;
    }
    run_context_init(&c->run, c->pool, c->log, settings->progress, settings->user);
    c->statistics.threads = thread_pool_worker_count(c->pool);
    c->statistics.noise = -1.0;
    *out_context = c;
    return AG_OK;
}

static void free_context(ag_context *context)
{
    run_context_reset(&context->run);
    thread_pool_destroy(context->pool);
    log_destroy(context->log);
    color_config_destroy(context->color_config);
    free(context->color_config_path);
    free(context->working_space_name);
    free_confinement(context);
    free(context->color_summary);
    free(context->color_views);
    last_frame_destroy(context->last_frame);
    free(context);
}

void ag_context_destroy(ag_context *context)
{
    if (!context || context->is_dropped)
        return;
    if (context->scene_count == 0) {
        free_context(context);
        return;
    }
    log_message(context->log, AG_LOG_ERROR, "ag_context_destroy: %zu of its scenes have not been destroyed before it",
                context->scene_count);
    log_silence(context->log); /* what `user` points to may be gone from now on */
    context->run.progress = NULL;
    run_cancel(&context->run);
    context->is_dropped = true;
}

static bool is_same_text(const char *a, const char *b) { return a && b ? strcmp(a, b) == 0 : a == b; }

bool context_is_alike(const ag_context *a, const ag_context *b)
{
    return a == b || (strcmp(a->isa, b->isa) == 0 && is_same_text(a->color_config_path, b->color_config_path) &&
                      is_same_text(a->working_space_name, b->working_space_name));
}

void context_add_scene(ag_context *context) { context->scene_count++; }

void context_remove_scene(ag_context *context)
{
    if (--context->scene_count == 0 && context->is_dropped)
        free_context(context);
}

unsigned ag_context_thread_count(const ag_context *context)
{
    return context ? thread_pool_worker_count(context->pool) : 0;
}

void ag_context_cancel(ag_context *context)
{
    if (context)
        run_cancel(&context->run);
}

void ag_context_clear_cancel(ag_context *context)
{
    if (context && !context->is_dropped)
        run_clear_cancel(&context->run);
}

void ag_context_pause(ag_context *context)
{
    if (context)
        run_pause(&context->run);
}

double context_add_to_phase(ag_context *context, ag_phase phase, phase_begin begin)
{
    double seconds = clock_seconds() - begin.time_s;
    context->statistics.time_s[phase] += seconds;
    context->statistics.phase_cpu_s[phase] += clock_process_cpu_seconds() - begin.cpu_s;
    return seconds;
}

void context_end_phase(ag_context *context, ag_phase phase, phase_begin begin)
{
    double seconds = context_add_to_phase(context, phase, begin);
    log_message(context->log, AG_LOG_INFO, "%-10s %9.3f s", ag_phase_name(phase), seconds);
}

void ag_film_chromaticities(const ag_film *film, float out_chromaticities[8])
{
    if (film && out_chromaticities)
        working_space_chromaticities(&film->space, out_chromaticities);
}

void ag_context_note_end(ag_context *context, ag_end end)
{
    if (context)
        context->statistics.end = end;
}

void ag_context_statistics_fill(const ag_context *context, void *out_statistics, size_t struct_size)
{
    if (!context) {
        public_struct_write_part(NULL, 0, out_statistics, struct_size);
        return;
    }
    ag_statistics s = context->statistics;
    s.time_total_s = clock_seconds() - context->created_at;
    s.cpu_s = clock_process_cpu_seconds();
    s.memory_peak_bytes = peak_memory_bytes();
    public_struct_write_part(&s, sizeof s, out_statistics, struct_size);
}

void ag_context_prediction_fill(const ag_context *context, void *out_prediction, size_t struct_size)
{
    public_struct_write_part(context ? &context->prediction : NULL, context ? sizeof context->prediction : 0,
                             out_prediction, struct_size);
}

void context_count_textures(ag_context *context, const scene *s)
{
    const texture_store_counts c = texture_store_count(s->textures.store);
    ag_statistics *out = &context->statistics;
    out->texture_whole_bytes = c.whole_bytes;
    out->texture_tile_bytes = c.tile_bytes_most;
    out->texture_file_bytes = c.file_bytes;
    out->texture_tiles_read = c.tiles_read;
}

ag_status context_check_textures(ag_context *context, const scene *s)
{
    context_count_textures(context, s);
    for (uint32_t i = 0; i < s->textures.image_count; i++)
        if (s->textures.images[i]->udim)
            texture_udim_tell_missed(s->textures.images[i], context->log);
    for (uint32_t i = 0; i < s->textures.image_count; i++) {
        const texture_image *picture = s->textures.images[i];
        const char *problem = picture->file ? texture_file_levels_problem(picture->file) : NULL;
        if (problem) {
            log_message(context->log, AG_LOG_ERROR, "'%s' %s", picture->path, problem);
            return AG_ERROR_INPUT;
        }
    }
    for (uint32_t i = 0; i < s->textures.image_count; i++) {
        const texture_image *picture = s->textures.images[i];
        if (picture->kept && texture_kept_is_damaged(picture->kept)) {
            log_message(context->log, AG_LOG_ERROR,
                        "'%s': its tiles in the folder of --texture-cache are damaged, and are removed: start again",
                        picture->path);
            return AG_ERROR_INPUT; /* no picture is made of them */
        }
    }
    const ag_status status = texture_store_state(s->textures.store);
    if (status == AG_ERROR_MEMORY)
        log_message(context->log, AG_LOG_ERROR, "out of memory for tiles of textures");
    else if (status != AG_OK)
        log_message(context->log, AG_LOG_ERROR,
                    "textures beyond --texture-memory cannot be read back from their temporary file");
    return status;
}
