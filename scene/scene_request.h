/* scene_request.h: settings of loading a scene beyond what its file says, used while it is read.
 * Flow: command line, public interface -> scene_load -> [here] -> readers. Threads: plain data. */
#ifndef AFTERGLOW_SCENE_REQUEST_H
#define AFTERGLOW_SCENE_REQUEST_H

#include "math/vec3.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The units of lamps in a glTF file, beside those of emissive surfaces; names as in Blender's exporter. */
typedef enum gltf_light_units {
    GLTF_LIGHTS_BY_GENERATOR, /* what its asset.generator is known to write */
    GLTF_LIGHTS_STANDARD,     /* cd and lx at 683 lm/W, beside emission in W/m^2/sr */
    GLTF_LIGHTS_UNITLESS,     /* W/sr and W/m^2, or photometric as emission is, which shows alike */
    GLTF_LIGHTS_RAW           /* points and spots in W over the whole sphere, suns in W/m^2 */
} gltf_light_units;

/* The axis of the world that points up, for suns, skies and cameras that the file does not say. */
typedef enum scene_up {
    UP_BY_FORMAT, /* y; in pbrt's text the one nearest to the camera's up */
    UP_X,
    UP_Y,
    UP_Z,
    UP_MINUS_X,
    UP_MINUS_Y,
    UP_MINUS_Z
} scene_up;

/* Writes the path of a file that the scene names, terminated by NUL, and returns true; or returns false, and the reader
 * looks for it. */
typedef bool scene_find_file(void *user, const char *name, char *out_path, size_t path_size);

/* All zero: the defaults. */
typedef struct scene_request {
    gltf_light_units gltf_light_units;
    bool has_camera; /* instead of the file's */
    vec3 camera_from, camera_to;
    vec3 camera_up;                /* zero: the axis that points up */
    float fov_degrees;             /* across the shorter image axis, (0, 180) */
    const char *camera_name;       /* of the file's cameras this one; borrowed; NULL: the first */
    bool drops_lights;             /* all of the file's */
    uint64_t texture_memory_bytes; /* of pictures; 0: no limit */
    const char *texture_cache;     /* a folder that keeps those beyond it; borrowed; NULL: none */
    uint64_t texture_cache_bytes;  /* of all in that folder */
    scene_up up;
    bool has_sun; /* beside the file's lights */
    float sun_azimuth_degrees, sun_elevation_degrees;
    float sun_irradiance;    /* W/m^2, on a surface that faces it */
    float sun_angle_degrees; /* across it, [0, 180] */
    bool has_sky;            /* instead of the file's infinite lights */
    rgb sky_radiance;        /* W/m^2/sr, linear Rec. 709; a picture is multiplied by it */
    const char *sky_file;    /* a picture of all directions; borrowed; NULL: none */
    float sky_rotation_degrees;
    scene_find_file *find_file; /* of pbrt's text; NULL: all are for the reader to find */
    void *find_file_user;
} scene_request;

#endif
