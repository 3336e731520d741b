/* pbrt_camera.c: the Camera of a pbrt-v4 scene.
 * Rests on the format's description, pbrt.org/fileformat-v4, "Cameras".
 * Flow: pbrt_parser -> [here] -> scene.camera. Threads: one per scene. */
#include "pbrt_private.h"

#include <string.h>

static ag_status read_screen_window(pbrt_parser *parser, parameter_list *list, camera *c)
{
    const double *window;
    size_t count;
    PBRT_TRY(parameter_get_numbers(list, parser->log, "screenwindow", PARAMETER_FLOAT, &window, &count));
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

static ag_status read_camera(pbrt_parser *parser, parameter_list *list, camera *c)
{
    log_sink *log = parser->log;
    float half_fov = -1.0f, shutter_open = 0.0f, shutter_close = 1.0f;
    PBRT_TRY(parameter_get_float(list, log, "fov", &c->fov_degrees));
    PBRT_TRY(parameter_get_float(list, log, "halffov", &half_fov));
    PBRT_TRY(parameter_get_float(list, log, "frameaspectratio", &c->frame_aspect_ratio));
    PBRT_TRY(parameter_get_float(list, log, "lensradius", &c->lens_radius));
    PBRT_TRY(parameter_get_float(list, log, "focaldistance", &c->focal_distance));
    /* as nothing moves, what the shutter does is not seen */
    PBRT_TRY(parameter_get_float(list, log, "shutteropen", &shutter_open));
    PBRT_TRY(parameter_get_float(list, log, "shutterclose", &shutter_close));
    PBRT_TRY(read_screen_window(parser, list, c));
    if (half_fov > 0.0f)
        c->fov_degrees = 2.0f * half_fov;
    if (!(c->fov_degrees > 0.0f && c->fov_degrees < 180.0f))
        return pbrt_refuse(parser, list, half_fov > 0.0f ? "halffov" : "fov",
                           "the field of view should be within (0, 180) degrees");
    if (parameter_list_find(list, "frameaspectratio") && !(c->frame_aspect_ratio > 0.0f))
        return pbrt_refuse(parser, list, "frameaspectratio", "\"frameaspectratio\" should be above 0");
    if (!(c->lens_radius >= 0.0f))
        return pbrt_refuse(parser, list, "lensradius", "\"lensradius\" should not be negative");
    if (!(c->focal_distance > 0.0f))
        return pbrt_refuse(parser, list, "focaldistance", "\"focaldistance\" should be above 0");
    return AG_OK;
}

ag_status pbrt_camera(pbrt_parser *parser, file_location where)
{
    parameter_list list;
    PBRT_TRY(pbrt_read_named_parameters(parser, "Camera", "a quoted type", where, &list));
    camera c = {.world_from_camera = transform_invert(&parser->state.world_from_object),
                .fov_degrees = 90.0f,
                .focal_distance = 1e6f};
    static const char *const OTHERS[] = {"orthographic", "spherical", "realistic"};
    bool is_known = strcmp(list.name, "perspective") == 0;
    ag_status status = AG_OK;
    for (size_t i = 0; i < sizeof OTHERS / sizeof *OTHERS; i++)
        if (strcmp(list.name, OTHERS[i]) == 0) {
            is_known = true;
            log_at(parser->log, AG_LOG_WARNING, where,
                   "Camera \"%s\" is not supported yet: it is rendered as \"perspective\"", list.name);
        }
    if (!is_known)
        status = pbrt_error(parser, where, strlen("Camera"), "unknown camera \"%s\"", list.name);
    if (!status)
        status = read_camera(parser, &list, &c);
    if (!status)
        status = pbrt_name_coordinate_system(parser, "camera", &c.world_from_camera);
    if (!status) {
        parameter_list_warn_unused(&list, parser->log);
        parser->scene->camera = c;
        parser->scene->has_camera = true;
    }
    parameter_list_reset(&list);
    return status;
}
