/* shading.h: radiance along a camera ray with the photon map, as Jensen splits it.
 * Rests on: Jensen 1996; Jensen 2001, ch. 8: emitted + direct + caustics + specular and glossy traced on + final
 * gather; Arvo, Kirk, "Particle Transport and Image Synthesis", 1990 (splitting, roulette).
 * Threads: pure but for the worker's counters and the irradiance slots. */
#ifndef AFTERGLOW_SHADING_H
#define AFTERGLOW_SHADING_H

#include "integrator/eye_path.h"

/* Eye paths are of traced lobes alone, few and short, and a lamp that one meets behind glass may be a thousand times as
 * bright as all around: a faint path that roulette had made as strong as it began would show it as a speck. */
static const eye_roulette SHADING_ROULETTE = {4, 1.0f / 16.0f};

/* Adds the radiance along the ray to a sample that has nothing in it but its bounds and room for layers. Gathered light
 * comes later, from the worker's batch once that is resolved. */
void shading_radiance(const transport *t, eye_worker *worker, const camera_sample *from, eye_sample *in_out);

#endif
