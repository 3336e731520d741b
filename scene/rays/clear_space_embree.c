/* clear_space_embree.c: see clear_space.h. Embree's point queries tell which surfaces are near.
 * Threads: see clear_space.h. */
#include "rays/clear_space.h"

#include "material/material.h"
#include "rays/bvh_embree.h"
#include "rays/transmittance.h"
#include "shape/alpha.h"

/* The ray down to the surface starts so high, as a share of the radius; what is higher than that is another surface. */
static const float LIFT = 1.0f / 64.0f;
/* Space with more surfaces than that in it is not looked at further: a query would take longer than it saves. */
enum { SURFACES_MOST = 64, TRIALS = 3 };
/* Distances are this much larger than what is known to be clear, and cosines than what is asked for. */
static const float ROUNDING = 0x1p-10f;
/* The sine between two normals that count as the same: a cosine differs by no more, half of ROUNDING. */
static const float LEVEL_SINE = 0x1p-11f;
/* A surface is level with the space's own only if its rounding error is at most this many times the own one's, as that
 * of tiles farther from the origin. */
static const float LEVEL_MARGINS = 8.0f;

typedef struct search {
    const scene *s;
    clear_space *space;
    float own_margin;                      /* of the space's own surface */
    float rounding_most;                   /* of all surfaces, as point_of tells it */
    float nearest;                         /* distance of the nearest obstacle */
    uint32_t surfaces;                     /* met so far */
    uint32_t shape_index, primitive_index; /* of the nearest obstacle */
} search;

static bool is_sphere(const shape *at) { return at->kind == SHAPE_SPHERE && at->as.quadric.uniform_radius > 0.0f; }

typedef struct triangle {
    vec3 a, b, c;
} triangle;

static triangle triangle_of(const mesh *m, uint32_t index)
{
    const uint32_t *corner = &m->indices[3 * (size_t)index];
    return (triangle){m->positions[corner[0]], m->positions[corner[1]], m->positions[corner[2]]};
}

/* The squared distance from a point to a triangle. */
static float triangle_distance_squared(vec3 p, triangle t)
{
    vec3 a = t.a, b = t.b, c = t.c;
    vec3 ab = vec3_sub(b, a), ac = vec3_sub(c, a), ap = vec3_sub(p, a), bp = vec3_sub(p, b), cp = vec3_sub(p, c);
    float d1 = vec3_dot(ab, ap), d2 = vec3_dot(ac, ap), d3 = vec3_dot(ab, bp), d4 = vec3_dot(ac, bp),
          d5 = vec3_dot(ab, cp), d6 = vec3_dot(ac, cp);
    float va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
    vec3 nearest;
    if (d1 <= 0.0f && d2 <= 0.0f)
        nearest = a;
    else if (d3 >= 0.0f && d4 <= d3)
        nearest = b;
    else if (d6 >= 0.0f && d5 <= d6)
        nearest = c;
    else if (vc <= 0.0f && d1 >= 0.0f && d3 <= 0.0f)
        nearest = vec3_add_scaled(a, ab, d1 / (d1 - d3));
    else if (vb <= 0.0f && d2 >= 0.0f && d6 <= 0.0f)
        nearest = vec3_add_scaled(a, ac, d2 / (d2 - d6));
    else if (va <= 0.0f && d4 - d3 >= 0.0f && d5 - d6 >= 0.0f)
        nearest = vec3_add_scaled(b, vec3_sub(c, b), (d4 - d3) / ((d4 - d3) + (d5 - d6)));
    else
        nearest = vec3_add_scaled(vec3_add_scaled(a, ab, vb / (va + vb + vc)), ac, vc / (va + vb + vc));
    float squared = vec3_distance_squared(p, nearest);
    return squared >= 0.0f ? squared : 0.0f; /* of a triangle without area it may be no number */
}

/* Position and normal are of no use here. epsilon: how far a surface may be met off its place: a large one, and one
 * that is far from the origin, farther. */
static surface_point point_of(const shape *at, uint32_t primitive_index)
{
    surface_point point = {.epsilon = at->kind == SHAPE_MESH ? 0.0f : at->as.quadric.epsilon};
    if (at->kind == SHAPE_MESH)
        shape_bare_point_at(at, primitive_index, 0.0f, 0.0f, point.position, &point);
    return point;
}

static float height_of(const shape *at, uint32_t primitive_index, vec3 normal)
{
    if (is_sphere(at))
        return vec3_dot(at->as.quadric.center, normal) + at->as.quadric.uniform_radius;
    if (at->kind != SHAPE_MESH)
        return INFINITY;
    triangle t = triangle_of(&at->as.mesh, primitive_index);
    return float_max(vec3_dot(t.a, normal), float_max(vec3_dot(t.b, normal), vec3_dot(t.c, normal)));
}

/* Whether rays end at all of it. */
static bool stops_rays(const scene *s, const shape *at)
{
    return shape_is_opaque(at) && !material_may_be_interface(s, at->material_index);
}

/* Whether a surface may be met in the place of the space's own: it lies in the same plane, rather than below it with
 * some corner in it, and rays end there as well. */
static bool is_level(const search *q, const shape *at, uint32_t primitive_index, const surface_point *point)
{
    const clear_space_plane *p = &q->space->plane[0];
    return at->kind == SHAPE_MESH && stops_rays(q->s, at) && point->epsilon <= LEVEL_MARGINS * q->own_margin &&
           height_of(at, primitive_index, p->normal) <= p->height + q->space->margin &&
           vec3_length_squared(vec3_cross(point->normal, p->normal)) <= LEVEL_SINE * LEVEL_SINE;
}

/* Whether a surface lies below one of the space's planes, or level with its own, so that its rounding counts. */
static bool is_below(search *q, const shape *at, uint32_t primitive_index, const surface_point *point)
{
    clear_space *space = q->space;
    const bool has_own_plane = q->s->shapes[space->shape_index].kind == SHAPE_MESH;
    for (uint32_t i = 0; i < space->plane_count; i++) {
        const clear_space_plane *p = &space->plane[i];
        const float slack = i == 0 && has_own_plane ? -space->margin : space->margin;
        if (height_of(at, primitive_index, p->normal) + point->epsilon <= p->height + slack)
            return true;
    }
    if (!has_own_plane || !is_level(q, at, primitive_index, point))
        return false;
    space->margin = float_max(space->margin, point->epsilon);
    return true;
}

/* Returns the distance from the centre to a surface. */
static float distance_to(const search *q, const shape *at, uint32_t primitive_index)
{
    if (at->kind == SHAPE_MESH)
        return sqrtf(triangle_distance_squared(q->space->center, triangle_of(&at->as.mesh, primitive_index)));
    if (is_sphere(at))
        return fabsf(sqrtf(vec3_distance_squared(q->space->center, at->as.quadric.center)) -
                     at->as.quadric.uniform_radius);
    vec3 low, high;
    shape_bounds(at, &low, &high);
    return sqrtf(vec3_distance_squared(q->space->center, vec3_min(vec3_max(q->space->center, low), high)));
}

/* Returns the distance from the centre to an obstacle, less its rounding error. INFINITY: the surface is no obstacle,
 * since it lies below the space or is the space's own. */
static float distance_to_obstacle(search *q, uint32_t shape_index, uint32_t primitive_index)
{
    const clear_space *space = q->space;
    const shape *at = &q->s->shapes[shape_index];
    const surface_point point = point_of(at, primitive_index);
    bool is_own = shape_index == space->shape_index && (primitive_index == space->primitive_index || is_sphere(at));
    if (is_own || is_below(q, at, primitive_index, &point))
        return INFINITY;
    return float_max(distance_to(q, at, primitive_index) - point.epsilon, 0.0f);
}

/* Makes the ball smaller where a surface reaches into it. Returns whether it does. out_radius: of where surfaces may be
 * that matter. */
static bool meet_surface(search *q, uint32_t shape_index, uint32_t primitive_index, float *out_radius)
{
    float distance = 0.0f;
    if (++q->surfaces <= SURFACES_MOST)
        distance = distance_to_obstacle(q, shape_index, primitive_index);
    if (!(distance < q->nearest))
        return false;
    q->shape_index = shape_index;
    q->primitive_index = primitive_index;
    q->nearest = distance;
    *out_radius = distance + q->rounding_most;
    return true;
}

/* Embree's. */
static bool meet_primitive(struct RTCPointQueryFunctionArguments *arguments)
{
    return meet_surface(arguments->userPtr, arguments->geomID, arguments->primID, &arguments->query->radius);
}

/* Returns the distance to the nearest obstacle, at most `radius`. */
static float find_obstacle(search *q, float radius)
{
    struct RTCPointQuery query = {
        .x = q->space->center.x, .y = q->space->center.y, .z = q->space->center.z, .radius = radius + q->rounding_most};
    struct RTCPointQueryContext context;
    q->nearest = radius;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(q->s->bvh->scene, &query, &context, meet_primitive, q);
    for (uint32_t i = 0; i < q->s->bvh->sphere_count; i++) {
        const quadric *sphere = &q->s->shapes[q->s->bvh->spheres[i]].as.quadric;
        float reach = query.radius + sphere->uniform_radius;
        if (vec3_distance_squared(q->space->center, sphere->center) < reach * reach)
            meet_surface(q, q->s->bvh->spheres[i], 0, &query.radius);
    }
    return q->nearest;
}

/* A plane between the centre and an obstacle, which lies below it, with its rounding. Returns false where there is
 * none. */
static bool part_from_obstacle(const search *q, clear_space_plane *out_plane)
{
    const shape *at = &q->s->shapes[q->shape_index];
    if (is_sphere(at)) {
        vec3 away = vec3_sub(q->space->center, at->as.quadric.center);
        float distance = vec3_length(away), radius = at->as.quadric.uniform_radius;
        out_plane->normal = vec3_scale(away, 1.0f / distance);
        out_plane->height = height_of(at, 0, out_plane->normal) + at->as.quadric.epsilon;
        return distance > radius;
    }
    if (at->kind != SHAPE_MESH)
        return false;
    const surface_point point = point_of(at, q->primitive_index);
    out_plane->normal = vec3_face_forward(point.normal, vec3_sub(q->space->center, point.position));
    out_plane->height = height_of(at, q->primitive_index, out_plane->normal) + point.epsilon;
    return vec3_length_squared(point.normal) > 0.0f;
}

/* Finds the surface itself. */
static bool find_own_surface(const scene *s, vec3 center, vec3 normal, float radius, clear_space *out_space)
{
    surface_hit hit;
    scene_ray down = scene_ray_make(vec3_add_scaled(center, normal, LIFT * radius), vec3_negate(normal));
    if (!scene_find_surface(s, down, 2.0f * LIFT * radius, &hit) ||
        vec3_distance_squared(hit.position, center) > hit.epsilon * hit.epsilon)
        return false;
    const shape *at = &s->shapes[hit.shape_index];
    vec3 n = vec3_face_forward(hit.geometric_normal, normal);
    if (!stops_rays(s, at) || !(vec3_dot(n, normal) > 0.9f))
        return false;
    if (is_sphere(at) ? !(vec3_dot(vec3_sub(center, at->as.quadric.center), n) > 0.0f) : at->kind != SHAPE_MESH)
        return false;
    *out_space = (clear_space){.center = center,
                               .radius = radius,
                               .margin = hit.epsilon,
                               .shape_index = hit.shape_index,
                               .primitive_index = hit.primitive_index};
    if (!is_sphere(at))
        out_space->plane[out_space->plane_count++] = (clear_space_plane){n, vec3_dot(n, hit.position)};
    return true;
}

/* Finds the ball, and the planes that part it from obstacles. Returns false where there are too many surfaces. */
static bool find_ball(const scene *s, float radius, clear_space *space)
{
    search q = {.s = s,
                .space = space,
                .own_margin = space->margin,
                .rounding_most =
                    float_max(vec3_max_abs(s->bounds_min), vec3_max_abs(s->bounds_max)) * SHAPE_EPSILON_RELATIVE};
    while ((space->radius = find_obstacle(&q, radius)) < radius && space->plane_count < CLEAR_SPACE_PLANES &&
           q.surfaces <= SURFACES_MOST && part_from_obstacle(&q, &space->plane[space->plane_count]))
        space->plane_count++;
    return q.surfaces <= SURFACES_MOST;
}

bool clear_space_is_told(const scene *s) { return s->bvh->tells_what_is_near; }

void clear_space_find(const scene *s, vec3 center, vec3 normal, float radius, clear_space *out_space)
{
    clear_space own, space;
    *out_space = (clear_space){0};
    if (!clear_space_is_told(s) || !find_own_surface(s, center, normal, radius, &own))
        return;
    for (int trial = 0; trial < TRIALS; trial++, radius *= 0.25f) {
        space = own;
        if (!find_ball(s, radius, &space))
            continue;
        space.radius = float_max(space.radius * (1.0f - ROUNDING) - space.margin, 0.0f);
        *out_space = space;
        return;
    }
}

/* Whether a line stays outside of a sphere. */
static bool passes_sphere(const quadric *sphere, float margin, vec3 from, vec3 to)
{
    vec3 way = vec3_sub(to, from), toward = vec3_sub(sphere->center, from);
    float square = vec3_dot(way, way), along = vec3_dot(toward, way), least = sphere->uniform_radius + margin;
    float share = square > 0.0f ? float_clamp(along / square, 0.0f, 1.0f) : 0.0f;
    return vec3_length_squared(vec3_sub(toward, vec3_scale(way, share))) > least * least;
}

/* Whether a point is in the ball, and above its planes from that number on. */
static bool is_within(const clear_space *space, vec3 point, uint32_t first_plane)
{
    bool is_above = vec3_distance_squared(point, space->center) < space->radius * space->radius;
    for (uint32_t i = first_plane; i < space->plane_count && is_above; i++)
        is_above = vec3_dot(point, space->plane[i].normal) > space->plane[i].height + 2.0f * space->margin;
    return is_above;
}

bool clear_space_has_line(const scene *s, const clear_space *space, vec3 from, vec3 to)
{
    if (!is_within(space, from, 0) || !is_within(space, to, 0))
        return false;
    const shape *at = &s->shapes[space->shape_index];
    return at->kind == SHAPE_MESH || passes_sphere(&at->as.quadric, 2.0f * space->margin, from, to);
}

/* Returns the distance along the ray to the plane or the sphere of the space, from outside, and the normal there. */
static bool find_meeting(const shape *at, const clear_space *space, vec3 origin, vec3 direction, float *out_distance,
                         vec3 *out_normal)
{
    if (at->kind == SHAPE_MESH) {
        const clear_space_plane *p = &space->plane[0];
        *out_normal = p->normal;
        *out_distance = (p->height - vec3_dot(origin, p->normal)) / vec3_dot(direction, p->normal);
        return true;
    }
    const quadric *sphere = &at->as.quadric;
    float radius = sphere->uniform_radius;
    vec3 from = vec3_sub(origin, sphere->center);
    float along = -vec3_dot(from, direction);
    float lateral_squared = vec3_length_squared(vec3_add_scaled(from, direction, along));
    if (!(lateral_squared < (1.0f - ROUNDING) * radius * radius))
        return false;
    *out_distance = along - sqrtf(radius * radius - lateral_squared);
    *out_normal = vec3_scale(vec3_add_scaled(from, direction, *out_distance), 1.0f / radius);
    return true;
}

/* Whether a point in a triangle's plane lies in it, and off its edges by the margin and a share of their heights. */
static bool is_inside(triangle t, vec3 normal, vec3 point, float margin)
{
    const vec3 corner[3] = {t.a, t.b, t.c};
    float all = vec3_dot(vec3_cross(vec3_sub(t.b, t.a), vec3_sub(t.c, t.a)), normal), sign = all < 0.0f ? -1.0f : 1.0f;
    bool is_in = true;
    for (int i = 0; i < 3 && is_in; i++) { /* areas, twice */
        vec3 from = corner[i], to = corner[(i + 1) % 3];
        float beside = sign * vec3_dot(vec3_cross(vec3_sub(from, point), vec3_sub(to, point)), normal);
        is_in = beside > ROUNDING * fabsf(all) + margin * sqrtf(vec3_distance_squared(from, to));
    }
    return is_in;
}

bool clear_space_ends_ray(const scene *s, const clear_space *space, vec3 origin, vec3 direction, float farthest,
                          float min_cos)
{
    const shape *at = &s->shapes[space->shape_index];
    bool is_plane = at->kind == SHAPE_MESH;
    float distance, margin = 2.0f * space->margin;
    vec3 normal;
    if (!is_within(space, origin, 0) || !find_meeting(at, space, origin, direction, &distance, &normal))
        return false;
    vec3 end = vec3_add_scaled(origin, direction, distance);
    return distance > margin && distance < (1.0f - ROUNDING) * farthest - margin &&
           -vec3_dot(normal, direction) > min_cos + ROUNDING && is_within(space, end, is_plane) &&
           (!is_plane || is_inside(triangle_of(&at->as.mesh, space->primitive_index), normal, end, margin));
}

/* Whether a disc in a triangle's plane lies in it. */
static bool holds_disc(triangle t, vec3 normal, vec3 position, float radius)
{
    const vec3 corner[3] = {t.a, t.b, t.c};
    float side = vec3_dot(vec3_cross(vec3_sub(t.b, t.a), vec3_sub(t.c, t.a)), normal) < 0.0f ? -1.0f : 1.0f;
    for (int i = 0; i < 3; i++) {
        vec3 edge = vec3_sub(corner[(i + 1) % 3], corner[i]);
        float height = side * vec3_dot(vec3_cross(normal, edge), vec3_sub(position, corner[i])); /* times its length */
        if (!(height > 0.0f && height * height > radius * radius * vec3_length_squared(edge)))
            return false;
    }
    return true;
}

bool clear_space_holds_disc(const scene *s, const clear_space *space, vec3 position, vec3 normal, float radius,
                            float share, float min_cos)
{
    static const float SLACK = 1.0f / 64.0f, LIFT_MOST = 1.0f / 16.0f;
    const shape *at = &s->shapes[space->shape_index];
    const float reach = radius * (1.0f + SLACK), margin = 2.0f * space->margin,
                ball = space->radius - LIFT_MOST * radius;
    if (!(ball > reach) || !(vec3_distance_squared(position, space->center) < (ball - reach) * (ball - reach)))
        return false;
    for (uint32_t i = at->kind == SHAPE_MESH; i < space->plane_count; i++)
        if (!(vec3_dot(position, space->plane[i].normal) >
              space->plane[i].height + reach + LIFT_MOST * radius + margin))
            return false;
    const float lateral = share * reach;
    if (at->kind == SHAPE_MESH) {
        const clear_space_plane *p = &space->plane[0];
        return vec3_dot(normal, p->normal) > 0.0f && fabsf(vec3_dot(position, p->normal) - p->height) <= margin &&
               holds_disc(triangle_of(&at->as.mesh, space->primitive_index), p->normal, position, lateral + margin);
    }
    const quadric *sphere = &at->as.quadric;
    vec3 out = vec3_sub(position, sphere->center);
    float r = sphere->uniform_radius, cosine_squared = 1.0f - lateral * lateral / (r * r);
    if (!(vec3_dot(normal, out) > 0.0f) || fabsf(vec3_length(out) - r) > margin ||
        !(cosine_squared > min_cos * min_cos + SLACK))
        return false;
    float depth = r * (1.0f - sqrtf(cosine_squared)) + margin;
    return depth * depth < (1.0f - SLACK) * (radius * radius - lateral * lateral);
}
