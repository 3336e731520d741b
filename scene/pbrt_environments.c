/* pbrt_environments.c: LightSource "infinite" of a pbrt-v4 scene.
 * Rests on the format's description, pbrt.org/fileformat-v4, "Lights". Square pictures are equal-area octahedral, as
 * pbrt-v4 wants them; those twice as wide as high, which it refuses, are latitude-longitude, as pbrt-v3 had them.
 * Flow: pbrt_lights -> [here] -> environment, scene. Threads: one per scene. */
#include "environment.h"
#include "image_encoding.h"
#include "image_reader.h"
#include "pbrt_private.h"

#include <stdlib.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

/* The axes of the light's space in the world. What is no rotation, reflection or scaling keeps its z axis, and x as far
 * as it can. */
static ag_status set_frame(pbrt_parser *parser, const parameter_list *list, light *l)
{
    const transform *t = &parser->state.world_from_object;
    if (!(transform_uniform_scale(t) > 0.0))
        log_at(parser->log, AG_LOG_WARNING, list->where,
               "LightSource \"infinite\": the transform is not a rotation, reflection or scaling: the picture is not "
               "bent, just turned");
    double z[3], x[3], length = 0.0, along = 0.0;
    for (int i = 0; i < 3; i++)
        length += t->m[i][2] * t->m[i][2];
    length = sqrt(length);
    for (int i = 0; i < 3; i++) {
        z[i] = t->m[i][2] / length;
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
    l->world_from_light.y = transform_swaps_handedness(t) ? vec3_negate(y) : y;
    const frame *f = &l->world_from_light;
    if (!vec3_is_finite(f->x) || !vec3_is_finite(f->y) || !vec3_is_finite(f->z))
        return pbrt_refuse(parser, list, "filename", "the transform leaves no direction");
    return AG_OK;
}

/* RGB of what was read, finite and not negative; NULL when out of memory. */
static rgb *finite_pixels(const image *picture, size_t *out_bad_count)
{
    size_t count = (size_t)picture->width * (size_t)picture->height, channels = (size_t)picture->channel_count;
    rgb *pixels = malloc(count * sizeof *pixels);
    *out_bad_count = 0;
    for (size_t i = 0; pixels && i < count; i++) {
        float c[3];
        bool is_bad = false;
        for (size_t k = 0; k < 3; k++) {
            float v = picture->pixels[i * channels + (channels >= 3 ? k : 0)];
            if (!(v >= 0.0f && isfinite(v))) {
                is_bad = true;
                v = 0.0f;
            }
            c[k] = v;
        }
        *out_bad_count += is_bad;
        pixels[i] = rgb_make(c[0], c[1], c[2]);
    }
    return pixels;
}

/* Frees the picture as soon as it can: large ones are a gigabyte. */
static ag_status create_environment(pbrt_parser *parser, const parameter_list *list, const char *name, image *picture,
                                    environment **out_environment)
{
    int width = picture->width, height = picture->height;
    if (width < 1 || height < 1 || width > ENVIRONMENT_MAX_SIZE || (width != height && width != 2 * height))
        return pbrt_refuse(
            parser, list, "filename",
            "\"%s\" is %d x %d: the picture of an infinite light is square (octahedral) or twice as wide "
            "as high (latitude-longitude)",
            name, width, height);
    size_t bad_count;
    rgb *pixels = finite_pixels(picture, &bad_count);
    image_reset(picture);
    if (!pixels)
        return AG_ERROR_MEMORY;
    if (bad_count > 0)
        log_at(parser->log, AG_LOG_WARNING, parameter_list_find(list, "filename")->where,
               "\"%s\": %zu pixels are negative, infinite or not a number; what is counts as 0", name, bad_count);
    return environment_create(width == height ? ENVIRONMENT_OCTAHEDRAL : ENVIRONMENT_LATITUDE_LONGITUDE,
                              (uint32_t)width, (uint32_t)height, pixels, out_environment);
}

static ag_status read_picture(pbrt_parser *parser, const parameter_list *list, const char *name,
                              environment **out_environment)
{
    char message[512];
    image picture = {0};
    char *path = pbrt_find_file(parser, name);
    ag_status status = path ? image_read(path, &picture, message, sizeof message) : AG_ERROR_MEMORY;
    free(path);
    if (status == AG_OK)
        status = image_linearize(&picture, (image_encoding){0}, message, sizeof message);
    if (status == AG_ERROR_COLOR)
        pbrt_refuse(parser, list, "filename", "cannot decode the picture \"%s\": %s", name, message);
    if (status == AG_ERROR_INPUT || status == AG_ERROR_SYSTEM)
        pbrt_refuse(parser, list, "filename", "cannot read the picture \"%s\": %s", name, message);
    if (status == AG_OK)
        status = create_environment(parser, list, name, &picture, out_environment);
    image_reset(&picture); /* where it is not empty yet */
    return status;
}

/* The measure of "illuminance" for a picture: what reaches a surface that faces the light's z, but half of it: pbrt
 * counts each pixel as 2 pi / count, and scenes are lit by what comes of that. */
static double picture_illuminance(const environment *e)
{
    double sum = 0.0;
    for (uint32_t y = 0; y < e->height; y++) {
        double row = 0.0;
        for (uint32_t x = 0; x < e->width; x++) {
            vec3 d = environment_direction(e, x, y, (vec2){0.5f, 0.5f});
            if (d.z > 0.0f)
                row += (double)d.z * rgb_luminance(e->pixels[(size_t)y * e->width + x]);
        }
        sum += row * 0.5 * environment_pixel_solid_angle(e, y);
    }
    return sum;
}

static ag_status read_infinite(pbrt_parser *parser, parameter_list *list, light *l)
{
    log_sink *log = parser->log;
    const char *name = "";
    const double *portal;
    size_t portal_count;
    float scale = 1.0f, illuminance = -1.0f;
    l->kind = LIGHT_INFINITE;
    l->radiance = rgb_gray(1.0f);
    PBRT_TRY(parameter_get_string(list, log, "filename", &name));
    if (name[0] && parameter_list_find(list, "L"))
        return pbrt_refuse(parser, list, "L", "an infinite light has \"L\" or \"filename\", not both");
    PBRT_TRY(parameter_get_rgb(list, log, "L", &l->radiance));
    PBRT_TRY(parameter_get_float(list, log, "scale", &scale));
    PBRT_TRY(parameter_get_float(list, log, "illuminance", &illuminance));
    PBRT_TRY(parameter_get_numbers(list, log, "portal", PARAMETER_POINT3, &portal, &portal_count));
    if (scale < 0.0f)
        return pbrt_refuse(parser, list, "scale", "\"scale\" should not be negative");
    if (portal_count > 0)
        log_at_once(log, AG_LOG_WARNING, parameter_list_find(list, "portal")->where, "infinite portal",
                    "LightSource \"infinite\": \"portal\" is not supported yet: light comes from everywhere");

    double factor = scale, measure = PI;
    if (name[0]) {
        PBRT_TRY(set_frame(parser, list, l));
        PBRT_TRY(read_picture(parser, list, name, &l->environment));
        if (illuminance > 0.0f)
            measure = picture_illuminance(l->environment);
    }
    if (illuminance > 0.0f) {
        if (!(measure > 0.0))
            return pbrt_refuse(parser, list, "illuminance", "no light comes from the upper half of the picture");
        factor *= illuminance / measure;
    }
    rgb c = l->radiance;
    l->radiance = rgb_make((float)(c.r * factor), (float)(c.g * factor), (float)(c.b * factor));
    if (!rgb_is_finite(environment_integral(l)))
        return pbrt_refuse(parser, list, "scale", "the light is too bright for a float");
    return AG_OK;
}

ag_status pbrt_infinite_light(pbrt_parser *parser, parameter_list *list, light *out_light)
{
    ag_status status = read_infinite(parser, list, out_light);
    if (status != AG_OK) {
        environment_destroy(out_light->environment);
        out_light->environment = NULL;
    }
    return status;
}
