/* texture_noise.h: gradient noise and sums of its octaves.
 * Rests on: Perlin, "Improving Noise", SIGGRAPH 2002; Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed.,
 * 2023, 10.6 (which gradients, and how octaves follow one another, so that scenes look as they do there).
 * Flow: texture asks. Threads: pure functions. */
#ifndef AFTERGLOW_TEXTURE_NOISE_H
#define AFTERGLOW_TEXTURE_NOISE_H

#include "math/vec3.h"

/* About [-1, 1]; 0 at whole coordinates; repeats every 256. */
float texture_noise(vec3 p);

/* Octaves of noise, each 1.99 times as fine as the one before and `roughness` times as high. */
float texture_fbm(vec3 p, float roughness, int octaves);
/* Octaves of the noise's absolute value, as in texture_fbm; the octaves left out count with its mean. */
float texture_turbulence(vec3 p, float roughness, int octaves);

#endif
