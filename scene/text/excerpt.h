/* excerpt.h: the line of a text that a message is about, with a mark below what it means.
 * Flow: readers -> [here] -> log. Threads: pure functions. */
#ifndef AFTERGLOW_EXCERPT_H
#define AFTERGLOW_EXCERPT_H

#include "text/file_location.h"

#include <stddef.h>

/* Writes the line at where with a mark below width bytes from its column on, "\n    line\n    ^~~", or "" where the
 * text has no such position. Long lines are cut around the mark; a byte order mark at the text's beginning counts for
 * no column. */
void text_excerpt(const char *text, size_t text_size, file_location where, size_t width, char *out_excerpt,
                  size_t out_size);

#endif
