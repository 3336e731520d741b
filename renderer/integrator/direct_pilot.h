/* direct_pilot.h: looks from where the picture will ask for direct light which lights are seen from there.
 * Rests on: see direct_guide.h.
 * Flow: eye_pilot -> [here] -> direct_guide -> direct lighting. Threads: cells by the run's workers; what is learned is
 * the same for any number of them, and for any crop, tile, size and number of samples of the picture. */
#ifndef AFTERGLOW_DIRECT_PILOT_H
#define AFTERGLOW_DIRECT_PILOT_H

#include "integrator/transport.h"

/* t: of the picture, direct_guide is not read. Fills out_guide, which is empty where the settings want no guiding or
 * the scene has nothing to be guided. *out_rays: shadow rays cast. Errors: AG_ERROR_MEMORY, AG_CANCELLED. */
ag_status direct_pilot_learn(const transport *t, run_context *run, direct_guide *out_guide, uint64_t *out_rays);

#endif
