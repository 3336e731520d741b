/* scene.c: owning, growing and committing a scene.
 * Threads: one builds it; committed, it is read-only. */
#define _POSIX_C_SOURCE 200809L
#include "scene.h"

#include "array_grow.h"
#include "closed_room.h"
#include "light/light_pick.h"
#include "material/bsdf.h"
#include "material/material_mips.h"
#include "material/material_table.h"
#include "material/pane.h"
#include "rays/bvh.h"
#include "rays/glued_faces.h"
#include "rays/slab_faces.h"
#include "scene_extent.h"
#include "scene_names.h"
#include "shape/curves.h"
#include "shape/mesh_motion.h"
#include "status.h"

#include <stdlib.h>
#include <string.h>

scene *scene_create(void)
{
    scene *s = calloc(1, sizeof *s);
    if (s) {
        s->space = working_space_rec709();
        s->textures.colors.space = &s->space;
        s->hints = scene_hints_default();
        s->bounds_min = (vec3){INFINITY, INFINITY, INFINITY};
        s->bounds_max = (vec3){-INFINITY, -INFINITY, -INFINITY};
        s->camera_medium = SCENE_NO_MEDIUM;
    }
    return s;
}

void scene_destroy(scene *s)
{
    if (!s)
        return;
    slab_faces_destroy(s->slab_faces);
    bvh_destroy(s->bvh);
    for (uint32_t i = 0; i < s->shape_count; i++)
        shape_reset(&s->shapes[i]);
    for (uint32_t i = 0; i < s->light_count; i++)
        light_reset(&s->lights[i]);
    texture_set_reset(&s->textures);
    for (uint32_t i = 0; i < s->file_name_count; i++)
        free(s->file_names[i]);
    for (uint32_t i = 0; i < s->light_group_count; i++)
        free(s->light_group_names[i]);
    scene_hints_reset(&s->hints);
    free(s->file_names);
    free(s->defined);
    free(s->camera_names);
    free(s->light_group_names);
    scene_names_reset(&s->names);
    free(s->shapes);
    free(s->objects);
    free(s->instances);
    free(s->instance_steps);
    free(s->object_shapes);
    free(s->materials);
    for (uint32_t i = 0; i < s->material_table_count; i++)
        material_table_release(s->material_tables[i]);
    free(s->material_tables);
    for (uint32_t i = 0; i < s->medium_count; i++)
        medium_reset(&s->media[i]);
    free(s->media);
    free(s->lights);
    light_pick_reset(s);
    free(s);
}

ag_status scene_light_group(scene *s, const char *name, uint32_t *out_index)
{
    for (uint32_t i = 0; i < s->light_group_count; i++)
        if (strcmp(s->light_group_names[i], name) == 0) {
            *out_index = i;
            return AG_OK;
        }
    if (s->light_group_count == SCENE_LIGHT_GROUPS_MAX)
        return AG_ERROR_SCENE;
    if (!s->light_group_names)
        s->light_group_names = calloc(SCENE_LIGHT_GROUPS_MAX, sizeof *s->light_group_names);
    char *copy = s->light_group_names ? strdup(name) : NULL;
    if (!copy)
        return AG_ERROR_MEMORY;
    s->light_group_names[s->light_group_count] = copy;
    *out_index = s->light_group_count++;
    return AG_OK;
}

void scene_set_request(scene *s, const scene_request *request)
{
    s->request = request;
    s->textures.limits = (texture_limits){0};
    if (request)
        s->textures.limits = (texture_limits){.memory_bytes = request->texture_memory_bytes,
                                              .cache = request->texture_cache,
                                              .cache_bytes = request->texture_cache_bytes};
}

void scene_set_before(scene *s, scene *before)
{
    s->before = before;
    s->textures.before = before ? &before->textures : NULL;
}

const char *scene_intern_file_name(scene *s, const char *name)
{
    for (uint32_t i = 0; i < s->file_name_count; i++)
        if (strcmp(s->file_names[i], name) == 0)
            return s->file_names[i];
    char *copy = strdup(name);
    if (!copy || !array_grow((void **)&s->file_names, s->file_name_count, sizeof *s->file_names)) {
        free(copy);
        return NULL;
    }
    return s->file_names[s->file_name_count++] = copy;
}

/* Finds or makes the table that the material's kind keeps of it, if any. */
static ag_status give_table(scene *s, material *m)
{
    m->table = NULL;
    if (!material_table_needed(m))
        return AG_OK;
    material_table *table = material_table_find(s->material_tables, s->material_table_count, m);
    if (!table) {
        if (!array_grow((void **)&s->material_tables, s->material_table_count, sizeof *s->material_tables))
            return AG_ERROR_MEMORY;
        material_table *before =
            s->before ? material_table_find(s->before->material_tables, s->before->material_table_count, m) : NULL;
        table = before ? material_table_hold(before) : material_table_create(m);
        if (!table)
            return AG_ERROR_MEMORY;
        s->material_tables[s->material_table_count++] = table;
    }
    m->table = table->content;
    return AG_OK;
}

ag_status scene_add_material(scene *s, const material *item, uint32_t *out_index)
{
    if (!array_grow((void **)&s->materials, s->material_count, sizeof *s->materials))
        return AG_ERROR_MEMORY;
    material *m = &s->materials[s->material_count];
    *m = *item;
    material_prepare(m);
    AG_TRY(give_table(s, m));
    *out_index = s->material_count++;
    return AG_OK;
}

ag_status scene_add_medium(scene *s, const medium *item, uint32_t *out_index)
{
    if (!array_grow((void **)&s->media, s->medium_count, sizeof *s->media)) {
        medium copy = *item;
        medium_reset(&copy);
        return AG_ERROR_MEMORY;
    }
    *out_index = s->medium_count;
    s->media[s->medium_count++] = *item;
    return AG_OK;
}

ag_status scene_add_object_shape(scene *s, uint32_t object_index, const shape *item, uint32_t *out_index)
{
    shape copy = *item;
    if (!array_grow((void **)&s->shapes, s->shape_count, sizeof *s->shapes)) {
        shape_reset(&copy);
        return AG_ERROR_MEMORY;
    }
    copy.light_index = SHAPE_NO_LIGHT;
    copy.object_index = object_index;
    *out_index = s->shape_count;
    s->shapes[s->shape_count++] = copy;
    return AG_OK;
}

ag_status scene_add_curves(scene *s, uint32_t object_index, const shape *item)
{
    uint32_t index;
    shape added = *item;
    added.object_index = object_index;
    shape *before = s->shape_count > 0 ? &s->shapes[s->shape_count - 1] : NULL;
    if (!before || !curves_can_be_joined(before, &added))
        return scene_add_object_shape(s, object_index, item, &index);
    ag_status status = curves_join(&before->as.curves, &item->as.curves);
    curves_reset(&added.as.curves);
    return status;
}

bool scene_shape_is_traced(const scene *s, const shape *item)
{
    return item->kind == SHAPE_CURVES || material_is_traced(s, item->material_index);
}

ag_status scene_add_shape(scene *s, const shape *item, uint32_t *out_index)
{
    return scene_add_object_shape(s, SCENE_NO_OBJECT, item, out_index);
}

ag_status scene_add_object(scene *s, uint32_t *out_index)
{
    if (!array_grow((void **)&s->objects, s->object_count, sizeof *s->objects))
        return AG_ERROR_MEMORY;
    *out_index = s->object_count;
    s->objects[s->object_count++] = (scene_object){0, 0};
    return AG_OK;
}

ag_status scene_add_instance(scene *s, uint32_t object_index, const affine *steps, uint32_t step_count,
                             uint32_t *out_index)
{
    for (uint32_t i = 0; i < step_count; i++)
        if (!affine_can_be_undone(&steps[i]))
            return AG_ERROR_SCENE;
    if (!array_grow((void **)&s->instances, s->instance_count, sizeof *s->instances))
        return AG_ERROR_MEMORY;
    scene_instance added = {object_index, s->instance_step_count, step_count};
    for (uint32_t i = 0; i < step_count; i++) {
        if (!array_grow((void **)&s->instance_steps, s->instance_step_count, sizeof *s->instance_steps))
            return AG_ERROR_MEMORY;
        s->instance_steps[s->instance_step_count++] = steps[i];
    }
    *out_index = s->instance_count;
    s->instances[s->instance_count++] = added;
    return AG_OK;
}

ag_status scene_add_light(scene *s, const light *item, uint32_t *out_index)
{
    if (!array_grow((void **)&s->lights, s->light_count, sizeof *s->lights)) {
        light copy = *item;
        light_reset(&copy);
        return AG_ERROR_MEMORY;
    }
    *out_index = s->light_count;
    if (item->kind == LIGHT_AREA)
        s->shapes[item->as.area.shape_index].light_index = s->light_count;
    s->lights[s->light_count++] = *item;
    return AG_OK;
}

/* The lights that stay keep their order, and shapes learn their new index. */
void scene_drop_lights(scene *s, bool (*is_dropped)(const light *l))
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < s->light_count; i++) {
        light *l = &s->lights[i];
        const bool is_kept = is_dropped && !is_dropped(l);
        if (l->kind == LIGHT_AREA)
            s->shapes[l->as.area.shape_index].light_index = is_kept ? kept : SHAPE_NO_LIGHT;
        if (is_kept)
            s->lights[kept++] = *l;
        else
            light_reset(l);
    }
    s->light_count = kept;
}

/* Beyond this a float overflows when squared. */
static const float REACH_MAX = 1e18f;

/* Whether rays that start within the ball do so in the instance's space too, where Embree refuses to trace others. */
static bool is_in_reach_of_instance(const affine *world_from_object, vec3 center, float radius)
{
    const double at[3] = {(double)center.x, (double)center.y, (double)center.z};
    const vec3 axes[3] = {{1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}};
    float reach = vec3_max_abs(instance_point_in_object(world_from_object, at));
    for (int i = 0; i < 3; i++) /* directions too */
        reach += float_max(radius, 1.0f) * vec3_max_abs(instance_direction_in_object(world_from_object, axes[i]));
    return reach <= REACH_MAX;
}

/* How far the eye gets from a point; INFINITY where it is out of reach. */
static float find_eye_distance(const camera *c, vec3 from)
{
    float distance = 0.0f;
    for (int k = 0; k < (c->is_moving ? 2 : 1); k++) {
        const transform at = c->is_moving ? camera_transform_at(c, (float)k) : c->world_from_camera;
        const vec3 eye = transform_point(&at, (vec3){0.0f, 0.0f, 0.0f});
        if (!(vec3_max_abs(eye) <= REACH_MAX) || !vec3_is_finite(eye))
            return INFINITY;
        distance = float_max(distance, vec3_length(vec3_sub(eye, from)));
    }
    return distance;
}

ag_status scene_check_camera(const scene *s, const camera *c, log_sink *log)
{
    const float away = c && s->instance_count > 0 ? find_eye_distance(c, s->bounding_center) : 0.0f;
    if (isinf(away)) {
        log_message(log, AG_LOG_ERROR, "the scene has instances, and its camera lies beyond 1e18 units in world space");
        return AG_ERROR_SCENE;
    }
    /* light from afar starts within twice the radius of the bounds */
    const float radius = float_max(2.0f * s->bounding_radius, away);
    for (uint32_t i = 0; i < s->instance_count; i++)
        for (uint32_t k = 0; k < s->instances[i].step_count; k++)
            if (!is_in_reach_of_instance(&s->instance_steps[s->instances[i].first_step + k], s->bounding_center,
                                         radius)) {
                const char *name = scene_name(s, NAMED_OBJECT, s->instances[i].object_index);
                log_message(log, AG_LOG_ERROR,
                            "an instance of object \"%s\" is so small, or so flat, that the scene reaches beyond 1e18 "
                            "units in its space",
                            name ? name : "");
                return AG_ERROR_SCENE;
            }
    return AG_OK;
}

static ag_status find_bounds(scene *s, log_sink *log)
{
    AG_TRY(scene_find_bounds(s, NULL, &s->bounds_min, &s->bounds_max));
    if (s->bounds_min.x > s->bounds_max.x) {
        s->bounding_radius = 1.0f;
        return AG_OK;
    }
    /* instances: the reader has checked the shapes' own bounds */
    if (s->instance_count > 0 && !(float_max(vec3_max_abs(s->bounds_min), vec3_max_abs(s->bounds_max)) <= REACH_MAX)) {
        log_message(log, AG_LOG_ERROR, "an instance reaches beyond 1e18 units in world space");
        return AG_ERROR_SCENE;
    }
    s->bounding_center = vec3_scale(vec3_add(s->bounds_min, s->bounds_max), 0.5f);
    s->bounding_radius = vec3_length(vec3_sub(s->bounds_max, s->bounding_center)) * 1.00001f;
    AG_TRY(scene_check_camera(s, s->has_camera ? &s->camera : NULL, log));
    return scene_find_detail(s, &s->detail_center, &s->detail_radius);
}

/* Which shapes each object has. */
static ag_status list_object_shapes(scene *s)
{
    if (s->object_count == 0)
        return AG_OK;
    s->object_shapes = malloc((size_t)(s->shape_count + 1) * sizeof *s->object_shapes);
    if (!s->object_shapes)
        return AG_ERROR_MEMORY;
    for (uint32_t i = 0; i < s->shape_count; i++)
        if (s->shapes[i].object_index != SCENE_NO_OBJECT)
            s->objects[s->shapes[i].object_index].shape_count++;
    uint32_t first = 0;
    for (uint32_t i = 0; i < s->object_count; i++) {
        s->objects[i].first_shape = first;
        first += s->objects[i].shape_count;
        s->objects[i].shape_count = 0; /* counted again as they come */
    }
    for (uint32_t i = 0; i < s->shape_count; i++)
        if (s->shapes[i].object_index != SCENE_NO_OBJECT) {
            scene_object *o = &s->objects[s->shapes[i].object_index];
            s->object_shapes[o->first_shape + o->shape_count++] = i;
        }
    return AG_OK;
}

void scene_set_camera(scene *s, const camera *c)
{
    s->camera = *c;
    s->has_motion = s->has_deforming || s->camera.is_moving || s->instance_step_count > s->instance_count;
    s->camera.medium = s->camera_medium;
    s->camera.tan_half_fov = (float)tan((double)s->camera.fov_degrees * (3.14159265358979323846 / 360.0));
}

/* Surfaces that were made anew, and as they were before: the arrays are the ones there were, for they are in trees.
 * Shapes keep their order, but for some that are gone, or new. */
static ag_status share_surfaces(scene *s)
{
    const scene *before = s->before;
    uint32_t at = 0;
    for (uint32_t i = 0; i < s->shape_count; i++) {
        const uint32_t places[2] = {at, i};
        for (int k = 0; k < 2; k++) {
            if (places[k] >= before->shape_count)
                continue;
            shape *was = &before->shapes[places[k]];
            if (shape_equals(&s->shapes[i], was))
                AG_TRY(shape_share_arrays(was, &s->shapes[i]));
            if (shape_has_same_surface(&s->shapes[i], was)) {
                s->shapes[i].area = was->area; /* of large meshes worth not to be worked out again */
                at = places[k] + 1;
                break;
            }
        }
    }
    return AG_OK;
}

void scene_restore_before(const scene *s)
{
    if (s && s->before)
        bvh_point_at(s->before->bvh, s->before);
}

static bool scatters(const scene *s, uint32_t medium_index)
{
    return medium_index < s->medium_count && medium_scatters(&s->media[medium_index]);
}

/* Whether rays may come into a medium that scatters: the eye, a lamp or a shape is in it. A medium that the file tells
 * of and nothing uses makes no difference. */
static bool has_rays_in_scattering_media(const scene *s)
{
    bool any = scatters(s, s->camera_medium);
    for (uint32_t i = 0; i < s->light_count; i++)
        any = any || (s->lights[i].kind != LIGHT_AREA && scatters(s, s->lights[i].medium));
    for (uint32_t i = 0; i < s->shape_count; i++)
        any = any || scatters(s, s->shapes[i].medium_inside) || scatters(s, s->shapes[i].medium_outside);
    return any;
}

ag_status scene_commit(scene *s, run_context *run, const char *isa)
{
    ag_status status = s->before ? share_surfaces(s) : AG_OK;
    for (uint32_t i = 0; i < s->shape_count && status == AG_OK; i++) {
        status = shape_commit(&s->shapes[i]);
        s->has_deforming =
            s->has_deforming || shape_is_deforming(&s->shapes[i]) || shape_is_moving_curves(&s->shapes[i]);
        s->has_interfaces = s->has_interfaces || material_may_be_interface(s, s->shapes[i].material_index);
        s->has_panes = s->has_panes || pane_may_be_of(s, s->shapes[i].material_index);
    }
    s->has_scattering_media = has_rays_in_scattering_media(s);
    if (status == AG_OK)
        status = list_object_shapes(s);
    if (status == AG_OK)
        status = scene_find_area(s, &s->surface_area);
    if (status == AG_OK)
        status = find_bounds(s, run->log);
    if (status != AG_OK)
        return status;
    status = bvh_create(s, run, isa, &s->reuse, &s->bvh);
    if (status == AG_OK)
        status = closed_room_furnish(s, run);
    if (status != AG_OK)
        return status;
    const camera seen = s->camera;
    scene_set_camera(s, &seen);
    status = material_mips_make(s, run);
    if (status == AG_OK)
        status = light_pick_commit(s, run->log);
    if (status == AG_OK)
        status = glued_faces_find(s, run);
    if (status == AG_OK)
        status = slab_faces_find(s, run, &s->slab_faces);
    s->has_panes = s->has_panes || s->slab_faces;
    return status;
}
