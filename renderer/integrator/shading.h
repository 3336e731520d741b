/* shading.h: radiance along a camera ray with the photon map, as Jensen splits it.
 * Rests on: Jensen 1996; Jensen 2001, ch. 8: emitted + direct + caustics + specular and glossy traced on + final
 * gather. Threads: pure but for the worker's counters and the irradiance slots. */
#ifndef AFTERGLOW_SHADING_H
#define AFTERGLOW_SHADING_H

#include "integrator/transport.h"

/* Adds to *in_out, which has nothing in it but its bounds and layers' place. */
/* All but what is gathered: that the worker's batch has when it is resolved. */
void shading_radiance(const transport *t, eye_worker *worker, scene_ray ray, const sampler *where, eye_sample *in_out);

#endif
