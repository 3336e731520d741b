/* pbrt_lights.c: LightSource and AreaLightSource of a pbrt-v4 scene.
 * Rests on the format's description, pbrt.org/fileformat-v4, "Lights". Light is linear RGB: an rgb I or L is taken as
 * it is; "power" and "illuminance" say how much of it there is, as in pbrt, whatever its magnitude would be.
 * Flow: pbrt_parser -> [here] -> scene. Threads: one per scene. */
#include "pbrt/pbrt_private.h"

#include <string.h>

/* The parameters that all lights have. */
typedef struct light_common {
    rgb color; /* "I" or "L" */
    float scale;
    float power; /* "power" or "illuminance"; not above 0: not given */
    vec3 from, to;
} light_common;

static const double PI = 3.14159265358979323846;

static ag_status read_common(pbrt_parser *parser, parameter_list *list, const char *color_name, const char *power_name,
                             light_common *out_common)
{
    light_common c = {{1.0f, 1.0f, 1.0f}, 1.0f, -1.0f, {0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f}};
    AG_TRY(parameter_get_rgb(list, parser->log, color_name, &c.color));
    AG_TRY(parameter_get_float(list, parser->log, "scale", &c.scale));
    AG_TRY(parameter_get_float(list, parser->log, power_name, &c.power));
    if (c.scale < 0.0f)
        return pbrt_refuse(parser, list, "scale", "\"scale\" should not be negative");
    *out_common = c;
    return AG_OK;
}

static void tell_dark(pbrt_parser *parser, file_location where, const char *directive, const char *name, rgb emitted)
{
    if (rgb_is_black(emitted))
        log_at(parser->log, AG_LOG_DEBUG, where, "%s \"%s\" has no power", directive, name);
}

void pbrt_tell_dark_light(pbrt_parser *parser, const parameter_list *list, rgb emitted)
{
    tell_dark(parser, list->where, "LightSource", list->name, emitted);
}

/* Scales a colour. factor is a quotient of powers, and may overflow where the scene makes no sense. */
static ag_status scale_color(pbrt_parser *parser, const parameter_list *list, rgb color, double factor, rgb *out_color)
{
    *out_color = rgb_make((float)(color.r * factor), (float)(color.g * factor), (float)(color.b * factor));
    return rgb_is_finite(*out_color) ? AG_OK
                                     : pbrt_refuse(parser, list, "scale", "the light is too bright for a float");
}

static ag_status read_direction(pbrt_parser *parser, parameter_list *list, light_common *c, vec3 *out_direction)
{
    AG_TRY(parameter_get_vec3(list, parser->log, "from", PARAMETER_POINT3, &c->from));
    AG_TRY(parameter_get_vec3(list, parser->log, "to", PARAMETER_POINT3, &c->to));
    const transform *t = &parser->state.world_from_object;
    double d[3] = {(double)c->to.x - c->from.x, (double)c->to.y - c->from.y, (double)c->to.z - c->from.z};
    double w[3], square = 0.0;
    for (int i = 0; i < 3; i++) {
        w[i] = t->m[i][0] * d[0] + t->m[i][1] * d[1] + t->m[i][2] * d[2];
        square += w[i] * w[i];
    }
    if (!(square > 0.0 && isfinite(square)))
        return pbrt_refuse(parser, list, "to", "\"from\" and \"to\" give no direction");
    double inverse = 1.0 / sqrt(square);
    *out_direction = vec3_make((float)(w[0] * inverse), (float)(w[1] * inverse), (float)(w[2] * inverse));
    return AG_OK;
}

static ag_status set_position(pbrt_parser *parser, const parameter_list *list, vec3 from, vec3 *out_position)
{
    *out_position = transform_point(&parser->state.world_from_object, from);
    return vec3_is_finite(*out_position) ? AG_OK : pbrt_refuse(parser, list, "from", "the light is too far away");
}

/* Works as scale_color for a LightSource, and says where the light is black. */
static ag_status set_color(pbrt_parser *parser, const parameter_list *list, rgb color, double factor, rgb *out_color)
{
    AG_TRY(scale_color(parser, list, color, factor, out_color));
    pbrt_tell_dark_light(parser, list, *out_color);
    return AG_OK;
}

static ag_status read_point(pbrt_parser *parser, parameter_list *list, light *l)
{
    light_common c;
    AG_TRY(read_common(parser, list, "I", "power", &c));
    AG_TRY(parameter_get_vec3(list, parser->log, "from", PARAMETER_POINT3, &c.from));
    AG_TRY(set_position(parser, list, c.from, &l->as.point.position));
    double factor = c.power > 0.0f ? c.scale * (c.power / (4.0 * PI)) : c.scale;
    return set_color(parser, list, c.color, factor, &l->as.point.intensity);
}

static ag_status read_spot(pbrt_parser *parser, parameter_list *list, light *l)
{
    light_common c;
    spot_source *spot = &l->as.spot;
    float cone = 30.0f, delta = 5.0f;
    AG_TRY(read_common(parser, list, "I", "power", &c));
    AG_TRY(read_direction(parser, list, &c, &spot->direction));
    AG_TRY(set_position(parser, list, c.from, &spot->position));
    AG_TRY(parameter_get_float(list, parser->log, "coneangle", &cone));
    AG_TRY(parameter_get_float(list, parser->log, "conedeltaangle", &delta));
    AG_TRY(parameter_get_bool(list, parser->log, "cosine", &spot->dims_by_cosine)); /* which pbrt does not have */
    if (!(cone > 0.0f && cone <= 180.0f))
        return pbrt_refuse(parser, list, "coneangle", "\"coneangle\" should be within (0, 180] degrees");
    if (!(delta >= 0.0f && delta <= 2.0f * cone)) /* beyond the axis pbrt counts on at the other side */
        return pbrt_refuse(parser, list, "conedeltaangle",
                           "\"conedeltaangle\" should be from 0 to twice \"coneangle\"");
    if (spot->dims_by_cosine && (cone > 90.0f || c.power > 0.0f))
        return pbrt_refuse(parser, list, "cosine",
                           "a \"cosine\" goes with a \"coneangle\" of at most 90 degrees, and not with \"power\"");
    light_set_cone(l, ((double)cone - delta) * (PI / 180.0), cone * (PI / 180.0));
    double cone_measure =
        PI * ((double)spot->falloff_start + spot->falloff_end); /* the ramp is half of its height, on average */
    double factor = c.power > 0.0f ? c.scale * (c.power / cone_measure) : c.scale;
    return set_color(parser, list, c.color, factor, &spot->intensity);
}

static ag_status read_distant(pbrt_parser *parser, parameter_list *list, light *l)
{
    light_common c;
    float angle = 0.0f; /* which pbrt does not have: degrees across the disc that shines */
    AG_TRY(read_common(parser, list, "L", "illuminance", &c));
    AG_TRY(read_direction(parser, list, &c, &l->as.distant.direction));
    AG_TRY(parameter_get_float(list, parser->log, "angle", &angle));
    if (!(angle >= 0.0f && angle <= 180.0f))
        return pbrt_refuse(parser, list, "angle", "\"angle\" should be from 0 to 180 degrees");
    light_set_disc(l, (double)angle * (PI / 180.0));
    double factor = c.power > 0.0f ? (double)c.scale * c.power : c.scale;
    return set_color(parser, list, c.color, factor, &l->as.distant.irradiance);
}

/* "photons", which pbrt does not have: multiplies the light's share of them. */
static ag_status read_photons(pbrt_parser *parser, parameter_list *list, float *out_photons)
{
    AG_TRY(parameter_get_float(list, parser->log, "photons", out_photons));
    if (!(*out_photons >= 0.0f))
        return pbrt_refuse(parser, list, "photons", "\"photons\" should not be negative");
    if (*out_photons == 0.0f)
        log_at(parser->log, AG_LOG_INFO, list->where,
               "the light sends no photons: its indirect light and caustics are missing from the photon map");
    return AG_OK;
}

/* "lightgroup", which pbrt does not have: a name under which layers keep the light apart. */
static ag_status read_group(pbrt_parser *parser, parameter_list *list, uint32_t *out_group)
{
    const char *name = "default";
    uint32_t unnamed;
    AG_TRY(parameter_get_string(list, parser->log, "lightgroup", &name));
    if (name[0] == '\0' || name[strspn(name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-")] ||
        strlen(name) > 40 || strcmp(name, "photons") == 0)
        return pbrt_refuse(
            parser, list, "lightgroup",
            "\"lightgroup\" should be a name of at most 40 letters, digits, - and _, and not \"photons\"");
    AG_TRY(scene_light_group(parser->scene, "default", &unnamed)); /* the first */
    ag_status status = scene_light_group(parser->scene, name, out_group);
    if (status == AG_ERROR_SCENE)
        return pbrt_refuse(parser, list, "lightgroup", "there are more than %d light groups", SCENE_LIGHT_GROUPS_MAX);
    return status;
}

static ag_status read_light(pbrt_parser *parser, parameter_list *list, light *l)
{
    typedef ag_status reader(pbrt_parser *, parameter_list *, light *);
    static const struct {
        const char *name;
        light_kind kind;
        reader *read;
    } READERS[] = {{"point", LIGHT_POINT, read_point},
                   {"spot", LIGHT_SPOT, read_spot},
                   {"distant", LIGHT_DISTANT, read_distant},
                   {"infinite", LIGHT_INFINITE, pbrt_infinite_light},
                   {"goniometric", LIGHT_GONIOMETRIC, pbrt_goniometric_light},
                   {"projection", LIGHT_PROJECTION, pbrt_projection_light}};
    for (size_t i = 0; i < sizeof READERS / sizeof *READERS; i++)
        if (strcmp(list->name, READERS[i].name) == 0) {
            *l = light_make(READERS[i].kind);
            AG_TRY(read_photons(parser, list, &l->photons));
            AG_TRY(read_group(parser, list, &l->group));
            return READERS[i].read(parser, list, l);
        }
    return pbrt_error(parser, list->where, strlen("LightSource"), "unknown light \"%s\"", list->name);
}

static ag_status add_light(pbrt_parser *parser, parameter_list *list)
{
    uint32_t index;
    light l;
    AG_TRY(read_light(parser, list, &l));
    parameter_list_warn_unused(list, parser->log);
    l.medium = pbrt_use_medium(parser, parser->state.medium_outside);
    return scene_add_light(parser->scene, &l, &index);
}

ag_status pbrt_light_source(pbrt_parser *parser, file_location where)
{
    parameter_list list;
    AG_TRY(pbrt_read_named_parameters(parser, "LightSource", "a quoted type", where, &list));
    pbrt_warn_still(parser, where, "a light");
    ag_status status = pbrt_is_flattened(parser, where, "LightSource") ? AG_OK : add_light(parser, &list);
    parameter_list_reset(&list);
    return status;
}

static double mean_luminance(const working_space *space, const texture_image *i)
{
    double sum = 0.0;
    for (uint32_t y = 0; y < i->height; y++)
        for (uint32_t x = 0; x < i->width; x++)
            sum += (double)working_space_luminance(
                space, texture_image_color(i, texture_wraps_same(TEXTURE_WRAP_CLAMP), TEXTURE_FILTER_POINT,
                                           ((float)x + 0.5f) / (float)i->width, ((float)y + 0.5f) / (float)i->height));
    return sum / ((double)i->width * i->height);
}

/* "filename": radiance by the surface's own u and v. */
static ag_status read_area_picture(pbrt_parser *parser, parameter_list *list, pbrt_area_light *l)
{
    const char *name = "";
    AG_TRY(parameter_get_string(list, parser->log, "filename", &name));
    if (!name[0])
        return AG_OK;
    if (parameter_list_find(list, "L"))
        return pbrt_refuse(parser, list, "L", "an area light has \"L\" or \"filename\", not both");
    texture t = texture_make(TEXTURE_IMAGE);
    t.is_spectrum = true;
    t.wraps = texture_wraps_same(TEXTURE_WRAP_CLAMP);
    AG_TRY(pbrt_load_image(parser, list, "filename", name, (image_encoding){0}, &t));
    if (parser->scene->textures.images[t.image_index]->udim)
        return pbrt_refuse(parser, list, "filename", "the picture of an area light cannot be in tiles");
    AG_TRY(texture_set_add(&parser->scene->textures, &t, &l->radiance_texture));
    if (l->power > 0.0f)
        l->mean_luminance = mean_luminance(&parser->scene->space, parser->scene->textures.images[t.image_index]);
    if (!(l->mean_luminance > 0.0))
        return pbrt_refuse(parser, list, "power", "the picture is black");
    return AG_OK;
}

static ag_status read_area_light(pbrt_parser *parser, parameter_list *list, pbrt_area_light *out_light)
{
    light_common c = {0};
    pbrt_area_light l = {.is_set = true,
                         .photons = 1.0f,
                         .radiance_texture = SCENE_NO_TEXTURE,
                         .mean_luminance = 1.0,
                         .where = list->where};
    if (strcmp(list->name, "diffuse") != 0)
        return pbrt_error(parser, list->where, strlen("AreaLightSource"), "unknown area light \"%s\"", list->name);
    AG_TRY(read_common(parser, list, "L", "power", &c));
    AG_TRY(parameter_get_bool(list, parser->log, "twosided", &l.two_sided));
    AG_TRY(scale_color(parser, list, c.color, c.scale, &l.radiance));
    l.power = c.power;
    AG_TRY(read_photons(parser, list, &l.photons));
    AG_TRY(read_group(parser, list, &l.group));
    AG_TRY(read_area_picture(parser, list, &l));
    parameter_list_warn_unused(list, parser->log);
    *out_light = l;
    return AG_OK;
}

ag_status pbrt_area_light_source(pbrt_parser *parser, file_location where)
{
    parameter_list list;
    AG_TRY(pbrt_read_named_parameters(parser, "AreaLightSource", "a quoted type", where, &list));
    ag_status status = read_area_light(parser, &list, &parser->state.area_light);
    parameter_list_reset(&list);
    return status;
}

ag_status pbrt_add_area_light(pbrt_parser *parser, const pbrt_area_light *source, uint32_t shape_index,
                              file_location where)
{
    float area = shape_area(&parser->scene->shapes[shape_index]);
    if (!(area > 0.0f && isfinite(area))) {
        log_at(parser->log, AG_LOG_WARNING, where, "the area light has a shape of area %g and is left out",
               (double)area);
        return AG_OK;
    }
    light l = light_make(LIGHT_AREA);
    l.as.area.shape_index = shape_index;
    l.as.area.two_sided = source->two_sided;
    l.as.area.radiance = source->radiance;
    l.as.area.radiance_texture = source->radiance_texture;
    l.photons = source->photons;
    l.group = source->group;
    if (source->power > 0.0f) {
        /* of a lamp with radiance 1 */
        double power = PI * (double)area * (source->two_sided ? 2.0 : 1.0) * source->mean_luminance;
        double factor = source->power / power;
        l.as.area.radiance = rgb_make((float)(l.as.area.radiance.r * factor), (float)(l.as.area.radiance.g * factor),
                                      (float)(l.as.area.radiance.b * factor));
        if (!rgb_is_finite(l.as.area.radiance)) {
            log_at(parser->log, AG_LOG_ERROR, where,
                   "AreaLightSource \"diffuse\": the light is too bright for a float");
            return AG_ERROR_SCENE;
        }
    }
    tell_dark(parser, where, "AreaLightSource", "diffuse", l.as.area.radiance);
    uint32_t index;
    return scene_add_light(parser->scene, &l, &index);
}
