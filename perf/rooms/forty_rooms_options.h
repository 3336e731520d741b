/* forty_rooms_options.h: what afterglow-forty-rooms was asked to measure.
 * Flow: command line -> [here] -> forty_rooms. Threads: one. */
#ifndef AFTERGLOW_FORTY_ROOMS_OPTIONS_H
#define AFTERGLOW_FORTY_ROOMS_OPTIONS_H

#include "rooms/forty_rooms_results.h"
#include "rooms/room_layout.h"

#include <stdbool.h>

#define GATHER_LIST_MAX 32

typedef struct forty_rooms_options {
    const char *folder;           /* of everything written; required */
    const char *program;          /* NULL: 'afterglow' beside this program */
    bool rooms[ROOM_COUNT + 1];   /* by number, from 1 */
    int gathers[GATHER_LIST_MAX]; /* in the order given */
    int gather_count;
    bool modes[CACHE_MODE_COUNT];
    int repeats[CACHE_MODE_COUNT]; /* runs of each mode, >= 1 */
    int thread_count;              /* 0: the renderer's own choice */
    bool resume;                   /* keep the lines that results.csv has, and measure the others */
    bool summary_only;             /* measure nothing */
} forty_rooms_options;

/* Returns 0, 2 after a usage error told on standard error, or -1 when the help was printed. Strings are borrowed. */
int forty_rooms_parse_options(int argc, char **argv, forty_rooms_options *out_options);

#endif
