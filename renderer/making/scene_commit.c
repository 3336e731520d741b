/* scene_commit.c: the commit of scenes that are made by calls: what has been said becomes what rays meet.
 * Flow: scene_memory.c, scene_editing.c -> scene_plan -> [here] -> scene. Threads: as in afterglow.h. */
#define _POSIX_C_SOURCE 200809L
#include "floating_point.h"
#include "scene_load.h"
#include "scene_making.h"
#include "scene_overrides.h"
#include "status.h"

#include <string.h>

static const char NAME[] = "scene from memory";

const char *scene_making_find_conflict(const scene *s, const camera *c)
{
    const bool has_shutter = c->shutter_open == s->camera.shutter_open && c->shutter_close == s->camera.shutter_close;
    return s->instance_step_count > s->instance_count && !has_shutter
               ? "what moves was made for another shutter: \"shutteropen\" and \"shutterclose\" should stay"
               : NULL;
}

/* Ends the building of a scene, and commits it. */
static ag_status complete(scene_making *making, pbrt_builder *builder, scene *s)
{
    ag_context *context = making->context;
    AG_TRY(pbrt_builder_finish(builder));
    AG_TRY(scene_overrides_apply(&context->run, NAME, true, s));
    const char *conflict = making->has_camera ? scene_making_find_conflict(s, &making->later_camera) : NULL;
    if (conflict) {
        log_message(context->log, AG_LOG_ERROR, "the camera that was set after the commit: %s", conflict);
        return AG_ERROR_ARGUMENT;
    }
    run_progress(&context->run, AG_PHASE_LOAD, 1.0);
    s->defined = strdup("");
    AG_TRY(s->defined ? AG_OK : AG_ERROR_MEMORY);
    AG_TRY(scene_complete(context, s));
    if (making->has_camera) {
        AG_TRY(scene_check_camera(s, &making->later_camera, context->log));
        scene_set_camera(s, &making->later_camera);
        s->has_camera = true;
    }
    return AG_OK;
}

/* Makes the scene anew of the plan; what has not changed is taken from the scene before. */
static ag_status run_plan(scene_making *making, scene *before, scene **out_scene)
{
    const color_config *colors;
    ag_context *context = making->context;
    AG_TRY(scene_making_check_arrays(making));
    AG_TRY(scene_making_check_kept(making));
    scene *s = *out_scene = scene_create();
    AG_TRY(s ? context_color_config(context, &colors) : AG_ERROR_MEMORY);
    s->space = context->working_space;
    s->textures.colors.config = colors;
    scene_set_request(s, &making->request);
    scene_set_before(s, before);
    pbrt_builder *builder = pbrt_builder_create(&context->run, s);
    ag_status status = builder ? scene_plan_run(&making->plan, &context->run, builder) : AG_ERROR_MEMORY;
    if (status == AG_OK)
        status = complete(making, builder, s);
    pbrt_builder_destroy(builder);
    return status;
}

void scene_making_keep_camera(ag_scene *made)
{
    scene_making *making = made->making;
    if (!making->is_edited || making->is_camera_edited)
        return;
    making->is_camera_edited = true;
    making->committed_camera = (camera_state){made->s->camera, making->later_camera, made->s->has_camera,
                                              made->s->is_camera_made_up, making->has_camera};
}

static void restore_camera(ag_scene *made)
{
    scene_making *making = made->making;
    const camera_state *was = &making->committed_camera;
    if (!making->is_camera_edited)
        return;
    scene_set_camera(made->s, &was->seen);
    made->s->has_camera = was->has_camera;
    made->s->is_camera_made_up = was->is_made_up;
    making->later_camera = was->later;
    making->has_camera = was->has_later;
    making->is_camera_edited = false;
}

static void count_commit(scene_making *making, const scene *s)
{
    making->counts.commits++;
    making->counts.trees_built += s->reuse.trees_built;
    making->counts.trees_kept += s->reuse.trees_kept;
    making->counts.pictures_read += s->textures.read_count + s->reuse.light_pictures_read;
    making->counts.pictures_kept += s->textures.kept_count + s->reuse.light_pictures_kept;
}

/* Commits a scene that can be changed. On failure the scene is what its last commit made, without the edits since. */
static ag_status commit_plan(ag_scene *made)
{
    scene_making *making = made->making;
    scene *before = made->s ? made->s : making->s, *s = NULL;
    ag_status status = run_plan(making, before, &s);
    if (status != AG_OK) {
        scene_restore_before(s);
        scene_destroy(s);
        if (made->s && making->is_edited) {
            scene_plan_reset(&making->plan);
            making->plan = making->committed;
            making->committed = (scene_plan){0};
            making->is_edited = false;
            making->has_stale = scene_plan_mark_stale(&making->plan);
            restore_camera(made);
            log_message(making->context->log, AG_LOG_ERROR, "the edits since the last commit are dropped");
        }
        return status;
    }
    scene_set_before(s, NULL);
    scene_destroy(before);
    made->s = s;
    making->s = NULL;
    scene_plan_reset(&making->committed);
    making->is_edited = making->is_camera_edited = making->has_stale = false;
    count_commit(making, s);
    return AG_OK;
}

/* Commits a scene that cannot be changed. */
static ag_status commit_once(ag_scene *made)
{
    scene_making *making = made->making;
    AG_TRY(scene_check_borrowed(making->context->log, making->s));
    AG_TRY(complete(making, making->builder, making->s));
    made->s = making->s;
    making->s = NULL;
    return AG_OK;
}

ag_status ag_scene_commit(ag_scene *made)
{
    if (!made || !scene_making_is_open(made, "ag_scene_commit"))
        return AG_ERROR_ARGUMENT;
    scene_making *making = made->making;
    if (made->s && !making->is_edited)
        return scene_making_check_arrays(making);
    const unsigned callers_arithmetic = floating_point_enter();
    made->inputs.scene = "";
    making->context->run.inputs = &made->inputs;
    run_progress(&making->context->run, AG_PHASE_LOAD, 0.0);
    const ag_status status = making->is_editable ? commit_plan(made) : commit_once(made);
    making->context->run.inputs = NULL;
    made->inputs.scene = NULL;
    pbrt_builder_destroy(making->builder);
    making->builder = NULL;
    if (status == AG_OK && !making->is_editable) {
        scene_making_destroy(making);
        made->making = NULL;
    }
    floating_point_leave(callers_arithmetic);
    return status;
}
