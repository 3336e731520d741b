/* scene_making.h: scenes that calls put together in memory, and the camera of any scene.
 * Part of afterglow.h, which tells about threads and errors. */
#ifndef AFTERGLOW_PUBLIC_SCENE_MAKING_H
#define AFTERGLOW_PUBLIC_SCENE_MAKING_H

#include "afterglow/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A scene that calls put together:
 *
 *     ag_scene_create -> ag_scene_set_..., ag_scene_add_... -> ag_scene_commit -> ag_render -> ag_scene_set_camera, ...
 *
 * Each call is a directive of pbrt-v4's text (pbrt.org/fileformat-v4), whose types, parameters, units, defaults and
 * limits it has, and goes the way of a file's directive: the picture has the bits of a file that says the same in the
 * same order. What is handed over is copied before the call returns, but for borrowed arrays (ag_shape).
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
/* Completes the scene and builds what rays need; it is then as one from a file, of which the camera alone can change,
 * but where is_editable of the settings says more (scene_editing.h). After an error it can only be destroyed. Errors
 * also: AG_ERROR_RAY_TRACING. */
AG_API ag_status ag_scene_commit(ag_scene *scene);

/* Each name of a material, a medium and a kind of texture is made once. Materials and media may be used before they are
 * made, textures only afterwards. type: "diffuse", "homogeneous", ... */
AG_API ag_status ag_scene_add_material(ag_scene *scene, const char *name, const char *type,
                                       const ag_parameter *parameters, size_t parameter_count);
AG_API ag_status ag_scene_add_medium(ag_scene *scene, const char *name, const char *type,
                                     const ag_parameter *parameters, size_t parameter_count);

/* Tells what the scene says of its picture; the last of each counts. type: "rgb", "independent", "photonmap",
 * "gaussian", ... */
typedef enum ag_scene_hint { AG_HINT_FILM, AG_HINT_SAMPLER, AG_HINT_INTEGRATOR, AG_HINT_PIXEL_FILTER } ag_scene_hint;
AG_API ag_status ag_scene_set_hint(ag_scene *scene, ag_scene_hint hint, const char *type,
                                   const ag_parameter *parameters, size_t parameter_count);

/* The structs that follow are filled by ag_default_...() as settings are. Matrices have 16 numbers, row by row, of
 * column vectors: the last column is where the origin goes, the last row is 0 0 0 1. Each is given when the shutter
 * opens (pbrt's time 0), and where something moves when it closes (time 1): two times and no more, as in pbrt's format,
 * between which it goes straight and turns evenly. A shape keeps its form meanwhile: arrays at several times, of a mesh
 * that bends, are not supported, and a way with more corners is a mean of pictures with shutters of their own. */

/* A picture in memory, which stands in for the file of that name in every "string filename" of textures and lights from
 * then on: packed, top row first; grey, grey and alpha, RGB, or RGB and alpha. */
typedef struct ag_image {
    size_t struct_size;
    int width, height;          /* pixels; at most 2^28 in all */
    int channel_count;          /* 1 to 4; default 3 */
    const unsigned char *bytes; /* as the values of a file of 8 bits: sRGB where no "encoding" says otherwise; or */
    const float *floats;        /* as those of an EXR file, linear */
} ag_image;
AG_DEFAULT_STRUCT(image, AG_STRUCT_IMAGE)
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
AG_DEFAULT_STRUCT(texture, AG_STRUCT_TEXTURE)
AG_API ag_status ag_scene_add_texture(ag_scene *scene, const ag_texture *texture);

/* A shape, a light or an instance of a scene, for the functions that change it. No two of them are the same in the life
 * of a process, nor is one used again; 0 is none. Calls that make one write it where out_handle is not NULL. */
typedef uint64_t ag_handle;

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
    /* Of a "trianglemesh" the arrays of "P" and "uv", which are then floats, and "indices" are used where they are, and
     * written by nobody, until the scene is destroyed, or committed without this shape as it was said here; of a scene
     * that renderings keep, until they are finished. They begin at multiples of 4 bytes, and behind P 4 more bytes must
     * be readable. What changes in them must be said by ag_scene_change_shape, best with other arrays: see
     * scene_editing.h of commits that fail. As far as they cannot be used so they are copied: P where the shape has a
     * matrix and stands still, or a coordinate is -0; indices where a triangle has no area. Default false: all is
     * copied. */
    bool borrows_arrays;
} ag_shape;
AG_DEFAULT_STRUCT(shape, AG_STRUCT_SHAPE)
AG_API ag_status ag_scene_add_shape(ag_scene *scene, const ag_shape *shape, ag_handle *out_handle);

/* An object has at least one shape when its first instance is made, and is complete with that: nothing can be added to
 * it afterwards. */
typedef struct ag_instance {
    size_t struct_size;
    const char *object;
    const double *world_from_object;     /* NULL, the default: as it is */
    const double *world_from_object_end; /* NULL, the default: it does not move */
} ag_instance;
AG_DEFAULT_STRUCT(instance, AG_STRUCT_INSTANCE)
AG_API ag_status ag_scene_add_instance(ag_scene *scene, const ag_instance *instance, ag_handle *out_handle);

typedef struct ag_light {
    size_t struct_size;
    const char *type; /* "point", "spot", "distant", "infinite", ... */
    const ag_parameter *parameters;
    size_t parameter_count;
    const double *world_from_light; /* NULL, the default: as it is */
    const char *medium_outside;     /* NULL, the default: none */
} ag_light;
AG_DEFAULT_STRUCT(light, AG_STRUCT_LIGHT)
AG_API ag_status ag_scene_add_light(ag_scene *scene, const ag_light *light, ag_handle *out_handle);

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
AG_DEFAULT_STRUCT(camera, AG_STRUCT_CAMERA)
AG_API ag_status ag_scene_set_camera(ag_scene *scene, const ag_camera *camera);

#ifdef __cplusplus
}
#endif
#endif
