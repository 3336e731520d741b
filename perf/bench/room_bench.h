/* room_bench.h: what the microbenchmarks share: room 20 of the forty, or another scene, its photon map as the paper
 * has it, and medians. Flow: room_layout, room_file -> [here] -> photon_search, gather_rays, photon_making. Threads:
 * one. */
#ifndef AFTERGLOW_ROOM_BENCH_H
#define AFTERGLOW_ROOM_BENCH_H

#include "irradiance_estimate.h"

enum { ROOM_BENCH_NEAREST = 300, ROOM_BENCH_GATHER_RAYS = 64, ROOM_BENCH_ROUNDS = 9 };

/* A log's listener: warnings and errors go to standard error. */
void room_bench_say(void *user, ag_log_level level, const char *message);

/* The scene of that file, or the room where path is NULL; ready for rays. *out_scene is to be destroyed, on failure
 * too, where it may be NULL. Errors: those of the parser and of files. */
ag_status room_bench_load(run_context *run, const char *path, scene **out_scene);

/* Traces the room's 500,000 photons. *out_set is to be reset by the caller. */
ag_status room_bench_trace(run_context *run, const scene *s, photon_set *out_set);

/* Traces the room's photons and makes their global map: estimates of the 300 nearest within 3.0. Borrows the scene. */
ag_status room_bench_map(run_context *run, const scene *s, photon_map *out_map);

/* The median of an odd number of values, which are put in order. */
double room_bench_median(double *values, size_t count);

typedef struct room_bench_row {
    const char *name;           /* without commas */
    size_t rival;               /* the row that it is held against: the first, where nothing is said */
    double most_ratio, most_us; /* how much is wanted at most, of the rival's time and in microseconds; 0: not said */
    double us[ROOM_BENCH_ROUNDS];
} room_bench_row;

/* CSV: medians of the rounds' ratios to the rival: both halves of a ratio have seen the same noise. */
void room_bench_report(const room_bench_row *rows, size_t count);

#endif
