/* forty_rooms_results.h: the measurements as a table, and the CSV files that keep them: results.csv, one line per room,
 * number of gather rays and cache mode; runs.csv, one line per run.
 * Flow: renderer_run -> forty_rooms -> [here] -> forty_rooms_summary, gnuplot. Threads: one caller at a time. */
#ifndef AFTERGLOW_FORTY_ROOMS_RESULTS_H
#define AFTERGLOW_FORTY_ROOMS_RESULTS_H

#include "afterglow/base.h"

#include <stddef.h>
#include <stdio.h>

/* The cache modes, with the program's words for them. */
#define CACHE_MODE_LIST(X)                                                                                             \
    X(CACHE_ON_DEMAND, "on-demand")                                                                                    \
    X(CACHE_PRECOMPUTE, "precompute")                                                                                  \
    X(CACHE_OFF, "off")

typedef enum cache_mode {
#define CACHE_MODE_ENUM(name, text) name,
    CACHE_MODE_LIST(CACHE_MODE_ENUM)
#undef CACHE_MODE_ENUM
        CACHE_MODE_COUNT
} cache_mode;

/* The columns that are numbers, in the file's order, with their printed form. A value that was not measured is NaN here
 * and an empty field in the file. Seconds are elapsed time unless the name says cpu. */
#define RESULT_COLUMN_LIST(X)                                                                                          \
    X(RESULT_THREADS, "threads", "%.0f")                                                                               \
    X(RESULT_REPEATS, "repeats", "%.0f")                                                                               \
    X(RESULT_LOAD_S, "load_s", "%.4f")                                                                                 \
    X(RESULT_BVH_S, "bvh_s", "%.4f")                                                                                   \
    X(RESULT_PHOTONS_S, "photons_s", "%.4f")                                                                           \
    X(RESULT_MAP_S, "map_s", "%.4f")                                                                                   \
    X(RESULT_PRECOMPUTE_S, "precompute_s", "%.4f")                                                                     \
    X(RESULT_RENDER_S, "render_s", "%.4f")                                                                             \
    X(RESULT_WRITE_S, "write_s", "%.4f")                                                                               \
    X(RESULT_TOTAL_S, "total_s", "%.4f")                                                                               \
    X(RESULT_SUM_S, "sum_s", "%.4f")         /* what the paper compares: photons + map + precompute + render */        \
    X(RESULT_SUM_MIN_S, "sum_min_s", "%.4f") /* over the repeats */                                                    \
    X(RESULT_SUM_MAX_S, "sum_max_s", "%.4f")                                                                           \
    X(RESULT_CPU_S, "cpu_s", "%.4f")     /* user + system of the whole process, as its parent is told */               \
    X(RESULT_PEAK_MB, "peak_mb", "%.1f") /* 10^6 bytes resident, as the parent is told */                              \
    X(RESULT_REQUESTS, "requests", "%.0f")                                                                             \
    X(RESULT_COMPUTED, "computed", "%.0f")                                                                             \
    X(RESULT_DISTINCT, "distinct", "%.0f")                                                                             \
    X(RESULT_DEFERRED, "deferred", "%.0f")                                                                             \
    X(RESULT_WAITED, "waited", "%.0f")                                                                                 \
    X(RESULT_DUPLICATED, "duplicated", "%.0f")                                                                         \
    X(RESULT_UNCACHED, "uncached", "%.0f") /* estimates at the hits themselves; nearly all for off */                  \
    X(RESULT_EMITTED, "emitted", "%.0f")                                                                               \
    X(RESULT_STORED, "stored", "%.0f")                                                                                 \
    X(RESULT_PHOTON_BYTES, "photon_bytes", "%.0f")                                                                     \
    X(RESULT_SHARE, "share", "%.6f")                     /* computed / stored; not for off */                          \
    X(RESULT_US_PER_ESTIMATE, "us_per_estimate", "%.3f") /* of one thread */                                           \
    X(RESULT_PICTURE_MEAN, "picture_mean", "%.9g")       /* over pixels and channels */                                \
    X(RESULT_IDENTICAL, "identical", "%.0f")             /* 1: every picture that must be the same is; 0: one differs */

typedef enum result_column {
#define RESULT_COLUMN_ENUM(name, text, format) name,
    RESULT_COLUMN_LIST(RESULT_COLUMN_ENUM)
#undef RESULT_COLUMN_ENUM
        RESULT_COLUMN_COUNT
} result_column;

/* The contents of a file. The columns that need several runs are empty in a line of RESULT_RUNS. */
typedef enum result_form { RESULT_MEDIANS, RESULT_RUNS } result_form;

typedef struct result_row {
    int room, gather;
    cache_mode mode;
    /* of a single run, from 1: which repeat of its room and gather rays, and its turn in it; else 0 */
    int repeat, turn;
    double values[RESULT_COLUMN_COUNT];
} result_row;

/* Own with result_table_reset; all zero is an empty table. */
typedef struct result_table {
    result_row *rows;
    size_t count, capacity;
} result_table;

const char *cache_mode_text(cache_mode mode);

/* Errors: AG_ERROR_MEMORY; the table is as it was. */
ag_status result_table_add(result_table *table, const result_row *row);
void result_table_reset(result_table *table);

/* NULL when there is no such line. repeat: 0 in a table of RESULT_MEDIANS. */
const result_row *result_table_find(const result_table *table, int room, int gather, cache_mode mode, int repeat);

/* The gather counts in the table, ascending; the list is the caller's to free. NULL when there is no memory. */
int *result_table_gathers(const result_table *table, size_t *out_count);

/* The greatest number of a repeat among the runs of a room at a gather count; 0 when there is none. */
int result_table_last_repeat(const result_table *runs, int room, int gather);

/* A room's speed-up by CPU time of the whole process: of each repeat, precompute's time / on-demand's, and of these the
 * median. What the machine does to a repeat falls on both its runs, and cancels. NaN when no repeat has both. ratios
 * has room for runs->count numbers. */
double result_table_speed_up(const result_table *runs, int room, int gather, double *ratios);

/* Sorts the values; of an even count the mean of the middle two; NaN of none. */
double result_median(double *values, size_t count);

/* Appends the file's lines to the table. A file that is not there adds nothing and is no error.
 * Errors: AG_ERROR_INPUT (unreadable, another heading, a malformed line), AG_ERROR_MEMORY; told on standard error. */
ag_status result_table_read(const char *path, result_form form, result_table *table);

void result_print_heading(FILE *file, result_form form);
void result_print_row(FILE *file, result_form form, const result_row *row);

#endif
