/* gltf_private.h: what the gltf_*.c files share, and nobody else.
 * Flow: gltf_reader -> gltf_document (file to JSON) -> gltf_nodes -> gltf_instances, gltf_cameras, gltf_lights, each by
 * way of gltf_json (values with their paths); gltf_meshes -> gltf_vertices, gltf_triangles -> gltf_accessors ->
 * gltf_buffers; gltf_meshes -> gltf_materials -> gltf_textures -> gltf_images. Threads: one per scene. */
#ifndef AFTERGLOW_GLTF_PRIVATE_H
#define AFTERGLOW_GLTF_PRIVATE_H

#include "scene.h"
#include "status.h"

#include <jansson.h>

#define GLTF_NONE UINT32_MAX

enum { GLTF_MAX_FACTORS = 4 };

/* Coordinates of vertices in world space are at most this, as in other formats. */
#define GLTF_MAX_COORDINATE 1e18

/* A value of the document and its path: a chain of keys and indices up to the document, in the callers' frames. json is
 * NULL for a missing value. */
typedef struct gltf_value {
    const json_t *json;
    const struct gltf_value *parent; /* NULL: this is the document */
    const char *key;                 /* of an object; NULL: index of an array */
    size_t index;
} gltf_value;

/* The arrays of the document that others refer to by index. */
typedef enum gltf_list {
    GLTF_ACCESSORS,
    GLTF_BUFFERS,
    GLTF_BUFFER_VIEWS,
    GLTF_CAMERAS,
    GLTF_IMAGES,
    GLTF_MATERIALS,
    GLTF_MESHES,
    GLTF_NODES,
    GLTF_SAMPLERS,
    GLTF_SCENES,
    GLTF_SKINS,
    GLTF_TEXTURES,
    GLTF_LIGHTS, /* of KHR_lights_punctual */
    GLTF_LIST_COUNT
} gltf_list;

/* Bytes that somebody else owns. */
typedef struct gltf_bytes {
    const unsigned char *data;
    size_t size;
} gltf_bytes;

/* A buffer or picture in memory; data NULL: not loaded yet. */
typedef struct gltf_file {
    unsigned char *data;
    size_t size;
} gltf_file;

/* A material, and the properties of the shapes that have it. */
typedef struct gltf_material {
    bool is_loaded;
    uint32_t material_index; /* the scene's */
    uint32_t uv_set;         /* that its textures use, GLTF_NONE: it has none */
    float alpha;             /* as in shape */
    uint32_t alpha_texture;
    float alpha_cutoff;
    uint32_t medium_inside; /* the scene's, SCENE_NO_MEDIUM: none */
    rgb radiance;           /* black: it does not shine */
    uint32_t radiance_texture;
    bool is_two_sided; /* shines from both sides */
    bool only_glows;   /* it glows by a picture no brighter than white, as a sign or a display: that lights no scene */
} gltf_material;

/* How many nodes have a mesh, and the object that it is for them. */
typedef struct gltf_mesh_use {
    uint32_t node_count;
    bool is_made;
    uint32_t object_index; /* the scene's object; SCENE_NO_OBJECT: it is empty */
} gltf_mesh_use;

/* A node's transform to world space: affine, of any rank. Row, column. */
typedef struct gltf_matrix {
    double m[3][4];
} gltf_matrix;

/* Factors from a file's units of lamps to W/sr and W/m^2. */
typedef struct gltf_lamp_units {
    double per_candela, per_lux;
    gltf_light_units kind; /* none of GLTF_LIGHTS_BY_GENERATOR */
} gltf_lamp_units;

typedef struct gltf_reader {
    run_context *run;
    scene *scene;
    file_location where; /* the file, without line */
    char *directory;     /* of the file, with its slash, or "" */

    char *text;       /* the whole file; owned */
    bool is_text;     /* which is the JSON itself */
    gltf_bytes chunk; /* a binary file's BIN chunk, in text; data NULL: there is none */
    json_t *root;
    gltf_value document;
    gltf_value lists_parents[2]; /* extensions, KHR_lights_punctual: of the list of lights */
    gltf_value lists[GLTF_LIST_COUNT];
    uint32_t list_counts[GLTF_LIST_COUNT];
    gltf_lamp_units lamp_units;
    char generator[96]; /* of the file, as it can be printed; "": it names none */
    bool told_units;
    bool is_blenders; /* by the exporter of Blender */

    gltf_file *buffers;            /* [list_counts[GLTF_BUFFERS]] */
    gltf_file *images;             /* [list_counts[GLTF_IMAGES]], of which data URIs alone are filled */
    gltf_material *materials;      /* [list_counts[GLTF_MATERIALS] + 1], the last the default one */
    gltf_mesh_use *mesh_uses;      /* [list_counts[GLTF_MESHES]] */
    gltf_matrix *world_from_nodes; /* [list_counts[GLTF_NODES]] */
    double aspect;                 /* width / height of the camera's picture; 0: it does not say */
    size_t triangles_read, triangles_dropped;
    uint32_t glow_count; /* of the scene's lights: surfaces that only glow */
} gltf_reader;

/* gltf_position.c: finds the line and column of a value; for one that is missing, those of the value that should hold
 * it. For a binary file, it gives the file alone. */
file_location gltf_position(const gltf_reader *r, const gltf_value *v);

/* gltf_json.c: values by key and index. Each function that fails tells the error with the value's path. */

/* Tells an error at the value's path. Always returns AG_ERROR_SCENE. */
ag_status gltf_error(const gltf_reader *r, const gltf_value *at, const char *format, ...) AG_PRINTF(3, 4);
/* Warns at the value's path, once for each key. */
void gltf_warn_once(const gltf_reader *r, const gltf_value *at, const char *key, const char *format, ...)
    AG_PRINTF(4, 5);

/* Return a member or an element; its json is NULL where there is none, also where the parent is none, or is no object
 * or array. */
gltf_value gltf_member(const gltf_value *object, const char *key);
gltf_value gltf_element(const gltf_value *array, size_t index);

/* Finds a member, which must be an object (array) if it is present. */
ag_status gltf_get_object(const gltf_reader *r, const gltf_value *parent, const char *key, gltf_value *out_value);
ag_status gltf_get_array(const gltf_reader *r, const gltf_value *parent, const char *key, gltf_value *out_value);
/* Returns the value extensions.NAME; extensions_frame is room for the step between, and has to live as long as the
 * value. */
ag_status gltf_get_extension(const gltf_reader *r, const gltf_value *parent, const char *name,
                             gltf_value *extensions_frame, gltf_value *out_value);
/* Finds an element, or an item of a list, which must be an object; index is in range. */
ag_status gltf_get_element(const gltf_reader *r, const gltf_value *array, size_t index, gltf_value *out_value);
ag_status gltf_get_item(const gltf_reader *r, gltf_list list, uint32_t index, gltf_value *out_value);

/* Each writes the value where there is one, and leaves *value alone where there is none. */
ag_status gltf_get_bool(const gltf_reader *r, const gltf_value *parent, const char *key, bool *value);
ag_status gltf_get_text(const gltf_reader *r, const gltf_value *parent, const char *key, const char **value);
/* Gets an integer in [0, 2^53]. */
ag_status gltf_get_uint(const gltf_reader *r, const gltf_value *parent, const char *key, uint64_t *value);
ag_status gltf_get_double(const gltf_reader *r, const gltf_value *parent, const char *key, double *value);
/* Gets exactly count numbers. */
ag_status gltf_get_doubles(const gltf_reader *r, const gltf_value *parent, const char *key, size_t count,
                           double *values);
/* Get a number (or count of them, up to GLTF_MAX_FACTORS, or three) that the format wants in [low, high]. One that is
 * not is brought there, with a warning. */
ag_status gltf_get_clamped(const gltf_reader *r, const gltf_value *parent, const char *key, double low, double high,
                           float *value);
ag_status gltf_get_factors(const gltf_reader *r, const gltf_value *parent, const char *key, double low, double high,
                           size_t count, float *values);
ag_status gltf_get_color(const gltf_reader *r, const gltf_value *parent, const char *key, double low, double high,
                         rgb *value);
/* Gets an index into a list, and checks it. */
ag_status gltf_get_index(const gltf_reader *r, const gltf_value *parent, const char *key, gltf_list list,
                         uint32_t *value);
/* Takes the value itself as such an index. */
ag_status gltf_read_index(const gltf_reader *r, const gltf_value *at, gltf_list list, uint32_t *out_index);
/* Work as gltf_get_… does for values that must be there: an error where one is not. */
ag_status gltf_require(const gltf_reader *r, const gltf_value *parent, const char *key);

/* gltf_document.c: reads the file, and checks what the whole of it says: version, extensions. */
ag_status gltf_document_read(gltf_reader *r, const char *path);

/* gltf_uri.c */

/* Decodes the bytes of a base64 data URI, malloc'ed. Returns NULL with a text where it is none or is damaged, and NULL
 * without a text when out of memory. */
unsigned char *gltf_uri_decode_data(const char *uri, size_t *out_size, const char **out_wrong);
bool gltf_uri_is_data(const char *uri);
/* Returns the path of the file that a relative URI names, malloc'ed; NULL as above. */
char *gltf_uri_to_path(const gltf_reader *r, const char *uri, const char **out_wrong);

/* gltf_buffers.c */
ag_status gltf_buffer_view(gltf_reader *r, uint32_t index, gltf_bytes *out_bytes, uint32_t *out_stride);
/* Finds a part of a view, for an accessor. Where *stride is 0 it becomes the view's stride, or element_size where the
 * view has none. */
ag_status gltf_view_span(gltf_reader *r, const gltf_value *at, uint64_t offset, uint64_t count, size_t element_size,
                         gltf_bytes *out_bytes, size_t *out_stride);

/* gltf_accessors.c: arrays of numbers, read where they are. */
typedef struct gltf_accessor {
    uint32_t count;
    int components;     /* 1 to 16 */
    int component_type; /* glTF's number */
    bool is_normalized;
    gltf_bytes bytes; /* data NULL: zeros */
    size_t stride;
    uint32_t sparse_count;
    gltf_bytes sparse_indices, sparse_values;
    int sparse_index_type;
} gltf_accessor;

/* Opens an accessor. index has been checked; at is where it stands, for the message that the accessor's elements have
 * another number of components than components_min to components_max. */
ag_status gltf_accessor_open(gltf_reader *r, const gltf_value *at, uint32_t index, int components_min,
                             int components_max, gltf_accessor *out_accessor);
/* Reads element i < count, all components; integers are normalised where the accessor says so. */
void gltf_accessor_get(const gltf_accessor *a, uint32_t i, float *out_values);
/* Reads an index from an accessor of unsigned integers. */
uint32_t gltf_accessor_get_index(const gltf_accessor *a, uint32_t i);

/* gltf_poses.c: how a node holds its mesh. */
typedef struct gltf_pose {
    gltf_matrix world_from_mesh;
    bool is_mirror;
    gltf_value weights;  /* of morph targets: numbers, of any count */
    gltf_matrix *joints; /* of a skin: world_from_mesh by each; owned */
    uint32_t joint_count;
} gltf_pose;

/* Opens a pose, for which world_from_nodes must be filled. *out_pose is to be closed, on failure too; node and
 * mesh_value must live as long. */
ag_status gltf_pose_open(gltf_reader *r, const gltf_value *node, const gltf_value *mesh_value,
                         const gltf_matrix *world_from_node, gltf_pose *out_pose);
void gltf_pose_close(gltf_pose *pose);
gltf_matrix gltf_matrix_identity(void);
gltf_matrix gltf_matrix_multiply(const gltf_matrix *a, const gltf_matrix *b); /* b first */

/* gltf_vertices.c: a primitive's vertices. */
enum { GLTF_MAX_INFLUENCES = 4 }; /* sets of four joints */

typedef struct gltf_morph {
    double weight;
    gltf_accessor positions, normals; /* the accessors to add */
    bool has_positions, has_normals;
} gltf_morph;

typedef struct gltf_vertices {
    const gltf_value *attributes;
    const gltf_pose *pose;
    uint32_t count; /* 0: there is nothing to see */
    gltf_accessor positions, normals, uvs;
    bool has_normals, has_uvs, needs_uvs;
    gltf_morph *morphs; /* owned */
    size_t morph_count;
    gltf_accessor joints[GLTF_MAX_INFLUENCES], weights[GLTF_MAX_INFLUENCES];
    int influence_count;
} gltf_vertices;

/* Opens a primitive's vertices. *out_vertices is to be closed, on failure too; attributes (the primitive's) and pose
 * must live as long. */
ag_status gltf_vertices_open(gltf_reader *r, const gltf_value *primitive, const gltf_value *attributes, uint32_t uv_set,
                             const gltf_pose *pose, gltf_vertices *out_vertices);
void gltf_vertices_close(gltf_vertices *v);
/* Reads vertex i < count, in world space. *out_normal is unit, or zero where there is none; *out_uv is left alone where
 * there is none. Both may be NULL. */
ag_status gltf_vertices_get(gltf_reader *r, const gltf_vertices *v, uint32_t i, vec3 *out_position, vec3 *out_normal,
                            vec2 *out_uv);
/* Computes the cofactors of the matrix's linear part, which transform normals; their sign is changed where the matrix
 * mirrors. Returns whether it does. */
bool gltf_matrix_cofactors(const gltf_matrix *matrix, double out_cofactors[3][3]);

/* gltf_meshes.c: adds a mesh's primitives to the scene. */
typedef enum gltf_mesh_part { GLTF_ALL_PARTS, GLTF_DARK_PART, GLTF_SHINING_PART } gltf_mesh_part;

typedef struct gltf_destination {
    gltf_mesh_part part;   /* which primitives to add, by whether their materials shine */
    uint32_t object_index; /* the scene's; SCENE_NO_OBJECT: the world itself */
} gltf_destination;

ag_status gltf_add_mesh(gltf_reader *r, uint32_t mesh_index, const gltf_pose *pose, gltf_destination to);

/* gltf_instances.c: first counts how many nodes use each mesh, then adds the mesh of each node. */
ag_status gltf_count_mesh_use(gltf_reader *r, const gltf_value *node);
ag_status gltf_add_node_mesh(gltf_reader *r, const gltf_value *node, uint32_t mesh_index,
                             const gltf_matrix *world_from_node);

/* gltf_triangles.c: the corners of a primitive's triangles. */
typedef struct gltf_triangles {
    uint32_t *indices; /* 3 per triangle, below the count of vertices; owned */
    uint32_t count;
    bool is_strip; /* a strip: triangles without area are meant to be there */
} gltf_triangles;

/* Finds the corners. *out_triangles is to be freed; its count is 0 for points and lines, which a warning names. */
ag_status gltf_read_triangles(gltf_reader *r, const gltf_value *primitive, uint32_t vertex_count,
                              gltf_triangles *out_triangles);

/* gltf_materials.c, gltf_material_extensions.c. index GLTF_NONE: the default material. */
ag_status gltf_material_find(gltf_reader *r, uint32_t index, const gltf_material **out_material);
/* Reads alphaMode and the alpha of the factor and of texture_key in base, the object that has the base colour. */
ag_status gltf_read_alpha(gltf_reader *r, const gltf_value *at, const gltf_value *base, const char *texture_key,
                          float factor, gltf_material *out);
ag_status gltf_read_material_extensions(gltf_reader *r, const gltf_value *at, material *m, gltf_material *out);

/* gltf_textures.c: which channel of a texture is read, how it is encoded, and what is done to its value. */
typedef struct gltf_texture_use {
    bool is_color, is_srgb;
    texture_channel channel; /* of a float */
    float scale;
    bool invert;
} gltf_texture_use;

/* Gets the texture that parent.key, a textureInfo, refers to; it is left alone where there is none. *uv_set: the set
 * that the material's textures use, GLTF_NONE for none yet. */
ag_status gltf_get_texture(gltf_reader *r, const gltf_value *parent, const char *key, gltf_texture_use use,
                           uint32_t *uv_set, uint32_t *out_texture);

/* gltf_images.c */
ag_status gltf_load_image(gltf_reader *r, uint32_t index, image_encoding encoding, uint32_t *out_image_index);

/* gltf_nodes.c: reads the default scene's nodes, and what they hold. */
ag_status gltf_add_nodes(gltf_reader *r);

/* gltf_cameras.c: makes the camera on a node the scene's if it is the one that is asked for, by its own name or the
 * node's, or the first. The picture gets its proportions. */
ag_status gltf_add_camera(gltf_reader *r, uint32_t index, const gltf_value *node, const gltf_matrix *world_from_node);
void gltf_set_picture_size(gltf_reader *r);
/* Finds the node's axis, 0 to 2, of unit length; returns false where the node's transform makes it zero. */
bool gltf_matrix_axis(const gltf_matrix *m, int axis, double out_axis[3]);

/* gltf_lights.c */
/* Finds the units of lamps. asked: what the user says of them. generator: the file's, NULL: none. */
gltf_lamp_units gltf_lamp_units_of(gltf_light_units asked, const char *generator);
ag_status gltf_add_lamp(gltf_reader *r, uint32_t index, const gltf_matrix *world_from_node);

#endif
