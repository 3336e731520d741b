/* pbrt_light_pictures.c: pictures that lights throw, and LightSource "goniometric" and "projection" of a pbrt-v4 scene.
 * Rests on the format's description, pbrt.org/fileformat-v4, "Lights", and for which way up a picture is on pbrt-v4's
 * behaviour. Square pictures of directions are equal-area octahedral, as pbrt-v4 wants them; those twice as wide as
 * high, which it refuses, are latitude-longitude, as pbrt-v3 had them. Flow: pbrt_lights, pbrt_environments -> [here]
 * -> environment, projection. Threads: one per scene. */
#include "image/image_reader.h"
#include "light/environment.h"
#include "light/projection.h"
#include "light_picture.h"
#include "pbrt/pbrt_private.h"

#include <stdio.h>
#include <stdlib.h>

ag_status pbrt_set_light_frame(pbrt_parser *parser, const parameter_list *list, bool swaps_yz, frame *out_frame)
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
    out_frame->z = vec3_make((float)z[0], (float)z[1], (float)z[2]);
    out_frame->x = vec3_make((float)(x[0] / length), (float)(x[1] / length), (float)(x[2] / length));
    vec3 y = vec3_cross(out_frame->z, out_frame->x);
    out_frame->y = transform_swaps_handedness(t) != swaps_yz ? vec3_negate(y) : y;
    const frame *f = out_frame;
    if (!vec3_is_finite(f->x) || !vec3_is_finite(f->y) || !vec3_is_finite(f->z))
        return pbrt_refuse(parser, list, "filename", "the transform leaves no direction");
    return AG_OK;
}

/* Tells the reason at its location; running out of memory and cancelling have none. */
static ag_status refuse_picture(pbrt_parser *parser, const parameter_list *list, ag_status status, const char *message)
{
    if (status != AG_ERROR_MEMORY && status != AG_CANCELLED)
        pbrt_refuse(parser, list, "filename", "%s", message);
    return status;
}

static ag_status read_file(pbrt_parser *parser, const char *name, bool is_gray, light_picture *out_picture,
                           char *message, size_t message_size)
{
    char *path = pbrt_find_file(parser, name);
    if (!path)
        return AG_ERROR_MEMORY;
    char reason[512];
    ag_status status = pbrt_allow_picture(parser, path, reason, sizeof reason);
    if (status == AG_OK)
        status =
            light_picture_read(parser->run, parser->scene, name, path, is_gray, out_picture, message, message_size);
    else
        snprintf(message, message_size, "cannot read the picture \"%s\": %s", name, reason);
    free(path);
    return status;
}

/* Reads a picture's pixels, from malloc. is_gray: they are no colours. */
static ag_status read_pixels(pbrt_parser *parser, const parameter_list *list, const char *name, bool is_gray,
                             light_picture *out_picture)
{
    char message[768] = "";
    const pbrt_picture *in_memory = pbrt_find_picture(parser, name);
    ag_status status = AG_ERROR_MEMORY;
    image copy;
    if (in_memory && image_copy(in_memory->pixels, true, &copy))
        status = light_picture_take(parser->scene, name, &copy, is_gray, out_picture, message, sizeof message);
    else if (!in_memory)
        status = read_file(parser, name, is_gray, out_picture, message, sizeof message);
    if (status != AG_OK)
        return refuse_picture(parser, list, status, message);
    if (out_picture->is_first_of_several)
        log_at(parser->log, AG_LOG_WARNING, parameter_list_find(list, "filename")->where,
               "\"%s\": " LIGHT_PICTURE_OTHERS, name);
    if (out_picture->bad_count > 0)
        log_at(parser->log, AG_LOG_WARNING, parameter_list_find(list, "filename")->where,
               "\"%s\": %zu pixels are negative, infinite or not a number; what is counts as 0", name,
               out_picture->bad_count);
    return AG_OK;
}

ag_status pbrt_read_environment(pbrt_parser *parser, const parameter_list *list, const char *name, bool is_gray,
                                environment **out_environment)
{
    char message[768] = "";
    light_picture picture;
    uint64_t version;
    AG_TRY(pbrt_picture_version(parser, name, &version));
    *out_environment = light_picture_find_kept(parser->scene, name, version, is_gray);
    if (*out_environment)
        return AG_OK;
    AG_TRY(read_pixels(parser, list, name, is_gray, &picture));
    for (size_t i = 0; is_gray && i < (size_t)picture.width * picture.height; i++)
        picture.pixels[i] = rgb_gray((picture.pixels[i].r + picture.pixels[i].g + picture.pixels[i].b) / 3.0f);
    ag_status status = light_picture_surround(&picture, name, out_environment, message, sizeof message);
    if (status != AG_OK)
        return refuse_picture(parser, list, status, message);
    light_picture_note(parser->scene, name, version, is_gray, *out_environment);
    return AG_OK;
}

/* --- lights at a point --- */

static ag_status read_common(pbrt_parser *parser, parameter_list *list, const char **out_name, double *out_scale,
                             double *out_power, vec3 *out_position)
{
    float scale = 1.0f, power = -1.0f;
    *out_name = "";
    AG_TRY(parameter_get_string(list, parser->log, "filename", out_name));
    AG_TRY(parameter_get_float(list, parser->log, "scale", &scale));
    AG_TRY(parameter_get_float(list, parser->log, "power", &power));
    if (scale < 0.0f)
        return pbrt_refuse(parser, list, "scale", "\"scale\" should not be negative");
    if (!(*out_name)[0])
        return pbrt_refuse(parser, list, "filename", "a \"%s\" light needs a picture, \"string filename\"", list->name);
    *out_position = transform_point(&parser->state.world_from_object, vec3_make(0.0f, 0.0f, 0.0f));
    *out_scale = scale;
    *out_power = power;
    return vec3_is_finite(*out_position) ? AG_OK : pbrt_error(parser, list->where, 1, "the light is too far away");
}

/* Sets the intensity, times scale; where a power is given, the intensity that has it. */
static ag_status set_intensity(pbrt_parser *parser, const parameter_list *list, rgb color, double scale, double power,
                               double power_of_one, rgb *out_intensity)
{
    double factor = scale;
    if (power > 0.0) {
        if (!(power_of_one > 0.0))
            return pbrt_refuse(parser, list, "power", "the picture is black");
        factor *= power / power_of_one;
    }
    *out_intensity = rgb_make((float)(color.r * factor), (float)(color.g * factor), (float)(color.b * factor));
    pbrt_tell_dark_light(parser, list, *out_intensity);
    return rgb_is_finite(*out_intensity) ? AG_OK
                                         : pbrt_refuse(parser, list, "scale", "the light is too bright for a float");
}

static ag_status read_goniometric(pbrt_parser *parser, parameter_list *list, light *l)
{
    const char *name;
    double scale = 1.0, power = -1.0;
    rgb color = rgb_gray(1.0f);
    light_directions *intensity = &l->as.goniometric.intensity;
    AG_TRY(read_common(parser, list, &name, &scale, &power, &l->as.goniometric.position));
    AG_TRY(parameter_get_rgb(list, parser->log, "I", &color));
    AG_TRY(pbrt_set_light_frame(parser, list, true, &intensity->world_from_light));
    AG_TRY(pbrt_read_environment(parser, list, name, true, &intensity->picture));
    AG_TRY(set_intensity(parser, list, color, scale, power, intensity->picture->integral.g, &intensity->value));
    return rgb_is_finite(environment_integral(intensity))
               ? AG_OK
               : pbrt_refuse(parser, list, "scale", "the light is too bright for a float");
}

static ag_status read_projection(pbrt_parser *parser, parameter_list *list, light *l)
{
    const char *name;
    double scale = 1.0, power = -1.0;
    float fov = 90.0f;
    light_picture picture;
    projection_source *p = &l->as.projection;
    AG_TRY(read_common(parser, list, &name, &scale, &power, &p->position));
    AG_TRY(parameter_get_float(list, parser->log, "fov", &fov));
    if (!(fov > 0.0f && fov < 180.0f))
        return pbrt_refuse(parser, list, "fov", "\"fov\" should be within (0, 180) degrees");
    AG_TRY(pbrt_set_light_frame(parser, list, false, &p->world_from_light));
    AG_TRY(read_pixels(parser, list, name, false, &picture));
    AG_TRY(projection_create(picture.width, picture.height, picture.pixels, fov, &p->picture));
    AG_TRY(set_intensity(parser, list, rgb_gray(1.0f), scale, power,
                         working_space_luminance(&parser->scene->space, p->picture->integral), &p->intensity));
    return rgb_is_finite(rgb_mul(p->intensity, p->picture->integral))
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
