/* light_picture.c: see light_picture.h. Threads: one per scene. */
#define _POSIX_C_SOURCE 200809L
#include "light_picture.h"

#include "image/image_encoding.h"
#include "image/image_reader.h"
#include "light/environment.h"
#include "texture/image_colors.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Returns the RGB of what was read; NULL when out of memory. */
static rgb *rgb_pixels(const image *picture)
{
    size_t count = (size_t)picture->width * (size_t)picture->height, channels = (size_t)picture->channel_count;
    rgb *pixels = malloc(count * sizeof *pixels);
    for (size_t i = 0; pixels && i < count; i++) {
        const float *v = &picture->pixels[i * channels];
        pixels[i] = channels >= 3 ? rgb_make(v[0], v[1], v[2]) : rgb_gray(v[0]);
    }
    return pixels;
}

/* Sets to 0 what is negative or not finite, before the matrix could mix it into other channels; returns how many pixels
 * had any, and converts all of them. */
static size_t clean_pixels(const image_colors *colors, rgb *pixels, size_t count)
{
    size_t bad_count = 0;
    for (size_t i = 0; i < count; i++) {
        float *c[3] = {&pixels[i].r, &pixels[i].g, &pixels[i].b};
        bool is_bad = false;
        for (int k = 0; k < 3; k++)
            if (!(*c[k] >= 0.0f && isfinite(*c[k]))) {
                is_bad = true;
                *c[k] = 0.0f;
            }
        bad_count += is_bad;
        if (colors->has_matrix)
            pixels[i] = image_colors_convert(colors, pixels[i]);
    }
    return bad_count;
}

/* Writes the message: what could not be done, then the reason. */
static ag_status describe_failure(ag_status status, const char *name, const char *reason, char *message,
                                  size_t message_size)
{
    if (status != AG_ERROR_MEMORY && status != AG_CANCELLED)
        snprintf(message, message_size, "cannot %s the picture \"%s\": %s",
                 status == AG_ERROR_COLOR ? "decode" : "read", name, reason);
    return status;
}

/* Converts a picture that was read, and takes it. path: by which the config's file rules know it. */
static ag_status take(const scene *s, const char *name, const char *path, image picture, bool is_gray,
                      light_picture *out_picture, char *message, size_t message_size)
{
    const image_colors_target *target = &s->textures.colors;
    char reason[512] = "";
    image_colors colors = {0};
    ag_status status = image_fill_window(&picture, path, reason, sizeof reason);
    if (status == AG_OK && !is_gray)
        status = image_colors_find(target, image_colors_rule(target, path), &picture, &colors, reason, sizeof reason);
    if (status == AG_OK && !colors.space)
        status = image_linearize(&picture, colors.encoding, reason, sizeof reason);
    if (status != AG_OK) {
        image_reset(&picture);
        return describe_failure(status, name, reason, message, message_size);
    }
    if (picture.width < 1 || picture.height < 1 || picture.width > ENVIRONMENT_MAX_SIZE ||
        picture.height > ENVIRONMENT_MAX_SIZE) {
        snprintf(message, message_size, "\"%s\" is %d x %d, which is beyond what a light may have", name, picture.width,
                 picture.height);
        image_reset(&picture);
        return AG_ERROR_SCENE;
    }
    const size_t count = (size_t)picture.width * (size_t)picture.height;
    light_picture p = {.width = (uint32_t)picture.width,
                       .height = (uint32_t)picture.height,
                       .pixels = rgb_pixels(&picture),
                       .is_first_of_several = picture.is_first_of_several};
    image_reset(&picture); /* freed as soon as possible, since it may take a gigabyte */
    if (!p.pixels)
        return AG_ERROR_MEMORY;
    if (colors.space)
        status = image_colors_decode(target, &colors, &p.pixels->r, count, reason, sizeof reason);
    if (status != AG_OK) {
        free(p.pixels);
        return describe_failure(status, name, reason, message, message_size);
    }
    p.bad_count = clean_pixels(&colors, p.pixels, count);
    *out_picture = p;
    return AG_OK;
}

ag_status light_picture_read(const run_context *run, const scene *s, const char *name, const char *path, bool is_gray,
                             light_picture *out_picture, char *message, size_t message_size)
{
    char reason[512] = "";
    image picture = {0};
    *out_picture = (light_picture){0};
    const ag_status status = image_read_colors(run, path, &picture, reason, sizeof reason);
    if (status != AG_OK) {
        image_reset(&picture);
        return describe_failure(status, name, reason, message, message_size);
    }
    return take(s, name, path, picture, is_gray, out_picture, message, message_size);
}

ag_status light_picture_take(const scene *s, const char *name, image *pixels, bool is_gray, light_picture *out_picture,
                             char *message, size_t message_size)
{
    const image picture = *pixels;
    *pixels = (image){0};
    *out_picture = (light_picture){0};
    return take(s, name, name, picture, is_gray, out_picture, message, message_size);
}

ag_status light_picture_surround(light_picture *picture, const char *name, environment **out_environment, char *message,
                                 size_t message_size)
{
    const uint32_t width = picture->width, height = picture->height;
    rgb *pixels = picture->pixels;
    picture->pixels = NULL;
    if (width != height && width != 2 * height) {
        free(pixels);
        snprintf(message, message_size,
                 "\"%s\" is %u x %u: the picture of such a light is square (octahedral) or twice as wide as high "
                 "(latitude-longitude)",
                 name, width, height);
        return AG_ERROR_SCENE;
    }
    return environment_create(width == height ? ENVIRONMENT_OCTAHEDRAL : ENVIRONMENT_LATITUDE_LONGITUDE, width, height,
                              pixels, out_environment);
}

environment *light_picture_find_kept(scene *s, const char *name, uint64_t version, bool is_gray)
{
    for (uint32_t i = 0; s->before && version != 0 && i < s->before->light_count; i++) {
        environment *e = light_picture_of(&s->before->lights[i]);
        if (e && e->name && e->version == version && e->is_gray == is_gray && strcmp(e->name, name) == 0) {
            s->reuse.light_pictures_kept++;
            return environment_hold(e);
        }
    }
    return NULL;
}

void light_picture_note(scene *s, const char *name, uint64_t version, bool is_gray, environment *e)
{
    s->reuse.light_pictures_read++;
    e->name = strdup(name); /* without memory it is read anew */
    e->version = version;
    e->is_gray = is_gray;
}
