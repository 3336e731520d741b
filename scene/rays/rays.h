/* rays.h: casting rays into a committed scene; only rays_embree.c knows how.
 * Flow: photon tracing and rendering cast rays. Threads: any number at once. */
#ifndef AFTERGLOW_RAYS_H
#define AFTERGLOW_RAYS_H

#include "surface.h"

/* The nearest surface along the ray, from its origin to max_distance (in lengths of direction, INFINITY is fine). A ray
 * that is not of finite numbers below 1.8e18 meets nothing. */
bool scene_intersect(const scene *s, scene_ray ray, float max_distance, surface_hit *out_hit);

/* Rays of unit direction from one point, many at once: those that go about the same way share theirs through the
 * scene's tree. Whether and how they are put together depends on them alone. */
enum { RAY_FAN_MAX = 64 };

/* The point that a ray of a fan meets, as the tree says it; for ray_fan_hit. */
typedef struct ray_meeting {
    float distance; /* INFINITY: nothing */
    float u, v;
    uint32_t geometry, primitive, instance;
} ray_meeting;

typedef struct ray_fan {
    scene_ray common; /* all of each ray but its direction */
    uint32_t count;
    _Alignas(32) float direction[3][RAY_FAN_MAX]; /* x, y, z */
    ray_meeting met[RAY_FAN_MAX];                 /* set by scene_intersect_fan */
} ray_fan;

static inline vec3 ray_fan_direction(const ray_fan *f, uint32_t i)
{
    return (vec3){f->direction[0][i], f->direction[1][i], f->direction[2][i]};
}

/* scene_intersect of them all, without an end; and what one of those that met something has hit. */
void scene_intersect_fan(const scene *s, ray_fan *f);
void ray_fan_hit(const scene *s, const ray_fan *f, uint32_t i, surface_hit *out_hit);

/* The short way for a ray that met a Lambertian surface and nothing else: its reflectance and where the ray hit, with
 * the normal on the ray's side. NULL: it is not to be told so easily, and ray_fan_hit tells all there is. Measured:
 * without it, by ray_fan_hit and a bsdf at each end, a frame of the Cornell box takes 7 % more CPU time
 * (material/README.md). */
const rgb *ray_fan_plain_point(const scene *s, const ray_fan *f, uint32_t i, surface_point *out_point);

/* How far along the ray the nearest surface is, INFINITY where there is none: traversal alone, without looking at what
 * was hit, which is the physical limit that benchmarks compare with. */
float scene_first_distance(const scene *s, scene_ray ray);

/* Whether anything stands along the ray up to max_distance (as above). */
bool scene_occluded(const scene *s, scene_ray ray, float max_distance);

#endif
