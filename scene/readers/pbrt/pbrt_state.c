/* pbrt_state.c: the blocks of a pbrt-v4 scene, which save the graphics state and bring it back.
 * Rests on the format's description, pbrt.org/fileformat-v4, "Attributes".
 * Flow: pbrt_parser -> [here]. Threads: one per scene. */
#include "pbrt/pbrt_private.h"

#include <stdlib.h>
#include <string.h>

ag_status pbrt_world_begin(pbrt_parser *parser, file_location where)
{
    (void)where;
    AG_TRY(pbrt_settle_hints(parser));
    AG_TRY(pbrt_settle_realistic(parser));
    parser->in_world = true;
    pbrt_state *state = &parser->state;
    state->world_from_object = state->world_from_object_end = transform_identity();
    state->start_is_active = state->end_is_active = true;
    return pbrt_name_coordinate_system(parser, "world", &state->world_from_object, &state->world_from_object_end);
}

ag_status pbrt_world_end(pbrt_parser *parser, file_location where)
{
    log_at_once(parser->log, AG_LOG_WARNING, where, "WorldEnd", "WorldEnd is not part of pbrt-v4 and is ignored");
    return AG_OK;
}

ag_status pbrt_save_state(pbrt_parser *parser, file_location where, bool is_object, bool is_import)
{
    if (parser->saved_count == parser->saved_capacity) {
        size_t capacity = parser->saved_capacity ? 2 * parser->saved_capacity : 16;
        pbrt_saved_state *larger = realloc(parser->saved, capacity * sizeof *larger);
        if (!larger)
            return AG_ERROR_MEMORY;
        parser->saved = larger;
        parser->saved_capacity = capacity;
    }
    parser->saved[parser->saved_count++] = (pbrt_saved_state){parser->state, where, is_object, is_import};
    return AG_OK;
}

ag_status pbrt_restore_state(pbrt_parser *parser, file_location where, const char *directive, bool is_object)
{
    const char *begin = is_object ? "ObjectBegin" : "AttributeBegin",
               *other = is_object ? "AttributeBegin" : "ObjectBegin";
    if (parser->saved_count == 0 || parser->saved[parser->saved_count - 1].is_import)
        return pbrt_error(parser, where, strlen(directive), "%s without %s", directive, begin);
    const pbrt_saved_state *saved = &parser->saved[parser->saved_count - 1];
    if (saved->is_object != is_object)
        return pbrt_error(parser, where, strlen(directive), "%s, but %s at %s:%d:%d is still open", directive, other,
                          saved->where.file, saved->where.line, saved->where.column);
    parser->state = saved->state;
    parser->saved_count--;
    pbrt_leave_attributes(parser);
    return AG_OK;
}

ag_status pbrt_attribute_begin(pbrt_parser *parser, file_location where)
{
    return pbrt_save_state(parser, where, false, false);
}

ag_status pbrt_attribute_end(pbrt_parser *parser, file_location where)
{
    return pbrt_restore_state(parser, where, "AttributeEnd", false);
}

ag_status pbrt_transform_begin(pbrt_parser *parser, file_location where)
{
    log_at_once(
        parser->log, AG_LOG_WARNING, where, "TransformBegin",
        "TransformBegin and TransformEnd are deprecated and taken, as in pbrt-v4, for AttributeBegin and AttributeEnd");
    return pbrt_save_state(parser, where, false, false);
}

ag_status pbrt_transform_end(pbrt_parser *parser, file_location where)
{
    return pbrt_restore_state(parser, where, "TransformEnd", false);
}

ag_status pbrt_reverse_orientation(pbrt_parser *parser, file_location where)
{
    (void)where;
    parser->state.reverse_orientation = !parser->state.reverse_orientation;
    return AG_OK;
}

ag_status pbrt_check_blocks(pbrt_parser *parser, file_location end)
{
    if (parser->saved_count == 0 || parser->saved[parser->saved_count - 1].is_import)
        return AG_OK;
    const pbrt_saved_state *saved = &parser->saved[parser->saved_count - 1];
    return pbrt_error(parser, end, 1, "the file ends, but %s at %s:%d:%d is still open",
                      saved->is_object ? "ObjectBegin" : "AttributeBegin", saved->where.file, saved->where.line,
                      saved->where.column);
}

/* Imports a file. It begins with a copy of the state, and without named coordinate systems: pbrt has it so, since it
 * may read the file beside the other. Materials and textures that the file names are known everywhere. */
ag_status pbrt_import(pbrt_parser *parser, file_location where)
{
    char *name;
    file_location name_where;
    AG_TRY(pbrt_read_string(parser, "Import", "a quoted file name", &name, &name_where));
    ag_status status = pbrt_push_file(parser, name, name_where, strlen(name) + 2);
    free(name);
    if (status == AG_OK)
        status = pbrt_save_state(parser, where, false, true);
    if (status != AG_OK)
        return status;
    pbrt_file *top = &parser->files[parser->file_count - 1];
    top->is_import = true;
    top->coordinate_systems = parser->coordinate_systems;
    top->coordinate_system_count = parser->coordinate_system_count;
    top->coordinate_system_names = parser->coordinate_system_names;
    parser->coordinate_systems = NULL;
    parser->coordinate_system_count = 0;
    parser->coordinate_system_names = (name_table){0};
    return AG_OK;
}

ag_status pbrt_end_import(pbrt_parser *parser, file_location end)
{
    AG_TRY(pbrt_check_blocks(parser, end));
    parser->state = parser->saved[--parser->saved_count].state;
    pbrt_leave_attributes(parser);
    pbrt_file *top = &parser->files[parser->file_count - 1];
    free(parser->coordinate_systems);
    name_table_reset(&parser->coordinate_system_names);
    parser->coordinate_systems = top->coordinate_systems;
    parser->coordinate_system_count = top->coordinate_system_count;
    parser->coordinate_system_names = top->coordinate_system_names;
    top->coordinate_systems = NULL;
    top->coordinate_system_names = (name_table){0};
    pbrt_pop_file(parser);
    return AG_OK;
}
