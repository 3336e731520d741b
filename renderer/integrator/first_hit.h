/* first_hit.h: what a camera ray meets first, for layers and denoisers: where, which way it faces, what it reflects.
 * Rests on: the documentation of Open Image Denoise (albedo of mirrors and glass, normals unscaled); pbrt-v4's
 * VisibleSurface. Flow: shading, path_tracing -> [here] -> eye_sample. Threads: pure but for the worker's scratch. */
#ifndef AFTERGLOW_FIRST_HIT_H
#define AFTERGLOW_FIRST_HIT_H

#include "integrator/transport.h"

/* A camera ray's point on film and lens and its time, as camera_generate_ray takes them. */
typedef struct film_point {
    float film_x, film_y, aspect; /* [0, 1] */
    vec2 lens;
    float time;
} film_point;

/* Fills in all members but the slopes. */
void first_hit_fill(const transport *t, eye_worker *worker, const vertex *v, const sampler *where, first_hit *out);

/* Adds the slopes, for a film of that size in pixels, and transforms the members wanted in camera space to it. */
void first_hit_project(const transport *t, const film_point *from, first_hit *in_out);

#endif
