/* pbrt_curves.c: Shape "curve" of a pbrt-v4 scene.
 * Rests on the format's description, pbrt.org/fileformat-v4, "Curves"; and for what a segment is in each basis on
 * Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, 6.7; Farin, "Curves and Surfaces for CAGD",
 * 2002 (all become cubic Bezier curves, exactly). Flow: pbrt_shapes -> [here] -> scene.shapes. Threads: one per
 * scene. */
#include "pbrt/pbrt_meshes.h"

#include "math/sampling.h"
#include "shape/curves.h"
#include "shape/mesh_motion.h"

#include <stdlib.h>
#include <string.h>

/* A flat segment is cut until its straight pieces keep within this share of its width, as pbrt does it; but into no
 * more than so many. */
static const double DEVIATION = 0.05;
enum { CUTS_MAX = 16 };
/* A ribbon is cut until its edges keep within this share of half its width where its normals put them; but into no more
 * than so many. */
static const double RIBBON_DEVIATION = 0.005;
enum { RIBBON_CUTS_MAX = 64 };
/* Normals that lie opposite each other, by their cosine, have no shortest way between them. */
static const double OPPOSITE = -0.9999;

typedef struct curve_source {
    const double *points, *normals;    /* 3 each; normals: NULL but for ribbons */
    size_t point_count, segment_count; /* of one set */
    uint32_t motion_segments;          /* sets of points behind the first */
    int degree;
    bool is_bspline;
    double width[2]; /* at its ends */
} curve_source;

/* A segment's four control points, and its ends' radii, in object space. */
typedef struct segment {
    double p[4][3];
    double radius[2];
} segment;

static void mix(const double *a, const double *b, double t, double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[i] * (1.0 - t) + b[i] * t;
}

/* Writes a parabola as a cubic. */
static void elevate(const double *a, const double *b, const double *c, double out[4][3])
{
    memcpy(out[0], a, 3 * sizeof(double));
    mix(a, b, 2.0 / 3.0, out[1]);
    mix(c, b, 2.0 / 3.0, out[2]);
    memcpy(out[3], c, 3 * sizeof(double));
}

/* Makes a segment as it is in one set of the points. */
static segment make_segment(const curve_source *source, size_t index, size_t set)
{
    segment s;
    const double *q =
        source->points + 3 * (set * source->point_count + index * (source->is_bspline ? 1 : (size_t)source->degree));
    for (int end = 0; end < 2; end++) {
        double t = (double)(index + (size_t)end) / (double)source->segment_count;
        s.radius[end] = 0.5 * (source->width[0] * (1.0 - t) + source->width[1] * t);
    }
    if (source->degree == 2 && source->is_bspline) {
        double first[3], last[3];
        mix(q, q + 3, 0.5, first);
        mix(q + 3, q + 6, 0.5, last);
        elevate(first, q + 3, last, s.p);
    } else if (source->degree == 2) {
        elevate(q, q + 3, q + 6, s.p);
    } else if (source->is_bspline) {
        double before[3], behind[3];
        mix(q, q + 3, 2.0 / 3.0, before);
        mix(q + 3, q + 6, 1.0 / 3.0, s.p[1]);
        mix(q + 3, q + 6, 2.0 / 3.0, s.p[2]);
        mix(q + 6, q + 9, 1.0 / 3.0, behind);
        mix(before, s.p[1], 0.5, s.p[0]);
        mix(s.p[2], behind, 0.5, s.p[3]);
    } else {
        memcpy(s.p, q, sizeof s.p);
    }
    return s;
}

/* Returns the part of a segment between two of its parameters, by its blossom. */
static segment cut(const segment *whole, double from, double to)
{
    segment part;
    const double ends[2] = {from, to};
    for (int k = 0; k < 4; k++) {
        double at[4][3];
        memcpy(at, whole->p, sizeof at);
        for (int level = 0; level < 3; level++) {
            double t = ends[level < k]; /* of three arguments the last k are the end */
            for (int i = 0; i < 3 - level; i++)
                mix(at[i], at[i + 1], t, at[i]);
        }
        memcpy(part.p[k], at[0], sizeof at[0]);
    }
    for (int end = 0; end < 2; end++)
        part.radius[end] = whole->radius[0] * (1.0 - ends[end]) + whole->radius[1] * ends[end];
    return part;
}

/* A cubic's second derivative is at most six times the largest second difference of its points; a chord over 1/n of
 * it strays by that over 8 n^2. */
static int count_cuts(const segment *s)
{
    double bend = 0.0, width = 2.0 * double_max(s->radius[0], s->radius[1]);
    for (int k = 0; k < 2; k++) {
        double square = 0.0;
        for (int i = 0; i < 3; i++) {
            double second = s->p[k][i] - 2.0 * s->p[k + 1][i] + s->p[k + 2][i];
            square += second * second;
        }
        bend = double_max(bend, sqrt(square));
    }
    double pieces = sqrt(0.75 * bend / (DEVIATION * width));
    return (int)double_clamp(ceil(pieces / CURVES_FLAT_PIECES), 1.0, CUTS_MAX);
}

/* Computes the normals of a part of a segment whose own normals turn evenly from one to the other, as control points of
 * the cubic that agrees with them at thirds. ends: of the segment, of any length. */
static void turn_normals(const double *const ends[2], double from, double to, double out[4][3])
{
    double unit[2][3], length[2] = {0.0, 0.0}, cosine = 0.0, at[4][3];
    for (int i = 0; i < 3; i++) {
        length[0] += ends[0][i] * ends[0][i];
        length[1] += ends[1][i] * ends[1][i];
    }
    for (int i = 0; i < 3; i++) {
        unit[0][i] = ends[0][i] / sqrt(length[0]);
        unit[1][i] = ends[1][i] / sqrt(length[1]);
        cosine += unit[0][i] * unit[1][i];
    }
    double angle = acos(double_clamp(cosine, -1.0, 1.0)), sine = sin(angle);
    for (int k = 0; k < 4; k++) {
        double t = from + (to - from) * k / 3.0;
        double a = sine > 1e-6 ? sin((1.0 - t) * angle) / sine : 1.0 - t, b = sine > 1e-6 ? sin(t * angle) / sine : t;
        for (int i = 0; i < 3; i++)
            at[k][i] = a * unit[0][i] + b * unit[1][i];
    }
    for (int i = 0; i < 3; i++) {
        out[0][i] = at[0][i];
        out[1][i] = (-5.0 * at[0][i] + 18.0 * at[1][i] - 9.0 * at[2][i] + 2.0 * at[3][i]) / 6.0;
        out[2][i] = (2.0 * at[0][i] - 9.0 * at[1][i] + 18.0 * at[2][i] - 5.0 * at[3][i]) / 6.0;
        out[3][i] = at[3][i];
    }
}

/* A ribbon needs the direction of its curve. Where two control points at an end coincide, the inner one is moved by
 * 1/256 of the way to the next. */
static void part_points(segment *s)
{
    static const double NEAR = 1.0 / 1024, APART = 1.0 / 256;
    for (int end = 0; end < 2; end++) {
        double *p = s->p[end ? 3 : 0], *inner = s->p[end ? 2 : 1], near = 0.0;
        for (int i = 0; i < 3; i++)
            near = double_max(near, fabs(inner[i] - p[i]));
        for (int k = 2; k <= 3; k++) {
            const double *next = s->p[end ? 3 - k : k];
            double far = 0.0;
            for (int i = 0; i < 3; i++)
                far = double_max(far, fabs(next[i] - p[i]));
            if (near < NEAR * far) {
                mix(p, next, APART, inner);
                break;
            }
        }
    }
}

typedef enum outcome { ADDED, IS_NOTHING, IS_OUT_OF_REACH, NO_MEMORY } outcome;

/* Adds one cubic, given in all its sets, in the shape's space; what has no width, no length in any of them, or is too
 * small for floats is nothing. */
static outcome add_segment(curves *c, const transform *t, double scale, const segment *sets, vec2 span,
                           double (*normals)[3])
{
    double length = 0.0, radius = scale * double_max(sets->radius[0], sets->radius[1]);
    if (curves_reserve(c, c->segment_count + 1) != AG_OK)
        return NO_MEMORY;
    curve_point *points = c->points + curves_points_of_each(c) * c->segment_count;
    for (size_t set = 0; set <= c->motion_segments; set++, points += 4) {
        const segment *s = &sets[set];
        for (int k = 0; k < 4; k++) {
            points[k].at = transform_point(t, (vec3){(float)s->p[k][0], (float)s->p[k][1], (float)s->p[k][2]});
            points[k].radius = (float)(scale * (s->radius[0] * (3 - k) + s->radius[1] * k) / 3.0);
            if (!(vec3_max_abs(points[k].at) + points[k].radius <= PBRT_MAX_COORDINATE) ||
                !vec3_is_finite(points[k].at))
                return IS_OUT_OF_REACH;
        }
        for (int k = 1; k < 4; k++)
            length += sqrt((double)vec3_distance_squared(points[k].at, points[0].at));
    }
    if (!(radius > 1e-15 && length > 1e-15))
        return IS_NOTHING;
    c->spans[c->segment_count] = span;
    for (int k = 0; normals && k < 4; k++)
        c->normals[4 * (size_t)c->segment_count + (size_t)k] =
            transform_normal(t, (vec3){(float)normals[k][0], (float)normals[k][1], (float)normals[k][2]});
    c->segment_count++;
    return ADDED;
}

/* Adds a segment, given in all its sets, as so many parts. normals: at the ends of a ribbon, else NULL. */
static outcome add_parts(curves *c, const transform *t, double scale, const segment *whole,
                         const double *const normals[2], int cuts)
{
    segment parts[MESH_STEPS_MAX];
    outcome all = ADDED;
    for (int k = 0; k < cuts; k++) {
        double from = (double)k / cuts, to = (double)(k + 1) / cuts, turned[4][3];
        for (size_t set = 0; set <= c->motion_segments; set++)
            parts[set] = cuts > 1 ? cut(&whole[set], from, to) : whole[set];
        if (normals)
            turn_normals(normals, from, to, turned);
        outcome one = add_segment(c, t, scale, parts, (vec2){(float)from, (float)to}, normals ? turned : NULL);
        if (one == IS_OUT_OF_REACH || one == NO_MEMORY)
            return one;
        all = one == IS_NOTHING ? IS_NOTHING : all;
    }
    return all;
}

/* Adds a ribbon in as few parts as keep its shape. */
static outcome add_ribbon(curves *c, const transform *t, double scale, segment *whole, const double *const normals[2])
{
    part_points(whole);
    for (int cuts = 1;; cuts *= 2) {
        uint32_t before = c->segment_count;
        double deviation = 0.0;
        outcome all = add_parts(c, t, scale, whole, normals, cuts);
        for (uint32_t k = before; k < c->segment_count; k++)
            deviation = double_max(deviation, curves_fit_ribbon(c, k));
        if (all != ADDED || !(deviation > RIBBON_DEVIATION) || cuts == RIBBON_CUTS_MAX)
            return all;
        c->segment_count = before;
    }
}

static ag_status add_segments(pbrt_parser *parser, const parameter_list *list, const curve_source *source, curves *c)
{
    const transform *t = &parser->state.world_from_object;
    double scale = transform_uniform_scale(t);
    size_t nothing = 0;
    for (size_t i = 0; i < source->segment_count; i++) {
        segment whole[MESH_STEPS_MAX];
        int cuts = 1;
        for (size_t set = 0; set <= source->motion_segments; set++) {
            whole[set] = make_segment(source, i, set);
            if (c->type == CURVES_FLAT && count_cuts(&whole[set]) > cuts)
                cuts = count_cuts(&whole[set]);
        }
        const double *normals[2] = {source->normals, source->normals};
        outcome all;
        if (source->normals) {
            normals[0] += 3 * i, normals[1] += 3 * (i + 1);
            all = add_ribbon(c, t, scale, whole, normals);
        } else {
            all = add_parts(c, t, scale, whole, NULL, cuts);
        }
        switch (all) {
        case ADDED: break;
        case IS_NOTHING: nothing++; break;
        case IS_OUT_OF_REACH:
            return pbrt_refuse(parser, list, "P", "the curve reaches beyond 1e18 units in world space");
        case NO_MEMORY: return AG_ERROR_MEMORY;
        }
    }
    if (nothing > 0)
        log_at(parser->log, AG_LOG_WARNING, list->where,
               "Shape \"curve\": %zu of %zu segments have no length or no width and are left out", nothing,
               source->segment_count);
    return AG_OK;
}

static ag_status read_widths(pbrt_parser *parser, parameter_list *list, curve_source *source)
{
    static const char *const NAMES[2] = {"width0", "width1"};
    float width = 1.0f;
    AG_TRY(parameter_get_float(list, parser->log, "width", &width));
    for (int i = 0; i < 2; i++) {
        float at_end = width;
        AG_TRY(parameter_get_float(list, parser->log, NAMES[i], &at_end));
        if (!(at_end >= 0.0f))
            return pbrt_refuse(parser, list, parameter_list_find(list, NAMES[i]) ? NAMES[i] : "width",
                               "a curve's width should not be below 0");
        source->width[i] = (double)at_end;
    }
    return AG_OK;
}

static ag_status read_points(pbrt_parser *parser, parameter_list *list, curves_type type, curve_source *source)
{
    int64_t degree = 3;
    const char *basis = "bezier";
    AG_TRY(parameter_get_int(list, parser->log, "degree", &degree));
    AG_TRY(parameter_get_string(list, parser->log, "basis", &basis));
    AG_TRY(parameter_get_numbers(list, parser->log, "P", PARAMETER_POINT3, &source->points, &source->point_count));
    source->point_count /= 3;
    AG_TRY(pbrt_read_motion_steps(parser, list, &source->point_count, &source->motion_segments));
    if (type == CURVES_RIBBON && source->motion_segments > 0)
        return pbrt_refuse(parser, list, "motionsteps",
                           "a \"ribbon\" cannot have \"motionsteps\", as \"flat\" curves and \"cylinder\"s can");
    if (degree != 2 && degree != 3)
        return pbrt_refuse(parser, list, "degree", "\"degree\" should be 2 or 3");
    source->degree = (int)degree;
    source->is_bspline = strcmp(basis, "bspline") == 0;
    if (!source->is_bspline && strcmp(basis, "bezier") != 0)
        return pbrt_refuse(parser, list, "basis", "unknown basis \"%s\": it should be \"bezier\" or \"bspline\"",
                           basis);
    size_t n = source->point_count, d = (size_t)degree;
    if (n < d + 1 || (!source->is_bspline && (n - 1) % d != 0))
        return pbrt_refuse(parser, list, "P",
                           source->is_bspline ? "a B-spline of degree %d has %d points or more, not %zu"
                                              : "Bezier curves of degree %d have %d points, and as many as the degree "
                                                "more for each further segment, not %zu",
                           source->degree, source->degree + 1, n);
    source->segment_count = source->is_bspline ? n - d : (n - 1) / d;
    return AG_OK;
}

static ag_status read_normals(pbrt_parser *parser, parameter_list *list, curves_type type, curve_source *source)
{
    size_t count;
    AG_TRY(parameter_get_numbers(list, parser->log, "N", PARAMETER_NORMAL, &source->normals, &count));
    count /= 3;
    if (type != CURVES_RIBBON) {
        if (count > 0)
            log_at_once(parser->log, AG_LOG_WARNING, list->where, "curve normals",
                        "Shape \"curve\": \"N\" is for curves of the type \"ribbon\" and is left out");
        source->normals = NULL;
        return AG_OK;
    }
    if (count == 0)
        return pbrt_refuse(parser, list, "N", "a \"ribbon\" needs normals \"N\" at the ends of its segments");
    if (count != source->segment_count + 1)
        return pbrt_refuse(parser, list, "N", "a \"ribbon\" of %zu segments needs %zu normals, not %zu",
                           source->segment_count, source->segment_count + 1, count);
    for (size_t i = 0; i < count; i++) {
        const double *n = source->normals + 3 * i, *m = n + (i + 1 < count ? 3 : 0);
        double nn = n[0] * n[0] + n[1] * n[1] + n[2] * n[2], mm = m[0] * m[0] + m[1] * m[1] + m[2] * m[2];
        if (!(nn > 1e-60 && nn < 1e60))
            return pbrt_refuse(parser, list, "N", "a ribbon's normal has no usable length");
        if (mm > 1e-60 && n[0] * m[0] + n[1] * m[1] + n[2] * m[2] < OPPOSITE * sqrt(nn) * sqrt(mm))
            return pbrt_refuse(parser, list, "N",
                               "two normals that follow each other are opposite: which way does the ribbon turn?");
    }
    return AG_OK;
}

static ag_status read_type(pbrt_parser *parser, parameter_list *list, curves_type *out_type)
{
    static const char *const NAMES[] = {
        [CURVES_FLAT] = "flat", [CURVES_CYLINDER] = "cylinder", [CURVES_RIBBON] = "ribbon"};
    const char *name = NAMES[CURVES_FLAT];
    AG_TRY(parameter_get_string(list, parser->log, "type", &name));
    for (size_t i = 0; i < sizeof NAMES / sizeof *NAMES; i++)
        if (strcmp(name, NAMES[i]) == 0) {
            *out_type = (curves_type)i;
            return AG_OK;
        }
    return pbrt_refuse(parser, list, "type", "unknown type \"%s\": it should be \"flat\", \"cylinder\" or \"ribbon\"",
                       name);
}

/* Returns whether the material may be hair. depth ends the search: mixes that pick one another in a circle are refused
 * only once all is read. */
static bool may_be_hair(const scene *s, uint32_t material_index, int depth)
{
    const material *m = &s->materials[material_index];
    if (m->kind == MATERIAL_MIX && depth > 0)
        return may_be_hair(s, m->mixed[0], depth - 1) || may_be_hair(s, m->mixed[1], depth - 1);
    return m->kind == MATERIAL_HAIR;
}

ag_status pbrt_curve(pbrt_parser *parser, parameter_list *list)
{
    curve_source source = {0};
    int64_t split_depth;
    shape s = shape_make(SHAPE_CURVES);
    curves *c = &s.as.curves;
    AG_TRY(read_type(parser, list, &c->type));
    AG_TRY(read_points(parser, list, c->type, &source));
    c->motion_segments = source.motion_segments;
    AG_TRY(read_widths(parser, list, &source));
    AG_TRY(read_normals(parser, list, c->type, &source));
    /* how finely pbrt cuts curves for its tree; Embree sees to that itself */
    AG_TRY(parameter_get_int(list, parser->log, "splitdepth", &split_depth));
    parameter_list_warn_unused(list, parser->log);
    /* its scattering is that of a whole fibre, which a ray must meet once: pbrt's "cylinder" is flat to rays, too */
    if (c->type == CURVES_CYLINDER && may_be_hair(parser->scene, parser->state.material_index, 8))
        c->type = CURVES_FLAT;
    s.flip_normal = parser->state.reverse_orientation;
    if (c->type == CURVES_RIBBON && transform_swaps_handedness(&parser->state.world_from_object))
        s.flip_normal = !s.flip_normal;
    ag_status status = add_segments(parser, list, &source, c);
    if (status != AG_OK || c->segment_count == 0) {
        curves_reset(c);
        return status;
    }
    return pbrt_add_shape(parser, list, &s);
}
