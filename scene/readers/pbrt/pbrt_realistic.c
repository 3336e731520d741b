/* pbrt_realistic.c: Camera "realistic" of a pbrt-v4 scene: many lenses from a file, for which one thin lens stands in.
 * Rests on: Kolb, Mitchell, Hanrahan, "A Realistic Camera Model for Computer Graphics", 1995; paraxial rays as in
 * Hecht, "Optics", 5th ed., 2017, 6.1. Lengths in the lens file are millimetres, in the scene metres. Flow: pbrt_camera
 * -> [here] -> scene.camera. Threads: one per scene. */
#include "pbrt/pbrt_private.h"

#include <stdlib.h>
#include <string.h>

enum { NUMBERS_PER_SURFACE = 4 }; /* radius of curvature (0: the stop), distance to the next, index behind, diameter */

typedef struct thin_lens {
    double focal_length, pupil_radius; /* m */
} thin_lens;

/* Traces a ray along the axis, at height 1, through all surfaces. Where it crosses the axis tells the focal
 * length, and its height at the stop how wide the stop looks from before the lens. Returns false where it
 * never crosses the axis. */
static bool reduce(const double *surfaces, size_t count, double stop_diameter, thin_lens *out_lens)
{
    double height = 1.0, slope = 0.0, index = 1.0, pupil = 0.0;
    for (size_t i = 0; i < count; i++) {
        const double *s = &surfaces[NUMBERS_PER_SURFACE * i];
        double radius = s[0], thickness = s[1], next_index = s[2] != 0.0 ? s[2] : 1.0, diameter = s[3];
        if (radius == 0.0) {
            pupil = double_min(stop_diameter, diameter) / 2.0 / fabs(height);
        } else {
            slope = (index * slope - height * (next_index - index) / radius) / next_index;
            index = next_index;
        }
        if (i + 1 < count)
            height += slope * thickness;
    }
    if (pupil == 0.0) /* no stop: the first lens is one */
        pupil = surfaces[3] / 2.0;
    out_lens->focal_length = -1e-3 / slope;
    out_lens->pupil_radius = 1e-3 * pupil;
    return out_lens->focal_length > 0.0 && isfinite(out_lens->focal_length) && out_lens->pupil_radius > 0.0 &&
           isfinite(out_lens->pupil_radius);
}

static ag_status read_lens(pbrt_parser *parser, const parameter_list *list, const char *name, double stop_diameter,
                           thin_lens *out_lens)
{
    double *numbers;
    size_t count;
    const parameter *p = parameter_list_find(list, "lensfile");
    AG_TRY(pbrt_read_number_file(parser, name, p->where, strlen("\"string lensfile\""), "", &numbers, &count));
    bool is_table = count > 0 && count % NUMBERS_PER_SURFACE == 0;
    bool is_lens = is_table && reduce(numbers, count / NUMBERS_PER_SURFACE, stop_diameter, out_lens);
    free(numbers);
    if (!is_table)
        return pbrt_refuse(parser, list, "lensfile", "\"%s\" has %zu numbers: it should have four for each surface",
                           name, count);
    if (!is_lens)
        return pbrt_refuse(parser, list, "lensfile", "\"%s\" does not focus light", name);
    return AG_OK;
}

ag_status pbrt_read_realistic(pbrt_parser *parser, parameter_list *list, camera *c)
{
    log_sink *log = parser->log;
    const char *file_name = NULL, *aperture = NULL;
    float diameter = 1.0f, focus = 10.0f;
    thin_lens lens = {0.0, 0.0};
    AG_TRY(parameter_get_string(list, log, "lensfile", &file_name));
    AG_TRY(parameter_get_string(list, log, "aperture", &aperture));
    AG_TRY(parameter_get_float(list, log, "aperturediameter", &diameter));
    AG_TRY(parameter_get_float(list, log, "focusdistance", &focus));
    if (!file_name)
        return pbrt_error(parser, list->where, strlen("Camera"), "Camera \"realistic\" has no \"string lensfile\"");
    if (!(diameter > 0.0f))
        return pbrt_refuse(parser, list, "aperturediameter", "\"aperturediameter\" should be above 0");
    AG_TRY(read_lens(parser, list, file_name, diameter, &lens));
    /* film and focus lie "focusdistance" apart, with the lens between them where 1/f = 1/before + 1/behind */
    double room = (double)focus * focus - 4.0 * focus * lens.focal_length;
    if (!(focus > 0.0f && room >= 0.0))
        return pbrt_refuse(parser, list, "focusdistance", "\"focusdistance\" should be at least 4 focal lengths, %g m",
                           4.0 * lens.focal_length);
    double behind = 2.0 * focus * lens.focal_length / (focus + sqrt(room));
    log_at_once(
        log, AG_LOG_WARNING, list->where, "realistic",
        "Camera \"realistic\" is not supported: a thin lens stands in, with its focal length of %.4g mm, its aperture "
        "and its brightness in the middle of the film, but without distortion, vignetting or a shape of the "
        "aperture",
        1e3 * lens.focal_length);
    c->lens_radius = (float)lens.pupil_radius;
    c->focal_distance = (float)(focus - behind);
    c->exposure *= (float)(3.14159265358979323846 * lens.pupil_radius * lens.pupil_radius / (behind * behind));
    parser->film_distance = behind;
    return AG_OK;
}

ag_status pbrt_settle_realistic(pbrt_parser *parser)
{
    parameter_list *film = &parser->film;
    float diagonal = 35.0f; /* mm */
    int64_t size[2] = {1280, 720};
    if (!(parser->film_distance > 0.0))
        return AG_OK;
    AG_TRY(parameter_get_float(film, parser->log, "diagonal", &diagonal));
    AG_TRY(parameter_get_int(film, parser->log, "xresolution", &size[0]));
    AG_TRY(parameter_get_int(film, parser->log, "yresolution", &size[1]));
    if (!(diagonal > 0.0f))
        return pbrt_refuse(parser, film, "diagonal", "\"diagonal\" should be above 0");
    double x = (double)size[0], y = (double)size[1], across = 1e-3 * diagonal * double_min(x, y) / sqrt(x * x + y * y);
    parser->scene->camera.fov_degrees =
        (float)(2.0 * atan(across / 2.0 / parser->film_distance) * (180.0 / 3.14159265358979323846));
    return AG_OK;
}
