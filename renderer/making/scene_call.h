/* scene_call.h: one call that says something of a scene, checked and copied: it can be run at any time, and again.
 * Flow: scene_memory, scene_editing -> [here] -> pbrt_builder. Threads: as in afterglow.h. */
#ifndef AFTERGLOW_SCENE_CALL_H
#define AFTERGLOW_SCENE_CALL_H

#include "context.h"
#include "image/image.h"
#include "pbrt/pbrt_builder.h"

/* What the calls speak of. */
typedef enum call_kind {
    CALL_SHAPE, /* this one and the two that follow are placed in the scene, and have handles */
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

/* A call as it comes: a description, which begins with its size, or the rest. */
typedef struct call_given {
    call_kind kind;
    const void *description;
    const char *name, *type;
    const ag_parameter *parameters;
    size_t parameter_count;
    ag_scene_hint hint;
} call_given;

/* Held by the lists that it is in; nobody changes what it says then. */
typedef struct scene_call {
    unsigned holder_count;
    call_kind kind;
    uint32_t number; /* of the thing in its scene, which the calls that change it keep; from 1 on */
    ag_scene_hint hint;
    bool has_told; /* its warnings: set by whoever has run it */
    file_location where;
    char *texts[3]; /* of materials and media name and type; of textures name, value and type; of pictures the name; of
                       all else, but instances, the type */
    char *material, *object, *medium_inside, *medium_outside; /* of pbrt_placement */
    double *start, *end;                                      /* [16], or NULL */
    bool reverse_orientation, is_light;
    pbrt_items items, light_items;
    pbrt_borrowed borrowed; /* of shapes, until the mesh is made; positions NULL: nothing is */
    uint64_t arrays_hash;   /* of what the mesh borrows, as it was read */
    bool is_stale;          /* that has been written to, and the edit which said so was dropped */
    shape *mesh;            /* owned: what the arrays of a shape have made, or NULL: they are among the items */
    image *picture;         /* owned, of CALL_IMAGE */
    uint64_t version;       /* of that */
} scene_call;

/* One that holds nothing yet, held once; NULL when out of memory. */
scene_call *scene_call_create(call_kind kind, file_location where);
scene_call *scene_call_hold(scene_call *c);
void scene_call_release(scene_call *c); /* NULL is fine */

/* Copies what is given; says in the log what is wrong with it. Errors: AG_ERROR_ARGUMENT, AG_ERROR_MEMORY. */
ag_status scene_call_take(log_sink *log, const call_given *given, scene_call *c);
/* A copy of a placed one, whose mesh both share: with other matrices, or with another material. Errors:
 * AG_ERROR_ARGUMENT (also to move a mesh, whose arrays are gone), AG_ERROR_MEMORY. */
ag_status scene_call_move(log_sink *log, const scene_call *from, const double *start, const double *end, scene_call *c);
ag_status scene_call_assign(const scene_call *from, const char *material_name, scene_call *c);

/* Names an empty call, for what it is to be compared with; is_float: of textures. Errors: AG_ERROR_MEMORY. */
ag_status scene_call_name(scene_call *c, const char *name, bool is_float);

/* Reads the arrays of a mesh, in a builder that does nothing else, so that the call can be run often; other calls stay
 * as they are. Errors: those of pbrt_builder_shape. */
ag_status scene_call_make_mesh(scene_call *c, pbrt_builder *builder);

/* can_repeat: its parameters are copied; else they are taken, and this was the last time. A picture is borrowed in any
 * case. Errors: those of the builder. */
ag_status scene_call_run(scene_call *c, pbrt_builder *builder, bool can_repeat);

/* "light", ...: for messages. */
const char *call_kind_name(call_kind kind);

#endif
