/* scene_plan.h: all calls that a scene is made of, to be changed and run again. The scene depends on the plan alone:
 * two plans with equal calls make equal scenes, whatever changes led to them. Flow: scene_memory, scene_editing ->
 * [here] -> scene_call. Threads: as in afterglow.h. */
#ifndef AFTERGLOW_SCENE_PLAN_H
#define AFTERGLOW_SCENE_PLAN_H

#include "scene_call.h"

typedef struct call_list {
    scene_call **calls; /* each held */
    size_t count, capacity;
} call_list;

/* A plan of zeros is empty. */
typedef struct scene_plan {
    call_list named;  /* the camera, hints, and things that have a name */
    call_list placed; /* shapes, lights and instances, in ascending order of their numbers */
} scene_plan;

void scene_plan_reset(scene_plan *plan);
/* Makes a plan that shares the calls of another. Errors: AG_ERROR_MEMORY, and *out_copy is empty. */
ag_status scene_plan_copy(const scene_plan *plan, scene_plan *out_copy);

/* The index of a call in its list; the list's count where it is not there. A float and a spectrum texture of one name
 * are two. */
size_t scene_plan_find_named(const scene_plan *plan, const scene_call *like);
size_t scene_plan_find_placed(const scene_plan *plan, uint32_t number);
/* The list that calls of a kind are in. */
call_list *scene_plan_list(scene_plan *plan, call_kind kind);

/* Puts a call at a place of its list, behind the last one or instead of another; holds it on AG_OK. Errors:
 * AG_ERROR_MEMORY. */
ag_status scene_plan_put(scene_plan *plan, size_t place, scene_call *c);
void scene_plan_remove(call_list *list, size_t place);

/* Marks the shapes whose borrowed arrays hold other numbers than were read from them; whether there is any. */
bool scene_plan_mark_stale(const scene_plan *plan);
/* The first that is marked so; NULL: there is none. */
const scene_call *scene_plan_find_stale(const scene_plan *plan);
/* The first shape of which borrowed arrays were freed (borrowed_arrays.h); NULL: there is none. */
const scene_call *scene_plan_find_lost(const scene_plan *plan);

/* Runs them all: pictures, media, textures (each behind those that it names), materials, hints and camera, then the
 * shapes of objects, then all else, in the order of their first calls. Each tells its warnings once. Errors: those of
 * the calls, AG_CANCELLED. */
ag_status scene_plan_run(const scene_plan *plan, run_context *run, pbrt_builder *builder);

#endif
