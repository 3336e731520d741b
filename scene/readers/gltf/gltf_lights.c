/* gltf_lights.c: the lamps of KHR_lights_punctual.
 * Rests on: Khronos, KHR_lights_punctual (point and spot in candela, directional in lux, along -z of their node); the
 * glTF exporter of Blender (io_scene_gltf2), for what units really are in files.
 * Flow: gltf_nodes -> [here] -> scene.lights. Threads: one per scene.
 *
 * Units. Only their ratios matter to a picture, and the format's own are photometric throughout: candela and lux of
 * lamps, nits of emissive materials. Reading each as its radiometric counterpart (W/sr, W/m^2, W/m^2/sr) keeps the
 * ratios for every exporter that keeps to the format. Blender's does not, by default: from version 3.6 on it multiplies
 * the watts of lamps by 683 lm/W ("Lighting Mode: Standard"), but writes emission as it is, 1 for a radiance of 1.
 * There lamps are divided by 683, and all is as it was in Blender, where a point lamp's W are 4 pi times its W/sr, and
 * a sun's strength is in W/m^2. Earlier versions wrote those W themselves. (Files of Blender's other lighting modes
 * cannot be told apart.) */
#include "gltf/gltf_private.h"

#include <stdio.h>
#include <string.h>

static const double LUMENS_PER_WATT = 683.0;

gltf_lamp_units gltf_lamp_units_of(const char *generator)
{
    gltf_lamp_units units = {1.0, 1.0};
    int major = 0, minor = 0;
    const char *blender = generator ? strstr(generator, "glTF Blender I/O v") : NULL;
    if (!blender || sscanf(blender + strlen("glTF Blender I/O v"), "%4d.%4d", &major, &minor) != 2)
        return units;
    if (major > 3 || (major == 3 && minor >= 6))
        units = (gltf_lamp_units){1.0 / LUMENS_PER_WATT, 1.0 / LUMENS_PER_WATT};
    else
        units.per_candela = 1.0 / (4.0 * 3.14159265358979323846);
    return units;
}

static ag_status read_spot(gltf_reader *r, const gltf_value *at, light *l)
{
    double inner = 0.0, outer = 0.78539816339744831;
    gltf_value spot;
    GLTF_TRY(gltf_get_object(r, at, "spot", &spot));
    GLTF_TRY(gltf_get_double(r, &spot, "innerConeAngle", &inner));
    GLTF_TRY(gltf_get_double(r, &spot, "outerConeAngle", &outer));
    if (!(inner >= 0.0 && inner <= outer && outer > 0.0 && outer <= 1.5708))
        return gltf_error(r, &spot, "its angles are %g and %g, which should be 0 <= inner < outer <= pi / 2", inner,
                          outer);
    light_set_cone(l, inner, outer);
    return AG_OK;
}

ag_status gltf_add_lamp(gltf_reader *r, uint32_t index, const gltf_matrix *world_from_node)
{
    const char *type = "";
    rgb color = rgb_gray(1.0f);
    double intensity = 1.0, z[3];
    uint32_t light_index;
    gltf_value at;
    GLTF_TRY(gltf_get_item(r, GLTF_LIGHTS, index, &at));
    GLTF_TRY(gltf_require(r, &at, "type"));
    GLTF_TRY(gltf_get_text(r, &at, "type", &type));
    GLTF_TRY(gltf_get_color(r, &at, "color", 0.0, 1e6, &color));
    color = working_space_light(&r->scene->space, color);
    GLTF_TRY(gltf_get_double(r, &at, "intensity", &intensity));
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
    light l = light_make(is_sun ? LIGHT_DISTANT : is_spot ? LIGHT_SPOT : LIGHT_POINT);
    rgb strength = rgb_scale(color, (float)(intensity * (is_sun ? r->lamp_units.per_lux : r->lamp_units.per_candela)));
    if (is_sun)
        l.radiance = strength;
    else
        l.intensity = strength;
    l.direction = vec3_make((float)-z[0], (float)-z[1], (float)-z[2]);
    l.position =
        vec3_make((float)world_from_node->m[0][3], (float)world_from_node->m[1][3], (float)world_from_node->m[2][3]);
    if (is_spot)
        GLTF_TRY(read_spot(r, &at, &l));
    if (!((double)vec3_max_abs(l.position) <= GLTF_MAX_COORDINATE))
        return gltf_error(r, &at, "it is beyond 1e18 units");
    return rgb_is_black(strength) ? AG_OK : scene_add_light(r->scene, &l, &light_index);
}
