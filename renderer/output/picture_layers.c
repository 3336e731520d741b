/* picture_layers.c: see picture_layers.h. */
#define _GNU_SOURCE
#include "output/picture_layers.h"

#include "film/film_channels.h"
#include "integrator/integrator.h"
#include "settings_table.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const float LARGEST_HALF = 65504.0f;

/* --- pixels --- */

static void clean(ag_context *context, const picture_layers *layers, size_t pixel_count, const char *path)
{
    uint64_t not_finite = 0, too_bright = 0;
    for (size_t i = 0; i < pixel_count; i++) {
        bool is_odd = false, is_cut = false;
        for (int c = 0; c < layers->channel_count; c++) {
            float *value = &layers->pixels[i * (size_t)layers->channel_count + (size_t)c];
            if (!isfinite(*value)) {
                *value = 0.0f;
                is_odd = true;
            }
            is_cut = is_cut || (layers->types[c] == IMAGE_HALF && fabsf(*value) > LARGEST_HALF);
        }
        not_finite += is_odd;
        too_bright += is_cut;
    }
    if (not_finite > 0)
        log_message(context->log, AG_LOG_WARNING, "%s: %llu pixels have values that are not finite: they are 0", path,
                    (unsigned long long)not_finite);
    if (too_bright > 0)
        log_message(context->log, AG_LOG_WARNING,
                    "%s: %llu pixels have values above 65504, the most that half can hold: they are clamped; floats "
                    "are not",
                    path, (unsigned long long)too_bright);
}

static ag_status fill_pixels(ag_context *context, const ag_film *film, const float *beauty, image_sample_type type,
                             const char *path, picture_layers *out)
{
    size_t pixel_count = (size_t)film->width * (size_t)film->height, count = (size_t)film->layout.channel_count;
    out->channel_count = film->layout.channel_count;
    out->pixels = malloc(pixel_count * count * sizeof *out->pixels);
    out->names = malloc(count * sizeof *out->names);
    out->types = malloc(count * sizeof *out->types);
    if (!out->pixels || !out->names || !out->types)
        return AG_ERROR_MEMORY;
    for (int c = 0; c < out->channel_count; c++) {
        const film_channel *channel = &film->layout.channels[c];
        out->names[c] = channel->name;
        out->types[c] = channel->is_exact ? IMAGE_FLOAT : type;
        if (channel->source != CHANNEL_BEAUTY)
            film_read_channel(film, c, out->pixels + c, count);
        for (size_t i = 0; channel->source == CHANNEL_BEAUTY && i < pixel_count; i++)
            out->pixels[i * count + (size_t)c] = beauty[3 * i + (size_t)channel->component];
    }
    clean(context, out, pixel_count, path);
    return AG_OK;
}

/* --- attributes --- */

/* Adds an attribute; where there is no memory for it, has_failed says so in the end. text, where it is not NULL, is
 * taken. */
static void add_attribute(picture_layers *out, image_attribute attribute, char *text)
{
    image_attribute *attributes = out->attributes;
    char **texts = out->texts;
    if (out->attribute_count == out->attribute_capacity) {
        size_t capacity = out->attribute_capacity > 0 ? 2 * (size_t)out->attribute_capacity : 64;
        attributes = realloc(out->attributes, capacity * sizeof *attributes);
        out->attributes = attributes ? attributes : out->attributes;
        texts = realloc(out->texts, capacity * sizeof *texts);
        out->texts = texts ? texts : out->texts;
        if (attributes && texts)
            out->attribute_capacity = (int)capacity;
    }
    if (!attributes || !texts) {
        out->has_failed = true;
        free(text);
        return;
    }
    texts[out->attribute_count] = text;
    attributes[out->attribute_count++] = attribute;
}

static void add_numbers(picture_layers *out, const char *name, const float *numbers, int count)
{
    add_attribute(out, (image_attribute){.name = name, .numbers = numbers, .number_count = count}, NULL);
}

static void add_text(picture_layers *out, const char *name, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Name and text are copied. */
static void add_text(picture_layers *out, const char *name, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    char *value = NULL, *both = NULL;
    int length = vasprintf(&value, format, arguments);
    va_end(arguments);
    size_t name_size = strlen(name) + 1;
    if (length >= 0)
        both = malloc(name_size + (size_t)length + 1);
    if (both) {
        memcpy(both, name, name_size);
        memcpy(both + name_size, value, (size_t)length + 1);
        add_attribute(out, (image_attribute){.name = both, .text = both + name_size}, both);
    } else {
        out->has_failed = true;
    }
    if (length >= 0)
        free(value);
}

/* "unknown" where the system does not say. */
static void read_cpu_name(char *out, size_t size)
{
    char line[512];
    snprintf(out, size, "unknown");
    FILE *file = fopen("/proc/cpuinfo", "r");
    while (file && fgets(line, sizeof line, file)) {
        const char *colon = strchr(line, ':');
        if (strncmp(line, "model name", strlen("model name")) == 0 && colon) {
            snprintf(out, size, "%s", colon + 1 + (colon[1] == ' '));
            out[strcspn(out, "\n")] = '\0';
            break;
        }
    }
    if (file)
        fclose(file);
}

/* Adds the attributes that differ from run to run. */
static void describe_run(ag_context *context, const ag_output_settings *settings, picture_layers *out)
{
    ag_statistics s = ag_context_statistics(context);
    char cpu[256];
    read_cpu_name(cpu, sizeof cpu);
    if (settings->command_line)
        add_text(out, "afterglow/commandLine", "%s", settings->command_line);
    add_text(out, "afterglow/threads", "%u", s.threads);
    add_text(out, "afterglow/cpu", "%s", cpu);
    add_text(out, "afterglow/memoryPeakBytes", "%llu", (unsigned long long)s.memory_peak_bytes);
    /* of this process, samples that a pause cut short counted twice */
    add_text(out, "afterglow/irradianceRequests", "%llu", (unsigned long long)s.irradiance_requests);
    add_text(out, "afterglow/irradianceComputed", "%llu", (unsigned long long)s.irradiance_computed);
    add_text(out, "afterglow/irradianceDeferred", "%llu", (unsigned long long)s.irradiance_deferred);
    add_text(out, "afterglow/irradianceWaited", "%llu", (unsigned long long)s.irradiance_waited);
    out->render_time = (float)s.time_total_s;
    add_numbers(out, "renderTimeSeconds", &out->render_time, 1); /* as pbrt-v4 calls it */
}

/* "settings.pane_light", as the statistics call it, becomes "afterglow/paneLight". */
static void name_attribute(const char *json, char *out, size_t size)
{
    const char *dot = strchr(json, '.');
    size_t length = (size_t)snprintf(out, size, "afterglow/");
    for (const char *c = dot ? dot + 1 : json; *c && length + 1 < size; c++) {
        bool is_capital = *c == '_' && c[1] != '\0';
        c += is_capital;
        out[length++] = is_capital && *c >= 'a' && *c <= 'z' ? (char)(*c - 'a' + 'A') : *c;
    }
    out[length] = '\0';
}

static void describe_settings(const ag_render_settings *settings, picture_layers *out)
{
    for (size_t i = 0; setting_at(i); i++) {
        const setting_row *row = setting_at(i);
        char value[SETTING_TEXT_MAX], name[64];
        if (!(row->marks & SETTING_IN_HEADER) ||
            (!integrator_of(settings->integrator)->has_photon_map && (row->marks & SETTING_OF_PHOTONS)))
            continue;
        name_attribute(row->json, name, sizeof name);
        setting_format(row, settings, value);
        add_text(out, name, "%s", value);
    }
}

static void describe(ag_context *context, const ag_film *film, const ag_output_settings *settings, picture_layers *out)
{
    const ag_render_settings *r = &film->origin.settings;
    const ag_statistics *s = &context->statistics;
    add_attribute(out, (image_attribute){.name = "Software", .text = "Afterglow"}, NULL);
    add_numbers(out, "worldToCamera", film->origin.world_to_camera, 16);
    if (film->origin.has_ndc)
        add_numbers(out, "worldToNDC", film->origin.world_to_ndc, 16);
    if (film->origin.defined && film->origin.defined[0])
        add_text(out, "afterglow/define", "%s", film->origin.defined);
    add_text(out, "afterglow/version", "%s", ag_version());
    add_text(out, "afterglow/isa", "%s", context->isa);
    describe_settings(r, out);
    if (integrator_of(r->integrator)->has_photon_map) {
        add_text(out, "afterglow/photonsGlobal", "%llu", (unsigned long long)s->photons_stored_global);
        add_text(out, "afterglow/photonsCaustic", "%llu", (unsigned long long)s->photons_stored_caustic);
        add_text(out, "afterglow/photonPathsEmitted", "%llu", (unsigned long long)s->photons_emitted);
    }
    for (int i = 0; i < CRYPTOMATTE_KIND_COUNT; i++) {
        const cryptomatte *m = &film->mattes[i];
        const char *const texts[4] = {m->layer, "MurmurHash3_32", "uint32_to_float32", m->manifest};
        for (int k = 0; m->layer && k < 4; k++)
            add_attribute(out, (image_attribute){.name = m->attribute_names[k], .text = texts[k]}, NULL);
    }
    if (!settings->reproducible)
        describe_run(context, settings, out);
}

ag_status picture_layers_create(ag_context *context, const ag_film *film, const float *beauty,
                                const ag_output_settings *settings, image_sample_type type, const char *path,
                                picture_layers *out_layers)
{
    *out_layers = (picture_layers){0};
    ag_status status = fill_pixels(context, film, beauty, type, path, out_layers);
    if (status == AG_OK)
        describe(context, film, settings, out_layers);
    if (status == AG_OK && out_layers->has_failed)
        status = AG_ERROR_MEMORY;
    if (status != AG_OK)
        picture_layers_reset(out_layers);
    return status;
}

ag_status picture_layers_add_numbers(picture_layers *layers, const char *name, const float *numbers, int count)
{
    add_numbers(layers, name, numbers, count);
    return layers->has_failed ? AG_ERROR_MEMORY : AG_OK;
}

void picture_layers_reset(picture_layers *layers)
{
    for (int i = 0; i < layers->attribute_count; i++)
        free(layers->texts[i]);
    free(layers->pixels);
    free(layers->names);
    free(layers->types);
    free(layers->texts);
    free(layers->attributes);
    *layers = (picture_layers){0};
}
