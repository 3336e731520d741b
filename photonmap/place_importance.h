/* place_importance.h: where light is asked for: how many of a pilot's questions fell on a surface, per area.
 * Rests on: Peter, Pietrek, "Importance Driven Construction of Photon Maps", 1998 (importons); Suykens, Willems,
 * "Density Control for Photon Maps", 2000.
 * Flow: the eye's side asks at places -> [here] -> photon_tracing, emission_guide. Threads: one builds; then read-only.
 *
 * The places lie in octrees, one for each of the six ways that a surface may face, so that what is asked for inside of
 * a wall says nothing of its outside. */
#ifndef AFTERGLOW_PLACE_IMPORTANCE_H
#define AFTERGLOW_PLACE_IMPORTANCE_H

#include "afterglow/base.h"
#include "math/vec3.h"

#include <stdint.h>

/* A place where the eye's side would ask for light, and the side of a surface that it is asked for. */
typedef struct asked_place {
    vec3 position, normal; /* normal: unit */
} asked_place;

typedef struct importance_node importance_node;

typedef struct place_importance {
    importance_node *nodes; /* owned; the roots of the six trees first */
    uint32_t node_count;
    vec3 corner; /* of the cube that all trees divide */
    float size;  /* of its edge */
} place_importance;

/* Reads the places. Without any, no place has importance. Errors: AG_ERROR_MEMORY. */
ag_status place_importance_create(const asked_place *places, uint32_t count, place_importance *out_importance);

/* For places that are few and by chance, shares of so large a whole (>= 1): between low and high, where all of them
 * lie, a part of a surface that has none counts as if it had up to one, by how many lie around it. */
ag_status place_importance_create_smooth(const asked_place *places, uint32_t count, uint32_t whole, vec3 low, vec3 high,
                                         place_importance *out_importance);
void place_importance_reset(place_importance *importance);

/* Share of all the places, or of the whole, that lies around here on the side of the normal, per area [1/m^2]; 0 where
 * there is none. */
float place_importance_at(const place_importance *importance, vec3 position, vec3 normal);

#endif
