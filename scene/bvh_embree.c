/* bvh_embree.c: the scene's shapes in Embree, and rays cast at them; the only file that knows Embree.
 * Rests on: Wald et al., "Embree: A Kernel Framework for Efficient CPU Ray Tracing", 2014.
 * Robust mode always: without it a few rays in a million slip through closed meshes. The kernels are held to AVX2 unless
 * asked otherwise: wider ones give other bits and no more speed for single rays.
 * Threads: the build is joined by the run's workers and no thread is created; rays may be cast from any. */
#define _GNU_SOURCE
#include "alpha.h"
#include "cpu_count.h"

#include "embree_api.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What Embree gives back to our functions. */
typedef struct attached {
    const scene *s;
    const shape *shape;
} attached;

struct bvh {
    attached *attached; /* [shape_count] */
    RTCDevice device;
    RTCScene scene;
    char isa[16];
    _Atomic int64_t memory_bytes; /* moved by Embree's memory monitor, from several threads; a plain count */
};

static bool count_memory(void *user, ssize_t bytes, bool post)
{
    (void)post;
    bvh *b = user;
    atomic_fetch_add_explicit(&b->memory_bytes, (int64_t)bytes, memory_order_relaxed);
    return true;
}

static bool report_progress(void *user, double fraction)
{
    run_context *run = user;
    run_progress(run, AG_PHASE_BVH, fraction < 1.0 ? fraction : 1.0);
    return !run_is_cancelled(run);
}

static void log_embree_error(void *user, enum RTCError code, const char *text)
{
    if (code != RTC_ERROR_CANCELLED)
        log_message(user, AG_LOG_ERROR, "Embree: %s", text ? text : "unknown error");
}

/* --- disks and ellipsoids: user geometry, one primitive each --- */

static void quadric_bounds(const struct RTCBoundsFunctionArguments *arguments)
{
    vec3 low, high;
    shape_bounds(((const attached *)arguments->geometryUserPtr)->shape, &low, &high);
    struct RTCBounds *b = arguments->bounds_o;
    b->lower_x = low.x, b->lower_y = low.y, b->lower_z = low.z;
    b->upper_x = high.x, b->upper_y = high.y, b->upper_z = high.z;
}

static bool quadric_hit(const void *user, const struct RTCRay *ray, float *out_t)
{
    const attached *a = user;
    vec3 origin = {ray->org_x, ray->org_y, ray->org_z}, direction = {ray->dir_x, ray->dir_y, ray->dir_z};
    float from = ray->tnear;
    for (uint32_t crossing = 0; shape_intersect_quadric(a->shape, origin, direction, from, ray->tfar, out_t); crossing++) {
        if (shape_is_opaque(a->shape) ||
            alpha_stops_ray(a->s, a->shape, 0, 0.0f, 0.0f, crossing, origin, direction, *out_t, ray->id))
            return true;
        from = *out_t;
    }
    return false;
}

/* Only rtcIntersect1 and rtcOccluded1 are used, so N is 1 in both. */
static void quadric_intersect(const struct RTCIntersectFunctionNArguments *arguments)
{
    if (!arguments->valid[0])
        return;
    struct RTCRayHit *ray_hit = (struct RTCRayHit *)(void *)arguments->rayhit;
    float t;
    bool was_hit = quadric_hit(arguments->geometryUserPtr, &ray_hit->ray, &t);
    if (was_hit) {
        ray_hit->ray.tfar = t;
        ray_hit->hit.u = ray_hit->hit.v = 0.0f;
        ray_hit->hit.Ng_x = ray_hit->hit.Ng_y = 0.0f, ray_hit->hit.Ng_z = 1.0f;
        ray_hit->hit.geomID = arguments->geomID;
        ray_hit->hit.primID = arguments->primID;
        ray_hit->hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    }
    EMBREE_REPORT(arguments, was_hit);
}

static void quadric_occluded(const struct RTCOccludedFunctionNArguments *arguments)
{
    if (!arguments->valid[0])
        return;
    struct RTCRay *ray = (struct RTCRay *)(void *)arguments->ray;
    float t;
    bool was_hit = quadric_hit(arguments->geometryUserPtr, ray, &t);
    if (was_hit)
        ray->tfar = -INFINITY;
    EMBREE_REPORT(arguments, was_hit);
}

/* --- triangles that are not wholly there --- */

/* N is 1 here too. Embree has put the hit's distance into the ray. */
static void filter_triangle(const struct RTCFilterFunctionNArguments *arguments)
{
    const attached *a = arguments->geometryUserPtr;
    const struct RTCRay *ray = (const struct RTCRay *)(const void *)arguments->ray;
    const struct RTCHit *hit = (const struct RTCHit *)(const void *)arguments->hit;
    if (arguments->valid[0] &&
        !alpha_stops_ray(a->s, a->shape, hit->primID, hit->u, hit->v, 0, (vec3){ray->org_x, ray->org_y, ray->org_z},
                         (vec3){ray->dir_x, ray->dir_y, ray->dir_z}, ray->tfar, ray->id))
        arguments->valid[0] = 0;
}

/* --- build --- */

static bool attach_shape(bvh *b, attached *user, uint32_t index)
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
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, m->positions, 0, sizeof(vec3),
                                   m->vertex_count);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, m->indices, 0,
                                   3 * sizeof(uint32_t), m->triangle_count);
        if (!shape_is_opaque(s)) {
            rtcSetGeometryIntersectFilterFunction(geometry, filter_triangle);
            rtcSetGeometryOccludedFilterFunction(geometry, filter_triangle);
        }
    } else if (s->as.quadric.uniform_radius > 0.0f && shape_is_opaque(s)) {
        geometry = rtcNewGeometry(b->device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
        float *sphere = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                                                4 * sizeof(float), 1);
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
    rtcSetGeometryUserData(geometry, user);
    rtcSetGeometryMask(geometry, 0xffffffffu); /* Embree 4's default would be bit 0 alone */
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(b->scene, geometry, index);
    rtcReleaseGeometry(geometry);
    return true;
}

typedef struct build_job {
    bvh *b;
    unsigned joiner_count;
} build_job;

static void join_build(void *user, unsigned worker_index)
{
    build_job *job = user;
    if (worker_index < job->joiner_count)
        rtcJoinCommitScene(job->b->scene);
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

    /* Embree caps its threads at the affinity mask; more joiners than that would wait for a place. */
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
    rtcSetDeviceMemoryMonitorFunction(b->device, count_memory, b);

    b->scene = rtcNewScene(b->device);
    rtcSetSceneFlags(b->scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(b->scene, RTC_BUILD_QUALITY_MEDIUM);
    rtcSetSceneProgressMonitorFunction(b->scene, report_progress, run);
    for (uint32_t i = 0; i < s->shape_count; i++)
        if (!attach_shape(b, &b->attached[i], i))
            goto fail;

    if (joiners == 1)
        rtcCommitScene(b->scene);
    else
        thread_pool_run(run->pool, join_build, &(build_job){b, joiners});
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

/* --- rays --- */

static struct RTCRay embree_ray(const scene_ray *r, float max_distance)
{
    struct RTCRay ray = {.org_x = r->origin.x, .org_y = r->origin.y, .org_z = r->origin.z, .tnear = 0.0f,
                         .dir_x = r->direction.x, .dir_y = r->direction.y, .dir_z = r->direction.z, .time = r->time,
                         .tfar = max_distance, .mask = 0xffffffffu, .id = r->meets_veils, .flags = 0};
    return ray;
}

bool scene_intersect(const scene *s, scene_ray ray, float max_distance, surface_hit *out_hit)
{
    struct RTCRayHit ray_hit;
    ray_hit.ray = embree_ray(&ray, max_distance);
    ray_hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ray_hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    embree_intersect(s->bvh->scene, &ray_hit);
    if (ray_hit.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return false;
    out_hit->distance = ray_hit.ray.tfar;
    out_hit->shape_index = ray_hit.hit.geomID;
    out_hit->primitive_index = ray_hit.hit.primID;
    shape_surface_at(&s->shapes[ray_hit.hit.geomID], ray_hit.hit.primID, ray_hit.hit.u, ray_hit.hit.v,
                     vec3_add_scaled(ray.origin, ray.direction, ray_hit.ray.tfar), out_hit);
    return true;
}

float scene_first_distance(const scene *s, scene_ray ray)
{
    struct RTCRayHit ray_hit;
    ray_hit.ray = embree_ray(&ray, INFINITY);
    ray_hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ray_hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    embree_intersect(s->bvh->scene, &ray_hit);
    return ray_hit.ray.tfar;
}

bool scene_occluded(const scene *s, scene_ray ray, float max_distance)
{
    struct RTCRay cast = embree_ray(&ray, max_distance);
    embree_occluded(s->bvh->scene, &cast);
    return cast.tfar < 0.0f;
}

scene_ray surface_ray(const surface_hit *hit, scene_ray arrived, vec3 direction)
{
    vec3 n = vec3_face_forward(hit->geometric_normal, direction);
    bool passes_through = vec3_dot(arrived.direction, n) > 0.0f;
    scene_ray next = arrived;
    next.origin = vec3_add_scaled(hit->position, n, hit->epsilon);
    next.direction = direction;
    if (hit->has_medium_interface)
        next.medium = vec3_dot(hit->geometric_normal, direction) > 0.0f ? hit->medium_outside : hit->medium_inside;
    if (hit->is_flat)
        next.origin = vec3_add_scaled(next.origin, arrived.direction, passes_through ? hit->epsilon : -hit->epsilon);
    return next;
}
