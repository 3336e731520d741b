/* file_location.h: where in a file something stands, and messages that begin with it.
 * Flow: readers -> [here] -> log. Threads: any. */
#ifndef AFTERGLOW_FILE_LOCATION_H
#define AFTERGLOW_FILE_LOCATION_H

#include "log.h"

#include <stdarg.h>

/* file is interned by the scene and lives as long as it, NULL: no file. line and column count from 1; line 0: the file
 * as a whole. */
typedef struct file_location {
    const char *file;
    int line, column;
} file_location;

/* FILE:LINE:COLUMN: error|warning|info|debug: message */
void log_at(log_sink *log, ag_log_level level, file_location where, const char *format, ...) AG_PRINTF(4, 5);
/* Speaks as log_at does, but once for each distinct key. */
void log_at_once(log_sink *log, ag_log_level level, file_location where, const char *key, const char *format, ...)
    AG_PRINTF(5, 6);
/* An error whose message is followed by excerpt: lines of the file's text, each after a newline, or "". */
void log_at_with_excerpt(log_sink *log, file_location where, const char *excerpt, const char *format, va_list arguments)
    AG_PRINTF(4, 0);

#endif
