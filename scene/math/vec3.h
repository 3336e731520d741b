/* vec3.h: points, directions and linear RGB as value types.
 * Plain IEEE steps in a fixed order (the build turns contraction off), so results do not depend on the compiler's mood.
 * Threads: pure functions. */
#ifndef AFTERGLOW_VEC3_H
#define AFTERGLOW_VEC3_H

#include "math/min_max.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#define AG_PI     3.14159265358979323846f
#define AG_INV_PI 0.31830988618379067154f

typedef struct vec2 {
    float x, y;
} vec2;

typedef struct vec3 {
    float x, y, z;
} vec3;

/* Linear RGB; the unit is the quantity's (W, W/m^2, W/m^2/sr, or none for a reflectance). */
typedef struct rgb {
    float r, g, b;
} rgb;

static inline vec3 vec3_make(float x, float y, float z) { return (vec3){x, y, z}; }
static inline vec3 vec3_add(vec3 a, vec3 b) { return (vec3){a.x + b.x, a.y + b.y, a.z + b.z}; }
static inline vec3 vec3_sub(vec3 a, vec3 b) { return (vec3){a.x - b.x, a.y - b.y, a.z - b.z}; }
static inline vec3 vec3_mul(vec3 a, vec3 b) { return (vec3){a.x * b.x, a.y * b.y, a.z * b.z}; }
static inline vec3 vec3_scale(vec3 a, float s) { return (vec3){a.x * s, a.y * s, a.z * s}; }
static inline vec3 vec3_negate(vec3 a) { return (vec3){-a.x, -a.y, -a.z}; }
/* a + b s */
static inline vec3 vec3_add_scaled(vec3 a, vec3 b, float s)
{
    return (vec3){a.x + b.x * s, a.y + b.y * s, a.z + b.z * s};
}
static inline float vec3_dot(vec3 a, vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline vec3 vec3_cross(vec3 a, vec3 b)
{
    return (vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static inline float vec3_length_squared(vec3 a) { return vec3_dot(a, a); }
static inline float vec3_length(vec3 a) { return sqrtf(vec3_dot(a, a)); }
static inline float vec3_distance_squared(vec3 a, vec3 b) { return vec3_length_squared(vec3_sub(a, b)); }
static inline vec3 vec3_normalize(vec3 a) { return vec3_scale(a, 1.0f / vec3_length(a)); }
/* A NaN of b does not count. */
static inline vec3 vec3_min(vec3 a, vec3 b)
{
    return (vec3){float_min(b.x, a.x), float_min(b.y, a.y), float_min(b.z, a.z)};
}
static inline vec3 vec3_max(vec3 a, vec3 b)
{
    return (vec3){float_max(b.x, a.x), float_max(b.y, a.y), float_max(b.z, a.z)};
}
static inline float vec3_max_abs(vec3 a) { return float_max(fabsf(a.x), float_max(fabsf(a.y), fabsf(a.z))); }
static inline bool vec3_is_zero(vec3 a) { return a.x == 0.0f && a.y == 0.0f && a.z == 0.0f; }
static inline bool vec3_is_finite(vec3 a) { return isfinite(a.x) && isfinite(a.y) && isfinite(a.z); }
/* n or -n, whichever lies on the side of v */
static inline vec3 vec3_face_forward(vec3 n, vec3 v) { return vec3_dot(n, v) < 0.0f ? vec3_negate(n) : n; }

/* At most the largest float below 1: for random numbers of [0, 1), which rounding may bring to 1. */
static inline float float_below_one(float x) { return float_min(x, 0x1.fffffep-1f); }

static inline rgb rgb_make(float r, float g, float b) { return (rgb){r, g, b}; }
static inline rgb rgb_gray(float v) { return (rgb){v, v, v}; }
static inline rgb rgb_add(rgb a, rgb b) { return (rgb){a.r + b.r, a.g + b.g, a.b + b.b}; }
static inline rgb rgb_sub(rgb a, rgb b) { return (rgb){a.r - b.r, a.g - b.g, a.b - b.b}; }
static inline rgb rgb_mul(rgb a, rgb b) { return (rgb){a.r * b.r, a.g * b.g, a.b * b.b}; }
static inline rgb rgb_scale(rgb a, float s) { return (rgb){a.r * s, a.g * s, a.b * s}; }
/* which ? a : b without a branch, for where it would be guessed wrong: by their bits. */
static inline float float_select(bool which, float a, float b)
{
    uint32_t a_bits, b_bits, mask = 0u - (uint32_t)which;
    memcpy(&a_bits, &a, sizeof a);
    memcpy(&b_bits, &b, sizeof b);
    a_bits = (a_bits & mask) | (b_bits & ~mask);
    memcpy(&a, &a_bits, sizeof a);
    return a;
}
/* A NaN does not count. */
static inline float rgb_max(rgb a)
{
    const float of_two = float_max(a.b, a.g), known = of_two == of_two ? of_two : a.b, all = float_max(known, a.r);
    return all == all ? all : known;
}
/* Each part as by float_clamp. */
static inline rgb rgb_clamp(rgb a, float low, float high)
{
    return (rgb){float_clamp(a.r, low, high), float_clamp(a.g, low, high), float_clamp(a.b, low, high)};
}
static inline bool rgb_is_black(rgb a) { return a.r == 0.0f && a.g == 0.0f && a.b == 0.0f; }
static inline bool rgb_is_finite(rgb a) { return isfinite(a.r) && isfinite(a.g) && isfinite(a.b); }
/* Relative luminance, Rec. 709 primaries (ITU-R BT.709-6). */
static inline float rgb_mean(rgb a) { return (a.r + a.g + a.b) / 3.0f; }
static inline float rgb_luminance(rgb a) { return 0.2126f * a.r + 0.7152f * a.g + 0.0722f * a.b; }

/* An orthonormal frame around a unit z axis. */
typedef struct frame {
    vec3 x, y, z;
} frame;

static inline frame frame_identity(void) { return (frame){{1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}}; }
/* Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017. */
static inline frame frame_from_z(vec3 z)
{
    float sign = copysignf(1.0f, z.z);
    float a = -1.0f / (sign + z.z);
    float b = z.x * z.y * a;
    return (frame){{1.0f + sign * (z.x * z.x) * a, sign * b, -sign * z.x}, {b, sign + (z.y * z.y) * a, -z.y}, z};
}
static inline vec3 frame_to_world(const frame *f, vec3 v)
{
    return vec3_add_scaled(vec3_add_scaled(vec3_scale(f->x, v.x), f->y, v.y), f->z, v.z);
}
static inline vec3 frame_to_local(const frame *f, vec3 v)
{
    return (vec3){vec3_dot(f->x, v), vec3_dot(f->y, v), vec3_dot(f->z, v)};
}

#endif
