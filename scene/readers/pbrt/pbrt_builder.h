/* pbrt_builder.h: a scene made by calls instead of text. Each is one or a few of pbrt-v4's directives, with
 * strings and parameters from memory, and goes through the very functions that a file's directives go through: what is
 * true of one is true of the other, to the last bit. Flow: scene_memory -> [here] -> pbrt_shapes, pbrt_materials, ...
 * -> scene. Threads: one per scene. */
#ifndef AFTERGLOW_PBRT_BUILDER_H
#define AFTERGLOW_PBRT_BUILDER_H

#include "math/transform.h"
#include "pbrt/parameter_list.h"
#include "scene.h"

typedef struct pbrt_builder pbrt_builder;
struct image;
struct shape;

/* Begins an empty, uncommitted scene; run and scene are borrowed until pbrt_builder_destroy. NULL when out of
 * memory. */
pbrt_builder *pbrt_builder_create(run_context *run, scene *out_scene);
void pbrt_builder_destroy(pbrt_builder *b); /* NULL is fine */

/* The call that messages name, as FUNCTION:NUMBER:PARAMETER. Parameters hold their own `where` in the same way. */
typedef struct pbrt_call {
    file_location where; /* of column 0 */
    const char *label;   /* of what is made, borrowed for the time of the call */
} pbrt_call;

/* Parameters in an array; what they hold is taken, on failure too, and the array left zeroed. */
typedef struct pbrt_items {
    parameter *items;
    size_t count;
} pbrt_items;

/* A placement: transform, material and media. */
typedef struct pbrt_placement {
    transform start, end;     /* world from its own space, while the shutter is open; of a camera: camera from world */
    const transform *between; /* [between_count] at evenly spaced times between the two, or NULL; none of a camera */
    uint32_t between_count;
    bool reverse_orientation;
    const char *material;                       /* may be made later; NULL: diffuse grey */
    const char *object;                         /* that it is part of; NULL: of the world */
    const char *medium_inside, *medium_outside; /* may be made later; NULL: none */
    struct shape *made_mesh; /* of pbrt_builder_mesh, shared: instead of the shape's arrays; NULL: they are read */
} pbrt_placement;

/* All calls give errors as a file's directives do, told to the run's log. What was made before stays, and a call that
 * fails has no effect. */

/* emission: of AreaLightSource; NULL: it does not shine. */
ag_status pbrt_builder_shape(pbrt_builder *b, const pbrt_call *call, const pbrt_placement *at, const char *type,
                             pbrt_items items, pbrt_items *emission);
/* Arrays of a trianglemesh that stay the caller's, and stay in place for as long as the mesh lives. Their numbers are
 * finite. Behind positions 4 more bytes can be read. Normals and tangents are parameters. */
typedef struct pbrt_borrowed {
    const float *positions; /* [3 * vertex_count] */
    const float *uvs;       /* [uv_count], or NULL; ignored with a warning where that is not as "motionsteps" says */
    const int32_t *indices; /* [index_count] */
    size_t vertex_count, uv_count, index_count; /* vertices: of all motion steps */
} pbrt_borrowed;

/* Returns whether shapes of that type are meshes, whose arrays can be read once and serve in several scenes. */
bool pbrt_builder_makes_mesh(const char *type);
/* The mesh that the parameters make where `at` puts it, alone, in a builder that is used for nothing else; without
 * triangles where it would be left out. shines: the shape has an area light, and stands where it does at the start;
 * whether its vertices stand still too depends on its material, and is left to pbrt_builder_shape. borrowed: instead of
 * P, uv and indices of a trianglemesh, copied as far as they cannot be used as they are; NULL: nothing is. The
 * caller's, by shape_reset. */
ag_status pbrt_builder_mesh(pbrt_builder *b, const pbrt_call *call, const pbrt_placement *at, const char *type,
                            pbrt_items items, bool shines, const pbrt_borrowed *borrowed, struct shape *out_mesh);
ag_status pbrt_builder_light(pbrt_builder *b, const pbrt_call *call, const pbrt_placement *at, const char *type,
                             pbrt_items items);
ag_status pbrt_builder_camera(pbrt_builder *b, const pbrt_call *call, const pbrt_placement *at, const char *type,
                              pbrt_items items);
/* Makes an instance of the object that at->object names, which is complete with it. Errors also: AG_ERROR_SCENE
 * (nothing has been added to such an object yet). */
ag_status pbrt_builder_instance(pbrt_builder *b, const pbrt_call *call, const pbrt_placement *at);

/* strings: name, "float" or "spectrum", class. */
ag_status pbrt_builder_texture(pbrt_builder *b, const pbrt_call *call, const pbrt_placement *at,
                               const char *const strings[3], pbrt_items items);

/* Directives that place nothing in the scene; the strings after each are those behind its name. */
typedef enum pbrt_statement {
    PBRT_MATERIAL, /* MakeNamedMaterial: name, type */
    PBRT_MEDIUM,   /* MakeNamedMedium: name, type */
    PBRT_FILM,     /* Film and the following: type; the last of each counts */
    PBRT_SAMPLER,
    PBRT_INTEGRATOR,
    PBRT_PIXEL_FILTER
} pbrt_statement;
ag_status pbrt_builder_state(pbrt_builder *b, const pbrt_call *call, pbrt_statement statement,
                             const char *const *strings, pbrt_items items);

/* A picture that stands in for the file of that name; borrowed for as long as the builder lives. version: even, another
 * one for other pixels of that name. */
ag_status pbrt_builder_picture(pbrt_builder *b, const pbrt_call *call, const char *name, const struct image *picture,
                               uint64_t version);

/* Sets whether warnings are dropped, and errors with them. */
void pbrt_builder_set_quiet(pbrt_builder *b, bool is_quiet);

/* Completes what depends on the whole scene. To be called once; nothing more can be added. */
ag_status pbrt_builder_finish(pbrt_builder *b);

#endif
