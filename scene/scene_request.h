/* scene_request.h: what whoever loads a scene asks of it beyond what its file says. Heeded while it is read.
 * Flow: command line, public interface -> scene_load -> [here] -> readers. Threads: plain data. */
#ifndef AFTERGLOW_SCENE_REQUEST_H
#define AFTERGLOW_SCENE_REQUEST_H

#include "math/vec3.h"

#include <stdbool.h>

/* The units of lamps in a glTF file, beside those of emissive surfaces; names as in Blender's exporter. */
typedef enum gltf_light_units {
    GLTF_LIGHTS_BY_GENERATOR, /* what its asset.generator is known to write */
    GLTF_LIGHTS_STANDARD,     /* cd and lx at 683 lm/W, beside emission in W/m^2/sr */
    GLTF_LIGHTS_UNITLESS,     /* W/sr and W/m^2, or photometric as emission is, which shows alike */
    GLTF_LIGHTS_RAW           /* points and spots in W over the whole sphere, suns in W/m^2 */
} gltf_light_units;

/* All zero: nothing is asked for. */
typedef struct scene_request {
    gltf_light_units gltf_light_units;
    bool has_camera; /* in the place of the file's */
    vec3 camera_from, camera_to, camera_up;
    float fov_degrees; /* across the shorter image axis, (0, 180) */
} scene_request;

#endif
