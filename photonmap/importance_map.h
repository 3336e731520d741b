/* importance_map.h: the density of a pilot's light lookups on surfaces, per area.
 * Rests on: Peter, Pietrek, "Importance Driven Construction of Photon Maps", 1998 (importons); Suykens, Willems,
 * "Density Control for Photon Maps", 2000.
 * Flow: the pilot's lookups -> [here] -> photon_tracing, emission_guide. Threads: built by one thread; then read-only.
 *
 * The points lie in octrees, one for each of the six main directions of normals, so that lookups on the inside of a
 * wall do not count for its outside. */
#ifndef AFTERGLOW_IMPORTANCE_MAP_H
#define AFTERGLOW_IMPORTANCE_MAP_H

#include "light/light.h"

#include <stdint.h>

/* A point where the renderer would look up light, and the side of the surface. */
typedef struct query_point {
    vec3 position, normal; /* normal: unit */
} query_point;

typedef struct importance_node importance_node;

typedef struct importance_map {
    importance_node *nodes; /* owned; the six roots first */
    uint32_t node_count;
    vec3 corner;        /* of the cube that the trees subdivide */
    float size;         /* length of its edge, scene units */
    light_target focus; /* a ball around most of the points; radius 0: there are none */
} importance_map;

/* Builds the map from points, and finds their focus. Without points all importance is 0. Errors: AG_ERROR_MEMORY. */
ag_status importance_map_create(const query_point *points, uint32_t count, importance_map *out_importance);

/* Builds the map from a sparse random sample: `count` of `whole` (>= 1) points, all between low and high. A part of a
 * surface without points counts as up to one point, depending on the number of points around it. It has no focus.
 * Errors: AG_ERROR_MEMORY. */
ag_status importance_map_create_smooth(const query_point *points, uint32_t count, uint32_t whole, vec3 low, vec3 high,
                                       importance_map *out_importance);
void importance_map_reset(importance_map *importance);

/* Returns the share of the points (or of `whole`) per area, 1/m^2, around a position on the side of the unit normal; 0
 * where there is none. */
float importance_map_at(const importance_map *importance, vec3 position, vec3 normal);

#endif
