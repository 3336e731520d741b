/* pbrt_private.h: what the files of the pbrt-v4 reader share: the stack of files, the graphics state, and the
 * interpreters of directives.
 * Rests on the format's description, pbrt.org/fileformat-v4. Names and defaults are pbrt-v4's.
 * Flow: pbrt_parser dispatches directives; pbrt_files gives tokens; pbrt_parameters reads parameter lists;
 * pbrt_transforms, pbrt_objects, pbrt_shapes, pbrt_textures, pbrt_materials, pbrt_lights, pbrt_camera, ... interpret.
 * Threads: one per scene. */
#ifndef AFTERGLOW_PBRT_PRIVATE_H
#define AFTERGLOW_PBRT_PRIVATE_H

#include "color/color_space.h"
#include "image/image.h"
#include "math/motion.h"
#include "pbrt/parameter_list.h"
#include "pbrt/pbrt_builder.h"
#include "pbrt/pbrt_lexer.h"
#include "scene.h"
#include "status.h"
#include "text/input_file.h"
#include "text/name_table.h"
#include "text/text_file.h"

/* World coordinates beyond this would overflow a float when squared. */
#define PBRT_MAX_COORDINATE 1e18f

#define PBRT_NO_MEDIUM SIZE_MAX

enum { PBRT_MAX_DEPTH = 32 };        /* of files that include one another */
enum { PBRT_MAX_PARAMETERS = 1000 }; /* of one directive, and of its attributes */
/* Files that include others twice multiply, so the number of files read is limited, and their text by
 * text_file_max_bytes. */
enum { PBRT_MAX_INCLUDES = 100000 };

/* The two ends of a current transform that has been given a name. */
typedef struct pbrt_named_transform {
    transform start, end;
} pbrt_named_transform;

/* The value that stands instead of $name. */
typedef struct pbrt_value {
    char *text;       /* owned; the last token may lie in it */
    pbrt_lexer lexer; /* of a value that stands without quotes: tokens of its own, which come first */
    bool has_tokens;
    file_location where; /* of $name, and how wide that is */
    size_t width;
} pbrt_value;

typedef struct pbrt_file {
    text_file file;
    pbrt_lexer lexer;
    pbrt_value value;
    file_location included_at; /* the Include or Import; zeroed for the first file */

    bool is_import; /* its end is told to who reads, who then ends it; the rest is for what it found: */
    pbrt_named_transform *coordinate_systems;
    size_t coordinate_system_count;
    name_table coordinate_system_names;
} pbrt_file;

/* The kinds of things for which Attribute sets parameters. */
typedef enum pbrt_target {
    PBRT_TARGET_SHAPE,
    PBRT_TARGET_LIGHT,
    PBRT_TARGET_MATERIAL,
    PBRT_TARGET_MEDIUM,
    PBRT_TARGET_TEXTURE,
    PBRT_TARGET_COUNT
} pbrt_target;

/* One parameter of an Attribute. The parser owns all. */
typedef struct pbrt_attribute {
    parameter item;
    size_t block;                        /* so many blocks were open around it */
    struct pbrt_attribute *outside;      /* that of its name which was in force before the block, or NULL */
    struct pbrt_attribute *older_of_all; /* for the owner */
    bool is_used;                        /* by any directive that followed */
    const char *target;                  /* "shape", ... */
} pbrt_attribute;

/* The attributes of one target that are in force. There is one of each name, so that a directive's work does not grow
 * with the Attribute lines before it. */
typedef struct pbrt_attributes {
    pbrt_attribute *in_force[PBRT_MAX_PARAMETERS];
    size_t count;
} pbrt_attributes;

/* AreaLightSource: what the shapes that follow emit. */
typedef struct pbrt_area_light {
    bool is_set;
    rgb radiance; /* "L" times "scale" */
    float power;  /* W, as pbrt's "power": above 0 the radiance is multiplied until a lamp of radiance 1 has it */
    bool two_sided;
    float photons;
    uint32_t group;            /* of light.group */
    uint32_t radiance_texture; /* of its picture, or SCENE_NO_TEXTURE */
    double mean_luminance;     /* of that picture; else 1 */
    file_location where;
} pbrt_area_light;

/* The state that AttributeBegin saves and AttributeEnd brings back. */
typedef struct pbrt_state {
    /* At the start and at the end of TransformTimes; before WorldBegin: camera_from_world. What does not move looks at
     * the start alone. */
    transform world_from_object, world_from_object_end;
    const transform *between; /* of calls alone: [between_count] at evenly spaced times between the two, borrowed */
    uint32_t between_count;
    bool start_is_active, end_is_active; /* whether directives change them; at least one is */
    bool is_flattened;                   /* by a transform that cannot be undone: what it would apply to is left out */
    bool reverse_orientation;
    uint32_t material_index;
    bool has_no_surface;                  /* the material is known to be "interface" */
    size_t medium_inside, medium_outside; /* MediumInterface: of pbrt_parser.named_media, or PBRT_NO_MEDIUM */
    pbrt_area_light area_light;
    color_space rgb_space; /* of rgb parameters */
} pbrt_state;

typedef struct pbrt_saved_state {
    pbrt_state state;
    file_location where; /* of the Begin */
    bool is_object;      /* ObjectBegin, not AttributeBegin */
    bool is_import;      /* Import: neither */
} pbrt_saved_state;

typedef struct pbrt_named_material {
    char *name;
    uint32_t index; /* in the scene; filled in when MakeNamedMaterial comes, which may be after its use */
    bool is_defined;
    bool is_excused;     /* only a call that failed has used it: it need not be made */
    file_location where; /* of its definition, or until then of its first use */
} pbrt_named_material;

typedef struct pbrt_named_medium {
    char *name;
    uint32_t index; /* in the scene, where it absorbs nothing until MakeNamedMedium comes, which may be after its use */
    bool is_defined,
        is_used;         /* is_used: by a shape or a light; of cameras the last one counts, see scene.camera_medium */
    file_location where; /* of its definition, or until then of the first MediumInterface that names it */
} pbrt_named_medium;

/* A shape that emits light within an object, to be added to the world. */
typedef struct pbrt_object_lamp {
    shape shape; /* its arrays are owned */
    pbrt_area_light light;
    file_location where;
} pbrt_object_lamp;

/* A shape that moves within an object: an object of its own, as Embree knows one level of instances only. */
typedef struct pbrt_object_part {
    uint32_t object_index;        /* the scene's */
    motion_path object_from_part; /* its segments are owned */
} pbrt_object_part;

typedef struct pbrt_object {
    char *name;
    uint32_t object_index; /* the scene's, of the shapes that stand still in it */
    bool is_defined;
    bool is_shown;       /* there is an instance of it */
    file_location where; /* of its ObjectBegin, or until then of its first ObjectInstance */
    pbrt_object_lamp *lamps;
    size_t lamp_count, lamp_capacity;
    pbrt_object_part *parts;
    size_t part_count, part_capacity;
} pbrt_object;

/* An ObjectInstance that came before its ObjectBegin. */
typedef struct pbrt_early_instance {
    uint32_t object; /* the parser's */
    transform start, end;
    file_location where;
} pbrt_early_instance;

/* A picture in memory, which stands in for the file of that name. */
typedef struct pbrt_picture {
    char *name;          /* owned */
    const image *pixels; /* borrowed */
    uint64_t version;    /* even; another one for other pixels */
} pbrt_picture;

/* The content of a call, which stands instead of text: the quoted strings behind the directive's name, and its
 * parameters. */
typedef struct pbrt_given {
    const char *const *strings; /* [string_count], borrowed */
    size_t string_count, next_string;
    parameter *items; /* [item_count]; the list takes what they hold, and leaves them zeroed */
    size_t item_count;
    file_location where;
    const char *label; /* of what is made, for messages */
} pbrt_given;

typedef struct pbrt_parser {
    run_context *run;
    log_sink *log;
    scene *scene;

    pbrt_file files[PBRT_MAX_DEPTH]; /* the innermost last */
    int file_count, include_count;
    size_t text_bytes;   /* of all files that have been included */
    char *top_directory; /* of the first file, with its slash, or "" */
    pbrt_token peeked;
    bool has_peeked;
    size_t told_bytes; /* of the first file, at the last progress */

    pbrt_given *given;                    /* borrowed; NULL: tokens come from the files */
    const struct pbrt_borrowed *borrowed; /* of the trianglemesh that is read next; NULL: nothing is */
    shape *made_mesh; /* borrowed: of the shape that is read next, whose arrays are not among its parameters; without
                         triangles: it was left out. NULL: all are */
    bool is_material_unknown; /* of the mesh that is read next, which becomes a made_mesh */
    pbrt_picture *pictures;
    size_t picture_count;
    parameter_source source;    /* of the lists that are read */
    pbrt_attribute *attributes; /* all there have been, the newest first */
    pbrt_attributes attributes_of[PBRT_TARGET_COUNT];

    parameter_list integrator, sampler, film, pixel_filter; /* the last of each; .name is NULL for none */

    double film_distance; /* m, from the lens of a realistic camera; 0: there is none */

    bool in_world;
    pbrt_state state;
    double transform_times[2]; /* s */
    pbrt_saved_state *saved;
    size_t saved_count, saved_capacity;
    pbrt_named_transform *coordinate_systems;
    size_t coordinate_system_count;
    name_table coordinate_system_names;
    pbrt_named_material *named_materials;
    size_t named_material_count;
    name_table material_names;
    pbrt_named_medium *named_media;
    size_t named_medium_count;
    name_table medium_names;
    pbrt_object *objects;
    size_t object_count, object_capacity;
    name_table object_names;
    pbrt_object *open_object;     /* between ObjectBegin and ObjectEnd, else NULL */
    uint32_t shapes_object_index; /* where pbrt_add_shape adds to: the scene's object, SCENE_NO_OBJECT for the world */
    /* The object that curves were last put into for a transform that moves or stretches them, with that transform and
     * the object around it: curves that follow join it. SCENE_NO_OBJECT: none yet. */
    uint32_t curves_object_index, curves_object_around;
    transform curves_start, curves_end, *curves_between; /* the last: [curves_between_count], owned */
    uint32_t curves_between_count;
    pbrt_early_instance *early_instances;
    size_t early_instance_count, early_instance_capacity;
    size_t lamp_copy_count, lamp_copy_vertex_count;         /* that instances have made */
    name_table float_texture_names, spectrum_texture_names; /* to indices of the scene's */
    float alpha;                                            /* of the shape being read */
    const char *shape_name;                                 /* of the shape that is read; NULL: none */
    uint32_t alpha_texture;                                 /* of the shape being read */
} pbrt_parser;

/* Every handler of a directive: where is the directive's location; its name has been read, nothing behind it. */
typedef ag_status pbrt_handler(pbrt_parser *parser, file_location where);

/* pbrt_parser.c: makes a parser; NULL when out of memory. */
pbrt_parser *pbrt_parser_create(run_context *run, scene *out_scene);
void pbrt_parser_destroy(pbrt_parser *parser);

/* pbrt_files.c: the stack of files and their tokens. The text of locations: parser->source. */
void pbrt_excerpt(const void *parser, file_location where, size_t width, char *out_text, size_t size);

/* Opens a file as the innermost. name is as the user wrote it, where the location of the Include (zeroed for none). */
ag_status pbrt_push_file(pbrt_parser *parser, const char *name, file_location where, size_t width);
ag_status pbrt_push_text(pbrt_parser *parser, const char *name, const char *text, size_t size);
void pbrt_pop_file(pbrt_parser *parser);
/* Returns the path of a file that the scene names: from the host's find_file; else, as in pbrt, below the first file's
 * directory; where that does not exist, below that of the file that names it. To be freed; NULL when out of memory. */
char *pbrt_find_file(const pbrt_parser *parser, const char *name);
/* Checks whether a picture may be read (input_file.h); where not, message has the reason and the path. Errors:
 * AG_ERROR_INPUT. */
ag_status pbrt_allow_picture(const pbrt_parser *parser, const char *path, char *message, size_t message_size);
/* Returns the picture in memory of a name; NULL: there is none. */
const pbrt_picture *pbrt_find_picture(const pbrt_parser *parser, const char *name);
/* Finds the version of the pixels that a name stands for, in memory or in a file that may be read; 0: it cannot be
 * told. Errors: AG_ERROR_MEMORY. */
ag_status pbrt_picture_version(const pbrt_parser *parser, const char *name, uint64_t *out_version);
/* Reads the next token; where an included file ends, the one that included it goes on. The end of an imported file is
 * told, as often as is asked, until it is popped. */
ag_status pbrt_next(pbrt_parser *parser, pbrt_token *out_token);
ag_status pbrt_peek(pbrt_parser *parser, pbrt_token *out_token);
/* Tells the error with the line it is in and a mark below; always returns AG_ERROR_SCENE. */
ag_status pbrt_error(pbrt_parser *parser, file_location where, size_t width, const char *format, ...) AG_PRINTF(4, 5);
/* Tells the error "DIRECTIVE expects WHAT, not TOKEN". */
ag_status pbrt_unexpected(pbrt_parser *parser, const pbrt_token *token, const char *directive, const char *expected);
/* Reads a quoted string, copied: *out_text is to be freed. Errors say "DIRECTIVE expects WHAT". */
ag_status pbrt_read_string(pbrt_parser *parser, const char *directive, const char *expected, char **out_text,
                           file_location *out_where);
ag_status pbrt_read_numbers(pbrt_parser *parser, const char *directive, size_t count, double *out_values);
/* Tells progress by the bytes of the first file; AG_CANCELLED when the run is cancelled. */
ag_status pbrt_tell_progress(pbrt_parser *parser);

/* pbrt_parameters.c: reads the parameters of "DIRECTIVE name parameters". On failure the list is reset. */
ag_status pbrt_read_parameters(pbrt_parser *parser, const char *directive, file_location where,
                               parameter_list *out_list);
/* Works as pbrt_read_parameters, for a directive that has a quoted name before its parameters. */
ag_status pbrt_read_named_parameters(pbrt_parser *parser, const char *directive, const char *expected,
                                     file_location where, parameter_list *out_list);

/* pbrt_colors.c */
pbrt_handler pbrt_color_space;
/* Makes rgb parameters the working space's and reads the files of spectra. width: of the quoted "type name". Errors:
 * AG_ERROR_SCENE, AG_ERROR_INPUT (a file cannot be read), AG_ERROR_MEMORY. */
ag_status pbrt_settle_color(pbrt_parser *parser, parameter *p, size_t width);
/* Reads a text file of nothing but numbers and comments, named at that location; hint ends the message where it cannot
 * be read. *out_numbers is to be freed. Errors: as above. */
ag_status pbrt_read_number_file(pbrt_parser *parser, const char *name, file_location where, size_t width,
                                const char *hint, double **out_numbers, size_t *out_count);

/* pbrt_old_parameters.c: translates what a list says in pbrt-v3's words into pbrt-v4's, for all but materials. Errors:
 * AG_ERROR_SCENE, AG_ERROR_MEMORY. */
ag_status pbrt_upgrade_parameters(pbrt_parser *parser, parameter_list *list);
/* Renames a parameter. Where both names are there, the new one's value holds. */
ag_status pbrt_rename_parameter(parameter_list *list, const char *from, const char *to);
/* Adds a parameter, unless the file has it. */
ag_status pbrt_add_string(parameter_list *list, const char *name, parameter_type type, const char *value);

/* pbrt_attributes.c */
pbrt_handler pbrt_attribute_directive;
/* Brings back, after a block has ended, the attributes that were in force before it. */
void pbrt_leave_attributes(pbrt_parser *parser);
/* Adds those in force for the list's directive, less those that it says itself. Errors: AG_ERROR_MEMORY. */
ag_status pbrt_append_attributes(pbrt_parser *parser, parameter_list *list);
/* Warns, at the end, of each attribute that no directive has used. */
void pbrt_warn_unused_attributes(const pbrt_parser *parser);
void pbrt_free_attributes(pbrt_parser *parser);

/* pbrt_options.c */
pbrt_handler pbrt_option;

/* Tells an error as pbrt_error does, at the parameter of that name, or where there is none at the directive. */
ag_status pbrt_refuse(pbrt_parser *parser, const parameter_list *list, const char *name, const char *format, ...)
    AG_PRINTF(4, 5);

/* pbrt_state.c: what Begin saves and End brings back. */
pbrt_handler pbrt_import, pbrt_world_begin, pbrt_world_end, pbrt_attribute_begin, pbrt_attribute_end,
    pbrt_transform_begin, pbrt_transform_end, pbrt_reverse_orientation;
ag_status pbrt_save_state(pbrt_parser *parser, file_location where, bool is_object, bool is_import);
ag_status pbrt_restore_state(pbrt_parser *parser, file_location where, const char *directive, bool is_object);
/* Tells an error where a Begin of the file that ends at that location has no End there. */
ag_status pbrt_check_blocks(pbrt_parser *parser, file_location end);
/* Ends an imported file: an open block is an error, else the state that the file began with is brought back, and the
 * file is popped. */
ag_status pbrt_end_import(pbrt_parser *parser, file_location end);

/* pbrt_objects.c: what is kept once, and where it is shown. */
pbrt_handler pbrt_object_begin, pbrt_object_end, pbrt_object_instance;
/* Opens the object of a name until pbrt_leave_object, also again after it was left, unless it has an instance. It is
 * defined when its caller says so. */
ag_status pbrt_enter_object(pbrt_parser *parser, const char *name, file_location where);
void pbrt_leave_object(pbrt_parser *parser);
/* Keeps a shape that shines within the open object. Takes its arrays, also on failure. */
ag_status pbrt_add_object_lamp(pbrt_parser *parser, shape *s, file_location where);
/* Shows a scene's object along the current transform as it moves: within the open object, or in the world. */
ag_status pbrt_show_moving_shape(pbrt_parser *parser, uint32_t object_index, file_location where);
/* Makes the instances that came early. It is an error where one is of an object that never came. */
ag_status pbrt_end_objects(pbrt_parser *parser);
void pbrt_reset_objects(pbrt_parser *parser);

/* pbrt_transforms.c */
pbrt_handler pbrt_identity, pbrt_translate, pbrt_scale, pbrt_rotate, pbrt_look_at, pbrt_transform,
    pbrt_concat_transform, pbrt_coordinate_system, pbrt_coord_sys_transform, pbrt_active_transform,
    pbrt_transform_times;
ag_status pbrt_name_coordinate_system(pbrt_parser *parser, const char *name, const transform *start,
                                      const transform *end);
/* Returns whether the current transform moves during the shutter, by its two ends. */
bool pbrt_is_moving(const pbrt_parser *parser);
/* Makes the motion from one transform to another in TransformTimes, seen through the camera's shutter. Errors as
 * motion_make's, at the directive. */
ag_status pbrt_make_motion(pbrt_parser *parser, const transform *start, const transform *end, file_location where,
                           const char *directive, motion *out_motion);
/* Makes the path of the current transform, from its start by way of state.between to its end. The caller frees the
 * path's segments. Errors: as pbrt_make_motion, and AG_ERROR_MEMORY. */
ag_status pbrt_make_path(pbrt_parser *parser, file_location where, const char *directive, motion_path *out_path);
/* Returns whether the current transform cannot be inverted, and then warns, once for each of what, that it is
 * left out. */
bool pbrt_is_flattened(pbrt_parser *parser, file_location where, const char *what);
/* Warns, once for each of what, that it does not move. */
void pbrt_warn_still(pbrt_parser *parser, file_location where, const char *what);

/* pbrt_materials.c */
pbrt_handler pbrt_material, pbrt_make_named_material, pbrt_use_named_material;
ag_status pbrt_add_default_material(pbrt_parser *parser);
/* Tells an error where a material was used and never made. */
ag_status pbrt_check_named_materials(pbrt_parser *parser);

/* pbrt_undo.c: how far a scene had come before a call, and the way back there when the call fails. */
typedef struct pbrt_mark {
    uint32_t shape_count, light_count, instance_count, instance_step_count, camera_medium;
    camera camera;
    bool has_camera;
    double film_distance;
    size_t lamp_copy_count, lamp_copy_vertex_count;
    size_t lamp_count, part_count; /* of the open object */
    size_t media[2];               /* of the graphics state, which the call must not change */
    bool are_media_used[2];
} pbrt_mark;
pbrt_mark pbrt_set_mark(const pbrt_parser *parser);
/* Drops shapes, lights, instances and the camera that were added since, with all that was noted of them. */
void pbrt_go_back(pbrt_parser *parser, const pbrt_mark *mark);

/* pbrt_media.c */
pbrt_handler pbrt_make_named_medium, pbrt_medium_interface;
/* Returns the scene's medium for one of the state's. */
uint32_t pbrt_medium_index(const pbrt_parser *parser, size_t named);
/* Works as pbrt_medium_index, for a medium that a shape or a light is in now, so that it has to be made. */
uint32_t pbrt_use_medium(pbrt_parser *parser, size_t named);
/* Tells an error where a medium was used and never made. */
ag_status pbrt_check_named_media(pbrt_parser *parser);

/* A kind of material by its name in a scene. read: reads its parameters into *m, which is made of its kind. */
typedef ag_status pbrt_material_reader(pbrt_parser *parser, parameter_list *list, material *m);
typedef struct pbrt_material_row {
    const char *name;
    material_kind kind;
    pbrt_material_reader *read;
} pbrt_material_row;

/* pbrt_material_kinds.c: returns the row of that name, or NULL. */
const pbrt_material_row *pbrt_material_row_of(const char *name);
/* Readers that are in files of their own: pbrt_materials.c, pbrt_principled.c. */
pbrt_material_reader pbrt_read_mix, pbrt_read_principled;
/* pbrt_material_kinds.c: "displacement" and "normalmap", of all kinds but mixes. */
pbrt_material_reader pbrt_read_maps;

/* pbrt_old_materials.c: where *type is one of pbrt-v3's names, makes it pbrt-v4's, and the list's parameters with
 * it. */
ag_status pbrt_upgrade_material(pbrt_parser *parser, parameter_list *list, const char **type);

/* pbrt_textures.c */
pbrt_handler pbrt_texture;
/* Loads the picture that the parameter names, and sets t->image_index. */
ag_status pbrt_load_image(pbrt_parser *parser, const parameter_list *list, const char *parameter_name,
                          const char *file_name, image_encoding encoding, texture *t);
/* Gets a parameter that may be a texture. *out_texture_index is the texture's, or SCENE_NO_TEXTURE; *out_constant is
 * written where the parameter is there and has the same value everywhere (a constant texture has), else left alone.
 * Errors: as of parameter_get_rgb and parameter_get_float, and where no such texture of the wanted type is there. */
ag_status pbrt_get_rgb_texture(pbrt_parser *parser, parameter_list *list, const char *name, rgb *out_constant,
                               uint32_t *out_texture_index);
ag_status pbrt_get_float_texture(pbrt_parser *parser, parameter_list *list, const char *name, float *out_constant,
                                 uint32_t *out_texture_index);

/* pbrt_lights.c */
pbrt_handler pbrt_light_source, pbrt_area_light_source;
/* Makes a shape of the world shine. */
ag_status pbrt_add_area_light(pbrt_parser *parser, const pbrt_area_light *source, uint32_t shape_index,
                              file_location where);

/* Make lights; each comes as light_make leaves it, and its pictures are the caller's. */
/* pbrt_environments.c: LightSource "infinite". */
ag_status pbrt_infinite_light(pbrt_parser *parser, parameter_list *list, light *out_light);
/* pbrt_light_pictures.c: LightSource "goniometric" and "projection". */
ag_status pbrt_goniometric_light(pbrt_parser *parser, parameter_list *list, light *out_light);
ag_status pbrt_projection_light(pbrt_parser *parser, parameter_list *list, light *out_light);
/* world_from_light: the axes of the current transform, or with swaps_yz the light's y and z along its z and y. What is
 * no rotation, reflection or scaling keeps the light's z axis, and x as far as it can. */
ag_status pbrt_set_light_frame(pbrt_parser *parser, const parameter_list *list, bool swaps_yz, frame *out_frame);
/* Warns where a LightSource sends only black. */
void pbrt_tell_dark_light(pbrt_parser *parser, const parameter_list *list, rgb emitted);
/* Reads the picture called name, "filename" of the list; its colours are averaged where is_gray. */
ag_status pbrt_read_environment(pbrt_parser *parser, const parameter_list *list, const char *name, bool is_gray,
                                struct environment **out_environment);

/* pbrt_camera.c */
pbrt_handler pbrt_camera;

/* pbrt_realistic.c: Camera "realistic"; and what is known of it when the Film is. */
ag_status pbrt_read_realistic(pbrt_parser *parser, parameter_list *list, camera *c);
ag_status pbrt_settle_realistic(pbrt_parser *parser);

/* pbrt_hints.c: Integrator, Sampler, Film and PixelFilter. */
pbrt_handler pbrt_integrator, pbrt_sampler, pbrt_film, pbrt_pixel_filter;
/* Fills scene.hints, once the last of these directives has been read. */
ag_status pbrt_settle_hints(pbrt_parser *parser);
void pbrt_reset_hints(pbrt_parser *parser); /* frees what is kept of them */
/* Gets an integer parameter from least to most; where it is absent the hint stays as it is. */
ag_status pbrt_get_integer_hint(pbrt_parser *parser, parameter_list *list, const char *name, int64_t least,
                                int64_t most, integer_hint *in_out_hint);

/* pbrt_film.c */
ag_status pbrt_settle_film(pbrt_parser *parser);
ag_status pbrt_settle_pixel_filter(pbrt_parser *parser);

/* pbrt_shapes.c */
pbrt_handler pbrt_shape;
/* Adds the shape with the current material and area light. A mesh's arrays pass to the scene, also on failure. */
ag_status pbrt_add_shape(pbrt_parser *parser, const parameter_list *list, shape *s);

/* pbrt_curves.c: Shape "curve". The current transform keeps angles. */
ag_status pbrt_curve(pbrt_parser *parser, parameter_list *list);

/* pbrt_meshes.c, pbrt_patches.c, pbrt_ply.c, pbrt_subdivision.c: Shape "trianglemesh", "bilinearmesh", "plymesh" and
 * "loopsubdiv". */
ag_status pbrt_triangle_mesh(pbrt_parser *parser, parameter_list *list);
ag_status pbrt_bilinear_mesh(pbrt_parser *parser, parameter_list *list);
ag_status pbrt_ply_mesh(pbrt_parser *parser, parameter_list *list);
ag_status pbrt_loop_subdivision(pbrt_parser *parser, parameter_list *list);

#endif
