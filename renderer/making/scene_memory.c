/* scene_memory.c: scenes of the public interface that are made by calls.
 * Rests on: pbrt-v4's file format, whose directives the calls are. Flow: afterglow.h -> [here] -> scene_call ->
 * pbrt_builder -> scene_commit.c -> scene. Threads: as in afterglow.h. */
#define _POSIX_C_SOURCE 200809L
#include "atomics.h"
#include "floating_point.h"
#include "scene_load.h"
#include "scene_making.h"
#include "shape/borrowed_arrays.h"
#include "status.h"

#include <stdlib.h>
#include <string.h>

/* The names of the public functions, for messages; each function counts its calls. */
static const char *const FUNCTIONS[DEED_COUNT][CALL_KIND_COUNT] = {
    [DEED_MAKE] = {"ag_scene_add_shape", "ag_scene_add_light", "ag_scene_add_instance", "ag_scene_set_camera",
                   "ag_scene_add_material", "ag_scene_add_medium", "ag_scene_add_texture", "ag_scene_set_hint",
                   "ag_scene_add_image"},
    [DEED_CHANGE] = {"ag_scene_change_shape", "ag_scene_change_light", "ag_scene_change_instance", "",
                     "ag_scene_change_material", "ag_scene_change_medium", "ag_scene_change_texture", "",
                     "ag_scene_change_image"},
    [DEED_MOVE] = {"ag_scene_move", "ag_scene_move", "ag_scene_move"},
    [DEED_ASSIGN] = {"ag_scene_assign_material"},
    [DEED_REMOVE] = {"ag_scene_remove", "ag_scene_remove", "ag_scene_remove", "", "ag_scene_remove_named",
                     "ag_scene_remove_named", "ag_scene_remove_named", "", "ag_scene_remove_named"}};

/* Counts the scenes that can be changed, over all contexts; part of their handles. */
static atomic_u64 scene_serials;

void scene_making_destroy(scene_making *making)
{
    if (!making)
        return;
    pbrt_builder_destroy(making->builder);
    pbrt_builder_destroy(making->meshes);
    scene_destroy(making->s);
    scene_destroy(making->mesh_scene);
    scene_plan_reset(&making->plan);
    scene_plan_reset(&making->committed);
    for (int k = 0; k < 3; k++)
        free(making->texts[k]);
    free(making);
}

ag_status scene_check_borrowed(log_sink *log, const scene *s)
{
    for (uint32_t i = 0; i < s->shape_count; i++)
        if (borrowed_arrays_are_lost(&s->shapes[i])) {
            log_message(
                log, AG_LOG_ERROR,
                "shape %u of the scene, a mesh of %u triangles: arrays that it borrows were freed or written to", i + 1,
                s->shapes[i].as.mesh.triangle_count);
            return AG_ERROR_ARGUMENT;
        }
    return AG_OK;
}

ag_status scene_check_complete(ag_context *context, const ag_scene *made)
{
    const char *wrong = !context_is_alike(context, made->context) ? "was made with a context of other settings"
                        : !made->s                                ? "is not complete: ag_scene_commit comes first"
                        : made->making && made->making->is_edited ? "was changed: ag_scene_commit comes first"
                                                                  : NULL;
    if (wrong)
        log_message(context->log, AG_LOG_ERROR, "the scene %s", wrong);
    AG_TRY(wrong ? AG_ERROR_ARGUMENT : made->making ? scene_making_check_arrays(made->making) : AG_OK);
    return scene_check_borrowed(context->log, made->s);
}

/* --- beginning --- */

static ag_status copy_request(const ag_scene_settings *settings, scene_making *making)
{
    AG_TRY(scene_request_make(making->context, settings, &making->request));
    if (settings->definition_count > 0)
        return scene_settings_refuse(making->context, "a scene from memory has no text for definitions");
    scene_request *asked = &making->request;
    const char **const texts[3] = {&asked->sky_file, &asked->camera_name, &asked->texture_cache};
    for (int k = 0; k < 3; k++)
        if (*texts[k] && !(*texts[k] = making->texts[k] = strdup(*texts[k])))
            return AG_ERROR_MEMORY;
    return AG_OK;
}

/* Meshes are made of their arrays by a builder with a scene of its own. */
static ag_status begin_meshes(scene_making *making)
{
    making->mesh_scene = scene_create();
    if (!making->mesh_scene)
        return AG_ERROR_MEMORY;
    making->mesh_scene->space = making->s->space;
    scene_set_request(making->mesh_scene, &making->request);
    making->meshes = pbrt_builder_create(&making->context->run, making->mesh_scene);
    return making->meshes ? AG_OK : AG_ERROR_MEMORY;
}

static ag_status begin(ag_context *context, const ag_scene_settings *settings, ag_scene *made)
{
    made->context = context;
    context_add_scene(context);
    scene_making *making = made->making = calloc(1, sizeof *making);
    if (!making)
        return AG_ERROR_MEMORY;
    making->context = context;
    making->is_editable = settings->is_editable;
    making->serial = (uint32_t)fetch_add_relaxed_u64(&scene_serials, 1) + 1;
    making->s = scene_create();
    if (!making->s)
        return AG_ERROR_MEMORY;
    AG_TRY(copy_request(settings, making));
    AG_TRY(scene_prepare(context, "", &making->request, making->s, &made->inputs));
    making->builder = pbrt_builder_create(&context->run, making->s);
    AG_TRY(making->builder ? AG_OK : AG_ERROR_MEMORY);
    return begin_meshes(making);
}

ag_status ag_scene_create(ag_context *context, const ag_scene_settings *settings, ag_scene **out_scene)
{
    const ag_scene_settings defaults = ag_default_scene_settings();
    if (context && !out_scene)
        log_message(context->log, AG_LOG_ERROR, "ag_scene_create: out_scene is NULL");
    if (!context || !out_scene)
        return AG_ERROR_ARGUMENT;
    ag_scene *made = calloc(1, sizeof *made);
    if (!made)
        return AG_ERROR_MEMORY;
    const unsigned callers_arithmetic = floating_point_enter();
    const ag_status status = begin(context, settings ? settings : &defaults, made);
    floating_point_leave(callers_arithmetic);
    if (status == AG_OK)
        *out_scene = made;
    else
        ag_scene_destroy(made);
    return status;
}

/* --- calls --- */

bool scene_making_is_open(const ag_scene *made, const char *function)
{
    const scene_making *making = made->making;
    const bool can_be_edited = making && making->is_editable && made->s;
    const char *wrong = NULL;
    if (can_be_edited && made->rendering_count > 0)
        wrong = "is not to be changed: a rendering of it is not finished yet";
    else if (!can_be_edited && made->s)
        wrong = "is complete already";
    else if (!can_be_edited && !making->builder)
        wrong = "can only be destroyed after the commit that failed";
    if (wrong)
        log_message(made->context->log, AG_LOG_ERROR, "%s: the scene %s", function, wrong);
    return !wrong;
}

ag_status call_work_begin(ag_scene *made, call_deed deed, call_kind kind, call_work *out_work)
{
    scene_making *making = made->making;
    const file_location where = call_place(FUNCTIONS[deed][kind], &making->call_counts[deed][kind]);
    scene_call *call = scene_call_create(kind, where);
    if (!call)
        return AG_ERROR_MEMORY;
    *out_work = (call_work){making, call, floating_point_enter(), context_begin_phase()};
    made->inputs.scene = "";
    making->context->run.inputs = &made->inputs;
    return AG_OK;
}

ag_status call_work_end(call_work *work, ag_status status)
{
    ag_context *context = work->making->context;
    if (status == AG_ERROR_MEMORY)
        log_at(context->log, AG_LOG_ERROR, work->call->where, "out of memory");
    scene_call_release(work->call);
    context->run.inputs = NULL;
    context_add_to_phase(context, AG_PHASE_LOAD, work->begin);
    floating_point_leave(work->callers_arithmetic);
    return status;
}

/* Runs a call into an open scene at once, so that the caller hears now what is wrong with it. */
static ag_status read_call(scene_making *making, scene_call *c)
{
    if (c->kind == CALL_CAMERA && making->has_moving) {
        log_at(making->context->log, AG_LOG_ERROR, c->where,
               "the camera comes before what moves: its shutter says when");
        return AG_ERROR_ARGUMENT;
    }
    scene_plan *plan = &making->plan;
    call_list *list = scene_plan_list(plan, c->kind);
    const bool is_replaced = c->kind == CALL_CAMERA || c->kind == CALL_HINT;
    const size_t place = is_replaced ? scene_plan_find_named(plan, c) : list->count;
    if (c->kind == CALL_IMAGE) /* the builder borrows it */
        AG_TRY(scene_plan_put(plan, place, c));
    const ag_status status = scene_call_run(c, making->builder, making->is_editable);
    if (status != AG_OK && c->kind == CALL_IMAGE)
        scene_plan_remove(list, place);
    AG_TRY(status);
    c->has_told = true;
    making->has_moving = making->has_moving || (c->end && c->kind != CALL_CAMERA);
    return making->is_editable && c->kind != CALL_IMAGE ? scene_plan_put(plan, place, c) : AG_OK;
}

/* Adds a call to the plan of a committed scene. The next commit runs it; arrays of meshes are read now. */
static ag_status edit_in_call(scene_making *making, scene_call *c)
{
    const size_t place = c->kind <= CALL_INSTANCE ? making->plan.placed.count : scene_plan_find_named(&making->plan, c);
    if (c->kind > CALL_INSTANCE && c->kind != CALL_HINT && place < making->plan.named.count) {
        log_at(making->context->log, AG_LOG_ERROR, c->where, "there is a %s \"%s\" already", call_kind_name(c->kind),
               c->texts[0]);
        return AG_ERROR_SCENE;
    }
    return scene_making_edit(making, c->kind, place, c);
}

ag_status scene_making_mesh(scene_making *making, scene_call *c)
{
    AG_TRY(scene_call_make_mesh(c, making->meshes));
    making->counts.meshes_made += c->mesh != NULL;
    return AG_OK;
}

static ag_status take_call(const call_work *work, const call_given *given)
{
    scene_making *making = work->making;
    AG_TRY(scene_call_take(making->context->log, given, work->call));
    AG_TRY(scene_making_number(making, work->call));
    if (making->is_editable || work->call->borrowed.positions)
        AG_TRY(scene_making_mesh(making, work->call));
    return making->builder ? read_call(making, work->call) : edit_in_call(making, work->call);
}

static ag_status add(ag_scene *made, const call_given *given, ag_handle *out_handle)
{
    call_work work;
    if (!made || !scene_making_is_open(made, FUNCTIONS[DEED_MAKE][given->kind]))
        return AG_ERROR_ARGUMENT;
    AG_TRY(call_work_begin(made, DEED_MAKE, given->kind, &work));
    const ag_status status = take_call(&work, given);
    if (status == AG_OK && out_handle)
        *out_handle = scene_making_handle(work.making, work.call);
    return call_work_end(&work, status);
}

ag_status ag_scene_add_shape(ag_scene *made, const ag_shape *shape_to_add, ag_handle *out_handle)
{
    return add(made, &(call_given){.kind = CALL_SHAPE, .description = shape_to_add}, out_handle);
}

ag_status ag_scene_add_light(ag_scene *made, const ag_light *light_to_add, ag_handle *out_handle)
{
    return add(made, &(call_given){.kind = CALL_LIGHT, .description = light_to_add}, out_handle);
}

ag_status ag_scene_add_instance(ag_scene *made, const ag_instance *instance, ag_handle *out_handle)
{
    return add(made, &(call_given){.kind = CALL_INSTANCE, .description = instance}, out_handle);
}

ag_status ag_scene_add_image(ag_scene *made, const char *name, const ag_image *picture)
{
    return add(made, &(call_given){.kind = CALL_IMAGE, .description = picture, .name = name}, NULL);
}

ag_status ag_scene_add_texture(ag_scene *made, const ag_texture *texture_to_add)
{
    return add(made, &(call_given){.kind = CALL_TEXTURE, .description = texture_to_add}, NULL);
}

ag_status ag_scene_add_material(ag_scene *made, const char *name, const char *type, const ag_parameter *parameters,
                                size_t count)
{
    const call_given given = {CALL_MATERIAL, .name = name, .type = type, .parameters = parameters,
                              .parameter_count = count};
    return add(made, &given, NULL);
}

ag_status ag_scene_add_medium(ag_scene *made, const char *name, const char *type, const ag_parameter *parameters,
                              size_t count)
{
    const call_given given = {CALL_MEDIUM, .name = name, .type = type, .parameters = parameters,
                              .parameter_count = count};
    return add(made, &given, NULL);
}

ag_status ag_scene_set_hint(ag_scene *made, ag_scene_hint hint, const char *type, const ag_parameter *parameters,
                            size_t count)
{
    const call_given given = {CALL_HINT, .hint = hint, .type = type, .parameters = parameters,
                              .parameter_count = count};
    return add(made, &given, NULL);
}

/* --- camera --- */

static ag_status refuse(log_sink *log, const scene_call *c, const char *what)
{
    log_at(log, AG_LOG_ERROR, c->where, "%s", what);
    return AG_ERROR_ARGUMENT;
}

/* Reads the camera into an empty scene. */
static ag_status read_camera(ag_context *context, const ag_scene *made, const ag_camera *given, scene_call *c,
                             camera *out_camera)
{
    scene *empty = scene_create();
    if (empty)
        empty->space = made->s->space;
    pbrt_builder *builder = empty ? pbrt_builder_create(&context->run, empty) : NULL;
    ag_status status = builder ? AG_OK : AG_ERROR_MEMORY;
    if (status == AG_OK && made->rendering_count > 0)
        status = refuse(context->log, c, "a rendering of the scene is not finished yet");
    if (status == AG_OK)
        status = scene_call_take(context->log, &(call_given){.kind = CALL_CAMERA, .description = given}, c);
    if (status == AG_OK && (c->medium_outside || strcmp(c->texts[0], "realistic") == 0))
        status = refuse(context->log, c,
                        "of a scene that is complete the camera stays in its medium, and has no lens "
                        "file");
    if (status == AG_OK)
        status = scene_call_run(c, builder, false);
    if (status == AG_OK)
        *out_camera = empty->camera;
    pbrt_builder_destroy(builder);
    scene_destroy(empty);
    const char *conflict = status == AG_OK ? scene_making_find_conflict(made->s, out_camera) : NULL;
    if (conflict)
        return refuse(context->log, c, conflict);
    return status == AG_OK ? scene_check_camera(made->s, out_camera, context->log) : status;
}

/* Sets the camera of a committed scene, which may come from a file. */
static ag_status change_camera(ag_scene *made, const ag_camera *given)
{
    ag_context *context = made->context;
    const unsigned callers_arithmetic = floating_point_enter();
    const phase_begin begin = context_begin_phase();
    const file_location where = call_place(FUNCTIONS[DEED_MAKE][CALL_CAMERA], &made->camera_calls);
    scene_call *c = scene_call_create(CALL_CAMERA, where);
    camera seen;
    const ag_status status = c ? read_camera(context, made, given, c, &seen) : AG_ERROR_MEMORY;
    if (status == AG_OK && made->making) {
        scene_making_keep_camera(made);
        made->making->later_camera = seen;
        made->making->has_camera = true;
    }
    if (status == AG_OK) {
        scene_set_camera(made->s, &seen);
        made->s->has_camera = true;
        made->s->is_camera_made_up = false;
    }
    if (status == AG_ERROR_MEMORY)
        log_at(context->log, AG_LOG_ERROR, where, "out of memory");
    scene_call_release(c);
    context_add_to_phase(context, AG_PHASE_LOAD, begin);
    floating_point_leave(callers_arithmetic);
    return status;
}

ag_status ag_scene_set_camera(ag_scene *made, const ag_camera *camera_to_set)
{
    if (made && made->s)
        return change_camera(made, camera_to_set);
    return add(made, &(call_given){.kind = CALL_CAMERA, .description = camera_to_set}, NULL);
}
