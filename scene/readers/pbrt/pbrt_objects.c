/* pbrt_objects.c: ObjectBegin, ObjectEnd and ObjectInstance of a pbrt-v4 scene.
 * Rests on the format's description, pbrt.org/fileformat-v4, "Object instancing". As in pbrt-v4 an instance may come
 * before its object, and an object may not contain another, nor instances. Beyond pbrt-v4, shapes within an object may
 * shine: they are copied into the world for each instance. Flow: pbrt_parser -> [here] -> scene.objects,
 * scene.instances. Threads: one per scene. */
#include "pbrt/pbrt_private.h"
#include "scene.h"

#include <stdlib.h>
#include <string.h>

/* The most lamps that instances may make, and vertices in them: each is a light to be picked, and kept whole. */
enum { LAMP_COPIES_MAX = 1 << 16, LAMP_COPY_VERTICES_MAX = 1 << 26 };

/* Makes room for one more item; returns false when out of memory. */
static bool reserve(void **items, size_t count, size_t *capacity, size_t item_bytes)
{
    if (count < *capacity)
        return true;
    size_t larger_capacity = *capacity ? 2 * *capacity : 4;
    void *larger = realloc(*items, larger_capacity * item_bytes);
    if (!larger)
        return false;
    *items = larger;
    *capacity = larger_capacity;
    return true;
}

/* Finds the object of that name, or makes it. */
static ag_status find_object(pbrt_parser *parser, const char *name, file_location where, uint32_t *out_object)
{
    if (name_table_find(&parser->object_names, name, out_object))
        return AG_OK;
    if (!reserve((void **)&parser->objects, parser->object_count, &parser->object_capacity, sizeof *parser->objects))
        return AG_ERROR_MEMORY;
    size_t size = strlen(name) + 1;
    pbrt_object made = {.name = malloc(size), .where = where};
    if (!made.name)
        return AG_ERROR_MEMORY;
    memcpy(made.name, name, size);
    ag_status status = scene_add_object(parser->scene, &made.object_index);
    if (status == AG_OK)
        status = name_table_set(&parser->object_names, name, (uint32_t)parser->object_count);
    if (status != AG_OK) {
        free(made.name);
        return status;
    }
    *out_object = (uint32_t)parser->object_count;
    parser->objects[parser->object_count++] = made;
    return scene_set_name(parser->scene, NAMED_OBJECT, made.object_index, name);
}

ag_status pbrt_enter_object(pbrt_parser *parser, const char *name, file_location where)
{
    uint32_t object;
    AG_TRY(find_object(parser, name, where, &object));
    pbrt_object *o = &parser->objects[object];
    if (o->is_shown)
        return pbrt_error(parser, where, 1, "object \"%s\" has an instance already: nothing can be added to it", name);
    parser->open_object = o;
    parser->shapes_object_index = o->object_index;
    return AG_OK;
}

void pbrt_leave_object(pbrt_parser *parser)
{
    parser->open_object = NULL;
    parser->shapes_object_index = SCENE_NO_OBJECT;
}

ag_status pbrt_object_begin(pbrt_parser *parser, file_location where)
{
    char *name;
    uint32_t object;
    AG_TRY(pbrt_read_string(parser, "ObjectBegin", "a quoted name", &name, NULL));
    if (parser->open_object) {
        free(name);
        return pbrt_error(parser, where, strlen("ObjectBegin"), "ObjectBegin within another object");
    }
    ag_status status = find_object(parser, name, where, &object);
    free(name);
    AG_TRY(status);
    pbrt_object *o = &parser->objects[object];
    if (o->is_defined)
        return pbrt_error(parser, where, strlen("ObjectBegin"), "object \"%s\" is there already, from %s:%d:%d",
                          o->name, o->where.file, o->where.line, o->where.column);
    AG_TRY(pbrt_save_state(parser, where, true, false));
    o->is_defined = true;
    o->where = where;
    parser->open_object = o;
    parser->shapes_object_index = o->object_index;
    return AG_OK;
}

ag_status pbrt_object_end(pbrt_parser *parser, file_location where)
{
    AG_TRY(pbrt_restore_state(parser, where, "ObjectEnd", true));
    pbrt_leave_object(parser);
    return AG_OK;
}

/* --- what is within an object and is no plain part of it --- */

ag_status pbrt_add_object_lamp(pbrt_parser *parser, shape *s, file_location where)
{
    pbrt_object *o = parser->open_object;
    if (!reserve((void **)&o->lamps, o->lamp_count, &o->lamp_capacity, sizeof *o->lamps)) {
        shape_reset(s);
        return AG_ERROR_MEMORY;
    }
    o->lamps[o->lamp_count++] = (pbrt_object_lamp){*s, parser->state.area_light, where};
    return AG_OK;
}

/* Adds an instance along the product of paths, of which inner may be NULL. */
static ag_status add_moving_instance(pbrt_parser *parser, uint32_t object_index, const motion_path *outer,
                                     const motion_path *inner, file_location where, const char *directive)
{
    affine steps[MOTION_STEPS_MAX];
    uint32_t index, count = motion_steps(outer, inner, steps);
    ag_status status = scene_add_instance(parser->scene, object_index, steps, count, &index);
    if (status == AG_ERROR_SCENE)
        return pbrt_error(parser, where, strlen(directive),
                          "%s: the transform cannot be undone: it is too small or too large", directive);
    return status;
}

ag_status pbrt_show_moving_shape(pbrt_parser *parser, uint32_t object_index, file_location where)
{
    motion_path path;
    pbrt_object *o = parser->open_object;
    if (o && !reserve((void **)&o->parts, o->part_count, &o->part_capacity, sizeof *o->parts))
        return AG_ERROR_MEMORY;
    AG_TRY(pbrt_make_path(parser, where, "Shape", &path));
    if (o) {
        o->parts[o->part_count++] = (pbrt_object_part){object_index, path};
        return AG_OK;
    }
    const ag_status status = add_moving_instance(parser, object_index, &path, NULL, where, "Shape");
    free(path.segments);
    return status;
}

/* --- instances --- */

/* Copies the lamps into the world, where they stand at the start time. */
static ag_status add_lamps(pbrt_parser *parser, const pbrt_object *o, const transform *world_from_object,
                           file_location where)
{
    for (size_t i = 0; i < o->lamp_count; i++) {
        const pbrt_object_lamp *lamp = &o->lamps[i];
        uint32_t index;
        shape copy;
        log_at_once(parser->log, AG_LOG_INFO, lamp->where, "lamp in object",
                    "shapes that shine within an object are copied into the world for each of its instances");
        parser->lamp_copy_count++;
        if (lamp->shape.kind == SHAPE_MESH)
            parser->lamp_copy_vertex_count += lamp->shape.as.mesh.vertex_count;
        if (parser->lamp_copy_count > LAMP_COPIES_MAX || parser->lamp_copy_vertex_count > LAMP_COPY_VERTICES_MAX)
            return pbrt_error(parser, where, strlen("ObjectInstance"),
                              "too many lamps come from the instances of objects: more than %d, or %d vertices in them",
                              LAMP_COPIES_MAX, LAMP_COPY_VERTICES_MAX);
        AG_TRY(shape_copy(&lamp->shape, world_from_object, &copy));
        vec3 low, high;
        shape_bounds(&copy, &low, &high);
        if (!(float_max(vec3_max_abs(low), vec3_max_abs(high)) <= PBRT_MAX_COORDINATE)) {
            shape_reset(&copy);
            return pbrt_error(parser, where, strlen("ObjectInstance"),
                              "a lamp of object \"%s\" reaches beyond 1e18 units in world space", o->name);
        }
        AG_TRY(scene_add_shape(parser->scene, &copy, &index));
        AG_TRY(pbrt_add_area_light(parser, &lamp->light, index, lamp->where));
    }
    return AG_OK;
}

static ag_status add_resting_instance(pbrt_parser *parser, const pbrt_object *o, const transform *world_from_object,
                                      file_location where)
{
    affine step;
    uint32_t index;
    ag_status status = AG_ERROR_SCENE;
    if (affine_from_transform(world_from_object, &step))
        status = scene_add_instance(parser->scene, o->object_index, &step, 1, &index);
    if (status == AG_ERROR_SCENE)
        return pbrt_error(parser, where, strlen("ObjectInstance"),
                          "ObjectInstance: the transform cannot be undone: it is not affine, too small or too large");
    return status;
}

/* Adds an instance of the object along the current transform. */
static ag_status add_instance(pbrt_parser *parser, const pbrt_object *o, file_location where)
{
    const transform *start = &parser->state.world_from_object;
    const bool is_moving = pbrt_is_moving(parser);
    AG_TRY(add_lamps(parser, o, start, where));
    if (!is_moving)
        AG_TRY(add_resting_instance(parser, o, start, where));
    if (!is_moving && o->part_count == 0)
        return AG_OK;
    motion_path path;
    AG_TRY(pbrt_make_path(parser, where, "ObjectInstance", &path));
    ag_status status = AG_OK;
    if (is_moving)
        status = add_moving_instance(parser, o->object_index, &path, NULL, where, "ObjectInstance");
    for (size_t i = 0; i < o->part_count && status == AG_OK; i++)
        status = add_moving_instance(parser, o->parts[i].object_index, &path, &o->parts[i].object_from_part, where,
                                     "ObjectInstance");
    free(path.segments);
    return status;
}

/* Finds the object of an instance: in a file it may come later, for a call it has to be there. */
static ag_status find_shown_object(pbrt_parser *parser, const char *name, file_location where, uint32_t *out_object)
{
    const bool is_there =
        name_table_find(&parser->object_names, name, out_object) && parser->objects[*out_object].is_defined;
    if (parser->given && !is_there)
        return pbrt_error(parser, where, 1, "no object is named \"%s\"", name);
    return find_object(parser, name, where, out_object);
}

static ag_status keep_early_instance(pbrt_parser *parser, uint32_t object, file_location where)
{
    const pbrt_state *state = &parser->state;
    if (!reserve((void **)&parser->early_instances, parser->early_instance_count, &parser->early_instance_capacity,
                 sizeof *parser->early_instances))
        return AG_ERROR_MEMORY;
    parser->early_instances[parser->early_instance_count++] =
        (pbrt_early_instance){object, state->world_from_object, state->world_from_object_end, where};
    return AG_OK;
}

ag_status pbrt_object_instance(pbrt_parser *parser, file_location where)
{
    char *name;
    uint32_t object;
    AG_TRY(pbrt_read_string(parser, "ObjectInstance", "a quoted name", &name, NULL));
    if (parser->open_object) {
        free(name);
        return pbrt_error(parser, where, strlen("ObjectInstance"), "ObjectInstance within an object");
    }
    ag_status status = find_shown_object(parser, name, where, &object);
    free(name);
    AG_TRY(status);
    pbrt_object *o = &parser->objects[object];
    if (!pbrt_is_flattened(parser, where, "ObjectInstance"))
        status = o->is_defined ? add_instance(parser, o, where) : keep_early_instance(parser, object, where);
    o->is_shown = o->is_shown || status == AG_OK;
    return status;
}

ag_status pbrt_end_objects(pbrt_parser *parser)
{
    for (size_t i = 0; i < parser->early_instance_count; i++) {
        const pbrt_early_instance *early = &parser->early_instances[i];
        const pbrt_object *o = &parser->objects[early->object];
        if (!o->is_defined)
            return pbrt_error(parser, early->where, strlen("ObjectInstance"), "no object is named \"%s\"", o->name);
        parser->state.world_from_object = early->start;
        parser->state.world_from_object_end = early->end;
        AG_TRY(add_instance(parser, o, early->where));
    }
    return AG_OK;
}

void pbrt_reset_objects(pbrt_parser *parser)
{
    for (size_t i = 0; i < parser->object_count; i++) {
        pbrt_object *o = &parser->objects[i];
        for (size_t k = 0; k < o->lamp_count; k++)
            shape_reset(&o->lamps[k].shape);
        for (size_t k = 0; k < o->part_count; k++)
            free(o->parts[k].object_from_part.segments);
        free(o->lamps);
        free(o->parts);
        free(o->name);
    }
    name_table_reset(&parser->object_names);
    free(parser->objects);
    free(parser->early_instances);
}
