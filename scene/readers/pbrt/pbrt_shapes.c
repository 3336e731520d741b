/* pbrt_shapes.c: Shape of a pbrt-v4 scene.
 * Rests on the format's description, pbrt.org/fileformat-v4, "Shapes"; and for which side is outside on Pharr, Jakob,
 * Humphreys, "Physically Based Rendering", 4th ed., 2023, ch. 6.
 * Flow: pbrt_parser -> [here] -> scene.shapes. Threads: one per scene. */
#include "pbrt/pbrt_meshes.h"

#include <stdlib.h>
#include <string.h>

/* Returns whether the last shape of the scene has this name, or has none where this is none. */
static bool is_last_named(const scene *s, const char *name)
{
    const char *before = s->shape_count > 0 ? scene_name(s, NAMED_SHAPE, s->shape_count - 1) : NULL;
    return before && name ? strcmp(before, name) == 0 : before == name;
}

ag_status pbrt_add_shape(pbrt_parser *parser, const parameter_list *list, shape *s)
{
    uint32_t index;
    s->medium_inside = pbrt_use_medium(parser, parser->state.medium_inside);
    s->medium_outside = pbrt_use_medium(parser, parser->state.medium_outside);
    s->has_medium_interface = s->medium_inside != s->medium_outside;
    s->alpha = parser->alpha;
    s->alpha_texture = parser->alpha_texture;
    s->material_index = parser->state.material_index;
    s->light_index = SHAPE_NO_LIGHT;
    bool shines = parser->state.area_light.is_set;
    if (shines && s->kind == SHAPE_CURVES)
        log_at_once(parser->log, AG_LOG_WARNING, list->where, "curve light",
                    "Shape \"curve\" cannot shine, nor can it in pbrt: its area light is left out");
    if (s->kind == SHAPE_CURVES && is_last_named(parser->scene, parser->shape_name))
        return scene_add_curves(parser->scene, parser->shapes_object_index, s);
    if (shines && parser->state.has_no_surface) {
        log_at(parser->log, AG_LOG_WARNING, list->where,
               "a shape with the material \"interface\" cannot shine: its area light is left out");
        shines = false;
    }
    if (shines && parser->open_object)
        return pbrt_add_object_lamp(parser, s, list->where);
    AG_TRY(scene_add_object_shape(parser->scene, parser->shapes_object_index, s, &index));
    return shines ? pbrt_add_area_light(parser, &parser->state.area_light, index, list->where) : AG_OK;
}

/* Returns whether normals can be computed in floats, whose squares end at 1e38 and 1e-38, in object space and in the
 * world's. */
static bool is_in_reach_of_floats(const quadric *q)
{
    double r = q->radius, largest = double_max(r, 1.0 / r);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            largest = double_max(largest, fabs(q->world_from_object.m[i][j]) * double_max(r, 1.0));
            largest = double_max(largest, fabs(q->world_from_object.inverse[i][j]) * double_max(1.0 / r, 1.0));
        }
    return largest <= (double)PBRT_MAX_COORDINATE;
}

static ag_status add_quadric(pbrt_parser *parser, parameter_list *list, shape *s)
{
    quadric *q = &s->as.quadric;
    q->world_from_object = parser->state.world_from_object;
    s->flip_normal = parser->state.reverse_orientation; /* the outward normal, transformed, is outward in any mirror */
    double reach = double_max((double)q->radius, fabs((double)q->height));
    reach = double_max(reach, double_max(fabs((double)q->z_min), fabs((double)q->z_max)));
    for (int i = 0; i < 3; i++) {
        double sum = fabs(q->world_from_object.m[i][3]);
        for (int j = 0; j < 3; j++)
            sum += reach * fabs(q->world_from_object.m[i][j]);
        if (!(sum <= (double)PBRT_MAX_COORDINATE))
            return pbrt_refuse(parser, list, "radius", "it reaches beyond 1e18 units in world space");
    }
    if (!is_in_reach_of_floats(q)) {
        log_at(parser->log, AG_LOG_WARNING, list->where,
               "Shape \"%s\" is too small, or scaled by too much or too little, for floats and is left out",
               list->name);
        return AG_OK;
    }
    return pbrt_add_shape(parser, list, s);
}

/* "radius", and "phimax" as a part of a turn; as in pbrt what is above 360 degrees is a whole one. */
static ag_status read_round(pbrt_parser *parser, parameter_list *list, quadric *q)
{
    float phi_max = 360.0f;
    q->radius = 1.0f;
    AG_TRY(parameter_get_float(list, parser->log, "radius", &q->radius));
    AG_TRY(parameter_get_float(list, parser->log, "phimax", &phi_max));
    if (!(q->radius > 0.0f))
        return pbrt_refuse(parser, list, "radius", "\"radius\" should be above 0");
    if (!(phi_max > 0.0f))
        return pbrt_refuse(parser, list, "phimax", "\"phimax\" should be above 0");
    q->turn = float_min(phi_max / 360.0f, 1.0f);
    return AG_OK;
}

/* "zmin" and "zmax", which as in pbrt may be the wrong way round. */
static ag_status read_heights(pbrt_parser *parser, parameter_list *list, float z_min, float z_max, quadric *q)
{
    AG_TRY(parameter_get_float(list, parser->log, "zmin", &z_min));
    AG_TRY(parameter_get_float(list, parser->log, "zmax", &z_max));
    q->z_min = float_min(z_min, z_max);
    q->z_max = float_max(z_min, z_max);
    return AG_OK;
}

static ag_status read_sphere(pbrt_parser *parser, parameter_list *list)
{
    shape s = shape_make(SHAPE_SPHERE);
    quadric *q = &s.as.quadric;
    AG_TRY(read_round(parser, list, q));
    AG_TRY(read_heights(parser, list, -q->radius, q->radius, q));
    q->z_min = float_max(q->z_min, -q->radius);
    q->z_max = float_min(q->z_max, q->radius);
    if (!(q->z_min < q->z_max))
        return pbrt_refuse(parser, list, "zmin", "nothing of the sphere lies between \"zmin\" and \"zmax\"");
    parameter_list_warn_unused(list, parser->log);
    return add_quadric(parser, list, &s);
}

static ag_status read_cylinder(pbrt_parser *parser, parameter_list *list)
{
    shape s = shape_make(SHAPE_CYLINDER);
    quadric *q = &s.as.quadric;
    AG_TRY(read_round(parser, list, q));
    AG_TRY(read_heights(parser, list, -1.0f, 1.0f, q));
    if (!(q->z_min < q->z_max))
        return pbrt_refuse(parser, list, "zmin", "\"zmin\" should differ from \"zmax\"");
    parameter_list_warn_unused(list, parser->log);
    return add_quadric(parser, list, &s);
}

static ag_status read_disk(pbrt_parser *parser, parameter_list *list)
{
    shape s = shape_make(SHAPE_DISK);
    quadric *q = &s.as.quadric;
    AG_TRY(read_round(parser, list, q));
    AG_TRY(parameter_get_float(list, parser->log, "innerradius", &q->inner_radius));
    AG_TRY(parameter_get_float(list, parser->log, "height", &q->height));
    if (!(q->inner_radius >= 0.0f && q->inner_radius < q->radius))
        return pbrt_refuse(parser, list, "innerradius", "\"innerradius\" should be from 0 to below \"radius\"");
    parameter_list_warn_unused(list, parser->log);
    return add_quadric(parser, list, &s);
}

/* Returns whether a shape has no effect: an interface with the same medium on both sides. */
static bool is_nothing(const pbrt_parser *parser)
{
    return parser->state.has_no_surface && !parser->state.area_light.is_set &&
           parser->state.medium_inside == parser->state.medium_outside;
}

/* Reads the alpha of the shape that is read next. */
static ag_status read_alpha(pbrt_parser *parser, parameter_list *list)
{
    float alpha = 1.0f;
    AG_TRY(pbrt_get_float_texture(parser, list, "alpha", &alpha, &parser->alpha_texture));
    parser->alpha = float_clamp(alpha, 0.0f, 1.0f);
    return AG_OK;
}

/* Adds a mesh that shares what was made of its arrays before, in the same space. */
static ag_status add_made_mesh(pbrt_parser *parser, parameter_list *list)
{
    const parameter *file = parameter_list_find(list, "filename");
    const uint32_t index = parser->scene->shape_count;
    if (parser->made_mesh->as.mesh.triangle_count == 0)
        return AG_OK;
    AG_TRY(pbrt_add_made_mesh(parser, list));
    return file && file->strings && parser->scene->shape_count > index
               ? scene_set_name(parser->scene, NAMED_SHAPE, index, file->strings[0])
               : AG_OK;
}

static ag_status read_kind(pbrt_parser *parser, parameter_list *list)
{
    static const char *const OLD[] = {"cone", "paraboloid", "hyperboloid", "heightfield", "heightfield2", "nurbs"};
    typedef ag_status reader(pbrt_parser *, parameter_list *);
    static const struct {
        const char *name;
        reader *read;
    } READERS[] = {{"sphere", read_sphere},
                   {"cylinder", read_cylinder},
                   {"disk", read_disk},
                   {"plymesh", pbrt_ply_mesh},
                   {"loopsubdiv", pbrt_loop_subdivision},
                   {"trianglemesh", pbrt_triangle_mesh},
                   {"bilinearmesh", pbrt_bilinear_mesh},
                   {"curve", pbrt_curve}};
    AG_TRY(read_alpha(parser, list));
    if (!pbrt_has_motion_steps(list->name) && parameter_list_find(list, "motionsteps"))
        return pbrt_refuse(
            parser, list, "motionsteps",
            "Shape \"%s\" cannot have \"motionsteps\", as \"trianglemesh\", \"loopsubdiv\" and \"curve\" can",
            list->name);
    if (parser->made_mesh)
        return is_nothing(parser) ? AG_OK : add_made_mesh(parser, list);
    for (size_t i = 0; i < sizeof READERS / sizeof *READERS; i++)
        if (strcmp(list->name, READERS[i].name) == 0) {
            if (is_nothing(parser))
                return AG_OK;
            return READERS[i].read(parser, list);
        }
    for (size_t i = 0; i < sizeof OLD / sizeof *OLD; i++)
        if (strcmp(list->name, OLD[i]) == 0) {
            log_at_once(parser->log, AG_LOG_WARNING, list->where, OLD[i],
                        "Shape \"%s\" is pbrt-v3's and not part of pbrt-v4: it is left out", list->name);
            return AG_OK;
        }
    return pbrt_error(parser, list->where, strlen("Shape"), "unknown shape \"%s\"", list->name);
}

/* "name", which pbrt does not have: what Cryptomattes call the shape. */
static ag_status read_shape(pbrt_parser *parser, parameter_list *list)
{
    const uint32_t first = parser->scene->shape_count;
    parser->shape_name = NULL;
    AG_TRY(parameter_get_string(list, parser->log, "name", &parser->shape_name));
    if (parser->shape_name && !*parser->shape_name)
        parser->shape_name = NULL;
    ag_status status = read_kind(parser, list);
    for (uint32_t i = first; status == AG_OK && i < parser->scene->shape_count; i++)
        status = scene_set_name(parser->scene, NAMED_SHAPE, i, parser->shape_name);
    return status;
}

static bool is_curve(const parameter_list *list) { return strcmp(list->name, "curve") == 0; }

/* Returns whether the transform stretches a curve unevenly: its width is that of its own space, where it is alike all
 * round. */
static bool is_stretched_curve(const pbrt_parser *parser, const parameter_list *list)
{
    return is_curve(list) && !(transform_uniform_scale(&parser->state.world_from_object) > 0.0);
}

/* Returns whether the current transform moves between its ends as that of the curves before. */
static bool is_same_between(const pbrt_parser *parser)
{
    const pbrt_state *state = &parser->state;
    if (parser->curves_between_count != state->between_count)
        return false;
    for (uint32_t i = 0; i < state->between_count; i++)
        if (memcmp(parser->curves_between[i].m, state->between[i].m, sizeof state->between[i].m) != 0)
            return false;
    return true;
}

/* Returns whether curves join those that have been put there just before. */
static bool joins_curves(const pbrt_parser *parser, const parameter_list *list)
{
    const pbrt_state *state = &parser->state;
    const parameter *name = parameter_list_find(list, "name");
    return is_curve(list) && parser->curves_object_index != SCENE_NO_OBJECT &&
           is_last_named(parser->scene, name && name->strings ? name->strings[0] : NULL) &&
           parser->curves_object_around == parser->shapes_object_index &&
           memcmp(parser->curves_start.m, state->world_from_object.m, sizeof parser->curves_start.m) == 0 &&
           memcmp(parser->curves_end.m, state->world_from_object_end.m, sizeof parser->curves_end.m) == 0 &&
           is_same_between(parser);
}

/* Notes that curves have been put into an object of their own, along the current transform. */
static ag_status note_curves(pbrt_parser *parser, uint32_t object_index)
{
    const pbrt_state *state = &parser->state;
    const size_t count = state->between_count;
    transform *between = count > 0 ? malloc(count * sizeof *between) : NULL;
    if (count > 0 && !between)
        return AG_ERROR_MEMORY;
    if (count > 0)
        memcpy(between, state->between, count * sizeof *between);
    free(parser->curves_between);
    parser->curves_between = between;
    parser->curves_between_count = state->between_count;
    parser->curves_object_index = object_index;
    parser->curves_object_around = parser->shapes_object_index;
    parser->curves_start = state->world_from_object;
    parser->curves_end = state->world_from_object_end;
    return AG_OK;
}

/* A shape that moves is, as in pbrt, an object of its own in its own space, of which there is one instance. */
static ag_status read_moving_shape(pbrt_parser *parser, parameter_list *list)
{
    pbrt_state *state = &parser->state;
    const transform start = state->world_from_object, end = state->world_from_object_end;
    const uint32_t between_count = state->between_count;
    uint32_t object_index, object_around = parser->shapes_object_index, count = parser->scene->shape_count;
    bool is_shown = joins_curves(parser, list);
    if (is_shown)
        object_index = parser->curves_object_index;
    else
        AG_TRY(scene_add_object(parser->scene, &object_index));
    state->world_from_object = state->world_from_object_end = transform_identity();
    state->between_count = 0;
    parser->shapes_object_index = object_index;
    ag_status status = read_shape(parser, list);
    parser->shapes_object_index = object_around;
    state->world_from_object = start;
    state->world_from_object_end = end;
    state->between_count = between_count;
    if (status != AG_OK || is_shown || parser->scene->shape_count == count) /* the last: it was left out */
        return status;
    if (is_curve(list))
        AG_TRY(note_curves(parser, object_index));
    return pbrt_show_moving_shape(parser, object_index, list->where);
}

ag_status pbrt_shape(pbrt_parser *parser, file_location where)
{
    parameter_list list;
    AG_TRY(pbrt_read_named_parameters(parser, "Shape", "a quoted type", where, &list));
    if (pbrt_is_flattened(parser, where, "Shape")) {
        parameter_list_reset(&list);
        return AG_OK;
    }
    bool shines = parser->state.area_light.is_set && !is_curve(&list);
    if (shines)
        pbrt_warn_still(parser, where, "a shape with an area light");
    bool has_own_space = (pbrt_is_moving(parser) && !shines) || is_stretched_curve(parser, &list);
    ag_status status = has_own_space ? read_moving_shape(parser, &list) : read_shape(parser, &list);
    parameter_list_reset(&list);
    return status;
}
