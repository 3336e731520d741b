/* option_values.h: what the text of an option's value means. All of the text must be a value; false where it is none,
 * and then what was to be set may be anything. Flow: options -> [here]. Threads: pure functions. */
#ifndef AFTERGLOW_OPTION_VALUES_H
#define AFTERGLOW_OPTION_VALUES_H

#include <stdbool.h>
#include <stdint.h>

bool parse_int(const char *text, int least, int most, int *out_value);
/* Parses any number, also infinity and NaN. */
bool parse_float(const char *text, float *out_value);
/* Parses finite numbers with commas between them; returns how many, at most so many. */
bool parse_floats(const char *text, int most, float *out_values, int *out_count);
/* Parses a number above 0, finite. */
bool parse_seconds(const char *text, double *out_seconds);
/* Parses seconds, or HH:MM:SS. */
bool parse_time(const char *text, double *out_seconds);
/* Parses bytes, or with K, M, G or T at the end 1024, 1024^2, ... times as many; at least 1. */
bool parse_bytes(const char *text, uint64_t *out_bytes);
/* Parses I/N, 1 <= I <= N. */
bool parse_tile(const char *text, int *out_index, int *out_count);
/* Reads a word of a list, and gives its index there. */
bool parse_word(const char *text, const char *const *words, int count, int *out_index);

#endif
