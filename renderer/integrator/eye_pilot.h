/* eye_pilot.h: finds out beforehand, by a few eye paths and gather rays, where the picture will ask for light.
 * Rests on: Peter, Pietrek, "Importance Driven Construction of Photon Maps", 1998.
 * Flow: camera -> [here] -> importance_map -> photon tracing. Threads: rows by the run's workers, merged in order.
 *
 * The eye paths are spread over the whole frame. Their number does not depend on resolution, crop, tile and samples, so
 * all parts of a picture, and all its sizes of one shape, have the same photons. */
#ifndef AFTERGLOW_EYE_PILOT_H
#define AFTERGLOW_EYE_PILOT_H

#include "afterglow/afterglow.h"
#include "onward_ways.h"
#include "photon_aim.h"
#include "rays/rays.h"
#include "scene.h"

typedef struct eye_pilot {
    importance_map gathered; /* points where the global map will be asked */
    importance_map onward;   /* diffuse surfaces whose light arrives at those */
    importance_map seen;     /* points where the caustic map will be asked */
    onward_ways ways;        /* directions from the onward surfaces to where light is asked for */
    onward_ways seen_ways;   /* directions from rough traced lobes to where their caustics are seen */
    emission_starts starts;  /* of the global map's paths: from lamps straight to the onward surfaces */
} eye_pilot;

/* Of the settings it reads width over height, depth, light through panes, number of photons and seed. Errors:
 * AG_ERROR_MEMORY, AG_CANCELLED. */
ag_status eye_pilot_look(const scene *s, run_context *run, const ag_render_settings *settings, eye_pilot *out_pilot);
void eye_pilot_reset(eye_pilot *pilot);

/* Finds how much of what the picture shows is enclosed: the root of the mean, over the eye paths, of the squared share
 * of a point's gather rays that meet something. A path that meets nothing counts as 0, and one that ends otherwise
 * before it comes to a point that gathers not at all; 1 where none counts. Of the settings it reads width over height,
 * depth, light through panes and seed. Errors: AG_ERROR_MEMORY, AG_CANCELLED. */
ag_status eye_pilot_find_enclosure(const scene *s, run_context *run, const ag_render_settings *settings,
                                   double *out_enclosure);

/* A point where the picture will ask for direct light. */
typedef struct lit_point {
    surface_hit hit;
    scene_ray arrived;
    vec3 normal; /* vertex_light_normal there */
} lit_point;

/* Finds the points. Of the settings it reads width over height, depth, light through panes and seed. Errors:
 * AG_ERROR_MEMORY, AG_CANCELLED. out_points: to be freed by the caller, on success. */
ag_status eye_pilot_find_lit(const scene *s, run_context *run, const ag_render_settings *settings,
                             lit_point **out_points, uint32_t *out_count);

#endif
