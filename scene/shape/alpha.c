/* alpha.c: see alpha.h. Threads: pure functions. */
#include "shape/alpha.h"

#include "math/rng.h"
#include "scene.h"

float alpha_at(const scene *s, const shape *at, const surface_hit *hit)
{
    float alpha = at->alpha;
    if (at->alpha_texture != SCENE_NO_TEXTURE)
        alpha *= texture_evaluate_float(&s->textures, at->alpha_texture, hit);
    if (at->alpha_cutoff > 0.0f)
        return alpha >= at->alpha_cutoff ? 1.0f : 0.0f;
    return float_clamp(alpha, 0.0f, 1.0f);
}

float alpha_at_hit(const scene *s, const surface_hit *hit)
{
    const shape *at = &s->shapes[hit->shape_index];
    if (shape_is_opaque(at))
        return 1.0f;
    surface_hit in_object = instance_hit_in_object(s, hit); /* the space in which alpha_stops_ray decided */
    return alpha_at(s, at, &in_object);
}

/* Returns a number that is uniform in [0, 1), another one for every ray and surface. */
static float number_of_ray(uint32_t shape_index, uint32_t primitive_index, uint32_t crossing, vec3 origin,
                           vec3 direction)
{
    uint64_t key = hash_combine(((uint64_t)shape_index << 32) | primitive_index, crossing);
    return (float)(hash_of_ray(key, origin, direction) >> 40) * 0x1p-24f;
}

bool alpha_stops_ray(const scene *s, const shape *at, uint32_t primitive_index, float u, float v, uint32_t crossing,
                     vec3 origin, vec3 direction, float time, float t, ray_alpha_rule alpha_rule)
{
    if (alpha_rule == RAY_MEETS_EMPTY_ALPHA)
        return true;
    surface_hit hit = {.distance = t, .time = time};
    if (at->alpha_texture != SCENE_NO_TEXTURE)
        shape_surface_at(at, primitive_index, u, v, vec3_add_scaled(origin, direction, t), direction, time, &hit);
    float alpha = alpha_at(s, at, &hit); /* reads the hit where alpha is a texture */
    if (alpha <= 0.0f || alpha >= 1.0f || alpha_rule == RAY_MEETS_ALPHA)
        return alpha > 0.0f;
    return number_of_ray((uint32_t)(at - s->shapes), primitive_index, crossing, origin, direction) < alpha;
}
