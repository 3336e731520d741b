/* irradiance_carry.h: takes irradiances from the map of one frame of an animation over to the map of the next, where
 * nothing nearby has changed: the slots get the bits that computing them anew would give.
 * Rests on: an estimate depends on the photons within its reach, on the surfaces there, and on the radii and exponents
 * of a steady map, which are rounded (photon_map.h); it stays the same while none of these changes.
 * Flow: photon_tracing with fixed paths -> photon_map of two frames, scene_forms of both -> [here] -> irradiance_cache.
 * Threads: one caller, on the run's workers; nobody else uses the maps meanwhile. */
#ifndef AFTERGLOW_IRRADIANCE_CARRY_H
#define AFTERGLOW_IRRADIANCE_CARRY_H

#include "photon_map.h"
#include "scene_forms.h"

typedef struct irradiance_carry {
    uint64_t came, went; /* photons that only the new map has, and that only the old one has */
    uint64_t kept;       /* irradiances that the new map has taken over */
} irradiance_carry;

/* Makes ready all slots of `map` whose irradiance can be taken from `before`, the map of another frame; to be called
 * before a cache is made over `map`. difference: between the scenes of the two, as rays meet them. A photon is the same
 * where its 20 bytes are. Nothing is taken where the maps are not both steady, with the same radii and exponents, or
 * where so many photons have changed that hardly any disc is without one. Errors: AG_ERROR_MEMORY, AG_CANCELLED; slots
 * that are ready then are right all the same. */
ag_status irradiance_carry_over(run_context *run, const photon_map *before, const scene_difference *difference,
                                photon_map *map, irradiance_carry *out_carry);

#endif
