/* photon_path.h: traces one photon path: emission, scattering, splitting, and storing photons at arrivals.
 * Flow: photon_tracing -> [here] -> photon_arrival. Threads: one for each block. */
#ifndef AFTERGLOW_PHOTON_PATH_H
#define AFTERGLOW_PHOTON_PATH_H

#include "photon_tracing.h"

/* A block of consecutive paths and their results; initialise with zeros. */
typedef struct path_block {
    photon *photons;
    uint32_t count, capacity;
    uint32_t first; /* of its photons in the set */
    uint64_t paths, parts, rays, rays_cut;
    energy_balance balance;
    bool out_of_memory;
    bool is_cut; /* cancelled before all of its paths were traced */
} path_block;

/* The state that tracing a path reads and writes. */
typedef struct photon_tracer {
    const scene *s;
    const light_target *target; /* of a caustic map: what its paths must meet first; else NULL */
    const photon_tracing_settings *settings;
    path_block *out;
    uint32_t limit;        /* most photons to store; paths that have begun are finished for the energy balance */
    emission_trial *trial; /* NULL; else a trial, whose value is computed and which stores nothing */
    trial_counts *counts;  /* counts of trials; with trial */
} photon_tracer;

/* Traces the path of a number to its end: photons, counts and balance go into t->out, a trial's value into t->trial.
 * Where memory runs out, the block records it. */
void photon_path_trace(photon_tracer *t, uint64_t number);

#endif
