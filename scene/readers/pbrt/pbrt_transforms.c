/* pbrt_transforms.c: the directives of a pbrt-v4 scene that change or name the current transform.
 * Rests on the format's description, pbrt.org/fileformat-v4, "Transformations"; matrices there are column by column.
 * Flow: pbrt_parser -> [here] -> the graphics state. Threads: one per scene. */
#include "pbrt/pbrt_private.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Multiplies one end of the current transform, or the identity, by t. What can be inverted piece by piece may still
 * overflow as a whole. */
static ag_status apply_to(pbrt_parser *parser, file_location where, const char *directive, bool replaces,
                          const transform *t, transform *end)
{
    transform product = replaces ? *t : transform_multiply(end, t);
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            if (!isfinite(product.m[i][j]) || !isfinite(product.inverse[i][j]))
                return pbrt_error(parser, where, strlen(directive),
                                  "%s makes a transform that is too large or too small", directive);
    *end = product;
    return AG_OK;
}

static ag_status apply(pbrt_parser *parser, file_location where, const char *directive, bool replaces,
                       const transform *t)
{
    pbrt_state *state = &parser->state;
    bool is_moving = pbrt_is_moving(parser);
    if (replaces)
        state->is_flattened = false;
    if (state->start_is_active)
        AG_TRY(apply_to(parser, where, directive, replaces, t, &state->world_from_object));
    if (state->end_is_active && state->start_is_active && !is_moving)
        state->world_from_object_end = state->world_from_object;
    else if (state->end_is_active)
        AG_TRY(apply_to(parser, where, directive, replaces, t, &state->world_from_object_end));
    return AG_OK;
}

/* Takes a transform that cannot be inverted. Exporters write such ones around what cannot be seen, and pbrt reads on:
 * as long as they hold, nothing is made. Before WorldBegin they are the camera's, and an error. */
static ag_status flatten(pbrt_parser *parser, file_location where, const char *directive, const char *what)
{
    if (!parser->in_world)
        return pbrt_error(parser, where, strlen(directive), "%s cannot be undone", what);
    log_at_once(parser->log, AG_LOG_WARNING, where, "flattened",
                "%s cannot be undone: what stands below it is left out", what);
    parser->state.is_flattened = true;
    return AG_OK;
}

bool pbrt_is_flattened(pbrt_parser *parser, file_location where, const char *what)
{
    char key[64];
    if (!parser->state.is_flattened)
        return false;
    snprintf(key, sizeof key, "flattened:%s", what);
    log_at_once(parser->log, AG_LOG_WARNING, where, key,
                "%s: its transform cannot be undone: it is left out, as are any others of the kind", what);
    return true;
}

bool pbrt_is_moving(const pbrt_parser *parser)
{
    const transform *start = &parser->state.world_from_object, *end = &parser->state.world_from_object_end;
    return parser->state.between_count > 0 || memcmp(start->m, end->m, sizeof start->m) != 0;
}

/* Makes one of a path's segments, which take equally long. */
static ag_status make_segment(pbrt_parser *parser, const transform *start, const transform *end, uint32_t index,
                              uint32_t count, file_location where, const char *directive, motion *out_motion)
{
    double times[2] = {0.0, 1.0}; /* of the shutter */
    const camera *c = &parser->scene->camera;
    if (parser->scene->has_camera)
        times[0] = (double)c->shutter_open, times[1] = (double)c->shutter_close;
    const double *span = parser->transform_times;
    for (int i = 0; i < 2; i++)
        times[i] = (times[i] - span[0]) / (span[1] - span[0]) * count - index;
    if (!motion_make(start, end, times[0], times[1], out_motion))
        return pbrt_error(
            parser, where, strlen(directive),
            "%s moves by way of a transform that cannot be undone (it is not affine, too small or too large, "
            "or turns inside out on its way)",
            directive);
    return AG_OK;
}

ag_status pbrt_make_motion(pbrt_parser *parser, const transform *start, const transform *end, file_location where,
                           const char *directive, motion *out_motion)
{
    return make_segment(parser, start, end, 0, 1, where, directive, out_motion);
}

ag_status pbrt_make_path(pbrt_parser *parser, file_location where, const char *directive, motion_path *out_path)
{
    const pbrt_state *state = &parser->state;
    const uint32_t count = state->between_count + 1;
    motion *segments = malloc(count * sizeof *segments);
    ag_status status = segments ? AG_OK : AG_ERROR_MEMORY;
    for (uint32_t i = 0; i < count && status == AG_OK; i++)
        status = make_segment(parser, i > 0 ? &state->between[i - 1] : &state->world_from_object,
                              i < count - 1 ? &state->between[i] : &state->world_from_object_end, i, count, where,
                              directive, &segments[i]);
    if (status != AG_OK) {
        free(segments);
        return status;
    }
    *out_path = (motion_path){segments, count};
    return AG_OK;
}

void pbrt_warn_still(pbrt_parser *parser, file_location where, const char *what)
{
    if (pbrt_is_moving(parser))
        log_at_once(parser->log, AG_LOG_WARNING, where, what,
                    "%s that moves is not supported, as in pbrt-v4: it stands as it does at the start time", what);
}

ag_status pbrt_identity(pbrt_parser *parser, file_location where)
{
    transform t = transform_identity();
    return apply(parser, where, "Identity", true, &t);
}

ag_status pbrt_translate(pbrt_parser *parser, file_location where)
{
    double v[3];
    AG_TRY(pbrt_read_numbers(parser, "Translate", 3, v));
    transform t = transform_translate(v[0], v[1], v[2]);
    return apply(parser, where, "Translate", false, &t);
}

ag_status pbrt_scale(pbrt_parser *parser, file_location where)
{
    double v[3];
    transform t;
    AG_TRY(pbrt_read_numbers(parser, "Scale", 3, v));
    if (!transform_scale(v[0], v[1], v[2], &t)) {
        char what[96];
        snprintf(what, sizeof what, "Scale %g %g %g", v[0], v[1], v[2]);
        return flatten(parser, where, "Scale", what);
    }
    return apply(parser, where, "Scale", false, &t);
}

ag_status pbrt_rotate(pbrt_parser *parser, file_location where)
{
    double v[4];
    transform t;
    AG_TRY(pbrt_read_numbers(parser, "Rotate", 4, v));
    if (!transform_rotate(v[0], v[1], v[2], v[3], &t))
        return pbrt_error(parser, where, 6, "Rotate has no axis: %g %g %g", v[1], v[2], v[3]);
    return apply(parser, where, "Rotate", false, &t);
}

ag_status pbrt_look_at(pbrt_parser *parser, file_location where)
{
    double v[9];
    transform t;
    AG_TRY(pbrt_read_numbers(parser, "LookAt", 9, v));
    if (!transform_look_at(v, v + 3, v + 6, &t))
        return pbrt_error(parser, where, 6,
                          v[0] == v[3] && v[1] == v[4] && v[2] == v[5]
                              ? "LookAt looks at the eye itself"
                              : "LookAt has an up vector that is zero or along the view");
    return apply(parser, where, "LookAt", false, &t);
}

/* Reads [ 16 numbers ], column by column. */
static ag_status read_matrix(pbrt_parser *parser, const char *directive, bool *out_is_singular,
                             transform *out_transform)
{
    double v[16], m[4][4];
    pbrt_token token;
    AG_TRY(pbrt_next(parser, &token));
    if (token.kind != PBRT_TOKEN_OPEN)
        return pbrt_unexpected(parser, &token, directive, "[");
    AG_TRY(pbrt_read_numbers(parser, directive, 16, v));
    AG_TRY(pbrt_next(parser, &token));
    if (token.kind != PBRT_TOKEN_CLOSE)
        return pbrt_unexpected(parser, &token, directive, "] after 16 numbers");
    for (int column = 0; column < 4; column++)
        for (int row = 0; row < 4; row++)
            m[row][column] = v[4 * column + row];
    *out_is_singular = !transform_from_matrix((const double(*)[4])m, out_transform);
    return AG_OK;
}

ag_status pbrt_transform(pbrt_parser *parser, file_location where)
{
    transform t;
    bool is_singular = false;
    AG_TRY(read_matrix(parser, "Transform", &is_singular, &t));
    if (is_singular)
        return flatten(parser, where, "Transform", "the singular matrix of Transform");
    return apply(parser, where, "Transform", true, &t);
}

ag_status pbrt_concat_transform(pbrt_parser *parser, file_location where)
{
    transform t;
    bool is_singular = false;
    AG_TRY(read_matrix(parser, "ConcatTransform", &is_singular, &t));
    if (is_singular)
        return flatten(parser, where, "ConcatTransform", "the singular matrix of ConcatTransform");
    return apply(parser, where, "ConcatTransform", false, &t);
}

ag_status pbrt_name_coordinate_system(pbrt_parser *parser, const char *name, const transform *start,
                                      const transform *end)
{
    uint32_t index;
    if (!name_table_find(&parser->coordinate_system_names, name, &index)) {
        size_t count = parser->coordinate_system_count;
        if ((count & (count - 1)) == 0) { /* room has doubled at every power of two */
            size_t capacity = count ? 2 * count : 4;
            pbrt_named_transform *larger = realloc(parser->coordinate_systems, capacity * sizeof *larger);
            if (!larger || count > UINT32_MAX / 2) {
                parser->coordinate_systems = larger ? larger : parser->coordinate_systems;
                return AG_ERROR_MEMORY;
            }
            parser->coordinate_systems = larger;
        }
        index = (uint32_t)count;
        AG_TRY(name_table_set(&parser->coordinate_system_names, name, index));
        parser->coordinate_system_count++;
    }
    parser->coordinate_systems[index] = (pbrt_named_transform){*start, *end};
    return AG_OK;
}

ag_status pbrt_coordinate_system(pbrt_parser *parser, file_location where)
{
    char *name;
    (void)where;
    AG_TRY(pbrt_read_string(parser, "CoordinateSystem", "a quoted name", &name, NULL));
    ag_status status = pbrt_name_coordinate_system(parser, name, &parser->state.world_from_object,
                                                   &parser->state.world_from_object_end);
    free(name);
    return status;
}

ag_status pbrt_coord_sys_transform(pbrt_parser *parser, file_location where)
{
    char *name;
    uint32_t index;
    AG_TRY(pbrt_read_string(parser, "CoordSysTransform", "a quoted name", &name, NULL));
    if (name_table_find(&parser->coordinate_system_names, name, &index)) {
        parser->state.is_flattened = false;
        parser->state.world_from_object = parser->coordinate_systems[index].start;
        parser->state.world_from_object_end = parser->coordinate_systems[index].end;
    } else {
        log_at(parser->log, AG_LOG_WARNING, where, "no coordinate system is named \"%s\": CoordSysTransform is ignored",
               name);
    }
    free(name);
    return AG_OK;
}

ag_status pbrt_active_transform(pbrt_parser *parser, file_location where)
{
    pbrt_token token;
    (void)where;
    AG_TRY(pbrt_next(parser, &token));
    bool is_start = pbrt_token_is(&token, PBRT_TOKEN_WORD, "StartTime");
    bool is_end = pbrt_token_is(&token, PBRT_TOKEN_WORD, "EndTime");
    if (!is_start && !is_end && !pbrt_token_is(&token, PBRT_TOKEN_WORD, "All"))
        return pbrt_unexpected(parser, &token, "ActiveTransform", "StartTime, EndTime or All");
    parser->state.start_is_active = !is_end;
    parser->state.end_is_active = !is_start;
    return AG_OK;
}

ag_status pbrt_transform_times(pbrt_parser *parser, file_location where)
{
    double times[2];
    AG_TRY(pbrt_read_numbers(parser, "TransformTimes", 2, times));
    if (!(times[0] < times[1]))
        return pbrt_error(parser, where, strlen("TransformTimes"), "TransformTimes %g %g: the end should be later",
                          times[0], times[1]);
    memcpy(parser->transform_times, times, sizeof times);
    return AG_OK;
}
