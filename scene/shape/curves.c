/* curves.c: see curves.h. Points are found in double precision from Embree's parameter, which is a start only: it is
 * settled by Newton's method, so that what Embree gives up for speed does not show.
 * Threads: read only. */
#include "shape/curves.h"

#include "math/sampling.h"

#include <string.h>

enum { SETTLE_STEPS = 3, LENGTH_PARTS = 16 };

/* Rays start off a tube's surface by this share of its radius, as Embree's search for the surface is no more
 * precise. */
static const float TUBE_EPSILON_RELATIVE = 0x1p-9f;
/* A flat curve turns to each ray about its middle line, so a ray that leaves it could meet it again. At half the width
 * off the surface no ray can; the rest is for rounding. */
static const float FLAT_EPSILON_RELATIVE = 1.02f;
/* Points on a ribbon are recomputed on the surface that Embree meets, so this covers rounding alone. Photons land off
 * the surface by as much as they start off it. */
static const float RIBBON_EPSILON_RELATIVE = 0x1p-12f;

/* --- points of the axis --- */

/* A segment as it is at a time of the shutter: its control points. */
typedef struct posed {
    uint32_t index;
    curve_point points[4];
} posed;

static float mixed(float a, float b, float t) { return (1.0f - t) * a + t * b; }

/* Returns the control points of the last set before a time of the shutter; the next set follows behind them.
 * *out_share: how much of the way to that next set is done. Only for points that move. */
static const curve_point *points_before(const curves *c, uint32_t segment, float time, float *out_share)
{
    const float passed = float_clamp(time, 0.0f, 1.0f) * (float)c->motion_segments;
    const uint32_t last = c->motion_segments - 1, whole = (uint32_t)passed, step = whole < last ? whole : last;
    *out_share = passed - (float)step;
    return c->points + curves_points_of_each(c) * segment + 4 * (size_t)step;
}

static posed pose_of(const curves *c, uint32_t segment, float time)
{
    posed at = {.index = segment};
    if (c->motion_segments == 0) {
        memcpy(at.points, c->points + curves_points_of_each(c) * segment, sizeof at.points);
        return at;
    }
    float t;
    const curve_point *before = points_before(c, segment, time, &t);
    for (size_t k = 0; k < 4; k++) {
        const curve_point a = before[k], b = before[4 + k];
        at.points[k] = (curve_point){{mixed(a.at.x, b.at.x, t), mixed(a.at.y, b.at.y, t), mixed(a.at.z, b.at.z, t)},
                                     mixed(a.radius, b.radius, t)};
    }
    return at;
}

/* Returns the largest absolute coordinate that a segment reaches at a time. Where it moves, the sets before and after
 * count, since their mean is rounded by as much. */
static float reach_of(const curves *c, const posed *segment, float time)
{
    const curve_point *points = segment->points;
    size_t count = 4;
    float reach = 0.0f, share;
    if (c->motion_segments > 0) {
        points = points_before(c, segment->index, time, &share);
        count = 8;
    }
    for (size_t k = 0; k < count; k++)
        reach = float_max(reach, vec3_max_abs(points[k].at) + points[k].radius);
    return reach;
}

typedef struct axis_point {
    double p[3], d[3], dd[3]; /* the middle line, and its derivatives by u */
    double t[3];              /* unit, along it */
    double speed;             /* |d| */
    double radius, slope;     /* slope: the radius's derivative by u */
} axis_point;

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/* Subtracts from v its part along a unit vector. */
static void take_across(double v[3], const double unit[3])
{
    double along = dot(v, unit);
    for (int i = 0; i < 3; i++)
        v[i] -= along * unit[i];
}

/* Makes v unit. Returns false where it is too short to have a direction. */
static bool make_unit(double v[3])
{
    double square = dot(v, v);
    if (!(square > 1e-60))
        return false;
    double inverse = 1.0 / sqrt(square);
    for (int i = 0; i < 3; i++)
        v[i] *= inverse;
    return true;
}

static void any_across(const double unit[3], double out[3])
{
    vec3 x = frame_from_z((vec3){(float)unit[0], (float)unit[1], (float)unit[2]}).x;
    out[0] = (double)x.x, out[1] = (double)x.y, out[2] = (double)x.z;
}

static vec3 rounded(const double v[3]) { return (vec3){(float)v[0], (float)v[1], (float)v[2]}; }

static axis_point find_axis_point(const posed *segment, double u)
{
    const curve_point *q = segment->points;
    const double w = 1.0 - u, b[4] = {w * w * w, 3.0 * u * w * w, 3.0 * u * u * w, u * u * u};
    const double d[3] = {3.0 * w * w, 6.0 * u * w, 3.0 * u * u};
    double x[4][4];
    axis_point at;
    for (int k = 0; k < 4; k++) {
        x[k][0] = (double)q[k].at.x, x[k][1] = (double)q[k].at.y, x[k][2] = (double)q[k].at.z;
        x[k][3] = (double)q[k].radius;
    }
    for (int i = 0; i < 3; i++) {
        at.p[i] = b[0] * x[0][i] + b[1] * x[1][i] + b[2] * x[2][i] + b[3] * x[3][i];
        at.d[i] = d[0] * (x[1][i] - x[0][i]) + d[1] * (x[2][i] - x[1][i]) + d[2] * (x[3][i] - x[2][i]);
        at.dd[i] = 6.0 * (w * (x[2][i] - 2.0 * x[1][i] + x[0][i]) + u * (x[3][i] - 2.0 * x[2][i] + x[1][i]));
    }
    at.radius = b[0] * x[0][3] + b[1] * x[1][3] + b[2] * x[2][3] + b[3] * x[3][3];
    at.slope = d[0] * (x[1][3] - x[0][3]) + d[1] * (x[2][3] - x[1][3]) + d[2] * (x[3][3] - x[2][3]);
    at.speed = sqrt(dot(at.d, at.d));
    for (int i = 0; i < 3; i++)
        at.t[i] = at.d[i];
    if (!make_unit(at.t)) { /* two control points coincide: the way to the other end */
        for (int i = 0; i < 3; i++)
            at.t[i] = x[3][i] - x[0][i];
        if (!make_unit(at.t))
            at.t[0] = 1.0, at.t[1] = at.t[2] = 0.0;
    }
    return at;
}

/* Returns the point of the axis whose cross-section contains `point`; with a direction, the point of the axis that is
 * nearest to it as seen along that. u: a parameter near it. */
static axis_point settle(const posed *segment, const double point[3], const double *direction, double *in_out_u)
{
    double u = double_clamp(*in_out_u, 0.0, 1.0);
    axis_point at = find_axis_point(segment, u);
    for (int step = 0; step < SETTLE_STEPS; step++) {
        double to[3], d[3];
        for (int i = 0; i < 3; i++)
            to[i] = point[i] - at.p[i], d[i] = at.d[i];
        if (direction)
            take_across(d, direction);
        double slope = dot(d, d) - dot(to, at.dd);
        if (direction)
            slope += dot(to, direction) * dot(at.dd, direction);
        if (!(slope > 0.25 * dot(d, d))) /* the curve bends around the point: towards it all the same */
            slope = dot(d, d);
        if (!(slope > 0.0))
            break;
        double moved = double_clamp(u + dot(to, d) / slope, 0.0, 1.0);
        if (!(fabs(moved - u) < 0.25)) /* further than Embree errs: another part of the same curve */
            break;
        u = moved;
        at = find_axis_point(segment, u);
    }
    *in_out_u = u;
    return at;
}

/* --- ribbons --- */

/* The vector from a ribbon's middle line to its edge on the side of normal x tangent, and its derivative by u. */
typedef struct ribbon_side {
    double d[3], slope[3];
} ribbon_side;

/* The control points of the cubic that this vector follows along the segment. */
typedef struct ribbon_edge {
    double b[4][3];
} ribbon_edge;

/* Evaluates the cubic of the normals and its derivative; n is not unit. */
static void find_ribbon_normal(const curves *c, uint32_t segment, double u, double n[3], double dn[3])
{
    const vec3 *q = c->normals + 4 * (size_t)segment;
    const double w = 1.0 - u, b[4] = {w * w * w, 3.0 * u * w * w, 3.0 * u * u * w, u * u * u};
    const double db[4] = {-3.0 * w * w, 3.0 * w * (w - 2.0 * u), 3.0 * u * (2.0 * w - u), 3.0 * u * u};
    for (int i = 0; i < 3; i++)
        n[i] = dn[i] = 0.0;
    for (int k = 0; k < 4; k++) {
        const double x[3] = {(double)q[k].x, (double)q[k].y, (double)q[k].z};
        for (int i = 0; i < 3; i++)
            n[i] += b[k] * x[i], dn[i] += db[k] * x[i];
    }
}

/* Returns the unit vector across the curve and its normal, and its derivative by u. follows_bend: with the part of it
 * that is due to the curve's own turning, which Embree leaves out. */
static ribbon_side ribbon_across(const curves *c, uint32_t segment, double u, const axis_point *at, bool follows_bend)
{
    double n[3], dn[3], turn[3], bend[3];
    ribbon_side a;
    find_ribbon_normal(c, segment, u, n, dn);
    cross(n, at->d, a.d);
    cross(dn, at->d, turn);
    cross(n, at->dd, bend);
    double length = sqrt(dot(a.d, a.d));
    if (!make_unit(a.d)) { /* the normal lies along the curve, or the curve has no direction there */
        any_across(at->t, a.d);
        length = INFINITY;
    }
    for (int i = 0; i < 3; i++)
        a.slope[i] = (turn[i] + (follows_bend ? bend[i] : 0.0)) / length;
    take_across(a.slope, a.d);
    return a;
}

/* Embree's ribbon is ruled between two cubics, which have the width and the turn of the normals at their ends. */
static ribbon_edge find_ribbon_edge(const curves *c, const posed *segment)
{
    ribbon_edge edge;
    for (int end = 0; end < 2; end++) {
        axis_point at = find_axis_point(segment, end);
        ribbon_side a = ribbon_across(c, segment->index, end, &at, false);
        for (int i = 0; i < 3; i++) {
            double d = at.radius * a.d[i], slope = at.slope * a.d[i] + at.radius * a.slope[i];
            edge.b[end ? 3 : 0][i] = d;
            edge.b[end ? 2 : 1][i] = d + (end ? -slope : slope) / 3.0;
        }
    }
    return edge;
}

static ribbon_side ribbon_side_at(const ribbon_edge *edge, double u)
{
    const double w = 1.0 - u, b[4] = {w * w * w, 3.0 * u * w * w, 3.0 * u * u * w, u * u * u};
    const double d[3] = {3.0 * w * w, 6.0 * u * w, 3.0 * u * u};
    ribbon_side side;
    for (int i = 0; i < 3; i++) {
        side.d[i] = b[0] * edge->b[0][i] + b[1] * edge->b[1][i] + b[2] * edge->b[2][i] + b[3] * edge->b[3][i];
        side.slope[i] = d[0] * (edge->b[1][i] - edge->b[0][i]) + d[1] * (edge->b[2][i] - edge->b[1][i]) +
                        d[2] * (edge->b[3][i] - edge->b[2][i]);
    }
    return side;
}

double curves_fit_ribbon(curves *c, uint32_t segment)
{
    enum { POINTS = 8 };
    double even[POINTS + 1][3], largest = 0.0, widest = 0.0;
    vec3 fit[4];
    axis_point at;
    const posed still = pose_of(c, segment, 0.0f);
    for (int k = 0; k <= POINTS; k++) {
        at = find_axis_point(&still, (double)k / POINTS);
        ribbon_side a = ribbon_across(c, segment, (double)k / POINTS, &at, true);
        for (int i = 0; i < 3; i++)
            even[k][i] = at.radius * a.d[i];
        widest = double_max(widest, at.radius);
        if (k > 0 && k < POINTS)
            continue;
        double n[3], slope[3], turn;
        cross(at.t, a.d, n);
        turn = dot(a.slope, n); /* Embree takes the slope to be dn x d, and dn is along -a */
        for (int i = 0; i < 3; i++)
            slope[i] = n[i] + (k > 0 ? 1.0 : -1.0) * turn * a.d[i] / 3.0;
        fit[k > 0 ? 3 : 0] = rounded(n);
        fit[k > 0 ? 2 : 1] = rounded(slope);
    }
    memcpy(c->normals + 4 * (size_t)segment, fit, sizeof fit);
    ribbon_edge edge = find_ribbon_edge(c, &still);
    for (int k = 1; k < POINTS; k++) {
        ribbon_side side = ribbon_side_at(&edge, (double)k / POINTS);
        at = find_axis_point(&still, (double)k / POINTS);
        for (int i = 0; i < 3; i++)
            side.d[i] -= even[k][i];
        take_across(side.d, at.t); /* an edge that slides along itself is where it was */
        largest = double_max(largest, sqrt(dot(side.d, side.d)));
    }
    return widest > 0.0 ? largest / widest : 0.0;
}

/* Returns the point of a ribbon that is nearest to a point almost on it: along it by u, which comes in near it, and
 * across by *out_v in [-1, 1]. Sets the derivatives by both. */
static axis_point settle_on_ribbon(const curves *c, const posed *segment, const double point[3], double *in_out_u,
                                   double *out_v, double out_normal[3])
{
    const ribbon_edge edge = find_ribbon_edge(c, segment);
    double u = double_clamp(*in_out_u, 0.0, 1.0), v = 0.0, along[3], across[3];
    axis_point at = find_axis_point(segment, u);
    for (int step = 0;; step++) {
        ribbon_side side = ribbon_side_at(&edge, u);
        double to[3], square = dot(side.d, side.d);
        for (int i = 0; i < 3; i++)
            to[i] = point[i] - at.p[i];
        if (step == 0)
            v = square > 0.0 ? dot(to, side.d) / square : 0.0;
        v = double_clamp(v, -1.0, 1.0);
        for (int i = 0; i < 3; i++) {
            across[i] = side.d[i];
            along[i] = at.d[i] + v * side.slope[i];
            to[i] -= v * side.d[i];
        }
        double aa = dot(along, along), ab = dot(along, across), determinant = aa * square - ab * ab;
        if (step == SETTLE_STEPS || !(determinant > 1e-6 * aa * square))
            break;
        double du = (dot(to, along) * square - dot(to, across) * ab) / determinant;
        double moved = double_clamp(u + du, 0.0, 1.0);
        if (!(fabs(moved - u) < 0.25)) /* further than Embree errs: another part of the same curve */
            break;
        v += (dot(to, across) * aa - dot(to, along) * ab) / determinant;
        u = moved;
        at = find_axis_point(segment, u);
    }
    cross(along, across, out_normal);
    if (!make_unit(out_normal))
        any_across(at.t, out_normal);
    *in_out_u = u;
    *out_v = v;
    return at;
}

/* Finds the normal of a tube: rings are closer together on the inside of a bend, and a taper tilts the normal along the
 * curve. */
static void tube_normal(const axis_point *at, const double around[3], double out[3])
{
    double stretch = at->speed > 0.0 ? at->speed - at->radius * dot(around, at->dd) / at->speed : 0.0;
    for (int i = 0; i < 3; i++)
        out[i] = around[i] * stretch - at->t[i] * at->slope;
    if (!(stretch > 0.0) || !make_unit(out)) /* bent more tightly than it is thick */
        for (int i = 0; i < 3; i++)
            out[i] = around[i];
}

void curves_surface_at(const shape *s, uint32_t primitive_index, float u, vec3 position, vec3 direction, float time,
                       surface_hit *out_hit)
{
    const curves *c = &s->as.curves;
    const posed segment = pose_of(c, primitive_index, time);
    surface_hit *h = out_hit;
    double x[3] = {(double)position.x, (double)position.y, (double)position.z}, off[3], normal[3] = {0}, aside[3];
    double way[3] = {(double)direction.x, (double)direction.y, (double)direction.z};
    double along = (double)u, v = 0.0, epsilon = 0.0;
    bool is_seen = make_unit(way);
    axis_point at;
    if (c->type == CURVES_RIBBON)
        at = settle_on_ribbon(c, &segment, x, &along, &v, normal);
    else
        at = settle(&segment, x, c->type == CURVES_FLAT && is_seen ? way : NULL, &along);
    for (int i = 0; i < 3; i++)
        off[i] = x[i] - at.p[i];

    /* across the curve and towards the ray's origin; then to the side on which v grows as seen from there */
    double facing[3] = {-way[0], -way[1], -way[2]};
    take_across(facing, at.t);
    if (!make_unit(facing))
        any_across(at.t, facing);
    cross(at.t, facing, aside);

    if (c->type == CURVES_FLAT) {
        double cosine = -dot(way, facing), depth = dot(off, facing);
        for (int i = 0; i < 3; i++) {
            normal[i] = facing[i];
            x[i] += cosine > 1e-3 ? way[i] * (depth / cosine) : -facing[i] * depth;
            off[i] = x[i] - at.p[i];
        }
        v = at.radius > 0.0 ? dot(off, aside) / at.radius : 0.0;
        epsilon = (double)FLAT_EPSILON_RELATIVE * at.radius;
    } else if (c->type == CURVES_CYLINDER) {
        take_across(off, at.t);
        if (!make_unit(off))
            memcpy(off, facing, sizeof off);
        for (int i = 0; i < 3; i++)
            x[i] = at.p[i] + at.radius * off[i];
        v = dot(off, aside);
        tube_normal(&at, off, normal);
        epsilon = (double)TUBE_EPSILON_RELATIVE * at.radius;
    } else {
        double depth = dot(off, normal);
        for (int i = 0; i < 3; i++)
            x[i] -= depth * normal[i];
        epsilon = (double)RIBBON_EPSILON_RELATIVE * at.radius;
    }
    vec2 span = c->spans[primitive_index];
    h->position = rounded(x);
    h->geometric_normal = vec3_normalize(rounded(normal));
    if (s->flip_normal)
        h->geometric_normal = vec3_negate(h->geometric_normal);
    h->shading_normal = h->geometric_normal;
    h->uv = (vec2){span.x + (float)along * (span.y - span.x), (float)double_clamp(0.5 + 0.5 * v, 0.0, 1.0)};
    h->epsilon = (float)epsilon + reach_of(c, &segment, time) * SHAPE_EPSILON_RELATIVE;
    h->is_flat = false;
    h->is_strand = true;
    h->faces_rays = c->type == CURVES_FLAT;
    h->is_mirrored = c->type == CURVES_RIBBON && dot(way, normal) < 0.0;
}

surface_differentials curves_differentials(const shape *s, const surface_hit *hit)
{
    const curves *c = &s->as.curves;
    vec2 span = c->spans[hit->primitive_index];
    double share = (double)span.y - (double)span.x;
    double u = double_clamp(((double)hit->uv.x - (double)span.x) / share, 0.0, 1.0);
    const posed segment = pose_of(c, hit->primitive_index, hit->time);
    axis_point at = find_axis_point(&segment, u);
    double sign = s->flip_normal ? -1.0 : 1.0, aside[3];
    double normal[3] = {sign * (double)hit->geometric_normal.x, sign * (double)hit->geometric_normal.y,
                        sign * (double)hit->geometric_normal.z};
    surface_differentials d = {0};
    if (c->type == CURVES_RIBBON) {
        ribbon_edge edge = find_ribbon_edge(c, &segment);
        ribbon_side side = ribbon_side_at(&edge, u);
        for (int i = 0; i < 3; i++)
            aside[i] = (at.d[i] + (2.0 * (double)hit->uv.y - 1.0) * side.slope[i]) / share;
        d.dpdu = rounded(aside);
        d.dpdv = vec3_scale(rounded(side.d), 2.0f);
        return d;
    }
    cross(at.t, normal, aside);
    d.dpdu = vec3_scale(rounded(at.t), (float)(at.speed / share));
    d.dpdv = vec3_scale(rounded(aside), (float)(2.0 * at.radius));
    if (c->type == CURVES_CYLINDER)
        d.dndv = vec3_scale(rounded(aside), (float)(2.0 * sign));
    return d;
}

float curves_area(const shape *s)
{
    const curves *c = &s->as.curves;
    double area = 0.0, around = c->type == CURVES_CYLINDER ? 2.0 * (double)AG_PI : 2.0;
    for (uint32_t k = 0; k < c->segment_count; k++) {
        const posed segment = pose_of(c, k, 0.0f);
        for (int i = 0; i < LENGTH_PARTS; i++) {
            axis_point at = find_axis_point(&segment, (i + 0.5) / LENGTH_PARTS);
            area += around * at.radius * at.speed / LENGTH_PARTS;
        }
    }
    return (float)area;
}
