/* pbrt_camera.c: the Camera of a pbrt-v4 scene.
 * Rests on the format's description, pbrt.org/fileformat-v4, "Cameras".
 * Flow: pbrt_parser -> [here] -> scene.camera. Threads: one per scene. */
#include "pbrt/pbrt_private.h"

#include <string.h>

static ag_status read_screen_window(pbrt_parser *parser, parameter_list *list, camera *c)
{
    const double *window;
    size_t count;
    AG_TRY(parameter_get_numbers(list, parser->log, "screenwindow", PARAMETER_FLOAT, &window, &count));
    if (!window)
        return AG_OK;
    if (count != 4 || !(window[0] < window[1]) || !(window[2] < window[3]))
        return pbrt_refuse(parser, list, "screenwindow",
                           "\"screenwindow\" should be x0 x1 y0 y1, with x0 < x1 and y0 < y1");
    for (int i = 0; i < 4; i++)
        c->screen_window[i] = (float)window[i];
    c->has_screen_window = true;
    return AG_OK;
}

/* Reads the shutter; the longer it is open, the brighter is the picture. */
static ag_status read_shutter(pbrt_parser *parser, parameter_list *list, camera *c)
{
    AG_TRY(parameter_get_float(list, parser->log, "shutteropen", &c->shutter_open));
    AG_TRY(parameter_get_float(list, parser->log, "shutterclose", &c->shutter_close));
    c->exposure = c->shutter_close - c->shutter_open;
    if (!(c->exposure > 0.0f && isfinite(c->exposure)))
        return pbrt_refuse(parser, list, parameter_list_find(list, "shutterclose") ? "shutterclose" : "shutteropen",
                           "the shutter should close after it opens, at %g", (double)c->shutter_open);
    return AG_OK;
}

static ag_status read_screen(pbrt_parser *parser, parameter_list *list, camera *c)
{
    log_sink *log = parser->log;
    AG_TRY(parameter_get_float(list, log, "frameaspectratio", &c->frame_aspect_ratio));
    AG_TRY(parameter_get_float(list, log, "lensradius", &c->lens_radius));
    AG_TRY(parameter_get_float(list, log, "focaldistance", &c->focal_distance));
    AG_TRY(read_screen_window(parser, list, c));
    if (parameter_list_find(list, "frameaspectratio") && !(c->frame_aspect_ratio > 0.0f))
        return pbrt_refuse(parser, list, "frameaspectratio", "\"frameaspectratio\" should be above 0");
    if (!(c->lens_radius >= 0.0f))
        return pbrt_refuse(parser, list, "lensradius", "\"lensradius\" should not be negative");
    if (!(c->focal_distance > 0.0f))
        return pbrt_refuse(parser, list, "focaldistance", "\"focaldistance\" should be above 0");
    return AG_OK;
}

static ag_status read_perspective(pbrt_parser *parser, parameter_list *list, camera *c)
{
    float half_fov = -1.0f;
    AG_TRY(parameter_get_float(list, parser->log, "fov", &c->fov_degrees));
    AG_TRY(parameter_get_float(list, parser->log, "halffov", &half_fov));
    AG_TRY(read_screen(parser, list, c));
    if (half_fov > 0.0f)
        c->fov_degrees = 2.0f * half_fov;
    if (!(c->fov_degrees > 0.0f && c->fov_degrees < 180.0f))
        return pbrt_refuse(parser, list, half_fov > 0.0f ? "halffov" : "fov",
                           "the field of view should be within (0, 180) degrees");
    return AG_OK;
}

static ag_status read_orthographic(pbrt_parser *parser, parameter_list *list, camera *c)
{
    c->kind = CAMERA_ORTHOGRAPHIC;
    return read_screen(parser, list, c);
}

/* Reads a spherical camera. Its parameters for screen and lens are read, as pbrt does, and have no effect. */
static ag_status read_spherical(pbrt_parser *parser, parameter_list *list, camera *c)
{
    const char *mapping = "equalarea";
    AG_TRY(read_screen(parser, list, c));
    AG_TRY(parameter_get_string(list, parser->log, "mapping", &mapping));
    if (strcmp(mapping, "equalarea") != 0 && strcmp(mapping, "equirectangular") != 0)
        return pbrt_refuse(parser, list, "mapping", "unknown mapping \"%s\"; known are equalarea and equirectangular",
                           mapping);
    c->kind = strcmp(mapping, "equalarea") == 0 ? CAMERA_EQUAL_AREA : CAMERA_EQUIRECTANGULAR;
    return AG_OK;
}

static const struct {
    const char *name;
    ag_status (*read)(pbrt_parser *parser, parameter_list *list, camera *c);
} READERS[] = {
    {"perspective", read_perspective},
    {"orthographic", read_orthographic},
    {"spherical", read_spherical},
    {"realistic", pbrt_read_realistic},
};

static ag_status read_camera(pbrt_parser *parser, parameter_list *list, camera *c)
{
    AG_TRY(read_shutter(parser, list, c));
    parser->film_distance = 0.0;
    for (size_t i = 0; i < sizeof READERS / sizeof *READERS; i++)
        if (strcmp(list->name, READERS[i].name) == 0)
            return READERS[i].read(parser, list, c);
    return pbrt_error(parser, list->where, strlen("Camera"), "unknown camera \"%s\"", list->name);
}

/* Makes the scene's camera move to `end`, once its shutter is known. */
static ag_status set_motion(pbrt_parser *parser, const transform *end, file_location where)
{
    camera *c = &parser->scene->camera;
    if (!pbrt_is_moving(parser))
        return AG_OK;
    AG_TRY(pbrt_make_motion(parser, &c->world_from_camera, end, where, "Camera", &c->motion));
    c->is_moving = true;
    return AG_OK;
}

ag_status pbrt_camera(pbrt_parser *parser, file_location where)
{
    parameter_list list;
    AG_TRY(pbrt_read_named_parameters(parser, "Camera", "a quoted type", where, &list));
    camera c = {.world_from_camera = transform_invert(&parser->state.world_from_object),
                .shutter_close = 1.0f,
                .fov_degrees = 90.0f,
                .focal_distance = 1e6f};
    transform end = transform_invert(&parser->state.world_from_object_end);
    ag_status status = read_camera(parser, &list, &c);
    if (status == AG_OK)
        status = pbrt_name_coordinate_system(parser, "camera", &c.world_from_camera, &end);
    if (status == AG_OK) {
        parameter_list_warn_unused(&list, parser->log);
        parser->scene->camera = c;
        parser->scene->camera_medium = pbrt_medium_index(parser, parser->state.medium_outside);
        parser->scene->has_camera = true;
        status = set_motion(parser, &end, where);
    }
    parameter_list_reset(&list);
    return status;
}
