/* pbrt_environments.c: LightSource "infinite" of a pbrt-v4 scene.
 * Rests on the format's description, pbrt.org/fileformat-v4, "Lights". Square pictures are equal-area octahedral, as
 * pbrt-v4 wants them; those twice as wide as high, which it refuses, are latitude-longitude, as pbrt-v3 had them.
 * Flow: pbrt_lights -> [here] -> environment, portal, scene. Threads: one per scene. */
#include "light/environment.h"
#include "light/portal.h"
#include "pbrt/pbrt_private.h"

static const double PI = 3.14159265358979323846;

/* Returns what "illuminance" measures for a picture: half of what reaches a surface that faces the light's z. pbrt
 * counts each pixel as 2 pi / count, and scenes are lit by what comes of that. */
static double picture_illuminance(const working_space *space, const environment *e)
{
    double sum = 0.0;
    for (uint32_t y = 0; y < e->height; y++) {
        double row = 0.0;
        for (uint32_t x = 0; x < e->width; x++) {
            vec3 d = environment_direction(e, x, y, (vec2){0.5f, 0.5f});
            if (d.z > 0.0f)
                row += (double)d.z * working_space_luminance(space, e->pixels[(size_t)y * e->width + x]);
        }
        sum += row * 0.5 * environment_pixel_solid_angle(e, y);
    }
    return sum;
}

/* Reads "portal", four corners, in world space whatever the transform. *out_is_given: whether it is there. */
static ag_status read_portal(pbrt_parser *parser, parameter_list *list, bool *out_is_given, portal *out_portal)
{
    const double *numbers;
    size_t count;
    vec3 corners[4];
    AG_TRY(parameter_get_numbers(list, parser->log, "portal", PARAMETER_POINT3, &numbers, &count));
    *out_is_given = count > 0;
    if (count == 0)
        return AG_OK;
    if (count != 12)
        return pbrt_refuse(parser, list, "portal", "\"portal\" has four corners, not %zu", count / 3);
    for (int i = 0; i < 4; i++)
        corners[i] = vec3_make((float)numbers[3 * i], (float)numbers[3 * i + 1], (float)numbers[3 * i + 2]);
    if (!portal_init(corners, out_portal))
        return pbrt_refuse(parser, list, "portal", "\"portal\" is not a rectangle, corner by corner");
    return AG_OK;
}

/* Returns the radiance that makes "illuminance" 1. With a portal a constant light is, to pbrt, a picture of
 * one pixel. */
static double find_measure(const working_space *space, const light_directions *sky, bool has_portal)
{
    if (sky->picture)
        return picture_illuminance(space, sky->picture);
    return has_portal ? 2.0 * PI * (double)working_space_luminance(space, sky->value) : PI;
}

static ag_status read_infinite(pbrt_parser *parser, parameter_list *list, light *l)
{
    log_sink *log = parser->log;
    const char *name = "";
    float scale = 1.0f, illuminance = -1.0f;
    bool has_portal;
    portal placed;
    light_directions *sky = &l->as.infinite.radiance;
    sky->value = rgb_gray(1.0f);
    AG_TRY(parameter_get_string(list, log, "filename", &name));
    if (name[0] && parameter_list_find(list, "L"))
        return pbrt_refuse(parser, list, "L", "an infinite light has \"L\" or \"filename\", not both");
    AG_TRY(parameter_get_rgb(list, log, "L", &sky->value));
    AG_TRY(parameter_get_float(list, log, "scale", &scale));
    AG_TRY(parameter_get_float(list, log, "illuminance", &illuminance));
    AG_TRY(read_portal(parser, list, &has_portal, &placed));
    if (scale < 0.0f)
        return pbrt_refuse(parser, list, "scale", "\"scale\" should not be negative");

    double factor = scale;
    if (name[0]) {
        AG_TRY(pbrt_set_light_frame(parser, list, false, &sky->world_from_light));
        AG_TRY(pbrt_read_environment(parser, list, name, false, &sky->picture));
    }
    if (illuminance > 0.0f) {
        double measure = find_measure(&parser->scene->space, sky, has_portal);
        if (!(measure > 0.0))
            return pbrt_refuse(parser, list, "illuminance", "no light comes from the upper half of the picture");
        factor *= illuminance / measure;
    }
    rgb c = sky->value;
    sky->value = rgb_make((float)(c.r * factor), (float)(c.g * factor), (float)(c.b * factor));
    pbrt_tell_dark_light(parser, list, sky->value);
    if (!rgb_is_finite(environment_integral(sky)))
        return pbrt_refuse(parser, list, "scale", "the light is too bright for a float");
    return has_portal ? portal_create(&placed, sky, &l->as.infinite.portal) : AG_OK;
}

ag_status pbrt_infinite_light(pbrt_parser *parser, parameter_list *list, light *out_light)
{
    ag_status status = read_infinite(parser, list, out_light);
    if (status != AG_OK)
        light_reset(out_light);
    return status;
}
