/* shading.h: radiance along a camera ray with the photon map, as Jensen splits it.
 * Rests on: Jensen 1996; Jensen 2001, ch. 8: emitted + direct + caustics + specular and glossy traced on + final
 * gather; Arvo, Kirk, "Particle Transport and Image Synthesis", 1990 (splitting, roulette).
 * Threads: pure but for the worker's counters and the irradiance slots. */
#ifndef AFTERGLOW_SHADING_H
#define AFTERGLOW_SHADING_H

#include "integrator/transport.h"

/* Below this throughput a diffuse place is shown by the k-nearest estimate at it instead of being gathered (Jensen
 * 2001, 8.2: an approximate evaluation where the contribution is low). */
static const float SHADING_LOW_CONTRIBUTION = 0.03f;

/* Sends an eye path on from a place by its traced lobes, with roulette from the fifth vertex on. is_last: only straight
 * through a pane where that is direct light. random_vertex: at which random numbers are drawn. False: the path ends.
 * *out_goes_straight: the sample is no scattering. */
bool shading_go_on(const transport *t, const vertex *v, const sampler *where, int random_vertex, int path_vertex,
                   bool is_last, rgb *in_out_throughput, bsdf_sample *out_next, bool *out_goes_straight);

/* Adds to *in_out, which has nothing in it but its bounds and layers' place. */
/* All but what is gathered: that the worker's batch has when it is resolved. */
void shading_radiance(const transport *t, eye_worker *worker, scene_ray ray, const sampler *where, eye_sample *in_out);

#endif
