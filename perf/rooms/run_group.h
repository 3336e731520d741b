/* run_group.h: one room at one gather count, in each cache mode and several times, checked: a line a run, a line a
 * mode. Flow: forty_rooms -> [here] -> renderer_run; lines back to forty_rooms. Threads: one. */
#ifndef AFTERGLOW_RUN_GROUP_H
#define AFTERGLOW_RUN_GROUP_H

#include "rooms/forty_rooms_results.h"

#include <stdbool.h>

typedef struct run_group_settings {
    const char *program;     /* the renderer */
    const char *work_folder; /* for pictures and statistics, replaced at each run */
    const char *scene_path;
    int room, gather;             /* the room's number; gather rays at each gather point */
    int thread_count;             /* 0: the renderer's own choice */
    bool modes[CACHE_MODE_COUNT]; /* which to run */
    int repeats[CACHE_MODE_COUNT];
    int first_repeat; /* what the first repeat is numbered in the runs' lines */
} run_group_settings;

/* Appends a line for each run to runs, and a line for each mode to the table: of its runs the one whose time is the
 * median, of an even count the lower middle. Checks that do not hold are told on standard error and added to
 * *failed_checks; they are no error here. Errors: as renderer_run, AG_ERROR_MEMORY, AG_ERROR_ARGUMENT (a path too
 * long); the tables may then lack lines. */
ag_status run_group_measure(const run_group_settings *settings, result_table *table, result_table *runs,
                            int *failed_checks);

#endif
