/* picture_layers.c: see picture_layers.h. */
#include "output/picture_layers.h"

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

static void add_numbers(picture_layers *out, const char *name, const float *numbers, int count)
{
    if (out->attribute_count < PICTURE_ATTRIBUTES_MAX)
        out->attributes[out->attribute_count++] =
            (image_attribute){.name = name, .numbers = numbers, .number_count = count};
}

static void add_text(picture_layers *out, const char *name, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* name lives as long as the program; what does not fit is left out. */
static void add_text(picture_layers *out, const char *name, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    size_t room = out->text_capacity - out->text_length;
    int length = vsnprintf(out->text + out->text_length, room, format, arguments);
    va_end(arguments);
    if (length < 0 || (size_t)length >= room || out->attribute_count >= PICTURE_ATTRIBUTES_MAX)
        return;
    out->attributes[out->attribute_count++] = (image_attribute){.name = name, .text = out->text + out->text_length};
    out->text_length += (size_t)length + 1;
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

/* What differs from run to run. */
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

static void describe(ag_context *context, const ag_film *film, const ag_output_settings *settings, picture_layers *out)
{
    const ag_render_settings *r = &film->origin.settings;
    const ag_statistics *s = &context->statistics;
    bool is_path = r->integrator == AG_INTEGRATOR_PATH;
    out->attributes[out->attribute_count++] = (image_attribute){.name = "Software", .text = "Afterglow"};
    add_numbers(out, "worldToCamera", film->origin.world_to_camera, 16);
    if (film->origin.has_ndc)
        add_numbers(out, "worldToNDC", film->origin.world_to_ndc, 16);
    if (film->origin.defined && film->origin.defined[0])
        add_text(out, "afterglow/define", "%s", film->origin.defined);
    add_text(out, "afterglow/version", "%s", ag_version());
    add_text(out, "afterglow/isa", "%s", context->isa);
    add_text(out, "afterglow/integrator", "%s", is_path ? "path" : "photonmap");
    add_text(out, "afterglow/paneLight", "%s", r->pane_light == AG_PANE_LIGHT_DIRECT ? "direct" : "traced");
    add_text(out, "afterglow/seed", "%lld", (long long)r->seed);
    add_text(out, "afterglow/samplesPerPixel", "%d", r->samples_per_pixel);
    add_text(out, "afterglow/directGuiding", "%g", (double)r->direct_guiding);
    if (!is_path) {
        add_text(out, "afterglow/gatherSamples", "%d", r->gather_samples);
        add_text(out, "afterglow/gatherGuiding", "%g", (double)r->gather_guiding);
        add_text(out, "afterglow/photonAim", "%g", (double)r->photon_aim);
        add_text(out, "afterglow/irradianceFraction", "%g", (double)r->irradiance_fraction);
        add_text(out, "afterglow/photonsGlobal", "%llu", (unsigned long long)s->photons_stored_global);
        add_text(out, "afterglow/photonsCaustic", "%llu", (unsigned long long)s->photons_stored_caustic);
        add_text(out, "afterglow/photonPathsEmitted", "%llu", (unsigned long long)s->photons_emitted);
    }
    for (int i = 0; i < CRYPTOMATTE_KIND_COUNT; i++) {
        const cryptomatte *m = &film->mattes[i];
        const char *const texts[4] = {m->layer, "MurmurHash3_32", "uint32_to_float32", m->manifest};
        for (int k = 0; m->layer && k < 4; k++)
            out->attributes[out->attribute_count++] =
                (image_attribute){.name = m->attribute_names[k], .text = texts[k]};
    }
    if (!settings->reproducible)
        describe_run(context, settings, out);
}

ag_status picture_layers_create(ag_context *context, const ag_film *film, const float *beauty,
                                const ag_output_settings *settings, image_sample_type type, const char *path,
                                picture_layers *out_layers)
{
    picture_layers made = {.text_capacity = PICTURE_TEXT_MAX};
    if (settings->command_line)
        made.text_capacity += strlen(settings->command_line);
    if (film->origin.defined)
        made.text_capacity += strlen(film->origin.defined) + 1;
    made.text = malloc(made.text_capacity);
    ag_status status = made.text ? fill_pixels(context, film, beauty, type, path, &made) : AG_ERROR_MEMORY;
    if (status != AG_OK) {
        picture_layers_reset(&made);
        return status;
    }
    *out_layers = made;
    describe(context, film, settings, out_layers); /* attributes point into it */
    return AG_OK;
}

void picture_layers_add_numbers(picture_layers *layers, const char *name, const float *numbers, int count)
{
    add_numbers(layers, name, numbers, count);
}

void picture_layers_reset(picture_layers *layers)
{
    free(layers->pixels);
    free(layers->names);
    free(layers->types);
    free(layers->text);
    *layers = (picture_layers){0};
}
