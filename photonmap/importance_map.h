/* importance_map.h: where light is asked for: how many of a pilot's questions fell on a surface, per area.
 * Rests on: Peter, Pietrek, "Importance Driven Construction of Photon Maps", 1998 (importons); Suykens, Willems,
 * "Density Control for Photon Maps", 2000.
 * Flow: the eye's side asks at points -> [here] -> photon_tracing, emission_guide. Threads: one builds; then read-only.
 *
 * The points lie in octrees, one for each of the six ways that a surface may face, so that what is asked for inside of
 * a wall says nothing of its outside. */
#ifndef AFTERGLOW_IMPORTANCE_MAP_H
#define AFTERGLOW_IMPORTANCE_MAP_H

#include "afterglow/base.h"
#include "math/vec3.h"

#include <stdint.h>

/* A point where the eye's side would ask for light, and the side of a surface that it is asked for. */
typedef struct query_point {
    vec3 position, normal; /* normal: unit */
} query_point;

typedef struct importance_node importance_node;

typedef struct importance_map {
    importance_node *nodes; /* owned; the roots of the six trees first */
    uint32_t node_count;
    vec3 corner; /* of the cube that all trees divide */
    float size;  /* of its edge */
} importance_map;

/* Reads the points. Without any, no point has importance. Errors: AG_ERROR_MEMORY. */
ag_status importance_map_create(const query_point *points, uint32_t count, importance_map *out_importance);

/* Reads points that are few and lie there by chance, and that are shares of a whole of so many (>= 1). They all lie
 * between low and high. A part of a surface that has none counts as if it had up to one, by how many lie around it. */
ag_status importance_map_create_smooth(const query_point *points, uint32_t count, uint32_t whole, vec3 low, vec3 high,
                                       importance_map *out_importance);
void importance_map_reset(importance_map *importance);

/* Share of all the points, or of the whole, that lies around here on the side of the normal, per area [1/m^2]; 0 where
 * there is none. */
float importance_map_at(const importance_map *importance, vec3 position, vec3 normal);

#endif
