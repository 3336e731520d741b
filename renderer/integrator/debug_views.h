/* debug_views.h: shows how the photon map and its cache fared, pixel by pixel, at the surface that the ray through the
 * pixel's middle meets first. The views are made after the samples, which they do not slow.
 * Rests on: Neilson, Yang, TR 04-21, 2004, whose figures show where irradiance was demanded.
 * Flow: maps, cache -> [here] -> film. Threads: the run's workers, a row each. */
#ifndef AFTERGLOW_DEBUG_VIEWS_H
#define AFTERGLOW_DEBUG_VIEWS_H

#include "film/film.h"
#include "integrator/transport.h"

/* Fills in the film's views, all but the tiles' times. workers: of the pool. Errors: AG_ERROR_MEMORY, AG_CANCELLED. */
ag_status debug_views_render(const transport *t, run_context *run, eye_worker *workers, struct ag_film *film);

#endif
