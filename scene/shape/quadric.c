/* quadric.c: see quadric.h. All but the last step is done in object space and in double precision.
 * Rests on: Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, ch. 6.2 to 6.4; Hearn, Baker; Haines
 * et al., "Precision Improvements for Ray/Sphere Intersection", 2019 (the discriminant). Threads: quadric_commit by one
 * thread; the rest read only. */
#include "shape/quadric.h"

#include "math/angle.h"
#include "math/sampling.h"

static const double PI = 3.14159265358979323846;

static double square(double x) { return x * x; }

static bool is_whole_sphere(const shape *s)
{
    const quadric *q = &s->as.quadric;
    return s->kind == SHAPE_SPHERE && q->turn >= 1.0f && q->z_min <= -q->radius && q->z_max >= q->radius;
}

/* --- area --- */

/* Returns the world's area per area in object space where the object's unit normal is (x, y, z): |cofactor(M) n| = |det
 * M| |M^-T n|. */
static double area_factor(const quadric *q, double x, double y, double z)
{
    const double(*m)[4] = q->world_from_object.m;
    const double(*inverse)[4] = q->world_from_object.inverse;
    double determinant = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    double sum = 0.0;
    for (int i = 0; i < 3; i++)
        sum += square(inverse[0][i] * x + inverse[1][i] * y + inverse[2][i] * z);
    return fabs(determinant) * sqrt(sum);
}

/* Archimedes: a sphere's zone has the area of the cylinder around it. */
static double object_area(const shape *s)
{
    const quadric *q = &s->as.quadric;
    if (s->kind == SHAPE_DISK)
        return PI * (double)q->turn * (square((double)q->radius) - square((double)q->inner_radius));
    return 2.0 * PI * (double)q->turn * (double)q->radius * ((double)q->z_max - (double)q->z_min);
}

float quadric_area(const shape *s)
{
    const quadric *q = &s->as.quadric;
    double area = object_area(s), scale = transform_uniform_scale(&q->world_from_object);
    if (s->kind == SHAPE_DISK)
        return (float)(area * area_factor(q, 0.0, 0.0, 1.0));
    if (scale > 0.0)
        return (float)(area * scale * scale);
    /* Ellipsoids and elliptic cylinders have no closed form: the mean factor, by midpoints; it depends on z on the
     * former only. */
    int z_steps = s->kind == SHAPE_SPHERE ? 512 : 1, phi_steps = s->kind == SHAPE_SPHERE ? 512 : 4096;
    double sum = 0.0, r = q->radius, z_min = q->z_min, z_max = q->z_max;
    for (int i = 0; i < z_steps; i++) {
        double z = s->kind == SHAPE_SPHERE ? (z_min + (z_max - z_min) * (i + 0.5) / z_steps) / r : 0.0;
        double ring = sqrt(1.0 - z * z);
        for (int j = 0; j < phi_steps; j++) {
            double phi = 2.0 * PI * (double)q->turn * (j + 0.5) / phi_steps;
            sum += area_factor(q, ring * cos(phi), ring * sin(phi), z);
        }
    }
    return (float)(sum / ((double)z_steps * phi_steps) * area);
}

/* --- bounds --- */

/* Returns how far the surface reaches along a direction of object space: the largest dot product of a point of it with
 * the direction. */
static double reach_along(const shape *s, double x, double y, double z)
{
    const quadric *q = &s->as.quadric;
    double r = q->radius, z_min = q->z_min, z_max = q->z_max;
    /* of a unit circle: its foremost point, or where that is cut off, one of the arc's ends */
    double arc = sqrt(x * x + y * y);
    if (q->turn < 1.0f && angle_turns(y, x) > (double)q->turn) {
        float sine, cosine;
        sincos_turns(q->turn, &sine, &cosine);
        arc = double_max(x, (double)cosine * x + (double)sine * y);
    }
    if (s->kind == SHAPE_DISK)
        return double_max(r * arc, (double)q->inner_radius * arc) + z * (double)q->height;
    if (s->kind == SHAPE_CYLINDER)
        return r * arc + double_max(z * z_min, z * z_max);
    /* on a sphere's meridian, arc sqrt(r^2 - h^2) + z h over the heights h */
    double length = sqrt(arc * arc + z * z), best = length > 0.0 ? r * z / length : 0.0;
    if (arc >= 0.0 && best >= z_min && best <= z_max)
        return r * length;
    return double_max(arc * sqrt(double_max(r * r - z_min * z_min, 0.0)) + z * z_min,
                      arc * sqrt(double_max(r * r - z_max * z_max, 0.0)) + z * z_max);
}

void quadric_find_bounds(const shape *s, vec3 *out_min, vec3 *out_max)
{
    const double(*m)[4] = s->as.quadric.world_from_object.m;
    float low[3], high[3];
    for (int i = 0; i < 3; i++) {
        double up = m[i][3] + reach_along(s, m[i][0], m[i][1], m[i][2]);
        double down = m[i][3] - reach_along(s, -m[i][0], -m[i][1], -m[i][2]);
        /* rounding must not shrink the box */
        double margin = (fabs(m[i][3]) + double_max(fabs(up), fabs(down)) + (up - down)) * 0x1p-22;
        low[i] = (float)(down - margin);
        high[i] = (float)(up + margin);
    }
    *out_min = (vec3){low[0], low[1], low[2]};
    *out_max = (vec3){high[0], high[1], high[2]};
}

/* Hits are put back onto the surface, so this covers a few roundings only. More would change the path of light that
 * goes round inside glass. */
#define QUADRIC_EPSILON_RELATIVE 0x1p-19f

void quadric_commit(shape *s)
{
    quadric *q = &s->as.quadric;
    double scale = transform_uniform_scale(&q->world_from_object), r = q->radius;
    float z = s->kind == SHAPE_DISK ? q->height : s->kind == SHAPE_CYLINDER ? 0.5f * (q->z_min + q->z_max) : 0.0f;
    q->center = transform_point(&q->world_from_object, (vec3){0.0f, 0.0f, z});
    q->uniform_radius = is_whole_sphere(s) ? q->radius * (float)scale : 0.0f;
    q->has_even_area = s->kind == SHAPE_DISK || scale > 0.0;
    sincos_turns(q->turn, &q->turn_sin, &q->turn_cos);
    q->theta_min = angle_turns(sqrt(double_max(square(r) - square((double)q->z_min), 0.0)), q->z_min);
    q->theta_max = angle_turns(sqrt(double_max(square(r) - square((double)q->z_max), 0.0)), q->z_max);
    vec3 low, high;
    quadric_find_bounds(s, &low, &high);
    q->epsilon = float_max(vec3_max_abs(low), vec3_max_abs(high)) * QUADRIC_EPSILON_RELATIVE;
}

/* --- samples --- */

/* Returns the outside normal in the world for one in object space. */
static vec3 world_normal(const shape *s, vec3 object_normal)
{
    vec3 n = vec3_normalize(transform_normal(&s->as.quadric.world_from_object, object_normal));
    return s->flip_normal ? vec3_negate(n) : n;
}

surface_sample quadric_sample_area(const shape *s, vec2 u)
{
    const quadric *q = &s->as.quadric;
    vec3 point, normal;
    float sine, cosine;
    sincos_turns(u.y * q->turn, &sine, &cosine);
    if (s->kind == SHAPE_DISK) {
        /* uniform in area between the two radii */
        float hole = q->inner_radius / q->radius;
        float r = q->radius * sqrtf(hole * hole + u.x * (1.0f - hole * hole));
        point = (vec3){r * cosine, r * sine, q->height};
        normal = (vec3){0.0f, 0.0f, 1.0f};
    } else if (s->kind == SHAPE_CYLINDER) {
        normal = (vec3){cosine, sine, 0.0f};
        point = (vec3){q->radius * cosine, q->radius * sine, q->z_max - u.x * (q->z_max - q->z_min)};
    } else if (is_whole_sphere(s)) {
        normal = sample_uniform_sphere(u);
        point = vec3_scale(normal, q->radius);
    } else {
        float z = (q->z_max - u.x * (q->z_max - q->z_min)) / q->radius, ring = sqrtf(float_max(1.0f - z * z, 0.0f));
        normal = (vec3){ring * cosine, ring * sine, z};
        point = vec3_scale(normal, q->radius);
    }
    surface_sample sample = {0};
    sample.position = transform_point(&q->world_from_object, point);
    sample.geometric_normal = world_normal(s, normal);
    sample.epsilon = q->epsilon;
    sample.pdf_area = quadric_pdf_area(s, sample.geometric_normal);
    return sample;
}

float quadric_pdf_area(const shape *s, vec3 geometric_normal)
{
    const quadric *q = &s->as.quadric;
    if (q->has_even_area)
        return 1.0f / s->area;
    /* world normal back to the object's: n_object ~ M^T n_world */
    const double(*m)[4] = q->world_from_object.m;
    double n[3], length = 0.0;
    for (int i = 0; i < 3; i++) {
        n[i] = m[0][i] * (double)geometric_normal.x + m[1][i] * (double)geometric_normal.y +
               m[2][i] * (double)geometric_normal.z;
        length += n[i] * n[i];
    }
    length = sqrt(length);
    return (float)(1.0 / (object_area(s) * area_factor(q, n[0] / length, n[1] / length, n[2] / length)));
}

/* --- surface geometry --- */

/* pbrt's parametrisation: u runs with phi over the part there is; v with theta from z_min to z_max on a sphere, with z
 * on a cylinder, from the rim to the hole on a disk. */
static vec2 surface_uv(const shape *s, double x, double y, double z)
{
    const quadric *q = &s->as.quadric;
    double turns = angle_turns(y, x), turn = q->turn, v;
    if (turns > turn) /* rounded over an end of the arc: which one? */
        turns = turns > 0.5 * (1.0 + turn) ? 0.0 : turn;
    if (s->kind == SHAPE_DISK)
        v = ((double)q->radius - sqrt(x * x + y * y)) / ((double)q->radius - (double)q->inner_radius);
    else if (s->kind == SHAPE_CYLINDER)
        v = (z - (double)q->z_min) / ((double)q->z_max - (double)q->z_min);
    else
        v = (angle_turns(sqrt(x * x + y * y), z) - q->theta_min) / (q->theta_max - q->theta_min);
    return (vec2){(float)(turns / turn), (float)double_clamp(v, 0.0, 1.0)};
}

/* Far from the origin a small sphere may be a single float: rays then hit its centre, where any direction will do. */
static vec3 normalize_or_z(vec3 v)
{
    float square = vec3_length_squared(v);
    return square > 0.0f ? vec3_scale(v, 1.0f / sqrtf(square)) : (vec3){0.0f, 0.0f, 1.0f};
}

bool quadric_bare_point_at(const shape *s, vec3 position, vec3 *out_position, vec3 *out_geometric_normal)
{
    const quadric *q = &s->as.quadric;
    if (!(q->uniform_radius > 0.0f))
        return false;
    /* onto the true sphere: the traversal's distance loses up to 1e-4 radii far away */
    vec3 n = normalize_or_z(vec3_sub(position, q->center));
    *out_position = vec3_add_scaled(q->center, n, q->uniform_radius);
    *out_geometric_normal = s->flip_normal ? vec3_negate(n) : n;
    return true;
}

void quadric_surface_at(const shape *s, vec3 position, bool with_uv, surface_hit *out_hit)
{
    const quadric *q = &s->as.quadric;
    const double(*w)[4] = q->world_from_object.inverse;
    surface_hit *h = out_hit;
    h->epsilon = q->epsilon;
    h->uv = (vec2){0.0f, 0.0f};
    h->is_flat = s->kind == SHAPE_DISK;
    if (quadric_bare_point_at(s, position, &h->position, &h->geometric_normal)) {
        h->shading_normal = h->geometric_normal;
        if (!with_uv)
            return;
        vec3 n = s->flip_normal ? vec3_negate(h->geometric_normal) : h->geometric_normal;
        double p[3];
        for (int i = 0; i < 3; i++)
            p[i] = w[i][0] * (double)n.x + w[i][1] * (double)n.y + w[i][2] * (double)n.z;
        h->uv = surface_uv(s, p[0], p[1], p[2]);
    } else {
        double p[3];
        for (int i = 0; i < 3; i++)
            p[i] = w[i][0] * (double)position.x + w[i][1] * (double)position.y + w[i][2] * (double)position.z + w[i][3];
        vec3 n = {0.0f, 0.0f, 1.0f};
        if (s->kind == SHAPE_DISK) {
            p[2] = q->height;
        } else {
            double across = s->kind == SHAPE_SPHERE ? p[2] : 0.0;
            double out = sqrt(p[0] * p[0] + p[1] * p[1] + across * across);
            double to_surface = out > 0.0 ? (double)q->radius / out : 0.0;
            p[0] *= to_surface;
            p[1] *= to_surface;
            if (s->kind == SHAPE_SPHERE)
                p[2] *= to_surface;
            n = normalize_or_z((vec3){(float)p[0], (float)p[1], s->kind == SHAPE_SPHERE ? (float)p[2] : 0.0f});
        }
        h->position = transform_point(&q->world_from_object, (vec3){(float)p[0], (float)p[1], (float)p[2]});
        h->geometric_normal = world_normal(s, n);
        h->uv = surface_uv(s, p[0], p[1], p[2]);
    }
    h->shading_normal = h->geometric_normal;
}

/* --- intersection --- */

/* Where the line o + t d meets a circle (of axes 2) or sphere (3) of radius squared r2: 0 or 2 points, in order. The
 * discriminant is taken from the line's distance to the middle, and the roots in their stable form. */
static int meet_round(const double o[3], const double d[3], int axes, double r2, double out_t[2])
{
    double a = 0.0, b = 0.0, c = -r2, off = 0.0;
    for (int i = 0; i < axes; i++) {
        a += d[i] * d[i];
        b -= o[i] * d[i];
        c += o[i] * o[i];
    }
    if (!(a > 0.0))
        return 0;
    for (int i = 0; i < axes; i++)
        off += square(o[i] + b / a * d[i]);
    double discriminant = r2 - off;
    if (!(discriminant >= 0.0))
        return 0;
    double root = b + copysign(sqrt(a * discriminant), b);
    double t0 = root != 0.0 ? c / root : 0.0, t1 = root / a;
    out_t[0] = t0 < t1 ? t0 : t1;
    out_t[1] = t0 < t1 ? t1 : t0;
    return 2;
}

/* Returns whether a point on the whole surface belongs to the part that exists. */
static bool is_in_part(const shape *s, double x, double y, double z)
{
    const quadric *q = &s->as.quadric;
    if (s->kind == SHAPE_DISK) {
        double distance2 = x * x + y * y;
        if (distance2 > square((double)q->radius) || distance2 < square((double)q->inner_radius))
            return false;
    } else {
        /* a sphere's uncut end reaches as far as rounding takes it */
        if (z < (double)q->z_min && (s->kind == SHAPE_CYLINDER || q->z_min > -q->radius))
            return false;
        if (z > (double)q->z_max && (s->kind == SHAPE_CYLINDER || q->z_max < q->radius))
            return false;
    }
    if (q->turn >= 1.0f)
        return true;
    /* the arc is what two half-planes have in common, or for more than half a turn what either has */
    bool is_left_of_start = y >= 0.0, is_right_of_end = (double)q->turn_cos * y - (double)q->turn_sin * x <= 0.0;
    return q->turn <= 0.5f ? is_left_of_start && is_right_of_end : is_left_of_start || is_right_of_end;
}

bool shape_intersect_quadric(const shape *s, vec3 origin, vec3 direction, float t_min, float t_max, float *out_t)
{
    const quadric *q = &s->as.quadric;
    const double(*w)[4] = q->world_from_object.inverse;
    double o[3], d[3], candidates[2];
    int count;
    for (int i = 0; i < 3; i++) {
        o[i] = w[i][0] * (double)origin.x + w[i][1] * (double)origin.y + w[i][2] * (double)origin.z + w[i][3];
        d[i] = w[i][0] * (double)direction.x + w[i][1] * (double)direction.y + w[i][2] * (double)direction.z;
    }
    if (s->kind == SHAPE_DISK) {
        count = d[2] != 0.0;
        candidates[0] = count ? ((double)q->height - o[2]) / d[2] : 0.0;
    } else {
        count = meet_round(o, d, s->kind == SHAPE_SPHERE ? 3 : 2, square((double)q->radius), candidates);
    }
    for (int i = 0; i < count; i++) {
        double at = candidates[i];
        float t = (float)at;
        if (t > t_min && t < t_max && is_in_part(s, o[0] + at * d[0], o[1] + at * d[1], o[2] + at * d[2])) {
            *out_t = t;
            return true;
        }
    }
    return false;
}
