/* statistics_json.c: what was done, as JSON. The field names are part of the program's contract.
 * Flow: after rendering. Threads: as in afterglow.h. */
#include "context.h"

#include "atomic_file.h"
#include "film/layer_table.h"
#include "settings_table.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static json_t *count(uint64_t value) { return json_integer((json_int_t)value); }

static const char *map_file_name(ag_map_file state)
{
    static const char *const names[] = {[AG_MAP_FILE_NONE] = "none",
                                        [AG_MAP_FILE_TRACED] = "traced",
                                        [AG_MAP_FILE_OPENED] = "opened",
                                        [AG_MAP_FILE_PRIVATE] = "private"};
    return names[state];
}

/* How the picture ended. */
static json_t *end_to_json(const ag_statistics *s)
{
    static const char *const reasons[] = {
        [AG_END_NONE] = "",           [AG_END_SAMPLES] = "samples",       [AG_END_NOISE] = "noise",
        [AG_END_PHOTONS] = "photons", [AG_END_TIME_LIMIT] = "time-limit", [AG_END_SIGNAL] = "signal",
        [AG_END_MEMORY] = "memory",   [AG_END_DRY_RUN] = "dry-run",       [AG_END_KEPT] = "kept"};
    json_t *noise = s->noise >= 0.0 && isfinite(s->noise) ? json_real(s->noise) : json_null();
    return json_pack("{s:s, s:o, s:{s:i, s:i, s:f}}", "reason", reasons[s->end], "noise", noise, "samples", "least",
                     s->samples.least, "most", s->samples.most, "mean", s->samples.mean);
}

static json_t *prediction_to_json(const ag_prediction *p)
{
    json_t *times = json_object();
    for (int i = 0; i < AG_PHASE_COUNT; i++)
        json_object_set_new(times, ag_phase_name((ag_phase)i), json_real(p->time_s[i]));
    json_object_set_new(times, "total", json_real(p->time_total_s));
    return json_pack("{s:{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}, s:o, s:f, s:f}", "memory", "peak_bytes",
                     count(p->memory_peak_bytes), "scene_bytes", count(p->memory_scene_bytes), "photon_bytes",
                     count(p->memory_photon_bytes), "thread_bytes", count(p->memory_thread_bytes), "film_bytes",
                     count(p->memory_film_bytes), "host_bytes", count(p->memory_host_bytes), "file_bytes",
                     count(p->memory_file_bytes), "needed_bytes", count(p->memory_needed_bytes), "optional_bytes",
                     count(p->memory_optional_bytes), "time_s", times, "cpu_s", p->cpu_s, "samples_per_pixel",
                     p->samples_per_pixel);
}

/* --- settings --- */

static json_t *layer_names(uint32_t layers)
{
    json_t *names = json_array();
    for (uint32_t bit = 1; bit; bit <<= 1)
        if (layers & bit)
            json_array_append_new(names, json_string(layer_name(bit)));
    return names;
}

/* SETTING_SIZE apart, whose two numbers are two values. */
static json_t *value_of(const setting_row *row, const ag_render_settings *settings)
{
    const void *value = (const unsigned char *)settings + row->offset;
    const double *window = value;
    char text[SETTING_TEXT_MAX];
    switch (row->kind) {
    case SETTING_INTEGER: return json_integer(*(const int *)value);
    case SETTING_COUNT:
    case SETTING_SEED: return count(*(const uint64_t *)value);
    case SETTING_NUMBER: {
        double number = (double)*(const float *)value;
        return isfinite(number) ? json_real(number) : json_null(); /* JSON has no infinity */
    }
    case SETTING_FLAG: return json_boolean(*(const bool *)value);
    case SETTING_WINDOW: return json_pack("[f, f, f, f]", window[0], window[1], window[2], window[3]);
    case SETTING_LAYERS: return layer_names(*(const uint32_t *)value);
    case SETTING_WORD:
    case SETTING_SIZE:
    case SETTING_FILE: break;
    }
    setting_format(row, settings, text);
    return json_string(text);
}

/* Returns the object of that name in the root, and makes it where it is not there; the root itself where the name is
 * empty. */
static json_t *object_in(json_t *root, const char *name)
{
    json_t *object = name[0] ? json_object_get(root, name) : root;
    if (object)
        return object;
    json_object_set_new(root, name, json_object());
    return json_object_get(root, name);
}

static void add_settings(json_t *root, const ag_render_settings *settings)
{
    for (size_t i = 0; setting_at(i); i++) {
        const setting_row *row = setting_at(i);
        if (!row->json)
            continue;
        const char *dot = strchr(row->json, '.');
        char name[32] = "";
        if (row->kind == SETTING_SIZE) {
            json_t *size = object_in(root, row->json);
            json_object_set_new(size, "width", json_integer(settings->width));
            json_object_set_new(size, "height", json_integer(settings->height));
            continue;
        }
        if (dot)
            snprintf(name, sizeof name, "%.*s", (int)(dot - row->json), row->json);
        json_object_set_new(object_in(root, name), dot ? dot + 1 : row->json, value_of(row, settings));
    }
}

/* --- counts and times --- */

/* Takes every value over; NULL when out of memory. */
static json_t *statistics_to_json(const ag_statistics *s, const ag_prediction *prediction,
                                  const ag_render_settings *settings, const char *isa)
{
    json_t *times = json_object(), *cpu_times = json_object(), *root = json_object();
    for (int i = 0; i < AG_PHASE_COUNT; i++) {
        json_object_set_new(times, ag_phase_name((ag_phase)i), json_real(s->time_s[i]));
        json_object_set_new(cpu_times, ag_phase_name((ag_phase)i), json_real(s->phase_cpu_s[i]));
    }
    json_object_set_new(times, "total", json_real(s->time_total_s));
    json_object_set_new(root, "version", json_string(ag_version()));
    json_object_set_new(root, "threads", json_integer((json_int_t)s->threads));
    json_object_set_new(root, "isa", json_string(isa));
    add_settings(root, settings);
    json_t *counts = json_pack(
        "{s:{s:o, s:o, s:o, s:o, s:s, s:o, s:o},"
        " s:{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:f, s:f}, s:{s:o, s:o, s:o, s:o, s:o, s:o},"
        " s:o, s:o, s:f, s:o, s:{s:o}, s:{s:o, s:o, s:o, s:o}, s:o}",
        "photons", "emitted", count(s->photons_emitted), "stored_global", count(s->photons_stored_global),
        "stored_caustic", count(s->photons_stored_caustic), "bytes", count(s->photon_bytes), "map_file",
        map_file_name(s->map_file), "came", count(s->photons_came), "went", count(s->photons_went), /**/
        "irradiance", "requests", count(s->irradiance_requests), "computed", count(s->irradiance_computed), "distinct",
        count(s->irradiance_distinct), "deferred", count(s->irradiance_deferred), "waited", count(s->irradiance_waited),
        "duplicated", count(s->irradiance_duplicated), "uncached", count(s->irradiance_uncached), "refused",
        count(s->irradiance_refused), "ready", count(s->irradiance_ready), "reclaimed", count(s->irradiance_reclaimed),
        "kept", count(s->irradiance_kept), "estimate_s", s->irradiance_estimate_s, "wait_s", s->irradiance_wait_s, /**/
        "rays", "camera", count(s->rays_camera), "shadow", count(s->rays_shadow), "gather", count(s->rays_gather),
        "photon", count(s->rays_photon), "path", count(s->rays_path), "estimate", count(s->rays_estimate), /**/
        "samples_not_finite", count(s->samples_not_finite), "time_s", times, "cpu_s", s->cpu_s, "phase_cpu_s",
        cpu_times, "memory", "peak_bytes", count(s->memory_peak_bytes), /**/
        "texture", "whole_bytes", count(s->texture_whole_bytes), "tile_bytes", count(s->texture_tile_bytes),
        "file_bytes", count(s->texture_file_bytes), "tiles_read", count(s->texture_tiles_read), /**/
        "end", end_to_json(s));
    bool is_whole = counts && json_object_update(root, counts) == 0;
    if (prediction->memory_peak_bytes > 0)
        is_whole = json_object_set_new(root, "prediction", prediction_to_json(prediction)) == 0 && is_whole;
    json_decref(counts);
    if (is_whole)
        return root;
    json_decref(root);
    return NULL;
}

ag_status ag_statistics_write(ag_context *context, const char *path)
{
    if (!context || !path)
        return AG_ERROR_ARGUMENT;
    if (run_is_cancelled(&context->run))
        return AG_CANCELLED;
    ag_statistics statistics = ag_context_statistics(context);
    json_t *json = statistics_to_json(&statistics, &context->prediction, &context->rendered, context->isa);
    char *text = json ? json_dumps(json, JSON_INDENT(2) | JSON_REAL_PRECISION(9)) : NULL;
    json_decref(json);
    if (!text)
        return AG_ERROR_MEMORY;
    size_t length = strlen(text);
    text[length] = '\n'; /* instead of the terminator: the file needs none */
    char message[1024];
    ag_status status = atomic_file_write(&context->run, path, text, length + 1, message, sizeof message);
    if (status != AG_OK && status != AG_CANCELLED)
        log_message(context->log, AG_LOG_ERROR, "%s", message);
    free(text);
    return status;
}

ag_status ag_statistics_check(ag_context *context, const char *path)
{
    if (!context || !path)
        return AG_ERROR_ARGUMENT;
    char message[1024];
    ag_status status = atomic_file_check(path, message, sizeof message);
    if (status != AG_OK)
        log_message(context->log, AG_LOG_ERROR, "%s", message);
    return status;
}
