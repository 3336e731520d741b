/* photon_aim.h: learns by trial paths which photons arrive where light is requested.
 * Rests on: Hachisuka, Jensen 2011; Suykens, Willems 2000 (see emission_guide.h).
 * Flow: importance_map -> [here] -> emission_guide -> photon_tracing. Threads: trials are traced by the run's
 * workers; what is learned is the same for any number of them. */
#ifndef AFTERGLOW_PHOTON_AIM_H
#define AFTERGLOW_PHOTON_AIM_H

#include "photon_tracing.h"

/* Starts of paths that bring light to where it is requested, found by following paths back from there. The value of
 * each is the root of the flux that it represents; its density is 1. */
typedef struct emission_starts {
    emission_trial *trials; /* owned */
    uint32_t count;
} emission_starts;

/* Finds the numbers of starts from afar anew, once, for the focus of the requests that they are learned for, if light
 * is to be denser there. */
void emission_starts_move(const scene *s, const importance_map *asked, emission_starts *in_out_starts);

typedef struct photon_aim {
    emission_guide guide;        /* owned; empty: photons are emitted by power alone */
    emission_guide starts_guide; /* owned; built from the starts alone; `other` of guide where there were enough */
    const light_target *focus;   /* borrowed from the requests: see photon_tracing_settings; NULL: none */
    uint32_t wanted;             /* photons to store, > 0 */
    /* As in photon_tracing_settings; without a guide 1, 0 and 0. */
    float stored_share, split_above, caustic_root;
    trial_counts tried; /* sums over all trials */
} photon_aim;

/* Returns how many trial paths a round has for a map of so many photons. */
uint32_t photon_aim_round_trials(uint64_t wanted);

/* Learns a guide for photon tracing with these settings. Of the members that photon_aim_apply sets it reads asked, ways
 * and wanted alone. starts: moved for what is asked; reordered; may be empty. share: of the paths that follow the
 * guide, [0, 1). *out_aim must not be moved. The guide is empty where no trial arrives where light is requested, or
 * where enough paths arrive without a guide and without a focus. out_aim->wanted is then that of the settings; with a
 * guide it is at most the number of photons that tracing by power alone would have stored before it gave up, since
 * estimates take longer the more photons they find. Photons of many paths tell more of the light than as many photons
 * of few paths, so where a guided path brings many, only a share of them is stored. Errors: AG_ERROR_MEMORY,
 * AG_CANCELLED. */
ag_status photon_aim_learn(const scene *s, run_context *run, const photon_tracing_settings *settings,
                           const emission_starts *starts, float share, photon_aim *out_aim);
void photon_aim_reset(photon_aim *aim);

/* Sets what was learned in the settings that it was learned for; they borrow the guide. Without one photons are emitted
 * and scattered by power alone, and all of them are stored. */
void photon_aim_apply(const photon_aim *aim, photon_tracing_settings *in_out_settings);

#endif
