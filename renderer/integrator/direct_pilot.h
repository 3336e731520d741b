/* direct_pilot.h: finds out which lights are seen from the points where the picture will ask for direct light.
 * Rests on: see direct_guide.h.
 * Flow: eye_pilot -> [here] -> direct_guide -> direct lighting. Threads: cells by the run's workers; what is learned is
 * the same for any number of them, and for any crop, tile, size and number of samples of the picture. */
#ifndef AFTERGLOW_DIRECT_PILOT_H
#define AFTERGLOW_DIRECT_PILOT_H

#include "integrator/transport.h"

/* Fills out_guide, which stays empty where the settings want no guiding or the scene has nothing to guide. t: the
 * picture's; its direct_guide is not read. *out_rays: the number of shadow rays cast. Errors: AG_ERROR_MEMORY,
 * AG_CANCELLED. */
ag_status direct_pilot_learn(const transport *t, run_context *run, direct_guide *out_guide, uint64_t *out_rays);

#endif
