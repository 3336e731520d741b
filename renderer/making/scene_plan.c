/* scene_plan.c: see scene_plan.h. */
#include "scene_plan.h"

#include "shape/borrowed_arrays.h"
#include "status.h"

#include <stdlib.h>
#include <string.h>

/* --- lists --- */

static void reset_list(call_list *list)
{
    for (size_t i = 0; i < list->count; i++)
        scene_call_release(list->calls[i]);
    free(list->calls);
    *list = (call_list){0};
}

static ag_status copy_list(const call_list *list, call_list *out)
{
    *out = (call_list){malloc((list->count + 1) * sizeof *out->calls), 0, list->count + 1};
    if (!out->calls)
        return AG_ERROR_MEMORY;
    for (; out->count < list->count; out->count++)
        out->calls[out->count] = scene_call_hold(list->calls[out->count]);
    return AG_OK;
}

void scene_plan_reset(scene_plan *plan)
{
    reset_list(&plan->named);
    reset_list(&plan->placed);
}

ag_status scene_plan_copy(const scene_plan *plan, scene_plan *out_copy)
{
    *out_copy = (scene_plan){0};
    ag_status status = copy_list(&plan->named, &out_copy->named);
    if (status == AG_OK)
        status = copy_list(&plan->placed, &out_copy->placed);
    if (status != AG_OK)
        scene_plan_reset(out_copy);
    return status;
}

static bool is_same_name(const scene_call *a, const scene_call *b)
{
    if (a->kind != b->kind)
        return false;
    if (a->kind == CALL_CAMERA)
        return true;
    if (a->kind == CALL_HINT)
        return a->hint == b->hint;
    return strcmp(a->texts[0], b->texts[0]) == 0 && (a->kind != CALL_TEXTURE || strcmp(a->texts[1], b->texts[1]) == 0);
}

size_t scene_plan_find_named(const scene_plan *plan, const scene_call *like)
{
    size_t i = 0;
    while (i < plan->named.count && !is_same_name(plan->named.calls[i], like))
        i++;
    return i;
}

size_t scene_plan_find_placed(const scene_plan *plan, uint32_t number)
{
    size_t low = 0, high = plan->placed.count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (plan->placed.calls[middle]->number < number)
            low = middle + 1;
        else
            high = middle;
    }
    return low < plan->placed.count && plan->placed.calls[low]->number == number ? low : plan->placed.count;
}

call_list *scene_plan_list(scene_plan *plan, call_kind kind)
{
    return kind <= CALL_INSTANCE ? &plan->placed : &plan->named;
}

ag_status scene_plan_put(scene_plan *plan, size_t place, scene_call *c)
{
    call_list *list = scene_plan_list(plan, c->kind);
    if (place == list->count && list->count == list->capacity) {
        const size_t capacity = 2 * list->capacity + 8;
        scene_call **larger = realloc(list->calls, capacity * sizeof *larger);
        if (!larger)
            return AG_ERROR_MEMORY;
        list->calls = larger;
        list->capacity = capacity;
    }
    if (place == list->count)
        list->count++;
    else
        scene_call_release(list->calls[place]);
    list->calls[place] = scene_call_hold(c);
    return AG_OK;
}

void scene_plan_remove(call_list *list, size_t place)
{
    scene_call_release(list->calls[place]);
    list->count--;
    memmove(list->calls + place, list->calls + place + 1, (list->count - place) * sizeof *list->calls);
}

bool scene_plan_mark_stale(const scene_plan *plan)
{
    for (size_t i = 0; i < plan->placed.count; i++) {
        scene_call *c = plan->placed.calls[i];
        c->is_stale = c->is_stale || (c->mesh && shape_hash_borrowed(c->mesh) != c->arrays_hash);
    }
    return scene_plan_find_stale(plan) != NULL;
}

const scene_call *scene_plan_find_lost(const scene_plan *plan)
{
    for (size_t i = 0; i < plan->placed.count; i++)
        if (plan->placed.calls[i]->mesh && borrowed_arrays_are_lost(plan->placed.calls[i]->mesh))
            return plan->placed.calls[i];
    return NULL;
}

const scene_call *scene_plan_find_stale(const scene_plan *plan)
{
    for (size_t i = 0; i < plan->placed.count; i++)
        if (plan->placed.calls[i]->is_stale)
            return plan->placed.calls[i];
    return NULL;
}

/* --- running --- */

/* The state while a plan is run. */
typedef struct plan_run {
    const scene_plan *plan;
    run_context *run;
    pbrt_builder *builder;
    bool *has_begun; /* for each named call: whether the run of that texture has begun */
} plan_run;

static ag_status run_call(const plan_run *r, scene_call *c)
{
    const bool is_quiet = c->has_told;
    if (run_is_cancelled(r->run))
        return AG_CANCELLED;
    pbrt_builder_set_quiet(r->builder, is_quiet);
    ag_status status = scene_call_run(c, r->builder, true);
    pbrt_builder_set_quiet(r->builder, false);
    if (status != AG_OK &&
        is_quiet) /* other calls have made it wrong since: it is run again, so that messages are told */
        status = scene_call_run(c, r->builder, true);
    c->has_told = c->has_told || status == AG_OK;
    return status;
}

static ag_status run_texture(const plan_run *r, size_t place, int depth);

/* Runs the textures that a texture names. The builder tells of those that do not exist. */
static ag_status run_inputs(const plan_run *r, const scene_call *c, int depth)
{
    const call_list *named = &r->plan->named;
    for (size_t i = 0; i < c->items.count; i++) {
        const parameter *p = &c->items.items[i];
        for (size_t k = 0; k < named->count && p->type == PARAMETER_TEXTURE && p->count == 1; k++)
            if (named->calls[k]->kind == CALL_TEXTURE && strcmp(named->calls[k]->texts[0], p->strings[0]) == 0)
                AG_TRY(run_texture(r, k, depth));
    }
    return AG_OK;
}

/* Textures that name each other in a circle, or in a chain longer than textures may be, end here: the builder then
 * tells the one that names this texture that there is none. */
static ag_status run_texture(const plan_run *r, size_t place, int depth)
{
    scene_call *c = r->plan->named.calls[place];
    if (r->has_begun[place] || depth > TEXTURE_MAX_COST)
        return AG_OK;
    r->has_begun[place] = true;
    AG_TRY(run_inputs(r, c, depth + 1));
    return run_call(r, c);
}

static ag_status run_named(const plan_run *r)
{
    static const call_kind ORDER[] = {CALL_IMAGE, CALL_MEDIUM, CALL_TEXTURE, CALL_MATERIAL, CALL_HINT, CALL_CAMERA};
    for (size_t i = 0; i < sizeof ORDER / sizeof *ORDER; i++)
        for (size_t k = 0; k < r->plan->named.count; k++) {
            scene_call *c = r->plan->named.calls[k];
            if (c->kind == ORDER[i])
                AG_TRY(c->kind == CALL_TEXTURE ? run_texture(r, k, 0) : run_call(r, c));
        }
    return AG_OK;
}

static ag_status run_placed(const plan_run *r)
{
    const call_list *placed = &r->plan->placed;
    for (int of_objects = 1; of_objects >= 0; of_objects--)
        for (size_t i = 0; i < placed->count; i++) {
            scene_call *c = placed->calls[i];
            if ((c->kind == CALL_SHAPE && c->object != NULL) == of_objects)
                AG_TRY(run_call(r, c));
        }
    return AG_OK;
}

ag_status scene_plan_run(const scene_plan *plan, run_context *run, pbrt_builder *builder)
{
    const plan_run r = {plan, run, builder, calloc(plan->named.count + 1, sizeof *r.has_begun)};
    ag_status status = r.has_begun ? run_named(&r) : AG_ERROR_MEMORY;
    free(r.has_begun);
    return status == AG_OK ? run_placed(&r) : status;
}
