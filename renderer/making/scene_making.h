/* scene_making.h: a scene of calls on its way, and what is kept of one that can be changed; for scene_memory.c and
 * scene_editing.c. Threads: as in afterglow.h. */
#ifndef AFTERGLOW_SCENE_MAKING_H
#define AFTERGLOW_SCENE_MAKING_H

#include "scene_plan.h"

/* What is done with the things that calls speak of. */
typedef enum call_deed { DEED_MAKE, DEED_CHANGE, DEED_MOVE, DEED_ASSIGN, DEED_REMOVE, DEED_COUNT } call_deed;

/* The camera of a scene that is committed, and what scene_making has of it. */
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
    char *sky_file, *camera_name; /* of the request */
    uint32_t serial;              /* of the scene, in its handles */
    uint32_t thing_count;         /* that have had a number */
    int call_counts[DEED_COUNT][CALL_KIND_COUNT];
    bool is_editable;
    bool has_moving; /* shapes or instances, whose motion was made for the camera's shutter */
    scene_plan plan; /* all calls, where it can be changed; else the pictures alone, which s borrows */
    scene_plan committed;
    bool is_edited;                /* plan says something else than committed, which is empty until then */
    bool has_stale;                /* shapes among those of the last commit: nothing can be rendered */
    bool has_camera;               /* one was set after a commit, which counts instead of the plan's */
    camera later_camera;           /* that one */
    bool is_camera_edited;         /* one was set after an edit, and goes with it where the commit fails: */
    camera_state committed_camera; /* to this one */
    ag_commit_counts counts;
} scene_making;

/* A call on its way. */
typedef struct call_work {
    scene_making *making;
    scene_call *call;
    unsigned callers_arithmetic;
    phase_begin begin;
} call_work;

/* Makes an empty call, counted and held by *out_work, and readies the context to read for it. Errors: AG_ERROR_MEMORY,
 * and nothing is to be ended. (scene_memory.c) */
ag_status call_work_begin(ag_scene *made, call_deed deed, call_kind kind, call_work *out_work);
/* Lets go of the call; gives the status. */
ag_status call_work_end(call_work *work, ag_status status);

/* Whether a scene takes calls; says in the log why not, for that function. (scene_memory.c) */
bool scene_making_is_open(const ag_scene *made, const char *function);

/* scene_call_make_mesh, counted. (scene_memory.c) */
ag_status scene_making_mesh(scene_making *making, scene_call *c);

/* Gives a new call its number, and pictures their version. Errors: AG_ERROR_MEMORY (there were 2^32 of them). */
ag_status scene_making_number(scene_making *making, scene_call *c);
/* Whether the trees fit what the shapes of the plan borrow; says in the log of which not. (scene_editing.c) */
ag_status scene_making_check_arrays(const scene_making *making);
/* The handle of what a placed call makes. */
ag_handle scene_making_handle(const scene_making *making, const scene_call *c);
/* Puts a call at a place of the plan of a scene that is committed, or with NULL for it removes the one that is there,
 * of that kind. Errors: AG_ERROR_MEMORY, and nothing has changed. (scene_editing.c) */
ag_status scene_making_edit(scene_making *making, call_kind kind, size_t place, scene_call *c);

#endif
