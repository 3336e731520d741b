/* photon_path.h: one photon path: it leaves a lamp, is scattered, split, and leaves photons where it arrives.
 * Flow: photon_tracing -> [here] -> transmittance, bsdf. Threads: one for each block. */
#ifndef AFTERGLOW_PHOTON_PATH_H
#define AFTERGLOW_PHOTON_PATH_H

#include "photon_tracing.h"

/* Paths in a row, and what comes of them; begin with all zero. */
typedef struct path_block {
    photon *photons;
    uint32_t count, capacity;
    uint32_t first; /* of its photons in the set */
    uint64_t paths, parts, rays, rays_cut;
    energy_balance balance;
    bool out_of_memory;
    bool is_cut; /* cancelled before all of its paths were traced */
} path_block;

/* Everything that tracing a path reads and writes. */
typedef struct photon_tracer {
    const scene *s;
    const light_target *target; /* of a caustic map: what its paths must meet first; else NULL */
    const photon_tracing_settings *settings;
    path_block *out;
    uint32_t limit;        /* photons to store at most; paths begun are finished for the balance */
    emission_trial *trial; /* NULL, or nothing is stored, and this is valued */
    trial_counts *counts;  /* with it */
} photon_tracer;

/* Follows the path of that number to its end: photons, counts and balance go into t->out, and a trial's value into
 * t->trial. A block that runs out of memory says so. */
void photon_path_trace(photon_tracer *t, uint64_t number);

#endif
