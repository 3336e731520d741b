/* scene_editing.c: changes of scenes that calls have made. Each changes the plan; the next commit makes the scene of
 * it. Flow: afterglow.h -> [here] -> scene_plan. Threads: as in afterglow.h. */
#include "scene_making.h"
#include "status.h"

#include <string.h>

ag_status scene_making_number(scene_making *making, scene_call *c)
{
    if (making->thing_count == UINT32_MAX)
        return AG_ERROR_MEMORY;
    c->number = ++making->thing_count;
    if (c->kind == CALL_IMAGE)
        c->version = 2 * (uint64_t)c->number; /* even, so that it differs from the versions of files, which are odd */
    return AG_OK;
}

ag_handle scene_making_handle(const scene_making *making, const scene_call *c)
{
    return (ag_handle)making->serial << 32 | c->number;
}

ag_status scene_making_edit(scene_making *making, call_kind kind, size_t place, scene_call *c)
{
    ag_status status = making->is_edited ? AG_OK : scene_plan_copy(&making->plan, &making->committed);
    AG_TRY(status);
    if (c)
        status = scene_plan_put(&making->plan, place, c);
    else
        scene_plan_remove(scene_plan_list(&making->plan, kind), place);
    if (status != AG_OK && !making->is_edited)
        scene_plan_reset(&making->committed);
    making->is_edited = making->is_edited || status == AG_OK;
    return status;
}

ag_status scene_making_check_arrays(const scene_making *making)
{
    const scene_call *stale = making->has_stale ? scene_plan_find_stale(&making->plan) : NULL;
    if (stale)
        log_at(making->context->log, AG_LOG_ERROR, stale->where,
               "its borrowed arrays were written to before a commit that failed: the shape has to be changed or "
               "removed, and committed");
    return stale ? AG_ERROR_ARGUMENT : AG_OK;
}

ag_status scene_making_check_kept(const scene_making *making)
{
    const scene_call *lost = scene_plan_find_lost(&making->plan);
    if (lost)
        log_at(
            making->context->log, AG_LOG_ERROR, lost->where,
            "arrays that it borrows were freed or written to: the shape has to be changed or removed before the commit");
    return lost ? AG_ERROR_ARGUMENT : AG_OK;
}

/* Whether the scene can be changed, and is committed; says in the log why not. */
static bool can_be_edited(const ag_scene *made, const char *function)
{
    if (!made)
        return false;
    const bool is_editable = made->making && made->making->is_editable;
    const char *wrong = !is_editable ? "cannot be changed: is_editable of its settings is false"
                        : !made->s   ? "is not committed yet: ag_scene_commit comes first"
                                     : NULL;
    if (!wrong)
        return scene_making_is_open(made, function);
    log_message(made->context->log, AG_LOG_ERROR, "%s: the scene %s", function, wrong);
    return false;
}

static ag_status refuse(const call_work *work, const char *what)
{
    log_at(work->making->context->log, AG_LOG_ERROR, work->call->where, "%s", what);
    return AG_ERROR_ARGUMENT;
}

/* --- what has a handle --- */

static ag_status find_placed(const call_work *work, ag_handle handle, size_t *out_place)
{
    const scene_plan *plan = &work->making->plan;
    if (handle >> 32 != work->making->serial)
        return refuse(work, handle == 0 ? "the handle is 0, which nothing has" : "the handle is another scene's");
    *out_place = scene_plan_find_placed(plan, (uint32_t)handle);
    return *out_place < plan->placed.count ? AG_OK : refuse(work, "nothing has this handle any more");
}

/* Replaces the thing of a handle by one of another description of its kind. */
static ag_status change_placed(const call_work *work, ag_handle handle, const call_given *given)
{
    size_t place;
    scene_call *c = work->call;
    AG_TRY(find_placed(work, handle, &place));
    const scene_call *was = work->making->plan.placed.calls[place];
    if (was->kind != c->kind)
        return refuse(work, was->kind == CALL_SHAPE   ? "the handle is a shape's"
                            : was->kind == CALL_LIGHT ? "the handle is a light's"
                                                      : "the handle is an instance's");
    AG_TRY(scene_call_take(work->making->context->log, given, c));
    c->number = was->number;
    AG_TRY(scene_making_mesh(work->making, c));
    return scene_making_edit(work->making, c->kind, place, c);
}

static ag_status change(ag_scene *made, const char *function, ag_handle handle, const call_given *given)
{
    call_work work;
    if (!can_be_edited(made, function))
        return AG_ERROR_ARGUMENT;
    AG_TRY(call_work_begin(made, DEED_CHANGE, given->kind, &work));
    return call_work_end(&work, change_placed(&work, handle, given));
}

ag_status ag_scene_change_shape(ag_scene *made, ag_handle handle, const ag_shape *shape_instead)
{
    return change(made, "ag_scene_change_shape", handle,
                  &(call_given){.kind = CALL_SHAPE, .description = shape_instead});
}

ag_status ag_scene_change_light(ag_scene *made, ag_handle handle, const ag_light *light_instead)
{
    return change(made, "ag_scene_change_light", handle,
                  &(call_given){.kind = CALL_LIGHT, .description = light_instead});
}

ag_status ag_scene_change_instance(ag_scene *made, ag_handle handle, const ag_instance *instance)
{
    return change(made, "ag_scene_change_instance", handle,
                  &(call_given){.kind = CALL_INSTANCE, .description = instance});
}

/* The kind of thing that the handle is of; CALL_SHAPE where that is not known. */
static call_kind kind_of(const ag_scene *made, ag_handle handle)
{
    const scene_plan *plan = &made->making->plan;
    const size_t place = scene_plan_find_placed(plan, (uint32_t)handle);
    return place < plan->placed.count ? plan->placed.calls[place]->kind : CALL_SHAPE;
}

static ag_status move(const call_work *work, ag_handle handle, const double *start, const double *end)
{
    size_t place;
    AG_TRY(find_placed(work, handle, &place));
    AG_TRY(scene_call_move(work->making->context->log, work->making->plan.placed.calls[place], start, end, work->call));
    return scene_making_edit(work->making, work->call->kind, place, work->call);
}

ag_status ag_scene_move(ag_scene *made, ag_handle handle, const double *world_from_own,
                        const double *world_from_own_end)
{
    call_work work;
    if (!can_be_edited(made, "ag_scene_move"))
        return AG_ERROR_ARGUMENT;
    AG_TRY(call_work_begin(made, DEED_MOVE, kind_of(made, handle), &work));
    return call_work_end(&work, move(&work, handle, world_from_own, world_from_own_end));
}

static ag_status assign(const call_work *work, ag_handle handle, const char *material_name)
{
    size_t place;
    AG_TRY(find_placed(work, handle, &place));
    const scene_call *was = work->making->plan.placed.calls[place];
    if (was->kind != CALL_SHAPE)
        return refuse(work, "the handle is no shape's");
    AG_TRY(scene_call_assign(was, material_name, work->call));
    return scene_making_edit(work->making, CALL_SHAPE, place, work->call);
}

ag_status ag_scene_assign_material(ag_scene *made, ag_handle handle, const char *material_name)
{
    call_work work;
    if (!can_be_edited(made, "ag_scene_assign_material"))
        return AG_ERROR_ARGUMENT;
    AG_TRY(call_work_begin(made, DEED_ASSIGN, CALL_SHAPE, &work));
    return call_work_end(&work, assign(&work, handle, material_name));
}

static ag_status remove_placed(const call_work *work, ag_handle handle)
{
    size_t place;
    AG_TRY(find_placed(work, handle, &place));
    return scene_making_edit(work->making, CALL_SHAPE, place, NULL);
}

ag_status ag_scene_remove(ag_scene *made, ag_handle handle)
{
    call_work work;
    if (!can_be_edited(made, "ag_scene_remove"))
        return AG_ERROR_ARGUMENT;
    AG_TRY(call_work_begin(made, DEED_REMOVE, kind_of(made, handle), &work));
    return call_work_end(&work, remove_placed(&work, handle));
}

/* --- what has a name --- */

static ag_status find_named(const call_work *work, size_t *out_place)
{
    const scene_call *c = work->call;
    *out_place = scene_plan_find_named(&work->making->plan, c);
    if (*out_place < work->making->plan.named.count)
        return AG_OK;
    log_at(work->making->context->log, AG_LOG_ERROR, c->where, "there is no %s \"%s\"", call_kind_name(c->kind),
           c->texts[0]);
    return AG_ERROR_ARGUMENT;
}

static ag_status change_one_named(const call_work *work, const call_given *given)
{
    size_t place;
    AG_TRY(scene_call_take(work->making->context->log, given, work->call));
    AG_TRY(find_named(work, &place));
    AG_TRY(scene_making_number(work->making, work->call));
    return scene_making_edit(work->making, work->call->kind, place, work->call);
}

static ag_status change_named(ag_scene *made, const char *function, const call_given *given)
{
    call_work work;
    if (!can_be_edited(made, function))
        return AG_ERROR_ARGUMENT;
    AG_TRY(call_work_begin(made, DEED_CHANGE, given->kind, &work));
    return call_work_end(&work, change_one_named(&work, given));
}

ag_status ag_scene_change_material(ag_scene *made, const char *name, const char *type, const ag_parameter *parameters,
                                   size_t count)
{
    return change_named(made, "ag_scene_change_material",
                        &(call_given){CALL_MATERIAL, NULL, name, type, parameters, count, AG_HINT_FILM});
}

ag_status ag_scene_change_medium(ag_scene *made, const char *name, const char *type, const ag_parameter *parameters,
                                 size_t count)
{
    return change_named(made, "ag_scene_change_medium",
                        &(call_given){CALL_MEDIUM, NULL, name, type, parameters, count, AG_HINT_FILM});
}

ag_status ag_scene_change_texture(ag_scene *made, const ag_texture *texture_instead)
{
    return change_named(made, "ag_scene_change_texture",
                        &(call_given){.kind = CALL_TEXTURE, .description = texture_instead});
}

ag_status ag_scene_change_image(ag_scene *made, const char *name, const ag_image *picture)
{
    return change_named(made, "ag_scene_change_image",
                        &(call_given){.kind = CALL_IMAGE, .description = picture, .name = name});
}

static ag_status remove_one_named(const call_work *work, const char *name, bool is_float)
{
    size_t place;
    scene_call *c = work->call;
    if (!name)
        return refuse(work, "the name is NULL");
    AG_TRY(scene_call_name(c, name, is_float));
    AG_TRY(find_named(work, &place));
    return scene_making_edit(work->making, c->kind, place, NULL);
}

ag_status ag_scene_remove_named(ag_scene *made, ag_named kind, const char *name)
{
    static const call_kind KINDS[] = {CALL_MATERIAL, CALL_MEDIUM, CALL_TEXTURE, CALL_TEXTURE, CALL_IMAGE};
    call_work work;
    if (!can_be_edited(made, "ag_scene_remove_named"))
        return AG_ERROR_ARGUMENT;
    const bool is_known = (unsigned)kind <= AG_NAMED_IMAGE;
    AG_TRY(call_work_begin(made, DEED_REMOVE, is_known ? KINDS[kind] : CALL_MATERIAL, &work));
    return call_work_end(&work, is_known ? remove_one_named(&work, name, kind == AG_NAMED_FLOAT_TEXTURE)
                                         : refuse(&work, "there is no such kind of named thing"));
}

ag_commit_counts ag_scene_commit_counts(const ag_scene *made)
{
    return made && made->making ? made->making->counts : (ag_commit_counts){0};
}
