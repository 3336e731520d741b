/* scaling_simulation.h: how a frame's rendering would go on more workers than there are: the tile scheduler's own
 * tiles, claimed in their order, batches of requests in the map's order, and slots that are claimed, set aside and
 * waited for, as events in simulated time with costs that were measured on one thread. It knows nothing of what more
 * workers do to caches and memory: what it says of scheduling and slots is a bound, and beyond the machine an
 * extrapolation. Flow: statistics of a run on one thread -> [here] -> scaling_simulation_program.c. Threads: one. */
#ifndef AFTERGLOW_SCALING_SIMULATION_H
#define AFTERGLOW_SCALING_SIMULATION_H

#include "afterglow/base.h"

#include <stdint.h>

enum { SIMULATION_WORKERS_MAX = 1024 };

typedef struct simulated_frame {
    int width, height;
    double requests_per_pixel; /* of irradiance */
    uint32_t photons;          /* that are asked for, each as likely as the other */
    double own_s;              /* CPU seconds of a request, all but its estimate: rays, shading, the lookup */
    double estimate_s;         /* of an estimate */
    double claim_s;            /* of claiming a slot: a cache line from another core */
    double tile_claim_s;       /* of claiming a tile; all workers take turns there */
    double tile_spread;        /* standard deviation of a tile's own cost over its mean, [0, 1] */
} simulated_frame;

typedef struct simulated_run {
    double seconds; /* until the last worker is done */
    uint64_t requests, computed, deferred, waited;
    double waiting_s; /* of all workers, for others' estimates */
    double idle_s;    /* of all workers, after their own end */
} simulated_run;

/* How many photons are asked for, where so many requests had so many estimates computed: the inverse of
 * computed = photons (1 - exp(-requests / photons)). computed <= requests. */
uint32_t simulation_photons(uint64_t requests, uint64_t computed);

/* workers: [1, SIMULATION_WORKERS_MAX]. Errors: AG_ERROR_ARGUMENT, AG_ERROR_MEMORY. */
ag_status simulation_run(const simulated_frame *of, unsigned workers, simulated_run *out_run);

#endif
