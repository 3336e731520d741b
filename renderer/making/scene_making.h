/* scene_making.h: the state of a scene that is made by calls, and of one that can be changed after its commit. Private
 * to scene_memory.c, scene_commit.c and scene_editing.c. Threads: as in afterglow.h. */
#ifndef AFTERGLOW_SCENE_MAKING_H
#define AFTERGLOW_SCENE_MAKING_H

#include "scene_plan.h"

#include <limits.h>

/* The effect of a call on an object of the scene. */
typedef enum call_deed { DEED_MAKE, DEED_CHANGE, DEED_MOVE, DEED_ASSIGN, DEED_REMOVE, DEED_COUNT } call_deed;

/* The camera of a committed scene, with the members of scene_making that concern it. */
typedef struct camera_state {
    camera seen, later;
    bool has_camera, is_made_up, has_later;
} camera_state;

typedef struct scene_making {
    ag_context *context;   /* the scene's */
    scene *s;              /* as far as the calls have come; NULL once it is committed */
    pbrt_builder *builder; /* of s; NULL from the commit on */
    pbrt_builder *meshes;  /* makes meshes, in a scene of its own; NULL where nothing can be changed */
    scene *mesh_scene;
    scene_request request;
    char *texts[3];       /* of the request: copies, in any order */
    uint32_t serial;      /* of the scene, in its handles */
    uint32_t thing_count; /* things that were given a number so far */
    uint64_t call_counts[DEED_COUNT][CALL_KIND_COUNT];
    bool is_editable;
    bool has_moving; /* some shapes or instances move, and their motion was made for the camera's shutter */
    scene_plan plan; /* all calls, where it can be changed; else the pictures alone, which s borrows */
    scene_plan committed;
    bool is_edited;        /* the plan differs from `committed`, which is empty while this is false */
    bool has_stale;        /* shapes are among those of the last commit, and nothing can be rendered */
    bool has_camera;       /* a camera was set after a commit, and counts instead of the plan's */
    camera later_camera;   /* the camera that was set so */
    bool is_camera_edited; /* a camera was set after an edit, and is dropped with the edits where the commit fails */
    camera_state committed_camera; /* the camera that counts again then */
    ag_commit_counts counts;
} scene_making;

/* Where the next call of a function stands in messages, which count no further than an int does. A scene whose parts
 * move 60 times a second has had more calls than that after hours. */
static inline file_location call_place(const char *function, uint64_t *in_out_count)
{
    ++*in_out_count;
    return (file_location){function, *in_out_count < INT_MAX ? (int)*in_out_count : INT_MAX, 0};
}

/* A call of the public interface while it is carried out. */
typedef struct call_work {
    scene_making *making;
    scene_call *call;
    unsigned callers_arithmetic;
    phase_begin begin;
} call_work;

/* Makes an empty call, counted and held by *out_work, and readies the context to read for it. Errors: AG_ERROR_MEMORY,
 * and nothing is to be ended. (scene_memory.c) */
ag_status call_work_begin(ag_scene *made, call_deed deed, call_kind kind, call_work *out_work);
/* Releases the call, and returns the status that it is given. */
ag_status call_work_end(call_work *work, ag_status status);

/* Whether a scene takes calls; says in the log why not, for that function. (scene_memory.c) */
bool scene_making_is_open(const ag_scene *made, const char *function);

/* Calls scene_call_make_mesh and counts the mesh. (scene_memory.c) */
ag_status scene_making_mesh(scene_making *making, scene_call *c);

/* Says why the camera cannot take the place of the scene's; NULL where it can. (scene_commit.c) */
const char *scene_making_find_conflict(const scene *s, const camera *c);
/* Notes the camera before the first one that is set among edits. (scene_commit.c) */
void scene_making_keep_camera(ag_scene *made);

/* Gives a new call its number, and pictures their version. Errors: AG_ERROR_MEMORY (there were 2^32 of them). */
ag_status scene_making_number(scene_making *making, scene_call *c);
/* Whether the trees fit the arrays that the shapes of the plan borrow; says in the log of which not.
 * (scene_editing.c) */
ag_status scene_making_check_arrays(const scene_making *making);
/* Whether the arrays that shapes of the plan borrow are there, for a commit to read; says in the log which are not.
 * (scene_editing.c) */
ag_status scene_making_check_kept(const scene_making *making);
/* Whether the arrays that a scene's shapes borrow are there; says in the log which are not. (scene_memory.c) */
ag_status scene_check_borrowed(log_sink *log, const scene *s);
/* The handle of the shape, light or instance that a call makes. */
ag_handle scene_making_handle(const scene_making *making, const scene_call *c);
/* Puts a call at a place of the plan of a scene that is committed, or with NULL for it removes the one that is there,
 * of that kind. Errors: AG_ERROR_MEMORY, and nothing has changed. (scene_editing.c) */
ag_status scene_making_edit(scene_making *making, call_kind kind, size_t place, scene_call *c);

#endif
