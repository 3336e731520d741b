/* embree_api.h: what differs between Embree 3 and 4, for the files *_embree.c alone.
 * Rests on Embree's CHANGELOG and api.md. Threads: none of its own. */
#ifndef AFTERGLOW_EMBREE_API_H
#define AFTERGLOW_EMBREE_API_H

#if defined(__has_include) && __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#if RTC_VERSION_MAJOR >= 4
static inline void embree_intersect(RTCScene world, struct RTCRayHit *ray_hit) { rtcIntersect1(world, ray_hit, NULL); }
static inline void embree_occluded(RTCScene world, struct RTCRay *ray) { rtcOccluded1(world, ray, NULL); }
static inline void embree_intersect_8(const int *valid, RTCScene world, struct RTCRayHit8 *ray_hits)
{
    struct RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcIntersect8(valid, world, ray_hits, &arguments);
}
/* As embree_intersect, but hits count for which the filter lets the ray's lane be valid; user geometries ask it
 * themselves. */
static inline void embree_intersect_filtered(RTCScene world, struct RTCRayHit *ray_hit, RTCFilterFunctionN filter)
{
    struct RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.filter = filter;
    arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
    rtcIntersect1(world, ray_hit, &arguments);
}
#define EMBREE_SCENE_FLAGS (RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS)
/* A user geometry of Embree 4 must say of each ray whether it was hit. */
#define EMBREE_REPORT(arguments, lane, was_hit) ((arguments)->valid[lane] = (was_hit) ? -1 : 0)
#else
static inline void embree_intersect(RTCScene world, struct RTCRayHit *ray_hit)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(world, &context, ray_hit);
}
static inline void embree_occluded(RTCScene world, struct RTCRay *ray)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(world, &context, ray);
}
static inline void embree_intersect_8(const int *valid, RTCScene world, struct RTCRayHit8 *ray_hits)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect8(valid, world, &context, ray_hits);
}
static inline void embree_intersect_filtered(RTCScene world, struct RTCRayHit *ray_hit, RTCFilterFunctionN filter)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.filter = filter;
    rtcIntersect1(world, &context, ray_hit);
}
#define EMBREE_SCENE_FLAGS                      (RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION)
#define EMBREE_REPORT(arguments, lane, was_hit) ((void)0)
#endif

#endif
