/* scene_overrides.c: see scene_overrides.h. Threads: one per scene. */
#include "scene_overrides.h"

#include "light/environment.h"
#include "light_picture.h"
#include "status.h"
#include "text/input_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double DEGREE = 3.14159265358979323846 / 180.0;

/* --- camera --- */

ag_status scene_overrides_meet_camera(scene *s, const char *name, const char *second_name, bool *out_is_wanted)
{
    const char *asked = s->request ? s->request->camera_name : NULL;
    const char *before = s->camera_names ? s->camera_names : "";
    const bool has_second = second_name && second_name[0] && strcmp(name, second_name) != 0;
    const size_t size = strlen(before) + strlen(name) + (has_second ? strlen(second_name) : 0) + 16;
    *out_is_wanted =
        !s->has_camera && (!asked || strcmp(asked, name) == 0 || (second_name && strcmp(asked, second_name) == 0));
    char *names = malloc(size);
    if (!names)
        return AG_ERROR_MEMORY;
    snprintf(names, size, "%s%s\"%s\"%s%s%s", before, before[0] ? ", " : "", name, has_second ? " (\"" : "",
             has_second ? second_name : "", has_second ? "\")" : "");
    free(s->camera_names);
    s->camera_names = names;
    return AG_OK;
}

static ag_status check_named_camera(run_context *run, const char *path, bool is_pbrt, const scene *s)
{
    const char *name = s->request->camera_name;
    if (!name || (s->has_camera && s->camera_names))
        return AG_OK;
    if (s->camera_names)
        log_message(run->log, AG_LOG_ERROR, "%s: error: it has no camera \"%s\", but %s", path, name, s->camera_names);
    else
        log_message(run->log, AG_LOG_ERROR, "%s: error: it has no camera \"%s\", but %s", path, name,
                    is_pbrt ? "one at most, without a name, as pbrt's format has it" : "none at all");
    return AG_ERROR_ARGUMENT;
}

/* Whether x, y and z of the world, as the camera shows them, are as on the left hand. */
static bool is_left_handed(const scene *s, bool is_pbrt)
{
    return is_pbrt && !(s->has_camera && transform_swaps_handedness(&s->camera.world_from_camera));
}

/* The camera that is asked for instead of the file's. axis: that points up. */
static ag_status set_camera(run_context *run, bool is_pbrt, vec3 axis, scene *s)
{
    const scene_request *asked = s->request;
    const bool is_left = is_left_handed(s, is_pbrt);
    const vec3 up = !vec3_is_zero(asked->camera_up) ? asked->camera_up : axis;
    const vec3 from = asked->camera_from, to = asked->camera_to;
    camera c = {.shutter_close = 1.0f};
    if (s->has_camera)
        c = s->camera;
    if (!(asked->fov_degrees > 0.0f && asked->fov_degrees < 180.0f) ||
        !camera_look(from, to, up, is_left, &c.world_from_camera)) {
        log_message(run->log, AG_LOG_ERROR,
                    "the camera asked for makes no sense: from and to should differ, up should not be along the way "
                    "between them, and the field of view should be within 0 and 180 degrees");
        return AG_ERROR_ARGUMENT;
    }
    c.kind = CAMERA_PERSPECTIVE;
    c.fov_degrees = asked->fov_degrees;
    c.focal_distance = vec3_length(vec3_sub(to, from));
    c.lens_radius = 0.0f;
    c.is_moving = c.has_screen_window = false;
    c.screen_shift[0] = c.screen_shift[1] = 0.0f;
    s->camera = c;
    s->has_camera = true;
    s->is_camera_made_up = false;
    return AG_OK;
}

/* --- directions --- */

static vec3 axis_of(int axis, bool is_minus)
{
    float v[3] = {0.0f, 0.0f, 0.0f};
    v[axis] = is_minus ? -1.0f : 1.0f;
    return vec3_make(v[0], v[1], v[2]);
}

/* The axis that points up, its number in *out_axis. */
static vec3 find_up(const scene *s, bool is_pbrt, int *out_axis)
{
    const scene_up asked = s->request->up;
    *out_axis = 1;
    if (asked != UP_BY_FORMAT) {
        *out_axis = ((int)asked - (int)UP_X) % 3;
        return axis_of(*out_axis, asked >= UP_MINUS_X);
    }
    if (!is_pbrt)
        return axis_of(1, false);
    const double(*m)[4] = s->camera.world_from_camera.m;
    const vec3 own = s->request->camera_up; /* where the file has no camera */
    double up[3] = {(double)own.x, (double)own.y, (double)own.z};
    for (int i = 0; i < 3 && s->has_camera; i++)
        up[i] = m[i][1];
    for (int i = 0; i < 3; i++)
        if (fabs(up[i]) > fabs(up[*out_axis]) * 1.0001) /* a tie stays with y */
            *out_axis = i;
    return axis_of(*out_axis, up[*out_axis] < 0.0);
}

frame scene_overrides_upright(const scene *s)
{
    const vec3 x = axis_of(0, false), y = axis_of(1, false), z = axis_of(2, false);
    switch (s->request ? s->request->up : UP_BY_FORMAT) {
    case UP_X: return (frame){vec3_negate(y), x, z};
    case UP_Z: return (frame){x, z, vec3_negate(y)};
    case UP_MINUS_X: return (frame){y, vec3_negate(x), z};
    case UP_MINUS_Y: return (frame){vec3_negate(x), vec3_negate(y), z};
    case UP_MINUS_Z: return (frame){x, vec3_negate(z), y};
    default: return (frame){x, y, z};
    }
}

/* North, east and up. */
typedef struct compass {
    vec3 north, east, up;
} compass;

static compass compass_of(const scene *s, bool is_pbrt)
{
    compass c;
    int axis;
    const bool is_left = is_left_handed(s, is_pbrt);
    c.up = find_up(s, is_pbrt, &axis);
    c.north = axis == 1 ? axis_of(2, !is_left) : axis_of(1, false);
    c.east = is_left ? vec3_cross(c.up, c.north) : vec3_cross(c.north, c.up);
    return c;
}

/* A unit direction of the horizon. */
static vec3 heading(const compass *c, double azimuth_degrees)
{
    const double angle = fmod(azimuth_degrees, 360.0) * DEGREE;
    return vec3_add(vec3_scale(c->north, (float)cos(angle)), vec3_scale(c->east, (float)sin(angle)));
}

/* --- light --- */

bool scene_overrides_light(const scene *s)
{
    return s->request && (s->request->has_sun || s->request->has_sky || s->request->drops_lights);
}

static ag_status add_sun(run_context *run, const compass *c, scene *s)
{
    const scene_request *asked = s->request;
    const double elevation = (double)asked->sun_elevation_degrees * DEGREE;
    const vec3 across = heading(c, (double)asked->sun_azimuth_degrees);
    const vec3 to_sun = vec3_add(vec3_scale(across, (float)cos(elevation)), vec3_scale(c->up, (float)sin(elevation)));
    light sun = light_make(LIGHT_DISTANT);
    light_set_disc(&sun, (double)asked->sun_angle_degrees * DEGREE);
    uint32_t index;
    sun.as.distant.irradiance = rgb_gray(asked->sun_irradiance);
    sun.as.distant.direction = vec3_negate(vec3_normalize(to_sun));
    log_message(run->log, AG_LOG_INFO, "the sun that is asked for stands towards (%.3g, %.3g, %.3g), with %g W/m^2",
                (double)to_sun.x, (double)to_sun.y, (double)to_sun.z, (double)asked->sun_irradiance);
    return scene_add_light(s, &sun, &index);
}

static ag_status read_sky(run_context *run, scene *s, environment **out_picture, char *message, size_t message_size)
{
    const char *path = s->request->sky_file;
    light_picture picture;
    if (!input_file_allow_named(run, path, message, message_size))
        return AG_ERROR_INPUT;
    const uint64_t version = input_file_version(path);
    *out_picture = light_picture_find_kept(s, path, version, false);
    if (*out_picture)
        return AG_OK;
    /* the inputs were asked above: what the user names may lie anywhere */
    struct input_files *const inputs = run->inputs;
    run->inputs = NULL;
    const ag_status status = light_picture_read(run, s, path, path, false, &picture, message, message_size);
    run->inputs = inputs;
    AG_TRY(status);
    AG_TRY(light_picture_surround(&picture, path, out_picture, message, message_size));
    light_picture_note(s, path, version, false, *out_picture);
    if (picture.is_first_of_several)
        log_message(run->log, AG_LOG_WARNING, "\"%s\": " LIGHT_PICTURE_OTHERS, path);
    if (picture.bad_count > 0)
        log_message(run->log, AG_LOG_WARNING,
                    "\"%s\": %zu pixels are negative, infinite or not a number; what is counts as 0", path,
                    picture.bad_count);
    return AG_OK;
}

/* A picture is latitude-longitude with its middle in the east, and north to the left of it: as in Blender, whose x is
 * in the middle. */
static ag_status add_sky(run_context *run, const compass *c, scene *s)
{
    const scene_request *asked = s->request;
    char message[768] = "";
    light sky = light_make(LIGHT_INFINITE);
    uint32_t index;
    ag_status status = AG_OK;
    sky.as.infinite.radiance.value = working_space_light(&s->space, asked->sky_radiance);
    if (asked->sky_file) {
        sky.as.infinite.radiance.world_from_light =
            (frame){.x = heading(c, 270.0 + (double)asked->sky_rotation_degrees),
                    .y = heading(c, (double)asked->sky_rotation_degrees),
                    .z = c->up};
        status = read_sky(run, s, &sky.as.infinite.radiance.picture, message, sizeof message);
    }
    if (status == AG_OK && !rgb_is_finite(environment_integral(&sky.as.infinite.radiance))) {
        snprintf(message, sizeof message, "the light is too bright for a float");
        status = AG_ERROR_ARGUMENT;
    }
    if (status != AG_OK) {
        if (status != AG_ERROR_MEMORY && status != AG_CANCELLED && asked->sky_file)
            log_message(run->log, AG_LOG_ERROR, "the sky that is asked for, \"%s\": %s", asked->sky_file, message);
        else if (status != AG_ERROR_MEMORY && status != AG_CANCELLED)
            log_message(run->log, AG_LOG_ERROR, "the sky that is asked for: %s", message);
        light_reset(&sky);
        return status;
    }
    scene_drop_lights(s, light_is_sky);
    return scene_add_light(s, &sky, &index);
}

ag_status scene_overrides_apply(run_context *run, const char *path, bool is_pbrt, scene *s)
{
    const scene_request *asked = s->request;
    AG_TRY(check_named_camera(run, path, is_pbrt, s));
    const compass c = compass_of(s, is_pbrt); /* by the file's own camera */
    if (asked->has_camera)
        AG_TRY(set_camera(run, is_pbrt, c.up, s));
    else if (asked->up != UP_BY_FORMAT && !asked->has_sun && !asked->has_sky && !s->is_camera_made_up)
        log_message(run->log, AG_LOG_WARNING,
                    "which axis points up is asked for, but no sun or sky is, and the file has its own camera");
    if (asked->drops_lights)
        scene_drop_lights(s, NULL);
    if (asked->has_sky)
        AG_TRY(add_sky(run, &c, s));
    return asked->has_sun ? add_sun(run, &c, s) : AG_OK;
}
