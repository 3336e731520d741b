/* pbrt_light_pictures.c: pictures that lights throw, and LightSource "goniometric" and "projection" of a pbrt-v4 scene.
 * Rests on the format's description, pbrt.org/fileformat-v4, "Lights", and for which way up a picture is on pbrt-v4's
 * behaviour. Square pictures of directions are equal-area octahedral, as pbrt-v4 wants them; those twice as wide as
 * high, which it refuses, are latitude-longitude, as pbrt-v3 had them. Flow: pbrt_lights, pbrt_environments -> [here]
 * -> environment, projection. Threads: one per scene. */
#include "image/image_encoding.h"
#include "image/image_reader.h"
#include "light/environment.h"
#include "light/projection.h"
#include "pbrt/pbrt_private.h"

#include <stdlib.h>

ag_status pbrt_set_light_frame(pbrt_parser *parser, const parameter_list *list, bool swaps_yz, light *l)
{
    const transform *t = &parser->state.world_from_object;
    const int z_column = swaps_yz ? 1 : 2;
    if (!(transform_uniform_scale(t) > 0.0))
        log_at(parser->log, AG_LOG_WARNING, list->where,
               "LightSource \"%s\": the transform is not a rotation, reflection or scaling: the picture is not "
               "bent, just turned",
               list->name);
    double z[3], x[3], length = 0.0, along = 0.0;
    for (int i = 0; i < 3; i++)
        length += t->m[i][z_column] * t->m[i][z_column];
    length = sqrt(length);
    for (int i = 0; i < 3; i++) {
        z[i] = t->m[i][z_column] / length;
        along += z[i] * t->m[i][0];
    }
    length = 0.0;
    for (int i = 0; i < 3; i++) {
        x[i] = t->m[i][0] - along * z[i];
        length += x[i] * x[i];
    }
    length = sqrt(length);
    l->world_from_light.z = vec3_make((float)z[0], (float)z[1], (float)z[2]);
    l->world_from_light.x = vec3_make((float)(x[0] / length), (float)(x[1] / length), (float)(x[2] / length));
    vec3 y = vec3_cross(l->world_from_light.z, l->world_from_light.x);
    l->world_from_light.y = transform_swaps_handedness(t) != swaps_yz ? vec3_negate(y) : y;
    const frame *f = &l->world_from_light;
    if (!vec3_is_finite(f->x) || !vec3_is_finite(f->y) || !vec3_is_finite(f->z))
        return pbrt_refuse(parser, list, "filename", "the transform leaves no direction");
    return AG_OK;
}

/* RGB of what was read; NULL when out of memory. */
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

/* Makes what is negative or not finite 0, before the matrix may make it anything else; gives the number of pixels. */
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

/* A picture's pixels, from malloc. is_gray: they are no colours. */
static ag_status read_pixels(pbrt_parser *parser, const parameter_list *list, const char *name, bool is_gray,
                             uint32_t *out_width, uint32_t *out_height, rgb **out_pixels)
{
    char message[512];
    image picture = {0};
    image_colors colors = {0};
    char *path = pbrt_find_file(parser, name);
    ag_status status = path ? pbrt_allow_picture(parser, path, message, sizeof message) : AG_ERROR_MEMORY;
    if (status == AG_OK)
        status = image_read(path, &picture, message, sizeof message);
    *out_pixels = NULL;
    if (status == AG_OK && !is_gray)
        status = image_colors_find(parser->scene, image_colors_rule(parser->scene, path), &picture, &colors, message,
                                   sizeof message);
    free(path);
    if (status == AG_OK && !colors.space)
        status = image_linearize(&picture, colors.encoding, message, sizeof message);
    if (status == AG_ERROR_COLOR)
        pbrt_refuse(parser, list, "filename", "cannot decode the picture \"%s\": %s", name, message);
    if (status == AG_ERROR_INPUT || status == AG_ERROR_SYSTEM)
        pbrt_refuse(parser, list, "filename", "cannot read the picture \"%s\": %s", name, message);
    if (status == AG_OK && (picture.width < 1 || picture.height < 1 || picture.width > ENVIRONMENT_MAX_SIZE ||
                            picture.height > ENVIRONMENT_MAX_SIZE))
        status = pbrt_refuse(parser, list, "filename", "\"%s\" is %d x %d, which is beyond what a light may have", name,
                             picture.width, picture.height);
    const size_t count = (size_t)picture.width * (size_t)picture.height;
    if (status == AG_OK) {
        *out_width = (uint32_t)picture.width;
        *out_height = (uint32_t)picture.height;
        *out_pixels = rgb_pixels(&picture);
        status = *out_pixels ? AG_OK : AG_ERROR_MEMORY;
    }
    image_reset(&picture); /* as soon as can be: large ones are a gigabyte */
    if (status == AG_OK && colors.space) {
        status = image_colors_decode(parser->scene, &colors, &(*out_pixels)->r, count, message, sizeof message);
        if (status == AG_ERROR_COLOR)
            pbrt_refuse(parser, list, "filename", "cannot decode the picture \"%s\": %s", name, message);
    }
    if (status != AG_OK) {
        free(*out_pixels);
        *out_pixels = NULL;
        return status;
    }
    size_t bad_count = clean_pixels(&colors, *out_pixels, count);
    if (bad_count > 0)
        log_at(parser->log, AG_LOG_WARNING, parameter_list_find(list, "filename")->where,
               "\"%s\": %zu pixels are negative, infinite or not a number; what is counts as 0", name, bad_count);
    return status;
}

ag_status pbrt_read_environment(pbrt_parser *parser, const parameter_list *list, const char *name, bool is_gray,
                                environment **out_environment)
{
    uint32_t width, height;
    rgb *pixels;
    PBRT_TRY(read_pixels(parser, list, name, is_gray, &width, &height, &pixels));
    if (width != height && width != 2 * height) {
        free(pixels);
        return pbrt_refuse(parser, list, "filename",
                           "\"%s\" is %u x %u: the picture of such a light is square (octahedral) or twice as wide "
                           "as high (latitude-longitude)",
                           name, width, height);
    }
    for (size_t i = 0; is_gray && i < (size_t)width * height; i++)
        pixels[i] = rgb_gray((pixels[i].r + pixels[i].g + pixels[i].b) / 3.0f);
    return environment_create(width == height ? ENVIRONMENT_OCTAHEDRAL : ENVIRONMENT_LATITUDE_LONGITUDE, width, height,
                              pixels, out_environment);
}

/* --- lights at a point --- */

static ag_status read_common(pbrt_parser *parser, parameter_list *list, const char **out_name, double *out_scale,
                             double *out_power, light *l)
{
    float scale = 1.0f, power = -1.0f;
    *out_name = "";
    PBRT_TRY(parameter_get_string(list, parser->log, "filename", out_name));
    PBRT_TRY(parameter_get_float(list, parser->log, "scale", &scale));
    PBRT_TRY(parameter_get_float(list, parser->log, "power", &power));
    if (scale < 0.0f)
        return pbrt_refuse(parser, list, "scale", "\"scale\" should not be negative");
    if (!(*out_name)[0])
        return pbrt_refuse(parser, list, "filename", "a \"%s\" light needs a picture, \"string filename\"", list->name);
    l->position = transform_point(&parser->state.world_from_object, vec3_make(0.0f, 0.0f, 0.0f));
    *out_scale = scale;
    *out_power = power;
    return vec3_is_finite(l->position) ? AG_OK : pbrt_error(parser, list->where, 1, "the light is too far away");
}

/* intensity times scale; where power is given, as much as makes a light of intensity 1 have it. */
static ag_status set_intensity(pbrt_parser *parser, const parameter_list *list, rgb color, double scale, double power,
                               double power_of_one, light *l)
{
    double factor = scale;
    if (power > 0.0) {
        if (!(power_of_one > 0.0))
            return pbrt_refuse(parser, list, "power", "the picture is black");
        factor *= power / power_of_one;
    }
    l->intensity = rgb_make((float)(color.r * factor), (float)(color.g * factor), (float)(color.b * factor));
    return rgb_is_finite(l->intensity) ? AG_OK
                                       : pbrt_refuse(parser, list, "scale", "the light is too bright for a float");
}

static ag_status read_goniometric(pbrt_parser *parser, parameter_list *list, light *l)
{
    const char *name;
    double scale = 1.0, power = -1.0;
    rgb color = rgb_gray(1.0f);
    l->kind = LIGHT_GONIOMETRIC;
    PBRT_TRY(read_common(parser, list, &name, &scale, &power, l));
    PBRT_TRY(parameter_get_rgb(list, parser->log, "I", &color));
    PBRT_TRY(pbrt_set_light_frame(parser, list, true, l));
    PBRT_TRY(pbrt_read_environment(parser, list, name, true, &l->environment));
    PBRT_TRY(set_intensity(parser, list, color, scale, power, l->environment->integral.g, l));
    return rgb_is_finite(environment_integral(l))
               ? AG_OK
               : pbrt_refuse(parser, list, "scale", "the light is too bright for a float");
}

static ag_status read_projection(pbrt_parser *parser, parameter_list *list, light *l)
{
    const char *name;
    double scale = 1.0, power = -1.0;
    float fov = 90.0f;
    uint32_t width, height;
    rgb *pixels;
    l->kind = LIGHT_PROJECTION;
    PBRT_TRY(read_common(parser, list, &name, &scale, &power, l));
    PBRT_TRY(parameter_get_float(list, parser->log, "fov", &fov));
    if (!(fov > 0.0f && fov < 180.0f))
        return pbrt_refuse(parser, list, "fov", "\"fov\" should be within (0, 180) degrees");
    PBRT_TRY(pbrt_set_light_frame(parser, list, false, l));
    l->direction = l->world_from_light.z;
    PBRT_TRY(read_pixels(parser, list, name, false, &width, &height, &pixels));
    PBRT_TRY(projection_create(width, height, pixels, fov, &l->projection));
    PBRT_TRY(set_intensity(parser, list, rgb_gray(1.0f), scale, power,
                           working_space_luminance(&parser->scene->space, l->projection->integral), l));
    return rgb_is_finite(rgb_mul(l->intensity, l->projection->integral))
               ? AG_OK
               : pbrt_refuse(parser, list, "scale", "the light is too bright for a float");
}

ag_status pbrt_goniometric_light(pbrt_parser *parser, parameter_list *list, light *out_light)
{
    ag_status status = read_goniometric(parser, list, out_light);
    if (status != AG_OK)
        light_reset(out_light);
    return status;
}

ag_status pbrt_projection_light(pbrt_parser *parser, parameter_list *list, light *out_light)
{
    ag_status status = read_projection(parser, list, out_light);
    if (status != AG_OK)
        light_reset(out_light);
    return status;
}
