/* surface.h: a point of a surface: what a ray has hit there, and the ray that leaves it.
 * Flow: rays, shape -> [here] -> material, photon map, renderer. Threads: plain values. */
#ifndef AFTERGLOW_SURFACE_H
#define AFTERGLOW_SURFACE_H

#include "rays/ray.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct scene scene; /* scene.h */

/* The straight way through a slab of glass, of which a ray has met the one face (rays/slab_faces.h). */
typedef struct slab_way {
    vec3 exit;       /* on the other face */
    float epsilon;   /* as in surface_hit, there */
    float thickness; /* along the normal, scene units; 0: there is no such way */
    uint32_t medium; /* between the faces, SCENE_NO_MEDIUM: none */
} slab_way;

/* Where a ray met a surface, recomputed from the primitive in plain IEEE steps rather than from the ray's length. */
typedef struct surface_hit {
    vec3 position;
    vec3 geometric_normal; /* unit, to the shape's outside */
    vec3 shading_normal;   /* unit, on the geometric normal's side */
    vec2 uv;               /* pbrt's, in [0, 1] on quadrics, and curves; a mesh's own, or (0, 0), (1, 0), (1, 1) on each
                            * triangle */
    float distance;        /* along the ray, for a unit direction in scene units */
    float epsilon;         /* how far off the surface a new ray must start so as not to meet it again, scene units */
    bool is_strand;        /* part of a curve, too thin for the estimates of a photon map: see bsdf.h */
    bool faces_rays;       /* part of a curve that turns to whatever ray comes: its normal is that ray's */
    bool is_mirrored; /* v grows to the other side of the first tangent than hair.h has it: of a ribbon that is seen
                       * from its outside, and in an instance that mirrors; both undo each other */
    bool is_flat;     /* part of a mesh, whose corners a start must stay out of: see surface_ray */
    bool has_medium_interface;              /* the shape's, for surface_ray */
    uint32_t medium_inside, medium_outside; /* the shape's, for surface_ray */
    uint32_t shape_index;
    uint32_t primitive_index; /* triangle of a mesh, segment of curves */
    uint32_t instance_index;  /* SCENE_NO_INSTANCE where the shape stands in the world itself */
    float time;               /* of the shutter, the ray's */
    slab_way slab;
    ray_footprint footprint; /* of the ray, over which textures are filtered; set by whoever traces cones */
} surface_hit;

/* A point on a surface, with the data for rays that leave it. */
typedef struct surface_point {
    vec3 position;
    vec3 normal;   /* geometric, unit */
    float epsilon; /* as in surface_hit */
} surface_point;

/* A random point on a shape, in proportion to area. pdf_area: 1/m^2. */
typedef struct surface_sample {
    vec3 position;
    vec3 geometric_normal; /* unit, outside */
    float pdf_area;
    float epsilon; /* as in surface_hit */
    uint32_t primitive_index;
    vec2 barycentrics; /* of meshes: of the triangle's second and third corner */
} surface_sample;

/* Where a ray that passes a surface straight starts on its other side: on its line, as far as the line leaves the
 * surface soon, so that many such crossings bend it no more than one. normal: geometric, of either side. */
static inline vec3 surface_point_behind(vec3 position, vec3 normal, float epsilon, vec3 direction)
{
    static const float COSINE_MIN = 0.125f;
    vec3 n = vec3_face_forward(normal, direction);
    float cosine = vec3_dot(n, direction), step = epsilon / float_max(cosine, COSINE_MIN);
    vec3 behind = vec3_add_scaled(position, direction, step);
    return cosine < COSINE_MIN ? vec3_add_scaled(behind, n, epsilon - step * cosine) : behind;
}

/* The ray that leaves a surface into `direction`, after arriving along `arrived` (of unit direction, and in the medium
 * of its last stretch). It is in the medium of its side where the surface parts two, else in that of `arrived`; and it
 * starts off the surface. On meshes, moving also against (or, when passing through, along) the way of arrival keeps
 * starts in the corners of closed rooms inside. On round surfaces it would turn the path a little each time, and let
 * out light that is trapped in glass. */
static inline scene_ray surface_ray(const surface_hit *hit, scene_ray arrived, vec3 direction)
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

/* Widens the cone of a ray, if it has one, up to the point that it has met, on a surface or in a medium, and notes
 * there the footprint of textures. */
static inline void surface_widen_cone(scene_ray *ray, surface_hit *hit)
{
    if (!ray_cone_is_wide(&ray->cone))
        return;
    ray->cone = ray_cone_at(&ray->cone, hit->distance);
    hit->footprint = ray_cone_footprint(&ray->cone, ray->direction);
}

#endif
