/* forty_rooms_summary.h: what the measurements say, as tables in Markdown.
 * Flow: forty_rooms_results -> [here] -> summary.md. Threads: one. */
#ifndef AFTERGLOW_FORTY_ROOMS_SUMMARY_H
#define AFTERGLOW_FORTY_ROOMS_SUMMARY_H

#include "rooms/forty_rooms_results.h"

/* Replaces the file. table: the lines of median time; runs: the single runs, none of an old measurement. Says of each
 * comparison in how many rooms it could be made; what was not measured is left out. Errors: AG_ERROR_OUTPUT (errno
 * set), AG_ERROR_MEMORY. */
ag_status forty_rooms_summary_write(const char *path, const result_table *table, const result_table *runs);

#endif
