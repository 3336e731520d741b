/* microfacet.h: the GGX distribution of microfacets, in the shading frame.
 * Rests on: Walter et al., "Microfacet Models for Refraction through Rough Surfaces", 2007; Heitz, "Sampling the GGX
 * Distribution of Visible Normals", 2018.
 * Threads: pure functions. */
#ifndef AFTERGLOW_MICROFACET_H
#define AFTERGLOW_MICROFACET_H

#include "math/sampling.h"

/* Roughness along the frame's x and y, > 0. */
typedef struct ggx {
    float alpha_u, alpha_v;
} ggx;

static inline float ggx_density(ggx m, vec3 n)
{
    float x = n.x / m.alpha_u, y = n.y / m.alpha_v, t = x * x + y * y + n.z * n.z;
    return 1.0f / (AG_PI * m.alpha_u * m.alpha_v * t * t);
}

/* Smith's Lambda: masked over visible microsurface. */
static inline float ggx_lambda(ggx m, vec3 v)
{
    if (v.z == 0.0f)
        return INFINITY;
    float x = m.alpha_u * v.x, y = m.alpha_v * v.y;
    return 0.5f * (sqrtf(1.0f + (x * x + y * y) / (v.z * v.z)) - 1.0f);
}

static inline float ggx_masking(ggx m, vec3 v) { return 1.0f / (1.0f + ggx_lambda(m, v)); }
static inline float ggx_masking_shadowing(ggx m, vec3 a, vec3 b)
{
    return 1.0f / (1.0f + ggx_lambda(m, a) + ggx_lambda(m, b));
}

/* Density of the normals that are visible from v. */
static inline float ggx_visible_density(ggx m, vec3 v, vec3 n)
{
    return ggx_masking(m, v) / fabsf(v.z) * ggx_density(m, n) * fabsf(vec3_dot(v, n));
}

/* A visible normal, in the upper half. */
static inline vec3 ggx_sample_visible(ggx m, vec3 v, vec2 u)
{
    vec3 vh = vec3_normalize((vec3){m.alpha_u * v.x, m.alpha_v * v.y, v.z});
    if (vh.z < 0.0f)
        vh = vec3_negate(vh);
    float square = vh.x * vh.x + vh.y * vh.y;
    vec3 t1 = square > 0.0f ? vec3_scale((vec3){-vh.y, vh.x, 0.0f}, 1.0f / sqrtf(square)) : (vec3){1.0f, 0.0f, 0.0f};
    vec3 t2 = vec3_cross(vh, t1);
    float r = sqrtf(u.x), sine, cosine;
    sincos_turns(u.y, &sine, &cosine);
    float p1 = r * cosine, p2 = r * sine, blend = 0.5f * (1.0f + vh.z);
    p2 = (1.0f - blend) * sqrtf(float_max(1.0f - p1 * p1, 0.0f)) + blend * p2;
    float p3 = sqrtf(float_max(1.0f - p1 * p1 - p2 * p2, 0.0f));
    vec3 nh = vec3_add(vec3_add(vec3_scale(t1, p1), vec3_scale(t2, p2)), vec3_scale(vh, p3));
    return vec3_normalize((vec3){m.alpha_u * nh.x, m.alpha_v * nh.y, float_max(1e-6f, nh.z)});
}

/* Half way between two directions on one side, in the upper half. */
static inline vec3 ggx_half_vector(vec3 o, vec3 i)
{
    vec3 h = vec3_normalize(vec3_add(o, i));
    return h.z < 0.0f ? vec3_negate(h) : h;
}

/* D G / (4 |cos o|): reflection's value times |cos i|, Fresnel's term left out. */
static inline float ggx_reflection(ggx m, vec3 o, vec3 i, vec3 h)
{
    return ggx_density(m, h) * ggx_masking_shadowing(m, o, i) / (4.0f * fabsf(o.z));
}

/* Density of i, reflected about a visible normal. */
static inline float ggx_reflection_pdf(ggx m, vec3 o, vec3 h)
{
    vec3 upper = o.z < 0.0f ? vec3_negate(o) : o;
    return ggx_visible_density(m, upper, h) / (4.0f * fabsf(vec3_dot(upper, h)));
}

#endif
