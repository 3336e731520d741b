/* shape.c: areas, bounds, sampling and surface geometry of meshes, spheres and disks.
 * Rests on: Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, ch. 6.
 * Threads: shape_commit by one thread; the rest read only. */
#include "bvh.h"
#include "math/sampling.h"

#include <stdlib.h>

/* Rays start this far off a surface, relative to the largest coordinate at hand: some 128 units in the last place of a
 * float, a few times what the traversal's arithmetic loses. */
static const float EPSILON_RELATIVE = 0x1p-16f;

static vec3 mesh_vertex(const mesh *m, uint32_t triangle, int corner)
{
    return m->positions[m->indices[3 * (size_t)triangle + (size_t)corner]];
}

/* Twice the triangle's area as a vector, in double so that slivers keep a direction. */
static vec3 mesh_area_vector(const mesh *m, uint32_t triangle, double *out_length)
{
    vec3 p[3] = {mesh_vertex(m, triangle, 0), mesh_vertex(m, triangle, 1), mesh_vertex(m, triangle, 2)};
    double e1[3] = {(double)p[1].x - p[0].x, (double)p[1].y - p[0].y, (double)p[1].z - p[0].z};
    double e2[3] = {(double)p[2].x - p[0].x, (double)p[2].y - p[0].y, (double)p[2].z - p[0].z};
    double n[3] = {e1[1] * e2[2] - e1[2] * e2[1], e1[2] * e2[0] - e1[0] * e2[2], e1[0] * e2[1] - e1[1] * e2[0]};
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    *out_length = length;
    double inverse = length > 0.0 ? 1.0 / length : 0.0;
    return (vec3){(float)(n[0] * inverse), (float)(n[1] * inverse), (float)(n[2] * inverse)};
}

static float mesh_epsilon(const mesh *m, uint32_t triangle)
{
    float largest = 0.0f;
    for (int c = 0; c < 3; c++)
        largest = fmaxf(largest, vec3_max_abs(mesh_vertex(m, triangle, c)));
    return largest * EPSILON_RELATIVE;
}

static float quadric_epsilon(const shape *s)
{
    vec3 low, high;
    shape_bounds(s, &low, &high);
    return fmaxf(vec3_max_abs(low), vec3_max_abs(high)) * EPSILON_RELATIVE;
}

void shape_bounds(const shape *s, vec3 *out_min, vec3 *out_max)
{
    vec3 low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
    if (s->kind == SHAPE_MESH) {
        for (uint32_t i = 0; i < s->as.mesh.vertex_count; i++) {
            low = vec3_min(low, s->as.mesh.positions[i]);
            high = vec3_max(high, s->as.mesh.positions[i]);
        }
    } else {
        /* Row i of the linear part, dotted with a unit sphere (or disk in xy), reaches out by its length. */
        const quadric *q = &s->as.quadric;
        const double(*m)[4] = q->world_from_object.m;
        float reach[3], center[3];
        for (int i = 0; i < 3; i++) {
            double z = s->kind == SHAPE_SPHERE ? m[i][2] : 0.0;
            double offset = s->kind == SHAPE_SPHERE ? 0.0 : (double)q->height;
            reach[i] = (float)((double)q->radius * sqrt(m[i][0] * m[i][0] + m[i][1] * m[i][1] + z * z));
            center[i] = (float)(m[i][3] + m[i][2] * offset);
            reach[i] += (fabsf(center[i]) + reach[i]) * 0x1p-22f; /* rounding must not shrink the box */
        }
        low = (vec3){center[0] - reach[0], center[1] - reach[1], center[2] - reach[2]};
        high = (vec3){center[0] + reach[0], center[1] + reach[1], center[2] + reach[2]};
    }
    *out_min = low;
    *out_max = high;
}

/* How much area an ellipsoid has per unit of its unit sphere's: |cofactor(M) n| = |det M| |M^-T n|. */
static double quadric_area_factor(const quadric *q, const double object_normal[3])
{
    const double(*m)[4] = q->world_from_object.m;
    const double(*inverse)[4] = q->world_from_object.inverse;
    double determinant = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    double square = 0.0;
    for (int i = 0; i < 3; i++) {
        double v = inverse[0][i] * object_normal[0] + inverse[1][i] * object_normal[1] + inverse[2][i] * object_normal[2];
        square += v * v;
    }
    return fabs(determinant) * sqrt(square);
}

float shape_area(const shape *s)
{
    const double pi = 3.14159265358979323846;
    double area = 0.0;
    if (s->kind == SHAPE_MESH) {
        for (uint32_t i = 0; i < s->as.mesh.triangle_count; i++) {
            double length;
            mesh_area_vector(&s->as.mesh, i, &length);
            area += 0.5 * length;
        }
        return (float)area;
    }
    const quadric *q = &s->as.quadric;
    double r = q->radius, hole = q->inner_radius;
    if (s->kind == SHAPE_DISK)
        return (float)(pi * (r * r - hole * hole) * quadric_area_factor(q, (const double[3]){0, 0, 1}));
    double scale = transform_uniform_scale(&q->world_from_object);
    if (scale > 0.0)
        return (float)(4.0 * pi * r * r * scale * scale);
    /* An ellipsoid's area has no closed form: integrate over the sphere by midpoints. */
    enum { STEPS = 512 };
    for (int i = 0; i < STEPS; i++) {
        double z = (2.0 * i + 1.0) / STEPS - 1.0, ring = sqrt(1.0 - z * z);
        for (int j = 0; j < STEPS; j++) {
            double phi = 2.0 * pi * (j + 0.5) / STEPS;
            area += quadric_area_factor(q, (const double[3]){ring * cos(phi), ring * sin(phi), z});
        }
    }
    return (float)(area / (STEPS * (double)STEPS) * 4.0 * pi * r * r);
}

ag_status shape_commit(shape *s)
{
    s->area = shape_area(s);
    if (s->kind != SHAPE_MESH) {
        quadric *q = &s->as.quadric;
        q->center = transform_point(&q->world_from_object, (vec3){0.0f, 0.0f, s->kind == SHAPE_DISK ? q->height : 0.0f});
        q->uniform_radius =
            s->kind == SHAPE_SPHERE ? q->radius * (float)transform_uniform_scale(&q->world_from_object) : 0.0f;
        return AG_OK;
    }
    mesh *m = &s->as.mesh;
    if (s->light_index == SHAPE_NO_LIGHT || m->area_cdf || m->triangle_count == 0)
        return AG_OK;
    m->area_cdf = malloc(m->triangle_count * sizeof *m->area_cdf);
    if (!m->area_cdf)
        return AG_ERROR_MEMORY;
    double sum = 0.0;
    for (uint32_t i = 0; i < m->triangle_count; i++) {
        double length;
        mesh_area_vector(m, i, &length);
        sum += 0.5 * length;
        m->area_cdf[i] = (float)(sum / (double)s->area);
    }
    return AG_OK;
}

/* The outside normal of a quadric at an object-space normal. */
static vec3 quadric_normal(const shape *s, vec3 object_normal)
{
    vec3 n = vec3_normalize(transform_normal(&s->as.quadric.world_from_object, object_normal));
    return s->flip_normal ? vec3_negate(n) : n;
}

surface_sample shape_sample_area(const shape *s, vec2 u)
{
    surface_sample sample;
    if (s->kind == SHAPE_MESH) {
        /* pick a triangle by area, then reuse the random number's rest */
        const mesh *m = &s->as.mesh;
        uint32_t low = 0, high = m->triangle_count - 1;
        while (low < high) {
            uint32_t middle = low + (high - low) / 2;
            if (m->area_cdf[middle] > u.x)
                high = middle;
            else
                low = middle + 1;
        }
        float before = low > 0 ? m->area_cdf[low - 1] : 0.0f, share = m->area_cdf[low] - before;
        if (share > 0.0f)
            u.x = fminf(fmaxf((u.x - before) / share, 0.0f), 0x1.fffffep-1f);
        vec2 b = sample_triangle(u);
        surface_hit hit;
        shape_surface_at(s, low, b.x, b.y, (vec3){0.0f, 0.0f, 0.0f}, &hit);
        sample.position = hit.position;
        sample.geometric_normal = hit.geometric_normal;
        sample.epsilon = hit.epsilon;
        sample.pdf_area = 1.0f / s->area;
        return sample;
    }
    const quadric *q = &s->as.quadric;
    vec3 object_point, object_normal;
    if (s->kind == SHAPE_SPHERE) {
        object_normal = sample_uniform_sphere(u);
        object_point = vec3_scale(object_normal, q->radius);
    } else {
        /* uniform in area between the two radii */
        float hole = q->inner_radius / q->radius, sine, cosine;
        float r = q->radius * sqrtf(hole * hole + u.x * (1.0f - hole * hole));
        sincos_turns(u.y, &sine, &cosine);
        object_point = (vec3){r * cosine, r * sine, q->height};
        object_normal = (vec3){0.0f, 0.0f, 1.0f};
    }
    sample.position = transform_point(&q->world_from_object, object_point);
    sample.geometric_normal = quadric_normal(s, object_normal);
    sample.epsilon = quadric_epsilon(s);
    sample.pdf_area = shape_pdf_area(s, sample.geometric_normal);
    return sample;
}

float shape_pdf_area(const shape *s, vec3 geometric_normal)
{
    if (s->kind != SHAPE_SPHERE || s->as.quadric.uniform_radius > 0.0f)
        return 1.0f / s->area;
    /* world normal back to the object's: n_object ~ M^T n_world */
    const quadric *q = &s->as.quadric;
    transform back = transform_invert(&q->world_from_object);
    vec3 n = vec3_normalize(transform_normal(&back, geometric_normal));
    double factor = quadric_area_factor(q, (const double[3]){n.x, n.y, n.z});
    return 1.0f / (4.0f * AG_PI * q->radius * q->radius * (float)factor);
}

void shape_surface_at(const shape *s, uint32_t primitive_index, float u, float v, vec3 position, surface_hit *out_hit)
{
    surface_hit *h = out_hit;
    h->uv = (vec2){u, v};
    if (s->kind == SHAPE_MESH) {
        const mesh *m = &s->as.mesh;
        const uint32_t *index = m->indices + 3 * (size_t)primitive_index;
        vec3 p0 = m->positions[index[0]], p1 = m->positions[index[1]], p2 = m->positions[index[2]];
        float w = 1.0f - u - v;
        h->position = vec3_add_scaled(vec3_add_scaled(vec3_scale(p0, w), p1, u), p2, v);
        double length;
        vec3 n = mesh_area_vector(m, primitive_index, &length);
        if (s->flip_normal)
            n = vec3_negate(n);
        h->shading_normal = n;
        if (m->normals) {
            vec3 ns = vec3_add_scaled(
                vec3_add_scaled(vec3_scale(m->normals[index[0]], w), m->normals[index[1]], u), m->normals[index[2]], v);
            float square = vec3_length_squared(ns);
            if (square > 0.0f) {
                h->shading_normal = vec3_scale(ns, 1.0f / sqrtf(square));
                n = vec3_face_forward(n, h->shading_normal); /* as pbrt: the given normals say where outside is */
            }
        }
        h->geometric_normal = n;
        if (m->uvs) {
            const vec2 *t = m->uvs;
            h->uv.x = t[index[0]].x * w + t[index[1]].x * u + t[index[2]].x * v;
            h->uv.y = t[index[0]].y * w + t[index[1]].y * u + t[index[2]].y * v;
        }
        h->epsilon = mesh_epsilon(m, primitive_index);
        return;
    }
    const quadric *q = &s->as.quadric;
    h->epsilon = quadric_epsilon(s);
    if (q->uniform_radius > 0.0f) {
        /* onto the true sphere: the traversal's distance loses up to 1e-4 radii far away */
        vec3 n = vec3_normalize(vec3_sub(position, q->center));
        h->position = vec3_add_scaled(q->center, n, q->uniform_radius);
        h->geometric_normal = s->flip_normal ? vec3_negate(n) : n;
    } else {
        transform object_from_world = transform_invert(&q->world_from_object);
        vec3 p = transform_point(&object_from_world, position), n = {0.0f, 0.0f, 1.0f};
        if (s->kind == SHAPE_SPHERE) {
            n = vec3_normalize(p);
            p = vec3_scale(n, q->radius);
        } else {
            p.z = q->height;
        }
        h->position = transform_point(&q->world_from_object, p);
        h->geometric_normal = quadric_normal(s, n);
    }
    h->shading_normal = h->geometric_normal;
}

bool shape_intersect_quadric(const shape *s, vec3 origin, vec3 direction, float t_min, float t_max, float *out_t)
{
    const quadric *q = &s->as.quadric;
    const double(*w)[4] = q->world_from_object.inverse;
    double o[3], d[3], candidates[2];
    int count = 0;
    for (int i = 0; i < 3; i++) {
        o[i] = w[i][0] * (double)origin.x + w[i][1] * (double)origin.y + w[i][2] * (double)origin.z + w[i][3];
        d[i] = w[i][0] * (double)direction.x + w[i][1] * (double)direction.y + w[i][2] * (double)direction.z;
    }
    double r2 = (double)q->radius * (double)q->radius;
    if (s->kind == SHAPE_DISK) {
        if (d[2] == 0.0)
            return false;
        double t = ((double)q->height - o[2]) / d[2];
        double x = o[0] + t * d[0], y = o[1] + t * d[1], square = x * x + y * y;
        if (square <= r2 && square >= (double)q->inner_radius * (double)q->inner_radius)
            candidates[count++] = t;
    } else {
        /* the stable form of the quadratic's roots; the discriminant from the distance of the ray to the centre
         * (Hearn, Baker; Haines et al., "Precision Improvements for Ray/Sphere Intersection", 2019) */
        double a = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        double b = -(o[0] * d[0] + o[1] * d[1] + o[2] * d[2]);
        double l[3], square = 0.0, c = o[0] * o[0] + o[1] * o[1] + o[2] * o[2] - r2;
        for (int i = 0; i < 3; i++) {
            l[i] = o[i] + b / a * d[i];
            square += l[i] * l[i];
        }
        double discriminant = r2 - square;
        if (!(discriminant >= 0.0))
            return false;
        double root = b + copysign(sqrt(a * discriminant), b);
        double t0 = root != 0.0 ? c / root : 0.0, t1 = root / a;
        candidates[count++] = t0 < t1 ? t0 : t1;
        candidates[count++] = t0 < t1 ? t1 : t0;
    }
    for (int i = 0; i < count; i++) {
        float t = (float)candidates[i];
        if (t > t_min && t < t_max) {
            *out_t = t;
            return true;
        }
    }
    return false;
}
