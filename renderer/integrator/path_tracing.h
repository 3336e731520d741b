/* path_tracing.h: radiance along a camera ray by path tracing: the truth that the photon map is held against.
 * Rests on: Kajiya, "The Rendering Equation", 1986; Veach 1997, ch. 9, 10 (next-event estimation, MIS).
 * Threads: pure but for the worker's counters. */
#ifndef AFTERGLOW_PATH_TRACING_H
#define AFTERGLOW_PATH_TRACING_H

#include "integrator/camera_sample.h"
#include "integrator/transport.h"

/* Adds the radiance along the ray to a sample that has nothing in it but its bounds and room for layers. */
void path_tracing_radiance(const transport *t, eye_worker *worker, const camera_sample *from, eye_sample *in_out);

#endif
