/* passes.h: a picture rendered pass by pass, with what is written on the way: checkpoints, snapshots, and what there
 * is when a signal ends it early.
 * Flow: main -> [here] -> ag_rendering. Threads: main's. */
#ifndef AFTERGLOW_PASSES_H
#define AFTERGLOW_PASSES_H

#include "options.h"

#include <stdbool.h>

typedef struct passes_result {
    ag_sample_counts samples;
    bool is_partial;  /* a signal or the time limit ended it: the picture is what there was, and there may be none */
    bool is_complete; /* it ended in order, if with AG_ERROR_OUTPUT since a file could not be written */
} passes_result;

/* Returns the seconds of a monotonic clock, the one that options.begun is read from. */
double passes_seconds(void);

/* Renders, and writes every outfile; tells which were written. AG_CANCELLED: a signal ended it, or the time limit
 * before each pixel had a sample; *out_result is valid then too. Other errors as of what it calls. */
ag_status passes_render(ag_context *context, const options *o, const ag_scene *scene,
                        const ag_render_settings *settings, passes_result *out_result);

#endif
