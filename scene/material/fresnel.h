/* fresnel.h: reflectance and refraction of interfaces.
 * Rests on: Fresnel's equations; Born, Wolf, "Principles of Optics", 14.2 (conductors).
 * Threads: pure functions. */
#ifndef AFTERGLOW_FRESNEL_H
#define AFTERGLOW_FRESNEL_H

#include "math/attenuation.h"
#include "math/vec3.h"

/* Returns the unpolarised reflectance of a dielectric; cos_in >= 0; eta: index on the far side over the near one. */
static inline float fresnel_dielectric(float cos_in, float eta)
{
    float sin2_through = (1.0f - cos_in * cos_in) / (eta * eta);
    if (sin2_through >= 1.0f)
        return 1.0f;
    float cos_through = sqrtf(1.0f - sin2_through);
    float parallel = (eta * cos_in - cos_through) / (eta * cos_in + cos_through);
    float perpendicular = (cos_in - eta * cos_through) / (cos_in + eta * cos_through);
    return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}

/* Returns the reflectance of a thin sheet with all reflections between its two faces, a geometric series. */
static inline float fresnel_thin_dielectric(float cos_in, float eta)
{
    float r = fresnel_dielectric(cos_in, eta);
    if (r < 1.0f)
        r += (1.0f - r) * (1.0f - r) * r / (1.0f - r * r);
    return r;
}

/* Of an index beyond this, all light is reflected to single precision; its fourth power would overflow. */
#define FRESNEL_INDEX_MAX 1e8f

/* Returns the unpolarised reflectance of a conductor, computed without complex numbers. */
static inline float fresnel_conductor_channel(float cos_in, float eta, float k)
{
    eta = eta < FRESNEL_INDEX_MAX ? eta : FRESNEL_INDEX_MAX;
    k = k < FRESNEL_INDEX_MAX ? k : FRESNEL_INDEX_MAX;
    float c2 = cos_in * cos_in, s2 = 1.0f - c2;
    float t0 = eta * eta - k * k - s2;
    float a2b2 = sqrtf(t0 * t0 + 4.0f * eta * eta * k * k);
    float a = sqrtf(float_max(0.5f * (a2b2 + t0), 0.0f));
    float t1 = a2b2 + c2, t2 = 2.0f * a * cos_in;
    float perpendicular = (t1 - t2) / (t1 + t2);
    float t3 = c2 * a2b2 + s2 * s2, t4 = t2 * s2;
    float parallel = perpendicular * (t3 - t4) / (t3 + t4);
    return 0.5f * (parallel + perpendicular);
}

static inline rgb fresnel_conductor(float cos_in, rgb eta, rgb k)
{
    return (rgb){fresnel_conductor_channel(cos_in, eta.r, k.r), fresnel_conductor_channel(cos_in, eta.g, k.g),
                 fresnel_conductor_channel(cos_in, eta.b, k.b)};
}

/* Schlick, "An Inexpensive BRDF Model for Physically-based Rendering", 1994: the share of f90 in f0 + (f90 - f0)
 * weight. */
static inline float fresnel_schlick_weight(float cos_in)
{
    float away = 1.0f - float_min(cos_in, 1.0f), square = away * away;
    return square * square * away;
}

/* Returns the share of diffuse light, starting under an interface at optical depth `thickness`, that is reflected down
 * again: twice the integral of F e^(-2 thickness / cos) cos over the cosine. eta: far over near index, seen from
 * inside. */
static inline float fresnel_dielectric_diffuse(float eta, float thickness)
{
    enum { STEPS = 512 };
    double sum = 0.0;
    for (int i = 0; i < STEPS; i++) {
        float c = ((float)i + 0.5f) / STEPS;
        sum += (double)fresnel_dielectric(c, eta) * (double)attenuation(2.0f * thickness / c) * (double)c;
    }
    return (float)(2.0 * sum / STEPS);
}

/* Refracts v through an interface with normal n on the side of v; eta: far over near index. Returns false for total
 * reflection. */
static inline bool refract_through(vec3 v, vec3 n, float eta, vec3 *out_through)
{
    float cos_in = vec3_dot(v, n);
    float sin2_through = float_max(1.0f - cos_in * cos_in, 0.0f) / (eta * eta);
    if (sin2_through >= 1.0f)
        return false;
    float cos_through = sqrtf(1.0f - sin2_through);
    *out_through = vec3_add(vec3_scale(v, -1.0f / eta), vec3_scale(n, cos_in / eta - cos_through));
    return true;
}

static inline vec3 reflect_about(vec3 v, vec3 n) { return vec3_sub(vec3_scale(n, 2.0f * vec3_dot(v, n)), v); }

#endif
