/* renderer_run.h: runs the renderer once as a process of its own, and reads what it says of itself.
 * Flow: forty_rooms -> [here] -> afterglow's statistics and picture -> forty_rooms. Threads: one caller at a time
 * (it forks). */
#ifndef AFTERGLOW_RENDERER_RUN_H
#define AFTERGLOW_RENDERER_RUN_H

#include "rooms/forty_rooms_results.h"

typedef struct renderer_run_settings {
    const char *program; /* a path, or a name to be looked up in $PATH */
    const char *scene_path;
    const char *picture_path; /* written; .exr */
    const char *stats_path;   /* written; JSON */
    cache_mode cache;
    int gather_samples;
    int thread_count; /* 0: the program's own choice */
} renderer_run_settings;

typedef struct renderer_picture {
    int width, height, channel_count;
    float *pixels; /* owned by whoever holds the picture; freed by renderer_picture_reset */
} renderer_picture;

/* Fills the row's values, all but the columns that need more than one run (repeats, sum_min_s, sum_max_s, identical),
 * which become NaN; room and gather are the caller's. *out_picture is the caller's to reset.
 * Errors, told on standard error: AG_ERROR_SYSTEM (not started, killed, or exit code not 0), AG_ERROR_INPUT (statistics
 * or picture missing or without a field of the contract). */
ag_status renderer_run(const renderer_run_settings *settings, result_row *out_row, renderer_picture *out_picture);

void renderer_picture_reset(renderer_picture *picture); /* all zero is fine */

/* How many pixels differ in any bit; every pixel when the shapes differ. */
size_t renderer_picture_difference_count(const renderer_picture *a, const renderer_picture *b);

#endif
