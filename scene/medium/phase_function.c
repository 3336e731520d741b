/* phase_function.c: see phase_function.h. */
#include "medium/phase_function.h"

#include "math/sampling.h"

#include <math.h>

float phase_function_density(const phase_function *phase, float cosine)
{
    const float g = phase->g;
    /* 1 + g^2 - 2 g cosine, without loss where the angle is small and g near 1 */
    float near = 1.0f - fabsf(g), square = near * near + 2.0f * fabsf(g) * (1.0f - (g < 0.0f ? -cosine : cosine));
    square = float_max(square, near * near);
    return 0.25f * AG_INV_PI * (1.0f - g * g) / (square * sqrtf(square));
}

/* The inverse of the distribution of cosines, in a form that is exact for g near 0 too. */
static float sample_cosine(float g, float u)
{
    float s = 1.0f - 2.0f * u, ratio = (1.0f - g * g) / (1.0f - g * s);
    float cosine = 0.5f * (g + (g - s) / (1.0f - g * s) * (1.0f + ratio));
    return float_clamp(cosine, -1.0f, 1.0f);
}

vec3 phase_function_sample(const phase_function *phase, vec3 along, vec2 u)
{
    float cosine = sample_cosine(phase->g, u.x), sine = sqrtf(float_max(1.0f - cosine * cosine, 0.0f)), s, c;
    sincos_turns(u.y, &s, &c);
    frame f = frame_from_z(along);
    return vec3_normalize(frame_to_world(&f, (vec3){sine * c, sine * s, cosine}));
}

void phase_function_add_hash(const phase_function *phase, hash128 *h) { HASH128_ADD(h, phase->g); }
