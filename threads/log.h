/* log.h: one serialised way out for messages, behind the caller's callback.
 * Threads: every function may be called from any thread. */
#ifndef AFTERGLOW_LOG_H
#define AFTERGLOW_LOG_H

#include "afterglow/base.h"

#include <stdbool.h>

typedef struct log_sink log_sink;

/* Makes a sink of messages; fn NULL: they are dropped. Returns NULL when out of memory. */
log_sink *log_create(ag_log_fn *fn, void *user);
void log_destroy(log_sink *log); /* NULL is fine */
/* Drops messages from now on. Returns the callback that had them, for log_speak. Not while other threads may log. */
ag_log_fn *log_silence(log_sink *log);
/* Sends messages to fn from now on. Not while other threads may log. */
void log_speak(log_sink *log, ag_log_fn *fn);

/* log NULL is fine: the message is dropped. Line ends at the end are cut, and control characters but line ends become
 * '?', tabs a space. A byte from 0x80 to 0x9f that is no part of a character of UTF-8 is a control character, too. fn
 * must not log to the same sink. */
void log_message(log_sink *log, ag_log_level level, const char *format, ...) AG_PRINTF(3, 4);

/* Logs as log_message does, but once for each distinct key in the life of the sink. Returns whether it spoke. */
bool log_once(log_sink *log, ag_log_level level, const char *key, const char *format, ...) AG_PRINTF(4, 5);

#endif
