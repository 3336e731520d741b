/* ray_cone.h: how wide a ray is: the cone of neighbouring rays that it stands for, and the ellipse that the cone cuts
 * out of a surface, over which textures are filtered.
 * Rests on: Akenine-Moller et al., "Improved Shader and Texture Level of Detail Using Ray Cones", JCGT 10(1), 2021;
 * Amanatides, "Ray Tracing with Cones", SIGGRAPH 1984.
 * Flow: camera -> [here] -> texture. Threads: plain values, pure functions. */
#ifndef AFTERGLOW_RAY_CONE_H
#define AFTERGLOW_RAY_CONE_H

#include "math/vec3.h"

#include <stdbool.h>

/* All zero: a ray without a cone, for which textures are not filtered. */
typedef struct ray_cone {
    float width;    /* across the ray at its origin, scene units; below 0 behind a focus */
    float spread;   /* growth of the width along the ray, per length; below 0 towards a focus */
    bool is_coarse; /* of a gather ray or photon: detail in the cone is of no interest */
} ray_cone;

/* The ellipse in which a cone meets a surface. */
typedef struct ray_footprint {
    float width; /* across the ray, scene units; 0: nothing is filtered */
    bool is_coarse;
    vec3 direction; /* the ray's, unit */
} ray_footprint;

/* The spread of rays that a diffuse surface scatters: about that of a hundred rays that share the hemisphere. */
#define RAY_CONE_DIFFUSE_SPREAD 0.125f

struct scene;
struct surface_hit;

static inline bool ray_cone_is_wide(const ray_cone *c) { return c->width != 0.0f || c->spread != 0.0f; }

/* Returns the cone at a distance along the ray. */
static inline ray_cone ray_cone_at(const ray_cone *c, float distance)
{
    return (ray_cone){c->width + c->spread * distance, c->spread, c->is_coarse};
}

static inline ray_footprint ray_cone_footprint(const ray_cone *at_surface, vec3 direction)
{
    return (ray_footprint){fabsf(at_surface->width), at_surface->is_coarse, direction};
}

/* Returns the cone behind a surface that scatters: the less probable the direction, the wider. pdf_solid_angle: of the
 * direction, 1/sr, > 0. */
ray_cone ray_cone_scattered(const ray_cone *at_surface, float pdf_solid_angle);

/* Returns the cone behind a smooth surface that reflects or refracts the ray into `direction`: a curved one spreads or
 * focuses the cone as a mirror or lens does near its axis. index: inside over outside. */
ray_cone ray_cone_bent(const struct scene *s, const ray_cone *at_surface, const struct surface_hit *hit, vec3 arrived,
                       vec3 direction, float index);

#endif
