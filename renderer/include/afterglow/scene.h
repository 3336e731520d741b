/* scene.h: scenes from files and from text, and what is asked of them beyond that.
 * Part of afterglow.h, which tells about threads and errors. */
#ifndef AFTERGLOW_PUBLIC_SCENE_H
#define AFTERGLOW_PUBLIC_SCENE_H

#include "afterglow/context.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ag_scene ag_scene;

/* Reads a scene and builds what rays need. The end of the name says the format: .gltf, .glb; .obj; .ply; what assimp
 * reads (.stl, .dae, .fbx, ...), for which a process is started; all else is pbrt-v4 text (plain or gzip; "-" is
 * standard input). A camera and light are made up where a model brings none. */
AG_API ag_status ag_scene_load(ag_context *context, const char *path, ag_scene **out_scene);

/* A value that a scene leaves open: pbrt text may say $name or ${name}, in strings or alone, or ${name:-otherwise}. */
typedef struct ag_definition {
    const char *name;  /* letters, digits and _, no digit first */
    const char *value; /* text, not looked through for further names: a number, several, a part of a file's name */
    bool is_optional;  /* that the scene does not use it is no error */
} ag_definition;

/* ag_scene_load with values for names, each name once. A name of the scene that has no value is an error with file,
 * line and column; but where all that is defined is optional, strings with a $ in them stay as they are. Errors also:
 * AG_ERROR_ARGUMENT (a name is not valid or given twice, or the scene does not use it; the log says which). */
AG_API ag_status ag_scene_load_with(ag_context *context, const char *path, const ag_definition *definitions,
                                    size_t definition_count, ag_scene **out_scene);

/* The units of lamps in a glTF file (KHR_lights_punctual), beside those of emissive surfaces. The names are
 * those of the "Lighting Mode" of Blender's exporter, which does not write down which one it was. */
typedef enum ag_gltf_light_units {
    AG_GLTF_LIGHT_UNITS_AUTO,     /* as asset.generator tells: Blender from 3.4 on standard, before that raw; others
                                   * unitless */
    AG_GLTF_LIGHT_UNITS_STANDARD, /* cd and lx at 683 lm/W, while emission is radiance: divided by 683 */
    AG_GLTF_LIGHT_UNITS_UNITLESS, /* taken as they are, as W/sr and W/m^2: so also cd and lx where emission is in nit */
    AG_GLTF_LIGHT_UNITS_RAW       /* points and spots in W over the whole sphere: divided by 4 pi; suns in W/m^2 */
} ag_gltf_light_units;

/* Which axis of the world points up, for cameras that are asked for or made up, and for the compass that suns and skies
 * have. North, where azimuths begin, is -z where y is up (+z in pbrt's left-handed world), so that east is +x; where z
 * or x is up, it is +y. Azimuths go clockwise for who looks down from above. */
typedef enum ag_up_axis {
    AG_UP_AUTO, /* y; of pbrt's text the axis nearest to the up of its camera, or of the one asked for */
    AG_UP_X,
    AG_UP_Y,
    AG_UP_Z,
    AG_UP_MINUS_X,
    AG_UP_MINUS_Y,
    AG_UP_MINUS_Z
} ag_up_axis;

#define AG_DEFAULT_TEXTURE_MEMORY_BYTES ((uint64_t)4 << 30)
#define AG_TEXTURE_MEMORY_LEAST_BYTES   ((uint64_t)16 << 20)
#define AG_DEFAULT_TEXTURE_CACHE_BYTES  ((uint64_t)32 << 30)

/* Finds a file that a scene names: a picture, an included text, a mesh, a spectrum. Writes its path to out_path, of
 * path_size bytes, with a NUL at its end (an empty one is an error); false leaves it to the library, which looks in the
 * scene's folder. Called on the thread that loads the scene, while it does so; it may call what an ag_log_fn may. */
typedef bool ag_find_file_fn(void *user, const char *name, char *out_path, size_t path_size);

/* Settings of a scene beyond what its file says. */
typedef struct ag_scene_settings {
    size_t struct_size;
    const ag_definition *definitions;     /* as in ag_scene_load_with; default NULL */
    size_t definition_count;              /* default 0 */
    ag_gltf_light_units gltf_light_units; /* default AG_GLTF_LIGHT_UNITS_AUTO */
    /* A perspective camera instead of the file's; its exposure and shutter stay. World space, as the file has it:
     * handed as pbrt is, or as models are. Directions from and to each other, and up, must not be parallel. */
    bool has_camera; /* default false */
    float camera_from[3], camera_to[3];
    float camera_up[3];       /* default 0 0 0: the axis that points up, see up */
    float camera_fov_degrees; /* across the shorter image axis, (0, 180); default 45 */
    /* Of the file's cameras the one of this name (glTF: its node's or its own); another one is an error that says which
     * there are. Not with has_camera. NULL, the default: the first. */
    const char *camera_name;
    uint64_t texture_memory_bytes; /* of the pictures of textures: up to half of it they are held whole, what is beyond
                                      lies in a temporary file ($TMPDIR, else /tmp), or in the picture's own file where
                                      that holds tiles and coarser levels; some tiles are held. The picture is the
                                      same. 0: unbounded, else [AG_TEXTURE_MEMORY_LEAST_BYTES, ...];
                                      default AG_DEFAULT_TEXTURE_MEMORY_BYTES */
    /* A folder that keeps what would lie in the temporary file between runs, made where it is missing; files are named
     * by the bytes of the pictures, and any number of processes may use it. It is left alone where texture_memory_bytes
     * is 0. NULL, the default: none. Needed as long as find_file_user. */
    const char *texture_cache;
    uint64_t texture_cache_bytes; /* of all its files: those that were not used for the longest time are removed;
                                     default AG_DEFAULT_TEXTURE_CACHE_BYTES */
    bool drops_lights; /* no light of the file's shines, nor any surface; nor is light made up. Default false */
    ag_up_axis up;     /* default AG_UP_AUTO */
    /* A sun beside the file's lights, infinitely far. Where there is one, or a sky of the following, no light is made
     * up. */
    bool has_sun;                /* default false */
    float sun_azimuth_degrees;   /* from north over east; default 0 */
    float sun_elevation_degrees; /* above the horizon, [-90, 90]; default 45 */
    float sun_irradiance;        /* W/m^2 on a surface that faces it, >= 0; default 3 */
    float sun_angle_degrees;     /* across it, [0, 180]: shadows have penumbras, mirrors do not show it; default 0 */
    /* A sky instead of the file's infinite lights. */
    bool has_sky;          /* default false */
    float sky_radiance[3]; /* W/m^2/sr, linear Rec. 709, >= 0; a picture is multiplied by it; default 1 1 1 */
    const char *sky_file;  /* a picture of it, latitude-longitude, its middle in the east, north to the left of that;
                              or square, octahedral. Read wherever it lies. NULL, the default: alike everywhere */
    float sky_rotation_degrees; /* turns the picture from north over east; default 0 */
    ag_find_file_fn *find_file; /* of pbrt's text; what it names is read where the context's is_confined allows it.
                                   Default NULL */
    void *find_file_user; /* handed to it; valid until a scene of ag_scene_create is destroyed, which may call it with
                             any commit, and until ag_scene_load or ag_scene_load_text returns */
    bool is_editable;     /* of ag_scene_create: what calls have made can be changed (scene_editing.h). Default
                             false: what was said is forgotten with the commit */
} ag_scene_settings;

AG_DEFAULT_STRUCT(scene_settings, AG_STRUCT_SCENE_SETTINGS)

/* ag_scene_load with settings; NULL: the default ones. They are needed for the time of the call alone. Errors also:
 * AG_ERROR_ARGUMENT (a setting is out of its range; the log says which). */
AG_API ag_status ag_scene_load_as(ag_context *context, const char *path, const ag_scene_settings *settings,
                                  ag_scene **out_scene);
/* ag_scene_load_as of pbrt-v4 text that lies in memory: size_bytes of it, which are needed for the time of the call
 * alone. name: what messages call it; it need not exist, but the folder in front of its last slash is where files of
 * the scene are looked for (none: the working folder), unless find_file of the settings knows better. */
AG_API ag_status ag_scene_load_text(ag_context *context, const char *name, const char *text, size_t size_bytes,
                                    const ag_scene_settings *settings, ag_scene **out_scene);
/* NULL is fine. Where renderings still borrow it, it goes with the last of them. */
AG_API void ag_scene_destroy(ag_scene *scene);

/* Whether a path names one of the files that the scene was read from: its own, those that it includes, meshes,
 * pictures; by device and inode, so that no other spelling or link hides it. To be asked before a picture is written
 * there. What a model of a format that assimp reads brings beside the model itself is not among them, but for
 * pictures. */
AG_API bool ag_scene_was_read_from(const ag_scene *scene, const char *path);

/* The Film directive's "filename", NULL where there is none. Lives as long as the scene. */
AG_API const char *ag_scene_film_file_name(const ag_scene *scene);

/* Whether the scene is written for this renderer (Integrator "photonmap") and has a Sampler: then its number of samples
 * is meant. That of other scenes is for another renderer. */
AG_API bool ag_scene_has_own_samples(const ag_scene *scene);

#ifdef __cplusplus
}
#endif
#endif
