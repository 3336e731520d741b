/* photon_aim.h: learns by trial which photons arrive where light is asked for.
 * Rests on: Hachisuka, Jensen 2011; Suykens, Willems 2000 (see emission_guide.h).
 * Flow: importance_map -> [here] -> emission_guide -> photon_tracing. Threads: trials are traced by the run's
 * workers; what is learned is the same for any number of them. */
#ifndef AFTERGLOW_PHOTON_AIM_H
#define AFTERGLOW_PHOTON_AIM_H

#include "photon_tracing.h"

/* Starts of paths along which light would come to where it is asked for, as looked for from there: each with the root
 * of the flux that it stands for as its value, and a density of 1. */
typedef struct emission_starts {
    emission_trial *trials; /* owned */
    uint32_t count;
} emission_starts;

typedef struct photon_aim {
    emission_guide guide; /* owned; empty: photons go by power alone */
    emission_guide found; /* owned: by the starts; the guide's other one */
    uint32_t wanted;      /* photons to store, > 0 */
    float split_above;    /* as photon_tracing_settings has it, and the next one; 0 without a guide */
    float caustic_root;
    trial_counts tried; /* in all */
} photon_aim;

/* Learns for photon tracing with these settings, of which guide and split_above are not read, and from starts, which
 * are reordered and may be none; share: of the paths, that follow what is learned, [0, 1). *out_aim stays where it
 * is. The guide is empty where none of the trials arrives where light is asked for, and
 * where enough do without one. wanted is the settings', or with a guide no more than power alone would have stored
 * before it gave up: estimates take longer the more photons they find. Errors: AG_ERROR_MEMORY, AG_CANCELLED. */
ag_status photon_aim_learn(const scene *s, run_context *run, const photon_tracing_settings *settings,
                           const emission_starts *starts, float share, photon_aim *out_aim);
void photon_aim_reset(photon_aim *aim);

#endif
