/* photon_aim.h: learns by trial which photons arrive where light is asked for.
 * Rests on: Hachisuka, Jensen 2011; Suykens, Willems 2000 (see emission_guide.h).
 * Flow: place_importance -> [here] -> emission_guide -> photon_tracing. Threads: trials are traced by the run's
 * workers; what is learned is the same for any number of them. */
#ifndef AFTERGLOW_PHOTON_AIM_H
#define AFTERGLOW_PHOTON_AIM_H

#include "photon_tracing.h"

/* Fills out_guide for photon tracing with these settings (whose guide is not read, and whose `asked` is); share: of the
 * paths, that follow what is learned, [0, 1). The guide is empty, so that photons go by power alone, where none of the
 * trials arrives where light is asked for, and where enough do without a guide. out_counts: of all that was tried.
 * *out_wanted: the settings' `wanted`, or, by a guide, no more than power alone would have stored before it gave up:
 * estimates take the longer the more photons they find. Errors: AG_ERROR_MEMORY, AG_CANCELLED. */
ag_status photon_aim_learn(const scene *s, run_context *run, const photon_tracing_settings *settings, float share,
                           emission_guide *out_guide, trial_counts *out_counts, uint32_t *out_wanted);

#endif
