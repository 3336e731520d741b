/* ray.h: a ray through the scene, with what it carries along.
 * Flow: the camera, lamps and surfaces start them; rays_embree casts them. Threads: plain values. */
#ifndef AFTERGLOW_RAY_H
#define AFTERGLOW_RAY_H

#include "math/vec3.h"
#include "rays/ray_cone.h"

#include <stdint.h>

#define SCENE_NO_MEDIUM UINT32_MAX

/* How a surface with alpha (alpha.h) meets a ray. */
typedef enum ray_alpha_rule {
    RAY_PASSES_ALPHA,     /* stops it by chance, as much as is there: light */
    RAY_MEETS_ALPHA,      /* stops it wherever anything is there: the ray looks for surfaces */
    RAY_MEETS_EMPTY_ALPHA /* stops it everywhere, also where nothing is there: the ray looks for the extent of such a
                             surface */
} ray_alpha_rule;

/* A ray; not named `ray`, which is a name of variables. */
typedef struct scene_ray {
    vec3 origin, direction; /* world; whoever wants the direction unit says so */
    float time;             /* of the shutter, [0, 1] from its opening to its closing */
    uint32_t medium;        /* in which it starts; SCENE_NO_MEDIUM: nothing absorbs */
    ray_alpha_rule alpha_rule;
    bool slabs_are_panes; /* light that may pass slabs of glass straight (slab_faces.h); else they bend it */
    bool skips_uv;        /* a hit's uv may be missing: neither a texture of the scene nor the caller reads it */
    ray_cone cone;        /* over which textures are filtered; all zero: none is */
} scene_ray;

/* Returns a ray at the opening of the shutter, in no medium. */
static inline scene_ray scene_ray_make(vec3 origin, vec3 direction)
{
    return (scene_ray){origin, direction, 0.0f, SCENE_NO_MEDIUM, RAY_PASSES_ALPHA, false, false, {0.0f, 0.0f, false}};
}

#endif
