/* texture_noise.c: see texture_noise.h. Threads: pure functions. */
#include "texture/texture_noise.h"

#include <stdint.h>

/* Perlin's permutation of 0 to 255, from his reference implementation. */
static const uint8_t PERMUTATION[256] = {
    151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225, 140, 36,  103, 30,  69,  142,
    8,   99,  37,  240, 21,  10,  23,  190, 6,   148, 247, 120, 234, 75,  0,   26,  197, 62,  94,  252, 219, 203,
    117, 35,  11,  32,  57,  177, 33,  88,  237, 149, 56,  87,  174, 20,  125, 136, 171, 168, 68,  175, 74,  165,
    71,  134, 139, 48,  27,  166, 77,  146, 158, 231, 83,  111, 229, 122, 60,  211, 133, 230, 220, 105, 92,  41,
    55,  46,  245, 40,  244, 102, 143, 54,  65,  25,  63,  161, 1,   216, 80,  73,  209, 76,  132, 187, 208, 89,
    18,  169, 200, 196, 135, 130, 116, 188, 159, 86,  164, 100, 109, 198, 173, 186, 3,   64,  52,  217, 226, 250,
    124, 123, 5,   202, 38,  147, 118, 126, 255, 82,  85,  212, 207, 206, 59,  227, 47,  16,  58,  17,  182, 189,
    28,  42,  223, 183, 170, 213, 119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101, 155, 167, 43,  172, 9,
    129, 22,  39,  253, 19,  98,  108, 110, 79,  113, 224, 232, 178, 185, 112, 104, 218, 246, 97,  228, 251, 34,
    242, 193, 238, 210, 144, 12,  191, 179, 162, 241, 81,  51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,
    181, 199, 106, 157, 184, 84,  204, 176, 115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,  222, 114,
    67,  29,  24,  72,  243, 141, 128, 195, 78,  66,  215, 61,  156, 180};

static const float LACUNARITY = 1.99f, MEAN_ABSOLUTE_NOISE = 0.2f;

/* A coordinate's cell, of 256, and the position within it. */
static int find_cell(float x, float *out_within)
{
    float in_period = isfinite(x) ? x - 256.0f * floorf(x * (1.0f / 256.0f)) : 0.0f; /* no rounding */
    float cell = floorf(in_period);
    *out_within = in_period - cell;
    return (int)cell & 255;
}

/* The slope at a corner, one of 16 directions, times the way from there. */
static float corner_value(int x, int y, int z, vec3 way)
{
    int hash = PERMUTATION[(PERMUTATION[(PERMUTATION[x & 255] + y) & 255] + z) & 255] & 15;
    bool is_twelve_or_thirteen = hash == 12 || hash == 13;
    float a = hash < 8 || is_twelve_or_thirteen ? way.x : way.y;
    float b = hash < 4 || is_twelve_or_thirteen ? way.y : way.z;
    return (hash & 1 ? -a : a) + (hash & 2 ? -b : b);
}

/* Perlin's fade: level at both ends, and so is its slope. */
static float fade(float t) { return t * t * t * (10.0f + t * (6.0f * t - 15.0f)); }

static float mix(float t, float a, float b) { return (1.0f - t) * a + t * b; }

float texture_noise(vec3 p)
{
    vec3 within;
    int x = find_cell(p.x, &within.x), y = find_cell(p.y, &within.y), z = find_cell(p.z, &within.z);
    float corner[8];
    for (int k = 0; k < 8; k++) {
        int i = k & 1, j = k >> 1 & 1, l = k >> 2;
        corner[k] = corner_value(x + i, y + j, z + l, vec3_sub(within, vec3_make((float)i, (float)j, (float)l)));
    }
    float u = fade(within.x), v = fade(within.y), w = fade(within.z);
    float near_z = mix(v, mix(u, corner[0], corner[1]), mix(u, corner[2], corner[3]));
    float far_z = mix(v, mix(u, corner[4], corner[5]), mix(u, corner[6], corner[7]));
    return mix(w, near_z, far_z);
}

float texture_fbm(vec3 p, float roughness, int octaves)
{
    float sum = 0.0f, frequency = 1.0f, height = 1.0f;
    for (int i = 0; i < octaves; i++) {
        sum += height * texture_noise(vec3_scale(p, frequency));
        frequency *= LACUNARITY;
        height *= roughness;
    }
    return sum;
}

float texture_turbulence(vec3 p, float roughness, int octaves)
{
    float sum = 0.0f, frequency = 1.0f, height = 1.0f;
    for (int i = 0; i < octaves; i++) {
        sum += height * fabsf(texture_noise(vec3_scale(p, frequency)));
        frequency *= LACUNARITY;
        height *= roughness;
    }
    return sum + height * MEAN_ABSOLUTE_NOISE;
}
