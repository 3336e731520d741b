/* alpha.h: alpha of surfaces: leaves cut out by a picture, cloth that transmits a part of the light. As in pbrt-v4,
 * a hash of the ray decides for values between 0 and 1, so that a ray always meets the same.
 * Flow: bvh_embree asks of every ray alike whether it meets a surface; lamps ask how much of them shines.
 * Threads: pure functions. */
#ifndef AFTERGLOW_ALPHA_H
#define AFTERGLOW_ALPHA_H

#include "shape/shape.h"
#include "texture/texture.h"

/* Returns whether no ray passes through. */
static inline bool shape_is_opaque(const shape *s)
{
    return s->alpha_texture == SCENE_NO_TEXTURE &&
           (s->alpha >= 1.0f || (s->alpha_cutoff > 0.0f && s->alpha >= s->alpha_cutoff));
}

/* Returns whether no ray meets it. An invisible lamp emits light nevertheless. */
static inline bool shape_is_invisible(const shape *s)
{
    return s->alpha <= 0.0f || (s->alpha_texture == SCENE_NO_TEXTURE && s->alpha < s->alpha_cutoff);
}

/* Returns alpha at a point, [0, 1]; the hit's shape_index is not read. */
float alpha_at(const scene *s, const shape *at, const surface_hit *hit);

/* Returns alpha at a point that a ray has hit, where it is above 0. Of the photons that arrive there, this share is
 * stored, while the part of the surface that exists is lit by all of them. */
float alpha_at_hit(const scene *s, const surface_hit *hit);

/* Returns whether a ray meets the surface where it crosses it at distance t. u, v: as in shape_surface_at; crossing:
 * its number, where the ray crosses one primitive several times; time: of the shutter. The result is the same for the
 * same ray. */
bool alpha_stops_ray(const scene *s, const shape *at, uint32_t primitive_index, float u, float v, uint32_t crossing,
                     vec3 origin, vec3 direction, float time, float t, ray_alpha_rule alpha_rule);

#endif
