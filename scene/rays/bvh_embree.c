/* bvh_embree.c: the scene's trees in Embree; only the files *_embree.c know it.
 * Rests on: Wald et al., "Embree: A Kernel Framework for Efficient CPU Ray Tracing", 2014.
 * Robust mode always: without it a few rays in a million slip through closed meshes. The kernels are held to AVX2
 * unless asked otherwise: wider ones give other bits and no more speed for single rays. Threads: the build is joined by
 * the run's workers and no thread is created. */
#define _GNU_SOURCE
#include "rays/bvh_embree.h"
#include "atomics.h"
#include "cpu_count.h"
#include "rays/geometry_embree.h"
#include "shape/alpha.h"
#include "shape/mesh_motion.h"
#include "status.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { JOINED_ITEMS_MIN = 2048 };

/* A tree of Embree's, of the world or of an object. Scenes that follow one another hold it together as long as nothing
 * in it changes; its functions ask the one that was pointed at last. */
typedef struct bvh_tree {
    RTCScene scene;
    unsigned holder_count;
    const struct scene *asked; /* that was pointed at last */
    embree_user attached[];    /* by the number of a shape's geometry */
} bvh_tree;

/* Embree's, of all trees of scenes that follow one another. */
struct bvh_device {
    RTCDevice embree;
    unsigned holder_count;
    char isa[16];
    _Atomic int64_t memory_bytes; /* moved by Embree's memory monitor, from several threads; a plain count */
    log_sink *log;                /* for errors; borrowed while trees are made */
    /* The first RTCError since trees began to be made. Embree keeps an error for the thread that met it, which may be
     * any that joins, so asking it from one thread does not do. Read when all have ended; relaxed. */
    atomic_int error;
    bool lacked_memory; /* in any build */
};

char embree_threads;

static bool count_memory(void *user, ssize_t bytes, bool post)
{
    (void)post;
    order_after_library(&embree_threads);
    struct bvh_device *d = user;
    atomic_fetch_add_explicit(&d->memory_bytes, (int64_t)bytes, memory_order_relaxed);
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

static void take_error(void *user, enum RTCError code, const char *text)
{
    struct bvh_device *d = user;
    int none = RTC_ERROR_NONE;
    order_after_library(&embree_threads);
    if (code == RTC_ERROR_CANCELLED) /* the run knows */
        return;
    if (atomic_compare_exchange_strong_explicit(&d->error, &none, (int)code, memory_order_relaxed,
                                                memory_order_relaxed))
        log_message(d->log, AG_LOG_ERROR, "Embree: %s", text ? text : "unknown error");
}

/* AG_OK, or what the first error since trees began to be made means. */
static ag_status build_status(const struct bvh_device *d)
{
    const int error = atomic_load_explicit(&d->error, memory_order_relaxed);
    if (error == RTC_ERROR_NONE)
        return AG_OK;
    return error == RTC_ERROR_OUT_OF_MEMORY ? AG_ERROR_MEMORY : AG_ERROR_RAY_TRACING;
}

/* --- build --- */

static ag_status attach_shape(const bvh *b, bvh_tree *t, uint32_t index)
{
    const bool is_attached = embree_attach_shape(b->device->embree, t->scene, &t->attached[index], index);
    AG_TRY(build_status(b->device));
    return is_attached ? AG_OK : AG_ERROR_RAY_TRACING;
}

/* Instances are numbered behind the shapes. */
static void attach_instance(const bvh *b, const scene *s, uint32_t instance_index)
{
    const scene_instance *i = &s->instances[instance_index];
    if (!b->objects[i->object_index])
        return;
    RTCGeometry geometry = rtcNewGeometry(b->device->embree, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, b->objects[i->object_index]->scene);
    rtcSetGeometryTimeStepCount(geometry, i->step_count);
    for (uint32_t k = 0; k < i->step_count; k++)
        rtcSetGeometryTransform(geometry, k, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, s->instance_steps[i->first_step + k].m);
    rtcSetGeometryMask(geometry, 0xffffffffu);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(b->world->scene, geometry, s->shape_count + instance_index);
    rtcReleaseGeometry(geometry);
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

/* --- trees --- */

/* NULL when out of memory. */
static bvh_tree *new_tree(const bvh *b, uint32_t shape_count)
{
    bvh_tree *t = calloc(1, sizeof *t + shape_count * sizeof t->attached[0]);
    if (!t)
        return NULL;
    t->holder_count = 1;
    t->scene = rtcNewScene(b->device->embree);
    rtcSetSceneFlags(t->scene, EMBREE_SCENE_FLAGS);
    rtcSetSceneBuildQuality(t->scene, RTC_BUILD_QUALITY_MEDIUM);
    return t;
}

static void release_tree(bvh_tree *t)
{
    if (!t || --t->holder_count > 0)
        return;
    rtcReleaseScene(t->scene);
    free(t);
}

static bvh_tree *hold_tree(bvh_tree *t, scene_reuse *reuse)
{
    t->holder_count++;
    reuse->trees_kept++;
    return t;
}

static void point_world(bvh_tree *t, const scene *s)
{
    t->asked = s;
    for (uint32_t i = 0; i < s->shape_count; i++)
        t->attached[i] = (embree_user){s, &s->shapes[i]};
}

static void point_object(bvh_tree *t, const scene *s, const scene_object *o)
{
    t->asked = s;
    for (uint32_t k = 0; k < o->shape_count; k++)
        t->attached[k] = (embree_user){s, &s->shapes[s->object_shapes[o->first_shape + k]]};
}

void bvh_point_at(const bvh *b, const scene *s)
{
    if (!b)
        return;
    point_world(b->world, s);
    for (uint32_t i = 0; i < b->object_count; i++)
        if (b->objects[i])
            point_object(b->objects[i], s, &s->objects[i]);
}

/* Whether Embree would be told the same of both. */
static bool is_same_to_tree(const shape *a, const shape *b)
{
    return shape_is_invisible(a) == shape_is_invisible(b) &&
           (shape_is_invisible(a) || (shape_is_opaque(a) == shape_is_opaque(b) && shape_has_same_surface(a, b)));
}

static bool is_same_object(const scene *s, const scene_object *o, const scene *before, const scene_object *was)
{
    bool is_same = o->shape_count == was->shape_count;
    for (uint32_t k = 0; k < o->shape_count && is_same; k++)
        is_same = is_same_to_tree(&s->shapes[s->object_shapes[o->first_shape + k]],
                                  &before->shapes[before->object_shapes[was->first_shape + k]]);
    return is_same;
}

/* The tree of an object of the scene before that serves no other one yet; NULL: there is none. Objects keep their
 * order, but for some that are gone, or new: *in_out_at is where the search begins. */
static bvh_tree *find_kept_object(const scene *s, const scene_object *o, uint32_t *in_out_at)
{
    const scene *before = s->before;
    const uint32_t count = before && before->bvh ? before->bvh->object_count : 0;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t at = (*in_out_at + i) % count;
        bvh_tree *t = before->bvh->objects[at];
        if (t && t->asked != s && is_same_object(s, o, before, &before->objects[at])) {
            *in_out_at = at + 1;
            return t;
        }
    }
    return NULL;
}

/* Builds the objects that have instances, each as an Embree scene of its own, whose shapes are numbered as in its
 * list. */
static ag_status make_objects(bvh *b, const scene *s, run_context *run, unsigned joiners, scene_reuse *reuse)
{
    uint32_t kept_at = 0;
    if (s->instance_count == 0)
        return AG_OK;
    b->objects = calloc(s->object_count, sizeof *b->objects);
    if (!b->objects)
        return AG_ERROR_MEMORY;
    b->object_count = s->object_count;
    for (uint32_t i = 0; i < s->instance_count; i++) {
        const uint32_t index = s->instances[i].object_index;
        const scene_object *o = &s->objects[index];
        if (b->objects[index] || o->shape_count == 0)
            continue;
        if (run_is_cancelled(run))
            return AG_CANCELLED;
        bvh_tree *kept = find_kept_object(s, o, &kept_at);
        bvh_tree *t = b->objects[index] = kept ? hold_tree(kept, reuse) : new_tree(b, o->shape_count);
        if (!t)
            return AG_ERROR_MEMORY;
        point_object(t, s, o);
        uint64_t item_count = 0;
        for (uint32_t k = 0; k < o->shape_count && !kept; k++) {
            item_count += embree_item_count(t->attached[k].shape);
            AG_TRY(attach_shape(b, t, k));
        }
        if (!kept)
            build(t->scene, item_count, run, joiners);
        AG_TRY(build_status(b->device)); /* nothing is built over a broken tree */
        reuse->trees_built += !kept;
    }
    return AG_OK;
}

/* Whether the world of the scene before is this one's: the same shapes, and instances of the same trees. */
static bool is_same_world(const bvh *b, const scene *s, const scene *before)
{
    bool is_same = before && before->bvh && s->shape_count == before->shape_count &&
                   s->instance_count == before->instance_count &&
                   s->instance_step_count == before->instance_step_count &&
                   memcmp(s->instance_steps ? (const void *)s->instance_steps : "",
                          before->instance_steps ? (const void *)before->instance_steps : "",
                          s->instance_step_count * sizeof *s->instance_steps) == 0;
    for (uint32_t i = 0; i < s->shape_count && is_same; i++) {
        const bool is_of_world = s->shapes[i].object_index == SCENE_NO_OBJECT;
        is_same = is_of_world == (before->shapes[i].object_index == SCENE_NO_OBJECT) &&
                  (!is_of_world || is_same_to_tree(&s->shapes[i], &before->shapes[i]));
    }
    for (uint32_t i = 0; i < s->instance_count && is_same; i++) {
        const scene_instance *now = &s->instances[i], *was = &before->instances[i];
        is_same = now->first_step == was->first_step && now->step_count == was->step_count &&
                  b->objects[now->object_index] == before->bvh->objects[was->object_index];
    }
    return is_same;
}

static ag_status make_world(bvh *b, const scene *s, run_context *run, unsigned joiners, scene_reuse *reuse)
{
    const bool is_kept = is_same_world(b, s, s->before);
    b->world = is_kept ? hold_tree(s->before->bvh->world, reuse) : new_tree(b, s->shape_count);
    if (!b->world)
        return AG_ERROR_MEMORY;
    b->scene = b->world->scene;
    point_world(b->world, s);
    if (is_kept)
        return AG_OK;
    reuse->trees_built++;
    rtcSetSceneProgressMonitorFunction(b->scene, report_progress, run);
    for (uint32_t i = 0; i < s->shape_count; i++)
        if (s->shapes[i].object_index == SCENE_NO_OBJECT)
            AG_TRY(attach_shape(b, b->world, i));
    for (uint32_t i = 0; i < s->instance_count; i++)
        attach_instance(b, s, i);
    AG_TRY(build_status(b->device));
    build(b->scene, UINT64_MAX, run, joiners);
    rtcSetSceneProgressMonitorFunction(b->scene, NULL, NULL);
    return run_is_cancelled(run) ? AG_CANCELLED : build_status(b->device);
}

/* --- device --- */

static void release_device(struct bvh_device *d)
{
    if (!d || --d->holder_count > 0)
        return;
    /* Where memory ended in a build, Embree 3.13 at times waits in rtcReleaseDevice for ever: the device is left, and
     * with it what its memory monitor points at. */
    if (d->lacked_memory)
        return;
    rtcReleaseDevice(d->embree);
    free(d);
}

static ag_status create_device(run_context *run, const char *isa, unsigned joiners, struct bvh_device **out_device)
{
    struct bvh_device *d = calloc(1, sizeof *d);
    char settings[96];
    if (!d)
        return AG_ERROR_MEMORY;
    d->holder_count = 1;
    snprintf(d->isa, sizeof d->isa, "%s", isa ? isa : "avx2");
    snprintf(settings, sizeof settings, "threads=%u,user_threads=%u,max_isa=%s", joiners, joiners, d->isa);
    d->embree = rtcNewDevice(settings);
    if (!d->embree) {
        const enum RTCError error = rtcGetDeviceError(NULL);
        free(d);
        if (error == RTC_ERROR_OUT_OF_MEMORY)
            return AG_ERROR_MEMORY;
        log_message(run->log, AG_LOG_ERROR, "Embree: no device for \"%s\" (error %d)", settings, (int)error);
        return AG_ERROR_RAY_TRACING;
    }
    order_before_library(&embree_threads);
    rtcSetDeviceMemoryMonitorFunction(d->embree, count_memory, d);
    *out_device = d;
    return AG_OK;
}

/* Builds objects, then the world. */
static ag_status make_trees(bvh *b, const scene *s, run_context *run, unsigned joiners, scene_reuse *reuse)
{
    ag_status status = make_objects(b, s, run, joiners, reuse);
    if (status == AG_OK)
        status = make_world(b, s, run, joiners, reuse);
    (void)rtcGetDeviceError(b->device->embree); /* this thread's is kept until it is read */
    b->device->lacked_memory |= build_status(b->device) == AG_ERROR_MEMORY;
    return status;
}

/* Point queries do not find Embree's own spheres (seen with 3.13), and not all curves; in instances they would go by
 * other spaces, and of meshes whose vertices move they would tell of one time alone. */
static void list_spheres(bvh *b, const scene *s)
{
    b->tells_what_is_near = s->instance_count == 0;
    for (uint32_t i = 0; i < s->shape_count && b->tells_what_is_near; i++) {
        const shape *at = &s->shapes[i];
        if (embree_has_as_sphere(at) && b->sphere_count < BVH_SPHERES_MAX)
            b->spheres[b->sphere_count++] = i;
        else
            b->tells_what_is_near = at->kind != SHAPE_CURVES && !embree_has_as_sphere(at) && !shape_is_deforming(at);
    }
}

ag_status bvh_create(const scene *s, run_context *run, const char *isa, scene_reuse *reuse, bvh **out_bvh)
{
    /* Embree caps its threads at the affinity mask; more joiners than that would wait for a free thread. */
    unsigned joiners = thread_pool_worker_count(run->pool), available = cpu_count_available();
    if (joiners > available)
        joiners = available;
    bvh *b = calloc(1, sizeof *b);
    ag_status status = b ? AG_OK : AG_ERROR_MEMORY;
    if (b && s->before && s->before->bvh) {
        b->device = s->before->bvh->device;
        b->device->holder_count++;
    } else if (b) {
        status = create_device(run, isa, joiners, &b->device);
    }
    if (status == AG_OK) {
        list_spheres(b, s);
        b->device->log = run->log;
        atomic_store_explicit(&b->device->error, RTC_ERROR_NONE, memory_order_relaxed);
        rtcSetDeviceErrorFunction(b->device->embree, take_error, b->device);
        status = make_trees(b, s, run, joiners, reuse);
        rtcSetDeviceErrorFunction(b->device->embree, NULL, NULL); /* the log may go before the bvh does */
    }
    if (status != AG_OK) {
        bvh_destroy(b);
        return status;
    }
    run_progress(run, AG_PHASE_BVH, 1.0);
    *out_bvh = b;
    return AG_OK;
}

void bvh_destroy(bvh *b)
{
    if (!b)
        return;
    release_tree(b->world);
    for (uint32_t i = 0; i < b->object_count; i++)
        release_tree(b->objects[i]);
    free(b->objects);
    release_device(b->device);
    free(b);
}

uint64_t bvh_memory_bytes(const bvh *b)
{
    int64_t bytes = atomic_load_explicit(&b->device->memory_bytes, memory_order_relaxed);
    return bytes > 0 ? (uint64_t)bytes : 0;
}

const char *bvh_isa(const bvh *b) { return b->device->isa; }
