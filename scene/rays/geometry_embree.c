/* geometry_embree.c: see geometry_embree.h.
 * Rests on: Wald et al., "Embree: A Kernel Framework for Efficient CPU Ray Tracing", 2014. Threads: Embree's call the
 * functions below. */
#include "rays/geometry_embree.h"

#include "atomics.h"
#include "shape/alpha.h"
#include "shape/curves.h"
#include "shape/quadric.h"

/* --- disks and ellipsoids: user geometry, one primitive each --- */

static void quadric_bounds(const struct RTCBoundsFunctionArguments *arguments)
{
    order_after_library(&embree_threads);
    vec3 low, high;
    shape_bounds(((const embree_user *)arguments->geometryUserPtr)->shape, &low, &high);
    struct RTCBounds *b = arguments->bounds_o;
    b->lower_x = low.x, b->lower_y = low.y, b->lower_z = low.z;
    b->upper_x = high.x, b->upper_y = high.y, b->upper_z = high.z;
    order_before_library(&embree_threads);
}

/* The numbers of a ray or hit that comes as one of N side by side, in the order of RTCRay and RTCHit. */
enum { RAY_ORIGIN = 0, RAY_NEAR = 3, RAY_DIRECTION = 4, RAY_TIME = 7, RAY_FAR = 8, RAY_ID = 10 };
enum { HIT_NORMAL = 0, HIT_U = 3, HIT_V = 4, HIT_PRIMITIVE = 5, HIT_GEOMETRY = 6, HIT_INSTANCE = 7 };

typedef struct lane {
    unsigned stride, at; /* N, and the index among them */
} lane;

static float *lane_float(void *first, lane l, unsigned number) { return (float *)first + number * l.stride + l.at; }
static uint32_t *lane_uint(void *first, lane l, unsigned number)
{
    return (uint32_t *)first + number * l.stride + l.at;
}
static vec3 lane_vec3(void *first, lane l, unsigned number)
{
    return (vec3){*lane_float(first, l, number), *lane_float(first, l, number + 1), *lane_float(first, l, number + 2)};
}

static ray_alpha_rule alpha_rule_of(uint32_t ray_id)
{
    return (ray_alpha_rule)(ray_id & ((1u << EMBREE_ROLES_SHIFT) - 1));
}

static bool is_sought(const shape *s, uint32_t ray_id)
{
    const uint32_t roles = ray_id >> EMBREE_ROLES_SHIFT;
    return roles == 0 || (roles & s->role) != 0;
}

static bool quadric_hit(const void *user, void *ray, lane l, float *out_t)
{
    const embree_user *a = user;
    vec3 origin = lane_vec3(ray, l, RAY_ORIGIN), direction = lane_vec3(ray, l, RAY_DIRECTION);
    float from = *lane_float(ray, l, RAY_NEAR), to = *lane_float(ray, l, RAY_FAR);
    if (!is_sought(a->shape, *lane_uint(ray, l, RAY_ID)))
        return false;
    for (uint32_t crossing = 0; shape_intersect_quadric(a->shape, origin, direction, from, to, out_t); crossing++) {
        if (shape_is_opaque(a->shape) ||
            alpha_stops_ray(a->s, a->shape, 0, 0.0f, 0.0f, crossing, origin, direction, *lane_float(ray, l, RAY_TIME),
                            *out_t, alpha_rule_of(*lane_uint(ray, l, RAY_ID))))
            return true;
        from = *out_t;
    }
    return false;
}

static void quadric_intersect(const struct RTCIntersectFunctionNArguments *arguments)
{
    /* RTCRayHitN is the rays, and then the hits */
    void *ray = arguments->rayhit, *hit = (float *)ray + sizeof(struct RTCRay) / sizeof(float) * arguments->N;
    for (lane l = {arguments->N, 0}; l.at < l.stride; l.at++) {
        float t;
        if (!arguments->valid[l.at])
            continue;
        bool was_hit = quadric_hit(arguments->geometryUserPtr, ray, l, &t);
        if (was_hit) {
            *lane_float(ray, l, RAY_FAR) = t;
            *lane_float(hit, l, HIT_U) = *lane_float(hit, l, HIT_V) = 0.0f;
            *lane_float(hit, l, HIT_NORMAL) = *lane_float(hit, l, HIT_NORMAL + 1) = 0.0f;
            *lane_float(hit, l, HIT_NORMAL + 2) = 1.0f;
            *lane_uint(hit, l, HIT_GEOMETRY) = arguments->geomID;
            *lane_uint(hit, l, HIT_PRIMITIVE) = arguments->primID;
            *lane_uint(hit, l, HIT_INSTANCE) = arguments->context->instID[0];
        }
        EMBREE_REPORT(arguments, l.at, was_hit);
    }
}

static void quadric_occluded(const struct RTCOccludedFunctionNArguments *arguments)
{
    for (lane l = {arguments->N, 0}; l.at < l.stride; l.at++) {
        float t;
        if (!arguments->valid[l.at])
            continue;
        bool was_hit = quadric_hit(arguments->geometryUserPtr, arguments->ray, l, &t);
        if (was_hit)
            *lane_float(arguments->ray, l, RAY_FAR) = -INFINITY;
        EMBREE_REPORT(arguments, l.at, was_hit);
    }
}

/* --- triangles and curves that are not wholly there --- */

/* Embree has put the hit's distance into the ray. A tube is crossed twice, in and out. */
static void filter_hit(const struct RTCFilterFunctionNArguments *arguments)
{
    const embree_user *a = arguments->geometryUserPtr;
    void *ray = arguments->ray, *hit = arguments->hit;
    for (lane l = {arguments->N, 0}; l.at < l.stride; l.at++) {
        if (!arguments->valid[l.at])
            continue;
        vec3 origin = lane_vec3(ray, l, RAY_ORIGIN), direction = lane_vec3(ray, l, RAY_DIRECTION);
        uint32_t crossing = a->shape->kind == SHAPE_CURVES && a->shape->as.curves.type == CURVES_CYLINDER &&
                            vec3_dot(lane_vec3(hit, l, HIT_NORMAL), direction) > 0.0f;
        if (!alpha_stops_ray(a->s, a->shape, *lane_uint(hit, l, HIT_PRIMITIVE), *lane_float(hit, l, HIT_U),
                             *lane_float(hit, l, HIT_V), crossing, origin, direction, *lane_float(ray, l, RAY_TIME),
                             *lane_float(ray, l, RAY_FAR), alpha_rule_of(*lane_uint(ray, l, RAY_ID))))
            arguments->valid[l.at] = 0;
    }
}

/* --- all kinds --- */

void embree_filter_by_role(const struct RTCFilterFunctionNArguments *arguments)
{
    const embree_user *a = arguments->geometryUserPtr;
    for (lane l = {arguments->N, 0}; l.at < l.stride; l.at++)
        if (arguments->valid[l.at] && !is_sought(a->shape, *lane_uint(arguments->ray, l, RAY_ID)))
            arguments->valid[l.at] = 0;
}

static RTCGeometry make_curves(RTCDevice device, const shape *s)
{
    static const enum RTCGeometryType TYPES[] = {[CURVES_FLAT] = RTC_GEOMETRY_TYPE_FLAT_BEZIER_CURVE,
                                                 [CURVES_CYLINDER] = RTC_GEOMETRY_TYPE_ROUND_BEZIER_CURVE,
                                                 [CURVES_RIBBON] = RTC_GEOMETRY_TYPE_NORMAL_ORIENTED_BEZIER_CURVE};
    const curves *c = &s->as.curves;
    const size_t point_count = curves_points_of_each(c) * c->segment_count;
    RTCGeometry geometry = rtcNewGeometry(device, TYPES[c->type]);
    rtcSetGeometryTimeStepCount(geometry, c->motion_segments + 1);
    for (unsigned k = 0; k <= c->motion_segments; k++) /* indices are those of the first step: others begin later */
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, k, RTC_FORMAT_FLOAT4, c->points + 4 * (size_t)k, 0,
                                   sizeof *c->points, point_count - 4 * (size_t)k);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, c->first_points, 0,
                               sizeof *c->first_points, c->segment_count);
    if (c->type == CURVES_RIBBON)
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_NORMAL, 0, RTC_FORMAT_FLOAT3, c->normals, 0,
                                   sizeof *c->normals, point_count);
    if (c->type == CURVES_FLAT)
        rtcSetGeometryTessellationRate(geometry, CURVES_FLAT_PIECES);
    return geometry;
}

bool embree_has_as_sphere(const shape *s)
{
    return s->kind == SHAPE_SPHERE && s->as.quadric.uniform_radius > 0.0f && shape_is_opaque(s);
}

bool embree_attach_shape(RTCDevice device, RTCScene into, embree_user *user, uint32_t index)
{
    const shape *s = user->shape;
    RTCGeometry geometry;
    if (shape_is_invisible(s))
        return true;
    if (s->kind == SHAPE_MESH) {
        const mesh *m = &s->as.mesh;
        if (m->triangle_count == 0)
            return true;
        geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetGeometryTimeStepCount(geometry, m->motion_segments + 1);
        for (unsigned k = 0; k <= m->motion_segments; k++)
            rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, k, RTC_FORMAT_FLOAT3,
                                       m->positions + (size_t)k * m->vertex_count, 0, sizeof(vec3), m->vertex_count);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, m->indices, 0,
                                   3 * sizeof(uint32_t), m->triangle_count);
    } else if (s->kind == SHAPE_CURVES) {
        geometry = make_curves(device, s);
    } else if (embree_has_as_sphere(s)) {
        geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
        float *sphere =
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), 1);
        if (!sphere) {
            rtcReleaseGeometry(geometry);
            return false;
        }
        const quadric *q = &s->as.quadric;
        sphere[0] = q->center.x, sphere[1] = q->center.y, sphere[2] = q->center.z, sphere[3] = q->uniform_radius;
    } else {
        geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryUserPrimitiveCount(geometry, 1);
        rtcSetGeometryBoundsFunction(geometry, quadric_bounds, NULL);
        rtcSetGeometryIntersectFunction(geometry, quadric_intersect);
        rtcSetGeometryOccludedFunction(geometry, quadric_occluded);
    }
    if ((s->kind == SHAPE_MESH || s->kind == SHAPE_CURVES) && !shape_is_opaque(s)) {
        rtcSetGeometryIntersectFilterFunction(geometry, filter_hit);
        rtcSetGeometryOccludedFilterFunction(geometry, filter_hit);
    }
    rtcSetGeometryUserData(geometry, user);
    rtcSetGeometryMask(geometry, 0xffffffffu); /* Embree 4's default would be bit 0 alone */
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(into, geometry, index);
    rtcReleaseGeometry(geometry);
    return true;
}

uint64_t embree_item_count(const shape *s)
{
    return s->kind == SHAPE_MESH ? s->as.mesh.triangle_count : s->kind == SHAPE_CURVES ? s->as.curves.segment_count : 1;
}
