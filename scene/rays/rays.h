/* rays.h: casting rays into a committed scene; only rays_embree.c knows how.
 * Flow: photon tracing and rendering cast rays. Threads: any number at once. */
#ifndef AFTERGLOW_RAYS_H
#define AFTERGLOW_RAYS_H

#include "surface.h"

/* Finds the nearest surface along the ray, from its origin to max_distance (in lengths of direction, INFINITY is fine).
 * A ray with components that are not finite, or not below 1.8e18, meets nothing. */
bool scene_intersect(const scene *s, scene_ray ray, float max_distance, surface_hit *out_hit);

/* Finds the nearest surface of a shape of these roles (of shape_role), between two distances along the ray. Glass does
 * not count for an opaque face that it lies on. */
bool scene_intersect_role(const scene *s, scene_ray ray, float from, float to, unsigned roles, surface_hit *out_hit);

/* Rays of unit direction from one point, cast together: those of similar directions traverse the scene's tree as
 * packets. The grouping depends on the rays alone. */
enum { RAY_FAN_MAX = 64 };

/* A hit of a fan's ray as Embree reports it, for ray_fan_hit. */
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

/* Casts all rays of a fan as scene_intersect does, with infinite max_distance; ray_fan_hit writes the full hit of a ray
 * that met something. */
void scene_intersect_fan(const scene *s, ray_fan *f);
void ray_fan_hit(const scene *s, const ray_fan *f, uint32_t i, surface_hit *out_hit);

/* A shortcut for a ray that met a plain Lambertian surface: returns its reflectance, and writes the position of the hit
 * and the normal on the ray's side. NULL: the surface needs ray_fan_hit. Measured: without it, by ray_fan_hit and a
 * bsdf at each end, a frame of the Cornell box takes 7 % more CPU time (material/shortcuts.md). */
const rgb *ray_fan_plain_point(const scene *s, const ray_fan *f, uint32_t i, surface_point *out_point);

/* Returns the distance of the nearest surface along the ray, INFINITY where there is none. It is traversal alone,
 * without evaluating the hit: the physical limit that benchmarks compare with. */
float scene_first_distance(const scene *s, scene_ray ray);

/* Returns whether a surface lies on the ray up to max_distance (as above). */
bool scene_occluded(const scene *s, scene_ray ray, float max_distance);

#endif
