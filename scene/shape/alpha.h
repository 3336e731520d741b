/* alpha.h: how much of a surface is there: leaves cut out by a picture, cloth that lets part of the light through.
 * As pbrt-v4's "alpha": of a share between 0 and 1 a hash of the ray decides, so that a ray meets the same each time.
 * Flow: bvh_embree asks of every ray alike whether it meets a surface; lamps ask how much of them shines.
 * Threads: pure functions. */
#ifndef AFTERGLOW_ALPHA_H
#define AFTERGLOW_ALPHA_H

#include "shape/shape.h"
#include "texture/texture.h"

/* No ray passes through. */
static inline bool shape_is_opaque(const shape *s)
{
    return s->alpha_texture == SCENE_NO_TEXTURE &&
           (s->alpha >= 1.0f || (s->alpha_cutoff > 0.0f && s->alpha >= s->alpha_cutoff));
}

/* No ray meets it. A lamp that is invisible shines for all that. */
static inline bool shape_is_invisible(const shape *s)
{
    return s->alpha <= 0.0f || (s->alpha_texture == SCENE_NO_TEXTURE && s->alpha < s->alpha_cutoff);
}

/* The share of the surface that is there at a point, [0, 1]; the hit's shape_index is not read. */
float alpha_at(const scene *s, const shape *at, const surface_hit *hit);

/* The share at a point that a ray has hit, where it is above 0. Of the photons that come to such a point this share is
 * stored there, while what is there is lit by all of them. */
float alpha_at_hit(const scene *s, const surface_hit *hit);

/* Whether a ray meets the surface where it crosses it at distance t. u, v: as of shape_surface_at; crossing: which one
 * it is where the ray crosses one primitive several times. The same for the same ray. */
bool alpha_stops_ray(const scene *s, const shape *at, uint32_t primitive_index, float u, float v, uint32_t crossing,
                     vec3 origin, vec3 direction, float t, ray_alpha_rule alpha_rule);

#endif
