/* bench_phases.h: what afterglow-bench times: the phases of a picture one by one, and a whole frame; a unit of each
 * does fixed work, and leaves a fingerprint of all that came out. Flow: bench_stage -> [here] -> bench_run. Threads:
 * each unit on the workers of its context. */
#ifndef AFTERGLOW_BENCH_PHASES_H
#define AFTERGLOW_BENCH_PHASES_H

#include "bench/bench_stage.h"

typedef enum bench_phase {
    BENCH_PHASE_PHOTONS,   /* tracing them */
    BENCH_PHASE_TREE,      /* of the global map */
    BENCH_PHASE_ESTIMATES, /* irradiance at all of its photons */
    BENCH_PHASE_LOOKUPS,   /* irradiance at points, all of it being there: the nearest photon */
    BENCH_PHASE_RAYS,      /* the nearest surface, one ray after the other, by Embree alone */
    BENCH_PHASE_SHADING,   /* a picture of direct light: camera rays, materials, lights, shadow rays */
    BENCH_PHASE_COLOR,     /* a picture through the default display and view */
    BENCH_PHASE_FRAME,     /* a whole picture, irradiance on demand */
    BENCH_PHASE_COUNT
} bench_phase;

const char *bench_phase_name(bench_phase phase);
/* The noun of the items that a unit's amount counts: "photon", "ray", ... */
const char *bench_phase_item(bench_phase phase);

typedef struct bench_outcome {
    double seconds, cpu_s;                         /* of the work alone */
    uint64_t amount;                               /* items done */
    hash128 hash;                                  /* of what came out: photons, tree, slots, distances, pixels */
    uint64_t count;                                /* what was counted; equal for all numbers of threads */
    uint64_t expected;                             /* what must have been counted */
    uint64_t duplicated;                           /* irradiances computed twice: 0 */
    bool is_sound;                                 /* all of finite numbers, and not all of them 0 */
    uint64_t requests, computed, deferred, waited; /* of the irradiance cache, in a frame */
    double waited_s;                               /* CPU seconds of waiting for others' estimates, in a frame */
} bench_outcome;

/* Errors: those of the work. */
ag_status bench_phase_run(bench_stage *stage, ag_context *context, bench_phase phase, bench_outcome *out_outcome);

#endif
