/* shape.c: areas, bounds, sampling and surface geometry: of meshes here, of the others in quadric.c.
 * Rests on: Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, ch. 6.
 * Threads: shape_commit by one thread; the rest read only. */
#include "math/sampling.h"
#include "shape/curves.h"
#include "shape/mesh_motion.h"
#include "shape/quadric.h"
#include "texture/texture.h"

#include <stdlib.h>
#include <string.h>

shape shape_make(shape_kind kind)
{
    shape s;
    memset(&s, 0, sizeof s);
    s.kind = kind;
    s.light_index = SHAPE_NO_LIGHT;
    s.medium_inside = s.medium_outside = SCENE_NO_MEDIUM;
    s.alpha = 1.0f;
    s.alpha_texture = SCENE_NO_TEXTURE;
    s.object_index = SCENE_NO_OBJECT;
    return s;
}

void mesh_reset(mesh *m)
{
    free(m->area_cdf);
    if (!m->holder_count || --*m->holder_count == 0) {
        free(m->borrowed & MESH_BORROWS_POSITIONS ? NULL : m->positions);
        free(m->borrowed & MESH_BORROWS_UVS ? NULL : m->uvs);
        free(m->borrowed & MESH_BORROWS_INDICES ? NULL : m->indices);
        free(m->normals);
        free(m->tangents);
        free(m->holder_count);
    }
    *m = (mesh){0};
}

void shape_reset(shape *s)
{
    if (s->kind == SHAPE_CURVES)
        curves_reset(&s->as.curves);
    if (s->kind == SHAPE_MESH)
        mesh_reset(&s->as.mesh);
}

/* Copies count items and adds room for spare more, zeroed; NULL stays NULL. */
static bool copy_array(const void *items, size_t count, size_t spare, size_t item_bytes, void *out_items)
{
    void *copy = NULL;
    if (items) {
        copy = calloc(count + spare, item_bytes);
        if (!copy)
            return false;
        memcpy(copy, items, count * item_bytes);
    }
    memcpy(out_items, &copy, sizeof copy);
    return true;
}

ag_status shape_copy(const shape *s, const transform *map, shape *out_copy)
{
    shape copy = *s;
    if (s->kind != SHAPE_MESH) {
        if (map)
            copy.as.quadric.world_from_object = transform_multiply(map, &s->as.quadric.world_from_object);
        *out_copy = copy;
        return AG_OK;
    }
    const mesh *from = &s->as.mesh;
    mesh *m = &copy.as.mesh;
    m->positions = NULL, m->normals = NULL, m->uvs = NULL, m->tangents = NULL, m->indices = NULL, m->area_cdf = NULL;
    m->holder_count = NULL, m->borrowed = 0;
    const size_t count = mesh_value_count(from);
    if (!copy_array(from->positions, count, 1, sizeof *m->positions, &m->positions) ||
        !copy_array(from->normals, count, 0, sizeof *m->normals, &m->normals) ||
        !copy_array(from->uvs, from->vertex_count, 0, sizeof *m->uvs, &m->uvs) ||
        !copy_array(from->tangents, count, 0, sizeof *m->tangents, &m->tangents) ||
        !copy_array(from->indices, 3 * (size_t)from->triangle_count, 0, sizeof *m->indices, &m->indices)) {
        shape_reset(&copy);
        return AG_ERROR_MEMORY;
    }
    *out_copy = copy;
    if (!map)
        return AG_OK;
    for (size_t i = 0; i < count; i++)
        m->positions[i] = transform_point(map, m->positions[i]);
    for (size_t i = 0; m->normals && i < count; i++) {
        vec3 n = transform_normal(map, m->normals[i]);
        float largest = vec3_max_abs(n);
        m->normals[i] = largest > 0.0f ? vec3_normalize(vec3_scale(n, 1.0f / largest)) : n;
    }
    for (size_t i = 0; m->tangents && i < count; i++)
        m->tangents[i] = transform_vector(map, m->tangents[i]);
    out_copy->flip_normal = s->flip_normal != transform_swaps_handedness(map);
    return AG_OK;
}

static vec3 mesh_vertex(const mesh *m, uint32_t triangle, int corner)
{
    return m->positions[m->indices[3 * (size_t)triangle + (size_t)corner]];
}

/* Returns twice the triangle's area as a vector, in double so that slivers keep a direction. */
static inline vec3 area_vector(vec3 a, vec3 b, vec3 c, double *out_length)
{
    double e1[3] = {(double)b.x - a.x, (double)b.y - a.y, (double)b.z - a.z};
    double e2[3] = {(double)c.x - a.x, (double)c.y - a.y, (double)c.z - a.z};
    double n[3] = {e1[1] * e2[2] - e1[2] * e2[1], e1[2] * e2[0] - e1[0] * e2[2], e1[0] * e2[1] - e1[1] * e2[0]};
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    *out_length = length;
    double inverse = length > 0.0 ? 1.0 / length : 0.0;
    return (vec3){(float)(n[0] * inverse), (float)(n[1] * inverse), (float)(n[2] * inverse)};
}

static vec3 mesh_area_vector(const mesh *m, uint32_t triangle, double *out_length)
{
    return area_vector(mesh_vertex(m, triangle, 0), mesh_vertex(m, triangle, 1), mesh_vertex(m, triangle, 2),
                       out_length);
}

void shape_bounds(const shape *s, vec3 *out_min, vec3 *out_max)
{
    if (s->kind == SHAPE_CURVES) {
        curves_find_bounds(s, out_min, out_max);
        return;
    }
    if (s->kind != SHAPE_MESH) {
        quadric_find_bounds(s, out_min, out_max);
        return;
    }
    vec3 low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < mesh_value_count(&s->as.mesh); i++) {
        low = vec3_min(low, s->as.mesh.positions[i]);
        high = vec3_max(high, s->as.mesh.positions[i]);
    }
    *out_min = low;
    *out_max = high;
}

float shape_area(const shape *s)
{
    if (s->kind == SHAPE_CURVES)
        return curves_area(s);
    if (s->kind != SHAPE_MESH)
        return quadric_area(s);
    double area = 0.0;
    for (uint32_t i = 0; i < s->as.mesh.triangle_count; i++) {
        double length;
        mesh_area_vector(&s->as.mesh, i, &length);
        area += 0.5 * length;
    }
    return (float)area;
}

ag_status shape_commit(shape *s)
{
    if (s->area == 0.0f)
        s->area = shape_area(s);
    if (s->kind == SHAPE_CURVES)
        return AG_OK;
    if (s->kind != SHAPE_MESH) {
        quadric_commit(s);
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

static const vec3 NOWHERE = {0.0f, 0.0f, 0.0f};

surface_sample shape_sample_triangle(const shape *s, uint32_t triangle, vec2 barycentrics)
{
    surface_hit hit;
    shape_surface_at(s, triangle, barycentrics.x, barycentrics.y, NOWHERE, NOWHERE, 0.0f, &hit);
    return (surface_sample){hit.position, hit.geometric_normal, 1.0f / s->area, hit.epsilon, triangle, barycentrics};
}

uint32_t shape_pick_triangle(const shape *s, float *in_out_u)
{
    const mesh *m = &s->as.mesh;
    uint32_t low = 0, high = m->triangle_count - 1;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (m->area_cdf[middle] > *in_out_u)
            high = middle;
        else
            low = middle + 1;
    }
    float before = low > 0 ? m->area_cdf[low - 1] : 0.0f, share = mesh_area_share(m, low);
    if (share > 0.0f)
        *in_out_u = float_below_one(float_max((*in_out_u - before) / share, 0.0f));
    return low;
}

static surface_sample mesh_sample_area(const shape *s, vec2 u)
{
    uint32_t triangle = shape_pick_triangle(s, &u.x);
    return shape_sample_triangle(s, triangle, sample_triangle(u));
}

/* Returns the numbers that pick a triangle and a place within it; at: what sample_triangle is given. */
static vec2 numbers_of_triangle(const mesh *m, uint32_t triangle, vec2 at)
{
    float before = triangle > 0 ? m->area_cdf[triangle - 1] : 0.0f;
    return (vec2){before + mesh_area_share(m, triangle) * at.x, at.y};
}

vec2 shape_sample_numbers(const shape *s, uint32_t triangle, vec2 barycentrics)
{
    vec2 u = numbers_of_triangle(&s->as.mesh, triangle, sample_triangle_inverse(barycentrics));
    return (vec2){float_below_one(float_max(u.x, 0.0f)), float_below_one(float_max(u.y, 0.0f))};
}

bool shape_sample_inverse(const shape *s, const surface_hit *hit, vec2 *out_u)
{
    if (s->kind != SHAPE_MESH)
        return false;
    const mesh *m = &s->as.mesh;
    uint32_t i = hit->primitive_index;
    vec3 corner = mesh_vertex(m, i, 0), p = vec3_sub(hit->position, corner);
    vec3 e1 = vec3_sub(mesh_vertex(m, i, 1), corner), e2 = vec3_sub(mesh_vertex(m, i, 2), corner);
    double a = vec3_dot(e1, e1), b = vec3_dot(e1, e2), c = vec3_dot(e2, e2), p1 = vec3_dot(p, e1), p2 = vec3_dot(p, e2);
    double determinant = a * c - b * b, inverse = determinant > 0.0 ? 1.0 / determinant : 0.0;
    vec2 at = {(float)((c * p1 - b * p2) * inverse), (float)((a * p2 - b * p1) * inverse)};
    *out_u = numbers_of_triangle(m, i, sample_triangle_inverse(at));
    return true;
}

surface_sample shape_sample_area(const shape *s, vec2 u)
{
    return s->kind == SHAPE_MESH ? mesh_sample_area(s, u) : quadric_sample_area(s, u);
}

void shape_sample_surface(const shape *s, uint32_t shape_index, const surface_sample *sample, surface_hit *out_hit)
{
    shape_surface_at(s, sample->primitive_index, sample->barycentrics.x, sample->barycentrics.y, sample->position,
                     NOWHERE, 0.0f, out_hit);
    out_hit->distance = 0.0f;
    out_hit->slab.thickness = 0.0f;
    out_hit->shape_index = shape_index;
    out_hit->primitive_index = sample->primitive_index;
}

float shape_pdf_area(const shape *s, vec3 geometric_normal)
{
    return s->kind == SHAPE_MESH ? 1.0f / s->area : quadric_pdf_area(s, geometric_normal);
}

typedef struct corners {
    vec3 p0, p1, p2;
} corners;

static corners mesh_corners(const mesh *m, uint32_t triangle)
{
    return (corners){mesh_vertex(m, triangle, 0), mesh_vertex(m, triangle, 1), mesh_vertex(m, triangle, 2)};
}

/* Returns the geometric normal, and computes the shading normal (the same where the mesh has none). normals: an array
 * that has those of the corners, at index; NULL: the mesh has none. */
static inline vec3 mesh_normals(const shape *s, const corners *c, const vec3 *normals, const uint32_t index[3], float u,
                                float v, vec3 *out_shading)
{
    double length;
    vec3 geometric = area_vector(c->p0, c->p1, c->p2, &length);
    if (s->flip_normal)
        geometric = vec3_negate(geometric);
    *out_shading = geometric;
    if (!normals)
        return geometric;
    vec3 ns = vec3_add_scaled(vec3_add_scaled(vec3_scale(normals[index[0]], 1.0f - u - v), normals[index[1]], u),
                              normals[index[2]], v);
    float square = vec3_length_squared(ns);
    if (!(square > 0.0f))
        return geometric;
    *out_shading = vec3_scale(ns, 1.0f / sqrtf(square));
    return vec3_face_forward(geometric, *out_shading); /* as pbrt: the given normals say where outside is */
}

static vec3 position_between(const corners *c, float u, float v)
{
    return vec3_add_scaled(vec3_add_scaled(vec3_scale(c->p0, 1.0f - u - v), c->p1, u), c->p2, v);
}

static float corners_epsilon(const corners *c)
{
    return float_max(float_max(vec3_max_abs(c->p0), vec3_max_abs(c->p1)), vec3_max_abs(c->p2)) * SHAPE_EPSILON_RELATIVE;
}

/* Position, normals and epsilon where the vertices move. Not inlined: such meshes are rare, and the caller is hot. */
static __attribute__((noinline)) void moving_mesh_surface_at(const shape *s, uint32_t primitive_index, float u, float v,
                                                             float time, surface_hit *h)
{
    const mesh *m = &s->as.mesh;
    static const uint32_t OWN[3] = {0, 1, 2};
    const corner_values p = mesh_moving_values(m, m->positions, primitive_index, time);
    const corners c = {p.at[0], p.at[1], p.at[2]};
    corner_values n = {{NOWHERE, NOWHERE, NOWHERE}};
    if (m->normals)
        n = mesh_moving_normals(m, primitive_index, time);
    h->position = position_between(&c, u, v);
    h->epsilon = mesh_moving_reach(m, primitive_index, time) * SHAPE_EPSILON_RELATIVE;
    h->geometric_normal = mesh_normals(s, &c, m->normals ? n.at : NULL, OWN, u, v, &h->shading_normal);
}

static void mesh_surface_at(const shape *s, uint32_t primitive_index, float u, float v, float time, surface_hit *h)
{
    h->uv = (vec2){u + v, v}; /* as pbrt: (0, 0), (1, 0), (1, 1) */
    const mesh *m = &s->as.mesh;
    const uint32_t *index = m->indices + 3 * (size_t)primitive_index;
    if (m->motion_segments > 0) {
        moving_mesh_surface_at(s, primitive_index, u, v, time, h);
    } else {
        corners c = mesh_corners(m, primitive_index);
        h->position = position_between(&c, u, v);
        h->epsilon = corners_epsilon(&c);
        h->geometric_normal = mesh_normals(s, &c, m->normals, index, u, v, &h->shading_normal);
    }
    if (m->uvs) {
        const vec2 *t = m->uvs;
        float w = 1.0f - u - v;
        h->uv.x = t[index[0]].x * w + t[index[1]].x * u + t[index[2]].x * v;
        h->uv.y = t[index[0]].y * w + t[index[1]].y * u + t[index[2]].y * v;
    }
    h->is_flat = true;
}

bool shape_bare_point_at(const shape *s, uint32_t primitive_index, float u, float v, vec3 position,
                         surface_point *out_point)
{
    if (s->kind == SHAPE_MESH && s->as.mesh.motion_segments == 0) {
        double length;
        corners c = mesh_corners(&s->as.mesh, primitive_index);
        out_point->position = position_between(&c, u, v);
        out_point->normal = area_vector(c.p0, c.p1, c.p2, &length);
        out_point->epsilon = corners_epsilon(&c);
        return true;
    }
    if (s->kind == SHAPE_CURVES || s->kind == SHAPE_MESH)
        return false;
    out_point->epsilon = s->as.quadric.epsilon;
    return quadric_bare_point_at(s, position, &out_point->position, &out_point->normal);
}

static void surface_at(const shape *s, uint32_t primitive_index, float u, float v, vec3 position, vec3 direction,
                       float time, bool with_uv, surface_hit *out_hit)
{
    out_hit->is_strand = out_hit->faces_rays = out_hit->is_mirrored = false;
    if (s->kind == SHAPE_MESH)
        mesh_surface_at(s, primitive_index, u, v, time, out_hit);
    else if (s->kind == SHAPE_CURVES)
        curves_surface_at(s, primitive_index, u, position, direction, time, out_hit);
    else
        quadric_surface_at(s, position, with_uv, out_hit);
    out_hit->has_medium_interface = s->has_medium_interface;
    out_hit->medium_inside = s->medium_inside;
    out_hit->medium_outside = s->medium_outside;
}

void shape_surface_at(const shape *s, uint32_t primitive_index, float u, float v, vec3 position, vec3 direction,
                      float time, surface_hit *out_hit)
{
    surface_at(s, primitive_index, u, v, position, direction, time, true, out_hit);
}

void shape_hit_at(const shape *s, uint32_t primitive_index, float u, float v, vec3 position, vec3 direction, float time,
                  surface_hit *out_hit)
{
    surface_at(s, primitive_index, u, v, position, direction, time, false, out_hit);
}
