/* scene_call.h: one call that says something of a scene, checked and copied: it can be run at any time, and again.
 * Flow: scene_memory, scene_editing -> [here] -> pbrt_builder. Threads: as in afterglow.h. */
#ifndef AFTERGLOW_SCENE_CALL_H
#define AFTERGLOW_SCENE_CALL_H

#include "context.h"
#include "image/image.h"
#include "pbrt/pbrt_builder.h"

/* The kinds of things that calls add to a scene. */
typedef enum call_kind {
    CALL_SHAPE, /* shapes, lights and instances are placed in the scene, and have handles */
    CALL_LIGHT,
    CALL_INSTANCE,
    CALL_CAMERA,
    CALL_MATERIAL,
    CALL_MEDIUM,
    CALL_TEXTURE,
    CALL_HINT,
    CALL_IMAGE,
    CALL_KIND_COUNT
} call_kind;

/* The arguments of a call: a description, which begins with its size, or the members that follow it. */
typedef struct call_given {
    call_kind kind;
    const void *description;
    const char *name, *type;
    const ag_parameter *parameters;
    size_t parameter_count;
    ag_scene_hint hint;
} call_given;

/* A call is held by each list that it is in, and is not changed while any list holds it. */
typedef struct scene_call {
    unsigned holder_count;
    call_kind kind;
    uint32_t number; /* of the thing in its scene, from 1 on; calls that change the thing keep it */
    ag_scene_hint hint;
    bool has_told; /* whoever runs the call sets this, so that its warnings are told once */
    file_location where;
    char *texts[3]; /* materials and media: name and type; textures: name, value and type; pictures: the name;
                       instances: none; all others: the type */
    char *material, *object, *medium_inside, *medium_outside; /* as in pbrt_placement */
    double *start, *end;                                      /* [16], [16 * end_count], owned, or NULL */
    size_t end_count;                                         /* at least 1 where there is an end */
    transform *between;                                       /* of all ends but the last, owned, or NULL */
    bool reverse_orientation, is_light;
    pbrt_items items, light_items;
    pbrt_borrowed borrowed; /* arrays of a shape, until its mesh is made; positions NULL: none */
    uint64_t arrays_hash;   /* of the arrays that the mesh borrows, as they were read */
    bool is_stale;          /* these were written to, and the edit that said so was dropped */
    shape *mesh;            /* owned: made of the arrays of a shape; NULL: the arrays are still among the items */
    image *picture;         /* owned; NULL but for CALL_IMAGE */
    uint64_t version;       /* of the picture */
} scene_call;

/* Makes an empty call, held once; NULL when out of memory. */
scene_call *scene_call_create(call_kind kind, file_location where);
scene_call *scene_call_hold(scene_call *c);
void scene_call_release(scene_call *c); /* NULL is fine */

/* Copies the arguments into an empty call, and says in the log what is wrong with them. Errors: AG_ERROR_ARGUMENT,
 * AG_ERROR_MEMORY. */
ag_status scene_call_take(log_sink *log, const call_given *given, scene_call *c);
/* Makes of an empty call a copy of a placed one with other matrices, one end at most, or with another material; both
 * share the mesh. Errors: AG_ERROR_ARGUMENT (also where a mesh is to be moved, since its arrays are gone),
 * AG_ERROR_MEMORY. */
ag_status scene_call_move(log_sink *log, const scene_call *from, const double *start, const double *end, scene_call *c);
ag_status scene_call_assign(const scene_call *from, const char *material_name, scene_call *c);

/* Gives an empty call a name, so that lists can be searched for calls of that name; is_float: the kind of value of a
 * texture. Errors: AG_ERROR_MEMORY. */
ag_status scene_call_name(scene_call *c, const char *name, bool is_float);

/* Makes the mesh of a shape's arrays by a builder that does nothing else, so that the call can be run often; calls of
 * other kinds stay as they are. Errors: those of pbrt_builder_shape. */
ag_status scene_call_make_mesh(scene_call *c, pbrt_builder *builder);

/* Hands the call to the builder. can_repeat: the builder gets copies of its parameters; else it takes them, and the
 * call cannot be run again. The builder borrows a picture in any case. Errors: those of the builder. */
ag_status scene_call_run(scene_call *c, pbrt_builder *builder, bool can_repeat);

/* The kind in words for messages: "light" and so on. */
const char *call_kind_name(call_kind kind);

#endif
