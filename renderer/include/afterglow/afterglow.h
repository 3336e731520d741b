/* afterglow.h: the public interface of Afterglow, a photon-mapping global illumination renderer.
 * Four objects, in the order in which the data moves: context, scene, film, file.
 *
 *     ag_context_create -> ag_scene_load -> ag_render -> ag_film_write
 *
 * Threads: a context and what was made with it belong to one thread at a time, but for ag_context_cancel and
 * ag_context_pause, which any thread and any signal handler may call, and for ag_film_read_tile and
 * ag_film_read_picture, which any thread may. Several contexts may work side by side.
 * Errors: what can fail returns ag_status and writes its out-parameters on AG_OK alone; the text goes to the log.
 * Structs are plain, and filled by ag_default_...(): later releases add members. A program is built against the header
 * of the library that it runs with; the library's SONAME changes whenever a public struct or enum does. */
#ifndef AFTERGLOW_AFTERGLOW_H
#define AFTERGLOW_AFTERGLOW_H

#include "afterglow/base.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* --- context: threads, log, progress --- */

typedef struct ag_context ag_context;

typedef struct ag_context_settings {
    unsigned thread_count;     /* 0: as many as the affinity mask and the cgroup's quota allow; default 0 */
    const char *isa;           /* widest instruction set of ray traversal: "sse2", "sse4.2", "avx", "avx2", "avx512";
                                  NULL: "avx2". Another set may give other bits. */
    const char *color_config;  /* an OpenColorIO config; NULL: $OCIO, else the one compiled in. Read when it is first
                                  needed; one that cannot be used is an error of that call */
    const char *working_space; /* colour space of the config that light is carried in, by name, alias or role; NULL: its
                                  role rendering, else scene_linear (linear Rec. 709 in the one compiled in). The
                                  scene's colours, spectra and pictures are converted to it as they are read */
    bool is_confined; /* scenes are not trusted: of their files only those are read that lie below the scene's own
                         folder, or below those of confined_to; of formats that assimp reads, where the kernel
                         (Landlock) holds its process there, else none. Default false */
    const char *const *confined_to; /* [confined_count], or NULL */
    size_t confined_count;
    ag_log_fn *log;           /* NULL: messages are dropped */
    ag_progress_fn *progress; /* or NULL */
    void *user;               /* handed to both */
} ag_context_settings;

AG_API ag_context_settings ag_default_context_settings(void);
/* Copies the settings; NULL for the defaults. */
AG_API ag_status ag_context_create(const ag_context_settings *settings, ag_context **out_context);
AG_API void ag_context_destroy(ag_context *context); /* after all that was made with it; NULL is fine */
AG_API unsigned ag_context_thread_count(const ag_context *context);
/* The work under way returns AG_CANCELLED, within 50 ms; so does all later work with this context, until
 * ag_context_clear_cancel. Safe in a signal handler. */
AG_API void ag_context_cancel(ag_context *context);
/* Work may begin again after a cancellation, with the context and the scenes that are there; so may a rendering whose
 * ag_rendering_continue was cancelled go on, to the same bits. Not while work is under way. */
AG_API void ag_context_clear_cancel(ag_context *context);
/* The ag_rendering_continue under way, else the next, returns AG_PAUSED, within 50 ms and with whole samples; it may be
 * called again. No other work is touched. Safe in a signal handler. */
AG_API void ag_context_pause(ag_context *context);

/* Lists what the colour config has, as lines of text: displays and their views, looks, colour spaces, roles. The
 * context's. Errors: AG_ERROR_COLOR, AG_ERROR_MEMORY. */
AG_API ag_status ag_color_summary(ag_context *context, const char **out_text);

/* --- scene --- */

typedef struct ag_scene ag_scene;

/* Reads a scene and builds what rays need. The end of the name says the format: .gltf, .glb; .obj; .ply; what assimp
 * reads
 * (.stl, .dae, .fbx, ...), for which a process is started; all else is pbrt-v4 text (plain or gzip; "-" is standard
 * input). A camera and light are made up where a model brings none. */
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
 * have. North, where azimuths begin, is -z where
 * y is up (+z in pbrt's left-handed world), so that east is +x; where z or x is up, it is +y. Azimuths go clockwise for
 * who looks down from above. */
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

/* Finds a file that a scene names: a picture, an included text, a mesh, a spectrum. Writes its path to out_path, of
 * path_size bytes, with a NUL at its end (an empty one is an error); false leaves it to the library, which looks in the
 * scene's folder. Called on the thread that loads the scene, while it does so; it may call what an ag_log_fn may. */
typedef bool ag_find_file_fn(void *user, const char *name, char *out_path, size_t path_size);

/* Settings of a scene beyond what its file says. */
typedef struct ag_scene_settings {
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
    void *find_file_user;       /* handed to it */
} ag_scene_settings;

AG_API ag_scene_settings ag_default_scene_settings(void);

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

/* --- scenes from memory --- */

/* A scene that calls put together:
 *
 *     ag_scene_create -> ag_scene_set_..., ag_scene_add_... -> ag_scene_commit -> ag_render -> ag_scene_set_camera, ...
 *
 * Each call is a directive of pbrt-v4's text (pbrt.org/fileformat-v4), whose types, parameters, units, defaults and
 * limits it has, and goes the way of a file's directive: the picture has the bits of a file that says the same in the
 * same order. What is handed over is copied before the call returns.
 * Threads: the scene is its context's. Errors of all of them: AG_ERROR_ARGUMENT (what must be there is NULL, a number
 * is not finite, an array is not of the parameter's type, a struct's size is not known, the scene is committed),
 * AG_ERROR_SCENE (as in a file), AG_ERROR_INPUT (a file that a parameter names), AG_ERROR_COLOR, AG_ERROR_MEMORY,
 * AG_CANCELLED. The log names the function, the number of its call for this scene and the number of the parameter that
 * is wrong, both from 1 on (0: none of them), and below that what was to be made:
 *
 *     ag_scene_add_shape:17:2: error: index 9 (value 3 of "indices") is out of range, there are 4 vertices
 *         Shape "trianglemesh" of material "red"
 *
 * What was made before a call that fails stays; the call itself then has no effect, and further calls may follow. */

typedef enum ag_parameter_type {
    AG_PARAMETER_FLOAT,
    AG_PARAMETER_INTEGER,
    AG_PARAMETER_STRING,
    AG_PARAMETER_BOOL,
    AG_PARAMETER_POINT2,
    AG_PARAMETER_VECTOR2,
    AG_PARAMETER_POINT3,
    AG_PARAMETER_VECTOR3,
    AG_PARAMETER_NORMAL,
    AG_PARAMETER_RGB,       /* linear Rec. 709 */
    AG_PARAMETER_SPECTRUM,  /* wavelength in nm and value, in pairs; or the name of one, as a string */
    AG_PARAMETER_BLACKBODY, /* K */
    AG_PARAMETER_TEXTURE    /* the name of one, as a string */
} ag_parameter_type;

/* One of a directive's parameters: "point3 P", "rgb reflectance", ... This struct will not change. */
typedef struct ag_parameter {
    const char *name; /* "P" */
    ag_parameter_type type;
    size_t count; /* of numbers, three for each point3; of strings; of bools */
    /* One of these arrays [count], the others NULL: integers of AG_PARAMETER_INTEGER, bools of AG_PARAMETER_BOOL,
     * strings of strings and names, floats or doubles of all else. */
    const float *floats;
    const double *doubles;
    const int32_t *integers;
    const char *const *strings;
    const bool *bools;
} ag_parameter;

/* An empty scene. settings: as for ag_scene_load_as, copied but for the definitions, of which there must be none;
 * NULL: the default ones. Until ag_scene_commit it can be added to and destroyed, and nothing else.
 *
 * The settings take effect at the commit. The camera that was set last before it says then where sun and sky stand:
 * which axis AG_UP_AUTO takes for up, and whether the world is left-handed; after that the camera of has_camera takes
 * its place. A camera that is set after the commit counts instead of either, and moves neither sun nor sky. So a host
 * that asks for them sets a camera of its convention before the commit too. */
AG_API ag_status ag_scene_create(ag_context *context, const ag_scene_settings *settings, ag_scene **out_scene);
/* Completes the scene and builds what rays need; it is then as one from a file, of which the camera alone can change.
 * After an error it can only be destroyed. Errors also: AG_ERROR_RAY_TRACING. */
AG_API ag_status ag_scene_commit(ag_scene *scene);

/* Each name of a material, a medium and a kind of texture is made once. Materials and media may be used before they are
 * made, textures only afterwards. type: "diffuse", "homogeneous", ... */
AG_API ag_status ag_scene_add_material(ag_scene *scene, const char *name, const char *type,
                                       const ag_parameter *parameters, size_t parameter_count);
AG_API ag_status ag_scene_add_medium(ag_scene *scene, const char *name, const char *type,
                                     const ag_parameter *parameters, size_t parameter_count);

/* Tells what the scene says of its picture; the last of each counts. type: "rgb", "independent", "photonmap",
 * "gaussian",
 * ... */
typedef enum ag_scene_hint { AG_HINT_FILM, AG_HINT_SAMPLER, AG_HINT_INTEGRATOR, AG_HINT_PIXEL_FILTER } ag_scene_hint;
AG_API ag_status ag_scene_set_hint(ag_scene *scene, ag_scene_hint hint, const char *type,
                                   const ag_parameter *parameters, size_t parameter_count);

/* The structs that follow begin with their size, which ag_default_...() sets: a library that knows more members takes
 * the rest for their defaults. Matrices have 16 numbers, row by row, of column vectors: the last column is where the
 * origin goes, the last row is 0 0 0 1. Each is given when the shutter opens (pbrt's time 0), and where something moves
 * when it closes (time 1). */

/* A picture in memory, which stands in for the file of that name in every "string filename" of textures and lights from
 * then on: packed, top row first; grey, grey and alpha, RGB, or RGB and alpha. */
typedef struct ag_image {
    size_t struct_size;
    int width, height;          /* pixels; at most 2^28 in all */
    int channel_count;          /* 1 to 4; default 3 */
    const unsigned char *bytes; /* as the values of a file of 8 bits: sRGB where no "encoding" says otherwise; or */
    const float *floats;        /* as those of an EXR file, linear */
} ag_image;
AG_API ag_image ag_default_image(void);
AG_API ag_status ag_scene_add_image(ag_scene *scene, const char *name, const ag_image *image);

typedef enum ag_texture_value { AG_TEXTURE_FLOAT, AG_TEXTURE_SPECTRUM } ag_texture_value;
typedef struct ag_texture {
    size_t struct_size;
    const char *name;
    ag_texture_value value; /* that it has at a point: a number, or a colour; default AG_TEXTURE_SPECTRUM */
    const char *type;       /* "imagemap", "scale", "checkerboard", ... */
    const ag_parameter *parameters;
    size_t parameter_count;
    const double *world_from_texture; /* of textures in space; NULL, the default: as it is */
} ag_texture;
AG_API ag_texture ag_default_texture(void);
AG_API ag_status ag_scene_add_texture(ag_scene *scene, const ag_texture *texture);

typedef struct ag_shape {
    size_t struct_size;
    const char *type; /* "trianglemesh", "sphere", "curve", ... */
    const ag_parameter *parameters;
    size_t parameter_count;
    const char *material; /* NULL, the default: diffuse, grey */
    const char *object;   /* that it is part of, made where there is none of that name, and seen where instances of it
                             are;   NULL, the default: it is in the world itself */
    const double *world_from_shape;     /* of an object's: from shape to object; NULL, the default: as it is */
    const double *world_from_shape_end; /* NULL, the default: it does not move */
    bool reverse_orientation;           /* default false */
    bool is_light;                      /* it shines, with AreaLightSource's parameters: default false */
    const ag_parameter *light_parameters;
    size_t light_parameter_count;
    const char *medium_inside, *medium_outside; /* NULL, the default: none */
} ag_shape;
AG_API ag_shape ag_default_shape(void);
AG_API ag_status ag_scene_add_shape(ag_scene *scene, const ag_shape *shape);

/* An object has at least one shape when its first instance is made, and is complete with that: nothing can be added to
 * it afterwards. */
typedef struct ag_instance {
    size_t struct_size;
    const char *object;
    const double *world_from_object;     /* NULL, the default: as it is */
    const double *world_from_object_end; /* NULL, the default: it does not move */
} ag_instance;
AG_API ag_instance ag_default_instance(void);
AG_API ag_status ag_scene_add_instance(ag_scene *scene, const ag_instance *instance);

typedef struct ag_light {
    size_t struct_size;
    const char *type; /* "point", "spot", "distant", "infinite", ... */
    const ag_parameter *parameters;
    size_t parameter_count;
    const double *world_from_light; /* NULL, the default: as it is */
    const char *medium_outside;     /* NULL, the default: none */
} ag_light;
AG_API ag_light ag_default_light(void);
AG_API ag_status ag_scene_add_light(ag_scene *scene, const ag_light *light);

/* The last one counts, but for has_camera (see ag_scene_create); it comes before all that moves. Of a scene that is
 * complete, from a file too, it may be changed as long as no rendering borrows the scene: nothing is rebuilt, and a
 * photon map that is kept (photon_map_file) goes on serving. Its medium then stays (medium must be NULL), and where
 * anything moves its shutter. */
typedef struct ag_camera {
    size_t struct_size;
    const char *type; /* default "perspective" */
    const ag_parameter *parameters;
    size_t parameter_count;
    const double *world_from_camera; /* as pbrt's: it looks along +z, x is to the right and y up. NULL, the default: as
                                        it is */
    const double *world_from_camera_end; /* NULL, the default: it does not move */
    const char *medium;                  /* that it is in; NULL, the default: none */
} ag_camera;
AG_API ag_camera ag_default_camera(void);
AG_API ag_status ag_scene_set_camera(ag_scene *scene, const ag_camera *camera);

/* --- rendering --- */

typedef enum ag_integrator { AG_INTEGRATOR_PHOTONMAP, AG_INTEGRATOR_PATH } ag_integrator;

typedef enum ag_cache_mode {
    AG_CACHE_ON_DEMAND,  /* irradiance at a photon is computed when it is first asked for */
    AG_CACHE_PRECOMPUTE, /* at every photon, before rendering; the picture is the same, bit for bit */
    AG_CACHE_OFF         /* an estimate at every gather hit: another estimator */
} ag_cache_mode;

/* Light that passes panes: thin glass and smooth interfaces of index 1, which do not bend it, and slabs of smooth solid
 * glass, whose parallel faces do no more than shift it by about a third of their thickness. A slab's faces are flat and
 * at least sixteen times as wide (area over diagonal) as it is thick. */
typedef enum ag_pane_light {
    AG_PANE_LIGHT_DIRECT, /* as if nothing were in its way: sampled at its lamp, by both integrators. Suns, points and
                             spots shine through windows in the path tracer too; no caustic. What the eye sees through
                             a slab, directly or in mirrors, is bent all the same */
    AG_PANE_LIGHT_TRACED  /* like light by way of any other glass */
} ag_pane_light;

/* Pictures of colours are filtered over the footprints of rays: along the eye's over their share of a pixel, also by
 * way of mirrors and glass, along gather rays' and photons' more coarsely. */
typedef enum ag_texture_filter { AG_TEXTURE_FILTER_ON, AG_TEXTURE_FILTER_OFF } ag_texture_filter;

typedef enum ag_only { AG_ONLY_ALL, AG_ONLY_INDIRECT } ag_only;

/* Layers of a picture beside its R, G and B. Their channels have the names that other renderers give them. */
typedef enum ag_layer {
    AG_LAYER_ALPHA = 1 << 0,  /* A: the share of the pixel where there is something; R, G and B hold the sky as well */
    AG_LAYER_DEPTH = 1 << 1,  /* Z: the nearest surface's, along the camera's axis; 1e10 where there is none */
    AG_LAYER_ALBEDO = 1 << 2, /* albedo.R, G, B: of what is met first, with what it reflects like a mirror, [0, 1] */
    AG_LAYER_NORMAL = 1 << 3, /* N.X, Y, Z: its shading normal on the eye's side, world space, mean over the pixel */
    AG_LAYER_POSITION = 1 << 4, /* P.X, Y, Z: world space, mean over what of the pixel is not empty */
    AG_LAYER_UV = 1 << 5,       /* u, v */
    /* The parts of light. R, G and B are their sum in this order, in floats, to the last bit. A pane whose light is
     * direct (ag_pane_light) is no surface to what it lets through: behind it the first surface is the one that is seen
     * through it. Slabs are surfaces to the eye, and none to the light that shines through them. */
    AG_LAYER_EMISSION = 1 << 6,      /* straight from lamps and sky to the eye */
    AG_LAYER_DIRECT = 1 << 7,        /* straight from lamps, reflected by the first surface's diffuse lobes */
    AG_LAYER_INDIRECT = 1 << 8,      /* what else these reflect, but */
    AG_LAYER_CAUSTIC = 1 << 9,       /* what comes to them from lamps by way of mirrors and glass alone */
    AG_LAYER_SPECULAR = 1 << 10,     /* all that comes by the first surface's other lobes */
    AG_LAYER_IRRADIANCE = 1 << 11,   /* irradiance.R, G, B: of the photon map at the first surface, W/m^2 */
    AG_LAYER_VARIANCE = 1 << 12,     /* variance.R, G, B: of the pixel's samples (not of their mean) */
    AG_LAYER_SAMPLES = 1 << 13,      /* samples.V: how many */
    AG_LAYER_ID = 1 << 14,           /* id.object.V, id.material.V: of the nearest surface, from 1 on; 0: nothing */
    AG_LAYER_LIGHT_GROUPS = 1 << 15, /* light_NAME.R, G, B: what came from the lamps of a group to the first surface and
                                        by way of mirrors and glass; light_photons: through the photon map */
    AG_LAYER_GBUFFER = 1 << 16,      /* the channels of pbrt-v4's film "gbuffer"; its P and N instead of the above */
    /* How the photon map fared, at what the ray through the pixel's middle meets first; 0 where that gathers
     * nothing. */
    AG_LAYER_PHOTON_DENSITY = 1 << 17, /* photon_density.V: photons per area, 1/m^2 */
    AG_LAYER_CACHE_STATE = 1 << 18, /* cache_state.V: of the photon nearest there: 1 its irradiance was not demanded, 2
                                       it was; 0: no photon is near */
    AG_LAYER_PHOTON_DISTANCE = 1 << 19, /* photon_distance.V: how far that photon is */
    AG_LAYER_GATHER_DISTANCE = 1 << 20, /* gather_distance.V: how far gather rays go, harmonic mean */
    /* Cryptomatte for objects (instances, glTF nodes, files of meshes) and materials, by their names in the scene,
     * or by numbers; six ranks. */
    AG_LAYER_CRYPTO_OBJECT = 1 << 22,
    AG_LAYER_CRYPTO_MATERIAL = 1 << 23,
    AG_LAYER_TILE_TIME = 1 << 21 /* tile_time.V: seconds that the pixel's tile took: another number in each run */
} ag_layer;
#define AG_LAYERS_LIGHT (AG_LAYER_EMISSION | AG_LAYER_DIRECT | AG_LAYER_INDIRECT | AG_LAYER_CAUSTIC | AG_LAYER_SPECULAR)
/* All that is the same from run to run, in our names. */
#define AG_LAYERS_ALL                                                                                                  \
    (AG_LAYER_ALPHA | AG_LAYER_DEPTH | AG_LAYER_ALBEDO | AG_LAYER_NORMAL | AG_LAYER_POSITION | AG_LAYER_UV |           \
     AG_LAYERS_LIGHT | AG_LAYER_IRRADIANCE | AG_LAYER_VARIANCE | AG_LAYER_SAMPLES | AG_LAYER_ID |                      \
     AG_LAYER_LIGHT_GROUPS | AG_LAYER_PHOTON_DENSITY | AG_LAYER_CACHE_STATE | AG_LAYER_PHOTON_DISTANCE |               \
     AG_LAYER_GATHER_DISTANCE | AG_LAYER_CRYPTO_OBJECT | AG_LAYER_CRYPTO_MATERIAL)

/* Layers by name, separated by commas: "A,Z,albedo", "light" for the parts of light, "all". Errors:
 * AG_ERROR_ARGUMENT. */
AG_API ag_status ag_layers_parse(const char *list, uint32_t *out_layers);

/* A layer by its name, for command lines and their help. The strings are the library's. */
typedef struct ag_layer_info {
    ag_layer layer;
    const char *name, *group; /* as ag_layers_parse knows them; group: of several layers, or NULL */
    const char *about;        /* what it shows, with *bold* and _italic_ words */
    bool is_left_out_of_all;  /* "all" is not this one, too */
} ag_layer_info;

/* All layers by number, from 0 on; NULL: there are no more. */
AG_API const ag_layer_info *ag_layer_at(size_t index);

typedef struct ag_render_settings {
    ag_integrator integrator;         /* default: photonmap */
    ag_cache_mode cache;              /* default: on demand */
    ag_pane_light pane_light;         /* default: direct */
    ag_texture_filter texture_filter; /* default: on */
    ag_only only;  /* AG_ONLY_INDIRECT: less emission and direct light at the first non-specular hit */
    uint64_t seed; /* default 0; statistics show it as a signed number */

    int width, height;     /* pixels of the full picture, [1, 65536] */
    double crop_window[4]; /* x0, x1, y0, y1 in [0, 1]: the part to render, from the left and from the top, as
                              pbrt's cropwindow: pixels from ceil(x0 width) up to ceil(x1 width) - 1; default 0 1 0 1 */
    int samples_per_pixel; /* [1, 2^20] */
    float exposure;        /* pixels are the radiance times this: pbrt's imaging ratio, the shutter's time * iso / 100;
                              > 0, default 1 */
    float max_component;   /* no component of a sample in CIE XYZ, which is pbrt's sensor, is above it: brighter samples
                              are scaled down; 0: unbounded, the default */
    float white_balance;   /* K, [1000, 25000]: daylight of this temperature (below 4000: a black body) becomes white;
                              0: none, the default */
    bool float_samples;    /* EXR files of the film hold floats where ag_output_settings leaves it open; default half */
    int max_depth;         /* scatterings between lamp and eye, [0, 100]; 100: roulette alone ends paths. Path tracing
                              keeps it exactly. The photon map bounds light's part (to max_depth - 2 before a
                              gather ray ends, max_depth - 1 before a caustic) and the eye's part apart: behind
                              mirrors and glass there may be some more. */

    uint64_t photon_count;         /* photons to store in the global map, [1, 2^32 - 2] */
    uint64_t caustic_photon_count; /* photons to store in the caustic map; only where anything is specular; [0, …] */
    int nearest;                   /* photons of an estimate, [1, 65536] */
    float radius;                  /* largest radius of an estimate, scene units; 0: from the photons' density */
    float irradiance_fraction;     /* share of the photons that irradiance is kept at, (0, 1]: gather rays look for the
                                      nearest of these irradiance photons, and each estimate is still of all photons.
                                      Less is faster, and blurs by about their spacing. Where photons lie far apart,
                                      and where surfaces turn, more photons are taken, so that each has an irradiance
                                      photon nearby. Default 1 */
    float gather_guiding; /* how much the photons' directions decide where gather rays go, [0, 1]: the share of the
                             rays that goes where light comes from, where photons are many; the rest goes by the
                             cosine. 0: all. Less noise or more, the same light. Default
                             AG_DEFAULT_GATHER_GUIDING */
    uint64_t photon_seed; /* of the photons, so that pictures of other seeds can share a kept photon map. Default
                             AG_PHOTON_SEED_AUTOMATIC: seed */
    float photon_aim;     /* share of the photon paths that begin where a pilot has found that they bring light to where
                             this picture asks for it, [0, 0.8]: the others begin by power alone, so that no photon is more
                             than five times as bright as without. The same light, with less noise in this picture and more
                             in others; the pilot depends on the whole frame's view and shape, and on nothing else of the
                             picture. Default AG_PHOTON_AIM_AUTOMATIC: AG_DEFAULT_PHOTON_AIM, but 0 for a photon_map_file,
                             which serves all views alike; one that is aimed is refused for another view */
    float direct_guiding; /* share of the samples of direct light that go to the lights, and the parts of the sky, that
                             a pilot has seen from about there, [0, 0.8]: the others go to all alike, so that none
                             counts more than five times as much as if all did. The same light, with less noise where it
                             comes through windows; the pilot depends on the whole frame's view and shape, on depth,
                             light through panes and seed, and on nothing else of the picture. Scenes without a distant
                             or infinite light have none. Default AG_DIRECT_GUIDING_AUTOMATIC:
                             AG_DEFAULT_DIRECT_GUIDING, but 0 for AG_INTEGRATOR_PATH, which others are held against */
    uint32_t layers;      /* AG_LAYER_..., or-ed; default 0, of a scene with film "gbuffer" AG_LAYER_GBUFFER */
    bool denoise;         /* ag_film_denoise will be asked for: the film keeps what it needs */
    bool layers_in_camera_space; /* P and normals of AG_LAYER_GBUFFER: the camera's, else the world's */
    float clamp_direct; /* no component of what a sample gets from a lamp by way of at most one surface is above it; 0:
                           unbounded, the default */
    float clamp_indirect; /* the same of all other contributions */
    float noise_level;    /* adaptive sampling: a block of 8 by 8 pixels gets no more samples when the standard error of
                             what is shown of it (its square root, where white is 1; what is brighter, by its share), root
                             mean square over the block, is below this; samples_per_pixel is the most then; 0: all pixels
                             get as many, the default. The program takes AG_DEFAULT_NOISE_LEVEL and
                             AG_DEFAULT_SAMPLES_MOST where neither options nor ag_scene_has_own_samples say otherwise */
    int noise_min_samples;      /* of each pixel then, [2, 2^20]; default 16 */
    float shown_exposure_stops; /* by which the picture will be made brighter when it is shown, [-100, 100]: noise and
                                   warnings are of what is shown; default 0 */
    int gather_samples;         /* gather rays for each camera sample, [1, 65536], where it meets a diffuse surface
                                   first; what is reflected shares about as many; 0, the default: each block of 8 by
                                   8 pixels chooses by the noise of its samples, and so it does the light samples;
                                   the first ones have so many that samples times gather rays are about
                                   AG_DEFAULT_GATHER_RAYS_PER_PIXEL (with a noise level for 64 samples at most), at
                                   least 4 */
    /* A file that holds the photon map from one picture to the next, with the irradiances computed so far; NULL, the
     * default: none. Traced where there is none yet; other processes on this machine that use it meanwhile fill it
     * together with this one. The picture is the same. Borrowed until ag_rendering_create or ag_render returns. One
     * that is damaged, or was made of another scene or with other settings than the photons depend on, is refused:
     * camera, film, samples and gather rays may differ, but the view may not where the photons are aimed. */
    const char *photon_map_file;
    bool photon_map_refresh; /* one that would be refused is traced anew, and replaced */
} ag_render_settings;

/* The scene's own settings, and our defaults for what it leaves open. Loading the scene has checked what its file says.
 * Errors: AG_ERROR_ARGUMENT. */
AG_API ag_status ag_render_settings_from_scene(ag_context *context, const ag_scene *scene,
                                               ag_render_settings *out_settings);

/* Our defaults alone. */
AG_API ag_render_settings ag_default_render_settings(void);

/* A setting that has a name, for command lines, dialogs and their help. The strings are the library's. */
typedef struct ag_setting {
    const char *name;      /* "photon-aim" */
    const char *argument;  /* what stands for its value in help, "F"; NULL: it takes none, and is switched on */
    const char *section;   /* "Output", "Picture" or "Light" */
    const char *help;      /* what it does, its range and default, in a sentence without an end */
    const char *manual;    /* the same at length, with *bold* and _italic_ words; NULL: help says it all */
    bool is_of_photon_map; /* a kept photon map was made with one value of it, and is refused for another */
} ag_setting;

/* All of them by number, from 0 on; NULL: there are no more. */
AG_API const ag_setting *ag_setting_at(size_t index);
/* Sets one by its name to what a text says; numbers have a point in every locale. "aov" adds to the layers that are
 * set. value: NULL where it takes none; "photon-map" borrows it. Errors: AG_ERROR_ARGUMENT (there is no such setting,
 * or the text is no value of it; settings are then as they were). */
AG_API ag_status ag_render_settings_set(ag_render_settings *settings, const char *name, const char *value);

#define AG_DEFAULT_NOISE_LEVEL           0.02f
#define AG_DEFAULT_SAMPLES_MOST          1024
#define AG_DEFAULT_GATHER_RAYS_PER_PIXEL 256
#define AG_DEFAULT_GATHER_GUIDING        0.5f
#define AG_PHOTON_SEED_AUTOMATIC         0x8000000000000000u
#define AG_DEFAULT_PHOTON_AIM            0.8f
#define AG_PHOTON_AIM_AUTOMATIC          (-1.0f)
#define AG_DEFAULT_DIRECT_GUIDING        0.8f
#define AG_DIRECT_GUIDING_AUTOMATIC      (-1.0f)

typedef struct ag_film ag_film;

/* Traces photons, builds the maps, renders. The picture depends on scene, settings and seed alone.
 * Errors: AG_ERROR_ARGUMENT (settings out of range), AG_ERROR_SCENE (no camera), AG_ERROR_INPUT (the photon map's file
 * is refused), AG_ERROR_OUTPUT (it cannot be written), AG_ERROR_MEMORY, AG_CANCELLED. */
AG_API ag_status ag_render(ag_context *context, const ag_scene *scene, const ag_render_settings *settings,
                           ag_film **out_film);
AG_API void ag_film_destroy(ag_film *film); /* NULL is fine */
/* Whether a photon map could be kept there; of one that is there already nothing is read. To be asked before the scene
 * is loaded. Errors: AG_ERROR_OUTPUT. */
AG_API ag_status ag_photon_map_check(ag_context *context, const char *path);

/* The contents of a photon map's file. */
typedef struct ag_photon_map_info {
    char program[56], machine[56]; /* that have made it; those of others refuse it */
    char scene[33];                /* fingerprint of what its photons depend on in the scene, 32 hexadecimals */
    char view[33];                 /* the same of the view that they are aimed at; "": at none */
    char settings[1024];           /* that they depend on, lines "NOUN: VALUE" */
    uint64_t file_bytes, paths_emitted, photons_global, photons_caustic;
    uint64_t irradiance_photons; /* photons of the global map that irradiance is kept at */
    uint64_t ready;              /* of these, where it has been computed */
    uint64_t damaged;            /* where it had been and is damaged: it will be computed again */
} ag_photon_map_info;

/* Errors: AG_ERROR_INPUT (it cannot be read, is damaged, or is no photon map; the log says why), AG_ERROR_MEMORY,
 * AG_CANCELLED. */
AG_API ag_status ag_photon_map_read_info(ag_context *context, const char *path, ag_photon_map_info *out_info);
/* Puts the irradiances of several files of one map together, which were filled apart, on machines of one maker: in any
 * order, and any of them any number of times, they make the same map. Written atomically; what stands at
 * out_path must be a photon map, and unless it is damaged it is put in with the others. count >= 1. out_info: of the
 * new file, or NULL. Errors: AG_ERROR_INPUT (as above; or they are of different maps, or hold different irradiances),
 * AG_ERROR_OUTPUT, AG_ERROR_MEMORY, AG_CANCELLED. */
AG_API ag_status ag_photon_map_merge(ag_context *context, const char *out_path, const char *const *paths, size_t count,
                                     ag_photon_map_info *out_info);

/* ag_render in passes over the whole picture: previews, checkpoints and limits of time are built on it. Samples [0, a)
 * and then [a, b) give the bits of [0, b) at once. The rendering borrows scene and context. */
typedef struct ag_rendering ag_rendering;

/* Traces photons and builds the maps. Errors as ag_render. */
AG_API ag_status ag_rendering_create(ag_context *context, const ag_scene *scene, const ag_render_settings *settings,
                                     ag_rendering **out_rendering);
/* Brings every pixel to so many samples, or to fewer where the settings' noise level is reached before; those that have
 * them already stay as they are. samples_per_pixel: [1, that of
 * the settings]. Errors: AG_ERROR_ARGUMENT; AG_CANCELLED, AG_PAUSED: the film is then as good as it is, each pixel
 * with the samples that it has had; AG_ERROR_SYSTEM: the photon map's file was cut short or overwritten meanwhile, and
 * the film is that of the call before. */
AG_API ag_status ag_rendering_continue(ag_rendering *rendering, int samples_per_pixel);
/* How many samples pixels have had so far. */
typedef struct ag_sample_counts {
    int least, most;
    double mean;
} ag_sample_counts;
AG_API ag_sample_counts ag_rendering_sample_counts(const ag_rendering *rendering);
/* Where a picture's noise comes from: the light that the camera's rays bring, by its way. */
typedef enum ag_noise_source {
    AG_NOISE_EMISSION, /* straight from lamps and sky to the eye: their edges */
    AG_NOISE_LAMPS,    /* direct light of all lights but the infinite ones */
    AG_NOISE_SKY,      /* direct light of infinite ones */
    AG_NOISE_INDIRECT,
    AG_NOISE_CAUSTIC,
    AG_NOISE_SPECULAR /* by way of mirrors, glass and glossy surfaces */
} ag_noise_source;
#define AG_NOISE_SOURCE_COUNT 6

typedef struct ag_noise {
    double level; /* the standard error of what is shown (see noise_level), root mean square over the picture; below 0:
                     not known, as pixels have had fewer than two samples */
    double share[AG_NOISE_SOURCE_COUNT]; /* of the variance; they sum to 1, or are all 0 where there is no noise */
    char hint[256];                      /* what makes most of it, and what would help most, a line; may be empty */
} ag_noise;
/* How noisy the picture is by now; from up to 16,384 of its pixels, spread evenly. The caustics' share counts the grain
 * of their photons too, which more samples do not lessen. */
AG_API ag_noise ag_rendering_noise(const ag_rendering *rendering);
/* All that samples have brought so far, as a file; written atomically. Another process that makes the same rendering
 * reads it, and goes on to the same bits. Errors: AG_ERROR_MEMORY, AG_ERROR_OUTPUT. */
AG_API ag_status ag_rendering_write_checkpoint(const ag_rendering *rendering, const char *path);
/* To be called before the first ag_rendering_continue. The log says why a file is refused: damaged, or of another
 * scene, other settings, another version. The rendering is then as it was. Errors: AG_ERROR_INPUT. */
AG_API ag_status ag_rendering_read_checkpoint(ag_rendering *rendering, const char *path);
/* The photons as binary PLY, for viewers and scripts: x, y, z, nx, ny, nz, the way the light went dx, dy, dz, red,
 * green, blue in W, caustic (0 global map, 1 caustic map), demanded (whether irradiance was computed there); written
 * atomically. Errors: AG_ERROR_ARGUMENT (path tracing has none), AG_ERROR_MEMORY, AG_ERROR_OUTPUT. */
AG_API ag_status ag_rendering_write_photons(const ag_rendering *rendering, const char *path);
/* The film as it is now, the rendering's; and the same one all along, which ag_rendering_finish hands over. While the
 * rendering is at work, its size and names may be asked for, and it may be watched with ag_film_read_tile and
 * ag_film_read_picture; all else waits until the call has returned. */
AG_API const ag_film *ag_rendering_film(const ag_rendering *rendering);
/* Ends the rendering, counts what was done, and hands its film over; out_film NULL: destroys that too. rendering NULL
 * is fine. */
AG_API void ag_rendering_finish(ag_rendering *rendering, ag_film **out_film);

/* The pixels rendered (the crop), linear RGB of the working space, top row first, 3 floats a pixel. The film's. */
AG_API const float *ag_film_pixels(const ag_film *film, int *out_width, int *out_height);
/* Of the working space: red, green, blue, white, each x and y, as EXR files have them. */
AG_API void ag_film_chromaticities(const ag_film *film, float out_chromaticities[8]);

/* The channels of picture and layers, by the names that they have in a file; R, G and B are the first three. */
AG_API int ag_film_channel_count(const ag_film *film);
AG_API const char *ag_film_channel_name(const ag_film *film, int channel); /* the film's; NULL: there is none */
/* Width * height values, top row first. Errors: AG_ERROR_ARGUMENT. */
AG_API ag_status ag_film_read_channel(const ag_film *film, int channel, float *out_values);

/* A picture can be watched while it is rendered: from ag_rendering_film on, and for as long as the film is there, any
 * thread may call the three functions below at any time, callbacks too. They copy the developed picture, R, G and B as
 * ag_film_pixels has them, tile by tile: each tile as it was when it was finished last, in this pass over the picture
 * or the one before. In the beginning it is black. None of them waits for longer than a tile takes to be copied, but
 * while the film is denoised. */
#define AG_TILE_SIZE 32
/* A part of the picture: AG_TILE_SIZE pixels wide and high, or less at its right and lower edges. */
typedef struct ag_tile {
    int x, y; /* of its upper left pixel, from the upper left of the pixels rendered */
    int width, height;
    uint64_t version; /* higher with each change of any tile; 0: never shown, and black */
} ag_tile;
/* Tiles are numbered row by row from the upper left. */
AG_API size_t ag_film_tile_count(const ag_film *film);
/* Copies the tile of that number if it has changed since a version, else gives false and writes nothing. out_pixels:
 * room for 3 * AG_TILE_SIZE * AG_TILE_SIZE floats; width * height pixels are written, rows without gaps. */
AG_API bool ag_film_read_tile(const ag_film *film, size_t tile, uint64_t since_version, ag_tile *out_tile,
                              float *out_pixels);
/* Brings a copy of the whole picture up to date: writes the tiles that have changed since a version, 0 for all that
 * have been shown, and gives the version that the copy then has. out_pixels: as large as ag_film_pixels, the
 * caller's. */
AG_API uint64_t ag_film_read_picture(const ag_film *film, uint64_t since_version, float *out_pixels);

/* Takes the noise out of R, G and B with Open Image Denoise, which is looked for when this is called; with albedo and
 * normals where the settings said denoise. The other channels stay, so the parts of light no longer add up. Errors:
 * AG_ERROR_SYSTEM (no such library), AG_ERROR_MEMORY. */
AG_API ag_status ag_film_denoise(ag_context *context, ag_film *film);
/* Whether the library is there. To be asked before a long render. Errors: AG_ERROR_SYSTEM. */
AG_API ag_status ag_denoise_check(ag_context *context);

/* --- files --- */

typedef enum ag_sample_type {
    AG_SAMPLE_DEFAULT,
    AG_SAMPLE_UINT8,
    AG_SAMPLE_UINT16,
    AG_SAMPLE_HALF,
    AG_SAMPLE_FLOAT
} ag_sample_type;

typedef struct ag_output_settings {
    ag_sample_type type;      /* default: half for EXR, float for Radiance and PFM, 16 bit for TIFF, 8 bit for others */
    bool tiled;               /* EXR in tiles of 64 x 64 pixels; default: in lines */
    bool reproducible;        /* EXR without what differs from run to run: equal pictures are equal files */
    const char *command_line; /* to be noted in EXR files, or NULL */
    const char *color_space;  /* of EXR, Radiance and PFM files, by the config's name, an alias or a role; NULL: the
                                 working space */
    /* of all others: */
    const char *display;  /* NULL: the config's default */
    const char *view;     /* NULL: the display's default */
    const char *look;     /* instead of the view's own: names with commas between them, undone with a - before it;
                             "none": none; NULL: the view's own */
    float exposure_stops; /* light is multiplied by 2 to this before the view; default 0 */
} ag_output_settings;

AG_API ag_output_settings ag_default_output_settings(void);

/* Whether a file of that name could be written with these settings: the extension is known, the folder there, the
 * colour config and what is asked of it usable. To be asked before a long render. Errors: AG_ERROR_ARGUMENT (extension
 * or type), AG_ERROR_OUTPUT, AG_ERROR_COLOR. */
AG_API ag_status ag_output_check(ag_context *context, const ag_output_settings *settings, const char *path);

/* Writes the film: scene-linear, with its layers and chromaticities, for .exr; scene-linear for .hdr (which clips what
 * is below 0) and .pfm, which cannot say their colour space; through look, display and view for .png, .tif, .jpg. The
 * file appears complete or not at all. settings NULL: the defaults. */
AG_API ag_status ag_film_write(ag_context *context, const ag_film *film, const ag_output_settings *settings,
                               const char *path);

/* From now on no context waits for the reader of a FIFO, or of standard output, that it writes to: such a write fails
 * where the reader is not ready. For the handler of a signal that is to end the process in order: safe in it. */
AG_API void ag_end_waits(void);

/* Removes the temporary files of writes under way, in any context. For the handler of a signal that ends the process at
 * once: safe in it. */
AG_API void ag_abandon_files(void);

/* --- what is to be expected --- */

/* The memory and time that a picture is expected to take. */
typedef struct ag_prediction {
    /* of memory, bytes; without what --denoise takes */
    uint64_t memory_peak_bytes;   /* of the whole process, resident; no less than it has had already */
    uint64_t memory_needed_bytes; /* the most that is there at once of what follows */
    uint64_t memory_scene_bytes;  /* what the process has now: the program and the scene */
    uint64_t memory_photon_bytes; /* photon maps */
    uint64_t memory_thread_bytes; /* of all threads */
    uint64_t memory_film_bytes;
    uint64_t memory_file_bytes; /* a picture on its way to a file; maps and threads' memory are given back before */
    /* of time: on this machine, were it idle; 0: not predicted */
    double time_s[AG_PHASE_COUNT];
    double time_total_s;      /* since the context was created */
    double cpu_s;             /* of all threads */
    double samples_per_pixel; /* that it takes on average */
} ag_prediction;

/* The memory alone, without any work. To be asked before ag_render. Errors: as ag_render. */
AG_API ag_status ag_predict_memory(ag_context *context, const ag_scene *scene, const ag_render_settings *settings,
                                   ag_prediction *out_prediction);
/* Time and memory; for the time photons are traced, a million into each map at most, and a part of the picture's blocks
 * of 8 x 8 pixels is rendered: a half of small pictures, some hundred blocks of large ones. A photon map's file is left
 * alone. Errors: as ag_render. */
AG_API ag_status ag_predict(ag_context *context, const ag_scene *scene, const ag_render_settings *settings,
                            ag_prediction *out_prediction);

/* --- what was done --- */

/* Where a picture's photon map came from. */
typedef enum ag_map_file {
    AG_MAP_FILE_NONE,   /* traced, and not kept */
    AG_MAP_FILE_TRACED, /* traced, and kept */
    AG_MAP_FILE_OPENED, /* from the file, and filled further */
    AG_MAP_FILE_PRIVATE /* from a file that could not be shared: a copy, which is not kept */
} ag_map_file;

/* Why a picture ended, so that a farm knows what to do with it. */
typedef enum ag_end {
    AG_END_NONE,       /* not known */
    AG_END_SAMPLES,    /* pixels have had all samples that the settings allow */
    AG_END_NOISE,      /* the noise that was asked for was reached before that, everywhere */
    AG_END_PHOTONS,    /* only the photon map was wanted */
    AG_END_TIME_LIMIT, /* the time was up */
    AG_END_SIGNAL,     /* it was interrupted */
    AG_END_MEMORY,     /* it needs more memory than there is, or than it may have */
    AG_END_DRY_RUN     /* it was only predicted */
} ag_end;

typedef struct ag_statistics {
    unsigned threads;
    uint64_t photons_emitted, photons_stored_global, photons_stored_caustic, photon_bytes;
    ag_map_file map_file; /* of the last picture */
    /* requests: points asked for; computed: estimates at photons; distinct: photons found ready afterwards that were
     * not before, counted by looking; deferred: set aside because another thread was computing; waited: had to wait in
     * the end; duplicated: computed twice, 0; uncached: estimates at hits themselves; refused:
     * requests for points where no estimate holds, whose light was followed by further bounces instead; ready: photons
     * of a map from a file that were ready when it was opened; reclaimed: claims taken over from other processes that
     * had died. Where other processes fill the map too, distinct counts what they computed as well. */
    uint64_t irradiance_requests, irradiance_computed, irradiance_distinct, irradiance_deferred, irradiance_waited,
        irradiance_duplicated, irradiance_uncached, irradiance_refused, irradiance_ready, irradiance_reclaimed;
    double irradiance_estimate_s; /* CPU seconds spent in estimates, all threads; from a sixteenth of them */
    double irradiance_wait_s;     /* CPU seconds spent in waiting for other threads' estimates, all threads */
    /* estimate: cast by estimates and lookups in the photon maps, to find where surfaces end and which photons are in
     * sight */
    uint64_t rays_camera, rays_shadow, rays_gather, rays_photon, rays_path, rays_estimate;
    uint64_t samples_not_finite; /* camera samples dropped because they were not numbers: 0 */
    double time_s[AG_PHASE_COUNT];
    double phase_cpu_s[AG_PHASE_COUNT]; /* user + system of the whole process meanwhile */
    double time_total_s;                /* since the context was created */
    double cpu_s;                       /* user + system of the whole process */
    uint64_t memory_peak_bytes;
    /* Of the scene loaded last: pictures of textures held whole, with what their coarser levels take, and the most that
     * tiles of the others took; their temporary file, and how many tiles were read from it. */
    uint64_t texture_whole_bytes, texture_tile_bytes, texture_file_bytes, texture_tiles_read;
    ag_end end;               /* of the last picture, as noted by ag_context_note_end */
    ag_sample_counts samples; /* of the pixels of the last picture */
    double noise;             /* of the last picture, as in ag_noise; below 0: not known */
    ag_prediction prediction; /* the last one; memory_peak_bytes is 0 where none was made */
} ag_statistics;

AG_API ag_statistics ag_context_statistics(const ag_context *context);
/* To be called when a rendering is finished, by who ended it; for the statistics. */
AG_API void ag_context_note_end(ag_context *context, ag_end end);

/* Whether statistics could be written there. To be asked before a long render. */
AG_API ag_status ag_statistics_check(ag_context *context, const char *path);

/* The statistics as JSON, with the settings of the last ag_render; written atomically. */
AG_API ag_status ag_statistics_write(ag_context *context, const char *path);

#ifdef __cplusplus
}
#endif
#endif
