/* gltf_lights.c: the lamps of KHR_lights_punctual.
 * Rests on: Khronos, KHR_lights_punctual (point and spot in candela, directional in lux, along -z of their node); the
 * glTF exporter of Blender (io_scene_gltf2), for what units really are in files.
 * Flow: gltf_nodes -> [here] -> scene.lights. Threads: one per scene.
 *
 * Units. Only their ratios matter to a picture, and the format's own are photometric throughout: candela and lux of
 * lamps, nits of emissive materials. Reading each as its radiometric counterpart (W/sr, W/m^2, W/m^2/sr) keeps the
 * ratios for every exporter that keeps to the format. Blender's writes emission as it is, 1 for a radiance of 1, and
 * lamps in one of three ways (its "Lighting Mode"), W being what its lamps are measured in:
 *
 *   lighting mode   point, spot         sun        here, times   1/sr of points   of suns
 *   standard        W 683 / (4 pi)      683 W/m^2                1 / 683          1 / 683
 *   unitless        W / (4 pi)          W/m^2                    1                1
 *   raw             W                   W/m^2                    1 / (4 pi)       1
 *
 * The choice came in October 2022 with version 3.4 (pull request 1760), standard by default; there was raw alone
 * before. No file says which one it was, not even its extras. So the rule is: Blender from 3.4 on is standard, before
 * that raw, all others are unitless; --gltf-light-units overrules it, and what was taken is said where there are
 * lamps. */
#include "gltf/gltf_private.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double LUMENS_PER_WATT = 683.0;
static const double SPHERE = 4.0 * 3.14159265358979323846; /* sr */

/* The version of Blender's exporter, which is that of Blender, times a thousand; 0: of none. */
static int exporter_version(const char *generator)
{
    int major = 0, minor = 0;
    const char *blender = generator ? strstr(generator, "glTF Blender I/O v") : NULL;
    if (!blender || sscanf(blender + strlen("glTF Blender I/O v"), "%4d.%3d", &major, &minor) != 2)
        return 0;
    return 1000 * major + minor;
}

static gltf_light_units units_by_generator(const char *generator)
{
    int version = exporter_version(generator);
    return version == 0 ? GLTF_LIGHTS_UNITLESS : version >= 3004 ? GLTF_LIGHTS_STANDARD : GLTF_LIGHTS_RAW;
}

gltf_lamp_units gltf_lamp_units_of(gltf_light_units asked, const char *generator)
{
    gltf_lamp_units units = {1.0, 1.0, asked == GLTF_LIGHTS_BY_GENERATOR ? units_by_generator(generator) : asked};
    if (units.kind == GLTF_LIGHTS_STANDARD)
        units.per_candela = units.per_lux = 1.0 / LUMENS_PER_WATT;
    if (units.kind == GLTF_LIGHTS_RAW)
        units.per_candela = 1.0 / SPHERE;
    return units;
}

/* Says in the log, once, where the first lamp is, which units were taken. */
static void tell_units(gltf_reader *r)
{
    static const char *const UNITS[] = {
        [GLTF_LIGHTS_BY_GENERATOR] = "",
        [GLTF_LIGHTS_STANDARD] = "standard (cd and lx at 683 lm/W)",
        [GLTF_LIGHTS_UNITLESS] = "unitless (W/sr and W/m^2, or cd and lx where emission is in nit)",
        [GLTF_LIGHTS_RAW] = "raw (W, and W/m^2 of suns)",
    };
    bool is_asked = r->scene->request && r->scene->request->gltf_light_units != GLTF_LIGHTS_BY_GENERATOR;
    if (r->told_units)
        return;
    r->told_units = true;
    log_at(r->run->log, AG_LOG_INFO, r->where, "lamps are read as %s, %s%s%s", UNITS[r->lamp_units.kind],
           is_asked          ? "as --gltf-light-units says"
           : r->generator[0] ? "as files by "
                             : "as files that name no generator are; --gltf-light-units says otherwise",
           is_asked ? "" : r->generator, is_asked || !r->generator[0] ? "" : " are; --gltf-light-units says otherwise");
}

/* Cones: full inside the inner one, a smoothstep in the cosine out to the outer one. Blender's lamps end so too, but
 * its exporter writes an inner angle that is the outer one less its share "blend", where Blender takes that share of
 * what the cosine has to go: so that is undone. Its spots were dimmer beside their axis before 3.5 (spot_light.c). */
static ag_status read_spot(gltf_reader *r, const gltf_value *at, light *l)
{
    double inner = 0.0, outer = 0.78539816339744831;
    gltf_value spot;
    AG_TRY(gltf_get_object(r, at, "spot", &spot));
    AG_TRY(gltf_get_double(r, &spot, "innerConeAngle", &inner));
    AG_TRY(gltf_get_double(r, &spot, "outerConeAngle", &outer));
    if (!(inner >= 0.0 && inner <= outer && outer > 0.0 && outer <= 1.5708))
        return gltf_error(r, &spot, "its angles are %g and %g, which should be 0 <= inner < outer <= pi / 2", inner,
                          outer);
    int version = exporter_version(r->generator);
    l->as.spot.dims_by_cosine = version > 0 && version < 3005;
    if (r->is_blenders && outer > 0.0)
        inner = acos(double_min(cos(outer) + (1.0 - cos(outer)) * (1.0 - inner / outer), 1.0));
    light_set_cone(l, inner, outer);
    return AG_OK;
}

ag_status gltf_add_lamp(gltf_reader *r, uint32_t index, const gltf_matrix *world_from_node)
{
    const char *type = "", *name = "";
    rgb color = rgb_gray(1.0f);
    double intensity = 1.0, z[3];
    uint32_t light_index;
    gltf_value at;
    tell_units(r);
    AG_TRY(gltf_get_item(r, GLTF_LIGHTS, index, &at));
    AG_TRY(gltf_require(r, &at, "type"));
    AG_TRY(gltf_get_text(r, &at, "type", &type));
    AG_TRY(gltf_get_color(r, &at, "color", 0.0, 1e6, &color));
    color = working_space_light(&r->scene->space, color);
    AG_TRY(gltf_get_double(r, &at, "intensity", &intensity));
    bool is_sun = strcmp(type, "directional") == 0, is_spot = strcmp(type, "spot") == 0;
    if (!is_sun && !is_spot && strcmp(type, "point") != 0)
        return gltf_error(r, &at, "there is no light of type \"%s\"", type);
    if (!(intensity >= 0.0 && intensity <= 1e24))
        return gltf_error(r, &at, "its intensity is %g, which should be from 0 to 1e24", intensity);
    if (!gltf_matrix_axis(world_from_node, 2, z)) {
        if (is_sun || is_spot)
            return gltf_error(r, &at, "its node leaves no direction");
        z[0] = z[1] = 0.0, z[2] = 1.0;
    }
    const gltf_value range = gltf_member(&at, "range");
    AG_TRY(gltf_get_text(r, &at, "name", &name));
    if (range.json && !is_sun)
        gltf_warn_once(r, &range, "range",
                       "the range of lamp \"%s\" is not heeded, nor that of any other: its light "
                       "goes on beyond it, as light does",
                       name);
    light l = light_make(is_sun ? LIGHT_DISTANT : is_spot ? LIGHT_SPOT : LIGHT_POINT);
    rgb strength = rgb_scale(color, (float)(intensity * (is_sun ? r->lamp_units.per_lux : r->lamp_units.per_candela)));
    const vec3 direction = vec3_make((float)-z[0], (float)-z[1], (float)-z[2]);
    const vec3 position =
        vec3_make((float)world_from_node->m[0][3], (float)world_from_node->m[1][3], (float)world_from_node->m[2][3]);
    if (is_sun) {
        l.as.distant.direction = direction;
        l.as.distant.irradiance = strength;
    } else if (is_spot) {
        l.as.spot.position = position;
        l.as.spot.direction = direction;
        l.as.spot.intensity = strength;
        AG_TRY(read_spot(r, &at, &l));
    } else {
        l.as.point = (point_source){position, strength};
    }
    if (!((double)vec3_max_abs(position) <= GLTF_MAX_COORDINATE))
        return gltf_error(r, &at, "it is beyond 1e18 units");
    return rgb_is_black(strength) ? AG_OK : scene_add_light(r->scene, &l, &light_index);
}
