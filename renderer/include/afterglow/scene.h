/* scene.h: loads scenes from files and from text, with settings beyond what the file says.
 * Part of afterglow.h, which tells about threads and errors. */
#ifndef AFTERGLOW_PUBLIC_SCENE_H
#define AFTERGLOW_PUBLIC_SCENE_H

#include "afterglow/context.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ag_scene ag_scene;

/* Reads a scene and builds the acceleration structures for its rays; the caller owns it. The extension tells the
 * format: .gltf, .glb; .obj; .ply; those that assimp reads (.stl, .dae, .fbx, ...), in a process of its own; any other
 * is pbrt-v4 text, plain or gzip ("-": standard input). A model without camera or light is given one. Errors:
 * AG_ERROR_ARGUMENT, AG_ERROR_INPUT (a file cannot be read), AG_ERROR_SCENE (the scene is not valid), AG_ERROR_COLOR,
 * AG_ERROR_RAY_TRACING, AG_ERROR_MEMORY, AG_ERROR_SYSTEM, AG_CANCELLED. */
AG_API ag_status ag_scene_load(ag_context *context, const char *path, ag_scene **out_scene);

/* The value of a name in pbrt text, where it is written $name, ${name} or ${name:-default}, in strings or alone. This
 * struct will not change. */
typedef struct ag_definition {
    const char *name;  /* letters, digits and _, not beginning with a digit */
    const char *value; /* the replacement, in which names are not replaced again */
    bool is_optional;  /* a scene that does not use it is no error */
} ag_definition;

/* ag_scene_load with values for names. A name in the scene without a value is an error with file, line and column;
 * where all definitions are optional, strings that contain a $ stay as they are instead. Errors: those of
 * ag_scene_load; AG_ERROR_ARGUMENT (a name is not valid, is defined twice, or is not used by the scene; the log says
 * which). */
AG_API ag_status ag_scene_load_with(ag_context *context, const char *path, const ag_definition *definitions,
                                    size_t definition_count, ag_scene **out_scene);

/* The units of lamps in a glTF file (KHR_lights_punctual), beside those of emissive surfaces. The names are
 * those of the "Lighting Mode" of Blender's exporter, which does not write down which one it was. */
typedef enum ag_gltf_light_units {
    AG_GLTF_LIGHT_UNITS_AUTO,     /* by asset.generator: standard for Blender from 3.4 on, raw for older ones,
                                   * unitless for others */
    AG_GLTF_LIGHT_UNITS_STANDARD, /* cd and lx at 683 lm/W, beside emission as radiance: divided by 683 */
    AG_GLTF_LIGHT_UNITS_UNITLESS, /* read as W/sr and W/m^2; also right for cd and lx beside emission in nit */
    AG_GLTF_LIGHT_UNITS_RAW       /* points and spots in W over the sphere: divided by 4 pi; suns in W/m^2 */
} ag_gltf_light_units;

/* The axis of the world that points up, for cameras of the settings or made for a model, and for the compass of suns
 * and skies. North, where azimuths begin, is -z where y is up (+z in pbrt's left-handed world), so that east is +x; it
 * is +y where z or x is up. Azimuths increase clockwise as seen from above. */
typedef enum ag_up_axis {
    AG_UP_AUTO, /* y; for pbrt text, the axis nearest to the up direction of the camera */
    AG_UP_X,
    AG_UP_Y,
    AG_UP_Z,
    AG_UP_MINUS_X,
    AG_UP_MINUS_Y,
    AG_UP_MINUS_Z
} ag_up_axis;

#define AG_DEFAULT_TEXTURE_MEMORY_BYTES ((uint64_t)3 << 29)
#define AG_TEXTURE_MEMORY_LEAST_BYTES   ((uint64_t)16 << 20)
#define AG_DEFAULT_TEXTURE_CACHE_BYTES  ((uint64_t)32 << 30)

/* Finds a file that a scene names: a picture, an included text, a mesh, a spectrum. Writes its path, terminated by NUL,
 * to out_path of path_size bytes (an empty path is an error) and returns true; or returns false, and the library looks
 * in the scene's folder. It is called on the thread that loads the scene, during the call; it may call the functions
 * that an ag_log_fn may call. */
typedef bool ag_find_file_fn(void *user, const char *name, char *out_path, size_t path_size);

/* Settings of a scene beyond what its file says. */
typedef struct ag_scene_settings {
    size_t struct_size;
    const ag_definition *definitions;     /* as in ag_scene_load_with; default NULL */
    size_t definition_count;              /* default 0 */
    ag_gltf_light_units gltf_light_units; /* default AG_GLTF_LIGHT_UNITS_AUTO */
    /* A perspective camera instead of the file's, whose exposure and shutter stay. Positions are in the file's world
     * space: left-handed for pbrt text, right-handed for models. camera_up must not be parallel to the view. */
    bool has_camera; /* default false */
    float camera_from[3], camera_to[3];
    float camera_up[3];       /* default 0 0 0: the axis of `up` */
    float camera_fov_degrees; /* across the shorter image axis, (0, 180); default 45 */
    /* The name of the file's camera to use (in glTF of its node, or its own); an unknown name is an error that lists
     * the names. Not together with has_camera. NULL, the default: the first camera. */
    const char *camera_name;
    uint64_t texture_memory_bytes; /* bound of the memory of image textures. Up to half of it they are kept whole; those
                                      beyond are kept in a temporary file ($TMPDIR, else /tmp), or in their own file
                                      where that has tiles and coarser levels, and their tiles are cached. The rendered
                                      picture is the same. 0: unbounded, else at least AG_TEXTURE_MEMORY_LEAST_BYTES;
                                      default AG_DEFAULT_TEXTURE_MEMORY_BYTES */
    /* A folder that takes the place of the temporary file and keeps textures between runs; it is created where it is
     * missing. Its files are named by a hash of the pictures, and any number of processes may share it. It is not used
     * where texture_memory_bytes is 0. NULL, the default: none. The string must be valid as long as find_file_user. */
    const char *texture_cache;
    uint64_t texture_cache_bytes; /* bound of the folder's size: least recently used files are removed;
                                     default AG_DEFAULT_TEXTURE_CACHE_BYTES */
    bool drops_lights;            /* leaves out the file's lights and emissive surfaces, and adds none. Default false */
    ag_up_axis up;                /* default AG_UP_AUTO */
    /* An infinitely distant sun beside the file's lights. With a sun, or the sky below, a model without light is given
     * none. */
    bool has_sun;                /* default false */
    float sun_azimuth_degrees;   /* from north towards east; default 0 */
    float sun_elevation_degrees; /* above the horizon, [-90, 90]; default 45 */
    float sun_irradiance;        /* W/m^2 on a surface that faces it, >= 0; default 3 */
    float sun_angle_degrees;     /* its angular diameter, [0, 180], for penumbras; mirrors do not show it; default 0 */
    /* A sky instead of the file's infinite lights. */
    bool has_sky;               /* default false */
    float sky_radiance[3];      /* W/m^2/sr, linear Rec. 709, >= 0; a picture is multiplied by it; default 1 1 1 */
    const char *sky_file;       /* a picture of it: latitude-longitude, with east in the middle and north left of it; or
                                   square, octahedral. is_confined does not apply to it. NULL, the default: uniform */
    float sky_rotation_degrees; /* turns the picture from north towards east; default 0 */
    ag_find_file_fn *find_file; /* for pbrt text; files that it names are read where the context's is_confined allows
                                   it. Default NULL */
    /* Passed to find_file. It must stay valid until ag_scene_load_as or ag_scene_load_text returns; for ag_scene_create
     * until the scene is destroyed, since each commit may call find_file. */
    void *find_file_user;
    bool is_editable; /* for ag_scene_create: the scene can be changed after its commit (scene_editing.h).
                         Default false */
} ag_scene_settings;

AG_DEFAULT_STRUCT(scene_settings, AG_STRUCT_SCENE_SETTINGS)

/* ag_scene_load with settings, which are read during the call; NULL: the defaults. Errors: those of ag_scene_load_with;
 * AG_ERROR_ARGUMENT (a setting is out of its range; the log says which). */
AG_API ag_status ag_scene_load_as(ag_context *context, const char *path, const ag_scene_settings *settings,
                                  ag_scene **out_scene);
/* ag_scene_load_as for pbrt-v4 text in memory: size_bytes of it, read during the call. name: used in messages; it need
 * not exist, but the scene's files are looked for in its folder (the part before its last slash, else the working
 * folder), unless find_file of the settings finds them. */
AG_API ag_status ag_scene_load_text(ag_context *context, const char *name, const char *text, size_t size_bytes,
                                    const ag_scene_settings *settings, ag_scene **out_scene);
/* NULL is fine. A scene that renderings still borrow is freed with the last of them. */
AG_API void ag_scene_destroy(ag_scene *scene);

/* Returns whether a path is one of the files that the scene was read from: its own, included ones, meshes, pictures.
 * Files are compared by device and inode, so that another spelling or a link is recognised. To be called before a
 * picture is written to path. Of formats that assimp reads, only the model's own file and its pictures are known. */
AG_API bool ag_scene_was_read_from(const ag_scene *scene, const char *path);

/* Returns the "filename" of the Film directive, which the scene owns; NULL where there is none. */
AG_API const char *ag_scene_film_file_name(const ag_scene *scene);

/* Returns whether the scene is written for this renderer (Integrator "photonmap") and has a Sampler, so that its number
 * of samples should be used. That of other scenes is meant for another renderer. */
AG_API bool ag_scene_has_own_samples(const ag_scene *scene);

#ifdef __cplusplus
}
#endif
#endif
