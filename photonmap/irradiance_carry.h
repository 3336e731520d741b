/* irradiance_carry.h: irradiances from the map of one frame of an animation to that of the next, where nothing has
 * changed nearby: the slots have the bits that they would get if they were computed anew.
 * Rests on: an estimate depends on the photons within its reach, on the surfaces there, and on what is rounded to be
 * the same for all of a steady map (photon_map.h): so it stays as it is while none of these changes. Flow:
 * photon_tracing with fixed paths -> photon_map of two frames, scene_forms of both -> [here] -> irradiance_cache.
 * Threads: one caller, on the run's workers; both maps are nobody else's meanwhile. */
#ifndef AFTERGLOW_IRRADIANCE_CARRY_H
#define AFTERGLOW_IRRADIANCE_CARRY_H

#include "photon_map.h"
#include "scene_forms.h"

typedef struct irradiance_carry {
    uint64_t came, went; /* photons that only the one map has and only the other one */
    uint64_t kept;       /* irradiances that the map has taken over */
} irradiance_carry;

/* Makes ready all slots of a map whose irradiance can be taken from the map of another frame; before a cache is made
 * over it. difference: between the scenes of both, as their rays meet them. Photons are known by their 20 bytes.
 * Nothing is taken where the maps are not both steady, with the same radii and exponents, or where so many photons have
 * changed that hardly any disc is without one. Errors: AG_ERROR_MEMORY, AG_CANCELLED; slots that are ready then are
 * right all the same. */
ag_status irradiance_carry_over(run_context *run, const photon_map *before, const scene_difference *difference,
                                photon_map *map, irradiance_carry *out_carry);

#endif
