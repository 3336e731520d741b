/* statistics_json.c: what was done, as JSON. The field names are part of the program's contract.
 * Flow: after rendering. Threads: as in afterglow.h. */
#include "context.h"

#include "output/atomic_file.h"

#include <jansson.h>
#include <stdlib.h>
#include <string.h>

static json_t *count(uint64_t value) { return json_integer((json_int_t)value); }

static const char *cache_name(ag_cache_mode mode)
{
    return mode == AG_CACHE_ON_DEMAND ? "on-demand" : mode == AG_CACHE_PRECOMPUTE ? "precompute" : "off";
}

static const char *map_file_name(ag_map_file state)
{
    static const char *const names[] = {[AG_MAP_FILE_NONE] = "none",
                                        [AG_MAP_FILE_TRACED] = "traced",
                                        [AG_MAP_FILE_OPENED] = "opened",
                                        [AG_MAP_FILE_PRIVATE] = "private"};
    return names[state];
}

/* Takes every value over; NULL when out of memory. */
static json_t *statistics_to_json(const ag_statistics *s, const ag_render_settings *settings, const char *isa)
{
    json_t *times = json_object(), *cpu_times = json_object();
    for (int i = 0; i < AG_PHASE_COUNT; i++) {
        json_object_set_new(times, ag_phase_name((ag_phase)i), json_real(s->time_s[i]));
        json_object_set_new(cpu_times, ag_phase_name((ag_phase)i), json_real(s->phase_cpu_s[i]));
    }
    json_object_set_new(times, "total", json_real(s->time_total_s));
    return json_pack(
        "{s:s, s:i, s:s, s:I, s:s, s:s, s:s, s:{s:i, s:i, s:i}, s:{s:o, s:o, s:o, s:o, s:s},"
        " s:{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:f, s:f}, s:{s:o, s:o, s:o, s:o, s:o},"
        " s:{s:i, s:f, s:f, s:i, s:f, s:f, s:f, s:i, s:s}, s:o, s:o, s:f, s:o, s:{s:o}}",
        "version", ag_version(), "threads", (int)s->threads, "isa", isa, "seed", (json_int_t)settings->seed,
        "integrator", settings->integrator == AG_INTEGRATOR_PATH ? "path" : "photonmap", "cache",
        cache_name(settings->cache), "only", settings->only == AG_ONLY_INDIRECT ? "indirect" : "all", /**/
        "image", "width", settings->width, "height", settings->height, "samples_per_pixel",
        settings->samples_per_pixel, /**/
        "photons", "emitted", count(s->photons_emitted), "stored_global", count(s->photons_stored_global),
        "stored_caustic", count(s->photons_stored_caustic), "bytes", count(s->photon_bytes), "map_file",
        map_file_name(s->map_file), /**/
        "irradiance", "requests", count(s->irradiance_requests), "computed", count(s->irradiance_computed), "distinct",
        count(s->irradiance_distinct), "deferred", count(s->irradiance_deferred), "waited", count(s->irradiance_waited),
        "duplicated", count(s->irradiance_duplicated), "uncached", count(s->irradiance_uncached), "refused",
        count(s->irradiance_refused), "ready", count(s->irradiance_ready), "reclaimed", count(s->irradiance_reclaimed),
        "estimate_s", s->irradiance_estimate_s, "wait_s", s->irradiance_wait_s, /**/
        "rays", "camera", count(s->rays_camera), "shadow", count(s->rays_shadow), "gather", count(s->rays_gather),
        "photon", count(s->rays_photon), "path", count(s->rays_path), /**/
        "settings", "nearest", settings->nearest, "radius", (double)settings->radius, "irradiance_fraction",
        (double)settings->irradiance_fraction, "gather_samples", settings->gather_samples, "gather_guiding",
        (double)settings->gather_guiding, "photon_aim", (double)settings->photon_aim, "direct_guiding",
        (double)settings->direct_guiding, "max_depth", settings->max_depth, "pane_light",
        settings->pane_light == AG_PANE_LIGHT_DIRECT ? "direct" : "traced", /**/
        "samples_not_finite", count(s->samples_not_finite), "time_s", times, "cpu_s", s->cpu_s, "phase_cpu_s",
        cpu_times, "memory", "peak_bytes", count(s->memory_peak_bytes));
}

ag_status ag_statistics_write(ag_context *context, const char *path)
{
    if (!context || !path)
        return AG_ERROR_ARGUMENT;
    if (run_is_cancelled(&context->run))
        return AG_CANCELLED;
    ag_statistics statistics = ag_context_statistics(context);
    json_t *json = statistics_to_json(&statistics, &context->rendered, context->isa);
    char *text = json ? json_dumps(json, JSON_INDENT(2) | JSON_REAL_PRECISION(9)) : NULL;
    json_decref(json);
    if (!text)
        return AG_ERROR_MEMORY;
    size_t length = strlen(text);
    text[length] = '\n'; /* in place of the terminator: the file needs none */
    char message[1024];
    ag_status status = atomic_file_write(path, text, length + 1, message, sizeof message);
    if (status != AG_OK)
        log_message(context->log, AG_LOG_ERROR, "%s", message);
    free(text);
    return status;
}

ag_status ag_statistics_check(ag_context *context, const char *path)
{
    char message[1024];
    ag_status status = atomic_file_check(path, message, sizeof message);
    if (status != AG_OK)
        log_message(context->log, AG_LOG_ERROR, "%s", message);
    return status;
}
