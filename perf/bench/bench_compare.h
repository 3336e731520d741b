/* bench_compare.h: two results of afterglow-bench side by side. Flow: two files of bench_json -> [here] -> text.
 * Threads: one. */
#ifndef AFTERGLOW_BENCH_COMPARE_H
#define AFTERGLOW_BENCH_COMPARE_H

#include "afterglow/base.h"

#include <stdio.h>

/* Writes a table of what both have measured on as many threads: the rates' medians, B's over A's, and whether their
 * turns part them: not where the one's least to most meets the other's. Results of different sizes or formats are not
 * comparable. Errors: AG_ERROR_INPUT (a file cannot be read, is no result, or they cannot be compared), with a line in
 * message. */
ag_status bench_compare(const char *path_a, const char *path_b, FILE *out, char *message, size_t message_size);

#endif
