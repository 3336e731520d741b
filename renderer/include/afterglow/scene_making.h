/* scene_making.h: builds scenes in memory, call by call, and sets the camera of any scene.
 * Part of afterglow.h, which tells about threads and errors. */
#ifndef AFTERGLOW_PUBLIC_SCENE_MAKING_H
#define AFTERGLOW_PUBLIC_SCENE_MAKING_H

#include "afterglow/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A scene is built by calls:
 *
 *     ag_scene_create -> ag_scene_set_..., ag_scene_add_... -> ag_scene_commit -> ag_render -> ag_scene_set_camera, ...
 *
 * Each call is a directive of pbrt-v4's text format (pbrt.org/fileformat-v4), with its types, parameters, units,
 * defaults and limits, and is processed as a directive of a file is: the picture has the bits of a file with the same
 * directives in the same order. Arguments are copied before the call returns, except borrowed arrays (ag_shape).
 * Threads: the scene belongs to its context's thread. Errors of all calls: AG_ERROR_ARGUMENT (a required argument is
 * NULL, a number is not finite, an array does not have the parameter's type, a struct has another size than the
 * library's, the scene is committed), AG_ERROR_SCENE (the directive is not valid), AG_ERROR_INPUT (a file that a
 * parameter names cannot be read), AG_ERROR_COLOR, AG_ERROR_MEMORY, AG_CANCELLED. The log names the function, the
 * number of the call for this scene and the number of the wrong parameter, both from 1 on (0: none), and on a second
 * line the object that was to be made:
 *
 *     ag_scene_add_shape:17:2: error: index 9 (value 3 of "indices") is out of range, there are 4 vertices
 *         Shape "trianglemesh" of material "red"
 *
 * A call that fails has no effect; objects made before it stay, and further calls may follow. */

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
    size_t count; /* number of elements of the array: three floats for each point3, ... */
    /* One array of [count] elements, the others NULL: integers for AG_PARAMETER_INTEGER, bools for AG_PARAMETER_BOOL,
     * strings for strings and names, floats or doubles for all other types. */
    const float *floats;
    const double *doubles;
    const int32_t *integers;
    const char *const *strings;
    const bool *bools;
} ag_parameter;

/* Creates an empty scene, which the caller owns. Until ag_scene_commit it can only be added to and destroyed. settings:
 * as for ag_scene_load_as, but without definitions; they are copied; NULL: the defaults.
 *
 * The settings take effect at the commit. The last camera set before it then determines the directions of sun and sky
 * (the axis of AG_UP_AUTO, and whether the world is left-handed), after which the camera of has_camera replaces it. A
 * camera that is set after the commit replaces either, and moves neither sun nor sky. A host that uses sun or sky
 * should therefore set a camera of its own convention before the commit too. */
AG_API ag_status ag_scene_create(ag_context *context, const ag_scene_settings *settings, ag_scene **out_scene);
/* Completes the scene and builds the acceleration structures for its rays. Afterwards only the camera can be changed,
 * as in a scene from a file, unless the settings have is_editable (scene_editing.h). After an error the scene can only
 * be destroyed. Errors: those of all calls; AG_ERROR_RAY_TRACING. */
AG_API ag_status ag_scene_commit(ag_scene *scene);

/* Add a named material or medium. Names must be unique among materials, among media, and among textures of one kind of
 * value. Materials and media may be referred to before they are added, textures only afterwards. type: "diffuse",
 * "homogeneous", ... */
AG_API ag_status ag_scene_add_material(ag_scene *scene, const char *name, const char *type,
                                       const ag_parameter *parameters, size_t parameter_count);
AG_API ag_status ag_scene_add_medium(ag_scene *scene, const char *name, const char *type,
                                     const ag_parameter *parameters, size_t parameter_count);

/* Sets one of the scene's hints about its picture, from which ag_render_settings_from_scene reads; the last call for a
 * hint counts. type: "rgb", "independent", "photonmap", "gaussian", ... */
typedef enum ag_scene_hint { AG_HINT_FILM, AG_HINT_SAMPLER, AG_HINT_INTEGRATOR, AG_HINT_PIXEL_FILTER } ag_scene_hint;
AG_API ag_status ag_scene_set_hint(ag_scene *scene, ag_scene_hint hint, const char *type,
                                   const ag_parameter *parameters, size_t parameter_count);

/* The following structs are initialised by ag_default_...(). Matrices have 16 numbers, row by row, and multiply column
 * vectors: the last column is the translation, the last row is 0 0 0 1. A matrix holds at the opening of the shutter
 * (pbrt's time 0); for objects that move, a second one holds at its closing (time 1). Between the two, translation is
 * linear and rotation uniform, as in pbrt. Shapes and instances may have more, for evenly spaced times: end_count
 * matrices stand one after the other at the end's address, of which the last holds at the closing. Rotation takes the
 * shorter way round from each matrix to the next, and at half a turn either: so a wheel that makes a whole turn needs
 * more than two steps, such as three of 120 degrees. Motion is traced in at most 128 steps, in each of which all points
 * go straight: where end_count allows for it, there are several from one matrix to the next, to keep rotation uniform;
 * from 65 ends on there is one, and what turns by 30 degrees in it is smaller by 3.4 % half way. The vertices of meshes
 * may move as well: see ag_shape. */

/* A picture in memory, which replaces the file of its name in each "string filename" of textures and lights added
 * later: packed, top row first; grey, grey and alpha, RGB, or RGB and alpha. One of bytes and floats is set, the other
 * NULL. */
typedef struct ag_image {
    size_t struct_size;
    int width, height;          /* pixels; at most 2^28 in all */
    int channel_count;          /* 1 to 4; default 3 */
    const unsigned char *bytes; /* as in a file of 8 bits: sRGB unless the texture's "encoding" differs */
    const float *floats;        /* as in an EXR file: linear */
} ag_image;
AG_DEFAULT_STRUCT(image, AG_STRUCT_IMAGE)
AG_API ag_status ag_scene_add_image(ag_scene *scene, const char *name, const ag_image *image);

typedef enum ag_texture_value { AG_TEXTURE_FLOAT, AG_TEXTURE_SPECTRUM } ag_texture_value;
typedef struct ag_texture {
    size_t struct_size;
    const char *name;
    ag_texture_value value; /* a number or a colour; default AG_TEXTURE_SPECTRUM */
    const char *type;       /* "imagemap", "scale", "checkerboard", ... */
    const ag_parameter *parameters;
    size_t parameter_count;
    const double *world_from_texture; /* of textures in space; NULL, the default: the identity */
} ag_texture;
AG_DEFAULT_STRUCT(texture, AG_STRUCT_TEXTURE)
AG_API ag_status ag_scene_add_texture(ag_scene *scene, const ag_texture *texture);

/* Identifies a shape, a light or an instance of a scene, for scene_editing.h. Handles are unique within a process and
 * are never used again; 0 is none. out_handle of the functions below may be NULL. */
typedef uint64_t ag_handle;

/* A shape. A "trianglemesh" or "loopsubdiv" whose vertices move while the shutter is open, and a "curve" whose points
 * move that is no "ribbon", has a parameter that pbrt does not know, "integer motionsteps", from 1 to 129: so many sets
 * of vertices stand one after the other in "P" (of 3 * motionsteps * vertices numbers), and likewise in "N" and "S"
 * where they are there; "uv", "indices" and widths are those of one set. The sets are for evenly spaced times from the
 * opening of the shutter to its closing, whatever the camera's shutter is, and vertices go straight from one to the
 * next. 1 is a mesh at rest. Errors: AG_ERROR_SCENE (another number of steps, no multiple of it in "P", another type of
 * shape).
 *
 * Such a shape may move by matrices too, and be part of an object. A light (is_light) stands still as it does at the
 * opening, which a warning says. The photon map has the mean over the shutter of the light on each point, kept where
 * the point is at the opening: a triangle that has no area then gets no indirect light from the map, which a warning
 * says. A pane of glass that bends is traced as any glass. */
typedef struct ag_shape {
    size_t struct_size;
    const char *type; /* "trianglemesh", "sphere", "curve", ... */
    const ag_parameter *parameters;
    size_t parameter_count;
    const char *material; /* NULL, the default: diffuse, grey */
    const char *object;   /* name of the object that it is part of, which is created by its first shape and is visible
                             by its instances; NULL, the default: the shape is in the world itself */
    const double *world_from_shape;     /* to object space for shapes of objects; NULL, the default: the identity */
    const double *world_from_shape_end; /* NULL, the default: it does not move */
    size_t end_count;                   /* matrices at world_from_shape_end, 1 to 128; default 1 */
    bool reverse_orientation;           /* default false */
    bool is_light;                      /* it is an area light, with the parameters of AreaLightSource; default false */
    const ag_parameter *light_parameters;
    size_t light_parameter_count;
    const char *medium_inside, *medium_outside; /* NULL, the default: none */
    /* The library uses the arrays of a "trianglemesh" in place instead of copying them: "P" (of all motion steps) and
     * "uv", as floats, and "indices". They must stay valid and unchanged until the scene is destroyed, or committed
     * after this shape was changed or removed; and until renderings that still borrow the scene are finished. They are
     * aligned to 4 bytes, and 4 bytes behind P are readable. Renderings and commits look whether they can be read, and
     * begin and end as they did, and are AG_ERROR_ARGUMENT where not: so most arrays that were freed are found, but not
     * those whose memory nobody has written to since. Changes are made by ag_scene_change_shape, best with other
     * arrays: see scene_editing.h on commits that fail. Arrays that cannot be used in place are copied: P where the
     * shape has a matrix and does not move, or where a coordinate is -0; indices where a triangle has no area. Default
     * false. */
    bool borrows_arrays;
} ag_shape;
AG_DEFAULT_STRUCT(shape, AG_STRUCT_SHAPE)
AG_API ag_status ag_scene_add_shape(ag_scene *scene, const ag_shape *shape, ag_handle *out_handle);

/* An instance of an object, which must have a shape by then. Its first instance completes the object: no shape can be
 * added to it afterwards. */
typedef struct ag_instance {
    size_t struct_size;
    const char *object;
    const double *world_from_object;     /* NULL, the default: the identity */
    const double *world_from_object_end; /* NULL, the default: it does not move */
    size_t end_count;                    /* matrices at world_from_object_end, 1 to 128; default 1 */
} ag_instance;
AG_DEFAULT_STRUCT(instance, AG_STRUCT_INSTANCE)
AG_API ag_status ag_scene_add_instance(ag_scene *scene, const ag_instance *instance, ag_handle *out_handle);

typedef struct ag_light {
    size_t struct_size;
    const char *type; /* "point", "spot", "distant", "infinite", ... */
    const ag_parameter *parameters;
    size_t parameter_count;
    const double *world_from_light; /* NULL, the default: the identity */
    const char *medium_outside;     /* NULL, the default: none */
} ag_light;
AG_DEFAULT_STRUCT(light, AG_STRUCT_LIGHT)
AG_API ag_status ag_scene_add_light(ag_scene *scene, const ag_light *light, ag_handle *out_handle);

/* Sets the camera; the last one counts, except as ag_scene_create says of has_camera. It must be set before anything
 * that moves is added. The camera of a complete scene, also of one from a file, may be changed while no rendering
 * borrows the scene: nothing is rebuilt, and a kept photon map (photon_map_file) remains valid. Its medium cannot be
 * changed then (medium must be NULL), nor its shutter where anything moves. */
typedef struct ag_camera {
    size_t struct_size;
    const char *type; /* default "perspective" */
    const ag_parameter *parameters;
    size_t parameter_count;
    const double *world_from_camera; /* as pbrt's: it looks along +z, x is to the right and y up. NULL, the default: as
                                        it is */
    const double *world_from_camera_end; /* NULL, the default: it does not move */
    const char *medium;                  /* the medium around it; NULL, the default: none */
} ag_camera;
AG_DEFAULT_STRUCT(camera, AG_STRUCT_CAMERA)
AG_API ag_status ag_scene_set_camera(ag_scene *scene, const ag_camera *camera);

#ifdef __cplusplus
}
#endif
#endif
