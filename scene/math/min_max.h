/* min_max.h: the lesser and the greater of two numbers, an instruction each; gcc makes a call of fminf and its kind,
 * for the sake of NaN. Here b is what remains of a NaN a, so bounds come second; a NaN b remains one. Threads: pure
 * functions. */
#ifndef AFTERGLOW_MIN_MAX_H
#define AFTERGLOW_MIN_MAX_H

static inline float float_min(float a, float b) { return a < b ? a : b; }
static inline float float_max(float a, float b) { return a > b ? a : b; }
static inline double double_min(double a, double b) { return a < b ? a : b; }
static inline double double_max(double a, double b) { return a > b ? a : b; }

/* Returns what of [low, high] is nearest to x; low where x is NaN. */
static inline float float_clamp(float x, float low, float high) { return float_min(float_max(x, low), high); }
static inline double double_clamp(double x, double low, double high) { return double_min(double_max(x, low), high); }

#endif
