/* glued_faces.c: see glued_faces.h. The search casts short rays across points of glass, which look for opaque faces,
 * and across points of opaque triangles near glass, which look for glass: a table's leg is small under the table top,
 * and a mat under a bottle is large. Threads: the search by one; the rest pure functions. */
#include "rays/glued_faces.h"

#include "material/material.h"
#include "scene_extent.h"
#include "shape/alpha.h"

#include <math.h>
#include <stdlib.h>

/* An opaque face is looked for this many epsilons before and behind the glass: its own epsilon, which decides, is
 * larger where its triangles reach farther out. */
static const float WINDOW_EPSILONS = 4.0f;
/* Of a ray and the normal, at least; at smaller angles the window would have no end. */
static const float COSINE_MIN = 1e-3f;

float glued_faces_window(const surface_hit *hit, vec3 direction)
{
    float along = fabsf(vec3_dot(hit->geometric_normal, direction));
    return WINDOW_EPSILONS * hit->epsilon / float_max(along, COSINE_MIN * vec3_length(direction));
}

bool glued_faces_touch(const surface_hit *glass, const surface_hit *opaque)
{
    vec3 apart = vec3_sub(opaque->position, glass->position);
    return fabsf(vec3_dot(glass->geometric_normal, apart)) <= opaque->epsilon;
}

/* --- the search --- */

/* Rays cast in all from points of glass, and from points of opaque faces, at most. */
static const uint32_t TRIALS_MAX = 1u << 18;
/* Of one shape in one place: triangles that are tried, evenly spread over the mesh; and points in proportion to area,
 * beside the one that each of these triangles has. */
enum { TRIANGLES_MAX = 2048, POINTS_BY_AREA = 256, QUADRIC_POINTS = 16 };
/* The boxes of glass that opaque faces are compared with, at most; then one around all. */
enum { BOXES_MAX = 256 };

typedef struct box {
    vec3 low, high;
} box;

typedef struct search {
    scene *s;
    uint32_t trials;      /* left */
    box boxes[BOXES_MAX]; /* of glass, and what is translucent, in the world */
    uint32_t box_count;
    uint32_t *first, *next; /* of each object its first instance, and of each instance the next; or NULL */
    bool *is_lost;          /* of each shape: translucent, and on an opaque face somewhere */
} search;

/* A part of a box in common with another, with some room for rounding. */
static bool overlap(const box *a, const box *b)
{
    float room = WINDOW_EPSILONS * SHAPE_EPSILON_RELATIVE * float_max(vec3_max_abs(a->low), vec3_max_abs(a->high));
    return a->low.x <= b->high.x + room && b->low.x <= a->high.x + room && a->low.y <= b->high.y + room &&
           b->low.y <= a->high.y + room && a->low.z <= b->high.z + room && b->low.z <= a->high.z + room;
}

static unsigned role_of(const scene *s, const shape *at)
{
    const bool shines = at->light_index != SHAPE_NO_LIGHT, transmits = material_transmits(s, at->material_index);
    if (at->kind == SHAPE_CURVES || (shines && transmits))
        return 0;
    if (!transmits)
        return SHAPE_IS_OPAQUE;
    return material_is_transparent(s, at->material_index) ? SHAPE_IS_TRANSPARENT : SHAPE_IS_TRANSLUCENT;
}

/* The hit at a point of a shape, in one of its object's instances or in the world itself. */
static void place_hit(const scene *s, const shape *at, uint32_t instance_index, surface_hit *in_out_hit)
{
    in_out_hit->shape_index = (uint32_t)(at - s->shapes);
    in_out_hit->instance_index = instance_index;
    if (instance_index == SCENE_NO_INSTANCE)
        return;
    affine world_from_object = instance_at(s, instance_index, 0.0f);
    instance_transform_hit(&world_from_object, in_out_hit);
}

static void mark(search *q, uint32_t shape_index)
{
    shape *at = &q->s->shapes[shape_index];
    if (at->role == SHAPE_IS_TRANSPARENT)
        at->is_glued = q->s->has_glued_faces = true;
    else
        q->is_lost[shape_index] = true;
}

static bool is_marked(const search *q, const shape *at) { return at->is_glued || q->is_lost[at - q->s->shapes]; }

/* Looks from both sides across a point of a shape for faces of another that it touches, and marks which of the two is
 * not opaque. */
static void try_point(search *q, const surface_hit *point)
{
    const bool is_opaque = q->s->shapes[point->shape_index].role == SHAPE_IS_OPAQUE;
    const unsigned sought = is_opaque ? SHAPE_IS_TRANSPARENT | SHAPE_IS_TRANSLUCENT : SHAPE_IS_OPAQUE;
    const float reach = WINDOW_EPSILONS * point->epsilon;
    for (int side = 0; side < 2 && q->trials > 0; side++) {
        surface_hit met;
        vec3 n = side == 0 ? point->geometric_normal : vec3_negate(point->geometric_normal);
        scene_ray ray = scene_ray_make(vec3_add_scaled(point->position, n, reach), vec3_negate(n));
        ray.alpha_rule = RAY_MEETS_ALPHA;
        ray.skips_uv = true;
        q->trials--;
        if (!scene_intersect_role(q->s, ray, 0.0f, 2.0f * reach, sought, &met))
            continue;
        if (is_opaque ? glued_faces_touch(&met, point) : glued_faces_touch(point, &met)) {
            mark(q, is_opaque ? met.shape_index : point->shape_index);
            return;
        }
    }
}

/* Points of a triangle that do not repeat on its neighbours' edges: an additive recurrence, folded at the diagonal.
 * Rests on: Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018. */
static void try_triangle(search *q, const shape *at, uint32_t instance_index, uint32_t triangle, uint32_t points)
{
    static const vec3 NOWHERE = {0.0f, 0.0f, 0.0f};
    for (uint32_t i = 0; i < points; i++) {
        float u = 1.0f / 3.0f + 0.7548777f * (float)i, v = 1.0f / 3.0f + 0.5698403f * (float)i;
        surface_hit hit;
        u -= floorf(u), v -= floorf(v);
        if (u + v > 1.0f)
            u = 1.0f - u, v = 1.0f - v;
        shape_hit_at(at, triangle, u, v, NOWHERE, NOWHERE, 0.0f, &hit);
        place_hit(q->s, at, instance_index, &hit);
        try_point(q, &hit);
        if (at->role != SHAPE_IS_OPAQUE && is_marked(q, at))
            return;
    }
}

static vec3 corner_of(const mesh *m, uint32_t triangle, int corner)
{
    return m->positions[m->indices[3 * (size_t)triangle + (size_t)corner]];
}

static float area_of(const mesh *m, uint32_t triangle)
{
    vec3 a = corner_of(m, triangle, 0);
    return 0.5f *
           vec3_length(vec3_cross(vec3_sub(corner_of(m, triangle, 1), a), vec3_sub(corner_of(m, triangle, 2), a)));
}

/* Glass, and what is translucent, in one place. */
static void try_glass(search *q, const shape *at, uint32_t instance_index)
{
    if (at->kind != SHAPE_MESH) {
        for (int i = 0; i < QUADRIC_POINTS * QUADRIC_POINTS && !is_marked(q, at); i++) {
            surface_sample p = shape_sample_area(at, (vec2){((float)(i % QUADRIC_POINTS) + 0.5f) / QUADRIC_POINTS,
                                                            ((float)(i / QUADRIC_POINTS) + 0.5f) / QUADRIC_POINTS});
            surface_hit hit = {.position = p.position,
                               .geometric_normal = p.geometric_normal,
                               .shading_normal = p.geometric_normal,
                               .epsilon = p.epsilon};
            place_hit(q->s, at, instance_index, &hit);
            try_point(q, &hit);
        }
        return;
    }
    const mesh *m = &at->as.mesh;
    const uint32_t step = m->triangle_count / TRIANGLES_MAX + 1;
    for (uint32_t i = 0; i < m->triangle_count && q->trials > 0 && !is_marked(q, at); i += step) {
        float share = at->area > 0.0f ? area_of(m, i) / at->area : 0.0f;
        try_triangle(q, at, instance_index, i, 1 + (uint32_t)(float_min(share, 1.0f) * POINTS_BY_AREA));
    }
}

/* The triangles of an opaque mesh, in one place, that lie in the boxes of glass. */
static void try_opaque(search *q, const shape *at, uint32_t instance_index)
{
    enum { POINTS = 4 };
    box own, near = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    if (at->kind != SHAPE_MESH)
        return; /* glass that lies on disks and balls finds them */
    shape_bounds(at, &own.low, &own.high);
    if (instance_index != SCENE_NO_INSTANCE)
        scene_place_bounds(q->s, instance_index, &own.low, &own.high);
    for (uint32_t i = 0; i < q->box_count; i++)
        if (overlap(&own, &q->boxes[i])) {
            near.low = vec3_min(near.low, q->boxes[i].low);
            near.high = vec3_max(near.high, q->boxes[i].high);
        }
    if (!(near.low.x <= near.high.x))
        return;
    affine world_from_object;
    if (instance_index != SCENE_NO_INSTANCE)
        world_from_object = instance_at(q->s, instance_index, 0.0f);
    for (uint32_t i = 0; i < at->as.mesh.triangle_count && q->trials > 0; i++) {
        box triangle = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
        for (int k = 0; k < 3; k++) {
            vec3 p = corner_of(&at->as.mesh, i, k);
            if (instance_index != SCENE_NO_INSTANCE)
                p = affine_point(&world_from_object, p);
            triangle.low = vec3_min(triangle.low, p);
            triangle.high = vec3_max(triangle.high, p);
        }
        if (overlap(&triangle, &near))
            try_triangle(q, at, instance_index, i, POINTS);
    }
}

static void add_box(search *q, const shape *at, uint32_t instance_index)
{
    box b;
    shape_bounds(at, &b.low, &b.high);
    if (instance_index != SCENE_NO_INSTANCE)
        scene_place_bounds(q->s, instance_index, &b.low, &b.high);
    if (q->box_count < BOXES_MAX) {
        q->boxes[q->box_count++] = b;
        return;
    }
    box *last = &q->boxes[BOXES_MAX - 1];
    last->low = vec3_min(last->low, b.low);
    last->high = vec3_max(last->high, b.high);
}

/* Calls a function for all shapes of some roles, wherever they are; each gets as many trials as are left. */
static ag_status for_each_place(search *q, run_context *run, unsigned roles,
                                void (*call)(search *q, const shape *at, uint32_t instance_index))
{
    for (uint32_t i = 0; i < q->s->shape_count; i++) {
        const shape *at = &q->s->shapes[i];
        if (run_is_cancelled(run))
            return AG_CANCELLED;
        if (!(at->role & roles) || shape_is_invisible(at))
            continue;
        if (at->object_index == SCENE_NO_OBJECT) {
            call(q, at, SCENE_NO_INSTANCE);
            continue;
        }
        for (uint32_t k = q->first[at->object_index]; k != SCENE_NO_INSTANCE; k = q->next[k])
            call(q, at, k);
    }
    return AG_OK;
}

/* Errors: AG_ERROR_MEMORY. */
static ag_status list_instances(search *q)
{
    const scene *s = q->s;
    q->is_lost = calloc((size_t)s->shape_count + 1, sizeof *q->is_lost);
    q->first = malloc(((size_t)s->object_count + 1) * sizeof *q->first);
    q->next = malloc(((size_t)s->instance_count + 1) * sizeof *q->next);
    if (!q->is_lost || !q->first || !q->next)
        return AG_ERROR_MEMORY;
    for (uint32_t i = 0; i < s->object_count; i++)
        q->first[i] = SCENE_NO_INSTANCE;
    for (uint32_t i = s->instance_count; i-- > 0;) {
        q->next[i] = q->first[s->instances[i].object_index];
        q->first[s->instances[i].object_index] = i;
    }
    return AG_OK;
}

/* Tells how many shapes of a role lie on opaque faces, which is the first, and what that means. */
static void tell(const search *q, unsigned role, log_sink *log, ag_log_level level, const char *meaning)
{
    const scene *s = q->s;
    uint32_t count = 0, first = 0;
    for (uint32_t i = s->shape_count; i-- > 0;)
        if (s->shapes[i].role == role && is_marked(q, &s->shapes[i]))
            count++, first = i;
    if (count == 0)
        return;
    const char *name = scene_name(s, NAMED_MATERIAL, s->shapes[first].material_index);
    log_message(log, level,
                "%u of the shapes that let light through lie flush on opaque faces, the first is shape %u%s%s%s: %s",
                count, first, name ? " of material \"" : "", name ? name : "", name ? "\"" : "", meaning);
}

ag_status glued_faces_find(scene *s, run_context *run)
{
    const unsigned others = SHAPE_IS_TRANSPARENT | SHAPE_IS_TRANSLUCENT;
    unsigned roles = 0;
    s->has_glued_faces = false;
    for (uint32_t i = 0; i < s->shape_count; i++) {
        s->shapes[i].role = role_of(s, &s->shapes[i]);
        s->shapes[i].is_glued = false;
        roles |= s->shapes[i].role;
    }
    if (!(roles & others) || !(roles & SHAPE_IS_OPAQUE))
        return AG_OK;
    search *q = calloc(1, sizeof *q);
    if (!q)
        return AG_ERROR_MEMORY;
    q->s = s;
    ag_status status = list_instances(q);
    if (status == AG_OK)
        status = for_each_place(q, run, others, add_box);
    q->trials = TRIALS_MAX;
    if (status == AG_OK)
        status = for_each_place(q, run, others, try_glass);
    q->trials = TRIALS_MAX;
    if (status == AG_OK)
        status = for_each_place(q, run, SHAPE_IS_OPAQUE, try_opaque);
    if (status == AG_OK) {
        tell(q, SHAPE_IS_TRANSPARENT, run->log, AG_LOG_INFO, "glass there is as if glued to the face");
        tell(q, SHAPE_IS_TRANSLUCENT, run->log, AG_LOG_WARNING,
             "rounding decides which of the two a ray meets there; lift paper, leaves or coloured glass a little");
    }
    free(q->is_lost);
    free(q->first);
    free(q->next);
    free(q);
    return status;
}
