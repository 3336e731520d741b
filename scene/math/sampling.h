/* sampling.h: warps from the unit square to directions and surfaces, with their densities.
 * Rests on: Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, appendix A.5; Shirley, Chiu,
 * "A Low Distortion Map Between Disk and Square", 1997.
 * Sine and cosine are our own polynomials: libm's have variants per instruction set that differ in the last bit.
 * Threads: pure functions. */
#ifndef AFTERGLOW_SAMPLING_H
#define AFTERGLOW_SAMPLING_H

#include "math/angle.h"
#include "math/vec3.h"

/* Sine and cosine of 2 pi u, u in [-1, 1]; right to float precision. Taylor series about the nearest quarter turn. */
static inline void sincos_turns(float u, float *out_sin, float *out_cos)
{
    double quarter = floor((double)u * 4.0 + 0.5);
    double x = ((double)u - quarter * 0.25) * 6.283185307179586477;
    double x2 = x * x;
    double s = x * (1.0 + x2 * (-1.0 / 6 + x2 * (1.0 / 120 + x2 * (-1.0 / 5040 + x2 * (1.0 / 362880)))));
    double c = 1.0 + x2 * (-0.5 + x2 * (1.0 / 24 + x2 * (-1.0 / 720 + x2 * (1.0 / 40320))));
    switch ((int)quarter & 3) {
    case 0: *out_sin = (float)s, *out_cos = (float)c; break;
    case 1: *out_sin = (float)c, *out_cos = (float)-s; break;
    case 2: *out_sin = (float)-s, *out_cos = (float)-c; break;
    default: *out_sin = (float)-c, *out_cos = (float)s; break;
    }
}

/* Uniform in the unit disk; density 1 / pi. Which half of the square a point is in decides its angle's formula, and is
 * as good as random: so without a branch. */
static inline vec2 sample_disk_concentric(vec2 u)
{
    float x = 2.0f * u.x - 1.0f, y = 2.0f * u.y - 1.0f;
    bool is_wide = fabsf(x) > fabsf(y);
    float r = float_select(is_wide, x, y), other = float_select(is_wide, y, x);
    /* an eighth of a turn at most: Taylor's series, as above */
    double a = r != 0.0f ? (double)(other / r) * 0.78539816339744831 : 0.0, a2 = a * a;
    float s = (float)(a * (1.0 + a2 * (-1.0 / 6 + a2 * (1.0 / 120 + a2 * (-1.0 / 5040 + a2 * (1.0 / 362880))))));
    float c = (float)(1.0 + a2 * (-0.5 + a2 * (1.0 / 24 + a2 * (-1.0 / 720 + a2 * (1.0 / 40320)))));
    return (vec2){r * float_select(is_wide, c, s), r * float_select(is_wide, s, c)};
}

/* Back from a point of the unit disk to what sample_disk_concentric was given, within the unit square. */
static inline vec2 sample_disk_concentric_inverse(vec2 d)
{
    bool is_wide = fabsf(d.x) > fabsf(d.y);
    float along = float_select(is_wide, d.x, d.y), across = float_select(is_wide, d.y, d.x);
    float r = copysignf(sqrtf(d.x * d.x + d.y * d.y), along);
    float other = 8.0f * copysignf(r, across) * (float)angle_turns(fabs((double)across), fabs((double)along));
    vec2 u = is_wide ? (vec2){r, other} : (vec2){other, r};
    return (vec2){float_below_one(float_max(0.5f + 0.5f * u.x, 0.0f)),
                  float_below_one(float_max(0.5f + 0.5f * u.y, 0.0f))};
}

/* Cosine-distributed around +z; density cos / pi per solid angle. */
static inline vec3 sample_cosine_hemisphere(vec2 u)
{
    vec2 d = sample_disk_concentric(u);
    float z_squared = 1.0f - d.x * d.x - d.y * d.y;
    return (vec3){d.x, d.y, sqrtf(z_squared > 1e-12f ? z_squared : 1e-12f)};
}

/* Uniform on the unit sphere; density 1 / (4 pi). */
static inline vec3 sample_uniform_sphere(vec2 u)
{
    float z = 1.0f - 2.0f * u.x, r = sqrtf(float_max(1.0f - z * z, 0.0f)), s, c;
    sincos_turns(u.y, &s, &c);
    return (vec3){r * c, r * s, z};
}

/* Back from a unit vector to what sample_uniform_sphere was given. */
static inline vec2 sample_uniform_sphere_inverse(vec3 d)
{
    return (vec2){float_below_one(float_max(0.5f - 0.5f * d.z, 0.0f)),
                  float_below_one((float)angle_turns((double)d.y, (double)d.x))};
}

/* Uniform in the cone around +z with 1 - cos_max = one_minus_cos_max; density 1 / (2 pi one_minus_cos_max). */
static inline vec3 sample_uniform_cone(vec2 u, float one_minus_cos_max)
{
    float h = u.x * one_minus_cos_max; /* 1 - cos, so that thin cones keep their precision */
    float r = sqrtf(float_max(h * (2.0f - h), 0.0f)), s, c;
    sincos_turns(u.y, &s, &c);
    return (vec3){r * c, r * s, 1.0f - h};
}

/* Barycentrics of vertices 1 and 2, uniform over the triangle; Heitz, "A Low-Distortion Map Between Triangle and
 * Square", 2019. */
static inline vec2 sample_triangle(vec2 u)
{
    if (u.y > u.x) {
        u.x *= 0.5f;
        u.y -= u.x;
    } else {
        u.y *= 0.5f;
        u.x -= u.y;
    }
    return u;
}

/* Back from barycentrics to what sample_triangle was given. */
static inline vec2 sample_triangle_inverse(vec2 b)
{
    return b.y > b.x ? (vec2){2.0f * b.x, b.x + b.y} : (vec2){b.x + b.y, 2.0f * b.y};
}

/* Veach and Guibas, "Optimally Combining Sampling Techniques", 1995: the power heuristic, exponent 2, for a sample
 * drawn by the first of two techniques with count_a and count_b samples. */
static inline float mis_power(float count_a, float pdf_a, float count_b, float pdf_b)
{
    float a = count_a * pdf_a, b = count_b * pdf_b;
    if (!(a > 0.0f))
        return 0.0f;
    float ratio = isinf(a) ? 0.0f : b / a; /* of finite squares only: they would overflow first */
    return 1.0f / (1.0f + ratio * ratio);
}

#endif
