/* tangents.c: see tangents.h. Threads: pure functions. */
#include "shape/tangents.h"

#include "math/sampling.h"
#include "scene.h"
#include "shape/curves.h"
#include "shape/mesh_motion.h"
#include "shape/quadric.h"

static const surface_differentials NO_DIFFERENTIALS;

static vec3 across(vec3 v, vec3 normal) { return vec3_add_scaled(v, normal, -vec3_dot(v, normal)); }

/* Combines derivatives along two edges into one along u or v, in double, since an atlas makes its uvs small. */
static vec3 combine(vec3 e1, double a, vec3 e2, double b)
{
    return (vec3){(float)(e1.x * a + e2.x * b), (float)(e1.y * a + e2.y * b), (float)(e1.z * a + e2.z * b)};
}

/* How uvs change along a triangle's edges from its first corner. */
typedef struct uv_edges {
    double u1, v1, u2, v2, inverse; /* of the determinant; 0 where they say nothing */
} uv_edges;

static uv_edges triangle_uv_edges(const mesh *m, const uint32_t *index)
{
    /* a mesh without uvs has (0, 0), (1, 0), (1, 1) on every triangle */
    uv_edges e = {1.0, 0.0, 1.0, 1.0, 0.0};
    if (m->uvs) {
        vec2 t0 = m->uvs[index[0]], t1 = m->uvs[index[1]], t2 = m->uvs[index[2]];
        e.u1 = (double)t1.x - t0.x, e.v1 = (double)t1.y - t0.y, e.u2 = (double)t2.x - t0.x, e.v2 = (double)t2.y - t0.y;
    }
    double determinant = e.u1 * e.v2 - e.u2 * e.v1, inverse = 1.0 / determinant;
    e.inverse = determinant == 0.0 || !isfinite(inverse) ? 0.0 : inverse;
    return e;
}

/* Returns dpdu and dpdv; all are zero where uvs say nothing. positions: of the triangle's corners. */
static surface_differentials triangle_axes(const mesh *m, uint32_t triangle, const corner_values *positions)
{
    const uint32_t *index = m->indices + 3 * (size_t)triangle;
    vec3 e1 = triangle_edge(positions, 1), e2 = triangle_edge(positions, 2);
    uv_edges uv = triangle_uv_edges(m, index);
    surface_differentials d = NO_DIFFERENTIALS;
    if (uv.inverse == 0.0)
        return d;
    d.dpdu = combine(e1, uv.v2 * uv.inverse, e2, -uv.v1 * uv.inverse);
    d.dpdv = combine(e1, -uv.u2 * uv.inverse, e2, uv.u1 * uv.inverse);
    return d;
}

static surface_differentials mesh_differentials(const shape *s, const surface_hit *hit)
{
    const mesh *m = &s->as.mesh;
    const uint32_t *index = m->indices + 3 * (size_t)hit->primitive_index;
    const corner_values p = mesh_values_at(m, m->positions, hit->primitive_index, hit->time);
    surface_differentials d = triangle_axes(m, hit->primitive_index, &p);
    uv_edges uv = triangle_uv_edges(m, index);
    if (uv.inverse == 0.0 || !m->normals)
        return d;
    const corner_values n = mesh_normals_at(m, hit->primitive_index, hit->time);
    vec3 n1 = triangle_edge(&n, 1), n2 = triangle_edge(&n, 2);
    double b1, b2;
    find_barycentrics(&p, hit->position, &b1, &b2);
    double length = (double)vec3_length(vec3_add(n.at[0], combine(n1, b1, n2, b2)));
    if (length > 0.0) {
        double inverse = uv.inverse / length;
        d.dndu = across(combine(n1, uv.v2 * inverse, n2, -uv.v1 * inverse), hit->shading_normal);
        d.dndv = across(combine(n1, -uv.u2 * inverse, n2, uv.u1 * inverse), hit->shading_normal);
    }
    return d;
}

/* Returns how the world's unit normal turns where the object's turns by dn. */
static vec3 turn_of_normal(const shape *s, vec3 object_normal, vec3 dn, vec3 world_normal)
{
    const transform *t = &s->as.quadric.world_from_object;
    float length = vec3_length(transform_normal(t, object_normal));
    vec3 turned = vec3_scale(transform_normal(t, dn), (s->flip_normal ? -1.0f : 1.0f) / length);
    return across(turned, world_normal);
}

static surface_differentials quadric_differentials(const shape *s, const surface_hit *hit)
{
    const quadric *q = &s->as.quadric;
    const double(*w)[4] = q->world_from_object.inverse;
    vec3 x = hit->position;
    double p[3];
    for (int i = 0; i < 3; i++)
        p[i] = w[i][0] * (double)x.x + w[i][1] * (double)x.y + w[i][2] * (double)x.z + w[i][3];
    const double turns = 6.283185307179586477;
    double phi_range = turns * (double)q->turn, ring = sqrt(p[0] * p[0] + p[1] * p[1]);
    double cosine = ring > 0.0 ? p[0] / ring : 1.0, sine = ring > 0.0 ? p[1] / ring : 0.0;
    vec3 dpdu = {(float)(-phi_range * p[1]), (float)(phi_range * p[0]), 0.0f}, dpdv, normal, dndu, dndv;
    if (s->kind == SHAPE_DISK) {
        double in = (double)q->inner_radius - (double)q->radius;
        dpdv = (vec3){(float)(in * cosine), (float)(in * sine), 0.0f};
        normal = (vec3){0.0f, 0.0f, 1.0f};
        dndu = dndv = (vec3){0.0f, 0.0f, 0.0f};
    } else if (s->kind == SHAPE_CYLINDER) {
        dpdv = (vec3){0.0f, 0.0f, q->z_max - q->z_min};
        normal = (vec3){(float)cosine, (float)sine, 0.0f};
        dndu = vec3_scale(dpdu, 1.0f / q->radius);
        dndv = (vec3){0.0f, 0.0f, 0.0f};
    } else {
        double range = turns * (q->theta_max - q->theta_min);
        dpdv = (vec3){(float)(range * p[2] * cosine), (float)(range * p[2] * sine), (float)(-range * ring)};
        normal = vec3_normalize((vec3){(float)p[0], (float)p[1], (float)p[2]});
        dndu = vec3_scale(dpdu, 1.0f / q->radius);
        dndv = vec3_scale(dpdv, 1.0f / q->radius);
    }
    const transform *t = &q->world_from_object;
    return (surface_differentials){transform_vector(t, dpdu), transform_vector(t, dpdv),
                                   turn_of_normal(s, normal, dndu, hit->shading_normal),
                                   turn_of_normal(s, normal, dndv, hit->shading_normal)};
}

/* Returns how the world's unit normal turns where the object's, of unit length, turns by dn: both are transformed by
 * the inverse transpose. */
static vec3 turn_to_world(const affine *a, vec3 object_normal, vec3 dn, vec3 world_normal)
{
    double c[3][3], turned[3], square = 0.0;
    const double n[3] = {(double)object_normal.x, (double)object_normal.y, (double)object_normal.z};
    affine_cofactors(a, c);
    for (int i = 0; i < 3; i++) {
        double placed = c[i][0] * n[0] + c[i][1] * n[1] + c[i][2] * n[2];
        square += placed * placed;
        turned[i] = c[i][0] * (double)dn.x + c[i][1] * (double)dn.y + c[i][2] * (double)dn.z;
    }
    double inverse = (affine_determinant(a) < 0.0 ? -1.0 : 1.0) / sqrt(square);
    vec3 turn = {(float)(turned[0] * inverse), (float)(turned[1] * inverse), (float)(turned[2] * inverse)};
    return across(turn, world_normal);
}

static surface_differentials differentials_of(const shape *at, const surface_hit *hit)
{
    if (at->kind == SHAPE_CURVES)
        return curves_differentials(at, hit);
    return at->kind == SHAPE_MESH ? mesh_differentials(at, hit) : quadric_differentials(at, hit);
}

surface_differentials surface_differentials_at(const scene *s, const surface_hit *hit)
{
    const shape *at = &s->shapes[hit->shape_index];
    surface_differentials d;
    if (hit->instance_index == SCENE_NO_INSTANCE) {
        d = differentials_of(at, hit);
    } else {
        affine world_from_object = instance_at(s, hit->instance_index, hit->time);
        surface_hit in_object = instance_hit_in_object(s, hit);
        d = differentials_of(at, &in_object);
        d.dpdu = affine_vector(&world_from_object, d.dpdu);
        d.dpdv = affine_vector(&world_from_object, d.dpdv);
        d.dndu = turn_to_world(&world_from_object, in_object.shading_normal, d.dndu, hit->shading_normal);
        d.dndv = turn_to_world(&world_from_object, in_object.shading_normal, d.dndv, hit->shading_normal);
    }
    float area = vec3_length_squared(vec3_cross(d.dpdu, d.dpdv));
    if (!(area > 0.0f && isfinite(area))) {
        frame any = frame_from_z(hit->geometric_normal);
        d = NO_DIFFERENTIALS;
        d.dpdu = any.x;
        d.dpdv = any.y;
    }
    return d;
}

bool surface_uv_axes(const scene *s, const surface_hit *hit, vec3 *out_dpdu, vec3 *out_dpdv)
{
    const shape *at = &s->shapes[hit->shape_index];
    const bool is_placed = hit->instance_index != SCENE_NO_INSTANCE;
    /* a triangle's are the same all over it */
    surface_hit in_object = is_placed && at->kind != SHAPE_MESH ? instance_hit_in_object(s, hit) : *hit;
    surface_differentials d;
    if (at->kind == SHAPE_MESH) {
        const mesh *m = &at->as.mesh;
        const corner_values p = mesh_values_at(m, m->positions, hit->primitive_index, hit->time);
        d = triangle_axes(m, hit->primitive_index, &p);
    } else {
        d = differentials_of(at, &in_object);
    }
    if (is_placed) {
        affine world_from_object = instance_at(s, hit->instance_index, hit->time);
        d.dpdu = affine_vector(&world_from_object, d.dpdu);
        d.dpdv = affine_vector(&world_from_object, d.dpdv);
    }
    *out_dpdu = d.dpdu;
    *out_dpdv = d.dpdv;
    float area = vec3_length_squared(vec3_cross(d.dpdu, d.dpdv));
    return area > 0.0f && isfinite(area);
}

static bool has_tangents(const shape *s) { return s->kind == SHAPE_MESH && s->as.mesh.tangents; }

bool surface_has_own_tangents(const scene *s, const surface_hit *hit)
{
    return has_tangents(&s->shapes[hit->shape_index]);
}

/* Finds the tangent that a mesh has been given, in its own space; returns false where there is none. */
static bool mesh_tangent(const shape *s, const surface_hit *hit, vec3 *out_tangent)
{
    const mesh *m = &s->as.mesh;
    if (!has_tangents(s))
        return false;
    const corner_values p = mesh_values_at(m, m->positions, hit->primitive_index, hit->time);
    const corner_values along = mesh_values_at(m, m->tangents, hit->primitive_index, hit->time);
    double b1, b2;
    find_barycentrics(&p, hit->position, &b1, &b2);
    vec3 t = vec3_add(along.at[0], combine(triangle_edge(&along, 1), b1, triangle_edge(&along, 2), b2));
    *out_tangent = t;
    return vec3_length_squared(vec3_cross(hit->shading_normal, t)) > 0.0f;
}

void surface_tangents(const scene *s, const surface_hit *hit, vec3 *out_dpdu, vec3 *out_dpdv)
{
    surface_differentials d = surface_differentials_at(s, hit);
    vec3 given;
    surface_hit in_object = instance_hit_in_object(s, hit);
    if (mesh_tangent(&s->shapes[hit->shape_index], &in_object, &given)) {
        if (hit->instance_index != SCENE_NO_INSTANCE) {
            affine world_from_object = instance_at(s, hit->instance_index, hit->time);
            given = affine_vector(&world_from_object, given);
        }
        vec3 aside = vec3_cross(hit->shading_normal, given);
        d.dpdv = vec3_face_forward(aside, d.dpdv);
        d.dpdu = given;
    }
    *out_dpdu = d.dpdu;
    *out_dpdv = d.dpdv;
}
