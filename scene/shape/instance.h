/* instance.h: objects, which are kept once, and instances, which put them into the world, at rest or moving while the
 * shutter is open.
 * Flow: the scene file makes them; rays_embree casts rays at them and asks here where in the world a hit lies.
 * Threads: read-only once the scene is committed. */
#ifndef AFTERGLOW_INSTANCE_H
#define AFTERGLOW_INSTANCE_H

#include "math/affine.h"
#include "surface.h"

#include <stdint.h>

#define SCENE_NO_OBJECT   UINT32_MAX
#define SCENE_NO_INSTANCE UINT32_MAX

struct scene;
struct surface_hit;

/* An object: the shapes with its object_index. "World space" of these shapes is the object's space. */
typedef struct scene_object {
    /* set by scene_commit */
    uint32_t first_shape, shape_count; /* the range of scene.object_shapes that tells which shapes */
} scene_object;

typedef struct scene_instance {
    uint32_t object_index;
    uint32_t first_step, step_count; /* the range of scene.instance_steps: world_from_object at evenly spaced times from
                                      * the shutter's opening to its closing, straight in between; 1: at rest */
} scene_instance;

/* Returns world_from_object at a time of the shutter, [0, 1]. */
affine instance_at(const struct scene *s, uint32_t instance_index, float time);

/* Transforms a point of the world, in double precision, to the object's space. */
vec3 instance_point_in_object(const affine *world_from_object, const double world[3]);

/* Transforms a direction of the world, of any length, to the object's space. */
vec3 instance_direction_in_object(const affine *world_from_object, vec3 direction);

/* Transforms a hit from the object's space to the world's: position, normals, epsilon. */
void instance_transform_hit(const affine *world_from_object, struct surface_hit *in_out_hit);

/* Returns a hit in its shape's space, except for epsilon: the hit itself where the shape is in the world. For functions
 * that read shapes. */
struct surface_hit instance_hit_in_object(const struct scene *s, const struct surface_hit *hit);

/* The place of a point of a surface, in world space, when the shutter opens. */
typedef struct surface_rest {
    vec3 position;
    vec3 geometric_normal; /* unit, outside; where area_ratio is 0 the normal of the hit that it was found for */
    float area_ratio;      /* the area around the point at the opening over that at the hit's time: 1 where nothing
                            * scales or bends it, 0 where the surface has no area at the opening */
} surface_rest;
/* Returns where the point of a hit lies at the opening of the shutter; where nothing moves that is the hit's own
 * position and geometric normal. */
surface_rest surface_at_opening(const scene *s, const surface_hit *hit);

#endif
