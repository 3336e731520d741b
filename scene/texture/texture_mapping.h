/* texture_mapping.h: where on a texture a point of a surface is.
 * The mappings and their parameters are pbrt-v4's (pbrt.org/fileformat-v4, "Textures").
 * Flow: surface hit -> [here] -> texture. Threads: pure functions. */
#ifndef AFTERGLOW_TEXTURE_MAPPING_H
#define AFTERGLOW_TEXTURE_MAPPING_H

#include "math/transform.h"

typedef enum texture_mapping_kind {
    TEXTURE_MAPPING_UV,          /* the surface's own u and v */
    TEXTURE_MAPPING_SPHERICAL,   /* s: angle from the z axis over pi; t: angle round it over 2 pi */
    TEXTURE_MAPPING_CYLINDRICAL, /* s: angle round the z axis from -x over 2 pi; t: z */
    TEXTURE_MAPPING_PLANAR,      /* s, t: along two axes */
    TEXTURE_MAPPING_SOLID,       /* the point in space: for textures in three dimensions */
    TEXTURE_MAPPING_UV_AFFINE    /* the surface's own u and v under any affine map */
} texture_mapping_kind;

/* Each kind reads the fields named at it; uv reads no texture_from_world. */
typedef struct texture_mapping {
    texture_mapping_kind kind;
    float texture_from_world[3][4];
    vec2 scale;   /* uv */
    vec2 delta;   /* uv, affine, planar */
    vec3 axes[2]; /* planar, in texture space; affine: s and t as (u, v, 0) is multiplied by them */
} texture_mapping;

/* Fills in texture_from_world. */
void texture_mapping_set_space(texture_mapping *m, const transform *world_from_texture);

/* uv is the surface's, position in world space. Not for solid ones. */
vec2 texture_mapping_st(const texture_mapping *m, vec2 uv, vec3 position);
/* The step of (s, t) where uv and position go on by so little. Not for solid ones. */
vec2 texture_mapping_step(const texture_mapping *m, vec2 uv, vec3 position, vec2 uv_step, vec3 position_step);
/* The point in texture space. Not for uv. */
vec3 texture_mapping_point(const texture_mapping *m, vec3 position);
/* The step of that point where position goes on by so little. */
vec3 texture_mapping_point_step(const texture_mapping *m, vec3 position_step);

#endif
