/* option_values.h: what the text of an option's value means. All of the text must be a value; false where it is none,
 * and then what was to be set may be anything. Flow: options -> [here]. Threads: pure functions. */
#ifndef AFTERGLOW_OPTION_VALUES_H
#define AFTERGLOW_OPTION_VALUES_H

#include <stdbool.h>
#include <stdint.h>

bool parse_int(const char *text, int least, int most, int *out_value);
/* Digits alone: no sign. */
bool parse_unsigned(const char *text, uint64_t most, uint64_t *out_value);
/* Counts of photons, also as 2e6: least at least, and no more than a map can hold. */
bool parse_count(const char *text, uint64_t least, uint64_t *out_value);
/* Any number, infinity and what is not a number among them. */
bool parse_float(const char *text, float *out_value);
/* A finite number that is not negative. */
bool parse_bound(const char *text, float *out_value);
/* Above 0, 1 at most. */
bool parse_fraction(const char *text, float *out_value);
/* From 0 to 1. */
bool parse_share(const char *text, float *out_value);
/* Above 0 and finite. */
bool parse_seconds(const char *text, double *out_seconds);
/* Seconds, or HH:MM:SS. */
bool parse_time(const char *text, double *out_seconds);
/* WIDTHxHEIGHT, each in [1, 65536]. */
bool parse_size(const char *text, int *out_width, int *out_height);
/* I/N, 1 <= I <= N. */
bool parse_tile(const char *text, int *out_index, int *out_count);
/* X0,X1,Y0,Y1, each in [0, 1], ascending. */
bool parse_crop(const char *text, double crop[4]);
/* One of a list of words: its place there. */
bool parse_word(const char *text, const char *const *words, int count, int *out_index);

#endif
