/* bvh.h: casting rays into the scene; only bvh_embree.c and rays_embree.c know how.
 * Flow: scene_commit builds it; photon tracing and rendering cast rays.
 * Threads: built by the run's workers; then any number cast rays at once. */
#ifndef AFTERGLOW_BVH_H
#define AFTERGLOW_BVH_H

#include "rays/ray.h"
#include "scene.h"

typedef struct bvh bvh;

/* See scene_commit for isa and errors. The scene's shapes must stay where they are while the bvh lives: meshes are
 * shared with Embree, not copied. */
ag_status bvh_create(const scene *s, run_context *run, const char *isa, bvh **out_bvh);
void bvh_destroy(bvh *b); /* NULL is fine */

/* Bytes that Embree holds for it, buffers of ours that it shares not counted. */
uint64_t bvh_memory_bytes(const bvh *b);

/* "avx2", ...: what the kernels were limited to. */
const char *bvh_isa(const bvh *b);

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
    bool is_flat;          /* part of a mesh, whose corners a start must stay out of: see surface_ray */
    bool has_medium_interface;              /* the shape's, for surface_ray */
    uint32_t medium_inside, medium_outside; /* likewise */
    uint32_t shape_index;
    uint32_t primitive_index; /* triangle of a mesh, segment of curves */
    uint32_t instance_index;  /* SCENE_NO_INSTANCE where the shape stands in the world itself */
    float time;               /* of the shutter, the ray's */
} surface_hit;

/* The nearest surface along the ray, from its origin to max_distance (in lengths of direction, INFINITY is fine). A ray
 * that is not of finite numbers below 1.8e18 meets nothing. */
bool scene_intersect(const scene *s, scene_ray ray, float max_distance, surface_hit *out_hit);

/* Rays of unit direction from one place, many at once: those that go about the same way share theirs through the
 * scene's tree. Whether and how they are put together depends on them alone. */
enum { RAY_FAN_MAX = 64 };

/* What a ray of a fan meets, as the tree says it; for ray_fan_hit. */
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

/* A place on a surface, and what it takes to leave it. */
typedef struct surface_place {
    vec3 position;
    vec3 normal;   /* geometric, unit */
    float epsilon; /* as in surface_hit */
} surface_place;

/* The short way for a ray that met a Lambertian surface and nothing else: its reflectance and where the ray hit, with
 * the normal on the ray's side. NULL: it is not to be told so easily, and ray_fan_hit tells all there is. */
const rgb *ray_fan_plain_place(const scene *s, const ray_fan *f, uint32_t i, surface_place *out_place);

/* How far along the ray the nearest surface is, INFINITY where there is none: traversal alone, without looking at what
 * was hit, which is the physical limit that benchmarks compare with. */
float scene_first_distance(const scene *s, scene_ray ray);

/* Whether anything stands along the ray up to max_distance (as above). */
bool scene_occluded(const scene *s, scene_ray ray, float max_distance);

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

/* Along which the surface's u and v grow there, in world space, unless it is a mesh with tangents of its own: those,
 * and across them on v's side. Worked out anew at each call. Where there are none, any that lie in the surface. */
void surface_tangents(const scene *s, const surface_hit *hit, vec3 *out_dpdu, vec3 *out_dpdv);

/* The same place of the surface as it stands when the shutter opens, and how its area there is to its area now (1 where
 * nothing is stretched). The hit's own place where nothing moves. */
typedef struct surface_rest {
    vec3 position;
    vec3 geometric_normal; /* unit, outside */
    float area_ratio;
} surface_rest;
surface_rest surface_at_opening(const scene *s, const surface_hit *hit);

/* A random place on a shape, in proportion to area. pdf_area: 1/m^2. */
typedef struct surface_sample {
    vec3 position;
    vec3 geometric_normal; /* unit, outside */
    float pdf_area;
    float epsilon; /* as in surface_hit */
    uint32_t primitive_index;
    vec2 barycentrics; /* of meshes: of the triangle's second and third corner */
} surface_sample;
surface_sample shape_sample_area(const shape *s, vec2 u);
/* All that there is to know of a sampled place; distance is 0. */
void shape_sample_surface(const shape *s, uint32_t shape_index, const surface_sample *sample, surface_hit *out_hit);
/* Back from a place to the random numbers that pick it. false for shapes that are no mesh. */
bool shape_sample_inverse(const shape *s, const surface_hit *hit, vec2 *out_u);
/* The density of shape_sample_area at a place on the shape with that geometric normal. */
float shape_pdf_area(const shape *s, vec3 geometric_normal);

/* shape.c's side of an intersection, for rays_embree.c: fills in everything but distance, indices and time. u, v:
 * Embree's barycentrics for meshes, u along curves; for all but meshes `position` comes in as the ray's point and is
 * put onto the surface. direction: the ray's, of any length; read for curves alone. */
void shape_surface_at(const shape *s, uint32_t primitive_index, float u, float v, vec3 position, vec3 direction,
                      surface_hit *out_hit);
/* The same, but uv may be missing. */
void shape_place_at(const shape *s, uint32_t primitive_index, float u, float v, vec3 position, vec3 direction,
                    surface_hit *out_hit);
/* Position, geometric normal and epsilon alone, as the same have them, but for the normal's side; false: not of this
 * kind of shape. */
bool shape_bare_place_at(const shape *s, uint32_t primitive_index, float u, float v, vec3 position,
                         surface_place *out_place);
/* Nearest hit of a committed sphere, cylinder or disk in (t_min, t_max); false where there is none. */
bool shape_intersect_quadric(const shape *s, vec3 origin, vec3 direction, float t_min, float t_max, float *out_t);
void shape_bounds(const shape *s, vec3 *out_min, vec3 *out_max);
/* Fills in what scene_commit sets: centers, areas; area_cdf when it shines. Errors: AG_ERROR_MEMORY. */
ag_status shape_commit(shape *s);

#endif
