/* pbrt_shapes.c: Shape of a pbrt-v4 scene.
 * Rests on the format's description, pbrt.org/fileformat-v4, "Shapes"; and for which side is outside on Pharr, Jakob,
 * Humphreys, "Physically Based Rendering", 4th ed., 2023, ch. 6.
 * Flow: pbrt_parser -> [here] -> scene.shapes. Threads: one per scene. */
#include "pbrt_private.h"

#include <stdio.h>
#include <string.h>

ag_status pbrt_add_shape(pbrt_parser *parser, const parameter_list *list, shape *s)
{
    uint32_t index;
    s->material_index = parser->state.material_index;
    s->light_index = SHAPE_NO_LIGHT;
    PBRT_TRY(scene_add_shape(parser->scene, s, &index));
    return pbrt_add_area_light(parser, index, list->where);
}

static ag_status add_quadric(pbrt_parser *parser, parameter_list *list, shape *s)
{
    quadric *q = &s->as.quadric;
    q->world_from_object = parser->state.world_from_object;
    s->flip_normal = parser->state.reverse_orientation; /* the outward normal, transformed, is outward in any mirror */
    double reach = fmax((double)q->radius, fabs((double)q->height));
    for (int i = 0; i < 3; i++) {
        double sum = fabs(q->world_from_object.m[i][3]);
        for (int j = 0; j < 3; j++)
            sum += reach * fabs(q->world_from_object.m[i][j]);
        if (!(sum <= (double)PBRT_MAX_COORDINATE))
            return pbrt_refuse(parser, list, "radius", "it reaches beyond 1e18 units in world space");
    }
    return pbrt_add_shape(parser, list, s);
}

static void warn_partial(pbrt_parser *parser, const parameter_list *list)
{
    char key[32];
    snprintf(key, sizeof key, "partial %.16s", list->name);
    log_at_once(parser->log, AG_LOG_WARNING, list->where, key,
                "partial shapes are not supported yet: a whole \"%s\" is used", list->name);
}

static ag_status read_sphere(pbrt_parser *parser, parameter_list *list)
{
    shape s;
    memset(&s, 0, sizeof s);
    s.kind = SHAPE_SPHERE;
    float radius = 1.0f, phi_max = 360.0f;
    PBRT_TRY(parameter_get_float(list, parser->log, "radius", &radius));
    if (!(radius > 0.0f))
        return pbrt_refuse(parser, list, "radius", "\"radius\" should be above 0");
    float z_min = -radius, z_max = radius;
    PBRT_TRY(parameter_get_float(list, parser->log, "zmin", &z_min));
    PBRT_TRY(parameter_get_float(list, parser->log, "zmax", &z_max));
    PBRT_TRY(parameter_get_float(list, parser->log, "phimax", &phi_max));
    if (z_min > -radius || z_max < radius || phi_max < 360.0f)
        warn_partial(parser, list);
    parameter_list_warn_unused(list, parser->log);
    s.as.quadric.radius = radius;
    return add_quadric(parser, list, &s);
}

static ag_status read_disk(pbrt_parser *parser, parameter_list *list)
{
    shape s;
    memset(&s, 0, sizeof s);
    s.kind = SHAPE_DISK;
    quadric *q = &s.as.quadric;
    float phi_max = 360.0f;
    q->radius = 1.0f;
    PBRT_TRY(parameter_get_float(list, parser->log, "radius", &q->radius));
    PBRT_TRY(parameter_get_float(list, parser->log, "innerradius", &q->inner_radius));
    PBRT_TRY(parameter_get_float(list, parser->log, "height", &q->height));
    PBRT_TRY(parameter_get_float(list, parser->log, "phimax", &phi_max));
    if (!(q->radius > 0.0f))
        return pbrt_refuse(parser, list, "radius", "\"radius\" should be above 0");
    if (!(q->inner_radius >= 0.0f && q->inner_radius < q->radius))
        return pbrt_refuse(parser, list, "innerradius", "\"innerradius\" should be from 0 to below \"radius\"");
    if (phi_max < 360.0f)
        warn_partial(parser, list);
    parameter_list_warn_unused(list, parser->log);
    return add_quadric(parser, list, &s);
}

/* Why a shape that is understood is not added; NULL when it is. */
static const char *why_left_out(const pbrt_parser *parser)
{
    if (parser->in_object)
        return "object instances are not supported yet: shapes between ObjectBegin and ObjectEnd are left out";
    if (parser->state.has_no_surface)
        return "shapes with the material \"interface\" have no surface and are left out; media are not supported yet";
    return NULL;
}

static ag_status read_shape(pbrt_parser *parser, parameter_list *list)
{
    static const char *const UNSUPPORTED[] = {"cylinder", "curve", "loopsubdiv", "plymesh"};
    typedef ag_status reader(pbrt_parser *, parameter_list *);
    static const struct {
        const char *name;
        reader *read;
    } READERS[] = {{"sphere", read_sphere},
                   {"disk", read_disk},
                   {"trianglemesh", pbrt_triangle_mesh},
                   {"bilinearmesh", pbrt_bilinear_mesh}};
    const char *left_out = why_left_out(parser);
    for (size_t i = 0; i < sizeof READERS / sizeof *READERS; i++)
        if (strcmp(list->name, READERS[i].name) == 0) {
            if (!left_out)
                return READERS[i].read(parser, list);
            log_at_once(parser->log, AG_LOG_WARNING, list->where, left_out, "%s", left_out);
            return AG_OK;
        }
    for (size_t i = 0; i < sizeof UNSUPPORTED / sizeof *UNSUPPORTED; i++)
        if (strcmp(list->name, UNSUPPORTED[i]) == 0) {
            log_at_once(parser->log, AG_LOG_WARNING, list->where, UNSUPPORTED[i],
                        "Shape \"%s\" is not supported yet and is left out", list->name);
            return AG_OK;
        }
    return pbrt_error(parser, list->where, strlen("Shape"), "unknown shape \"%s\"", list->name);
}

ag_status pbrt_shape(pbrt_parser *parser, file_location where)
{
    parameter_list list;
    PBRT_TRY(pbrt_read_named_parameters(parser, "Shape", "a quoted type", where, &list));
    ag_status status = read_shape(parser, &list);
    parameter_list_reset(&list);
    return status;
}
