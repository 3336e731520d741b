/* bvh_embree.c: the scene's shapes in Embree; with rays_embree.c the only file that knows it.
 * Rests on: Wald et al., "Embree: A Kernel Framework for Efficient CPU Ray Tracing", 2014.
 * Robust mode always: without it a few rays in a million slip through closed meshes. The kernels are held to AVX2
 * unless asked otherwise: wider ones give other bits and no more speed for single rays. Threads: the build is joined by
 * the run's workers and no thread is created. */
#define _GNU_SOURCE
#include "rays/bvh_embree.h"
#include "atomics.h"
#include "cpu_count.h"
#include "shape/alpha.h"
#include "shape/quadric.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { JOINED_ITEMS_MIN = 2048 };

/* Our user data, which Embree gives back to our functions. */
typedef struct attached {
    const scene *s;
    const shape *shape;
} attached;

/* Calls to us from Embree's threads read what was written before the build, and what they write is read after it. */
static char embree_threads;

static bool count_memory(void *user, ssize_t bytes, bool post)
{
    (void)post;
    order_after_library(&embree_threads);
    bvh *b = user;
    atomic_fetch_add_explicit(&b->memory_bytes, (int64_t)bytes, memory_order_relaxed);
    order_before_library(&embree_threads);
    return true;
}

static bool report_progress(void *user, double fraction)
{
    order_after_library(&embree_threads);
    run_context *run = user;
    run_progress(run, AG_PHASE_BVH, fraction < 1.0 ? fraction : 1.0);
    bool goes_on = !run_is_cancelled(run);
    order_before_library(&embree_threads);
    return goes_on;
}

static void log_embree_error(void *user, enum RTCError code, const char *text)
{
    if (code != RTC_ERROR_CANCELLED)
        log_message(user, AG_LOG_ERROR, "Embree: %s", text ? text : "unknown error");
}

/* --- disks and ellipsoids: user geometry, one primitive each --- */

static void quadric_bounds(const struct RTCBoundsFunctionArguments *arguments)
{
    order_after_library(&embree_threads);
    vec3 low, high;
    shape_bounds(((const attached *)arguments->geometryUserPtr)->shape, &low, &high);
    struct RTCBounds *b = arguments->bounds_o;
    b->lower_x = low.x, b->lower_y = low.y, b->lower_z = low.z;
    b->upper_x = high.x, b->upper_y = high.y, b->upper_z = high.z;
    order_before_library(&embree_threads);
}

/* The numbers of a ray or hit that comes as one of N side by side, in the order of RTCRay and RTCHit. */
enum { RAY_ORIGIN = 0, RAY_NEAR = 3, RAY_DIRECTION = 4, RAY_FAR = 8, RAY_ID = 10 };
enum { HIT_NORMAL = 0, HIT_U = 3, HIT_V = 4, HIT_PRIMITIVE = 5, HIT_GEOMETRY = 6, HIT_INSTANCE = 7 };

typedef struct lane {
    unsigned stride, at; /* N, and which of them */
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

static bool quadric_hit(const void *user, void *ray, lane l, float *out_t)
{
    const attached *a = user;
    vec3 origin = lane_vec3(ray, l, RAY_ORIGIN), direction = lane_vec3(ray, l, RAY_DIRECTION);
    float from = *lane_float(ray, l, RAY_NEAR), to = *lane_float(ray, l, RAY_FAR);
    for (uint32_t crossing = 0; shape_intersect_quadric(a->shape, origin, direction, from, to, out_t); crossing++) {
        if (shape_is_opaque(a->shape) || alpha_stops_ray(a->s, a->shape, 0, 0.0f, 0.0f, crossing, origin, direction,
                                                         *out_t, (ray_alpha_rule)*lane_uint(ray, l, RAY_ID)))
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
    const attached *a = arguments->geometryUserPtr;
    void *ray = arguments->ray, *hit = arguments->hit;
    for (lane l = {arguments->N, 0}; l.at < l.stride; l.at++) {
        if (!arguments->valid[l.at])
            continue;
        vec3 origin = lane_vec3(ray, l, RAY_ORIGIN), direction = lane_vec3(ray, l, RAY_DIRECTION);
        uint32_t crossing = a->shape->kind == SHAPE_CURVES && a->shape->as.curves.type == CURVES_CYLINDER &&
                            vec3_dot(lane_vec3(hit, l, HIT_NORMAL), direction) > 0.0f;
        if (!alpha_stops_ray(a->s, a->shape, *lane_uint(hit, l, HIT_PRIMITIVE), *lane_float(hit, l, HIT_U),
                             *lane_float(hit, l, HIT_V), crossing, origin, direction, *lane_float(ray, l, RAY_FAR),
                             (ray_alpha_rule)*lane_uint(ray, l, RAY_ID)))
            arguments->valid[l.at] = 0;
    }
}

/* --- build --- */

static RTCGeometry make_curves(bvh *b, const shape *s)
{
    static const enum RTCGeometryType TYPES[] = {[CURVES_FLAT] = RTC_GEOMETRY_TYPE_FLAT_BEZIER_CURVE,
                                                 [CURVES_CYLINDER] = RTC_GEOMETRY_TYPE_ROUND_BEZIER_CURVE,
                                                 [CURVES_RIBBON] = RTC_GEOMETRY_TYPE_NORMAL_ORIENTED_BEZIER_CURVE};
    const curves *c = &s->as.curves;
    size_t point_count = 4 * (size_t)c->segment_count;
    RTCGeometry geometry = rtcNewGeometry(b->device, TYPES[c->type]);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, c->points, 0, sizeof *c->points,
                               point_count);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, c->first_points, 0,
                               sizeof *c->first_points, c->segment_count);
    if (c->type == CURVES_RIBBON)
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_NORMAL, 0, RTC_FORMAT_FLOAT3, c->normals, 0,
                                   sizeof *c->normals, point_count);
    if (c->type == CURVES_FLAT)
        rtcSetGeometryTessellationRate(geometry, CURVES_FLAT_PIECES);
    return geometry;
}

static bool attach_shape(bvh *b, RTCScene into, attached *user, uint32_t index)
{
    const shape *s = user->shape;
    RTCGeometry geometry;
    if (shape_is_invisible(s))
        return true;
    if (s->kind == SHAPE_MESH) {
        const mesh *m = &s->as.mesh;
        if (m->triangle_count == 0)
            return true;
        geometry = rtcNewGeometry(b->device, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, m->positions, 0,
                                   sizeof(vec3), m->vertex_count);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, m->indices, 0,
                                   3 * sizeof(uint32_t), m->triangle_count);
    } else if (s->kind == SHAPE_CURVES) {
        geometry = make_curves(b, s);
    } else if (s->as.quadric.uniform_radius > 0.0f && shape_is_opaque(s)) {
        geometry = rtcNewGeometry(b->device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
        float *sphere =
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), 1);
        if (!sphere) {
            rtcReleaseGeometry(geometry);
            return false;
        }
        const quadric *q = &s->as.quadric;
        sphere[0] = q->center.x, sphere[1] = q->center.y, sphere[2] = q->center.z, sphere[3] = q->uniform_radius;
    } else {
        geometry = rtcNewGeometry(b->device, RTC_GEOMETRY_TYPE_USER);
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

/* Instances are numbered behind the shapes. */
static void attach_instance(bvh *b, const scene *s, uint32_t instance_index)
{
    const scene_instance *i = &s->instances[instance_index];
    if (!b->objects[i->object_index])
        return;
    RTCGeometry geometry = rtcNewGeometry(b->device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, b->objects[i->object_index]);
    rtcSetGeometryTimeStepCount(geometry, i->step_count);
    for (uint32_t k = 0; k < i->step_count; k++)
        rtcSetGeometryTransform(geometry, k, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, s->instance_steps[i->first_step + k].m);
    rtcSetGeometryMask(geometry, 0xffffffffu);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(b->scene, geometry, s->shape_count + instance_index);
    rtcReleaseGeometry(geometry);
}

static RTCScene new_scene(bvh *b)
{
    RTCScene made = rtcNewScene(b->device);
    rtcSetSceneFlags(made, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(made, RTC_BUILD_QUALITY_MEDIUM);
    return made;
}

typedef struct build_job {
    RTCScene scene;
    unsigned joiner_count;
} build_job;

static void join_build(void *user, unsigned worker_index)
{
    build_job *job = user;
    if (worker_index < job->joiner_count)
        rtcJoinCommitScene(job->scene);
}

/* Joining costs more than a small build: item_count tells whether it is one. */
static void build(RTCScene which, uint64_t item_count, run_context *run, unsigned joiners)
{
    order_before_library(&embree_threads);
    if (joiners == 1 || item_count < JOINED_ITEMS_MIN)
        rtcCommitScene(which);
    else
        thread_pool_run(run->pool, join_build, &(build_job){which, joiners});
    order_after_library(&embree_threads);
}

static uint64_t item_count_of(const shape *s)
{
    return s->kind == SHAPE_MESH ? s->as.mesh.triangle_count : s->kind == SHAPE_CURVES ? s->as.curves.segment_count : 1;
}

/* The objects that instances show, each a scene of its own, whose shapes are numbered as in its list. */
static bool build_objects(bvh *b, const scene *s, run_context *run, unsigned joiners)
{
    if (s->instance_count == 0)
        return true;
    b->objects = calloc(s->object_count, sizeof *b->objects);
    if (!b->objects)
        return false;
    b->object_count = s->object_count;
    for (uint32_t i = 0; i < s->instance_count; i++) {
        uint32_t index = s->instances[i].object_index;
        const scene_object *o = &s->objects[index];
        if (b->objects[index] || o->shape_count == 0)
            continue;
        if (run_is_cancelled(run))
            return true;
        uint64_t item_count = 0;
        b->objects[index] = new_scene(b);
        for (uint32_t k = 0; k < o->shape_count; k++) {
            attached *user = &b->attached[s->object_shapes[o->first_shape + k]];
            item_count += item_count_of(user->shape);
            if (!attach_shape(b, b->objects[index], user, k))
                return false;
        }
        build(b->objects[index], item_count, run, joiners);
    }
    return true;
}

ag_status bvh_create(const scene *s, run_context *run, const char *isa, bvh **out_bvh)
{
    bvh *b = calloc(1, sizeof *b);
    if (!b)
        return AG_ERROR_MEMORY;
    b->attached = malloc(((size_t)s->shape_count + 1) * sizeof *b->attached);
    if (!b->attached) {
        free(b);
        return AG_ERROR_MEMORY;
    }
    for (uint32_t i = 0; i < s->shape_count; i++)
        b->attached[i] = (attached){s, &s->shapes[i]};
    snprintf(b->isa, sizeof b->isa, "%s", isa ? isa : "avx2");

    /* Embree caps its threads at the affinity mask; more joiners than that would wait for a free thread. */
    unsigned joiners = thread_pool_worker_count(run->pool), available = cpu_count_available();
    if (joiners > available)
        joiners = available;
    char settings[96];
    snprintf(settings, sizeof settings, "threads=%u,user_threads=%u,max_isa=%s", joiners, joiners, b->isa);
    ag_status status = AG_ERROR_RAY_TRACING;
    b->device = rtcNewDevice(settings);
    if (!b->device) {
        log_message(run->log, AG_LOG_ERROR, "Embree: no device for \"%s\" (error %d)", settings,
                    (int)rtcGetDeviceError(NULL));
        goto fail;
    }
    rtcSetDeviceErrorFunction(b->device, log_embree_error, run->log);
    order_before_library(&embree_threads);
    rtcSetDeviceMemoryMonitorFunction(b->device, count_memory, b);

    if (!build_objects(b, s, run, joiners))
        goto fail;
    b->scene = new_scene(b);
    rtcSetSceneProgressMonitorFunction(b->scene, report_progress, run);
    for (uint32_t i = 0; i < s->shape_count; i++)
        if (s->shapes[i].object_index == SCENE_NO_OBJECT && !attach_shape(b, b->scene, &b->attached[i], i))
            goto fail;
    for (uint32_t i = 0; i < s->instance_count; i++)
        attach_instance(b, s, i);
    build(b->scene, UINT64_MAX, run, joiners);
    rtcSetSceneProgressMonitorFunction(b->scene, NULL, NULL);

    if (run_is_cancelled(run)) {
        status = AG_CANCELLED;
        goto fail;
    }
    enum RTCError error = rtcGetDeviceError(b->device);
    if (error == RTC_ERROR_OUT_OF_MEMORY)
        status = AG_ERROR_MEMORY;
    if (error != RTC_ERROR_NONE)
        goto fail;
    rtcSetDeviceErrorFunction(b->device, NULL, NULL); /* the log may go before the bvh does */
    run_progress(run, AG_PHASE_BVH, 1.0);
    *out_bvh = b;
    return AG_OK;

fail:
    bvh_destroy(b);
    return status;
}

void bvh_destroy(bvh *b)
{
    if (!b)
        return;
    if (b->scene)
        rtcReleaseScene(b->scene);
    for (uint32_t i = 0; i < b->object_count; i++)
        if (b->objects[i])
            rtcReleaseScene(b->objects[i]);
    free(b->objects);
    if (b->device)
        rtcReleaseDevice(b->device);
    free(b->attached);
    free(b);
}

uint64_t bvh_memory_bytes(const bvh *b)
{
    int64_t bytes = atomic_load_explicit(&b->memory_bytes, memory_order_relaxed);
    return bytes > 0 ? (uint64_t)bytes : 0;
}

const char *bvh_isa(const bvh *b) { return b->isa; }
